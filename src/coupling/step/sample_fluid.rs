//! The second stage: the flow that each body of a batch sees, its mean and turbulence on top.

use super::stage_data::{Disturbance, StepContext, StepInput};
use super::turbulence::{Fluctuate, StepTurbulence};
use super::workspace::{Batch, LayerPoints};
use crate::coupling::body_state::NONE;
use crate::coupling::environment::Environment;
use crate::coupling::shared_constants::ConstantsTable;
use crate::dynamics::gravity_step::GravityStep;
use crate::flow::FlowSample;
use crate::math::{Row, dispatch, row, to_f64, to_quaternion, to_real, vector};
use crate::medium::Medium;
use crate::turbulence::LangevinMode;
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::math::{Real, Rotation, Vector};

/// Reynolds number up to which a body is turned by the strain of the fluid, less and less: that is a matter of creeping
/// flow.
const STRAIN_ENDS: Real = 30.0;

/// Reads the flow at every body of a batch and adds the turbulence. Bodies where the flow is no number are
/// added to `bad_flows`.
pub(super) fn sample_fluid(
    (environment, layer): (&Environment, usize),
    constants: &ConstantsTable,
    context: &StepContext,
    batch: &mut Batch,
    [samples, part_samples]: [&mut Vec<FlowSample>; 2],
    of_layer: &mut LayerPoints,
    bad_flows: &mut Vec<RigidBodyHandle>,
) {
    let Batch {
        inputs,
        disturbances,
        points,
        flows,
        turbulence: memories,
        parts,
        part_points,
        part_turbulence,
        crossings,
        point_layers,
        part_accelerations,
        ..
    } = batch;
    if flows.is_empty() {
        return;
    }
    samples.clear();
    samples.resize(points.len(), FlowSample::default());
    let (medium, time) = (&environment.medium, environment.time);
    let Some(own) = medium.layers().get(layer) else {
        return;
    };
    medium.sample(layer, points, time, samples);
    if let Some(flow) = &own.flow {
        let viscosity = own.fluid.kinematic_viscosity();
        for ((input, point), sample) in inputs.iter().zip(points.iter()).zip(samples.iter_mut()) {
            let Some(shared) = constants.get(input.constants) else {
                continue;
            };
            let reach = shared.constants.length as Real;
            let slip = (vector(input.rapier_linear) - sample.velocity).length();
            let speed = slip + sample.vorticity.length() * reach;
            let share = 1.0 - speed * (2.0 * reach) / (STRAIN_ENDS * viscosity);
            if share > 0.0 {
                sample.strain = flow.strain_rate(*point, time, reach) * share;
            }
        }
    }
    part_samples.clear();
    part_samples.resize(part_points.len(), FlowSample::default());
    if !crossings.is_empty() {
        part_accelerations.resize(part_points.len(), Vector::ZERO);
        for layer in 0..medium.layers().len() {
            if medium.moves(layer) {
                of_layer.find(layer, part_points, point_layers);
                of_layer.sample(medium, layer, [time, context.dt.into()]);
                for (place, now, acceleration) in of_layer.found(context.dt) {
                    part_samples[place] = now;
                    part_accelerations[place] = acceleration;
                }
            }
        }
    } else if !part_points.is_empty() {
        medium.sample(layer, part_points, time, part_samples);
    }
    if let Some(turbulent) = &own.turbulence {
        let turbulence = StepTurbulence::new(turbulent, &own.fluid, environment, context.dt);
        match turbulent.mode {
            LangevinMode::FluidSeen => {
                dispatch(Fluctuate {
                    turbulence: &turbulence,
                    inputs,
                    points,
                    samples,
                    memories,
                });
                for (i, input) in inputs.iter().enumerate() {
                    let Some(shared) = constants.get(input.constants) else {
                        continue;
                    };
                    if !crossings.is_empty() {
                        continue;
                    }
                    let first = input.first_part as usize;
                    let range = first..(first + shared.parts.len()).min(part_points.len());
                    turbulence.fluctuate_parts(
                        input,
                        (points[i], &memories[i]),
                        &part_points[range.clone()],
                        &mut part_samples[range.clone()],
                        &mut part_turbulence[range],
                    );
                }
            }
            LangevinMode::BodyIncrements | LangevinMode::FractionalStep => {
                let gravity_first =
                    turbulent.mode == LangevinMode::FractionalStep && crossings.is_empty();
                for (i, input) in inputs.iter_mut().enumerate() {
                    let shared = constants.get(input.constants);
                    let length = shared.map_or(0.0, |shared| shared.constants.length as Real);
                    let mut relative = vector(input.rapier_linear) - samples[i].velocity;
                    if let Some(shared) = shared.filter(|_| gravity_first && !input.touching) {
                        let attitude = Rotation::from_array(input.rapier_attitude);
                        let gravity = GravityStep::of(
                            &shared.constants,
                            &shared.mass.inverse,
                            to_quaternion(attitude),
                            to_f64(context.gravity) * f64::from(input.gravity_scale),
                            context.dt.into(),
                        );
                        relative += to_real(gravity.change.linear);
                        disturbance_of(input, disturbances).take(&gravity);
                    }
                    let (linear, angular) = turbulence.increments(
                        input.handle,
                        &mut memories[i],
                        points[i],
                        relative,
                        length,
                    );
                    let disturbance = disturbance_of(input, disturbances);
                    disturbance.linear = row(vector(disturbance.linear) + linear);
                    disturbance.angular = row(vector(disturbance.angular) + angular);
                }
            }
        }
    }
    for (i, ((flow, sample), input)) in flows.iter_mut().zip(samples).zip(inputs).enumerate() {
        if !flow.advance(sample) {
            bad_flows.push(input.handle);
        }
        if part_points.is_empty() {
            continue;
        }
        let Some(shared) = constants.get(input.constants) else {
            continue;
        };
        let half_length = 0.5 * shared.constants.length as Real;
        let first = input.first_part as usize;
        let mut count = shared.parts.len();
        let mut fluctuation = Vector::ZERO;
        if let Some(own) = crossings.get(i) {
            // All that is in the layer of the batch fluctuates as the body's center.
            count = own.rows;
            fluctuation = memories.get(i).map_or(fluctuation, |own| own.fluctuation);
        }
        let range = first..(first + count).min(part_points.len());
        let layers = point_layers.get(range.clone()).unwrap_or_default();
        for (seen, of) in part_samples[range.clone()].iter_mut().zip(layers) {
            if usize::from(*of) == layer {
                seen.velocity += fluctuation;
            }
        }
        for (part, seen) in parts[range.clone()].iter_mut().zip(&part_samples[range]) {
            let relative = seen.velocity - vector(flow.velocity);
            let spin = seen.vorticity * half_length;
            if (relative + spin).is_finite() {
                part.velocity = with_last(relative, part.velocity);
                part.spin = with_last(spin, part.spin);
            } else {
                bad_flows.push(input.handle);
            }
        }
    }
}

