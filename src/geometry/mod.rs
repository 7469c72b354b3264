//! The geometry that the fluid feels: closed surfaces of any rapier shape, and ellipsoids.

mod carlson;
pub mod ellipsoid;
pub mod surface;
mod tessellate;

pub use ellipsoid::Ellipsoid;
pub use surface::{Surface, VolumeIntegrals};
