//! The scalars that the force laws and the integrator run on: `f64` for a free body, `f32`
//! [`Lanes`](super::Lanes) for the bodies of a rapier world. One formula serves all of them.
//!
//! Lanes are made of registers that not every machine has. That this one has them is *proved* by a
//! token of size zero, which only the detection at run time hands out and which every value carries
//! on. Nothing can therefore be made of nothing: a constant is asked of a value, `x.constant(2.0)`, and is
//! of its kind; and nalgebra's zeros and ones, which need no value, are out of reach, so that products
//! of matrices are written out ([`spatial`](super::spatial)).

use crate::math;
use rapier3d::na::{ClosedAddAssign, ClosedDivAssign, ClosedMulAssign, ClosedSubAssign};
use std::fmt::Debug;
use std::ops::Neg;

/// A real number, or several side by side.
///
/// Sums, differences, products, quotients and roots are rounded correctly, `f32` and lanes have the
/// same [`Scalar::exp`] and [`Scalar::ln`]: a body's bits do not depend on how many are beside it.
pub trait Scalar:
    Copy
    + Debug
    + PartialEq
    + 'static
    + Neg<Output = Self>
    + ClosedAddAssign
    + ClosedSubAssign
    + ClosedMulAssign
    + ClosedDivAssign
{
    /// A constant, of the kind that `self` is; in every lane.
    fn constant(self, value: f64) -> Self;
    /// `e^self`; but for f64, arguments beyond ±87 count as ±87.
    fn exp(self) -> Self;
    /// Natural logarithm; `self` must be positive, finite and not subnormal.
    fn ln(self) -> Self;
    /// Whether no lane is below `limit` (or NaN).
    fn all_ge(self, limit: f64) -> bool;
    /// `self` where it is larger than `other`, in each lane. What NaN gives is left open.
    fn max(self, other: Self) -> Self;
    /// `self` where it is smaller than `other`, in each lane. What NaN gives is left open.
    fn min(self, other: Self) -> Self;
    /// `self` in the lanes where `a < b`, `other` elsewhere (also where `a` or `b` is NaN).
    fn select_lt(self, a: Self, b: Self, other: Self) -> Self;
    /// Square root; `self` must not be negative.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// The next whole number that is not less.
    fn ceil(self) -> Self;
    /// What `of` makes of the numbers of each lane, in f64: for what is no arithmetic, as a look-up.
    fn by_lane<const I: usize, const O: usize>(
        inputs: [Self; I],
        of: impl FnMut([f64; I]) -> [f64; O],
    ) -> [Self; O];
}

/// The methods that f64 and f32 have in the standard library.
macro_rules! standard {
    ($type:ident) => {
        #[inline(always)]
        fn constant(self, value: f64) -> Self {
            value as $type
        }
        #[inline(always)]
        fn all_ge(self, limit: f64) -> bool {
            self >= limit as $type
        }
        #[inline(always)]
        fn max(self, other: Self) -> Self {
            self.max(other)
        }
        #[inline(always)]
        fn min(self, other: Self) -> Self {
            self.min(other)
        }
        #[inline(always)]
        fn select_lt(self, a: Self, b: Self, other: Self) -> Self {
            if a < b { self } else { other }
        }
        #[inline(always)]
        fn sqrt(self) -> Self {
            self.sqrt()
        }
        #[inline(always)]
        fn abs(self) -> Self {
            self.abs()
        }
        #[inline(always)]
        fn ceil(self) -> Self {
            self.ceil()
        }
        #[inline(always)]
        fn by_lane<const I: usize, const O: usize>(
            inputs: [Self; I],
            mut of: impl FnMut([f64; I]) -> [f64; O],
        ) -> [Self; O] {
            of(inputs.map(f64::from)).map(|x| x as $type)
        }
    };
}

impl Scalar for f64 {
    standard!(f64);
    #[inline(always)]
    fn exp(self) -> Self {
        math::exp(self)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        math::ln(self)
    }
}

impl Scalar for f32 {
    standard!(f32);
    #[inline(always)]
    fn exp(self) -> Self {
        exponential(self)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        logarithm(self)
    }
}

