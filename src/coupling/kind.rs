//! Kinds: what equal bodies in the same fluid share at run time.

use crate::Error;
use crate::body::{BodyConstants, DryMass, ImmersedBody, InertiaConstants, LawConstants};
use crate::dynamics::integrate::Inviscid;
use crate::dynamics::kirchhoff::{Twist, skew};
use crate::fluid::Fluid;
use crate::hydro::viscous::physical::{PhysicalConstants, PlatesOnly};
use crate::hydro::viscous::stochastic::StochasticConstants;
use crate::hydro::viscous::thesis::ThesisConstants;
use crate::hydro::viscous::{Evaluate, ViscousTerms};
use crate::math::{Lanes, Scalar, scalar_struct, to_f64, to_quaternion, to_real, to_rotation};
use fearless_simd::Simd;
use rapier3d::dynamics::MassProperties;
use rapier3d::math::{Rotation, Vector};
use rapier3d::na::{Matrix3, Matrix6, UnitQuaternion, Vector3};

/// The law's constants: `f32`, or [`Lanes`] of it.
// One per kind: a box would save nothing.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Debug)]
pub(super) enum Law<T> {
    Inviscid,
    /// The default law for a body that is purely a plate to it …
    Plate(PhysicalConstants<T>),
    /// … and for one that is not.
    Physical(PhysicalConstants<T>),
    Thesis(ThesisConstants<T>),
    Stochastic(StochasticConstants<T>),
}

impl<T: Scalar> Evaluate<T> for Law<T> {
    #[inline(always)]
    fn least_iterations(&self) -> u32 {
        match self {
            Self::Inviscid => Evaluate::<T>::least_iterations(&Inviscid),
            Self::Plate(law) => PlatesOnly(law).least_iterations(),
            Self::Physical(law) => law.least_iterations(),
            Self::Thesis(law) => law.least_iterations(),
            Self::Stochastic(law) => law.least_iterations(),
        }
    }

    #[inline(always)]
    fn terms(&self, u: &Vector3<T>, w: &Vector3<T>) -> ViscousTerms<T> {
        match self {
            Self::Inviscid => Inviscid.terms(u, w),
            Self::Plate(law) => PlatesOnly(law).terms(u, w),
            Self::Physical(law) => law.terms(u, w),
            Self::Thesis(law) => law.terms(u, w),
            Self::Stochastic(law) => law.terms(u, w),
        }
    }
}

/// What the step needs of a kind: `f32`, or [`Lanes`] of it.
#[derive(Clone, Debug)]
pub(super) struct StepConstants<T> {
    pub inertia: InertiaConstants<T>,
    pub law: Law<T>,
    pub scales: Scales<T>,
}

impl<S: Simd> StepConstants<Lanes<S>> {
    /// One kind in every lane.
    #[inline(always)]
    pub fn splat(simd: S, kind: &StepConstants<f32>) -> Self {
        let law = match &kind.law {
            Law::Inviscid => Law::Inviscid,
            Law::Plate(law) => Law::Plate(PhysicalConstants::splat(simd, law)),
            Law::Physical(law) => Law::Physical(PhysicalConstants::splat(simd, law)),
            Law::Thesis(law) => Law::Thesis(ThesisConstants::splat(simd, law)),
            Law::Stochastic(law) => Law::Stochastic(StochasticConstants::splat(simd, law)),
        };
        Self {
            inertia: InertiaConstants::splat(simd, &kind.inertia),
            law,
            scales: Scales::splat(simd, &kind.scales),
        }
    }

    /// Kinds of one [`Route`] side by side.
    #[inline(always)]
    pub fn gather<'a>(simd: S, of: impl Fn(usize) -> &'a StepConstants<f32>) -> Self {
        // Of one route, all laws are the same variant.
        macro_rules! side_by_side {
            ($variant:ident, $constants:ident, $first:ident) => {
                Law::$variant($constants::gather(simd, |lane| match &of(lane).law {
                    Law::$variant(law) => law,
                    _ => $first,
                }))
            };
        }
        let law = match &of(0).law {
            Law::Inviscid => Law::Inviscid,
            Law::Plate(first) => side_by_side!(Plate, PhysicalConstants, first),
            Law::Physical(first) => side_by_side!(Physical, PhysicalConstants, first),
            Law::Thesis(first) => side_by_side!(Thesis, ThesisConstants, first),
            Law::Stochastic(first) => side_by_side!(Stochastic, StochasticConstants, first),
        };
        Self {
            inertia: InertiaConstants::gather(simd, |lane| &of(lane).inertia),
            law,
            scales: Scales::gather(simd, |lane| &of(lane).scales),
        }
    }
}

