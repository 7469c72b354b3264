//! The forces on one body of the world.

use super::flight::vector;
use super::immersion::Immersion;
use super::slot::NONE;
use crate::dynamics::forces::{ForceBreakdown, Instant};
use crate::dynamics::kirchhoff::Twist;
use crate::math::{to_f64, to_quaternion};
use rapier3d::dynamics::{RigidBodyHandle, RigidBodySet};
use rapier3d::math::Vector;
use rapier3d::na::UnitQuaternion;

impl Immersion {
    /// The forces on a body in the state that it has now, or `None` if it is not immersed (yet: a
    /// body enters the fluid with the first step after its insertion). Gravity is that of the last
    /// step.
    pub fn forces(&self, bodies: &RigidBodySet, handle: RigidBodyHandle) -> Option<ForceBreakdown> {
        let slot = self.slot(handle)?;
        let body = bodies.get(handle)?;
        if slot.kind == NONE || slot.original.is_none() {
            return None;
        }
        let c = &self.kinds[slot.kind as usize].constants;
        let attitude =
            to_quaternion(*body.rotation()) * UnitQuaternion::from_rotation_matrix(&c.axes);
        let sample = self.flow.as_ref().map(|flow| {
            let point = body.center_of_mass();
            let velocity = flow.velocity(point, self.time);
            (velocity, flow.vorticity(point, self.time))
        });
        let (stream, vorticity) = sample.unwrap_or_default();
        let plate = |row| to_f64(vector(row));
        let motion = &slot.flight.motion;
        let forces_in = |stream: Vector| {
            let forces = c.forces(&Instant {
                attitude,
                velocity: Twist {
                    linear: attitude.inverse() * to_f64(body.linvel() - stream),
                    angular: attitude.inverse()
                        * to_f64(body.angvel() - vorticity * 0.5)
                        * c.length,
                },
                rate: Twist {
                    linear: plate(motion.linear_rate),
                    angular: plate(motion.angular_rate),
                },
                gravity: to_f64(self.gravity * body.gravity_scale()),
            });
            forces.weighted(slot.control.map(f64::from))
        };
        let mut mean = forces_in(stream);
        let fluctuation = slot.flight.stirred.fluctuation;
        if self.turbulence.is_some() && fluctuation != Vector::ZERO {
            let stirred = forces_in(stream + fluctuation);
            mean.turbulence = stirred.viscous() - mean.viscous();
        }
        Some(mean)
    }
}
