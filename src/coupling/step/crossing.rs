//! Bodies that a boundary of two fluids cuts: which of them are, and their step.
//!
//! Few bodies are at a surface at a time, and each is cut in its own way, so that they are advanced one by one, in
//! f64. Rapier is told the inertia that such a body has in the **lowest** fluid that it is in, once when it gets there:
//! the share that changes from step to step is in the force and torque that the step hands over, so that no mass
//! changes in rapier while a body bobs.

use super::locked_axes;
use super::stage_data::{CrossingBody, PartRow, SeenFlow, StepContext, StepInput, StepOutput};
use super::substep_matching::Target;
use super::workspace::{Batch, Batched};
use crate::coupling::body_state::BodyState;
use crate::coupling::crossing_memory::CrossingMemory;
use crate::coupling::environment::Environment;
use crate::coupling::shared_constants::{ConstantsTable, SharedConstants};
use crate::dynamics::ForceAndTorque;
use crate::dynamics::crossing::{CrossingConstants, CrossingStep, Cut, Moved};
use crate::dynamics::integrate::Motion;
use crate::dynamics::locked::Locks;
use crate::dynamics::parts::PartNow;
use crate::hydro::viscous::ForceFactors;
use crate::math::spatial::{Twist, rotate, rotate_back};
use crate::math::{Row, row, to_f64, to_real, vector};
use rapier3d::dynamics::RigidBody;
use rapier3d::math::{Real, Vector};
use rapier3d::na::{Quaternion, Rotation3, Vector3};

/// Share of the weight below which what is left of it and buoyancy lets a floating body sleep …
const BALANCED: f64 = 0.002;
/// … and share of the speed of a wave as long as the body is high.
const SLOW: f64 = 0.01;
/// The same where fluids move.
const STOPPED: f64 = 0.001;

/// The layers that a body is in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Layers {
    pub first: usize,
    pub last: usize,
    /// Whether the body has to be cut.
    pub cut: bool,
}

/// The layers that a body may be in during a step.
#[inline(always)]
pub(super) fn layers_of(
    environment: &Environment,
    constants: &ConstantsTable,
    state: &BodyState,
    body: &RigidBody,
    dt: Real,
) -> Layers {
    let medium = &environment.medium;
    if !medium.has_surface() {
        return Layers {
            first: 0,
            last: 0,
            cut: false,
        };
    }
    let center = body.center_of_mass();
    let crossing = constants.crossing(state.constants);
    let radius = crossing.map_or(0.0, |crossing| crossing.whole.radius as Real);
    let way = (body.linvel().dot(medium.up()) * dt).abs();
    let was_cut = state.crossing.as_ref().is_some_and(|memory| memory.active);
    let (first, last) = medium.layers_within(center, radius, way, environment.time);
    Layers {
        first,
        last,
        cut: first != last || was_cut,
    }
}

/// Advances the bodies of a batch, all of which are cut.
pub(super) fn integrate(
    batch: &Batch,
    crossings: &mut [CrossingBody],
    outputs: &mut Vec<StepOutput>,
    environment: &Environment,
    batched: Batched,
) {
    let level = environment.medium.axes();
    outputs.resize(batch.inputs.len(), StepOutput::default());
    let one = |i: usize, own: &mut CrossingBody, output: &mut StepOutput| {
        let input = &batch.inputs[i];
        let (Some(shared), Some(constants)) = (
            batched.constants.get(input.constants),
            batched.constants.crossing(input.constants),
        ) else {
            return;
        };
        let first = input.first_part as usize;
        let step = OneStep {
            environment,
            level: &level,
            shared,
            constants,
            input,
            flow: batch.flows.get(i),
            rows: batch.parts.get(first..first + own.rows).unwrap_or_default(),
            accelerations: batch
                .part_accelerations
                .get(first..first + own.rows)
                .unwrap_or_default(),
            batched,
            context: batched.context,
        };
        step.advance(own, output);
    };
    #[cfg(feature = "parallel")]
    {
        use rapier3d::rayon::prelude::*;
        /// Bodies per task: enough to be worth handing to another thread.
        const TASK: usize = 64;
        let all = crossings.par_iter_mut().with_min_len(TASK);
        let all = all.zip(outputs.par_iter_mut()).enumerate();
        all.for_each(|(i, (own, output))| one(i, own, output));
    }
    #[cfg(not(feature = "parallel"))]
    for (i, (own, output)) in crossings.iter_mut().zip(outputs).enumerate() {
        one(i, own, output);
    }
}

/// The step of one body.
struct OneStep<'a> {
    environment: &'a Environment,
    level: &'a Rotation3<f64>,
    shared: &'a SharedConstants,
    constants: &'a CrossingConstants,
    input: &'a StepInput,
    flow: Option<&'a SeenFlow>,
    rows: &'a [PartRow],
    /// Acceleration of the fluid at each; none where all fluids rest.
    accelerations: &'a [Vector],
    batched: Batched<'a>,
    context: &'a StepContext,
}

