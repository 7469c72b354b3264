//! Training: numerical experiments over a body's coefficients, and what pattern each shows (thesis
//! § 5.4).
//!
//! An [`Experiment`] drops a body; a [`Sweep`] drops it at every node of a [`Grid`] of parameters and is
//! refined where neighbours disagree; [`Subspaces`] answer which pattern a point belongs to.
//! [`Clusters`] are the thesis's own classification, beside the direct
//! [`Classifier`](crate::motion::Classifier).

pub mod cluster;
pub mod energy;
pub mod experiment;
#[cfg(feature = "serde-serialize")]
mod file;
pub mod grid;
pub mod planner;
pub mod subspace;
pub mod sweep;

pub use cluster::Clusters;
pub use energy::{ControlBox, EnergyObjective};
pub use experiment::{Experiment, Release, thin_ellipsoid};
pub use grid::{Axis, Grid};
pub use planner::{DwellReport, Plan, Planner, PlannerParams};
pub use subspace::Subspaces;
pub use sweep::{Sample, Sweep};
