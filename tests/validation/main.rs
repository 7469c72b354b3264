//! What must hold: one physical law or promise per module.

mod bluff;
mod changed;
mod changed_body;
mod colliders;
mod control;
mod determinism;
mod equivalence;
mod exact;
mod fidelity;
#[cfg(feature = "serde-serialize")]
mod fuzz;
mod held;
mod hull;
mod impact;
mod induced_drag;
mod kirchhoff;
mod lifecycle;
mod misuse;
mod moving_fluid;
mod parts;
mod passive;
mod plain;
mod published;
mod published_bars;
mod readout;
mod robustness;
mod scope;
mod shapes;
mod sleepers;
mod sphere;
mod static_polars;

mod support;
mod surface;
mod thesis_law;
mod trim;
mod turbulence;
