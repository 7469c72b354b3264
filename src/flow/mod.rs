//! The motion of the fluid itself: what the bodies are immersed *in*.

mod analytic;
mod cells;
mod grid;
mod lattice;
mod layers;
mod log_law;
mod wind;
#[cfg(feature = "bake")]
mod wind_bake;
#[cfg(feature = "bake")]
mod wind_params;

pub use analytic::{Gust, Shear, Vortex};
pub use grid::GridFlow;
pub use layers::Layers;
pub use log_law::LogLaw;
pub use wind::{HeightLaw, SpectralWind};
#[cfg(feature = "bake")]
pub use wind_params::{Spectrum, WindParams};

use rapier3d::math::{Real, Vector};

/// What the fluid does at one point, in world axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlowSample {
    /// Velocity of the fluid, m/s.
    pub velocity: Vector,
    /// Vorticity (curl of the velocity), 1/s. A small body that follows the fluid spins at half of it.
    pub vorticity: Vector,
}

/// A velocity field: the one trait that users implement.
///
/// Bodies feel the flow at their center of mass. All quantities are in world axes and SI units;
/// `time` is the time of the [immersion](crate), in seconds since it was created.
pub trait Flow: Send + Sync {
    /// Velocity of the fluid at `point` and `time`, m/s.
    fn velocity(&self, point: Vector, time: f64) -> Vector;

    /// Curl of the velocity at `point` and `time`, 1/s. Zero unless implemented: bodies then do
    /// not feel that the flow shears.
    fn vorticity(&self, _point: Vector, _time: f64) -> Vector {
        Vector::ZERO
    }

    /// Samples many points at once. The step calls this once per batch of bodies, so that the
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

/// What a batch of one point finds there.
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

    /// The flow's vorticity against central differences of its velocity. The step of 2⁻⁷ m leaves
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
