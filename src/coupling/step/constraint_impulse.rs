//! The impulse of the constraints (joints, friction) that hold a body, and the mass that they feel.
//!
//! Rapier's solver knows a scalar mass m_s; the body and the fluid that it drags along have the tensor 𝕄.
//! A body to which the force `f = m_s Δv_free/dt` is handed over, with Δv_free its change of velocity if
//! nothing held it, moves rightly if nothing does. What holds it, however, is met by m_s Δv_free, where
//! the fluid's force over dt is 𝕄 Δv_free: every force reaches the constraint scaled by m_s/𝕄, steady
//! drag as well, at any dt.
//!
//! The constraint gives an impulse J in a step, `m_s Δv = f dt + J`, so that J is known after the step.
//! It changes little from step to step, and the next step counts on it:
//!
//! ```text
//! 𝕄 Δv_pred = F(ν) dt + Ĵ          (the integrator, implicitly)
//! f = (m_s Δv_pred − Ĵ)/dt          (what rapier is given)
//! J = Ĵ + m_s (Δv − Δv_pred)        (what the constraint did)
//! ```
//!
//! * Where the body is held, Δv = 0, J is `Ĵ − m_s Δv_pred = Ĵ(1 − m_s/𝕄) − (m_s/𝕄) F dt`: iterated with
//!   Ĵ := J it converges to −F dt, the true reaction, at any dt. The error shrinks by 1 − m_s/𝕄 per step,
//!   which is in [0, 1) where m_s ≤ 𝕄.
//! * Where m_s > 𝕄 it would overshoot, and diverge above 2𝕄; there 𝕄/m_s of the surprise J − Ĵ is learnt.
//!   By principal masses, `Ĵ' = Ĵ + min(1, 𝕄/m_s)(J − Ĵ)`.
//! * A body that is not held in a direction has Δv = Δv_pred there and keeps Ĵ = 0.
//! * With `m_s = 1/(d·𝕄⁻¹d)` along the direction d of Ĵ, the impulse that the constraint finds at once is
//!   the right one along d.
//!
//! A constraint that **opens** (joint removed, rope gone slack, a bounce that is over) leaves the body
//! with Δv = (𝕄⁻¹ − 1/m_s)Ĵ too much, for the force took Ĵ off through m_s and the integrator put it on
//! through 𝕄. It is taken back after the step, `v += (𝕄⁻¹ − 1/m_s)(J − Ĵ)`.
//!
//! Moments are counted on likewise: a wing on a rail or a keel on a boat is held against the Munk moment all the
//! time, and would turn in each prediction and be braked by what it does not do (a plate on a slider in an ideal
//! fluid stopped at .7 m/s, a wing on a cart lost two thirds of its speed in 5 s at 60 Hz). Rapier's inertia
//! is that of body and fluid, so that all of a surprise is learnt. What energy the prediction brings about at
//! long levers, [`energy_budget`](super::energy_budget) takes away. Where a motor drives the system there is no such
//! bound, and moments are not counted on: plates on motorised sliders ran away to thousands of m/s.

use super::stage_data::{HeldStart, JointAction};
use super::{contact_mass, held_motion, locked_axes};
use crate::coupling::body_mass::BodyMass;
use crate::coupling::body_state::FlightState;
use crate::coupling::shared_constants::SharedConstants;
use crate::math::vector;
use rapier3d::dynamics::RigidBody;
use rapier3d::math::{Real, Rotation, Vector};

/// Part of a body's momentum that the impulse of a slack joint does not reach.
const SLACK: Real = 1e-5;
/// Relative change of a velocity that rounding can cause: no surprise.
const ROUNDING: Real = 1e-6;
/// Part of the expected impulse below which a constraint counts as open.
const OPEN: Real = 0.25;
/// Step below which nothing is learnt, s: its impulse is a rounding error.
const SHORT: Real = 1e-5;
/// Turn in a step, rad, after which the last impulse says nothing about the next.
const FAR: Real = 1.0;
/// How many times longer than the last a step may be for its joints to be counted on in proportion: rounding
/// grows as much.
const LONGER: Real = 20.0;
/// Turn in a step, rad, from which on the moments of joints are not counted on.
const STEADY: Real = 0.05;
/// Turn in a step, rad, below which rounding hides whether the impulse turns with the body. It matters down to there: what lags behind a
/// link that swings by an angle a step brakes it by as much.
const NEAR: Real = 1e-5;

/// The mass that a jointed body shows rapier: along the last impulse of its joints; the largest until that
/// is known, so that the first impulse is that of the whole fluid where the body moves broadside on.
pub(super) fn joint_mass(mass: &BodyMass, body: &RigidBody, impulse: Vector) -> f64 {
    let length = impulse.length();
    if length > 0.0 {
        contact_mass::mass_along(mass, body, impulse / length)
    } else {
        mass.principal.masses.max_element().into()
    }
}

