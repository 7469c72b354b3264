//! The arithmetic of a step: many bodies, four at a time, no rapier.

use super::handover::{Pace, Target};
use super::immersion::{NONE, Slot};
use super::kind::{Kind, LawLanes, Route, Scales};
use crate::body::InertiaConstants;
use crate::dynamics::Integrator;
use crate::dynamics::integrate::{Inviscid, Load, Motion, advance, rotate, rotate_back, substeps};
use crate::dynamics::kirchhoff::Twist;
use crate::hydro::viscous::Evaluate;
use crate::hydro::viscous::physical::{PhysicalConstants, PlatesOnly};
use crate::hydro::viscous::scaled::Scaled;
use crate::hydro::viscous::stochastic::StochasticConstants;
use crate::hydro::viscous::thesis::ThesisConstants;
use crate::math::{LANES, Lanes};
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::math::{Rotation, Vector};
use rapier3d::na::{Quaternion, SimdValue, Vector3};
use simba::simd::WideF32x4;

/// A vector and one more number, or a quaternion (x, y, z, w): what four lanes are filled with at
/// once.
pub(super) type Row = [f32; 4];

/// A vector as a row.
#[inline(always)]
pub(super) fn row(v: Vector) -> Row {
    [v.x, v.y, v.z, 0.0]
}

/// The vector of a row.
#[inline(always)]
pub(super) fn vector([x, y, z, _]: Row) -> Vector {
    Vector::new(x, y, z)
}

/// One awake body during one step. World axes unless said otherwise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flyer {
    pub handle: RigidBodyHandle,
    /// Indices of the body's slot and kind.
    pub slot: u32,
    pub kind: u32,
    /// Touches nothing and is held by nothing: velocity and pose are handed over exactly.
    pub free: bool,
    /// Is in contact or held, so that rapier may let it sleep.
    pub may_sleep: bool,
    /// Goes on with the velocity relative to the fluid that was integrated.
    pub goes_on: bool,
    /// Mass that rapier's solver uses, kg; `new_mass` if rapier has to be told.
    pub solver_mass: f32,
    pub new_mass: bool,
    /// Factors on the law's drag, rotational lift and translational lift.
    pub control: [f32; 3],
    /// Share of the world's gravity that the body feels.
    pub gravity_scale: f32,
    /// Index of the body's [`Extra`], `NONE` if it has none.
    pub extra: u32,
    /// Whether a torque or the fluid's vorticity turns the body.
    pub turned: bool,
    /// What rapier has: attitude (plate axes to world) and velocities.
    pub rapier_attitude: Row,
    pub rapier_linear: Row,
    pub rapier_angular: Row,
}

/// What most bodies in still fluid have none of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Extra {
    /// Velocities relative to the fluid that come on top of what was integrated: what happened to
    /// the body since, or all of its velocity. m/s and rad/s.
    pub linear: Row,
    pub angular: Row,
    /// Velocity of the fluid, m/s, its vorticity, 1/s, and the change of its velocity since the last
    /// step.
    pub stream: Row,
    pub vorticity: Row,
    pub stream_change: Row,
    /// User's force, N, and torque, N·m.
    pub force: Row,
    pub torque: Row,
}

/// What a step makes of a [`Flyer`]. World axes unless said otherwise.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Landing {
    /// Motion at the end of the step.
    pub motion: Integrated,
    /// Velocities at the end of the step, m/s and rad/s.
    pub end_linear: Row,
    pub end_angular: Row,
    /// Velocities to start from, and the force and torque to apply.
    pub start_linear: Row,
    pub start_angular: Row,
    pub push: Row,
    pub twist: Row,
}

/// The motion of a body as the integrator carries it from step to step: plate axes, relative to the
/// fluid.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct Integrated {
    /// Plate axes to world.
    pub attitude: Row,
    /// u, m/s, and the length of the last substep, s.
    pub linear: Row,
    /// w = ωL, m/s, and the number of substeps in the last step.
    pub angular: Row,
    /// dν/dt of the last substep, m/s².
    pub linear_rate: Row,
    pub angular_rate: Row,
    /// d²ν/dt² between the last two substeps, m/s³.
    pub linear_trend: Row,
    pub angular_trend: Row,
}

