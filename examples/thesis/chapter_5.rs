//! Chapter 5: the pattern-driven method.

use super::entry::Ours::{Printed, Timed};
use super::entry::{Chapter, Entry, Number, api};

pub const CHAPTER: Chapter = Chapter {
    title: "Chapter 5: the pattern-driven method",
    entries: &[
        Entry {
            api: api![boundary_element, Accuracy],
            example: Some("added_mass"),
            pictures: &["added_mass_error.svg"],
            numbers: &[
                Number::new(
                    "ellipsoid of 1.3 cm: error of the previous method",
                    "0.01",
                    Printed("/ellipsoid/2/previous"),
                ),
                Number::new("… of ours", "", Printed("/ellipsoid/2/ours")),
                Number::new(
                    "ellipsoid of 0.1 mm: previous method",
                    "",
                    Printed("/ellipsoid/9/previous"),
                ),
                Number::new("… ours", "", Printed("/ellipsoid/9/ours")),
            ],
            ..Entry::new("Fig. 5.2", "error of the added mass of thin bodies")
        },
        Entry {
            api: api![ThesisLaw],
            remark: "Drawings. The equations are in the law's documentation, with what is wrong in print.",
            ..Entry::new(
                "Figs. 5.1, 5.3, Table 5.1",
                "overview, forces, coefficients of others",
            )
        },
        Entry {
            api: api![ThesisLaw],
            remark: "Its three fits are constants of the law (`ThesisLaw::FIG_5_4_DATA_1` to `_3`), which has the curves of (5.15) to (5.17) by \
                     construction; the data behind them are not published.",
            ..Entry::new("Fig. 5.4", "coefficients over the angle of attack")
        },
        Entry {
            api: api![PhysicalLaw],
            example: Some("patterns"),
            pictures: &["fig_5_5_helix.svg"],
            ..Entry::new("Fig. 5.5", "a card that autorotates along a helix")
        },
        Entry {
            api: api![motion::Pattern, motion::Classifier, motion::Spread],
            example: Some("patterns"),
            pictures: &["fig_5_6_patterns.svg"],
            ..Entry::new(
                "Figs. 5.6, 5.7",
                "four patterns of a card, and their d and e",
            )
        },
        Entry {
            api: api![training::Sweep, training::Clusters],
            example: Some("patterns"),
            pictures: &["fig_5_7_clusters.svg", "fig_5_8_samples.svg"],
            ..Entry::new("Fig. 5.8", "clusters over d and e")
        },
        Entry {
            api: api![training::Grid, training::Subspaces],
            example: Some("patterns"),
            pictures: &["fig_5_10_thesis_law.svg", "fig_5_10_default_law.svg"],
            ..Entry::new("Figs. 5.9, 5.10", "sampling, and subspaces of patterns")
        },
        Entry {
            api: api![motion::MotionGraph, training::Planner],
            example: Some("patterns"),
            ..Entry::new(
                "Figs. 5.11, 5.12, (5.25)",
                "transitions, and where they happen",
            )
        },
        Entry {
            api: api![ViscousLaw, training::Experiment],
            example: Some("patterns"),
            pictures: &["fig_5_13_effects.svg"],
            ..Entry::new("Fig. 5.13", "effects of the fluid switched on one by one")
        },
        Entry {
            api: api![training::Planner, Immersion],
            example: Some("patterns"),
            pictures: &["fig_5_14_leaf.svg"],
            ..Entry::new("Figs. 5.14, 5.15", "a leaf that descends and then tumbles")
        },
        Entry {
            api: api![training::Planner, motion::Codebook],
            example: Some("patterns"),
            pictures: &["fig_5_16_tree.svg"],
            ..Entry::new("Fig. 5.16, Table 5.2", "leaves from a tree")
        },
        Entry {
            numbers: &[
                Number::new(
                    "training of 729 falls, s",
                    "20 520 (5.7 h)",
                    Timed("training, 729 falls"),
                ),
                Number::new(
                    "refined to 4913, s",
                    "14 400 (4.0 h)",
                    Timed("training, refined to 4913"),
                ),
                Number::new("step, ms", "20", Timed("step of a card alone")),
            ],
            remark: "With the boundaries resampled, most of the 4913 need no fall.",
            ..Entry::new("§ 5.6", "times of the method")
        },
    ],
};
