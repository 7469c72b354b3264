//! Floating bodies that touch, are joined, and are loaded.

use super::Pond;
use rapier3d::prelude::*;
use rapier3d_immersed::rapier3d;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion, Medium};

/// A world with logs on water, at a rate.
fn logs(places: &[Vector], hertz: f32) -> (PhysicsWorld, Immersion, Vec<RigidBodyHandle>) {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = 1.0 / hertz;
    let mut immersion = Immersion::new(Medium::layered(Fluid::AIR, Fluid::WATER));
    let handles: Vec<_> = places
        .iter()
        .map(|place| {
            let log = ColliderBuilder::cuboid(1.0, 0.1, 0.15).density(600.0);
            world
                .insert(RigidBodyBuilder::dynamic().translation(*place), log)
                .0
        })
        .collect();
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handles[0]).unwrap();
    immersion.insert_all(handles.clone(), hydro);
    (world, immersion, handles)
}

/// How high a log of 600 kg/m³ and .2 m floats with its middle, m.
fn floating_height() -> f32 {
    0.1 - 0.2 * (600.0 - 1.184) / (997.0 - 1.184)
}

/// Two logs dropped side by side, touching, float as each would alone, and sleep.
#[test]
fn two_logs_side_by_side() {
    for hertz in [60.0, 240.0] {
        let (mut world, mut immersion, handles) = logs(
            &[Vector::new(0.0, 0.3, -0.15), Vector::new(0.1, 0.3, 0.155)],
            hertz,
        );
        for _ in 0..(40.0 * hertz) as usize {
            immersion.step(&mut world);
        }
        for handle in handles {
            let body = &world.bodies[handle];
            let miss = body.translation().y - floating_height();
            println!("{hertz}: {miss}, {:?}", body.is_sleeping());
            assert!(miss.abs() < 3e-3, "{hertz}: {miss}");
            assert!(body.linvel().length() < 1e-2);
        }
    }
}

/// A raft of eight logs on fixed joints floats level as the logs do, rights itself after a kick, and holds together.
#[test]
fn a_raft_of_eight_logs() {
    for hertz in [60.0, 240.0] {
        let places: Vec<_> = (0..8)
            .map(|i| Vector::new(0.0, 0.0, 0.31 * i as f32))
            .collect();
        let (mut world, mut immersion, handles) = logs(&places, hertz);
        for pair in handles.windows(2) {
            let joint = FixedJointBuilder::new()
                .local_anchor1(Vector::Z * 0.155)
                .local_anchor2(Vector::Z * -0.155);
            world.insert_impulse_joint(pair[0], pair[1], joint);
        }
        for i in 0..(30.0 * hertz) as usize {
            if i == hertz as usize {
                let impulse = Vector::Y * -60.0;
                immersion.apply_impulse(&mut world.bodies, handles[0], impulse);
            }
            immersion.step(&mut world);
        }
        for pair in handles.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|handle| world.bodies[handle].translation());
            assert!(
                ((b - a).length() - 0.31).abs() < 0.01,
                "{hertz}: {}",
                (b - a).length()
            );
        }
        for handle in handles {
            let miss = world.bodies[handle].translation().y - floating_height();
            println!("{hertz}: {miss}");
            assert!(miss.abs() < 8e-3, "{hertz}: {miss}");
        }
    }
}

/// A loaded boat of 2 × .4 × .6 m: its load low it stays upright, its load high it capsizes. GM = BM − BG is .115 and
/// −.12 m.
#[test]
fn a_boat_capsizes_when_its_load_is_high() {
    for hertz in [60.0, 240.0] {
        for (load_height, upright) in [(-0.1, true), (0.5, false)] {
            let mut pond = Pond::new(
                RigidBodyBuilder::dynamic().rotation(Vector::X * 0.03),
                ColliderBuilder::cuboid(1.0, 0.2, 0.3).density(200.0),
                hertz,
            );
            // 96 kg of boat and as much of load: draft .16 m.
            let inertia = Vector::splat(3.0);
            let load = MassProperties::new(Vector::Y * load_height, 96.0, inertia);
            pond.world.bodies[pond.body].set_additional_mass_properties(load, true);
            pond.run(30.0);
            let up = (pond.body().rotation() * Vector::Y).y;
            println!("{hertz} {load_height}: {up}");
            if upright {
                assert!(up > 0.999, "{hertz}: {up}");
            } else {
                assert!(up < 0.7, "{hertz}: {up}");
            }
        }
    }
}
