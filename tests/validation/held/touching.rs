//! Jointed bodies that touch others, brakes, platforms and steps of changing length.

use crate::support::weightless;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, ImmersedBody, Immersion, ViscousLaw};

fn immerse(
    world: &PhysicsWorld,
    immersion: &mut Immersion,
    body: RigidBodyHandle,
    law: ViscousLaw,
) {
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, body).unwrap();
    immersion.insert(body, ImmersedBody::new(hydro).with_law(law).unwrap());
}

/// Two plates on a joint slide on the ground, under water and in air, and come to rest: friction and fluid only
/// brake. A tenth of the start is left for the impacts of a plate that tips.
#[test]
fn jointed_plates_that_slide_come_to_rest() {
    for (fluid, half, density) in [
        (Fluid::WATER, [0.2, 0.005, 0.2], 2700.0),
        (Fluid::WATER, [0.2, 0.005, 0.2], 8000.0),
        (Fluid::WATER, [0.2, 0.02, 0.2], 1200.0),
        (Fluid::AIR, [0.1, 0.0002, 0.1], 100.0),
        (Fluid::AIR, [0.3, 0.001, 0.3], 20.0),
    ] {
        for hz in [60.0, 240.0] {
            for fixed in [false, true] {
                let mut world = PhysicsWorld::new();
                world.integration_parameters.dt = 1.0 / hz;
                let ground = ColliderBuilder::cuboid(50.0, 0.5, 50.0).translation(Vector::Y * -0.5);
                world.insert_collider(ground, None);
                let mut immersion = Immersion::new(fluid);
                let gap = 2.5 * half[0];
                let plates = [0.0, gap].map(|x| {
                    let body = RigidBodyBuilder::dynamic()
                        .translation(Vector::new(x, half[1] + 1e-4, 0.0))
                        .linvel(Vector::X * 2.0);
                    let plate = ColliderBuilder::cuboid(half[0], half[1], half[2]).density(density);
                    world.insert(body, plate).0
                });
                for plate in plates {
                    immerse(&world, &mut immersion, plate, ViscousLaw::default());
                }
                let at = Vector::X * (gap / 2.0);
                let joint: GenericJoint = if fixed {
                    FixedJointBuilder::new()
                        .local_anchor1(at)
                        .local_anchor2(-at)
                        .into()
                } else {
                    SphericalJointBuilder::new()
                        .local_anchor1(at)
                        .local_anchor2(-at)
                        .into()
                };
                world.insert_impulse_joint(plates[0], plates[1], joint);
                for _ in 0..(4.0 * hz) as usize {
                    immersion.step(&mut world);
                    for plate in plates {
                        let speed = world.bodies[plate].linvel().length();
                        assert!(speed < 2.2, "{half:?} {density} {hz} {fixed}: {speed}");
                    }
                }
                for plate in plates {
                    let speed = world.bodies[plate].linvel().length();
                    assert!(speed < 0.1, "{half:?} {density} {hz} {fixed}: {speed}");
                }
            }
        }
    }
}

/// A hinge whose motor only brakes, between two spinning plates in an ideal fluid: their energy does not grow.
#[test]
fn a_brake_takes_energy() {
    for damping in [0.002, 0.02, 0.2] {
        let mut world = weightless();
        let mut immersion = Immersion::new(Fluid::WATER);
        let spin = Vector::new(0.97, -3.78, -0.5);
        let plates = [0.0, 0.2].map(|x| {
            let at = Vector::X * x;
            let own = Vector::Y * if x == 0.0 { 3.3 } else { 5.87 };
            let body = RigidBodyBuilder::dynamic()
                .translation(at)
                .linvel(spin.cross(at))
                .angvel(spin + own);
            let plate = ColliderBuilder::cuboid(0.1, 0.05, 0.002)
                .density(500.0)
                .collision_groups(InteractionGroups::none());
            world.insert(body, plate).0
        });
        for plate in plates {
            immerse(&world, &mut immersion, plate, ViscousLaw::Inviscid);
        }
        let hinge = RevoluteJointBuilder::new(Vector::Y)
            .local_anchor1(Vector::X * 0.1)
            .local_anchor2(Vector::X * -0.1)
            .motor_velocity(0.0, damping);
        world.insert_impulse_joint(plates[0], plates[1], hinge);
        let mut start = None;
        for n in 0..240 {
            immersion.step(&mut world);
            let energies = plates.map(|plate| {
                let matrix = immersion.mass_matrix_of(plate).unwrap();
                let body = &world.bodies[plate];
                let back = body.rotation().inverse();
                let (v, w) = (back * body.linvel(), back * body.angvel());
                let six = [v.x, v.y, v.z, w.x, w.y, w.z].map(f64::from);
                let six = rapier3d_immersed::rapier3d::na::Vector6::from(six);
                0.5 * six.dot(&(matrix * six))
            });
            let energy = energies[0] + energies[1];
            // The start's velocities do not obey the hinge: the first step makes them.
            let start = *start.get_or_insert(energy);
            assert!(energy <= 1.001 * start, "{damping} {n}: {energy} {start}");
        }
    }
}

