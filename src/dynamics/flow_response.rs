//! How a body follows a fluid that accelerates.

use super::constants::BodyConstants;
use crate::math::spatial::{Twist, skew, transform};
use crate::math::{Scalar, scalar_struct};
use rapier3d::na::{Matrix3, Matrix6, Vector3};

scalar_struct! {
    /// How a body follows the fluid around it, plate axes: `𝕄⁻¹ (ρV + ρA)`, the pressure gradient and the
    /// added mass of an accelerating flow.
    pub(crate) struct FlowResponse<T> {
        /// Change of u per change of the fluid's velocity …
        linear: Matrix3<T>,
        /// … and of w = ωL.
        angular: Matrix3<T>,
        /// The spin, in units of speed, that the strain across each axis is worth, m:
        /// L (b² − c²)/(b² + c²) and so on.
        straining: Vector3<T>,
    }
}

impl<T: Scalar> FlowResponse<T> {
    /// Change of the velocity of a body when the fluid around it changes its own by `change`. A neutrally
    /// buoyant body follows exactly.
    #[inline(always)]
    pub fn to(&self, change: &Vector3<T>) -> Twist<T> {
        Twist {
            linear: transform(&self.linear, change),
            angular: transform(&self.angular, change),
        }
    }
}

impl FlowResponse<f64> {
    /// That of one body, of whose [`mass_matrix`](BodyConstants::mass_matrix) this is the inverse.
    pub fn new(constants: &BodyConstants, inverse_mass: &Matrix6<f64>) -> Self {
        // First in the body's axes, then in the plate's.
        let mut dragged = constants
            .added_mass
            .to_matrix6()
            .fixed_columns::<3>(0)
            .into_owned();
        let mut pressure = dragged.fixed_rows_mut::<3>(0);
        pressure += Matrix3::from_diagonal_element(constants.displaced_mass);
        let mut moment = dragged.fixed_rows_mut::<3>(3);
        moment += skew(&constants.buoyancy_arm) * constants.displaced_mass;
        let response = inverse_mass * dragged;
        let to_plate =
            |m: Matrix3<f64>| constants.axes.inverse().matrix() * m * constants.axes.matrix();
        Self {
            linear: to_plate(response.fixed_rows::<3>(0).into_owned()),
            angular: to_plate(response.fixed_rows::<3>(3).into_owned()) * constants.length,
            straining: constants.straining * constants.length,
        }
    }
}
