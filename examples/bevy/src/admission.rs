//! Bodies that enter and leave the fluid, or get another description there.
//!
//! The immersion itself follows what users change of colliders and masses; here only descriptions are made that it cannot
//! make, and those that could not be made before.

use crate::components::{Description, Immersed};
use crate::context::RapierContextImmersion;
use crate::look::Look;
use crate::readout::ImmersionWarning;
use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use bevy_rapier3d::rapier::prelude::{ColliderSet, RigidBodyHandle, RigidBodySet};
use rapier3d_immersed::{BodyChanges, ForceFactors, ImmersedBody, Immersion, Warning};

/// What was told to an immersion of a body.
#[derive(Component)]
pub(crate) struct Admitted {
    context: Entity,
    handle: RigidBodyHandle,
    told: Immersed,
    /// What the description was made of, if only this module can make it anew.
    look: Option<Look>,
    /// Why there is none.
    refused: Option<String>,
}

/// Gives contexts theirs that were there before the plugin.
pub(crate) fn add_immersions(
    contexts: Query<
        Entity,
        (
            With<RapierContextSimulation>,
            Without<RapierContextImmersion>,
        ),
    >,
    mut commands: Commands,
) {
    for context in &contexts {
        commands
            .entity(context)
            .insert(RapierContextImmersion::default());
    }
}

type Newcomers<'w, 's> = Query<
    'w,
    's,
    (
        Entity,
        Ref<'static, Immersed>,
        &'static RapierRigidBodyHandle,
        &'static RapierContextEntityLink,
        Option<&'static mut Admitted>,
    ),
>;

/// Tells the immersions of bodies that are new, have another component or are made of something else.
pub(crate) fn admit(
    mut bodies: Newcomers,
    mut contexts: Query<(
        &mut RapierContextImmersion,
        &mut RapierContextColliders,
        &mut RapierRigidBodySet,
    )>,
    mut warnings: MessageWriter<ImmersionWarning>,
    mut commands: Commands,
) {
    for (entity, immersed, handle, link, admitted) in &mut bodies {
        let (context, handle) = (link.0, handle.0);
        let Ok((mut immersion, mut colliders, mut set)) = contexts.get_mut(context) else {
            continue;
        };
        let mut tank = Tank {
            handle,
            // Nothing of a body that stays as it is counts as a change to others.
            immersion: immersion.bypass_change_detection(),
            colliders: &mut colliders.bypass_change_detection().colliders,
            bodies: &mut set.bypass_change_detection().bodies,
        };
        let known = admitted.filter(|known| known.context == context && known.handle == handle);
        let Some(mut known) = known else {
            let mut fresh = Admitted {
                context,
                handle,
                told: Immersed::clone(&immersed),
                look: None,
                refused: None,
            };
            tank.describe(entity, &mut fresh, &mut warnings);
            tank.set_factors(ForceFactors::ONE, immersed.factors);
            commands.entity(entity).insert(fresh);
            continue;
        };
        let before = immersed
            .is_changed()
            .then(|| std::mem::replace(&mut known.told, Immersed::clone(&immersed)));
        let described = before
            .as_ref()
            .is_some_and(|before| before.description != known.told.description);
        if described || tank.is_outdated(&known) {
            tank.describe(entity, &mut known, &mut warnings);
            tank.set_factors(ForceFactors::ONE, known.told.factors);
        } else if let Some(before) = before {
            if before.law != known.told.law {
                tank.change_law(&known.told);
            }
            tank.set_factors(before.factors, known.told.factors);
        }
    }
}

/// One body, and what it is in.
struct Tank<'a> {
    handle: RigidBodyHandle,
    immersion: &'a mut Immersion,
    colliders: &'a mut ColliderSet,
    bodies: &'a mut RigidBodySet,
}

impl Tank<'_> {
    /// Whether a description has to be made anew, or may be possible now.
    fn is_outdated(&self, known: &Admitted) -> bool {
        let (Some(look), Some(body)) = (&known.look, self.bodies.get(self.handle)) else {
            return false;
        };
        if self.immersion.contains(self.handle) {
            self.immersion.body_changes == BodyChanges::Follow && !look.holds(body, self.colliders)
        } else {
            !(look.holds(body, self.colliders) && look.weighs(body, self.colliders))
        }
    }

    /// Makes the description, and immerses the body as that.
    fn describe(
        &mut self,
        entity: Entity,
        known: &mut Admitted,
        warnings: &mut MessageWriter<ImmersionWarning>,
    ) {
        // The colliders of a body in the fluid do not show its own masses.
        self.immersion
            .remove(self.handle, self.bodies, self.colliders);
        let made = known
            .told
            .describe(self.bodies, self.colliders, self.handle);
        let body = self.bodies.get(self.handle);
        let look = body.map(|body| Look::of(body, self.colliders));
        match made {
            Ok(body) => {
                self.immersion.insert(self.handle, body);
                let follows = matches!(
                    known.told.description,
                    Description::Colliders | Description::Given(_)
                );
                known.look = look.filter(|_| !follows);
                known.refused = None;
            }
            Err(error) => {
                known.look = look;
                let reason = error.to_string();
                if known.refused.as_ref() != Some(&reason) {
                    log::warn!("{entity} is not immersed: {reason}");
                    warnings.write(ImmersionWarning {
                        context: known.context,
                        body: Some(entity),
                        warning: Warning::Refused {
                            body: self.handle,
                            reason: reason.clone(),
                        },
                    });
                    known.refused = Some(reason);
                }
            }
        }
    }

    /// The same description under another law.
    fn change_law(&mut self, told: &Immersed) {
        if let Some(body) = self.immersion.get(self.handle) {
            let body = ImmersedBody {
                law: told.law,
                ..body.clone()
            };
            self.immersion.insert(self.handle, body);
        }
    }

    /// Sets the factors if they are others: whoever replays a series sets them, too.
    fn set_factors(&mut self, before: ForceFactors, factors: ForceFactors) {
        if before == factors {
            return;
        }
        if let Err(error) = factors.check() {
            log::warn!("factors on the forces of {:?}: {error}", self.handle);
        }
        self.immersion.set_control(self.handle, factors);
    }
}

/// Makes a body rapier's own again that loses the component. One that rapier removes is forgotten without help.
pub(crate) fn leave(
    removed: On<Remove<Immersed>>,
    admitted: Query<&Admitted>,
    mut contexts: Query<(
        &mut RapierContextImmersion,
        &mut RapierContextColliders,
        &mut RapierRigidBodySet,
    )>,
    mut commands: Commands,
) {
    let Ok(known) = admitted.get(removed.entity) else {
        return;
    };
    if let Ok((mut immersion, mut colliders, mut bodies)) = contexts.get_mut(known.context) {
        immersion.remove(known.handle, &mut bodies.bodies, &mut colliders.colliders);
    }
    commands.entity(removed.entity).try_remove::<Admitted>();
}
