//! What bodies of parts and engines keep from step to step, besides what all bodies do.

use super::shared_constants::SharedConstants;
use super::turbulence_memory::TurbulenceMemory;
use crate::body::ImmersedBody;
use crate::dynamics::ForceAndTorque;
use crate::hydro::viscous::ForceFactors;
use crate::math::{to_f64, to_quaternion, to_real};
use rapier3d::dynamics::RigidBody;
use rapier3d::math::{Real, Vector};
use rapier3d::na::Vector3;

/// How one part is set, and what it remembers.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct PartState {
    /// Factors on its law's forces.
    pub factors: ForceFactors,
    /// Turn about its hinge, rad.
    pub deflection: Real,
    pub turbulence: TurbulenceMemory,
}

/// The equipment of one body.
#[derive(Clone, Debug, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct Equipment {
    pub parts: Vec<PartState>,
    /// What drives each thruster: N, or turns per second.
    pub drives: Vec<f64>,
    /// Volume that the body displaces beyond its shape's, m³.
    pub extra_volume: f64,
    /// Whether something of it was set since the body was last moved.
    pub set: bool,
    /// What thrusters and extra volume did in the last step.
    pub thrust: ForceAndTorque,
    pub buoyancy: ForceAndTorque,
}

impl Equipment {
    /// The equipment of a body of this description that had `before`; `None` if it needs none.
    pub fn of(body: &ImmersedBody, before: Option<Box<Self>>) -> Option<Box<Self>> {
        let extra = before
            .as_ref()
            .is_some_and(|known| known.extra_volume != 0.0);
        if body.parts.is_empty() && body.thrusters.is_empty() && !extra {
            return None;
        }
        let mut equipment = before.unwrap_or_default();
        let parts = body.parts.len();
        equipment.parts.resize(parts, PartState::default());
        equipment.drives.resize(body.thrusters.len(), 0.0);
        Some(equipment)
    }

    /// Whether every number can be.
    #[cfg(feature = "serde-serialize")]
    pub fn is_valid(&self) -> bool {
        let part = |part: &PartState| {
            let memory = &part.turbulence;
            part.factors.check().is_ok()
                && part.deflection.is_finite()
                && (memory.fluctuation + memory.slip + memory.seen.normalized).is_finite()
        };
        self.parts.iter().all(part)
            && self.drives.iter().all(|drive| drive.is_finite())
            && self.extra_volume.is_finite()
            && [self.thrust, self.buoyancy]
                .iter()
                .all(|acts| (acts.force + acts.torque).is_finite())
    }

    /// Lets thrusters and extra volume act on a body in a step of `dt`.
    pub fn act(
        &mut self,
        shared: &SharedConstants,
        body: &RigidBody,
        fluid_velocity: Vector,
        gravity: Vector,
        density_at: impl Fn(Vector) -> f64,
        dt: Real,
    ) {
        self.set = false;
        let c = &shared.constants;
        let turn = to_quaternion(*body.rotation());
        let back = turn.inverse();
        let linear = back * to_f64(body.linvel() - fluid_velocity);
        let angular = back * to_f64(body.angvel());
        let (mut force, mut torque) = (Vector3::zeros(), Vector3::zeros());
        for (thruster, drive) in shared.thrusters.iter().zip(&self.drives) {
            let arm = thruster.point - c.dry.center;
            let speed = (linear + angular.cross(&arm)).dot(&thruster.direction);
            let density = density_at(body.center_of_mass() + to_real(turn * arm));
            let [thrust, turning] = thruster.action(*drive, speed, density);
            // A propeller that turns fast brakes a light body within a step: it may not more than stop what it brakes.
            let stiff = thruster.slope(*drive, density) * f64::from(dt) / c.dry.mass;
            let thrust = thruster.direction * (thrust / (1.0 + stiff));
            force += thrust;
            torque += arm.cross(&thrust) + thruster.direction * turning;
        }
        self.thrust = ForceAndTorque {
            force: to_real(turn * force),
            torque: to_real(turn * torque),
        };
        let density = if self.extra_volume == 0.0 {
            0.0
        } else {
            density_at(body.center_of_mass() + to_real(turn * c.buoyancy_arm))
        };
        let buoyancy = to_f64(gravity) * (-density * self.extra_volume);
        self.buoyancy = ForceAndTorque {
            force: to_real(buoyancy),
            torque: to_real((turn * c.buoyancy_arm).cross(&buoyancy)),
        };
    }

    /// Both together.
    pub fn action(&self) -> ForceAndTorque {
        self.thrust + self.buoyancy
    }
}
