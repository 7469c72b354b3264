//! The bridge to rapier: the only place that reads and writes its bodies.

mod boarding;
mod contact;
mod emitter;
mod flight;
mod follow;
mod from_rapier;
mod handover;
mod immersion;
mod kind;
mod membership;
mod original;
mod playback;
mod played;
mod player;
mod players;
pub mod preset;
mod readout;
mod scratch;
mod sets;
mod slot;
#[cfg(feature = "serde-serialize")]
mod snapshot;
mod step;
mod stir;
mod stream;
mod warning;
mod wing;

pub use emitter::{Emitter, EmitterParams};
pub use follow::{FollowParams, Followed};
pub use immersion::Immersion;
pub use playback::OnContact;
pub use player::{AtContact, Drive, MotionPlayer};
pub use players::{MotionPlayers, Playing};
pub use sets::RapierSets;
pub use warning::Warning;
