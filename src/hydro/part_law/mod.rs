//! Laws that a single part of a body can be under.

mod custom;
mod damping;
mod drag_box;
mod frozen_force;
pub(crate) mod place;
mod planform;
mod polar_table;
mod separate;
mod separated;

pub use custom::{CustomLaw, PartMotion};
pub use damping::Damping;
pub use drag_box::DragBox;
pub use polar_table::{PolarRow, PolarTable};
pub use separated::SeparatedLaw;

use super::HydroProperties;
use super::viscous::force_factors::Factored;
use super::viscous::{ForceFactors, PreparedLaw, ViscousLaw};
use crate::error::Error;
use crate::fluid::Fluid;
use crate::math::spatial::{Blocks, Twist};
use crate::math::{Lanes, Scalar};
use custom::PreparedCustom;
use damping::DampingConstants;
use drag_box::DragBoxConstants;
use fearless_simd::Simd;
use place::{CoupledMass, HingePlace, PartPlace};
use polar_table::{PolarConstants, Section};
use rapier3d::na::{Matrix3, Vector3};
use separated::PreparedSeparated;

/// What gives the fluid's force on a part of a body.
// One per part of a description, and most are of the larger variants: a box would save nothing.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum PartLaw {
    /// One of the laws of whole bodies, from the part's own geometry.
    Viscous(ViscousLaw),
    /// Coefficients of lift, drag and moment over the angle of attack.
    Polar(PolarTable),
    /// A drag area for each direction.
    DragBox(DragBox),
    /// Linear and quadratic damping in six degrees of freedom.
    Damping(Damping),
    /// Another law as a reduced model.
    Separated(SeparatedLaw),
    /// A closure. It cannot be saved in a snapshot.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    Custom(CustomLaw),
}

impl From<ViscousLaw> for PartLaw {
    fn from(law: ViscousLaw) -> Self {
        Self::Viscous(law)
    }
}

impl From<PolarTable> for PartLaw {
    fn from(law: PolarTable) -> Self {
        Self::Polar(law)
    }
}

impl From<DragBox> for PartLaw {
    fn from(law: DragBox) -> Self {
        Self::DragBox(law)
    }
}

impl From<Damping> for PartLaw {
    fn from(law: Damping) -> Self {
        Self::Damping(law)
    }
}

impl From<SeparatedLaw> for PartLaw {
    fn from(law: SeparatedLaw) -> Self {
        Self::Separated(law)
    }
}

impl From<CustomLaw> for PartLaw {
    fn from(law: CustomLaw) -> Self {
        Self::Custom(law)
    }
}

impl PartLaw {
    /// # Errors
    /// Those of the law's own `check`.
    pub fn check(&self) -> Result<(), Error> {
        match self {
            Self::Viscous(law) => law.check(),
            Self::DragBox(law) => law.check(),
            Self::Damping(law) => law.check(),
            Self::Separated(law) => law.check(),
            Self::Polar(_) | Self::Custom(_) => Ok(()),
        }
    }

    /// Share of the coupling of the part's added mass that is felt.
    pub(crate) fn munk_factor(&self, hydro: &HydroProperties) -> f64 {
        match self {
            Self::Viscous(law) => law.munk_factor(hydro),
            // Their moments are measured ones, which have it in them.
            Self::Polar(_) | Self::DragBox(_) | Self::Custom(_) => 0.0,
            // Vehicle models have the Coriolis matrix of the added mass beside the damping.
            Self::Damping(_) => 1.0,
            Self::Separated(law) => law.munk_factor(),
        }
    }

