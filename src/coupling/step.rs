//! Before and after rapier's step.

use super::contact;
use super::flight::{Air, Clock, Extra, Flyer, Integrated, Landing, fly, row, vector};
use super::handover::Pace;
use super::immersion::{Immersion, NONE, Warning};
use super::kind::Route;
use super::original::Original;
use super::stir::Stirred;
use super::stream::Stream;
use crate::flow::FlowSample;
use rapier3d::dynamics::{
    ImpulseJointSet, IntegrationParameters, IslandManager, LockedAxes, MultibodyJointSet,
    RigidBody, RigidBodyHandle, RigidBodySet,
};
use rapier3d::geometry::{ColliderSet, NarrowPhase};
use rapier3d::math::{Real, Rotation, Vector};
use rapier3d::pipeline::{EventHandler, PhysicsHooks, PhysicsWorld};

/// The parts of a rapier world that the step reads and writes, for users who hold rapier's sets
/// themselves.
pub struct RapierSets<'a> {
    /// Gravity, m/s².
    pub gravity: Vector,
    /// Time step and solver settings.
    pub integration_parameters: &'a IntegrationParameters,
    /// Which bodies are awake.
    pub islands: &'a IslandManager,
    /// Contacts.
    pub narrow_phase: &'a NarrowPhase,
    /// The bodies.
    pub bodies: &'a mut RigidBodySet,
    /// The colliders; written only when a body enters or leaves the fluid.
    pub colliders: &'a mut ColliderSet,
    /// Joints: jointed bodies are handed over like those in contact.
    pub impulse_joints: &'a ImpulseJointSet,
    /// Multibodies, likewise.
    pub multibody_joints: &'a MultibodyJointSet,
}

impl<'a> RapierSets<'a> {
    /// The parts of a [`PhysicsWorld`].
    pub fn of(world: &'a mut PhysicsWorld) -> Self {
        Self {
            gravity: world.gravity,
            integration_parameters: &world.integration_parameters,
            islands: &world.islands,
            narrow_phase: &world.narrow_phase,
            bodies: &mut world.bodies,
            colliders: &mut world.colliders,
            impulse_joints: &world.impulse_joints,
            multibody_joints: &world.multibody_joints,
        }
    }
}

/// Memory that is reused from step to step.
#[derive(Clone, Default)]
pub(super) struct Scratch {
    /// Bodies that are about to be moved, by route.
    batches: [Batch; Route::COUNT],
    landings: Vec<Landing>,
    /// Slots of bodies that are close to something, unless the world is `crowded`.
    close: Vec<bool>,
    crowded: bool,
    /// Bodies between `before_step` and `after_step`.
    borrowed: Vec<Borrowed>,
    samples: Vec<FlowSample>,
}

/// Bodies of one route that are moved together.
#[derive(Clone, Default)]
pub(super) struct Batch {
    pub flyers: Vec<Flyer>,
    pub extras: Vec<Extra>,
    /// Where the flyers are (centers of mass) and what flows past them; empty where nothing flows.
    pub points: Vec<Vector>,
    pub streams: Vec<Stream>,
    /// What the flyers remember of the turbulence; empty where there is none.
    pub stirred: Vec<Stirred>,
}

impl Batch {
    fn clear(&mut self) {
        self.flyers.clear();
        self.extras.clear();
        self.points.clear();
        self.streams.clear();
        self.stirred.clear();
    }
}

/// Size of a batch: small enough for the bodies to be still in the cache when they are written, large
/// enough for threads to share.
const BATCH: usize = if cfg!(feature = "parallel") {
    16384
} else {
    256
};

/// Sleeping and stale slots are looked at once in this many steps.
const SWEEP: u32 = 16;
/// A gust wakes a body when the pressure it could exert changes by this share of the weight.
const WAKE_SHARE: Real = 0.25;
/// Relative difference of velocities that rapier's own arithmetic in f32 can cause.
const ROUNDING: Real = 2e-6;
/// Change of the solver's mass near contacts that is worth telling rapier.
const MASS_CHANGE: Real = 0.02;

/// Steps of a contact that count as its impact: what the contact did is corrected in these. A velocity
/// that is set after the step is new to the solver; in a pile of leaves such corrections kept up 2 cm/s
/// forever, where without them it comes to rest below 1 mm/s.
const IMPACT: u8 = 3;

#[derive(Clone, Copy)]
struct Borrowed {
    handle: RigidBodyHandle,
    slot: u32,
    force: Vector,
    torque: Vector,
    touching: bool,
}

