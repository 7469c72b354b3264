//! Writes to rapier what the step shall do to each body, and gives back after it what users had set.

use super::held_motion;
use super::mean_motion::MeanMotion;
use super::stage_data::{
    HeldStart, JointAction, SavedForces, SeenFlow, StepContext, StepInput, StepOutput,
};
use super::workspace::{Batch, Workspace};
use super::{constraint_impulse, contact_mass, energy_budget, locked_axes};
use crate::body::from_rapier::inertia;
use crate::coupling::body_mass::BodyMass;
use crate::coupling::body_state::{FlightState, NONE};
use crate::coupling::equipment::Equipment;
use crate::coupling::rapier_sets::RapierSets;
use crate::coupling::registry::Registry;
use crate::coupling::shared_constants::{ConstantsTable, SharedConstants};
use crate::dynamics::ForceAndTorque;
use crate::math::{Row, to_f64, to_quaternion, to_real, vector};
use rapier3d::dynamics::{RigidBody, RigidBodySet};
use rapier3d::math::{Rotation, Vector};
use rapier3d::na::Matrix3;

/// Steps of a contact that count as its impact: what the contact did is corrected in these. A velocity
/// that is set after the step is new to the solver; in a pile of leaves such corrections kept up 2 cm/s
/// forever, where without them it comes to rest below 1 mm/s.
const IMPACT: u8 = 3;

/// Turn of a multibody's link in a step, rad, from which on the fluid may only brake it.
const FAST_LINK: f32 = 0.5;
/// The same from which on its joints are not counted on to turn it.
const STEADY_LINK: f32 = 0.1;

/// Speed above which the motion of a body is not followed, m/s: the integrator's limit.
const MOST_SPEED: f32 = 1e6;

/// What is written besides rapier's sets.
pub(super) struct Destination<'a> {
    pub constants: &'a ConstantsTable,
    pub registry: &'a mut Registry,
    pub context: &'a StepContext,
    pub saved_forces: &'a mut Vec<SavedForces>,
    pub held: &'a mut Vec<HeldStart>,
    pub moved_by_mean: &'a mut Vec<MeanMotion>,
}

/// Writes the outputs of a batch, and keeps what must be given back.
pub(super) fn write_back(batch: &mut Batch, sets: &mut RapierSets, to: &mut Destination) {
    let fluid_moves = !batch.flows.is_empty() || !batch.turbulence.is_empty();
    for (input, own) in batch.inputs.iter().zip(&mut batch.crossings) {
        if let Some(state) = to.registry.at_mut(input.state as usize) {
            state.crossing = own.memory.take();
        }
    }
    for (i, (input, output)) in batch.inputs.iter().zip(&batch.outputs).enumerate() {
        if fluid_moves && let Some(state) = to.registry.at_mut(input.state as usize) {
            if let Some(flow) = batch.flows.get(i) {
                state.flight.fluid_velocity = vector(flow.velocity);
            }
            if let Some(turbulence) = batch.turbulence.get(i) {
                state.flight.turbulence = *turbulence;
            }
            if let Some(equipment) = &mut state.equipment {
                let memories = batch.part_turbulence.get(input.first_part as usize..);
                let parts = equipment.parts.iter_mut();
                for (part, memory) in parts.zip(memories.unwrap_or_default()) {
                    part.turbulence = *memory;
                }
            }
        }
        if let Some(saved) = write_body(input, output, (batch, i), sets, to) {
            to.saved_forces.push(saved);
        }
    }
}

