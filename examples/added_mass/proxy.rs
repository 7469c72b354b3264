//! How far off the proxy ellipsoid is: the ellipsoid of the same extents along the principal axes.

use crate::case::Case;
use rapier3d_immersed::geometry::Ellipsoid;
use rapier3d_immersed::hydro::AddedMass;
use rapier3d_immersed::rapier3d::na::{Matrix3, Rotation3, Vector3};

pub struct ProxyError {
    pub linear: f64,
    pub angular: f64,
}

/// Relative difference of each block in the Frobenius norm; none for a sheet.
pub fn error(case: &Case, added: &AddedMass) -> Option<ProxyError> {
    let surface = case.surface()?;
    let inside = surface.volume_integrals();
    let mut axes: Matrix3<f64> = inside.second_moment.symmetric_eigen().eigenvectors;
    if axes.determinant() < 0.0 {
        axes.column_mut(0).neg_mut();
    }
    let extent = |axis: Vector3<f64>| {
        let along = surface.vertices().iter().map(|v| axis.dot(v));
        let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        high - low
    };
    let proxy = Ellipsoid {
        semi_axes: Vector3::from_fn(|i, _| extent(axes.column(i).into_owned()) / 2.0),
    };
    let proxy = proxy
        .added_mass()
        .rotated(&Rotation3::from_matrix_unchecked(axes));
    Some(ProxyError {
        linear: (proxy.linear - added.linear).norm() / added.linear.norm(),
        angular: (proxy.angular - added.angular).norm() / added.angular.norm(),
    })
}
