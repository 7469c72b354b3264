//! Plates in a steady stream under the default law: a wing's lift and stall, no thrust along a stalled plate, and
//! what rotation adds, term by term.

use crate::support::solid_box;
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::training::fidelity::StaticPlate;
use rapier3d_immersed::{Fluid, FreeBody, PhysicalLaw, ViscousLaw};
use std::f64::consts::PI;

/// Span, thickness and chord, m, and speed, m/s, in water: Re = 2·10⁵, where creeping flow adds less than 10⁻⁴.
const CHORD: f64 = 0.1;
const THICKNESS: f64 = 2e-4;
const SPEED: f64 = 2.0;

/// Nothing but attached flow, whatever the angle; no damping.
fn attached() -> PhysicalLaw {
    PhysicalLaw {
        lift_slope: 1.0,
        stall_sine: 10.0,
        stall_limit: 10.0,
        rotational_stall: 0.0,
        rotational_stall_narrow: 0.0,
        attached_damping: 0.0,
        rotation_damping: 0.0,
        rotation_damping_narrow: 0.0,
        suction_loss: 1.0,
        lift_onset: 0.0,
        damping_onset: 0.0,
        ..PhysicalLaw::default()
    }
}

/// A plate whose chord lies along z and its normal along y, at an angle of attack, rad, pitching up with `rate`, rad/s.
fn plate(law: PhysicalLaw, aspect: f64, angle: f64, rate: f64) -> FreeBody {
    let size = [aspect * CHORD, THICKNESS, CHORD];
    let (body, mass) = solid_box(size, 2000.0, ViscousLaw::Physical(law));
    let mut plate = FreeBody::new(&body, &mass, &Fluid::WATER).unwrap();
    // x × z = −y: turning about −x lifts the nose.
    let velocity = Vector3::new(0.0, -angle.sin(), angle.cos()) * SPEED;
    plate.set_velocity(velocity, Vector3::x() * -rate);
    plate
}

fn density() -> f64 {
    f64::from(Fluid::WATER.density())
}

/// Helmbold's share of 2π.
fn finite(aspect: f64) -> f64 {
    aspect / (2.0 + (aspect * aspect + 4.0).sqrt())
}

/// The bars of the calibration: slope of Helmbold (1942) within 10 %, greatest lift within 15 % and its angle
/// within 5° where they are known, center of pressure within .04 of a vortex lattice's at 5°, in the middle at 90°
/// and never coming forward, thrust along a stalled plate at most 5 % of the normal force.
#[test]
fn plates_are_wings() {
    for known in StaticPlate::published().unwrap() {
        let name = (known.aspect, known.round);
        let polar = known.polar(&ViscousLaw::default()).unwrap();
        let slope = polar.lift_slope() / known.lift_slope;
        assert!((slope - 1.0).abs() < 0.1, "{name:?}: {slope}");
        let (angle, lift) = polar.stall();
        if let (Some(greatest), Some([low, high])) = (known.max_lift, known.stall) {
            assert!((lift / greatest - 1.0).abs() < 0.15, "{name:?}: {lift}");
            assert!(
                (low - 5.0..=high + 5.0).contains(&angle),
                "{name:?}: {angle}"
            );
        }
        if let Some(at) = known.pressure_point {
            let ours = polar.pressure_point();
            assert!((ours - at).abs() < 0.04, "{name:?}: {ours}");
        }
        assert!(
            (polar.points[90].pressure_point - 0.5).abs() < 1e-4,
            "{name:?}"
        );
        assert!(polar.pressure_goes_back(), "{name:?}");
        assert!(
            polar.stalled_thrust() < 0.05,
            "{name:?}: {}",
            polar.stalled_thrust()
        );
    }
}

