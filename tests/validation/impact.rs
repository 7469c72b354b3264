//! Impacts with a body whose mass depends on the direction.

use crate::support::weightless;
use rapier3d_immersed::rapier3d::glamx::EulerRot;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, ImmersedBody, Immersion, ViscousLaw};

/// A ball strikes the middle of a plate at rest that drags 20 times its own mass of water along
/// broadside on. Exact, without friction and restitution: along the normal both leave with the
/// common velocity `M v_n/(M + m + A_nn)`; across it nothing changes. For any attitude of the plate
/// and any direction of the ball.
#[test]
fn oblique_impact_with_added_mass_twenty_times_the_mass() {
    for (roll, pitch, sideways) in [(0.0, 0.0, 0.0), (0.4, 0.9, 0.3), (-1.2, 2.0, -0.4)] {
        let mut world = weightless();
        let attitude = Rotation::from_euler(EulerRot::XYZ, roll, pitch, 0.5);
        let half = Vector::new(0.2, 0.2, 0.005);
        let shape = SharedShape::cuboid(half.x, half.y, half.z);
        let hydro = HydroProperties::from_shape(shape.as_ref()).unwrap();
        let added = f64::from(Fluid::WATER.density()) * hydro.added_mass.linear[(2, 2)];
        let mass = added / 20.0;
        let (plate, _) = world.insert(
            RigidBodyBuilder::dynamic().pose(Pose::from_parts(Vector::ZERO, attitude)),
            ColliderBuilder::new(shape)
                .mass(mass as Real)
                .friction(0.0)
                .restitution(0.0),
        );
        let normal = attitude * Vector::Z;
        let across = attitude * Vector::X;
        let (radius, speed, ball_mass) = (0.05, 0.5, 5.0);
        let incoming = (normal * -1.0 + across * sideways).normalize() * speed;
        // It arrives over the middle after 0.1 m.
        let start = normal * (half.z + radius) - incoming * 0.2;
        let (ball, _) = world.insert(
            RigidBodyBuilder::dynamic()
                .translation(start)
                .linvel(incoming),
            ColliderBuilder::ball(radius)
                .mass(ball_mass)
                .friction(0.0)
                .restitution(0.0),
        );
        let body = ImmersedBody::new(hydro)
            .with_law(ViscousLaw::Inviscid)
            .unwrap();
        let mut immersion = Immersion::new(Fluid::WATER);
        immersion.insert(plate, body);
        for _ in 0..24 {
            immersion.step(&mut world);
        }

        let heavy = mass + added;
        let before = f64::from(incoming.dot(normal));
        let common = f64::from(ball_mass) * before / (f64::from(ball_mass) + heavy);
        let after = world.bodies[ball].linvel();
        let ball_normal = f64::from(after.dot(normal));
        let ball_across = after.dot(across);
        assert!(
            (ball_normal / common - 1.0).abs() < 0.01,
            "{ball_normal} {common}"
        );
        assert!((ball_across - incoming.dot(across)).abs() < 0.01 * speed);
        let plate_normal = f64::from(world.bodies[plate].linvel().dot(normal));
        let momentum = f64::from(ball_mass) * ball_normal + heavy * plate_normal;
        let total = f64::from(ball_mass) * before;
        assert!((momentum / total - 1.0).abs() < 0.01, "{momentum} {total}");
    }
}

/// The same plate lying on the floor under water comes to rest, falls asleep, and sleeps at no cost
/// until something wakes it.
#[test]
fn a_plate_settles_and_sleeps() {
    let mut world = PhysicsWorld::new();
    world.insert(
        RigidBodyBuilder::fixed().translation(Vector::Y * -0.5),
        ColliderBuilder::cuboid(5.0, 0.5, 5.0),
    );
    let (plate, _) = world.insert(
        RigidBodyBuilder::dynamic()
            .translation(Vector::Y * 0.1)
            .rotation(Vector::X * 0.1),
        ColliderBuilder::cuboid(0.1, 0.005, 0.1).density(2700.0),
    );
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, plate).unwrap();
    let mut immersion = Immersion::new(Fluid::WATER);
    immersion.insert(plate, hydro);
    for _ in 0..600 {
        immersion.step(&mut world);
    }
    let body = &world.bodies[plate];
    assert!(body.is_sleeping(), "{} {}", body.linvel(), body.angvel());
    let height = body.translation().y;
    assert!((0.0..0.01).contains(&height), "{height}");
}

/// A sphere that sinks at 2 cm/s, below rapier's sleeping threshold, does not fall asleep in mid
/// water.
#[test]
fn no_sleep_in_mid_water() {
    let mut world = PhysicsWorld::new();
    let (ball, _) = world.insert(
        RigidBodyBuilder::dynamic(),
        ColliderBuilder::ball(0.01).density(Fluid::WATER.density() * 1.001),
    );
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, ball).unwrap();
    let mut immersion = Immersion::new(Fluid::WATER);
    immersion.insert(ball, hydro);
    for _ in 0..600 {
        immersion.step(&mut world);
    }
    let body = &world.bodies[ball];
    assert!(!body.is_sleeping());
    assert!(
        (0.01..0.05).contains(&-body.linvel().y),
        "{}",
        body.linvel()
    );
}
