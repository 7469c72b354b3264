//! How much of a sea's variance waves of each frequency hold.

use crate::error::Error;
use crate::math;
use core::f64::consts::TAU;

/// The spectrum of a wind sea, of Pierson and Moskowitz (1964) or of JONSWAP (Hasselmann et al. 1973):
/// S(ω) ∝ ω⁻⁵ exp(−1.25 (ω_p/ω)⁴) γ^r, r = exp(−(ω/ω_p − 1)²/2σ²), σ = .07 below the peak and .09 above.
///
/// ```
/// use rapier3d_immersed::free_surface::WaveSpectrum;
///
/// // 10 m/s at a height of 19.5 m, blowing for days over an ocean.
/// let ocean = WaveSpectrum::fully_developed(10.0, 9.81)?;
/// assert!((ocean.significant_height() - 2.13).abs() < 0.01 && (ocean.peak_period() - 7.3).abs() < 0.1);
/// // The same over a lake of 5 km: short and steep.
/// let lake = WaveSpectrum::fetch_limited(10.0, 5000.0, 9.81)?;
/// assert!((lake.significant_height() - 0.40).abs() < 0.01 && (lake.peak_period() - 2.3).abs() < 0.1);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WaveSpectrum {
    significant_height: f64,
    peak_period: f64,
    peakedness: f64,
    /// The density is this times its shape over ω/ω_p, m²s.
    level: f64,
}

/// The mean JONSWAP peak is this much higher than that of Pierson and Moskowitz.
const JONSWAP_PEAKEDNESS: f64 = 3.3;

/// Fetch times gravity over wind speed squared, beyond which a sea grows no more.
const GROWN: f64 = 2e4;

impl WaveSpectrum {
    /// A spectrum of γ = `peakedness` (1 is Pierson and Moskowitz's) with this significant height H_s = 4√m₀ (m), about
    /// the mean height of the highest third of the waves from trough to crest, and this period of its peak (s).
    ///
    /// # Errors
    /// If the height is negative, the period not positive, or the peakedness outside of 1 to 20.
    pub fn jonswap(
        significant_height: f64,
        peak_period: f64,
        peakedness: f64,
    ) -> Result<Self, Error> {
        Error::check_not_negative("significant_height", significant_height)?;
        Error::check_positive("peak_period", peak_period)?;
        Error::check_range("peakedness", peakedness, 1.0, 20.0)?;
        let variance = significant_height.powi(2) / 16.0;
        Ok(Self {
            significant_height,
            peak_period,
            peakedness,
            level: variance / integral(peakedness) * peak_period / TAU,
        })
    }

    /// The spectrum of Pierson and Moskowitz: [`jonswap`](Self::jonswap) of peakedness 1.
    ///
    /// # Errors
    /// Those of [`jonswap`](Self::jonswap).
    pub fn pierson_moskowitz(significant_height: f64, peak_period: f64) -> Result<Self, Error> {
        Self::jonswap(significant_height, peak_period, 1.0)
    }

    /// The sea of an ocean over which a wind of this speed at a height of 19.5 m (m/s) has blown for long, Pierson and
    /// Moskowitz (1964): S = .0081 g²ω⁻⁵ exp(−.74 (g/Uω)⁴). `gravity` in m/s².
    ///
    /// # Errors
    /// If speed or gravity is not positive.
    pub fn fully_developed(wind: f64, gravity: f64) -> Result<Self, Error> {
        Error::check_positive("wind", wind)?;
        Error::check_positive("gravity", gravity)?;
        let height = 2.0 * wind * wind / gravity * (0.0081_f64 / 0.74).sqrt();
        let peak = math::powf(0.8 * 0.74_f64, 0.25) * gravity / wind;
        Self::pierson_moskowitz(height, TAU / peak)
    }

    /// The sea that a wind of this speed at a height of 10 m (m/s) raises on water that reaches this far upwind (m),
    /// Hasselmann et al. (1973): α = .076 (U²/gF)^.22, ω_p = 22 (g²/UF)^⅓, γ = 3.3. A fetch beyond 20,000 U²/g counts as
    /// that. `gravity` in m/s².
    ///
    /// # Errors
    /// If speed, fetch or gravity is not positive.
    pub fn fetch_limited(wind: f64, fetch: f64, gravity: f64) -> Result<Self, Error> {
        Error::check_positive("wind", wind)?;
        Error::check_positive("fetch", fetch)?;
        Error::check_positive("gravity", gravity)?;
        let reduced = (fetch * gravity / (wind * wind)).min(GROWN);
        let peak = 22.0 * gravity / wind * math::powf(reduced, -1.0 / 3.0);
        let alpha = 0.076 * math::powf(reduced, -0.22);
        let variance = alpha * gravity.powi(2) / peak.powi(4) * integral(JONSWAP_PEAKEDNESS);
        Self::jonswap(4.0 * variance.sqrt(), TAU / peak, JONSWAP_PEAKEDNESS)
    }

    /// H_s = 4√m₀, m.
    pub fn significant_height(&self) -> f64 {
        self.significant_height
    }

    /// Period of the spectrum's peak, s.
    pub fn peak_period(&self) -> f64 {
        self.peak_period
    }

    /// S(ω), m²s: variance per angular frequency (rad/s), one-sided.
    pub fn density(&self, frequency: f64) -> f64 {
        let x = frequency * self.peak_period / TAU;
        if x <= 0.0 {
            return 0.0;
        }
        self.level * x.powi(-5) * math::exp(-1.25 * x.powi(-4)) * peak(x, self.peakedness)
    }

