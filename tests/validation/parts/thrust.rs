//! Control surfaces, thrusters, and volume at run time.

use rapier3d_immersed::rapier3d::na::{Isometry3, Vector3};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{
    Fluid, ForceFactors, Hinge, HydroProperties, ImmersedBody, Immersion, Part, Propeller, Thruster,
};

fn boat(
    body: impl Fn(HydroProperties) -> ImmersedBody,
) -> (PhysicsWorld, Immersion, RigidBodyHandle) {
    let mut world = PhysicsWorld {
        gravity: Vector::ZERO,
        ..PhysicsWorld::new()
    };
    let hull = ColliderBuilder::cuboid(0.5, 0.1, 0.1).density(997.0);
    let (handle, _) = world.insert(RigidBodyBuilder::dynamic(), hull);
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
    let mut immersion = Immersion::new(Fluid::WATER);
    immersion.insert(handle, body(hydro));
    (world, immersion, handle)
}

fn rudder(hydro: HydroProperties) -> ImmersedBody {
    let blade = HydroProperties::from_shape(&Cuboid::new(Vector::new(0.05, 0.1, 0.002))).unwrap();
    let blade = Part::new(blade)
        .at(Isometry3::translation(-0.55, 0.0, 0.0))
        .with_hinge(Hinge::new(Vector3::new(-0.5, 0.0, 0.0), Vector3::y()).unwrap());
    ImmersedBody::new(hydro.clone()).with_parts([Part::new(hydro), blade])
}

/// A rudder turns a boat that runs, to the side that it is laid to, and with it amidships the boat runs straight; the deflection
/// is undone when it is set back. A wing whose forces are multiplied by nothing has none.
#[test]
fn rudders_steer() {
    let run = |angle: f32, factors: ForceFactors| {
        let (mut world, mut immersion, handle) = boat(rudder);
        world.bodies[handle].set_linvel(Vector::X * 2.0, true);
        immersion.set_deflection(handle, 1, angle);
        immersion.set_part_control(handle, 1, factors);
        (0..30).for_each(|_| immersion.step(&mut world));
        assert_eq!(immersion.warnings(), []);
        world.bodies[handle].angvel().y
    };
    let straight = run(0.0, ForceFactors::ONE);
    assert!(straight.abs() < 1e-5, "{straight}");
    // A right-handed turn about +y moves the rudder's trailing edge (−x) to +z: its force is to −z and the bow goes to +z,
    // a turn about −y.
    let (left, right) = (run(0.3, ForceFactors::ONE), run(-0.3, ForceFactors::ONE));
    assert!(
        left < -0.05 && (left + right).abs() < 1e-3 * left.abs(),
        "{left} {right}"
    );
    let off = run(
        0.3,
        ForceFactors {
            drag: 0.0,
            rotational_lift: 0.0,
            translational_lift: 0.0,
        },
    );
    assert!(off.abs() < 1e-5, "{off}");
    let (_, mut immersion, handle) = boat(rudder);
    for nothing in [f32::NAN, f32::INFINITY] {
        immersion.set_deflection(handle, 1, nothing);
    }
    immersion.set_deflection(handle, 0, 0.3);
    immersion.set_deflection(handle, 7, 0.3);
    assert_eq!(immersion.deflection(handle, 0), Some(0.0));
    assert_eq!(immersion.deflection(handle, 1), Some(0.0));
    assert_eq!(immersion.deflection(handle, 7), None);
}

/// A thruster pushes with its force along its direction, which turns with the body, and by its lever; the read-out says so.
#[test]
fn thrusters_push() {
    let point = Vector3::new(-0.5, 0.0, 0.2);
    let (mut world, mut immersion, handle) = boat(|hydro| {
        ImmersedBody::new(hydro).with_thrusters([Thruster::new(point, Vector3::x()).unwrap()])
    });
    let turn = Vector::new(0.0, 0.7, 0.0);
    world.bodies[handle].set_rotation(Rotation::from_scaled_axis(turn), true);
    immersion.set_thrust(handle, 0, 30.0);
    immersion.step(&mut world);
    let thrust = immersion.forces(&world.bodies, handle).unwrap().thrust;
    let attitude = *world.bodies[handle].rotation();
    assert!((thrust.force - attitude * Vector::X * 30.0).length() < 0.01);
    assert!((thrust.torque - attitude * Vector::Y * (0.2 * 30.0)).length() < 0.01);
    let mass = immersion.mass_matrix_of(handle).unwrap();
    let speed = f64::from(world.bodies[handle].linvel().length());
    let exact = 30.0 / mass[(0, 0)] / 60.0;
    assert!((speed / exact - 1.0).abs() < 0.02, "{speed} {exact}");
    immersion.set_thrust(handle, 0, f64::NAN);
    immersion.set_thrust(handle, 3, 1.0);
    assert_eq!(immersion.thrust(handle, 0), Some(30.0));
}

