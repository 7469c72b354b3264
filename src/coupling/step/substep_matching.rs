//! The force and the start velocities with which rapier's substeps reach the motion that was integrated.
//!
//! Rapier's solver takes n substeps of h = dt/n. In each it first adds `F h/m_s` to the velocity and
//! then moves the body by the new velocity. A constant force that makes up the difference Δ of the
//! velocities therefore moves the body by `v₀ + Δ(n+1)/2n` on average, not by the mean velocity:
//! the velocity is right but the pose runs ahead by Δ·dt/2n.
//!
//! A **free** body gets both right: its velocity is first set to `v₁ − Δ'` with
//! `Δ' = (v₁ − v̄)·2n/(n−1)`, so that after the force both the last velocity v₁ and the mean velocity
//! v̄ are those that were integrated. The same holds for the rotation, where the rotation vector of
//! the product of rapier's n small rotations (Cayley maps, about axes that turn, so that they do not
//! commute) is written as a series and solved for the mean. With σ the mean angular velocity times
//! dt, τ its change over the step times dt and c = σ × τ,
//!
//! ```text
//! R = σ − κc − μ|σ|²c + λ c × τ − (|σ|²σ + κ(2(σ·τ)τ + |τ|²σ)) / 12n²
//! κ = (1 − n⁻²)/12,   μ = (1 − n⁻²)(1 − 9n⁻²)/720,   λ = (1 − n⁻²)(1 − ⅔n⁻²)/240
//! ```
//!
//! (for n → ∞ Magnus' series; the dependence on n was fitted to products of rotations and is exact
//! to their rounding). What is left, about 10⁻⁵ rad for a body that turns by half a radian per step,
//! is made up for in the next step, because the attitude that the crate integrates is kept.
//!
//! A body in **contact** or held by a joint gets a force alone, since setting velocities would keep a
//! pile from coming to rest.

use crate::math::Scalar;
use crate::math::spatial::{conjugate, cross, dot, quaternion_product, select_lt};
use rapier3d::math::Vector;
use rapier3d::na::{Quaternion, Vector3};

/// How rapier divides a step, and the coefficients of the series that follow from it.
#[derive(Clone, Copy)]
pub(in crate::coupling) struct SubstepScheme {
    /// Time step, s, and its inverse.
    dt: f64,
    per_dt: f64,
    /// Whether rapier takes more than one substep; if not, velocity and pose cannot both be right.
    split: bool,
    /// Δ' per v₁ − v̄.
    gain: f64,
    kappa: f64,
    mu: f64,
    lambda: f64,
    cayley: f64,
}

impl SubstepScheme {
    /// The scheme of `substeps` substeps per step of `dt` seconds.
    pub fn new(dt: f32, substeps: usize) -> Self {
        let n = substeps.max(1) as f64;
        let n2 = n * n;
        let shrunk = 1.0 - 1.0 / n2;
        let dt = f64::from(dt);
        Self {
            dt,
            per_dt: 1.0 / dt,
            split: substeps > 1,
            gain: 2.0 * n / (n - 1.0).max(1.0),
            kappa: shrunk / 12.0,
            mu: shrunk * (1.0 - 9.0 / n2) / 720.0,
            lambda: shrunk * (1.0 - 2.0 / (3.0 * n2)) / 240.0,
            cayley: 1.0 / (12.0 * n2),
        }
    }
}

impl SubstepScheme {
    /// The mean velocity of a free body that was to start with `start` and reach `end`.
    pub fn mean(&self, start: Vector, end: Vector) -> Vector {
        if self.split {
            end - (end - start) / self.gain as f32
        } else {
            start
        }
    }
}

/// What rapier's bodies have, and what they shall have.
pub(super) struct Target<'a, T> {
    pub scheme: &'a SubstepScheme,
    /// Plate axes to world, now and at the end of the step.
    pub attitude: Quaternion<T>,
    pub end_attitude: Quaternion<T>,
    /// Velocities now.
    pub linear: Vector3<T>,
    pub angular: Vector3<T>,
    /// Velocities at the end of the step.
    pub end_linear: Vector3<T>,
    pub end_angular: Vector3<T>,
    /// Displacement of the center of mass over the step.
    pub displacement: Vector3<T>,
    /// 1 where the body is free, 0 where it touches something.
    pub free: T,
}

/// What rapier's bodies are given before the step.
pub(super) struct Matched<T> {
    /// Velocities to start from.
    pub start_linear: Vector3<T>,
    pub start_angular: Vector3<T>,
    /// Accelerations, linear (m/s²) and angular (rad/s²), that the force and the torque shall cause.
    pub linear_acceleration: Vector3<T>,
    pub angular_acceleration: Vector3<T>,
}

/// Passes over the small terms of the series; each leaves about a hundredth of the error.
const REFINEMENTS: usize = 2;

