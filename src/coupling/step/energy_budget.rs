//! A joint gives a body no more energy than its impulse does.
//!
//! Rapier moves a jointed body with a scalar mass and the inertia of the step's start; body and fluid have
//! 𝕄 in axes that turn with the body. Where a step turns it far, the velocity that the solver leaves has
//! another energy ½ν·𝕄ν at the new attitude than the impulses have worked, and in thousands of steps a few
//! per mille each way become a runaway. What the energy may be is known after the step. With ν₀ before it
//! and ν₁ after it, relative to the fluid, and with the load Q (weight, buoyancy, user's force) and the
//! constraint's impulse J,
//!
//! ```text
//! ½ν₁·𝕄ν₁ ≤ ½ν₀·𝕄ν₀ + (Q dt + J)·(ν₀ + ν₁)/2
//! ```
//!
//! since drag only takes. In rapier's own terms the work of J is exact as long as the step does not turn the
//! body far. Of joints without motors to bodies that stand still it is known better: they do none, and −J·v in the frame of a fluid that moves by v. Where the
//! fluid changes its velocity it works, too; its work is in the motion that was integrated, ν':
//!
//! ```text
//! ½ν₁·𝕄ν₁ ≤ ½ν'·𝕄ν' + J·(ν₀ + ν₁)/2 − Ĵ·(ν₀ + ν')/2
//! ```
//!
//! A body that has more is slowed down, all velocities by the same factor, which keeps what a joint to the
//! world demands. Errors that took energy are remembered up to 2·10⁻⁴ of it, so that those which come
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
const RESERVE: Real = 2e-4;
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
    dt: Real,
) {
    let energy = |attitude: Rotation, relative: Vector, angular: Vector| {
        let back = (attitude * shared.axes).inverse();
        kinetic_energy(shared, back * relative, back * angular)
    };
    let relative = body.linvel() - start.fluid_velocity;
    let now = energy(*body.rotation(), relative, body.angvel());
    let before = start.linear - start.fluid_velocity;
    let mean = (before + relative) * 0.5;
    let mean_turn = (start.angular + body.angvel()) * 0.5;
    let without_joints = if start.steady {
        let loads = start.load_force.dot(mean) + start.load_torque.dot(mean_turn);
        energy(start.attitude, before, start.angular) + loads * dt
    } else {
        let integrated = kinetic_energy(shared, start.own_linear, start.own_angular);
        integrated - start.impulse.dot(before + start.expected_change * 0.5)
    };
    let work = if start.workless {
        -did.impulse.dot(start.fluid_velocity)
    } else {
        did.impulse.dot(mean) + did.moment.dot(mean_turn)
    };
    let reserve = flight.energy_reserve + without_joints + work - now;
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
