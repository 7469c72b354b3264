//! Ellipsoids.

use rapier3d::na::Vector3;
use std::f64::consts::PI;

/// An ellipsoid by its semi-axes (m), along the axes of its own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Ellipsoid {
    /// Semi-axes, m: positive, except that one may be zero (an elliptic disc).
    pub semi_axes: Vector3<f64>,
}

impl Ellipsoid {
    /// Volume, m³.
    pub fn volume(&self) -> f64 {
        4.0 / 3.0 * PI * self.semi_axes.product()
    }

    /// Area of the shadow along the unit vector `direction` (ellipsoid's axes), m².
    ///
    /// `π √(b²c² d_x² + a²c² d_y² + a²b² d_z²)`.
    pub fn projected_area(&self, direction: Vector3<f64>) -> f64 {
        let [a, b, c] = self.semi_axes.into();
        PI * Vector3::new(b * c, a * c, a * b)
            .component_mul(&direction)
            .norm()
    }
}