    /// The law's constants for one part in one fluid, and the point that its force refers to with its axes: in the
    /// part's frame. `mass` and `length` are the body's scales.
    pub(crate) fn prepare(
        &self,
        hydro: &HydroProperties,
        fluid: &Fluid,
        mass: f64,
        length: f64,
    ) -> (PreparedPart<f64>, Vector3<f64>, Matrix3<f64>) {
        let density = f64::from(fluid.density());
        let kinematic_viscosity = f64::from(fluid.kinematic_viscosity());
        let plate = &hydro.planform;
        let axes = *plate.axes.matrix();
        let frame = Matrix3::identity();
        match self {
            Self::Viscous(law) => {
                let prepared = law.prepare(hydro, fluid, mass, length);
                (PreparedPart::Viscous(prepared), plate.center, axes)
            }
            Self::Polar(table) => {
                let chord = 2.0 * plate.half_extents.y;
                let section = Section {
                    area: plate.area,
                    chord,
                    density,
                    kinematic_viscosity,
                };
                let to_plate = axes.transpose();
                let constants = PolarConstants::new(table, &section, &to_plate, mass, length);
                let ahead = PolarConstants::reference(table, &constants.forward, chord);
                (
                    PreparedPart::Polar(constants, table.clone()),
                    plate.center + axes * ahead,
                    axes,
                )
            }
            Self::DragBox(drag) => {
                let constants = DragBoxConstants::new(drag, density, mass);
                (PreparedPart::DragBox(constants), drag.center, frame)
            }
            Self::Damping(damping) => {
                let constants = DampingConstants::new(damping, mass, length);
                (PreparedPart::Damping(constants), Vector3::zeros(), frame)
            }
            Self::Separated(law) => {
                let (law, point, axes) = law.prepare(hydro, fluid, mass, length);
                (PreparedPart::Separated(law), point, axes)
            }
            Self::Custom(law) => {
                let law = PreparedCustom::new(law, density, kinematic_viscosity, mass, length);
                (PreparedPart::Custom(law), Vector3::zeros(), frame)
            }
        }
    }
}

/// A part's law for one body in one fluid, `f64` or `f32`.
// As above.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum PreparedPart<T> {
    Viscous(PreparedLaw<T>),
    Polar(PolarConstants<T>, PolarTable),
    DragBox(DragBoxConstants<T>),
    Damping(DampingConstants<T>),
    Separated(PreparedSeparated),
    Custom(PreparedCustom),
}

impl PreparedPart<f64> {
    /// The matrices of drag, translational lift, rotational lift and damping, which add up to
    /// [`matrix`](PreparedPart::matrix).
    pub fn components(
        &self,
        place: &PartPlace<f64>,
        v: &Twist<f64>,
        factors: ForceFactors<f64>,
    ) -> [Blocks<f64>; 4] {
        let none = || Blocks::zero(0.0);
        match self {
            Self::Viscous(law) => {
                let law = &Factored { law, factors };
                planform::components(law, place, v)
            }
            Self::Polar(law, table) => {
                let drag = law.matrix(table, place, v, [factors.drag, 0.0]);
                let lift = law.matrix(table, place, v, [0.0, factors.translational_lift]);
                [drag, lift, none(), none()]
            }
            Self::DragBox(_) | Self::Damping(_) | Self::Separated(_) | Self::Custom(_) => {
                let all = self.matrix(Exact, place, v, factors);
                [all, none(), none(), none()]
            }
        }
    }

    /// The nearest constants in f32.
    pub fn rounded(&self) -> PreparedPart<f32> {
        match self {
            Self::Viscous(law) => PreparedPart::Viscous(law.rounded()),
            Self::Polar(law, table) => PreparedPart::Polar(law.rounded(), table.clone()),
            Self::DragBox(law) => PreparedPart::DragBox(law.rounded()),
            Self::Damping(law) => PreparedPart::Damping(law.rounded()),
            Self::Separated(law) => PreparedPart::Separated(law.clone()),
            Self::Custom(law) => PreparedPart::Custom(law.clone()),
        }
    }
}

impl PreparedPart<f32> {
    /// Whether every constant is a finite number.
    pub fn is_finite(&self) -> bool {
        match self {
            Self::Viscous(law) => law.is_finite(),
            Self::Polar(law, _) => law.is_finite(),
            Self::DragBox(law) => law.is_finite(),
            Self::Damping(law) => law.is_finite(),
            Self::Separated(law) => law.is_finite(),
            Self::Custom(_) => true,
        }
    }
}

/// Turns constants as they are kept into the scalars that a step computes with.
pub(crate) trait Raise<T: Scalar>: Copy {
    /// What constants are kept in.
    type Kept: Copy + std::fmt::Debug + PartialEq + 'static;

