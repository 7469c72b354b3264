//! The default law's plate as a finite wing.

use crate::support::solid_box;
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::{Fluid, FreeBody, PhysicalLaw, ViscousLaw};
use std::f64::consts::PI;

/// Only the lift of attached flow, at every angle.
const ATTACHED: PhysicalLaw = PhysicalLaw {
    pressure_travel: 0.0,
    attached_lift: 3.0,
    attached_aspect: 2.0,
    stalled_lift: 0.0,
    stalled_aspect: 0.0,
    stall_sine: 10.0,
    stall_width: 0.1,
    rotational_lift: 0.0,
    rotational_aspect: 0.0,
    rotational_stall: 0.0,
    munk: 0.0,
    translation_damping: 0.0,
    rotation_damping: 0.0,
    friction: 0.0,
    edge_drag: 0.0,
    suction_loss: 0.0,
    induced_drag: 0.0,
    lift_onset: 0.0,
    damping_onset: 0.0,
    magnus: 0.5,
};

/// Chord 2 cm along z; the span is along x.
const CHORD: f64 = 0.02;

/// m/s: Re = 4·10⁵.
const SPEED: f64 = 300.0;

/// Drag and lift, N, of a plate that flies along z, so fast that creeping flow adds nothing, its leading edge up by `angle`.
fn drag_and_lift(law: PhysicalLaw, span: f64, angle: f64) -> (f64, f64) {
    let size = [span, 2e-4, CHORD];
    let (body, mass) = solid_box(size, 500.0, ViscousLaw::Physical(law));
    let mut plate = FreeBody::new(&body, &mass, &Fluid::AIR).unwrap();
    let velocity = Vector3::new(0.0, -angle.sin(), angle.cos()) * SPEED;
    plate.set_velocity(velocity, Vector3::zeros());
    let forces = plate.forces(Vector3::zeros());
    let drag = forces.drag.force.length();
    let lift = forces.translational_lift.force.length();
    (f64::from(drag), f64::from(lift))
}

/// C_Di = C_L²/(π AR) (Prandtl 1918), by the difference that the coefficient makes.
#[test]
fn induced_drag_is_that_of_a_finite_wing() {
    for span in [CHORD, 0.06, 0.4] {
        let angle = 0.1;
        let area = span * CHORD;
        let dynamic = 0.5 * f64::from(Fluid::AIR.density()) * SPEED * SPEED * area;
        let (without, lift) = drag_and_lift(ATTACHED, span, angle);
        let law = PhysicalLaw {
            induced_drag: 1.0,
            ..ATTACHED
        };
        let (with, _) = drag_and_lift(law, span, angle);
        let coefficient = lift / dynamic;
        let wing = coefficient * coefficient / (PI * span / CHORD);
        let induced = (with - without) / dynamic;
        // Linear in C_L where that is large.
        let expected = wing / (1.0 + 0.3 * coefficient);
        assert!(coefficient < 1.0);
        assert!(
            (induced / expected - 1.0).abs() < 1e-3,
            "{induced} {expected}"
        );
    }
}

/// Without suction at the leading edge the force is normal to the plate: L sin α = D cos α.
#[test]
fn without_suction_the_force_is_normal() {
    let law = PhysicalLaw {
        suction_loss: 1.0,
        ..ATTACHED
    };
    for angle in [0.05f64, 0.1, 0.2] {
        let (drag, lift) = drag_and_lift(law, 0.4, angle);
        let along = lift * angle.sin() - drag * angle.cos();
        // The loss fades out toward broadside as cos² α.
        let fading = angle.sin().powi(2) * lift * angle.sin();
        assert!((along - fading).abs() < 0.02 * drag, "{along} {fading}");
        let (drag, _) = drag_and_lift(ATTACHED, 0.4, angle);
        assert!(lift * angle.sin() > 2.0 * drag, "suction pulls forward");
    }
}
