//! The stochastic method's law: constant drag and lift coefficients (thesis § 4.2.2).

use super::coefficients::{Bounds, Coefficient, coefficients};
use super::terms::{Evaluate, ViscousTerms, safe_inverse};
use super::thesis::pressure_arm;
use crate::fluid::Fluid;
use crate::hydro::HydroProperties;
use crate::math::spatial::norm;
use crate::math::{Scalar, scalar_struct};
use rapier3d::na::Vector3;

coefficients! {
    /// `F = −½ρA|U| (C_d U + C_l U × (N × U)/|N × U|)`, applied at the center of pressure (thesis (4.7));
    /// made for use together with the turbulence of chapter 4.
    ///
    /// The thesis does not say what N is, and gives no numbers and no center of pressure. Ours are N, the
    /// plate normal on the windward side (N·U > 0), and the defaults (the broadside drag of a disc, and a
    /// moderate lift on a quarter of chapter 5's arm); the arm is the one of its chapter 5,
    /// `(1 − sin³α)·a/2` with a the major semi-axis.
    pub struct StochasticLaw {
        /// C_d, constant over the angle of attack.
        drag: 1.17, NotNegative;
        /// C_l, constant over the angle of attack.
        lift: 0.6, Finite;
        /// Center of pressure over that of chapter 5; 0 puts the force at the planform's center.
        arm: 0.25, Finite;
    }
}

impl StochasticLaw {
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
    pub(crate) struct StochasticConstants<T> {
        dynamic_area: T,
        drag: T,
        lift: T,
        arm: T,
    }
}

impl<T: Scalar> Evaluate<T> for StochasticConstants<T> {
    #[inline(always)]
    fn terms(&self, u: &Vector3<T>, _w: &Vector3<T>) -> ViscousTerms<T> {
        let tangential = (u.x * u.x + u.y * u.y).sqrt();
        let speed = norm(u);
        let pressure = self.dynamic_area * speed;
        // −U × (N × U) = (N × U) × U, and |N × U| is the tangential speed. N is ±z; the sign of
        // u_z passes smoothly through zero.
        let windward = u.z * safe_inverse(u.z.abs() + speed.constant(1e-3) * speed);
        let turn = pressure * self.lift * windward * safe_inverse(tangential);
        ViscousTerms {
            drag: pressure * self.drag,
            translational_lift: Vector3::new(-u.y * turn, u.x * turn, speed.constant(0.0)),
            arm: pressure_arm(u, self.arm),
            arm_moves: false,
            ..ViscousTerms::none(speed)
        }
    }
}
