//! What is set for all bodies: fluids, wind, turbulence, law and method; and how far each may go.

use crate::methods::Method;
use rapier3d_immersed::flow::Uniform;
use rapier3d_immersed::free_surface::{Sea, WaveSpectrum, Waves};
use rapier3d_immersed::rapier3d::math::Vector;
use rapier3d_immersed::turbulence::{Turbulence, TurbulenceState, TurbulentLayer};
use rapier3d_immersed::{
    Error, Fluid, ForceFactors, Layer, Medium, PhysicalLaw, StochasticLaw, ThesisLaw, ViscousLaw,
};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// How far each value may go. The panel's sliders end here, and the bench holds values from elsewhere within.
pub mod ranges {
    use std::ops::RangeInclusive;

    /// Times the lengths of a thing.
    pub const SIZE: RangeInclusive<f64> = 0.3..=4.0;
    /// Each component of the wind, and of the current, m/s.
    pub const WIND: RangeInclusive<f64> = -10.0..=10.0;
    /// Standard deviation of each component of the turbulence, m/s.
    pub const TURBULENCE: RangeInclusive<f64> = 0.0..=3.0;
    /// Size of the eddies, m.
    pub const EDDY: RangeInclusive<f64> = 0.02..=5.0;
    /// Height of the water's level over the ground, m.
    pub const LEVEL: RangeInclusive<f64> = 0.1..=2.0;
    /// Significant height of the waves, m.
    pub const WAVES: RangeInclusive<f64> = 0.0..=0.15;
    /// Coefficients C̃ of the thesis's law.
    pub const COEFFICIENT: RangeInclusive<f64> = 0.0..=5.0;
    /// Factors on the forces of any law.
    pub const FACTOR: RangeInclusive<f64> = 0.0..=4.0;
    /// Distance of a place from the middle, m.
    pub const PLACE: RangeInclusive<f64> = -8.0..=8.0;
    /// Height of a place over the ground, m.
    pub const HEIGHT: RangeInclusive<f64> = 0.0..=8.0;
    /// Each component of a velocity at the release, m/s.
    pub const SPEED: RangeInclusive<f64> = -20.0..=20.0;
    /// Each component of the spin at the release, rad/s.
    pub const SPIN: RangeInclusive<f64> = -100.0..=100.0;
    /// Bodies of one rain.
    pub const RAIN: RangeInclusive<f64> = 1.0..=200.0;
}

/// What bodies are in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Fluids {
    /// Air over the ground.
    Air,
    /// Water everywhere.
    Water,
    /// Air over a pond.
    Pond,
}

/// A viscous law by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Law {
    /// The default, [`PhysicalLaw`].
    Physical,
    /// [`ThesisLaw`] with [`Settings::coefficients`].
    Thesis,
    /// [`StochasticLaw`].
    Stochastic,
    /// An ideal fluid.
    Inviscid,
}

/// All settings.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// What bodies are in (default air).
    pub fluids: Fluids,
    /// Height of the pond's level over the ground, m (default 0.5).
    pub level: f64,
    /// Significant height of the pond's waves, m (default 0, at rest).
    pub waves: f64,
    /// Velocity of the uppermost fluid, m/s (default 0).
    pub wind: [f64; 3],
    /// Velocity of the pond's water, m/s (default 0).
    pub current: [f64; 3],
    /// Standard deviation of each component of the uppermost fluid's velocity, m/s (default 0).
    pub turbulence: f64,
    /// Size of its eddies, m (default 0.3).
    pub eddy: f64,
    /// How the fluid pushes back (default the physical law).
    pub law: Law,
    /// C̃ = (C_D, C_L1, C_L2) of the thesis's law (default those of its zigzag, for the damped law).
    pub coefficients: [f64; 3],
    /// Factors on drag, rotational and translational lift of any law (default 1).
    pub factors: [f64; 3],
    /// What moves bodies (default the law).
    pub method: Method,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            fluids: Fluids::Air,
            level: 0.5,
            waves: 0.0,
            wind: [0.0; 3],
            current: [0.0; 3],
            turbulence: 0.0,
            eddy: 0.3,
            law: Law::Physical,
            coefficients: ThesisLaw::DAMPED_ZIGZAG,
            factors: [1.0; 3],
            method: Method::Law,
        }
    }
}

