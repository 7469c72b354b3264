//! The forces on one body of the world.

use super::body_state::BodyState;
use super::environment::Environment;
use super::shared_constants::ConstantsTable;
use crate::dynamics::ForceBreakdown;
use crate::dynamics::forces::Instant;
use crate::math::spatial::Twist;
use crate::math::{to_f64, to_quaternion, vector};
use rapier3d::dynamics::RigidBody;
use rapier3d::math::Vector;
use rapier3d::na::UnitQuaternion;

/// The forces on a body in the state that it has now; `None` if it is not in the fluid.
pub(super) fn forces(
    state: &BodyState,
    constants: &ConstantsTable,
    environment: &Environment,
    body: &RigidBody,
) -> Option<ForceBreakdown> {
    state.saved.as_ref()?;
    let c = &constants.get(state.constants)?.constants;
    let axes = UnitQuaternion::from_rotation_matrix(&c.axes);
    let attitude = to_quaternion(*body.rotation()) * axes;
    let mean = environment.mean_flow(body.center_of_mass());
    let plate_axes = |row| to_f64(vector(row));
    let motion = &state.flight.motion;
    let forces_in = |fluid_velocity: Vector| {
        let linear = body.linvel() - fluid_velocity;
        let angular = body.angvel() - mean.vorticity * 0.5;
        let forces = c.forces(&Instant {
            attitude,
            velocity: Twist {
                linear: attitude.inverse() * to_f64(linear),
                angular: attitude.inverse() * to_f64(angular) * c.length,
            },
            rate: Twist {
                linear: plate_axes(motion.linear_rate),
                angular: plate_axes(motion.angular_rate),
            },
            gravity: to_f64(environment.gravity * body.gravity_scale()),
        });
        forces.scaled(&state.control.factors.into())
    };
    let mut forces = forces_in(mean.velocity);
    let fluctuation = state.flight.turbulence.fluctuation;
    if environment.turbulence.is_some() && fluctuation != Vector::ZERO {
        let fluctuating = forces_in(mean.velocity + fluctuation);
        forces.turbulence = fluctuating.viscous() - forces.viscous();
    }
    Some(forces)
}
