//! The immersion of a rapier context, and how to get at it from an entity.

use crate::surroundings::Applied;
use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use bevy_rapier3d::rapier::prelude::{RigidBodyHandle, RigidBodySet};
use rapier3d_immersed::{Fluid, Immersion};

/// The [`Immersion`] of a rapier context: everything that has no component or resource of its own. It is on every entity
/// with a [`RapierContextSimulation`].
///
/// A body of the context is known there by the handle in its [`RapierRigidBodyHandle`]; [`WriteImmersion`] looks it up.
/// What [`Medium`](crate::Medium), [`Wind`](crate::Wind) and [`Turbulence`](crate::Turbulence) say is set there
/// when they change, and not otherwise: what is set by hand stays until then.
///
/// ```
/// use bevy::prelude::*;
/// use bevy_rapier3d_immersed::prelude::*;
///
/// /// Switches the fluid off and on.
/// fn switch(mut contexts: Query<&mut RapierContextImmersion>) {
///     for mut immersion in &mut contexts {
///         let on = !immersion.is_enabled();
///         immersion.set_enabled(on);
///     }
/// }
/// # bevy::ecs::system::assert_is_system(switch);
/// ```
#[derive(Component, Deref, DerefMut)]
pub struct RapierContextImmersion {
    #[deref]
    immersion: Immersion,
    /// What was told to it last.
    pub(crate) applied: Applied,
    /// How many of its warnings were sent.
    pub(crate) sent: usize,
}

impl Default for RapierContextImmersion {
    fn default() -> Self {
        Self {
            immersion: Immersion::new(Fluid::AIR),
            applied: Applied::default(),
            sent: 0,
        }
    }
}

impl RapierContextImmersion {
    /// Whether a step with it differs from one without it: because of bodies, or because time goes on for what moves.
    pub(crate) fn is_in_use(&self) -> bool {
        let medium = self.medium();
        let mut layers = medium.layers().iter();
        !self.is_empty()
            || layers.any(|layer| layer.flow.is_some() || layer.turbulence.is_some())
            || !medium.surface().is_still()
    }
}

/// From an entity to its body in the fluid.
///
/// ```
/// use bevy::prelude::*;
/// use bevy_rapier3d_immersed::prelude::*;
///
/// #[derive(Component)]
/// struct Boat;
///
/// fn row(boat: Single<Entity, With<Boat>>, mut immersions: WriteImmersion) {
///     if let Some(boat) = immersions.get(*boat) {
///         boat.immersion.set_thrust(boat.handle, 0, 4.0); // N
///         boat.immersion.apply_impulse(boat.bodies, boat.handle, Vec3::X); // N·s, body and fluid
///     }
/// }
/// # bevy::ecs::system::assert_is_system(row);
/// ```
#[derive(SystemParam)]
pub struct WriteImmersion<'w, 's> {
    handles: Query<
        'w,
        's,
        (
            &'static RapierRigidBodyHandle,
            &'static RapierContextEntityLink,
        ),
    >,
    contexts: Query<
        'w,
        's,
        (
            &'static mut RapierContextImmersion,
            &'static mut RapierRigidBodySet,
        ),
    >,
}

/// A body, and the immersion that has it.
pub struct InFluid<'a> {
    /// That of the body's context.
    pub immersion: &'a mut Immersion,
    /// The context's bodies.
    pub bodies: &'a mut RigidBodySet,
    /// The body.
    pub handle: RigidBodyHandle,
}

impl WriteImmersion<'_, '_> {
    /// The body of an entity; `None` if bevy_rapier has none, or it is not [`Immersed`](crate::Immersed) (yet).
    pub fn get(&mut self, entity: Entity) -> Option<InFluid<'_>> {
        let (handle, link) = self.handles.get(entity).ok()?;
        let (immersion, bodies) = self.contexts.get_mut(link.0).ok()?;
        if !immersion.contains(handle.0) {
            return None;
        }
        Some(InFluid {
            immersion: &mut immersion.into_inner().immersion,
            bodies: &mut bodies.into_inner().bodies,
            handle: handle.0,
        })
    }
}
