//! Parts of a body: several surfaces, each with a place, a shape and a law of its own.

use crate::error::Error;
use crate::hydro::{HydroProperties, PartLaw};
use rapier3d::na::{Isometry3, Vector3};

/// One of the surfaces that a body consists of: a wing, a fin, a fuselage, a blade's strip.
///
/// Each part sees its own velocity, v + ω × r, and its own fluid. Their forces add up at the body's center of
/// mass; a rotation is damped by what it moves the parts.
///
/// ```
/// use rapier3d_immersed::rapier3d::na::{Isometry3, Vector3};
/// use rapier3d_immersed::rapier3d::prelude::*;
/// use rapier3d_immersed::{Damping, Hinge, HydroProperties, Part};
///
/// let wing = HydroProperties::from_shape(&Cuboid::new(Vector::new(0.4, 0.002, 0.05)))?;
/// let tail = HydroProperties::from_shape(&Cuboid::new(Vector::new(0.1, 0.001, 0.03)))?;
/// let wing = Part::new(wing);
/// // The elevator turns about its leading edge.
/// let tail = Part::new(tail)
///     .at(Isometry3::translation(0.0, 0.0, 0.4))
///     .with_hinge(Hinge::new(Vector3::new(0.0, 0.0, 0.37), Vector3::x())?);
/// assert!(Hinge::new(Vector3::zeros(), Vector3::zeros()).is_err());
/// # drop((wing, tail));
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Part {
    /// What the fluid feels of it, in the part's frame.
    pub hydro: HydroProperties,
    /// The part's frame in the body's.
    pub pose: Isometry3<f64>,
    /// What gives its force; `None` is the law of the body.
    pub law: Option<PartLaw>,
    /// What it can be turned about in flight, if it can.
    pub hinge: Option<Hinge>,
}

/// A line that a part turns about, in the body's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Hinge {
    /// A point of it, m.
    pub point: Vector3<f64>,
    /// Its direction, of length 1: a positive deflection is a right-handed turn about it.
    pub axis: Vector3<f64>,
}

impl Hinge {
    /// A hinge through a point, m, along an axis of any length but zero.
    ///
    /// # Errors
    /// [`Error::NotFinite`], or [`Error::InvalidParameter`] if the axis has no length.
    pub fn new(point: Vector3<f64>, axis: Vector3<f64>) -> Result<Self, Error> {
        Error::check_all_finite("point of a hinge", point.as_slice())?;
        Error::check_all_finite("axis of a hinge", axis.as_slice())?;
        Error::check_positive("length of the axis of a hinge", axis.norm())?;
        Ok(Self {
            point,
            axis: axis.normalize(),
        })
    }
}

impl Part {
    /// A part whose frame is the body's, under the body's law.
    pub fn new(hydro: HydroProperties) -> Self {
        Self {
            hydro,
            pose: Isometry3::identity(),
            law: None,
            hinge: None,
        }
    }

    /// The same part elsewhere in the body.
    pub fn at(self, pose: Isometry3<f64>) -> Self {
        Self { pose, ..self }
    }

    /// The same part under a law of its own.
    pub fn with_law(self, law: impl Into<PartLaw>) -> Self {
        Self {
            law: Some(law.into()),
            ..self
        }
    }

    /// The same part on a hinge: [`Immersion::set_deflection`](crate::Immersion::set_deflection) turns it in flight.
    pub fn with_hinge(self, hinge: Hinge) -> Self {
        Self {
            hinge: Some(hinge),
            ..self
        }
    }

    /// # Errors
    /// Those of its properties and its law; [`Error::NotFinite`] for its pose, [`Error::InvalidParameter`] for a hinge
    /// whose axis is not of length 1.
    pub fn check(&self) -> Result<(), Error> {
        self.check_numbers()?;
        self.hydro.check_hulls()
    }

    /// Checks all but the hull.
    pub(crate) fn check_numbers(&self) -> Result<(), Error> {
        self.hydro.check_numbers()?;
        if let Some(law) = &self.law {
            law.check()?;
            if let PartLaw::Separated(law) = law {
                law.check_shape(&self.hydro)?;
            }
        }
        let pose = &self.pose;
        Error::check_all_finite("position of a part", pose.translation.vector.as_slice())?;
        Error::check_all_finite("orientation of a part", pose.rotation.coords.as_slice())?;
        let norm = pose.rotation.norm();
        Error::check(
            "norm of the orientation of a part",
            norm,
            (norm - 1.0).abs() < 1e-6,
            "1",
        )?;
        if let Some(hinge) = &self.hinge {
            let known = Hinge::new(hinge.point, hinge.axis)?;
            let length = hinge.axis.norm();
            let unit = (known.axis - hinge.axis).norm() < 1e-6;
            Error::check("length of the axis of a hinge", length, unit, "1")?;
        }
        Ok(())
    }
}