impl<T: Scalar> Target<'_, T> {
    #[inline(always)]
    pub fn matched(&self) -> Matched<T> {
        let scheme = self.scheme;
        let constant = |value| self.free.constant(value);
        let (per_dt, gain) = (constant(scheme.per_dt), constant(scheme.gain));
        // A body in contact gets the whole change by the force.
        let linear = self.end_linear - self.linear;
        let angular = self.end_angular - self.angular;
        let mean = self.displacement * per_dt;
        let (free_linear, free_angular) = if scheme.split {
            let spin = self.mean_spin();
            (
                (self.end_linear - mean) * gain,
                (self.end_angular - spin) * gain,
            )
        } else {
            let nothing = Vector3::repeat(constant(0.0));
            (nothing, nothing)
        };
        let (start_linear, start_angular) = if scheme.split {
            (
                self.end_linear - free_linear,
                self.end_angular - free_angular,
            )
        } else {
            // What the mean alone leads to is the matter of another file.
            (mean, self.end_angular)
        };
        // In the lanes of touching bodies `free` is 0 and below this.
        let limit = constant(0.5);
        let touching = |value, other| select_lt(value, self.free, limit, other);
        Matched {
            start_linear: touching(&self.linear, &start_linear),
            start_angular: touching(&self.angular, &start_angular),
            linear_acceleration: touching(&linear, &free_linear) * per_dt,
            angular_acceleration: touching(&angular, &free_angular) * per_dt,
        }
    }

    /// The mean angular velocity with which rapier's substeps turn the body to `end_attitude`.
    #[inline(always)]
    fn mean_spin(&self) -> Vector3<T> {
        let scheme = self.scheme;
        let constant = |value| self.free.constant(value);
        let (one, two) = (constant(1.0), constant(2.0));
        let nothing = Vector3::repeat(constant(0.0));
        let (dt, per_dt, gain) = (
            constant(scheme.dt),
            constant(scheme.per_dt),
            constant(scheme.gain),
        );
        let (kappa, mu, lambda) = (
            constant(scheme.kappa),
            constant(scheme.mu),
            constant(scheme.lambda),
        );
        let cayley = constant(scheme.cayley);
        let turn = quaternion_product(&self.end_attitude, &conjugate(&self.attitude));
        let turn = rotation_vector(&turn);
        // τ = gain (ε − σ), so that κσ × τ is linear in σ: (1 + κ gain ε ×) σ = R + the rest.
        let end = self.end_angular * dt;
        let skew = end * (kappa * gain);
        let per = one / (one + dot(&skew, &skew));
        let mut mean = unskewed(&skew, per, &turn);
        for _ in 0..REFINEMENTS {
            let change = (end - mean) * gain;
            let across = cross(&mean, &change);
            let mean2 = dot(&mean, &mean);
            let aligned = dot(&mean, &change);
            let small = across * (mu * mean2) - cross(&across, &change) * lambda
                + (mean * (mean2 + kappa * dot(&change, &change))
                    + change * (two * kappa * aligned))
                    * cayley;
            // Beyond a radian or two the series means nothing.
            let within = dot(&small, &small) * constant(16.0);
            let small = select_lt(&small, within, mean2, &nothing);
            mean = unskewed(&skew, per, &(turn + small));
        }
        mean * per_dt
    }
}

/// Solves `x + s × x = b`, where `per` is 1/(1 + s²).
#[inline(always)]
fn unskewed<T: Scalar>(s: &Vector3<T>, per: T, b: &Vector3<T>) -> Vector3<T> {
    (b - cross(s, b) + s * dot(s, b)) * per
}

