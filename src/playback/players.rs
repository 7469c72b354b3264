//! Synthesized falls played by rapier's bodies (thesis chapter 3), with collisions.

use super::player::MotionPlayer;
use super::player_state::{PlayStep, PlayerState, touches};
use crate::coupling::{Immersion, RapierSets};
use crate::error::Error;
use crate::flow::{Flow, FlowSample};
use crate::motion::path::WindResponse;
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::math::{Real, Vector};
use std::collections::HashMap;
use std::sync::Arc;

/// How many players fetch their keys together. Players are at different times of different paths, whose keys
/// rapier's step has pushed out of the cache: one by one, each would wait for its own.
const GROUP: usize = 16;

/// What a played body does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Playing {
    /// It follows its path and has come so far, in seconds since the path's beginning.
    At(Real),
    /// It touches something, or has just done so, and waits for its path to go on.
    Waiting,
}

/// The bodies of a world that play paths.
///
/// [`MotionPlayers::before_step`] goes before [`Immersion::before_step`]. The fluid does not act on a body
/// that is also immersed while it is played. Bodies that are removed from rapier are dropped.
///
/// ```
/// use rapier3d_immersed::RapierSets;
/// use rapier3d_immersed::motion::Regime;
/// use rapier3d_immersed::motion::path::{Key, MotionPath};
/// use rapier3d_immersed::playback::{MotionPlayer, MotionPlayers, Playing};
/// use rapier3d_immersed::rapier3d::prelude::*;
/// use std::sync::Arc;
///
/// // A path straight down at 1 m/s.
/// let keys = (0..=60).map(|i| Key {
///     position: Vector::Y * (-i as f32 / 60.0),
///     velocity: -Vector::Y,
///     attitude: Rotation::IDENTITY,
/// });
/// let path = MotionPath::new(1.0 / 60.0, keys.collect(), vec![(0.0, Regime::SteadyDescent)])?;
/// let player = MotionPlayer::new(Arc::new(path), Vector::Y * 2.0);
/// let mut world = PhysicsWorld::new();
/// let body = RigidBodyBuilder::dynamic().pose(player.release(Vector::ZERO));
/// let (flake, _) = world.insert(body, ColliderBuilder::ball(0.01));
/// let mut players = MotionPlayers::new();
/// players.play(flake, &player)?;
/// for _ in 0..30 {
///     players.before_step(&mut RapierSets::of(&mut world), None);
///     world.step();
/// }
/// assert!((world.bodies[flake].translation().y - 1.5).abs() < 1e-3);
/// assert!(matches!(players.playing(flake), Some(Playing::At(_))));
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
///
/// With the feature `serde-serialize` a snapshot holds all but the wind, which is set again; bodies then
/// go on bit by bit as they would have. Loading refuses another version, numbers that are not finite, and
/// references to paths that are missing.
#[derive(Clone, Default)]
pub struct MotionPlayers {
    pub(super) states: Vec<PlayerState>,
    pub(super) lookup: HashMap<RigidBodyHandle, u32>,
    wind: Option<(Arc<dyn Flow>, WindResponse)>,
    pub(super) time: f64,
    points: Vec<Vector>,
    samples: Vec<FlowSample>,
    finished: Vec<RigidBodyHandle>,
    touching: Touching,
}

/// Which players touch another body.
#[derive(Clone, Default)]
struct Touching {
    /// One entry per player, in the order of their states, unless the world is `crowded`.
    states: Vec<bool>,
    crowded: bool,
}

impl MotionPlayers {
    /// An empty set, in fluid at rest.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the wind that blows players along and leans them; `None` stands for fluid at rest.
    ///
    /// # Errors
    /// Those of [`WindResponse::check`].
    pub fn set_wind(&mut self, wind: Option<(Arc<dyn Flow>, WindResponse)>) -> Result<(), Error> {
        if let Some((_, response)) = &wind {
            response.check()?;
        }
        self.wind = wind;
        Ok(())
    }

