//! Turbulence that a body feels but no grid resolves (thesis chapter 4).
//!
//! A k–ε model says how strong the turbulence is ([`TurbulenceState`]): baked into a
//! [`TurbulenceTable`], in closed form, or of the surface layer ([`Turbulence`]). A Langevin process
//! turns that into the fluctuating velocity that one body sees ([`SeenFluctuation`]), driven by a
//! random stream of its own ([`NoiseStream`]).

#[cfg(feature = "bake")]
pub mod grid;
mod k_epsilon;
mod langevin;
mod noise;
mod source;
mod table;

pub use k_epsilon::{KEpsilon, TurbulenceState};
pub use langevin::{SeenFluctuation, kolmogorov_constant, relative_velocity_after, spin_increment};
pub use noise::NoiseStream;
pub use source::Turbulence;
pub use table::{TurbulenceField, TurbulenceTable};
