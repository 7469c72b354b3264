//! Bodies come and go, in rapier and in the fluid, and nothing depends on it.

use rapier3d_immersed::flow::Uniform;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion, RapierSets, Warning};

fn leaf(world: &mut PhysicsWorld, height: Real) -> RigidBodyHandle {
    let body = RigidBodyBuilder::dynamic()
        .translation(Vector::Y * height)
        .rotation(Vector::new(0.3, 0.0, 0.2));
    world
        .insert(
            body,
            ColliderBuilder::cuboid(0.0365, 0.000_15, 0.021).density(300.0),
        )
        .0
}

fn hydro(world: &PhysicsWorld, handle: RigidBodyHandle) -> HydroProperties {
    HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap()
}

#[test]
fn removal_in_flight_and_reuse_of_handles() {
    let mut world = PhysicsWorld::new();
    let mut immersion = Immersion::new(Fluid::AIR);
    let leaves: Vec<_> = (0..40).map(|i| leaf(&mut world, i as Real)).collect();
    let shape = hydro(&world, leaves[0]);
    immersion.insert_all(leaves.iter().copied(), shape.clone());
    for _ in 0..10 {
        immersion.step(&mut world);
    }
    for handle in leaves.iter().step_by(2) {
        world.remove_body(*handle);
    }
    for _ in 0..40 {
        immersion.step(&mut world);
    }
    assert_eq!(immersion.len(), 20);
    // New bodies take over the indices; a stale handle still means nothing.
    let fresh: Vec<_> = (0..20).map(|i| leaf(&mut world, i as Real)).collect();
    assert!(fresh.iter().any(|new| {
        leaves
            .iter()
            .any(|old| old.into_raw_parts().0 == new.into_raw_parts().0 && old != new)
    }));
    assert!(fresh.iter().all(|handle| !immersion.contains(*handle)));
    immersion.insert(leaves[0], shape.clone());
    immersion.insert_all(fresh.iter().copied(), shape);
    for _ in 0..60 {
        immersion.step(&mut world);
    }
    assert!(fresh.iter().all(|handle| immersion.contains(*handle)));
    for handle in &fresh {
        // In air a leaf falls at one to three meters per second; in vacuum it would be 10 by now.
        let speed = world.bodies[*handle].linvel().length();
        assert!((0.1..4.0).contains(&speed), "{speed}");
    }
}

/// The number of bodies is right in the next step after rapier has lost some, awake or asleep, and with the
/// set of bodies at hand at once.
#[test]
fn the_number_of_bodies_is_right() {
    let mut world = PhysicsWorld::new();
    let floor = ColliderBuilder::cuboid(50.0, 0.5, 50.0).translation(Vector::Y * -0.5);
    world.insert(RigidBodyBuilder::fixed(), floor);
    let mut immersion = Immersion::new(Fluid::AIR);
    let mut bodies = Vec::new();
    for i in 0..20 {
        // Half of them lie on the floor.
        let height = if i % 2 == 0 { 0.05 } else { 1000.0 };
        let body = leaf(&mut world, height);
        world.bodies[body].set_translation(Vector::new(i as Real, height, 0.0), true);
        bodies.push(body);
    }
    let shape = hydro(&world, bodies[0]);
    immersion.insert_all(bodies.iter().copied(), shape.clone());
    (0..600).for_each(|_| immersion.step(&mut world));
    let sleeping = |handle: &&RigidBodyHandle| world.bodies[**handle].is_sleeping();
    assert!(bodies.iter().filter(sleeping).count() >= 5);
    let mut left = bodies.len();
    for pair in bodies.chunks(4) {
        for handle in pair {
            world.remove_body(*handle);
        }
        left -= pair.len();
        assert_eq!(immersion.len_in(&world.bodies), left);
        immersion.step(&mut world);
        assert_eq!(immersion.len(), left);
        assert!(!immersion.contains(pair[0]));
    }
    // One goes and one comes in the same step.
    let (one, other) = (leaf(&mut world, 1000.0), leaf(&mut world, 1001.0));
    immersion.insert_all([one, other], shape.clone());
    immersion.step(&mut world);
    world.remove_body(one);
    let third = leaf(&mut world, 1002.0);
    immersion.insert(third, shape);
    immersion.step(&mut world);
    assert_eq!((immersion.len(), immersion.len_in(&world.bodies)), (2, 2));
}