/// Writes what the step shall do to one body, the one at an index of its batch.
#[inline(always)]
fn write_body(
    input: &StepInput,
    output: &StepOutput,
    (batch, index): (&Batch, usize),
    sets: &mut RapierSets,
    to: &mut Destination,
) -> Option<SavedForces> {
    let body = sets.bodies.get_mut(input.handle)?;
    let [force, torque, start_linear, start_angular] = [
        output.force,
        output.torque,
        output.start_linear,
        output.start_angular,
    ]
    .map(vector);
    // Rapier moves what has gone beyond all measure by itself, and the next step begins with what it has then.
    let fast = vector(output.end_linear).length_squared() > MOST_SPEED * MOST_SPEED;
    if fast || !(force + torque + start_linear + start_angular).is_finite() {
        if let Some(state) = to.registry.at_mut(input.state as usize) {
            state.flight.continues = false;
        }
        return None;
    }
    let state = to.registry.at_mut(input.state as usize)?;
    let shared = to.constants.get(input.constants)?;
    let held = !input.free || input.system != NONE || input.locked;
    let mass = held.then(|| state.mass(shared));
    let flight = &mut state.flight;
    let mut saved = SavedForces {
        handle: input.handle,
        state: input.state,
        constants: input.constants,
        force: body.user_force(),
        torque: body.user_torque(),
        touching: input.touching,
        mean_motion: NONE,
        held: NONE,
    };
    let (mut force, mut torque) = (force, torque);
    let jointed = input.system != NONE;
    let mut motion = None;
    if let Some(mass) = &mass {
        let still = |flow: &SeenFlow| flow.change == Row::default();
        let disturbance = batch.disturbances.get(input.disturbance as usize);
        let own = state.equipment.as_deref();
        let own = own.map_or_else(Default::default, Equipment::action);
        let held = Held {
            shared,
            mass,
            input,
            output,
            expected: disturbance.map_or(JointAction::default(), |d| d.expected),
            user_force: saved.force + own.force,
            user_torque: saved.torque + own.torque,
            steady: batch.flows.get(index).is_none_or(still),
            at_surface: batch.crossings.get(index).map(|own| own.load),
            context: to.context,
        };
        let mut start = held.start(body, flight, force);
        if input.locked {
            let plate = Rotation::from_array(output.motion.attitude);
            let end = held_motion::under_locks(shared, mass, plate, &start);
            motion = Some(MeanMotion::locked(input, output, to.context, end));
        } else if !input.free {
            (force, torque) = held.forces(body, flight, &mut start, force, torque);
        }
        if jointed {
            saved.held = to.held.len() as u32;
            to.held.push(start);
        }
    }
    if input.free {
        motion = motion.or_else(|| MeanMotion::of(input, output, to.context));
        if let Some(motion) = motion {
            body.set_linvel(motion.mean_linear, false);
            body.set_angvel(motion.mean_angular, false);
            force = to.context.gravity * (-input.gravity_scale * input.solver_mass);
            torque = Vector::ZERO;
            saved.mean_motion = to.moved_by_mean.len() as u32;
            to.moved_by_mean.push(motion);
        } else {
            body.set_linvel(start_linear, false);
            body.set_angvel(start_angular, false);
        }
    }
    if flight.converts_torque && input.locks.is_empty() {
        let rapier = &body.mass_properties().local_mprops;
        torque = shared.torque_for(rapier, *body.rotation(), torque);
    }
    replace_forces(body, force, torque);
    if !input.may_sleep {
        // Drifting slowly through water is not resting.
        body.activation_mut().time_since_can_sleep = 0.0;
    }
    if !input.touching {
        flight.corrected_contacts = 0;
    }
    // Impulses at a lever can spin a thin body up without bounds: rapier's own limit stays on.
    let fast = input.free
        || !jointed
        || state
            .saved
            .as_ref()
            .is_some_and(|saved| saved.fast_rotation);
    if fast != body.is_fast_rotation_allowed() {
        body.set_allow_fast_rotation(fast);
        if let Some(saved) = &mut state.saved {
            saved.fast_written = fast;
        }
    }
    if input.new_mass
        && let Some(saved) = &mut state.saved
    {
        let mass = input.solver_mass.into();
        saved.set_mass(shared, mass, input.handle, sets.bodies, sets.colliders);
        state.flight.solver_mass = input.solver_mass;
    }
    let flight = &mut state.flight;
    flight.motion = output.motion;
    flight.end_linear = vector(output.end_linear);
    flight.end_angular = vector(output.end_angular);
    flight.was_held = jointed && !input.free;
    flight.continues = true;
    Some(saved)
}

/// A body that something holds, in the step that is written.
struct Held<'a> {
    shared: &'a SharedConstants,
    mass: &'a BodyMass,
    input: &'a StepInput,
    output: &'a StepOutput,
    /// What the constraints are expected to do.
    expected: JointAction,
    user_force: Vector,
    user_torque: Vector,
    /// Whether the fluid's velocity is that of the last step.
    steady: bool,
    /// Weight, buoyancy and user's force of a body that is cut.
    at_surface: Option<ForceAndTorque>,
    context: &'a StepContext,
}