/// Attached: C_N = sin α (2πη + K_v (1 − η)² sin α), normal to the plate, less what turns into the broadside drag with
/// sin⁴ α, which is 10⁻³ of it here.
#[test]
fn attached_flow_has_helmbolds_slope_and_vortex_lift() {
    for aspect in [1.0, 2.0, 6.0, 29.0] {
        for degrees in [3.0f64, 8.0] {
            let angle = degrees.to_radians();
            let law = PhysicalLaw {
                friction: 0.0,
                edge_drag: 0.0,
                vortex_lift: PI,
                ..attached()
            };
            let forces = plate(law, aspect, angle, 0.0).forces(Vector3::zeros());
            let force = forces.viscous().force;
            let eta = finite(aspect);
            let exact = angle.sin() * (2.0 * PI * eta + PI * (1.0 - eta).powi(2) * angle.sin());
            let dynamic = 0.5 * density() * SPEED * SPEED * aspect * CHORD * CHORD;
            let normal = f64::from(force.y) / dynamic;
            assert!(
                (normal / exact - 1.0).abs() < 2e-3,
                "{aspect} {degrees}: {normal} {exact}"
            );
            let along = f64::from(force.z) / dynamic;
            assert!(along.abs() < 1e-3 * normal, "{aspect} {degrees}: {along}");
        }
    }
}

/// A wide plate that is held past its stall is pushed more than one that turns: by 2 C_t η² cos⁴α sin α, less what turns into
/// the broadside drag with sin⁴ α; of it a plate that turns by 0.3 rad per chord has a hundredth.
#[test]
fn steady_separated_flow_pushes_more() {
    let (aspect, angle) = (6.0, 30f64.to_radians());
    let normal = |steady_lift: f64, per_chord: f64| {
        let law = PhysicalLaw {
            steady_lift,
            ..PhysicalLaw::default()
        };
        let rate = per_chord * SPEED / CHORD;
        let forces = plate(law, aspect, angle, rate).forces(Vector3::zeros());
        let dynamic = 0.5 * density() * SPEED * SPEED * aspect * CHORD * CHORD;
        f64::from(forces.viscous().force.y) / dynamic
    };
    let more = |per_chord: f64| normal(0.8, per_chord) - normal(0.0, per_chord);
    let sine = angle.sin();
    let exact = 1.6 * finite(aspect).powi(2) * angle.cos().powi(4) * sine * (1.0 - sine.powi(4));
    let held = more(0.0);
    assert!((held / exact - 1.0).abs() < 0.01, "{held} {exact}");
    // The velocity at its center of pressure differs by a per cent.
    let turning = more(-0.3) / held * 101.0;
    assert!((turning - 1.0).abs() < 0.1, "{turning}");
}

/// Past its stall, at 20°, a wing of aspect ratio 6 has a lift coefficient between 0.6 and 1.1, as flat plates have, and in two dimensions
/// at least three quarters of the normal force 1/(0.222 + 0.283/sin α) (Hoerner, *Fluid-Dynamic Drag*).
#[test]
fn wings_lift_past_their_stall() {
    let known = StaticPlate::published().unwrap();
    let polar = |plate: &StaticPlate| plate.polar(&ViscousLaw::default()).unwrap();
    let lift = polar(&known[2]).points[20].lift;
    assert!((0.6..1.1).contains(&lift), "{lift}");
    let wide = polar(&known[3]).points[20];
    let (sine, cosine) = 20f64.to_radians().sin_cos();
    let normal = wide.lift * cosine + wide.drag * sine;
    let hoerner = 1.0 / (0.222 + 0.283 / sine);
    assert!(
        (0.75..1.1).contains(&(normal / hoerner)),
        "{normal} {hoerner}"
    );
}

