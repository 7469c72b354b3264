//! Before and after rapier's step.

use super::contact;
use super::flight::{Air, Clock, Flyer, Landing, fly, vector};
use super::handover::Pace;
use super::immersion::Immersion;
use super::kind::Route;
use super::scratch::{Borrowed, Scratch};
use super::sets::RapierSets;
use super::stream::Stream;
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::pipeline::{EventHandler, PhysicsHooks, PhysicsWorld};

/// Steps of a contact that count as its impact: what the contact did is corrected in these. A velocity
/// that is set after the step is new to the solver; in a pile of leaves such corrections kept up 2 cm/s
/// forever, where without them it comes to rest below 1 mm/s.
const IMPACT: u8 = 3;

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
        self.admit(sets);
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
                let key = |handle: &RigidBodyHandle| handle.into_raw_parts();
                if newcomers.binary_search_by_key(&key(&handle), key).is_err() {
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

    /// Moves the bodies of a batch.
    pub(super) fn depart(
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
