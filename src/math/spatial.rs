//! Vectors, rotations and the six-dimensional quantities of a rigid body, for every [`Scalar`].
//!
//! nalgebra's own products start from its zeros, which lanes cannot make without a value (see
//! [`scalar`](super::scalar)); they are therefore written out here.

use super::Scalar;
use rapier3d::na::{Matrix3, Quaternion, Vector3};

/// The velocity of a rigid body, or a change of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Twist<T> {
    pub linear: Vector3<T>,
    pub angular: Vector3<T>,
}

/// What acts on a rigid body, or its momentum: force and torque, impulse and its moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Wrench<T> {
    pub force: Vector3<T>,
    pub torque: Vector3<T>,
}

/// A 6×6 matrix in blocks that maps a twist to a wrench.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Blocks<T> {
    pub m11: Matrix3<T>,
    pub m12: Matrix3<T>,
    pub m21: Matrix3<T>,
    pub m22: Matrix3<T>,
}

impl<T: Scalar> Twist<T> {
    /// Zero, of the kind that `scalar` is.
    #[inline(always)]
    pub fn zero(scalar: T) -> Self {
        let zero = Vector3::repeat(scalar.constant(0.0));
        Self {
            linear: zero,
            angular: zero,
        }
    }

    /// `self` in the lanes where `a < b`, `other` elsewhere.
    #[inline(always)]
    pub fn select_lt(&self, a: T, b: T, other: &Self) -> Self {
        Self {
            linear: select_lt(&self.linear, a, b, &other.linear),
            angular: select_lt(&self.angular, a, b, &other.angular),
        }
    }

    /// `factor · self`
    #[inline(always)]
    pub fn scaled(&self, factor: T) -> Self {
        Self {
            linear: self.linear * factor,
            angular: self.angular * factor,
        }
    }

    /// `self + factor · other`
    #[inline(always)]
    pub fn add_scaled(&self, other: &Self, factor: T) -> Self {
        Self {
            linear: self.linear + other.linear * factor,
            angular: self.angular + other.angular * factor,
        }
    }
}

impl<T: Scalar> Wrench<T> {
    /// `factor · self`
    #[inline(always)]
    pub fn scaled(&self, factor: T) -> Self {
        Self {
            force: self.force * factor,
            torque: self.torque * factor,
        }
    }
}

impl<T: Scalar> std::ops::Add for Wrench<T> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            force: self.force + other.force,
            torque: self.torque + other.torque,
        }
    }
}

impl<T: Scalar> Blocks<T> {
    /// Zero, of the kind that `scalar` is.
    #[inline(always)]
    pub fn zero(scalar: T) -> Self {
        let nothing = Matrix3::repeat(scalar.constant(0.0));
        Self {
            m11: nothing,
            m12: nothing,
            m21: nothing,
            m22: nothing,
        }
    }

    /// Product with a twist.
    #[inline(always)]
    pub fn apply(&self, v: &Twist<T>) -> Wrench<T> {
        Wrench {
            force: transform(&self.m11, &v.linear) + transform(&self.m12, &v.angular),
            torque: transform(&self.m21, &v.linear) + transform(&self.m22, &v.angular),
        }
    }

    /// Adds another matrix.
    #[inline(always)]
    pub fn add(&mut self, other: &Self) {
        self.m11 += other.m11;
        self.m12 += other.m12;
        self.m21 += other.m21;
        self.m22 += other.m22;
    }

    /// `self − factor · other`
    #[inline(always)]
    pub fn less_scaled(&self, other: &Self, factor: T) -> Self {
        Self {
            m11: self.m11 - other.m11 * factor,
            m12: self.m12 - other.m12 * factor,
            m21: self.m21 - other.m21 * factor,
            m22: self.m22 - other.m22 * factor,
        }
    }

    /// Solves `self · x = b` by block elimination. Both pivots are invertible where the
    /// symmetric part of the matrix is positive.
    #[inline(always)]
    pub fn solve(&self, b: &Wrench<T>) -> Twist<T> {
        let inverse = inverse3(&self.m11);
        let through = product(&self.m21, &inverse);
        let pivot = inverse3(&(self.m22 - product(&through, &self.m12)));
        let angular = transform(&pivot, &(b.torque - transform(&through, &b.force)));
        Twist {
            linear: transform(&inverse, &(b.force - transform(&self.m12, &angular))),
            angular,
        }
    }
}

/// The matrix of these entries, by row and column.
#[inline(always)]
pub(crate) fn matrix<T: Scalar>(entry: impl Fn(usize, usize) -> T) -> Matrix3<T> {
    let e = entry;
    Matrix3::new(
        e(0, 0),
        e(0, 1),
        e(0, 2),
        e(1, 0),
        e(1, 1),
        e(1, 2),
        e(2, 0),
        e(2, 1),
        e(2, 2),
    )
}

