//! The inertia of a body and of the fluid that it drags along, as contacts and joints feel it.

use super::principal_mass::PrincipalMass;
use rapier3d::math::{Real, Vector};
use rapier3d::na::{Matrix6, Vector6};

/// The mass of a body with its fluid about its center of mass: body axes, SI units.
#[derive(Clone, Debug)]
pub(super) struct BodyMass {
    whole: Matrix6<f64>,
    /// Its inverse.
    pub inverse: Matrix6<f64>,
    /// 𝕄₁₁ by its principal axes.
    pub principal: PrincipalMass,
    /// Whether rapier's inertia does not tell how a push at the center of mass turns the body.
    pub coupled: bool,
    /// Whether a boundary of fluids cuts the body, so that rapier has another inertia of it.
    pub cut: bool,
}

impl BodyMass {
    /// `None` if the matrix has no inverse.
    pub fn of(whole: Matrix6<f64>, coupled: bool) -> Option<Self> {
        Some(Self {
            inverse: whole.try_inverse()?,
            principal: PrincipalMass::of(&whole.fixed_view::<3, 3>(0, 0).into_owned()),
            whole,
            coupled,
            cut: false,
        })
    }

    /// Kinetic energy, J, at a velocity in m/s and rad/s, body axes.
    pub fn energy(&self, linear: Vector, angular: Vector) -> Real {
        let [v, w] = [linear, angular];
        let v = Vector6::new(v.x, v.y, v.z, w.x, w.y, w.z).map(f64::from);
        (0.5 * v.dot(&(self.whole * v))) as Real
    }
}
