//! Equations of motion of one body, and their integrator.

#[cfg(test)]
mod designs;
pub mod forces;
pub mod free_body;
pub(crate) mod integrate;
pub(crate) mod kirchhoff;
mod symmetric;

pub use forces::{ForceAndTorque, ForceBreakdown};
pub use free_body::FreeBody;
pub use integrate::Integrator;