    /// The moment mₙ = ∫ ωⁿ S dω between two positive frequencies, m²/sⁿ: m₀ is the variance, 2π√(m₀/m₂) the mean period
    /// between zero upcrossings.
    pub fn moment(&self, order: i32, from: f64, to: f64) -> f64 {
        let span = math::ln(to / from);
        let steps = 2 * (span.abs() / 0.004).ceil().max(4.0) as usize;
        let step = span / steps as f64;
        let value = |i: usize| {
            let frequency = from * math::exp(step * i as f64);
            frequency.powi(order + 1) * self.density(frequency)
        };
        simpson(steps, step, value)
    }
}

/// What raises the peak of a JONSWAP spectrum, at ω/ω_p = `x`.
fn peak(x: f64, peakedness: f64) -> f64 {
    let width = if x < 1.0 { 0.07 } else { 0.09 };
    math::powf(peakedness, math::exp(-0.5 * ((x - 1.0) / width).powi(2)))
}

/// ∫₀^∞ x⁻⁵ exp(−1.25 x⁻⁴) γ^r dx = ¼∫₀^∞ exp(−1.25 u) γ^r du with u = x⁻⁴: ⅕ for γ = 1.
fn integral(peakedness: f64) -> f64 {
    let (steps, step) = (3200, 0.01);
    let value = |i: usize| {
        let u = step * i as f64;
        math::exp(-1.25 * u) * peak(math::powf(u, -0.25), peakedness)
    };
    simpson(steps, step, value) / 4.0
}

/// Simpson's rule over an even number of steps.
fn simpson(steps: usize, step: f64, value: impl Fn(usize) -> f64) -> f64 {
    let sum = |from: usize, to: usize| (from..to).step_by(2).map(&value).sum::<f64>();
    let ends = value(0) + value(steps);
    (ends + 4.0 * sum(1, steps) + 2.0 * sum(2, steps)) * step / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// m₀ = H_s²/16; and the form that the two papers print, with α in place of H_s.
    #[test]
    fn densities_are_the_papers() {
        for (height, period, peakedness) in [(2.0, 8.0, 1.0), (3.0, 9.0, 3.3), (0.4, 2.0, 7.0)] {
            let sea = WaveSpectrum::jonswap(height, period, peakedness).unwrap();
            let variance = sea.moment(0, 0.3 * TAU / period, 40.0 * TAU / period);
            assert!(
                (variance * 16.0 / (height * height) - 1.0).abs() < 1e-5,
                "{variance}"
            );
        }
        let (wind, g) = (12.0, 9.81);
        let sea = WaveSpectrum::fully_developed(wind, g).unwrap();
        for omega in [0.5, 0.717, 1.0, 3.0] {
            let f: f64 = g / (wind * omega);
            let printed = 0.0081 * g * g * f64::powi(omega, -5) * (-0.74 * f.powi(4)).exp();
            assert!((sea.density(omega) / printed - 1.0).abs() < 1e-9);
        }
        let fetch: f64 = 30e3;
        let sea = WaveSpectrum::fetch_limited(wind, fetch, g).unwrap();
        let alpha = 0.076 * (wind * wind / (fetch * g)).powf(0.22);
        let omega = 22.0 * (g * g / (wind * fetch)).cbrt();
        let printed = 3.3 * alpha * g * g * omega.powi(-5) * (-1.25_f64).exp();
        assert!((sea.density(omega) / printed - 1.0).abs() < 1e-9);
        let tail = alpha * g * g * (4.0 * omega).powi(-5) * (-1.25_f64 / 256.0).exp();
        assert!((sea.density(4.0 * omega) / tail - 1.0).abs() < 1e-9);
        // Other moments of the closed form: m₂/m₀ = √(1.25π) ω_p² for γ = 1.
        let sea = WaveSpectrum::pierson_moskowitz(1.0, TAU).unwrap();
        let exact = (1.25 * core::f64::consts::PI).sqrt() / 16.0;
        let cut = sea.moment(2, 0.3, 1000.0);
        assert!((cut / exact - 1.0).abs() < 1e-5, "{cut} {exact}");
    }

    #[test]
    fn impossible_spectra_are_named() {
        let starts = |spectrum: Result<WaveSpectrum, Error>, name: &str| {
            assert!(
                spectrum.unwrap_err().to_string().starts_with(name),
                "{name}"
            );
        };
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            starts(WaveSpectrum::pierson_moskowitz(1.0, bad), "peak_period");
            starts(WaveSpectrum::fully_developed(bad, 9.81), "wind");
            starts(WaveSpectrum::fully_developed(5.0, bad), "gravity");
            starts(WaveSpectrum::fetch_limited(bad, 1e4, 9.81), "wind");
            starts(WaveSpectrum::fetch_limited(5.0, bad, 9.81), "fetch");
            starts(WaveSpectrum::fetch_limited(5.0, 1e4, bad), "gravity");
            starts(WaveSpectrum::jonswap(1.0, 5.0, bad), "peakedness");
        }
        starts(
            WaveSpectrum::pierson_moskowitz(-1.0, 5.0),
            "significant_height",
        );
        starts(
            WaveSpectrum::pierson_moskowitz(f64::NAN, 5.0),
            "significant_height",
        );
        let calm = WaveSpectrum::pierson_moskowitz(0.0, 5.0).unwrap();
        assert_eq!(calm.density(1.0), 0.0);
        assert_eq!(calm.density(0.0), 0.0);
    }
}
