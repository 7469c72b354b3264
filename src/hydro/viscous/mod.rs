//! Viscous forces: drag, translational lift, rotational lift and damping.
//!
//! Three laws, one form. Whatever the law, its force on the body is
//!
//! ```text
//! f = −(c·1 + S) v + W × v        v = velocity of the pressure point relative to the fluid
//! ```
//!
//! a resistance (`c ≥ 0` from the pressure, `S ≥ 0` from creeping flow) plus a *turning* part that
//! does no work. The integrator evaluates `c`, `S`, `W` and the pressure point once per substep and
//! then solves for the velocity implicitly; because a resistance can only take energy and a
//! turning force none, that is stable at any step size, however wrong the frozen coefficients are.
//!
//! All of it happens in **plate axes**: x along the longest, z along the shortest principal axis of
//! the shape, origin at the body's center of mass.

pub mod physical;
pub(crate) mod scaled;
pub mod stochastic;
pub mod thesis;

pub use physical::PhysicalLaw;
pub use stochastic::StochasticLaw;
pub use thesis::ThesisLaw;

use crate::Error;
use crate::math::Scalar;
use rapier3d::na::{Matrix3, Vector3};

/// Which law gives the viscous force.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum ViscousLaw {
    /// No viscous force: an ideal fluid, in which the Kirchhoff equations conserve energy and
    /// impulse.
    Inviscid,
    /// The default: calibrated against experiments, passive, right at low Reynolds numbers.
    Physical(PhysicalLaw),
    /// Three components with coefficients that depend on the angle of attack (thesis § 5.3.2).
    Thesis(ThesisLaw),
    /// Constant drag and lift coefficients (thesis § 4.2.2).
    Stochastic(StochasticLaw),
}

impl Default for ViscousLaw {
    fn default() -> Self {
        Self::Physical(PhysicalLaw::default())
    }
}

impl ViscousLaw {
    /// Checks every coefficient.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] names the first that is not finite or has the wrong sign.
    pub fn check(&self) -> Result<(), Error> {
        match self {
            Self::Inviscid => Ok(()),
            Self::Physical(law) => law.check(),
            Self::Thesis(law) => law.check(),
            Self::Stochastic(law) => law.check(),
        }
    }

    /// How much of the inertial *coupling* of the added mass the law keeps, in [0, 1].
    pub(crate) fn munk_factor(&self) -> f64 {
        match self {
            Self::Physical(law) => law.munk,
            _ => 1.0,
        }
    }
}

/// The viscous force of one moment, ready for the implicit solve. Plate axes; everything per unit
/// of the body's mass scale, lengths in the body's length scale (see
/// [`BodyConstants`](crate::body)).
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
        let drag = scalar.lit(0.0);
        let zero = Vector3::repeat(drag);
        Self {
            drag,
            creeping: zero,
            translational_lift: zero,
            rotational_lift: zero,
            arm: zero,
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

/// A law whose per-body constants have been prepared.
pub(crate) trait Evaluate<T: Scalar> {
    /// Evaluations per substep that the law needs at least.
    fn least_iterations(&self) -> u32 {
        1
    }

    /// The terms at a velocity `u` of the planform's center and an angular velocity `w` (in units
    /// of speed: times the length scale), both relative to the fluid, in plate axes.
    fn terms(&self, u: &Vector3<T>, w: &Vector3<T>) -> ViscousTerms<T>;
}

/// `e / max(e, tiny)`-safe inverse: `1/x` with `x` kept away from zero.
#[inline(always)]
pub(crate) fn safe_inverse<T: Scalar>(x: T) -> T {
    x.lit(1.0) / x.larger(x.lit(1e-12))
}

/// Torque arm of the thesis' laws: `(1 − sin³α)·a/2` along the in-plane velocity (thesis, text
/// after (5.18): a quarter of the major axis in ideal flow), for the semi-axis `a`.
#[inline(always)]
pub(crate) fn thesis_arm<T: Scalar>(u: &Vector3<T>, semi_axis: T) -> Vector3<T> {
    let tangential = (u.x * u.x + u.y * u.y).root();
    let speed = (u.x * u.x + u.y * u.y + u.z * u.z).root();
    let sine = u.z.absolute() * safe_inverse(speed);
    let length = (sine.lit(1.0) - sine * sine * sine) * semi_axis * sine.lit(0.5);
    let per_speed = length * safe_inverse(tangential);
    Vector3::new(u.x * per_speed, u.y * per_speed, u.z.lit(0.0))
}
