//! What the fluid does around each body of a batch: its mean flow, and turbulence on top.

use super::flight::{Extra, Flyer, row, vector};
use super::immersion::Immersion;
use super::scratch::Batch;
use super::slot::{FlightState, NONE};
use super::stir::{Stir, Stirring};
use crate::flow::FlowSample;
use crate::math::{Row, dispatch};
use crate::turbulence::LangevinMode;
use rapier3d::math::Real;

/// What flows past a flyer. World axes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Stream {
    /// Velocity of the fluid, m/s; that of the last step until the flow has been sampled.
    pub velocity: Row,
    /// Its vorticity, 1/s.
    pub vorticity: Row,
    /// Change of its velocity since the last step, m/s; zero for a body that was not flying then,
    /// of which the last number tells.
    pub change: Row,
}

impl Stream {
    /// What a body remembers of the last step.
    #[inline(always)]
    pub fn before(flight: &FlightState) -> Self {
        Self {
            velocity: row(flight.stream),
            vorticity: [0.0; 4],
            change: [0.0, 0.0, 0.0, f32::from(u8::from(flight.flying))],
        }
    }

    /// Goes on to this step's flow. Where that is no number the fluid stays as it was.
    #[inline(always)]
    fn go_on(&mut self, sample: &FlowSample) {
        if (sample.velocity + sample.vorticity).is_finite() {
            let change = sample.velocity - vector(self.velocity);
            self.change = row(change * self.change[3]);
            self.velocity = row(sample.velocity);
            self.vorticity = row(sample.vorticity);
        }
    }
}

/// A flyer's extra, made if there is none yet.
fn extra_of<'a>(flyer: &mut Flyer, extras: &'a mut Vec<Extra>) -> &'a mut Extra {
    if flyer.extra == NONE {
        flyer.extra = extras.len() as u32;
        extras.push(Extra::default());
    }
    &mut extras[flyer.extra as usize]
}

impl Immersion {
    /// Reads the flow at every flyer and stirs it by turbulence.
    pub(super) fn sample_fluid(&self, batch: &mut Batch, samples: &mut Vec<FlowSample>, dt: Real) {
        let Batch {
            flyers,
            extras,
            points,
            streams,
            stirred,
        } = batch;
        if streams.is_empty() {
            return;
        }
        samples.clear();
        samples.resize(points.len(), FlowSample::default());
        if let Some(flow) = &self.flow {
            flow.sample(points, self.time, samples);
        }
        if let Some(layer) = &self.turbulence {
            let stirring = Stirring::new(layer, &self.fluid, self.time, dt, self.steps);
            match layer.mode {
                LangevinMode::FluidSeen => dispatch(Stir {
                    stirring: &stirring,
                    flyers,
                    points,
                    samples,
                    stirred,
                }),
                LangevinMode::BodyIncrements => {
                    for (i, flyer) in flyers.iter_mut().enumerate() {
                        let length = self.kinds[flyer.kind as usize].constants.length as Real;
                        let relative = vector(flyer.rapier_linear) - samples[i].velocity;
                        let (linear, angular) = stirring.increments(
                            flyer.handle,
                            &mut stirred[i],
                            points[i],
                            relative,
                            length,
                        );
                        let extra = extra_of(flyer, extras);
                        extra.linear = row(vector(extra.linear) + linear);
                        extra.angular = row(vector(extra.angular) + angular);
                    }
                }
            }
        }
        for (stream, sample) in streams.iter_mut().zip(samples) {
            stream.go_on(sample);
        }
    }
}
