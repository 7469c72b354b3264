//! The snow of either kind, and where it falls: large flakes are bodies of rapier.

use crate::drift::Drift;
use rapier3d_immersed::flow::LogLaw;
use rapier3d_immersed::motion::DimensionlessNumbers;
use rapier3d_immersed::motion::path::{
    SynthesisParams, Synthesizer, TrajectoryDatabase, WindResponse,
};
use rapier3d_immersed::playback::{Emitter, EmitterParams, MotionPlayers};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::turbulence::{Turbulence, TurbulentLayer};
use rapier3d_immersed::{DryMass, Error, Fluid, HydroProperties, Immersion, RapierSets};
use std::sync::Arc;

pub const DT: f32 = 1.0 / 60.0;
/// Where it snows, m.
pub const LOW: Vector = Vector::new(-8.0, 0.0, -10.0);
pub const HIGH: Vector = Vector::new(8.0, 5.0, 6.0);

/// The ground, a wall and a boulder.
pub fn world(dt: f32) -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = dt;
    let mut stand = |collider: ColliderBuilder| {
        world.insert(RigidBodyBuilder::fixed(), collider);
    };
    stand(ColliderBuilder::cuboid(60.0, 0.5, 60.0).translation(Vector::Y * -0.5));
    stand(ColliderBuilder::cuboid(0.15, 0.6, 1.2).translation(Vector::new(-1.2, 0.6, 0.0)));
    stand(ColliderBuilder::ball(0.7).translation(Vector::new(1.3, 0.4, 0.5)));
    world.step();
    world
}

/// A wind over open ground, and the turbulence that belongs to it.
pub fn wind(speed: f32, seed: u64) -> Result<(LogLaw, TurbulentLayer), Error> {
    let wind = LogLaw::new(Vector::X, Vector::Y, speed, 2.0, 0.01)?;
    let turbulence = Turbulence::SurfaceLayer(wind);
    Ok((
        wind,
        TurbulentLayer {
            seed,
            ..turbulence.into()
        },
    ))
}

/// Either kind of snow.
pub enum Fall {
    Fine(Box<Drift>),
    Large(Box<Flakes>),
}

/// Large flakes, and the world that they fall in.
pub struct Flakes {
    world: PhysicsWorld,
    emitter: Emitter,
    players: MotionPlayers,
    immersion: Immersion,
    words: String,
}

impl Fall {
    /// Flakes that come in within some seconds; a share of them plays paths.
    pub fn large(
        flakes: u32,
        speed: f32,
        seed: u64,
        [within, played]: [f32; 2],
    ) -> Result<Self, Error> {
        let collider = ColliderBuilder::cylinder(0.25e-3, 3e-3).density(100.0);
        let hydro = HydroProperties::from_shape(collider.shape.as_ref())?;
        let mass = DryMass::of_shape(collider.shape.as_ref(), 100.0)?;
        let numbers = DimensionlessNumbers::of(&hydro, &mass, &Fluid::AIR, 9.81)?;
        let params = SynthesisParams {
            height: f64::from(HIGH.y) + 1.0,
            ..SynthesisParams::default()
        };
        let database = TrajectoryDatabase::shipped();
        let synthesizer = Synthesizer::new(&numbers, 6e-3, database, params)?;
        let paths = (0..64)
            .map(|number| Arc::new(synthesizer.path(number)))
            .collect();
        let (wind, turbulence) = wind(speed, seed)?;
        let params = EmitterParams {
            corners: [Vector::new(LOW.x, 1.0, LOW.z), HIGH],
            rate: flakes as f32 / within,
            most: flakes as usize,
            played,
            seed,
            ..EmitterParams::default()
        };
        let body = RigidBodyBuilder::dynamic();
        let emitter = Emitter::new(params, body, collider, hydro, paths)?;
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.set_flow(wind);
        immersion.set_turbulence(turbulence);
        let mut players = MotionPlayers::new();
        players.set_wind(Some((Arc::new(wind), WindResponse::default())))?;
        let words = format!(
            "flakes of 6 mm: {:.2} m/s broadside, Re {:.0}",
            numbers.broadside_descent(),
            numbers.reynolds_at(numbers.broadside_descent()),
        );
        Ok(Self::Large(Box::new(Flakes {
            world: world(DT),
            emitter,
            players,
            immersion,
            words,
        })))
    }

    pub fn described(&self) -> String {
        match self {
            Self::Fine(drift) => {
                let (particle, air) = (&drift.particle, &Fluid::AIR);
                let speed = particle.settling_speed(air, 9.81);
                format!(
                    "fine snow of {:.1} mm: {speed:.2} m/s, Re {:.1}, follows the air within {:.0} ms",
                    1e3 * particle.diameter(),
                    particle.reynolds_at(air, speed),
                    1e3 * particle.relaxation_time(air),
                )
            }
            Self::Large(flakes) => flakes.words.clone(),
        }
    }

    pub fn step(&mut self) {
        match self {
            Self::Fine(drift) => {
                drift.snow.step_in_world(DT, &drift.world);
                drift.renew();
            }
            Self::Large(flakes) => {
                let Flakes {
                    world,
                    emitter,
                    players,
                    immersion,
                    ..
                } = &mut **flakes;
                emitter.before_step(world, players, immersion);
                players.before_step(&mut RapierSets::of(world), Some(immersion));
                immersion.step(world);
            }
        }
    }

    /// Flakes that are stepped.
    pub fn moving(&self) -> usize {
        match self {
            Self::Fine(drift) => drift.snow.particles().len(),
            Self::Large(flakes) => flakes.emitter.alive().count(),
        }
    }

    pub fn settled(&self) -> usize {
        match self {
            Self::Fine(drift) => drift.settled.len(),
            Self::Large(flakes) => {
                let Flakes { world, emitter, .. } = &**flakes;
                let at_rest = |handle: &RigidBodyHandle| {
                    let body = &world.bodies[*handle];
                    body.is_sleeping() || body.linvel().length() < 0.01
                };
                emitter.alive().filter(at_rest).count()
            }
        }
    }

    pub fn places(&self) -> Vec<Vector> {
        match self {
            Self::Fine(drift) => {
                let flying = drift.snow.particles().iter().map(|flake| flake.position);
                flying.chain(drift.settled.iter().copied()).collect()
            }
            Self::Large(flakes) => {
                let bodies = &flakes.world.bodies;
                let alive = flakes.emitter.alive();
                alive.map(|handle| bodies[handle].translation()).collect()
            }
        }
    }
}
