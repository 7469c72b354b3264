//! The generalised Kirchhoff equations as pure functions, in plate axes about the center of mass.
//!
//! ```text
//! p = 𝕄₁₁ u + 𝕄₁₂ ω            ṗ = p × ω + F
//! h = 𝕄₁₂ᵀ u + 𝕄₂₂ ω           ḣ = h × ω + p × u + T
//! ```
//!
//! (Kirchhoff 1870; Lamb § 124. Thesis (4.4) prints v × (Mω) for ω × (Mv), wrong even for a
//! sphere.) With the viscous force in the form of [`viscous`](crate::hydro::viscous) the right-hand
//! side is `N(ν) ν + Q`, ν = (u, ω), where the symmetric part of N is never positive: that is what
//! the integrator builds on.
//!
//! Angular velocity is carried as `w = ωL`, see [`InertiaConstants`].

use crate::body::InertiaConstants;
use crate::hydro::viscous::ViscousTerms;
use crate::math::Scalar;
use rapier3d::na::{Matrix3, Vector3};

/// A velocity, a momentum or a force, linear and angular part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Twist<T> {
    pub linear: Vector3<T>,
    pub angular: Vector3<T>,
}

/// A 6×6 matrix in blocks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Blocks<T> {
    pub m11: Matrix3<T>,
    pub m12: Matrix3<T>,
    pub m21: Matrix3<T>,
    pub m22: Matrix3<T>,
}

/// `v ×` as a matrix.
#[inline(always)]
pub(crate) fn skew<T: Scalar>(v: &Vector3<T>) -> Matrix3<T> {
    let o = T::zero();
    Matrix3::new(o, -v.z, v.y, v.z, o, -v.x, -v.y, v.x, o)
}

impl<T: Scalar> Twist<T> {
    #[inline(always)]
    pub fn zero() -> Self {
        Self {
            linear: Vector3::repeat(T::zero()),
            angular: Vector3::repeat(T::zero()),
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

impl<T: Scalar> Blocks<T> {
    /// Product with a twist.
    #[inline(always)]
    pub fn apply(&self, v: &Twist<T>) -> Twist<T> {
        Twist {
            linear: self.m11 * v.linear + self.m12 * v.angular,
            angular: self.m21 * v.linear + self.m22 * v.angular,
        }
    }

    /// Solves `self · x = b` by block elimination. Both pivots are invertible because the
    /// symmetric part of the matrix is positive.
    #[inline(always)]
    pub fn solve(&self, b: &Twist<T>) -> Twist<T> {
        let inverse = inverse3(&self.m11);
        let through = self.m21 * inverse;
        let pivot = inverse3(&(self.m22 - through * self.m12));
        let angular = pivot * (b.angular - through * b.linear);
        Twist {
            linear: inverse * (b.linear - self.m12 * angular),
            angular,
        }
    }
}

/// Inverse by the adjugate.
#[inline(always)]
fn inverse3<T: Scalar>(m: &Matrix3<T>) -> Matrix3<T> {
    let (a, b, c) = (m.column(0), m.column(1), m.column(2));
    let cross = |p: usize, q: usize| {
        let (p, q) = (m.column(p), m.column(q));
        Vector3::new(
            p[1] * q[2] - p[2] * q[1],
            p[2] * q[0] - p[0] * q[2],
            p[0] * q[1] - p[1] * q[0],
        )
    };
    let (bc, ca, ab) = (cross(1, 2), cross(2, 0), cross(0, 1));
    let determinant = a[0] * bc.x + a[1] * bc.y + a[2] * bc.z;
    debug_assert_eq!((b.len(), c.len()), (3, 3));
    let per = T::one() / determinant;
    Matrix3::new(bc.x, bc.y, bc.z, ca.x, ca.y, ca.z, ab.x, ab.y, ab.z) * per
}

impl<T: Scalar> InertiaConstants<T> {
    /// 𝕄.
    #[inline(always)]
    pub fn mass_matrix(&self) -> Blocks<T> {
        let m12 = Matrix3::new(
            self.m12_xx,
            self.m12_xy,
            self.m12_xz,
            self.m12_yx,
            self.m12_yy,
            self.m12_yz,
            self.m12_zx,
            self.m12_zy,
            self.m12_zz,
        );
        Blocks {
            m11: Matrix3::new(
                self.m11_xx,
                self.m11_xy,
                self.m11_xz,
                self.m11_xy,
                self.m11_yy,
                self.m11_yz,
                self.m11_xz,
                self.m11_yz,
                self.m11_zz,
            ),
            m12,
            m21: m12.transpose(),
            m22: Matrix3::new(
                self.m22_xx,
                self.m22_xy,
                self.m22_xz,
                self.m22_xy,
                self.m22_yy,
                self.m22_yz,
                self.m22_xz,
                self.m22_yz,
                self.m22_zz,
            ),
        }
    }

    /// From the center of mass to the planform's center, in L.
    #[inline(always)]
    pub fn center(&self) -> Vector3<T> {
        Vector3::new(self.center_x, self.center_y, self.center_z)
    }

    /// Velocity of the planform's center.
    #[inline(always)]
    pub fn center_velocity(&self, v: &Twist<T>) -> Vector3<T> {
        v.linear + v.angular.cross(&self.center())
    }

    /// N(ν): inertial coupling and viscous force as a matrix that acts on the velocity.
    ///
    /// `v` is the velocity at which it is frozen. The inertial part is skew-symmetric for any
    /// `v`; of the added mass' share in it only the fraction `munk` is kept.
    #[inline(always)]
    pub fn coupling_matrix(
        &self,
        mass: &Blocks<T>,
        terms: &ViscousTerms<T>,
        v: &Twist<T>,
    ) -> Blocks<T> {
        let p = mass.m11 * v.linear + mass.m12 * v.angular;
        let p = p * self.munk + v.linear * (self.dry_mass * (T::one() - self.munk));
        let h = mass.m22 * v.angular + (mass.m21 * v.linear) * self.munk;
        let p = skew(&(p * self.per_length));
        let h = skew(&(h * self.per_length));

        let g = terms.force_matrix();
        let lever = skew(&self.center());
        let arm = skew(&terms.arm);
        // v_pressure = u + lever_v·w, torque = lever_t·f
        let (lever_v, lever_t) = if terms.arm_moves {
            // Only the rotation about in-plane axes moves the pressure point, and only the in-plane
            // torque of the arm is felt: one is the transpose of the other.
            let mut moved = -lever;
            moved[(2, 0)] += terms.arm.y;
            moved[(2, 1)] -= terms.arm.x;
            (moved, moved.transpose())
        } else {
            (-lever, lever + arm)
        };
        let n12 = g * lever_v;
        let n21 = lever_t * g;
        let mut n22 = n21 * lever_v + h;
        for i in 0..3 {
            n22[(i, i)] -= terms.damping[i];
        }
        Blocks {
            m11: g,
            m12: n12 + p,
            m21: n21 + p,
            m22: n22,
        }
    }
}
