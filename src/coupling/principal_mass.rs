//! The linear masses that a body shows in fluid.

use crate::math::to_rotation;
use rapier3d::math::{Real, Rotation, Vector};
use rapier3d::na::{Matrix3, Rotation3, UnitQuaternion};

/// 𝕄₁₁ = m + ρA₁₁ by its principal axes.
#[derive(Clone, Debug)]
pub(super) struct PrincipalMass {
    /// kg.
    pub masses: Vector,
    /// The masses' axes to the body's frame.
    axes: Rotation,
}

impl PrincipalMass {
    /// `matrix` is 𝕄₁₁ in the body's frame.
    pub fn of(matrix: &Matrix3<f64>) -> Self {
        let eigen = matrix.symmetric_eigen();
        let mut axes = eigen.eigenvectors;
        if axes.determinant() < 0.0 {
            axes.column_mut(0).neg_mut();
        }
        let axes = Rotation3::from_matrix_unchecked(axes);
        let masses = eigen.eigenvalues.map(|mass| mass as Real);
        Self {
            masses: Vector::new(masses.x, masses.y, masses.z),
            axes: to_rotation(UnitQuaternion::from_rotation_matrix(&axes)),
        }
    }

    /// Scales each principal part of a vector in world axes by a function of its mass; `attitude` maps
    /// the body's frame to the world.
    pub fn scale(&self, attitude: Rotation, v: Vector, factor: impl Fn(Real) -> Real) -> Vector {
        let axes = attitude * self.axes;
        let own = axes.inverse() * v;
        let masses = self.masses;
        let factors = Vector::new(factor(masses.x), factor(masses.y), factor(masses.z));
        axes * (own * factors)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{to_f64, to_quaternion};
    use approx::assert_relative_eq;

    /// With the masses as factors it is the product with the tensor, whatever its axes are.
    #[test]
    fn masses_as_factors_make_the_momentum() {
        let turn = Rotation3::from_euler_angles(0.4, -1.1, 2.0);
        let own = Matrix3::from_diagonal(&[1.0, 3.0, 7.0].into());
        let matrix = turn.matrix() * own * turn.matrix().transpose();
        let attitude = Rotation::from_scaled_axis(Vector::new(0.3, 2.0, -0.5));
        let v = Vector::new(0.2, -1.0, 0.6);
        let momentum = PrincipalMass::of(&matrix).scale(attitude, v, |mass| mass);
        let rotation = to_quaternion(attitude);
        let exact = rotation * (matrix * (rotation.inverse() * to_f64(v)));
        assert_relative_eq!(to_f64(momentum), exact, epsilon = 1e-5);
    }
}
