//! The scalars that the force laws and the integrator run on: `f64` for a free body, `f32` lanes
//! for the bodies of a rapier world. One formula serves all of them.

use rapier3d::na::{SimdBool, SimdPartialOrd, SimdRealField, SimdValue};
use simba::simd::WideF32x4;

/// Number of bodies that the step advances at once.
pub(crate) const LANES: usize = 4;

/// [`LANES`] bodies side by side.
pub(crate) type Lanes = WideF32x4;

/// A real number, or several side by side.
pub trait Scalar: SimdRealField + Copy {
    /// The same constant in every lane.
    fn lit(value: f64) -> Self;
    /// `e^self`; in lanes, arguments beyond ±87 count as ±87.
    fn exponential(self) -> Self;
    /// Natural logarithm; `self` must be positive.
    fn logarithm(self) -> Self;
    /// Whether no lane is below `limit` (or NaN).
    fn all_from(self, limit: f64) -> bool;
    /// `self` where it is larger than `other`, in each lane. What NaN gives is left open.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        self.simd_max(other)
    }
    /// `self` where it is smaller than `other`, in each lane. What NaN gives is left open.
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
    #[inline(always)]
    fn all_from(self, limit: f64) -> bool {
        self >= limit
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
        exponential(wide::f32x4::splat(self)).to_array()[0]
    }
    #[inline(always)]
    fn logarithm(self) -> Self {
        wide::f32x4::splat(self).ln().to_array()[0]
    }
    #[inline(always)]
    fn all_from(self, limit: f64) -> bool {
        self >= limit as f32
    }
}

/// `e^x` for |x| ≤ 87, to 2 units in the last place, without the special cases that `wide` provides
/// for: a third of its operations. `2^n e^r` with the polynomial of the Cephes library (Moshier
/// 1989) for |r| ≤ ½ ln 2.
#[inline(always)]
fn exponential(x: wide::f32x4) -> wide::f32x4 {
    use wide::{bytemuck, f32x4, i32x4};
    let x = x.fast_max(f32x4::splat(-87.0)).fast_min(f32x4::splat(87.0));
    let n = (x * f32x4::splat(std::f32::consts::LOG2_E)).fast_round_int();
    let whole = f32x4::from_i32x4(n);
    // ln 2 in two parts, the first exact in a few bits.
    let r = x - whole * f32x4::splat(0.693_359_4) + whole * f32x4::splat(2.121_944_4e-4);
    const P: [f32; 5] = [
        1.398_199_9e-3,
        8.333_452e-3,
        4.166_579_6e-2,
        1.666_666_5e-1,
        0.5,
    ];
    let mut p = f32x4::splat(1.987_569_1e-4);
    for coefficient in P {
        p = p * r + f32x4::splat(coefficient);
    }
    let fraction = p * r * r + r + f32x4::splat(1.0);
    let power: f32x4 = bytemuck::cast((n + i32x4::splat(127)) << 23);
    fraction * power
}

impl Scalar for Lanes {
    #[inline(always)]
    fn lit(value: f64) -> Self {
        Self::splat(value as f32)
    }
    #[inline(always)]
    fn exponential(self) -> Self {
        Self(exponential(self.0))
    }
    #[inline(always)]
    fn logarithm(self) -> Self {
        Self(self.0.ln())
    }
    #[inline(always)]
    fn all_from(self, limit: f64) -> bool {
        self.simd_ge(Self::lit(limit)).all()
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Self(self.0.fast_max(other.0))
    }
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        Self(self.0.fast_min(other.0))
    }
}

/// Defines a struct whose fields are all one scalar type, and how to convert it lane by lane.
///
/// `Name<T>::from_f64(&Name<f64>)` rounds or broadcasts; `Name::gather([&Name<Lanes>; LANES])` puts
/// bodies side by side whose constants differ.
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
            /// Four bodies side by side; of each, all lanes are the same.
            #[inline(always)]
            pub(crate) fn gather(bodies: [&$name<$crate::math::Lanes>; $crate::math::LANES]) -> Self {
                use rapier3d::na::SimdValue;
                Self { $($field: $crate::math::Lanes::from(bodies.map(|b| b.$field.extract(0))),)+ }
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
