//! The form that every law's force has, and how a law is asked for it.

use crate::math::Scalar;
use rapier3d::na::{Matrix3, Vector3};

/// The viscous force of one moment, ready for the implicit solve. Plate axes; everything per unit
/// of the body's mass scale, lengths in the body's length scale (see
/// [`BodyConstants`](crate::dynamics::constants::BodyConstants)).
#[derive(Clone, Copy, Debug)]
pub(crate) struct ViscousTerms<T> {
    /// c, 1/s: resistance against the velocity of the pressure point.
    pub drag: T,
    /// Diagonal of S, 1/s.
    pub creeping: Vector3<T>,
    /// W of the translational lift, 1/s.
    pub translational_lift: Vector3<T>,
    /// W of the rotational lift, 1/s.
    pub rotational_lift: Vector3<T>,
    /// From the pressure point to the planform's center: z is 0.
    pub arm: Vector3<T>,
    /// From the planform's center to the point that the whole force acts on and whose velocity it
    /// resists, if that is not the center: a lever like that to the center itself.
    pub offset: Vector3<T>,
    /// Whether the pressure point's own velocity, due to `arm`, enters v. Such a law is passive;
    /// without it the torque of the pressure can pump energy.
    pub arm_moves: bool,
    /// Diagonal of the rotational resistance, 1/s.
    pub damping: Vector3<T>,
}

impl<T: Scalar> ViscousTerms<T> {
    /// No force at all, in the kind of numbers that `scalar` is of.
    #[inline(always)]
    pub fn none(scalar: T) -> Self {
        let drag = scalar.constant(0.0);
        let zero = Vector3::repeat(drag);
        Self {
            drag,
            creeping: zero,
            translational_lift: zero,
            rotational_lift: zero,
            arm: zero,
            offset: zero,
            arm_moves: true,
            damping: zero,
        }
    }

    /// The matrix `−(c·1 + S) + W×` that maps v to the force.
    #[inline(always)]
    pub fn force_matrix(&self) -> Matrix3<T> {
        let w = self.translational_lift + self.rotational_lift;
        let d = self.creeping.map(|s| -(self.drag + s));
        Matrix3::new(d.x, -w.z, w.y, w.z, d.y, -w.x, -w.y, w.x, d.z)
    }
}

/// A law whose constants for one body have been prepared.
pub(crate) trait Evaluate<T: Scalar> {
    /// Evaluations per substep that the law needs at least.
    fn least_iterations(&self) -> u32 {
        1
    }

    /// The terms at a velocity `u` of the planform's center and an angular velocity `w` (in units
    /// of speed: times the length scale), both relative to the fluid, in plate axes.
    fn terms(&self, u: &Vector3<T>, w: &Vector3<T>) -> ViscousTerms<T>;
}

/// `1/x`, where x ≥ 0 is kept away from zero by 10⁻¹².
#[inline(always)]
pub(crate) fn safe_inverse<T: Scalar>(x: T) -> T {
    x.constant(1.0) / x.max(x.constant(1e-12))
}