impl Held<'_> {
    /// The body before the step. Out of the way of free bodies, which most are. `force` is that which leads to the velocity that was integrated.
    fn start(&self, body: &RigidBody, flight: &FlightState, force: Vector) -> HeldStart {
        let attitude = *body.rotation();
        let (input, output) = (self.input, self.output);
        let (linear, angular) = (vector(input.rapier_linear), vector(input.rapier_angular));
        let gravity = self.context.gravity * input.gravity_scale;
        let constants = &self.shared.constants;
        let (dry_mass, displaced) = (constants.dry.mass, constants.displaced_mass);
        let arm = attitude * to_real(constants.buoyancy_arm);
        let mut start = HeldStart {
            handle: input.handle,
            state: input.state,
            attitude,
            linear,
            angular,
            expected_change: (force / input.solver_mass + gravity) * self.context.dt,
            expected_turn: Vector::ZERO,
            expected: self.expected,
            own_linear: output.motion.linear,
            own_angular: output.motion.angular * self.shared.step.inertia.per_length,
            fluid_velocity: flight.fluid_velocity,
            locks: input.locks,
            system: input.system,
            flies: input.free,
            load_force: self.user_force + gravity * (dry_mass - displaced) as f32,
            load_torque: self.user_torque + arm.cross(gravity * -displaced as f32),
            steady: self.steady,
            learns_turn: input.locks.is_empty(),
            linked: input.linked,
        };
        if let Some(load) = &self.at_surface {
            (start.load_force, start.load_torque) = (load.force, load.torque);
        }
        if input.free {
            start.expected_change = vector(output.end_linear) - start.linear;
            start.expected_turn = vector(output.end_angular) - start.angular;
        }
        start
    }

    /// The force and the torque to hand over. `force` and `torque` are those that lead to the velocities
    /// that were integrated.
    #[inline(never)]
    fn forces(
        &self,
        body: &RigidBody,
        flight: &mut FlightState,
        start: &mut HeldStart,
        force: Vector,
        torque: Vector,
    ) -> (Vector, Vector) {
        let (input, shared, context) = (self.input, self.shared, self.context);
        let dt = context.dt;
        let gravity = context.gravity * input.gravity_scale;
        let (linear, angular, attitude) = (start.linear, start.angular, start.attitude);
        let (mut force, mut torque) = (force, torque);
        if input.linked {
            // Rapier adds the gyroscopic torque of links by itself.
            let end = Rotation::from_array(self.output.motion.attitude) * shared.axes.inverse();
            let change = held_motion::turned(shared, end, vector(self.output.end_angular))
                - held_motion::turned(shared, attitude, angular);
            torque = change / dt;
            let end = vector(self.output.end_angular);
            start.expected_turn = end - angular;
            start.learns_turn &= start.angular.length().max(end.length()) * dt < STEADY_LINK;
            (force, torque) = self.tamed(start, force, torque);
        } else if !input.in_contact || !input.locks.is_empty() {
            let plate = Rotation::from_array(input.rapier_attitude);
            let substeps = context.substeps_of(input);
            let guess = vector(self.output.end_angular);
            let (end_linear, end_angular) =
                held_motion::end_velocities(shared, self.mass, plate, start, guess, substeps);
            start.expected_change = end_linear - linear;
            start.expected_turn = end_angular - angular;
            force = (start.expected_change / dt - gravity) * input.solver_mass;
            let acceleration = start.expected_turn / dt;
            torque = if input.locks.is_empty() {
                held_motion::turned(shared, attitude, acceleration)
            } else {
                let tensor = self.tensor(body, flight);
                let acceleration = to_f64(acceleration);
                to_real(locked_axes::torque_for(&tensor, input.locks, acceleration))
            };
        }
        if input.in_contact && input.system == NONE {
            // What the fluid does, as far as the mass of its own tells.
            let own = self.user_force + gravity * shared.constants.dry.mass as f32;
            let masses = &self.mass.principal;
            let change = masses.scale(attitude, start.expected_change, |mass| mass);
            flight.fluid_force = (change - self.expected.impulse) / dt - own;
        }
        force -= self.expected.impulse / dt;
        if self.expected.turn != Vector::ZERO {
            torque -= held_motion::turned(shared, attitude, self.expected.turn) / dt;
        }
        (force, torque)
    }

    /// Force and torque of a link that turns so far in a step that they are out of date within it: as much
    /// of the fluid's share as takes energy. A link's velocity cannot be set right after the step.
    fn tamed(&self, start: &HeldStart, force: Vector, torque: Vector) -> (Vector, Vector) {
        let dt = self.context.dt;
        let end = vector(self.output.end_angular);
        if start.angular.length().max(end.length()) * dt < FAST_LINK {
            return (force, torque);
        }
        let (fluid_force, fluid_torque) = (force - self.user_force, torque - self.user_torque);
        let relative = start.linear - start.fluid_velocity;
        let power = fluid_force.dot(relative) + fluid_torque.dot(start.angular);
        // τ·I⁻¹τ, at most.
        let inertia = &self.shared.step.scales.rapier_inertia;
        let least = inertia.m11.min(inertia.m22).min(inertia.m33);
        let pushed = fluid_force.length_squared() / self.input.solver_mass;
        let turned = fluid_torque.length_squared() / least;
        let whole = 0.5 * dt * (pushed + turned);
        let share = if whole > 0.0 {
            (-power / whole).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (
            self.user_force + fluid_force * share,
            self.user_torque + fluid_torque * share,
        )
    }

    /// Rapier's tensor of inertia, world axes.
    fn tensor(&self, body: &RigidBody, flight: &FlightState) -> Matrix3<f64> {
        let own = if flight.converts_torque {
            inertia(&body.mass_properties().local_mprops)
        } else {
            self.shared.wet(1.0).inertia
        };
        let rotation = to_quaternion(*body.rotation()).to_rotation_matrix();
        rotation.matrix() * own * rotation.matrix().transpose()
    }
}