impl Immersion {
    /// Steps the world, with the immersed bodies in their fluid.
    pub fn step(&mut self, world: &mut PhysicsWorld) {
        self.step_with_events(world, &(), &());
    }

    /// Steps the world with rapier's physics hooks and event handler.
    pub fn step_with_events(
        &mut self,
        world: &mut PhysicsWorld,
        hooks: &dyn PhysicsHooks,
        events: &dyn EventHandler,
    ) {
        self.before_step(&mut RapierSets::of(world));
        world.step_with_events(hooks, events);
        self.after_step(&mut RapierSets::of(world));
    }

    /// To be called right before `PhysicsPipeline::step`, with [`Immersion::after_step`] right after
    /// it. Sets each immersed body's force, torque and velocity so that rapier's step moves it as
    /// the fluid would.
    pub fn before_step(&mut self, sets: &mut RapierSets) {
        if std::mem::take(&mut self.changed) {
            for index in 0..self.slots.len() {
                self.enter_or_leave(index, sets);
            }
        }
        self.sweep(sets);
        let dt = sets.integration_parameters.dt;
        self.gravity = sets.gravity;
        if self.enabled && dt > 0.0 {
            let mut scratch = std::mem::take(&mut self.scratch);
            scratch.borrowed.clear();
            let clock = Clock {
                dt,
                pace: Pace::new(dt, sets.integration_parameters.num_solver_iterations),
                gravity: sets.gravity,
                integrator: self.integrator,
            };
            self.find_close(sets, &mut scratch);
            // Rapier lists a body as active only once it has stepped it: newcomers go first.
            let mut newcomers = std::mem::take(&mut self.newcomers);
            newcomers.sort_unstable_by_key(|handle| handle.into_raw_parts());
            newcomers.dedup();
            for handle in &newcomers {
                self.board(*handle, sets, &mut scratch, &clock);
            }
            let islands = sets.islands;
            islands.active_bodies().for_each(|handle| {
                let key = handle.into_raw_parts();
                let new = |list: &[RigidBodyHandle]| {
                    list.binary_search_by_key(&key, |h| h.into_raw_parts())
                        .is_ok()
                };
                if newcomers.is_empty() || !new(&newcomers) {
                    self.board(handle, sets, &mut scratch, &clock);
                }
            });
            for route in Route::all() {
                self.depart(route, sets, &mut scratch, &clock);
            }
            newcomers.clear();
            self.newcomers = newcomers;
            self.scratch = scratch;
        }
    }

    /// To be called right after `PhysicsPipeline::step`: gives users' forces back and corrects the
    /// velocities of bodies in contact.
    pub fn after_step(&mut self, sets: &mut RapierSets) {
        let scratch = std::mem::take(&mut self.scratch);
        for borrowed in &scratch.borrowed {
            let Some(body) = sets.bodies.get_mut(borrowed.handle) else {
                continue;
            };
            body.reset_forces(false);
            body.reset_torques(false);
            body.add_force(borrowed.force, false);
            body.add_torque(borrowed.torque, false);
            if !borrowed.touching {
                continue;
            }
            let Some(slot) = &mut self.slots[borrowed.slot as usize] else {
                continue;
            };
            let flight = &mut slot.flight;
            if flight.contact >= IMPACT {
                continue;
            }
            let kind = &self.kinds[slot.kind as usize];
            let mass = flight.solver_mass.into();
            if let Some((linear, angular)) =
                contact::correction(kind, body, sets.narrow_phase, mass)
            {
                flight.contact += 1;
                body.set_linvel(body.linvel() + linear, false);
                body.set_angvel(body.angvel() + angular, false);
            }
        }
        if self.enabled {
            self.time += f64::from(sets.integration_parameters.dt.max(0.0));
            self.steps += 1;
        }
        self.scratch = scratch;
        self.scratch.borrowed.clear();
    }

    /// Lets a newly inserted or enabled body into the fluid, or a disabled one out.
    fn enter_or_leave(&mut self, index: usize, sets: &mut RapierSets) {
        let Some(slot) = &mut self.slots[index] else {
            return;
        };
        let wanted = self.enabled && slot.enabled;
        if wanted == slot.original.is_some() && (!wanted || slot.kind != NONE) {
            return;
        }
        let handle = slot.handle;
        if !wanted {
            if let Some(original) = slot.original.take() {
                slot.flight.flying = false;
                original.restore(handle, sets.bodies, sets.colliders);
            }
        } else if sets.bodies.get(handle).is_some_and(RigidBody::is_dynamic) {
            self.enter(index, handle, sets);
        }
    }