/// A propeller drives a boat to the speed where its thrust `ρn²D⁴(k₀ − k₁J)` is the drag that the same boat shows when it runs at it,
/// and rolls it by its torque.
#[test]
fn propellers_reach_a_speed() {
    let screw = Propeller::new(0.1, [0.4, 0.45], [0.05, 0.04]).unwrap();
    let (mut world, mut immersion, handle) = boat(|hydro| {
        let thruster = Thruster::new(Vector3::new(-0.5, 0.0, 0.0), Vector3::x()).unwrap();
        ImmersedBody::new(hydro).with_thrusters([thruster.with_propeller(screw)])
    });
    world.bodies[handle].set_locked_axes(LockedAxes::ROTATION_LOCKED, true);
    immersion.set_thrust(handle, 0, 20.0);
    (0..1200).for_each(|_| immersion.step(&mut world));
    let speed = f64::from(world.bodies[handle].linvel().x);
    let forces = immersion.forces(&world.bodies, handle).unwrap();
    let thrust = 997.0 * 400.0 * 0.1f64.powi(4) * (0.4 - 0.45 * speed / 2.0);
    let drag = f64::from(-forces.viscous().force.x);
    assert!(
        speed > 0.3 && (thrust / drag - 1.0).abs() < 0.02,
        "{speed}: {thrust} {drag}"
    );
    let torque = f64::from(forces.thrust.torque.x);
    let exact = -997.0 * 400.0 * 0.1f64.powi(5) * (0.05 - 0.04 * speed / 2.0);
    assert!((torque / exact - 1.0).abs() < 0.02, "{torque} {exact}");
}

/// A propeller that turns far too fast for a body of 4 g, at half a second per step: braked, not blown up.
#[test]
fn fast_propellers_on_light_bodies() {
    let screw = Propeller::new(0.05, [0.4, 0.45], [0.0, 0.0]).unwrap();
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = 0.5;
    let (handle, _) = world.insert(
        RigidBodyBuilder::dynamic().linvel(Vector::X * -20.0),
        ColliderBuilder::ball(0.01).density(1000.0),
    );
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
    let thruster = Thruster::new(Vector3::zeros(), Vector3::x()).unwrap();
    let body = ImmersedBody::new(hydro).with_thrusters([thruster.with_propeller(screw)]);
    let mut immersion = Immersion::new(Fluid::WATER);
    immersion.insert(handle, body);
    immersion.set_thrust(handle, 0, 1e3);
    for _ in 0..200 {
        immersion.step(&mut world);
        let speed = world.bodies[handle].linvel().length();
        // The pitch is 0.4/0.45 D: no faster than n times that, but for what it falls.
        assert!(speed < 60.0, "{speed}");
    }
}

/// A swim bladder of a body that is as heavy as the water: so much more volume, so much lift, and the body wakes for it.
#[test]
fn extra_volume_lifts() {
    let mut world = PhysicsWorld::new();
    let (handle, _) = world.insert(
        RigidBodyBuilder::dynamic(),
        ColliderBuilder::cuboid(0.5, 0.1, 0.1).density(997.0),
    );
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
    let volume = hydro.volume;
    let mut immersion = Immersion::new(Fluid::WATER);
    immersion.insert(handle, hydro);
    immersion.step(&mut world);
    let before = immersion
        .forces(&world.bodies, handle)
        .unwrap()
        .buoyancy
        .force
        .y;
    immersion.set_extra_volume(handle, 0.1 * volume);
    immersion.step(&mut world);
    let after = immersion
        .forces(&world.bodies, handle)
        .unwrap()
        .buoyancy
        .force
        .y;
    assert!((after / before - 1.1).abs() < 1e-3, "{before} {after}");
    (0..30).for_each(|_| immersion.step(&mut world));
    assert!(world.bodies[handle].linvel().y > 0.05);
    immersion.set_extra_volume(handle, -0.1 * volume);
    (0..120).for_each(|_| immersion.step(&mut world));
    assert!(world.bodies[handle].linvel().y < -0.05);
}
