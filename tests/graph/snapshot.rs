//! A saved scene of players and an emitter goes on bit by bit like the one that it was saved from; what
//! cannot be is refused when it is loaded.

use super::{leaf, up_to};
use rapier3d_immersed::flow::{Flow, Uniform};
use rapier3d_immersed::motion::Regime;
use rapier3d_immersed::motion::path::{MotionPath, WindResponse};
use rapier3d_immersed::playback::{
    AtContact, Drive, Emitter, EmitterParams, MotionPlayer, MotionPlayers,
};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion, RapierSets};
use serde_json::Value;
use std::sync::Arc;

struct Scene {
    world: PhysicsWorld,
    players: MotionPlayers,
    emitter: Emitter,
    immersion: Immersion,
}

impl Scene {
    /// Leaves of every drive and answer to contacts over a floor and a ball, and more from above.
    fn new() -> Self {
        let mut world = PhysicsWorld::new();
        world.insert(
            RigidBodyBuilder::fixed(),
            ColliderBuilder::cuboid(20.0, 0.1, 20.0).translation(Vector::Y * -0.1),
        );
        world.insert(
            RigidBodyBuilder::fixed().translation(Vector::Y * 0.5),
            ColliderBuilder::ball(0.2),
        );
        let synthesizer = leaf(up_to(Regime::PeriodicSpiral, 2.0));
        let paths: Vec<_> = (0..6)
            .map(|seed| Arc::new(synthesizer.path(seed)))
            .collect();
        let collider = ColliderBuilder::cuboid(0.0365, 0.001, 0.021).density(100.0);
        let hydro = HydroProperties::from_shape(collider.shape.as_ref()).unwrap();
        let mut players = MotionPlayers::new();
        let mut immersion = Immersion::new(Fluid::AIR);
        for i in 0..24 {
            let kinematic = i % 2 == 0;
            let player = MotionPlayer {
                heading: i as Real,
                drive: match kinematic {
                    true => Drive::Kinematic,
                    false => Drive::Velocity { compliance: 0.1 },
                },
                at_contact: [
                    AtContact::HandOver,
                    AtContact::Resume { after: 0.1 },
                    AtContact::Deflect,
                    AtContact::Ignore,
                ][i / 2 % 4],
                ..MotionPlayer::new(
                    paths[i % 6].clone(),
                    Vector::new(0.04 * (i as Real - 12.0), 1.2, 0.03 * (i % 5) as Real),
                )
            };
            let body = match kinematic {
                true => RigidBodyBuilder::kinematic_position_based(),
                false => RigidBodyBuilder::dynamic(),
            };
            let body = body.pose(player.release(Vector::ZERO));
            let (handle, _) = world.insert(body, collider.clone());
            players.play(handle, &player).unwrap();
            immersion.insert(handle, hydro.clone());
        }
        let params = EmitterParams {
            rate: 40.0,
            most: 60,
            played: 0.6,
            lifetime: 1.5,
            ..EmitterParams::default()
        };
        let body = RigidBodyBuilder::dynamic();
        let emitter = Emitter::new(params, body, collider, hydro, paths).unwrap();
        let mut scene = Self {
            world,
            players,
            emitter,
            immersion,
        };
        scene.blow();
        scene
    }

    /// The wind, which a snapshot does not hold.
    fn blow(&mut self) {
        let wind: Arc<dyn Flow> = Arc::new(Uniform::new(0.3, 0.0, 0.1));
        self.players
            .set_wind(Some((wind, WindResponse::default())))
            .unwrap();
    }

    fn step(&mut self, steps: usize) {
        for _ in 0..steps {
            self.emitter
                .before_step(&mut self.world, &mut self.players, &mut self.immersion);
            let sets = &mut RapierSets::of(&mut self.world);
            self.players.before_step(sets, Some(&mut self.immersion));
            self.immersion.step(&mut self.world);
        }
    }

    /// All of rapier's bodies.
    fn bits(&self) -> Vec<u32> {
        let bodies = self.world.bodies.iter().flat_map(|(handle, body)| {
            let (index, generation) = handle.into_raw_parts();
            let numbers = [
                body.translation().to_array().to_vec(),
                body.rotation().to_array().to_vec(),
                body.linvel().to_array().to_vec(),
                body.angvel().to_array().to_vec(),
            ];
            let numbers = numbers.concat().into_iter().map(f32::to_bits);
            let numbers: Vec<u32> = numbers.chain([index, generation]).collect();
            numbers
        });
        bodies.collect()
    }
}

/// Before the first step, in flight, while bodies meet the ball, and when most lie on the floor.
#[test]
fn a_restored_snapshot_goes_on_alike() {
    for steps in [0, 25, 60, 120] {
        let mut scene = Scene::new();
        scene.step(steps);
        let saved = postcard::to_stdvec(&(
            &scene.world,
            &scene.players,
            &scene.emitter,
            &scene.immersion,
        ));
        let (world, players, emitter, immersion) = postcard::from_bytes(&saved.unwrap()).unwrap();
        let mut restored = Scene {
            world,
            players,
            emitter,
            immersion,
        };
        restored.blow();
        assert_eq!(restored.bits(), scene.bits());
        scene.step(60);
        restored.step(60);
        assert_eq!(restored.players.len(), scene.players.len());
        assert_eq!(restored.bits(), scene.bits(), "saved after {steps} steps");
    }
}

