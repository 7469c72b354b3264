//! The scalars that the force laws and the integrator run on: `f64` for a free body, `f32` lanes
//! for the bodies of a rapier world. One formula serves all of them.

use rapier3d::na::{SimdRealField, SimdValue};
use simba::simd::WideF32x4;

/// Number of bodies that the step advances at once.
pub(crate) const LANES: usize = 4;

/// [`LANES`] bodies side by side.
pub(crate) type Lanes = WideF32x4;

/// A real number, or several side by side.
pub trait Scalar: SimdRealField + Copy {
    /// The same constant in every lane.
    fn lit(value: f64) -> Self;
    /// `e^self`.
    fn exponential(self) -> Self;
    /// Natural logarithm; `self` must be positive.
    fn logarithm(self) -> Self;
    /// `self` where it is larger than `other`, in each lane.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        self.simd_max(other)
    }
    /// `self` where it is smaller than `other`, in each lane.
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        self.simd_min(other)
    }
    /// `self` in the lanes where `a < b`, `other` elsewhere (also where `a` or `b` is NaN).
    #[inline(always)]
    fn where_less(self, a: Self, b: Self, other: Self) -> Self {
        self.select(a.simd_lt(b), other)
    }
    /// Square root; `self` must not be negative.
    #[inline(always)]
    fn root(self) -> Self {
        self.simd_sqrt()
    }
}

impl Scalar for f64 {
    #[inline(always)]
    fn lit(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn exponential(self) -> Self {
        self.exp()
    }
    #[inline(always)]
    fn logarithm(self) -> Self {
        self.ln()
    }
}

impl Scalar for f32 {
    #[inline(always)]
    fn lit(value: f64) -> Self {
        value as f32
    }
    // The same polynomials as the lanes use, so that a lane and a scalar give the same bits.
    #[inline(always)]
    fn exponential(self) -> Self {
        wide::f32x4::splat(self).exp().to_array()[0]
    }
    #[inline(always)]
    fn logarithm(self) -> Self {
        wide::f32x4::splat(self).ln().to_array()[0]
    }
}

impl Scalar for Lanes {
    #[inline(always)]
    fn lit(value: f64) -> Self {
        Self::splat(value as f32)
    }
    #[inline(always)]
    fn exponential(self) -> Self {
        Self(self.0.exp())
    }
    #[inline(always)]
    fn logarithm(self) -> Self {
        Self(self.0.ln())
    }
}

/// Defines a struct whose fields are all one scalar type, and how to convert it lane by lane.
///
/// `Name<T>::from_f64(&Name<f64>)` rounds or broadcasts; `Name<Lanes>::gather([&Name<f32>; LANES])`
/// puts four bodies side by side.
macro_rules! scalar_struct {
    ($(#[$meta:meta])* $vis:vis struct $name:ident { $($(#[$field_meta:meta])* $field:ident,)+ }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
        $vis struct $name<T> {
            $($(#[$field_meta])* pub(crate) $field: T,)+
        }

        impl<T: $crate::math::Scalar> $name<T> {
            /// Rounds (f32) or broadcasts (lanes) constants that were computed in f64.
            pub(crate) fn from_f64(constants: &$name<f64>) -> Self {
                Self { $($field: T::lit(constants.$field),)+ }
            }
        }

        impl $name<$crate::math::Lanes> {
            /// Four bodies side by side. Bodies that share their constants are the common case.
            #[inline(always)]
            pub(crate) fn gather(bodies: [&$name<f32>; $crate::math::LANES]) -> Self {
                let [first, rest @ ..] = bodies;
                if rest.iter().all(|other| std::ptr::eq(first, *other)) {
                    use rapier3d::na::SimdValue;
                    return Self { $($field: $crate::math::Lanes::splat(first.$field),)+ };
                }
                Self { $($field: $crate::math::Lanes::from(bodies.map(|b| b.$field)),)+ }
            }
        }
    };
}
pub(crate) use scalar_struct;

#[cfg(test)]
mod tests {
    use super::*;

    /// The polynomials are good to a few units in the last place over the range the laws use.
    #[test]
    fn exp_and_ln_in_lanes() {
        for i in -40..=40 {
            let x = i as f32 * 0.5;
            let exact = f64::from(x).exp();
            assert!(
                (f64::from(x.exponential()) / exact - 1.0).abs() < 5e-7,
                "exp {x}"
            );
            let y = exact as f32;
            let ln = f64::from(y).ln();
            assert!(
                (f64::from(y.logarithm()) - ln).abs() < 1e-6 * ln.abs().max(1.0),
                "ln {y}"
            );
        }
    }
}
