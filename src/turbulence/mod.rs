//! Turbulence that a body feels but no grid resolves (thesis chapter 4).
//!
//! A k–ε model says how strong the turbulence is ([`TurbulenceState`]). A [`Turbulence`] is where that
//! comes from: it is the same everywhere, decays, belongs to the surface layer under a wind, or was baked
//! into a [`TurbulenceTable`]. Given to [`Immersion::set_turbulence`](crate::Immersion::set_turbulence),
//! alone or with a mode and a seed as a [`TurbulentLayer`], it acts on every immersed body, and nothing
//! else of this module is needed.
//!
//! Below that, a Langevin process turns the strength into the fluctuating velocity that one body sees
//! ([`SeenFluctuation`]), driven by a random stream of the body's own ([`NoiseStream`]). With the feature
//! `bake`, `TurbulenceTable::bake` computes a table from `TurbulenceParams`: it runs a flow on a grid (module
//! `grid`) and the k–ε model on it (`KEpsilonGrid`).
//!
//! ```
//! use rapier3d_immersed::flow::LogLaw;
//! use rapier3d_immersed::rapier3d::prelude::*;
//! use rapier3d_immersed::turbulence::{LangevinMode, Turbulence, TurbulentLayer};
//! use rapier3d_immersed::{Fluid, Immersion};
//!
//! // Wind over rough ground, and the turbulence that belongs to it.
//! let wind = LogLaw::new(Vector::X, Vector::Y, 4.0, 10.0, 0.3)?;
//! let turbulence = Turbulence::SurfaceLayer(wind);
//! let state = turbulence.at(Vector::Y * 2.0, 0.0, 0.0);
//! assert!((state.deviation() - 0.68).abs() < 0.01); // m/s, 1.49 times the friction velocity
//!
//! let mut immersion = Immersion::new(Fluid::AIR);
//! immersion.set_flow(wind);
//! immersion.set_turbulence(TurbulentLayer { source: turbulence, mode: LangevinMode::default(), seed: 7 });
//! # Ok::<(), rapier3d_immersed::Error>(())
//! ```

#[cfg(feature = "bake")]
mod bake;
#[cfg(feature = "bake")]
pub mod grid;
mod k_epsilon;
#[cfg(feature = "bake")]
mod k_epsilon_grid;
mod langevin;
mod noise;
mod source;
mod table;

#[cfg(feature = "bake")]
pub use bake::{BakeReport, BakeSample, ShearSource, TurbulenceParams};
pub use k_epsilon::{KEpsilon, TurbulenceState};
#[cfg(feature = "bake")]
pub use k_epsilon_grid::KEpsilonGrid;
pub(crate) use langevin::{Eddies, decay, pass};
pub use langevin::{SeenFluctuation, kolmogorov_constant, relative_velocity_after, spin_increment};
pub use noise::NoiseStream;
pub(crate) use noise::gaussian;
pub use source::{LangevinMode, Turbulence, TurbulentLayer};
pub use table::{TurbulenceField, TurbulenceTable};
