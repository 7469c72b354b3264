//! Bodies that enter and leave the fluid, and a slow look at those that the step does not visit.

use super::immersion::Immersion;
use super::original::Original;
use super::sets::RapierSets;
use super::slot::NONE;
use super::warning::Warning;
use rapier3d::dynamics::{RigidBody, RigidBodyHandle};
use rapier3d::math::{Real, Vector};

/// Sleeping and stale slots are looked at once in this many steps.
const SWEEP: u32 = 16;
/// A gust wakes a body when the pressure it could exert changes by this share of the weight.
const WAKE_SHARE: Real = 0.25;

impl Immersion {
    /// Lets bodies in and out after a change.
    pub(super) fn admit(&mut self, sets: &mut RapierSets) {
        if std::mem::take(&mut self.changed) {
            for index in 0..self.slots.len() {
                self.enter_or_leave(index, sets);
            }
        }
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
    pub(super) fn sweep(&mut self, sets: &mut RapierSets) {
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
}
