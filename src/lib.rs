//! Immersed rigid body dynamics for [rapier3d]: bodies that rapier holds fly through air and water, and go
//! on colliding, stacking and jointing through rapier.
//!
//! ```
//! use rapier3d_immersed::rapier3d::prelude::*;
//! use rapier3d_immersed::{Fluid, HydroProperties, Immersion};
//!
//! let mut world = PhysicsWorld::new();
//! let leaf = ColliderBuilder::cuboid(0.0365, 0.00015, 0.021).density(300.0);
//! let (leaf, _) = world.insert(RigidBodyBuilder::dynamic().rotation(Vector::X * 0.3), leaf);
//!
//! let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, leaf)?;
//! let mut immersion = Immersion::new(Fluid::AIR);
//! immersion.insert(leaf, hydro);
//! for _ in 0..60 {
//!     immersion.step(&mut world); // instead of `world.step()`
//! }
//! assert!(world.bodies[leaf].linvel().length() < 4.0); // after a second rapier alone has 9.8 m/s
//! # Ok::<(), rapier3d_immersed::Error>(())
//! ```
//!
//! # Where to find what
//!
//! | you want to | start at |
//! |---|---|
//! | see ten lines for a leaf, a coin, a frisbee, a boat, … | [`guide`] |
//! | let bodies of a rapier world fly | [`Immersion`], [`HydroProperties`], [`Fluid`] |
//! | do so where something else steps rapier | [`Immersion::before_step`], [`RapierSets`] |
//! | choose how the fluid pushes back | [`ImmersedBody`], [`ViscousLaw`] |
//! | know whether the default law is for a body | [`ImmersedBody::out_of_scope`], [`OutOfScope`], `docs/which-bodies.md` |
//! | know what a shape's added mass is | [`HydroProperties::added_mass`], [`Accuracy`], [`boundary_element`] |
//! | let the fluid move | [`flow`], [`turbulence`] |
//! | let bodies float, give water a surface with waves | [`Medium`], [`free_surface`], [`Immersion::hydrostatics`] |
//! | see every force on a body | [`Immersion::forces`]; `DebugRender` (feature `debug-render`) draws them |
//! | steer how a body falls | [`Immersion::set_control`], [`Immersion::replay`], [`training`] |
//! | fly one body without rapier, in f64 | [`FreeBody`] |
//! | name and classify motions | [`motion`] |
//! | put falls together from a motion graph | [`motion::path`], [`playback`] |
//! | stack bodies of centimeters | [`preset`] |
//! | replace a simulation by a formula | [`reduced`] |
//!
//! # The house
//!
//! Data runs one way: shape → surface ([`geometry`]) → [`HydroProperties`] → [`ImmersedBody`] → the equations
//! of motion ([`FreeBody`]) → rapier's bodies ([`Immersion`]). What is above a module may use it, never the
//! other way round:
//!
//! ```text
//! training   playback   debug_render   sweeps, plans, fits; bodies on synthesized paths; forces as lines
//!     coupling             Immersion: the bridge to rapier
//!    interning             equal values, stored once
//!      motion              patterns, phase diagram, codebooks, paths
//!     dynamics             Kirchhoff's equations, the integrator, FreeBody
//!   body   medium          ImmersedBody, DryMass; layers of fluid
//! hydro   turbulence       added mass, viscous laws; k–ε, Langevin
//! geometry  flow  free_surface  reduced   closed surfaces; velocity fields; waves; separated representations
//! math file fluid preset   scalars and lanes; sealed tables; density, viscosity; leaf-sized worlds
//!       error              the one error type
//! ```
//!
//! # Units and conventions
//!
//! SI units throughout; world axes are rapier's. *Plate axes* are those of a body's shape: x along its
//! longest, z along its shortest principal axis. What is computed once is computed in `f64`, what is stepped
//! in rapier's `Real`.
//!
//! Bad input is an [`Error`] that names the value, when something is built, baked or loaded. A step never
//! fails and never panics: what a user should know of it is a [`Warning`].
//!
//! # Features
//!
//! `parallel`, `serde-serialize` and `enhanced-determinism` mirror rapier's. `bake` adds the offline solvers
//! (boundary elements, flow solver, wind synthesis).
#![forbid(unsafe_code)]
#![warn(missing_docs)]
// Tests compare with the machine's own functions.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]
// On docs.rs, what needs a feature says so.
#![cfg_attr(docsrs, feature(doc_cfg))]

mod body;
mod coupling;
#[cfg(feature = "debug-render")]
mod debug_render;
mod dynamics;
mod error;
mod file;
pub mod flow;
mod fluid;
pub mod free_surface;
pub mod geometry;
#[cfg(any(doc, doctest))]
pub mod guide;
mod hydro;
mod interning;
mod math;
mod medium;
pub mod motion;
pub mod playback;
pub mod preset;
pub mod reduced;
pub mod training;
pub mod turbulence;

pub use body::{Division, DryMass, Hinge, ImmersedBody, Part, Propeller, Thruster};
pub use coupling::{BodyChanges, Immersion, OnContact, RapierSets, Warning};
#[cfg(feature = "debug-render")]
pub use debug_render::DebugRender;
pub use dynamics::{ForceAndTorque, ForceBreakdown, FreeBody, Hydrostatics, Integrator};
pub use error::Error;
pub use fluid::Fluid;
#[cfg(feature = "bake")]
pub use hydro::boundary_element;
pub use hydro::viscous::{
    Bounds, Coefficient, ForceFactors, PhysicalLaw, StochasticLaw, ThesisLaw, ViscousLaw,
};
pub use hydro::{
    Accuracy, AddedMass, AddedMassSource, BluffShape, CustomLaw, Damping, DragBox, Hull,
    HydroProperties, OutOfScope, PartLaw, PartMotion, Planform, PolarRow, PolarTable, SeparatedLaw,
    Solid, StokesResistance, Submerged, Waterplane,
};
pub use medium::{Layer, Medium};
pub use rapier3d;

/// The examples in the README run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
