//! What the fluid feels of a shape, and how it pushes back.

mod accuracy;
mod added_mass;
mod added_mass_source;
mod bluff_shape;
mod bluff_side;
#[cfg(feature = "bake")]
pub mod boundary_element;
mod carlson;
mod check;
mod ellipsoid;
#[cfg(feature = "serde-serialize")]
mod file;
mod hull;
pub(crate) mod part_law;
mod planform;
mod properties;
mod scope;
mod silhouette;
mod solids;
mod strips;
pub(crate) mod viscous;

pub use accuracy::Accuracy;
pub use added_mass::AddedMass;
pub use added_mass_source::AddedMassSource;
pub use bluff_shape::BluffShape;
pub use ellipsoid::StokesResistance;
pub use hull::{Hull, Submerged, Waterplane};
pub use part_law::{
    CustomLaw, Damping, DragBox, PartLaw, PartMotion, PolarRow, PolarTable, SeparatedLaw,
};
pub use planform::Planform;
pub use properties::HydroProperties;
pub use scope::OutOfScope;
use silhouette::Silhouette;
pub use solids::Solid;
