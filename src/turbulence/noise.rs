//! Random numbers: every body has a stream of its own.

use crate::math::Scalar;
use rapier3d::math::{Real, Vector};

/// The Gaussian noise of one body: a pure function of (seed, body, step, draw).
///
/// Nothing is stored but a key, so that the order in which bodies are stepped, the number of threads, and
/// saving and restoring cannot change what a body draws.
///
/// ```
/// use rapier3d_immersed::turbulence::NoiseStream;
///
/// let noise = NoiseStream::new(7, 42);
/// assert_eq!(noise.vector(5, 0), NoiseStream::new(7, 42).vector(5, 0));
/// assert_ne!(noise.vector(5, 0), noise.vector(6, 0));
/// let mean: f32 = (0..10_000).map(|step| noise.vector(step, 0).x).sum::<f32>() / 10_000.0;
/// assert!(mean.abs() < 0.04); // four standard errors
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct NoiseStream {
    key: u64,
}

/// Finalizer of SplitMix64 (Steele, Lea & Flood 2014): every input bit changes every output bit.
#[inline(always)]
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// 2⁶⁴ over the golden ratio: neighboring counters land far apart.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

impl NoiseStream {
    /// The stream of the body with number `body` (any number that stays with it) under `seed`.
    #[inline]
    pub fn new(seed: u64, body: u64) -> Self {
        let key = mix(seed.wrapping_add(GOLDEN)) ^ body.wrapping_mul(GOLDEN);
        Self {
            key: mix(key.wrapping_add(1)),
        }
    }

    /// Three independent standard Gaussian numbers for time step `step`. Different `draw`s of one
    /// step are independent: the thesis's mode needs two.
    #[inline]
    pub fn vector(&self, step: u64, draw: u32) -> Vector {
        Vector::from_array(gaussian(self.uniform(step, draw)))
    }

    /// Four independent uniform numbers in the ranges that [`gaussian`] takes.
    #[inline(always)]
    pub(crate) fn uniform(&self, step: u64, draw: u32) -> [Real; 4] {
        let counter = step.wrapping_mul(GOLDEN).wrapping_add(u64::from(draw));
        let low = mix(self.key ^ counter);
        let high = mix(low.wrapping_add(self.key));
        /// The spacing of 32-bit numbers that fill a range of one.
        const UNIT: Real = 1.0 / 4_294_967_296.0;
        let positive = |bits: u64| ((bits >> 32) as u32 as Real + 0.5) * UNIT;
        let turn = |bits: u64| bits as u32 as i32 as Real * UNIT;
        [positive(low), turn(low), positive(high), turn(high)]
    }
}

/// Three independent standard Gaussian numbers from numbers that are uniform in (0, 1], [−½, ½], (0, 1]
/// and [−½, ½] (Box & Muller 1958): √(−2 ln a) at the angle of `b` turns. It takes basic operations only, so
/// that the bits are the same on every platform and in every lane. The largest that 32 bits can make is 6.8.
#[inline(always)]
pub(crate) fn gaussian<T: Scalar>([a, b, c, d]: [T; 4]) -> [T; 3] {
    // The root is real, as ln a ≤ 0 for a ≤ 1. Sines are those of half the angle, so that no sign has to be
    // chosen.
    let first = (a.constant(-2.0) * a.ln()).sqrt();
    let second = (c.constant(-2.0) * c.ln()).sqrt();
    let (half, one, two) = (a.constant(0.5), a.constant(1.0), a.constant(2.0));
    let (b, d) = (b * half, d * half);
    let (sine, other) = (sine_of_turns(b), sine_of_turns(d));
    let cosine = sine_of_turns(a.constant(0.25) - b.abs());
    [
        first * (one - two * sine * sine),
        first * (two * sine * cosine),
        second * (one - two * other * other),
    ]
}