/// `v ×` as a matrix.
#[inline(always)]
pub(crate) fn skew<T: Scalar>(v: &Vector3<T>) -> Matrix3<T> {
    let o = v.x.constant(0.0);
    Matrix3::new(o, -v.z, v.y, v.z, o, -v.x, -v.y, v.x, o)
}

/// Inverse by the adjugate.
#[inline(always)]
pub(crate) fn inverse3<T: Scalar>(m: &Matrix3<T>) -> Matrix3<T> {
    let (a, b, c) = (m.m11, m.m12, m.m13);
    let (d, e, f) = (m.m21, m.m22, m.m23);
    let (g, h, i) = (m.m31, m.m32, m.m33);
    let (c11, c12, c13) = (e * i - f * h, f * g - d * i, d * h - e * g);
    let per = a.constant(1.0) / (a * c11 + b * c12 + c * c13);
    Matrix3::new(
        c11 * per,
        (c * h - b * i) * per,
        (b * f - c * e) * per,
        c12 * per,
        (a * i - c * g) * per,
        (c * d - a * f) * per,
        c13 * per,
        (b * g - a * h) * per,
        (a * e - b * d) * per,
    )
}

/// Product of two matrices.
#[inline(always)]
pub(crate) fn product<T: Scalar>(p: &Matrix3<T>, q: &Matrix3<T>) -> Matrix3<T> {
    Matrix3::new(
        p.m11 * q.m11 + p.m12 * q.m21 + p.m13 * q.m31,
        p.m11 * q.m12 + p.m12 * q.m22 + p.m13 * q.m32,
        p.m11 * q.m13 + p.m12 * q.m23 + p.m13 * q.m33,
        p.m21 * q.m11 + p.m22 * q.m21 + p.m23 * q.m31,
        p.m21 * q.m12 + p.m22 * q.m22 + p.m23 * q.m32,
        p.m21 * q.m13 + p.m22 * q.m23 + p.m23 * q.m33,
        p.m31 * q.m11 + p.m32 * q.m21 + p.m33 * q.m31,
        p.m31 * q.m12 + p.m32 * q.m22 + p.m33 * q.m32,
        p.m31 * q.m13 + p.m32 * q.m23 + p.m33 * q.m33,
    )
}

/// Product of a matrix and a vector.
#[inline(always)]
pub(crate) fn transform<T: Scalar>(m: &Matrix3<T>, v: &Vector3<T>) -> Vector3<T> {
    Vector3::new(
        m.m11 * v.x + m.m12 * v.y + m.m13 * v.z,
        m.m21 * v.x + m.m22 * v.y + m.m23 * v.z,
        m.m31 * v.x + m.m32 * v.y + m.m33 * v.z,
    )
}

/// Cross product.
#[inline(always)]
pub(crate) fn cross<T: Scalar>(a: &Vector3<T>, b: &Vector3<T>) -> Vector3<T> {
    Vector3::new(
        a.y * b.z - a.z * b.y,
        a.z * b.x - a.x * b.z,
        a.x * b.y - a.y * b.x,
    )
}

/// Scalar product.
#[inline(always)]
pub(crate) fn dot<T: Scalar>(a: &Vector3<T>, b: &Vector3<T>) -> T {
    a.x * b.x + a.y * b.y + a.z * b.z
}

/// Length of a vector.
#[inline(always)]
pub(crate) fn norm<T: Scalar>(v: &Vector3<T>) -> T {
    dot(v, v).sqrt()
}

/// `v` in the lanes where `a < b`, `other` elsewhere.
#[inline(always)]
pub(crate) fn select_lt<T: Scalar>(v: &Vector3<T>, a: T, b: T, other: &Vector3<T>) -> Vector3<T> {
    Vector3::new(
        v.x.select_lt(a, b, other.x),
        v.y.select_lt(a, b, other.y),
        v.z.select_lt(a, b, other.z),
    )
}

/// `q` in the lanes where `a < b`, `other` elsewhere.
#[inline(always)]
pub(crate) fn select_quaternion_lt<T: Scalar>(
    q: &Quaternion<T>,
    a: T,
    b: T,
    other: &Quaternion<T>,
) -> Quaternion<T> {
    let (q, other) = (&q.coords, &other.coords);
    let axis = select_lt(&q.xyz(), a, b, &other.xyz());
    Quaternion::new(q.w.select_lt(a, b, other.w), axis.x, axis.y, axis.z)
}

/// Product of two quaternions.
#[inline(always)]
pub(crate) fn quaternion_product<T: Scalar>(p: &Quaternion<T>, q: &Quaternion<T>) -> Quaternion<T> {
    let (p, q) = (&p.coords, &q.coords);
    Quaternion::new(
        p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z,
        p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y,
        p.w * q.y - p.x * q.z + p.y * q.w + p.z * q.x,
        p.w * q.z + p.x * q.y - p.y * q.x + p.z * q.w,
    )
}

