#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod body;
pub mod coupling;
pub mod dynamics;
pub mod error;
mod file;
pub mod flow;
pub mod fluid;
pub mod geometry;
pub mod hydro;
mod math;
pub mod motion;
pub mod reduced;
pub mod training;
pub mod turbulence;

pub use body::{DryMass, ImmersedBody};
pub use coupling::{Immersion, OnContact, RapierSets, Warning, preset};
pub use dynamics::{ForceAndTorque, ForceBreakdown, FreeBody, Integrator};
pub use error::Error;
pub use fluid::Fluid;
pub use hydro::{Accuracy, HydroProperties, PhysicalLaw, StochasticLaw, ThesisLaw, ViscousLaw};
pub use rapier3d;
