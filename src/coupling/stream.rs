//! What the fluid does around each body of a batch: its mean flow, and turbulence on top.

use super::flight::{Extra, Flyer, row, vector};
use super::immersion::{FlightState, Immersion, NONE};
use super::step::{Batch, RapierSets};
use crate::flow::FlowSample;
use crate::fluid::Fluid;
use crate::turbulence::{
    Eddies, LangevinMode, NoiseStream, SeenFluctuation, Turbulence, TurbulenceState,
    TurbulentLayer, kolmogorov_constant, relative_velocity_after, spin_increment,
};
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::math::{Real, Vector};

/// Memory that is reused from batch to batch.
#[derive(Clone, Default)]
pub(super) struct Sampler {
    points: Vec<Vector>,
    samples: Vec<FlowSample>,
}

/// What a body remembers of the turbulence that it flies through.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct Stirred {
    seen: SeenFluctuation,
    /// Time of the immersion when the turbulence first acted on the body, s.
    since: Option<f64>,
    /// The fluctuation of the fluid's velocity in the last step, m/s.
    pub fluctuation: Vector,
    /// The body's velocity through the fluid that it sees, averaged over [`AVERAGED`] memories, m/s.
    /// The momentary one would be correlated with the fluctuation, whose memory it sets, and would
    /// make strong fluctuations last less: a sixth of the variance would be lost.
    slip: Vector,
}

/// Time over which the slip is averaged, in memories of a tracer: long enough for the correlation with
/// the fluctuation to fade, short enough for a leaf to reach its falling speed.
const AVERAGED: Real = 10.0;

/// The turbulence of one step.
struct Step<'a> {
    layer: &'a TurbulentLayer,
    /// The turbulence where it is the same for all bodies.
    common: Option<Local>,
    viscosity: Real,
    time: f64,
    dt: Real,
    number: u64,
}

/// The turbulence at one place and time.
#[derive(Clone, Copy)]
struct Local {
    state: TurbulenceState,
    c0: Real,
    eddies: Eddies,
    /// Weight of this step in the average of the slip.
    weight: Real,
}

impl Local {
    fn new(state: TurbulenceState, viscosity: Real, dt: Real) -> Self {
        let c0 = kolmogorov_constant(state.taylor_reynolds_squared(viscosity));
        // A state of zero dissipation (or a wild one, from a table of the user's) stirs nothing.
        let c0 = if c0.is_finite() { c0 } else { 0.0 };
        let eddies = Eddies::new(&state, c0, dt);
        Self {
            state,
            c0,
            eddies,
            // share/(1 + share), also where the share is infinite.
            weight: 1.0 - 1.0 / (1.0 + eddies.decay / AVERAGED),
        }
    }
}

/// What one step of turbulence does to a body.
#[derive(Default)]
struct Gust {
    /// Fluctuation of the fluid's velocity, m/s.
    fluctuation: Vector,
    /// Changes of the body's own velocities, m/s and rad/s.
    linear: Vector,
    angular: Vector,
}

impl<'a> Step<'a> {
    fn new(layer: &'a TurbulentLayer, fluid: &Fluid, time: f64, dt: Real, number: u64) -> Self {
        let viscosity = fluid.kinematic_viscosity();
        let common = match &layer.source {
            Turbulence::Homogeneous(state) => Some(Local::new(*state, viscosity, dt)),
            _ => None,
        };
        Self {
            layer,
            common,
            viscosity,
            time,
            dt,
            number,
        }
    }

