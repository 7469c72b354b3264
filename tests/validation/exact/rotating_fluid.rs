//! Fluid that turns like a solid at the rate Ω has the vorticity 2Ω, and what turns with it feels nothing of
//! its friction. A sphere at its center is spun up as Stokes says: I ω̇ = −8πμa³ (ω − Ω).

use super::sphere;
use crate::support::weightless;
use rapier3d_immersed::flow::{Flow, FlowSample};
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, FreeBody, HydroProperties, Immersion};

/// Rate of the fluid's rotation, rad/s.
const RATE: Real = 3.0;
const RADIUS: f64 = 0.05;

/// Solid-body rotation about x.
struct Turntable;

impl Flow for Turntable {
    fn velocity(&self, point: Vector, _time: f64) -> Vector {
        (Vector::X * RATE).cross(point)
    }

    fn vorticity(&self, _point: Vector, _time: f64) -> Vector {
        Vector::X * (2.0 * RATE)
    }
}

/// Thick like honey, so that the law's turbulent terms, which a sphere has about z only, are small even
/// there.
fn fluid() -> Fluid {
    Fluid::new(1000.0, 1e-3).unwrap()
}

/// Relaxation time of the spin, s: I/(8πμa³) with the semi-axis that the law uses.
fn relaxation(hydro: &HydroProperties, inertia: f64) -> f64 {
    let viscosity = f64::from(fluid().dynamic_viscosity());
    let a = hydro.proxy.semi_axes.x;
    inertia / (8.0 * std::f64::consts::PI * viscosity * a.powi(3))
}

/// A sphere at rest is spun up exponentially; at the fluid's own rate it keeps on turning.
#[test]
fn a_free_sphere_is_spun_up() {
    let (body, mass) = sphere(RADIUS, 1000.0);
    let time = relaxation(&body.hydro, mass.inertia[(0, 0)]);
    let flow = FlowSample {
        velocity: Vector::ZERO,
        vorticity: Vector::X * (2.0 * RATE),
        ..FlowSample::default()
    };
    let rate = f64::from(RATE);
    for start in [0.0, rate, -2.0 * rate] {
        let mut body = FreeBody::new(&body, &mass, &fluid()).unwrap();
        body.set_velocity(Vector3::zeros(), Vector3::x() * start);
        let steps = 1000;
        for step in 1..=steps {
            body.step_in(time / 500.0, Vector3::zeros(), &flow);
            let exact = rate + (start - rate) * (-f64::from(step) / 500.0).exp();
            let miss = (body.angular_velocity() - Vector3::x() * exact).norm();
            // Second order: (dt/τ)²/12 of the way per τ, 3e-7.
            assert!(miss < 1e-6 * rate, "{step}: {miss}");
        }
    }
}

/// The same in a rapier world, on the axis of the turntable.
#[test]
fn a_sphere_on_the_turntable() {
    for start in [0.0, RATE] {
        let mut world = weightless();
        world.integration_parameters.dt = 1.0 / 480.0;
        let (handle, _) = world.insert(
            RigidBodyBuilder::dynamic().angvel(Vector::X * start),
            ColliderBuilder::ball(RADIUS as Real).density(fluid().density()),
        );
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
        let inertia = 0.4 * f64::from(world.bodies[handle].mass()) * RADIUS * RADIUS;
        let time = relaxation(&hydro, inertia);
        let mut immersion = Immersion::new(fluid());
        immersion.set_flow(Turntable);
        immersion.insert(handle, hydro);
        for step in 1..=240 {
            immersion.step(&mut world);
            let at = f64::from(step) / 480.0;
            let exact = RATE + (start - RATE) * (-at / time).exp() as Real;
            let found = world.bodies[handle].angvel();
            assert!(
                (found - Vector::X * exact).length() < 1e-3 * RATE,
                "{step}: {found} {exact}"
            );
        }
        // The read-out agrees: the torque is that of the spin relative to the fluid.
        let spin = world.bodies[handle].angvel().x - RATE;
        let torque = -f64::from(spin) * inertia / time;
        let read = immersion.forces(&world.bodies, handle).unwrap();
        let full = f64::from(RATE) * inertia / time;
        let miss = f64::from(read.damping.torque.x) - torque;
        assert!(miss.abs() < 1e-3 * full, "{miss} {full}");
    }
}
