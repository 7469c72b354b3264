//! How long and how fast linear waves are on water of a depth.

use crate::error::Error;
use crate::math;

/// Linear gravity waves on water of one depth: ω² = gk tanh kh.
///
/// ```
/// use rapier3d_immersed::free_surface::Dispersion;
///
/// let sea = Dispersion::default(); // deep, 9.81 m/s²
/// assert!((sea.wavelength(8.0)? - 99.9).abs() < 0.1); // gT²/2π
/// let beach = Dispersion { depth: 1.0, ..sea };
/// assert!((beach.wavelength(8.0)? - 24.7).abs() < 0.1); // nearly T√(gh)
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dispersion {
    /// Depth of the water at rest, m. Default infinite.
    pub depth: f64,
    /// Acceleration of gravity, m/s². Default 9.81.
    pub gravity: f64,
}

impl Default for Dispersion {
    fn default() -> Self {
        Self {
            depth: f64::INFINITY,
            gravity: 9.81,
        }
    }
}

impl Dispersion {
    pub(super) fn check(&self) -> Result<(), Error> {
        Error::check_positive("gravity", self.gravity)?;
        let requirement = "positive (infinite for deep water)";
        Error::check("depth", self.depth, self.depth > 0.0, requirement)?;
        Ok(())
    }

    /// Period of waves of this length (m), s.
    ///
    /// # Errors
    /// If the length, the depth or gravity is not positive.
    pub fn period(&self, wavelength: f64) -> Result<f64, Error> {
        self.check()?;
        Error::check_positive("wavelength", wavelength)?;
        let wavenumber = core::f64::consts::TAU / wavelength;
        Ok(core::f64::consts::TAU / self.frequency(wavenumber))
    }

    /// Length of waves of this period (s), m.
    ///
    /// # Errors
    /// If the period, the depth or gravity is not positive.
    pub fn wavelength(&self, period: f64) -> Result<f64, Error> {
        self.check()?;
        Error::check_positive("period", period)?;
        let frequency = core::f64::consts::TAU / period;
        Ok(core::f64::consts::TAU / self.wavenumber(frequency))
    }

    /// Angular frequency ω of the wavenumber k, both positive.
    pub(super) fn frequency(&self, wavenumber: f64) -> f64 {
        (self.gravity * wavenumber * math::tanh(wavenumber * self.depth)).sqrt()
    }

    /// Wavenumber k of the angular frequency ω, both positive: Newton's method for x = kh.
    pub(super) fn wavenumber(&self, frequency: f64) -> f64 {
        let deep = frequency * frequency / self.gravity;
        let y = deep * self.depth;
        // No wave tells deeper water than this from infinitely deep: tanh is 1.
        if y > 40.0 {
            return deep;
        }
        // This start, y/√tanh y (Eckart 1952), is off by 5 % at most, so that a few steps give all digits.
        let mut x = y / math::tanh(y).sqrt();
        for _ in 0..6 {
            let tanh = math::tanh(x);
            x -= (x * tanh - y) / (tanh + x * (1.0 - tanh * tanh));
        }
        x / self.depth
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::TAU;

    /// There and back again, from waves as long as 6000 depths to as short as a twentieth of one. The two limits
    /// are gT²/2π and T√(gh), which a wave of kh misses by a share (kh)²/6.
    #[test]
    fn lengths_and_periods_belong_together() {
        for depth in [0.05, 1.0, 30.0, f64::INFINITY] {
            for gravity in [1.62, 9.81] {
                let water = Dispersion { depth, gravity };
                let unit = if depth.is_finite() { depth } else { 1.0 };
                for i in 0..=60 {
                    let wavelength = unit * 10f64.powf(-1.3 + f64::from(i) * 5.08 / 60.0);
                    let period = water.period(wavelength).unwrap();
                    let back = water.wavelength(period).unwrap();
                    assert!(
                        (back / wavelength - 1.0).abs() < 1e-12,
                        "{wavelength} {back}"
                    );
                    let deep = gravity * period * period / TAU;
                    if wavelength < 0.2 * depth {
                        assert!((wavelength / deep - 1.0).abs() < 1e-12);
                    }
                    let kh = TAU * depth / wavelength;
                    if kh < 0.1 {
                        let shallow = period * (gravity * depth).sqrt();
                        let short = 1.0 - wavelength / shallow;
                        assert!((short / (kh * kh / 6.0) - 1.0).abs() < 0.01, "{short}");
                    }
                }
            }
        }
    }

    #[test]
    fn impossible_water_is_named() {
        let water = Dispersion::default();
        let error =
            |water: Dispersion, period: f64| water.wavelength(period).unwrap_err().to_string();
        assert!(error(water, 0.0).starts_with("period"));
        assert!(
            water
                .period(f64::NAN)
                .unwrap_err()
                .to_string()
                .starts_with("wavelength")
        );
        for bad in [0.0, -1.0, f64::NAN] {
            assert!(
                error(
                    Dispersion {
                        depth: bad,
                        ..water
                    },
                    1.0
                )
                .starts_with("depth")
            );
            assert!(
                error(
                    Dispersion {
                        gravity: bad,
                        ..water
                    },
                    1.0
                )
                .starts_with("gravity")
            );
        }
    }
}
