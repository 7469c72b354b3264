//! Bodies that enter and leave the fluid, and a slow look at those that the step does not visit.

use super::body_state::BodyState;
use super::environment::Environment;
use super::rapier_sets::RapierSets;
use super::registry::{Registry, SWEEP};
use super::saved_properties::SavedProperties;
use super::shared_constants::ConstantsTable;
use super::warning::{Warning, Warnings};
use crate::body::from_rapier::CoreMass;
use crate::error::Error;
use rapier3d::dynamics::{RigidBody, RigidBodyHandle};
use rapier3d::math::{Real, Vector};

/// A change of the fluid around a sleeping body wakes it when the pressure that it could exert, or the
/// change of the weight, is this share of the weight.
const WAKE_SHARE: Real = 0.25;
/// Relative error of rapier's inertia tensor from which on torques are converted, and the user warned.
const CONVERTED_ERROR: f64 = 1e-3;
/// Relative error of rapier's inertia tensor or mass of the dry body that a user should know.
const REPORTED_ERROR: f64 = 0.01;

/// Finds the constants of the bodies that are in the fluid and have none, as after a change of the fluid or
/// of a description: what the set knows of a body is then right at once, and rapier's body with the next
/// step. A body whose constants cannot be made is refused there.
pub(super) fn renew_constants(
    registry: &mut Registry,
    constants: &mut ConstantsTable,
    environment: &Environment,
) -> Result<(), Error> {
    let mut result = Ok(());
    for index in 0..registry.states().len() {
        if let Err(error) = renew_constants_of(index, registry, constants, environment) {
            result = Err(error);
        }
    }
    result
}

