//! Bodies in a fluid that moves.

use rapier3d_immersed::flow::Flow;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion};

/// A uniform stream that speeds up from rest.
struct SpeedingUp(Real);

impl Flow for SpeedingUp {
    fn velocity(&self, _point: Vector, time: f64) -> Vector {
        Vector::X * (self.0 * time as Real)
    }
}

/// A neutrally buoyant body follows an accelerating uniform flow exactly, whatever its shape: the
/// pressure gradient and the added mass together push it like the fluid it displaces.
#[test]
fn a_neutrally_buoyant_body_follows_an_accelerating_flow() {
    for half in [[0.1, 0.1, 0.1], [0.2, 0.01, 0.1]] {
        let mut world = PhysicsWorld::new();
        let (handle, _) = world.insert(
            RigidBodyBuilder::dynamic().rotation(Vector::new(0.5, 0.2, 1.0)),
            ColliderBuilder::cuboid(half[0], half[1], half[2]).density(Fluid::WATER.density()),
        );
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
        let mut immersion = Immersion::new(Fluid::WATER);
        immersion.set_flow(SpeedingUp(2.0));
        immersion.insert(handle, hydro);
        for _ in 0..120 {
            immersion.step(&mut world);
        }
        // The flow is read at the start of each step.
        let stream = 2.0 * (immersion.time() as Real - world.integration_parameters.dt);
        let v = world.bodies[handle].linvel();
        assert!(
            (v - Vector::X * stream).length() < 2e-3 * stream,
            "{v} {stream}"
        );
        assert!(world.bodies[handle].angvel().length() < 1e-2);
    }
}

/// A leaf in a steady wind drifts to the wind's speed and falls as in still air.
#[test]
fn a_falling_leaf_drifts_with_the_wind() {
    let mut world = PhysicsWorld::new();
    let (handle, _) = world.insert(
        RigidBodyBuilder::dynamic().rotation(Vector::X * 0.2),
        ColliderBuilder::cuboid(0.0365, 0.000_15, 0.021).density(300.0),
    );
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.set_flow(rapier3d_immersed::flow::Uniform::new(20.0, 0.0, 0.0));
    immersion.insert(handle, hydro);
    for _ in 0..600 {
        immersion.step(&mut world);
    }
    let start = world.bodies[handle].translation();
    for _ in 0..600 {
        immersion.step(&mut world);
    }
    let mean = (world.bodies[handle].translation() - start) / 10.0;
    // Its own gliding, up to 2 m/s either way, comes on top.
    assert!((mean.x - 20.0).abs() < 3.0, "{mean}");
    assert!((-3.0..-0.3).contains(&mean.y), "{mean}");
}

/// A leaf that lies on the floor is lifted by an upward gust that presses more than its weight, ½ρC_D U²
/// > mg/A (U = 1.1 m/s here), even when it has fallen asleep; a weaker one leaves it lying.
#[test]
fn a_gust_lifts_a_resting_leaf() {
    let lifted = |speed: Real| {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = 1.0 / 240.0;
        let floor = ColliderBuilder::cuboid(1.0, 0.1, 1.0).translation(Vector::Y * -0.1);
        world.colliders.insert(floor);
        let (leaf, _) = world.insert(
            RigidBodyBuilder::dynamic().translation(Vector::Y * 0.002),
            ColliderBuilder::cuboid(0.0365, 0.000_15, 0.021).density(300.0),
        );
        rapier3d_immersed::preset::leaf_scale(&mut world.integration_parameters);
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, leaf).unwrap();
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.insert(leaf, hydro);
        immersion.set_flow(rapier3d_immersed::flow::Gust {
            velocity: Vector::Y * speed,
            start: 4.0,
            duration: 1.0,
            ..Default::default()
        });
        let mut highest: Real = 0.0;
        for step in 0..1200 {
            immersion.step(&mut world);
            if step == 950 {
                assert!(world.bodies[leaf].is_sleeping(), "{speed}");
            }
            highest = highest.max(world.bodies[leaf].translation().y);
        }
        highest
    };
    assert!(lifted(0.7) < 0.005, "{}", lifted(0.7));
    assert!(lifted(1.8) > 0.05, "{}", lifted(1.8));
}
