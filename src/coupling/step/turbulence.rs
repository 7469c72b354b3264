//! The turbulence that each body of a batch sees.

use super::stage_data::StepInput;
use crate::coupling::environment::Environment;
use crate::coupling::turbulence_memory::TurbulenceMemory;
use crate::flow::FlowSample;
use crate::fluid::Fluid;
use crate::math;
use crate::math::{Lanes, MOST_LANES, OnLanes, Row, row, vector};
use crate::turbulence::{
    Eddies, LangevinMode, NoiseStream, SeenFluctuation, Turbulence, TurbulenceState,
    TurbulentLayer, gaussian, kolmogorov_constant, pass, relative_velocity_after, spin_increment,
};
use fearless_simd::Simd;
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::math::{Real, Vector};

/// Time over which the slip is averaged, in memories of a tracer: long enough for the correlation with
/// the fluctuation to fade, short enough for a leaf to reach its falling speed.
const AVERAGED: Real = 10.0;

/// The turbulence of one step.
pub(super) struct StepTurbulence<'a> {
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
        // A state of zero dissipation (or one that is no number, from a table of the user's) moves nothing.
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

impl<'a> StepTurbulence<'a> {
    pub fn new(
        layer: &'a TurbulentLayer,
        fluid: &Fluid,
        environment: &Environment,
        dt: Real,
    ) -> Self {
        let viscosity = fluid.kinematic_viscosity();
        let common = match &layer.source {
            Turbulence::Homogeneous(state) => Some(Local::new(*state, viscosity, dt)),
            _ => None,
        };
        Self {
            layer,
            common,
            viscosity,
            time: environment.time,
            dt,
            number: environment.steps,
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
        memory: &mut TurbulenceMemory,
        point: Vector,
        relative: Vector,
        length: Real,
    ) -> (Vector, Vector) {
        debug_assert_ne!(self.layer.mode, LangevinMode::FluidSeen);
        let since = *memory.since.get_or_insert(self.time);
        let Local { state, c0, .. } = self.local(point, since);
        let noise = self.noise(body);
        let [first, second] = [0, 1].map(|draw| noise.vector(self.number, draw));
        let after = relative_velocity_after(relative, &state, c0, self.dt, first);
        let linear = after - relative;
        let angular = spin_increment(&state, c0, length, self.dt, second);
        memory.fluctuation = Vector::ZERO;
        if (linear + angular).is_finite() {
            (linear, angular)
        } else {
            Default::default()
        }
    }
}

impl StepTurbulence<'_> {
    /// Lets the fluid fluctuate around the parts of a body at `center`, which itself sees what is in `memory`:
    /// eddies of integral length Λ = k^1.5/ε are seen alike by what is close, with the correlation exp(−r/Λ) of the
    /// distance to the center. The fluctuations are added to the mean flow in `samples`.
    pub fn fluctuate_parts(
        &self,
        input: &StepInput,
        (center, memory): (Vector, &TurbulenceMemory),
        points: &[Vector],
        samples: &mut [FlowSample],
        memories: &mut [TurbulenceMemory],
    ) {
        let since = memory.since.unwrap_or(self.time);
        for (i, (point, sample)) in points.iter().zip(samples).enumerate() {
            let Local { state, eddies, .. } = self.local(*point, since);
            let own = &mut memories[i];
            let noise = self.noise(input.handle);
            // The body's own draws are 0 and 1.
            let noise = noise.vector(self.number, 2 + i as u32);
            if own.since.is_none() {
                own.since = Some(self.time);
                own.seen = SeenFluctuation::stationary(noise);
            }
            let mut seen = own.seen.normalized.to_array();
            let slip2 = memory.slip.length_squared();
            let fluctuation = Vector::from_array(pass(&mut seen, &eddies, slip2, noise.to_array()));
            own.seen.normalized = Vector::from_array(seen);
            let integral_length =
                math::powf(state.kinetic_energy.max(0.0), 1.5) / state.dissipation;
            let distance = point.distance(center);
            let alike = math::exp(-distance / integral_length.max(f32::MIN_POSITIVE));
            let mixed =
                memory.fluctuation * alike + fluctuation * (1.0 - alike * alike).max(0.0).sqrt();
            if mixed.is_finite() && own.seen.normalized.is_finite() {
                own.fluctuation = mixed;
            } else {
                *own = TurbulenceMemory {
                    since: own.since,
                    ..TurbulenceMemory::default()
                };
            }
            sample.velocity += own.fluctuation;
        }
    }
}