/// Additional mass, given as a number or as mass properties, is given back with the rest, and a body that sleeps
/// is not woken by it.
#[test]
fn additional_mass_is_given_back() {
    let extra = MassProperties::new(Vector::X * 0.01, 2e-3, Vector::new(1e-6, 2e-6, 3e-6));
    for (builder, mass) in [
        (RigidBodyBuilder::dynamic(), 0.0),
        (RigidBodyBuilder::dynamic().additional_mass(0.5), 0.5),
        (
            RigidBodyBuilder::dynamic().additional_mass_properties(extra),
            2e-3,
        ),
    ] {
        let mut world = PhysicsWorld::new();
        let collider = ColliderBuilder::cuboid(0.04, 0.02, 0.03).density(300.0);
        let (body, _) = world.insert(builder, collider);
        world.step();
        let before = world.bodies[body].mass_properties().local_mprops;
        let own = 300.0 * 8.0 * 0.04 * 0.02 * 0.03;
        assert!((before.mass() / (own + mass) - 1.0).abs() < 1e-5);
        let shape = hydro(&world, body);
        let mut immersion = Immersion::new(Fluid::WATER);
        immersion.insert(body, shape);
        immersion.step(&mut world);
        assert_ne!(world.bodies[body].mass_properties().local_mprops, before);
        world.bodies[body].sleep();
        immersion.remove(body, &mut world.bodies, &mut world.colliders);
        let body = &world.bodies[body];
        assert!(body.is_sleeping());
        let after = body.mass_properties().local_mprops;
        assert!((after.mass() / before.mass() - 1.0).abs() < 1e-6);
        assert!((after.local_com - before.local_com).length() < 1e-7);
    }
}

/// A body that is switched off or on leaves or enters with the very next step.
#[test]
fn switching_a_body_takes_effect_at_once() {
    let mut world = PhysicsWorld::new();
    let leaf = leaf(&mut world, 100.0);
    let shape = hydro(&world, leaf);
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.insert(leaf, shape);
    for enabled in [true, false, true, false] {
        immersion.set_body_enabled(leaf, enabled);
        immersion.step(&mut world);
        assert_eq!(immersion.forces(&world.bodies, leaf).is_some(), enabled);
        assert_eq!(world.bodies[leaf].gyroscopic_forces_enabled(), !enabled);
    }
}

/// A body's switches are its user's: those that the crate sets are given back as they were.
#[test]
fn switches_are_given_back() {
    for (gyroscopic, fast) in [(false, false), (false, true), (true, false), (true, true)] {
        let mut world = PhysicsWorld::new();
        let leaf = leaf(&mut world, 100.0);
        world.bodies[leaf].enable_gyroscopic_forces(gyroscopic);
        world.bodies[leaf].set_allow_fast_rotation(fast);
        let shape = hydro(&world, leaf);
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.insert(leaf, shape);
        immersion.step(&mut world);
        // In the fluid the crate's own equations have the gyroscopic torque, and no limit.
        assert!(!world.bodies[leaf].gyroscopic_forces_enabled());
        assert!(world.bodies[leaf].is_fast_rotation_allowed());
        immersion.remove(leaf, &mut world.bodies, &mut world.colliders);
        let body = &world.bodies[leaf];
        assert_eq!(body.gyroscopic_forces_enabled(), gyroscopic);
        assert_eq!(body.is_fast_rotation_allowed(), fast);
    }
}

/// Removing from the fluid gives back what the body had; one body can be switched off alone.
#[test]
fn leaving_the_fluid() {
    let mut world = PhysicsWorld::new();
    let (a, b) = (leaf(&mut world, 100.0), leaf(&mut world, 200.0));
    let before = world.bodies[a].mass_properties().local_mprops;
    let shape = hydro(&world, a);
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.insert_all([a, b], shape);
    for _ in 0..30 {
        immersion.step(&mut world);
    }
    immersion.remove(a, &mut world.bodies, &mut world.colliders);
    immersion.set_body_enabled(b, false);
    for _ in 0..30 {
        immersion.step(&mut world);
    }
    assert!(!immersion.contains(a) && immersion.contains(b));
    for handle in [a, b] {
        assert_eq!(world.bodies[handle].mass_properties().local_mprops, before);
        // Half a second of free fall on top.
        assert!(world.bodies[handle].linvel().y < -4.5);
    }
}

