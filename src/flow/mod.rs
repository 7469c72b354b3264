//! The motion of the fluid itself: velocity fields, to be given to an
//! [`Immersion`](crate::Immersion) with [`set_flow`](crate::Immersion::set_flow).
//!
//! [`Uniform`], [`Shear`], [`Vortex`] and [`Gust`] have closed forms and cost next to nothing; [`LogLaw`]
//! is the mean wind over ground. [`GridFlow`] looks up a field that was computed elsewhere, and
//! [`SpectralWind`] a gusty wind of a prescribed spectrum. [`Within`] keeps a flow to a volume, [`Shelter`] weakens it
//! behind obstacles. [`Layers`] adds several of them up, and any other
//! field implements [`Flow`]. Fluctuations that are too fine for any field are turbulence: see
//! [`turbulence`](crate::turbulence).
//!
//! ```
//! use rapier3d_immersed::flow::{Flow, Gust, Layers, LogLaw};
//! use rapier3d_immersed::rapier3d::prelude::*;
//! use rapier3d_immersed::{Fluid, Immersion};
//!
//! // 4 m/s at a height of 10 m over rough ground, and a gust of 2 m/s that lasts from 3 to 5 s.
//! let wind = LogLaw::new(Vector::X, Vector::Y, 4.0, 10.0, 0.3)?;
//! let gust = Gust { velocity: Vector::X * 2.0, start: 3.0, duration: 2.0, ..Gust::default() };
//! let flow = Layers::new().with(wind).with(gust);
//! assert!((flow.velocity(Vector::Y * 10.0, 4.0).x - 6.0).abs() < 1e-5);
//!
//! let mut immersion = Immersion::new(Fluid::AIR);
//! immersion.set_flow(flow);
//! # Ok::<(), rapier3d_immersed::Error>(())
//! ```
//!
//! A new flow touches two files: its own and this one. Its own implements [`Flow`], with the vorticity and,
//! where a batch is cheaper than its points, [`Flow::sample`]; this one declares the module and re-exports
//! the type.

mod analytic;
mod cells;
mod grid;
mod lattice;
mod layers;
mod log_law;
mod shelter;
mod wind;
#[cfg(feature = "bake")]
mod wind_bake;
#[cfg(feature = "bake")]
mod wind_params;
mod within;

pub use analytic::{Gust, Shear, Vortex};
pub use grid::GridFlow;
pub use layers::Layers;
pub use log_law::LogLaw;
pub use shelter::Shelter;
pub use wind::{HeightLaw, SpectralWind};
#[cfg(feature = "bake")]
pub use wind_params::{Spectrum, WindParams};
pub use within::Within;

use rapier3d::math::{Real, Vector};

/// What the fluid does at one point, in world axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlowSample {
    /// Velocity of the fluid, m/s.
    pub velocity: Vector,
    /// Vorticity (curl of the velocity), 1/s. A small body that follows the fluid spins at half of it.
    pub vorticity: Vector,
    /// Rate of strain. It turns small bodies that are not round, in creeping flow: see [`StrainRate`].
    pub strain: StrainRate,
}

/// The symmetric part of the velocity's gradient, world axes, 1/s: how the fluid stretches and shears.
///
/// In creeping flow a long body turns with half the vorticity and with the strain that would lay it
/// along the direction of stretching, so that in a shear flow it tumbles unevenly, with the period
/// (2π/rate)(r + 1/r), r its length over its width (Jeffery 1922).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StrainRate {
    /// ∂U_x/∂x, ∂U_y/∂y, ∂U_z/∂z; their sum is zero in an incompressible fluid.
    pub stretching: Vector,
    /// ½(∂U_y/∂z + ∂U_z/∂y), ½(∂U_z/∂x + ∂U_x/∂z), ½(∂U_x/∂y + ∂U_y/∂x).
    pub shearing: Vector,
}

impl StrainRate {
    /// From the velocity's derivatives along x, y and z.
    pub fn of_gradient(along_x: Vector, along_y: Vector, along_z: Vector) -> Self {
        Self {
            stretching: Vector::new(along_x.x, along_y.y, along_z.z),
            shearing: Vector::new(
                along_z.y + along_y.z,
                along_x.z + along_z.x,
                along_y.x + along_x.y,
            ) * 0.5,
        }
    }
}

impl std::ops::Mul<Real> for StrainRate {
    type Output = Self;

    fn mul(self, factor: Real) -> Self {
        Self {
            stretching: self.stretching * factor,
            shearing: self.shearing * factor,
        }
    }
}

/// A velocity field: the one trait that users implement.
///
/// Bodies feel the flow at their center of mass, bodies of parts at each part. All quantities are in world axes and SI units;
/// `time` is the [time of the immersion](crate::Immersion::time): the seconds that it has been stepped.
///
/// ```
/// use rapier3d_immersed::flow::Flow;
/// use rapier3d_immersed::rapier3d::prelude::*;
/// use rapier3d_immersed::{Fluid, HydroProperties, Immersion};
///
/// /// Water that flows in over the bottom of a tank and rises toward its middle.
/// struct Upwelling;
///
/// impl Flow for Upwelling {
///     fn velocity(&self, point: Vector, _time: f64) -> Vector {
///         Vector::new(-0.5 * point.x, point.y, -0.5 * point.z)
///     }
/// }
///
/// let mut world = PhysicsWorld::new();
/// let body = RigidBodyBuilder::dynamic().translation(Vector::new(0.2, 0.1, 0.0));
/// let (bead, _) = world.insert(body, ColliderBuilder::ball(0.002).density(1000.0));
/// let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, bead)?;
/// let mut immersion = Immersion::new(Fluid::WATER);
/// immersion.insert(bead, hydro);
/// immersion.set_flow(Upwelling);
/// (0..60).for_each(|_| immersion.step(&mut world));
/// // A bead as heavy as water is carried along: inwards and upwards.
/// let at = world.bodies[bead].translation();
/// assert!(at.x < 0.17 && at.y > 0.13);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
pub trait Flow: Send + Sync {
    /// Velocity of the fluid at `point` and `time`, m/s.
    fn velocity(&self, point: Vector, time: f64) -> Vector;

