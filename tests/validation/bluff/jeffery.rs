//! Ellipsoids that a shear flow turns, at no Reynolds number to speak of: Jeffery's orbits.

use super::ellipsoid;
use crate::support::weightless;
use rapier3d_immersed::flow::{Flow, FlowSample, Shear, StrainRate};
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, FreeBody, HydroProperties, Immersion};
use std::f64::consts::{PI, TAU};

/// So thick that inertia is nothing: Re = 10⁻⁴.
fn syrup() -> Fluid {
    Fluid::new(1000.0, 0.1).unwrap()
}

/// Flow along x that grows along y at this rate, 1/s.
const RATE: Real = 1.0;

fn shear() -> Shear {
    Shear {
        across: Vector::Y,
        rate: Vector::X * RATE,
        ..Shear::default()
    }
}

/// In shear a spheroid turns with the period (2π/γ̇)(r + 1/r) (Jeffery 1922): 32.7/γ̇ at r = 5, 63.5/γ̇ at
/// r = 10; with the vorticity alone it would be 4π/γ̇ for every r. Half a turn from along the flow to along
/// the flow is half of it; on the way the angle is tan φ = r tan(…) there, far from uniform.
#[test]
fn spheroids_tumble_with_jefferys_period() {
    for ratio in [5.0, 10.0, 0.2] {
        let (a, b) = if ratio > 1.0 {
            (1e-3, 1e-3 / ratio)
        } else {
            (1e-3 * ratio, 1e-3)
        };
        let (body, mass) = ellipsoid([a, b, b], 1000.0);
        let flow = FlowSample {
            velocity: Vector::ZERO,
            vorticity: Vector::Z * -RATE,
            strain: shear().strain_rate(Vector::ZERO, 0.0, 1e-3),
        };
        let mut free = FreeBody::new(&body, &mass, &syrup()).unwrap();
        let exact = TAU / f64::from(RATE) * (ratio + 1.0 / ratio);
        let dt = exact / 4000.0;
        let (mut turned, mut steps) = (0.0, 0);
        let mut rates = (f64::INFINITY, 0.0_f64);
        while turned < TAU && steps < 40_000 {
            free.step_in(dt, Vector3::zeros(), &flow);
            let spin = -free.angular_velocity().z;
            rates = (rates.0.min(spin), rates.1.max(spin));
            turned += spin * dt;
            steps += 1;
        }
        let period = f64::from(steps) * dt;
        assert!(
            (period / exact - 1.0).abs() < 0.05,
            "{ratio}: {period} {exact}"
        );
        // Along the flow it turns with γ̇/(r² + 1), across it with r² times that.
        let long = ratio.max(1.0 / ratio);
        let slow = f64::from(RATE) / (long * long + 1.0);
        assert!(
            (rates.0 / slow - 1.0).abs() < 0.05,
            "{ratio}: {rates:?} {slow}"
        );
        let fast = slow * long * long;
        assert!(
            (rates.1 / fast - 1.0).abs() < 0.05,
            "{ratio}: {rates:?} {fast}"
        );
    }
}

/// The same through rapier, where the step takes the strain from differences of the flow's velocity; and a
/// body at a thousand times the Reynolds number is not asked about it.
#[test]
fn spheroids_tumble_in_an_immersion() {
    let (body, mass) = ellipsoid([1e-2, 2e-3, 2e-3], 1000.0);
    let exact = TAU / f64::from(RATE) * 5.2;
    let dt = exact / 1600.0;
    let mut world = weightless();
    world.integration_parameters.dt = dt as Real;
    let collider = ColliderBuilder::ball(2e-3).mass_properties(mass.to_mass_properties());
    let (handle, _) = world.insert(RigidBodyBuilder::dynamic().can_sleep(false), collider);
    let mut immersion = Immersion::new(syrup());
    immersion.insert(handle, body);
    immersion.set_flow(shear());
    let (mut turned, mut steps) = (0.0, 0);
    while turned < PI && steps < 10_000 {
        immersion.step(&mut world);
        turned -= f64::from(world.bodies[handle].angvel().z) * dt;
        steps += 1;
    }
    let period = 2.0 * f64::from(steps) * dt;
    assert!((period / exact - 1.0).abs() < 0.05, "{period} {exact}");
}

/// Counts how often it is asked for its strain.
struct Counting(std::sync::Arc<std::sync::atomic::AtomicUsize>);

impl Flow for Counting {
    fn velocity(&self, point: Vector, time: f64) -> Vector {
        shear().velocity(point, time)
    }

    fn strain_rate(&self, point: Vector, time: f64, reach: Real) -> StrainRate {
        self.0.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        shear().strain_rate(point, time, reach)
    }
}

/// Only what creeps is asked about: a pebble in water is not, a grain in syrup is, once per step.
#[test]
fn strain_is_paid_for_where_it_is_felt() {
    for (fluid, size, asked) in [(Fluid::WATER, 0.05, 0), (syrup(), 1e-3, 60)] {
        let count = std::sync::Arc::<std::sync::atomic::AtomicUsize>::default();
        let mut world = weightless();
        let body = RigidBodyBuilder::dynamic()
            .translation(Vector::Y * 0.2)
            .can_sleep(false);
        let collider = ColliderBuilder::cuboid(size, 0.5 * size, 0.5 * size).density(1000.0);
        let (body, _) = world.insert(body, collider);
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, body).unwrap();
        let mut immersion = Immersion::new(fluid);
        immersion.set_flow(Counting(count.clone()));
        immersion.insert(body, hydro);
        (0..60).for_each(|_| immersion.step(&mut world));
        assert_eq!(count.load(std::sync::atomic::Ordering::Relaxed), asked);
    }
}

/// Differences find the strain of a flow that has all of its components, whichever way round they are.
#[test]
fn differences_find_the_strain() {
    struct Linear;
    impl Flow for Linear {
        fn velocity(&self, p: Vector, _time: f64) -> Vector {
            Vector::new(
                p.x + 2.0 * p.y + 3.0 * p.z,
                4.0 * p.x - 3.0 * p.y + 5.0 * p.z,
                6.0 * p.x + 7.0 * p.y + 2.0 * p.z,
            )
        }
    }
    let found = Linear.strain_rate(Vector::new(0.3, -0.2, 0.1), 0.0, 0.05);
    let expected = StrainRate {
        stretching: Vector::new(1.0, -3.0, 2.0),
        shearing: Vector::new(6.0, 4.5, 3.0),
    };
    assert!((found.stretching - expected.stretching).length() < 1e-3);
    assert!((found.shearing - expected.shearing).length() < 1e-3);
}
