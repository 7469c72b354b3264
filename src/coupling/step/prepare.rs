//! The first stage: which bodies a step moves, and what it has to know of them.

use super::contact_mass::CloseBodies;
use super::crossing;
use super::jointed_systems::JointedSystems;
use super::stage_data::{
    CrossingBody, Disturbance, JointAction, PartRow, SeenFlow, StepContext, StepInput,
};
use super::workspace::{Batch, Bin};
use super::{constraint_impulse, contact_mass, friction, held_motion};
use crate::coupling::body_state::{BodyState, FlightState, IntegratorState, NONE};
use crate::coupling::control::SeriesTable;
use crate::coupling::environment::Environment;
use crate::coupling::equipment::{Equipment, PartState};
use crate::coupling::rapier_sets::RapierSets;
use crate::coupling::registry::Registry;
use crate::coupling::shared_constants::{ConstantsTable, Route, SharedConstants, layer_of};
use crate::dynamics::crossing::CrossingConstants;
use crate::math;
use crate::math::{row, to_real};
use rapier3d::dynamics::{LockedAxes, RigidBody, RigidBodyHandle};
use rapier3d::math::{Real, Rotation, Vector};
use rapier3d::na::Vector3;

/// Relative difference of velocities that rapier's own arithmetic in f32 can cause.
const ROUNDING: Real = 2e-6;
/// Change of the solver's mass near contacts that is worth telling rapier.
const MASS_CHANGE: Real = 0.02;
/// The same for jointed bodies, whose joints are counted on from step to step: the mass decides only how fast
/// that settles.
const JOINTED_MASS_CHANGE: Real = 0.1;

/// Share of its smallest semi-axis that a body may be off the place where it was going, besides the way that it goes in
/// a step, if its user has not put it there; the share of that up to which its energy is as it was; and the rounding of
/// places.
const MOVED: Real = 0.1;
const SAME_PLACE: Real = 0.05;
const PLACE_ROUNDING: Real = 1e-6;

/// Step below which a body is moved by a force alone, s. Its pose is off by an eighth of `Δv dt` then, but a
/// mean velocity found from a pose would be off by the rounding of the attitude, 10⁻⁷/dt.
const SHORT: Real = 1e-5;

/// What preparation reads, and where it puts bodies.
pub(super) struct Preparation<'a> {
    pub environment: &'a Environment,
    pub constants: &'a ConstantsTable,
    pub series: &'a SeriesTable,
    pub close: &'a CloseBodies,
    pub context: &'a StepContext,
    pub registry: &'a mut Registry,
    pub moved: &'a mut [u8],
    pub changed: &'a mut Vec<u32>,
    pub sunk: &'a mut Vec<(u32, usize)>,
    pub batches: &'a mut [Batch],
    pub systems: &'a mut JointedSystems,
}

