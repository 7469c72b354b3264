//! How accurately the added mass of a shape is computed.

use super::HydroProperties;
use crate::error::Error;
use rapier3d::math::Pose;
use rapier3d::parry::shape::Shape;

/// How accurately the added mass of a shape is computed.
///
/// [`HydroProperties::added_mass_source`] says what came of it.
///
/// # When the proxy ellipsoid will do
/// Difference between the ellipsoid with the same three shadows and the shape, measured with the
/// `added_mass` example; rotations relative to the larger of added and displaced inertia. Of bodies that are not thin, the
/// default has these shapes in a table, within 1 %.
///
/// | shape | translation | rotation |
/// |---|---|---|
/// | ellipsoid, ball, elliptic disc | 0 | 0 |
/// | box 1 × 1 × 0.05 | 6 % | 11 % |
/// | box 1 × 2 × 0.05 | 5 % | 12 % |
/// | cube | 41 % | 24 % |
/// | box 1 × 1 × 10 | 35 % | 43 % |
/// | coin, diameter 1, height 0.1 | 16 % | 19 % |
/// | cylinder, diameter 1, height 2 | 20 % | 7 % |
/// | cylinder, diameter 1, height 10 | 12 % | 5 % |
/// | cone, diameter 1, height 2 | 4 % | 50 % |
/// | capsule, diameter 1, length 2 | 8 % | 5 % |
///
/// About its centroid an ellipsoid has no coupling A₁₂ either: a body without three planes of
/// symmetry turns as it is pushed only with [`Accuracy::Mesh`], or as the cone that it is.
///
/// ```
/// use rapier3d_immersed::rapier3d::prelude::*;
/// use rapier3d_immersed::HydroProperties;
///
/// let cube = HydroProperties::from_shape(&Cuboid::new(Vector::splat(0.5)))?;
/// // 0.639 of the displaced mass; its ellipsoid drags 41 % too little along.
/// assert!((cube.added_mass.linear[(0, 0)] - 0.639).abs() < 0.003);
/// assert!((cube.proxy.added_mass().linear[(0, 0)] / 0.639 - 0.59).abs() < 0.01);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Accuracy {
    /// What the laws were calibrated with, in microseconds. Of boxes, cylinders, cones and capsules, as whatever shape they
    /// come, that of a table; of thin plates and all other shapes that of the proxy ellipsoid.
    #[default]
    Calibrated,
    /// The table for thin plates, too: rectangles and discs, thinner than a quarter of their width. Their true added mass is some
    /// 6 % more broadside, 11 % more in rotation; but the coefficients of [`PhysicalLaw`](crate::PhysicalLaw) were found with
    /// the ellipsoid's, and with this five bars of published plates and papers are missed that are met without.
    Tabulated,
    /// The shape's own, by boundary elements (feature `bake`). It takes up to seconds: see
    /// [`boundary_element`](super::boundary_element).
    #[cfg(feature = "bake")]
    Mesh {
        /// Relative error to refine to, positive. 0.01 is a good choice.
        tolerance: f64,
    },
}

impl HydroProperties {
    /// [`HydroProperties::from_shape`] with the added mass as accurate as asked for.
    ///
    /// A solve that does not reach the tolerance is logged as a warning, not an error. For its
    /// report, or to save its result, use [`AddedMass::of_shape`](super::AddedMass) and
    /// [`HydroProperties::with_added_mass`].
    ///
    /// # Errors
    /// Those of [`HydroProperties::from_shape`]; for a mesh also [`Error::InvalidParameter`] if the
    /// tolerance is not positive, [`Error::DegenerateTriangle`], [`Error::SelfIntersection`],
    /// [`Error::InsideOut`], [`Error::TooManyPanels`] and [`Error::UnphysicalAddedMass`].
    pub fn from_shape_with(shape: &dyn Shape, accuracy: Accuracy) -> Result<Self, Error> {
        Self::from_shape(shape)?.with_accuracy(&[(Pose::IDENTITY, shape)], accuracy)
    }

    /// The same properties with the added mass of all `parts` of the body together, posed in its frame.
    pub(crate) fn with_accuracy(
        self,
        parts: &[(Pose, &dyn Shape)],
        accuracy: Accuracy,
    ) -> Result<Self, Error> {
        #[cfg(not(feature = "bake"))]
        let _ = parts;
        match accuracy {
            Accuracy::Calibrated => Ok(self),
            Accuracy::Tabulated => Ok(self.tabulated()),
            #[cfg(feature = "bake")]
            Accuracy::Mesh { tolerance } => self.solved(parts, tolerance),
        }
    }
}
