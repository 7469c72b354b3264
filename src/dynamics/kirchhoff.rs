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
    let o = v.x.lit(0.0);
    Matrix3::new(o, -v.z, v.y, v.z, o, -v.x, -v.y, v.x, o)
}

impl<T: Scalar> Twist<T> {
    /// Zero, of the kind that `scalar` is.
    #[inline(always)]
    pub fn zero(scalar: T) -> Self {
        let zero = Vector3::repeat(scalar.lit(0.0));
        Self {
            linear: zero,
            angular: zero,
        }
    }

    /// `self` in the lanes where `a < b`, `other` elsewhere.
    #[inline(always)]
    pub fn where_less(&self, a: T, b: T, other: &Self) -> Self {
        Self {
            linear: choose(&self.linear, a, b, &other.linear),
            angular: choose(&self.angular, a, b, &other.angular),
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

impl<T: Scalar> Blocks<T> {
    /// Product with a twist.
    #[inline(always)]
    pub fn apply(&self, v: &Twist<T>) -> Twist<T> {
        Twist {
            linear: transform(&self.m11, &v.linear) + transform(&self.m12, &v.angular),
            angular: transform(&self.m21, &v.linear) + transform(&self.m22, &v.angular),
        }
    }

    /// Solves `self · x = b` by block elimination. Both pivots are invertible because the
    /// symmetric part of the matrix is positive.
    #[inline(always)]
    pub fn solve(&self, b: &Twist<T>) -> Twist<T> {
        let inverse = inverse3(&self.m11);
        let through = product(&self.m21, &inverse);
        let pivot = inverse3(&(self.m22 - product(&through, &self.m12)));
        let angular = transform(&pivot, &(b.angular - transform(&through, &b.linear)));
        Twist {
            linear: transform(&inverse, &(b.linear - transform(&self.m12, &angular))),
            angular,
        }
    }
}

/// Inverse by the adjugate, written out: it is a fifth of the step.
#[inline(always)]
pub(super) fn inverse3<T: Scalar>(m: &Matrix3<T>) -> Matrix3<T> {
    let (a, b, c) = (m.m11, m.m12, m.m13);
    let (d, e, f) = (m.m21, m.m22, m.m23);
    let (g, h, i) = (m.m31, m.m32, m.m33);
    let (c11, c12, c13) = (e * i - f * h, f * g - d * i, d * h - e * g);
    let per = a.lit(1.0) / (a * c11 + b * c12 + c * c13);
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

/// Product, written out.
#[inline(always)]
fn product<T: Scalar>(p: &Matrix3<T>, q: &Matrix3<T>) -> Matrix3<T> {
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

/// Product with a vector, written out.
#[inline(always)]
pub(super) fn transform<T: Scalar>(m: &Matrix3<T>, v: &Vector3<T>) -> Vector3<T> {
    Vector3::new(
        m.m11 * v.x + m.m12 * v.y + m.m13 * v.z,
        m.m21 * v.x + m.m22 * v.y + m.m23 * v.z,
        m.m31 * v.x + m.m32 * v.y + m.m33 * v.z,
    )
}

/// Cross product, written out.
#[inline(always)]
pub(crate) fn cross<T: Scalar>(a: &Vector3<T>, b: &Vector3<T>) -> Vector3<T> {
    Vector3::new(
        a.y * b.z - a.z * b.y,
        a.z * b.x - a.x * b.z,
        a.x * b.y - a.y * b.x,
    )
}

/// `v` in the lanes where `a < b`, `other` elsewhere.
#[inline(always)]
pub(crate) fn choose<T: Scalar>(v: &Vector3<T>, a: T, b: T, other: &Vector3<T>) -> Vector3<T> {
    Vector3::new(
        v.x.where_less(a, b, other.x),
        v.y.where_less(a, b, other.y),
        v.z.where_less(a, b, other.z),
    )
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

    /// The increment Δν of one substep: `(𝕄 − θhN) Δν = h (N ν₀ + Q)` with N frozen at `middle`.
    ///
    /// `SYMMETRIC` says that 𝕄 is diagonal and the planform is centered on the center of mass, as for
    /// every uniform body with three planes of symmetry and every proxy ellipsoid of one; that path
    /// ([`symmetric`](super::symmetric)) costs a fraction.
    #[inline(always)]
    pub fn increment<const SYMMETRIC: bool>(
        &self,
        terms: &ViscousTerms<T>,
        start: &Twist<T>,
        middle: &Twist<T>,
        load: &Twist<T>,
        h: T,
        theta: T,
    ) -> Twist<T> {
        if SYMMETRIC && terms.arm_moves {
            return self.symmetric_increment(terms, start, middle, load, h, theta);
        }
        let scale = theta * h;
        let mass = self.mass_matrix();
        let n = self.coupling_matrix(&mass, terms, middle);
        let system = Blocks {
            m11: mass.m11 - n.m11 * scale,
            m12: mass.m12 - n.m12 * scale,
            m21: mass.m21 - n.m21 * scale,
            m22: mass.m22 - n.m22 * scale,
        };
        let right = n.apply(start);
        system.solve(&Twist {
            linear: (right.linear + load.linear) * h,
            angular: (right.angular + load.angular) * h,
        })
    }

    /// From the center of mass to the planform's center, in L.
    #[inline(always)]
    pub fn center(&self) -> Vector3<T> {
        Vector3::new(self.center_x, self.center_y, self.center_z)
    }

    /// Velocity of the planform's center.
    #[inline(always)]
    pub fn center_velocity(&self, v: &Twist<T>) -> Vector3<T> {
        v.linear + cross(&v.angular, &self.center())
    }

    /// N(ν): inertial coupling and viscous force as a matrix that acts on the velocity.
    ///
    /// `v` is the velocity at which it is frozen. The inertial part is skew-symmetric for any
    /// `v`; of the added mass' share in it only the fraction `munk` is kept.
    #[inline(always)]
    pub(super) fn coupling_matrix(
        &self,
        mass: &Blocks<T>,
        terms: &ViscousTerms<T>,
        v: &Twist<T>,
    ) -> Blocks<T> {
        // Of the body's own momentum m u, ω × is applied to u, so that no torque m u × u is left
        // where the frozen u and the new one differ; that of the fluid turns with both.
        let own = skew(&(v.angular * (self.dry_mass * self.per_length)));
        let p = transform(&mass.m11, &v.linear) - v.linear * self.dry_mass
            + transform(&mass.m12, &v.angular);
        let p = p * self.munk;
        let h = transform(&mass.m22, &v.angular) + transform(&mass.m21, &v.linear) * self.munk;
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
        let n12 = product(&g, &lever_v);
        let n21 = product(&lever_t, &g);
        let mut n22 = product(&n21, &lever_v) + h;
        for i in 0..3 {
            n22[(i, i)] -= terms.damping[i];
        }
        Blocks {
            m11: g - own,
            m12: n12 + p,
            m21: n21 + p,
            m22: n22,
        }
    }
}
