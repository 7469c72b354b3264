//! Bodies whose velocity cannot change along some axes of the world.
//!
//! A lock is a constraint `Qν = q`: Q projects on the locked axes, q is the velocity that the body
//! has along them, which nothing changes. A substep of [`integrate`](super::integrate) acts on the
//! velocity `ν_θ = ν₀ + θΔν`; the constraint is put on just this velocity, at the attitude in the
//! middle:
//!
//! ```text
//! (𝕄 − θhN) Δν = h (Nν₀ + F) + λ,     Q(ν₀ + θΔν) = q,     Qλ = λ
//! ```
//!
//! With P = 1 − Q, S = 𝕄 − θhN, r = h(Nν₀ + F) and Δν = x + c, where `c = (q − Qν₀)/θ` lies in the
//! locked axes and x in the others, this is
//!
//! ```text
//! (P S P + Q) x = P (r − S c)
//! ```
//!
//! Where nothing moves along the locked axes (q = 0), the reaction λ is orthogonal to ν_θ, so that the
//! energy cannot grow for the same reason as that of a free body, whatever the step. A lock that is put
//! on Δν itself lets the energy grow by a few per cent in a step that turns the body far.

use crate::math::Scalar;
use crate::math::spatial::{Blocks, Twist, Wrench, product, rotate_back, select_lt, transform};
use rapier3d::na::{Matrix3, Quaternion, Vector3};

/// Which axes of the world are locked, and the velocity along them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Locks<T> {
    /// Whether some body is locked; if not, nothing else is looked at.
    pub any: bool,
    /// 1 for a locked axis of the world, 0 for a free one.
    pub linear: Vector3<T>,
    pub angular: Vector3<T>,
    /// Velocity along the locked axes, world axes, relative to the fluid; w = ωL.
    pub velocity: Twist<T>,
}

impl<T: Scalar> Locks<T> {
    /// No lock.
    #[inline(always)]
    pub fn none(scalar: T) -> Self {
        let zero = Twist::zero(scalar);
        Self {
            any: false,
            linear: zero.linear,
            angular: zero.angular,
            velocity: zero,
        }
    }

    /// The increment Δν under the locks, of the equation `system Δν = right`; `free` where a body has none.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    pub fn increment(
        &self,
        free: &Twist<T>,
        system: &Blocks<T>,
        right: &Wrench<T>,
        start: &Twist<T>,
        attitude: &Quaternion<T>,
        h: T,
        theta: T,
    ) -> Twist<T> {
        let (zero, one) = (h.constant(0.0), h.constant(1.0));
        let (q1, q2) = (
            projector(attitude, &self.linear),
            projector(attitude, &self.angular),
        );
        let unit = Matrix3::new(one, zero, zero, zero, one, zero, zero, zero, one);
        let (p1, p2) = (unit - q1, unit - q2);
        let per_theta = one / theta;
        let kept = |velocity: &Vector3<T>, q: &Matrix3<T>, start: &Vector3<T>| {
            (rotate_back(attitude, velocity) - transform(q, start)) * per_theta
        };
        let given = Twist {
            linear: kept(&self.velocity.linear, &q1, &start.linear),
            angular: kept(&self.velocity.angular, &q2, &start.angular),
        };
        let taken = system.apply(&given);
        let projected = Blocks {
            m11: product(&product(&p1, &system.m11), &p1) + q1,
            m12: product(&product(&p1, &system.m12), &p2),
            m21: product(&product(&p2, &system.m21), &p1),
            m22: product(&product(&p2, &system.m22), &p2) + q2,
        };
        let found = projected.solve(&Wrench {
            force: transform(&p1, &(right.force - taken.force)),
            torque: transform(&p2, &(right.torque - taken.torque)),
        });
        let (l, a) = (&self.linear, &self.angular);
        let locked = l.x + l.y + l.z + a.x + a.y + a.z;
        // A lane that stands still has h = 0 and keeps its velocity, whatever it is along a lock.
        let standing = zero.select_lt(zero, h, one);
        let limit = h.constant(0.5);
        let select = |free: &Vector3<T>, x: Vector3<T>, c: &Vector3<T>| {
            let held = select_lt(free, limit, standing, &(x + c));
            select_lt(free, locked, limit, &held)
        };
        Twist {
            linear: select(&free.linear, transform(&p1, &found.linear), &given.linear),
            angular: select(
                &free.angular,
                transform(&p2, &found.angular),
                &given.angular,
            ),
        }
    }
}

/// Projector, in body axes, on the axes of the world that are locked.
#[inline(always)]
fn projector<T: Scalar>(attitude: &Quaternion<T>, locked: &Vector3<T>) -> Matrix3<T> {
    let (zero, one) = (locked.x.constant(0.0), locked.x.constant(1.0));
    let x = rotate_back(attitude, &Vector3::new(one, zero, zero));
    let y = rotate_back(attitude, &Vector3::new(zero, one, zero));
    let z = rotate_back(attitude, &Vector3::new(zero, zero, one));
    let entry = |i: usize, j: usize| {
        x[i] * x[j] * locked.x + y[i] * y[j] * locked.y + z[i] * z[j] * locked.z
    };
    let (xy, xz, yz) = (entry(0, 1), entry(0, 2), entry(1, 2));
    Matrix3::new(
        entry(0, 0),
        xy,
        xz,
        xy,
        entry(1, 1),
        yz,
        xz,
        yz,
        entry(2, 2),
    )
}
