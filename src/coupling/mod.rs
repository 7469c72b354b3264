//! The bridge to rapier: the only place that reads and writes its bodies.

mod contact;
mod flight;
mod from_rapier;
mod handover;
mod immersion;
mod kind;
mod original;
pub mod preset;
mod readout;
mod step;
mod wing;

pub use immersion::{Immersion, Warning};
pub use step::RapierSets;
