//! How the motion that the crate integrated is handed to rapier.
//!
//! Rapier's solver takes n substeps of h = dt/n. In each it first adds `F h/m_s` to the velocity and
//! then moves the body by the new velocity. A constant force that makes up the difference Δ of the
//! velocities therefore moves the body by `v₀ + Δ(n+1)/2n` on average, not by the mean velocity:
//! the velocity is right but the pose runs ahead by Δ·dt/2n.
//!
//! A **free** body gets both right: its velocity is first set to `v₁ − Δ'` with
//! `Δ' = (v₁ − v̄)·2n/(n−1)`, so that after the force both the last velocity v₁ and the mean velocity
//! v̄ are those that were integrated. The same holds for the rotation, where the product of rapier's
//! n small rotations (Cayley maps, about axes that turn, so that they do not commute) is matched by
//! trying; what is left, about 10⁻⁵ rad for a body that turns by a radian per step, is made up for in
//! the next step, because the attitude that the crate integrates is kept.
//!
//! A body in **contact** or held by a joint gets a force alone, since setting velocities would keep a
//! pile from coming to rest.

use crate::dynamics::kirchhoff::cross;
use crate::math::{Lanes, Scalar};
use rapier3d::na::{Quaternion, Vector3};

type V = Vector3<Lanes>;

/// What rapier's bodies have, and what they shall have.
pub(super) struct Target {
    /// Time step, s, and rapier's number of substeps.
    pub dt: f32,
    pub substeps: usize,
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

/// Corrections of the angular velocity: each leaves about a tenth of the error.
const TRIES: usize = 3;

impl Target {
    #[inline(always)]
    pub fn hand_over(&self) -> Handover {
        let per_dt = Lanes::lit(1.0) / Lanes::lit(self.dt.into());
        // In contact: the whole change by the force.
        let push = self.end_linear - self.linear;
        let twist = self.end_angular - self.angular;
        let n = self.substeps as f64;
        let (free_push, free_twist) = if self.substeps > 1 {
            let gain = Lanes::lit(2.0 * n / (n - 1.0));
            let mean = self.displacement * per_dt;
            let spin = self.mean_spin(gain, per_dt);
            (
                (self.end_linear - mean) * gain,
                (self.end_angular - spin) * gain,
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
            push: choose(&free_push, &push) * per_dt,
            twist: choose(&free_twist, &twist) * per_dt,
        }
    }

    /// The mean angular velocity with which rapier's substeps turn the body to `end_attitude`.
    #[inline(always)]
    fn mean_spin(&self, gain: Lanes, per_dt: Lanes) -> V {
        let turn = product(&self.end_attitude, &conjugate(&self.attitude));
        let mut spin = rotation_vector(&turn) * per_dt;
        let dt = Lanes::lit(self.dt.into());
        for _ in 0..TRIES {
            let twist = (self.end_angular - spin) * gain;
            let missing = product(&turn, &conjugate(&self.turned(&spin, &twist)));
            let missing = rotation_vector(&missing) * per_dt;
            // Inverse left Jacobian of the rotation: what to add to its vector so that the product
            // changes by `missing`.
            let angle = spin * dt;
            let across = cross(&angle, &missing);
            let twice = cross(&angle, &across);
            spin += missing - across * Lanes::lit(0.5) + twice * Lanes::lit(1.0 / 12.0);
        }
        spin
    }

    /// How rapier's substeps turn a body that reaches `end_angular` by a constant twist, with mean
    /// angular velocity `spin`.
    #[inline(always)]
    fn turned(&self, spin: &V, twist: &V) -> Quaternion<Lanes> {
        let n = self.substeps as f64;
        let half_step = Lanes::lit(0.5 * f64::from(self.dt) / n);
        let (one, zero) = (Lanes::lit(1.0), Lanes::lit(0.0));
        let mut turned = Quaternion::new(one, zero, zero, zero);
        for k in 1..=self.substeps {
            let share = Lanes::lit(k as f64 / n - (n + 1.0) / (2.0 * n));
            let a = (spin + twist * share) * half_step;
            turned = product(&Quaternion::new(one, a.x, a.y, a.z), &turned);
        }
        // Rapier normalises each factor; the product of the lengths is the length of the product.
        let norm2 =
            turned.w * turned.w + turned.i * turned.i + turned.j * turned.j + turned.k * turned.k;
        let per = one / norm2.root();
        Quaternion::new(
            turned.w * per,
            turned.i * per,
            turned.j * per,
            turned.k * per,
        )
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

/// Rotation vector of a unit quaternion, by the series of the arc sine: exact for small turns, and
/// for large ones a start that the tries improve.
#[inline(always)]
fn rotation_vector(q: &Quaternion<Lanes>) -> V {
    let a = Vector3::new(q.i, q.j, q.k);
    let sine2 = a.x * a.x + a.y * a.y + a.z * a.z;
    let series = Lanes::lit(2.0)
        + sine2
            * (Lanes::lit(1.0 / 3.0) + sine2 * (Lanes::lit(0.15) + sine2 * Lanes::lit(5.0 / 56.0)));
    // Of q and −q the shorter way round.
    let sign = Lanes::lit(-1.0).where_less(q.w, Lanes::lit(0.0), Lanes::lit(1.0));
    a * (series * sign)
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
                dt,
                substeps: 4,
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
