//! What must hold: one physical law or promise per module.

mod control;
mod determinism;
mod equivalence;
mod fidelity;
mod held;
mod impact;
mod kirchhoff;
mod lifecycle;
mod plain;
mod published;
mod published_bars;
mod readout;
mod robustness;
mod shapes;
mod sphere;
mod stream;
mod support;
mod thesis_law;
mod turbulence;
mod wing;
