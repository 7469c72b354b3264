//! The plugin, and its place in the schedule.

use crate::components::{FluidForces, Immersed};
use crate::context::RapierContextImmersion;
use crate::surroundings::{ContextSurroundings, Medium, Turbulence, Wind};
use crate::{admission, readout, step, surroundings};
use bevy::ecs::intern::Interned;
use bevy::ecs::schedule::{ScheduleCleanupPolicy, ScheduleConfigs, ScheduleLabel};
use bevy::ecs::system::{ScheduleSystem, SystemParamItem};
use bevy::prelude::*;
use bevy_rapier3d::plugin::systems::step_simulation;
use bevy_rapier3d::prelude::*;
use std::marker::PhantomData;

/// Immerses the bodies that have the component [`Immersed`].
///
/// Goes after bevy_rapier's plugin, with the same hooks, and into the same schedule without being told which:
///
/// ```
/// use bevy::prelude::*;
/// use bevy_rapier3d::prelude::*;
/// use bevy_rapier3d_immersed::prelude::*;
///
/// App::new()
///     .add_plugins(RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule())
///     .add_plugins(ImmersedPlugin::<NoUserData>::default());
/// ```
///
/// # What it changes
/// Bevy_rapier's step system makes all substeps of an update at once, and the fluid has to act before and after each of
/// them. So the plugin takes that system out of its schedule, and runs it once per substep: see [`TimestepMode`]. Where
/// there are neither immersed bodies nor wind it runs as it would by itself.
///
/// With several substeps [`RapierContextSimulation::step_stats`] are those of the last one.
pub struct ImmersedPlugin<PhysicsHooks = ()> {
    default_system_setup: bool,
    hooks: PhantomData<fn() -> PhysicsHooks>,
}

impl<PhysicsHooks> Default for ImmersedPlugin<PhysicsHooks> {
    fn default() -> Self {
        Self {
            default_system_setup: true,
            hooks: PhantomData,
        }
    }
}

/// Where the plugin's own systems are.
#[derive(SystemSet, Debug, Hash, PartialEq, Eq, Clone)]
pub enum ImmersedSet {
    /// Bodies, and what they are in, are told to the contexts' [`Immersion`](rapier3d_immersed::Immersion)s: after
    /// [`PhysicsSet::SyncBackend`], before [`PhysicsSet::StepSimulation`]. What goes between this and the step sees all
    /// bodies of the step.
    Sync,
}

impl<PhysicsHooks> ImmersedPlugin<PhysicsHooks>
where
    PhysicsHooks: 'static + BevyPhysicsHooks,
    for<'w, 's> SystemParamItem<'w, 's, PhysicsHooks>: BevyPhysicsHooks,
{
    /// Whether the plugin puts its systems into bevy_rapier's schedule (the default), or the user adds
    /// [`ImmersedPlugin::get_systems`].
    pub fn with_default_system_setup(mut self, default_system_setup: bool) -> Self {
        self.default_system_setup = default_system_setup;
        self
    }

    /// All systems of the plugin, for users who set up bevy_rapier's by themselves: instead of
    /// `RapierPhysicsPlugin::get_systems(PhysicsSet::StepSimulation)`, which must not be there, too.
    pub fn get_systems() -> ScheduleConfigs<ScheduleSystem> {
        (
            (
                admission::add_immersions,
                surroundings::surround,
                admission::admit,
            )
                .chain()
                .in_set(ImmersedSet::Sync)
                .after(PhysicsSet::SyncBackend)
                .before(PhysicsSet::StepSimulation),
            step::step_immersed::<PhysicsHooks>.in_set(PhysicsSet::StepSimulation),
            (readout::write_forces, readout::send_warnings).in_set(PhysicsSet::Writeback),
        )
            .into_configs()
    }

    /// Takes bevy_rapier's step system out of the schedule that it is in.
    ///
    /// # Panics
    /// If it is in none.
    fn take_over(app: &mut App) -> Interned<dyn ScheduleLabel> {
        let step = step_simulation::<PhysicsHooks>;
        let set = IntoSystemSet::into_system_set(step).intern();
        let schedules = app.world().get_resource::<Schedules>();
        let schedule = schedules.into_iter().flat_map(Schedules::iter);
        let label = schedule
            .filter(|(_, schedule)| schedule.graph().system_sets.get_key(set).is_some())
            .map(|(_, schedule)| schedule.label())
            .next();
        let Some(label) = label else {
            panic!(
                "ImmersedPlugin goes after RapierPhysicsPlugin of the same hooks ({}), whose step it takes over; \
                 where bevy_rapier's systems are set up by hand, so are ImmersedPlugin's: with_default_system_setup(false)",
                std::any::type_name::<PhysicsHooks>()
            );
        };
        let removed = app.world_mut().schedule_scope(label, |world, schedule| {
            let policy = ScheduleCleanupPolicy::RemoveSetAndSystems;
            schedule.remove_systems_in_set(step, world, policy)
        });
        match removed {
            Ok(1..) => label,
            other => panic!("bevy_rapier's step system cannot be taken over: {other:?}"),
        }
    }
}

impl<PhysicsHooks> Plugin for ImmersedPlugin<PhysicsHooks>
where
    PhysicsHooks: 'static + BevyPhysicsHooks,
    for<'w, 's> SystemParamItem<'w, 's, PhysicsHooks>: BevyPhysicsHooks,
{
    fn build(&self, app: &mut App) {
        app.register_type::<Immersed>()
            .register_type::<FluidForces>()
            .register_type::<Medium>()
            .register_type::<Wind>()
            .register_type::<Turbulence>()
            .register_type::<ContextSurroundings>();
        app.init_resource::<Medium>()
            .init_resource::<Wind>()
            .init_resource::<Turbulence>()
            .add_message::<readout::ImmersionWarning>()
            .add_observer(admission::leave);
        // Contexts that are there already get theirs from `add_immersions`.
        let _ = app
            .try_register_required_components::<RapierContextSimulation, RapierContextImmersion>();
        if self.default_system_setup {
            let schedule = Self::take_over(app);
            app.add_systems(schedule, Self::get_systems());
        }
    }
}
