//! How wide a fall swings, and how far from below its release it lands (thesis § 3.3.5).

use crate::error::Error;
use crate::math;
use crate::motion::{FallEstimates, Regime};
use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

/// Where falls land: a distance ∝ exp(−((r − B)/C)²) per unit of height, scaled by kL/a, along the
/// heading; and beside it, if that is asked for.
///
/// The thesis takes the form from thousands of falls of paper (Razavi 2010) without printing k, B or C.
/// [`Deviation::of`] has what was estimated; a public data set of Czech coins in a tank of water
/// (38 × 32 × 38 cm) has medians of 12 to 16 cm, which no test holds ours to.
///
/// ```
/// use rapier3d_immersed::motion::path::Deviation;
///
/// // A coin (L = a) that lands 0.3 of its height away from below its release: from 2 m, 0.6 m.
/// let deviation = Deviation { coefficient: 1.0, mean: 0.3, width: 0.15, across: 0.0 };
/// assert!((deviation.distance(1.0, 2.0) - 0.6).abs() < 1e-12);
/// let calm = Deviation { coefficient: 0.5, ..deviation };
/// assert!((calm.distance(1.0, 2.0) - 0.3).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Deviation {
    /// k: deviation coefficient, 1 if B and C are those of the body.
    pub coefficient: f64,
    /// B: mean, per unit of height.
    pub mean: f64,
    /// C: width, √2 standard deviations, per unit of height.
    pub width: f64,
    /// Width across the heading, about a mean of 0: 0 in the thesis, whose falls are plane unless they circle.
    pub across: f64,
}

impl Deviation {
    /// The deviation of a regime, estimated with k = 1 and L = a ([`FallEstimates`]): of chaotic and tumbling
    /// motion from tracked falls of paper from 1 m (B = .33 and .61), of the others, which no tracks show,
    /// from this crate's own falls of discs by 130 diameters, which hardly deviate (.006 to .05). The helix,
    /// which neither shows, has that of the spiral, a convention.
    ///
    /// Own falls that tumble have B = .40, and chaotic ones .04: those turn back so often that their distance
    /// does not grow with the height, as (3.9) has it.
    pub fn of(regime: Regime) -> Self {
        let estimates = FallEstimates::shipped();
        Self {
            coefficient: 1.0,
            mean: estimates.deviation("deviation_mean", regime),
            width: estimates.deviation("deviation_width", regime),
            across: 0.0,
        }
    }

    /// # Errors
    /// [`Error::InvalidParameter`] names a value that is negative or not finite.
    pub fn check(&self) -> Result<(), Error> {
        Error::check_not_negative("deviation coefficient", self.coefficient)?;
        Error::check_not_negative("mean deviation", self.mean)?;
        Error::check_not_negative("width of the deviation", self.width)?;
        Error::check_not_negative("width across the heading", self.across)?;
        Ok(())
    }

    /// D = k B (L/a) h, m: mean distance of the landing, for an object of length L and cross-section
    /// length a from height h, thesis (3.9) with the h that it lacks.
    pub fn distance(&self, aspect: f64, height: f64) -> f64 {
        self.coefficient * self.mean * aspect * height
    }

    /// Standard deviation of the landing distance, m: kC(L/a)h/√2.
    pub fn spread(&self, aspect: f64, height: f64) -> f64 {
        self.coefficient * self.width * aspect * height * std::f64::consts::FRAC_1_SQRT_2
    }

    /// Standard deviation of the landing across the heading, m.
    pub fn spread_across(&self, aspect: f64, height: f64) -> f64 {
        self.coefficient * self.across * aspect * height * std::f64::consts::FRAC_1_SQRT_2
    }

    /// A_0 = D U/(hΩ), m: amplitude of the oscillation (3.10). It does not depend on the height. No fall swings
    /// so: the flutters of this crate, whose D is a hundredth of h, swing fifty times as wide
    /// ([`SynthesisParams::swing`](super::SynthesisParams::swing)).
    pub fn amplitude(&self, aspect: f64, descent: f64, frequency: f64) -> f64 {
        self.distance(aspect, 1.0) * descent / frequency
    }

