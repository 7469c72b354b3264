//! Added mass: the inertia of the fluid that a moving body drags along.

use crate::math;
use rapier3d::na::{Matrix3, Matrix6, Rotation3, Vector3, Vector6};

/// Share of the largest diagonal entry that may be the rounding of another.
const ROUNDING: f64 = 1e-12;

/// Added-mass tensor of a shape **per unit fluid density**, about one reference point and in the
/// axes of one frame.
///
/// Moving with velocity `u` of the reference point and angular velocity `ω` through an inviscid
/// fluid of density ρ, the body sets fluid in motion whose impulse and impulse moment are
///
/// ```text
/// p = ρ (A₁₁ u + A₁₂ ω)        h = ρ (A₁₂ᵀ u + A₂₂ ω)
/// ```
///
/// and whose kinetic energy is `½ (u·p + ω·h)` (Lamb, *Hydrodynamics*, chapter VI; thesis § 5.3.1,
/// which leaves out the coupling block A₁₂ that any body without three planes of symmetry has).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct AddedMass {
    /// A₁₁, symmetric: impulse per velocity, m³.
    pub linear: Matrix3<f64>,
    /// A₁₂: impulse per angular velocity, m⁴. Its transpose maps velocity to impulse moment.
    pub coupling: Matrix3<f64>,
    /// A₂₂, symmetric: impulse moment per angular velocity, m⁵.
    pub angular: Matrix3<f64>,
}

impl AddedMass {
    /// The added mass of nothing.
    pub fn zero() -> Self {
        Self {
            linear: Matrix3::zeros(),
            coupling: Matrix3::zeros(),
            angular: Matrix3::zeros(),
        }
    }

    /// Added mass of a body whose axes are planes of symmetry.
    pub fn diagonal(linear: Vector3<f64>, angular: Vector3<f64>) -> Self {
        Self {
            linear: Matrix3::from_diagonal(&linear),
            coupling: Matrix3::zeros(),
            angular: Matrix3::from_diagonal(&angular),
        }
    }

    /// The same tensor about another reference point, at `offset` from the current one (m, same
    /// axes).
    ///
    /// The old point moves with `u − ω × offset` where `u` is the velocity of the new one; the
    /// kinetic energy does not depend on the choice.
    pub fn about(&self, offset: Vector3<f64>) -> Self {
        let d = offset.cross_matrix();
        let coupling = self.coupling + self.linear * d;
        Self {
            linear: self.linear,
            coupling,
            angular: self.angular + d.transpose() * coupling + self.coupling.transpose() * d,
        }
    }

    /// The same tensor in other axes: `rotation` maps the current axes' coordinates to the new
    /// ones'.
    pub fn rotated(&self, rotation: &Rotation3<f64>) -> Self {
        let (r, rt) = (rotation.matrix(), rotation.inverse());
        let turn = |block: &Matrix3<f64>| r * block * rt.matrix();
        Self {
            linear: turn(&self.linear),
            coupling: turn(&self.coupling),
            angular: turn(&self.angular),
        }
    }

    /// The same tensor times a factor.
    pub(crate) fn scaled(&self, factor: f64) -> Self {
        Self {
            linear: self.linear * factor,
            coupling: self.coupling * factor,
            angular: self.angular * factor,
        }
    }

    /// The symmetric 6×6 matrix `[A₁₁ A₁₂; A₁₂ᵀ A₂₂]`.
    pub fn to_matrix6(&self) -> Matrix6<f64> {
        let mut m = Matrix6::zeros();
        m.fixed_view_mut::<3, 3>(0, 0).copy_from(&self.linear);
        m.fixed_view_mut::<3, 3>(0, 3).copy_from(&self.coupling);
        m.fixed_view_mut::<3, 3>(3, 0)
            .copy_from(&self.coupling.transpose());
        m.fixed_view_mut::<3, 3>(3, 3).copy_from(&self.angular);
        m
    }

    /// The inverse of [`AddedMass::to_matrix6`]; the blocks are symmetrised.
    pub fn from_matrix6(m: &Matrix6<f64>) -> Self {
        let m = (m + m.transpose()) * 0.5;
        Self {
            linear: m.fixed_view::<3, 3>(0, 0).into_owned(),
            coupling: m.fixed_view::<3, 3>(0, 3).into_owned(),
            angular: m.fixed_view::<3, 3>(3, 3).into_owned(),
        }
    }

    /// Whether every entry is finite and no motion has negative kinetic energy (beyond rounding).
    pub fn is_physical(&self) -> bool {
        let m = self.to_matrix6();
        if !m.iter().all(|x| x.is_finite()) {
            return false;
        }
        let asymmetry = (self.linear - self.linear.transpose()).norm()
            + (self.angular - self.angular.transpose()).norm();
        // Scale rows and columns so that m³ and m⁵ compare. What is rounding beside the largest of its block,
        // as a rod's inertia about its own axis is once it has been turned, is left at that.
        // About its center a ball's inertia is rounding as a whole: beside that of a body of its size.
        let [linear, angular] = [self.linear, self.angular].map(|block| block.diagonal().amax());
        let largest = [linear, angular.max(math::cbrt(linear).powi(5))];
        let largest = Vector6::from_fn(|i, _| largest[i / 3]);
        let diagonal = m.diagonal();
        if (0..6).any(|i| diagonal[i] < -ROUNDING * largest[i]) {
            return false;
        }
        let scale = diagonal.zip_map(&largest, |d, largest| {
            let size = if d > ROUNDING * largest { d } else { largest };
            if size > 0.0 { size.sqrt().recip() } else { 1.0 }
        });
        let scaled = Matrix6::from_diagonal(&scale) * m * Matrix6::from_diagonal(&scale);
        asymmetry <= 1e-9 * m.norm()
            && scaled
                .symmetric_eigenvalues()
                .iter()
                .all(|eigenvalue| *eigenvalue >= -1e-9)
    }
}