    /// Lets a body play a path from its beginning, from the next step on; a path that it played before
    /// is dropped. Put the body at [`MotionPlayer::release`]. A body of another kind than the drive
    /// needs is left alone.
    ///
    /// # Errors
    /// Those of [`MotionPlayer::check`].
    pub fn play(&mut self, handle: RigidBodyHandle, player: &MotionPlayer) -> Result<(), Error> {
        player.check()?;
        let state = PlayerState::new(handle, player);
        match self.lookup.get(&handle) {
            Some(index) => self.states[*index as usize] = state,
            None => {
                self.lookup.insert(handle, self.states.len() as u32);
                self.states.push(state);
            }
        }
        Ok(())
    }

    /// Stops playing a body and gives it back to the force model, if it is immersed. Unknown handles are
    /// ignored.
    pub fn stop(&mut self, handle: RigidBodyHandle, immersion: Option<&mut Immersion>) {
        if self.forget(handle)
            && let Some(immersion) = immersion
        {
            immersion.set_body_enabled(handle, true);
        }
    }

    fn forget(&mut self, handle: RigidBodyHandle) -> bool {
        let Some(index) = self.lookup.remove(&handle) else {
            return false;
        };
        self.states.swap_remove(index as usize);
        if let Some(moved) = self.states.get(index as usize) {
            self.lookup.insert(moved.handle, index);
        }
        true
    }

    /// Number of bodies that are played or wait.
    pub fn len(&self) -> usize {
        self.states.len()
    }

    /// Whether no body is played.
    pub fn is_empty(&self) -> bool {
        self.states.is_empty()
    }

    /// What a body does; `None` if it is not played.
    pub fn playing(&self, handle: RigidBodyHandle) -> Option<Playing> {
        let state = &self.states[*self.lookup.get(&handle)? as usize];
        Some(if state.waiting {
            Playing::Waiting
        } else {
            Playing::At(state.clock)
        })
    }

    /// To be called before rapier's step, and before [`Immersion::before_step`] if there is one: moves
    /// every played body along its path.
    pub fn before_step(&mut self, sets: &mut RapierSets, mut immersion: Option<&mut Immersion>) {
        let dt = sets.integration_parameters.dt;
        if dt <= 0.0 {
            return;
        }
        let solver = sets.integration_parameters.num_solver_iterations as Real;
        let step = PlayStep {
            dt,
            // A constant acceleration over a step of n substeps moves a body by (n + 1)/2n of its Δv dt.
            sag: sets.gravity * (dt * (0.5 + 0.5 / solver)),
            angle: self.wind.as_ref().map(|(_, response)| *response),
        };
        if let Some((flow, _)) = &self.wind {
            self.points.clear();
            self.points.extend(self.states.iter().map(|state| {
                sets.bodies
                    .get(state.handle)
                    .map_or(state.origin, |body| body.center_of_mass())
            }));
            self.samples
                .resize(self.points.len(), FlowSample::default());
            flow.sample(&self.points, self.time, &mut self.samples);
        }
        self.find_touching(sets);
        self.finished.clear();
        for (number, group) in self.states.chunks_mut(GROUP).enumerate() {
            bring(group, dt);
            for (place, state) in group.iter_mut().enumerate() {
                let index = number * GROUP + place;
                let Some(body) = sets.bodies.get_mut(state.handle) else {
                    self.finished.push(state.handle);
                    continue;
                };
                if !state.watched {
                    state.watch(body, sets.colliders);
                }
                let wind = step.angle.map(|_| self.samples[index].velocity);
                let was_taken = state.taken;
                let touching = if self.touching.crowded {
                    touches(body, sets.narrow_phase)
                } else {
                    self.touching.states[index]
                };
                if !state.advance(body, touching, wind, &step) {
                    self.finished.push(state.handle);
                } else if state.taken != was_taken
                    && let Some(immersion) = &mut immersion
                {
                    immersion.set_body_enabled(state.handle, !state.taken);
                }
            }
        }
        let finished = std::mem::take(&mut self.finished);
        for handle in &finished {
            self.stop(*handle, immersion.as_deref_mut());
        }
        self.finished = finished;
        self.time += f64::from(dt);
    }

