//! Chapters 6 and 7: reduced models, and all methods side by side.

use super::entry::Ours::Printed;
use super::entry::{Chapter, Entry, Grid, Number, api};

pub const CHAPTERS: [Chapter; 2] = [
    Chapter {
        title: "Chapter 6: reduced models",
        entries: REDUCED,
    },
    Chapter {
        title: "Chapter 7: the methods side by side",
        entries: COMPARISON,
    },
];

const REDUCED: &[Entry] = &[
    Entry {
        api: api![reduced::Separated, reduced::solve, reduced::PgdParams],
        example: Some("reduced_models"),
        pictures: &["linear.svg"],
        numbers: &[Number::new(
            "largest error",
            "10⁻¹¹",
            Printed("/linear/worst_error"),
        )],
        ..Entry::new(
            "Figs. 6.1–6.3, Algorithm 3",
            "a parametric linear model (6.18)",
        )
    },
    Entry {
        api: api![reduced::evolve, reduced::EvolutionParams],
        example: Some("reduced_models"),
        pictures: &["falling.svg"],
        numbers: &[
            Number::new(
                "relative error after 5 enrichments",
                "converged",
                Printed("/falling/after_5"),
            ),
            Number::new("… in the end", "", Printed("/falling/finally")),
        ],
        ..Entry::new("Figs. 6.4, 6.5", "a body that falls with drag (6.20)")
    },
    Entry {
        api: api![reduced::evolve, reduced::Coupling],
        example: Some("reduced_models"),
        pictures: &["coupled.svg"],
        numbers: &[
            Number::new(
                "relative error after 8 enrichments",
                "converged",
                Printed("/coupled/monolithic/after_8"),
            ),
            Number::new("… in the end", "", Printed("/coupled/monolithic/finally")),
            Number::new(
                "all of 20³ initial values, ms",
                "17",
                Printed("/coupled/separated_ms_at_20"),
            ),
            Number::new(
                "times faster than solving each",
                "50",
                Printed("/coupled/times_faster_at_20"),
            ),
        ],
        ..Entry::new(
            "Figs. 6.6, 6.7",
            "three coupled equations with unknown initial values (6.22)",
        )
    },
    Entry {
        api: api![reduced::KirchhoffBody],
        example: Some("reduced_models"),
        pictures: &["kirchhoff.svg"],
        numbers: &[Number::new(
            "relative error",
            "",
            Printed("/kirchhoff/error"),
        )],
        remark: "With gravity and its torque turning with the body, which the thesis names and does not print.",
        ..Entry::new(
            "Fig. 6.8, (6.24)",
            "a body in a potential flow, six unknown velocities",
        )
    },
    Entry {
        api: api![
            reduced::DeimEvolution,
            reduced::PiecewiseLinear,
            reduced::TensorTrain,
            reduced::SeparatedForces
        ],
        example: Some("reduced_models"),
        pictures: &["planar.svg"],
        remark: "What § 6.5 proposes, carried out: neither alternative holds beyond the first turns of a fall; a tensor train of \
                 the *forces* does.",
        ..Entry::new("Fig. 6.9, § 6.5", "nonlinear forces in a reduced model")
    },
];

const COMPARISON: &[Entry] = &[
    Entry {
        remark: "A drawing.",
        ..Entry::new("Fig. 7.1", "the methods and what they know")
    },
    Entry {
        api: api![
            playback::MotionPlayers,
            StochasticLaw,
            training::Planner,
            SeparatedLaw
        ],
        example: Some("methods"),
        pictures: &["methods.svg", "methods.gif"],
        grid: Some(Grid {
            columns: &[
                ("graph-based", "graph"),
                ("stochastic", "stochastic"),
                ("pattern-driven", "pattern"),
                ("reduced", "reduced"),
                ("default law", "law"),
            ],
            rows: &[
                (
                    "adaptive geometries: shapes that it takes",
                    "adaptive_geometries",
                ),
                (
                    "data independence: bytes held, samples",
                    "data_independence",
                ),
                (
                    "computation cost beyond rapier's, per body-step",
                    "computation_cost",
                ),
                (
                    "simulation fidelity: descent, drift, regimes of paper",
                    "simulation_fidelity",
                ),
                (
                    "controllability: off a target 2 m below; sequence shown",
                    "controllability",
                ),
                (
                    "simulation stability: of 1000 falls at 1/30 s, gain energy; most",
                    "simulation_stability",
                ),
                ("extensibility: gap of two joined leaves", "extensibility"),
            ],
            pointer: "/methods/COLUMN/table_7_1/ROW/measured",
        }),
        remark: "The thesis ticks boxes, as far as its scanned text shows; these are measurements of the same leaf and of a paper circle of 24 mm. Its ticks: cost, fidelity and \
                 stability for the graph; none for the stochastic model; geometries, cost, fidelity, controllability and stability for \
                 patterns; geometries and cost for the reduced model.",
        ..Entry::new("Table 7.1", "the four methods compared")
    },
    Entry {
        example: Some("methods"),
        remark: "The answers of its nineteen participants are not published. The example's `scoring.html` asks anyone the same questions of \
                 our clips, and weighs the answers by (7.1).",
        ..Entry::new("Figs. 7.2, 7.3, (7.1)", "the questionnaire")
    },
    Entry {
        api: api![SeparatedLaw, PartLaw, reduced::SeparatedForces],
        example: Some("reduced_models"),
        pictures: &["driven.svg"],
        numbers: &[
            Number::new(
                "default law: ns per body-step, rapier's included",
                "",
                Printed("/driven/default law/ns_per_body_step"),
            ),
            Number::new(
                "separated, rank 32",
                "",
                Printed("/driven/separated, rank 32/ns_per_body_step"),
            ),
            Number::new(
                "default law: descent, m/s",
                "",
                Printed("/driven/default law/descent"),
            ),
            Number::new(
                "separated, rank 32: descent, m/s",
                "",
                Printed("/driven/separated, rank 32/descent"),
            ),
        ],
        remark: "A reduced model drives bodies in rapier, with an error bound. It costs more than the law that it stands for, and so is \
                 for laws that are expensive themselves.",
        ..Entry::new(
            "§ 7.3, model-driven simulation",
            "a reduced model as the law of a body",
        )
    },
    Entry {
        api: api![motion::Sketch, training::Followed],
        example: Some("patterns"),
        pictures: &["sketches.svg"],
        numbers: &[
            Number::new(
                "a swing of five points: mean distance, cm",
                "",
                Printed("/sketches/0/mean_cm"),
            ),
            Number::new("a glide", "", Printed("/sketches/1/mean_cm")),
        ],
        remark: "Drawn as SVG or loaded from a table, for several leaves at once, with wind and obstacles: example `sketch`.",
        ..Entry::new("§ 7.3, controllable simulation", "motion along a sketch")
    },
    Entry {
        api: api![playback::Suspension, playback::Emitter],
        remark: "Rapier collides all methods' bodies. Below Re 10 a hundred thousand flakes are a `Suspension`: example `snow`.",
        ..Entry::new("§ 7.3, multibody simulation", "collisions, snow and dust")
    },
];
