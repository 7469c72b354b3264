//! The generalised Kirchhoff equations as pure functions, in plate axes about the center of mass.
//!
//! ```text
//! p = 𝕄₁₁ u + 𝕄₁₂ ω            ṗ = p × ω + F
//! h = 𝕄₁₂ᵀ u + 𝕄₂₂ ω           ḣ = h × ω + p × u + T
//! ```
//!
//! (Kirchhoff 1870; Lamb, chapter VI. Thesis (4.4) prints v × (Mω) for ω × (Mv), wrong even for a
//! sphere.) With the viscous force in the form of [`viscous`](crate::hydro::viscous) the right-hand
//! side is `N(ν) ν + Q`, ν = (u, ω), where the symmetric part of N is never positive: that is what
//! the integrator builds on.
//!
//! Angular velocity is carried as `w = ωL`, see [`InertiaConstants`].

use super::constants::InertiaConstants;
use crate::hydro::viscous::terms::ViscousTerms;
use crate::math::Scalar;
use crate::math::spatial::{Blocks, Twist, Wrench, cross, product, skew, transform};
use rapier3d::na::Vector3;

impl<T: Scalar> InertiaConstants<T> {
    /// 𝕄.
    #[inline(always)]
    pub fn mass_matrix(&self) -> Blocks<T> {
        Blocks {
            m11: self.m11,
            m12: self.m12,
            m21: self.m12.transpose(),
            m22: self.m22,
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
        load: &Wrench<T>,
        h: T,
        theta: T,
    ) -> Twist<T> {
        if SYMMETRIC && terms.arm_moves {
            return self.symmetric_increment(terms, start, middle, load, h, theta);
        }
        let mass = self.mass_matrix();
        let n = self.coupling_matrix(&mass, terms, middle);
        let system = mass.less_scaled(&n, theta * h);
        let right = n.apply(start);
        system.solve(&(right + *load).scaled(h))
    }

    /// Velocity of the planform's center.
    #[inline(always)]
    pub fn center_velocity(&self, v: &Twist<T>) -> Vector3<T> {
        v.linear + cross(&v.angular, &self.center)
    }

    /// N(ν): inertial coupling and viscous force as a matrix that acts on the velocity.
    ///
    /// `v` is the velocity at which it is frozen. The inertial part is skew-symmetric for any
    /// `v`; of the added mass's share in it only the fraction `munk` is kept, but all of the part that is
    /// the same in all directions.
    #[inline(always)]
    pub(super) fn coupling_matrix(
        &self,
        mass: &Blocks<T>,
        terms: &ViscousTerms<T>,
        v: &Twist<T>,
    ) -> Blocks<T> {
        // Of the body's own momentum m u, ω × is applied to u, so that no torque m u × u is left
        // where the frozen u and the new one differ; that of the fluid turns with both, but for the part of
        // it that is the same in all directions, which is like a mass of the body's own at its middle.
        let (isotropic, arm) = (self.isotropic, &self.volume_center);
        let own = skew(&(v.angular * ((self.dry_mass + isotropic) * self.per_length)));
        let middle = skew(arm);
        let turning = skew(&(v.angular * (isotropic * self.per_length)));
        let own12 = product(&turning, &middle);
        let own22 = product(&middle, &own12);
        let p = transform(&mass.m11, &v.linear) - v.linear * (self.dry_mass + isotropic)
            + transform(&mass.m12, &v.angular)
            - cross(&v.angular, arm) * isotropic;
        let p = p * self.munk;
        let h = transform(&mass.m22, &v.angular)
            + cross(arm, &cross(arm, &v.angular)) * isotropic
            + (transform(&mass.m21, &v.linear) - cross(arm, &v.linear) * isotropic) * self.munk;
        let p = skew(&(p * self.per_length));
        let h = skew(&(h * self.per_length));

        let g = terms.force_matrix();
        let lever = skew(&(self.center + terms.offset));
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
        let mut n22 = product(&n21, &lever_v) + h + own22;
        for i in 0..3 {
            n22[(i, i)] -= terms.damping[i];
        }
        Blocks {
            m11: g - own,
            m12: n12 + p + own12,
            m21: n21 + p - own12.transpose(),
            m22: n22,
        }
    }
}
