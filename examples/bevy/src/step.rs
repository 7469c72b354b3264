//! The step: bevy_rapier's own, once per substep, between the two halves of the fluid's.
//!
//! Two ways were weighed. To call [`RapierContextSimulation::step_simulation`] for each substep would need its adapter of hooks
//! and its lists of what was quarantined, which are private, and would have to follow all else that bevy_rapier's system
//! does. So it is that system which runs, under a [`TimestepMode`] of one substep; only the time of an update is divided
//! here, with the same arithmetic in the same order, so that the bits are the same.

use crate::context::RapierContextImmersion;
use bevy::ecs::system::SystemParamItem;
use bevy::prelude::*;
use bevy_rapier3d::plugin::systems::step_simulation;
use bevy_rapier3d::prelude::*;
use bevy_rapier3d::rapier::prelude::IntegrationParameters;
use rapier3d_immersed::{Immersion, RapierSets};

/// How an update is divided: the same for all contexts, but for how often.
#[derive(Clone, Copy)]
struct Division {
    /// What the parameters of a context read between updates, s.
    whole: f32,
    /// Length of a substep, s.
    substep: f32,
    substeps: usize,
}

impl Division {
    fn of(mode: TimestepMode, delta: f32) -> Self {
        let (whole, substeps, scale) = match mode {
            TimestepMode::Fixed { dt, substeps } => (dt, substeps, 1.0),
            TimestepMode::Variable {
                max_dt,
                time_scale,
                substeps,
            } => ((delta * time_scale).min(max_dt), substeps, 1.0),
            TimestepMode::Interpolated {
                dt,
                time_scale,
                substeps,
            } => (dt, substeps, time_scale),
        };
        Self {
            whole,
            substep: whole / substeps as f32 * scale,
            substeps,
        }
    }
}

/// A context that steps in this update.
#[derive(Clone, Copy)]
struct Stepping {
    context: Entity,
    /// How often `substeps` substeps are made.
    times: usize,
}

/// In place of bevy_rapier's step system.
pub(crate) fn step_immersed<Hooks>(world: &mut World)
where
    Hooks: 'static + BevyPhysicsHooks,
    for<'w, 's> SystemParamItem<'w, 's, Hooks>: BevyPhysicsHooks,
{
    let mode = *world.resource::<TimestepMode>();
    let division = Division::of(mode, world.resource::<Time>().delta_secs());
    let own = |world: &mut World| run(world, step_simulation::<Hooks>);
    if !(division.substeps > 0 && division.substep > 0.0) {
        return own(world);
    }
    let Some(stepping) = run(world, plan) else {
        return own(world);
    };
    let most = stepping.iter().map(|context| context.times).max();
    let Some(most @ 1..) = most else {
        return own(world);
    };
    let alone = TimestepMode::Fixed {
        dt: division.substep,
        substeps: 1,
    };
    *world
        .resource_mut::<TimestepMode>()
        .bypass_change_detection() = alone;
    for time in 0..most {
        let ended: Vec<_> = set_active(world, &stepping, |context| context.times > time);
        if matches!(mode, TimestepMode::Interpolated { .. }) {
            let last = stepping.iter().filter(|context| context.times == time + 1);
            let last: Vec<_> = last.map(|context| context.context).collect();
            run_with(world, begin_interpolation, last);
        }
        for _ in 0..division.substeps {
            run_with(world, before_step, division.substep);
            own(world);
            run_with(world, after_step, division.substep);
        }
        for context in ended {
            activate(world, context, true);
        }
    }
    *world
        .resource_mut::<TimestepMode>()
        .bypass_change_detection() = mode;
    run_with(world, show_whole, division.whole);
}

/// Runs a system, which must not fail.
fn run<O: 'static, M, S: IntoSystem<(), O, M> + 'static>(world: &mut World, system: S) -> O {
    world
        .run_system_cached(system)
        .unwrap_or_else(|error| panic!("a part of the physics step did not run: {error}"))
}

fn run_with<I, M, S>(world: &mut World, system: S, input: I)
where
    I: 'static,
    S: IntoSystem<In<I>, (), M> + 'static,
{
    world
        .run_system_cached_with(system, input)
        .unwrap_or_else(|error| panic!("a part of the physics step did not run: {error}"));
}