/// `q*`
#[inline(always)]
pub(crate) fn conjugate<T: Scalar>(q: &Quaternion<T>) -> Quaternion<T> {
    let q = &q.coords;
    Quaternion::new(q.w, -q.x, -q.y, -q.z)
}

/// `q v q*` for a unit quaternion.
#[inline(always)]
pub(crate) fn rotate<T: Scalar>(q: &Quaternion<T>, v: &Vector3<T>) -> Vector3<T> {
    let a = q.coords.xyz();
    let t = cross(&a, v);
    let t = t + t;
    v + t * q.coords.w + cross(&a, &t)
}

/// `q* v q` for a unit quaternion.
#[inline(always)]
pub(crate) fn rotate_back<T: Scalar>(q: &Quaternion<T>, v: &Vector3<T>) -> Vector3<T> {
    rotate(&conjugate(q), v)
}

/// `q · cay(2a)`: the attitude turned by the body-axes rotation whose half tangent is `a`. Its norm is
/// that of `q`.
#[inline(always)]
pub(crate) fn turned<T: Scalar>(q: &Quaternion<T>, a: &Vector3<T>) -> Quaternion<T> {
    let (q, x, y, z) = (&q.coords, a.x, a.y, a.z);
    let one = x.constant(1.0);
    let per = one / (one + dot(a, a)).sqrt();
    Quaternion::new(
        (q.w - q.x * x - q.y * y - q.z * z) * per,
        (q.x + q.w * x + q.y * z - q.z * y) * per,
        (q.y + q.w * y + q.z * x - q.x * z) * per,
        (q.z + q.w * z + q.x * y - q.y * x) * per,
    )
}

/// The quaternion of norm 1 along `q`.
#[inline(always)]
pub(crate) fn normalized<T: Scalar>(q: &Quaternion<T>) -> Quaternion<T> {
    let q = q.coords;
    let norm = (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z).sqrt();
    Quaternion::from_vector(q * (norm.constant(1.0) / norm))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rapier3d::na::{Matrix6, UnitQuaternion, Vector6};

    /// The rotations that are written out here against nalgebra's.
    #[test]
    fn rotations_agree_with_nalgebra() {
        let q = UnitQuaternion::from_euler_angles(0.3, -1.0, 2.0);
        let raw = *q.quaternion();
        let v = Vector3::new(1.0, -2.0, 0.5);
        assert!((rotate(&raw, &v) - q * v).norm() < 1e-14);
        assert!((rotate_back(&raw, &v) - q.inverse() * v).norm() < 1e-14);
        let small = Vector3::new(0.01, -0.02, 0.03);
        let cayley = q * UnitQuaternion::from_quaternion(Quaternion::new(1.0, 0.01, -0.02, 0.03));
        let turned = UnitQuaternion::new_unchecked(turned(&raw, &small));
        assert!(turned.angle_to(&cayley) < 1e-7);
        let other = Quaternion::new(0.2, -0.5, 0.1, 0.7);
        assert!((quaternion_product(&raw, &other) - raw * other).norm() < 1e-15);
    }

    /// Block elimination against nalgebra's decomposition of the whole matrix, whose diagonal blocks
    /// are positive and whose off-diagonal ones are arbitrary.
    #[test]
    fn blocks_solve_what_they_multiply() {
        let block = |seed: f64| Matrix3::from_fn(|i, j| (seed + (3 * i + j) as f64).sin());
        let definite = |seed: f64| {
            let m = block(seed);
            m * m.transpose() + Matrix3::identity()
        };
        let (m12, m21) = (block(2.0), -block(2.0).transpose());
        let blocks = Blocks {
            m11: definite(1.0),
            m12,
            m21,
            m22: definite(3.0),
        };
        let mut whole = Matrix6::zeros();
        whole.fixed_view_mut::<3, 3>(0, 0).copy_from(&blocks.m11);
        whole.fixed_view_mut::<3, 3>(0, 3).copy_from(&m12);
        whole.fixed_view_mut::<3, 3>(3, 0).copy_from(&m21);
        whole.fixed_view_mut::<3, 3>(3, 3).copy_from(&blocks.m22);
        let b = Vector6::new(1.0, -2.0, 0.3, 0.7, 1.9, -0.4);
        let exact = whole.lu().solve(&b).unwrap();
        let found = blocks.solve(&Wrench {
            force: b.fixed_rows::<3>(0).into_owned(),
            torque: b.fixed_rows::<3>(3).into_owned(),
        });
        assert!((found.linear - exact.fixed_rows::<3>(0)).norm() < 1e-14);
        assert!((found.angular - exact.fixed_rows::<3>(3)).norm() < 1e-14);
        let back = blocks.apply(&found);
        assert!((back.force - b.fixed_rows::<3>(0)).norm() < 1e-14);
        assert!((back.torque - b.fixed_rows::<3>(3)).norm() < 1e-14);
    }
}
