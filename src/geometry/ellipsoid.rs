//! Ellipsoids.

use rapier3d::na::Vector3;
use std::f64::consts::PI;

/// An ellipsoid by its semi-axes (m), along the axes of its own frame.
///
/// ```
/// use rapier3d_immersed::geometry::Ellipsoid;
/// use rapier3d_immersed::rapier3d::na::Vector3;
///
/// // Broadside, an infinitely thin disc of radius a drags (8/3)ρa³ of fluid along.
/// let disc = Ellipsoid { semi_axes: Vector3::new(0.1, 0.1, 0.0) };
/// let added_mass = disc.added_mass();
/// assert!((added_mass.linear[(2, 2)] - 8.0 / 3.0 * 0.1_f64.powi(3)).abs() < 1e-9);
/// assert_eq!(disc.volume(), 0.0);
/// ```
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
