//! How far off the proxy ellipsoid is: the ellipsoid that casts the same three shadows along the
//! principal axes.

use crate::case;
use crate::support::shape::Shaped;
use rapier3d_immersed::{AddedMass, HydroProperties};

pub struct ProxyError {
    pub linear: f64,
    pub angular: f64,
}

/// Difference of each block in the Frobenius norm, relative to the block, of the rotations at least
/// to the inertia of the displaced fluid; none for a sheet.
pub fn error(body: &Shaped, added: &AddedMass) -> Option<ProxyError> {
    let surface = case::surface(body)?;
    let inside = surface.volume_integrals();
    let proxy = HydroProperties::from_surface(&surface, inside.centroid).added_mass;
    let floor = inside.unit_inertia().norm();
    Some(ProxyError {
        linear: (proxy.linear - added.linear).norm() / added.linear.norm(),
        angular: (proxy.angular - added.angular).norm() / added.angular.norm().max(floor),
    })
}
