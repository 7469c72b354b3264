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
use super::integrate::Load;
use super::reaction::{Frozen, Reaction, implicitness};
use crate::body::{ImmersedBody, Part};
use crate::fluid::Fluid;
use crate::hydro::part_law::place::{CoupledMass, HingePlace, PartPlace};
use crate::hydro::part_law::{PreparedPart, Raise};
use crate::hydro::viscous::ForceFactors;
use crate::hydro::{AddedMass, HydroProperties, PartLaw};
use crate::math::Scalar;
use crate::math::spatial::{Blocks, Twist, Wrench, cross, product, rotate_back, skew, transform};
use rapier3d::na::{Matrix3, Rotation3, Vector3};

/// What a step needs of one part, `f64` or `f32`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PartConstants<K> {
    pub place: PartPlace<K>,
    pub law: PreparedPart<K>,
    pub hinge: Option<HingePlace<K>>,
}

impl PartConstants<f64> {
    /// Of a part of a body whose center of mass, plate axes and scales these are.
    pub fn new(part: &Part, body: &ImmersedBody, fluid: &Fluid, frame: &BodyFrame) -> Self {
        let of_body = PartLaw::Viscous(body.law);
        let law = part.law.as_ref().unwrap_or(&of_body);
        let (law, point, axes) = law.prepare(&part.hydro, fluid, frame.mass, frame.length);
        let to_plate = frame.axes.inverse();
        let from_center = |p: Vector3<f64>| to_plate * (p - frame.center) / frame.length;
        Self {
            place: PartPlace {
                position: from_center(part.pose.transform_point(&point.into()).coords),
                turn: to_plate.matrix() * part.pose.rotation.to_rotation_matrix().matrix() * axes,
            },
            law,
            hinge: part.hinge.map(|hinge| HingePlace {
                point: from_center(hinge.point),
                axis: to_plate * hinge.axis,
            }),
        }
    }

    /// The nearest constants in f32.
    pub fn rounded(&self) -> PartConstants<f32> {
        PartConstants {
            place: self.place.rounded(),
            law: self.law.rounded(),
            hinge: self.hinge.map(|hinge| hinge.rounded()),
        }
    }
}

impl PartConstants<f32> {
    /// Whether every constant is a finite number.
    pub fn is_finite(&self) -> bool {
        let hinge = self.hinge.is_none_or(|hinge| hinge.is_finite());
        self.place.is_finite() && self.law.is_finite() && hinge
    }
}

/// What the places of a body's parts are given in.
pub(crate) struct BodyFrame {
    /// Center of mass, m, body axes.
    pub center: Vector3<f64>,
    /// Plate axes to body axes.
    pub axes: Rotation3<f64>,
    pub mass: f64,
    pub length: f64,
}

/// The coupled mass of all parts of a body.
pub(super) fn coupled_mass(
    body: &ImmersedBody,
    density: f64,
    frame: &BodyFrame,
) -> CoupledMass<f64> {
    let to_plate = frame.axes.inverse();
    let mut coupled = AddedMass::zero();
    let (mut isotropic, mut first, mut second) = (0.0, Vector3::zeros(), Matrix3::zeros());
    for part in &body.parts {
        let of_body = PartLaw::Viscous(body.law);
        let law = part.law.as_ref().unwrap_or(&of_body);
        let hydro = &part.hydro;
        // What is the same in all directions is felt whole, at the part's center of volume.
        let same = hydro.isotropic_added_mass() * hydro.thickness();
        let at = part.pose.transform_point(&hydro.centroid.into()).coords - frame.center;
        let of_same = AddedMass::diagonal(Vector3::repeat(same), Vector3::zeros()).about(-at);
        let own = added_mass_in_body(hydro, part, &frame.center);
        let rest = own.to_matrix6() - of_same.to_matrix6();
        coupled = coupled + AddedMass::from_matrix6(&(rest * law.munk_factor(hydro)));
        let at = to_plate * at / frame.length;
        isotropic += same;
        first += at * same;
        second += at * at.transpose() * same;
    }
    let plate = coupled.rotated(&to_plate);
    let scale = density / frame.mass;
    CoupledMass {
        m11: plate.linear * scale,
        m12: plate.coupling * (scale / frame.length),
        isotropic: isotropic * scale,
        first: first * scale,
        second: second * scale,
    }
}

/// A part's added mass about a point of the body's frame, in its axes.
pub(crate) fn added_mass_in_body(
    hydro: &HydroProperties,
    part: &Part,
    about: &Vector3<f64>,
) -> AddedMass {
    let turn = part.pose.rotation.to_rotation_matrix();
    let at = part.pose.transform_point(&hydro.reference.into()).coords;
    hydro.added_mass.rotated(&turn).about(about - at)
}

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
        let (sine, cosine) = deflection.sin_cos();
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
        let zero = h.constant(0.0);
        let mut applied = Wrench {
            force: rotate_back(attitude, &load.force),
            torque: Vector3::repeat(zero),
        };
        if load.turning {
            let buoyancy = rotate_back(attitude, &load.buoyancy);
            applied.torque =
                rotate_back(attitude, &load.torque) + cross(&load.buoyancy_arm, &buoyancy);
        }
        let nothing = Matrix3::repeat(zero);
        let mut n = Blocks {
            m11: nothing,
            m12: nothing,
            m21: nothing,
            m22: nothing,
        };
        for (i, part) in self.constants.iter().enumerate() {
            let now = (self.now)(i);
            let mut place = self.raise.place(&part.place);
            if self.deflected
                && let Some(hinge) = &part.hinge
            {
                place = self.raise.hinge(hinge).turned(&place, now.sine, now.cosine);
            }
            if !self.flows {
                n.add(&part.law.matrix(self.raise, &place, middle, now.factors));
                continue;
            }
            // The fluid's motion around the part, as a twist about the center of mass.
            let spin = rotate_back(attitude, &now.spin);
            let fluid = Twist {
                linear: rotate_back(attitude, &now.velocity) - cross(&spin, &place.position),
                angular: spin,
            };
            let relative = middle.add_scaled(&fluid, h.constant(-1.0));
            let of_part = part.law.matrix(self.raise, &place, &relative, now.factors);
            let carried = of_part.apply(&fluid);
            applied.force -= carried.force;
            applied.torque -= carried.torque;
            n.add(&of_part);
        }

        let along = |i: usize| {
            let linear = n.m11[(i, i)] * inertia.per_m11[i];
            let angular = n.m22[(i, i)] * inertia.per_m22[i];
            -linear.min(angular)
        };
        let theta = implicitness(h * along(0).max(along(1)).max(along(2)));
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

/// Adds the inertial coupling: see [`InertiaConstants::coupling_matrix`], of which this is the sum over parts: `[r]× [ω]× [r]×` is
/// `−(r·ω) [r]×`.
#[inline(always)]
fn couple<T: Scalar>(
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
