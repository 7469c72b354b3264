//! The arithmetic of a step: many bodies, four at a time, no rapier.

use super::kind::{Kind, LawLanes};
use crate::dynamics::Integrator;
use crate::dynamics::integrate::{Inviscid, Load, Motion, advance, rotate, rotate_back, substeps};
use crate::dynamics::kirchhoff::Twist;
use crate::hydro::viscous::Evaluate;
use crate::math::{LANES, Lanes};
use rapier3d::na::{Quaternion, SimdValue, Vector3};

/// One awake body during one step: what goes in, and what comes out in the same places.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flyer {
    /// Index of the body's slot.
    pub slot: u32,
    /// Index of the body's kind.
    pub kind: u32,
    /// Plate axes to world axes (x, y, z, w).
    pub attitude: [f32; 4],
    /// Velocity relative to the fluid, plate axes (u then w = ωL), m/s.
    pub velocity: [f32; 6],
    /// Velocities that come on top of it: what happened to the body since it was integrated, or all
    /// of its velocity, or what an accelerating flow adds. World axes, m/s and rad/s.
    pub linear: [f32; 3],
    pub angular: [f32; 3],
    /// dν/dt of the last substep, plate axes (u then w = ωL), m/s².
    pub rate: [f32; 6],
    /// Velocity of the fluid, m/s, and its vorticity, 1/s.
    pub stream: [f32; 3],
    pub vorticity: [f32; 3],
    /// Gravity that the body feels, m/s²: the world's times its scale.
    pub gravity: [f32; 3],
    /// User's force, N, and torque, N·m, world axes.
    pub force: [f32; 3],
    pub torque: [f32; 3],
    /// Out: velocities at the end of the step, world axes, m/s and rad/s.
    pub end_linear: [f32; 3],
    pub end_angular: [f32; 3],
    /// Out: displacement of the center of mass over the step, m, world axes.
    pub displacement: [f32; 3],
}

/// Puts one field of four bodies side by side.
#[inline(always)]
fn side_by_side<const N: usize>(values: [[f32; N]; LANES]) -> [Lanes; N] {
    std::array::from_fn(|i| Lanes::from(values.map(|v| v[i])))
}

/// Field `i` of each lane.
#[inline(always)]
fn apart<const N: usize>(values: [Lanes; N]) -> [[f32; N]; LANES] {
    std::array::from_fn(|lane| std::array::from_fn(|i| values[i].extract(lane)))
}

/// Advances all `flyers`, whose kinds must all have the law that `pick` selects.
pub(super) fn fly(flyers: &mut [Flyer], kinds: &[Kind], dt: f32, integrator: &Integrator) {
    for group in flyers.chunks_mut(LANES) {
        let filled = group.len();
        // A last group that is not full repeats its last body.
        let mut four: [Flyer; LANES] = std::array::from_fn(|i| group[i.min(filled - 1)]);
        let kinds = four.map(|flyer| &kinds[flyer.kind as usize]);
        match kinds.map(|kind| &kind.law) {
            [
                LawLanes::Physical(a),
                LawLanes::Physical(b),
                LawLanes::Physical(c),
                LawLanes::Physical(d),
            ] => {
                let law = crate::hydro::viscous::physical::PhysicalConstants::gather([a, b, c, d]);
                fly_four(&mut four, kinds, &law, dt, integrator);
            }
            [
                LawLanes::Thesis(a),
                LawLanes::Thesis(b),
                LawLanes::Thesis(c),
                LawLanes::Thesis(d),
            ] => {
                let law = crate::hydro::viscous::thesis::ThesisConstants::gather([a, b, c, d]);
                fly_four(&mut four, kinds, &law, dt, integrator);
            }
            [
                LawLanes::Stochastic(a),
                LawLanes::Stochastic(b),
                LawLanes::Stochastic(c),
                LawLanes::Stochastic(d),
            ] => {
                let law =
                    crate::hydro::viscous::stochastic::StochasticConstants::gather([a, b, c, d]);
                fly_four(&mut four, kinds, &law, dt, integrator);
            }
            _ => fly_four(&mut four, kinds, &Inviscid, dt, integrator),
        }
        group.copy_from_slice(&four[..filled]);
    }
}

