//! Random seas of a spectrum.

use super::{Dispersion, Wave, WaveSpectrum, Waves};
use crate::error::Error;
use crate::math;
use core::f64::consts::{PI, TAU};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// The parameters of [`Waves::sea`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sea {
    /// How high and long the waves are. Default: JONSWAP's of 1 m and 5 s.
    pub spectrum: WaveSpectrum,
    /// Along x and z, where the waves run to in the mean; of any length but zero. Default x.
    pub direction: [f64; 2],
    /// How the energy spreads over the angles θ to the mean direction: as cos²ˢ(θ/2), s = `spreading`. Zero spreads it over
    /// all directions, infinity gives long crests. Goda takes 10 for wind seas and 25 to 75 for swell. Default 10.
    pub spreading: f64,
    /// Number of waves. The cost grows with it, and the sea repeats itself less. Default 64.
    pub waves: usize,
    /// Highest frequency over that of the peak. Waves beyond are left out, which hold .5 % of the energy at the default of
    /// 4, and the others share it. Their number would be better spent elsewhere, and small bodies feel the steepness of the
    /// shortest: it grows with the logarithm of this.
    pub cutoff: f64,
    /// Depth and gravity. The spectrum's density is taken as it is in any depth.
    pub dispersion: Dispersion,
    /// Seed of phases, directions and frequencies. Default 0.
    pub seed: u64,
}

impl Default for Sea {
    fn default() -> Self {
        Self {
            spectrum: WaveSpectrum::jonswap(1.0, 5.0, 3.3).expect("a sea that there is"),
            direction: [1.0, 0.0],
            spreading: 10.0,
            waves: 64,
            cutoff: 4.0,
            dispersion: Dispersion::default(),
            seed: 0,
        }
    }
}

/// Frequency over the peak's below which there is nothing: 10⁻⁸ of the energy of a spectrum of Pierson and Moskowitz.
const LOWEST: f64 = 0.5;

/// Significant height over the length of the waves of the peak (times tanh kh), beyond which the whole sea would break.
const STEEPEST: f64 = 0.14;

/// Highest crest over significant height: a crest of 8 standard deviations is one in 10¹³.
const HIGHEST: f64 = 2.0;

impl Waves {
    /// A random sea: each wave has the energy of one band of frequencies (amplitudes are not random, so that the variance
    /// of every sea is H_s²/16; bands are equally wide in the logarithm, so that no period repeats it), a random frequency in it,
    /// a random phase, and a direction of its own.
    ///
    /// It is taken to be no higher than 2 H_s, though a conspiracy of all waves would be.
    ///
    /// ```
    /// use rapier3d_immersed::free_surface::{FreeSurface, Sea, WaveSpectrum, Waves};
    ///
    /// let spectrum = WaveSpectrum::jonswap(2.0, 7.0, 3.3)?;
    /// let sea = Waves::sea(&Sea { spectrum, seed: 7, ..Sea::default() })?;
    /// let heights = (0..20_000).map(|i| sea.elevation(0.0, 0.0, f64::from(i)).height);
    /// let variance = heights.map(|height| height * height).sum::<f64>() / 20_000.0;
    /// assert!((4.0 * variance.sqrt() - 2.0).abs() < 0.05);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    ///
    /// # Errors
    /// If the sea is so steep that it would break as a whole (H_s above .14 of the length of the peak's waves, or of
    /// .14 tanh kh of it), the direction zero, the spreading negative, the number of waves not from 1 to 10,000, the cutoff
    /// not from 1.1 to 30; and those of [`Waves::new`].
    pub fn sea(sea: &Sea) -> Result<Self, Error> {
        sea.dispersion.check()?;
        let height = sea.spectrum.significant_height();
        let peak = TAU / sea.spectrum.peak_period();
        let k = sea.dispersion.wavenumber(peak);
        let most = STEEPEST * TAU / k * math::tanh(k * sea.dispersion.depth);
        Error::check_range(
            "significant_height of a sea that does not break",
            height,
            0.0,
            most,
        )?;
        let requirement = "zero or positive (infinite for long crests)";
        Error::check(
            "spreading",
            sea.spreading,
            sea.spreading >= 0.0,
            requirement,
        )?;
        Error::check_range("number of waves", sea.waves as f64, 1.0, 1e4)?;
        Error::check_range("cutoff", sea.cutoff, 1.1, 30.0)?;

        let mut random = Pcg64Mcg::seed_from_u64(sea.seed);
        let mut uniform = || random.random::<f64>();
        let (lowest, highest) = (LOWEST * peak, sea.cutoff * peak);
        let shares = height * height / 16.0 / sea.spectrum.moment(0, lowest, highest);
        let spread = Spread::new(sea.spreading);
        let first = uniform();
        let waves = (0..sea.waves).map(|i| {
            let at = |i: f64| lowest * math::powf(highest / lowest, i / sea.waves as f64);
            let energy = sea.spectrum.moment(0, at(i as f64), at(i as f64 + 1.0));
            let frequency = at(i as f64 + uniform());
            // Multiples of the golden section fill the directions evenly, however many follow each other.
            let angle = spread.angle((first + i as f64 * GOLDEN) % 1.0);
            let ([x, z], (sin, cos)) = (sea.direction, math::sin_cos(angle));
            Wave {
                amplitude: if height > 0.0 {
                    (2.0 * shares * energy).sqrt()
                } else {
                    0.0
                },
                wavelength: TAU / sea.dispersion.wavenumber(frequency),
                direction: [x * cos - z * sin, z * cos + x * sin],
                phase: TAU * uniform(),
            }
        });
        let waves: Vec<Wave> = waves.collect();
        Ok(Self::new(sea.dispersion, &waves)?.bounded(HIGHEST * height))
    }
}

