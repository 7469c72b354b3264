//! Bodies that follow synthesized falls (thesis chapter 3), and emitters that fill a scene with them.
//!
//! A [`MotionPath`](crate::motion::path::MotionPath) says where a body would be in free fall. A
//! [`MotionPlayer`] says which path a body follows, and how; [`MotionPlayers`] moves the bodies before each
//! step of rapier, and hands them to the force model when they touch something. An [`Emitter`] lets bodies
//! of both kinds into a world.

mod emitter;
mod player;
mod player_state;
mod players;
#[cfg(feature = "serde-serialize")]
mod snapshot;

pub use emitter::{Emitter, EmitterParams};
pub use player::{AtContact, Drive, MotionPlayer};
pub use players::{MotionPlayers, Playing};
