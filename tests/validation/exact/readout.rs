//! The components of the force are those that move the body: their sum is m dv/dt, and the sum of their torques
//! the change of the body's own angular momentum, also where the fluid's inertia couples the two.

use super::off_center::lopsided;
use rapier3d_immersed::rapier3d::math::Vector;
use rapier3d_immersed::rapier3d::na::{UnitQuaternion, Vector3};
use rapier3d_immersed::{
    Fluid, ForceAndTorque, ForceFactors, FreeBody, PhysicalLaw, StochasticLaw, ThesisLaw,
    ViscousLaw,
};

fn vector(v: Vector) -> Vector3<f64> {
    Vector3::new(v.x, v.y, v.z).map(f64::from)
}

/// The acceleration is that of the step just made, the forces are those at its end: first order in a step that is
/// 1e-4 of what it takes to turn once, so that 1e-3 of the largest component are left.
#[test]
fn components_add_up_for_a_lopsided_body() {
    let laws = [
        ViscousLaw::Inviscid,
        ViscousLaw::Physical(PhysicalLaw {
            munk: 0.4,
            ..PhysicalLaw::default()
        }),
        ViscousLaw::Stochastic(StochasticLaw::default()),
        ViscousLaw::Thesis(ThesisLaw::default()),
    ];
    for law in laws {
        let (body, dry) = lopsided(law);
        let mut body = FreeBody::new(&body, &dry, &Fluid::WATER).unwrap();
        body.set_orientation(UnitQuaternion::from_euler_angles(0.4, -0.9, 0.3));
        body.set_velocity(Vector3::new(0.4, -0.3, 0.5), Vector3::new(2.0, 1.0, -1.5));
        let gravity = Vector3::new(0.0, -9.81, 0.0);
        let dt = 2e-5;
        let own = |body: &FreeBody| {
            let turn = body.orientation();
            let spin = turn.inverse() * body.angular_velocity();
            (
                body.linear_velocity() * dry.mass,
                turn * (dry.inertia * spin),
            )
        };
        for step in 0..20_000 {
            let (linear, angular) = own(&body);
            body.step(dt, gravity);
            if step % 2000 != 1999 {
                continue;
            }
            let (linear_after, angular_after) = own(&body);
            let f = body.forces(gravity);
            let parts = [
                f.added_mass,
                f.drag,
                f.translational_lift,
                f.rotational_lift,
                f.damping,
                f.buoyancy,
                f.weight,
            ];
            let sum = parts
                .iter()
                .fold(ForceAndTorque::default(), |sum, part| sum + *part);
            let largest = |of: fn(&ForceAndTorque) -> Vector| {
                parts
                    .iter()
                    .map(|part| of(part).length())
                    .fold(0.0, f32::max)
            };
            let force = (linear_after - linear) / dt;
            let torque = (angular_after - angular) / dt;
            let miss = (vector(sum.force) - force).norm();
            let twist = (vector(sum.torque) - torque).norm();
            let most = f64::from(largest(|part| part.force));
            assert!(miss < 1e-3 * most, "{law:?} {step}: {miss} of {most}");
            let most = f64::from(largest(|part| part.torque));
            assert!(twist < 1e-3 * most, "{law:?} {step}: {twist} of {most}");
        }
    }
}

/// To turn a body is not to turn its velocities.
#[test]
fn velocities_stay_when_the_body_is_turned() {
    let (body, dry) = lopsided(ViscousLaw::Inviscid);
    let mut body = FreeBody::new(&body, &dry, &Fluid::WATER).unwrap();
    let (v, w) = (Vector3::new(0.4, -0.3, 0.5), Vector3::new(2.0, 1.0, -1.5));
    body.set_velocity(v, w);
    let turn = UnitQuaternion::from_euler_angles(0.4, -0.9, 0.3);
    body.set_orientation(turn);
    assert!((body.linear_velocity() - v).norm() < 1e-12);
    assert!((body.angular_velocity() - w).norm() < 1e-12);
    assert!(body.orientation().angle_to(&turn) < 1e-7);
}

