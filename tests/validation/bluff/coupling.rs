//! The coupling of motions by the added mass: potential flow gives it, and a law may weaken only what of it
//! separated flow takes away, and only for bodies behind which the flow is separated.

use super::{accelerations, ellipsoid, to_f64};
use crate::support::{solid_box, sphere};
use rapier3d_immersed::flow::FlowSample;
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::rapier3d::prelude::Vector;
use rapier3d_immersed::training::{BodyInWorld, BodyState};
use rapier3d_immersed::{
    AddedMass, DryMass, Fluid, FreeBody, ImmersedBody, PhysicalLaw, ViscousLaw,
};

/// A body with an added mass that is the same in all directions about its middle, half of its volume's: a
/// sphere as the law's coupling sees it. As a slab it has a law that weakens the coupling of thin bodies.
fn isotropic_slab(law: PhysicalLaw) -> (ImmersedBody, DryMass) {
    let law = ViscousLaw::Physical(law);
    let (mut body, mass) = solid_box([0.2, 0.1, 0.04], 2000.0, law);
    let half = Vector3::repeat(0.5 * body.hydro.volume);
    let isotropic = AddedMass::diagonal(half, Vector3::zeros());
    body.hydro = body.hydro.with_added_mass(isotropic).unwrap();
    (body, mass)
}

/// Without Magnus force a spinning sphere in a stream is pushed by nothing across it: a mass that is the
/// same in all directions couples no motion to another. Were the law's whole coupling scaled by `munk`, there
/// would be a lift of ½ρV (1 − munk) ω × u.
#[test]
fn a_spinning_sphere_has_no_lift() {
    let law = PhysicalLaw {
        magnus: 0.0,
        ..PhysicalLaw::default()
    };
    let (mut body, mass) = sphere(0.05, 1500.0);
    body.law = ViscousLaw::Physical(law);
    let mut free = FreeBody::new(&body, &mass, &Fluid::WATER).unwrap();
    let (u, w): (Vector3<f64>, Vector3<f64>) = (
        Vector3::new(0.5, -1.5, 2.0),
        Vector3::new(30.0, 40.0, -70.0),
    );
    free.set_velocity(u, w);
    let (acceleration, _) = accelerations(&free);
    let across = w.cross(&u);
    let lift = acceleration.dot(&across) / across.norm();
    let weakened = across.norm() * f64::from(Fluid::WATER.density()) * body.hydro.volume * 0.5
        / (mass.mass * 1.5);
    // The facets of its surface are not the same all around.
    assert!(lift.abs() < 1e-3 * weakened, "{lift} {weakened}");
    // Nor is there one in the law of a slab.
    let (slab, mass) = isotropic_slab(PhysicalLaw { munk: 0.0, ..law });
    let mut free = FreeBody::new(&slab, &mass, &Fluid::WATER).unwrap();
    free.set_velocity(u, w);
    let inertia = to_f64(free.forces(Vector3::zeros()).added_mass.force);
    let weakened = across * (f64::from(Fluid::WATER.density()) * slab.hydro.volume * 0.5);
    assert!(inertia.norm() < 1e-6 * weakened.norm(), "{inertia}");
}

/// The fluid's inertia where the center of mass is off the middle, in a steady motion: d/dt of
/// ½ρV (u + ω × r) while everything turns with ω, that is ½ρV ω × (ω × r) and no ω × u, and its moment at
/// the middle; whatever share of the coupling the law leaves.
#[test]
fn isotropic_fluid_goes_with_the_middle() {
    for munk in [0.0, 0.3, 1.0] {
        let (body, mut mass) = isotropic_slab(PhysicalLaw {
            munk,
            ..PhysicalLaw::default()
        });
        let offset = Vector3::new(0.01, -0.02, 0.005);
        mass.center += offset;
        let mut free = FreeBody::new(&body, &mass, &Fluid::WATER).unwrap();
        let (u, w): (Vector3<f64>, Vector3<f64>) =
            (Vector3::new(0.5, -1.5, 2.0), Vector3::new(3.0, 4.0, -7.0));
        free.set_velocity(u, w);
        let fluid = 0.5 * f64::from(Fluid::WATER.density()) * body.hydro.volume;
        // Without history the velocity in the world is taken as steady, so that only the middle turns
        // about the center of mass.
        let force = w.cross(&w.cross(&-offset)) * -fluid;
        let found = free.forces(Vector3::zeros()).added_mass;
        let miss = to_f64(found.force) - force;
        assert!(miss.norm() < 1e-5 * force.norm(), "{munk}: {miss} {force}");
        let moment = (-offset).cross(&force);
        let miss = to_f64(found.torque) - moment;
        assert!(
            miss.norm() < 1e-5 * moment.norm(),
            "{munk}: {miss} {moment}"
        );
    }
}

