//! What playing synthesized falls costs, per player and step, beside rapier's own step:
//! `cargo bench --bench players`.

use rapier3d_immersed::motion::path::{
    MotionPath, SynthesisParams, Synthesizer, TrajectoryDatabase,
};
use rapier3d_immersed::motion::{DimensionlessNumbers, Outline};
use rapier3d_immersed::playback::{Drive, Emitter, EmitterParams, MotionPlayer, MotionPlayers};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion, RapierSets};
use std::sync::Arc;
use std::time::Instant;

fn main() {
    let quick = std::env::args().any(|arg| arg == "--test");
    let numbers =
        DimensionlessNumbers::new(Outline::Round, 0.042, 0.0003, 400.0, &Fluid::AIR, 9.81)
            .expect("a leaf in air");
    let params = SynthesisParams {
        height: 20.0,
        ..SynthesisParams::default()
    };
    let leaf = Synthesizer::new(&numbers, 0.073, TrajectoryDatabase::shipped(), params)
        .expect("the default parameters are valid");
    let start = Instant::now();
    let paths: Vec<_> = (0..64).map(|seed| Arc::new(leaf.path(seed))).collect();
    let each = start.elapsed() / 64;
    println!(
        "a fall of {:.0} s: {each:.1?} to synthesize",
        paths[0].duration()
    );
    for (name, drive) in [
        ("kinematic", Drive::Kinematic),
        ("velocity", Drive::Velocity { compliance: 0.1 }),
    ] {
        for count in if quick { [10, 100] } else { [1000, 10_000] } {
            let mut world = PhysicsWorld::new();
            let mut players = MotionPlayers::new();
            for i in 0..count {
                let cell = [i % 100, i / 100].map(|x| x as Real * 2.0);
                let player = MotionPlayer {
                    heading: i as Real,
                    drive,
                    ..MotionPlayer::new(paths[i % 64].clone(), Vector::new(cell[0], 0.0, cell[1]))
                };
                let body = match drive {
                    Drive::Kinematic => RigidBodyBuilder::kinematic_position_based(),
                    Drive::Velocity { .. } => RigidBodyBuilder::dynamic(),
                };
                let (handle, _) = world.insert(
                    body.pose(player.release(Vector::ZERO)),
                    ColliderBuilder::cuboid(0.0365, 0.000_15, 0.021).density(400.0),
                );
                players.play(handle, &player).expect("a valid player");
            }
            let (mut own, mut rapiers) = (Vec::new(), Vec::new());
            for _ in 0..if quick { 3 } else { 200 } {
                let start = Instant::now();
                players.before_step(&mut RapierSets::of(&mut world), None);
                own.push(start.elapsed().as_nanos() as f64 / count as f64);
                let start = Instant::now();
                world.step();
                rapiers.push(start.elapsed().as_nanos() as f64 / count as f64);
            }
            own.sort_by(f64::total_cmp);
            rapiers.sort_by(f64::total_cmp);
            println!(
                "{name}, {count} players: {:.0} ns each per step (median; least {:.0}); rapier's step {:.0} ns",
                own[own.len() / 2],
                own[0],
                rapiers[rapiers.len() / 2]
            );
        }
    }
    mixed(paths, if quick { 50 } else { 10_000 });
}

/// A suspension: nine in ten play, the others are driven by forces; all fall towards a floor. The emitter
/// fills the scene within a second and renews it every second from then on.
///
/// The players' part is the time of [`MotionPlayers::before_step`] alone, over the players at that step:
/// neither the emitter, which makes and removes bodies, nor the force-driven ones, nor rapier count.
fn mixed(paths: Vec<Arc<MotionPath>>, most: usize) {
    let collider = ColliderBuilder::cuboid(0.0365, 0.000_15, 0.021).density(400.0);
    let hydro = HydroProperties::from_shape(collider.shape.as_ref()).expect("a plate");
    let params = EmitterParams {
        corners: [Vector::new(-40.0, 6.0, -40.0), Vector::new(40.0, 9.0, 40.0)],
        rate: most as Real,
        most,
        ..EmitterParams::default()
    };
    let body = RigidBodyBuilder::dynamic();
    let mut emitter =
        Emitter::new(params, body, collider, hydro, paths).expect("the parameters are valid");
    let mut world = PhysicsWorld::new();
    world.insert(
        RigidBodyBuilder::fixed(),
        ColliderBuilder::cuboid(60.0, 0.1, 60.0).translation(Vector::Y * -0.1),
    );
    let mut players = MotionPlayers::new();
    let mut immersion = Immersion::new(Fluid::AIR);
    let (mut own, mut whole) = (Vec::new(), Vec::new());
    for step in 0..300 {
        emitter.before_step(&mut world, &mut players, &mut immersion);
        let start = Instant::now();
        players.before_step(&mut RapierSets::of(&mut world), Some(&mut immersion));
        let played = start.elapsed();
        immersion.step(&mut world);
        if step >= 180 {
            own.push(played.as_nanos() as f64 / players.len().max(1) as f64);
            whole.push(start.elapsed().as_secs_f64() * 1e3);
        }
    }
    own.sort_by(f64::total_cmp);
    whole.sort_by(f64::total_cmp);
    println!(
        "mixed scene of {}, {} of them played: {:.0} ns per player and step (median; least {:.0}); \
         all of the step {:.1} ms",
        world.bodies.len() - 1,
        players.len(),
        own[own.len() / 2],
        own[0],
        whole[whole.len() / 2],
    );
}
