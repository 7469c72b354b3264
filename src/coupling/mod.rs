//! The bridge to rapier: the only place that reads and writes its bodies.

mod contact;
mod flight;
mod follow;
mod from_rapier;
mod handover;
mod immersion;
mod kind;
mod original;
mod playback;
pub mod preset;
mod readout;
mod step;
mod stream;
mod wing;

pub use follow::{FollowParams, Followed};
pub use immersion::{Immersion, Warning};
pub use playback::OnContact;
pub use step::RapierSets;