    /// Where a fall lands that is `normal` standard deviations off the mean along the heading and to its
    /// right, m (negative is behind the release).
    pub fn landing(&self, aspect: f64, height: f64, normal: [f64; 2]) -> [f64; 2] {
        [
            self.distance(aspect, height) + self.spread(aspect, height) * normal[0],
            self.spread_across(aspect, height) * normal[1],
        ]
    }
}

/// Two standard normal numbers.
pub(super) fn normals(random: &mut impl Rng) -> [f64; 2] {
    [StandardNormal.sample(random), StandardNormal.sample(random)]
}

/// The smallest [`chaotic_factor`].
pub(super) const SMALLEST_FACTOR: f64 = 0.1;

/// r ∈ [0.1, 10], by which a chaotic segment is larger than a regular one (thesis § 3.3.5). Normal in
/// log₁₀ r, standard deviation ⅓, drawn again beyond the ends: the thesis names Box–Muller and the
/// range only. It is a factor on lengths and times in the glide plane; the vertical oscillation about a
/// steady descent is never larger than in a regular segment.
pub(super) fn chaotic_factor(random: &mut impl Rng) -> f64 {
    loop {
        let normal: f64 = StandardNormal.sample(random);
        if normal.abs() <= 3.0 {
            return math::powf(10f64, normal / 3.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_pcg::Pcg64Mcg;

    /// (3.9) and (3.10) by hand: k = 2, B = .1, L/a = 4, h = 3, U = .8, Ω = 5.
    #[test]
    fn formulas() {
        let deviation = Deviation {
            coefficient: 2.0,
            mean: 0.1,
            width: 0.05,
            across: 0.02,
        };
        assert!((deviation.distance(4.0, 3.0) - 2.4).abs() < 1e-12);
        assert!((deviation.amplitude(4.0, 0.8, 5.0) - 2.4 * 0.8 / (3.0 * 5.0)).abs() < 1e-12);
        // The density exp(−(r/C)²) has the standard deviation C/√2.
        assert!((deviation.spread(4.0, 3.0) - 1.2 / 2f64.sqrt()).abs() < 1e-12);
        assert!((deviation.spread_across(4.0, 3.0) - 0.48 / 2f64.sqrt()).abs() < 1e-12);
    }

    /// The mean of 10 000 draws is within 5 standard errors, their spread too (relative error 1/√2n).
    #[test]
    fn landings_are_normal() {
        let deviation = Deviation {
            coefficient: 1.0,
            mean: 0.3,
            width: 0.15,
            across: 0.0,
        };
        let mut random = Pcg64Mcg::seed_from_u64(2);
        let draws: Vec<f64> = (0..10_000)
            .map(|_| deviation.landing(1.0, 2.0, normals(&mut random))[0])
            .collect();
        let mean = draws.iter().sum::<f64>() / 1e4;
        let spread = (draws.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / 1e4).sqrt();
        let asked = deviation.spread(1.0, 2.0);
        assert!((mean - 0.6).abs() < 5.0 * asked / 100.0);
        assert!((spread / asked - 1.0).abs() < 5.0 / (2e4f64).sqrt());
    }

    #[test]
    fn chaotic_factors_stay_in_range() {
        let mut random = Pcg64Mcg::seed_from_u64(2);
        let draws: Vec<f64> = (0..10_000).map(|_| chaotic_factor(&mut random)).collect();
        assert!(draws.iter().all(|r| (0.1..=10.0).contains(r)));
        // Normal in the logarithm to the base of ten with a deviation of ⅓, without what is beyond three of
        // them: the distribution function, Φ(z) less Φ(−3), from its table. Counts are binomial; five
        // standard deviations.
        for (deviations, below) in [
            (-2.0, 0.0214),
            (-1.0, 0.1573),
            (0.0, 0.4987),
            (1.0, 0.8400),
            (2.0, 0.9759),
        ] {
            let limit = 10f64.powf(deviations / 3.0);
            let count = draws.iter().filter(|r| **r < limit).count() as f64;
            let share = below / 0.9973;
            let off = (count - 1e4 * share).abs();
            let deviation = (1e4 * share * (1.0 - share)).sqrt();
            assert!(off < 5.0 * deviation, "{deviations}: {count}");
        }
    }
}
