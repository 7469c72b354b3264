//! Motion patterns: their names, how to tell them apart, and how they follow each other (thesis
//! chapters 3 and 5). [`path`] puts falls together from segments.

mod classify;
mod codebook;
mod graph;
mod numbers;
pub mod path;
mod pattern;
mod phase_diagram;
mod sketch;
mod trajectory;
mod turning;

pub use classify::{Classifier, Observation};
pub use codebook::{Codebook, ControlSeries, Dwell};
pub use graph::MotionGraph;
pub use numbers::{DimensionlessNumbers, Outline};
pub use pattern::{Pattern, Regime, UnknownPattern};
pub use phase_diagram::{Boundary, Case, PhaseDiagram};
pub use sketch::Sketch;
pub use trajectory::{Moment, Spread, Trajectory};
pub use turning::{TurnFinder, curvature};
