//! The geometry that the fluid feels: closed surfaces of any rapier shape, and ellipsoids.

#[cfg_attr(not(feature = "bake"), allow(dead_code))]
pub(crate) mod bisect;
mod ellipsoid;
mod graded;
mod panels;
pub(crate) mod quality;
mod sheet;
mod surface;
mod tessellate;

pub use ellipsoid::Ellipsoid;
pub use sheet::Sheet;
pub use surface::{Surface, VolumeIntegrals};