/// The document with one value replaced; `at` is a path of keys and indices.
fn altered(document: &Value, at: &str, value: Value) -> Value {
    let mut document = document.clone();
    let place = document.pointer_mut(at);
    *place.unwrap_or_else(|| panic!("there is no {at}")) = value;
    document
}

fn refusal<T: serde::de::DeserializeOwned>(document: Value) -> String {
    match serde_json::from_value::<T>(document) {
        Ok(_) => panic!("should have been refused"),
        Err(error) => error.to_string(),
    }
}

/// Each fault by its name. (JSON has no NaN: a number too large for an f32 reads as infinity, and
/// postcard holds NaN as it is.)
#[test]
fn bad_players_are_refused() {
    let mut scene = Scene::new();
    scene.step(10);
    let good = serde_json::to_value(&scene.players).unwrap();
    assert!(serde_json::from_value::<MotionPlayers>(good.clone()).is_ok());
    for (at, value, says) in [
        ("/version", 1000.into(), "version 1000"),
        ("/time", (-1.0).into(), "time of the players"),
        ("/states/3/path", 99.into(), "path of a player"),
        ("/states/3/clock", (-0.5).into(), "clock"),
        ("/states/3/clock", 1e300.into(), "clock"),
        ("/states/3/origin/0", 1e300.into(), "origin"),
        ("/states/3/blown/1", 1e300.into(), "wind"),
        ("/states/3/turn/3", 7.0.into(), "turn"),
        ("/states/3/now/1/2", 7.0.into(), "attitude"),
        (
            "/states/3/drive/Velocity/compliance",
            (-1.0).into(),
            "compliance",
        ),
        ("/paths/0/keys/4/position/1", 1e300.into(), "key"),
        ("/paths/0/interval", 0.0.into(), "interval"),
        (
            "/states/3/handle",
            good["states"][4]["handle"].clone(),
            "only one",
        ),
    ] {
        let message = refusal::<MotionPlayers>(altered(&good, at, value));
        assert!(message.contains(says), "{at}: {message}");
    }
}

#[test]
fn bad_emitters_are_refused() {
    let mut scene = Scene::new();
    scene.step(40);
    let good = serde_json::to_value(&scene.emitter).unwrap();
    assert!(serde_json::from_value::<Emitter>(good.clone()).is_ok());
    for (at, value, says) in [
        ("/version", 0.into(), "version 0"),
        ("/params/rate", (-1.0).into(), "rate"),
        ("/params/played", 2.0.into(), "played"),
        ("/params/corners/0/1", 1e300.into(), "corners"),
        ("/due", 1.5.into(), "due"),
        ("/time", 0.0.into(), "emission"),
        ("/alive/0/0", (-1.0).into(), "emission"),
        ("/immersed/hydro/volume", 0.0.into(), "displaced volume"),
        ("/paths", Value::Array(Vec::new()), "paths"),
        ("/random", Value::Array(Vec::new()), "cannot be decoded"),
    ] {
        let message = refusal::<Emitter>(altered(&good, at, value));
        assert!(message.contains(says), "{at}: {message}");
    }
}

/// NaN, in postcard: every four bytes of a small snapshot in turn. What is still accepted plays without
/// a NaN in rapier.
#[test]
fn no_nan_gets_in() {
    let key = |y: Real| rapier3d_immersed::motion::path::Key {
        position: Vector::Y * y,
        velocity: -Vector::Y,
        attitude: Rotation::IDENTITY,
    };
    let regimes = vec![(0.0, Regime::SteadyDescent)];
    let path = MotionPath::new(2.0, vec![key(0.0), key(-2.0)], regimes).unwrap();
    let player = MotionPlayer::new(Arc::new(path), Vector::Y);
    let world = || {
        let mut world = PhysicsWorld::new();
        let body = RigidBodyBuilder::dynamic().pose(player.release(Vector::ZERO));
        let (body, _) = world.insert(body, ColliderBuilder::ball(0.1));
        (world, body)
    };
    let (_, body) = world();
    let mut players = MotionPlayers::new();
    players.play(body, &player).unwrap();
    let bytes = postcard::to_stdvec(&players).unwrap();
    let (mut refused, mut accepted) = (0, 0);
    for at in 0..bytes.len() - 3 {
        let mut bad = bytes.clone();
        bad[at..at + 4].copy_from_slice(&f32::NAN.to_le_bytes());
        let Ok(mut players) = postcard::from_bytes::<MotionPlayers>(&bad) else {
            refused += 1;
            continue;
        };
        accepted += 1;
        let (mut world, _) = world();
        for _ in 0..5 {
            players.before_step(&mut RapierSets::of(&mut world), None);
            world.step();
        }
        assert!(world.bodies[body].translation().is_finite(), "byte {at}");
    }
    println!("refused {refused}, accepted {accepted}");
    // The path has 23 numbers (two keys, interval twice, regime), the player 23.
    assert!(refused >= 46);
}
