//! The geometry that the fluid feels: closed surfaces of any rapier shape, and ellipsoids.

mod carlson;
pub mod ellipsoid;

pub use ellipsoid::Ellipsoid;