/// Puts an awake body into the batch of its route, if it is immersed; one that its user has changed is set
/// aside.
#[inline(never)]
pub(super) fn prepare(
    handle: RigidBodyHandle,
    sets: &RapierSets,
    to: &mut Preparation,
) -> Option<Bin> {
    let index = to.registry.index(handle)?;
    let body = sets.bodies.get(handle)?;
    if !body.is_dynamic() || body.is_sleeping() || !body.is_enabled() {
        return None;
    }
    let joints = if to.context.joints {
        to.systems.get(index)
    } else {
        None
    };
    let state = to.registry.at_mut(index)?;
    let enabling = std::mem::take(&mut state.enabling);
    let saved = state.saved.as_deref()?;
    if !enabling && !saved.still_holds(body, sets.colliders) {
        to.changed.push(index as u32);
        return None;
    }
    let layers = crossing::layers_of(to.environment, to.constants, state, body, to.context.dt);
    if layers.last != layer_of(state.constants) {
        to.sunk.push((index as u32, layers.last));
        return None;
    }
    let shared = to.constants.get(state.constants)?;
    let normal = if to.close.contains(index) {
        contact_mass::normal(shared, body, sets)
    } else {
        None
    };
    let jointed = joints.is_some();
    let locks = body.locked_axes();
    let touching = normal.is_some() || jointed || locks != LockedAxes::empty();
    let dt = to.context.dt;
    state.control.advance(touching, to.series, dt.into());
    // What flies freely needs none.
    let mass = touching.then(|| state.mass(shared));
    let mass = mass.as_deref().unwrap_or(&shared.mass);
    let flight = &mut state.flight;
    if !touching {
        if flight.constraint_time > 0.0 || flight.contact_steps > 0 {
            flight.let_go();
        }
    } else if normal.is_some() {
        flight.contact_steps = flight.contact_steps.saturating_add(1);
    } else {
        flight.contact_steps = 0;
    }
    let wanted_mass = match normal {
        Some(normal) => contact_mass::mass_along(mass, body, normal) as Real,
        None if jointed => {
            constraint_impulse::joint_mass(mass, body, flight.constraint_impulse) as Real
        }
        None => shared.constants.dry.mass as Real,
    };
    let change = if jointed {
        JOINTED_MASS_CHANGE
    } else {
        MASS_CHANGE
    };
    let new_mass = (wanted_mass - flight.solver_mass).abs() > change * wanted_mass;
    let solver_mass = if new_mass {
        wanted_mass
    } else {
        flight.solver_mass
    };
    // What hangs on a slack rope flies.
    let linked = jointed && sets.link(handle);
    let slack = jointed
        && !linked
        && normal.is_none()
        && locks.is_empty()
        && constraint_impulse::is_slack(shared, body, flight);
    // Locks alone are obeyed by the integrator.
    let long = dt >= SHORT;
    let locked = long && !locks.is_empty() && !jointed && normal.is_none();
    let free = (long && (!touching || slack)) || locked;
    if let Some(joints) = joints
        && (normal.is_some() || moves_along(locks, body))
    {
        to.systems.drive(joints.number);
    }

    let rapier_attitude = *body.rotation() * shared.axes;
    let continues = free && !locked && continues(flight, body, rapier_attitude);
    let (linear, angular) = if linked {
        // What a user has set is not what rapier's multibody moves by.
        sets.link_velocities(handle)?
    } else {
        (body.linvel(), body.angvel())
    };
    let (mut force, mut torque) = (body.user_force(), body.user_torque());
    if let Some(equipment) = &mut state.equipment {
        let gravity = to.context.gravity * body.gravity_scale();
        let density_at = |point| {
            to.environment
                .density_at(point)
                .unwrap_or(shared.constants.density)
        };
        equipment.act(shared, body, flight.fluid_velocity, gravity, density_at, dt);
        let own = equipment.action();
        force += own.force;
        torque += own.torque;
    }
    let (change_linear, change_angular) = if continues {
        (
            beyond_rounding(linear, flight.end_linear),
            beyond_rounding(angular, flight.end_angular),
        )
    } else {
        flight.motion = IntegratorState::at(rapier_attitude);
        (linear, angular)
    };
    let expected = match normal {
        // Where something is touched as well, what the joints did cannot be told from what that did.
        Some(_) if jointed => {
            flight.forget_joints();
            JointAction::default()
        }
        _ if joints.is_some_and(|joints| joints.unresolved) => JointAction::default(),
        _ if jointed => {
            let mut expected = constraint_impulse::of_step(flight, angular, dt);
            if joints.is_some_and(|joints| joints.motorised) {
                expected.turn = Vector::ZERO;
            }
            expected
        }
        Some(normal) => {
            let masses = &mass.principal;
            let impulse = friction::expected(
                shared,
                masses,
                body,
                flight,
                force,
                (normal, solver_mass),
                sets,
            );
            flight.constraint_impulse = impulse;
            flight.constraint_time = dt;
            JointAction {
                impulse,
                ..JointAction::default()
            }
        }
        None => JointAction::default(),
    };
    let moment = if expected.turn == Vector::ZERO {
        torque
    } else {
        torque + held_motion::turned(shared, *body.rotation(), expected.turn) / dt
    };
    let undisturbed =
        continues && [change_linear, change_angular, force, torque] == [Vector::ZERO; 4];

    if let Some(moved) = to.moved.get_mut(index) {
        *moved = 1;
    }
    let layer = layers.last;
    let route = if layers.cut {
        Route::CROSSING
    } else {
        shared.route
    };
    let bin = Bin { layer, route };
    let batch = to.batches.get_mut(bin.index())?;
    let disturbance = if undisturbed {
        NONE
    } else {
        batch.disturbances.push(Disturbance {
            linear: row(change_linear),
            angular: row(change_angular),
            force: row(force + expected.impulse / dt),
            torque: row(moment),
            expected,
        });
        batch.disturbances.len() as u32 - 1
    };
    let medium = &to.environment.medium;
    let moves = if layers.cut {
        !medium.is_still()
    } else {
        medium.moves(layer)
    };
    let own_layer = medium.layers().get(layer);
    let turbulent = own_layer.is_some_and(|own| own.turbulence.is_some());
    if moves {
        batch.points.push(body.center_of_mass());
        batch.flows.push(SeenFlow::before(flight));
    }
    if turbulent {
        batch.turbulence.push(flight.turbulence);
    }
    let first_part = batch.parts.len() as u32;
    let mut may_sleep = touching;
    if layers.cut {
        let crossing = to.constants.crossing(state.constants)?;
        let mut memory = state.crossing.take().unwrap_or_default();
        if !memory.active && state.flight.continues {
            memory.enter_from(&shared.constants, layer, body.center_of_mass());
        }
        may_sleep = memory.slow && (touching || (medium.is_still() && memory.balanced));
        let center = body.center_of_mass();
        let off = (center - memory.place).length();
        let thinnest = crossing.semi_axes.min() as Real;
        let rounding = PLACE_ROUNDING * center.length();
        // What has put a body elsewhere than where it was going has not pushed it there through the surface.
        let way = MOVED * thinnest + linear.length() * dt;
        let moved_there = touching || off <= way + rounding;
        let undisturbed = undisturbed && off <= SAME_PLACE * way + rounding;
        let own = CrossingBody {
            first: layers.first,
            count: layers.last + 1 - layers.first,
            rows: 0,
            center,
            known_mass: memory.active && moved_there,
            alone: undisturbed && free,
            memory: Some(memory),
            load: Default::default(),
        };
        add_crossing(own, crossing, state, rapier_attitude, moves, batch);
    } else if let Some(equipment) = &state.equipment
        && shared.route.has_parts()
    {
        add_parts(
            shared,
            equipment,
            body.center_of_mass(),
            rapier_attitude,
            [moves, turbulent],
            batch,
        );
    }
    batch.inputs.push(StepInput {
        handle,
        state: index as u32,
        constants: state.constants,
        free,
        touching,
        may_sleep,
        in_contact: normal.is_some(),
        locked,
        system: joints.map_or(NONE, |joints| joints.number),
        linked,
        locks,
        own_substeps: body.additional_solver_iterations() as u32,
        continues,
        solver_mass,
        new_mass,
        factors: state.control.factors,
        gravity_scale: body.gravity_scale(),
        disturbance,
        first_part,
        has_torque: moment != Vector::ZERO,
        rapier_attitude: rapier_attitude.to_array(),
        rapier_linear: row(linear),
        rapier_angular: row(angular),
    });
    Some(bin)
}