    /// `relative` is the body's velocity less the mean flow's, `length` its size.
    fn stir(
        &self,
        body: RigidBodyHandle,
        stirred: &mut Stirred,
        point: Vector,
        relative: Vector,
        length: Real,
    ) -> Gust {
        let (index, generation) = body.into_raw_parts();
        let number = u64::from(generation) << 32 | u64::from(index);
        let noise = NoiseStream::new(self.layer.seed, number);
        let first = stirred.since.is_none();
        let since = *stirred.since.get_or_insert(self.time);
        let local = self.common.unwrap_or_else(|| {
            let state = self.layer.source.at(point, self.time, self.time - since);
            Local::new(state, self.viscosity, self.dt)
        });
        let first_draw = noise.vector(self.number, 0);
        let mut gust = Gust::default();
        match self.layer.mode {
            LangevinMode::FluidSeen => {
                if first {
                    stirred.seen = SeenFluctuation::stationary(first_draw);
                    stirred.slip = relative;
                }
                let noise = if first {
                    noise.vector(self.number, 1)
                } else {
                    first_draw
                };
                let slip = relative - stirred.fluctuation;
                stirred.slip += (slip - stirred.slip) * local.weight;
                let slip2 = stirred.slip.length_squared();
                gust.fluctuation = stirred.seen.pass(&local.eddies, slip2, noise);
            }
            LangevinMode::BodyIncrements => {
                let after =
                    relative_velocity_after(relative, &local.state, local.c0, self.dt, first_draw);
                gust.linear = after - relative;
                let second = noise.vector(self.number, 1);
                gust.angular = spin_increment(&local.state, local.c0, length, self.dt, second);
            }
        }
        let whole = gust.fluctuation + gust.linear + gust.angular;
        if !whole.is_finite() {
            gust = Gust::default();
        }
        stirred.fluctuation = gust.fluctuation;
        gust
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

/// Lets the fluid move past a body with `sample`.
fn immerse_in(
    sample: &FlowSample,
    flyer: &mut Flyer,
    flight: &mut FlightState,
    extras: &mut Vec<Extra>,
) {
    let change = sample.velocity - flight.stream;
    // In the frame of the fluid: a body that goes on is there already, but the frame itself has
    // changed its velocity.
    let frame = if flyer.goes_on {
        change
    } else {
        sample.velocity
    };
    let extra = extra_of(flyer, extras);
    extra.stream = row(sample.velocity);
    extra.vorticity = row(sample.vorticity);
    if flight.flying {
        extra.stream_change = row(change);
    }
    extra.linear = row(vector(extra.linear) - frame);
    flyer.turned |= sample.vorticity != Vector::ZERO;
    flight.stream = sample.velocity;
}

impl Immersion {
    /// Reads the flow at every flyer, stirs it by turbulence, and lets its changes push the bodies
    /// in it.
    pub(super) fn sample_fluid(
        &mut self,
        batch: &mut Batch,
        sets: &RapierSets,
        sampler: &mut Sampler,
        dt: Real,
    ) {
        if self.flow.is_none() && self.turbulence.is_none() {
            return;
        }
        let Sampler { points, samples } = sampler;
        let Batch { flyers, extras } = batch;
        points.clear();
        points.extend(flyers.iter().map(|flyer| {
            let body = sets.bodies.get(flyer.handle);
            body.map_or(Vector::ZERO, |body| body.center_of_mass())
        }));
        samples.clear();
        samples.resize(points.len(), FlowSample::default());
        if let Some(flow) = &self.flow {
            flow.sample(points, self.time, samples);
        }
        let layer = self.turbulence.as_ref();
        let step = layer.map(|layer| Step::new(layer, &self.fluid, self.time, dt, self.steps));
        for ((flyer, sample), point) in flyers.iter_mut().zip(samples).zip(points) {
            if !sample.velocity.is_finite() || !sample.vorticity.is_finite() {
                continue;
            }
            let Some(slot) = &mut self.slots[flyer.slot as usize] else {
                continue;
            };
            let flight = &mut slot.flight;
            if let Some(step) = &step {
                let relative = vector(flyer.rapier_linear) - sample.velocity;
                let length = self.kinds[flyer.kind as usize].constants.length as Real;
                let gust = step.stir(flyer.handle, &mut flight.stirred, *point, relative, length);
                sample.velocity += gust.fluctuation;
                if step.layer.mode == LangevinMode::BodyIncrements {
                    let extra = extra_of(flyer, extras);
                    extra.linear = row(vector(extra.linear) + gust.linear);
                    extra.angular = row(vector(extra.angular) + gust.angular);
                }
            }
            immerse_in(sample, flyer, flight, extras);
        }
    }
}
