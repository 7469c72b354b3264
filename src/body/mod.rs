//! The description of an immersed body: its shape as the fluid feels it, its law, and its own mass.

mod bent;
mod division;
pub(crate) mod far_part;
pub(crate) mod from_rapier;
mod part;
mod piece;
mod thruster;

pub use division::Division;
pub use part::{Hinge, Part};
pub use thruster::{Propeller, Thruster};

use crate::error::Error;
use crate::geometry::Surface;
use crate::hydro::viscous::ViscousLaw;
use crate::hydro::{HydroProperties, OutOfScope, PartLaw};
use rapier3d::na::{Matrix3, Vector3};
use rapier3d::parry::shape::Shape;
use std::sync::Arc;

/// What decides the fluid's force on a body: its shape as the fluid feels it, and the viscous law.
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
    /// The parts whose forces it consists of; without any, the whole is one.
    pub parts: Vec<Part>,
    /// What pushes it by itself.
    pub thrusters: Vec<Thruster>,
}

impl ImmersedBody {
    /// A body of this shape under the default law, with the parts that the properties name.
    pub fn new(mut hydro: HydroProperties) -> Self {
        let parts = std::mem::take(&mut hydro.parts);
        Self {
            hydro,
            law: ViscousLaw::default(),
            parts: parts.into_iter().map(Part::new).collect(),
            thrusters: Vec::new(),
        }
    }

    /// The same body made of these parts, in place of those that it has. Volume, added mass and planform of the
    /// whole stay what they are; none at all makes it one part again.
    pub fn with_parts(self, parts: impl IntoIterator<Item = Part>) -> Self {
        Self {
            parts: parts.into_iter().collect(),
            ..self
        }
    }

    /// The same body with these thrusters, in place of those that it has.
    pub fn with_thrusters(self, thrusters: impl IntoIterator<Item = Thruster>) -> Self {
        Self {
            thrusters: thrusters.into_iter().collect(),
            ..self
        }
    }

    /// # Errors
    /// Those of [`HydroProperties::check`], [`ViscousLaw::check`], [`Part::check`] and [`Thruster::check`].
    pub fn check(&self) -> Result<(), Error> {
        self.check_numbers()?;
        self.check_hulls()
    }

    /// Checks the hulls, which only a boundary of fluids asks for.
    pub(crate) fn check_hulls(&self) -> Result<(), Error> {
        self.hydro.check_hulls()?;
        let mut parts = self.parts.iter();
        parts.try_for_each(|part| part.hydro.check_hulls())
    }

    /// Checks all but the hulls.
    pub(crate) fn check_numbers(&self) -> Result<(), Error> {
        self.hydro.check_numbers()?;
        self.law.check()?;
        self.parts.iter().try_for_each(Part::check_numbers)?;
        self.thrusters.iter().try_for_each(Thruster::check)
    }

    /// What the default law does not see of the body, of the whole or of each of its parts that is under that law:
    /// empty where it is as good as `docs/which-bodies.md` says. [`Immersion::insert`](crate::Immersion::insert)
    /// makes a [`Warning`](crate::Warning) of it.
    ///
    /// ```
    /// use rapier3d_immersed::rapier3d::prelude::*;
    /// use rapier3d_immersed::{HydroProperties, ImmersedBody, OutOfScope};
    ///
    /// let bar = SharedShape::cuboid(0.03, 0.001, 0.005);
    /// let across = Pose::from_rotation(Rotation::from_rotation_y(std::f32::consts::FRAC_PI_2));
    /// let cross = SharedShape::compound(vec![(Pose::IDENTITY, bar.clone()), (across, bar.clone())]);
    /// let cross = ImmersedBody::new(HydroProperties::from_shape(cross.as_ref())?);
    /// assert!(matches!(cross.out_of_scope()[..], [OutOfScope::Gaps { .. }]));
    /// assert!(ImmersedBody::new(HydroProperties::from_shape(bar.as_ref())?).out_of_scope().is_empty());
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn out_of_scope(&self) -> Vec<OutOfScope> {
        let is_default = |law: &ViscousLaw| matches!(law, ViscousLaw::Physical(_));
        let mut found: Vec<OutOfScope> = Vec::new();
        let mut add = |hydro: &HydroProperties| {
            for reason in &hydro.out_of_scope {
                if !found.contains(reason) {
                    found.push(*reason);
                }
            }
        };
        if self.parts.is_empty() && is_default(&self.law) {
            add(&self.hydro);
        }
        for part in &self.parts {
            let default = match &part.law {
                None => is_default(&self.law),
                Some(PartLaw::Viscous(law)) => is_default(law),
                Some(_) => false,
            };
            if default {
                add(&part.hydro);
            }
        }
        found
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
    /// No mass.
    pub(crate) const NONE: Self = Self {
        mass: 0.0,
        center: Vector3::new(0.0, 0.0, 0.0),
        inertia: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    };

    /// The mass properties of a solid of uniform density that fills a closed surface, in the surface's
    /// frame. `mass` in kg; what it weighs at a density is `density * surface.volume_integrals().volume`.
    ///
    /// ```
    /// use rapier3d_immersed::DryMass;
    /// use rapier3d_immersed::geometry::Surface;
    /// use rapier3d_immersed::rapier3d::prelude::*;
    ///
    /// let card = Surface::from_shape(&Cuboid::new(Vector::new(0.03, 0.02, 0.001)))?;
    /// let dry = DryMass::uniform(&card, 2e-3)?;
    /// assert!((dry.inertia[(2, 2)] - 2e-3 / 3.0 * (0.03_f64.powi(2) + 0.02_f64.powi(2))).abs() < 1e-12);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if the mass is not positive and finite, or the surface encloses nothing.
    pub fn uniform(surface: &Surface, mass: f64) -> Result<Self, Error> {
        let integrals = surface.volume_integrals();
        let uniform = Self {
            mass,
            center: integrals.centroid,
            inertia: integrals.unit_inertia() * (mass / integrals.volume),
        };
        uniform.check()?;
        Ok(uniform)
    }

    /// The mass properties of a solid of a density (kg/m³) that fills a shape, in the shape's frame, with the
    /// border of a rounded one.
    ///
    /// Rapier's own mass of a rounded shape is that of its core: a cone of 2000 kg/m³ with a thick border
    /// floats. This one line gives it the right one:
    ///
    /// ```
    /// use rapier3d_immersed::DryMass;
    /// use rapier3d_immersed::rapier3d::prelude::*;
    ///
    /// let cone = SharedShape::round_cone(0.1, 0.05, 0.05);
    /// let core = ColliderBuilder::new(cone.clone()).density(2000.0).build().mass();
    /// let mass = DryMass::of_shape(cone.as_ref(), 2000.0)?.to_mass_properties();
    /// let whole = ColliderBuilder::new(cone).mass_properties(mass).build().mass();
    /// assert!(whole > 4.0 * core);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Surface::from_shape`], and [`Error::InvalidParameter`] if the density is not positive and
    /// finite.
    pub fn of_shape(shape: &dyn Shape, density: f64) -> Result<Self, Error> {
        Error::check_positive("density", density)?;
        let surface = Surface::from_shape(shape)?;
        Self::uniform(&surface, density * surface.volume_integrals().volume)
    }

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
