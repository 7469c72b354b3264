//! Runs the stages of a step over batches of bodies.

use super::integrate::integrate;
use super::prepare::{self, Preparation};
use super::sample_fluid::sample_fluid;
use super::stage_data::StepContext;
use super::substep_matching::SubstepScheme;
use super::workspace::{Batched, Bin, Workspace};
use super::write_back;
use super::{contact_mass, crossing, energy_budget};
use crate::coupling::control::SeriesTable;
use crate::coupling::environment::Environment;
use crate::coupling::rapier_sets::RapierSets;
use crate::coupling::registry::Registry;
use crate::coupling::shared_constants::ConstantsTable;
use crate::dynamics::Integrator;
use rapier3d::dynamics::RigidBodyHandle;

/// What a step reads and changes besides rapier.
pub(in crate::coupling) struct StepParts<'a> {
    pub integrator: Integrator,
    pub environment: &'a Environment,
    pub constants: &'a ConstantsTable,
    pub series: &'a SeriesTable,
    pub registry: &'a mut Registry,
    pub workspace: &'a mut Workspace,
}

/// Sets each body's force, torque and velocity so that rapier's step moves it as the fluid would. Bodies that
/// their users have changed are left for [`move_newcomers`].
pub(in crate::coupling) fn before_step(parts: &mut StepParts, sets: &mut RapierSets) {
    let Some(context) = context(parts.integrator, sets) else {
        return;
    };
    parts.workspace.forget_bodies();
    let layers = parts.environment.medium.layers().len();
    parts.workspace.prepare_batches(layers);
    if context.joints {
        parts.workspace.jointed.systems.find(sets, parts.registry);
    } else {
        parts.workspace.jointed.systems.clear();
    }
    parts.workspace.begin_marks(parts.registry.states().len());
    let heavy_fluid = parts.constants.heavy_fluid;
    contact_mass::find_close(
        parts.registry,
        heavy_fluid,
        sets,
        &mut parts.workspace.close,
    );

    // Rapier lists a body as active only once it has stepped it: newcomers go first.
    let mut newcomers = std::mem::take(&mut parts.registry.newcomers);
    let key = |handle: &RigidBodyHandle| handle.into_raw_parts();
    newcomers.sort_unstable_by_key(key);
    newcomers.dedup();
    for handle in &newcomers {
        move_body(*handle, parts, sets, &context);
    }
    let islands = sets.islands;
    for handle in islands.active_bodies() {
        if newcomers.binary_search_by_key(&key(&handle), key).is_err() {
            move_body(handle, parts, sets, &context);
        }
    }
    for bin in Bin::all(parts.environment.medium.layers().len()) {
        run_stages(bin, parts, sets, &context);
    }
    newcomers.clear();
    parts.registry.newcomers = newcomers;
}

/// Moves bodies that have entered the fluid after [`before_step`] of the same step.
pub(in crate::coupling) fn move_newcomers(parts: &mut StepParts, sets: &mut RapierSets) {
    let Some(context) = context(parts.integrator, sets) else {
        return;
    };
    if context.joints && !parts.registry.newcomers.is_empty() {
        parts
            .workspace
            .jointed
            .systems
            .find_others(sets, parts.registry);
    }
    for handle in std::mem::take(&mut parts.registry.newcomers) {
        let index = parts.registry.index(handle);
        let moved = index.and_then(|index| parts.workspace.moved.get(index));
        if moved != Some(&1) {
            move_body(handle, parts, sets, &context);
        }
    }
    for bin in Bin::all(parts.environment.medium.layers().len()) {
        run_stages(bin, parts, sets, &context);
    }
}

