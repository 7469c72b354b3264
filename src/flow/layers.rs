//! The sum of several flows, and a flow that several owners share.

use super::{Flow, FlowSample};
use rapier3d::math::Vector;
use std::sync::Arc;

/// The sum of several flows: a gust over a mean wind, a turbulent field over either.
///
/// ```
/// use rapier3d_immersed::flow::{Flow, Layers, Shear, Uniform};
/// use rapier3d_immersed::rapier3d::prelude::*;
///
/// let shear = Shear { across: Vector::Y, rate: Vector::Z, ..Shear::default() };
/// let flow = Layers::new().with(Uniform::new(1.0, 0.0, 0.0)).with(shear);
/// assert_eq!(flow.velocity(Vector::Y * 2.0, 0.0), Vector::new(1.0, 0.0, 2.0));
/// ```
#[derive(Default)]
pub struct Layers {
    /// The flows whose velocities and vorticities are added up.
    pub flows: Vec<Box<dyn Flow>>,
}

impl Layers {
    /// Fluid at rest, to which [`Layers::with`] adds flows.
    pub fn new() -> Self {
        Self::default()
    }

    /// These flows with `flow` on top.
    #[must_use]
    pub fn with(mut self, flow: impl Flow + 'static) -> Self {
        self.flows.push(Box::new(flow));
        self
    }
}

/// How many points are sampled at once, so that one layer's samples fit on the stack.
const CHUNK: usize = 64;

impl Flow for Layers {
    fn velocity(&self, point: Vector, time: f64) -> Vector {
        self.flows
            .iter()
            .map(|flow| flow.velocity(point, time))
            .sum()
    }

    fn vorticity(&self, point: Vector, time: f64) -> Vector {
        self.flows
            .iter()
            .map(|flow| flow.vorticity(point, time))
            .sum()
    }

    fn sample(&self, points: &[Vector], time: f64, samples: &mut [FlowSample]) {
        let mut layer = [FlowSample::default(); CHUNK];
        for (points, samples) in points.chunks(CHUNK).zip(samples.chunks_mut(CHUNK)) {
            samples.fill(FlowSample::default());
            for flow in &self.flows {
                let layer = &mut layer[..points.len()];
                flow.sample(points, time, layer);
                for (sample, added) in samples.iter_mut().zip(layer) {
                    sample.velocity += added.velocity;
                    sample.vorticity += added.vorticity;
                }
            }
        }
    }
}

/// A flow that several owners share, e.g. a large baked field in two immersions.
impl<F: Flow + ?Sized> Flow for Arc<F> {
    fn velocity(&self, point: Vector, time: f64) -> Vector {
        (**self).velocity(point, time)
    }

    fn vorticity(&self, point: Vector, time: f64) -> Vector {
        (**self).vorticity(point, time)
    }

    fn sample(&self, points: &[Vector], time: f64, samples: &mut [FlowSample]) {
        (**self).sample(points, time, samples);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::{Gust, Shear, Uniform, tests::assert_curl_matches};

    #[test]
    fn layers_add_up_point_by_point_and_in_batches() {
        let shear = Shear {
            across: Vector::Y,
            rate: Vector::X,
            ..Shear::default()
        };
        let gust = Gust {
            velocity: Vector::Z,
            ..Gust::default()
        };
        let flow = Layers::new()
            .with(Uniform::new(1.0, 2.0, 3.0))
            .with(Arc::new(shear))
            .with(gust);
        let at = flow.velocity(Vector::new(0.0, 4.0, 0.0), 0.5);
        assert!((at - Vector::new(5.0, 2.0, 4.0)).length() < 1.0e-6);
        assert_curl_matches(&flow, Vector::new(1.0, 2.0, 3.0), 0.3);

        // There are more points than one chunk holds, and the samples are not zero before.
        let points: Vec<_> = (0..150).map(|i| Vector::Y * i as f32).collect();
        let mut samples = vec![
            FlowSample {
                velocity: Vector::ONE,
                vorticity: Vector::ONE,
                ..FlowSample::default()
            };
            150
        ];
        flow.sample(&points, 0.25, &mut samples);
        for (point, sample) in points.iter().zip(&samples) {
            assert_eq!(sample.velocity, flow.velocity(*point, 0.25));
            assert_eq!(sample.vorticity, flow.vorticity(*point, 0.25));
        }
    }
}