/// A zero-length step moves nothing and changes no velocity.
#[test]
fn a_step_of_no_length() {
    let mut world = PhysicsWorld::new();
    let handle = leaf(&mut world, 1.0);
    let shape = hydro(&world, handle);
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.insert(handle, shape);
    for _ in 0..30 {
        immersion.step(&mut world);
    }
    let dt = std::mem::replace(&mut world.integration_parameters.dt, 0.0);
    let state = |world: &PhysicsWorld| {
        let body = &world.bodies[handle];
        (*body.position(), body.linvel(), body.angvel())
    };
    let (before, time) = (state(&world), immersion.time());
    immersion.step(&mut world);
    assert_eq!(state(&world), before);
    assert_eq!(immersion.time(), time);
    world.integration_parameters.dt = dt;
    immersion.step(&mut world);
    assert!(world.bodies[handle].linvel().is_finite());
}

/// What cannot fly is left to rapier, and said.
#[test]
fn refusals_are_reported() {
    let mut world = PhysicsWorld::new();
    let good = leaf(&mut world, 1.0);
    let shape = hydro(&world, good);
    let (massless, _) = world.insert(
        RigidBodyBuilder::dynamic(),
        ColliderBuilder::cuboid(0.1, 0.1, 0.1).density(0.0),
    );
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.insert_all([good, massless], shape);
    immersion.step(&mut world);
    assert!(
        immersion.warnings().iter().any(|warning| {
            matches!(warning, Warning::Refused { body, .. } if *body == massless)
        })
    );
    let text = immersion.warnings().last().unwrap().to_string();
    assert!(text.contains("mass must be positive"), "{text}");
    // Once: trying again does not say it again.
    immersion.set_body_enabled(massless, true);
    immersion.step(&mut world);
    assert_eq!(immersion.warnings().len(), 1);
}

/// A turned leaf hull is where rapier's own inertia is wrong; the user hears of it.
#[test]
fn wrong_inertia_is_reported() {
    let mut world = PhysicsWorld::new();
    let outline = (0..24).flat_map(|i| {
        let angle = i as Real * std::f32::consts::TAU / 24.0;
        [0.000_15, -0.000_15].map(|z| Vector::new(0.0365 * angle.cos(), 0.021 * angle.sin(), z))
    });
    let turn = Rotation::from_scaled_axis(Vector::new(0.4, 0.9, -0.3));
    let points: Vec<_> = outline.map(|p| turn * p).collect();
    let (handle, _) = world.insert(
        RigidBodyBuilder::dynamic(),
        ColliderBuilder::convex_hull(&points)
            .unwrap()
            .density(300.0),
    );
    let shape = hydro(&world, handle);
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.insert(handle, shape);
    immersion.step(&mut world);
    assert!(matches!(
        immersion.warnings(),
        [Warning::WrongInertia { relative_error, .. }] if *relative_error > 0.1
    ));
}

/// Users who hold rapier's sets call before and after around the pipeline: the same result.
#[test]
fn before_and_after_are_the_step() {
    let run = |by_hand: bool| {
        let mut world = PhysicsWorld::new();
        let handle = leaf(&mut world, 1.0);
        let shape = hydro(&world, handle);
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.insert(handle, shape);
        for _ in 0..60 {
            if by_hand {
                immersion.before_step(&mut RapierSets::of(&mut world));
                world.step();
                immersion.after_step(&mut RapierSets::of(&mut world));
            } else {
                immersion.step(&mut world);
            }
        }
        *world.bodies[handle].position()
    };
    assert_eq!(run(true), run(false));
}

/// A leaf asleep on the floor lies still in a breeze and is woken and carried off by a gust.
#[test]
fn a_gust_wakes_a_sleeping_leaf() {
    let mut world = PhysicsWorld::new();
    world.insert(
        RigidBodyBuilder::fixed().translation(Vector::Y * -0.5),
        ColliderBuilder::cuboid(50.0, 0.5, 50.0),
    );
    let handle = leaf(&mut world, 0.05);
    let shape = hydro(&world, handle);
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.insert(handle, shape);
    for _ in 0..600 {
        immersion.step(&mut world);
    }
    assert!(world.bodies[handle].is_sleeping());
    let lying = world.bodies[handle].translation();
    immersion.set_flow(Uniform::new(0.3, 0.0, 0.0));
    for _ in 0..120 {
        immersion.step(&mut world);
    }
    assert!(world.bodies[handle].is_sleeping());
    immersion.set_flow(Uniform::new(6.0, 3.0, 0.0));
    for _ in 0..120 {
        immersion.step(&mut world);
    }
    let moved = world.bodies[handle].translation() - lying;
    assert!(moved.x > 0.5, "{moved}");
}
