//! What a particle of a suspension is, and what moves it.

use crate::body::DryMass;
use crate::error::Error;
use crate::fluid::Fluid;
use crate::hydro::HydroProperties;
use crate::math;
use crate::math::Scalar;
use rapier3d::math::{Real, Vector};
use std::f64::consts::PI;

/// A particle that is small enough for its Reynolds number to stay below 10, or not far above.
///
/// ```
/// use rapier3d_immersed::playback::Particle;
/// use rapier3d_immersed::Fluid;
///
/// // A grain of dust of 30 µm: its velocity relaxes within 7 ms, and it falls at 68 mm/s.
/// let dust = Particle::sphere(30e-6, 2650.0)?;
/// let (time, fall) = (dust.relaxation_time(&Fluid::AIR), dust.settling_speed(&Fluid::AIR, 9.81));
/// assert!((time - 7.2e-3).abs() < 1e-4 && (fall - 0.0678).abs() < 2e-4);
/// assert!(dust.reynolds_at(&Fluid::AIR, fall) < 0.2);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// Its own mass, kg.
    pub mass: f64,
    /// Volume that it displaces, m³.
    pub volume: f64,
    /// Added mass over the fluid's density, m³: a sphere's is half its volume.
    pub added_volume: f64,
    /// Resistance in creeping flow over dynamic viscosity, m: a sphere's is 3πd (Stokes 1851).
    pub resistance: f64,
}

/// Factor and exponent of the drag over that of creeping flow, 1 + 0.15 Re^0.687 for spheres up to Re = 800 (Schiller &
/// Naumann 1933).
const EXCESS: (Real, Real) = (0.15, 0.687);
/// Below this Reynolds number the drag is Stokes's: the excess is 1.3·10⁻⁵ there.
const CREEPING: Real = 1e-6;

impl Particle {
    /// A sphere by its diameter (m) and density (kg/m³). A flake of snow may be given as the sphere around it, with what it
    /// weighs over that sphere's volume.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] names what is not positive and finite.
    pub fn sphere(diameter: f64, density: f64) -> Result<Self, Error> {
        Error::check_positive("diameter", diameter)?;
        Error::check_positive("density", density)?;
        let volume = PI / 6.0 * diameter.powi(3);
        let sphere = Self {
            mass: density * volume,
            volume,
            added_volume: 0.5 * volume,
            resistance: 3.0 * PI * diameter,
        };
        sphere.check()?;
        Ok(sphere)
    }

    /// A body in all attitudes alike: its mobility in creeping flow and its added mass are the means of its three axes', that of the
    /// [ellipsoid](HydroProperties::proxy) that stands for it.
    ///
    /// # Errors
    /// Those of [`Particle::check`].
    pub fn of_body(hydro: &HydroProperties, mass: &DryMass) -> Result<Self, Error> {
        let resistance = hydro.proxy.stokes_resistance().linear;
        let particle = Self {
            mass: mass.mass,
            volume: hydro.volume,
            added_volume: hydro.added_mass.linear.trace() / 3.0,
            resistance: 3.0 / resistance.map(|r| 1.0 / r).sum(),
        };
        particle.check()?;
        Ok(particle)
    }

    /// # Errors
    /// [`Error::InvalidParameter`] names what is not positive and finite; the added volume may be zero.
    pub fn check(&self) -> Result<(), Error> {
        Error::check_positive("mass of the particle", self.mass)?;
        Error::check_positive("volume of the particle", self.volume)?;
        Error::check_positive("resistance of the particle", self.resistance)?;
        Error::check_not_negative("added volume of the particle", self.added_volume)?;
        Ok(())
    }

    /// Diameter of the sphere of its volume, m: what its Reynolds number is on.
    pub fn diameter(&self) -> f64 {
        math::cbrt(6.0 / PI * self.volume)
    }

    /// Reynolds number at a speed (m/s) through the fluid.
    pub fn reynolds_at(&self, fluid: &Fluid, speed: f64) -> f64 {
        speed * self.diameter() / f64::from(fluid.kinematic_viscosity())
    }

