//! The arithmetic of a step: many bodies, four at a time, no rapier.

use super::handover::{Handover, Target};
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
use rapier3d::na::{Quaternion, SimdValue, Vector3};

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

    /// Attitude (plate axes to world; x, y, z, w) as integrated; out: at the end of the step.
    pub attitude: [f32; 4],
    /// Velocity relative to the fluid as integrated, plate axes (u then w = ωL), m/s; out: likewise.
    pub velocity: [f32; 6],
    /// dν/dt of the last substep, plate axes, m/s²; out: likewise.
    pub rate: [f32; 6],
    /// Velocities that come on top of it: what happened to the body since it was integrated, or all
    /// of its velocity, or what an accelerating flow adds. m/s and rad/s.
    pub linear: [f32; 3],
    pub angular: [f32; 3],
    /// Velocity of the fluid, m/s, and its vorticity, 1/s.
    pub stream: [f32; 3],
    pub vorticity: [f32; 3],
    /// Gravity that the body feels, m/s²: the world's times its scale.
    pub gravity: [f32; 3],
    /// User's force, N, and torque, N·m.
    pub force: [f32; 3],
    pub torque: [f32; 3],

    /// What rapier has: attitude (plate axes to world) and velocities.
    pub rapier_attitude: [f32; 4],
    pub rapier_linear: [f32; 3],
    pub rapier_angular: [f32; 3],

    /// Out: velocities at the end of the step, m/s and rad/s.
    pub end_linear: [f32; 3],
    pub end_angular: [f32; 3],
    /// Out: velocities to start from, and the force and torque to apply.
    pub start_linear: [f32; 3],
    pub start_angular: [f32; 3],
    pub push: [f32; 3],
    pub twist: [f32; 3],
}

/// How a step is taken.
#[derive(Clone, Copy)]
pub(super) struct Clock {
    pub dt: f32,
    /// Rapier's substeps per step.
    pub substeps: usize,
    pub integrator: Integrator,
}

/// Puts one field of four bodies side by side.
#[inline(always)]
fn side_by_side<const N: usize>(values: [[f32; N]; LANES]) -> [Lanes; N] {
    std::array::from_fn(|i| Lanes::from(values.map(|v| v[i])))
}

/// Lane by lane.
#[inline(always)]
fn apart<const N: usize>(values: [Lanes; N]) -> [[f32; N]; LANES] {
    let rows: [[f32; LANES]; N] = values.map(|v| v.0.to_array());
    std::array::from_fn(|lane| std::array::from_fn(|i| rows[i][lane]))
}

/// Advances `flyers`, whose kinds must all be of the same `route`.
pub(super) fn fly(flyers: &mut [Flyer], kinds: &[Kind], route: Route, clock: &Clock) {
    if route.symmetric {
        fly_route::<true>(flyers, kinds, clock);
    } else {
        fly_route::<false>(flyers, kinds, clock);
    }
}

fn fly_route<const SYMMETRIC: bool>(flyers: &mut [Flyer], kinds: &[Kind], clock: &Clock) {
    for group in flyers.chunks_mut(LANES) {
        let filled = group.len();
        // A last group that is not full repeats its last body.
        let mut four: [Flyer; LANES] = std::array::from_fn(|i| group[i.min(filled - 1)]);
        let kinds = four.map(|flyer| &kinds[flyer.kind as usize]);
        let laws = kinds.map(|kind| &kind.law);
        match laws {
            [
                LawLanes::Plate(a),
                LawLanes::Plate(b),
                LawLanes::Plate(c),
                LawLanes::Plate(d),
            ] => {
                let law = PhysicalConstants::gather([a, b, c, d]);
                fly_four::<SYMMETRIC>(&mut four, kinds, &PlatesOnly(&law), clock);
            }
            [
                LawLanes::Physical(a),
                LawLanes::Physical(b),
                LawLanes::Physical(c),
                LawLanes::Physical(d),
            ] => {
                let law = PhysicalConstants::gather([a, b, c, d]);
                fly_four::<SYMMETRIC>(&mut four, kinds, &law, clock);
            }
            [
                LawLanes::Thesis(a),
                LawLanes::Thesis(b),
                LawLanes::Thesis(c),
                LawLanes::Thesis(d),
            ] => {
                let law = ThesisConstants::gather([a, b, c, d]);
                fly_four::<SYMMETRIC>(&mut four, kinds, &law, clock);
            }
            [
                LawLanes::Stochastic(a),
                LawLanes::Stochastic(b),
                LawLanes::Stochastic(c),
                LawLanes::Stochastic(d),
            ] => {
                let law = StochasticConstants::gather([a, b, c, d]);
                fly_four::<SYMMETRIC>(&mut four, kinds, &law, clock);
            }
            _ => fly_four::<SYMMETRIC>(&mut four, kinds, &Inviscid, clock),
        }
        group.copy_from_slice(&four[..filled]);
    }
}

