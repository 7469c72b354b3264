//! Single terms of the default law, in states where theory or the law's own definition gives them in closed
//! form. The coefficients are those that are written here.

use super::sphere;
use crate::support::solid_box;
use rapier3d_immersed::geometry::Ellipsoid;
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::{Fluid, FreeBody, PhysicalLaw, ViscousLaw};
use std::f64::consts::PI;

/// A sphere that turns in a stream feels ½ρπR²u² C_L along ω × u, C_L = S/(2.32 S + 0.4) of the spin across
/// the stream S = R|ω × û|/u, times `magnus`, and nothing else across the stream.
#[test]
fn magnus_force() {
    let (mut body, mass) = sphere(0.05, 300.0);
    body.law = ViscousLaw::Physical(PhysicalLaw {
        magnus: 0.75,
        ..PhysicalLaw::default()
    });
    let (u, w): (Vector3<f64>, _) = (Vector3::new(0.5, -1.5, 2.0), Vector3::new(3.0, 4.0, -7.0));
    let (across, speed) = (w.cross(&u), u.norm());
    let ratio = 0.05 * across.norm() / speed.powi(2);
    let lift = 0.75 * ratio / (2.32 * ratio + 0.4);
    let dynamic = 0.5 * f64::from(Fluid::WATER.density()) * PI * 0.05_f64.powi(2);
    let exact = across.normalize() * (dynamic * speed.powi(2) * lift);
    let mut body = FreeBody::new(&body, &mass, &Fluid::WATER).unwrap();
    body.set_velocity(u, w);
    let forces = body.forces(Vector3::zeros());
    let found = forces.rotational_lift.force.as_dvec3();
    let miss = Vector3::new(found.x, found.y, found.z) - exact;
    // Read-outs are single precision.
    assert!(miss.norm() < 1e-6 * exact.norm(), "{miss} {exact}");
    assert_eq!(forces.translational_lift.force.length(), 0.0);
}

/// A plate in its own plane along x: `edge_drag` adds ½ρA k_e (t/c) u², with the thickness t and the chord c.
#[test]
fn drag_of_the_edges() {
    let [length, width, thickness] = [0.2, 0.1, 0.004];
    let drag = |edge_drag: f64, u: Vector3<f64>| {
        let law = PhysicalLaw {
            edge_drag,
            friction: 2.0,
            ..PhysicalLaw::default()
        };
        let size = [length, width, thickness];
        let (body, mass) = solid_box(size, 2000.0, ViscousLaw::Physical(law));
        let mut body = FreeBody::new(&body, &mass, &Fluid::WATER).unwrap();
        body.set_velocity(u, Vector3::zeros());
        let force = body.forces(Vector3::zeros()).drag.force;
        -f64::from(force.dot(rapier3d_immersed::rapier3d::prelude::Vector::new(
            u.x as f32, u.y as f32, u.z as f32,
        ))) / u.norm()
    };
    let dynamic = 0.5 * f64::from(Fluid::WATER.density()) * length * width;
    for (u, chord) in [(Vector3::x() * 2.0, length), (Vector3::y() * -3.0, width)] {
        let exact = dynamic * 1.5 * thickness / chord * u.norm_squared();
        let found = drag(1.5, u) - drag(0.0, u);
        assert!((found / exact - 1.0).abs() < 1e-4, "{found} {exact}");
        // What is left is friction, k_f Re^−½, and creeping flow.
        let re = u.norm() * chord / f64::from(Fluid::WATER.kinematic_viscosity());
        let friction = dynamic * 2.0 / re.sqrt() * u.norm_squared();
        let left = drag(0.0, u);
        assert!((left / friction - 1.0).abs() < 0.05, "{left} {friction}");
        assert!(left > friction);
    }
}