/// Adds the parts of a body to its batch. There are as many as its description has.
fn add_parts(
    shared: &SharedConstants,
    equipment: &Equipment,
    center: Vector,
    attitude: Rotation,
    [moves, turbulent]: [bool; 2],
    batch: &mut Batch,
) {
    let length = shared.constants.length as Real;
    let none = PartState::default();
    for (i, constants) in shared.parts.iter().enumerate() {
        let part = equipment.parts.get(i).unwrap_or(&none);
        batch.parts.push(part_row(part));
        if moves {
            let [x, y, z] = constants.place.position.into();
            batch
                .part_points
                .push(center + attitude * (Vector::new(x, y, z) * length));
        }
        if turbulent {
            batch.part_turbulence.push(part.turbulence);
        }
    }
}

/// Adds a body that is cut, with a row for each of its parts in each layer.
fn add_crossing(
    mut own: CrossingBody,
    constants: &CrossingConstants,
    state: &BodyState,
    attitude: Rotation,
    moves: bool,
    batch: &mut Batch,
) {
    let none = PartState::default();
    let parts = constants.part_count();
    own.rows = parts * own.count;
    for layer in own.first..own.first + own.count {
        for i in 0..parts {
            let equipment = state.equipment.as_ref();
            let part = equipment.and_then(|known| known.parts.get(i));
            let part = part.unwrap_or(&none);
            batch.parts.push(part_row(part));
            if moves {
                // At the middle of what was there in the last step.
                let cut = constants.parts.get(i).unwrap_or(&constants.whole);
                let memory = own.memory.as_ref();
                let before = memory.and_then(|memory| memory.before(layer, i, parts));
                let shift = before.map_or(Vector3::zeros(), |(portion, _)| portion.shift);
                let at = own.center + attitude * to_real(cut.middle + shift);
                batch.part_points.push(at);
                batch.point_layers.push(layer as u8);
            }
        }
    }
    batch.crossings.push(own);
}

/// How a part is set, in a fluid at rest.
fn part_row(part: &PartState) -> PartRow {
    let (sine, cosine) = math::sin_cos(part.deflection);
    let factors = &part.factors;
    PartRow {
        velocity: [0.0, 0.0, 0.0, sine],
        spin: [0.0, 0.0, 0.0, cosine],
        factors: [
            factors.drag,
            factors.rotational_lift,
            factors.translational_lift,
            0.0,
        ],
    }
}

/// Whether a body moves along an axis that is locked.
fn moves_along(locks: LockedAxes, body: &RigidBody) -> bool {
    let along = |velocity: Vector, bits: u8| {
        let locked = |i: u8| bits >> i & 1 == 1;
        (locked(0) && velocity.x != 0.0)
            || (locked(1) && velocity.y != 0.0)
            || (locked(2) && velocity.z != 0.0)
    };
    !locks.is_empty()
        && (along(body.linvel(), locks.bits()) || along(body.angvel(), locks.bits() >> 3))
}

/// Whether the motion that was integrated goes on: nobody has turned the body since, and nothing damps
/// it in rapier.
fn continues(flight: &FlightState, body: &RigidBody, rapier_attitude: Rotation) -> bool {
    let kept = Rotation::from_array(flight.motion.attitude);
    flight.continues
        && !flight.was_held
        && body.linear_damping() == 0.0
        && body.angular_damping() == 0.0
        && rapier_attitude.dot(kept).abs() > 1.0 - 1e-4
}

/// What rapier or a user did to a velocity comes on top of what was integrated; rounding does not.
fn beyond_rounding(now: Vector, expected: Vector) -> Vector {
    let change = now - expected;
    if change.length() > ROUNDING * expected.length() {
        change
    } else {
        Vector::ZERO
    }
}