#[inline(never)]
fn fly_four<const SYMMETRIC: bool>(
    four: &mut [Flyer; LANES],
    kinds: [&Kind; LANES],
    law: &impl Evaluate<Lanes>,
    clock: &Clock,
) {
    let inertia = InertiaConstants::gather(kinds.map(|kind| &kind.inertia));
    let scale = Scales::gather(kinds.map(|kind| &kind.scales));
    let dt = Lanes::splat(clock.dt);
    let vector = |f: fn(&Flyer) -> [f32; 3]| {
        let [x, y, z] = side_by_side([f(&four[0]), f(&four[1]), f(&four[2]), f(&four[3])]);
        Vector3::new(x, y, z)
    };
    let quaternion = |f: fn(&Flyer) -> [f32; 4]| {
        let [i, j, k, w] = side_by_side([f(&four[0]), f(&four[1]), f(&four[2]), f(&four[3])]);
        Quaternion::new(w, i, j, k)
    };
    let twist = |f: fn(&Flyer) -> [f32; 6]| {
        let [ux, uy, uz, wx, wy, wz] =
            side_by_side([f(&four[0]), f(&four[1]), f(&four[2]), f(&four[3])]);
        Twist {
            linear: Vector3::new(ux, uy, uz),
            angular: Vector3::new(wx, wy, wz),
        }
    };
    let attitude = quaternion(|f| f.attitude);
    let stream = vector(|f| f.stream);
    let gravity = vector(|f| f.gravity);
    let buoyancy = gravity * -scale.displaced_mass;
    let zero = [0.0; 3];
    let turning = |(flyer, kind): (&Flyer, &&Kind)| {
        flyer.torque != zero || flyer.vorticity != zero || kind.buoyancy_turns
    };
    let load = Load {
        force: gravity * scale.dry_mass + buoyancy + vector(|f| f.force) * scale.per_mass,
        torque: vector(|f| f.torque) * scale.per_mass_length,
        buoyancy,
        buoyancy_arm: Vector3::new(scale.arm_x, scale.arm_y, scale.arm_z),
        fluid_spin: vector(|f| f.vorticity) * (scale.length * Lanes::splat(0.5)),
        turning: four.iter().zip(&kinds).any(turning),
    };
    let kept = twist(|f| f.velocity);
    let mut motion = Motion {
        attitude,
        displacement: Vector3::repeat(Lanes::splat(0.0)),
        velocity: Twist {
            linear: kept.linear + rotate_back(&attitude, &vector(|f| f.linear)),
            angular: kept.angular + rotate_back(&attitude, &(vector(|f| f.angular) * scale.length)),
        },
        rate: twist(|f| f.rate),
    };
    let law = &Scaled {
        law,
        factors: side_by_side(four.map(|f| f.control)),
    };
    let count = substeps(&inertia, &motion, &load, dt, &clock.integrator);
    let most = count.0.to_array().into_iter().fold(1.0, f32::max) as u32;
    advance::<SYMMETRIC, _, _>(
        &inertia,
        law,
        &load,
        &mut motion,
        dt,
        count,
        most,
        clock.integrator.iterations,
    );

    let target = Target {
        dt: clock.dt,
        substeps: clock.substeps,
        attitude: quaternion(|f| f.rapier_attitude),
        end_attitude: motion.attitude,
        linear: vector(|f| f.rapier_linear),
        angular: vector(|f| f.rapier_angular),
        end_linear: rotate(&motion.attitude, &motion.velocity.linear) + stream,
        end_angular: rotate(&motion.attitude, &motion.velocity.angular) * inertia.per_length,
        displacement: motion.displacement + stream * dt,
        free: Lanes::from(four.map(|f| f32::from(u8::from(f.free)))),
    };
    let Handover {
        start_linear,
        start_angular,
        push,
        twist,
    } = target.hand_over();
    let solver_mass = Lanes::from(four.map(|f| f.solver_mass));
    // What rapier adds by itself is taken off: its gravity acts on the solver's mass.
    let push = (push - gravity) * solver_mass;
    let inverse = target.attitude;
    let twist = rotate_back(&inverse, &twist);
    let twist = rotate(&inverse, &scale.turn(&twist));

    let three = |v: &Vector3<Lanes>| apart([v.x, v.y, v.z]);
    let six = |v: &Twist<Lanes>| {
        let (u, w) = (&v.linear, &v.angular);
        apart([u.x, u.y, u.z, w.x, w.y, w.z])
    };
    let q = &motion.attitude;
    let attitude = apart([q.i, q.j, q.k, q.w]);
    let (velocity, rate) = (six(&motion.velocity), six(&motion.rate));
    let (end_linear, end_angular) = (three(&target.end_linear), three(&target.end_angular));
    let (start_linear, start_angular) = (three(&start_linear), three(&start_angular));
    let (push, twist) = (three(&push), three(&twist));
    for (lane, flyer) in four.iter_mut().enumerate() {
        flyer.attitude = attitude[lane];
        flyer.velocity = velocity[lane];
        flyer.rate = rate[lane];
        flyer.end_linear = end_linear[lane];
        flyer.end_angular = end_angular[lane];
        flyer.start_linear = start_linear[lane];
        flyer.start_angular = start_angular[lane];
        flyer.push = push[lane];
        flyer.twist = twist[lane];
    }
}
