//! How the motion that the crate integrated is handed to rapier.
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

use crate::dynamics::kirchhoff::cross;
use crate::math::{Lanes, Scalar};
use rapier3d::na::{Quaternion, Vector3};

type V = Vector3<Lanes>;

/// How rapier steps, and the coefficients of the series that follow from it.
#[derive(Clone, Copy)]
pub(super) struct Pace {
    /// Time step, s, and its inverse.
    dt: Lanes,
    per_dt: Lanes,
    /// Whether rapier takes more than one substep; if not, velocity and pose cannot both be right.
    split: bool,
    /// Δ' per v₁ − v̄.
    gain: Lanes,
    kappa: Lanes,
    mu: Lanes,
    lambda: Lanes,
    cayley: Lanes,
}

impl Pace {
    /// Of `substeps` substeps per step of `dt` seconds.
    pub fn new(dt: f32, substeps: usize) -> Self {
        let n = substeps.max(1) as f64;
        let n2 = n * n;
        let shrunk = 1.0 - 1.0 / n2;
        let dt = f64::from(dt);
        Self {
            dt: Lanes::lit(dt),
            per_dt: Lanes::lit(1.0 / dt),
            split: substeps > 1,
            gain: Lanes::lit(2.0 * n / (n - 1.0).max(1.0)),
            kappa: Lanes::lit(shrunk / 12.0),
            mu: Lanes::lit(shrunk * (1.0 - 9.0 / n2) / 720.0),
            lambda: Lanes::lit(shrunk * (1.0 - 2.0 / (3.0 * n2)) / 240.0),
            cayley: Lanes::lit(1.0 / (12.0 * n2)),
        }
    }
}

/// What rapier's bodies have, and what they shall have.
pub(super) struct Target<'a> {
    pub pace: &'a Pace,
    /// Plate axes to world, now and at the end of the step.
    pub attitude: Quaternion<Lanes>,
    pub end_attitude: Quaternion<Lanes>,
    /// Velocities now.
    pub linear: V,
    pub angular: V,
    /// Velocities at the end of the step.
    pub end_linear: V,
    pub end_angular: V,
    /// Displacement of the center of mass over the step.
    pub displacement: V,
    /// 1 where the body is free, 0 where it touches something.
    pub free: Lanes,
}

/// What rapier's bodies are given before the step.
pub(super) struct Handover {
    /// Velocities to start from.
    pub start_linear: V,
    pub start_angular: V,
    /// Accelerations, linear (m/s²) and angular (rad/s²), that the force and the torque shall cause.
    pub push: V,
    pub twist: V,
}

/// Passes over the small terms of the series; each leaves about a hundredth of the error.
const REFINEMENTS: usize = 2;

impl Target<'_> {
    #[inline(always)]
    pub fn hand_over(&self) -> Handover {
        let pace = self.pace;
        // In contact: the whole change by the force.
        let push = self.end_linear - self.linear;
        let twist = self.end_angular - self.angular;
        let (free_push, free_twist) = if pace.split {
            let mean = self.displacement * pace.per_dt;
            let spin = self.mean_spin();
            (
                (self.end_linear - mean) * pace.gain,
                (self.end_angular - spin) * pace.gain,
            )
        } else {
            (push, twist)
        };
        let touching = Lanes::lit(0.5);
        let choose =
            |free: &V, touch: &V| free.zip_map(touch, |f, t| t.where_less(self.free, touching, f));
        Handover {
            start_linear: choose(&(self.end_linear - free_push), &self.linear),
            start_angular: choose(&(self.end_angular - free_twist), &self.angular),
            push: choose(&free_push, &push) * pace.per_dt,
            twist: choose(&free_twist, &twist) * pace.per_dt,
        }
    }

    /// The mean angular velocity with which rapier's substeps turn the body to `end_attitude`.
    #[inline(always)]
    fn mean_spin(&self) -> V {
        let pace = self.pace;
        let (one, two) = (Lanes::lit(1.0), Lanes::lit(2.0));
        let turn = product(&self.end_attitude, &conjugate(&self.attitude));
        let turn = rotation_vector(&turn);
        // τ = gain (ε − σ), so that κσ × τ is linear in σ: (1 + κ gain ε ×) σ = R + the rest.
        let end = self.end_angular * pace.dt;
        let skew = end * (pace.kappa * pace.gain);
        let per = one / (one + dot(&skew, &skew));
        let solve = |b: &V| (b - cross(&skew, b) + skew * dot(&skew, b)) * per;
        let mut mean = solve(&turn);
        for _ in 0..REFINEMENTS {
            let change = (end - mean) * pace.gain;
            let across = cross(&mean, &change);
            let mean2 = dot(&mean, &mean);
            let aligned = dot(&mean, &change);
            let small = across * (pace.mu * mean2) - cross(&across, &change) * pace.lambda
                + (mean * (mean2 + pace.kappa * dot(&change, &change))
                    + change * (two * pace.kappa * aligned))
                    * pace.cayley;
            // Beyond a radian or two the series means nothing.
            let within = dot(&small, &small) * Lanes::lit(16.0);
            let small = small.map(|x| x.where_less(within, mean2, Lanes::lit(0.0)));
            mean = solve(&(turn + small));
        }
        mean * pace.per_dt
    }
}

