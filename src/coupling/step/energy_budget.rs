//! Joints give bodies no more energy than they have.
//!
//! Rapier moves a jointed body with a scalar mass and the inertia of the step's start; body and fluid have
//! 𝕄 in axes that turn with the body. Where a step turns it far, the velocity that the solver leaves has
//! another energy ½ν·𝕄ν at the new attitude than the impulses have worked, and in thousands of steps a few
//! per mille each way become a runaway. What the energy may be is known after the step. With ν₀ before it
//! and ν₁ after it, relative to the fluid, and with the load Q (weight, buoyancy, user's force) and the
//! constraint's impulse J,
//!
//! ```text
//! ½ν₁·𝕄ν₁ ≤ ½ν₀·𝕄ν₀ + (Q dt + J)·(ν₀ + ν₁)/2
//! ```
//!
//! since drag only takes. Where the fluid changes its velocity it works, too; its work is in the motion that
//! was integrated, ν', with the impulse Ĵ that was counted on:
//!
//! ```text
//! ½ν₁·𝕄ν₁ ≤ ½ν'·𝕄ν' + J·(ν₀ + ν₁)/2 − Ĵ·(ν₀ + ν')/2
//! ```
//!
//! In rapier's own terms the work of J is exact only as long as the step does not turn the body far. Joints
//! without motors do none on the whole of a [system](super::jointed_systems) of bodies that they connect,
//! except −J·v in the frame of a fluid that moves by v, and what springs store. The sum of all that is kept
//! for each system; body by body where a motor, a contact or a body that is not in the fluid drives it, unless
//! it has links of multibodies, which share one velocity.
//!
//! A system that has more is slowed down, all velocities by the same factor, which keeps what its joints
//! demand. Errors that took energy are remembered up to 2·10⁻⁴ of it, so that those which come and go in
//! turns damp nothing; up to a quarter where a spring swings, whose energy a step of a tenth of its period
//! changes by so much within the swing.

use super::held_motion;
use super::jointed_systems::{JointedSystems, SystemKind, spring_energy};
use super::stage_data::{HeldEnd, HeldStart, JointAction};
use crate::coupling::body_mass::BodyMass;
use crate::coupling::body_state::BodyState;
use crate::coupling::rapier_sets::{RapierSets, scaled};
use crate::coupling::registry::Registry;
use crate::coupling::shared_constants::{ConstantsTable, SharedConstants};
use rapier3d::dynamics::RigidBody;
use rapier3d::math::{Real, Rotation, Vector};

/// Share of its energy that a body may get back of what was lost.
const RESERVE: Real = 2e-4;
/// The same where springs swing.
const SPRUNG_RESERVE: Real = 0.25;
/// Relative excess that is left alone: rounding.
const ROUNDING: Real = 1e-6;

/// The jointed bodies of a step.
#[derive(Clone, Default)]
pub(in crate::coupling) struct JointedBodies {
    pub starts: Vec<HeldStart>,
    pub ends: Vec<HeldEnd>,
    pub systems: JointedSystems,
    energies: Vec<SystemEnergy>,
}

impl JointedBodies {
    /// Forgets what the bodies had before the step.
    pub fn forget(&mut self) {
        self.starts.clear();
        self.ends.clear();
    }
}

/// Kinetic energy of body and fluid, J; velocities in world axes; `attitude` maps the body's frame to the world.
fn energy_at(mass: &BodyMass, attitude: Rotation, linear: Vector, angular: Vector) -> Real {
    let back = attitude.inverse();
    mass.energy(back * linear, back * angular)
}

/// What a jointed body has after the step, after what its joints `did`; `driven` says whether something drives
/// its system.
pub(super) fn measure(
    (shared, mass): (&SharedConstants, &BodyMass),
    body: &RigidBody,
    start: &HeldStart,
    number: u32,
    did: &JointAction,
    driven: bool,
    dt: Real,
) -> HeldEnd {
    let relative = body.linvel() - start.fluid_velocity;
    let before = start.linear - start.fluid_velocity;
    let mean = (before + relative) * 0.5;
    let mean_turn = (start.angular + body.angvel()) * 0.5;
    let without_joints = if start.steady {
        let loads = start.load_force.dot(mean) + start.load_torque.dot(mean_turn);
        energy_at(mass, start.attitude, before, start.angular) + loads * dt
    } else {
        let integrated = mass.energy(
            shared.axes * start.own_linear,
            shared.axes * start.own_angular,
        );
        let moment = held_motion::turned(shared, start.attitude, start.expected.turn);
        integrated
            - start
                .expected
                .impulse
                .dot(before + start.expected_change * 0.5)
            - moment.dot(start.angular + start.expected_turn * 0.5)
    };
    HeldEnd {
        start: number,
        energy: energy_at(mass, *body.rotation(), relative, body.angvel()),
        without_joints,
        work: if driven {
            let moment = held_motion::turned(shared, start.attitude, did.turn);
            did.impulse.dot(mean) + moment.dot(mean_turn)
        } else {
            -did.impulse.dot(start.fluid_velocity)
        },
    }
}