scalar_struct! {
    /// How forces and lengths of the world scale to those of the integrator.
    pub(super) struct Scales {
        /// L, m.
        length,
        /// 1/mass scale, 1/kg.
        per_mass,
        /// 1/(mass scale · L).
        per_mass_length,
        /// Body's own mass over the mass scale.
        dry_mass,
        /// Displaced mass over the mass scale.
        displaced_mass,
        /// Center of mass to center of buoyancy, plate axes, in L.
        arm_x,
        arm_y,
        arm_z,
        /// Rotational inertia that rapier is given, I + ρA₂₂, plate axes, kg·m²: upper triangle.
        turn_xx,
        turn_xy,
        turn_xz,
        turn_yy,
        turn_yz,
        turn_zz,
        /// Change of velocity (u, then w = ωL) per change of the fluid's velocity, plate axes:
        /// `𝕄⁻¹ (ρV + ρA)`, the pressure gradient and the added mass of an accelerating flow.
        push_ux, push_uy, push_uz, push_vx, push_vy, push_vz, push_wx, push_wy, push_wz,
        spin_ux, spin_uy, spin_uz, spin_vx, spin_vy, spin_vz, spin_wx, spin_wy, spin_wz,
    }
}

impl<T: Scalar> Scales<T> {
    /// Change of the velocity of a body when the fluid around it changes its own by `change`, plate
    /// axes. A neutrally buoyant body follows exactly.
    #[inline(always)]
    pub fn pushed_by(&self, change: &Vector3<T>) -> Twist<T> {
        let (x, y, z) = (change.x, change.y, change.z);
        Twist {
            linear: Vector3::new(
                self.push_ux * x + self.push_uy * y + self.push_uz * z,
                self.push_vx * x + self.push_vy * y + self.push_vz * z,
                self.push_wx * x + self.push_wy * y + self.push_wz * z,
            ),
            angular: Vector3::new(
                self.spin_ux * x + self.spin_uy * y + self.spin_uz * z,
                self.spin_vx * x + self.spin_vy * y + self.spin_vz * z,
                self.spin_wx * x + self.spin_wy * y + self.spin_wz * z,
            ),
        }
    }

    /// Torque that causes an angular acceleration in rapier, plate axes.
    #[inline(always)]
    pub fn turn(&self, a: &Vector3<T>) -> Vector3<T> {
        Vector3::new(
            self.turn_xx * a.x + self.turn_xy * a.y + self.turn_xz * a.z,
            self.turn_xy * a.x + self.turn_yy * a.y + self.turn_yz * a.z,
            self.turn_xz * a.x + self.turn_yz * a.y + self.turn_zz * a.z,
        )
    }
}

/// Which code a body takes through the step. Bodies of one route are advanced side by side, so that
/// what happens to one never depends on who its neighbours are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Route {
    /// See [`BodyConstants::symmetric`].
    pub symmetric: bool,
    law: u8,
}

impl Route {
    /// Number of routes.
    pub const COUNT: usize = 10;

    /// All routes, in the order of their indices.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..Self::COUNT as u8).map(|index| Self {
            symmetric: index % 2 == 1,
            law: index / 2,
        })
    }

    /// Index among all routes.
    pub fn index(self) -> usize {
        usize::from(self.law * 2 + u8::from(self.symmetric))
    }
}

/// One description with one set of mass properties in one fluid.
#[derive(Clone, Debug)]
pub(super) struct Kind {
    /// Index of the description.
    pub description: u32,
    pub constants: BodyConstants,
    pub step: StepConstants<f32>,
    /// Plate axes to the body's frame.
    pub axes: Rotation,
    pub route: Route,
    /// Whether buoyancy has a torque.
    pub buoyancy_turns: bool,
    /// Whether some motion drags more than half of the body's own mass along.
    pub heavy_fluid: bool,
    /// Inverse of the 6×6 mass of body and fluid about the center of mass, body axes.
    pub inverse_mass: Matrix6<f64>,
    /// Whether a push at the center of mass turns the body (A₁₂ ≠ 0).
    pub coupled: bool,
}

