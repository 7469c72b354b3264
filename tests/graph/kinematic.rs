//! Kinematic players feel contacts too: with what is fixed, kinematic or dynamic. They become dynamic
//! there, with the velocity that they had, and the force model takes them over.

use super::players::{path, world};
use rapier3d_immersed::motion::Regime;
use rapier3d_immersed::playback::{AtContact, Drive, MotionPlayer, MotionPlayers, Playing};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion, RapierSets};

fn player(regime: Regime, at_contact: AtContact) -> MotionPlayer {
    MotionPlayer {
        drive: Drive::Kinematic,
        at_contact,
        ..MotionPlayer::new(path(&[regime], 3.0), Vector::Y * 3.0)
    }
}

/// A played leaf meets the ground, becomes dynamic, and comes to rest on it, immersed.
#[test]
fn a_kinematic_leaf_settles() {
    for at_contact in [
        AtContact::HandOver,
        AtContact::Resume { after: 0.3 },
        AtContact::Deflect,
    ] {
        let player = player(Regime::PeriodicFlutter, at_contact);
        let (mut world, leaf) = world(&player, 2.0);
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, leaf).unwrap();
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.insert(leaf, hydro);
        let mut players = MotionPlayers::new();
        players.play(leaf, &player).unwrap();
        let mut lowest = Real::INFINITY;
        for _ in 0..420 {
            players.before_step(&mut RapierSets::of(&mut world), Some(&mut immersion));
            immersion.step(&mut world);
            lowest = lowest.min(world.bodies[leaf].translation().y);
        }
        let body = &world.bodies[leaf];
        assert_eq!(body.body_type(), RigidBodyType::Dynamic, "{at_contact:?}");
        assert!(body.linvel().length() < 0.02, "{at_contact:?}");
        let height = body.translation().y;
        assert!((1.99..2.06).contains(&height), "{at_contact:?} {height}");
        // At 1 m/s and 60 Hz it goes 1.7 cm per step; rapier sees contacts 2 cm ahead.
        assert!(lowest > 1.99, "{at_contact:?} {lowest}");
        assert!(players.playing(leaf).is_none_or(|p| p == Playing::Waiting));
    }
}

/// Whatever stands in the way: the leaf is let go there, not before, and goes on with its velocity.
#[test]
fn every_kind_of_body_is_felt() {
    for kind in [
        RigidBodyType::Fixed,
        RigidBodyType::KinematicPositionBased,
        RigidBodyType::KinematicVelocityBased,
        RigidBodyType::Dynamic,
    ] {
        let player = player(Regime::SteadyDescent, AtContact::HandOver);
        let (mut world, leaf) = world(&player, -9.0);
        let below = player.origin + player.path.at(1.0).position;
        let obstacle = RigidBodyBuilder::new(kind).translation(below - Vector::Y * 0.1);
        let obstacle = obstacle.gravity_scale(0.0);
        world.insert(obstacle, ColliderBuilder::ball(0.1).density(10.0));
        let mut players = MotionPlayers::new();
        players.play(leaf, &player).unwrap();
        let mut step = 0;
        while players.playing(leaf).is_some() {
            players.before_step(&mut RapierSets::of(&mut world), None);
            if players.playing(leaf).is_some() {
                world.step();
            }
            step += 1;
            assert!(step < 200, "{kind:?}");
        }
        let body = &world.bodies[leaf];
        assert_eq!(body.body_type(), RigidBodyType::Dynamic);
        let time = step as Real / 60.0;
        // Not later than two steps after the contact, nor farther than the prediction distance.
        assert!((0.97..1.05).contains(&time), "{kind:?} {time}");
        let velocity = player.path.at(time).velocity;
        assert!((body.linvel() - velocity).length() < 0.01, "{kind:?}");
    }
}

/// [`AtContact::Ignore`] asks nothing of rapier: the leaf goes through the ground to the end of its path.
#[test]
fn contacts_can_be_ignored() {
    let player = player(Regime::SteadyDescent, AtContact::Ignore);
    let (mut world, leaf) = world(&player, 2.0);
    let mut players = MotionPlayers::new();
    players.play(leaf, &player).unwrap();
    for step in 1..60 {
        players.before_step(&mut RapierSets::of(&mut world), None);
        world.step();
        let key = player.path.at(step as Real / 60.0);
        let error = world.bodies[leaf].translation() - player.origin - key.position;
        assert!(error.length() < 1e-4, "{step}");
    }
    assert!(world.bodies[leaf].translation().y < 2.2);
}

/// After a contact the path goes on from where the leaf is, without a jump in place, attitude or
/// velocity: it is kinematic again and falls like its path.
#[test]
fn the_path_goes_on_after_a_contact() {
    for at_contact in [AtContact::Resume { after: 0.1 }, AtContact::Deflect] {
        let player = player(Regime::PeriodicFlutter, at_contact);
        let (mut world, leaf) = world(&player, -9.0);
        let below = player.origin + player.path.at(0.8).position;
        world.insert(
            RigidBodyBuilder::fixed().translation(below + Vector::new(0.03, -0.05, 0.0)),
            ColliderBuilder::ball(0.05),
        );
        let mut players = MotionPlayers::new();
        players.play(leaf, &player).unwrap();
        let (mut waited, mut resumed) = (0, None);
        for step in 0..150 {
            let before = *world.bodies[leaf].position();
            let speed = world.bodies[leaf].linvel();
            let was = players.playing(leaf);
            players.before_step(&mut RapierSets::of(&mut world), None);
            world.step();
            let body = &world.bodies[leaf];
            let now = players.playing(leaf);
            if now == Some(Playing::Waiting) {
                waited += 1;
                assert!(body.is_dynamic());
            }
            if was == Some(Playing::Waiting) && now != was {
                resumed = Some(step);
                assert_eq!(body.body_type(), RigidBodyType::KinematicPositionBased);
                // One step of a tenth of a second in which the difference to the path fades.
                let moved = body.translation() - before.translation;
                assert!((moved * 60.0 - speed).length() < 0.4, "{moved} {speed}");
                assert!(body.rotation().angle_between(before.rotation) < 0.4);
            }
        }
        let resumed = resumed.expect("the leaf slides off the ball");
        assert!(
            waited > 1 && resumed < 140,
            "{at_contact:?} {waited} {resumed}"
        );
        // Half a second later, five times the time in which the difference fades, it moves like its path.
        let Some(Playing::At(time)) = players.playing(leaf) else {
            panic!("{at_contact:?} plays no more");
        };
        // Rapier's velocity is the mean over the step.
        let [to, from] = [time, time - 1.0 / 60.0].map(|t| player.path.at(t).position);
        let off = world.bodies[leaf].linvel() - (to - from) * 60.0;
        let since = (150 - resumed) as Real / 60.0;
        println!("{at_contact:?}: waited {waited} steps; {since:.2} s later off by {off}");
        assert!(off.length() < 0.05, "{at_contact:?} {off}");
    }
}
