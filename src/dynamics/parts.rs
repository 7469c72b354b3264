//! A body of several parts: what their forces add up to in a substep.
//!
//! Part i sees the velocity `ν − νᵢ`, νᵢ being that of the fluid around it: its own flow sample. Its law gives
//! a matrix Nᵢ whose symmetric part is not positive, about its own point; moved to the center of mass by the congruence
//! `XᵀNX` and added up it is still a resistance, so that the linearly implicit substep of
//! [`integrate`](super::integrate) is as stable and passive with a hundred parts as with one:
//!
//! ```text
//! (𝕄 − θh(C + ΣNᵢ)) Δν = h (C ν₀ + Σ Nᵢ (ν₀ − νᵢ) + Q)
//! ```
//!
//! C is the inertial coupling, skew for any momentum: of the fluid's, each part's added mass counts with the share
//! that its law keeps.

use super::constants::InertiaConstants;
use super::load::Load;
use super::part_constants::PartConstants;
use super::reaction::{Frozen, Reaction, implicitness};
use crate::hydro::part_law::Raise;
use crate::hydro::part_law::place::{CoupledMass, PartPlace};
use crate::hydro::viscous::ForceFactors;
use crate::math;
use crate::math::Scalar;
use crate::math::spatial::{Blocks, Twist, Wrench, cross, product, rotate_back, skew, transform};
use rapier3d::na::Vector3;

/// What the fluid around a part does, and how the part is set: of one body, or of several side by side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PartNow<T> {
    /// Velocity of the fluid at the part relative to that of the body's frame, and its spin ½ curl times L; world axes,
    /// m/s.
    pub velocity: Vector3<T>,
    pub spin: Vector3<T>,
    /// Factors on its law's forces.
    pub factors: ForceFactors<T>,
    /// Sine and cosine of its deflection.
    pub sine: T,
    pub cosine: T,
}

impl PartNow<f64> {
    /// In a fluid at rest, with a deflection, rad.
    pub fn at_rest(deflection: f64) -> Self {
        let (sine, cosine) = math::sin_cos(deflection);
        Self {
            velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
            factors: ForceFactors::default(),
            sine,
            cosine,
        }
    }
}

/// The parts of bodies that are alike.
pub(crate) struct Parts<'a, K, R, N> {
    pub constants: &'a [PartConstants<K>],
    pub coupled: &'a CoupledMass<K>,
    pub raise: R,
    /// What goes on at each part.
    pub now: N,
    /// Whether fluid flows differently at the parts, and whether one is deflected.
    pub flows: bool,
    pub deflected: bool,
}

impl<T: Scalar, R: Raise<T>, N: Fn(usize) -> PartNow<T>> Reaction<T> for Parts<'_, R::Kept, R, N> {
    #[inline(always)]
    fn least_iterations(&self) -> u32 {
        1
    }

    #[inline(always)]
    fn increment<const SYMMETRIC: bool>(
        &self,
        inertia: &InertiaConstants<T>,
        load: &Load<T>,
        frozen: &Frozen<T>,
        h: T,
    ) -> Twist<T> {
        let Frozen {
            start,
            middle,
            attitude,
        } = frozen;
        let mut applied = load.applied(attitude);
        let mut n = Blocks::zero(h);
        for (i, part) in self.constants.iter().enumerate() {
            let now = (self.now)(i);
            let place = part.place_now(self.raise, self.deflected, &now);
            if self.flows {
                part.add_in_flow(self.raise, &place, &now, frozen, &mut n, &mut applied);
            } else {
                n.add(&part.law.matrix(self.raise, &place, middle, now.factors));
            }
        }

        let theta = implicitness(h * fastest_decay(inertia, &n));
        couple(&self.raise.coupled(self.coupled), inertia, middle, &mut n);
        let system = inertia.mass_matrix().less_scaled(&n, theta * h);
        let right = (n.apply(start) + applied).scaled(h);
        let free = system.solve(&right);
        if load.locks.any {
            load.locks
                .increment(&free, &system, &right, start, attitude, h, theta)
        } else {
            free
        }
    }
}

impl<K: Copy + std::fmt::Debug + PartialEq + 'static> PartConstants<K> {
    /// Where the part is, turned about its hinge if some part is.
    #[inline(always)]
    pub fn place_now<T: Scalar, R: Raise<T, Kept = K>>(
        &self,
        raise: R,
        deflected: bool,
        now: &PartNow<T>,
    ) -> PartPlace<T> {
        let place = raise.place(&self.place);
        match &self.hinge {
            Some(hinge) if deflected => raise.hinge(hinge).turned(&place, now.sine, now.cosine),
            _ => place,
        }
    }

    /// Adds the part's matrix in a fluid that moves around it, and the force of that motion.
    #[inline(always)]
    pub fn add_in_flow<T: Scalar, R: Raise<T, Kept = K>>(
        &self,
        raise: R,
        place: &PartPlace<T>,
        now: &PartNow<T>,
        frozen: &Frozen<T>,
        n: &mut Blocks<T>,
        applied: &mut Wrench<T>,
    ) {
        // The fluid's motion around the part, as a twist about the center of mass.
        let spin = rotate_back(&frozen.attitude, &now.spin);
        let fluid = Twist {
            linear: rotate_back(&frozen.attitude, &now.velocity) - cross(&spin, &place.position),
            angular: spin,
        };
        let relative = frozen.middle.add_scaled(&fluid, now.sine.constant(-1.0));
        let of_part = self.law.matrix(raise, place, &relative, now.factors);
        let carried = of_part.apply(&fluid);
        applied.force -= carried.force;
        applied.torque -= carried.torque;
        n.add(&of_part);
    }
}

/// The rate at which the motion decays that the matrix of all forces brakes most, 1/s.
#[inline(always)]
pub(super) fn fastest_decay<T: Scalar>(inertia: &InertiaConstants<T>, n: &Blocks<T>) -> T {
    let along = |i: usize| {
        let linear = n.m11[(i, i)] * inertia.per_m11[i];
        let angular = n.m22[(i, i)] * inertia.per_m22[i];
        -linear.min(angular)
    };
    along(0).max(along(1)).max(along(2))
}

/// Adds the inertial coupling: see [`InertiaConstants::coupling_matrix`], of which this is the sum over parts: `[r]× [ω]× [r]×` is
/// `−(r·ω) [r]×`.
#[inline(always)]
pub(super) fn couple<T: Scalar>(
    coupled: &CoupledMass<T>,
    inertia: &InertiaConstants<T>,
    v: &Twist<T>,
    n: &mut Blocks<T>,
) {
    let (u, w) = (&v.linear, &v.angular);
    let per_length = inertia.per_length;
    let turned = transform(&coupled.second, w);
    let trace = coupled.second.m11 + coupled.second.m22 + coupled.second.m33;
    let p = transform(&coupled.m11, u) + transform(&coupled.m12, w);
    let h =
        transform(&inertia.m22, w) + turned - w * trace + transform(&coupled.m12.transpose(), u);
    let p = skew(&(p * per_length));
    let own = skew(&(w * ((inertia.dry_mass + coupled.isotropic) * per_length)));
    let own12 = product(&skew(&(w * per_length)), &skew(&coupled.first));
    n.m11 -= own;
    n.m12 += p + own12;
    n.m21 += p - own12.transpose();
    n.m22 += skew(&((h - turned) * per_length));
}
