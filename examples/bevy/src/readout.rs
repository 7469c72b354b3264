//! What the fluid did, for users.

use crate::components::FluidForces;
use crate::context::RapierContextImmersion;
use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use bevy_rapier3d::rapier::prelude::RigidBodyHandle;
use rapier3d_immersed::Warning;

/// Something that a user should know, sent once. The same text goes to the log.
#[derive(Message, Clone, Debug, PartialEq)]
pub struct ImmersionWarning {
    /// The rapier context.
    pub context: Entity,
    /// The entity of the body that it is about, if it is about one that is still there.
    pub body: Option<Entity>,
    /// What it is.
    pub warning: Warning,
}

/// Writes the forces of those who ask for them.
pub(crate) fn write_forces(
    contexts: Query<(&RapierContextImmersion, &RapierRigidBodySet)>,
    mut bodies: Query<(
        &RapierRigidBodyHandle,
        &RapierContextEntityLink,
        &mut FluidForces,
    )>,
) {
    for (handle, link, mut forces) in &mut bodies {
        let context = contexts.get(link.0).ok();
        let now = context.and_then(|(immersion, set)| immersion.forces(&set.bodies, handle.0));
        forces.set_if_neq(FluidForces(now.unwrap_or_default()));
    }
}

/// Sends what the steps had to say since the last time.
pub(crate) fn send_warnings(
    mut contexts: Query<(Entity, &mut RapierContextImmersion, &RapierRigidBodySet)>,
    mut messages: MessageWriter<ImmersionWarning>,
) {
    for (context, mut immersion, set) in &mut contexts {
        let count = immersion.warnings().len();
        if count == immersion.sent {
            continue;
        }
        // Fewer than before are others: the user has cleared the list.
        let sent = if count < immersion.sent {
            0
        } else {
            immersion.sent
        };
        for warning in &immersion.warnings()[sent..] {
            messages.write(ImmersionWarning {
                context,
                body: body_of(warning).and_then(|body| set.rigid_body_entity(body)),
                warning: warning.clone(),
            });
        }
        immersion.sent = count;
    }
}

/// The body that a warning is about.
fn body_of(warning: &Warning) -> Option<RigidBodyHandle> {
    match warning {
        Warning::Refused { body, .. }
        | Warning::WrongInertia { body, .. }
        | Warning::OddInertia { body, .. }
        | Warning::CoreMass { body, .. }
        | Warning::ShapeKept { body }
        | Warning::ChangeIgnored { body }
        | Warning::OutOfScope { body, .. }
        | Warning::FarPart { body, .. }
        | Warning::ImmersedTwice { body }
        | Warning::FlowNotFinite { body } => Some(*body),
        _ => None,
    }
}
