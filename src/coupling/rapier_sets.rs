//! What of a rapier world the coupling works on.

use rapier3d::dynamics::{
    ImpulseJointSet, IntegrationParameters, IslandManager, MultibodyJointSet, RigidBodyHandle,
    RigidBodySet,
};
use rapier3d::geometry::{ColliderSet, NarrowPhase};
use rapier3d::math::{Real, Vector};
use rapier3d::pipeline::PhysicsWorld;

/// The parts of a rapier world that the step reads and writes, for users who hold rapier's sets
/// themselves.
pub struct RapierSets<'a> {
    /// Gravity, m/s².
    pub gravity: Vector,
    /// Time step and solver settings.
    pub integration_parameters: &'a IntegrationParameters,
    /// Which bodies are awake.
    pub islands: &'a IslandManager,
    /// Contacts.
    pub narrow_phase: &'a NarrowPhase,
    /// The bodies.
    pub bodies: &'a mut RigidBodySet,
    /// The colliders; written when a body enters or leaves the fluid, and when its mass changes near a contact.
    pub colliders: &'a mut ColliderSet,
    /// Joints: jointed bodies are handed over like those in contact.
    pub impulse_joints: &'a ImpulseJointSet,
    /// Multibodies, likewise; written where the velocities that rapier leaves have more energy than was there.
    pub multibody_joints: &'a mut MultibodyJointSet,
}

/// A velocity times a factor; zero times infinity is zero.
pub(super) fn scaled(velocity: Real, factor: Real) -> Real {
    if factor == 0.0 {
        0.0
    } else {
        velocity * factor
    }
}

impl<'a> RapierSets<'a> {
    /// The parts of a [`PhysicsWorld`].
    pub fn of(world: &'a mut PhysicsWorld) -> Self {
        Self {
            gravity: world.gravity,
            integration_parameters: &world.integration_parameters,
            islands: &world.islands,
            narrow_phase: &world.narrow_phase,
            bodies: &mut world.bodies,
            colliders: &mut world.colliders,
            impulse_joints: &world.impulse_joints,
            multibody_joints: &mut world.multibody_joints,
        }
    }

    /// Whether there are joints at all.
    pub(super) fn have_joints(&self) -> bool {
        !self.impulse_joints.is_empty() || self.multibody_joints.multibodies().next().is_some()
    }

    /// The velocities of a link of a multibody, m/s at its center of mass and rad/s. Those that rapier's body
    /// reads after a step are of one substep before.
    /// Zero before the first step; `None` if the body is no link.
    pub(super) fn link_velocities(&self, handle: RigidBodyHandle) -> Option<(Vector, Vector)> {
        let id = self.multibody_joints.rigid_body_link(handle)?;
        let multibody = self.multibody_joints.get_multibody(id.multibody)?;
        let jacobian = multibody.body_jacobian(id.id);
        let velocity = multibody.generalized_velocity();
        if jacobian.ncols() != velocity.len() {
            return Some((Vector::ZERO, Vector::ZERO));
        }
        let v = jacobian * velocity;
        Some((Vector::new(v[0], v[1], v[2]), Vector::new(v[3], v[4], v[5])))
    }

    /// Multiplies the velocities of a multibody relative to `still` by a factor, once: for the first of its
    /// links that moves.
    pub(super) fn slow_links_down(&mut self, handle: RigidBodyHandle, factor: Real, still: Vector) {
        let Some(id) = self.multibody_joints.rigid_body_link(handle).copied() else {
            return;
        };
        let Some(multibody) = self.multibody_joints.get_multibody_mut(id.multibody) else {
            return;
        };
        let root = multibody.root();
        let free_root = root.joint().ndofs() == 6;
        if id.id > 1 || (id.id == 1 && free_root) {
            return;
        }
        let mut velocity = multibody.generalized_velocity_mut();
        for part in velocity.iter_mut() {
            *part = scaled(*part, factor);
        }
        if free_root {
            for (i, part) in still.to_array().into_iter().enumerate() {
                velocity[i] += part * (1.0 - factor);
            }
        }
    }

    /// Whether a body is a link of a multibody.
    pub(super) fn link(&self, handle: RigidBodyHandle) -> bool {
        self.multibody_joints.rigid_body_link(handle).is_some()
    }
}