    fn enter(&mut self, index: usize, handle: RigidBodyHandle, sets: &mut RapierSets) {
        let Some(slot) = &mut self.slots[index] else {
            return;
        };
        let description = slot.description;
        let (original, fresh) = match slot.original.take() {
            Some(original) => (Ok(*original), None),
            None => match Original::of(handle, sets.bodies, sets.colliders) {
                Ok((original, error)) => (Ok(original), Some(error)),
                Err(error) => (Err(error), None),
            },
        };
        let entered = original.and_then(|original| {
            let kind = self.kind_of(description, &original.dry)?;
            Ok((original, kind))
        });
        match entered {
            Ok((original, kind)) => {
                let mass = original.dry.mass;
                // After loading a snapshot rapier's body is as the kind wants it already, but
                // setting it again changes nothing.
                let loaded = fresh.is_none() && self.loaded(index);
                let mut odd = None;
                if !loaded {
                    self.newcomers.push(handle);
                    let error = original.immerse(
                        &self.kinds[kind as usize],
                        mass,
                        handle,
                        sets.bodies,
                        sets.colliders,
                    );
                    odd = (error > 1e-3).then_some(error);
                }
                if let Some(slot) = &mut self.slots[index] {
                    if fresh.is_some() || slot.flight.solver_mass == 0.0 {
                        slot.flight.solver_mass = mass as Real;
                    }
                    slot.kind = kind;
                    slot.original = Some(Box::new(original));
                    if !loaded {
                        slot.flight.odd_inertia = odd.is_some();
                    }
                }
                if let Some(relative_error) = odd {
                    self.warn(Warning::OddInertia {
                        body: handle,
                        relative_error,
                    });
                } else if let Some(relative_error) = fresh.filter(|error| *error > 0.01) {
                    self.warn(Warning::WrongInertia {
                        body: handle,
                        relative_error,
                    });
                }
            }
            Err(error) => {
                if let Some(slot) = &mut self.slots[index] {
                    slot.enabled = false;
                }
                self.warn(Warning::Refused {
                    body: handle,
                    reason: error.to_string(),
                });
            }
        }
    }

    /// Whether the slot was in flight when its kind was lost, as after loading a snapshot.
    fn loaded(&self, index: usize) -> bool {
        self.slots[index]
            .as_ref()
            .is_some_and(|slot| slot.kind == NONE && slot.flight.flying)
    }

    /// Looks at a part of the bodies that the step does not visit: forgets those that rapier has
    /// removed, and wakes sleepers in a gust.
    fn sweep(&mut self, sets: &mut RapierSets) {
        self.sweep = (self.sweep + 1) % SWEEP;
        let phase = self.sweep as usize;
        for index in (phase..self.slots.len()).step_by(SWEEP as usize) {
            // A body that has become dynamic since.
            self.enter_or_leave(index, sets);
            let Some(slot) = &self.slots[index] else {
                continue;
            };
            let handle = slot.handle;
            let Some(body) = sets.bodies.get(handle) else {
                self.slots[index] = None;
                let lookup = &mut self.lookup[handle.into_raw_parts().0 as usize];
                if *lookup == index as u32 {
                    *lookup = NONE;
                    self.free.push(index as u32);
                }
                continue;
            };
            if let Some(flow) = &self.flow
                && body.is_sleeping()
                && slot.kind != NONE
            {
                let now = flow.velocity(body.center_of_mass(), self.time);
                let kind = &self.kinds[slot.kind as usize];
                let description = &self.descriptions[slot.description as usize];
                let area = description.hydro.planform.area as Real;
                let pressure = |v: Vector| 0.5 * self.fluid.density() * area * v.length_squared();
                let c = &kind.constants;
                let weight = (c.dry.mass - c.displaced_mass).abs() as Real * sets.gravity.length();
                let change = (pressure(now) - pressure(slot.flight.stream)).abs();
                if change > WAKE_SHARE * weight {
                    sets.bodies[handle].wake_up(true);
                    self.newcomers.push(handle);
                }
            }
        }
    }

