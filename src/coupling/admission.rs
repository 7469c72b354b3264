//! Bodies that enter and leave the fluid, and a slow look at those that the step does not visit.

use super::body_look::{BodyChanges, body_mark};
use super::body_state::BodyState;
use super::environment::Environment;
use super::rapier_sets::RapierSets;
use super::registry::{Registry, SWEEP};
use super::saved_properties::{Difference, SavedProperties, is_immersed};
use super::shared_constants::{ConstantsTable, in_layer};
use super::surface_readout::AmongLayers;
use super::warning::{Warning, Warnings};
use crate::body::far_part::FarPart;
use crate::body::from_rapier::CoreMass;
use crate::error::Error;
use crate::math::to_real;
use rapier3d::dynamics::{RigidBody, RigidBodyHandle};
use rapier3d::math::{Real, Vector};
use std::hash::{DefaultHasher, Hash, Hasher};

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
    let (description, medium) = (state.description, &environment.medium);
    let used = || registry.used_constants();
    let found = constants.intern(description, body, &saved.dry, medium, used)?;
    if let Some(state) = registry.at_mut(index) {
        // In the layer that it was in, if the medium has that one.
        let layer = usize::from(state.layer).min(medium.layers().len() - 1);
        state.constants = in_layer(found, layer);
    }
    Ok(())
}

/// What admission looks at and changes.
pub(super) struct Admission<'a> {
    /// Whether the fluid is on.
    pub enabled: bool,
    pub changes: BodyChanges,
    pub environment: &'a Environment,
    pub registry: &'a mut Registry,
    pub constants: &'a mut ConstantsTable,
    pub warnings: &'a mut Warnings,
    /// The body that entered last, and the error of rapier's own inertia for it.
    pub last: Option<(usize, f64)>,
}

