//! Chapters 6 and 7: reduced models, and all methods side by side.

use super::entry::Ours::{Printed, Timed};
use super::entry::{Chapter, Entry, Number, api};

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
        numbers: &[],
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
        pictures: &["horizon.svg"],
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
        example: Some("methods"),
        pictures: &["methods.svg"],
        ..Entry::new("Table 7.1", "the four methods compared")
    },
    Entry {
        example: Some("methods"),
        remark: "The answers of its nineteen participants are not published. `scoring.html` asks anyone the same questions of our \
                 clips, and weighs the answers by (7.1).",
        ..Entry::new("Figs. 7.2, 7.3, (7.1)", "the questionnaire")
    },
    Entry {
        api: api![motion::Sketch, training::Followed],
        example: Some("patterns"),
        pictures: &["sketches.svg"],
        ..Entry::new("§ 7.3", "motion along a sketch")
    },
];