/// Numbers of the format of f32, whose bits can be got at.
pub(super) trait Binary32: Scalar {
    /// `2^n`, where `shifted` is `n + 3·2²²`, −126 ≤ n ≤ 127.
    fn power_of_two(shifted: Self) -> Self;
    /// A positive x as `(m, 2²³ + 127 + n)`, where x = m 2ⁿ with ½√2 ≤ m < √2.
    fn mantissa_and_exponent(self) -> (Self, Self);
}

/// Bits of 1 and of ½√2, and how many the mantissa has.
pub(super) const ONE: u32 = 127 << MANTISSA;
pub(super) const ROOT_HALF: u32 = std::f32::consts::FRAC_1_SQRT_2.to_bits();
pub(super) const MANTISSA: u32 = 23;
/// 2²³: the numbers from here on to 2²⁴ have their whole part in the lowest bits.
pub(super) const WHOLE: u32 = (127 + MANTISSA) << MANTISSA;

impl Binary32 for f32 {
    fn power_of_two(shifted: Self) -> Self {
        Self::from_bits((shifted.to_bits() << MANTISSA).wrapping_add(ONE))
    }
    fn mantissa_and_exponent(self) -> (Self, Self) {
        let above = self.to_bits().wrapping_sub(ROOT_HALF);
        let exponent = above.wrapping_add(ONE) >> MANTISSA;
        let mantissa = self.to_bits().wrapping_sub(above & (!0 << MANTISSA));
        (
            Self::from_bits(mantissa),
            Self::from_bits(exponent.wrapping_add(WHOLE)),
        )
    }
}

/// ln 2 in two parts, the first exact in a few bits.
const LN_2: [f64; 2] = [0.693_359_375, -2.121_944_4e-4];

/// `e^x` for |x| ≤ 87, to 2 units in the last place: `2^n e^r` with the polynomial of the Cephes
/// library (Moshier 1989) for |r| ≤ ½ ln 2.
#[inline(always)]
pub(super) fn exponential<T: Binary32>(x: T) -> T {
    let x = x.max(x.constant(-87.0)).min(x.constant(87.0));
    // The sum is so large that it has no bits for a fraction, which rounds x to a whole number.
    let shift = x.constant(12_582_912.0);
    let shifted = x * x.constant(std::f64::consts::LOG2_E) + shift;
    let n = shifted - shift;
    let r = x - n * x.constant(LN_2[0]) - n * x.constant(LN_2[1]);
    let mut p = x.constant(1.987_569_1e-4);
    for coefficient in [
        1.398_199_9e-3,
        8.333_452e-3,
        4.166_579_6e-2,
        1.666_666_5e-1,
        0.5,
    ] {
        p = p * r + x.constant(coefficient);
    }
    let fraction = p * r * r + r + x.constant(1.0);
    fraction * T::power_of_two(shifted)
}

/// `ln x` for normal x > 0, to 3 units in the last place: `n ln 2 + 2 artanh((m−1)/(m+1))` with
/// artanh as its series.
#[inline(always)]
pub(super) fn logarithm<T: Binary32>(x: T) -> T {
    let (m, shifted) = x.mantissa_and_exponent();
    let n = shifted - x.constant(8_388_608.0 + 127.0);
    let one = x.constant(1.0);
    let f = m - one;
    let s = f / (m + one);
    let s2 = s * s;
    let mut p = x.constant(2.0 / 9.0);
    for coefficient in [2.0 / 7.0, 2.0 / 5.0, 2.0 / 3.0] {
        p = p * s2 + x.constant(coefficient);
    }
    let small = p * s2 * s + n * x.constant(LN_2[1]);
    (s + s) + small + n * x.constant(LN_2[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The polynomials are good to a few units in the last place (6e-8) over the range the laws use.
    #[test]
    fn exponential_and_logarithm() {
        for i in -160..=160 {
            let x = i as f32 * 0.5;
            let exact = f64::from(x).exp();
            assert!(
                (f64::from(Scalar::exp(x)) / exact - 1.0).abs() < 2e-7,
                "exp {x}"
            );
            let y = exact as f32;
            let ln = f64::from(y).ln();
            assert!(
                (f64::from(Scalar::ln(y)) - ln).abs() <= 2e-7 * ln.abs(),
                "ln {y}"
            );
        }
    }
}
