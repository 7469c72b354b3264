//! One step: four stages one after another, over batches of bodies that take the same [`Route`].
//!
//! ```text
//! prepare ──► sample_fluid (turbulence) ──► integrate (lane_group, substep_matching) ──► write_back
//! ```
//!
//! [`driver`] fills the batches and runs the stages; no stage calls another. What passes between them is in
//! [`stage_data`], the memory for it in [`workspace`].
//!
//! [`Route`]: super::shared_constants::Route

mod constraint_impulse;
mod contact_mass;
mod crossing;
pub(super) mod driver;
mod energy_budget;
mod friction;
mod held_motion;
mod integrate;
mod jointed_systems;
mod lane_group;
mod locked_axes;
mod mean_motion;
mod prepare;
mod sample_fluid;
mod stage_data;
mod substep_matching;
#[cfg(test)]
mod tests;
mod turbulence;
pub(super) mod workspace;
mod write_back;