impl Admission<'_> {
    /// Lets bodies in and out after a change, and wakes sleepers when gravity has changed.
    pub fn admit(&mut self, sets: &mut RapierSets) {
        self.forget_removed(sets);
        for index in self.registry.take_waiting() {
            self.look_at_waiting(index as usize, sets);
        }
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

    /// Forgets bodies that rapier has removed, if there are fewer than before: who sleeps is not missed by
    /// the step.
    fn forget_removed(&mut self, sets: &mut RapierSets) {
        let before = std::mem::replace(&mut self.registry.rapier_bodies, sets.bodies.len());
        if sets.bodies.len() < before {
            for index in 0..self.registry.states().len() {
                self.forget_if_removed(index, sets);
            }
        }
    }

    fn forget_if_removed(&mut self, index: usize, sets: &mut RapierSets) {
        let Some(state) = &self.registry.states()[index] else {
            return;
        };
        if sets.bodies.contains(state.handle) {
            return;
        }
        if let Some(state) = self.registry.forget(index)
            && let Some(saved) = state.saved
        {
            // Its colliders may live on without it.
            saved.restore(state.handle, sets.bodies, sets.colliders);
        }
    }

    /// Looks at a body that could not be moved in the last step.
    fn look_at_waiting(&mut self, index: usize, sets: &mut RapierSets) {
        self.forget_if_removed(index, sets);
        let Some(state) = self.registry.at_mut(index) else {
            return;
        };
        if sets.bodies.get(state.handle).is_some_and(can_move) {
            let was_disabled = std::mem::take(&mut state.disabled);
            if state.saved.is_some() && !state.outdated {
                // Rapier may list it as active only after its next step.
                state.flight.continues = false;
                if let Some(memory) = &mut state.crossing {
                    // It may have been carried through the surface meanwhile.
                    memory.active = false;
                }
                state.enabling = was_disabled;
                let handle = state.handle;
                self.registry.newcomers.push(handle);
            } else if was_disabled {
                // Its colliders are enabled with rapier's next step.
                return self.registry.wait(index);
            }
        }
        self.enter_or_leave(index, sets);
    }

    /// Looks at a body that the last step moved and this one does not.
    pub fn look_at_missed(&mut self, index: usize, sets: &mut RapierSets) {
        self.forget_if_removed(index, sets);
        if let Some(state) = self.registry.at_mut(index)
            && let Some(body) = sets.bodies.get(state.handle)
            && !can_move(body)
        {
            state.disabled = !body.is_enabled();
            self.registry.wait(index);
        }
    }

    /// Lets a newly inserted or enabled body into the fluid, one whose description or fluid has changed in
    /// anew, or a disabled one out.
    pub fn enter_or_leave(&mut self, index: usize, sets: &mut RapierSets) {
        let Some(state) = self.registry.at_mut(index) else {
            return;
        };
        let handle = state.handle;
        let Some(body) = sets.bodies.get(handle) else {
            return;
        };
        if !(self.enabled && state.enabled) {
            state.refused = None;
            self.give_back(index, sets);
        } else if !can_move(body) {
            state.disabled = !body.is_enabled();
            self.registry.wait(index);
        } else if state.saved.is_some() {
            if state.outdated {
                self.enter_or_be_refused(index, handle, sets);
            }
        } else if is_immersed(body) {
            if !std::mem::replace(&mut state.warned.immersed_twice, true) {
                self.warnings.push(Warning::ImmersedTwice { body: handle });
            }
            self.registry.wait(index);
        } else if state.refused.is_none()
            || std::mem::take(&mut state.outdated)
            || state.refused != Some(body_mark(body, sets.colliders))
        {
            self.enter_or_be_refused(index, handle, sets);
        } else {
            self.registry.wait(index);
        }
    }

    fn enter_or_be_refused(
        &mut self,
        index: usize,
        handle: RigidBodyHandle,
        sets: &mut RapierSets,
    ) {
        if let Err(reason) = self.enter(index, handle, sets) {
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
        self.leave_if_changed(index, sets);
        // The error of rapier's own inertia is known only of a body that is read for the first time.
        let mut dry_error = None;
        let mut core_mass = None;
        if self
            .registry
            .at_mut(index)
            .is_some_and(|state| state.saved.is_none())
        {
            self.follow_shape(index, sets)?;
            core_mass = CoreMass::of_body(sets.bodies, sets.colliders, handle)?
                .filter(|mass| mass.missing() > REPORTED_ERROR);
            let like = self.last.and_then(|(index, error)| {
                let state = self.registry.states()[index].as_ref()?;
                Some((state.saved.as_deref()?, error))
            });
            let (saved, error) = SavedProperties::of(handle, sets.bodies, sets.colliders, like)?;
            dry_error = Some(error);
            if let Some(state) = self.registry.at_mut(index) {
                state.saved = Some(Box::new(saved));
            }
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
        let far_part = FarPart::of_body(handle, sets.bodies, sets.colliders, body);
        let last = self
            .last
            .and_then(|(last, _)| self.registry.states()[last].as_ref());
        let equal = last.filter(|last| {
            last.description == description
                && last.saved.as_ref().is_some_and(|saved| saved.dry == dry)
                && self.constants.get(last.constants).is_some()
        });
        let constants = match equal {
            Some(last) if last.handle != handle => last.constants,
            _ => {
                let medium = &self.environment.medium;
                let used = || self.registry.used_constants();
                self.constants
                    .intern(description, body, &dry, medium, used)?
            }
        };
        let place = sets.bodies.get(handle).map(RigidBody::center_of_mass);
        let layer = self.environment.layer_at(place.unwrap_or_default());
        let layered = self.environment.medium.has_surface();
        let constants = in_layer(constants, layer);
        let Some(state) = self.registry.at_mut(index) else {
            return Ok(());
        };
        let (Some(shared), Some(saved)) = (self.constants.get(constants), &mut state.saved) else {
            return Ok(());
        };
        let error = saved.immerse(shared, dry.mass, handle, sets.bodies, sets.colliders);
        let wet_error = Some(error).filter(|error| *error > CONVERTED_ERROR);
        state.left = None;
        state.refused = None;
        state.constants = constants;
        state.layer = layer as u8;
        state.crossing = layered.then(Default::default);
        state.outdated = false;
        state.described_anew = false;
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
        if let Some(far) = far_part
            && !std::mem::replace(&mut state.warned.far_part, true)
        {
            self.warnings.push(Warning::FarPart {
                body: handle,
                part: far.part,
                distance: far.distance,
                size: far.size,
            });
        }
        let known_error = dry_error.filter(|error| *error > REPORTED_ERROR);
        if let Some(relative_error) = wet_error.or(known_error)
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
        if let Some(error) = dry_error {
            self.last = Some((index, error));
        }
        self.registry.newcomers.push(handle);
        Ok(())
    }

    /// Gives a body in the medium the inertia that it has in another layer.
    pub fn change_layer(&mut self, index: usize, layer: usize, sets: &mut RapierSets) {
        let Some(state) = self.registry.at_mut(index) else {
            return;
        };
        let handle = state.handle;
        let constants = in_layer(state.constants, layer);
        let (Some(shared), Some(old), Some(saved)) = (
            self.constants.get(constants),
            self.constants.get(state.constants),
            &mut state.saved,
        ) else {
            return;
        };
        let mass = shared.constants.dry.mass;
        let error = saved.immerse(shared, mass, handle, sets.bodies, sets.colliders);
        let memory = state.crossing.get_or_insert_default();
        if !memory.active && state.flight.continues {
            // Whole in one fluid until now.
            let place = sets.bodies.get(handle).map(RigidBody::center_of_mass);
            let from = usize::from(state.layer);
            memory.enter_from(&old.constants, from, place.unwrap_or_default());
        }
        state.flight.converts_torque = error > CONVERTED_ERROR;
        state.flight.solver_mass = mass as Real;
        state.flight.continues = false;
        (state.constants, state.layer) = (constants, layer as u8);
        self.registry.newcomers.push(handle);
    }

    /// Gives a body back to rapier that is let in anew, if its user has changed it, too: it is read anew
    /// then.
    fn leave_if_changed(&mut self, index: usize, sets: &mut RapierSets) {
        let Some(state) = self.registry.at_mut(index) else {
            return;
        };
        let described_anew = state.described_anew;
        let (Some(saved), Some(body)) = (&mut state.saved, sets.bodies.get(state.handle)) else {
            return;
        };
        if self.changes == BodyChanges::Ignore
            || saved.difference(body, sets.colliders) == Difference::Nothing
        {
            return;
        }
        self.give_back(index, sets);
        if described_anew && let Some(state) = self.registry.at_mut(index) {
            state.left = None;
        }
    }

    /// Takes a body out of the fluid: gives it back to rapier as its user wants it.
    pub fn give_back(&mut self, index: usize, sets: &mut RapierSets) {
        if let Some(state) = self.registry.at_mut(index)
            && let Some(saved) = state.saved.take()
        {
            state.flight.continues = false;
            saved.restore(state.handle, sets.bodies, sets.colliders);
            state.left = Some(saved);
        }
    }

    /// Gives a body that cannot be immersed back to rapier as it was, and says why. It is tried again when
    /// it changes.
    fn refuse(
        &mut self,
        index: usize,
        handle: RigidBodyHandle,
        sets: &mut RapierSets,
        reason: &Error,
    ) {
        self.give_back(index, sets);
        self.registry.wait(index);
        let Some(state) = self.registry.at_mut(index) else {
            return;
        };
        let body = sets.bodies.get(handle);
        state.refused = body.map(|body| body_mark(body, sets.colliders));
        state.outdated = false;
        let cause = cause_bit(reason);
        if state.warned.refused & cause == 0 {
            state.warned.refused |= cause;
            self.warnings.push(Warning::Refused {
                body: handle,
                reason: reason.to_string(),
            });
        }
    }

    pub fn wake(&mut self, handle: RigidBodyHandle, sets: &mut RapierSets) {
        if let Some(body) = sets.bodies.get_mut(handle)
            && body.is_sleeping()
        {
            body.wake_up(true);
            self.registry.newcomers.push(handle);
        }
    }

    /// Looks at a part of the bodies that the step does not visit: forgets those that rapier has
    /// removed, takes over what users have changed of sleepers, and wakes them when the fluid around them
    /// has changed.
    pub fn sweep(&mut self, sets: &mut RapierSets) {
        self.registry.sweep_phase = (self.registry.sweep_phase + 1) % SWEEP;
        let phase = self.registry.sweep_phase as usize;
        for index in (phase..self.registry.states().len()).step_by(SWEEP as usize) {
            self.look_at_missed(index, sets);
            let Some(state) = &self.registry.states()[index] else {
                continue;
            };
            let handle = state.handle;
            let Some(body) = sets.bodies.get(handle) else {
                continue;
            };
            if !body.is_sleeping() {
                continue;
            }
            if let Some(saved) = &state.saved
                && !state.enabling
                && !saved.still_holds(body, sets.colliders)
            {
                self.take_over(index, sets);
                continue;
            }
            let energy = self.turbulent_energy(state, body);
            let set = state.equipment.as_ref().is_some_and(|own| own.set);
            if set || self.fluid_wakes(state, body, energy, sets.gravity) {
                if let Some(state) = self.registry.at_mut(index) {
                    state.flight.turbulent_energy = energy;
                }
                self.wake(handle, sets);
            }
        }
    }

    /// Kinetic energy of the turbulence around a body, m²/s²; zero where it is no number.
    fn turbulent_energy(&self, state: &BodyState, body: &RigidBody) -> Real {
        let layers = self.environment.medium.layers();
        let layer = layers.get(usize::from(state.layer));
        let Some(layer) = layer.and_then(|layer| layer.turbulence.as_ref()) else {
            return 0.0;
        };
        let time = self.environment.time;
        let age = time - state.flight.turbulence.since.unwrap_or(time);
        let local = layer.source.at(body.center_of_mass(), time, age);
        Some(local.kinetic_energy)
            .filter(|energy| energy.is_finite())
            .unwrap_or(0.0)
    }

    /// Whether a wave has come to a sleeping body, or left it, that changes its buoyancy by [`WAKE_SHARE`] of its weight.
    fn wave_wakes(&self, state: &BodyState, body: &RigidBody, gravity: Vector) -> bool {
        let medium = &self.environment.medium;
        if !medium.has_surface() || medium.surface().is_still() || gravity == Vector::ZERO {
            return false;
        }
        let (Some(shared), Some(among)) = (
            self.constants.get(state.constants),
            AmongLayers::of(state, self.constants, self.environment, body),
        ) else {
            return false;
        };
        let memory = state.crossing.as_ref().filter(|memory| memory.active);
        let whole = if state.layer == 0 { 0.0 } else { 1.0 };
        let before = memory.map_or(whole, |memory| memory.submerged.into());
        let now = among.hydrostatics();
        let jump = medium.layers()[1].fluid.density() - medium.layers()[0].fluid.density();
        let volume = self
            .registry
            .description(state)
            .map_or(0.0, |body| body.hydro.volume);
        let change = f64::from(jump.abs()) * volume * (now.submerged_share - before).abs();
        change > f64::from(WAKE_SHARE) * shared.constants.dry.mass
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
        let layer = usize::from(state.layer);
        let at = body.center_of_mass();
        if self.wave_wakes(state, body, gravity) {
            return true;
        }
        let mut pressure = 0.0;
        // A body at a surface feels the fluid above, too.
        if let Some(memory) = state.crossing.as_ref().filter(|memory| memory.active) {
            for above in usize::from(memory.first)..layer {
                let now = self.environment.mean_flow(above, at).velocity;
                let before = memory
                    .before(above, 0, 1)
                    .map(|(_, velocity)| to_real(velocity));
                let before: Vector = before.unwrap_or_default();
                let fluid = self.environment.medium.layers()[above].fluid;
                pressure +=
                    fluid.density() * (now - before).length() * (now.length() + before.length());
            }
        }
        let now = self.environment.mean_flow(layer, at).velocity;
        let speeds = (now - before).length() * (now.length() + before.length());
        let fluctuations = (turbulent_energy - flight.turbulent_energy).abs() * (2.0 / 3.0);
        let area = description.hydro.planform.area as Real;
        let c = &shared.constants;
        pressure += c.density as Real * (speeds + fluctuations);
        let pressure = 0.5 * area * pressure;
        let weight = (c.dry.mass - c.displaced_mass).abs() as Real * gravity.length();
        pressure > WAKE_SHARE * weight
    }
}

/// Whether rapier moves a body by forces.
fn can_move(body: &RigidBody) -> bool {
    body.is_enabled() && body.is_dynamic()
}

/// One bit for the kind of reason, so that each is told once.
fn cause_bit(reason: &Error) -> u64 {
    let mut hasher = DefaultHasher::new();
    std::mem::discriminant(reason).hash(&mut hasher);
    if let Error::InvalidParameter { parameter, .. } | Error::OutOfRange { parameter, .. } = reason
    {
        parameter.hash(&mut hasher);
    }
    1 << (hasher.finish() % 64)
}