/// Components of all waves of the pond.
const WAVES: usize = 24;
/// Height over length of the pond's waves: a fresh breeze's.
const STEEPNESS: f64 = 0.04;
/// Seed of the turbulence and of the waves.
const SEED: u64 = 7;

impl Settings {
    /// The uppermost fluid.
    pub fn fluid(&self) -> Fluid {
        match self.fluids {
            Fluids::Water => Fluid::WATER,
            Fluids::Air | Fluids::Pond => Fluid::AIR,
        }
    }

    /// The fluid at a height over the ground, m.
    pub fn fluid_at(&self, height: f64) -> Fluid {
        match self.fluids {
            Fluids::Pond if height < self.level => Fluid::WATER,
            _ => self.fluid(),
        }
    }

    /// The viscous law of all bodies.
    pub fn law(&self) -> ViscousLaw {
        match self.law {
            Law::Physical => ViscousLaw::Physical(PhysicalLaw::default()),
            Law::Thesis => ViscousLaw::Thesis(ThesisLaw::new(self.coefficients)),
            Law::Stochastic => ViscousLaw::Stochastic(StochasticLaw::default()),
            Law::Inviscid => ViscousLaw::Inviscid,
        }
    }

    /// The factors on its forces.
    pub fn factors(&self) -> ForceFactors {
        self.factors.map(|x| x as f32).into()
    }

    /// What bodies are in, with all that moves in it.
    ///
    /// # Errors
    /// What cannot be.
    pub fn medium(&self, wake: Option<TurbulentLayer>) -> Result<Medium, Error> {
        let mut upper = Layer::new(self.fluid());
        if self.wind != [0.0; 3] {
            upper = upper.with_flow(uniform(self.wind));
        }
        if self.turbulence > 0.0 {
            let state =
                TurbulenceState::from_intensity(self.turbulence as f32, 1.0, self.eddy as f32)?;
            upper = upper.with_turbulence(TurbulentLayer {
                seed: SEED,
                ..Turbulence::Homogeneous(state).into()
            });
        } else if let Some(wake) = wake {
            upper = upper.with_turbulence(wake);
        }
        if self.fluids != Fluids::Pond {
            return Ok(Medium::new(upper));
        }
        let mut water = Layer::new(Fluid::WATER);
        if self.current != [0.0; 3] {
            water = water.with_flow(uniform(self.current));
        }
        let medium = Medium::layered(upper, water).with_level(Vector::Y * self.level as f32)?;
        Ok(match self.surface()? {
            Some(waves) => medium.with_surface(waves),
            None => medium,
        })
    }

    /// The waves of the pond, if it has some.
    ///
    /// # Errors
    /// What cannot be.
    pub fn surface(&self) -> Result<Option<Waves>, Error> {
        if self.fluids != Fluids::Pond || self.waves == 0.0 {
            return Ok(None);
        }
        let length = self.waves / STEEPNESS;
        let period = (TAU * length / crate::GRAVITY).sqrt();
        Waves::sea(&Sea {
            spectrum: WaveSpectrum::jonswap(self.waves, period, 3.3)?,
            direction: [0.9, 0.4],
            waves: WAVES,
            seed: SEED,
            ..Sea::default()
        })
        .map(Some)
    }

    /// Whether bodies are moved in the same way: all but the motion of the fluids is the same.
    pub fn moves_as(&self, other: &Self) -> bool {
        let of = |s: &Self| (s.fluids, s.law, s.method, s.coefficients, s.factors);
        of(self) == of(other)
    }

    /// Whether two settings have the same medium, but for what moves in it.
    pub fn same_fluids(&self, other: &Self) -> bool {
        (self.fluids, self.level, self.waves) == (other.fluids, other.level, other.waves)
    }
}

/// The same velocity everywhere, m/s.
pub(crate) fn uniform(velocity: [f64; 3]) -> Uniform {
    let [x, y, z] = velocity.map(|x| x as f32);
    Uniform::new(x, y, z)
}