/// A slender hull feels its whole Munk moment, (A_y − A_x) u² sin α cos α: a neutrally buoyant spheroid of
/// 5 : 1, 1 m long, at 10° and 1 m/s in water, with Lamb's coefficients k₁ = 0.0591, k₂ = 0.8943
/// (Lamb, *Hydrodynamics*, § 115): 2.98 N·m, which turns it broadside.
#[test]
fn a_hull_feels_its_munk_moment() {
    let (body, mass) = ellipsoid([0.5, 0.1, 0.1], 998.0);
    let fluid = Fluid::new(998.0, 1e-6).unwrap();
    let mut free = FreeBody::new(&body, &mass, &fluid).unwrap();
    let angle = 10f64.to_radians();
    free.set_velocity(
        Vector3::new(angle.cos(), angle.sin(), 0.0),
        Vector3::zeros(),
    );
    let torque = to_f64(free.forces(Vector3::zeros()).added_mass.torque);
    let exact = 998.0 * body.hydro.volume * (0.8943 - 0.0591) * angle.sin() * angle.cos();
    // The facets take 0.4 % of the volume.
    assert!((exact - 2.98).abs() < 0.02, "{exact}");
    assert!((-torque.z / exact - 1.0).abs() < 0.005, "{torque} {exact}");
    assert!(torque.x.abs() + torque.y.abs() < 1e-3 * exact, "{torque}");
}

/// A dense ball sinks straight for a minute: nothing pushes it sideways or turns it.
#[test]
fn a_dense_ball_sinks_straight() {
    let (body, mass) = sphere(0.05, 7800.0);
    let mut free = FreeBody::new(&body, &mass, &Fluid::WATER).unwrap();
    for _ in 0..3600 {
        free.step(1.0 / 60.0, Vector3::new(0.0, -9.81, 0.0));
    }
    let depth = -free.position.y;
    assert!(depth > 100.0);
    // The facets of its surface tell the axes apart.
    let aside = free.position.x.hypot(free.position.z);
    assert!(aside < 1e-6 * depth, "{}", free.position);
    assert!(free.angular_velocity().norm() < 1e-6);

    // In single precision, through rapier.
    let start = BodyState::default();
    let mut world = BodyInWorld::new(body, &mass, Fluid::WATER, &start, 1.0 / 60.0, 9.81).unwrap();
    (0..3600).for_each(|_| world.step());
    let at = world.state().position;
    assert!((at.y / free.position.y - 1.0).abs() < 1e-3, "{at}");
    assert!(at.x.hypot(at.z) < 1e-4 * depth, "{at}");
}

/// A fluid that speeds up as a whole carries a neutrally buoyant body along exactly, whatever its shape,
/// as it does in an `Immersion`: pressure gradient and added mass push it like the fluid that it displaces.
/// A sphere of three times the density follows with 3/7 of the fluid's acceleration at first:
/// (ρV + ½ρV)/(3ρV + ½ρV).
#[test]
fn a_free_body_follows_an_accelerating_fluid() {
    let stream = |step: i32| FlowSample {
        velocity: Vector::new(0.02, -0.01, 0.03) * step as f32,
        vorticity: Vector::ZERO,
        ..FlowSample::default()
    };
    let rho = f64::from(Fluid::WATER.density());
    for (body, mass) in [sphere(0.05, rho), ellipsoid([0.2, 0.05, 0.02], rho)] {
        let mut free = FreeBody::new(&body, &mass, &Fluid::WATER).unwrap();
        for step in 0..50 {
            free.step_in(0.01, Vector3::new(0.0, -9.81, 0.0), &stream(step));
        }
        let flow = to_f64(stream(49).velocity);
        let miss = free.linear_velocity() - flow;
        // In single precision the density is that of the fluid, too; the velocities are.
        assert!(miss.norm() < 1e-6 * flow.norm(), "{miss}");
        assert!(free.angular_velocity().norm() < 1e-6);
    }
    let (body, mass) = sphere(0.05, 3.0 * rho);
    let mut free = FreeBody::new(&body, &mass, &Fluid::WATER).unwrap();
    free.step_in(1e-4, Vector3::zeros(), &stream(0));
    free.step_in(1e-4, Vector3::zeros(), &stream(1));
    let flow = to_f64(stream(1).velocity);
    let share = free.linear_velocity().dot(&flow) / flow.norm_squared();
    assert!((share - 3.0 / 7.0).abs() < 1e-3, "{share}");
    // What was there before it is no acceleration.
    let mut free = FreeBody::new(&body, &mass, &Fluid::WATER).unwrap();
    free.step_in(1e-6, Vector3::zeros(), &stream(1));
    assert!(free.linear_velocity().norm() < 1e-4 * flow.norm());
}