fn wide(row: Row) -> Vector3<f64> {
    to_f64(vector(row))
}

fn quaternion(row: Row) -> Quaternion<f64> {
    let [x, y, z, w] = row.map(f64::from);
    Quaternion::new(w, x, y, z)
}

fn narrow(v: &Vector3<f64>) -> Row {
    row(to_real(*v))
}

impl OneStep<'_> {
    fn advance(&self, own: &mut CrossingBody, output: &mut StepOutput) {
        let (input, context, constants) = (self.input, self.context, self.constants);
        let length = constants.length;
        let kept = self.batched.motion(input);
        let disturbance = self.batched.disturbance(input);
        let dt = f64::from(context.dt);
        let attitude = quaternion(kept.attitude);
        let velocity = self
            .flow
            .map_or(Vector3::zeros(), |flow| wide(flow.velocity));
        // The velocity is counted in the frame of the fluid: a body that goes on is there already.
        let frame = match self.flow {
            Some(flow) if input.continues => wide(flow.change),
            _ => velocity,
        };
        let own_linear =
            to_f64(kept.linear) + rotate_back(&attitude, &(wide(disturbance.linear) - frame));
        let own_angular =
            to_f64(kept.angular) + rotate_back(&attitude, &wide(disturbance.angular)) * length;
        let mut motion = Motion {
            attitude,
            displacement: Vector3::zeros(),
            velocity: Twist {
                linear: own_linear,
                angular: own_angular,
            },
            rate: Twist {
                linear: wide(kept.linear_rate),
                angular: wide(kept.angular_rate),
            },
            trend: Twist {
                linear: wide(kept.linear_trend),
                angular: wide(kept.angular_trend),
            },
            last: kept.last_substep.into(),
        };
        let Some(memory) = own.memory.as_deref_mut() else {
            return;
        };
        self.look_around(own.count, memory, &velocity);
        let gravity = context.gravity * input.gravity_scale;
        let energy_before = memory.energy.filter(|(_, of)| own.alone && *of == gravity);
        let step = CrossingStep {
            constants,
            cut: Cut {
                medium: &self.environment.medium,
                time: self.environment.time,
                first: own.first,
                count: own.count,
            },
            level: self.level,
            center: self.environment.medium.to_level(self.level, own.center),
            fluid_velocity: velocity,
            now: &memory.now,
            accelerations: &memory.accelerations,
            gravity: to_f64(gravity),
            force: wide(disturbance.force),
            torque: wide(disturbance.torque),
            locks: self.locks(&motion),
            dt,
            integrator: context.integrator,
            mass_before: own.known_mass.then_some(memory.mass),
            energy_before: energy_before.map(|(energy, _)| energy),
        };
        let moved = step.advance(&mut motion, &mut memory.portions);
        memory.active = own.count > 1;
        memory.first = own.first as u8;
        memory.mass = moved.mass;
        let resting = self.environment.medium.is_still();
        memory.energy = resting.then_some((moved.energy, gravity));
        memory.submerged = moved.first.submerged as Real;
        memory.place = own.center + to_real(motion.displacement + velocity * dt);
        [memory.slow, memory.balanced] = self.rests(&moved, &motion, &velocity, resting);
        own.load = ForceAndTorque {
            force: to_real(moved.load.force),
            torque: to_real(moved.load.torque),
        };
        self.write(&motion, moved.substeps, &velocity, output);
    }

    /// Whether a body is as good as at rest and in balance, so that rapier may let it sleep. Speeds are within [`SLOW`] of
    /// that of a wave as long as the body is high, in the world and within [`STOPPED`] of it where fluids move: what drifts
    /// along slowly does not rest. Forces are within [`BALANCED`] of the weight, and the surface holds it against them:
    /// what is under altogether sinks or rises, however slowly. Of a thin body, which rounding tilts by more than such a
    /// torque, the edges are within [`BALANCED`] of its height from where they float.
    fn rests(
        &self,
        moved: &Moved,
        motion: &Motion<f64>,
        fluid_velocity: &Vector3<f64>,
        resting: bool,
    ) -> [bool; 2] {
        let (load, height) = (&moved.load, moved.height);
        let gravity = to_f64(self.context.gravity).norm() * f64::from(self.input.gravity_scale);
        let weight = gravity * self.constants.dry_mass * BALANCED;
        let v = &motion.velocity;
        let linear = rotate(&motion.attitude, &v.linear) + fluid_velocity;
        let share = if resting { SLOW } else { STOPPED };
        let speed = share * (gravity * height).sqrt();
        let held = moved.heave_stiffness * (SLOW * height);
        let reach = self.constants.semi_axes.max();
        let tilted = moved.tilt_stiffness * (BALANCED * height / reach);
        let balanced = load.force.norm() <= weight.min(held)
            && load.torque.norm() <= tilted.max(weight * height);
        [linear.norm().max(v.angular.norm()) <= speed, balanced]
    }

    /// Looks at the fluid around each part in each layer.
    fn look_around(&self, count: usize, memory: &mut CrossingMemory, frame: &Vector3<f64>) {
        let parts = self.constants.part_count();
        memory.accelerations.clear();
        for number in 0..count {
            let of_layer = self.accelerations.iter().skip(number * parts).take(parts);
            let sum: Vector = of_layer.sum();
            memory.accelerations.push(to_f64(sum) / parts as f64);
        }
        // The fluid around the body is taken as it is in the middle of the step.
        let half = 0.5 * self.context.dt;
        memory.velocities.clear();
        memory.now.clear();
        let factors = &self.input.factors;
        for index in 0..count * parts {
            let row = self.rows.get(index).copied().unwrap_or_default();
            let [drag, rotational, translational, _] = row.factors;
            memory.velocities.push(self.fluid_at(index, frame));
            let ahead = self.accelerations.get(index).map(|a| *a * half);
            memory.now.push(PartNow {
                velocity: wide(row.velocity) + to_f64(ahead.unwrap_or_default()),
                spin: wide(row.spin),
                factors: ForceFactors {
                    drag: f64::from(drag * factors.drag),
                    rotational_lift: f64::from(rotational * factors.rotational_lift),
                    translational_lift: f64::from(translational * factors.translational_lift),
                },
                sine: row.velocity[3].into(),
                cosine: row.spin[3].into(),
            });
        }
    }

    /// Velocity of the fluid at a part in a layer.
    fn fluid_at(&self, index: usize, frame: &Vector3<f64>) -> Vector3<f64> {
        let relative = self.rows.get(index).map(|row| wide(row.velocity));
        relative.unwrap_or_default() + frame
    }

    fn locks(&self, motion: &Motion<f64>) -> Locks<f64> {
        let locks = self.input.locks;
        if locks.is_empty() {
            return Locks::none(0.0);
        }
        let linear = wide(locked_axes::linear(locks));
        let angular = wide(locked_axes::angular(locks));
        let velocity = &motion.velocity;
        Locks {
            any: true,
            linear,
            angular,
            velocity: Twist {
                linear: rotate(&motion.attitude, &velocity.linear).component_mul(&linear),
                angular: rotate(&motion.attitude, &velocity.angular).component_mul(&angular),
            },
        }
    }

    /// What rapier shall do, as for the bodies of the other routes.
    fn write(
        &self,
        motion: &Motion<f64>,
        count: f64,
        fluid_velocity: &Vector3<f64>,
        output: &mut StepOutput,
    ) {
        let (input, context) = (self.input, self.context);
        let dt = f64::from(context.dt);
        let rapier_attitude = quaternion(input.rapier_attitude);
        let target = Target {
            scheme: &context.scheme,
            attitude: rapier_attitude,
            end_attitude: motion.attitude,
            linear: wide(input.rapier_linear),
            angular: wide(input.rapier_angular),
            end_linear: rotate(&motion.attitude, &motion.velocity.linear) + fluid_velocity,
            end_angular: rotate(&motion.attitude, &motion.velocity.angular) / self.constants.length,
            displacement: motion.displacement + fluid_velocity * dt,
            free: f64::from(u8::from(input.free)),
        };
        let matched = target.matched();
        let gravity = to_f64(context.gravity) * f64::from(input.gravity_scale);
        let force = (matched.linear_acceleration - gravity) * f64::from(input.solver_mass);
        let acceleration = rotate_back(&rapier_attitude, &matched.angular_acceleration);
        let inertia = self.shared.step.scales.rapier_inertia.map(f64::from);
        let torque = rotate(&rapier_attitude, &(inertia * acceleration));
        let q = &motion.attitude.coords;
        output.motion.linear = to_real(motion.velocity.linear);
        output.motion.last_substep = motion.last as Real;
        output.motion.angular = to_real(motion.velocity.angular);
        output.motion.substeps = count as Real;
        output.motion.attitude = [q.x, q.y, q.z, q.w].map(|x| x as Real);
        output.motion.linear_rate = narrow(&motion.rate.linear);
        output.motion.angular_rate = narrow(&motion.rate.angular);
        output.motion.linear_trend = narrow(&motion.trend.linear);
        output.motion.angular_trend = narrow(&motion.trend.angular);
        output.end_linear = narrow(&target.end_linear);
        output.end_angular = narrow(&target.end_angular);
        output.start_linear = narrow(&matched.start_linear);
        output.start_angular = narrow(&matched.start_angular);
        output.force = narrow(&force);
        output.torque = narrow(&torque);
    }
}
