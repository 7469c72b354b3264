//! Snapshots of players and emitters: how they are written, and which are refused when they are read.

use super::emitter::{Emitter, EmitterParams};
use super::player::{AtContact, Drive, FARTHEST};
use super::player_state::{Deflection, PlayerState};
use super::players::MotionPlayers;
use crate::body::ImmersedBody;
use crate::error::Error;
use crate::motion::path::MotionPath;
use rand_pcg::Pcg64Mcg;
use rapier3d::dynamics::{RigidBody, RigidBodyHandle};
use rapier3d::geometry::ColliderBuilder;
use rapier3d::math::{Real, Rotation, Vector};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::HashMap;
use std::sync::Arc;

const VERSION: u32 = 5;

fn check_version(file: &'static str, found: u32) -> Result<(), Error> {
    if found == VERSION {
        return Ok(());
    }
    Err(Error::UnsupportedFileVersion {
        file,
        found,
        supported: VERSION,
    })
}

fn check_vector(what: &'static str, vector: Vector) -> Result<(), Error> {
    Error::check_all_within(what, &vector.to_array().map(f64::from), FARTHEST)
}

fn check_rotation(what: &'static str, rotation: Rotation) -> Result<(), Error> {
    let norm = f64::from(rotation.length());
    Error::check(what, norm, (norm - 1.0).abs() < 1e-3, "of norm 1").map(|_| ())
}

/// A snapshot of players, in which shared paths are written once. `P` is [`MotionPath`] or a reference to
/// one.
#[derive(Serialize, Deserialize)]
struct PlayersSnapshot<P> {
    version: u32,
    time: f64,
    paths: Vec<P>,
    states: Vec<PlayerSnapshot>,
}

#[derive(Serialize, Deserialize)]
struct PlayerSnapshot {
    handle: RigidBodyHandle,
    /// Index of the path.
    path: u32,
    origin: Vector,
    turn: Rotation,
    to_plate: Rotation,
    drive: Drive,
    at_contact: AtContact,
    clock: Real,
    /// `None` if nothing has touched it, because not every format has infinity.
    free: Option<Real>,
    waiting: bool,
    taken: bool,
    watched: bool,
    blown: Vector,
    deflection: Option<[Vector; 2]>,
    now: (Vector, Rotation),
}

impl Serialize for MotionPlayers {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut paths: Vec<&MotionPath> = Vec::new();
        let mut known = HashMap::new();
        let states = self.states.iter().map(|state| {
            let path = *known.entry(Arc::as_ptr(&state.path)).or_insert_with(|| {
                paths.push(&state.path);
                paths.len() as u32 - 1
            });
            PlayerSnapshot {
                handle: state.handle,
                path,
                origin: state.origin,
                turn: state.turn,
                to_plate: state.to_plate,
                drive: state.drive,
                at_contact: state.at_contact,
                clock: state.clock,
                free: state.free.is_finite().then_some(state.free),
                waiting: state.waiting,
                taken: state.taken,
                watched: state.watched,
                blown: state.blown,
                deflection: state.deflection.map(|d| [d.rotation, d.velocity]),
                now: state.now,
            }
        });
        let states = states.collect();
        let snapshot = PlayersSnapshot {
            version: VERSION,
            time: self.time,
            paths,
            states,
        };
        snapshot.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for MotionPlayers {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let snapshot = PlayersSnapshot::<MotionPath>::deserialize(deserializer)?;
        Self::try_from(snapshot).map_err(D::Error::custom)
    }
}

impl PlayerSnapshot {
    fn check(&self) -> Result<(), Error> {
        check_vector("origin", self.origin)?;
        check_vector("velocity of a played body from the wind", self.blown)?;
        check_vector("place of a played body", self.now.0)?;
        check_rotation("turn of a path", self.turn)?;
        check_rotation("axes of a played body", self.to_plate)?;
        check_rotation("attitude of a played body", self.now.1)?;
        for part in self.deflection.into_iter().flatten() {
            check_vector("deflection of a played body", part)?;
        }
        self.drive.check()?;
        self.at_contact.check()?;
        Error::check_not_negative("clock of a player", self.clock.into())?;
        if let Some(free) = self.free {
            Error::check_not_negative("time since a contact", free.into())?;
        }
        Ok(())
    }
}

impl TryFrom<PlayersSnapshot<MotionPath>> for MotionPlayers {
    type Error = Error;