impl Integrated {
    /// At rest in the fluid, without history.
    pub fn at(attitude: Rotation) -> Self {
        Self {
            attitude: attitude.to_array(),
            ..Self::default()
        }
    }
}

/// How a step is taken.
#[derive(Clone, Copy)]
pub(super) struct Clock {
    pub dt: f32,
    pub pace: Pace,
    pub gravity: Vector,
    pub integrator: Integrator,
}

/// One row of four bodies side by side.
#[inline(always)]
fn side_by_side(rows: [Row; LANES]) -> [Lanes; 4] {
    wide::f32x4::transpose(rows.map(wide::f32x4::from)).map(WideF32x4)
}

/// Vectors side by side, and the number that came with them.
#[inline(always)]
fn vectors(rows: [Row; LANES]) -> (Vector3<Lanes>, Lanes) {
    let [x, y, z, more] = side_by_side(rows);
    (Vector3::new(x, y, z), more)
}

#[inline(always)]
fn quaternions(rows: [Row; LANES]) -> Quaternion<Lanes> {
    let [i, j, k, w] = side_by_side(rows);
    Quaternion::new(w, i, j, k)
}

/// Lane by lane.
#[inline(always)]
fn apart(v: &Vector3<Lanes>, more: Lanes) -> [Row; LANES] {
    wide::f32x4::transpose([v.x.0, v.y.0, v.z.0, more.0]).map(|row| row.to_array())
}

/// What the bodies of a batch have in common.
#[derive(Clone, Copy)]
pub(super) struct Air<'a> {
    pub slots: &'a [Option<Slot>],
    pub kinds: &'a [Kind],
    pub extras: &'a [Extra],
    pub clock: &'a Clock,
}

impl Air<'_> {
    #[inline(always)]
    fn motion(&self, flyer: &Flyer) -> &Integrated {
        const REST: &Integrated = &Integrated {
            attitude: [0.0, 0.0, 0.0, 1.0],
            linear: [0.0; 4],
            angular: [0.0; 4],
            linear_rate: [0.0; 4],
            angular_rate: [0.0; 4],
            linear_trend: [0.0; 4],
            angular_trend: [0.0; 4],
        };
        let slot = self.slots.get(flyer.slot as usize).and_then(Option::as_ref);
        slot.map_or(REST, |slot| &slot.flight.motion)
    }

    #[inline(always)]
    fn extra(&self, flyer: &Flyer) -> &Extra {
        const NOTHING: &Extra = &Extra {
            linear: [0.0; 4],
            angular: [0.0; 4],
            stream: [0.0; 4],
            vorticity: [0.0; 4],
            stream_change: [0.0; 4],
            force: [0.0; 4],
            torque: [0.0; 4],
        };
        self.extras.get(flyer.extra as usize).unwrap_or(NOTHING)
    }
}

/// Bodies that are sorted by their number of substeps, so that few lanes stand still.
const WINDOW: usize = 64;

/// Advances `flyers`, whose kinds must all be of the same `route`, with the widest instructions that
/// the machine has; they round alike on all machines.
pub(super) fn fly(flyers: &[Flyer], landings: &mut [Landing], route: Route, air: Air) {
    pulp::Arch::new().dispatch(Flock {
        flyers,
        landings,
        route,
        air,
    });
}

struct Flock<'a> {
    flyers: &'a [Flyer],
    landings: &'a mut [Landing],
    route: Route,
    air: Air<'a>,
}

impl pulp::WithSimd for Flock<'_> {
    type Output = ();

    // Not a closure: its call would not be inlined into code with the features.
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let windows = self.flyers.chunks(WINDOW);
        for (flyers, landings) in windows.zip(self.landings.chunks_mut(WINDOW)) {
            if self.route.symmetric {
                fly_window::<true>(flyers, landings, self.air);
            } else {
                fly_window::<false>(flyers, landings, self.air);
            }
        }
    }
}

