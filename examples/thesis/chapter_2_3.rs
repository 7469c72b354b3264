//! Chapters 1 to 3: what falls how, and the graph-based method.

use super::entry::Ours::{Printed, Quick, Timed};
use super::entry::{Chapter, Entry, Number, api};
use rapier3d_immersed::Fluid;
use rapier3d_immersed::motion::{DimensionlessNumbers, Outline};

/// The thesis's coin: an aluminium disc of 2 cm and 1.5 mm in water, whose properties it does not print.
fn coin() -> DimensionlessNumbers {
    let water = Fluid::new(1000.0, 0.89e-6).expect("water");
    DimensionlessNumbers::new(Outline::Round, 0.02, 0.0015, 2700.0, &water, 9.81).expect("a coin")
}

pub const CHAPTERS: [Chapter; 2] = [
    Chapter {
        title: "Chapters 1 and 2: what is immersed, and what is known of it",
        entries: INTRODUCTION,
    },
    Chapter {
        title: "Chapter 3: the graph-based method",
        entries: GRAPH,
    },
];

const INTRODUCTION: &[Entry] = &[
    Entry {
        remark: "Photographs and drawings: not to be had, or nothing to compute.",
        ..Entry::new(
            "Figs. 1.1–1.3, Table 1.1",
            "examples, modules, a family of methods",
        )
    },
    Entry {
        api: api![training::fidelity],
        remark: "Lists of papers. What the crate is measured against is in [measurements.md](measurements.md).",
        ..Entry::new("Tables 2.1, 2.2", "experiments and computations by others")
    },
    Entry {
        api: api![AddedMass, FreeBody],
        remark: "Kirchhoff's equations (2.12), with the full tensor of six by six, against exact solutions in \
                 `tests/validation/kirchhoff.rs`.",
        ..Entry::new("(2.12)", "motion in a potential flow")
    },
];

