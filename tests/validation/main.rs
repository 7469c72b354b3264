//! What must hold: one physical law or promise per module.

mod control;
mod determinism;
mod equivalence;
mod fidelity;
mod impact;
mod kirchhoff;
mod lifecycle;
mod plain;
mod readout;
mod robustness;
#[path = "../../examples/support/seed.rs"]
mod seed;
mod shapes;
mod sphere;
mod stream;
mod support;
mod thesis_law;
mod turbulence;
mod wing;