/// sin 2πx for |x| ≤ ¼, to 1e-7, by six terms of the series.
#[inline(always)]
fn sine_of_turns<T: Scalar>(x: T) -> T {
    let angle = x * x.constant(std::f64::consts::TAU);
    let (square, one) = (angle * angle, x.constant(1.0));
    let mut sum = one;
    for n in [110.0, 72.0, 42.0, 20.0, 6.0] {
        sum = one - square * x.constant(1.0 / n) * sum;
    }
    angle * sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_are_standard_normal_and_independent() {
        let n = 200_000u64;
        let mut sums = [0.0f64; 8];
        let streams = [NoiseStream::new(1, 7), NoiseStream::new(1, 8)];
        let mut tail = 0;
        let mut last = 0.0;
        for step in 0..n {
            let a = streams[0].vector(step, 0);
            let (x, y) = (f64::from(a.x), f64::from(a.y));
            let next_draw = f64::from(streams[0].vector(step, 1).x);
            let neighbor = f64::from(streams[1].vector(step, 0).x);
            for (sum, value) in sums.iter_mut().zip([
                x,
                x * x - 1.0,
                x.powi(3),
                x.powi(4) - 3.0,
                x * y,
                x * next_draw,
                x * neighbor,
                x * last,
            ]) {
                *sum += value;
            }
            tail += u32::from(x.abs() > 3.0);
            last = x;
        }
        // The tolerance is 4.5 standard deviations of x, x², x³, x⁴ and of the products, over √n.
        let deviations = [
            1.0,
            2.0f64.sqrt(),
            15.0f64.sqrt(),
            96.0f64.sqrt(),
            1.0,
            1.0,
            1.0,
            1.0,
        ];
        for (i, (sum, deviation)) in sums.iter().zip(deviations).enumerate() {
            let z = sum / (n as f64).sqrt() / deviation;
            assert!(z.abs() < 4.5, "moment {i}: {z} standard errors");
        }
        // P(|x| > 3) = .0026998
        let expected = 0.002_699_8 * n as f64;
        assert!((f64::from(tail) - expected).abs() < 4.5 * expected.sqrt());
    }

    #[test]
    fn turns_have_their_sines_and_logarithms_their_ends() {
        for i in -1000..=1000 {
            let x = 0.25e-3 * i as f32;
            let exact = (std::f64::consts::TAU * f64::from(x)).sin();
            assert!((f64::from(sine_of_turns(x)) - exact).abs() < 2.0e-7, "{x}");
        }
        // Every eighth of the turn is tried, with the signs and sizes that it should have.
        for i in -4..=4 {
            let turns = i as f32 * 0.125;
            let [x, y, _] = gaussian([0.5, turns, 1.0, 0.0]);
            let radius = (2.0 * 2.0f32.ln()).sqrt();
            let (sine, cosine) = (std::f32::consts::TAU * turns).sin_cos();
            assert!((x - radius * cosine).abs() < 1.0e-6, "{turns}: {x}");
            assert!((y - radius * sine).abs() < 1.0e-6, "{turns}: {y}");
        }
        let unit = 1.0 / 4_294_967_296.0;
        let [x, _, z] = gaussian([0.5 * unit, 0.0, 1.0, 0.5f32]);
        assert!((x - 6.764).abs() < 1.0e-3 && z == 0.0, "{x} {z}");
    }

    /// The bits are pinned, because a body's noise is part of what a saved simulation means.
    #[test]
    fn noise_is_a_pure_function_of_its_arguments() {
        let stream = NoiseStream::new(42, 3);
        assert_eq!(stream.vector(17, 0), NoiseStream::new(42, 3).vector(17, 0));
        assert_ne!(stream.vector(17, 0), stream.vector(18, 0));
        assert_ne!(stream.vector(17, 0), stream.vector(17, 1));
        assert_ne!(stream.vector(17, 0), NoiseStream::new(43, 3).vector(17, 0));
        assert_ne!(stream.vector(17, 0), NoiseStream::new(42, 4).vector(17, 0));
    }
}