    /// Marks the players that touch something where the world's pairs are few: to ask for a body's pairs
    /// one by one takes three look-ups in memory that nothing else in the step needs.
    fn find_touching(&mut self, sets: &RapierSets) {
        let Touching { states, crowded } = &mut self.touching;
        states.clear();
        states.resize(self.states.len(), false);
        // A touching pair costs some four times what a mere pair does.
        let mut left = self.states.len();
        for pair in sets.narrow_phase.contact_pairs() {
            let active = pair.has_any_active_contact();
            let cost = if active { 4 } else { 1 };
            *crowded = left < cost;
            if *crowded {
                return;
            }
            left -= cost;
            if !active {
                continue;
            }
            for collider in [pair.collider1, pair.collider2] {
                let parent = sets.colliders.get(collider).and_then(|c| c.parent());
                if let Some(state) = parent.and_then(|body| self.lookup.get(&body)) {
                    states[*state as usize] = true;
                }
            }
        }
        *crowded = false;
    }
}

/// Reads a little of the keys that a group's step is about to need, so that the machine fetches them all
/// at the same time.
#[inline]
fn bring(group: &[PlayerState], dt: Real) {
    let mut sum = 0.0;
    for state in group {
        let [a, b] = state.path.keys_around(state.clock + dt);
        sum += a.position.x + b.attitude.w;
    }
    std::hint::black_box(sum);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Regime;
    use crate::motion::path::{Key, MotionPath};
    use crate::playback::{AtContact, Drive};
    use rapier3d::prelude::*;

    /// The world's pairs say the same of a player as its own pairs. Bodies land on a floor one after the
    /// other, until the world is crowded and its pairs are no longer searched.
    #[test]
    fn players_in_contact_are_found_alike_both_ways() {
        let key = |t: Real| Key {
            position: Vector::Y * -t,
            velocity: -Vector::Y,
            attitude: Rotation::IDENTITY,
        };
        let regimes = vec![(0.0, Regime::SteadyDescent)];
        let path = Arc::new(MotionPath::new(10.0, vec![key(0.0), key(10.0)], regimes).unwrap());
        let mut world = PhysicsWorld::new();
        world.insert(
            RigidBodyBuilder::fixed(),
            ColliderBuilder::cuboid(50.0, 0.1, 50.0),
        );
        let mut players = MotionPlayers::new();
        for i in 0..60 {
            let at = Vector::new(i as Real, 0.3 + 0.02 * i as Real, 0.0);
            let mut player = MotionPlayer::new(path.clone(), at);
            player.at_contact = AtContact::Deflect;
            let mut body = RigidBodyBuilder::dynamic();
            if i % 2 == 0 {
                player.drive = Drive::Kinematic;
                body = RigidBodyBuilder::kinematic_position_based();
            }
            let (leaf, _) = world.insert(
                body.pose(player.release(Vector::ZERO)),
                ColliderBuilder::cuboid(0.04, 0.01, 0.02),
            );
            players.play(leaf, &player).unwrap();
        }
        let (mut found, mut apart, mut crowded) = (0, 0, 0);
        for _ in 0..120 {
            players.before_step(&mut RapierSets::of(&mut world), None);
            assert_eq!(players.len(), 60);
            for (state, marked) in players.states.iter().zip(&players.touching.states) {
                if players.touching.crowded {
                    crowded += 1;
                    continue;
                }
                let touching = touches(&world.bodies[state.handle], &world.narrow_phase);
                assert_eq!(*marked, touching);
                *(if touching { &mut found } else { &mut apart }) += 1;
            }
            world.step();
        }
        assert!(
            found > 100 && apart > 1000 && crowded > 1000,
            "{found} {apart} {crowded}"
        );
    }
}