/// How a step is taken; `None` if it moves nothing.
fn context(integrator: Integrator, sets: &RapierSets) -> Option<StepContext> {
    let parameters = sets.integration_parameters;
    // A negative or NaN time step moves nothing, in rapier as here.
    if parameters.dt.is_nan() || parameters.dt <= 0.0 {
        return None;
    }
    Some(StepContext {
        dt: parameters.dt,
        substeps: parameters.num_solver_iterations.max(1),
        scheme: SubstepScheme::new(parameters.dt, parameters.num_solver_iterations),
        gravity: sets.gravity,
        joints: sets.have_joints(),
        integrator,
    })
}

/// Prepares a body, and moves its batch if that is full.
fn move_body(
    handle: RigidBodyHandle,
    parts: &mut StepParts,
    sets: &mut RapierSets,
    context: &StepContext,
) {
    let mut preparation = Preparation {
        environment: parts.environment,
        constants: parts.constants,
        series: parts.series,
        close: &parts.workspace.close,
        context,
        registry: parts.registry,
        moved: &mut parts.workspace.moved,
        changed: &mut parts.workspace.changed,
        sunk: &mut parts.workspace.sunk,
        batches: &mut parts.workspace.batches,
        systems: &mut parts.workspace.jointed.systems,
    };
    if let Some(bin) = prepare::prepare(handle, sets, &mut preparation)
        && parts.workspace.batches[bin.index()].is_full()
    {
        run_stages(bin, parts, sets, context);
    }
}

/// Moves the bodies of a batch, which is empty thereafter.
fn run_stages(bin: Bin, parts: &mut StepParts, sets: &mut RapierSets, context: &StepContext) {
    let workspace = &mut *parts.workspace;
    let batch = &mut workspace.batches[bin.index()];
    if batch.inputs.is_empty() {
        return;
    }
    sample_fluid(
        (parts.environment, bin.layer),
        parts.constants,
        context,
        batch,
        [&mut workspace.samples, &mut workspace.part_samples],
        &mut workspace.layer_points,
        &mut workspace.bad_flows,
    );
    let mut outputs = std::mem::take(&mut batch.outputs);
    let mut crossings = std::mem::take(&mut batch.crossings);
    let batched = Batched {
        states: parts.registry.states(),
        constants: parts.constants,
        disturbances: &batch.disturbances,
        parts: &batch.parts,
        context,
    };
    if bin.route.crossing {
        let environment = parts.environment;
        crossing::integrate(batch, &mut crossings, &mut outputs, environment, batched);
    } else {
        integrate(
            &batch.inputs,
            &batch.flows,
            &mut outputs,
            bin.route,
            batched,
        );
    }
    (batch.outputs, batch.crossings) = (outputs, crossings);
    let mut to = write_back::Destination {
        constants: parts.constants,
        registry: parts.registry,
        context,
        saved_forces: &mut workspace.saved_forces,
        held: &mut workspace.jointed.starts,
        moved_by_mean: &mut workspace.moved_by_mean,
    };
    write_back::write_back(batch, sets, &mut to);
    batch.clear();
}

/// Gives users' forces back where a step was begun and never finished, and bodies that were moved by their mean
/// velocity that of the step's end; whether there were any.
pub(in crate::coupling) fn give_back(parts: &mut StepParts, sets: &mut RapierSets) -> bool {
    let workspace = &mut *parts.workspace;
    let unfinished = !workspace.saved_forces.is_empty();
    for saved in &workspace.saved_forces {
        write_back::give_back(saved, &workspace.moved_by_mean, sets.bodies);
    }
    workspace.forget_bodies();
    unfinished
}

/// Gives users' forces back and corrects the velocities of bodies in contact.
pub(in crate::coupling) fn after_step(parts: &mut StepParts, sets: &mut RapierSets) {
    for i in 0..parts.workspace.saved_forces.len() {
        let (workspace, registry) = (&mut *parts.workspace, &mut *parts.registry);
        write_back::finish(i, workspace, parts.constants, registry, sets);
    }
    energy_budget::keep(
        &mut parts.workspace.jointed,
        parts.constants,
        parts.registry,
        sets,
    );
    parts.workspace.forget_bodies();
}
