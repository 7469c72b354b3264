//! What the fluid feels of a shape.

pub mod added_mass;

pub use added_mass::AddedMass;