/// A pendulum on a platform that its user moves in every other step, in a fluid so thin that it must swing as
/// under plain rapier: within a centimeter after five seconds (it was over a meter).
#[test]
fn a_platform_moves_what_hangs_on_it() {
    let run = |fluid: bool| {
        let mut world = PhysicsWorld::new();
        let platform = world.insert_body(RigidBodyBuilder::kinematic_position_based());
        let (ball, _) = world.insert(
            RigidBodyBuilder::dynamic()
                .translation(Vector::Y * -1.0)
                .can_sleep(false),
            ColliderBuilder::ball(0.05).density(2000.0),
        );
        let pivot = SphericalJointBuilder::new().local_anchor2(Vector::Y);
        world.insert_impulse_joint(platform, ball, pivot);
        let mut immersion = Immersion::new(Fluid::new(1e-6, 1e-5).unwrap());
        if fluid {
            immerse(&world, &mut immersion, ball, ViscousLaw::default());
        }
        for n in 0..300 {
            if n % 2 == 0 {
                let at = Vector::X * ((n as f32 / 60.0 * 3.0).sin() * 0.1);
                world.bodies[platform].set_next_kinematic_translation(at);
            }
            immersion.step(&mut world);
        }
        world.bodies[ball].translation()
    };
    let (wet, plain) = (run(true), run(false));
    assert!((wet - plain).length() < 0.01, "{wet} {plain}");
}

/// A tilted disc that carries a load on a joint glides alike whether all steps are equal or not.
#[test]
fn steps_may_change_their_length() {
    let run = |other: f32| {
        let mut world = PhysicsWorld::new();
        let mut immersion = Immersion::new(Fluid::AIR);
        let body = || {
            RigidBodyBuilder::dynamic()
                .lock_rotations()
                .can_sleep(false)
        };
        let (disc, _) = world.insert(
            body().rotation(Vector::Z * 0.4),
            ColliderBuilder::cylinder(0.002, 0.5).mass(0.05),
        );
        let (load, _) = world.insert(
            body().translation(Vector::Y * -1.0),
            ColliderBuilder::ball(0.05).mass(1.0),
        );
        let turn = Pose::from_rotation(Rotation::from_rotation_z(-0.4));
        let frame = turn * Pose::from_translation(-Vector::Y);
        world.insert_impulse_joint(disc, load, FixedJointBuilder::new().local_frame1(frame));
        immerse(&world, &mut immersion, disc, ViscousLaw::default());
        let mut time = 0.0;
        let mut long = true;
        while time < 2.0 {
            let dt = if long { 1.0 / 60.0 } else { other };
            world.integration_parameters.dt = dt;
            immersion.step(&mut world);
            time += dt;
            long = !long;
        }
        world.bodies[disc].linvel()
    };
    let equal = run(1.0 / 60.0);
    for other in [1.0 / 62.0, 1.0 / 75.0, 1.0 / 120.0, 1.0 / 1000.0] {
        let found = run(other);
        assert!(
            (found - equal).length() < 0.05 * equal.length(),
            "{other}: {found} {equal}"
        );
    }
}

/// A multibody's joint that is removed between rapier's step and `after_step` leaves its link the velocity.
#[test]
fn a_joint_may_go_within_a_step() {
    let mut world = PhysicsWorld::new();
    let mut immersion = Immersion::new(Fluid::AIR);
    let post = world.insert_body(RigidBodyBuilder::fixed());
    let (ball, _) = world.insert(
        RigidBodyBuilder::dynamic().translation(Vector::X),
        ColliderBuilder::ball(0.1).density(500.0),
    );
    let pivot = SphericalJointBuilder::new().local_anchor2(-Vector::X);
    let joint = world.insert_multibody_joint(post, ball, pivot).unwrap();
    immerse(&world, &mut immersion, ball, ViscousLaw::default());
    for _ in 0..20 {
        immersion.step(&mut world);
    }
    immersion.before_step(&mut rapier3d_immersed::RapierSets::of(&mut world));
    world.step();
    let before = world.bodies[ball].linvel();
    world.multibody_joints.remove(joint, true);
    immersion.after_step(&mut rapier3d_immersed::RapierSets::of(&mut world));
    let after = world.bodies[ball].linvel();
    assert!(
        before.length() > 1.0 && (after - before).length() < 0.1,
        "{before} {after}"
    );
}