/// Rotation vector of a unit quaternion, the shorter way round: `4 atan(t)` along the axis, with
/// t = tan(θ/4) ≤ 1 and the arc tangent as its series, to 5e-5 for turns by two radians.
#[inline(always)]
fn rotation_vector<T: Scalar>(q: &Quaternion<T>) -> Vector3<T> {
    let (q, w) = (q.coords.xyz(), q.coords.w);
    let one = w.constant(1.0);
    let sign = w.constant(-1.0).select_lt(w, w.constant(0.0), one);
    let t = q * (sign / (one + w * sign));
    let t2 = dot(&t, &t);
    let mut series = w.constant(-1.0 / 11.0);
    for term in [1.0 / 9.0, -1.0 / 7.0, 0.2, -1.0 / 3.0, 1.0] {
        series = series * t2 + w.constant(term);
    }
    t * (series * w.constant(4.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::spatial::rotate;
    use rapier3d::math::Rotation;

    fn to_nalgebra(v: Vector) -> Vector3<f32> {
        Vector3::new(v.x, v.y, v.z)
    }

    fn quaternion(q: Rotation) -> Quaternion<f32> {
        Quaternion::new(q.w, q.x, q.y, q.z)
    }

    fn vector(v: &Vector3<f32>) -> Vector {
        Vector::new(v.x, v.y, v.z)
    }

    /// Replays what rapier's solver does with the force and torque (velocity increment, then a Cayley
    /// rotation, n times) for bodies that turn by up to a radian per step about a turning axis.
    #[test]
    fn replayed_substeps_reach_the_target() {
        let dt = 1.0 / 60.0;
        for (scale, tolerance) in [(0.2, 2e-6), (1.0, 2e-5), (2.0, 5e-4)] {
            let angular = Vector::new(10.0, 20.0, -15.0) * scale;
            let end_angular = Vector::new(16.0, 12.0, -18.0) * scale;
            let mean = (angular + end_angular) * 0.5;
            let start = Rotation::from_scaled_axis(Vector::new(0.3, -2.0, 1.0));
            let end = Rotation::from_scaled_axis(mean * dt) * start;
            let (linear, end_linear) = (Vector::new(1.0, 2.0, 3.0), Vector::new(0.5, -1.0, 3.5));
            let moved = (linear + end_linear) * (0.5 * dt);
            let target = Target {
                scheme: &SubstepScheme::new(dt, 4),
                attitude: quaternion(start),
                end_attitude: quaternion(end),
                linear: to_nalgebra(linear),
                angular: to_nalgebra(angular),
                end_linear: to_nalgebra(end_linear),
                end_angular: to_nalgebra(end_angular),
                displacement: to_nalgebra(moved),
                free: 1.0,
            };
            let matched = target.matched();
            let (mut v, mut w) = (
                vector(&matched.start_linear),
                vector(&matched.start_angular),
            );
            let (mut x, mut q) = (Vector::ZERO, start);
            for _ in 0..4 {
                v += vector(&matched.linear_acceleration) * (dt / 4.0);
                w += vector(&matched.angular_acceleration) * (dt / 4.0);
                x += v * (dt / 4.0);
                let a = w * (dt / 8.0);
                q = (Rotation::from_xyzw(a.x, a.y, a.z, 1.0) * q).normalize();
            }
            assert!((v - end_linear).length() < 1e-5);
            assert!((w - end_angular).length() < 1e-4);
            assert!((x - moved).length() < 1e-6);
            let miss = q * end.inverse();
            let miss = 2.0 * Vector::new(miss.x, miss.y, miss.z).length();
            assert!(miss < tolerance, "{scale}: {miss:e}");
        }
    }

    /// Rotation vectors of turns by up to two radians, to what is said of the series: 5e-5 of the turn.
    #[test]
    fn rotation_vector_of_large_turns() {
        let axis = Vector::new(0.6, -0.48, 0.64);
        for angle in [0.5, 1.0, 1.5, 2.0_f32] {
            let turn = quaternion(Rotation::from_axis_angle(axis, angle));
            let found = vector(&rotation_vector(&turn));
            assert!(
                (found - axis * angle).length() < 5e-5 * angle,
                "{angle}: {found}"
            );
        }
    }

    /// In double precision the series finds the start velocity from which n Cayley maps have led to an attitude
    /// (turns by a quarter of a radian). What it leaves out, 2.6e-7 for n = 4 and less for more, is less than a
    /// tenth of each of its terms is: of that with μ 5e-7, of that with λ 3e-6.
    #[test]
    fn the_series_finds_the_start() {
        for count in [4_u8, 8, 16] {
            let start = Vector3::new(0.5, 0.9, -0.7) * 0.2;
            let end = Vector3::new(0.9, 0.5, -0.9) * 0.2;
            let mut turn = Quaternion::new(1.0, 0.0, 0.0, 0.0);
            for k in 1..=count {
                let share = f64::from(k) / f64::from(count);
                let a = (start + (end - start) * share) * (0.5 / f64::from(count));
                turn = Quaternion::from_parts(1.0, a) * turn;
            }
            let target = Target {
                scheme: &SubstepScheme::new(1.0, count.into()),
                attitude: Quaternion::new(1.0, 0.0, 0.0, 0.0),
                end_attitude: turn.normalize(),
                linear: Vector3::zeros(),
                angular: Vector3::zeros(),
                end_linear: Vector3::zeros(),
                end_angular: end,
                displacement: Vector3::zeros(),
                free: 1.0_f64,
            };
            let miss = (target.matched().start_angular - start).norm();
            assert!(miss < 3.5e-7, "{count}: {miss:e}");
        }
    }

    /// A world that is told to take no substep at all gets the numbers of one.
    #[test]
    fn no_substep_is_one() {
        let of = |substeps| {
            let s = SubstepScheme::new(0.01, substeps);
            (s.gain, s.kappa, s.mu, s.lambda, s.cayley, s.split)
        };
        assert_eq!(of(0), of(1));
        assert!(of(0).0.is_finite());
    }

    /// Rotation vectors of small turns, whichever sign the quaternion has.
    #[test]
    fn rotation_vector_of_small_turns() {
        let v = Vector::new(0.02, -0.01, 0.03);
        for sign in [1.0, -1.0] {
            let q = Rotation::from_scaled_axis(v) * sign;
            assert!((vector(&rotation_vector(&quaternion(q))) - v).length() < 1e-7);
        }
        let axis = rotate(&quaternion(Rotation::from_scaled_axis(v)), &to_nalgebra(v));
        assert!((vector(&axis) - v).length() < 1e-7);
    }
}
