//! Factors on a body's forces act as they say, and a series of them is replayed step by step.

use rapier3d_immersed::motion::{ControlSeries, Dwell, Pattern};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, ForceFactors, HydroProperties, Immersion, OnContact};

fn world(height: Real) -> (PhysicsWorld, RigidBodyHandle, Immersion) {
    let mut world = PhysicsWorld::new();
    let (leaf, _) = world.insert(
        RigidBodyBuilder::dynamic()
            .translation(Vector::Y * height)
            .rotation(Vector::X * 0.3),
        ColliderBuilder::cuboid(0.0365, 0.00015, 0.021).density(400.0),
    );
    world.insert(
        RigidBodyBuilder::fixed(),
        ColliderBuilder::cuboid(10.0, 0.1, 10.0).translation(Vector::Y * -0.1),
    );
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, leaf).unwrap();
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.insert(leaf, hydro);
    (world, leaf, immersion)
}

fn series() -> ControlSeries {
    let dwells = [0, 10].map(|from| Dwell {
        pattern: Pattern::Zigzag,
        from,
    });
    let controls = (0..20).map(|i| ForceFactors::from([1.0 + i as f32, 0.5, 0.5]));
    let controls = controls.collect();
    ControlSeries::new(1.0 / 60.0, controls, dwells.to_vec()).unwrap()
}

/// Drag makes a leaf fall more slowly, ones change nothing, and nonsense is not taken.
#[test]
fn factors_act() {
    let fall = |control: Option<[f32; 3]>| {
        let (mut world, leaf, mut immersion) = world(9.0);
        if let Some(control) = control {
            immersion.set_control(leaf, control.into());
        }
        (0..60).for_each(|_| immersion.step(&mut world));
        world.bodies[leaf].translation()
    };
    let plain = fall(None);
    assert_eq!(fall(Some([1.0; 3])), plain);
    assert_eq!(fall(Some([f32::NAN, 1.0, 1.0])), plain);
    assert_eq!(fall(Some([-1.0, 1.0, 1.0])), plain);
    assert!(fall(Some([4.0, 0.0, 0.0])).y > plain.y + 0.1);
}

#[test]
fn a_series_is_replayed_step_by_step() {
    let (mut world, leaf, mut immersion) = world(9.0);
    immersion.replay(leaf, &series(), OnContact::Restart);
    for step in 0..25 {
        immersion.step(&mut world);
        let expected = series().controls()[step.min(19)];
        assert_eq!(immersion.control(leaf), Some(expected), "{step}");
    }
    immersion.stop_replay(leaf);
    assert_eq!(immersion.control(leaf), Some(ForceFactors::ONE));
    assert_eq!(immersion.replay_time(leaf), None);
}

/// On the floor the law is the body's own; thrown up again, the pattern begins anew.
#[test]
fn contact_interrupts() {
    for on_contact in [OnContact::Restart, OnContact::Stop, OnContact::Ignore] {
        let (mut world, leaf, mut immersion) = world(0.12);
        immersion.replay(leaf, &series(), on_contact);
        for _ in 0..180 {
            immersion.step(&mut world);
        }
        let resting = immersion.control(leaf);
        world.bodies[leaf].set_linvel(Vector::Y * 4.0, true);
        for _ in 0..12 {
            immersion.step(&mut world);
        }
        let flying = immersion.control(leaf).unwrap().drag;
        match on_contact {
            OnContact::Restart => {
                assert_eq!(resting, Some(ForceFactors::ONE));
                assert!(
                    flying > 1.0 && immersion.replay_time(leaf) < Some(0.4),
                    "{flying}"
                );
            }
            OnContact::Stop => {
                assert_eq!((resting, flying), (Some(ForceFactors::ONE), 1.0));
                assert_eq!(immersion.replay_time(leaf), None);
            }
            OnContact::Ignore => assert_eq!(resting.unwrap().drag, 20.0),
        }
    }
}

#[test]
fn replays_of_removed_bodies_are_forgotten() {
    let (mut world, leaf, mut immersion) = world(9.0);
    immersion.replay(leaf, &series(), OnContact::Restart);
    world.remove_body(leaf);
    for _ in 0..40 {
        immersion.step(&mut world);
    }
    assert_eq!(immersion.replay_time(leaf), None);
    immersion.replay(leaf, &series(), OnContact::Restart);
    assert_eq!(immersion.replay_time(leaf), None);
}

#[cfg(feature = "serde-serialize")]
#[test]
fn a_snapshot_goes_on_replaying() {
    let (mut world, leaf, mut immersion) = world(9.0);
    immersion.replay(leaf, &series(), OnContact::Restart);
    (0..5).for_each(|_| immersion.step(&mut world));
    let bytes = postcard::to_stdvec(&immersion).unwrap();
    let mut loaded: Immersion = postcard::from_bytes(&bytes).unwrap();
    assert_eq!(loaded.replay_time(leaf), immersion.replay_time(leaf));
    loaded.step(&mut world);
    assert_eq!(loaded.control(leaf), Some(series().controls()[5]));
}