/// A square plate that spins in its own plane, without translation: friction brakes it with
/// 0.005 ρ (∫x² + ∫y²) c ω², c = its side, so that 1/ω grows linearly in time.
#[test]
fn friction_of_a_spinning_plate() {
    let side = 0.2;
    let law = PhysicalLaw {
        attached_damping: 0.0,
        translation_damping: 0.0,
        translation_damping_narrow: 0.0,
        rotation_damping: 0.0,
        rotation_damping_narrow: 0.0,
        ..PhysicalLaw::default()
    };
    // So thin a fluid that creeping flow takes 1e-7 of what is looked at.
    let fluid = Fluid::new(1000.0, 1e-12).unwrap();
    let (body, mass) = solid_box([side, side, 0.004], 2000.0, ViscousLaw::Physical(law));
    let second = 2.0 * side.powi(4) / 12.0;
    let friction = 0.005 * 1000.0 * second * side;
    let rho = f64::from(fluid.density());
    let inertia = mass.inertia[(2, 2)] + rho * body.hydro.added_mass.angular[(2, 2)];
    let mut body = FreeBody::new(&body, &mass, &fluid).unwrap();
    let start = 20.0;
    body.set_velocity(Vector3::zeros(), Vector3::z() * start);
    let torque = f64::from(body.forces(Vector3::zeros()).damping.torque.z);
    let exact = -friction * start * start;
    assert!((torque / exact - 1.0).abs() < 1e-5, "{torque} {exact}");
    let dt = 1e-3;
    for _ in 0..2000 {
        body.step(dt, Vector3::zeros());
    }
    let exact = 1.0 / (1.0 / start + friction / inertia * 2.0);
    let found = body.angular_velocity().z;
    // A quarter of the spin is lost, at second order in a step that loses 1e-4 of it.
    assert!(exact < 0.8 * start, "{exact}");
    assert!((found / exact - 1.0).abs() < 1e-5, "{found} {exact}");
}

/// A sphere has the drag curve of Clift & Gauvin (1971) without Stokes's term on its shadow,
/// S = `3.6 Re^−0.313 + 0.42/(1 + 42500 Re^−1.16)`, Re on the diameter of its volume, and the creeping
/// resistance 6πμR. A cube has `(C − 0.45) Re/(Re + 120)` more, C its coefficient at Re 10⁴–10⁵, in every
/// direction.
#[test]
fn drag_of_bluff_bodies() {
    let fluid = Fluid::new(1000.0, 1e-5).unwrap();
    let viscosity = f64::from(fluid.kinematic_viscosity());
    let cube = solid_box([0.1; 3], 300.0, ViscousLaw::default());
    for (body, mass) in [sphere(0.05, 300.0), cube] {
        let Ellipsoid { semi_axes } = body.hydro.proxy;
        // Shadow, coefficient, and radius in creeping flow.
        let shape = body.hydro.bluff.clone();
        let (area, drag, radius) = shape.map_or((PI * 0.05 * 0.05, 0.45, 0.05), |shape| {
            assert!((shape.drag[0] - shape.drag[1]).norm() < 1e-6);
            (shape.shadow.x, shape.drag[0].x, 0.05 * (6.0 / PI).powf(0.4))
        });
        for u in [Vector3::new(2.0, -1.0, 0.5), Vector3::z() * -0.03] {
            let speed = u.norm();
            let re: f64 = speed * 2.0 * semi_axes.product().cbrt() / viscosity;
            let sphere = 3.6 * re.powf(-0.313) + 0.42 / (1.0 + 42500.0 * re.powf(-1.16));
            let coefficient = sphere + (drag - 0.45) * re / (re + 120.0);
            let creeping = u * (6.0 * PI * radius * f64::from(fluid.dynamic_viscosity()));
            let exact = u * (-0.5 * 1000.0 * area * coefficient * speed) - creeping;
            let mut body = FreeBody::new(&body, &mass, &fluid).unwrap();
            body.set_velocity(u, Vector3::zeros());
            let found = body.forces(Vector3::zeros()).drag.force;
            let found = Vector3::new(found.x, found.y, found.z).map(f64::from);
            let miss = (found - exact).norm();
            assert!(miss < 1e-5 * exact.norm(), "{found} {exact}");
        }
    }
}
