//! What must hold: one physical law or promise per module.

mod equivalence;
mod impact;
mod kirchhoff;
mod lifecycle;
mod plain;
mod robustness;
mod sphere;
mod stream;
mod support;
