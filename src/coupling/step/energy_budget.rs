//! A joint gives a body no more energy than its impulse does.
//!
//! Rapier moves a jointed body with a scalar mass and the inertia of the step's start; body and fluid have
//! 𝕄 in axes that turn with the body. Where a step turns it far, the velocity that the solver leaves has
//! another energy ½ν·𝕄ν at the new attitude than the impulses have worked, and in thousands of steps a few
//! per mille each way become a runaway. What the energy may be is known after the step: that of the motion
//! which was integrated, with the work of the impulse J that was found in place of that of the Ĵ that was
//! expected,
//!
//! ```text
//! E ≤ ½ν·𝕄ν (integrated) − Ĵ·(v₀ + v_pred)/2 + J·(v₀ + v₁)/2 + J_ω·(ω₀ + ω₁)/2
//! ```
//!
//! with velocities relative to the fluid. In rapier's own terms, with its scalar mass, this work is exact.
//! A body that has more is slowed down, all velocities by the same factor, which keeps what a joint to the
//! world demands. Errors that took energy are remembered up to a thousandth of it, so that those which come
//! and go in turns damp nothing.

use super::constraint_impulse::Learnt;
use super::workspace::HeldStart;
use crate::coupling::body_state::FlightState;
use crate::coupling::shared_constants::SharedConstants;
use crate::math::spatial::{Twist, dot};
use rapier3d::dynamics::RigidBody;
use rapier3d::math::{Real, Rotation, Vector};
use rapier3d::na::Vector3;

/// Share of its energy that a body may get back of what was lost.
const RESERVE: Real = 1e-3;
/// Relative excess that is left alone: rounding.
const ROUNDING: Real = 1e-6;

/// Kinetic energy of body and fluid, J; velocities in plate axes.
pub(super) fn kinetic_energy(shared: &SharedConstants, linear: Vector, angular: Vector) -> Real {
    let constants = &shared.constants;
    let length = constants.length as Real;
    let velocity = Twist {
        linear: Vector3::new(linear.x, linear.y, linear.z),
        angular: Vector3::new(angular.x, angular.y, angular.z) * length,
    };
    let momentum = shared.step.inertia.mass_matrix().apply(&velocity);
    let twice = dot(&momentum.force, &velocity.linear) + dot(&momentum.torque, &velocity.angular);
    0.5 * constants.mass as Real * twice
}

/// Slows a jointed body down that has more energy than its joints can have given it.
pub(super) fn keep(
    shared: &SharedConstants,
    body: &mut RigidBody,
    flight: &mut FlightState,
    start: &HeldStart,
    did: &Learnt,
) {
    let plate: Rotation = *body.rotation() * shared.axes;
    let relative = body.linvel() - start.fluid_velocity;
    let back = plate.inverse();
    let now = kinetic_energy(shared, back * relative, back * body.angvel());
    let integrated = kinetic_energy(shared, start.own_linear, start.own_angular);
    let before = start.linear - start.fluid_velocity;
    let mean = (before + relative) * 0.5;
    let mean_expected = before + start.expected_change * 0.5;
    let mean_turn = (start.angular + body.angvel()) * 0.5;
    let work = did.impulse.dot(mean) - start.impulse.dot(mean_expected) + did.moment.dot(mean_turn);
    let reserve = flight.energy_reserve + integrated + work - now;
    if reserve.is_nan() {
        flight.energy_reserve = 0.0;
        return;
    }
    flight.energy_reserve = reserve.clamp(0.0, RESERVE * now);
    if reserve < -ROUNDING * now {
        let factor = ((now + reserve) / now).max(0.0).sqrt();
        body.set_linvel(start.fluid_velocity + relative * factor, false);
        body.set_angvel(body.angvel() * factor, false);
    }
}
