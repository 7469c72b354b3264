//! The bridge to rapier: the only place that lets the fluid act on its bodies.
//!
//! ```text
//! Immersion (façade) ──► registry ──► body_state        which bodies, and what is kept of each
//!     │                  shared_constants               what equal bodies share
//!     │                  environment, control           the fluid; factors on forces
//!     ├──► admission ──► saved_properties, body_look    bodies enter and leave the fluid
//!     ├──► body_changes                                 what users change of a body in the fluid
//!     ├──► readout, impulse                             forces on one body; pushes at body and fluid
//!     ├──► fluids, replay                               the fluid, and factors on forces, as users set them
//!     ├──► parts ──► equipment                          parts, thrusters and volume, set in flight
//!     ├──► rapier_sets, warning, snapshot               what users hand in, are told, and may save
//!     └──► step::driver                                 prepare → sample → integrate → write back
//! ```

mod admission;
mod body_changes;
mod body_look;
mod body_mass;
mod body_state;
mod control;
mod crossing_memory;
mod environment;
mod equipment;
mod fluids;
mod immersion;
mod impulse;
mod parts;
mod principal_mass;
mod rapier_sets;
mod readout;
mod registry;
mod replay;
mod saved_properties;
mod shared_constants;
#[cfg(feature = "serde-serialize")]
mod snapshot;
mod step;
mod surface_readout;
mod turbulence_memory;
mod warning;

pub use body_look::BodyChanges;
pub use control::OnContact;
pub use immersion::Immersion;
pub use rapier_sets::RapierSets;
pub use warning::Warning;