#[inline(always)]
fn conjugate(q: &Quaternion<Lanes>) -> Quaternion<Lanes> {
    Quaternion::new(q.w, -q.i, -q.j, -q.k)
}

/// Quaternion product, written out.
#[inline(always)]
fn product(p: &Quaternion<Lanes>, q: &Quaternion<Lanes>) -> Quaternion<Lanes> {
    Quaternion::new(
        p.w * q.w - p.i * q.i - p.j * q.j - p.k * q.k,
        p.w * q.i + p.i * q.w + p.j * q.k - p.k * q.j,
        p.w * q.j - p.i * q.k + p.j * q.w + p.k * q.i,
        p.w * q.k + p.i * q.j - p.j * q.i + p.k * q.w,
    )
}

#[inline(always)]
fn dot(a: &V, b: &V) -> Lanes {
    a.x * b.x + a.y * b.y + a.z * b.z
}

/// Rotation vector of a unit quaternion, the shorter way round: `4 atan(t)` along the axis, with
/// t = tan(θ/4) ≤ 1 and the arc tangent as its series, to 5e-5 for turns by two radians.
#[inline(always)]
fn rotation_vector(q: &Quaternion<Lanes>) -> V {
    let one = Lanes::lit(1.0);
    let sign = Lanes::lit(-1.0).where_less(q.w, Lanes::lit(0.0), one);
    let t = Vector3::new(q.i, q.j, q.k) * (sign / (one + q.w * sign));
    let t2 = dot(&t, &t);
    let mut series = Lanes::lit(-1.0 / 11.0);
    for term in [1.0 / 9.0, -1.0 / 7.0, 0.2, -1.0 / 3.0, 1.0] {
        series = series * t2 + Lanes::lit(term);
    }
    t * (series * Lanes::lit(4.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::integrate::rotate;
    use rapier3d::math::{Rotation, Vector};

    fn lanes(v: Vector) -> V {
        Vector3::new(v.x, v.y, v.z).map(|x| Lanes::lit(x.into()))
    }

    fn quaternion(q: Rotation) -> Quaternion<Lanes> {
        let [x, y, z, w] = q.to_array().map(|x| Lanes::lit(x.into()));
        Quaternion::new(w, x, y, z)
    }

    fn first(v: &V) -> Vector {
        Vector::from_array([v.x, v.y, v.z].map(|x| x.0.to_array()[0]))
    }

    /// Replays what rapier's solver does with the handover (velocity increment, then a Cayley
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
                pace: &Pace::new(dt, 4),
                attitude: quaternion(start),
                end_attitude: quaternion(end),
                linear: lanes(linear),
                angular: lanes(angular),
                end_linear: lanes(end_linear),
                end_angular: lanes(end_angular),
                displacement: lanes(moved),
                free: Lanes::lit(1.0),
            };
            let handover = target.hand_over();
            let (mut v, mut w) = (
                first(&handover.start_linear),
                first(&handover.start_angular),
            );
            let (mut x, mut q) = (Vector::ZERO, start);
            for _ in 0..4 {
                v += first(&handover.push) * (dt / 4.0);
                w += first(&handover.twist) * (dt / 4.0);
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

    /// Rotation vectors of small turns, whichever sign the quaternion has.
    #[test]
    fn rotation_vector_of_small_turns() {
        let v = Vector::new(0.02, -0.01, 0.03);
        for sign in [1.0, -1.0] {
            let q = Rotation::from_scaled_axis(v) * sign;
            assert!((first(&rotation_vector(&quaternion(q))) - v).length() < 1e-7);
        }
        let axis = rotate(&quaternion(Rotation::from_scaled_axis(v)), &lanes(v));
        assert!((first(&axis) - v).length() < 1e-7);
    }
}
