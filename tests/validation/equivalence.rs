//! A body that flies freely in a rapier world moves as the crate's own integrator moves it.

use crate::support::{solid_box, weightless};
use rapier3d_immersed::rapier3d::na::{Quaternion, UnitQuaternion, Vector3};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, FreeBody, HydroProperties, Immersion, ViscousLaw};

fn vector(v: Vector) -> Vector3<f64> {
    Vector3::new(v.x.into(), v.y.into(), v.z.into())
}

fn quaternion(q: &Rotation) -> UnitQuaternion<f64> {
    UnitQuaternion::from_quaternion(Quaternion::new(
        q.w.into(),
        q.x.into(),
        q.y.into(),
        q.z.into(),
    ))
}

/// A leaf in air under gravity at 240 Hz, and a large card at 60 Hz: both turn by up to a quarter of
/// a radian per step. Each step of rapier is compared with a step of the f64 integrator
/// from the same state: velocities to 10⁻⁵ of the speed, pose within what the bound
/// 0.125·|Δv|·dt allows. (Step by step, because a falling leaf is too sensitive for a whole path.)
#[test]
fn step_by_step() {
    for (dt, size) in [
        (1.0 / 240.0, [0.073, 0.042, 0.0003]),
        (1.0 / 60.0, [0.3, 0.2, 0.001]),
    ] {
        let mut world = weightless();
        world.gravity = Vector::new(0.0, 0.0, -9.81);
        world.integration_parameters.dt = dt;
        let half = size.map(|x| (x / 2.0) as Real);
        let start = Rotation::from_euler(
            rapier3d_immersed::rapier3d::glamx::EulerRot::XYZ,
            0.3,
            0.5,
            0.1,
        );
        let (handle, _) = world.insert(
            RigidBodyBuilder::dynamic().pose(Pose::from_parts(Vector::ZERO, start)),
            ColliderBuilder::cuboid(half[0], half[1], half[2]).density(300.0),
        );
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
        let (body, mass) = solid_box(size, 300.0, ViscousLaw::default());
        let mut reference = FreeBody::new(&body, &mass, &Fluid::AIR).unwrap();
        reference.set_orientation(quaternion(&start));
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.insert(handle, hydro);

        let (mut worst_v, mut worst_w, mut worst_x, mut worst_q): (f64, f64, f64, f64) =
            Default::default();
        for _ in 0..(3.0 / dt) as usize {
            immersion.step(&mut world);
            let before = reference.linear_velocity();
            reference.step(f64::from(dt), Vector3::new(0.0, 0.0, -9.81));
            let rapier = &world.bodies[handle];
            let (v, w) = (reference.linear_velocity(), reference.angular_velocity());
            let kick = (v - before).norm() * f64::from(dt);
            worst_v = worst_v.max((vector(rapier.linvel()) - v).norm() / v.norm());
            worst_w = worst_w.max((vector(rapier.angvel()) - w).norm() / w.norm().max(1.0));
            let bound = 0.125 * kick + 1e-6 * v.norm() * f64::from(dt);
            let moved = vector(rapier.center_of_mass());
            worst_x = worst_x.max((moved - reference.position).norm() / bound);
            let turned = quaternion(rapier.rotation()).angle_to(&reference.orientation());
            worst_q = worst_q.max(turned);
            // Both go on from rapier's state, with the integrator's own memory kept.
            reference.follow(
                moved,
                quaternion(rapier.rotation()),
                vector(rapier.linvel()),
                vector(rapier.angvel()),
            );
        }
        let worst = (worst_v, worst_w, worst_x, worst_q);
        assert!(
            worst_v < 1e-5 && worst_w < 1e-5 && worst_x < 1.0 && worst_q < 1e-4,
            "{dt}: {worst:?}"
        );
    }
}

/// A card of 0.3 g whose collider is turned and shifted in its body, and one of two colliders: they
/// fly as the card does whose collider sits at the origin. (Carried as additional mass properties,
/// their inertia came out with two principal moments exchanged, and they spun up.)
#[test]
fn the_pose_of_the_collider_does_not_matter() {
    let half = [0.0365, 0.000_15, 0.021];
    let lying = Rotation::from_scaled_axis(Vector::new(0.3, 0.0, 0.2));
    let fly = |turn: Rotation, shift: Vector, parts: usize| {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = 1.0 / 240.0;
        // The body is turned back, so that the card itself lies the same in the world.
        let pose = Pose::from_parts(Vector::ZERO, lying) * Pose::from_parts(shift, turn).inverse();
        let handle = world.insert_body(RigidBodyBuilder::dynamic().pose(pose));
        let width = half[2] / parts as Real;
        for part in 0..parts {
            let z = width * (2 * part + 1) as Real - half[2];
            let place = Pose::from_parts(shift, turn) * Pose::from_translation(Vector::Z * z);
            let card = ColliderBuilder::cuboid(half[0], half[1], width).density(300.0);
            world.insert_collider(card.position(place), Some(handle));
        }
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.insert(handle, hydro);
        // Short: a falling card forgets where it came from.
        for _ in 0..100 {
            immersion.step(&mut world);
        }
        let body = &world.bodies[handle];
        (body.center_of_mass(), body.angvel())
    };
    let (place, spin) = fly(Rotation::IDENTITY, Vector::ZERO, 1);
    assert!(spin.length() > 1.0);
    let turn = Rotation::from_scaled_axis(Vector::new(-1.3, 0.4, 0.7));
    let shift = Vector::new(0.02, -0.01, 0.03);
    for (turn, shift, parts) in [
        (turn, Vector::ZERO, 1),
        (Rotation::IDENTITY, shift, 1),
        (turn, shift, 1),
        (turn, shift, 2),
    ] {
        let (other, other_spin) = fly(turn, shift, parts);
        assert!((other - place).length() < 2e-3, "{parts}: {other} {place}");
        assert!(
            (other_spin - spin).length() < 0.05 * spin.length(),
            "{other_spin} {spin}"
        );
    }
}
