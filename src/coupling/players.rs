//! Synthesized falls played by rapier's bodies (thesis chapter 3), with collisions.

use super::immersion::Immersion;
use super::player::{AtContact, Drive, MotionPlayer};
use super::step::RapierSets;
use crate::Error;
use crate::flow::{Flow, FlowSample};
use crate::motion::path::{MotionPath, WindResponse};
use rapier3d::dynamics::{RigidBody, RigidBodyHandle, RigidBodyType};
use rapier3d::geometry::NarrowPhase;
use rapier3d::math::{Pose, Real, Rotation, Vector};
use std::collections::HashMap;
use std::sync::Arc;

/// What a played body does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Playing {
    /// It follows its path; seconds since the path's beginning.
    At(Real),
    /// It touches something, or has just done so, and waits for its path to go on.
    Waiting,
}

/// The bodies of a world that play paths.
///
/// [`MotionPlayers::before_step`] goes before [`Immersion::before_step`]. A body that is also immersed
/// is out of the fluid's hands while it is played. Bodies that are removed from rapier are forgotten.
#[derive(Clone, Default)]
pub struct MotionPlayers {
    slots: Vec<Slot>,
    lookup: HashMap<RigidBodyHandle, u32>,
    wind: Option<(Arc<dyn Flow>, WindResponse)>,
    time: f64,
    points: Vec<Vector>,
    samples: Vec<FlowSample>,
    finished: Vec<RigidBodyHandle>,
}

#[derive(Clone)]
struct Slot {
    handle: RigidBodyHandle,
    path: Arc<MotionPath>,
    origin: Vector,
    turn: Rotation,
    /// From the body's frame to the plate's axes.
    to_plate: Rotation,
    drive: Drive,
    at_contact: AtContact,
    clock: Real,
    /// Seconds since something touched it.
    free: Real,
    waiting: bool,
    /// Whether the force model has been told to let go.
    taken: bool,
    /// Velocity taken from the wind, m/s.
    blown: Vector,
    /// The path at `clock`, turned: position from the origin, and attitude of the body's frame.
    now: (Vector, Rotation),
}

