//! The first part of the thesis's fractional step (§4.3.2): weight and buoyancy act before the turbulence.

use super::stage_data::{Disturbance, StepContext, StepInput};
use crate::coupling::shared_constants::SharedConstants;
use crate::math::{row, to_f64, to_quaternion, to_real, vector};
use rapier3d::math::{Rotation, Vector};
use rapier3d::na::Vector6;

/// What weight and buoyancy do to a body in a step. World axes.
pub(super) struct GravityStep {
    /// Changes of the velocities, m/s and rad/s.
    pub linear: Vector,
    angular: Vector,
    /// Weight and buoyancy, N, and their torque about the center of mass, N·m.
    force: Vector,
    torque: Vector,
}

impl GravityStep {
    /// Of a body that is whole in its fluid: `𝕄⁻¹ (F_g, Γ_g) dt`, thesis (4.5) and (4.6) with their signs corrected.
    pub fn of(shared: &SharedConstants, input: &StepInput, context: &StepContext) -> Self {
        let constants = &shared.constants;
        let plate = to_quaternion(Rotation::from_array(input.rapier_attitude));
        let attitude = plate * constants.axes.inverse();
        let gravity = attitude.inverse() * to_f64(context.gravity) * f64::from(input.gravity_scale);
        let force = gravity * (constants.dry.mass - constants.displaced_mass);
        let torque = constants
            .buoyancy_arm
            .cross(&(gravity * -constants.displaced_mass));
        let load = Vector6::from_iterator(force.iter().chain(&torque).copied());
        let change = shared.mass.inverse * load * f64::from(context.dt);
        let world = |part: usize| to_real(attitude * change.fixed_rows::<3>(part).into_owned());
        Self {
            linear: world(0),
            angular: world(3),
            force: to_real(attitude * force),
            torque: to_real(attitude * torque),
        }
    }

    /// Gives a body the change at once, and takes the loads that cause it out of the rest of its step.
    pub fn take(&self, disturbance: &mut Disturbance) {
        let add = |to: &mut _, change| *to = row(vector(*to) + change);
        add(&mut disturbance.linear, self.linear);
        add(&mut disturbance.angular, self.angular);
        add(&mut disturbance.force, -self.force);
        add(&mut disturbance.torque, -self.torque);
    }
}
