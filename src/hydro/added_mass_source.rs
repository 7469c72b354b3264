//! Where the added mass of a shape is from.

use super::Solid;

/// Where a shape's added mass is from, and so how good it is.
///
/// ```
/// use rapier3d_immersed::rapier3d::prelude::*;
/// use rapier3d_immersed::{AddedMassSource, HydroProperties};
///
/// let source = |shape: &dyn Shape| HydroProperties::from_shape(shape).map(|hydro| hydro.added_mass_source);
/// // A crate is tabulated, under whatever name it comes …
/// let size = Vector::new(0.25, 0.15, 0.2);
/// let corners: Vec<_> = Cuboid::new(size).to_trimesh().0;
/// let hull = SharedShape::convex_hull(&corners).unwrap();
/// assert!(matches!(source(&Cuboid::new(size))?, AddedMassSource::Table { .. }));
/// assert!(matches!(source(hull.as_ref())?, AddedMassSource::Table { .. }));
/// // … half of it, cut along a diagonal, is not.
/// let half: Vec<_> = corners.iter().copied().filter(|v| v.x / size.x < v.y / size.y + 0.1).collect();
/// let wedge = SharedShape::convex_hull(&half).unwrap();
/// assert_eq!(source(wedge.as_ref())?, AddedMassSource::ProxyEllipsoid);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum AddedMassSource {
    /// Lamb's closed form for the ellipsoid that the shape is: right to the shape's facets.
    Ellipsoid,
    /// The table of boxes, cylinders, cones and capsules by boundary elements: right to 1 %.
    Table {
        /// The solid that the shape was recognised as.
        solid: Solid,
    },
    /// Lamb's closed form for an ellipsoid with the shape's shadows. Flat plates of round outline are right, those of rectangles 5 % low, compact
    /// bodies with edges may be half of it off; [`Accuracy`](super::Accuracy) has a table.
    ProxyEllipsoid,
    /// The sum over parts, each from its own source; what they do to each other's flow is left out.
    Parts,
    /// Boundary elements on the shape's own surface.
    BoundaryElements {
        /// Relative error that the solver estimates, infinite if it had one mesh only.
        estimated_error: f64,
    },
    /// The user's: [`HydroProperties::with_added_mass`](super::HydroProperties::with_added_mass).
    Given,
}
