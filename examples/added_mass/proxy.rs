//! How far off the proxy ellipsoid is: the ellipsoid that casts the same three shadows along the
//! principal axes.

use crate::case::Case;
use rapier3d_immersed::geometry::Ellipsoid;
use rapier3d_immersed::hydro::AddedMass;
use rapier3d_immersed::rapier3d::na::{Matrix3, Rotation3, Vector3};
use std::f64::consts::PI;

pub struct ProxyError {
    pub linear: f64,
    pub angular: f64,
}

/// Difference of each block in the Frobenius norm, relative to the block, of the rotations at least
/// to the inertia of the displaced fluid; none for a sheet.
pub fn error(case: &Case, added: &AddedMass) -> Option<ProxyError> {
    let surface = case.surface()?;
    let inside = surface.volume_integrals();
    let moment = inside.second_moment;
    let diagonal = Matrix3::from_diagonal(&moment.diagonal());
    // The axes of a cube are arbitrary: take the frame's own where they do.
    let mut axes = if (moment - diagonal).norm() <= 1e-5 * moment.norm() {
        Matrix3::identity()
    } else {
        moment.symmetric_eigen().eigenvectors
    };
    if axes.determinant() < 0.0 {
        axes.column_mut(0).neg_mut();
    }
    let [x, y, z] = [0, 1, 2].map(|i| surface.projected_area(axes.column(i).into_owned()));
    let proxy = Ellipsoid {
        semi_axes: Vector3::new(y * z / x, z * x / y, x * y / z).map(|s| (s / PI).sqrt()),
    };
    let proxy = proxy
        .added_mass()
        .rotated(&Rotation3::from_matrix_unchecked(axes));
    let floor = inside.unit_inertia().norm();
    Some(ProxyError {
        linear: (proxy.linear - added.linear).norm() / added.linear.norm(),
        angular: (proxy.angular - added.angular).norm() / added.angular.norm().max(floor),
    })
}
