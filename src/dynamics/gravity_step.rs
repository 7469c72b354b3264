//! The first part of the thesis's fractional step (§4.3.2): weight and buoyancy act before the turbulence.

use super::constants::BodyConstants;
use crate::math::spatial::{Twist, Wrench};
use rapier3d::na::{Matrix6, UnitQuaternion, Vector3, Vector6};

/// What weight and buoyancy do in a step to a body that is whole in its fluid. World axes.
pub(crate) struct GravityStep {
    /// Changes of the velocities, m/s and rad/s.
    pub change: Twist<f64>,
    /// Weight and buoyancy, N, and their torque about the center of mass, N·m.
    pub load: Wrench<f64>,
}

impl GravityStep {
    /// `𝕄⁻¹ (F_g, Γ_g) dt`, thesis (4.5) and (4.6) with their signs corrected. `attitude` maps plate axes to the world;
    /// the inverse is that of the [`mass_matrix`](BodyConstants::mass_matrix).
    pub fn of(
        constants: &BodyConstants,
        inverse_mass: &Matrix6<f64>,
        attitude: UnitQuaternion<f64>,
        gravity: Vector3<f64>,
        dt: f64,
    ) -> Self {
        let body = attitude * constants.axes.inverse();
        let gravity = body.inverse() * gravity;
        let force = gravity * (constants.dry.mass - constants.displaced_mass);
        let torque = constants
            .buoyancy_arm
            .cross(&(gravity * -constants.displaced_mass));
        let load = Vector6::from_iterator(force.iter().chain(&torque).copied());
        let change = inverse_mass * load * dt;
        let world = |part: usize| body * change.fixed_rows::<3>(part).into_owned();
        Self {
            change: Twist {
                linear: world(0),
                angular: world(3),
            },
            load: Wrench {
                force: body * force,
                torque: body * torque,
            },
        }
    }
}
