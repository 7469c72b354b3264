//! Motion patterns: their names, how to tell them apart, and how they follow each other (thesis
//! chapters 3 and 5). [`path`] puts falls together from segments.

pub mod classify;
pub mod codebook;
pub mod graph;
pub mod numbers;
pub mod path;
pub mod pattern;
pub mod phase_diagram;
pub mod sketch;
pub mod trajectory;
pub mod turning;

pub use classify::{Classifier, Observation};
pub use codebook::{Codebook, ControlSeries, Dwell};
pub use graph::MotionGraph;
pub use numbers::{DimensionlessNumbers, Outline};
pub use pattern::{Pattern, Regime};
pub use phase_diagram::PhaseDiagram;
pub use sketch::Sketch;
pub use trajectory::{Moment, Spread, Trajectory};
pub use turning::TurnFinder;