/// Lets the fluid's velocity fluctuate around each body, several side by side. All slices are of one
/// length.
pub(super) struct Fluctuate<'a> {
    pub turbulence: &'a StepTurbulence<'a>,
    pub inputs: &'a [StepInput],
    pub points: &'a [Vector],
    /// The mean flow; the fluctuations are added to it.
    pub samples: &'a mut [FlowSample],
    pub memories: &'a mut [TurbulenceMemory],
}

impl OnLanes for Fluctuate<'_> {
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self {
            turbulence,
            inputs,
            points,
            samples,
            memories,
        } = self;
        let common = match &turbulence.common {
            Some(local) => {
                let row = local.row();
                Some(Lanes::<S>::side_by_side(simd, |_| row))
            }
            None => None,
        };
        for from in (0..inputs.len()).step_by(Lanes::<S>::COUNT) {
            let full = Lanes::<S>::COUNT.min(inputs.len() - from);
            // A last group that is not full repeats its last body.
            let index: [usize; MOST_LANES] = std::array::from_fn(|lane| from + lane.min(full - 1));
            let mut locals = [Row::default(); MOST_LANES];
            let mut uniforms = [Row::default(); MOST_LANES];
            for lane in 0..full {
                let i = index[lane];
                let (noise, memory) = (turbulence.noise(inputs[i].handle), &mut memories[i]);
                let mut draw = 0;
                let since = *memory.since.get_or_insert_with(|| {
                    draw = 1;
                    turbulence.time
                });
                if draw == 1 {
                    // New bodies have been in the turbulence for long.
                    let first = noise.vector(turbulence.number, 0);
                    memory.seen = SeenFluctuation::stationary(first);
                    memory.slip = vector(inputs[i].rapier_linear) - samples[i].velocity;
                }
                if common.is_none() {
                    locals[lane] = turbulence.local(points[i], since).row();
                }
                uniforms[lane] = noise.uniform(turbulence.number, draw);
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
            let body = Lanes::<S>::side_by_side(simd, |lane| inputs[index[lane]].rapier_linear);
            let mean = Lanes::<S>::side_by_side(simd, |lane| row(samples[index[lane]].velocity));
            let old = Lanes::<S>::side_by_side(simd, |lane| row(memories[index[lane]].fluctuation));
            let [x, y, z, zero] =
                Lanes::<S>::side_by_side(simd, |lane| row(memories[index[lane]].slip));
            let mut slip = [x, y, z];
            for axis in 0..3 {
                let now = body[axis] - mean[axis] - old[axis];
                slip[axis] += (now - slip[axis]) * weight;
            }
            let [x, y, z] = slip;
            let slip2 = x * x + y * y + z * z;
            let [x, y, z, _] =
                Lanes::<S>::side_by_side(simd, |lane| row(memories[index[lane]].seen.normalized));
            let mut seen = [x, y, z];
            let eddies = Eddies {
                decay,
                deviation,
                per_variance,
            };
            let [x, y, z] = pass(&mut seen, &eddies, slip2, noise);
            Lanes::apart([x, y, z, zero], |lane, row| {
                memories[index[lane]].fluctuation = vector(row);
            });
            let [x, y, z] = seen;
            Lanes::apart([x, y, z, zero], |lane, row| {
                memories[index[lane]].seen.normalized = vector(row);
            });
            let [x, y, z] = slip;
            Lanes::apart([x, y, z, zero], |lane, row| {
                memories[index[lane]].slip = vector(row);
            });
            for i in from..from + full {
                let memory = &mut memories[i];
                if !(memory.fluctuation + memory.seen.normalized + memory.slip).is_finite() {
                    *memory = TurbulenceMemory {
                        since: memory.since,
                        ..TurbulenceMemory::default()
                    };
                }
                samples[i].velocity += memory.fluctuation;
            }
        }
    }
}
