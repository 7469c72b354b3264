//! Where a part is, and what the matrix of its force becomes about the body's center of mass.

use crate::math::spatial::{Blocks, Twist, cross, product, skew, transform};
use crate::math::{Scalar, scalar_struct};
use rapier3d::na::{Matrix3, Vector3};

scalar_struct! {
    /// A part's place in a body: body's plate axes, lengths in units of the body's length scale L.
    pub(crate) struct PartPlace<T> {
        /// From the body's center of mass to the part's planform center.
        position: Vector3<T>,
        /// Maps the part's own plate axes to the body's.
        turn: Matrix3<T>,
    }
}

scalar_struct! {
    /// The line that a part turns about.
    pub(crate) struct HingePlace<T> {
        /// From the body's center of mass to a point of it.
        point: Vector3<T>,
        /// Its direction, of length 1.
        axis: Vector3<T>,
    }
}

scalar_struct! {
    /// The added mass whose coupling to the body's motion is felt: that of each part times the share that its law
    /// keeps. Plate axes about the center of mass.
    pub(crate) struct CoupledMass<T> {
        m11: Matrix3<T>,
        m12: Matrix3<T>,
        /// What of the added mass is the same in all directions, and its first and second moment about the center of
        /// mass.
        isotropic: T,
        first: Vector3<T>,
        second: Matrix3<T>,
    }
}

impl CoupledMass<f64> {
    /// The same at another place, `by` away.
    pub fn moved(&self, by: &Vector3<f64>) -> Self {
        let crossed = self.first * by.transpose();
        let moved = by * by.transpose() * self.isotropic;
        Self {
            m11: self.m11,
            m12: self.m12 - product(&self.m11, &skew(by)),
            isotropic: self.isotropic,
            first: self.first + by * self.isotropic,
            second: self.second + crossed + crossed.transpose() + moved,
        }
    }
}

impl<T: Scalar> HingePlace<T> {
    /// A part's place when it is turned about the hinge by an angle of this sine and cosine.
    #[inline(always)]
    pub fn turned(&self, place: &PartPlace<T>, sine: T, cosine: T) -> PartPlace<T> {
        // Rodrigues's formula.
        let rest = sine.constant(1.0) - cosine;
        let a = &self.axis;
        let rotate = |v: &Vector3<T>| {
            v * cosine + cross(a, v) * sine + a * ((a.x * v.x + a.y * v.y + a.z * v.z) * rest)
        };
        let column = |i: usize| {
            rotate(&Vector3::new(
                place.turn[(0, i)],
                place.turn[(1, i)],
                place.turn[(2, i)],
            ))
        };
        let (x, y, z) = (column(0), column(1), column(2));
        PartPlace {
            position: self.point + rotate(&(place.position - self.point)),
            turn: Matrix3::new(x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z),
        }
    }
}

impl<T: Scalar> PartPlace<T> {
    /// From the part's own axes to the body's.
    #[inline(always)]
    pub fn out(&self, v: &Vector3<T>) -> Vector3<T> {
        transform(&self.turn, v)
    }

    /// From the body's axes to the part's own.
    #[inline(always)]
    pub fn back(&self, v: &Vector3<T>) -> Vector3<T> {
        let m = &self.turn;
        Vector3::new(
            m.m11 * v.x + m.m21 * v.y + m.m31 * v.z,
            m.m12 * v.x + m.m22 * v.y + m.m32 * v.z,
            m.m13 * v.x + m.m23 * v.y + m.m33 * v.z,
        )
    }

    /// A matrix from the part's own axes in the body's.
    #[inline(always)]
    pub fn matrix_out(&self, m: &Matrix3<T>) -> Matrix3<T> {
        product(&product(&self.turn, m), &self.turn.transpose())
    }

    /// A diagonal one.
    #[inline(always)]
    pub fn diagonal_out(&self, d: &Vector3<T>) -> Matrix3<T> {
        let r = &self.turn;
        let entry = |i: usize, j: usize| {
            r[(i, 0)] * r[(j, 0)] * d.x + r[(i, 1)] * r[(j, 1)] * d.y + r[(i, 2)] * r[(j, 2)] * d.z
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
}

/// The matrix of a force `G v` on the velocity of a point at `arm` from the body's center of mass, about
/// that: a congruence, so that a resistance stays one.
#[inline(always)]
pub(super) fn at<T: Scalar>(g: &Matrix3<T>, arm: &Vector3<T>) -> Blocks<T> {
    through(g, &-skew(arm))
}

/// The same for a velocity `u + Λ w`.
#[inline(always)]
pub(super) fn through<T: Scalar>(g: &Matrix3<T>, lever: &Matrix3<T>) -> Blocks<T> {
    let back = product(&lever.transpose(), g);
    Blocks {
        m11: *g,
        m12: product(g, lever),
        m21: back,
        m22: product(&back, lever),
    }
}

/// A matrix about a point at `arm` from the body's center of mass, about that.
#[inline(always)]
pub(super) fn moved<T: Scalar>(n: &Blocks<T>, arm: &Vector3<T>) -> Blocks<T> {
    let r = skew(arm);
    let (m11r, rm11) = (product(&n.m11, &r), product(&r, &n.m11));
    Blocks {
        m11: n.m11,
        m12: n.m12 - m11r,
        m21: n.m21 + rm11,
        m22: n.m22 + product(&r, &n.m12) - product(&n.m21, &r) - product(&r, &m11r),
    }
}

/// Velocity of a point at `arm` from the body's center of mass.
#[inline(always)]
pub(super) fn velocity_at<T: Scalar>(v: &Twist<T>, arm: &Vector3<T>) -> Vector3<T> {
    v.linear + cross(&v.angular, arm)
}
