//! Steps and causes beyond all measure.

use crate::support::weightless;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::turbulence::{LangevinMode, Turbulence, TurbulenceState, TurbulentLayer};
use rapier3d_immersed::{Fluid, HydroProperties, Immersion};

/// Turbulence of k = ε = 10³⁰, whose increments of 10¹⁵ m/s are beyond the crate's limit of 10⁶: leaves on the
/// ground are left to rapier in these steps. When it is gone they lie within seconds, on the ground, not in it.
#[test]
fn what_was_thrown_comes_to_rest() {
    let mut world = PhysicsWorld::new();
    let ground = ColliderBuilder::new(SharedShape::halfspace(Vector::Y));
    world.insert_collider(ground, None);
    let mut immersion = Immersion::new(Fluid::AIR);
    let mut leaves = vec![];
    for i in 0..8 {
        let leaf = RigidBodyBuilder::dynamic().translation(Vector::new(i as f32, 0.01, 0.0));
        let collider = ColliderBuilder::cuboid(0.0365, 0.002, 0.021).density(300.0);
        let (leaf, _) = world.insert(leaf, collider);
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, leaf).unwrap();
        immersion.insert(leaf, hydro);
        leaves.push(leaf);
    }
    let mut layer = TurbulentLayer::from(Turbulence::Homogeneous(TurbulenceState {
        kinetic_energy: 1e30,
        dissipation: 1e30,
    }));
    layer.mode = LangevinMode::BodyIncrements;
    immersion.set_turbulence(layer);
    for _ in 0..30 {
        immersion.step(&mut world);
    }
    immersion.clear_turbulence();
    for _ in 0..300 {
        immersion.step(&mut world);
    }
    for leaf in leaves {
        let body = &world.bodies[leaf];
        let (speed, height) = (body.linvel().length(), body.translation().y);
        assert!(speed < 0.01, "{speed}");
        assert!((0.0..0.05).contains(&height), "{height}");
    }
}

/// The same for a body that a user throws at up to 10¹³ m/s, of which rapier leaves 400: drag has stopped it
/// to its falling speed of 4 m/s after three seconds.
#[test]
fn what_a_user_throws_slows_down() {
    for speed in [300.0, 1e4, 1e6, 1e10, 1e13] {
        let mut world = PhysicsWorld::new();
        let mut immersion = Immersion::new(Fluid::AIR);
        let body = RigidBodyBuilder::dynamic()
            .rotation(Vector::new(0.3, 0.4, 0.5))
            .linvel(Vector::new(0.0, 0.8, 0.6) * speed);
        let collider = ColliderBuilder::cuboid(0.0365, 0.002, 0.021).density(300.0);
        let (leaf, _) = world.insert(body, collider);
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, leaf).unwrap();
        immersion.insert(leaf, hydro);
        for _ in 0..180 {
            immersion.step(&mut world);
        }
        let end = world.bodies[leaf].linvel().length();
        assert!(end < 6.0, "{speed}: {end}");
    }
}

/// A step of 10⁻²⁰ s changes nothing, whatever holds the body; the next one of 1/60 s goes on as if it had
/// not been.
#[test]
fn the_shortest_step_is_harmless() {
    let run = |short: bool| {
        let mut world = weightless();
        let post = world.insert_body(RigidBodyBuilder::fixed());
        let mut immersion = Immersion::new(Fluid::WATER);
        let mut bodies = vec![];
        for (i, locks) in [LockedAxes::empty(), LockedAxes::ROTATION_LOCKED_X]
            .into_iter()
            .enumerate()
        {
            for jointed in [false, true] {
                let at = Vector::new(3.0 * i as f32, 1.0, f32::from(u8::from(jointed)));
                let body = RigidBodyBuilder::dynamic()
                    .translation(at)
                    .rotation(Vector::new(0.4, 0.2, 0.9))
                    .linvel(Vector::new(0.3, 0.0, -0.2))
                    .angvel(Vector::new(0.0, 2.0, 1.0))
                    .locked_axes(locks)
                    .can_sleep(false);
                let plate = ColliderBuilder::cuboid(0.1, 0.001, 0.05).density(2700.0);
                let (body, _) = world.insert(body, plate);
                if jointed {
                    let pivot = SphericalJointBuilder::new()
                        .local_anchor1(at + Vector::X * 0.2)
                        .local_anchor2(Vector::X * 0.2);
                    world.insert_impulse_joint(post, body, pivot);
                }
                let (sets, colliders) = (&world.bodies, &world.colliders);
                let hydro = HydroProperties::from_body(sets, colliders, body).unwrap();
                immersion.insert(body, hydro);
                bodies.push(body);
            }
        }
        let mut states = vec![];
        for n in 0..60 {
            if short && n % 10 == 5 {
                let before = bodies.iter().map(|b| world.bodies[*b].clone());
                let before: Vec<_> = before
                    .map(|b| (*b.position(), b.linvel(), b.angvel()))
                    .collect();
                world.integration_parameters.dt = 1e-20;
                immersion.step(&mut world);
                for (body, before) in bodies.iter().zip(before) {
                    let body = &world.bodies[*body];
                    let pushed = (body.linvel() - before.1).length();
                    let turned = (body.angvel() - before.2).length();
                    assert!(pushed < 1e-6 && turned < 1e-5, "{pushed} {turned}");
                    assert!((body.translation() - before.0.translation).length() < 1e-6);
                }
            }
            world.integration_parameters.dt = 1.0 / 60.0;
            immersion.step(&mut world);
        }
        for body in bodies {
            let body = &world.bodies[body];
            states.push((body.translation(), body.linvel(), body.angvel()));
        }
        states
    };
    // The flight begins anew after each, without the history of its acceleration.
    for (with, without) in run(true).into_iter().zip(run(false)) {
        assert!((with.0 - without.0).length() < 2e-3, "{with:?} {without:?}");
        assert!((with.1 - without.1).length() < 5e-3, "{with:?} {without:?}");
        assert!((with.2 - without.2).length() < 0.05, "{with:?} {without:?}");
    }
}
