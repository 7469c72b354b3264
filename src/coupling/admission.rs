//! Bodies that enter and leave the fluid, and a slow look at those that the step does not visit.

use super::body_state::{BodyState, NONE};
use super::environment::Environment;
use super::rapier_sets::RapierSets;
use super::registry::Registry;
use super::saved_properties::SavedProperties;
use super::shared_constants::ConstantsTable;
use super::warning::{Warning, Warnings};
use crate::error::Error;
use rapier3d::dynamics::{RigidBody, RigidBodyHandle};
use rapier3d::math::{Real, Vector};

/// Sleeping and stale bodies are looked at once in this many steps.
const SWEEP: u32 = 16;
/// A gust wakes a body when the pressure it could exert changes by this share of the weight.
const WAKE_SHARE: Real = 0.25;
/// Relative error of rapier's inertia tensor from which on torques are converted, and the user warned.
const CONVERTED_ERROR: f64 = 1e-3;
/// Relative error of rapier's inertia tensor of the dry body that a user should know.
const REPORTED_ERROR: f64 = 0.01;

/// What admission looks at and changes.
pub(super) struct Admission<'a> {
    /// Whether the fluid is on.
    pub enabled: bool,
    pub environment: &'a Environment,
    pub registry: &'a mut Registry,
    pub constants: &'a mut ConstantsTable,
    pub warnings: &'a mut Warnings,
}

impl Admission<'_> {
    /// Lets bodies in and out after a change.
    pub fn admit(&mut self, sets: &mut RapierSets) {
        if std::mem::take(&mut self.registry.changed) {
            for index in 0..self.registry.states().len() {
                self.enter_or_leave(index, sets);
            }
        }
    }

    /// Lets a newly inserted or enabled body into the fluid, or a disabled one out.
    fn enter_or_leave(&mut self, index: usize, sets: &mut RapierSets) {
        let Some(state) = self.registry.at_mut(index) else {
            return;
        };
        let wanted = self.enabled && state.enabled;
        if wanted == state.saved.is_some() && (!wanted || state.constants != NONE) {
            return;
        }
        let handle = state.handle;
        if !wanted {
            if let Some(saved) = state.saved.take() {
                state.flight.continues = false;
                saved.restore(handle, sets.bodies, sets.colliders);
            }
        } else if sets.bodies.get(handle).is_some_and(RigidBody::is_dynamic) {
            if let Err(reason) = self.enter(index, handle, sets) {
                if let Some(state) = self.registry.at_mut(index) {
                    state.enabled = false;
                    state.saved = None;
                }
                self.warnings.push(Warning::Refused {
                    body: handle,
                    reason: reason.to_string(),
                });
            }
        }
    }

    /// Lets a body into the fluid.
    fn enter(
        &mut self,
        index: usize,
        handle: RigidBodyHandle,
        sets: &mut RapierSets,
    ) -> Result<(), Error> {
        let Some(state) = self.registry.at_mut(index) else {
            return Ok(());
        };
        let description = state.description;
        // The error of rapier's own inertia is known only of a body that is read for the first time.
        let (saved, dry_error) = match state.saved.take() {
            Some(saved) => (*saved, None),
            None => {
                let (saved, error) = SavedProperties::of(handle, sets.bodies, sets.colliders)?;
                (saved, Some(error))
            }
        };
        let loaded = dry_error.is_none() && is_loaded(state);
        let body = self.registry.description_at(description);
        let fluid = &self.environment.fluid;
        let constants = self
            .constants
            .intern(description, body, &saved.dry, fluid)?;
        let mass = saved.dry.mass;
        let mut wet_error = None;
        // After a snapshot has been loaded rapier's body is as it shall be, and setting it again would
        // change nothing.
        if !loaded {
            self.registry.newcomers.push(handle);
            let shared = self.constants.get(constants);
            let error = saved.immerse(shared, mass, handle, sets.bodies, sets.colliders);
            wet_error = Some(error).filter(|error| *error > CONVERTED_ERROR);
        }
        if let Some(state) = self.registry.at_mut(index) {
            if dry_error.is_some() || state.flight.solver_mass == 0.0 {
                state.flight.solver_mass = mass as Real;
            }
            state.constants = constants;
            state.saved = Some(Box::new(saved));
            if !loaded {
                state.flight.converts_torque = wet_error.is_some();
            }
        }
        if let Some(relative_error) = wet_error {
            self.warnings.push(Warning::OddInertia {
                body: handle,
                relative_error,
            });
        } else if let Some(relative_error) = dry_error.filter(|error| *error > REPORTED_ERROR) {
            self.warnings.push(Warning::WrongInertia {
                body: handle,
                relative_error,
            });
        }
        Ok(())
    }

    /// Looks at a part of the bodies that the step does not visit: forgets those that rapier has
    /// removed, and wakes sleepers in a gust.
    pub fn sweep(&mut self, sets: &mut RapierSets) {
        self.registry.sweep_phase = (self.registry.sweep_phase + 1) % SWEEP;
        let phase = self.registry.sweep_phase as usize;
        for index in (phase..self.registry.states().len()).step_by(SWEEP as usize) {
            // A body may have become dynamic since the last look.
            self.enter_or_leave(index, sets);
            let Some(state) = &self.registry.states()[index] else {
                continue;
            };
            let handle = state.handle;
            match sets.bodies.get(handle) {
                None => self.registry.forget(index),
                Some(body) if body.is_sleeping() && self.gust_wakes(state, body, sets.gravity) => {
                    sets.bodies[handle].wake_up(true);
                    self.registry.newcomers.push(handle);
                }
                Some(_) => {}
            }
        }
    }

    /// Whether the flow around a sleeping body has changed enough to move it.
    fn gust_wakes(&self, state: &BodyState, body: &RigidBody, gravity: Vector) -> bool {
        let Some(flow) = &self.environment.flow else {
            return false;
        };
        if state.constants == NONE {
            return false;
        }
        let now = flow.velocity(body.center_of_mass(), self.environment.time);
        let area = self.registry.description(state).hydro.planform.area as Real;
        let density = self.environment.fluid.density();
        let pressure = |v: Vector| 0.5 * density * area * v.length_squared();
        let c = &self.constants.get(state.constants).constants;
        let weight = (c.dry.mass - c.displaced_mass).abs() as Real * gravity.length();
        let change = (pressure(now) - pressure(state.flight.fluid_velocity)).abs();
        change > WAKE_SHARE * weight
    }
}

/// Whether the body was in flight when its constants were lost, as after loading a snapshot.
fn is_loaded(state: &BodyState) -> bool {
    state.constants == NONE && state.flight.continues
}
