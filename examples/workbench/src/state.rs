//! The world at one moment: what is in it, what moves it, and a step of it.

use crate::change::{Change, Placement, Rain};
use crate::kinds::{Shape, kind};
use crate::methods::{self, Method};
use crate::path::{self, Followed};
use crate::settings::Settings;
use crate::support::scene::Scene;
use crate::support::{Quat, Vec3, from_rapier};
use rand::{RngExt, SeedableRng};
use rapier3d_immersed::playback::MotionPlayers;
use rapier3d_immersed::rapier3d::math::{Pose, Vector};
use rapier3d_immersed::rapier3d::prelude::{PhysicsWorld, RigidBodyHandle};
use rapier3d_immersed::{ForceBreakdown, Immersion, RapierSets, preset};
use std::collections::VecDeque;
use std::f64::consts::TAU;

/// Of the world, m/s².
pub const GRAVITY: f64 = 9.81;
/// Bodies that the bench holds.
const MOST_BODIES: usize = 400;
/// Side of the ground, m.
const GROUND: f64 = 40.0;
/// What is farther from the middle than this, m, is switched off.
const FARTHEST: f32 = 16.0;
/// What is faster, m/s and rad/s, is held: an ideal fluid resists nothing.
const FASTEST: f32 = 80.0;
const FASTEST_SPIN: f32 = 2000.0;
/// Linear RGB of the ground.
pub(crate) const SAND: [f32; 3] = [0.62, 0.58, 0.50];
/// Steps between two points of a trail, and its points: two seconds.
const TRAIL_STEPS: u64 = 4;
const TRAIL: usize = 120;
/// Time constant of the mean descent, s.
const DESCENT_TIME: f64 = 0.5;

/// What moves a body.
#[derive(Clone)]
pub enum Drive {
    /// The method that is set.
    Method,
    /// A drawn line.
    Path(Box<Followed>),
}

/// A body of the bench.
#[derive(Clone)]
pub struct Body {
    /// What it is.
    pub shape: Shape,
    /// Times the lengths of the thing.
    pub size: f64,
    /// A number of its own, also the seed of what is random about it.
    pub id: u64,
    /// What moves it.
    pub drive: Drive,
    /// Its speed downward, averaged over half a second, m/s.
    pub descent: f64,
    /// Where its center of mass has been in the last two seconds, m.
    pub trail: VecDeque<[f32; 3]>,
    /// Whether it was placed since the last step.
    fresh: bool,
}

impl Body {
    /// Of its farthest point from its center of mass, m.
    pub fn reach(&self) -> f32 {
        kind(self.shape, self.size).map_or(0.0, |kind| {
            let corners = kind.solid.vertices().iter();
            let reach = corners.map(|v| (v - kind.dry.center).norm());
            reach.fold(0.0, f64::max) as f32
        })
    }

    /// Whether it was placed since the last step.
    pub(crate) fn is_fresh(&self) -> bool {
        self.fresh
    }
}

/// The world at one moment.
pub struct State {
    /// Steps since the beginning.
    pub step: u64,
    /// What is set; it acts from the next step on.
    pub settings: Settings,
    /// The bodies, in the order of the scene's pieces.
    pub bodies: Vec<Body>,
    /// What is in the world, and how it looks.
    pub(crate) scene: Scene,
    /// The fluid.
    pub immersion: Immersion,
    pub(crate) players: MotionPlayers,
    /// What the last step was made with, and whose wake is in it.
    pub(crate) applied: Option<(Settings, Option<(Shape, u64)>)>,
    placed: u64,
    /// What could not be done as asked since this was last looked at.
    pub(crate) notes: Vec<String>,
}

impl Default for State {
    fn default() -> Self {
        let mut world = PhysicsWorld::new();
        preset::leaf_scale(&mut world.integration_parameters);
        let mut scene = Scene::new(world);
        let floor = Pose::from_translation(Vector::Y * -0.05);
        scene.add_box(floor, [GROUND, 0.1, GROUND], SAND);
        let settings = Settings::default();
        Self {
            step: 0,
            settings,
            bodies: Vec::new(),
            scene,
            immersion: Immersion::new(settings.fluid()),
            players: MotionPlayers::new(),
            applied: None,
            placed: 0,
            notes: Vec::new(),
        }
    }
}

