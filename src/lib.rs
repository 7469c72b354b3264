//! Immersed rigid body dynamics for rapier3d.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod body;
mod coupling;
mod dynamics;
mod error;
mod file;
pub mod flow;
mod fluid;
pub mod geometry;
mod hydro;
mod math;
pub mod motion;
pub mod playback;
pub mod preset;
pub mod reduced;
pub mod training;
pub mod turbulence;

pub use body::{DryMass, ImmersedBody};
pub use coupling::{Immersion, OnContact, RapierSets, Warning};
pub use dynamics::{ForceAndTorque, ForceBreakdown, FreeBody, Integrator};
pub use error::Error;
pub use fluid::Fluid;
#[cfg(feature = "bake")]
pub use hydro::boundary_element;
pub use hydro::viscous::{
    Bounds, Coefficient, ForceFactors, PhysicalLaw, StochasticLaw, ThesisLaw, ViscousLaw,
};
pub use hydro::{Accuracy, AddedMass, HydroProperties, Planform, StokesResistance};
pub use rapier3d;

/// README's examples run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
