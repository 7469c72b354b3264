//! Motion patterns: their names, how to tell them apart, and how they follow each other (thesis
//! chapters 3 and 5).
//!
//! Before a body falls, [`DimensionlessNumbers`] place it on the [`PhaseDiagram`], which says in which
//! [`Regime`] it will fall. After it has fallen, a [`Classifier`] says what its [`Trajectory`] shows.
//!
//! Falls can be directed in two ways. Either forces move the body and a [`ControlSeries`] changes them so
//! that a planned [`Pattern`] or a [`Sketch`] is followed: [`training`](crate::training) makes such series, a
//! [`Codebook`] keeps them, and [`Immersion::replay`](crate::Immersion::replay) plays them. Or falls are put
//! together from segments without forces: that is the module [`path`], whose falls
//! [`playback`](crate::playback) plays. A [`MotionGraph`] says what follows what in both.
//!
//! ```
//! use rapier3d_immersed::motion::{DimensionlessNumbers, PhaseDiagram, Regime};
//! use rapier3d_immersed::rapier3d::prelude::*;
//! use rapier3d_immersed::{DryMass, Fluid, HydroProperties};
//!
//! let mut world = PhysicsWorld::new();
//! let coin = ColliderBuilder::cylinder(0.0008, 0.01).density(7000.0);
//! let (coin, _) = world.insert(RigidBodyBuilder::dynamic(), coin);
//! let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, coin)?;
//! let mass = DryMass::of_body(&world.bodies, &world.colliders, coin)?;
//! let numbers = DimensionlessNumbers::of(&hydro, &mass, &Fluid::WATER, 9.81)?;
//! // A coin that sinks flutters from side to side.
//! assert_eq!(PhaseDiagram::default().regime_of(&numbers), Regime::TransitionalChaotic);
//! # Ok::<(), rapier3d_immersed::Error>(())
//! ```

mod classify;
mod codebook;
mod estimates;
mod graph;
mod helix;
mod numbers;
pub mod path;
mod pattern;
mod phase_diagram;
mod planned_for;
mod sketch;
mod sketch_csv;
mod trajectory;
mod turning;

pub use classify::{Classifier, Observation};
pub use codebook::{Codebook, ControlSeries, Dwell};
pub use estimates::{Estimate, EstimateSource, FallEstimates};
pub use graph::MotionGraph;
pub use helix::HelixFit;
pub use numbers::{DimensionlessNumbers, Outline};
pub use pattern::{Pattern, Regime, UnknownPattern};
pub use phase_diagram::{Boundary, Case, PhaseDiagram};
pub use planned_for::PlannedFor;
pub use sketch::Sketch;
pub use trajectory::{AttitudeSpread, Moment, Spread, Trajectory};
pub use turning::TurnFinder;