    fn try_from(snapshot: PlayersSnapshot<MotionPath>) -> Result<Self, Error> {
        check_version("motion players", snapshot.version)?;
        let time = Error::check_not_negative("time of the players", snapshot.time)?;
        let paths: Vec<_> = snapshot.paths.into_iter().map(Arc::new).collect();
        let mut players = Self::default();
        players.time = time;
        for (index, state) in snapshot.states.into_iter().enumerate() {
            state.check()?;
            let path = paths.get(state.path as usize).ok_or(Error::OutOfRange {
                parameter: "path of a player",
                low: 0.0,
                high: paths.len() as f64 - 1.0,
                value: f64::from(state.path),
            })?;
            let before = players.lookup.insert(state.handle, index as u32);
            let once = before.is_none();
            Error::check("player", index as f64, once, "the only one of its body")?;
            players.states.push(PlayerState {
                handle: state.handle,
                path: path.clone(),
                origin: state.origin,
                turn: state.turn,
                to_plate: state.to_plate,
                drive: state.drive,
                at_contact: state.at_contact,
                clock: state.clock,
                free: state.free.unwrap_or(Real::INFINITY),
                waiting: state.waiting,
                taken: state.taken,
                watched: state.watched,
                blown: state.blown,
                deflection: state
                    .deflection
                    .map(|[rotation, velocity]| Deflection { rotation, velocity }),
                now: state.now,
            });
        }
        Ok(players)
    }
}

/// A snapshot of an emitter, with `P` as for players.
#[derive(Serialize, Deserialize)]
struct EmitterSnapshot<P> {
    version: u32,
    params: EmitterParams,
    body: RigidBody,
    collider: ColliderBuilder,
    immersed: ImmersedBody,
    paths: Vec<P>,
    /// The generator in postcard's encoding: its 128 bits are too many for JSON.
    random: Vec<u8>,
    due: Real,
    time: f64,
    alive: Vec<(f64, RigidBodyHandle)>,
}

fn generator(bytes: &[u8]) -> Result<Pcg64Mcg, Error> {
    match postcard::take_from_bytes(bytes) {
        Ok((generator, [])) => Ok(generator),
        _ => Err(Error::UndecodableFile {
            file: "emitter",
            length: bytes.len(),
        }),
    }
}

impl Serialize for Emitter {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let snapshot = EmitterSnapshot {
            version: VERSION,
            params: self.params,
            body: self.body.clone(),
            collider: self.collider.clone(),
            immersed: self.immersed.clone(),
            paths: self.paths.iter().map(Arc::as_ref).collect(),
            random: postcard::to_stdvec(&self.random).expect("a number always encodes"),
            due: self.due,
            time: self.time,
            alive: self.alive.iter().copied().collect(),
        };
        snapshot.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Emitter {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let snapshot = EmitterSnapshot::<MotionPath>::deserialize(deserializer)?;
        Self::try_from(snapshot).map_err(D::Error::custom)
    }
}

impl TryFrom<EmitterSnapshot<MotionPath>> for Emitter {
    type Error = Error;

    fn try_from(snapshot: EmitterSnapshot<MotionPath>) -> Result<Self, Error> {
        check_version("emitter", snapshot.version)?;
        let time = Error::check_not_negative("time of the emitter", snapshot.time)?;
        let due = f64::from(snapshot.due);
        Error::check_range("bodies that are due", due, 0.0, 1.0)?;
        let mut last = 0.0;
        for (born, _) in &snapshot.alive {
            last = Error::check_range("time of an emission", *born, last, time)?;
        }
        let body = &snapshot.body;
        let place = body.translation();
        for vector in [
            place,
            body.linvel(),
            body.angvel(),
            body.user_force(),
            body.user_torque(),
        ] {
            check_vector("state of an emitted body", vector)?;
        }
        let colliders = snapshot.body.colliders().len();
        Error::check_length("colliders of an emitter's body", 0, colliders)?;
        let paths = snapshot.paths.into_iter().map(Arc::new).collect();
        let mut emitter = Self::of(
            snapshot.params,
            snapshot.body,
            snapshot.collider,
            snapshot.immersed,
            paths,
        )?;
        emitter.random = generator(&snapshot.random)?;
        emitter.due = snapshot.due;
        emitter.time = time;
        emitter.alive = snapshot.alive.into();
        Ok(emitter)
    }
}
