//! The forces of several fluids on a body, in one substep.

use super::constants::CrossingFluid;
use super::portion::Portion;
use crate::dynamics::constants::InertiaConstants;
use crate::dynamics::load::Load;
use crate::dynamics::parts::{PartNow, couple, fastest_decay};
use crate::dynamics::reaction::{Frozen, Reaction, implicitness};
use crate::hydro::part_law::Exact;
use crate::hydro::part_law::place::CoupledMass;
use crate::hydro::viscous::ForceFactors;
use crate::math::spatial::{Blocks, Twist};
use rapier3d::na::{Matrix3, Vector3};

/// A fluid that rests where the lowest does is not asked for its force on a part if it has less than this share of the mass
/// that the lowest has there, and so of the force: air over still water.
const SLIGHT: f64 = 0.01;
/// Share of a part below which its fluid is not asked for its force.
const NOTHING: f64 = 1e-6;

/// What the fluids do to a body in a substep. Units of the integrator.
pub(super) struct Fluids<'a> {
    /// The layers that the body is in.
    pub fluids: &'a [CrossingFluid],
    /// What of each part is in each layer, and what goes on there: layer by layer.
    pub portions: &'a [Portion],
    pub now: &'a [PartNow<f64>],
    /// What the lengths of portions are divided by, m.
    pub length: f64,
    /// The added mass that couples.
    pub coupled: CoupledMass<f64>,
    /// Hydrostatic stiffness, 1/s², and the damping by the waves that the body makes over it, s.
    pub stiffness: Blocks<f64>,
    pub radiation: f64,
}

/// The added mass that couples of a body with these portions in fluids, each at the middle of what is there.
pub(super) fn coupled_mass<'a>(
    portions: impl Iterator<Item = (Portion, &'a CrossingFluid)>,
    length: f64,
) -> CoupledMass<f64> {
    let mut sum = CoupledMass {
        m11: Matrix3::zeros(),
        m12: Matrix3::zeros(),
        isotropic: 0.0,
        first: Vector3::zeros(),
        second: Matrix3::zeros(),
    };
    for (Portion { share, shift }, fluid) in portions {
        if share < NOTHING {
            continue;
        }
        let own = &fluid.coupled.moved(&(shift / length));
        sum.m11 += own.m11 * share;
        sum.m12 += own.m12 * share;
        sum.isotropic += own.isotropic * share;
        sum.first += own.first * share;
        sum.second += own.second * share;
    }
    sum
}

impl Reaction<f64> for Fluids<'_> {
    fn least_iterations(&self) -> u32 {
        1
    }

    fn increment<const SYMMETRIC: bool>(
        &self,
        inertia: &InertiaConstants<f64>,
        load: &Load<f64>,
        frozen: &Frozen<f64>,
        h: f64,
    ) -> Twist<f64> {
        let Frozen {
            start,
            middle,
            attitude,
        } = frozen;
        let mut applied = load.applied(attitude);
        let mut n = Blocks::zero(h);
        let of_layers = |fluid: &CrossingFluid| fluid.parts.len();
        let count = self.fluids.first().map_or(1, of_layers).max(1);
        let lowest = self.portions.rchunks(count).next().unwrap_or_default();
        let rows = self.portions.chunks(count).zip(self.now.chunks(count));
        let rows = self
            .fluids
            .iter()
            .zip(rows)
            .flat_map(|(fluid, (own, now))| {
                let own = fluid.parts.iter().zip(own).zip(now);
                own.zip(lowest).map(move |own| (fluid.density, own))
            });
        let densest = self.fluids.last().map_or(0.0, |fluid| fluid.density);
        for (density, (((part, portion), now), below)) in rows {
            let still = now.velocity == Vector3::zeros() && now.spin == Vector3::zeros();
            let slight = density * portion.share < SLIGHT * densest * below.share;
            if portion.share < NOTHING || (still && slight) {
                continue;
            }
            let mut place = part.place_now(Exact, true, now);
            place.position += portion.shift / self.length;
            let factors = ForceFactors {
                drag: now.factors.drag * portion.share,
                rotational_lift: now.factors.rotational_lift * portion.share,
                translational_lift: now.factors.translational_lift * portion.share,
            };
            let now = PartNow { factors, ..*now };
            part.add_in_flow(Exact, &place, &now, frozen, &mut n, &mut applied);
        }
        n = n.less_scaled(&self.stiffness, self.radiation);
        let theta = implicitness(h * fastest_decay(inertia, &n));
        couple(&self.coupled, inertia, middle, &mut n);
        let system = inertia.mass_matrix().less_scaled(&n, theta * h);
        let system = system.less_scaled(&self.stiffness, -0.25 * h * h);
        let mut right = (n.apply(start) + applied).scaled(h);
        let restoring = self.stiffness.apply(start).scaled(-0.5 * h * h);
        right.force += restoring.force;
        right.torque += restoring.torque;
        let free = system.solve(&right);
        if load.locks.any {
            load.locks
                .increment(&free, &system, &right, start, attitude, h, theta)
        } else {
            free
        }
    }
}
