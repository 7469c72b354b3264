//! Suspensions (thesis § 7.3: snow, dust, confetti): bodies that enter a scene all the time, some of them
//! played, the others moved by forces.

use super::player::{AtContact, Drive, FARTHEST, MotionPlayer};
use super::players::MotionPlayers;
use crate::body::ImmersedBody;
use crate::coupling::Immersion;
use crate::error::Error;
use crate::motion::path::MotionPath;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rapier3d::dynamics::{RigidBody, RigidBodyBuilder, RigidBodyHandle, RigidBodyType};
use rapier3d::geometry::ColliderBuilder;
use rapier3d::math::{Pose, Real, Rotation, Vector};
use rapier3d::pipeline::PhysicsWorld;
use std::collections::VecDeque;
use std::sync::Arc;

/// Where bodies appear, how many, and what they do.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct EmitterParams {
    /// Corners of the box in which bodies appear, m. Default a square of 1 m at a height of 3 m.
    pub corners: [Vector; 2],
    /// Bodies per second. Default 100.
    pub rate: Real,
    /// Most bodies at a time; beyond it the oldest is removed. Default 10 000.
    pub most: usize,
    /// Share of bodies that play a path; the others are immersed. Default 0.9.
    pub played: Real,
    /// How long a body stays, s. Default 60.
    pub lifetime: Real,
    /// How players follow their path. Default [`Drive::Velocity`] with a compliance of 0.1 s.
    pub drive: Drive,
    /// What a contact does to them. Default [`AtContact::HandOver`]: the force model takes over.
    pub at_contact: AtContact,
    /// Seed of places, headings and paths. Default 0.
    pub seed: u64,
}

impl Default for EmitterParams {
    fn default() -> Self {
        Self {
            corners: [Vector::new(-0.5, 3.0, -0.5), Vector::new(0.5, 3.0, 0.5)],
            rate: 100.0,
            most: 10_000,
            played: 0.9,
            lifetime: 60.0,
            drive: Drive::Velocity { compliance: 0.1 },
            at_contact: AtContact::HandOver,
            seed: 0,
        }
    }
}

/// Lets equal bodies into a world.
///
/// ```
/// use rapier3d_immersed::playback::{Emitter, EmitterParams, MotionPlayers};
/// use rapier3d_immersed::rapier3d::prelude::*;
/// use rapier3d_immersed::{Fluid, HydroProperties, Immersion, RapierSets};
///
/// // Confetti that forces move; with `played` above 0, `paths` would hold falls to play.
/// let collider = ColliderBuilder::cuboid(0.005, 0.0001, 0.003).density(700.0);
/// let hydro = HydroProperties::from_shape(&*collider.shape)?;
/// let params = EmitterParams { rate: 240.0, most: 100, played: 0.0, ..EmitterParams::default() };
/// let mut emitter = Emitter::new(params, RigidBodyBuilder::dynamic(), collider, hydro, Vec::new())?;
/// let mut world = PhysicsWorld::new();
/// let (mut immersion, mut players) = (Immersion::new(Fluid::AIR), MotionPlayers::new());
/// for _ in 0..30 {
///     emitter.before_step(&mut world, &mut players, &mut immersion);
///     players.before_step(&mut RapierSets::of(&mut world), Some(&mut immersion));
///     immersion.step(&mut world);
/// }
/// assert_eq!(emitter.alive().count(), 100); // half a second would bring 120
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
///
/// With the feature `serde-serialize` it can be saved and goes on as it would have; loading refuses what
/// [`Emitter::new`] does, and other versions.
#[derive(Clone)]
pub struct Emitter {
    pub(super) params: EmitterParams,
    pub(super) body: RigidBody,
    pub(super) collider: ColliderBuilder,
    pub(super) immersed: ImmersedBody,
    pub(super) paths: Vec<Arc<MotionPath>>,
    axes: Rotation,
    pub(super) random: Pcg64Mcg,
    pub(super) due: Real,
    pub(super) time: f64,
    pub(super) alive: VecDeque<(f64, RigidBodyHandle)>,
}

/// Steps after which what is wrong with a body has shown.
const TRIAL_STEPS: usize = 8;

/// Lets rapier step an emitted body alone: what it makes NaN of, whichever of its many settings is to blame,
/// is refused.
///
/// # Errors
/// [`Error::NotFinite`].
fn check_emitted(body: RigidBody, collider: ColliderBuilder) -> Result<(), Error> {
    Error::check_not_negative("friction of the collider", collider.friction.into())?;
    Error::check_not_negative("restitution of the collider", collider.restitution.into())?;
    Error::check_not_negative("contact skin of the collider", collider.contact_skin.into())?;
    let mut world = PhysicsWorld::new();
    let (handle, _) = world.insert(body, collider);
    for _ in 0..TRIAL_STEPS {
        world.step();
    }
    let body = &world.bodies[handle];
    let state = [
        body.translation(),
        body.linvel(),
        body.angvel(),
        body.center_of_mass(),
    ];
    for vector in state {
        Error::check_all_finite("emitted body", &vector.to_array().map(f64::from))?;
    }
    Error::check_finite("mass of the emitted body", body.mass().into())?;
    Ok(())
}