/// Whether the joints of a body did nothing in the last step.
pub(super) fn is_slack(shared: &SharedConstants, body: &RigidBody, flight: &FlightState) -> bool {
    let around = body.angvel().length() * shared.constants.length as Real;
    let momentum = flight.solver_mass * (body.linvel().length() + around);
    // By the trace: rounding about a thin rod's axis is not small against its spin about it.
    let inertia = &shared.step.scales.rapier_inertia;
    let turning = (inertia.m11 + inertia.m22 + inertia.m33) * body.angvel().length();
    flight.constraint_time > 0.0
        && flight.constraint_impulse.length() <= SLACK * momentum
        && held_motion::turned(shared, *body.rotation(), flight.constraint_turn).length()
            <= SLACK * turning
}

/// What the coming step counts on, in proportion to its time. It turns with the body where that was the better
/// guess for the last step, as on a wheel, and not on a rope. A body that turns far in a step and whose joint
/// does not turn with it will be pushed in another direction: nothing is expected then.
pub(super) fn of_step(flight: &FlightState, angular: Vector, dt: Real) -> JointAction {
    let turn = angular.length() * dt;
    if dt < SHORT || flight.constraint_time <= 0.0 || (turn >= FAR && !flight.constraint_turns) {
        return JointAction::default();
    }
    let share = (dt / flight.constraint_time).min(LONGER);
    let mut action = JointAction {
        impulse: flight.constraint_impulse * share,
        turn: flight.constraint_turn * (share * (1.0 - turn / STEADY).max(0.0)),
    };
    if turn >= NEAR && flight.constraint_turns {
        let attitude = Rotation::from_scaled_axis(angular * dt);
        action.impulse = attitude * action.impulse;
        action.turn = attitude * action.turn;
    }
    action
}

/// A vector turned by a rotation vector.
fn turned_by(v: Vector, turn: Vector) -> Vector {
    Rotation::from_scaled_axis(turn) * v
}

/// Learns from rapier's step what the joints of a body did, and sets its velocity right where they have
/// opened. Of a body that is `touched` by others nothing can be learnt: in water a plate that slides has a
/// multiple of its mass across the slide, and what a contact does would be counted on as the joint's.
pub(super) fn learn(
    mass: &BodyMass,
    body: &mut RigidBody,
    flight: &mut FlightState,
    start: &HeldStart,
    touched: bool,
    dt: Real,
) -> JointAction {
    let locked = locked_axes::linear(start.locks);
    let undamped = body.linvel() * (1.0 + dt * body.linear_damping());
    let mut surprise = undamped - start.linear - start.expected_change;
    let rounding = ROUNDING * (undamped.length() + start.linear.length());
    if surprise.length() <= rounding {
        surprise = Vector::ZERO;
    }
    let solver_mass = flight.solver_mass;
    let surprise = surprise * solver_mass * (Vector::ONE - vector(locked));
    let expected = start.expected.impulse;
    let impulse = expected + surprise;
    let turned = body.angvel() * (1.0 + dt * body.angular_damping());
    let turn = turned - start.angular - start.expected_turn + start.expected.turn;
    if touched {
        flight.forget_joints();
    }
    if touched || dt < SHORT {
        return JointAction { impulse, turn };
    }
    let mean_turn = (start.angular + body.angvel()) * (0.5 * dt);
    if mean_turn.length_squared() > NEAR * NEAR {
        let last = flight.constraint_impulse;
        let with_body = impulse - turned_by(last, mean_turn);
        flight.constraint_turns = with_body.length_squared() < (impulse - last).length_squared();
    }
    let attitude = start.attitude;
    let masses = &mass.principal;
    let opened =
        expected != Vector::ZERO && impulse.dot(expected) < OPEN * expected.length_squared();
    flight.constraint_time = dt;
    flight.constraint_turn = if start.learns_turn {
        turn
    } else {
        Vector::ZERO
    };
    if opened {
        let right = masses.scale(attitude, surprise, |mass| 1.0 / mass - 1.0 / solver_mass);
        if !start.linked {
            body.set_linvel(body.linvel() + right, false);
        }
        flight.constraint_impulse = impulse;
    } else {
        let learnt = masses.scale(attitude, surprise, |mass| (mass / solver_mass).min(1.0));
        flight.constraint_impulse = expected + learnt;
    }
    if !(flight.constraint_impulse + flight.constraint_turn).is_finite() {
        flight.constraint_impulse = Vector::ZERO;
        flight.constraint_turn = Vector::ZERO;
    }
    JointAction { impulse, turn }
}
