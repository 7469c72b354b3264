//! What of a rapier world the coupling works on.

use rapier3d::dynamics::{
    ImpulseJointSet, IntegrationParameters, IslandManager, MultibodyJointSet, RigidBody,
    RigidBodyHandle, RigidBodySet,
};
use rapier3d::geometry::{ColliderSet, NarrowPhase};
use rapier3d::math::Vector;
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
    /// Multibodies, likewise.
    pub multibody_joints: &'a MultibodyJointSet,
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
            multibody_joints: &world.multibody_joints,
        }
    }

    /// Whether joints hold a body.
    pub(super) fn join(&self, handle: RigidBodyHandle) -> bool {
        (!self.impulse_joints.is_empty()
            && self.impulse_joints.attached_joints(handle).next().is_some())
            || self.link(handle)
    }

    /// Whether all joints of a body are without motors, and hold it to bodies that stand still.
    pub(super) fn join_without_work(&self, handle: RigidBodyHandle) -> bool {
        let mut joints = self.impulse_joints.attached_joints(handle);
        joints.all(|(first, second, _, joint)| {
            let other = if first == handle { second } else { first };
            joint.data.motor_axes.is_empty()
                && self.bodies.get(other).is_some_and(RigidBody::is_fixed)
        })
    }

    /// Whether a body is a link of a multibody.
    pub(super) fn link(&self, handle: RigidBodyHandle) -> bool {
        self.multibody_joints.rigid_body_link(handle).is_some()
    }
}
