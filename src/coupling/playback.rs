//! Control of single bodies: factors on the law's forces, set by hand or replayed from a codebook.

use super::immersion::Immersion;
use super::slot::Slot;
use crate::motion::ControlSeries;
use rapier3d::dynamics::RigidBodyHandle;

/// What a contact does to a series that is being replayed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum OnContact {
    /// While the body touches something or sleeps it is under its own law; when it flies again, the
    /// pattern that was interrupted begins anew.
    #[default]
    Restart,
    /// The body goes on under its own law for good.
    Stop,
    /// The series goes on as if nothing had happened.
    Ignore,
}

/// What a body replays.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct Player {
    /// Index of the series.
    series: u32,
    on_contact: OnContact,
    /// Seconds since its beginning.
    clock: f64,
}

impl Slot {
    /// Sets the control of a body that replays a series for a step of `dt`, and moves its clock on.
    #[inline]
    pub fn replay(&mut self, touching: bool, series: &[Option<ControlSeries>], dt: f64) {
        let Some(player) = &mut self.player else {
            return;
        };
        let Some(series) = &series[player.series as usize] else {
            return;
        };
        if touching && player.on_contact != OnContact::Ignore {
            self.control = [1.0; 3];
            if player.on_contact == OnContact::Stop {
                self.player = None;
            } else {
                player.clock = series.dwell_start(player.clock);
            }
        } else {
            self.control = series.at(player.clock);
            player.clock += dt;
        }
    }
}

impl Immersion {
    /// Multiplies the drag, rotational lift and translational lift of a body's law, from the next step
    /// on (default 1, 1, 1): the control parameters c̃ of the pattern-driven method, as
    /// [`FreeBody::control`](crate::FreeBody::control). A series that the body replays is stopped.
    ///
    /// Unknown handles, and factors that are not finite or have a negative drag, are ignored.
    pub fn set_control(&mut self, handle: RigidBodyHandle, control: [f32; 3]) {
        let valid = control.iter().all(|c| c.is_finite()) && control[0] >= 0.0;
        if let Some(slot) = self.slot_mut(handle).filter(|_| valid) {
            slot.player = None;
            slot.control = control;
        }
    }

    /// Lets a body replay a series from its beginning, at the next step; after its last entry that one
    /// stays. The body must be under the law that the series was planned for
    /// ([`Codebook::law`](crate::motion::Codebook)). A body that is held by a joint counts as touching:
    /// its series begins when it breaks loose. Unknown handles are ignored.
    pub fn play(&mut self, handle: RigidBodyHandle, series: &ControlSeries, on_contact: OnContact) {
        let Some(index) = self.slot_index(handle) else {
            return;
        };
        let series = self.series_index(series);
        if let Some(slot) = &mut self.slots[index] {
            slot.player = Some(Player {
                series,
                on_contact,
                clock: 0.0,
            });
        }
    }

    /// Stops the series that a body replays: it goes on under its own law. Nothing to stop is no error.
    pub fn stop(&mut self, handle: RigidBodyHandle) {
        if let Some(slot) = self.slot_mut(handle)
            && slot.player.take().is_some()
        {
            slot.control = [1.0; 3];
        }
    }

    /// The factors on a body's drag, rotational lift and translational lift in the last step.
    pub fn control(&self, handle: RigidBodyHandle) -> Option<[f32; 3]> {
        self.slot(handle).map(|slot| slot.control)
    }

    /// How far a body has come in the series that it replays, s; `None` if it replays none.
    pub fn playing_at(&self, handle: RigidBodyHandle) -> Option<f64> {
        self.slot(handle)?.player.map(|player| player.clock)
    }

    /// Where a series is kept, equal ones once. When their number has doubled, those that no body
    /// replays any more make room.
    fn series_index(&mut self, series: &ControlSeries) -> u32 {
        let known = |kept: &Option<ControlSeries>| kept.as_ref() == Some(series);
        if let Some(index) = self.series.iter().rposition(known) {
            return index as u32;
        }
        if self.series.len() >= 16 && self.series.len().is_power_of_two() {
            let mut used = vec![false; self.series.len()];
            for player in self.slots.iter().flatten().filter_map(|slot| slot.player) {
                used[player.series as usize] = true;
            }
            for (kept, used) in self.series.iter_mut().zip(used) {
                if !used {
                    *kept = None;
                }
            }
        }
        let index = match self.series.iter().position(Option::is_none) {
            Some(index) => index,
            None => {
                self.series.push(None);
                self.series.len() - 1
            }
        };
        self.series[index] = Some(series.clone());
        index as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{Dwell, Pattern};
    use crate::{Fluid, HydroProperties};
    use rapier3d::prelude::*;

    fn world(height: Real) -> (PhysicsWorld, RigidBodyHandle, Immersion) {
        let mut world = PhysicsWorld::new();
        let (leaf, _) = world.insert(
            RigidBodyBuilder::dynamic()
                .translation(Vector::Y * height)
                .rotation(Vector::X * 0.3),
            ColliderBuilder::cuboid(0.0365, 0.00015, 0.021).density(400.0),
        );
        world.insert(
            RigidBodyBuilder::fixed(),
            ColliderBuilder::cuboid(10.0, 0.1, 10.0).translation(Vector::Y * -0.1),
        );
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, leaf).unwrap();
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.insert(leaf, hydro);
        (world, leaf, immersion)
    }