impl MotionPlayers {
    /// No players, in still fluid.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the wind that blows players along and leans them; `None` for still fluid.
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
        let release = player.release(Vector::ZERO);
        let slot = Slot {
            handle,
            path: player.path.clone(),
            origin: player.origin,
            turn: Rotation::from_axis_angle(Vector::Y, player.heading),
            now: (release.translation - player.origin, release.rotation),
            to_plate: player.axes.inverse(),
            drive: player.drive,
            at_contact: player.at_contact,
            clock: 0.0,
            free: Real::INFINITY,
            waiting: false,
            taken: false,
            blown: Vector::ZERO,
        };
        match self.lookup.get(&handle) {
            Some(index) => self.slots[*index as usize] = slot,
            None => {
                self.lookup.insert(handle, self.slots.len() as u32);
                self.slots.push(slot);
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
        self.slots.swap_remove(index as usize);
        if let Some(moved) = self.slots.get(index as usize) {
            self.lookup.insert(moved.handle, index);
        }
        true
    }

    /// Number of bodies that are played or wait.
    pub fn len(&self) -> usize {
        self.slots.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.slots.is_empty()
    }

    /// What a body does; `None` if it is not played.
    pub fn playing(&self, handle: RigidBodyHandle) -> Option<Playing> {
        let slot = &self.slots[*self.lookup.get(&handle)? as usize];
        Some(if slot.waiting {
            Playing::Waiting
        } else {
            Playing::At(slot.clock)
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
        let step = Step {
            dt,
            // A constant acceleration over a step of n substeps moves a body by (n + 1)/2n of its Δv dt.
            sag: sets.gravity * (dt * (0.5 + 0.5 / solver)),
            angle: self.wind.as_ref().map(|(_, response)| *response),
        };
        if let Some((flow, _)) = &self.wind {
            self.points.clear();
            self.points.extend(self.slots.iter().map(|slot| {
                sets.bodies
                    .get(slot.handle)
                    .map_or(slot.origin, |body| body.center_of_mass())
            }));
            self.samples
                .resize(self.points.len(), FlowSample::default());
            flow.sample(&self.points, self.time, &mut self.samples);
        }
        self.finished.clear();
        for (index, slot) in self.slots.iter_mut().enumerate() {
            let Some(body) = sets.bodies.get_mut(slot.handle) else {
                self.finished.push(slot.handle);
                continue;
            };
            let wind = step.angle.map(|_| self.samples[index].velocity);
            let was_taken = slot.taken;
            if !slot.advance(body, sets.narrow_phase, wind, &step) {
                self.finished.push(slot.handle);
            } else if slot.taken != was_taken
                && let Some(immersion) = &mut immersion
            {
                immersion.set_body_enabled(slot.handle, !slot.taken);
            }
        }
        let finished = std::mem::take(&mut self.finished);
        for handle in &finished {
            self.stop(*handle, immersion.as_deref_mut());
        }
        self.finished = finished;
        self.time += f64::from(dt);
    }
}

/// What is the same for all bodies in a step.
struct Step {
    dt: Real,
    /// Velocity by which gravity moves a body within the step.
    sag: Vector,
    angle: Option<WindResponse>,
}

impl Slot {
    /// Moves the body for a step; whether it goes on being played.
    #[inline]
    fn advance(
        &mut self,
        body: &mut RigidBody,
        narrow_phase: &NarrowPhase,
        wind: Option<Vector>,
        step: &Step,
    ) -> bool {
        match self.drive {
            Drive::Kinematic if body.body_type() == RigidBodyType::KinematicPositionBased => {
                self.taken = true;
                let lean = self.blow(wind, step);
                self.proceed(step.dt);
                let rotation = leaning(lean, self.now.1);
                let com = self.origin + self.now.0;
                let origin = com - rotation * body.local_center_of_mass();
                body.set_next_kinematic_position(Pose::from_parts(origin, rotation));
                let done = self.clock >= self.path.duration();
                if done {
                    body.set_body_type(RigidBodyType::Dynamic, true);
                }
                !done
            }
            Drive::Velocity { compliance } if body.is_dynamic() => {
                self.drive(body, narrow_phase, compliance, wind, step)
            }
            _ => true,
        }
    }

    fn drive(
        &mut self,
        body: &mut RigidBody,
        narrow_phase: &NarrowPhase,
        compliance: Real,
        wind: Option<Vector>,
        step: &Step,
    ) -> bool {
        let dt = step.dt;
        let touching = self.at_contact != AtContact::Ignore && touches(body, narrow_phase);
        self.free = if touching { 0.0 } else { self.free + dt };
        let com = *body.position() * body.local_center_of_mass();
        match self.at_contact {
            AtContact::HandOver if touching => return false,
            AtContact::Resume { after } => {
                if touching {
                    (self.waiting, self.taken) = (true, false);
                } else if self.waiting && self.free > after {
                    self.waiting = false;
                    self.anchor(com);
                    // The velocity of the path comes back as after a contact.
                    self.free = dt;
                }
                if self.waiting {
                    return true;
                }
            }
            AtContact::Deflect if touching => self.anchor(com),
            _ => {}
        }
        self.taken = true;
        // Where the path was before this step's wind: the wind's displacement is not an error.
        let from = self.origin + self.now.0;
        let lean = self.blow(wind, step);
        let turned = leaning(lean, self.now.1);
        let before = self.now.0;
        self.proceed(dt);
        let mut moved = self.now.0 - before;
        if lean.is_some() {
            moved += self.blown * dt;
        }
        let rotation = leaning(lean, self.now.1);
        // Share of an error that is worked off in this step (implicit Euler).
        let k = dt / (dt + compliance);
        let linear = (moved + (from - com) * k) / dt - step.sag;
        let away = turned * body.rotation().inverse();
        let angular = (vector(rotation * turned.inverse()) + vector(away) * k) / dt;
        let (linear, angular) = if self.free < 8.0 * compliance {
            let s = 1.0 - (-self.free / compliance).exp();
            (
                body.linvel() + (linear - body.linvel()) * s,
                body.angvel() + (angular - body.angvel()) * s,
            )
        } else {
            (linear, angular)
        };
        body.set_linvel(linear, true);
        body.set_angvel(angular, true);
        self.clock < self.path.duration()
    }

    /// Takes on the wind; returns how far it leans the body.
    #[inline]
    fn blow(&mut self, wind: Option<Vector>, step: &Step) -> Option<Rotation> {
        let (wind, response) = (wind?, step.angle?);
        let wind = if wind.is_finite() { wind } else { Vector::ZERO };
        self.blown += (wind - self.blown) * (step.dt / (response.delay + step.dt));
        self.origin += self.blown * step.dt;
        Some(response.lean(self.blown))
    }

    /// Moves on along the path.
    #[inline]
    fn proceed(&mut self, dt: Real) {
        self.clock += dt;
        let key = self.path.at(self.clock);
        self.now = (
            self.turn * key.position,
            self.turn * key.attitude * self.to_plate,
        );
    }

    /// Lets the path go through a point at the present time.
    fn anchor(&mut self, com: Vector) {
        self.origin = com - self.now.0;
    }
}

/// A rotation in the wind.
#[inline]
fn leaning(lean: Option<Rotation>, rotation: Rotation) -> Rotation {
    lean.map_or(rotation, |lean| lean * rotation)
}

/// Whether a body touches another.
#[inline]
fn touches(body: &RigidBody, narrow_phase: &NarrowPhase) -> bool {
    body.colliders().iter().any(|collider| {
        narrow_phase
            .contact_pairs_with(*collider)
            .any(|pair| pair.has_any_active_contact())
    })
}

/// Rotation vector of a rotation, to fifth order in its angle.
#[inline]
fn vector(rotation: Rotation) -> Vector {
    let part = Vector::new(rotation.x, rotation.y, rotation.z);
    let s2 = part.length_squared();
    let sign = if rotation.w < 0.0 { -2.0 } else { 2.0 };
    part * (sign * (1.0 + s2 / 6.0 + 0.075 * s2 * s2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::Uniform;
    use crate::motion::path::{SynthesisParams, Synthesizer, TrajectoryDatabase};
    use crate::motion::{Numbers, Outline, Regime};
    use crate::{Fluid, HydroProperties};
    use rapier3d::prelude::*;

    fn path(regimes: &[Regime], height: f64) -> Arc<MotionPath> {
        let numbers =
            Numbers::new(Outline::Round, 0.042, 0.0003, 400.0, &Fluid::AIR, 9.81).unwrap();
        let params = SynthesisParams {
            height,
            main: Some(Regime::PeriodicSpiral),
            ..SynthesisParams::default()
        };
        let database = TrajectoryDatabase::shipped();
        let leaf = Synthesizer::new(&numbers, 0.073, database, params).unwrap();
        Arc::new(leaf.path_through(regimes, 5).unwrap())
    }

    fn world(player: &MotionPlayer, height: Real) -> (PhysicsWorld, RigidBodyHandle) {
        let mut world = PhysicsWorld::new();
        let body = match player.drive {
            Drive::Kinematic => RigidBodyBuilder::kinematic_position_based(),
            Drive::Velocity { .. } => RigidBodyBuilder::dynamic(),
        };
        let (leaf, _) = world.insert(
            body.pose(player.release(Vector::ZERO)),
            ColliderBuilder::cuboid(0.0365, 0.001, 0.021).density(400.0),
        );
        let ground = ColliderBuilder::cuboid(10.0, 0.1, 10.0);
        world.insert(
            RigidBodyBuilder::fixed().translation(Vector::Y * (height - 0.1)),
            ground,
        );
        (world, leaf)
    }

    /// Both drives follow the path, through every pattern, to rounding: the velocities that are set
    /// carry the body exactly to where it shall be. Attitudes are first order within a step (rapier
    /// normalises a linear step), and the error is worked off.
    #[test]
    fn bodies_follow_their_path() {
        for drive in [Drive::Kinematic, Drive::Velocity { compliance: 0.05 }] {
            let regimes = [
                Regime::PeriodicFlutter,
                Regime::PeriodicTumbling,
                Regime::PeriodicSpiral,
            ];
            let player = MotionPlayer {
                heading: 0.7,
                drive,
                ..MotionPlayer::new(path(&regimes, 3.0), Vector::new(1.0, 4.0, 0.0))
            };
            let (mut world, leaf) = world(&player, -9.0);
            let mut players = MotionPlayers::new();
            players.play(leaf, &player).unwrap();
            let turn = Rotation::from_axis_angle(Vector::Y, 0.7);
            let steps = (player.path.duration() * 60.0) as usize;
            for step in 1..steps {
                players.before_step(&mut RapierSets::of(&mut world), None);
                world.step();
                let key = player.path.at(step as Real / 60.0);
                let body = &world.bodies[leaf];
                let error = (body.center_of_mass() - player.origin - turn * key.position).length();
                assert!(error < 1e-3, "{drive:?} {step}: {error}");
                let attitude = turn * key.attitude * player.axes.inverse();
                let angle = attitude.angle_between(*body.rotation());
                assert!(angle < 0.06, "{drive:?} {step}: {angle}");
            }
        }
    }

    /// A leaf that is played meets the ground, the force model takes over, and it comes to rest there.
    #[test]
    fn a_played_leaf_settles() {
        for at_contact in [
            AtContact::HandOver,
            AtContact::Resume { after: 0.3 },
            AtContact::Deflect,
        ] {
            let player = MotionPlayer {
                at_contact,
                ..MotionPlayer::new(path(&[Regime::PeriodicFlutter], 1.0), Vector::Y)
            };
            let (mut world, leaf) = world(&player, 0.4);
            let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, leaf).unwrap();
            let mut immersion = Immersion::new(Fluid::AIR);
            immersion.insert(leaf, hydro);
            let mut players = MotionPlayers::new();
            players.play(leaf, &player).unwrap();
            for _ in 0..360 {
                players.before_step(&mut RapierSets::of(&mut world), Some(&mut immersion));
                immersion.step(&mut world);
            }
            let body = &world.bodies[leaf];
            assert!(body.linvel().length() < 0.02, "{at_contact:?}");
            let height = body.translation().y;
            assert!((0.39..0.46).contains(&height), "{at_contact:?} {height}");
            assert!(players.playing(leaf).is_none_or(|p| p == Playing::Waiting));
        }
    }

    /// A ball in the path turns a deflected leaf aside, and the path goes on from there.
    #[test]
    fn deflection_lasts() {
        let player = MotionPlayer {
            at_contact: AtContact::Deflect,
            ..MotionPlayer::new(path(&[Regime::SteadyDescent], 3.0), Vector::Y * 3.0)
        };
        let (mut world, leaf) = world(&player, -9.0);
        let below = player.origin + player.path.at(1.0).position;
        world.insert(
            RigidBodyBuilder::fixed().translation(below + Vector::new(0.02, -0.05, 0.0)),
            ColliderBuilder::ball(0.05),
        );
        let mut players = MotionPlayers::new();
        players.play(leaf, &player).unwrap();
        let mut left = Vector::ZERO;
        for step in 0..170 {
            players.before_step(&mut RapierSets::of(&mut world), None);
            world.step();
            if step == 120 {
                left = world.bodies[leaf].translation();
            }
        }
        let end = world.bodies[leaf].translation();
        let drift = player.path.at(1.0).velocity;
        let undisturbed = Vector::Y * 3.0 + player.path.at(121.0 / 60.0).position;
        assert!((left - undisturbed).length() > 0.02, "{left} {undisturbed}");
        // After the collision the velocity is the path's again, not a pull back to it.
        let velocity = (end - left) / (49.0 / 60.0);
        assert!((velocity - drift).length() < 0.1, "{velocity} {drift}");
    }

    #[test]
    fn wind_carries_players_along() {
        let player = MotionPlayer::new(path(&[Regime::SteadyDescent], 3.0), Vector::Y * 5.0);
        let (mut world, leaf) = world(&player, -9.0);
        let mut players = MotionPlayers::new();
        let flow: Arc<dyn Flow> = Arc::new(Uniform::new(0.0, 0.0, 2.0));
        let response = WindResponse::default();
        players.set_wind(Some((flow, response))).unwrap();
        players.play(leaf, &player).unwrap();
        for _ in 0..120 {
            players.before_step(&mut RapierSets::of(&mut world), None);
            world.step();
        }
        let moved =
            world.bodies[leaf].translation() - Vector::Y * 5.0 - player.path.at(2.0).position;
        // 2 m/s for 2 s, less the delay of 0.1 s and a step.
        assert!((moved.z - 2.0 * 1.9).abs() < 0.05, "{moved}");
        let normal = *world.bodies[leaf].rotation() * Vector::Y;
        let lean = response.angle * 2.0 / 3.0;
        assert!((normal.angle_between(Vector::Y) - lean).abs() < 0.02 && normal.z > 0.0);
    }

    #[test]
    fn removed_bodies_and_nonsense_are_ignored() {
        let player = MotionPlayer::new(path(&[Regime::SteadyDescent], 3.0), Vector::Y);
        let (mut world, leaf) = world(&player, -9.0);
        let mut players = MotionPlayers::new();
        players.play(leaf, &player).unwrap();
        assert_eq!(players.playing(leaf), Some(Playing::At(0.0)));
        world.remove_body(leaf);
        players.before_step(&mut RapierSets::of(&mut world), None);
        assert!(players.is_empty() && players.playing(leaf).is_none());
        players.stop(leaf, None);
        let bad = MotionPlayer {
            origin: Vector::new(Real::NAN, 0.0, 0.0),
            ..player
        };
        assert!(players.play(leaf, &bad).is_err());
    }
}
