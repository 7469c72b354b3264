//! What the fluid feels of a shape, and how it pushes back.

mod accuracy;
mod added_mass;
#[cfg(feature = "bake")]
pub mod boundary_element;
mod carlson;
mod check;
mod ellipsoid;
#[cfg(feature = "serde-serialize")]
mod file;
mod planform;
mod properties;
pub(crate) mod viscous;

pub use accuracy::Accuracy;
pub use added_mass::AddedMass;
pub use ellipsoid::StokesResistance;
pub use planform::Planform;
pub use properties::HydroProperties;
