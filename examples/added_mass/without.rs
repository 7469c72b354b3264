//! How far off the added mass is that a shape has without boundary elements: from the table, or that of an ellipsoid.

use crate::case;
use crate::support::shape::Shaped;
use rapier3d_immersed::{AddedMass, AddedMassSource, HydroProperties};

pub struct Without {
    /// Where it is from.
    pub source: &'static str,
    pub linear: f64,
    pub angular: f64,
}

/// Difference of each block in the Frobenius norm, relative to the block, of the rotations at least
/// to the inertia of the displaced fluid; none for a sheet.
pub fn error(body: &Shaped, added: &AddedMass) -> Option<Without> {
    let surface = case::surface(body)?;
    let inside = surface.volume_integrals();
    let hydro = HydroProperties::from_surface(&surface, inside.centroid);
    let (own, floor) = (hydro.added_mass, inside.unit_inertia().norm());
    Some(Without {
        source: match hydro.added_mass_source {
            AddedMassSource::Table { .. } => "from the table",
            AddedMassSource::Ellipsoid => "that of the ellipsoid that it is",
            _ => "that of an ellipsoid with its shadows",
        },
        linear: (own.linear - added.linear).norm() / added.linear.norm(),
        angular: (own.angular - added.angular).norm() / added.angular.norm().max(floor),
    })
}
