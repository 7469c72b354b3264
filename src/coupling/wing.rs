//! One step of the bodies that fit into the machine's registers side by side.

use super::flight::{Air, Extra, Flyer, Integrated, Landing};
use super::handover::Target;
use super::kind::{Law, StepConstants};
use super::slot::NONE;
use super::stream::Stream;
use crate::dynamics::integrate::{Load, Motion, advance, rotate, rotate_back, substeps};
use crate::dynamics::kirchhoff::{Twist, choose};
use crate::hydro::viscous::physical::PlatesOnly;
use crate::hydro::viscous::scaled::Scaled;
use crate::math::{Lanes, MOST_LANES, Row, Scalar};
use fearless_simd::Simd;
use rapier3d::na::{Quaternion, Vector3};

/// The bodies of one group of lanes on their way. Of arrays, as many are meant as there are lanes.
pub(super) struct Wing<'a, S: Simd> {
    pub simd: S,
    pub bodies: [&'a Flyer; MOST_LANES],
    /// What they keep from step to step.
    pub kept: [&'a Integrated; MOST_LANES],
    pub constants: &'a StepConstants<Lanes<S>>,
    /// Of their route.
    pub symmetric: bool,
    /// Whether the buoyancy of one has a torque.
    pub turned_by_buoyancy: bool,
    /// What flows past the bodies of their window; `None` where nothing flows.
    pub streams: Option<&'a [Stream]>,
    /// Where they are in their window, and where they land.
    pub index: [usize; MOST_LANES],
    pub landings: &'a mut [Landing],
    pub air: Air<'a>,
}

#[inline(always)]
fn quaternion<T: Scalar>((axis, w): (Vector3<T>, T)) -> Quaternion<T> {
    Quaternion::new(w, axis.x, axis.y, axis.z)
}

impl<S: Simd> Wing<'_, S> {
    /// Vectors side by side, and the number that came with them.
    #[inline(always)]
    fn vectors(&self, row: impl Fn(&Flyer) -> Row) -> (Vector3<Lanes<S>>, Lanes<S>) {
        let [x, y, z, more] = Lanes::side_by_side(self.simd, |lane| row(self.bodies[lane]));
        (Vector3::new(x, y, z), more)
    }

    /// Of what the bodies keep from step to step.
    #[inline(always)]
    fn kept(&self, row: impl Fn(&Integrated) -> Row) -> (Vector3<Lanes<S>>, Lanes<S>) {
        let [x, y, z, more] = Lanes::side_by_side(self.simd, |lane| row(self.kept[lane]));
        (Vector3::new(x, y, z), more)
    }

    /// Of what most bodies have none of.
    #[inline(always)]
    fn extra(&self, row: impl Fn(&Extra) -> Row) -> Vector3<Lanes<S>> {
        self.vectors(|flyer| row(self.air.extra(flyer))).0
    }

    /// One step, from what is known of the bodies to their landings.
    #[inline(always)]
    pub fn fly(mut self) {
        let StepConstants {
            inertia,
            law,
            scales: scale,
        } = self.constants;
        let clock = self.air.clock;
        let lit = |value| Lanes::splat(self.simd, value);
        let zero = lit(0.0);
        let nothing = Vector3::repeat(zero);
        let attitude = quaternion(self.kept(|m| m.attitude));
        let (linear, last) = self.kept(|m| m.linear);
        let (angular, _) = self.kept(|m| m.angular);
        let mut motion = Motion {
            attitude,
            displacement: nothing,
            velocity: Twist { linear, angular },
            rate: Twist {
                linear: self.kept(|m| m.linear_rate).0,
                angular: self.kept(|m| m.angular_rate).0,
            },
            trend: Twist {
                linear: self.kept(|m| m.linear_trend).0,
                angular: self.kept(|m| m.angular_trend).0,
            },
            last,
        };
        let (numbers, goes_on) = self.vectors(|f| {
            let free = f32::from(u8::from(f.free));
            let goes_on = f32::from(u8::from(f.goes_on));
            [f.solver_mass, f.gravity_scale, free, goes_on]
        });
        let (solver_mass, gravity_scale, free) = (numbers.x, numbers.y, numbers.z);
        let g = clock.gravity;
        let gravity = Vector3::new(lit(g.x), lit(g.y), lit(g.z)) * gravity_scale;
        let buoyancy = gravity * -scale.displaced_mass;
        let mut load = Load {
            force: gravity * scale.dry_mass + buoyancy,
            torque: nothing,
            buoyancy,
            buoyancy_arm: Vector3::new(scale.arm_x, scale.arm_y, scale.arm_z),
            fluid_spin: nothing,
            turning: self.turned_by_buoyancy || self.bodies.iter().any(|flyer| flyer.turned),
            spinning: false,
        };
        if self.bodies.iter().any(|flyer| flyer.extra != NONE) {
            load.force += self.extra(|e| e.force) * scale.per_mass;
            load.torque = self.extra(|e| e.torque) * scale.per_mass_length;
            let on_top = rotate_back(&attitude, &self.extra(|e| e.linear));
            let spin = rotate_back(&attitude, &(self.extra(|e| e.angular) * scale.length));
            motion.velocity.linear += on_top;
            motion.velocity.angular += spin;
        }
        let mut stream = nothing;
        if let Some(streams) = self.streams {
            let flow = |row: fn(&Stream) -> Row| {
                let [x, y, z, _] =
                    Lanes::side_by_side(self.simd, |lane| row(&streams[self.index[lane]]));
                Vector3::new(x, y, z)
            };
            stream = flow(|s| s.velocity);
            let change = flow(|s| s.change);
            let spins = |lane: &usize| streams[*lane].vorticity != Row::default();
            if self.index.iter().any(spins) {
                load.spinning = true;
                load.fluid_spin = flow(|s| s.vorticity) * (scale.length * lit(0.5));
            }
            // In the frame of the fluid: a body that goes on is there already, but the frame itself
            // has changed its velocity.
            let frame = choose(&change, lit(0.5), goes_on, &stream);
            let pushed = scale.pushed_by(&rotate_back(&attitude, &change));
            motion.velocity.linear += pushed.linear - rotate_back(&attitude, &frame);
            motion.velocity.angular += pushed.angular;
        }
        let dt = lit(clock.dt);
        let count = substeps(inertia, &motion, &load, dt, &clock.integrator);
        let (most, iterations) = (count.largest(1.0) as u32, clock.integrator.iterations);
        let (control, _) = self.vectors(|f| {
            let [drag, rotational, translational] = f.control;
            [drag, rotational, translational, 0.0]
        });
        let factors = [control.x, control.y, control.z];
        let m = &mut motion;
        // What most bodies are has code of its own.
        match (law, self.symmetric) {
            (Law::Plate(law), true) => {
                let law = &PlatesOnly(law);
                let law = Scaled { law, factors };
                advance::<true, _, _>(inertia, &law, &load, m, dt, count, most, iterations);
            }
            (law, true) => {
                let law = Scaled { law, factors };
                advance::<true, _, _>(inertia, &law, &load, m, dt, count, most, iterations);
            }
            (law, false) => {
                let law = Scaled { law, factors };
                advance::<false, _, _>(inertia, &law, &load, m, dt, count, most, iterations);
            }
        }

        let (mut rapier_linear, mut rapier_angular) = (nothing, nothing);
        if !self.bodies.iter().all(|flyer| flyer.free) {
            rapier_linear = self.vectors(|f| f.rapier_linear).0;
            rapier_angular = self.vectors(|f| f.rapier_angular).0;
        }
        let target = Target {
            pace: &clock.pace,
            attitude: quaternion(self.vectors(|f| f.rapier_attitude)),
            end_attitude: motion.attitude,
            linear: rapier_linear,
            angular: rapier_angular,
            end_linear: rotate(&motion.attitude, &motion.velocity.linear) + stream,
            end_angular: rotate(&motion.attitude, &motion.velocity.angular) * inertia.per_length,
            displacement: motion.displacement + stream * dt,
            free,
        };
        let handover = target.hand_over();
        // What rapier adds by itself is taken off: its gravity acts on the solver's mass.
        let push = (handover.push - gravity) * solver_mass;
        let inverse = target.attitude;
        let twist = rotate_back(&inverse, &handover.twist);
        let twist = rotate(&inverse, &scale.turn(&twist));

        let q = &motion.attitude.coords;
        let Motion {
            velocity,
            rate,
            trend,
            last,
            ..
        } = &motion;
        self.land(&q.xyz(), q.w, |l| &mut l.motion.attitude);
        self.land(&velocity.linear, *last, |l| &mut l.motion.linear);
        self.land(&velocity.angular, count, |l| &mut l.motion.angular);
        self.land(&rate.linear, zero, |l| &mut l.motion.linear_rate);
        self.land(&rate.angular, zero, |l| &mut l.motion.angular_rate);
        self.land(&trend.linear, zero, |l| &mut l.motion.linear_trend);
        self.land(&trend.angular, zero, |l| &mut l.motion.angular_trend);
        self.land(&target.end_linear, zero, |l| &mut l.end_linear);
        self.land(&target.end_angular, zero, |l| &mut l.end_angular);
        self.land(&handover.start_linear, zero, |l| &mut l.start_linear);
        self.land(&handover.start_angular, zero, |l| &mut l.start_angular);
        self.land(&push, zero, |l| &mut l.push);
        self.land(&twist, zero, |l| &mut l.twist);
    }

    /// Writes a vector and one more number of each body to where it lands.
    #[inline(always)]
    fn land(
        &mut self,
        v: &Vector3<Lanes<S>>,
        more: Lanes<S>,
        row: impl Fn(&mut Landing) -> &mut Row,
    ) {
        Lanes::apart([v.x, v.y, v.z, more], |lane, value| {
            *row(&mut self.landings[self.index[lane]]) = value;
        });
    }
}
