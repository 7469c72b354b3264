//! Free bodies that a force and a start velocity cannot lead to both pose and velocity
//! (see [`substep_matching`](super::substep_matching)):
//!
//! * where rapier takes a single substep, which moves the body by the velocity at the end;
//! * where a body has solver iterations of its own, so that it takes another number of substeps;
//! * where locked axes hold it: the turn of a step is not one about the free axes;
//! * where a body turns so far in a step, or changes its spin so much, that the series of rotation vectors
//!   would miss the attitude by more than a milliradian.
//!
//! Such a body is moved by its **mean** velocity, without force or torque, so that its pose is right
//! whatever the number of substeps; the velocity at the end of the step is set after it. What a contact in
//! the meantime did to the mean velocity is kept. A pile would never come to rest so, but these are free.
//!
//! The mean angular velocity is that with which n Cayley maps make the whole turn θ,
//! `ω̄ = (2n/dt) tan(θ/2n)` about its axis, θ being of all 2πk + θ₀ the turn closest to the body's spin.

use super::held_motion::replayed;
use super::locked_axes;
use super::stage_data::{StepContext, StepInput, StepOutput};
use crate::math;
use crate::math::{Row, vector};
use rapier3d::dynamics::{LockedAxes, RigidBody};
use rapier3d::math::{Real, Rotation, Vector};
use std::f32::consts::{PI, TAU};

/// Turn per step, rad, up to which the series is known to hold.
const SLOW: Real = 1.5;
/// Miss of the attitude, rad, that the next step can make up for.
const MISS: Real = 0.001;
/// Relative difference of velocities that rounding can cause.
const ROUNDING: Real = 2e-6;

/// Velocities of a body that is moved by its mean velocity. World axes, m/s and rad/s.
#[derive(Clone, Copy, Debug)]
pub(in crate::coupling) struct MeanMotion {
    pub mean_linear: Vector,
    pub mean_angular: Vector,
    end_linear: Vector,
    end_angular: Vector,
}

impl MeanMotion {
    /// How a body is moved that needs this, `None` if it does not.
    #[inline(always)]
    pub fn of(input: &StepInput, output: &StepOutput, context: &StepContext) -> Option<Self> {
        let (now, end) = (vector(input.rapier_angular), vector(output.end_angular));
        let spin = now.length_squared().max(end.length_squared());
        let spin = spin.max(vector(output.start_angular).length_squared());
        let needed = input.own_substeps > 0
            || context.substeps == 1
            || (spin * (context.dt * context.dt) > SLOW * SLOW && misses(input, output, context));
        (input.free && needed).then(|| Self::new(input, output, context))
    }

    fn new(input: &StepInput, output: &StepOutput, context: &StepContext) -> Self {
        let end_linear = vector(output.end_linear);
        let end_angular = vector(output.end_angular);
        let from = Rotation::from_array(input.rapier_attitude);
        let turn = Rotation::from_array(output.motion.attitude) * from.inverse();
        let expected = (vector(input.rapier_angular) + end_angular) * (0.5 * context.dt);
        let count = context.substeps_of(input).count;
        Self {
            mean_linear: context.scheme.mean(vector(output.start_linear), end_linear),
            mean_angular: mean_spin(turn, expected, count) / context.dt,
            end_linear,
            end_angular,
        }
    }

    /// How a body is moved that only its locked axes hold: always by its mean velocity, so that attitude and
    /// velocities are those under which its energy was integrated. `end` are its velocities at the end.
    pub fn locked(
        input: &StepInput,
        output: &StepOutput,
        context: &StepContext,
        end: (Vector, Vector),
    ) -> Self {
        let mut motion = Self::new(input, output, context);
        let start = (vector(input.rapier_linear), vector(input.rapier_angular));
        let keep = |mean: &mut Vector, start: Vector, locked: Row| {
            *mean += (start - *mean) * vector(locked);
        };
        keep(
            &mut motion.mean_linear,
            start.0,
            locked_axes::linear(input.locks),
        );
        // Turns about two axes add up to some about the third; those about one axis do not leave it.
        if (input.locks & LockedAxes::ROTATION_LOCKED)
            .bits()
            .count_ones()
            > 1
        {
            let locked = locked_axes::angular(input.locks);
            keep(&mut motion.mean_angular, start.1, locked);
        }
        Self {
            end_linear: end.0,
            end_angular: end.1,
            ..motion
        }
    }

    /// After the step: gives the body its velocity at the end.
    pub fn finish(&self, body: &mut RigidBody) {
        let linear = ended(body.linvel(), self.mean_linear, self.end_linear);
        let angular = ended(body.angvel(), self.mean_angular, self.end_angular);
        body.set_linvel(linear, false);
        body.set_angvel(angular, false);
    }
}

/// Whether rapier's substeps from the start velocity would not lead to the attitude.
fn misses(input: &StepInput, output: &StepOutput, context: &StepContext) -> bool {
    let substeps = context.substeps_of(input);
    let from = Rotation::from_array(input.rapier_attitude);
    let (start, end) = (vector(output.start_angular), vector(output.end_angular));
    let reached = replayed(from, start, end, substeps);
    let cosine = reached.dot(Rotation::from_array(output.motion.attitude));
    cosine.abs() < math::cos(0.5 * MISS)
}

/// The velocity at the end of a step after which rapier has `now`.
fn ended(now: Vector, mean: Vector, end: Vector) -> Vector {
    let change = now - mean;
    if change.length() > ROUNDING * mean.length() {
        end + change
    } else {
        end
    }
}

/// The rotation vector per step, tangents in place of angles, of `count` Cayley maps that make `turn`,
/// about as many times around as `expected`.
fn mean_spin(turn: Rotation, expected: Vector, count: usize) -> Vector {
    let turn = if turn.w < 0.0 { -turn } else { turn };
    let half = Vector::new(turn.x, turn.y, turn.z);
    let sine = half.length();
    let (axis, angle) = if sine > 1e-12 {
        (half / sine, 2.0 * math::atan2(sine, turn.w))
    } else {
        (expected.normalize_or_zero(), 0.0)
    };
    let around = ((expected.dot(axis) - angle) / TAU).round() * TAU;
    let count = count.max(1) as Real;
    // A substep cannot turn by half a turn.
    let whole = if (angle + around).abs() < 0.9 * PI * count {
        angle + around
    } else {
        angle
    };
    axis * (2.0 * count * math::tan(whole / (2.0 * count)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rapier's Cayley maps with the mean spin make the turn, however large, in one substep or many.
    #[test]
    fn cayley_maps_make_the_turn() {
        let axis = Vector::new(0.6, -0.48, 0.64);
        for angle in [1e-8, 0.3, 2.0, 3.1, 4.0, 9.0_f32] {
            for count in [1, 2, 4, 5, 16] {
                let wanted = Rotation::from_axis_angle(axis, angle);
                let spin = mean_spin(wanted, axis * angle, count);
                let a = spin * (0.5 / count as Real);
                let mut turn = Rotation::IDENTITY;
                for _ in 0..count {
                    turn = (Rotation::from_xyzw(a.x, a.y, a.z, 1.0) * turn).normalize();
                }
                let miss = turn * wanted.inverse();
                let miss = 2.0 * Vector::new(miss.x, miss.y, miss.z).length();
                assert!(miss < 3e-5, "{angle} {count}: {miss:e}");
                if count > 5 {
                    assert!(spin.dot(axis) > 0.99 * angle, "{angle} {count}: {spin}");
                }
            }
        }
    }
}
