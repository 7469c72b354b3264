//! The bridge to rapier: the only place that reads and writes its bodies.

mod contact;
mod emitter;
mod flight;
mod follow;
mod from_rapier;
mod handover;
mod immersion;
mod kind;
mod original;
mod playback;
mod played;
mod player;
mod players;
pub mod preset;
mod readout;
#[cfg(feature = "serde-serialize")]
mod snapshot;
mod step;
mod stir;
mod stream;
mod wing;

pub use emitter::{Emitter, EmitterParams};
pub use follow::{FollowParams, Followed};
pub use immersion::{Immersion, Warning};
pub use playback::OnContact;
pub use player::{AtContact, Drive, MotionPlayer};
pub use players::{MotionPlayers, Playing};
pub use step::RapierSets;