    /// Time in which all but 1/e of a slow velocity through the fluid is lost, s: mass and added mass over Stokes's
    /// resistance.
    pub fn relaxation_time(&self, fluid: &Fluid) -> f64 {
        let added = f64::from(fluid.density()) * self.added_volume;
        (self.mass + added) / (f64::from(fluid.dynamic_viscosity()) * self.resistance)
    }

    /// Speed at which it falls through fluid at rest, or rises if it is negative, under a gravity of this size (m/s²), m/s.
    pub fn settling_speed(&self, fluid: &Fluid, gravity: f64) -> f64 {
        let buoyant = self.mass - f64::from(fluid.density()) * self.volume;
        let creeping = buoyant * gravity / (f64::from(fluid.dynamic_viscosity()) * self.resistance);
        // Newton's method for s (1 + 0.15 (s Re₁)^0.687) = s₀, which grows and is convex: from above it converges.
        let (factor, power) = (f64::from(EXCESS.0), f64::from(EXCESS.1));
        let (target, mut speed) = (creeping.abs(), creeping.abs());
        for _ in 0..64 {
            let excess = factor * math::powf(self.reynolds_at(fluid, speed), power);
            let miss = speed * (1.0 + excess) - target;
            speed -= miss / (1.0 + (1.0 + power) * excess);
        }
        speed.copysign(creeping)
    }

    /// What moves it in a fluid, in single precision.
    ///
    /// # Errors
    /// Those of [`Particle::check`]; [`Error::BeyondSinglePrecision`].
    pub(super) fn motion(&self, fluid: &Fluid) -> Result<ParticleMotion, Error> {
        self.check()?;
        let density = f64::from(fluid.density());
        let (displaced, added) = (density * self.volume, density * self.added_volume);
        let mass = self.mass + added;
        let motion = ParticleMotion {
            creeping_rate: (1.0 / self.relaxation_time(fluid)) as Real,
            reynolds_per_speed: self.reynolds_at(fluid, 1.0) as Real,
            weight: ((self.mass - displaced) / mass) as Real,
            carried: ((displaced + added) / mass) as Real,
        };
        let numbers = [motion.creeping_rate, motion.reynolds_per_speed];
        let known =
            numbers.iter().all(|x| x.is_normal()) && (motion.weight + motion.carried).is_finite();
        if known {
            Ok(motion)
        } else {
            let length = 0.5 * self.diameter();
            Err(Error::BeyondSinglePrecision { mass, length })
        }
    }
}

/// The equation of a particle's velocity v in a fluid of velocity u,
/// `dv/dt = c f(Re) (u − v) + w g + b du/dt` (Maxey & Riley 1983 without history and curvature of the flow).
#[derive(Clone, Copy, Debug)]
pub(super) struct ParticleMotion {
    /// c, 1/s.
    creeping_rate: Real,
    /// Re over speed, s/m.
    reynolds_per_speed: Real,
    /// w: what is left of its weight, over mass and added mass.
    pub weight: Real,
    /// b: 1 for a particle as heavy as the fluid, 3 for a light one.
    pub carried: Real,
}

impl ParticleMotion {
    /// Drag over mass and velocity, at a speed through the fluid, 1/s.
    #[inline]
    pub fn drag_rate(&self, speed: Real) -> Real {
        let reynolds = speed * self.reynolds_per_speed;
        if reynolds > CREEPING {
            let excess = EXCESS.0 * Scalar::exp(EXCESS.1 * Scalar::ln(reynolds));
            self.creeping_rate * (1.0 + excess)
        } else {
            self.creeping_rate
        }
    }

    /// Velocity relative to the fluid at which drag and weight balance, m/s.
    pub fn settling_velocity(&self, gravity: Vector) -> Vector {
        let pull = gravity * self.weight;
        let mut velocity = pull / self.creeping_rate;
        // The drag depends on the speed by a power below 1, so that this converges: by 0.41 or less each time up to Re = 800.
        for _ in 0..40 {
            velocity = pull / self.drag_rate(velocity.length());
        }
        velocity
    }
}
