//! What a description was made of, to see when it has to be made anew.

use bevy_rapier3d::rapier::prelude::{
    Collider, ColliderHandle, ColliderSet, Pose, RigidBody, SharedShape,
};
use std::sync::Arc;

/// The colliders of a body, as they were when it was described.
pub(crate) struct Look(Vec<Seen>);

struct Seen {
    handle: ColliderHandle,
    /// Held, so that its address is not another shape's.
    shape: SharedShape,
    pose: Option<Pose>,
    solid: bool,
    /// kg: of account for bodies that are not immersed; the masses of others are the solver's.
    mass: f32,
}

impl Look {
    pub fn of(body: &RigidBody, colliders: &ColliderSet) -> Self {
        let seen = attached(body, colliders).map(|(handle, collider)| Seen {
            handle,
            shape: collider.shared_shape().clone(),
            pose: collider.position_wrt_parent().copied(),
            solid: is_solid(collider),
            mass: collider.mass(),
        });
        Self(seen.collect())
    }

    /// Whether the colliders are the same, of the same shapes at the same places.
    pub fn holds(&self, body: &RigidBody, colliders: &ColliderSet) -> bool {
        let mut now = attached(body, colliders);
        let same = self.0.iter().all(|seen| {
            now.next().is_some_and(|(handle, collider)| {
                handle == seen.handle
                    && Arc::ptr_eq(&seen.shape.0, &collider.shared_shape().0)
                    && seen.pose.as_ref() == collider.position_wrt_parent()
                    && seen.solid == is_solid(collider)
            })
        });
        same && now.next().is_none()
    }

    /// Whether their masses are the same, too.
    pub fn weighs(&self, body: &RigidBody, colliders: &ColliderSet) -> bool {
        let masses = attached(body, colliders).map(|(_, collider)| collider.mass());
        self.0.iter().map(|seen| seen.mass).eq(masses)
    }
}

fn attached<'a>(
    body: &'a RigidBody,
    colliders: &'a ColliderSet,
) -> impl Iterator<Item = (ColliderHandle, &'a Collider)> {
    let handles = body.colliders().iter();
    handles.filter_map(|handle| Some((*handle, colliders.get(*handle)?)))
}

/// Whether it displaces fluid.
fn is_solid(collider: &Collider) -> bool {
    collider.is_enabled() && !collider.is_sensor()
}