impl State {
    /// A copy but for rapier's world and the fluid, in whose place are these.
    pub(crate) fn with(&self, world: PhysicsWorld, immersion: Immersion) -> Self {
        let scene = &self.scene;
        Self {
            step: self.step,
            settings: self.settings,
            bodies: self.bodies.clone(),
            scene: Scene {
                world,
                kinds: scene.kinds.clone(),
                pieces: scene.pieces.clone(),
                colors: scene.colors.clone(),
                obstacles: scene.obstacles.clone(),
                water: scene.water,
            },
            immersion,
            players: self.players.clone(),
            applied: self.applied,
            placed: self.placed,
            notes: Vec::new(),
        }
    }

    /// Time since the beginning, s.
    pub fn time(&self) -> f64 {
        self.step as f64 * f64::from(preset::LEAF_DT)
    }

    /// Rapier's world.
    pub fn world(&self) -> &PhysicsWorld {
        &self.scene.world
    }

    /// Rapier's handle of a body.
    pub fn handle(&self, body: usize) -> Option<RigidBodyHandle> {
        self.scene.pieces.get(body).map(|piece| piece.handle)
    }

    /// Whether a body is there to be seen: not if it has left the ground.
    pub fn is_seen(&self, body: usize) -> bool {
        let handle = self.handle(body);
        handle.is_some_and(|handle| self.world().bodies[handle].is_enabled())
    }

    /// What the fluid does to a body; `None` where there is no body or no fluid for it.
    pub fn forces(&self, body: usize) -> Option<ForceBreakdown> {
        let bodies = &self.scene.world.bodies;
        self.immersion.forces(bodies, self.handle(body)?)
    }

    /// Poses and velocities of all bodies, bit by bit.
    pub fn bits(&self) -> Vec<u32> {
        let bodies = self.scene.pieces.iter();
        let numbers = bodies.flat_map(|piece| {
            let body = &self.scene.world.bodies[piece.handle];
            let (turn, place) = (body.rotation(), body.translation());
            let vectors = [place, body.linvel(), body.angvel()];
            let vectors = vectors.into_iter().flat_map(|v| v.to_array());
            vectors.chain(turn.to_array())
        });
        numbers.map(f32::to_bits).collect()
    }

    /// Makes a change that is [held](Change::held) within its ranges.
    ///
    /// # Errors
    /// Why it cannot be; nothing has changed then.
    pub fn change(&mut self, change: &Change) -> Result<(), String> {
        match change {
            Change::Place(body) => self.place(body),
            Change::Rain(rain) => self.rain(rain),
            Change::Draw(points) => self.draw(points),
            Change::Set(setting) => {
                setting.put(&mut self.settings);
                Ok(())
            }
            Change::Remove(body) => self.remove(*body),
            Change::Clear => {
                while let Some(last) = self.bodies.len().checked_sub(1) {
                    self.remove(last)?;
                }
                Ok(())
            }
        }
    }

    fn place(&mut self, body: &Placement) -> Result<(), String> {
        let mut size = body.size;
        if body.shape == Shape::Airplane && size != 1.0 {
            self.notes.push("the airplane has one size".into());
            size = 1.0;
        }
        let release = rapier3d_immersed::training::Release {
            tilt: body.tilt.to_radians(),
            tilt_axis: methods::TILT_AXIS,
            heading: body.heading.to_radians(),
            ..Default::default()
        };
        let of = kind(body.shape, size)?;
        let turn = match body.shape {
            // Its nose is along x and its keel along −z: planforms do not know top from bottom.
            Shape::Airplane => {
                let (x, y) = (Vec3::x_axis(), Vec3::y_axis());
                let level = Quat::from_axis_angle(&x, release.tilt - TAU / 4.0);
                Quat::from_axis_angle(&y, release.heading) * level
            }
            _ => release.orientation(&of.body.hydro),
        };
        let (at, velocity) = (Vec3::from(body.position), Vec3::from(body.velocity));
        self.insert(
            body.shape,
            size,
            (at, turn),
            velocity,
            Vec3::from(body.spin),
        )
    }

