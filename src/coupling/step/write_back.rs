//! Writes to rapier what the step shall do to each body, and gives back after it what users had set.

use super::contact_mass;
use super::workspace::{Batch, SavedForces, StepInput, StepOutput};
use crate::coupling::rapier_sets::RapierSets;
use crate::coupling::registry::Registry;
use crate::coupling::shared_constants::ConstantsTable;
use crate::math::vector;
use rapier3d::dynamics::{RigidBody, RigidBodySet};
use rapier3d::math::Vector;

/// Steps of a contact that count as its impact: what the contact did is corrected in these. A velocity
/// that is set after the step is new to the solver; in a pile of leaves such corrections kept up 2 cm/s
/// forever, where without them it comes to rest below 1 mm/s.
const IMPACT: u8 = 3;

/// Writes the outputs of a batch, and keeps what must be given back.
pub(super) fn write_back(
    batch: &Batch,
    constants: &ConstantsTable,
    registry: &mut Registry,
    sets: &mut RapierSets,
    saved_forces: &mut Vec<SavedForces>,
) {
    for (i, (input, output)) in batch.inputs.iter().zip(&batch.outputs).enumerate() {
        if let Some(state) = registry.at_mut(input.state as usize) {
            if let Some(flow) = batch.flows.get(i) {
                state.flight.fluid_velocity = vector(flow.velocity);
            }
            if let Some(turbulence) = batch.turbulence.get(i) {
                state.flight.turbulence = *turbulence;
            }
        }
        if let Some(saved) = write_body(input, output, constants, registry, sets) {
            saved_forces.push(saved);
        }
    }
}

/// Writes what the step shall do to one body.
fn write_body(
    input: &StepInput,
    output: &StepOutput,
    constants: &ConstantsTable,
    registry: &mut Registry,
    sets: &mut RapierSets,
) -> Option<SavedForces> {
    let body = sets.bodies.get_mut(input.handle)?;
    let [force, torque, start_linear, start_angular] = [
        output.force,
        output.torque,
        output.start_linear,
        output.start_angular,
    ]
    .map(vector);
    if !(force + torque + start_linear + start_angular).is_finite() {
        return None;
    }
    let state = registry.at_mut(input.state as usize)?;
    let shared = constants.get(input.constants)?;
    let torque = if state.flight.converts_torque {
        let rapier = &body.mass_properties().local_mprops;
        shared.torque_for(rapier, *body.rotation(), torque)
    } else {
        torque
    };
    let saved = SavedForces {
        handle: input.handle,
        state: input.state,
        constants: input.constants,
        force: body.user_force(),
        torque: body.user_torque(),
        touching: input.may_sleep,
    };
    if input.free {
        body.set_linvel(start_linear, false);
        body.set_angvel(start_angular, false);
    }
    replace_forces(body, force, torque);
    if !input.may_sleep {
        // Drifting slowly through water is not resting.
        body.activation_mut().time_since_can_sleep = 0.0;
        state.flight.corrected_contacts = 0;
    }
    if input.new_mass
        && let Some(saved) = &state.saved
    {
        let mass = input.solver_mass.into();
        saved.set_mass(shared, mass, input.handle, sets.bodies, sets.colliders);
        state.flight.solver_mass = input.solver_mass;
    }
    state.flight.motion = output.motion;
    state.flight.end_linear = vector(output.end_linear);
    state.flight.end_angular = vector(output.end_angular);
    state.flight.continues = true;
    Some(saved)
}

/// After the step: gives a body's forces back to the user, and corrects its velocity if it has just met
/// something.
pub(super) fn finish(
    saved: &SavedForces,
    constants: &ConstantsTable,
    registry: &mut Registry,
    sets: &mut RapierSets,
) {
    let Some(body) = give_back(saved, sets.bodies) else {
        return;
    };
    let Some(state) = registry.at_mut(saved.state as usize) else {
        return;
    };
    // A user may have changed the set since the step began: the body may have gone, or have another
    // description or fluid. Its contacts are then left as rapier solved them.
    let unchanged = state.handle == saved.handle && state.constants == saved.constants;
    if !unchanged || !saved.touching || state.flight.corrected_contacts >= IMPACT {
        return;
    }
    let Some(shared) = constants.get(state.constants) else {
        return;
    };
    let mass = state.flight.solver_mass.into();
    if let Some((linear, angular)) = contact_mass::correction(shared, body, sets.narrow_phase, mass)
        && (linear + angular).is_finite()
    {
        state.flight.corrected_contacts += 1;
        body.set_linvel(body.linvel() + linear, false);
        body.set_angvel(body.angvel() + angular, false);
    }
}

/// Gives a body's forces back to the user.
pub(super) fn give_back<'a>(
    saved: &SavedForces,
    bodies: &'a mut RigidBodySet,
) -> Option<&'a mut RigidBody> {
    let body = bodies.get_mut(saved.handle)?;
    replace_forces(body, saved.force, saved.torque);
    Some(body)
}

fn replace_forces(body: &mut RigidBody, force: Vector, torque: Vector) {
    body.reset_forces(false);
    body.reset_torques(false);
    body.add_force(force, false);
    body.add_torque(torque, false);
}
