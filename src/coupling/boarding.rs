//! Which bodies a step moves, and what it has to know of them.

use super::contact;
use super::flight::{Clock, Extra, Flyer, Integrated, row};
use super::immersion::Immersion;
use super::scratch::Scratch;
use super::sets::RapierSets;
use super::slot::NONE;
use super::stream::Stream;
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::math::{Real, Rotation, Vector};

/// Size of a batch: small enough for the bodies to be still in the cache when they are written, large
/// enough for threads to share.
const BATCH: usize = if cfg!(feature = "parallel") {
    16384
} else {
    256
};

/// Relative difference of velocities that rapier's own arithmetic in f32 can cause.
const ROUNDING: Real = 2e-6;
/// Change of the solver's mass near contacts that is worth telling rapier.
const MASS_CHANGE: Real = 0.02;

impl Immersion {
    /// Marks the bodies that meet others where these are few, so that the rest need not be asked for
    /// their pairs one by one.
    pub(super) fn find_close(&self, sets: &RapierSets, scratch: &mut Scratch) {
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
    pub(super) fn board(
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
        let held = sets.hold(body, handle);
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Fluid, HydroProperties};
    use rapier3d::prelude::*;

    /// No body that is passed over has a contact, or one ahead: plates land on a floor one after the other,
    /// in air (where only contacts count) and in water (where pairs that could meet do).
    #[test]
    fn bodies_that_are_passed_over_touch_nothing() {
        for (fluid, heavy) in [(Fluid::AIR, false), (Fluid::WATER, true)] {
            let mut world = PhysicsWorld::new();
            world.insert(
                RigidBodyBuilder::fixed(),
                ColliderBuilder::cuboid(50.0, 0.1, 50.0),
            );
            let plates: Vec<_> = (0..60)
                .map(|i| {
                    let at = Vector::new(i as Real - 30.0, 0.2 + 0.03 * i as Real, 0.0);
                    let body = RigidBodyBuilder::dynamic().translation(at);
                    let plate = ColliderBuilder::cuboid(0.1, 0.005, 0.1).density(1500.0);
                    world.insert(body, plate).0
                })
                .collect();
            let hydro =
                HydroProperties::from_body(&world.bodies, &world.colliders, plates[0]).unwrap();
            let mut immersion = Immersion::new(fluid);
            immersion.insert_all(plates.iter().copied(), hydro);
            let (mut near, mut passed, mut crowded) = (0, 0, 0);
            for _ in 0..240 {
                immersion.step(&mut world);
                let sets = RapierSets::of(&mut world);
                assert_eq!(immersion.heavy_fluid, heavy);
                let mut scratch = Scratch::default();
                immersion.find_close(&sets, &mut scratch);
                let surroundings = contact::Surroundings {
                    bodies: sets.bodies,
                    colliders: sets.colliders,
                    dt: sets.integration_parameters.dt,
                };
                for (slot, close) in immersion.slots.iter().zip(&scratch.close) {
                    let slot = slot.as_ref().unwrap();
                    let (kind, body) = (
                        &immersion.kinds[slot.kind as usize],
                        &sets.bodies[slot.handle],
                    );
                    if scratch.crowded {
                        crowded += 1;
                    } else if *close {
                        near += 1;
                    } else {
                        passed += 1;
                        let normal = contact::normal(kind, body, sets.narrow_phase, surroundings);
                        assert_eq!(normal, None);
                    }
                }
            }
            assert!(
                near > 50 && passed > 500 && crowded > 500,
                "{near} {passed} {crowded}"
            );
        }
    }
}
