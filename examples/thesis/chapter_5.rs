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
            numbers: &[
                Number::new("radius, cm", "", Printed("/fig_5_5/radius_cm")),
                Number::new("pitch, cm", "", Printed("/fig_5_5/pitch_cm")),
                Number::new(
                    "residual over the radius",
                    "",
                    Printed("/fig_5_5/residual_of_radius"),
                ),
                Number::new(
                    "releases near 45° that tumble, of 40",
                    "",
                    Printed("/fig_5_5/releases_tumbling"),
                ),
                Number::new(
                    "… along a helix",
                    "one, shown",
                    Printed("/fig_5_5/releases_helix"),
                ),
            ],
            remark: "Its card tumbles from almost every release; along a helix from two of forty. The release drawn is one of these.",
            ..Entry::new("Fig. 5.5", "a card that autorotates along a helix")
        },
        Entry {
            api: api![motion::Pattern, motion::Classifier, motion::Spread],
            example: Some("patterns"),
            pictures: &["fig_5_6_patterns.svg"],
            numbers: &[
                Number::new(
                    "d of SD, cm",
                    "1.25",
                    Printed("/fig_5_6/distances_under_readings/0/d_cm/0"),
                ),
                Number::new(
                    "… ZZ",
                    "5.69",
                    Printed("/fig_5_6/distances_under_readings/0/d_cm/1"),
                ),
                Number::new(
                    "… AZ",
                    "13.72 (1.25 in the figure)",
                    Printed("/fig_5_6/distances_under_readings/0/d_cm/2"),
                ),
                Number::new(
                    "… AR",
                    "22.43",
                    Printed("/fig_5_6/distances_under_readings/0/d_cm/3"),
                ),
            ],
            remark: "Every printed coefficient shows its pattern (the direct classifier, releases from 9° to 11°), but AR, which does in 12 of \
                     21. Its distances come out only for a card of twice the mass, whose patterns then are others: no reading gives both.",
            ..Entry::new(
                "Figs. 5.6, 5.7",
                "four patterns of a card, and their d and e",
            )
        },
        Entry {
            api: api![training::Sweep, training::Clusters],
            example: Some("patterns"),
            pictures: &["fig_5_7_clusters.svg", "fig_5_8_samples.svg"],
            numbers: &[
                Number::new(
                    "κ of (d, e) against the direct classifier, card",
                    "",
                    Printed("/fig_5_7/0/kappa/path"),
                ),
                Number::new(
                    "… of how the body turns",
                    "",
                    Printed("/fig_5_7/0/kappa/turning"),
                ),
                Number::new(
                    "… of turns and flips",
                    "",
                    Printed("/fig_5_7/0/kappa/flips"),
                ),
                Number::new(
                    "leaf under the default law: (d, e)",
                    "",
                    Printed("/fig_5_7/3/kappa/path"),
                ),
                Number::new("… of how it turns", "", Printed("/fig_5_7/3/kappa/turning")),
            ],
            remark: "That d and e tell the patterns apart is not reproduced: they do not see whether a body turns over. `Features` has sets that do; \
                     they were chosen on these falls.",
            ..Entry::new("Fig. 5.8", "clusters over d and e")
        },
        Entry {
            api: api![training::Grid, training::Subspaces],
            example: Some("patterns"),
            pictures: &[
                "fig_5_9_sampling.svg",
                "fig_5_10_thesis_law.svg",
                "fig_5_10_default_law.svg",
            ],
            numbers: &[
                Number::new(
                    "nodes of the finest grid",
                    "4913",
                    Printed("/fig_5_10/0/nodes"),
                ),
                Number::new(
                    "falls that the refinement takes",
                    "",
                    Printed("/fig_5_10/0/new_falls"),
                ),
            ],
            ..Entry::new("Figs. 5.9, 5.10", "sampling, and subspaces of patterns")
        },
        Entry {
            api: api![motion::MotionGraph, training::Planner],
            example: Some("patterns"),
            pictures: &["fig_5_11_graph.svg", "fig_5_12_curvature.svg"],
            numbers: &[
                Number::new(
                    "maxima of the curvature: ZZ",
                    "several",
                    Printed("/fig_5_12/1/maxima"),
                ),
                Number::new("… AZ", "several", Printed("/fig_5_12/2/maxima")),
                Number::new("… AR", "several", Printed("/fig_5_12/3/maxima")),
            ],
            remark: "The probabilities of (5.25) are the thesis's own. By its tolerance of 0.1 the flutter of this card has no maxima.",
            ..Entry::new(
                "Figs. 5.11, 5.12, (5.25)",
                "transitions, and where they happen",
            )
        },
        Entry {
            api: api![ViscousLaw, training::Experiment],
            example: Some("patterns"),
            pictures: &["fig_5_13_effects.svg"],
            numbers: &[Number::new(
                "largest rise of the center with all effects, mm",
                "rises at turns",
                Printed("/fig_5_13/4/largest_rise_mm"),
            )],
            remark: "That the center of mass rises where the path turns is not seen in these falls.",
            ..Entry::new("Fig. 5.13", "effects of the fluid switched on one by one")
        },
        Entry {
            api: api![training::Planner, Immersion],
            example: Some("patterns"),
            pictures: &["fig_5_14_leaf.svg"],
            numbers: &[
                Number::new("first pattern", "SD", Printed("/fig_5_14/observed/0")),
                Number::new("second pattern", "AR", Printed("/fig_5_14/observed/1")),
            ],
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
