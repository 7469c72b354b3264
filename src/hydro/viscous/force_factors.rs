//! Factors on a law's three forces, set from outside step by step.

use super::terms::{Evaluate, ViscousTerms};
use crate::error::Error;
use crate::math::Scalar;
use rapier3d::math::Real;
use rapier3d::na::Vector3;

/// Factors on the three forces of a viscous law: the control parameters c̃ of the pattern-driven method
/// (thesis § 5.3.3). Under the thesis's law with coefficients (1, 1, 1) they are its C̃.
///
/// A law that is passive stays so if `drag` is not negative: lifts do no work whatever their size. Damping
/// of the rotation is not scaled.
///
/// ```
/// use rapier3d_immersed::ForceFactors;
///
/// let heavy_drag = ForceFactors { drag: 4.0, ..ForceFactors::ONE };
/// assert!(heavy_drag.check().is_ok());
/// assert!(ForceFactors { drag: -1.0, ..heavy_drag }.check().is_err());
/// assert_eq!(ForceFactors::from([4.0, 1.0, 1.0]), heavy_drag);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct ForceFactors<T = Real> {
    /// Factor on the drag, creeping flow included; at least 0.
    pub drag: T,
    /// Factor on the lift of the rotation.
    pub rotational_lift: T,
    /// Factor on the lift of the angle of attack.
    pub translational_lift: T,
}

impl ForceFactors<Real> {
    /// The law as it is.
    pub const ONE: Self = Self {
        drag: 1.0,
        rotational_lift: 1.0,
        translational_lift: 1.0,
    };
}

/// The law as it is: all factors are 1.
impl<T: From<u8>> Default for ForceFactors<T> {
    fn default() -> Self {
        Self {
            drag: 1.into(),
            rotational_lift: 1.into(),
            translational_lift: 1.into(),
        }
    }
}

impl<T: Copy + Into<f64>> ForceFactors<T> {
    /// # Errors
    /// [`Error::OutOfRange`] names the factor that is not finite, or the drag's if it is negative.
    pub fn check(&self) -> Result<(), Error> {
        Error::check_range("factor on the drag", self.drag.into(), 0.0, f64::MAX)?;
        let (low, high) = (f64::MIN, f64::MAX);
        let rotational = self.rotational_lift.into();
        Error::check_range("factor on the rotational lift", rotational, low, high)?;
        let translational = self.translational_lift.into();
        Error::check_range("factor on the translational lift", translational, low, high)?;
        Ok(())
    }
}

/// In the order drag, rotational lift, translational lift: that of the thesis's (C_D, C_L1, C_L2).
impl<T> From<[T; 3]> for ForceFactors<T> {
    fn from([drag, rotational_lift, translational_lift]: [T; 3]) -> Self {
        Self {
            drag,
            rotational_lift,
            translational_lift,
        }
    }
}

impl<T> From<ForceFactors<T>> for [T; 3] {
    fn from(factors: ForceFactors<T>) -> Self {
        [
            factors.drag,
            factors.rotational_lift,
            factors.translational_lift,
        ]
    }
}

impl From<ForceFactors<f64>> for ForceFactors<f32> {
    fn from(factors: ForceFactors<f64>) -> Self {
        <[f64; 3]>::from(factors).map(|factor| factor as f32).into()
    }
}

impl From<ForceFactors<f32>> for ForceFactors<f64> {
    fn from(factors: ForceFactors<f32>) -> Self {
        <[f32; 3]>::from(factors).map(f64::from).into()
    }
}

/// A prepared law with factors on its forces.
pub(crate) struct Factored<'a, T, L> {
    pub law: &'a L,
    pub factors: ForceFactors<T>,
}

impl<T: Scalar, L: Evaluate<T>> Evaluate<T> for Factored<'_, T, L> {
    #[inline(always)]
    fn least_iterations(&self) -> u32 {
        self.law.least_iterations()
    }

    #[inline(always)]
    fn terms(&self, u: &Vector3<T>, w: &Vector3<T>) -> ViscousTerms<T> {
        let factors = &self.factors;
        let terms = self.law.terms(u, w);
        ViscousTerms {
            drag: terms.drag * factors.drag,
            creeping: terms.creeping * factors.drag,
            rotational_lift: terms.rotational_lift * factors.rotational_lift,
            translational_lift: terms.translational_lift * factors.translational_lift,
            ..terms
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The error names the factor and its value.
    #[test]
    fn bad_factors_are_named() {
        for (index, name) in ["drag", "rotational lift", "translational lift"]
            .into_iter()
            .enumerate()
        {
            for bad in [f64::NEG_INFINITY, f64::INFINITY, f64::NAN] {
                let mut factors = [1.0; 3];
                factors[index] = bad;
                let text = ForceFactors::from(factors).check().unwrap_err().to_string();
                let value = bad.to_string();
                assert!(text.contains(name) && text.contains(&value), "{text}");
            }
        }
        assert!(ForceFactors::from([0.0, -2.0, -3.0]).check().is_ok());
    }
}
