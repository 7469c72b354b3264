//! The plugin: bevy_rapier's bodies in a fluid. Copy it into your app.

use bevy::prelude::*;
use bevy_rapier3d::plugin::context::{
    RapierContextColliders, RapierContextJoints, RapierContextSimulation, RapierRigidBodySet,
};
use bevy_rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion, RapierSets};

/// Immerses the bodies that have the component [`Immersed`].
///
/// Goes into the schedule of [`RapierPhysicsPlugin`], whose [`TimestepMode`] must be
/// `Fixed` with one substep: of several steps at a time bevy_rapier shows only the first and the last.
pub struct ImmersionPlugin<S> {
    /// The fluid that the bodies are in.
    pub fluid: Fluid,
    /// The schedule that rapier's plugin runs in.
    pub schedule: S,
}

/// For a dynamic body with a collider. Without it the body is rapier's own again.
#[derive(Component, Default)]
pub struct Immersed;

/// The fluid and what is in it: wind, turbulence, laws of single bodies, read-outs.
#[derive(Resource, Deref, DerefMut)]
pub struct Surroundings(pub Immersion);

impl<S: bevy::ecs::schedule::ScheduleLabel + Clone> Plugin for ImmersionPlugin<S> {
    fn build(&self, app: &mut App) {
        app.insert_resource(Surroundings(Immersion::new(self.fluid)));
        app.add_systems(
            self.schedule.clone(),
            (
                (leave, enter, before_step)
                    .chain()
                    .after(PhysicsSet::SyncBackend)
                    .before(PhysicsSet::StepSimulation),
                // Before the writeback: users' forces are their own again by then.
                after_step
                    .after(PhysicsSet::StepSimulation)
                    .before(PhysicsSet::Writeback),
            ),
        );
    }
}

/// The parts of the default rapier context.
type Context<'w, 's> = Single<
    'w,
    's,
    (
        &'static RapierContextSimulation,
        &'static mut RapierContextColliders,
        &'static mut RapierContextJoints,
        &'static mut RapierRigidBodySet,
        &'static RapierConfiguration,
    ),
    With<DefaultRapierContext>,
>;

type New = Or<(Added<Immersed>, Added<RapierRigidBodyHandle>)>;

/// Bodies that the fluid takes on: those that have just got the component, or rapier's handle.
fn enter(
    newcomers: Query<&RapierRigidBodyHandle, (With<Immersed>, New)>,
    mut surroundings: ResMut<Surroundings>,
    context: Context,
) {
    let (_, colliders, _, bodies, _) = context.into_inner();
    for handle in &newcomers {
        match HydroProperties::from_body(&bodies.bodies, &colliders.colliders, handle.0) {
            Ok(hydro) => surroundings.insert(handle.0, hydro),
            Err(error) => warn!("not immersed: {error}"),
        }
    }
}

/// Bodies that have lost the component. Those that rapier has removed are forgotten without help.
fn leave(
    mut gone: RemovedComponents<Immersed>,
    handles: Query<&RapierRigidBodyHandle>,
    mut surroundings: ResMut<Surroundings>,
    context: Context,
) {
    let (_, mut colliders, _, mut bodies, _) = context.into_inner();
    for entity in gone.read() {
        if let Ok(handle) = handles.get(entity) {
            surroundings.remove(handle.0, &mut bodies.bodies, &mut colliders.colliders);
        }
    }
}

fn before_step(
    mut surroundings: ResMut<Surroundings>,
    context: Context,
    timestep: Res<TimestepMode>,
) {
    step(context, *timestep, |sets| surroundings.before_step(sets));
}

fn after_step(
    mut surroundings: ResMut<Surroundings>,
    context: Context,
    timestep: Res<TimestepMode>,
) {
    step(context, *timestep, |sets| surroundings.after_step(sets));
    for warning in surroundings.warnings() {
        warn!("{warning}");
    }
    surroundings.clear_warnings();
}

/// Shows the context's parts as [`RapierSets`], if bevy_rapier steps them now.
fn step(context: Context, timestep: TimestepMode, visit: impl FnOnce(&mut RapierSets)) {
    let (simulation, mut colliders, mut joints, mut bodies, configuration) = context.into_inner();
    let TimestepMode::Fixed { dt, substeps: 1 } = timestep else {
        warn_once!("immersed bodies need TimestepMode::Fixed with one substep");
        return;
    };
    if !configuration.physics_pipeline_active {
        return;
    }
    // Bevy_rapier sets the step's length only in the step.
    let integration_parameters = IntegrationParameters {
        dt,
        ..simulation.integration_parameters
    };
    let joints = &mut *joints;
    visit(&mut RapierSets {
        gravity: configuration.gravity,
        integration_parameters: &integration_parameters,
        islands: &simulation.islands,
        narrow_phase: &simulation.narrow_phase,
        bodies: &mut bodies.bodies,
        colliders: &mut colliders.colliders,
        impulse_joints: &joints.impulse_joints,
        multibody_joints: &mut joints.multibody_joints,
    });
}