    /// Curl of the velocity at `point` and `time`, 1/s. Unless a flow implements it, it is zero, and
    /// bodies do not feel that the flow shears.
    fn vorticity(&self, _point: Vector, _time: f64) -> Vector {
        Vector::ZERO
    }

    /// Rate of strain at `point` and `time` around a body of half the size `reach`, m.
    ///
    /// Unless a flow implements it, it is differenced from six velocities at that distance, or somewhat
    /// farther where single precision would not tell them apart. The step asks for it only around bodies that it turns: those
    /// whose Reynolds number is below 30.
    fn strain_rate(&self, point: Vector, time: f64, reach: Real) -> StrainRate {
        let reach = reach.max(1e-3 * (1.0 + point.abs().max_element()));
        let along = |axis: Vector| {
            let step = axis * reach;
            (self.velocity(point + step, time) - self.velocity(point - step, time)) / (2.0 * reach)
        };
        StrainRate::of_gradient(along(Vector::X), along(Vector::Y), along(Vector::Z))
    }

    /// Samples many points at once, without the rate of strain. The step calls this once per batch of bodies, so that the
    /// loop inside is free of virtual calls; override it where a batch is cheaper than its points.
    ///
    /// `points` and `samples` have the same length. The crate's own grid and wind take 8 to 25 ns per point
    /// of a batch, and 20 to 65 ns when a point is asked for alone by [`Flow::velocity`].
    fn sample(&self, points: &[Vector], time: f64, samples: &mut [FlowSample]) {
        for (point, sample) in points.iter().zip(samples) {
            sample.velocity = self.velocity(*point, time);
            sample.vorticity = self.vorticity(*point, time);
        }
    }
}

/// What a batch finds that consists of `point` alone.
fn alone(flow: &impl Flow, point: Vector, time: f64) -> FlowSample {
    let mut sample = [FlowSample::default()];
    flow.sample(&[point], time, &mut sample);
    sample[0]
}

/// Fluid at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Still;

impl Flow for Still {
    fn velocity(&self, _point: Vector, _time: f64) -> Vector {
        Vector::ZERO
    }
}

/// The same velocity everywhere and always.
///
/// ```
/// use rapier3d_immersed::flow::{Flow, Uniform};
/// use rapier3d_immersed::rapier3d::prelude::*;
///
/// let breeze = Uniform::new(2.0, 0.0, 0.0);
/// assert_eq!(breeze.velocity(Vector::Y * 30.0, 7.0), Vector::X * 2.0);
/// assert_eq!(breeze.vorticity(Vector::Y * 30.0, 7.0), Vector::ZERO);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Uniform {
    /// Velocity of the fluid, m/s, world axes.
    pub velocity: Vector,
}

impl Uniform {
    /// A uniform flow along `velocity` (m/s).
    pub fn new(x: Real, y: Real, z: Real) -> Self {
        Self {
            velocity: Vector::new(x, y, z),
        }
    }
}

impl Flow for Uniform {
    fn velocity(&self, _point: Vector, _time: f64) -> Vector {
        self.velocity
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A few points that are not special to any flow.
    pub(crate) fn points() -> [Vector; 4] {
        [
            Vector::new(0.13, 0.71, -0.37),
            Vector::new(-1.21, 0.35, 0.55),
            Vector::new(2.03, 1.47, 1.19),
            Vector::new(0.02, 0.44, -0.01),
        ]
    }

    /// Compares the flow's vorticity with central differences of its velocity. The step of 2⁻⁷ m leaves
    /// a rounding error of about 1e-5 of the speed and a truncation error far below the tolerance.
    pub(crate) fn assert_curl_matches(flow: &dyn Flow, point: Vector, time: f64) {
        let h = 1.0 / 128.0;
        let d = |axis: Vector| {
            (flow.velocity(point + axis * h, time) - flow.velocity(point - axis * h, time))
                / (2.0 * h)
        };
        let (dx, dy, dz) = (d(Vector::X), d(Vector::Y), d(Vector::Z));
        let curl = Vector::new(dy.z - dz.y, dz.x - dx.z, dx.y - dy.x);
        let found = flow.vorticity(point, time);
        assert!(
            (curl - found).length() < 2.0e-3 * (1.0 + found.length()),
            "{point}: {found}, but by differences {curl}"
        );
        let mut samples = [FlowSample::default(); 1];
        flow.sample(&[point], time, &mut samples);
        assert!((samples[0].velocity - flow.velocity(point, time)).length() < 1.0e-5);
        assert!((samples[0].vorticity - found).length() < 1.0e-4 * (1.0 + found.length()));
    }
}