const GRAPH: &[Entry] = &[
    Entry {
        api: api![motion::Regime, motion::path::UnifiedCurve],
        example: Some("synthesis"),
        pictures: &["synthesis_patterns.svg"],
        remark: "A leaf in each regime, prescribed: it shows what the database holds, not what is predicted.",
        ..Entry::new(
            "Figs. 3.1, 3.8",
            "six regimes, from the side and from above",
        )
    },
    Entry {
        remark: "A drawing; the module's documentation has the same steps.",
        ..Entry::new("Fig. 3.2", "overview of the method")
    },
    Entry {
        api: api![motion::PhaseDiagram, motion::DimensionlessNumbers],
        example: Some("patterns"),
        pictures: &["phase_diagram.svg"],
        remark: "The curves are those of Field et al. (1997). Where the spiral begins is from the crate's own falls; where the helix does, a convention.",
        ..Entry::new("Fig. 3.3", "phase diagram over Re and I*")
    },
    Entry {
        api: api![
            motion::path::TanabeKaneko,
            motion::path::HarmonicFlutter,
            motion::path::Segment
        ],
        example: Some("synthesis"),
        pictures: &["synthesis_database.svg"],
        remark: "",
        ..Entry::new("Figs. 3.4, 3.5", "solutions of (3.4), segments of (3.6)")
    },
    Entry {
        example: Some("tracks"),
        pictures: &["tracks.svg"],
        numbers: &[
            Number::new(
                "paper circle of 24 mm: ours within a diameter for, s",
                "",
                Printed("/forecasts/2/ours_s"),
            ),
            Number::new(
                "… the repeat of the experiment, s",
                "",
                Printed("/forecasts/2/repeat_s"),
            ),
        ],
        remark: "Its own track is not published; those of falling paper are (Howison et al. 2020), with positions only.",
        ..Entry::new("Fig. 3.6", "a synthesized path over a measured one")
    },
    Entry {
        api: api![motion::path::TrajectoryDatabase],
        remark: "A drawing of the search tree; `src/motion/path/search_tree.rs` is it.",
        ..Entry::new("Fig. 3.7", "the search tree of segments")
    },
    Entry {
        api: api![
            motion::path::motion_classes,
            motion::MotionGraph,
            motion::FallEstimates
        ],
        example: Some("synthesis"),
        pictures: &["synthesis_classes.svg", "synthesis_chain.svg"],
        numbers: &[
            Number::new("classes of motion", "7", Printed("/classes/own_classes")),
            Number::new(
                "share of the seven commonest",
                "1",
                Printed("/classes/own_share_of_the_seven_commonest"),
            ),
            Number::new(
                "share of sequences that strictly increase",
                "1 (its hypothesis)",
                Printed("/classes/own_share_that_strictly_increases"),
            ),
        ],
        remark: "Its matrix (3.13) has no numbers. Ours are counted in 12 000 falls of discs under the default law, and in tracked \
                 falls of paper (`synthesis --estimate`); a quarter of the changes go backward. A helix was the main motion of 4 falls: its \
                 place stays a convention.",
        ..Entry::new(
            "Figs. 3.9, 3.10, (3.9), (3.13)",
            "motion classes, and the Markov chain",
        )
    },
    Entry {
        api: api![motion::path::FrameGraph],
        example: Some("synthesis"),
        pictures: &["synthesis_frames.svg"],
        numbers: &[
            Number::new(
                "jump of the velocity at splices of frames, m/s",
                "",
                Printed("/frames/PS/of_frames/velocity_rms_m_per_s"),
            ),
            Number::new(
                "… of regimes, m/s",
                "",
                Printed("/frames/PS/of_regimes/velocity_rms_m_per_s"),
            ),
            Number::new(
                "jump of the attitude at splices of frames, rad",
                "",
                Printed("/frames/PS/of_frames/attitude_rms_rad"),
            ),
            Number::new(
                "… of regimes, rad",
                "",
                Printed("/frames/PS/of_regimes/attitude_rms_rad"),
            ),
        ],
        ..Entry::new("Fig. 3.11", "the motion graph, with frames as its nodes")
    },
    Entry {
        api: api![flow::SpectralWind, flow::WindParams],
        example: Some("wind"),
        pictures: &["field_thesis.svg", "field.svg", "spectra.svg"],
        remark: "With the thesis's spectrum, and with one that was measured (Kaimal et al. 1972).",
        ..Entry::new("Fig. 3.12", "gusty wind at two heights")
    },
    Entry {
        api: api![motion::path::MotionPath],
        example: Some("synthesis"),
        pictures: &["synthesis_wind.svg"],
        ..Entry::new("Fig. 3.13", "a trajectory that the wind bends")
    },
    Entry {
        api: api![motion::path::MotionPath, motion::path::WindResponse],
        example: Some("wind"),
        pictures: &["paths.svg"],
        remark: "",
        ..Entry::new("Fig. 3.14", "paths in wind of 1, 3 and 5 m/s")
    },
    Entry {
        api: api![motion::path::Synthesizer, motion::DimensionlessNumbers],
        example: Some("synthesis"),
        pictures: &["synthesis_bodies.svg"],
        numbers: &[
            Number::new("coin: Re", "3.55 × 10³", Quick(|| coin().reynolds_u0)),
            Number::new("coin: I*", "10⁻²", Quick(|| coin().i_star)),
            Number::new(
                "paper: Re",
                "6.8 × 10³",
                Printed("/bodies/1/computed/reynolds_u0"),
            ),
            Number::new(
                "paper: I*",
                "2.2 × 10⁻³",
                Printed("/bodies/1/computed/i_star"),
            ),
            Number::new(
                "leaf: Re",
                "1.2 × 10⁴",
                Printed("/bodies/2/computed/reynolds_u0"),
            ),
            Number::new(
                "leaf: I*",
                "6.3 × 10⁻³",
                Printed("/bodies/2/computed/i_star"),
            ),
            Number::new(
                "coin: regime",
                "flutter",
                Printed("/bodies/0/computed/regime"),
            ),
            Number::new(
                "paper: regime",
                "spiral",
                Printed("/bodies/1/computed/regime"),
            ),
            Number::new(
                "leaf: regime",
                "helix",
                Printed("/bodies/2/computed/regime"),
            ),
        ],
        remark: "The numbers of paper and leaf do not follow from the thesis's own formulas for any plausible density; by \
                 them both tumble, as real ones do. Videos: not published.",
        ..Entry::new("Figs. 3.15–3.17", "coin, paper and leaf")
    },
    Entry {
        api: api![playback::MotionPlayers, playback::Emitter],
        example: Some("synthesis"),
        pictures: &["synthesis_tree.svg"],
        remark: "With collisions, which the thesis leaves out.",
        ..Entry::new("Fig. 3.18", "leaves from a tree")
    },
    Entry {
        api: api![playback::MotionPlayers],
        numbers: &[
            Number::new("2-D wind 100 × 100, ms", "8", Timed("wind, 100 × 100")),
            Number::new("3-D wind 100³, ms", "1363", Timed("wind, 100 × 100 × 100")),
            Number::new(
                "step of one body, ms",
                "< 3",
                Timed("synthesized path, step"),
            ),
        ],
        ..Entry::new("§ 3.5, § 3.6", "times of the method")
    },
];
