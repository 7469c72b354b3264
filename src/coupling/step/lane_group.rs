//! One step of the bodies that fit into the machine's registers side by side.

use super::locked_axes;
use super::stage_data::{Disturbance, PartRow, SeenFlow, StepInput, StepOutput};
use super::substep_matching::Target;
use super::workspace::Batched;
use crate::coupling::body_state::{IntegratorState, NONE};
use crate::coupling::shared_constants::{SharedConstants, StepConstants};
use crate::dynamics::integrate::{Motion, advance, substeps};
use crate::dynamics::load::Load;
use crate::dynamics::locked::Locks;
use crate::dynamics::parts::{PartNow, Parts};
use crate::dynamics::reaction::Whole;
use crate::hydro::part_law::EveryLane;
use crate::hydro::viscous::force_factors::Factored;
use crate::hydro::viscous::{ForceFactors, PreparedLaw};
use crate::math::spatial::{Twist, rotate, rotate_back, select_lt};
use crate::math::{Lanes, MOST_LANES, Row, Scalar, vector};
use fearless_simd::Simd;
use rapier3d::math::Vector;
use rapier3d::na::{Quaternion, Vector3};

/// The bodies of one group of lanes. Of arrays, as many entries are meant as there are lanes.
pub(super) struct LaneGroup<'a, S: Simd> {
    pub simd: S,
    pub bodies: [&'a StepInput; MOST_LANES],
    /// What they keep from step to step.
    pub motions: [&'a IntegratorState; MOST_LANES],
    pub constants: &'a StepConstants<Lanes<S>>,
    /// Whether their route is that of symmetric bodies.
    pub symmetric: bool,
    /// What the bodies share, if they are of parts.
    pub parts: Option<&'a SharedConstants>,
    /// Whether the buoyancy of one has a torque.
    pub buoyancy_turns: bool,
    /// The flow that the bodies of their window see; `None` where nothing flows.
    pub flows: Option<&'a [SeenFlow]>,
    /// Their places in the window.
    pub index: [usize; MOST_LANES],
    /// The outputs of the window.
    pub outputs: &'a mut [StepOutput],
    pub batched: Batched<'a>,
}

/// A vector and one more number as a row.
#[inline(always)]
fn row_with(v: Vector, number: f32) -> Row {
    [v.x, v.y, v.z, number]
}

#[inline(always)]
fn quaternion<T: Scalar>([x, y, z, w]: [T; 4]) -> Quaternion<T> {
    Quaternion::new(w, x, y, z)
}

#[inline(always)]
fn vector3<T: Scalar>([x, y, z, _]: [T; 4]) -> Vector3<T> {
    Vector3::new(x, y, z)
}

impl<S: Simd> LaneGroup<'_, S> {
    /// Rows of the inputs side by side.
    #[inline(always)]
    fn inputs(&self, row: impl Fn(&StepInput) -> Row) -> [Lanes<S>; 4] {
        Lanes::side_by_side(self.simd, |lane| row(self.bodies[lane]))
    }

    /// Rows of what the bodies keep from step to step, side by side.
    #[inline(always)]
    fn motions(&self, row: impl Fn(&IntegratorState) -> Row) -> [Lanes<S>; 4] {
        Lanes::side_by_side(self.simd, |lane| row(self.motions[lane]))
    }

    /// Vectors of what most bodies have none of, side by side.
    #[inline(always)]
    fn disturbances(&self, row: impl Fn(&Disturbance) -> Row) -> Vector3<Lanes<S>> {
        vector3(self.inputs(|input| row(self.batched.disturbance(input))))
    }

    /// One step, from the inputs to the outputs.
    #[inline(always)]
    pub fn step(mut self) {
        let StepConstants {
            inertia,
            law,
            scales: scale,
            flow_response,
        } = self.constants;
        let context = self.batched.context;
        let constant = |value| Lanes::splat(self.simd, value);
        let zero = constant(0.0);
        let nothing = Vector3::repeat(zero);
        let attitude = quaternion(self.motions(|m| m.attitude));
        let linear = self.motions(|m| row_with(m.linear, m.last_substep));
        let mut motion = Motion {
            attitude,
            displacement: nothing,
            velocity: Twist {
                linear: vector3(linear),
                angular: vector3(self.motions(|m| row_with(m.angular, m.substeps))),
            },
            rate: Twist {
                linear: vector3(self.motions(|m| m.linear_rate)),
                angular: vector3(self.motions(|m| m.angular_rate)),
            },
            trend: Twist {
                linear: vector3(self.motions(|m| m.linear_trend)),
                angular: vector3(self.motions(|m| m.angular_trend)),
            },
            last: linear[3],
        };
        let [solver_mass, gravity_scale, free, continues] = self.inputs(|input| {
            let free = f32::from(u8::from(input.free));
            let continues = f32::from(u8::from(input.continues));
            [input.solver_mass, input.gravity_scale, free, continues]
        });
        let g = context.gravity;
        let gravity = Vector3::new(constant(g.x), constant(g.y), constant(g.z)) * gravity_scale;
        let buoyancy = gravity * -scale.displaced_mass;
        let mut load = Load {
            force: gravity * scale.dry_mass + buoyancy,
            torque: nothing,
            buoyancy,
            buoyancy_arm: scale.buoyancy_arm,
            fluid_spin: nothing,
            stretching: nothing,
            shearing: nothing,
            strain_response: nothing,
            turning: self.buoyancy_turns || self.bodies.iter().any(|input| input.has_torque),
            spinning: false,
            straining: false,
            locks: Locks::none(zero),
        };
        if self.bodies.iter().any(|input| input.disturbance != NONE) {
            load.force += self.disturbances(|d| d.force) * scale.per_mass;
            load.torque = self.disturbances(|d| d.torque) * scale.per_mass_length;
            let linear = rotate_back(&attitude, &self.disturbances(|d| d.linear));
            let angular = self.disturbances(|d| d.angular) * scale.length;
            motion.velocity.linear += linear;
            motion.velocity.angular += rotate_back(&attitude, &angular);
        }
        let mut fluid_velocity = nothing;
        if let Some(flows) = self.flows {
            let flow = |row: fn(&SeenFlow) -> Row| {
                let rows = |lane| row(&flows[self.index[lane]]);
                vector3(Lanes::side_by_side(self.simd, rows))
            };
            fluid_velocity = flow(|f| f.velocity);
            let change = flow(|f| f.change);
            let spins = |place: &usize| flows[*place].vorticity != Row::default();
            if self.index.iter().any(spins) {
                load.spinning = true;
                load.fluid_spin = flow(|f| f.vorticity) * (scale.length * constant(0.5));
            }
            if self.index.iter().any(|place| flows[*place].strains()) {
                (load.spinning, load.straining) = (true, true);
                load.stretching = flow(|f| f.stretching);
                load.shearing = flow(|f| f.shearing);
                load.strain_response = flow_response.straining;
            }
            // The velocity is counted in the frame of the fluid: a body that goes on is there already,
            // but the frame itself has changed its velocity.
            let frame = select_lt(&change, constant(0.5), continues, &fluid_velocity);
            let response = flow_response.to(&rotate_back(&attitude, &change));
            motion.velocity.linear += response.linear - rotate_back(&attitude, &frame);
            motion.velocity.angular += response.angular;
        }
        if self.bodies.iter().any(|input| !input.locks.is_empty()) {
            let linear = vector3(self.inputs(|input| locked_axes::linear(input.locks)));
            let angular = vector3(self.inputs(|input| locked_axes::angular(input.locks)));
            let velocity = &motion.velocity;
            load.locks = Locks {
                any: true,
                linear,
                angular,
                velocity: Twist {
                    linear: rotate(&attitude, &velocity.linear).component_mul(&linear),
                    angular: rotate(&attitude, &velocity.angular).component_mul(&angular),
                },
            };
        }
        let dt = constant(context.dt);
        let count = substeps(inertia, &motion, &load, dt, &context.integrator);
        let (most, iterations) = (count.largest(1.0) as u32, context.integrator.iterations);
        let [drag, rotational_lift, translational_lift, _] = self.inputs(|input| {
            let factors = &input.factors;
            let (drag, rotational) = (factors.drag, factors.rotational_lift);
            [drag, rotational, factors.translational_lift, 0.0]
        });
        let factors = ForceFactors {
            drag,
            rotational_lift,
            translational_lift,
        };
        let m = &mut motion;
        if let Some(shared) = self.parts {
            let parts = self.part_forces(shared, factors);
            advance::<false, _, _>(inertia, &parts, &load, m, dt, count, most, iterations);
        } else {
            // Most bodies are symmetric plates: they have code of their own, the others share theirs.
            macro_rules! advance {
                ($symmetric:literal, $law:expr) => {{
                    let law = Factored { law: $law, factors };
                    let law = &Whole(&law);
                    advance::<$symmetric, _, _>(
                        inertia, law, &load, m, dt, count, most, iterations,
                    );
                }};
            }
            match (law, self.symmetric) {
                (PreparedLaw::Plate(law), true) => advance!(true, law),
                (law, true) => advance!(true, law),
                (law, false) => advance!(false, law),
            }
        }

        let (mut rapier_linear, mut rapier_angular) = (nothing, nothing);
        if !self.bodies.iter().all(|input| input.free) {
            rapier_linear = vector3(self.inputs(|input| input.rapier_linear));
            rapier_angular = vector3(self.inputs(|input| input.rapier_angular));
        }
        let rapier_attitude = quaternion(self.inputs(|input| input.rapier_attitude));
        let target = Target {
            scheme: &context.scheme,
            attitude: rapier_attitude,
            end_attitude: motion.attitude,
            linear: rapier_linear,
            angular: rapier_angular,
            end_linear: rotate(&motion.attitude, &motion.velocity.linear) + fluid_velocity,
            end_angular: rotate(&motion.attitude, &motion.velocity.angular) * inertia.per_length,
            displacement: motion.displacement + fluid_velocity * dt,
            free,
        };
        let matched = target.matched();
        // What rapier adds by itself is taken off: its gravity acts on the solver's mass.
        let force = (matched.linear_acceleration - gravity) * solver_mass;
        let acceleration = rotate_back(&rapier_attitude, &matched.angular_acceleration);
        let torque = rotate(&rapier_attitude, &scale.torque_for(&acceleration));

        let q = &motion.attitude.coords;
        let Motion {
            velocity,
            rate,
            trend,
            last,
            ..
        } = &motion;
        self.store_with(&velocity.linear, *last, |output, linear, last| {
            output.motion.linear = linear;
            output.motion.last_substep = last;
        });
        self.store_with(&velocity.angular, count, |output, angular, count| {
            output.motion.angular = angular;
            output.motion.substeps = count;
        });
        self.store_row([q.x, q.y, q.z, q.w], |o| &mut o.motion.attitude);
        self.store(&rate.linear, |o| &mut o.motion.linear_rate);
        self.store(&rate.angular, |o| &mut o.motion.angular_rate);
        self.store(&trend.linear, |o| &mut o.motion.linear_trend);
        self.store(&trend.angular, |o| &mut o.motion.angular_trend);
        self.store(&target.end_linear, |o| &mut o.end_linear);
        self.store(&target.end_angular, |o| &mut o.end_angular);
        self.store(&matched.start_linear, |o| &mut o.start_linear);
        self.store(&matched.start_angular, |o| &mut o.start_angular);
        self.store(&force, |o| &mut o.force);
        self.store(&torque, |o| &mut o.torque);
    }

    /// The forces on the parts of bodies that are alike.
    #[inline(always)]
    fn part_forces<'b>(
        &'b self,
        shared: &'b SharedConstants,
        factors: ForceFactors<Lanes<S>>,
    ) -> Parts<'b, f32, EveryLane<S>, impl Fn(usize) -> PartNow<Lanes<S>>> {
        let rows = self.batched.parts;
        let count = shared.parts.len();
        let first = |lane: usize| self.bodies[lane].first_part as usize;
        let any = |is: fn(&PartRow) -> bool| {
            let of = |lane| {
                rows.get(first(lane)..first(lane) + count)
                    .unwrap_or_default()
            };
            (0..MOST_LANES).any(|lane| of(lane).iter().any(is))
        };
        let now = move |i: usize| {
            let row = |row: fn(&PartRow) -> Row| {
                let of = |lane| rows.get(first(lane) + i).map_or(Row::default(), row);
                Lanes::side_by_side(self.simd, of)
            };
            let (velocity, spin) = (row(|part| part.velocity), row(|part| part.spin));
            let [drag, rotational_lift, translational_lift, _] = row(|part| part.factors);
            PartNow {
                velocity: vector3(velocity),
                spin: vector3(spin),
                factors: ForceFactors {
                    drag: drag * factors.drag,
                    rotational_lift: rotational_lift * factors.rotational_lift,
                    translational_lift: translational_lift * factors.translational_lift,
                },
                sine: velocity[3],
                cosine: spin[3],
            }
        };
        Parts {
            constants: &shared.parts,
            coupled: &shared.coupled_mass,
            raise: EveryLane(self.simd),
            now,
            flows: any(|part| part.velocity[..3] != [0.0; 3] || part.spin[..3] != [0.0; 3]),
            deflected: any(|part| part.velocity[3] != 0.0),
        }
    }

    /// Writes four numbers of each body to its output.
    #[inline(always)]
    fn store_row(&mut self, columns: [Lanes<S>; 4], to: impl Fn(&mut StepOutput) -> &mut Row) {
        Lanes::apart(columns, |lane, row| {
            *to(&mut self.outputs[self.index[lane]]) = row;
        });
    }

    /// Writes a vector of each body to its output.
    #[inline(always)]
    fn store(&mut self, v: &Vector3<Lanes<S>>, to: impl Fn(&mut StepOutput) -> &mut Row) {
        let zero = Lanes::splat(self.simd, 0.0);
        self.store_row([v.x, v.y, v.z, zero], to);
    }

    /// Gives a vector and one more number of each body to its output.
    #[inline(always)]
    fn store_with(
        &mut self,
        v: &Vector3<Lanes<S>>,
        number: Lanes<S>,
        to: impl Fn(&mut StepOutput, Vector, f32),
    ) {
        Lanes::apart([v.x, v.y, v.z, number], |lane, row| {
            to(&mut self.outputs[self.index[lane]], vector(row), row[3]);
        });
    }
}
