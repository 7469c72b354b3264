//! One random stream per body.

use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;
use rapier3d::math::{Real, Vector};

/// The Gaussian noise of one body: a pure function of (seed, body, step, draw).
///
/// Nothing is stored but a key, so that the order in which bodies are stepped, the number of threads, and saving
/// and restoring cannot change what a body draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct NoiseStream {
    key: u64,
}

/// Finalizer of SplitMix64 (Steele, Lea & Flood 2014): every input bit changes every output bit.
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// 2⁶⁴ over the golden ratio: neighboring counters land far apart.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

impl NoiseStream {
    /// The stream of the body with number `body` (any number that stays with it) under `seed`.
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
        let counter = step.wrapping_mul(GOLDEN).wrapping_add(u64::from(draw));
        let low = mix(self.key ^ counter);
        let high = mix(low.wrapping_add(self.key));
        let mut random = Pcg64Mcg::new(u128::from(high) << 64 | u128::from(low));
        let mut normal = || -> Real { StandardNormal.sample(&mut random) };
        Vector::new(normal(), normal(), normal())
    }
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
        // Standard deviations of x, x², x³, x⁴ and of the products, over √n; 4.5 of them.
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

    /// Pinned bits: a body's noise is part of what a saved simulation means.
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