/// How often each active context steps; `None` if bevy_rapier's step as it is does all that there is to do.
///
/// Of [`TimestepMode::Interpolated`] this keeps the account, as bevy_rapier's own step does.
fn plan(
    mut contexts: Query<(
        Entity,
        &RapierContextImmersion,
        &RapierConfiguration,
        &mut SimulationToRenderTime,
    )>,
    mode: Res<TimestepMode>,
    time: Res<Time>,
) -> Option<Vec<Stepping>> {
    let active = |configuration: &RapierConfiguration| configuration.physics_pipeline_active;
    let used = |(_, immersion, configuration, _): (_, &RapierContextImmersion, _, _)| {
        active(configuration) && immersion.is_in_use()
    };
    if !contexts.iter().any(used) {
        return None;
    }
    let TimestepMode::Interpolated { dt, .. } = *mode else {
        let active = contexts.iter().filter(|context| active(context.2));
        return Some(
            active
                .map(|(context, ..)| Stepping { context, times: 1 })
                .collect(),
        );
    };
    let times = |diff: f32| {
        let mut left = diff + time.delta_secs();
        let mut times = 0;
        while left > 0.0 {
            left -= dt;
            times += 1;
        }
        (times, left)
    };
    // Where no context steps, bevy_rapier's step keeps the account.
    if contexts
        .iter()
        .filter(|context| active(context.2))
        .all(|(.., account)| times(account.diff).0 == 0)
    {
        return None;
    }
    let mut stepping = Vec::new();
    for (context, _, configuration, mut account) in &mut contexts {
        if active(configuration) {
            let (times, left) = times(account.diff);
            account.diff = left;
            stepping.push(Stepping { context, times });
        }
    }
    Some(stepping)
}

/// Lets those contexts stand still that take no part, and says which.
fn set_active(
    world: &mut World,
    stepping: &[Stepping],
    takes_part: impl Fn(&Stepping) -> bool,
) -> Vec<Entity> {
    let out = stepping.iter().filter(|context| !takes_part(context));
    let out: Vec<_> = out.map(|context| context.context).collect();
    for context in &out {
        activate(world, *context, false);
    }
    out
}

fn activate(world: &mut World, context: Entity, active: bool) {
    if let Some(mut configuration) = world.get_mut::<RapierConfiguration>(context) {
        configuration
            .bypass_change_detection()
            .physics_pipeline_active = active;
    }
}

/// Keeps where the bodies of these contexts are: between there and where the next step takes them they are shown.
fn begin_interpolation(
    In(contexts): In<Vec<Entity>>,
    sets: Query<&RapierRigidBodySet>,
    mut bodies: Query<(
        &RapierRigidBodyHandle,
        &RapierContextEntityLink,
        &mut TransformInterpolation,
    )>,
) {
    for (handle, link, mut interpolation) in &mut bodies {
        if contexts.contains(&link.0)
            && let Ok(set) = sets.get(link.0)
            && let Some(body) = set.bodies.get(handle.0)
        {
            interpolation.start = Some(*body.position());
            interpolation.end = None;
        }
    }
}

/// The parts of a context.
type Context = (
    &'static mut RapierContextImmersion,
    &'static RapierContextSimulation,
    &'static mut RapierContextColliders,
    &'static mut RapierContextJoints,
    &'static mut RapierRigidBodySet,
    &'static RapierConfiguration,
);

fn before_step(In(dt): In<f32>, contexts: Query<Context>) {
    visit(dt, contexts, Immersion::before_step);
}

fn after_step(In(dt): In<f32>, contexts: Query<Context>) {
    visit(dt, contexts, Immersion::after_step);
}

/// Shows each context that steps to its immersion.
fn visit(dt: f32, mut contexts: Query<Context>, half: fn(&mut Immersion, &mut RapierSets)) {
    for (mut immersion, simulation, mut colliders, mut joints, mut bodies, configuration) in
        &mut contexts
    {
        // Where only collisions are looked for nothing is moved.
        let full = configuration.simulation_mode == SimulationMode::Full;
        if !(configuration.physics_pipeline_active && full) {
            continue;
        }
        let integration_parameters = IntegrationParameters {
            dt,
            ..simulation.integration_parameters
        };
        let joints = &mut *joints;
        let mut sets = RapierSets {
            gravity: configuration.gravity,
            integration_parameters: &integration_parameters,
            islands: &simulation.islands,
            narrow_phase: &simulation.narrow_phase,
            bodies: &mut bodies.bodies,
            colliders: &mut colliders.colliders,
            impulse_joints: &joints.impulse_joints,
            multibody_joints: &mut joints.multibody_joints,
        };
        half(&mut immersion, &mut sets);
    }
}

/// Between updates the parameters read what they would by bevy_rapier's own step.
fn show_whole(
    In(whole): In<f32>,
    mut contexts: Query<(&mut RapierContextSimulation, &RapierConfiguration)>,
) {
    for (mut simulation, configuration) in &mut contexts {
        if configuration.physics_pipeline_active {
            simulation.integration_parameters.dt = whole;
        }
    }
}