    /// Inserts a body with its center of mass at a place, or above it where that is taken.
    fn insert(
        &mut self,
        shape: Shape,
        size: f64,
        (mut at, turn): (Vec3, Quat),
        velocity: Vec3,
        spin: Vec3,
    ) -> Result<(), String> {
        self.check_room()?;
        let of = kind(shape, size)?;
        let asked = at.y;
        let pose = |at: &Vec3| {
            let q = turn.coords.map(|x| x as f32);
            let turned = rapier3d_immersed::rapier3d::math::Rotation::from_xyzw(q.x, q.y, q.z, q.w);
            Pose::from_parts(
                crate::support::to_rapier(&(at - turn * of.dry.center)),
                turned,
            )
        };
        self.scene.find_room(&of, &mut at, pose)?;
        if at.y > asked + 1e-6 {
            let by = 100.0 * (at.y - asked);
            self.notes
                .push(format!("placed {by:.0} cm higher: there was no room"));
        }
        let equal =
            |known: &crate::support::scene::Kind| std::sync::Arc::ptr_eq(&known.body, &of.body);
        let kinds = &mut self.scene.kinds;
        let index = kinds.iter().position(equal).unwrap_or_else(|| {
            kinds.push(of.clone());
            kinds.len() - 1
        });
        let id = self.placed;
        self.placed += 1;
        let origin = at - turn * of.dry.center;
        let color = shape.color(id as usize);
        self.scene
            .add_piece(index, color, (origin, turn), spin, preset::leaf_body);
        let handle = self.scene.pieces[self.scene.pieces.len() - 1].handle;
        let velocity = crate::support::to_rapier(&velocity);
        self.scene.world.bodies[handle].set_linvel(velocity, true);
        self.bodies.push(Body {
            shape,
            size,
            id,
            drive: Drive::Method,
            descent: 0.0,
            trail: VecDeque::new(),
            fresh: true,
        });
        Ok(())
    }

    fn check_room(&self) -> Result<(), String> {
        match self.bodies.len() {
            MOST_BODIES.. => Err(format!("there are {MOST_BODIES} bodies already")),
            _ => Ok(()),
        }
    }

    fn rain(&mut self, rain: &Rain) -> Result<(), String> {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(rain.seed);
        for count in 0..rain.count as usize {
            let mut within = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
            let position = [
                within(-rain.spread, rain.spread),
                within(rain.heights[0], rain.heights[1]),
                within(-rain.spread, rain.spread),
            ];
            let placed = self.place(&Placement {
                shape: rain.shape,
                size: rain.size,
                position,
                tilt: within(-60.0, 60.0),
                heading: within(0.0, 360.0),
                ..Placement::default()
            });
            // One note is enough for many bodies.
            self.notes.truncate(1);
            match placed {
                Err(problem) if count > 0 => {
                    self.notes.push(format!("only {count} fell: {problem}"));
                    break;
                }
                outcome => outcome?,
            }
        }
        Ok(())
    }

    fn draw(&mut self, points: &[[f64; 3]]) -> Result<(), String> {
        self.check_room()?;
        let leaf = methods::experiment(&kind(Shape::Leaf, 1.0)?, &self.settings);
        let sketch = path::sketch(points, &leaf)?;
        // The search asks the medium of the moment.
        self.apply_settings();
        let followed = Followed::new(sketch, &leaf, &self.immersion, self.placed)?;
        let release = followed.release();
        let pose = (release.position, release.orientation);
        self.insert(Shape::Leaf, 1.0, pose, release.velocity, release.spin)?;
        if let Some(body) = self.bodies.last_mut() {
            body.drive = Drive::Path(Box::new(followed));
        }
        Ok(())
    }

