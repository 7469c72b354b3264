//! The velocities that a body shall have after a step in which joints hold it, with locked axes or without.
//! (What locked axes alone hold is moved by its mean velocity, see [`mean_motion`](super::mean_motion).)
//!
//! Such a body gets a force and a torque alone; rapier's n substeps then turn it by Cayley maps of a
//! velocity that grows evenly, so that it reaches another attitude R' than the integrator's R (by
//! 0.125·dt·Δω at four substeps). Were it given the integrator's velocity in world axes, its velocity in
//! its own axes would be off by as much, and with it the energy `½ν·𝕄ν`, which a spinning rod gains by
//! per cents in each second. Here rapier's substeps are replayed, and the velocities of the body's **own**
//! axes are those that the integrator found. R' depends on the velocity at the end, and that on R':
//! a few passes, each of which leaves a tenth of the error or less.

use super::locked_axes;
use super::stage_data::{HeldStart, Substeps};
use crate::coupling::body_mass::BodyMass;
use crate::coupling::shared_constants::SharedConstants;
use crate::math::{to_f64, to_quaternion, to_real};
use rapier3d::math::{Real, Rotation, Vector};
use rapier3d::na::{Vector3, Vector6};

/// Passes over attitude and velocity.
const PASSES: usize = 3;
/// Turn in a step, rad, below which its substeps are replayed by a series.
const SLOW: Real = 0.3;
/// Relative change of the angular velocity in a pass that needs no other.
const NEAR: Real = 1e-4;

/// Linear and angular velocity at the end of the step, world axes. `plate` maps the plate axes to the
/// world at its start; `guess` is the angular velocity that the integrator found.
pub(super) fn end_velocities(
    shared: &SharedConstants,
    mass: &BodyMass,
    plate: Rotation,
    start: &HeldStart,
    guess: Vector,
    substeps: Substeps,
) -> (Vector, Vector) {
    let (mut linear, mut angular) = (start.linear, guess);
    for _ in 0..PASSES {
        let last = angular;
        let reached = replayed(plate, start.angular, angular, substeps);
        (linear, angular) = under_locks(shared, mass, reached, start);
        // What is left is a tenth of this, or the part of a radian that the step turns the body by.
        if (angular - last).length_squared() <= NEAR * NEAR * angular.length_squared() {
            break;
        }
    }
    (linear, angular)
}

/// Linear and angular velocity in world axes of a body at an attitude (plate axes to world), under its
/// locks.
pub(super) fn under_locks(
    shared: &SharedConstants,
    mass: &BodyMass,
    plate: Rotation,
    start: &HeldStart,
) -> (Vector, Vector) {
    let linear = plate * start.own_linear + start.fluid_velocity;
    let angular = plate * start.own_angular;
    if start.locks.is_empty() {
        return (linear, angular);
    }
    let six = |linear, angular| {
        let (v, w) = (to_f64(linear), to_f64(angular));
        Vector6::new(v.x, v.y, v.z, w.x, w.y, w.z)
    };
    let body = to_quaternion(plate * shared.axes.inverse()).to_rotation_matrix();
    let kept = six(start.linear, start.angular);
    let obeys = locked_axes::obey(mass, &body, start.locks, six(linear, angular), &kept);
    (
        to_real(obeys.fixed_rows::<3>(0).into_owned()),
        to_real(obeys.fixed_rows::<3>(3).into_owned()),
    )
}

/// What the inertia that rapier is given makes of an angular velocity or acceleration: angular momentum or
/// torque, world axes. `attitude` maps the body's frame to the world.
pub(super) fn turned(shared: &SharedConstants, attitude: Rotation, angular: Vector) -> Vector {
    let plate = attitude * shared.axes;
    let own = plate.inverse() * angular;
    let own = shared
        .step
        .scales
        .torque_for(&Vector3::new(own.x, own.y, own.z));
    plate * Vector::new(own.x, own.y, own.z)
}

/// The attitude that rapier's substeps reach from `attitude`, whose angular velocity grows evenly from
/// `start` to `end`.
pub(super) fn replayed(
    attitude: Rotation,
    start: Vector,
    end: Vector,
    substeps: Substeps,
) -> Rotation {
    let count = substeps.count as Real;
    let dt = substeps.length * count;
    if start.length_squared().max(end.length_squared()) * (dt * dt) < SLOW * SLOW {
        return replayed_at_once(attitude, start, end, count, dt);
    }
    let change = (end - start) / count;
    let mut now = start;
    let mut reached = attitude;
    for _ in 0..substeps.count {
        now += change;
        let half = now * (0.5 * substeps.length);
        reached = Rotation::from_xyzw(half.x, half.y, half.z, 1.0) * reached;
        // Products of many long quaternions would overflow.
        reached = reached.normalize();
    }
    reached
}

/// The same for small turns, by the rotation vector of the product: with Δ = `end − start` and n substeps it
/// is `dt (ω₀ + (n+1)/2n Δ) − dt²/12 (1 − 1/n²) ω₀ × Δ` (the sum, and half of all commutators), each Cayley
/// map turning by a twelfth of θ³ less than θ.
fn replayed_at_once(
    attitude: Rotation,
    start: Vector,
    end: Vector,
    count: Real,
    dt: Real,
) -> Rotation {
    let change = end - start;
    let commutator = start.cross(change) * (dt * dt / 12.0 * (1.0 - 1.0 / (count * count)));
    let turn = (start + change * (0.5 + 0.5 / count)) * dt - commutator;
    let square = turn.length_squared();
    // tan(θ/2) of the whole turn, as the half of a quaternion whose real part is 1.
    let half = turn * (0.5 + square * (1.0 - 1.0 / (count * count)) / 24.0);
    (Rotation::from_xyzw(half.x, half.y, half.z, 1.0) * attitude).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The series against the product of the substeps, for turns up to where it is used.
    #[test]
    fn small_turns_are_replayed_at_once() {
        let attitude = Rotation::from_scaled_axis(Vector::new(0.3, -2.0, 1.0));
        let dt = 1.0 / 60.0;
        for scale in [0.1, 0.5, 1.0] {
            let start = Vector::new(0.2, 0.1, -0.15) * (scale / dt);
            let end = Vector::new(0.1, 0.16, -0.2) * (scale / dt);
            for count in [1, 2, 4, 9] {
                let mut exact = attitude;
                let mut now = start;
                for _ in 0..count {
                    now += (end - start) / count as Real;
                    let half = now * (0.5 * dt / count as Real);
                    exact = (Rotation::from_xyzw(half.x, half.y, half.z, 1.0) * exact).normalize();
                }
                let found = replayed_at_once(attitude, start, end, count as Real, dt);
                let miss = found * exact.inverse();
                let miss = 2.0 * Vector::new(miss.x, miss.y, miss.z).length();
                assert!(
                    miss < 4e-6 + 2e-5 * scale * scale * scale,
                    "{scale} {count}: {miss:e}"
                );
            }
        }
    }
}