/// Indices of a window's flyers, by the substeps that they took last.
#[inline(always)]
fn by_substeps(flyers: &[Flyer], air: Air) -> [u8; WINDOW] {
    const CLASSES: u8 = 16;
    let mut classes = [0; WINDOW];
    let mut starts = [0_u8; CLASSES as usize + 1];
    for (flyer, class) in flyers.iter().zip(&mut classes) {
        *class = (air.motion(flyer).angular[3] as u8).min(CLASSES - 1);
        starts[usize::from(*class) + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut order = [0; WINDOW];
    for (index, class) in classes[..flyers.len()].iter().enumerate() {
        let place = &mut starts[usize::from(*class)];
        order[usize::from(*place) % WINDOW] = index as u8;
        *place += 1;
    }
    order
}

#[inline(always)]
fn fly_window<const SYMMETRIC: bool>(flyers: &[Flyer], landings: &mut [Landing], air: Air) {
    let order = by_substeps(flyers, air);
    for group in order[..flyers.len()].chunks(LANES) {
        // A last group that is not full repeats its last body.
        let index: [usize; LANES] =
            std::array::from_fn(|lane| group[lane.min(group.len() - 1)].into());
        let four = index.map(|i| &flyers[i]);
        let kinds = four.map(|flyer| &air.kinds[flyer.kind as usize]);
        let laws = kinds.map(|kind| &kind.law);
        let mut wing = Wing::<SYMMETRIC> {
            four,
            kinds,
            alike: kinds.iter().all(|kind| std::ptr::eq(*kind, kinds[0])),
            index,
            landings: &mut *landings,
            air,
        };
        match laws {
            [
                LawLanes::Plate(a),
                LawLanes::Plate(b),
                LawLanes::Plate(c),
                LawLanes::Plate(d),
            ] => {
                let mixed;
                let law = if wing.alike {
                    a
                } else {
                    mixed = PhysicalConstants::gather([a, b, c, d]);
                    &mixed
                };
                wing.fly(&PlatesOnly(law));
            }
            [
                LawLanes::Physical(a),
                LawLanes::Physical(b),
                LawLanes::Physical(c),
                LawLanes::Physical(d),
            ] => wing.fly(&PhysicalConstants::gather([a, b, c, d])),
            [
                LawLanes::Thesis(a),
                LawLanes::Thesis(b),
                LawLanes::Thesis(c),
                LawLanes::Thesis(d),
            ] => wing.fly(&ThesisConstants::gather([a, b, c, d])),
            [
                LawLanes::Stochastic(a),
                LawLanes::Stochastic(b),
                LawLanes::Stochastic(c),
                LawLanes::Stochastic(d),
            ] => wing.fly(&StochasticConstants::gather([a, b, c, d])),
            _ => wing.fly(&Inviscid),
        }
    }
}

/// Four bodies on their way.
struct Wing<'a, const SYMMETRIC: bool> {
    four: [&'a Flyer; LANES],
    kinds: [&'a Kind; LANES],
    /// Whether the kinds are one.
    alike: bool,
    /// Where they land.
    index: [usize; LANES],
    landings: &'a mut [Landing],
    air: Air<'a>,
}

impl<const SYMMETRIC: bool> Wing<'_, SYMMETRIC> {
    #[inline(always)]
    fn rows(&self, row: impl Fn(&Flyer) -> Row) -> [Row; LANES] {
        self.four.map(row)
    }

    #[inline(always)]
    fn kept(&self, row: impl Fn(&Integrated) -> Row) -> [Row; LANES] {
        self.four.map(|flyer| row(self.air.motion(flyer)))
    }

    #[inline(always)]
    fn fly(&mut self, law: &impl Evaluate<Lanes>) {
        let mixed;
        let (inertia, scale) = if self.alike {
            (&self.kinds[0].inertia, &self.kinds[0].scales)
        } else {
            mixed = (
                InertiaConstants::gather(self.kinds.map(|kind| &kind.inertia)),
                Scales::gather(self.kinds.map(|kind| &kind.scales)),
            );
            (&mixed.0, &mixed.1)
        };
        let clock = self.air.clock;
        let zero = Lanes::splat(0.0);
        let nothing = Vector3::repeat(zero);
        let attitude = quaternions(self.kept(|m| m.attitude));
        let (linear, last) = vectors(self.kept(|m| m.linear));
        let (angular, _) = vectors(self.kept(|m| m.angular));
        let mut motion = Motion {
            attitude,
            displacement: nothing,
            velocity: Twist { linear, angular },
            rate: Twist {
                linear: vectors(self.kept(|m| m.linear_rate)).0,
                angular: vectors(self.kept(|m| m.angular_rate)).0,
            },
            trend: Twist {
                linear: vectors(self.kept(|m| m.linear_trend)).0,
                angular: vectors(self.kept(|m| m.angular_trend)).0,
            },
            last,
        };
        let [solver_mass, gravity_scale, free, _] = side_by_side(self.rows(|f| {
            let free = f32::from(u8::from(f.free));
            [f.solver_mass, f.gravity_scale, free, 0.0]
        }));
        let gravity = Vector3::from(clock.gravity.to_array().map(Lanes::splat)) * gravity_scale;
        let buoyancy = gravity * -scale.displaced_mass;
        let mut load = Load {
            force: gravity * scale.dry_mass + buoyancy,
            torque: nothing,
            buoyancy,
            buoyancy_arm: Vector3::new(scale.arm_x, scale.arm_y, scale.arm_z),
            fluid_spin: nothing,
            turning: self.kinds.iter().any(|kind| kind.buoyancy_turns),
        };
        let mut stream = nothing;
        if self.four.iter().any(|flyer| flyer.extra != NONE) {
            let extra = |row: fn(&Extra) -> Row| vectors(self.rows(|f| row(self.air.extra(f)))).0;
            stream = extra(|e| e.stream);
            load.force += extra(|e| e.force) * scale.per_mass;
            load.torque = extra(|e| e.torque) * scale.per_mass_length;
            load.fluid_spin = extra(|e| e.vorticity) * (scale.length * Lanes::splat(0.5));
            load.turning |= self.four.iter().any(|flyer| flyer.turned);
            let on_top = rotate_back(&attitude, &extra(|e| e.linear));
            let spin = rotate_back(&attitude, &(extra(|e| e.angular) * scale.length));
            let change = rotate_back(&attitude, &extra(|e| e.stream_change));
            let pushed = scale.pushed_by(&change);
            motion.velocity.linear += on_top + pushed.linear;
            motion.velocity.angular += spin + pushed.angular;
        }
        let [drag, rotational, translational, _] = side_by_side(self.rows(|f| {
            let [drag, rotational, translational] = f.control;
            [drag, rotational, translational, 0.0]
        }));
        let law = &Scaled {
            law,
            factors: [drag, rotational, translational],
        };
        let dt = Lanes::splat(clock.dt);
        let count = substeps(inertia, &motion, &load, dt, &clock.integrator);
        let most = count.0.to_array().into_iter().fold(1.0, f32::max) as u32;
        advance::<SYMMETRIC, _, _>(
            inertia,
            law,
            &load,
            &mut motion,
            dt,
            count,
            most,
            clock.integrator.iterations,
        );

        let (mut rapier_linear, mut rapier_angular) = (nothing, nothing);
        if !self.four.iter().all(|flyer| flyer.free) {
            rapier_linear = vectors(self.rows(|f| f.rapier_linear)).0;
            rapier_angular = vectors(self.rows(|f| f.rapier_angular)).0;
        }
        let target = Target {
            pace: &clock.pace,
            attitude: quaternions(self.rows(|f| f.rapier_attitude)),
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

        let q = &motion.attitude;
        let attitude = apart(&Vector3::new(q.i, q.j, q.k), q.w);
        let linear = apart(&motion.velocity.linear, motion.last);
        let angular = apart(&motion.velocity.angular, count);
        let linear_rate = apart(&motion.rate.linear, zero);
        let angular_rate = apart(&motion.rate.angular, zero);
        let linear_trend = apart(&motion.trend.linear, zero);
        let angular_trend = apart(&motion.trend.angular, zero);
        let end_linear = apart(&target.end_linear, zero);
        let end_angular = apart(&target.end_angular, zero);
        let start_linear = apart(&handover.start_linear, zero);
        let start_angular = apart(&handover.start_angular, zero);
        let push = apart(&push, zero);
        let twist = apart(&twist, zero);
        for (lane, index) in self.index.iter().enumerate() {
            self.landings[*index] = Landing {
                motion: Integrated {
                    attitude: attitude[lane],
                    linear: linear[lane],
                    angular: angular[lane],
                    linear_rate: linear_rate[lane],
                    angular_rate: angular_rate[lane],
                    linear_trend: linear_trend[lane],
                    angular_trend: angular_trend[lane],
                },
                end_linear: end_linear[lane],
                end_angular: end_angular[lane],
                start_linear: start_linear[lane],
                start_angular: start_angular[lane],
                push: push[lane],
                twist: twist[lane],
            };
        }
    }
}