impl std::ops::Add for AddedMass {
    type Output = Self;

    /// Sum of two tensors about the same point and in the same axes.
    fn add(self, other: Self) -> Self {
        Self {
            linear: self.linear + other.linear,
            coupling: self.coupling + other.coupling,
            angular: self.angular + other.angular,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> AddedMass {
        let mut m = Matrix6::from_fn(|i, j| 0.1 * ((i * 7 + j * 3) % 5) as f64);
        m = m * m.transpose() + Matrix6::identity() * 0.3;
        AddedMass::from_matrix6(&m)
    }

    /// Kinetic energy per unit density is a scalar: it cannot depend on the point or the axes.
    #[test]
    fn energy_does_not_depend_on_reference_point_or_axes() {
        let a = sample();
        let (u, w) = (Vector3::new(0.3, -1.0, 0.7), Vector3::new(1.1, 0.2, -0.4));
        let energy = |a: &AddedMass, u: Vector3<f64>, w: Vector3<f64>| {
            0.5 * (u.dot(&(a.linear * u + a.coupling * w))
                + w.dot(&(a.coupling.transpose() * u + a.angular * w)))
        };
        let d = Vector3::new(0.5, 0.25, -2.0);
        let moved = energy(&a.about(d), u + w.cross(&d), w);
        assert!((moved - energy(&a, u, w)).abs() < 1e-12);

        let r = Rotation3::from_euler_angles(0.4, -1.2, 2.0);
        let turned = energy(&a.rotated(&r), r * u, r * w);
        assert!((turned - energy(&a, u, w)).abs() < 1e-12);
    }

    #[test]
    fn moving_there_and_back_is_the_identity() {
        let (a, d) = (sample(), Vector3::new(0.5, 0.25, -2.0));
        let back = a.about(d).about(-d);
        assert!((back.to_matrix6() - a.to_matrix6()).norm() < 1e-12);
    }

    /// Rods from a millimetre to a kilometre, turned and moved: rounding is not negative energy, but a
    /// thousandth of the rod's own is.
    #[test]
    fn rods_at_any_scale_and_attitude_are_physical() {
        for size in [1e-3, 1.0, 1e3_f64] {
            let (volume, square) = (0.1 * size.powi(3), size * size);
            let linear = Vector3::new(1e-8, 1.0, 1.0) * volume;
            let angular = Vector3::new(0.0, 0.1, 0.1) * (volume * square);
            for angle in 0..40 {
                let turn = Rotation3::from_euler_angles(0.3, 0.17 * f64::from(angle), 0.9);
                let rod = AddedMass::diagonal(linear, angular).rotated(&turn);
                let moved = rod.about(turn * Vector3::new(0.4 * size, 0.0, 0.0));
                assert!(moved.is_physical(), "{size} {angle}");
                let mut negative = moved;
                let axis = turn * Vector3::x();
                negative.angular -= axis * axis.transpose() * (1e-3 * angular.y);
                assert!(!negative.is_physical(), "{size} {angle}");
            }
        }
    }

    /// The matrix leads back to the tensor, its rounding's asymmetry halved.
    #[test]
    fn the_matrix_is_the_tensor() {
        let mut m = sample().to_matrix6();
        m[(0, 4)] += 2e-3;
        m[(4, 1)] = 0.7;
        m[(1, 4)] = 0.7;
        let mut halved = m;
        halved[(0, 4)] -= 1e-3;
        halved[(4, 0)] += 1e-3;
        let back = AddedMass::from_matrix6(&m).to_matrix6();
        assert!((back - halved).norm() < 1e-12, "{}", back - halved);
    }

    /// Every entry of a sum is the sum of the entries.
    #[test]
    fn tensors_add_up() {
        let (a, b) = (sample(), sample().about(Vector3::new(0.5, 0.25, -2.0)));
        let sum = (a + b).to_matrix6();
        assert!((sum - a.to_matrix6() - b.to_matrix6()).norm() < 1e-12);
    }

    /// Balls from a tenth of a millimetre to a hundred metres, at any place: their inertia is nothing but rounding.
    #[test]
    fn balls_of_any_size_are_physical() {
        for exponent in -40..=20 {
            let radius = 1.3_f32.powi(exponent);
            let ball = rapier3d::parry::shape::Ball::new(radius);
            let hydro = crate::hydro::HydroProperties::from_shape(&ball).unwrap();
            assert!(hydro.check().is_ok(), "{radius}");
            for angle in 0..10 {
                let turn = Rotation3::from_euler_angles(0.3, 0.17 * f64::from(angle), 0.9);
                let turned = hydro.added_mass.rotated(&turn);
                assert!(turned.is_physical(), "{radius} {angle}");
            }
        }
    }

    #[test]
    fn negative_energy_and_nan_are_not_physical() {
        assert!(sample().is_physical());
        let mut negative = sample();
        negative.linear[(0, 0)] = -1.0;
        assert!(!negative.is_physical());
        // However small: this one, of a millimeter, has less energy than rounding would be of a meter's.
        let mut small = AddedMass::diagonal(Vector3::repeat(1e-9), Vector3::repeat(1e-15));
        assert!(small.is_physical());
        small.coupling[(0, 1)] = 1e-11;
        assert!(!small.is_physical());
        let mut nan = sample();
        nan.coupling[(1, 2)] = f64::NAN;
        assert!(!nan.is_physical());
    }
}
