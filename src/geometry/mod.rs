//! The geometry that the fluid feels: closed surfaces, open sheets and ellipsoids.
//!
//! [`Surface::from_shape`] makes a closed surface of any rapier shape that encloses a volume, [`Surface::new`] of a mesh of your
//! own; [`HydroProperties::from_surface`](crate::HydroProperties::from_surface) and
//! [`DryMass::uniform`](crate::DryMass::uniform) take it from there. A [`Sheet`] is a mesh without thickness,
//! for the boundary elements (feature `bake`); an [`Ellipsoid`] stands in for any shape.

pub(crate) mod bands;
#[cfg_attr(not(feature = "bake"), allow(dead_code))]
pub(crate) mod bisect;
mod ellipsoid;
mod equal_shapes;
mod graded;
mod panels;
pub(crate) mod quality;
mod relief;
mod revolution;
mod rounded;
mod sheet;
mod surface;
mod tessellate;
mod voxels;

pub use ellipsoid::Ellipsoid;
pub(crate) use equal_shapes::equal_shapes;
pub(crate) use quality::check_indices;
pub(crate) use relief::Relief;
pub use sheet::Sheet;
pub use surface::{Surface, VolumeIntegrals};
pub(crate) use tessellate::rounded_volume;
