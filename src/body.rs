//! The description of an immersed body, and the constants that the integrator makes of it.

use crate::Error;
use crate::fluid::Fluid;
use crate::hydro::viscous::ViscousLaw;
use crate::hydro::viscous::physical::PhysicalConstants;
use crate::hydro::viscous::stochastic::StochasticConstants;
use crate::hydro::viscous::thesis::ThesisConstants;
use crate::hydro::{AddedMass, HydroProperties};
use crate::math::scalar_struct;
use rapier3d::na::{Matrix3, Rotation3, Vector3};
use std::sync::Arc;

/// What makes a body fly: its shape as the fluid feels it, and the law of the viscous force.
///
/// Independent of mass, fluid and state: equal bodies share one description.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct ImmersedBody {
    /// What the fluid feels of the shape.
    pub hydro: HydroProperties,
    /// How the viscous force is computed.
    pub law: ViscousLaw,
}

impl ImmersedBody {
    /// A body of this shape under the default law.
    pub fn new(hydro: HydroProperties) -> Self {
        Self {
            hydro,
            law: ViscousLaw::default(),
        }
    }

    /// The same body under another law.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] or [`Error::OutOfRange`] names a coefficient that cannot be.
    pub fn with_law(self, law: ViscousLaw) -> Result<Self, Error> {
        law.check()?;
        Ok(Self { law, ..self })
    }
}

impl From<HydroProperties> for ImmersedBody {
    fn from(hydro: HydroProperties) -> Self {
        Self::new(hydro)
    }
}

impl From<HydroProperties> for Arc<ImmersedBody> {
    fn from(hydro: HydroProperties) -> Self {
        Arc::new(ImmersedBody::new(hydro))
    }
}

/// Mass properties of the body itself, without any fluid, in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct DryMass {
    /// Mass, kg.
    pub mass: f64,
    /// Center of mass, m, in the body's frame.
    pub center: Vector3<f64>,
    /// Inertia tensor about the center of mass along the axes of the body's frame, kg·m².
    pub inertia: Matrix3<f64>,
}

impl DryMass {
    /// The mass of two bodies that move as one.
    pub fn combined(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        let center = (self.center * self.mass + other.center * other.mass) / mass;
        let about = |part: &Self| {
            let d = part.center - center;
            part.inertia
                + (Matrix3::from_diagonal_element(d.norm_squared()) - d * d.transpose()) * part.mass
        };
        Self {
            mass,
            center,
            inertia: about(self) + about(other),
        }
    }

    /// # Errors
    /// [`Error::InvalidParameter`] if the mass is not positive and finite, or the inertia tensor
    /// has an eigenvalue that is not.
    pub fn check(&self) -> Result<(), Error> {
        Error::check_positive("mass", self.mass)?;
        if !self.inertia.iter().all(|x| x.is_finite()) {
            return Err(Error::InvalidParameter {
                parameter: "principal moment of inertia",
                requirement: "positive and finite",
                value: f64::NAN,
            });
        }
        for moment in self.inertia.symmetric_eigenvalues().iter() {
            Error::check_positive("principal moment of inertia", *moment)?;
        }
        Ok(())
    }
}

/// The viscous law's constants of one body; which variant decides the list that the body is in.
// One per body, and the largest is what almost every body has: a box would save nothing.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LawConstants {
    Inviscid,
    Physical(PhysicalConstants<f64>),
    Thesis(ThesisConstants<f64>),
    Stochastic(StochasticConstants<f64>),
}

scalar_struct! {
    /// Inertia of body and fluid in **plate axes** about the center of mass.
    ///
    /// To stay far from the ends of f32's range for bodies from 1 µg to 1 t, masses are in units of
    /// a mass scale and lengths in units of a length scale L; angular velocities are carried as
    /// `w = ωL`, in m/s like the linear velocity.
    pub(crate) struct InertiaConstants {
        /// 𝕄₁₁ = m + ρA₁₁, upper triangle.
        m11_xx, m11_xy, m11_xz, m11_yy, m11_yz, m11_zz,
        /// 𝕄₁₂ = ρA₁₂, row by row.
        m12_xx, m12_xy, m12_xz, m12_yx, m12_yy, m12_yz, m12_zx, m12_zy, m12_zz,
        /// 𝕄₂₂ = I + ρA₂₂, upper triangle.
        m22_xx, m22_xy, m22_xz, m22_yy, m22_yz, m22_zz,
        /// Inverses of the diagonals of 𝕄₁₁ and 𝕄₂₂.
        per_m11_xx, per_m11_yy, per_m11_zz, per_m22_xx, per_m22_yy, per_m22_zz,
        /// The body's own mass.
        dry_mass,
        /// Share of the added mass' coupling that is felt.
        munk,
        /// From the center of mass to the planform's center, L.
        center_x, center_y, center_z,
        /// 1/L, 1/m.
        per_length,
        /// Chord that convection is measured by, m.
        chord,
    }
}

