//! Fine snow, as a suspension.

use crate::fall::{DT, HIGH, LOW, wind, world};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rapier3d_immersed::playback::{Particle, Suspension};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Error, Fluid, Layer};

/// Fine snow that settles where it meets something; as much comes in at the top and from upwind.
pub struct Drift {
    pub world: PhysicsWorld,
    pub snow: Suspension,
    pub particle: Particle,
    random: Pcg64Mcg,
    pub settled: Vec<Vector>,
    count: usize,
}

impl Drift {
    pub fn new(flakes: u32, speed: f32, seed: u64) -> Result<Self, Error> {
        let (wind, turbulence) = wind(speed, seed)?;
        let air = Layer::new(Fluid::AIR)
            .with_flow(wind)
            .with_turbulence(turbulence);
        let particle = Particle::sphere(0.3e-3, 200.0)?;
        let mut drift = Self {
            world: world(DT),
            snow: Suspension::new(air, particle)?,
            particle,
            random: Pcg64Mcg::seed_from_u64(seed),
            settled: Vec::new(),
            count: flakes as usize,
        };
        let fall = drift.snow.settling_velocity(drift.world.gravity);
        for _ in 0..flakes {
            let place = drift.place(LOW.y, HIGH.y);
            drift.snow.insert(place, fall);
        }
        Ok(drift)
    }

    fn place(&mut self, low: f32, high: f32) -> Vector {
        let random = &mut self.random;
        Vector::new(
            random.random_range(LOW.x..HIGH.x),
            random.random_range(low..=high),
            random.random_range(LOW.z..HIGH.z),
        )
    }

    /// Takes out what has settled or blown away, and lets as much in.
    pub fn renew(&mut self) {
        let (settled, fall) = (
            &mut self.settled,
            self.snow.settling_velocity(self.world.gravity),
        );
        let mut blown = 0;
        self.snow.retain(|flake| {
            if flake.settled {
                settled.push(flake.position);
            }
            let away = flake.position.x > HIGH.x;
            blown += usize::from(away && !flake.settled);
            !flake.settled && !away
        });
        for missing in 0..self.count - self.snow.particles().len() {
            let mut place = self.place(HIGH.y, HIGH.y);
            if missing < blown {
                place = self.place(LOW.y, HIGH.y);
                place.x = LOW.x;
            }
            self.snow.insert(place, fall);
        }
    }
}
