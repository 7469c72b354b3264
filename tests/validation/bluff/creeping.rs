//! Creeping flow: what is known exactly, and of cylinders and cubes what was computed and measured.

use super::{ellipsoid, to_f64};
use crate::published::bluff::revolved;
use crate::support::solid_box;
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::na::{UnitQuaternion, Vector3};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{DryMass, Fluid, FreeBody, HydroProperties, ImmersedBody, ViscousLaw};
use std::f64::consts::PI;

/// As thick as syrup, so that nothing but creeping flow is left.
fn syrup() -> Fluid {
    Fluid::new(1000.0, 1.0).unwrap()
}

/// Resistance over viscosity for motion along a direction, m.
fn resistance((body, mass): &(ImmersedBody, DryMass), direction: Vector3<f64>) -> f64 {
    let speed = 1e-6;
    let mut free = FreeBody::new(body, mass, &syrup()).unwrap();
    free.set_velocity(direction * speed, Vector3::zeros());
    let force = to_f64(free.forces(Vector3::zeros()).drag.force);
    -force.dot(&direction) / speed / f64::from(syrup().dynamic_viscosity())
}

fn solid(surface: &Surface) -> (ImmersedBody, DryMass) {
    let mass = DryMass::uniform(surface, 1000.0 * surface.volume_integrals().volume).unwrap();
    let hydro = HydroProperties::from_surface(surface, mass.center);
    (ImmersedBody::new(hydro), mass)
}

/// Cylinders of length L and diameter D, p = L/D from 2 to 30: along 2πμL/(ln p − 0.207 + 0.980/p − 0.133/p²),
/// across 4πμL/(ln p + 0.839 + 0.185/p + 0.233/p²) (Tirado & García de la Torre, *J. Chem. Phys.* 71, 2581 (1979)
/// and 81, 2047 (1984)).
#[test]
fn cylinders() {
    for p in [2.0, 3.0, 5.0, 10.0, 20.0, 30.0_f64] {
        let (r, half) = (0.01, 0.01 * p);
        let surface = revolved(&[[0.0, -half], [r, -half], [r, half], [0.0, half]], 64);
        let body = solid(&surface);
        let length = 2.0 * half;
        let along = 2.0 * PI * length / (p.ln() - 0.207 + 0.980 / p - 0.133 / (p * p));
        let across = 4.0 * PI * length / (p.ln() + 0.839 + 0.185 / p + 0.233 / (p * p));
        let (found_along, found_across) = (
            resistance(&body, Vector3::y()),
            resistance(&body, Vector3::x()),
        );
        assert!(
            (found_along / along - 1.0).abs() < 0.05,
            "{p}: {found_along} {along}"
        );
        assert!(
            (found_across / across - 1.0).abs() < 0.05,
            "{p}: {found_across} {across}"
        );
    }
}

/// A cube settles at 0.843 log₁₀(φ/0.065) of the speed of the sphere of its volume, with the sphericity φ =
/// (π/6)^⅓ = 0.806 (Pettyjohn & Christiansen, *Chem. Eng. Prog.* 44, 157 (1948), measured): a radius of 0.673
/// edges, in every direction.
#[test]
fn cubes() {
    let edge = 0.01;
    let body = solid_box([edge; 3], 1500.0, ViscousLaw::default());
    let sphericity = (PI / 6.0).cbrt();
    let slower = 0.843 * (sphericity / 0.065).log10();
    let radius = edge * (3.0 / (4.0 * PI)).cbrt() / slower;
    for direction in [Vector3::x(), Vector3::new(0.6, 0.0, 0.8), Vector3::z()] {
        let found = resistance(&body, direction) / (6.0 * PI);
        assert!((found / radius - 1.0).abs() < 0.05, "{found} {radius}");
    }
}

/// What keeps its tilt drifts while it settles: the weight has a part along the body's axis and one across, and each makes
/// its own velocity, by the exact resistances over viscosity `along` and `across` (m). Direction and speed to 1 %, tilt
/// kept to 2·10⁻³ (the law takes no Reynolds number as less than 10⁻³) over a hundred times its size.
fn drifts(
    (body, mass): &(ImmersedBody, DryMass),
    axis: Vector3<f64>,
    along: f64,
    across: f64,
    size: f64,
) {
    let gravity = Vector3::new(0.0, -9.81, 0.0);
    for tilt in [0.3, 0.8, 1.2] {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), tilt);
        let mut free = FreeBody::new(body, mass, &syrup()).unwrap();
        free.set_orientation(turn);
        let axis = turn * axis;
        let weight = gravity * (mass.mass - 1000.0 * body.hydro.volume);
        let part = axis * axis.dot(&weight);
        let exact =
            (part / along + (weight - part) / across) / f64::from(syrup().dynamic_viscosity());
        let dt = size / exact.norm();
        for _ in 0..100 {
            free.step(dt, gravity);
        }
        let drift = free.linear_velocity();
        assert!(
            (drift - exact).norm() < 0.01 * exact.norm(),
            "{tilt}: {drift} {exact}"
        );
        let turned = (free.orientation() * (turn.inverse() * axis)).angle(&axis);
        assert!(turned < 2e-3, "{tilt}: turned by {turned}");
    }
}

/// A disc with 16 and 32/3 radii (exact for a thin one), a prolate spheroid of 5 : 1 and an oblate one of
/// 1 : 2 with the closed forms of Happel & Brenner, § 5-11.
#[test]
fn discs_and_spheroids_keep_their_tilt() {
    let radius = 1e-3;
    let disc = SharedShape::cylinder(2e-6, radius as Real);
    let surface = Surface::from_shape(disc.as_ref()).unwrap();
    let thin = |surface: &Surface| {
        let mass = DryMass::uniform(surface, 3000.0 * surface.volume_integrals().volume).unwrap();
        let hydro = HydroProperties::from_surface(surface, mass.center);
        (ImmersedBody::new(hydro), mass)
    };
    let (along, across) = (16.0 * radius, 32.0 / 3.0 * radius);
    drifts(&thin(&surface), Vector3::y(), along, across, 2.0 * radius);

    let a: f64 = 5e-3;
    let b: f64 = 1e-3;
    let e = (1.0 - (b / a).powi(2)).sqrt();
    let l = ((1.0 + e) / (1.0 - e)).ln();
    let along = 16.0 * PI * a * e.powi(3) / ((1.0 + e * e) * l - 2.0 * e);
    let across = 32.0 * PI * a * e.powi(3) / (2.0 * e + (3.0 * e * e - 1.0) * l);
    drifts(
        &ellipsoid([a, b, b], 2000.0),
        Vector3::x(),
        along,
        across,
        2.0 * b,
    );

    // Oblate: of e = √(1 − c²/a²), C = arccot(c/(ae)).
    let (a, c) = (2e-3_f64, 1e-3_f64);
    let e = (1.0 - (c / a).powi(2)).sqrt();
    let root = (1.0 - e * e).sqrt();
    let angle = (e / root).atan();
    let along = 8.0 * PI * a * e.powi(3) / (e * root - (1.0 - 2.0 * e * e) * angle);
    let across = 16.0 * PI * a * e.powi(3) / ((1.0 + 2.0 * e * e) * angle - e * root);
    drifts(
        &ellipsoid([a, a, c], 2000.0),
        Vector3::z(),
        along,
        across,
        2.0 * c,
    );
}
