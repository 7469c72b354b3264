//! Bodies that are not immersed step exactly as without the crate, and immersed ones keep what is
//! the user's.

use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion};

fn tumbling_boxes() -> (PhysicsWorld, Vec<RigidBodyHandle>) {
    let mut world = PhysicsWorld::new();
    world.insert(
        RigidBodyBuilder::fixed(),
        ColliderBuilder::cuboid(5.0, 0.1, 5.0),
    );
    let boxes = (0..20).map(|i| {
        let x = i as Real;
        let body = RigidBodyBuilder::dynamic()
            .translation(Vector::new(0.1 * x, 1.0 + 0.4 * x, 0.05 * x))
            .rotation(Vector::new(x, 0.2 * x, 0.0))
            .angvel(Vector::new(0.0, x, 1.0));
        world
            .insert(body, ColliderBuilder::cuboid(0.2, 0.1, 0.15))
            .0
    });
    let boxes = boxes.collect();
    (world, boxes)
}

fn bits(world: &PhysicsWorld) -> Vec<u32> {
    let numbers = world.bodies.iter().flat_map(|(_, body)| {
        let pose = body.position();
        [
            pose.translation.to_array().to_vec(),
            pose.rotation.to_array().to_vec(),
            body.linvel().to_array().to_vec(),
            body.angvel().to_array().to_vec(),
        ]
        .concat()
    });
    numbers.map(f32::to_bits).collect()
}

#[test]
fn a_world_without_immersed_bodies_is_bit_identical() {
    let (mut plain, _) = tumbling_boxes();
    let (mut stepped, _) = tumbling_boxes();
    let mut immersion = Immersion::new(Fluid::WATER);
    for _ in 0..200 {
        plain.step();
        immersion.step(&mut stepped);
    }
    assert_eq!(bits(&plain), bits(&stepped));
}

/// Switching the set off gives back the mass properties, so that the scene goes on as plain rapier's
/// would from the same state.
#[test]
fn switched_off_is_plain_rapier() {
    let (mut plain, _) = tumbling_boxes();
    let (mut switched, boxes) = tumbling_boxes();
    let before: Vec<_> = boxes
        .iter()
        .map(|handle| switched.bodies[*handle].mass_properties().local_mprops)
        .collect();
    let hydro =
        HydroProperties::from_body(&switched.bodies, &switched.colliders, boxes[0]).unwrap();
    let mut immersion = Immersion::new(Fluid::WATER);
    immersion.insert_all(boxes.iter().copied(), hydro);
    // On and off again without a step in between that moves anything.
    let dt = std::mem::replace(&mut switched.integration_parameters.dt, 0.0);
    immersion.step(&mut switched);
    assert_ne!(
        switched.bodies[boxes[0]].mass_properties().local_mprops,
        before[0]
    );
    immersion.set_enabled(false);
    immersion.step(&mut switched);
    switched.integration_parameters.dt = dt;
    for (handle, before) in boxes.iter().zip(&before) {
        let now = switched.bodies[*handle].mass_properties().local_mprops;
        assert_eq!(now, *before);
    }
    for _ in 0..100 {
        plain.step();
        immersion.step(&mut switched);
    }
    assert_eq!(bits(&plain), bits(&switched));
}

/// A neutrally buoyant cube with a user's force on it: the force is there after each step, and it
/// accelerates body and fluid, m + A, not the body alone.
#[test]
fn user_forces_survive_and_act_on_body_and_fluid() {
    let mut world = PhysicsWorld::new();
    let density = Fluid::WATER.density();
    let (handle, _) = world.insert(
        RigidBodyBuilder::dynamic(),
        ColliderBuilder::ball(0.1).density(density),
    );
    let (force, torque) = (Vector::new(0.5, 0.0, 0.25), Vector::new(0.0, 1e-3, 0.0));
    world.bodies[handle].add_force(force, true);
    world.bodies[handle].add_torque(torque, true);
    let mass = world.bodies[handle].mass();
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
    let mut immersion = Immersion::new(Fluid::WATER);
    immersion.insert(handle, hydro);
    for _ in 0..10 {
        immersion.step(&mut world);
        assert_eq!(world.bodies[handle].user_force(), force);
        assert_eq!(world.bodies[handle].user_torque(), torque);
    }
    let elapsed = 10.0 * world.integration_parameters.dt;
    let exact = force.x / (1.5 * mass) * elapsed;
    let reached = world.bodies[handle].linvel().x;
    assert!((reached / exact - 1.0).abs() < 0.01, "{reached} {exact}");
}

/// Rapier's damping and gravity scale still work: without gravity there is no buoyancy either.
#[test]
fn gravity_scale_and_damping_are_kept() {
    let mut world = PhysicsWorld::new();
    let (handle, _) = world.insert(
        RigidBodyBuilder::dynamic()
            .gravity_scale(0.0)
            .linear_damping(2.0)
            .linvel(Vector::X),
        ColliderBuilder::ball(0.1).density(1e4),
    );
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.insert(handle, hydro);
    for _ in 0..60 {
        immersion.step(&mut world);
    }
    let v = world.bodies[handle].linvel();
    assert!(v.y.abs() < 1e-5, "{v}");
    // Rapier divides by 1 + 2 dt each step; a ball of 10⁴ kg/m³ hardly feels air.
    let damped = (1.0_f32 + 2.0 / 60.0).powi(-60);
    assert!((v.x / damped - 1.0).abs() < 0.01, "{v}");
}
