//! What must hold: one physical law or promise per module.

mod equivalence;
mod kirchhoff;
mod sphere;
mod support;
