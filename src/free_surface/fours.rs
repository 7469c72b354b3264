//! Linear waves, four side by side. Sums, products and quotients only, in an order that does not depend on the
//! machine's registers: the same waves give the same bits everywhere.

use crate::math::OnLanes;
use fearless_simd::{Simd, SimdBase, f64x4};

/// Four waves, each number one per wave.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Four {
    /// Turns of the phase per meter along x and z, per second, and at the origin.
    pub turns: [[f64; 4]; 4],
    /// Amplitude, and amplitude times wavenumber along x and z.
    pub height: [[f64; 4]; 3],
    /// Amplitude of the velocity at the level of rest along x, up and along z, of infinitely deep water.
    pub velocity: [[f64; 4]; 3],
    /// Wavenumber, 1/m.
    pub wavenumber: [f64; 4],
    /// e^(−2kh).
    pub bottom: [f64; 4],
}

/// Where and when, in level axes.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub x: f64,
    pub z: f64,
    pub time: f64,
}

/// Farther away and later than this (m, s) f64 has too few digits left for the phase of a wave of a millimeter.
const FAR: f64 = 1e9;

impl Place {
    /// Numbers that are NaN, or beyond [`FAR`], count as zero.
    pub fn new(x: f64, z: f64, time: f64) -> Self {
        let [x, z, time] = [x, z, time].map(|v| if v.abs() < FAR { v } else { 0.0 });
        Self { x, z, time }
    }
}

impl Four {
    /// Cosine and sine of the waves' phases.
    #[inline(always)]
    fn phase<S: Simd>(&self, simd: S, place: Place) -> [f64x4<S>; 2] {
        let [x, z, t, start] = self.turns.map(|row| f64x4::load_array(simd, row));
        cos_sin(x * place.x + z * place.z - t * place.time + start)
    }
}

/// Height and slopes of the sum of waves.
pub(super) struct Elevations<'a> {
    pub waves: &'a [Four],
    pub place: Place,
    pub sum: &'a mut [f64; 3],
}

impl OnLanes for Elevations<'_> {
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let mut sum = [f64x4::splat(simd, 0.0); 3];
        for four in self.waves {
            let [cos, sin] = four.phase(simd, self.place);
            let [a, ax, az] = four.height.map(|row| f64x4::load_array(simd, row));
            sum[0] += a * cos;
            sum[1] -= ax * sin;
            sum[2] -= az * sin;
        }
        *self.sum = sum.map(total);
    }
}

/// The highest that a wave is taken to carry its own velocity above the level at which it runs, times its wavenumber. The
/// steepest wave that stands has .443 (Stokes), so that this holds back none that stands alone.
const MOST_RISE: f64 = 0.5;

/// Velocity of the sum of waves, whose order is from long to short.
pub(super) struct Velocities<'a> {
    pub waves: &'a [Four],
    pub place: Place,
    /// Height of the point.
    pub y: f64,
    /// Height of the bottom.
    pub bottom: f64,
    pub sum: &'a mut [f64; 3],
}

impl OnLanes for Velocities<'_> {
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let mut sum = [f64x4::splat(simd, 0.0); 3];
        let deep = self.bottom == f64::NEG_INFINITY;
        // Height of the surface that the longer waves make: each wave runs on it.
        let mut level = f64x4::splat(simd, 0.0);
        for four in self.waves {
            let [cos, sin] = four.phase(simd, self.place);
            let height = f64x4::load_array(simd, four.height[0]) * cos;
            let shifted = height.shift_elements_right::<1>(0.0);
            let pairs = shifted + shifted.shift_elements_right::<1>(0.0);
            let before = pairs + pairs.shift_elements_right::<2>(0.0);
            let above = (self.y - (level + before)).max(self.bottom);
            level += total(height);

            let k = f64x4::load_array(simd, four.wavenumber);
            let decay = exponential((k * above).min(MOST_RISE));
            let [along, up] = if deep {
                [decay; 2]
            } else {
                // These are cosh k(y + h)/sinh kh and sinh k(y + h)/sinh kh.
                let q = f64x4::load_array(simd, four.bottom);
                let (growth, per) = (q / decay, 1.0 / (1.0 - q));
                [(decay + growth) * per, (decay - growth) * per]
            };
            let [x, y, z] = four.velocity.map(|row| f64x4::load_array(simd, row));
            sum[0] += x * (cos * along);
            sum[1] += y * (sin * up);
            sum[2] += z * (cos * along);
        }
        *self.sum = sum.map(total);
    }
}

#[inline(always)]
fn total<S: Simd>(four: f64x4<S>) -> f64 {
    let [a, b, c, d] = four.to_array();
    (a + b) + (c + d)
}

/// 1.5·2⁵²: f64 has no fractions here, so that a sum with it rounds to a whole number.
const WHOLE: f64 = 6_755_399_441_055_744.0;

