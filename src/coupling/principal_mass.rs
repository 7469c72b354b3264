//! The linear masses that a body shows in fluid.

use crate::math::{to_f64, to_quaternion, to_real};
use rapier3d::math::{Rotation, Vector};
use rapier3d::na::{Matrix3, Vector3};

/// 𝕄₁₁ = m + ρA₁₁ by its principal axes.
#[derive(Clone, Debug)]
pub(super) struct PrincipalMass {
    /// kg.
    pub masses: Vector3<f64>,
    /// The masses' axes in the body's frame, as columns.
    axes: Matrix3<f64>,
}

impl PrincipalMass {
    /// `matrix` is 𝕄₁₁ in the body's frame.
    pub fn of(matrix: &Matrix3<f64>) -> Self {
        let eigen = matrix.symmetric_eigen();
        Self {
            masses: eigen.eigenvalues,
            axes: eigen.eigenvectors,
        }
    }

    /// Scales each principal part of a vector in world axes by a function of its mass; `attitude` maps
    /// the body's frame to the world.
    pub fn scale(&self, attitude: Rotation, v: Vector, factor: impl Fn(f64) -> f64) -> Vector {
        let rotation = to_quaternion(attitude);
        let parts = self.axes.tr_mul(&(rotation.inverse() * to_f64(v)));
        let parts = parts.zip_map(&self.masses, |part, mass| part * factor(mass));
        to_real(rotation * (self.axes * parts))
    }
}