/// The same for the body at one index.
pub(super) fn renew_constants_of(
    index: usize,
    registry: &mut Registry,
    constants: &mut ConstantsTable,
    environment: &Environment,
) -> Result<(), Error> {
    let Some(state) = &registry.states()[index] else {
        return Ok(());
    };
    let (Some(saved), None) = (&state.saved, constants.get(state.constants)) else {
        return Ok(());
    };
    let Some(body) = registry.description(state) else {
        return Ok(());
    };
    let (description, fluid) = (state.description, &environment.fluid);
    let used = || registry.used_constants();
    let found = constants.intern(description, body, &saved.dry, fluid, used)?;
    if let Some(state) = registry.at_mut(index) {
        state.constants = found;
    }
    Ok(())
}

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
    /// Lets bodies in and out after a change, and wakes sleepers when gravity has changed.
    pub fn admit(&mut self, sets: &mut RapierSets) {
        if std::mem::take(&mut self.registry.changed) {
            for index in 0..self.registry.states().len() {
                self.enter_or_leave(index, sets);
            }
        }
        let old = self.environment.gravity;
        if (sets.gravity - old).length() > WAKE_SHARE * old.length() && self.environment.steps > 0 {
            let handles: Vec<_> = self.registry.iter_mut().map(|state| state.handle).collect();
            for handle in handles {
                self.wake(handle, sets);
            }
        }
    }

    /// Lets a newly inserted or enabled body into the fluid, one whose description or fluid has changed in
    /// anew, or a disabled one out.
    fn enter_or_leave(&mut self, index: usize, sets: &mut RapierSets) {
        let Some(state) = self.registry.at_mut(index) else {
            return;
        };
        let wanted = self.enabled && state.enabled;
        if wanted == state.saved.is_some() && (!wanted || !state.outdated) {
            return;
        }
        let handle = state.handle;
        if !wanted {
            if let Some(saved) = state.saved.take() {
                state.flight.continues = false;
                saved.restore(handle, sets.bodies, sets.colliders);
            }
        } else if sets.bodies.get(handle).is_some_and(RigidBody::is_dynamic)
            && let Err(reason) = self.enter(index, handle, sets)
        {
            self.refuse(index, handle, sets, &reason);
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
        // The error of rapier's own inertia is known only of a body that is read for the first time.
        let mut dry_error = None;
        let mut core_mass = None;
        if state.saved.is_none() {
            core_mass = CoreMass::of_body(sets.bodies, sets.colliders, handle)?
                .filter(|mass| mass.missing() > REPORTED_ERROR);
            let (saved, error) = SavedProperties::of(handle, sets.bodies, sets.colliders)?;
            state.saved = Some(Box::new(saved));
            dry_error = Some(error).filter(|error| *error > REPORTED_ERROR);
        } else {
            // A body that sleeps in another fluid, or as another shape, may not rest there.
            self.wake(handle, sets);
        }
        let Some(state) = &self.registry.states()[index] else {
            return Ok(());
        };
        let (Some(saved), Some(body)) = (&state.saved, self.registry.description(state)) else {
            return Ok(());
        };
        let (dry, description) = (saved.dry, state.description);
        let fluid = &self.environment.fluid;
        let used = || self.registry.used_constants();
        let constants = self
            .constants
            .intern(description, body, &dry, fluid, used)?;
        let Some(shared) = self.constants.get(constants) else {
            return Ok(());
        };
        let error = saved.immerse(shared, dry.mass, handle, sets.bodies, sets.colliders);
        let wet_error = Some(error).filter(|error| *error > CONVERTED_ERROR);
        self.registry.newcomers.push(handle);
        let Some(state) = self.registry.at_mut(index) else {
            return Ok(());
        };
        state.constants = constants;
        state.outdated = false;
        // What was integrated belonged to other constants; rapier's velocities are what is left of it.
        state.flight.continues = false;
        state.flight.corrected_contacts = 0;
        state.flight.solver_mass = dry.mass as Real;
        state.flight.converts_torque = wet_error.is_some();
        if let Some(mass) = core_mass
            && !std::mem::replace(&mut state.warned.core_mass, true)
        {
            self.warnings.push(Warning::CoreMass {
                body: handle,
                rapier_mass: mass.rapier,
                whole_mass: mass.whole,
            });
        }
        if let Some(relative_error) = wet_error.or(dry_error)
            && !std::mem::replace(&mut state.warned.inertia, true)
        {
            self.warnings.push(if wet_error.is_some() {
                Warning::OddInertia {
                    body: handle,
                    relative_error,
                }
            } else {
                Warning::WrongInertia {
                    body: handle,
                    relative_error,
                }
            });
        }
        Ok(())
    }

    /// Gives a body that cannot be immersed back to rapier as it was, and says why.
    fn refuse(
        &mut self,
        index: usize,
        handle: RigidBodyHandle,
        sets: &mut RapierSets,
        reason: &Error,
    ) {
        let Some(state) = self.registry.at_mut(index) else {
            return;
        };
        state.enabled = false;
        if let Some(saved) = state.saved.take() {
            state.flight.continues = false;
            saved.restore(handle, sets.bodies, sets.colliders);
        }
        if !std::mem::replace(&mut state.warned.refused, true) {
            self.warnings.push(Warning::Refused {
                body: handle,
                reason: reason.to_string(),
            });
        }
    }

    fn wake(&mut self, handle: RigidBodyHandle, sets: &mut RapierSets) {
        if let Some(body) = sets.bodies.get_mut(handle)
            && body.is_sleeping()
        {
            body.wake_up(true);
            self.registry.newcomers.push(handle);
        }
    }

    /// Looks at a part of the bodies that the step does not visit: forgets those that rapier has
    /// removed, and wakes sleepers around which the fluid has changed.
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
            let Some(body) = sets.bodies.get(handle) else {
                self.registry.forget(index);
                continue;
            };
            if !body.is_sleeping() {
                continue;
            }
            let energy = self.turbulent_energy(state, body);
            if self.fluid_wakes(state, body, energy, sets.gravity) {
                if let Some(state) = self.registry.at_mut(index) {
                    state.flight.turbulent_energy = energy;
                }
                self.wake(handle, sets);
            }
        }
    }

    /// Kinetic energy of the turbulence around a body, m²/s²; zero where it is no number.
    fn turbulent_energy(&self, state: &BodyState, body: &RigidBody) -> Real {
        let Some(layer) = &self.environment.turbulence else {
            return 0.0;
        };
        let time = self.environment.time;
        let age = time - state.flight.turbulence.since.unwrap_or(time);
        let local = layer.source.at(body.center_of_mass(), time, age);
        Some(local.kinetic_energy)
            .filter(|energy| energy.is_finite())
            .unwrap_or(0.0)
    }

    /// Whether the fluid around a sleeping body has changed enough to move it: by the pressure
    /// ½ρA |ΔU| (|U| + |U'|) of the mean flow, which is that of a wind that turns, too, and by ½ρA ⅔k of
    /// the turbulence.
    fn fluid_wakes(
        &self,
        state: &BodyState,
        body: &RigidBody,
        turbulent_energy: Real,
        gravity: Vector,
    ) -> bool {
        let flight = &state.flight;
        let before = flight.fluid_velocity - flight.turbulence.fluctuation;
        let (Some(shared), Some(description)) = (
            self.constants.get(state.constants),
            self.registry.description(state),
        ) else {
            return false;
        };
        let now = self.environment.mean_flow(body.center_of_mass()).velocity;
        let speeds = (now - before).length() * (now.length() + before.length());
        let fluctuations = (turbulent_energy - flight.turbulent_energy).abs() * (2.0 / 3.0);
        let area = description.hydro.planform.area as Real;
        let pressure = 0.5 * self.environment.fluid.density() * area * (speeds + fluctuations);
        let c = &shared.constants;
        let weight = (c.dry.mass - c.displaced_mass).abs() as Real * gravity.length();
        pressure > WAKE_SHARE * weight
    }
}