/// Cosine and sine of 2π·`turns`, to 1e-13, for less than 2⁵⁰ turns: the series of the quarter of the angle, which is
/// doubled twice.
#[inline(always)]
fn cos_sin<S: Simd>(turns: f64x4<S>) -> [f64x4<S>; 2] {
    let rest = turns - ((turns + WHOLE) - WHOLE);
    let x = rest * core::f64::consts::FRAC_PI_2;
    let square = x * x;
    let sin = x * series(square, PER_ODD_FACTORIAL);
    let cos = series(square, PER_EVEN_FACTORIAL) * square + 1.0;
    doubled(doubled([cos, sin]))
}

/// Cosine and sine of twice the angle.
#[inline(always)]
fn doubled<S: Simd>([cos, sin]: [f64x4<S>; 2]) -> [f64x4<S>; 2] {
    let twice = sin + sin;
    [1.0 - twice * sin, twice * cos]
}

/// A polynomial, its highest power first.
#[inline(always)]
fn series<S: Simd, const N: usize>(x: f64x4<S>, coefficients: [f64; N]) -> f64x4<S> {
    let mut sum = x * coefficients[0] + coefficients[1];
    for coefficient in &coefficients[2..] {
        sum = sum * x + *coefficient;
    }
    sum
}

/// Coefficients of the series of the sine from x¹³ to x, and of the cosine from x¹⁴ to x².
const PER_ODD_FACTORIAL: [f64; 7] = [
    1.0 / 6_227_020_800.0,
    -1.0 / 39_916_800.0,
    1.0 / 362_880.0,
    -1.0 / 5040.0,
    1.0 / 120.0,
    -1.0 / 6.0,
    1.0,
];
const PER_EVEN_FACTORIAL: [f64; 7] = [
    -1.0 / 87_178_291_200.0,
    1.0 / 479_001_600.0,
    -1.0 / 3_628_800.0,
    1.0 / 40_320.0,
    -1.0 / 720.0,
    1.0 / 24.0,
    -1.0 / 2.0,
];

/// e^x for x ≤ ½, to 1e-14 of 1; below −40 it stays at 4e-18. It is the series of x/64, squared six times.
#[inline(always)]
fn exponential<S: Simd>(x: f64x4<S>) -> f64x4<S> {
    let x = x.max(-40.0) * (1.0 / 64.0);
    let mut sum = series(x, PER_FACTORIAL);
    for _ in 0..6 {
        sum *= sum;
    }
    sum
}

/// Coefficients of the series of e^x from x⁸ to 1.
const PER_FACTORIAL: [f64; 9] = [
    1.0 / 40_320.0,
    1.0 / 5040.0,
    1.0 / 720.0,
    1.0 / 120.0,
    1.0 / 24.0,
    1.0 / 6.0,
    0.5,
    1.0,
    1.0,
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{dispatch, dispatch_narrow};

    #[derive(Clone, Copy)]
    struct Functions;

    impl OnLanes for Functions {
        fn run<S: Simd>(self, simd: S) {
            for i in -4000..4000 {
                let turns = f64::from(i) * 0.012_3;
                let [cos, sin] = cos_sin(f64x4::splat(simd, turns)).map(|v| v.to_array()[0]);
                let angle = core::f64::consts::TAU * turns;
                assert!((cos - angle.cos()).abs() < 2e-13, "{turns}");
                assert!((sin - angle.sin()).abs() < 2e-13, "{turns}");
                let x = f64::from(i) * 0.01 - 39.5;
                let found = exponential(f64x4::splat(simd, x.min(0.5))).to_array()[0];
                let exact = x.clamp(-40.0, 0.5).exp();
                assert!((found - exact).abs() < 2e-14 && found > 0.0, "{x} {found}");
            }
        }
    }

    #[test]
    fn functions_are_the_librarys() {
        dispatch(Functions);
        dispatch_narrow(Functions);
    }

    /// The machine's registers change no bit.
    #[test]
    fn registers_change_no_bit() {
        let row = |seed: f64| core::array::from_fn(|i| (seed + 0.37 * i as f64).sin());
        let rows = |seed: f64| core::array::from_fn(|i| row(seed + 1.7 * i as f64));
        let waves: Vec<Four> = (0..5)
            .map(|i| Four {
                turns: core::array::from_fn(|j| row(f64::from(i) + 1.3 * j as f64)),
                height: rows(0.3 * f64::from(i)),
                velocity: rows(0.7 * f64::from(i)),
                wavenumber: row(f64::from(i)).map(f64::abs),
                bottom: row(2.0 * f64::from(i)).map(|x| 0.5 * x.abs()),
            })
            .collect();
        for i in 0..200 {
            let place = Place::new(0.3 * f64::from(i), -0.7 * f64::from(i), 1.1 * f64::from(i));
            let mut sums = [[0.0; 3]; 4];
            let [a, b, c, d] = &mut sums;
            let elevations = |sum| Elevations {
                waves: &waves,
                place,
                sum,
            };
            dispatch(elevations(a));
            dispatch_narrow(elevations(b));
            let velocities = |sum| Velocities {
                waves: &waves,
                place,
                y: -0.01 * f64::from(i),
                bottom: -1.5,
                sum,
            };
            dispatch(velocities(c));
            dispatch_narrow(velocities(d));
            let bits = sums.map(|sum| sum.map(f64::to_bits));
            assert_eq!(bits[0], bits[1]);
            assert_eq!(bits[2], bits[3]);
        }
    }
}