#[inline(never)]
fn fly_four(
    four: &mut [Flyer; LANES],
    kinds: [&Kind; LANES],
    law: &impl Evaluate<Lanes>,
    dt: f32,
    integrator: &Integrator,
) {
    let inertia = crate::body::InertiaConstants::gather(kinds.map(|kind| &kind.inertia));
    let scale = crate::coupling::kind::Scales::gather(kinds.map(|kind| &kind.scales));
    let dt = Lanes::splat(dt);
    let vector = |f: fn(&Flyer) -> [f32; 3]| {
        let [x, y, z] = side_by_side([f(&four[0]), f(&four[1]), f(&four[2]), f(&four[3])]);
        Vector3::new(x, y, z)
    };
    let [i, j, k, w] = side_by_side(four.map(|f| f.attitude));
    let attitude = Quaternion::new(w, i, j, k);
    let stream = vector(|f| f.stream);
    let gravity = vector(|f| f.gravity);
    let buoyancy = gravity * -scale.displaced_mass;
    let load = Load {
        force: gravity * scale.dry_mass + buoyancy + vector(|f| f.force) * scale.per_mass,
        torque: vector(|f| f.torque) * scale.per_mass_length,
        buoyancy,
        buoyancy_arm: Vector3::new(scale.arm_x, scale.arm_y, scale.arm_z),
        fluid_spin: vector(|f| f.vorticity) * (scale.length * Lanes::splat(0.5)),
    };
    let twist = |values: [Lanes; 6]| {
        let [ux, uy, uz, wx, wy, wz] = values;
        Twist {
            linear: Vector3::new(ux, uy, uz),
            angular: Vector3::new(wx, wy, wz),
        }
    };
    let kept = twist(side_by_side(four.map(|f| f.velocity)));
    let mut motion = Motion {
        attitude,
        displacement: Vector3::repeat(Lanes::splat(0.0)),
        velocity: Twist {
            linear: kept.linear + rotate_back(&attitude, &vector(|f| f.linear)),
            angular: kept.angular + rotate_back(&attitude, &(vector(|f| f.angular) * scale.length)),
        },
        rate: twist(side_by_side(four.map(|f| f.rate))),
    };
    let count = substeps(&inertia, &motion, &load, dt, integrator);
    let most = (0..LANES)
        .map(|lane| count.extract(lane))
        .fold(1.0, f32::max);

    let (m, most, iterations) = (&mut motion, most as u32, integrator.iterations);
    if kinds.iter().all(|kind| kind.constants.symmetric) {
        advance::<true, _, _>(&inertia, law, &load, m, dt, count, most, iterations);
    } else {
        advance::<false, _, _>(&inertia, law, &load, m, dt, count, most, iterations);
    }

    let linear = rotate(&motion.attitude, &motion.velocity.linear) + stream;
    let angular = rotate(&motion.attitude, &motion.velocity.angular) * inertia.per_length;
    let moved = motion.displacement + stream * dt;
    let q = &motion.attitude;
    let attitude = apart([q.i, q.j, q.k, q.w]);
    let linear = apart([linear.x, linear.y, linear.z]);
    let angular = apart([angular.x, angular.y, angular.z]);
    let moved = apart([moved.x, moved.y, moved.z]);
    let six = |v: &Twist<Lanes>| {
        let (u, w) = (&v.linear, &v.angular);
        apart([u.x, u.y, u.z, w.x, w.y, w.z])
    };
    let (velocity, rate) = (six(&motion.velocity), six(&motion.rate));
    for (lane, flyer) in four.iter_mut().enumerate() {
        flyer.attitude = attitude[lane];
        flyer.velocity = velocity[lane];
        flyer.end_linear = linear[lane];
        flyer.end_angular = angular[lane];
        flyer.displacement = moved[lane];
        flyer.rate = rate[lane];
    }
}