/// The sums over a system, J, and the factor by which it is slowed down.
#[derive(Clone, Copy, Debug, Default)]
struct SystemEnergy {
    energy: Real,
    allowed: Real,
    /// What springs store after the step.
    stored: Real,
    /// Parts of `energy` at rest in the fluid, and of the velocities in the world.
    at_rest: Real,
    of_world: Real,
    bodies: Real,
    reserve: Real,
    factor: Real,
}

impl SystemEnergy {
    /// Sets the energy that is left over, or the factor if there is too much. A system that hangs on
    /// something is slowed down in the frame of the world, others in that of the fluid.
    fn settle(&mut self, kind: SystemKind) {
        let share = if kind.sprung { SPRUNG_RESERVE } else { RESERVE };
        let left = self.allowed - self.energy - self.stored;
        self.factor = 1.0;
        self.reserve = 0.0;
        if !left.is_finite() {
            // What is beyond all numbers is stopped.
            self.factor = if self.energy.is_finite() { 1.0 } else { 0.0 };
            return;
        }
        self.reserve = left.clamp(0.0, share * (self.energy + self.stored));
        if left < -ROUNDING * (self.energy + self.stored) {
            let wanted = (self.energy + left).max(0.0);
            self.factor = if kind.anchored && self.at_rest > 0.0 {
                // ½(fv − U)·𝕄(fv − U) = af² − bf + c.
                let (a, c) = (self.of_world, self.at_rest);
                let b = a + c - self.energy;
                let square = b * b - 4.0 * a * (c - wanted);
                (b + square.max(0.0).sqrt()) / (2.0 * a)
            } else {
                (wanted / self.energy).sqrt()
            };
            self.factor = self.factor.clamp(0.0, 1.0);
            if self.factor.is_nan() {
                self.factor = 1.0;
            }
        }
    }
}

/// Slows the systems down that have more energy than they can have.
pub(super) fn keep(
    bodies: &mut JointedBodies,
    constants: &ConstantsTable,
    registry: &mut Registry,
    sets: &mut RapierSets,
) {
    let JointedBodies {
        starts: held,
        ends: held_ends,
        systems,
        energies,
    } = bodies;
    if held_ends.is_empty() {
        return;
    }
    energies.clear();
    energies.resize(systems.len(), SystemEnergy::default());
    for end in held_ends.iter() {
        let start = &held[end.start as usize];
        let (first, kind) = systems.system(start.system);
        let index = kind.sum_of(start.system, first);
        let Some((state, shared)) = body_of(start, registry, constants) else {
            continue;
        };
        let sum = &mut energies[index as usize];
        sum.bodies += 1.0;
        sum.energy += end.energy;
        sum.allowed += end.without_joints + end.work + state.flight.energy_reserve;
        if kind.anchored
            && start.fluid_velocity != Vector::ZERO
            && let Some(body) = sets.bodies.get(start.handle)
        {
            let attitude = *body.rotation();
            let mass = state.mass(shared);
            sum.at_rest += energy_at(&mass, attitude, start.fluid_velocity, Vector::ZERO);
            sum.of_world += energy_at(&mass, attitude, body.linvel(), body.angvel());
        }
    }
    for spring in systems.springs() {
        let (first, kind) = systems.system(spring.body);
        if !kind.driven
            && let Some(joint) = sets.impulse_joints.get(spring.joint)
        {
            let sum = &mut energies[first as usize];
            sum.allowed += spring.energy;
            sum.stored += spring_energy(joint, sets.bodies);
        }
    }
    for number in 0..systems.len() as u32 {
        let (first, kind) = systems.system(number);
        if kind.sum_of(number, first) == number {
            energies[number as usize].settle(kind);
        }
    }
    for end in held_ends.iter() {
        let start = &held[end.start as usize];
        let (first, kind) = systems.system(start.system);
        let sum = &energies[kind.sum_of(start.system, first) as usize];
        let Some((state, _)) = body_of(start, registry, constants) else {
            continue;
        };
        state.flight.energy_reserve = sum.reserve / sum.bodies;
        if sum.factor < 1.0 {
            let still = if kind.anchored {
                Vector::ZERO
            } else {
                start.fluid_velocity
            };
            slow_down(start, sum.factor, still, sets);
        }
    }
}

/// The state and the constants of a body that was held in this step.
fn body_of<'a>(
    start: &HeldStart,
    registry: &'a mut Registry,
    constants: &'a ConstantsTable,
) -> Option<(&'a mut BodyState, &'a SharedConstants)> {
    let state = registry.at_mut(start.state as usize)?;
    let shared = constants.get(state.constants)?;
    Some((state, shared))
}

/// Multiplies the velocities of a body relative to `still` by a factor.
fn slow_down(start: &HeldStart, factor: Real, still: Vector, sets: &mut RapierSets) {
    if start.linked {
        sets.slow_links_down(start.handle, factor, still);
    }
    if let Some(body) = sets.bodies.get_mut(start.handle) {
        let slower = |v: Vector| Vector::from_array(v.to_array().map(|x| scaled(x, factor)));
        body.set_linvel(still + slower(body.linvel() - still), false);
        body.set_angvel(slower(body.angvel()), false);
    }
}