    fn viscous(self, law: &PreparedLaw<Self::Kept>) -> PreparedLaw<T>;
    fn polar(self, law: &PolarConstants<Self::Kept>) -> PolarConstants<T>;
    fn drag_box(self, law: &DragBoxConstants<Self::Kept>) -> DragBoxConstants<T>;
    fn damping(self, law: &DampingConstants<Self::Kept>) -> DampingConstants<T>;
    fn place(self, place: &PartPlace<Self::Kept>) -> PartPlace<T>;
    fn hinge(self, hinge: &HingePlace<Self::Kept>) -> HingePlace<T>;
    fn coupled(self, mass: &CoupledMass<Self::Kept>) -> CoupledMass<T>;
}

/// One body in f64: constants are as they are.
#[derive(Clone, Copy)]
pub(crate) struct Exact;

impl Raise<f64> for Exact {
    type Kept = f64;

    fn viscous(self, law: &PreparedLaw<f64>) -> PreparedLaw<f64> {
        *law
    }
    fn polar(self, law: &PolarConstants<f64>) -> PolarConstants<f64> {
        *law
    }
    fn drag_box(self, law: &DragBoxConstants<f64>) -> DragBoxConstants<f64> {
        *law
    }
    fn damping(self, law: &DampingConstants<f64>) -> DampingConstants<f64> {
        *law
    }
    fn place(self, place: &PartPlace<f64>) -> PartPlace<f64> {
        *place
    }
    fn hinge(self, hinge: &HingePlace<f64>) -> HingePlace<f64> {
        *hinge
    }
    fn coupled(self, mass: &CoupledMass<f64>) -> CoupledMass<f64> {
        *mass
    }
}

/// Equal bodies side by side: constants are the same in every lane.
#[derive(Clone, Copy)]
pub(crate) struct EveryLane<S>(pub S);

impl<S: Simd> Raise<Lanes<S>> for EveryLane<S> {
    type Kept = f32;

    #[inline(always)]
    fn viscous(self, law: &PreparedLaw<f32>) -> PreparedLaw<Lanes<S>> {
        PreparedLaw::splat(self.0, law)
    }
    #[inline(always)]
    fn polar(self, law: &PolarConstants<f32>) -> PolarConstants<Lanes<S>> {
        PolarConstants::splat(self.0, law)
    }
    #[inline(always)]
    fn drag_box(self, law: &DragBoxConstants<f32>) -> DragBoxConstants<Lanes<S>> {
        DragBoxConstants::splat(self.0, law)
    }
    #[inline(always)]
    fn damping(self, law: &DampingConstants<f32>) -> DampingConstants<Lanes<S>> {
        DampingConstants::splat(self.0, law)
    }
    #[inline(always)]
    fn place(self, place: &PartPlace<f32>) -> PartPlace<Lanes<S>> {
        PartPlace::splat(self.0, place)
    }
    #[inline(always)]
    fn hinge(self, hinge: &HingePlace<f32>) -> HingePlace<Lanes<S>> {
        HingePlace::splat(self.0, hinge)
    }
    #[inline(always)]
    fn coupled(self, mass: &CoupledMass<f32>) -> CoupledMass<Lanes<S>> {
        CoupledMass::splat(self.0, mass)
    }
}

impl<K: Copy + std::fmt::Debug + PartialEq + 'static> PreparedPart<K> {
    /// The matrix that maps the body's velocity relative to the fluid around the part to the part's force, in the
    /// body's axes about its center of mass. Its symmetric part is not positive, except under a law of the thesis.
    #[inline(always)]
    pub fn matrix<T: Scalar, R: Raise<T, Kept = K>>(
        &self,
        raise: R,
        place: &PartPlace<T>,
        v: &Twist<T>,
        factors: ForceFactors<T>,
    ) -> Blocks<T> {
        match self {
            Self::Viscous(law) => {
                let law = &raise.viscous(law);
                planform::matrix(&Factored { law, factors }, place, v)
            }
            Self::Polar(law, table) => {
                let factors = [factors.drag, factors.translational_lift];
                raise.polar(law).matrix(table, place, v, factors)
            }
            Self::DragBox(law) => raise.drag_box(law).matrix(place, v, factors.drag),
            Self::Damping(law) => raise.damping(law).matrix(place, v, factors.drag),
            Self::Separated(law) => law.matrix(place, v, factors.drag),
            Self::Custom(law) => law.matrix(place, v, factors.drag),
        }
    }
}
