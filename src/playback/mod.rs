//! Bodies that follow synthesized falls (thesis chapter 3), and emitters that fill a scene with them.
//!
//! A [`MotionPath`](crate::motion::path::MotionPath) says where a body would be in free fall. A
//! [`MotionPlayer`] says which path a body follows, and how; [`MotionPlayers`] moves the bodies before each
//! step of rapier, and hands them to the force model when they touch something. An [`Emitter`] lets bodies
//! of both kinds into a world. What is too small to fall in a pattern, dust and fine snow, is a [`Suspension`]: particles that no
//! body of rapier stands for.
//!
//! ```
//! use rapier3d_immersed::motion::path::{SynthesisParams, Synthesizer, TrajectoryDatabase};
//! use rapier3d_immersed::motion::DimensionlessNumbers;
//! use rapier3d_immersed::playback::{MotionPlayer, MotionPlayers};
//! use rapier3d_immersed::rapier3d::prelude::*;
//! use rapier3d_immersed::{DryMass, Fluid, HydroProperties, Immersion, RapierSets};
//! use std::sync::Arc;
//!
//! let mut world = PhysicsWorld::new();
//! world.insert(RigidBodyBuilder::fixed(), ColliderBuilder::cuboid(5.0, 0.1, 5.0));
//! let collider = ColliderBuilder::cuboid(0.0365, 0.0005, 0.021).density(400.0);
//! let (leaf, _) = world.insert(RigidBodyBuilder::dynamic(), collider);
//! let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, leaf)?;
//! let mass = DryMass::of_body(&world.bodies, &world.colliders, leaf)?;
//!
//! // Offline: a fall from 2 m.
//! let numbers = DimensionlessNumbers::of(&hydro, &mass, &Fluid::AIR, 9.81)?;
//! let (database, params) = (TrajectoryDatabase::shipped(), SynthesisParams::default());
//! let path = Synthesizer::new(&numbers, 0.073, database, params)?.path(1);
//!
//! // At run time: the leaf plays it from 1.5 m, until it hits the floor and the force model takes over.
//! let player = MotionPlayer::new(Arc::new(path), Vector::Y * 1.5);
//! world.bodies[leaf].set_position(player.release(Vector::ZERO), true);
//! let (mut immersion, mut players) = (Immersion::new(Fluid::AIR), MotionPlayers::new());
//! immersion.insert(leaf, hydro);
//! players.play(leaf, &player)?;
//! for _ in 0..180 {
//!     players.before_step(&mut RapierSets::of(&mut world), Some(&mut immersion));
//!     immersion.step(&mut world);
//! }
//! assert!(players.is_empty());
//! assert!((world.bodies[leaf].translation().y - 0.1).abs() < 0.05);
//! # Ok::<(), rapier3d_immersed::Error>(())
//! ```

mod emitter;
mod particle;
mod player;
mod player_state;
mod players;
#[cfg(feature = "serde-serialize")]
mod snapshot;
mod suspension;

pub use emitter::{Emitter, EmitterParams};
pub use particle::Particle;
pub use player::{AtContact, Drive, MotionPlayer};
pub use players::{MotionPlayers, Playing};
pub use suspension::{Suspended, Suspension};