    fn series() -> ControlSeries {
        let dwells = [0, 10].map(|from| Dwell {
            pattern: Pattern::Zigzag,
            from,
        });
        let controls = (0..20).map(|i| [1.0 + i as f32, 0.5, 0.5]).collect();
        ControlSeries::new(1.0 / 60.0, controls, dwells.to_vec()).unwrap()
    }

    /// Drag makes a leaf fall more slowly, ones change nothing, and nonsense is not taken.
    #[test]
    fn factors_act() {
        let fall = |control: Option<[f32; 3]>| {
            let (mut world, leaf, mut immersion) = world(9.0);
            if let Some(control) = control {
                immersion.set_control(leaf, control);
            }
            (0..60).for_each(|_| immersion.step(&mut world));
            world.bodies[leaf].translation()
        };
        let plain = fall(None);
        assert_eq!(fall(Some([1.0; 3])), plain);
        assert_eq!(fall(Some([f32::NAN, 1.0, 1.0])), plain);
        assert_eq!(fall(Some([-1.0, 1.0, 1.0])), plain);
        assert!(fall(Some([4.0, 0.0, 0.0])).y > plain.y + 0.1);
    }

    #[test]
    fn a_series_is_replayed_step_by_step() {
        let (mut world, leaf, mut immersion) = world(9.0);
        immersion.play(leaf, &series(), OnContact::Restart);
        for step in 0..25 {
            immersion.step(&mut world);
            let expected = series().controls()[step.min(19)];
            assert_eq!(immersion.control(leaf), Some(expected), "{step}");
        }
        immersion.stop(leaf);
        assert_eq!(immersion.control(leaf), Some([1.0; 3]));
        assert_eq!(immersion.playing_at(leaf), None);
    }

    /// On the floor the law is the body's own; thrown up again, the pattern begins anew.
    #[test]
    fn contact_interrupts() {
        for on_contact in [OnContact::Restart, OnContact::Stop, OnContact::Ignore] {
            let (mut world, leaf, mut immersion) = world(0.12);
            immersion.play(leaf, &series(), on_contact);
            for _ in 0..180 {
                immersion.step(&mut world);
            }
            let resting = immersion.control(leaf);
            world.bodies[leaf].set_linvel(Vector::Y * 4.0, true);
            for _ in 0..12 {
                immersion.step(&mut world);
            }
            let flying = immersion.control(leaf).unwrap()[0];
            match on_contact {
                OnContact::Restart => {
                    assert_eq!(resting, Some([1.0; 3]));
                    assert!(
                        flying > 1.0 && immersion.playing_at(leaf) < Some(0.4),
                        "{flying}"
                    );
                }
                OnContact::Stop => {
                    assert_eq!((resting, flying), (Some([1.0; 3]), 1.0));
                    assert_eq!(immersion.playing_at(leaf), None);
                }
                OnContact::Ignore => assert_eq!(resting.unwrap()[0], 20.0),
            }
        }
    }

    #[test]
    fn players_of_removed_bodies_are_forgotten() {
        let (mut world, leaf, mut immersion) = world(9.0);
        immersion.play(leaf, &series(), OnContact::Restart);
        world.remove_body(leaf);
        for _ in 0..40 {
            immersion.step(&mut world);
        }
        assert_eq!(immersion.playing_at(leaf), None);
        immersion.play(leaf, &series(), OnContact::Restart);
        assert_eq!(immersion.playing_at(leaf), None);
    }

    #[cfg(feature = "serde-serialize")]
    #[test]
    fn a_snapshot_goes_on_playing() {
        let (mut world, leaf, mut immersion) = world(9.0);
        immersion.play(leaf, &series(), OnContact::Restart);
        (0..5).for_each(|_| immersion.step(&mut world));
        let bytes = postcard::to_stdvec(&immersion).unwrap();
        let mut loaded: Immersion = postcard::from_bytes(&bytes).unwrap();
        assert_eq!(loaded.playing_at(leaf), immersion.playing_at(leaf));
        loaded.step(&mut world);
        assert_eq!(loaded.control(leaf), Some(series().controls()[5]));
    }

    /// Ever new series for one body do not pile up.
    #[test]
    fn series_make_room() {
        let (_, leaf, mut immersion) = world(9.0);
        for i in 0..1000 {
            let other = ControlSeries::new(1.0 + f64::from(i), vec![[1.0; 3]], Vec::new());
            immersion.play(leaf, &other.unwrap(), OnContact::Restart);
        }
        assert!(immersion.series.len() <= 32);
        let kept = immersion.slot(leaf).and_then(|slot| slot.player).unwrap();
        let kept = immersion.series[kept.series as usize].as_ref().unwrap();
        assert_eq!(kept.interval(), 1000.0);
    }
}
