//! Training: numerical experiments over a body's coefficients, and what pattern each shows (thesis
//! § 5.4).
//!
//! In the order of use: an [`Experiment`] drops a body; a [`Sweep`] drops it at every node of a [`Grid`] of
//! parameters (the law's factors, or release, mass and wind as [`Parameter`]s) and is refined where neighbours
//! disagree; [`Subspaces`] answer which pattern a point belongs to, by the direct [`Classifier`](crate::motion::Classifier) or by [`Clusters`], the thesis's own
//! classification. A [`Planner`] makes series of force factors from them, which a body in rapier replays
//! ([`Immersion::replay`](crate::Immersion::replay)). A [`Sketch`](crate::motion::Sketch) that is followed
//! ([`Sketch::follow`](crate::motion::Sketch::follow)) needs an experiment only; a [`SketchFollower`] does so among
//! the winds, obstacles and other bodies of a world. Apart from these,
//! [`fidelity`] compares laws with measured falls, [`FallStatistics`] say what a fall amounts to, and
//! [`BodyInWorld`] is one body in a rapier world.
//!
//! ```
//! use rapier3d_immersed::motion::{Classifier, MotionGraph, Pattern};
//! use rapier3d_immersed::rapier3d::prelude::*;
//! use rapier3d_immersed::training::{Experiment, Grid, Planner, PlannerParams, Subspaces, Sweep};
//! use rapier3d_immersed::{DryMass, Fluid, HydroProperties, Immersion, OnContact};
//! use std::ops::ControlFlow;
//!
//! # fn main() -> Result<(), rapier3d_immersed::Error> {
//! let mut world = PhysicsWorld::new();
//! world.integration_parameters.dt = 1.0 / 120.0;
//! let (leaf, _) = world.insert(
//!     RigidBodyBuilder::dynamic().translation(Vector::Y * 3.0),
//!     ColliderBuilder::cuboid(0.0365, 0.00015, 0.021).density(400.0),
//! );
//! let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, leaf)?;
//! let mass = DryMass::of_body(&world.bodies, &world.colliders, leaf)?;
//!
//! // Offline: what does the leaf do for which coefficients? (4³ falls; 9³ take half a second.)
//! let mut experiment = Experiment::new(hydro.clone(), mass, Fluid::AIR);
//! experiment.release.tilt_axis = 80f64.to_radians();
//! let mut sweep = Sweep::new(Grid::of_coefficients(4, 3.0)?);
//! let classifier = Classifier::default();
//! sweep.run_coefficients(&experiment, &classifier, |_, _| ControlFlow::Continue(()))?;
//! let subspaces = Subspaces::new(sweep.grid().clone(), sweep.patterns()?)?;
//!
//! // "Flutter, then tumble."
//! let graph = MotionGraph::thesis();
//! let planner = Planner::new(experiment.clone(), subspaces, &graph, PlannerParams::default())?;
//! let plan = planner.plan_sequence(&[Pattern::Zigzag, Pattern::Autorotation], 1)?;
//!
//! // At run time.
//! world.bodies[leaf].set_rotation(experiment.release.rotation(&hydro), true);
//! let mut immersion = Immersion::new(Fluid::AIR);
//! immersion.insert(leaf, hydro);
//! immersion.replay(leaf, &plan.series, OnContact::Restart);
//! for _ in 0..60 {
//!     immersion.step(&mut world);
//! }
//! assert_eq!(immersion.control(leaf), Some(plan.series.at(59.5 / 120.0)));
//! # Ok(())
//! # }
//! ```
//!
//! Everything here is offline work; with the feature `bake` it uses all cores.

mod cluster;
mod energy;
mod experiment;
mod fall_statistics;
pub mod fidelity;
#[cfg(feature = "serde-serialize")]
mod file;
mod followed;
mod follower;
mod grid;
mod in_world;
mod parameter;
mod plan;
mod planner;
mod sketch_control;
mod subspace;
mod sweep;

pub use cluster::{Clusters, Features};
pub use energy::{ControlBox, EnergyObjective};
pub use experiment::{Experiment, Release, thin_ellipsoid};
pub use fall_statistics::FallStatistics;
pub use followed::{FollowParams, Followed};
pub use follower::SketchFollower;
pub use grid::{Axis, Grid};
pub use in_world::{BodyInWorld, BodyState};
pub use parameter::Parameter;
pub use plan::{DwellReport, Plan, PlannerParams};
pub use planner::Planner;
pub use subspace::Subspaces;
pub use sweep::{Sample, Sweep};