/// Factors on the forces show in the read-out: the drag's, creeping flow included, the two lifts', and no other.
#[test]
fn factors_show() {
    for law in [
        ViscousLaw::default(),
        ViscousLaw::Thesis(ThesisLaw::default()),
    ] {
        let (body, dry) = lopsided(law);
        let mut body = FreeBody::new(&body, &dry, &Fluid::WATER).unwrap();
        body.set_velocity(Vector3::new(0.4, -0.3, 0.5), Vector3::new(2.0, 1.0, -1.5));
        let gravity = Vector3::new(0.0, -9.81, 0.0);
        let plain = body.forces(gravity);
        body.control = ForceFactors {
            drag: 2.0,
            rotational_lift: 4.0,
            translational_lift: -0.5,
        };
        let found = body.forces(gravity);
        for (found, plain, factor) in [
            (found.drag, plain.drag, 2.0),
            (found.rotational_lift, plain.rotational_lift, 4.0),
            (found.translational_lift, plain.translational_lift, -0.5),
            (found.damping, plain.damping, 1.0),
            (found.buoyancy, plain.buoyancy, 1.0),
            (found.weight, plain.weight, 1.0),
        ] {
            // Powers of two do not round.
            assert_eq!(found.force, plain.force * factor);
            assert_eq!(found.torque, plain.torque * factor);
        }
        assert_ne!(plain.rotational_lift.force, Vector::ZERO);
    }
}

/// A body that follows a state has it and keeps the integrator's memory: following its own state changes nothing.
#[test]
fn a_body_follows_its_own_state() {
    let (body, dry) = lopsided(ViscousLaw::default());
    let mut body = FreeBody::new(&body, &dry, &Fluid::WATER).unwrap();
    let gravity = Vector3::new(0.0, -9.81, 0.0);
    body.set_velocity(Vector3::new(0.4, -0.3, 0.5), Vector3::new(2.0, 1.0, -1.5));
    (0..30).for_each(|_| body.step(0.01, gravity));
    let mut other = body.clone();
    let (v, w) = (body.linear_velocity(), body.angular_velocity());
    other.follow(body.position, body.orientation(), v, w);
    let elsewhere = Vector3::new(1.0, 2.0, 3.0);
    let mut moved = body.clone();
    moved.follow(elsewhere, body.orientation(), w, v);
    assert_eq!(moved.position, elsewhere);
    assert!((moved.linear_velocity() - w).norm() < 1e-12);
    assert!((moved.angular_velocity() - v).norm() < 1e-12);
    for _ in 0..30 {
        body.step(0.01, gravity);
        other.step(0.01, gravity);
        assert!((body.position - other.position).norm() < 1e-9);
        assert!((body.angular_velocity() - other.angular_velocity()).norm() < 1e-7);
    }
    // Without its memory it would go another way.
    let mut forgetful = body.clone();
    forgetful.set_velocity(body.linear_velocity(), body.angular_velocity());
    (0..2).for_each(|_| {
        body.step(0.01, gravity);
        forgetful.step(0.01, gravity);
    });
    assert!((body.linear_velocity() - forgetful.linear_velocity()).norm() > 1e-6);
}

/// Setting the velocity of a body forgets what it did before: it goes on as a new one.
#[test]
fn setting_the_velocity_forgets() {
    let (body, dry) = lopsided(ViscousLaw::default());
    let mut new = FreeBody::new(&body, &dry, &Fluid::WATER).unwrap();
    let mut used = new.clone();
    let gravity = Vector3::new(0.0, -9.81, 0.0);
    (0..30).for_each(|_| used.step(0.01, gravity));
    used.position = Vector3::zeros();
    used.set_orientation(UnitQuaternion::identity());
    used.set_velocity(Vector3::zeros(), Vector3::zeros());
    for _ in 0..10 {
        used.step(0.01, gravity);
        new.step(0.01, gravity);
        assert!((used.position - new.position).norm() < 1e-12);
        assert!((used.linear_velocity() - new.linear_velocity()).norm() < 1e-12);
    }
}

/// Components are added and subtracted force by force and torque by torque.
#[test]
fn components_are_vectors() {
    let of = |x: f32, y: f32| ForceAndTorque {
        force: Vector::new(x, 0.0, 1.0),
        torque: Vector::new(0.0, y, 2.0),
    };
    let difference = ForceAndTorque {
        force: Vector::X * 2.0,
        torque: Vector::Y * -5.0,
    };
    assert_eq!(of(3.0, -1.0) - of(1.0, 4.0), difference);
    assert_eq!(of(1.0, 4.0) + difference, of(3.0, -1.0));
}
