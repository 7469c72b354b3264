//! What the fluid feels of a shape.

pub mod added_mass;
#[cfg(feature = "bake")]
pub mod boundary_element;
#[cfg(feature = "serde-serialize")]
mod file;

pub use added_mass::AddedMass;