impl Kind {
    /// # Errors
    /// Those of [`BodyConstants::new`].
    pub fn new(
        description: u32,
        body: &ImmersedBody,
        dry: &DryMass,
        fluid: &Fluid,
    ) -> Result<Self, Error> {
        let constants = BodyConstants::new(body, dry, fluid)?;
        let law = match &constants.law {
            LawConstants::Inviscid => Law::Inviscid,
            LawConstants::Physical(law) => {
                let rounded = PhysicalConstants::rounded(law);
                if law.plate_share == 1.0 {
                    Law::Plate(rounded)
                } else {
                    Law::Physical(rounded)
                }
            }
            LawConstants::Thesis(law) => Law::Thesis(ThesisConstants::rounded(law)),
            LawConstants::Stochastic(law) => Law::Stochastic(StochasticConstants::rounded(law)),
        };
        let (mass, length) = (constants.mass, constants.length);
        let arm = constants.axes.inverse() * constants.buoyancy_arm / length;
        let mut whole = constants.added_mass.to_matrix6();
        let mut linear = whole.fixed_view_mut::<3, 3>(0, 0);
        linear += Matrix3::from_diagonal_element(dry.mass);
        let mut angular = whole.fixed_view_mut::<3, 3>(3, 3);
        angular += dry.inertia;
        let inverse_mass = whole.try_inverse().ok_or(Error::UnphysicalAddedMass)?;
        let coupling = constants.added_mass.coupling.norm();
        let turn = constants.axes.inverse().matrix()
            * whole.fixed_view::<3, 3>(3, 3)
            * constants.axes.matrix();
        let route = Route {
            symmetric: constants.symmetric,
            law: match law {
                Law::Inviscid => 0,
                Law::Plate(_) => 1,
                Law::Physical(_) => 2,
                Law::Thesis(_) => 3,
                Law::Stochastic(_) => 4,
            },
        };
        // What an accelerating flow does, first in the body's axes, then in the plate's.
        let mut dragged = constants
            .added_mass
            .to_matrix6()
            .fixed_columns::<3>(0)
            .into_owned();
        let mut pressure = dragged.fixed_rows_mut::<3>(0);
        pressure += Matrix3::from_diagonal_element(constants.displaced_mass);
        let mut moment = dragged.fixed_rows_mut::<3>(3);
        moment += skew(&constants.buoyancy_arm) * constants.displaced_mass;
        let response = inverse_mass * dragged;
        let to_plate =
            |m: Matrix3<f64>| constants.axes.inverse().matrix() * m * constants.axes.matrix();
        let push = to_plate(response.fixed_rows::<3>(0).into_owned());
        let spin = to_plate(response.fixed_rows::<3>(3).into_owned()) * length;
        let scales = Scales {
            length,
            per_mass: 1.0 / mass,
            per_mass_length: 1.0 / (mass * length),
            dry_mass: dry.mass / mass,
            displaced_mass: constants.displaced_mass / mass,
            arm_x: arm.x,
            arm_y: arm.y,
            arm_z: arm.z,
            turn_xx: turn[(0, 0)],
            turn_xy: turn[(0, 1)],
            turn_xz: turn[(0, 2)],
            turn_yy: turn[(1, 1)],
            turn_yz: turn[(1, 2)],
            turn_zz: turn[(2, 2)],
            push_ux: push[(0, 0)],
            push_uy: push[(0, 1)],
            push_uz: push[(0, 2)],
            push_vx: push[(1, 0)],
            push_vy: push[(1, 1)],
            push_vz: push[(1, 2)],
            push_wx: push[(2, 0)],
            push_wy: push[(2, 1)],
            push_wz: push[(2, 2)],
            spin_ux: spin[(0, 0)],
            spin_uy: spin[(0, 1)],
            spin_uz: spin[(0, 2)],
            spin_vx: spin[(1, 0)],
            spin_vy: spin[(1, 1)],
            spin_vz: spin[(1, 2)],
            spin_wx: spin[(2, 0)],
            spin_wy: spin[(2, 1)],
            spin_wz: spin[(2, 2)],
        };
        Ok(Self {
            description,
            step: StepConstants {
                inertia: InertiaConstants::rounded(&constants.inertia),
                law,
                scales: Scales::rounded(&scales),
            },
            axes: to_rotation(UnitQuaternion::from_rotation_matrix(&constants.axes)),
            route,
            buoyancy_turns: arm.amax() > 1e-7,
            heavy_fluid: constants.added_mass.linear.symmetric_eigenvalues().max() > 0.5 * dry.mass,
            inverse_mass,
            coupled: coupling > 1e-6 * mass * length,
            constants,
        })
    }

    /// What rapier is given: the scalar mass it can use, and I + ρA₂₂.
    pub fn wet(&self, mass: f64) -> DryMass {
        let dry = &self.constants.dry;
        DryMass {
            mass,
            center: dry.center,
            inertia: dry.inertia + self.constants.added_mass.angular,
        }
    }

    /// The torque that causes in rapier, whose inertia tensor is `rapier`'s, what `torque` would
    /// cause with the right one. World axes; `attitude` maps the body's frame to the world.
    pub fn torque_for(
        &self,
        rapier: &MassProperties,
        attitude: Rotation,
        torque: Vector,
    ) -> Vector {
        let rotation = to_quaternion(attitude);
        let torque = rotation.inverse() * to_f64(torque);
        let right = self.wet(1.0).inertia;
        let acceleration = right
            .try_inverse()
            .map_or(torque * 0.0, |inverse| inverse * torque);
        let theirs = super::from_rapier::inertia(rapier);
        to_real(rotation * (theirs * acceleration))
    }

    /// Whether another body would be of this kind.
    pub fn is(&self, description: u32, dry: &DryMass) -> bool {
        self.description == description && self.constants.dry == *dry
    }
}
