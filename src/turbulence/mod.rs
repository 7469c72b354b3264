//! Turbulence that a body feels but no grid resolves (thesis chapter 4).
//!
//! A k–ε model says how strong the turbulence is ([`TurbulenceState`]): baked into a
//! [`TurbulenceTable`], in closed form, or of the surface layer ([`Turbulence`]). A Langevin process
//! turns that into the fluctuating velocity that one body sees ([`SeenFluctuation`]), driven by a
//! random stream of its own ([`NoiseStream`]).

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
pub(crate) use langevin::{Eddies, pass};
pub use langevin::{SeenFluctuation, kolmogorov_constant, relative_velocity_after, spin_increment};
pub use noise::NoiseStream;
pub(crate) use noise::gaussian;
pub use source::{LangevinMode, Turbulence, TurbulentLayer};
pub use table::{TurbulenceField, TurbulenceTable};