impl Emitter {
    /// An emitter of bodies like `body` with `collider` (whose center of mass is the body's origin)
    /// that are `immersed` so, and play one of `paths`. Whatever type the body has, those that play by
    /// [`Drive::Kinematic`] are kinematic and all others dynamic.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::InvalidParameter`] or [`Error::OutOfRange`] names a parameter that
    /// cannot be; [`Error::WrongLength`] if bodies shall be played and there is no path.
    pub fn new(
        params: EmitterParams,
        body: RigidBodyBuilder,
        collider: ColliderBuilder,
        immersed: impl Into<ImmersedBody>,
        paths: Vec<Arc<MotionPath>>,
    ) -> Result<Self, Error> {
        Self::of(params, body.build(), collider, immersed.into(), paths)
    }

    pub(super) fn of(
        params: EmitterParams,
        body: RigidBody,
        collider: ColliderBuilder,
        immersed: ImmersedBody,
        paths: Vec<Arc<MotionPath>>,
    ) -> Result<Self, Error> {
        for corner in params.corners {
            let corner = corner.to_array().map(f64::from);
            Error::check_all_within("corners", &corner, FARTHEST)?;
        }
        Error::check_not_negative("rate", params.rate.into())?;
        Error::check_range("most", params.most as f64, 1.0, 1e7)?;
        Error::check_range("played", params.played.into(), 0.0, 1.0)?;
        Error::check_positive("lifetime", params.lifetime.into())?;
        if let Some(path) = paths.first() {
            let player = MotionPlayer {
                drive: params.drive,
                at_contact: params.at_contact,
                ..MotionPlayer::new(path.clone(), params.corners[0])
            };
            player.check()?;
        } else if params.played > 0.0 {
            return Err(Error::WrongLength {
                what: "paths to play",
                expected: 1,
                actual: 0,
            });
        }
        immersed.hydro.check()?;
        immersed.law.check()?;
        check_emitted(body.clone(), collider.clone())?;
        let axes = crate::math::to_rotation(immersed.hydro.planform.axes.into());
        Ok(Self {
            random: Pcg64Mcg::seed_from_u64(params.seed),
            params,
            body,
            collider,
            immersed,
            paths,
            axes,
            due: 0.0,
            time: 0.0,
            alive: VecDeque::new(),
        })
    }

    /// Bodies in the world, oldest first.
    pub fn alive(&self) -> impl Iterator<Item = RigidBodyHandle> {
        self.alive.iter().map(|(_, handle)| *handle)
    }

    /// Lets in what is due in a step of the world, and takes out what is too old or too many. To be
    /// called before [`MotionPlayers::before_step`].
    pub fn before_step(
        &mut self,
        world: &mut PhysicsWorld,
        players: &mut MotionPlayers,
        immersion: &mut Immersion,
    ) {
        let dt = world.integration_parameters.dt.max(0.0);
        self.time += f64::from(dt);
        self.due += self.params.rate * dt;
        let count = self.due.floor();
        self.due -= count;
        let count = (count as usize).min(self.params.most);
        let oldest = self.time - f64::from(self.params.lifetime);
        let room = self.params.most - count;
        while let Some((born, handle)) = self.alive.front().copied()
            && (born < oldest || self.alive.len() > room)
        {
            players.stop(handle, None);
            immersion.remove(handle, &mut world.bodies, &mut world.colliders);
            world.remove_body(handle);
            self.alive.pop_front();
        }
        for _ in 0..count {
            let handle = self.emit(world, players, immersion);
            self.alive.push_back((self.time, handle));
        }
    }

