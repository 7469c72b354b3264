//! The chapters, and the examples that show them.

use super::entry::{Chapter, Run};
use super::{chapter_2_3, chapter_4, chapter_5, chapter_6_7};

/// What makes the page.
pub const COMMAND: &str = "cargo run --release --features bake,serde-serialize --example thesis";

const BAKE: &str = "bake";
const BOTH: &str = "bake,serde-serialize";

/// The examples whose numbers and pictures the page shows.
pub const RUNS: &[Run] = &[
    Run::new("synthesis", BAKE, &[]),
    Run::new("tracks", "", &[]),
    Run::new("wind", BAKE, &[]),
    Run::new("stochastic", "", &[]),
    Run::new("added_mass", BOTH, &["--figure"]),
    Run::new("patterns", BOTH, &[]),
    Run::new(
        "reduced_models",
        "",
        &["--only", "linear,falling,coupled,kirchhoff,driven,planar"],
    ),
    Run::new("methods", BOTH, &["--gif"]),
];

/// In the order of the thesis.
pub fn chapters() -> [&'static Chapter; 6] {
    let [introduction, graph] = &chapter_2_3::CHAPTERS;
    let [reduced, comparison] = &chapter_6_7::CHAPTERS;
    [
        introduction,
        graph,
        &chapter_4::CHAPTER,
        &chapter_5::CHAPTER,
        reduced,
        comparison,
    ]
}
