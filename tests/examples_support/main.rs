//! What the examples share is tested here, and the parts of the pond and the boat: examples themselves have no tests.

#[path = "../../examples/methods/means.rs"]
#[allow(dead_code, reason = "shared with the example")]
mod means;
#[path = "../../examples/methods/measured.rs"]
#[allow(dead_code, reason = "shared with the example")]
mod measured;
#[path = "../../examples/pond/scene.rs"]
#[allow(dead_code, reason = "shared with the example")]
mod pond_scene;
#[path = "../../examples/boat/righting.rs"]
#[allow(dead_code, reason = "shared with the example")]
mod righting;
#[path = "../../examples/boat/seakeeping.rs"]
#[allow(dead_code, reason = "shared with the example")]
mod seakeeping;
#[path = "../../examples/stochastic/case.rs"]
#[allow(dead_code, reason = "shared with the example")]
mod stochastic_case;
#[path = "../../examples/support/mod.rs"]
mod support;
#[path = "../../examples/sketch/svg.rs"]
mod svg;
#[path = "../../examples/boat/wigley.rs"]
#[allow(dead_code, reason = "shared with the example")]
mod wigley;

mod airplane;
mod animation;
mod boat;
mod command_lines;
mod drawings;
mod falls;
mod leaves;
mod meshes;
mod methods;
mod pages;
mod pond;
mod reels;
mod scoring;
mod specimens;
mod stochastic;
mod tables;

/// As in the example `methods`.
type Failure = Box<dyn std::error::Error + Send + Sync>;