/// ½(√5 − 1).
const GOLDEN: f64 = 0.618_033_988_749_895;

/// The angle below which each share of the energy lies.
struct Spread {
    step: f64,
    below: Vec<f64>,
}

impl Spread {
    fn new(spreading: f64) -> Self {
        const STEPS: usize = 2000;
        // Where cos²ˢ(θ/2) is narrow it is a normal distribution of variance 2/s.
        let reach = (8.0 * (2.0 / spreading).sqrt()).min(PI);
        let step = 2.0 * reach / STEPS as f64;
        let density = |i: usize| {
            let cos = math::cos(0.5 * step * (i as f64 + 0.5 - STEPS as f64 / 2.0));
            if cos < 1.0 {
                math::powf(cos, 2.0 * spreading)
            } else {
                1.0
            }
        };
        let mut below = vec![0.0; STEPS + 1];
        for i in 0..STEPS {
            below[i + 1] = below[i] + density(i);
        }
        Self { step, below }
    }

    fn angle(&self, share: f64) -> f64 {
        let steps = self.below.len() - 1;
        let wanted = share * self.below[steps];
        let i = self
            .below
            .partition_point(|below| *below <= wanted)
            .clamp(1, steps);
        let (low, high) = (self.below[i - 1], self.below[i]);
        let within = if high > low {
            (wanted - low) / (high - low)
        } else {
            0.5
        };
        self.step * (i as f64 - 1.0 + within - steps as f64 / 2.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first two moments of cos²ˢ(θ/2): ⟨cos θ⟩ = s/(s + 1), ⟨cos 2θ⟩ = s(s − 1)/((s + 1)(s + 2)) (Longuet-Higgins,
    /// Cartwright and Smith 1963).
    #[test]
    fn angles_spread_as_asked() {
        for s in [0.0, 1.0, 2.5, 10.0, 75.0, 1e4, 1e12] {
            let spread = Spread::new(s);
            let angles: Vec<f64> = (0..10_000)
                .map(|i| spread.angle((f64::from(i) + 0.5) / 1e4))
                .collect();
            assert!(angles.windows(2).all(|pair| pair[0] <= pair[1]));
            let mean = |of: &dyn Fn(f64) -> f64| angles.iter().map(|a| of(*a)).sum::<f64>() / 1e4;
            let first = s / (s + 1.0);
            let second = s * (s - 1.0) / ((s + 1.0) * (s + 2.0));
            assert!((mean(&|a| a.cos()) - first).abs() < 1e-4, "{s}");
            assert!((mean(&|a| (2.0 * a).cos()) - second).abs() < 3e-4, "{s}");
            assert!(mean(&|a| a.sin()).abs() < 1e-9, "{s}");
        }
        let spread = Spread::new(f64::INFINITY);
        assert!([0.0, 0.3, 0.999_999].map(|share| spread.angle(share)) == [0.0; 3]);
    }

    #[test]
    fn impossible_seas_are_named() {
        let error = |change: &dyn Fn(&mut Sea)| {
            let mut sea = Sea::default();
            change(&mut sea);
            Waves::sea(&sea).unwrap_err().to_string()
        };
        // Waves of 5 s are 39.03 m long.
        let steep = |height| WaveSpectrum::pierson_moskowitz(height, 5.0).unwrap();
        assert!(error(&|sea| sea.spectrum = steep(5.5)).starts_with("significant_height"));
        assert!(
            Waves::sea(&Sea {
                spectrum: steep(5.4),
                ..Sea::default()
            })
            .is_ok()
        );
        assert!(error(&|sea| sea.dispersion.depth = 1.0).starts_with("significant_height"));
        assert!(error(&|sea| sea.dispersion.depth = f64::NAN).starts_with("depth"));
        assert!(error(&|sea| sea.dispersion.gravity = 0.0).starts_with("gravity"));
        assert!(error(&|sea| sea.direction = [0.0; 2]).contains("direction"));
        assert!(error(&|sea| sea.direction = [f64::NAN, 1.0]).contains("direction"));
        assert!(error(&|sea| sea.spreading = -1.0).starts_with("spreading"));
        assert!(error(&|sea| sea.spreading = f64::NAN).starts_with("spreading"));
        assert!(error(&|sea| sea.waves = 0).starts_with("number of waves"));
        assert!(error(&|sea| sea.waves = 10_001).starts_with("number of waves"));
        assert!(error(&|sea| sea.cutoff = 1.0).starts_with("cutoff"));
        assert!(error(&|sea| sea.cutoff = f64::NAN).starts_with("cutoff"));
        // A calm is none.
        use crate::free_surface::FreeSurface;
        assert!(
            Waves::sea(&Sea {
                spectrum: steep(0.0),
                ..Sea::default()
            })
            .unwrap()
            .is_still()
        );
    }
}
