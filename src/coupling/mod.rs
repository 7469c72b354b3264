//! The bridge to rapier: the only place that reads and writes its bodies.

mod contact;
mod flight;
mod from_rapier;
mod handover;
mod immersion;
mod kind;
mod original;
mod playback;
pub mod preset;
mod readout;
mod sketch;
mod step;

pub use immersion::{Immersion, Warning};
pub use playback::OnContact;
pub use sketch::{FollowParams, Followed, Sketch};
pub use step::RapierSets;