    /// Marks the bodies that meet others where these are few, so that the rest need not be asked for
    /// their pairs one by one.
    fn find_close(&self, sets: &RapierSets, scratch: &mut Scratch) {
        scratch.close.clear();
        scratch.close.resize(self.slots.len(), false);
        scratch.crowded = false;
        // Pairs without a contact yet matter only to bodies that drag much fluid along.
        let mut few = sets.islands.num_active_bodies() / 4;
        for pair in sets.narrow_phase.contact_pairs() {
            if !self.heavy_fluid && !pair.has_any_active_contact() {
                continue;
            }
            if few == 0 {
                scratch.crowded = true;
                return;
            }
            few -= 1;
            for collider in [pair.collider1, pair.collider2] {
                let parent = sets.colliders.get(collider).and_then(|c| c.parent());
                if let Some(slot) = parent.and_then(|body| self.slot_index(body)) {
                    scratch.close[slot] = true;
                }
            }
        }
    }

    /// Puts an awake body on the list of those that this step moves, if it is immersed.
    fn board(
        &mut self,
        handle: RigidBodyHandle,
        sets: &mut RapierSets,
        scratch: &mut Scratch,
        clock: &Clock,
    ) {
        let Some(index) = self.slot_index(handle) else {
            return;
        };
        let (Some(slot), Some(body)) = (self.slots[index].as_mut(), sets.bodies.get(handle)) else {
            return;
        };
        if slot.original.is_none() || slot.kind == NONE || !body.is_dynamic() || body.is_sleeping()
        {
            return;
        }
        let kind = &self.kinds[slot.kind as usize];
        let surroundings = contact::Surroundings {
            bodies: sets.bodies,
            colliders: sets.colliders,
            dt: sets.integration_parameters.dt,
        };
        let close = scratch.crowded || scratch.close[index];
        let normal = if close {
            contact::normal(kind, body, sets.narrow_phase, surroundings)
        } else {
            None
        };
        let held = is_held(body, handle, sets);
        slot.replay(normal.is_some() || held, &self.series, clock.dt.into());
        let wanted = match normal {
            Some(normal) => contact::mass_along(kind, body, normal) as Real,
            None => kind.constants.dry.mass as Real,
        };
        let solver_mass = slot.flight.solver_mass;
        let new_mass = (wanted - solver_mass).abs() > MASS_CHANGE * wanted;
        // A body with substeps of its own is handed over like one in contact.
        let free = normal.is_none() && !held && body.additional_solver_iterations() == 0;

        let rapier = *body.rotation() * kind.axes;
        let flight = &mut slot.flight;
        let kept = Rotation::from_array(flight.motion.attitude);
        // The motion that was integrated goes on, unless someone turned the body since. What rapier
        // or a user did to its velocity comes on top; rounding does not.
        let goes_on = free
            && flight.flying
            && body.linear_damping() == 0.0
            && body.angular_damping() == 0.0
            && rapier.dot(kept).abs() > 1.0 - 1e-4;
        let beyond_rounding = |now: Vector, expected: Vector| {
            let change = now - expected;
            if change.length() > ROUNDING * expected.length() {
                change
            } else {
                Vector::ZERO
            }
        };
        let (linear, angular) = (body.linvel(), body.angvel());
        let (force, torque) = (body.user_force(), body.user_torque());
        let (mut plain, mut on_top) = (false, (linear, angular));
        if goes_on {
            on_top = (
                beyond_rounding(linear, flight.end_linear),
                beyond_rounding(angular, flight.end_angular),
            );
            plain = [on_top.0, on_top.1, force, torque] == [Vector::ZERO; 4];
        } else {
            flight.motion = Integrated::at(rapier);
        }
        let route = kind.route;
        let batch = &mut scratch.batches[route.index()];
        let extra = if plain {
            NONE
        } else {
            batch.extras.push(Extra {
                linear: row(on_top.0),
                angular: row(on_top.1),
                force: row(force),
                torque: row(torque),
            });
            batch.extras.len() as u32 - 1
        };
        if self.flow.is_some() || self.turbulence.is_some() {
            batch.points.push(body.center_of_mass());
            batch.streams.push(Stream::before(flight));
        }
        if self.turbulence.is_some() {
            batch.stirred.push(flight.stirred);
        }
        batch.flyers.push(Flyer {
            handle,
            slot: index as u32,
            kind: slot.kind,
            free,
            may_sleep: normal.is_some() || held,
            goes_on,
            solver_mass: if new_mass { wanted } else { solver_mass },
            new_mass,
            control: slot.control,
            gravity_scale: body.gravity_scale(),
            extra,
            turned: torque != Vector::ZERO,
            rapier_attitude: rapier.to_array(),
            rapier_linear: row(linear),
            rapier_angular: row(angular),
        });
        if batch.flyers.len() == BATCH {
            self.depart(route, sets, scratch, clock);
        }
    }

