//! What the fluid feels of a shape, and how it pushes back.

pub mod accuracy;
pub mod added_mass;
#[cfg(feature = "bake")]
pub mod boundary_element;
#[cfg(feature = "serde-serialize")]
mod file;
pub mod planform;
pub mod properties;
pub mod viscous;

pub use accuracy::Accuracy;
pub use added_mass::AddedMass;
pub use planform::Planform;
pub use properties::HydroProperties;
pub use viscous::{PhysicalLaw, StochasticLaw, ThesisLaw, ViscousLaw};
