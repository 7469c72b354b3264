//! The stochastic method's law: constant drag and lift coefficients (thesis § 4.2.2).

use super::{Evaluate, ViscousTerms, safe_inverse, thesis_arm};
use crate::Error;
use crate::fluid::Fluid;
use crate::hydro::HydroProperties;
use crate::math::{Scalar, scalar_struct};
use rapier3d::na::Vector3;

/// `F = −½ρA|U| (C_d U + C_l U × (N × U)/|N × U|)` with N the plate normal on the windward side
/// (N·U > 0), applied at the center of pressure (thesis (4.7)); made for use together with the
/// turbulence of chapter 4.
///
/// The thesis gives no numbers and no center of pressure: the defaults are ours, and the arm is the
/// one of its chapter 5, `(1 − sin³α)·a/2`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct StochasticLaw {
    /// C_d, constant over the angle of attack.
    pub drag: f64,
    /// C_l, constant over the angle of attack.
    pub lift: f64,
    /// Center of pressure over that of chapter 5; 0 puts the force at the planform's center.
    pub arm: f64,
}

impl Default for StochasticLaw {
    /// The broadside drag of a disc, and a moderate lift on a quarter of chapter 5's arm.
    fn default() -> Self {
        Self {
            drag: 1.17,
            lift: 0.6,
            arm: 0.25,
        }
    }
}

impl StochasticLaw {
    /// Checks every coefficient.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a coefficient is not finite or the drag is negative.
    pub fn check(&self) -> Result<(), Error> {
        Error::check_range("drag", self.drag, 0.0, f64::MAX)?;
        Error::check_range("lift", self.lift, f64::MIN, f64::MAX)?;
        Error::check_range("arm", self.arm, f64::MIN, f64::MAX)?;
        Ok(())
    }

    pub(crate) fn prepare(
        &self,
        hydro: &HydroProperties,
        fluid: &Fluid,
        mass: f64,
        length: f64,
    ) -> StochasticConstants<f64> {
        let rho = f64::from(fluid.density());
        StochasticConstants {
            dynamic_area: 0.5 * rho * hydro.planform.area / mass,
            drag: self.drag,
            lift: self.lift,
            arm: self.arm * hydro.planform.half_extents.x / length,
        }
    }
}

scalar_struct! {
    /// What [`StochasticLaw`] needs of one body in one fluid; units as in
    /// [`PhysicalConstants`](super::physical).
    pub(crate) struct StochasticConstants {
        dynamic_area,
        drag,
        lift,
        arm,
    }
}

impl<T: Scalar> Evaluate<T> for StochasticConstants<T> {
    #[inline(always)]
    fn terms(&self, u: &Vector3<T>, _w: &Vector3<T>) -> ViscousTerms<T> {
        let tangential = (u.x * u.x + u.y * u.y).root();
        let speed = (u.x * u.x + u.y * u.y + u.z * u.z).root();
        let pressure = self.dynamic_area * speed;
        // −U × (N × U) = (N × U) × U, and |N × U| is the tangential speed. N is ±z; the sign of
        // u_z passes smoothly through zero.
        let windward = u.z * safe_inverse(u.z.absolute() + speed.lit(1e-3) * speed);
        let turn = pressure * self.lift * windward * safe_inverse(tangential);
        ViscousTerms {
            drag: pressure * self.drag,
            translational_lift: Vector3::new(-u.y * turn, u.x * turn, speed.lit(0.0)),
            arm: thesis_arm(u, self.arm),
            arm_moves: false,
            ..ViscousTerms::none(speed)
        }
    }
}
