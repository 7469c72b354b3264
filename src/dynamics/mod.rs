//! Equations of motion of one body, and their integrator.

pub(crate) mod constants;
pub(crate) mod crossing;
#[cfg(test)]
mod designs;
pub(crate) mod flow_response;
pub(crate) mod forces;
mod free_body;
pub(crate) mod gravity_step;
pub(crate) mod integrate;
mod integrator;
mod kirchhoff;
pub(crate) mod load;
pub(crate) mod locked;
pub(crate) mod part_constants;
pub(crate) mod parts;
pub(crate) mod reaction;
mod symmetric;

pub use crossing::Hydrostatics;
pub use forces::{ForceAndTorque, ForceBreakdown};
pub use free_body::FreeBody;
pub use integrator::Integrator;