/// Everything about one kind of body in one fluid that does not change from step to step.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BodyConstants {
    /// Mass scale, kg.
    pub mass: f64,
    /// Length scale L, m.
    pub length: f64,
    /// Maps plate axes to the body's frame.
    pub axes: Rotation3<f64>,
    pub inertia: InertiaConstants<f64>,
    pub law: LawConstants,
    /// Whether 𝕄 is diagonal and the planform centered on the center of mass, to f32 rounding.
    pub symmetric: bool,
    /// Mass of the displaced fluid ρV, kg.
    pub displaced_mass: f64,
    /// From the center of mass to the center of buoyancy, m, body axes.
    pub buoyancy_arm: Vector3<f64>,
    /// Added mass times density about the center of mass, body axes.
    pub added_mass: AddedMass,
    pub dry: DryMass,
}

impl BodyConstants {
    /// # Errors
    /// Those of [`DryMass::check`] and [`ViscousLaw::check`].
    pub fn new(body: &ImmersedBody, dry: &DryMass, fluid: &Fluid) -> Result<Self, Error> {
        dry.check()?;
        body.law.check()?;
        let hydro = &body.hydro;
        let rho = f64::from(fluid.density());
        let about_center = hydro.added_mass_about(dry.center);
        if !about_center.is_physical() {
            return Err(Error::UnphysicalAddedMass);
        }
        let added_mass = AddedMass {
            linear: about_center.linear * rho,
            coupling: about_center.coupling * rho,
            angular: about_center.angular * rho,
        };
        let axes = hydro.planform.axes;
        let plate = added_mass.rotated(&axes.inverse());
        let turn = axes.inverse();
        let dry_inertia = turn.matrix() * dry.inertia * axes.matrix();

        let mass = dry.mass + plate.linear.trace() / 3.0;
        let extents = hydro.planform.half_extents;
        let length = extents.x.max(1e-9);
        let m11 = (plate.linear + Matrix3::from_diagonal_element(dry.mass)) / mass;
        let m12 = plate.coupling / (mass * length);
        let m22 = (plate.angular + dry_inertia) / (mass * length * length);
        let center = turn * (hydro.planform.center - dry.center) / length;
        let inertia = InertiaConstants {
            m11_xx: m11[(0, 0)],
            m11_xy: m11[(0, 1)],
            m11_xz: m11[(0, 2)],
            m11_yy: m11[(1, 1)],
            m11_yz: m11[(1, 2)],
            m11_zz: m11[(2, 2)],
            m12_xx: m12[(0, 0)],
            m12_xy: m12[(0, 1)],
            m12_xz: m12[(0, 2)],
            m12_yx: m12[(1, 0)],
            m12_yy: m12[(1, 1)],
            m12_yz: m12[(1, 2)],
            m12_zx: m12[(2, 0)],
            m12_zy: m12[(2, 1)],
            m12_zz: m12[(2, 2)],
            m22_xx: m22[(0, 0)],
            m22_xy: m22[(0, 1)],
            m22_xz: m22[(0, 2)],
            m22_yy: m22[(1, 1)],
            m22_yz: m22[(1, 2)],
            m22_zz: m22[(2, 2)],
            per_m11_xx: 1.0 / m11[(0, 0)],
            per_m11_yy: 1.0 / m11[(1, 1)],
            per_m11_zz: 1.0 / m11[(2, 2)],
            per_m22_xx: 1.0 / m22[(0, 0)],
            per_m22_yy: 1.0 / m22[(1, 1)],
            per_m22_zz: 1.0 / m22[(2, 2)],
            dry_mass: dry.mass / mass,
            munk: body.law.munk_factor(),
            center_x: center.x,
            center_y: center.y,
            center_z: center.z,
            per_length: 1.0 / length,
            chord: 2.0 * extents.y,
        };
        let diagonal = |m: &Matrix3<f64>| {
            let rest = m - Matrix3::from_diagonal(&m.diagonal());
            (0..3).all(|i| rest.row(i).amax() <= 1e-7 * m[(i, i)])
        };
        let symmetric =
            diagonal(&m11) && diagonal(&m22) && m12.amax() <= 1e-7 && center.amax() <= 1e-7;
        let law = match &body.law {
            ViscousLaw::Inviscid => LawConstants::Inviscid,
            ViscousLaw::Physical(law) => {
                LawConstants::Physical(law.prepare(hydro, fluid, mass, length))
            }
            ViscousLaw::Thesis(law) => {
                LawConstants::Thesis(law.prepare(hydro, fluid, mass, length))
            }
            ViscousLaw::Stochastic(law) => {
                LawConstants::Stochastic(law.prepare(hydro, fluid, mass, length))
            }
        };
        Ok(Self {
            mass,
            length,
            axes,
            inertia,
            law,
            symmetric,
            displaced_mass: rho * hydro.volume,
            buoyancy_arm: hydro.centroid - dry.center,
            added_mass,
            dry: *dry,
        })
    }
}
