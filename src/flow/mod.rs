//! The motion of the fluid itself: what the bodies are immersed *in*.

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
    /// `points` and `samples` have the same length.
    fn sample(&self, points: &[Vector], time: f64, samples: &mut [FlowSample]) {
        for (point, sample) in points.iter().zip(samples) {
            sample.velocity = self.velocity(*point, time);
            sample.vorticity = self.vorticity(*point, time);
        }
    }
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