/// The circulation follows the angle of attack at ¾ of the chord, which a pitch rate changes by ωc/4V (Pistolesi):
/// lift ½ρAV² C_Lα ωc/4V.
#[test]
fn pitching_adds_the_circulation_of_three_quarter_chord() {
    for (aspect, rate) in [(1.0, 2.0), (6.0, 3.0), (29.0, -1.0)] {
        let forces = plate(attached(), aspect, 0.0, rate).forces(Vector3::zeros());
        let area = aspect * CHORD * CHORD;
        let slope = 2.0 * PI * finite(aspect);
        let exact = 0.5 * density() * area * SPEED * SPEED * slope * rate * CHORD / (4.0 * SPEED);
        let found = f64::from(forces.rotational_lift.force.y);
        // Of the velocity, the pressure point's ωcχ is across: ε aside, the lift does not see it.
        assert!(
            (found / exact - 1.0).abs() < 1e-5,
            "{aspect}: {found} {exact}"
        );
    }
}

/// Near its stall a plate that pitches up lifts more than one at rest, and one that pitches down less; more strongly
/// if it is wide.
#[test]
fn stall_moves_with_the_signed_pitch_rate() {
    let law = PhysicalLaw::default();
    let lift = |aspect: f64, rate: f64| {
        let stall = law.stall_sine + law.stall_aspect / aspect;
        let forces = plate(law, aspect, stall.asin(), rate).forces(Vector3::zeros());
        let force = forces.translational_lift.force;
        f64::from(force.y.hypot(force.z))
    };
    for aspect in [2.0, 29.0] {
        let loses = |rate: f64| lift(aspect, rate) / lift(aspect, 0.0);
        assert!(loses(0.3) > 1.0 && loses(-0.3) < 1.0, "{aspect}");
        // Upside down too: what counts is whether the angle of attack grows.
        let area = plate(law, aspect, -0.3, -0.3).forces(Vector3::zeros());
        let other = plate(law, aspect, 0.3, 0.3).forces(Vector3::zeros());
        let (a, b) = (
            area.translational_lift.force,
            other.translational_lift.force,
        );
        assert!((a.y + b.y).abs() < 1e-5 * b.y.abs(), "{a} {b}");
    }
    let early = |aspect: f64| lift(aspect, -0.3) / lift(aspect, 0.0);
    assert!(early(29.0) < early(2.0), "{} {}", early(29.0), early(2.0));
}

/// Attached flow damps pitching, about the span, by ½ρ C_D90 k₁ₐ I₂ |u| with I₂ = b c³/12, and rolling, about the motion, by
/// that share of strip theory that the coefficients say: `½ρ 2πη k_p I₂ |u|`, I₂ = c b³/12, each strip having the lift of its
/// own velocity (Helmbold's slope).
#[test]
fn damping_of_attached_flow() {
    let law = PhysicalLaw {
        attached_damping: 2.0,
        roll_damping: 0.8,
        roll_damping_narrow: 0.5,
        translation_damping: 7.0,
        translation_damping_narrow: 7.0,
        ..attached()
    };
    // C_D90 of a rectangle whose sides are as 1 to 10 (DNV-RP-C205).
    let (aspect, broadside) = (10.0, 1.5);
    let eta = aspect / (2.0 + f64::sqrt(aspect * aspect + 4.0));
    let rolling = (0.5 + 0.3 * eta * eta) * 2.0 * PI * eta;
    let span = aspect * CHORD;
    let mut body = plate(law, aspect, 0.0, 0.0);
    for (axis, exact) in [
        (Vector3::x(), broadside * 2.0 * span * CHORD.powi(3) / 12.0),
        (Vector3::z(), rolling * CHORD * span.powi(3) / 12.0),
    ] {
        let rate = 1e-3;
        body.set_velocity(Vector3::z() * SPEED, axis * rate);
        let torque = body.forces(Vector3::zeros()).damping.torque;
        let torque = Vector3::new(torque.x, torque.y, torque.z).map(f64::from);
        let exact = -0.5 * density() * exact * SPEED * rate;
        assert!(
            (torque.dot(&axis) / exact - 1.0).abs() < 2e-3,
            "{torque} {exact}"
        );
    }
}