/// After the step: gives a body's forces back to the user, and corrects its velocity if it has just met
/// something.
pub(super) fn finish(
    number: usize,
    workspace: &mut Workspace,
    constants: &ConstantsTable,
    registry: &mut Registry,
    sets: &mut RapierSets,
) {
    let Some(saved) = workspace.saved_forces.get(number) else {
        return;
    };
    if give_back(saved, &workspace.moved_by_mean, sets.bodies).is_none() {
        return;
    }
    if saved.held == NONE && !saved.touching {
        return;
    }
    let Some(state) = registry.at_mut(saved.state as usize) else {
        return;
    };
    // A user may have changed the set since the step began: the body may have gone, or have another
    // description or fluid. Its contacts are then left as rapier solved them.
    if state.handle != saved.handle || state.constants != saved.constants {
        return;
    }
    let Some(shared) = constants.get(state.constants) else {
        return;
    };
    let with_fluid = state.mass(shared);
    if let Some(start) = workspace.jointed.starts.get(saved.held as usize) {
        if start.linked
            && let Some((linear, angular)) = sets.link_velocities(saved.handle)
            && let Some(body) = sets.bodies.get_mut(saved.handle)
        {
            body.set_linvel(linear, false);
            body.set_angvel(angular, false);
        }
        let Some(body) = sets.bodies.get_mut(saved.handle) else {
            return;
        };
        let dt = sets.integration_parameters.dt;
        let flight = &mut state.flight;
        let touched = contact_mass::is_touched(body, sets.narrow_phase);
        if touched {
            workspace.jointed.systems.drive(start.system);
        }
        let did = constraint_impulse::learn(&with_fluid, body, flight, start, touched, dt);
        // A body that flew the whole step has the energy that was integrated.
        if !(start.flies && did.impulse == Vector::ZERO) {
            let (_, kind) = workspace.jointed.systems.system(start.system);
            let end = energy_budget::measure(
                (shared, &with_fluid),
                body,
                start,
                saved.held,
                &did,
                kind.driven,
                dt,
            );
            workspace.jointed.ends.push(end);
        }
    }
    if !saved.touching || state.flight.corrected_contacts >= IMPACT {
        return;
    }
    let Some(body) = sets.bodies.get_mut(saved.handle) else {
        return;
    };
    let mass = state.flight.solver_mass.into();
    if let Some((linear, angular)) =
        contact_mass::correction(shared, &with_fluid, body, sets.narrow_phase, mass)
        && (linear + angular).is_finite()
    {
        state.flight.corrected_contacts += 1;
        body.set_linvel(body.linvel() + linear, false);
        body.set_angvel(body.angvel() + angular, false);
    }
}

/// Gives a body's forces back to the user, and its velocity at the end of the step to one that was moved by its
/// mean velocity. `None` if it has gone.
pub(super) fn give_back(
    saved: &SavedForces,
    moved_by_mean: &[MeanMotion],
    bodies: &mut RigidBodySet,
) -> Option<()> {
    let body = bodies.get_mut(saved.handle)?;
    replace_forces(body, saved.force, saved.torque);
    if let Some(motion) = moved_by_mean.get(saved.mean_motion as usize) {
        motion.finish(body);
    }
    Some(())
}

fn replace_forces(body: &mut RigidBody, force: Vector, torque: Vector) {
    body.reset_forces(false);
    body.reset_torques(false);
    body.add_force(force, false);
    body.add_torque(torque, false);
}