impl LayerPoints {
    /// Finds those of many points that are in a layer.
    fn find(&mut self, layer: usize, points: &[Vector], layers: &[u8]) {
        self.points.clear();
        self.places.clear();
        let all = layers.iter().zip(points).enumerate();
        for (place, (_, point)) in all.filter(|(_, (own, _))| usize::from(**own) == layer) {
            self.points.push(*point);
            self.places.push(place);
        }
    }

    /// Samples the fluid at the points now, and where it will have gone after `dt`.
    fn sample(&mut self, medium: &Medium, layer: usize, [time, dt]: [f64; 2]) {
        for samples in &mut self.samples {
            samples.clear();
            samples.resize(self.points.len(), FlowSample::default());
        }
        let [now, then] = &mut self.samples;
        medium.sample(layer, &self.points, time, now);
        for (point, sample) in self.points.iter_mut().zip(&*now) {
            *point += sample.velocity * dt as Real;
        }
        medium.sample(layer, &self.points, time + dt, then);
    }

    /// The points' places among all points, what is there now, and how the fluid that is there accelerates in a step of
    /// `dt`, m/s².
    fn found(&self, dt: Real) -> impl Iterator<Item = (usize, FlowSample, Vector)> {
        let [now, then] = &self.samples;
        let both = self.places.iter().zip(now.iter().zip(then));
        both.map(move |(place, (now, then))| {
            let acceleration = (then.velocity - now.velocity) / dt;
            let known = acceleration.is_finite();
            let acceleration = if known { acceleration } else { Vector::ZERO };
            (*place, *now, acceleration)
        })
    }
}

/// A vector as a row that keeps its last number.
fn with_last(v: Vector, row: Row) -> Row {
    [v.x, v.y, v.z, row[3]]
}

/// A body's disturbance, made if there is none yet.
fn disturbance_of<'a>(
    input: &mut StepInput,
    disturbances: &'a mut Vec<Disturbance>,
) -> &'a mut Disturbance {
    if input.disturbance == NONE {
        input.disturbance = disturbances.len() as u32;
        disturbances.push(Disturbance::default());
    }
    &mut disturbances[input.disturbance as usize]
}
