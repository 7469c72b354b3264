//! The default law's plate as a finite wing.

use crate::support::solid_box;
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::{Fluid, FreeBody, PhysicalLaw, ViscousLaw};
use std::f64::consts::PI;

/// Only the lift of attached flow, at every angle.
const ATTACHED: PhysicalLaw = PhysicalLaw {
    pressure_travel: 0.0,
    lift_slope: 1.0,
    vortex_lift: 0.0,
    stalled_lift: 0.0,
    stalled_lift_narrow: 0.0,
    steady_lift: 0.0,
    steady_rate: 1.0,
    stall_sine: 10.0,
    stall_aspect: 0.0,
    stall_limit: 10.0,
    stall_width: 0.1,
    pitch_stall: 0.0,
    pitch_stall_narrow: 0.0,
    stall_delay: 0.0,
    pressure_retreat: 0.0,
    stalled_travel: 0.0,
    stalled_travel_narrow: 0.0,
    travel_onset: 0.0,
    rotational_stall: 0.0,
    rotational_stall_narrow: 0.0,
    munk: 0.0,
    attached_damping: 0.0,
    roll_damping: 0.0,
    roll_damping_narrow: 0.0,
    translation_damping: 0.0,
    translation_damping_narrow: 0.0,
    rotation_damping: 0.0,
    rotation_damping_narrow: 0.0,
    friction: 0.0,
    edge_drag: 0.0,
    lift_onset: 0.0,
    damping_onset: 0.0,
    suction_loss: 0.0,
    induced_drag: 0.0,
    magnus: 0.0,
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

/// The rotation's lift has the induced drag of a finite wing, C_Di = C_L C_R/(π AR) (Prandtl 1918), where the lift
/// is small, by the difference that the coefficient makes; edge on there is no other lift, and C_L = C_R. Where it
/// is not small, the law stays below that, as it must to be bounded; how far is ours and not tested.
#[test]
fn induced_drag_is_that_of_a_finite_wing() {
    let drag_and_lift = |law: PhysicalLaw, span: f64, rate: f64| {
        let size = [span, 2e-4, CHORD];
        let (body, mass) = solid_box(size, 500.0, ViscousLaw::Physical(law));
        let mut plate = FreeBody::new(&body, &mass, &Fluid::AIR).unwrap();
        plate.set_velocity(Vector3::z() * SPEED, Vector3::x() * rate);
        let forces = plate.forces(Vector3::zeros());
        let drag = -f64::from(forces.drag.force.z);
        (drag, f64::from(forces.rotational_lift.force.length()))
    };
    let induced = |span: f64, rate: f64| {
        let area = span * CHORD;
        let dynamic = 0.5 * f64::from(Fluid::AIR.density()) * SPEED * SPEED * area;
        let (without, lift) = drag_and_lift(ATTACHED, span, rate);
        let law = PhysicalLaw {
            induced_drag: 1.0,
            ..ATTACHED
        };
        let (with, _) = drag_and_lift(law, span, rate);
        let coefficient = lift / dynamic;
        let wing = coefficient * coefficient / (PI * span / CHORD);
        (coefficient, (with - without) / dynamic / wing)
    };
    for span in [CHORD, 0.06, 0.4] {
        for rate in [200.0, -500.0, 1000.0] {
            let (coefficient, share) = induced(span, rate);
            assert!((1e-3..0.1).contains(&coefficient), "{coefficient}");
            // What is missing is of the order of C_L; forces are rounded to 10⁻⁷ of themselves.
            assert!((1.0 - coefficient..1.0 + 1e-4).contains(&share), "{share}");
        }
        let (_, large) = induced(span, 2e5);
        assert!(large < 1.0, "{large}");
    }
}

/// Without suction at the leading edge the force is normal to the plate: L sin α = D cos α. Toward
/// broadside, where flow is not attached, the law lets that go, by sin² α.
#[test]
fn without_suction_the_force_is_normal() {
    let law = PhysicalLaw {
        suction_loss: 1.0,
        ..ATTACHED
    };
    for angle in [0.05f64, 0.1, 0.2] {
        let (drag, lift) = drag_and_lift(law, 0.4, angle);
        let along = lift * angle.sin() - drag * angle.cos();
        // Drag of its own that the plate has beside the lift's: C_D90 sin² α of some 3 sin 2α sin α.
        assert!(
            along.abs() < (angle.sin().powi(2) + 0.02) * drag,
            "{along} {drag}"
        );
        let (drag, _) = drag_and_lift(ATTACHED, 0.4, angle);
        assert!(lift * angle.sin() > 2.0 * drag, "suction pulls forward");
    }
}
