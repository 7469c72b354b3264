//! Turbulence around each body of a batch.

use super::flight::{Flyer, row, vector};
use crate::flow::FlowSample;
use crate::fluid::Fluid;
use crate::math::{Lanes, MOST_LANES, OnLanes, Row};
use crate::turbulence::{
    Eddies, LangevinMode, NoiseStream, SeenFluctuation, Turbulence, TurbulenceState,
    TurbulentLayer, gaussian, kolmogorov_constant, pass, relative_velocity_after, spin_increment,
};
use fearless_simd::Simd;
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::math::{Real, Vector};

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
pub(super) struct Stirring<'a> {
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
    eddies: Eddies<Real>,
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

    fn row(&self) -> Row {
        let Eddies {
            decay,
            deviation,
            per_variance,
        } = self.eddies;
        [decay, deviation, per_variance, self.weight]
    }
}

impl<'a> Stirring<'a> {
    pub fn new(layer: &'a TurbulentLayer, fluid: &Fluid, time: f64, dt: Real, number: u64) -> Self {
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

    #[inline(always)]
    fn noise(&self, body: RigidBodyHandle) -> NoiseStream {
        let (index, generation) = body.into_raw_parts();
        let number = u64::from(generation) << 32 | u64::from(index);
        NoiseStream::new(self.layer.seed, number)
    }

    /// The turbulence at `point`, around a body that came into it at `since`.
    #[inline]
    fn local(&self, point: Vector, since: f64) -> Local {
        self.common.unwrap_or_else(|| {
            let state = self.layer.source.at(point, self.time, self.time - since);
            Local::new(state, self.viscosity, self.dt)
        })
    }

    /// Changes of the body's own velocities, m/s and rad/s (the thesis's mode). `relative` is its
    /// velocity less the mean flow's, `length` its size.
    pub fn increments(
        &self,
        body: RigidBodyHandle,
        stirred: &mut Stirred,
        point: Vector,
        relative: Vector,
        length: Real,
    ) -> (Vector, Vector) {
        debug_assert_eq!(self.layer.mode, LangevinMode::BodyIncrements);
        let since = *stirred.since.get_or_insert(self.time);
        let Local { state, c0, .. } = self.local(point, since);
        let noise = self.noise(body);
        let [first, second] = [0, 1].map(|draw| noise.vector(self.number, draw));
        let after = relative_velocity_after(relative, &state, c0, self.dt, first);
        let linear = after - relative;
        let angular = spin_increment(&state, c0, length, self.dt, second);
        stirred.fluctuation = Vector::ZERO;
        if (linear + angular).is_finite() {
            (linear, angular)
        } else {
            Default::default()
        }
    }
}

/// Lets the fluid's velocity fluctuate around each flyer, several side by side. All slices are of one
/// length.
pub(super) struct Stir<'a> {
    pub stirring: &'a Stirring<'a>,
    pub flyers: &'a [Flyer],
    pub points: &'a [Vector],
    /// The mean flow; the fluctuations are added to it.
    pub samples: &'a mut [FlowSample],
    pub stirred: &'a mut [Stirred],
}

impl OnLanes for Stir<'_> {
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self {
            stirring,
            flyers,
            points,
            samples,
            stirred,
        } = self;
        let common = match &stirring.common {
            Some(local) => {
                let row = local.row();
                Some(Lanes::<S>::side_by_side(simd, |_| row))
            }
            None => None,
        };
        for from in (0..flyers.len()).step_by(Lanes::<S>::COUNT) {
            let full = Lanes::<S>::COUNT.min(flyers.len() - from);
            // A last group that is not full repeats its last body.
            let index: [usize; MOST_LANES] = std::array::from_fn(|lane| from + lane.min(full - 1));
            let mut locals = [Row::default(); MOST_LANES];
            let mut uniforms = [Row::default(); MOST_LANES];
            for lane in 0..full {
                let i = index[lane];
                let (noise, stirred) = (stirring.noise(flyers[i].handle), &mut stirred[i]);
                let mut draw = 0;
                let since = *stirred.since.get_or_insert_with(|| {
                    draw = 1;
                    stirring.time
                });
                if draw == 1 {
                    // New bodies have been in the turbulence for long.
                    let first = noise.vector(stirring.number, 0);
                    stirred.seen = SeenFluctuation::stationary(first);
                    stirred.slip = vector(flyers[i].rapier_linear) - samples[i].velocity;
                }
                if common.is_none() {
                    locals[lane] = stirring.local(points[i], since).row();
                }
                uniforms[lane] = noise.uniform(stirring.number, draw);
            }
            for lane in full..MOST_LANES {
                locals[lane] = locals[full - 1];
                uniforms[lane] = uniforms[full - 1];
            }

            let noise = gaussian(Lanes::<S>::side_by_side(simd, |lane| uniforms[lane]));
            let [decay, deviation, per_variance, weight] = match common {
                Some(local) => local,
                None => Lanes::<S>::side_by_side(simd, |lane| locals[lane]),
            };
            let body = Lanes::<S>::side_by_side(simd, |lane| flyers[index[lane]].rapier_linear);
            let mean = Lanes::<S>::side_by_side(simd, |lane| row(samples[index[lane]].velocity));
            let old = Lanes::<S>::side_by_side(simd, |lane| row(stirred[index[lane]].fluctuation));
            let [x, y, z, zero] =
                Lanes::<S>::side_by_side(simd, |lane| row(stirred[index[lane]].slip));
            let mut slip = [x, y, z];
            for axis in 0..3 {
                let now = body[axis] - mean[axis] - old[axis];
                slip[axis] += (now - slip[axis]) * weight;
            }
            let [x, y, z] = slip;
            let slip2 = x * x + y * y + z * z;
            let [x, y, z, _] =
                Lanes::<S>::side_by_side(simd, |lane| row(stirred[index[lane]].seen.normalized));
            let mut seen = [x, y, z];
            let eddies = Eddies {
                decay,
                deviation,
                per_variance,
            };
            let [x, y, z] = pass(&mut seen, &eddies, slip2, noise);
            Lanes::apart([x, y, z, zero], |lane, row| {
                stirred[index[lane]].fluctuation = vector(row);
            });
            let [x, y, z] = seen;
            Lanes::apart([x, y, z, zero], |lane, row| {
                stirred[index[lane]].seen.normalized = vector(row);
            });
            let [x, y, z] = slip;
            Lanes::apart([x, y, z, zero], |lane, row| {
                stirred[index[lane]].slip = vector(row);
            });
            for i in from..from + full {
                let stirred = &mut stirred[i];
                if !(stirred.fluctuation + stirred.seen.normalized + stirred.slip).is_finite() {
                    *stirred = Stirred {
                        since: stirred.since,
                        ..Stirred::default()
                    };
                }
                samples[i].velocity += stirred.fluctuation;
            }
        }
    }
}