    fn emit(
        &mut self,
        world: &mut PhysicsWorld,
        players: &mut MotionPlayers,
        immersion: &mut Immersion,
    ) -> RigidBodyHandle {
        let [low, high] = self.params.corners;
        let random = &mut self.random;
        let mut share = || random.random_range(0.0..1.0f32);
        let place = low + (high - low) * Vector::new(share(), share(), share());
        let heading = share() * std::f32::consts::TAU;
        let played = share() < self.params.played;
        let tilt = Rotation::from_axis_angle(Vector::X, share() - 0.5);
        let mut body = self.body.clone();
        let player = played.then(|| {
            let path = &self.paths[random.random_range(0..self.paths.len())];
            MotionPlayer {
                heading,
                axes: self.axes,
                drive: self.params.drive,
                at_contact: self.params.at_contact,
                ..MotionPlayer::new(path.clone(), place)
            }
        });
        let turn = Rotation::from_axis_angle(Vector::Y, heading) * tilt;
        let free = Pose::from_parts(place, turn);
        let pose = player
            .as_ref()
            .map_or(free, |player| player.release(Vector::ZERO));
        // A path of numbers beyond single precision begins nowhere.
        let known = pose.translation.is_finite() && pose.rotation.is_finite();
        let pose = if known { pose } else { free };
        let kinematic = played && self.params.drive == Drive::Kinematic;
        body.set_body_type(
            match kinematic {
                true => RigidBodyType::KinematicPositionBased,
                false => RigidBodyType::Dynamic,
            },
            true,
        );
        body.set_position(pose, true);
        let (handle, _) = world.insert(body, self.collider.clone());
        if let Some(player) = player {
            players
                .play(handle, &player)
                .expect("the emitter's players were checked");
        }
        immersion.insert(handle, self.immersed.clone());
        handle
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coupling::RapierSets;
    use crate::fluid::Fluid;
    use crate::hydro::HydroProperties;
    use crate::motion::Regime;
    use crate::motion::path::{Key, MotionPath};

    fn confetti(params: EmitterParams) -> Result<Emitter, Error> {
        let collider = ColliderBuilder::cuboid(0.01, 0.0005, 0.006).density(300.0);
        let hydro = HydroProperties::from_shape(collider.shape.as_ref())?;
        let key = |y: Real| Key {
            position: Vector::Y * y,
            velocity: -Vector::Y,
            attitude: Rotation::from_axis_angle(Vector::X, -std::f32::consts::FRAC_PI_2),
        };
        let regimes = vec![(0.0, Regime::SteadyDescent)];
        let path = MotionPath::new(2.0, vec![key(0.0), key(-2.0)], regimes)?;
        let body = RigidBodyBuilder::dynamic();
        Emitter::new(params, body, collider, hydro, vec![Arc::new(path)])
    }

    fn run(seed: u64) -> (Vec<Vector>, usize, usize) {
        let mut emitter = confetti(EmitterParams {
            rate: 200.0,
            most: 150,
            played: 0.5,
            lifetime: 0.9,
            seed,
            ..EmitterParams::default()
        })
        .unwrap();
        let mut world = PhysicsWorld::new();
        let mut players = MotionPlayers::new();
        let mut immersion = Immersion::new(Fluid::AIR);
        for _ in 0..90 {
            emitter.before_step(&mut world, &mut players, &mut immersion);
            players.before_step(&mut RapierSets::of(&mut world), Some(&mut immersion));
            immersion.step(&mut world);
            assert!(world.bodies.len() <= 150);
        }
        let places = emitter.alive().map(|h| world.bodies[h].translation());
        (places.collect(), players.len(), immersion.len())
    }

    /// The emitter is full after 0.75 s and never holds more than asked; about half of the bodies are played,
    /// the same ones for the same seed.
    #[test]
    fn a_steady_stream() {
        let (places, players, immersed) = run(3);
        assert_eq!(places.len(), 150);
        assert_eq!(immersed, 150);
        // The bounds are 5 standard deviations of a binomial of 150 and ½.
        assert!((45..=105).contains(&players), "{players}");
        assert!(places.iter().all(|p| p.is_finite() && p.y < 3.01));
        assert_eq!(run(3).0, places);
        assert_ne!(run(4).0, places);
    }

    /// Kinematic players hand over where they meet the floor, so that they are immersed too; those that
    /// do not play are dynamic from the start.
    #[test]
    fn kinematic_streams_settle() {
        let mut emitter = confetti(EmitterParams {
            corners: [Vector::new(-0.5, 0.6, -0.5), Vector::new(0.5, 0.9, 0.5)],
            rate: 60.0,
            most: 60,
            played: 0.5,
            drive: Drive::Kinematic,
            ..EmitterParams::default()
        })
        .unwrap();
        let mut world = PhysicsWorld::new();
        let floor = ColliderBuilder::cuboid(9.0, 0.1, 9.0).translation(Vector::Y * -0.1);
        world.insert(RigidBodyBuilder::fixed(), floor);
        let mut players = MotionPlayers::new();
        let mut immersion = Immersion::new(Fluid::AIR);
        let mut most = 0;
        for step in 0..240 {
            if step < 60 {
                emitter.before_step(&mut world, &mut players, &mut immersion);
            }
            players.before_step(&mut RapierSets::of(&mut world), Some(&mut immersion));
            immersion.step(&mut world);
            let kinematic = world.bodies.iter().filter(|(_, body)| body.is_kinematic());
            assert_eq!(kinematic.count(), players.len());
            most = most.max(players.len());
        }
        assert!(most > 10 && players.is_empty(), "{most} {}", players.len());
        assert_eq!(immersion.len(), 60);
        for handle in emitter.alive() {
            let height = world.bodies[handle].translation().y;
            assert!((-0.01..0.05).contains(&height), "{height}");
        }
    }

    #[test]
    fn impossible_emitters_are_refused() {
        let base = EmitterParams::default();
        for bad in [
            EmitterParams { rate: -1.0, ..base },
            EmitterParams { most: 0, ..base },
            EmitterParams {
                played: 1.5,
                ..base
            },
            EmitterParams {
                lifetime: Real::NAN,
                ..base
            },
            EmitterParams {
                corners: [Vector::NAN; 2],
                ..base
            },
            EmitterParams {
                drive: Drive::Velocity { compliance: -1.0 },
                ..base
            },
        ] {
            assert!(confetti(bad).is_err(), "{bad:?}");
        }
    }
}