    fn remove(&mut self, body: usize) -> Result<(), String> {
        let handle = self.handle(body).ok_or("there is no such body")?;
        let world = &mut self.scene.world;
        self.players.stop(handle, None);
        self.immersion
            .remove(handle, &mut world.bodies, &mut world.colliders);
        world.remove_body(handle);
        self.scene.pieces.remove(body);
        self.scene.colors.remove(body);
        self.bodies.remove(body);
        Ok(())
    }

    /// Moves the world on by [`preset::LEAF_DT`].
    pub fn step(&mut self) {
        self.apply_settings();
        let world = &mut self.scene.world;
        for (body, piece) in self.bodies.iter_mut().zip(&self.scene.pieces) {
            if let Drive::Path(path) = &mut body.drive {
                path.before_step(piece.handle, &world.bodies, &mut self.immersion);
            }
        }
        if !self.players.is_empty() {
            let sets = &mut RapierSets::of(world);
            self.players.before_step(sets, Some(&mut self.immersion));
        }
        self.immersion.step(world);
        self.step += 1;
        self.watch();
    }

    /// Keeps what is shown of each body, and switches off what has left the ground.
    fn watch(&mut self) {
        let dt = f64::from(preset::LEAF_DT);
        for (body, piece) in self.bodies.iter_mut().zip(&self.scene.pieces) {
            let rapier = &self.scene.world.bodies[piece.handle];
            let at = rapier.center_of_mass();
            body.descent += (dt / DESCENT_TIME) * (-f64::from(rapier.linvel().y) - body.descent);
            if self.step.is_multiple_of(TRAIL_STEPS) {
                if body.trail.len() == TRAIL {
                    body.trail.pop_front();
                }
                body.trail.push_back(at.to_array());
            }
            if let Drive::Path(path) = &mut body.drive {
                path.after_step(&from_rapier(at));
            }
            let (speed, spin) = (rapier.linvel().length(), rapier.angvel().length());
            if speed > FASTEST || spin > FASTEST_SPIN {
                let linear = rapier.linvel() * (FASTEST / speed).min(1.0);
                let angular = rapier.angvel() * (FASTEST_SPIN / spin).min(1.0);
                let rapier = &mut self.scene.world.bodies[piece.handle];
                rapier.set_linvel(linear, true);
                rapier.set_angvel(angular, true);
                let name = body.shape.name();
                self.notes.push(format!(
                    "{name}: held at {FASTEST} m/s, {FASTEST_SPIN} rad/s"
                ));
            }
            let rapier = &self.scene.world.bodies[piece.handle];
            let within = at.abs().max_element() < FARTHEST && at.y > -1.0;
            if !within && rapier.is_enabled() {
                let world = &mut self.scene.world;
                self.immersion
                    .remove(piece.handle, &mut world.bodies, &mut world.colliders);
                world.bodies[piece.handle].set_enabled(false);
            }
        }
    }

    /// Gives the fluid and the bodies what has been set since the last step.
    fn apply_settings(&mut self) {
        let settings = self.settings;
        let first = self
            .bodies
            .first()
            .map_or((Shape::Leaf, 1.0), |b| (b.shape, b.size));
        let in_wake = settings.method == Method::Stochastic && settings.turbulence == 0.0;
        let wake = in_wake.then_some((first.0, first.1.to_bits()));
        let before = self.applied.replace((settings, wake));
        let all = before.is_none_or(|(before, _)| !before.moves_as(&settings));
        let anew = before != self.applied;
        if anew && let Err(problem) = self.apply_medium(before, wake) {
            self.notes.push(problem);
        }
        for body in 0..self.bodies.len() {
            if all || self.bodies[body].fresh {
                if let Err(problem) = self.dress(body) {
                    let name = self.bodies[body].shape.name();
                    self.notes
                        .push(format!("{name}: {problem}; it falls by the law"));
                }
                self.bodies[body].fresh = false;
            }
        }
    }
}
