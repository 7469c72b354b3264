//! Whatever stands in a snapshot, loading it either refuses it or gives something that steps on without
//! panic, hang or NaN: every byte is changed in several ways, and every truncation is tried.

use rapier3d_immersed::motion::path::{Key, MotionPath};
use rapier3d_immersed::motion::{ControlSeries, MotionGraph, Regime};
use rapier3d_immersed::playback::{Emitter, EmitterParams, MotionPlayer, MotionPlayers};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::turbulence::{Turbulence, TurbulenceState};
use rapier3d_immersed::{
    Fluid, ForceFactors, HydroProperties, ImmersedBody, Immersion, OnContact, RapierSets,
    ThesisLaw, ViscousLaw,
};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::sync::Arc;

/// Loads what is left of `value` after each change of its bytes, and lets `check` use it. The number that
/// was refused, and that was loaded.
pub fn fuzz<T: Serialize + DeserializeOwned>(value: &T, check: impl Fn(T)) -> (usize, usize) {
    let good = postcard::to_stdvec(value).unwrap();
    check(postcard::from_bytes(&good).unwrap());
    let (mut refused, mut loaded) = (0, 0);
    let mut load = |bytes: &[u8]| match postcard::from_bytes::<T>(bytes) {
        Ok(value) => {
            loaded += 1;
            check(value);
        }
        Err(_) => refused += 1,
    };
    for at in 0..good.len() {
        load(&good[..at]);
        let byte = good[at];
        for other in [0, 0x7f, 0xff, byte ^ 1, byte ^ 0x40, byte ^ 0x80] {
            let mut bad = good.clone();
            bad[at] = other;
            load(&bad);
        }
    }
    (refused, loaded)
}

fn leaf() -> ColliderBuilder {
    ColliderBuilder::cuboid(0.0365, 0.000_15, 0.021).density(300.0)
}

pub fn assert_finite(world: &PhysicsWorld) {
    for (_, body) in world.bodies.iter() {
        let numbers = [body.translation(), body.linvel(), body.angvel()];
        assert!(numbers.iter().all(|v| v.is_finite()), "{body:?}");
    }
}

#[test]
fn immersions() {
    let mut world = PhysicsWorld::new();
    let floor = ColliderBuilder::cuboid(10.0, 0.1, 10.0).translation(Vector::Y * -0.15);
    world.insert(RigidBodyBuilder::fixed(), floor);
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.set_turbulence(Turbulence::Homogeneous(TurbulenceState {
        kinetic_energy: 0.1,
        dissipation: 0.1,
    }));
    let mut handles = Vec::new();
    for (i, height) in [0.0, 1.0, 2.0].into_iter().enumerate() {
        let body = RigidBodyBuilder::dynamic().translation(Vector::new(i as Real, height, 0.0));
        let (handle, _) = world.insert(body.rotation(Vector::X * 0.3), leaf());
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
        let law = ViscousLaw::Thesis(ThesisLaw::new(ThesisLaw::ZIGZAG));
        let body = ImmersedBody::new(hydro);
        let body = if i == 1 {
            body.with_law(law).unwrap()
        } else {
            body
        };
        immersion.insert(handle, body);
        handles.push(handle);
    }
    let series = ControlSeries::new(0.1, vec![ForceFactors::ONE; 3], Vec::new()).unwrap();
    immersion.replay(handles[2], &series, OnContact::Restart);
    (0..20).for_each(|_| immersion.step(&mut world));
    world.remove_body(handles[1]);
    (0..20).for_each(|_| immersion.step(&mut world));
    let scene = postcard::to_stdvec(&world).unwrap();
    let (refused, loaded) = fuzz(&immersion, |mut loaded: Immersion| {
        let mut world: PhysicsWorld = postcard::from_bytes(&scene).unwrap();
        (0..3).for_each(|_| loaded.step(&mut world));
        assert_finite(&world);
    });
    assert!(refused > 1000 && loaded > 1000, "{refused} {loaded}");
}

fn path() -> Arc<MotionPath> {
    let key = |t: Real| Key {
        position: Vector::Y * -t,
        velocity: -Vector::Y,
        attitude: Rotation::IDENTITY,
    };
    let regimes = vec![(0.0, Regime::SteadyDescent)];
    Arc::new(MotionPath::new(10.0, vec![key(0.0), key(0.1), key(0.2)], regimes).unwrap())
}

#[test]
fn players() {
    let mut world = PhysicsWorld::new();
    let mut players = MotionPlayers::new();
    for x in [0.0, 1.0] {
        let player = MotionPlayer::new(path(), Vector::X * x);
        let body = RigidBodyBuilder::dynamic().pose(player.release(Vector::ZERO));
        let (handle, _) = world.insert(body, leaf());
        players.play(handle, &player).unwrap();
    }
    let scene = postcard::to_stdvec(&world).unwrap();
    let (refused, loaded) = fuzz(&players, |mut loaded: MotionPlayers| {
        let mut world: PhysicsWorld = postcard::from_bytes(&scene).unwrap();
        for _ in 0..3 {
            loaded.before_step(&mut RapierSets::of(&mut world), None);
            world.step();
        }
        assert_finite(&world);
    });
    assert!(refused > 100 && loaded > 100, "{refused} {loaded}");
}

#[test]
fn emitters() {
    let hydro = HydroProperties::from_shape(leaf().shape.as_ref()).unwrap();
    let params = EmitterParams {
        rate: 600.0,
        // One at a time: bodies as large as planets that overlap fail an assertion of parry's in debug builds.
        most: 1,
        ..EmitterParams::default()
    };
    let body = RigidBodyBuilder::dynamic();
    let emitter = Emitter::new(params, body, leaf(), hydro, vec![path()]).unwrap();
    let (refused, loaded) = fuzz(&emitter, |mut loaded: Emitter| {
        let mut world = PhysicsWorld::new();
        let (mut players, mut immersion) = (MotionPlayers::new(), Immersion::new(Fluid::AIR));
        for _ in 0..3 {
            loaded.before_step(&mut world, &mut players, &mut immersion);
            immersion.step(&mut world);
        }
        assert_finite(&world);
    });
    assert!(refused > 100 && loaded > 100, "{refused} {loaded}");
}

#[test]
fn fluids_and_graphs() {
    let (refused, _) = fuzz(&Fluid::AIR, |fluid: Fluid| {
        assert!(fluid.density() > 0.0 && fluid.kinematic_viscosity() > 0.0);
        assert!(fluid.density().is_finite() && fluid.kinematic_viscosity().is_finite());
    });
    assert!(refused > 8, "{refused}");
    let (refused, loaded) = fuzz(&MotionGraph::thesis(), |graph: MotionGraph| {
        let sum: f64 = (0..graph.states()).map(|to| graph.probability(0, to)).sum();
        assert!((sum - 1.0).abs() < 0.01, "{sum}");
    });
    assert!(refused > 100 && loaded > 0, "{refused} {loaded}");
}
