//! Bodies of rapier that play synthesized falls: they follow, collide, settle, and are blown along.

use super::{leaf, up_to};
use rapier3d_immersed::flow::{Flow, Uniform};
use rapier3d_immersed::motion::Regime;
use rapier3d_immersed::motion::path::{MotionPath, WindResponse};
use rapier3d_immersed::playback::{AtContact, Drive, MotionPlayer, MotionPlayers, Playing};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion, RapierSets};
use std::sync::Arc;

pub fn path(regimes: &[Regime], height: f64) -> Arc<MotionPath> {
    let leaf = leaf(up_to(Regime::PeriodicSpiral, height));
    Arc::new(leaf.path_through(regimes, 5).unwrap())
}

pub fn world(player: &MotionPlayer, height: Real) -> (PhysicsWorld, RigidBodyHandle) {
    let mut world = PhysicsWorld::new();
    let body = match player.drive {
        Drive::Kinematic => RigidBodyBuilder::kinematic_position_based(),
        Drive::Velocity { .. } => RigidBodyBuilder::dynamic(),
    };
    let (leaf, _) = world.insert(
        body.pose(player.release(Vector::ZERO)),
        ColliderBuilder::cuboid(0.0365, 0.001, 0.021).density(400.0),
    );
    let ground = ColliderBuilder::cuboid(10.0, 0.1, 10.0);
    world.insert(
        RigidBodyBuilder::fixed().translation(Vector::Y * (height - 0.1)),
        ground,
    );
    (world, leaf)
}

/// Both drives follow the path, through every pattern, to rounding: the velocities that are set
/// carry the body exactly to where it shall be. Attitudes are first order within a step (rapier
/// normalises a linear step), and the error is worked off.
#[test]
fn bodies_follow_their_path() {
    for drive in [Drive::Kinematic, Drive::Velocity { compliance: 0.05 }] {
        let regimes = [
            Regime::PeriodicFlutter,
            Regime::PeriodicTumbling,
            Regime::PeriodicSpiral,
        ];
        let player = MotionPlayer {
            heading: 0.7,
            drive,
            ..MotionPlayer::new(path(&regimes, 3.0), Vector::new(1.0, 4.0, 0.0))
        };
        let (mut world, leaf) = world(&player, -9.0);
        let mut players = MotionPlayers::new();
        players.play(leaf, &player).unwrap();
        let turn = Rotation::from_axis_angle(Vector::Y, 0.7);
        let steps = (player.path.duration() * 60.0) as usize;
        for step in 1..steps {
            players.before_step(&mut RapierSets::of(&mut world), None);
            world.step();
            let key = player.path.at(step as Real / 60.0);
            let body = &world.bodies[leaf];
            let error = (body.center_of_mass() - player.origin - turn * key.position).length();
            assert!(error < 1e-3, "{drive:?} {step}: {error}");
            let attitude = turn * key.attitude * player.axes.inverse();
            let angle = attitude.angle_between(*body.rotation());
            assert!(angle < 0.06, "{drive:?} {step}: {angle}");
        }
    }
}

/// A leaf that is played meets the ground, the force model takes over, and it comes to rest there.
#[test]
fn a_played_leaf_settles() {
    for at_contact in [
        AtContact::HandOver,
        AtContact::Resume { after: 0.3 },
        AtContact::Deflect,
    ] {
        let player = MotionPlayer {
            at_contact,
            ..MotionPlayer::new(path(&[Regime::PeriodicFlutter], 1.0), Vector::Y)
        };
        let (mut world, leaf) = world(&player, 0.4);
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, leaf).unwrap();
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.insert(leaf, hydro);
        let mut players = MotionPlayers::new();
        players.play(leaf, &player).unwrap();
        for _ in 0..360 {
            players.before_step(&mut RapierSets::of(&mut world), Some(&mut immersion));
            immersion.step(&mut world);
        }
        let body = &world.bodies[leaf];
        assert!(body.linvel().length() < 0.02, "{at_contact:?}");
        let height = body.translation().y;
        assert!((0.39..0.46).contains(&height), "{at_contact:?} {height}");
        assert!(players.playing(leaf).is_none_or(|p| p == Playing::Waiting));
    }
}

/// A ball in the path turns a deflected leaf aside, and the path goes on from there.
#[test]
fn deflection_lasts() {
    let player = MotionPlayer {
        at_contact: AtContact::Deflect,
        ..MotionPlayer::new(path(&[Regime::SteadyDescent], 3.0), Vector::Y * 3.0)
    };
    let (mut world, leaf) = world(&player, -9.0);
    let below = player.origin + player.path.at(1.0).position;
    world.insert(
        RigidBodyBuilder::fixed().translation(below + Vector::new(0.02, -0.05, 0.0)),
        ColliderBuilder::ball(0.05),
    );
    let mut players = MotionPlayers::new();
    players.play(leaf, &player).unwrap();
    let mut left = Vector::ZERO;
    for step in 0..170 {
        players.before_step(&mut RapierSets::of(&mut world), None);
        world.step();
        if step == 120 {
            left = world.bodies[leaf].translation();
        }
    }
    let end = world.bodies[leaf].translation();
    let drift = player.path.at(1.0).velocity;
    let undisturbed = Vector::Y * 3.0 + player.path.at(121.0 / 60.0).position;
    assert!((left - undisturbed).length() > 0.02, "{left} {undisturbed}");
    // After the collision the velocity is the path's again, not a pull back to it.
    let velocity = (end - left) / (49.0 / 60.0);
    assert!((velocity - drift).length() < 0.1, "{velocity} {drift}");
}

#[test]
fn wind_carries_players_along() {
    let player = MotionPlayer::new(path(&[Regime::SteadyDescent], 3.0), Vector::Y * 5.0);
    let (mut world, leaf) = world(&player, -9.0);
    let mut players = MotionPlayers::new();
    let flow: Arc<dyn Flow> = Arc::new(Uniform::new(0.0, 0.0, 2.0));
    let response = WindResponse::default();
    players.set_wind(Some((flow, response))).unwrap();
    players.play(leaf, &player).unwrap();
    for _ in 0..120 {
        players.before_step(&mut RapierSets::of(&mut world), None);
        world.step();
    }
    let moved = world.bodies[leaf].translation() - Vector::Y * 5.0 - player.path.at(2.0).position;
    // 2 m/s for 2 s, less the delay of 0.1 s and a step.
    assert!((moved.z - 2.0 * 1.9).abs() < 0.05, "{moved}");
    let normal = *world.bodies[leaf].rotation() * Vector::Y;
    let lean = response.angle * 2.0 / 3.0;
    assert!((normal.angle_between(Vector::Y) - lean).abs() < 0.02 && normal.z > 0.0);
}

#[test]
fn removed_bodies_and_nonsense_are_ignored() {
    let player = MotionPlayer::new(path(&[Regime::SteadyDescent], 3.0), Vector::Y);
    let (mut world, leaf) = world(&player, -9.0);
    let mut players = MotionPlayers::new();
    players.play(leaf, &player).unwrap();
    assert_eq!(players.playing(leaf), Some(Playing::At(0.0)));
    world.remove_body(leaf);
    players.before_step(&mut RapierSets::of(&mut world), None);
    assert!(players.is_empty() && players.playing(leaf).is_none());
    players.stop(leaf, None);
    let bad = MotionPlayer {
        origin: Vector::new(Real::NAN, 0.0, 0.0),
        ..player
    };
    assert!(players.play(leaf, &bad).is_err());
}
