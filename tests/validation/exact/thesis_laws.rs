//! The thesis's two laws against their formulas, written out here from the page, with coefficients of which none
//! is one.

use crate::support::solid_box;
use rapier3d_immersed::rapier3d::math::Vector;
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::{
    DryMass, Fluid, FreeBody, ImmersedBody, PhysicalLaw, StochasticLaw, ThesisLaw, ViscousLaw,
};

const SIZE: [f64; 3] = [0.2, 0.12, 0.004];

fn body(law: ViscousLaw) -> (ImmersedBody, DryMass) {
    solid_box(SIZE, 800.0, law)
}

fn vector(v: Vector) -> Vector3<f64> {
    Vector3::new(v.x, v.y, v.z).map(f64::from)
}

/// Velocities, m/s and rad/s, in all octants; the body's axes are the plate's.
const STATES: [([f64; 3], [f64; 3]); 4] = [
    ([0.5, -0.3, 0.8], [2.0, -3.0, 5.0]),
    ([-1.0, 0.2, 0.1], [0.5, 1.0, -2.0]),
    ([0.1, 0.4, -2.0], [-4.0, 0.3, 1.0]),
    ([0.7, 0.9, -0.2], [1.0, 6.0, 0.0]),
];

fn assert_near(found: Vector, exact: Vector3<f64>, size: f64, what: &str) {
    let miss = (vector(found) - exact).norm();
    // Read-outs are single precision.
    assert!(miss < 1e-6 * size, "{what}: {} for {exact}", vector(found));
}

/// Length of the arm, `(1 − sin³α) a/2` with the semi-axis a, along the velocity in the plate.
fn arm(u: &Vector3<f64>) -> Vector3<f64> {
    let along = Vector3::new(u.x, u.y, 0.0).normalize();
    let sine = u.z.abs() / u.norm();
    along * ((1.0 - sine.powi(3)) * 0.5 * SIZE[0] / 2.0)
}

/// `F = −½ρA|U| (C_d U + C_l U × (N × U)/|N × U|)` (thesis (4.7)) at its center of pressure, N on the windward
/// side; the sign of N passes smoothly through zero, over a thousandth of the speed.
#[test]
fn stochastic_law() {
    let law = StochasticLaw {
        drag: 2.5,
        lift: 0.7,
        arm: 0.4,
        damping: 0.0,
    };
    let (body, mass) = body(ViscousLaw::Stochastic(law));
    for (u, w) in STATES {
        let (u, w) = (Vector3::from(u), Vector3::from(w));
        let mut body = FreeBody::new(&body, &mass, &Fluid::WATER).unwrap();
        body.set_velocity(u, w);
        let forces = body.forces(Vector3::zeros());
        let dynamic = 0.5 * f64::from(Fluid::WATER.density()) * SIZE[0] * SIZE[1];
        let windward = Vector3::z() * (u.z / (u.z.abs() + 1e-3 * u.norm()));
        let drag = u * (-2.5 * dynamic * u.norm());
        let turning = Vector3::z().cross(&u);
        let lift = u.cross(&windward.cross(&u)) * (-0.7 * dynamic * u.norm() / turning.norm());
        let size = drag.norm();
        assert_near(forces.drag.force, drag, size, "drag");
        assert_near(forces.translational_lift.force, lift, size, "lift");
        assert_eq!(forces.rotational_lift.force, Vector::ZERO);
        assert_eq!(forces.damping.torque, Vector::ZERO);
        // The force acts at the arm, and only in the plate's plane is there no torque about its normal.
        let torque = (arm(&u) * 0.4).cross(&drag);
        assert_near(forces.drag.torque, torque, size * SIZE[0], "torque");
    }
}

/// Drag −½ρA C_D sin²α |u|u, and lifts along ω × u and (ω × u) × u with C_L1 sin 2α and C_L2 cos 2α (thesis
/// (5.15) to (5.17)), the unit vector of ω × u regularised by κ|u|²/L; the share 0.6 of a plate's damping.
#[test]
fn thesis_law() {
    let law = ThesisLaw {
        drag: 1.7,
        rotational_lift: 2.3,
        translational_lift: 0.6,
        regularisation: 0.05,
        damping: 0.6,
    };
    let (plate, mass) = body(ViscousLaw::Thesis(law));
    // The damping of a plate does not depend on what else the default law does.
    let (default, _) = body(ViscousLaw::Physical(PhysicalLaw {
        damping_onset: 0.0,
        // Stalled at every angle of these states.
        stall_sine: 0.0,
        stall_aspect: 0.0,
        stall_width: 1e-3,
        pitch_stall: 0.0,
        pitch_stall_narrow: 0.0,
        translation_damping: 0.0827,
        translation_damping_narrow: 0.0827,
        rotation_damping: 3.41,
        rotation_damping_narrow: 3.41,
        ..PhysicalLaw::default()
    }));
    for (u, w) in STATES {
        let (u, w) = (Vector3::from(u), Vector3::from(w));
        let mut body = FreeBody::new(&plate, &mass, &Fluid::WATER).unwrap();
        body.set_velocity(u, w);
        let forces = body.forces(Vector3::zeros());
        let dynamic = 0.5 * f64::from(Fluid::WATER.density()) * SIZE[0] * SIZE[1];
        let speed2 = u.norm_squared();
        let angle = (u.z.abs() / u.norm()).asin();
        let drag = u * (-1.7 * dynamic * u.norm() * angle.sin().powi(2));
        let turning = w.cross(&u);
        let turning = turning / (turning.norm() + 0.05 * speed2 / (SIZE[0] / 2.0));
        let first = turning * (2.3 * dynamic * speed2 * (2.0 * angle).sin());
        let second = turning.cross(&u.normalize()) * (0.6 * dynamic * speed2 * (2.0 * angle).cos());
        let size = dynamic * speed2;
        assert_near(forces.drag.force, drag, size, "drag");
        assert_near(forces.rotational_lift.force, first, size, "rotational lift");
        assert_near(
            forces.translational_lift.force,
            second,
            size,
            "translational lift",
        );
        let torque = arm(&u).cross(&drag);
        assert_near(forces.drag.torque, torque, size * SIZE[0], "torque");

        let mut body = FreeBody::new(&default, &mass, &Fluid::WATER).unwrap();
        body.set_velocity(u, w);
        let damping = vector(body.forces(Vector3::zeros()).damping.torque);
        let found = vector(forces.damping.torque);
        // About the normal the default law has friction on top.
        let miss = (found - damping * 0.6).xy();
        assert!(miss.norm() < 1e-5 * found.norm(), "{miss}");
        assert!(found.z * w.z <= 0.0 && found.z.abs() <= 0.6 * damping.z.abs());
    }
}