    /// Moves the bodies of a batch.
    fn depart(
        &mut self,
        route: Route,
        sets: &mut RapierSets,
        scratch: &mut Scratch,
        clock: &Clock,
    ) {
        let batch = &mut scratch.batches[route.index()];
        self.sample_fluid(batch, &mut scratch.samples, clock.dt);
        let landings = &mut scratch.landings;
        landings.resize(batch.flyers.len(), Landing::default());
        let air = Air {
            slots: &self.slots,
            kinds: &self.kinds,
            extras: &batch.extras,
            clock,
        };
        fly_all(&batch.flyers, &batch.streams, landings, route, air);
        for (i, (flyer, landing)) in batch.flyers.iter().zip(landings.iter()).enumerate() {
            if let Some(slot) = &mut self.slots[flyer.slot as usize] {
                if let Some(stream) = batch.streams.get(i) {
                    slot.flight.stream = vector(stream.velocity);
                }
                if let Some(stirred) = batch.stirred.get(i) {
                    slot.flight.stirred = *stirred;
                }
            }
            if let Some(borrowed) = self.hand_over(flyer, landing, sets) {
                scratch.borrowed.push(borrowed);
            }
        }
        batch.clear();
    }

    /// Writes what the step shall do to one body, and keeps what must be given back.
    fn hand_over(
        &mut self,
        flyer: &Flyer,
        landing: &Landing,
        sets: &mut RapierSets,
    ) -> Option<Borrowed> {
        let body = sets.bodies.get_mut(flyer.handle)?;
        let [force, torque, start_linear, start_angular] = [
            landing.push,
            landing.twist,
            landing.start_linear,
            landing.start_angular,
        ]
        .map(vector);
        if !(force + torque + start_linear + start_angular).is_finite() {
            return None;
        }
        let slot = self.slots[flyer.slot as usize].as_mut()?;
        let kind = &self.kinds[flyer.kind as usize];
        let torque = if slot.flight.odd_inertia {
            let rapier = &body.mass_properties().local_mprops;
            kind.torque_for(rapier, *body.rotation(), torque)
        } else {
            torque
        };
        let borrowed = Borrowed {
            handle: flyer.handle,
            slot: flyer.slot,
            force: body.user_force(),
            torque: body.user_torque(),
            touching: flyer.may_sleep,
        };
        if flyer.free {
            body.set_linvel(start_linear, false);
            body.set_angvel(start_angular, false);
        }
        body.reset_forces(false);
        body.reset_torques(false);
        body.add_force(force, false);
        body.add_torque(torque, false);
        if !flyer.may_sleep {
            // Drifting slowly through water is not resting.
            body.activation_mut().time_since_can_sleep = 0.0;
        }
        if flyer.new_mass
            && let Some(original) = &slot.original
        {
            let mass = flyer.solver_mass.into();
            original.set_mass(kind, mass, flyer.handle, sets.bodies, sets.colliders);
            slot.flight.solver_mass = flyer.solver_mass;
        }
        if !flyer.may_sleep {
            slot.flight.contact = 0;
        }
        slot.flight.motion = landing.motion;
        slot.flight.end_linear = vector(landing.end_linear);
        slot.flight.end_angular = vector(landing.end_angular);
        slot.flight.flying = true;
        Some(borrowed)
    }
}

fn fly_all(flyers: &[Flyer], streams: &[Stream], landings: &mut [Landing], route: Route, air: Air) {
    #[cfg(feature = "parallel")]
    {
        use rapier3d::rayon::prelude::*;
        /// Bodies per task: enough to be worth handing to another thread.
        const TASK: usize = 256;
        if flyers.len() > TASK {
            flyers
                .par_chunks(TASK)
                .zip(landings.par_chunks_mut(TASK))
                .enumerate()
                .for_each(|(number, (task, landings))| {
                    let from = number * TASK;
                    let streams = streams.get(from..from + task.len()).unwrap_or_default();
                    fly(task, streams, landings, route, air);
                });
            return;
        }
    }
    fly(flyers, streams, landings, route, air);
}

/// Whether joints or locked axes keep a body from moving freely.
fn is_held(body: &RigidBody, handle: RigidBodyHandle, sets: &RapierSets) -> bool {
    body.locked_axes() != LockedAxes::empty()
        || (!sets.impulse_joints.is_empty()
            && sets.impulse_joints.attached_joints(handle).next().is_some())
        || sets.multibody_joints.rigid_body_link(handle).is_some()
}
