//! Sums of linear waves.

use super::dispersion::Dispersion;
use super::fours::{Elevations, Four, Place, Velocities};
use super::{Elevation, FreeSurface};
use crate::error::Error;
use crate::math;
use crate::math::dispatch;
use rapier3d::na::Vector3;

/// A linear (Airy) wave: η = amplitude · cos(k·(x, z) − ωt + phase).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// Height of the crests above the level of rest, m.
    pub amplitude: f64,
    /// From crest to crest, m. [`Dispersion::wavelength`] gives it for a period.
    pub wavelength: f64,
    /// Along x and z, where the wave runs to; of any length but zero.
    pub direction: [f64; 2],
    /// Phase at the origin at time 0, rad; 0 is a crest.
    pub phase: f64,
}

impl Default for Wave {
    /// 10 m long, 10 cm high, along x, with a crest at the origin at time 0.
    fn default() -> Self {
        Self {
            amplitude: 0.1,
            wavelength: 10.0,
            direction: [1.0, 0.0],
            phase: 0.0,
        }
    }
}

/// A surface that is the sum of linear waves on water of finite or infinite depth, with the velocities below it.
///
/// # Above the level of rest
/// Linear theory knows velocities below the level of rest only, as aω cosh k(y + h)/sinh kh along the wave and
/// aω sinh k(y + h)/sinh kh up. Here every wave goes on with the same formula above it, but runs on the surface that
/// the longer waves make: its y counts from there. So a single wave carries what floats at its surface with the whole
/// Stokes drift, and short waves do not explode at the crests of long ones (e^ky is 10⁵ for ripples of half a meter on
/// a crest of 1 m). Of waves of about the same length, none goes higher than ky = ½.
///
/// One wave conserves the water and does not turn it, exactly; several do up to their steepness, as linear theory does.
///
/// # Cost
/// Per wave some 2.5 ns an elevation and 7.5 ns a velocity with AVX2 (`cargo bench --bench surface`). The bits depend on
/// the waves only, not on the machine; what is computed when they are made (tanh, cos) may differ in its last bit between
/// systems.
///
/// ```
/// use rapier3d_immersed::free_surface::{Dispersion, FreeSurface, Wave, Waves};
///
/// let water = Dispersion { depth: 3.0, ..Dispersion::default() };
/// let swell = Wave { amplitude: 0.3, wavelength: water.wavelength(5.0)?, ..Wave::default() };
/// let ripple = Wave { amplitude: 0.02, wavelength: 1.0, direction: [1.0, 1.0], ..Wave::default() };
/// let waves = Waves::new(water, &[swell, ripple])?;
/// assert!((waves.elevation(0.0, 0.0, 0.0).height - 0.32).abs() < 1e-12); // two crests meet
/// assert!((waves.elevation(0.0, 0.0, 2.5).height + 0.3).abs() < 0.021); // half a period later
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Waves {
    fours: Vec<Four>,
    waves: Vec<Wave>,
    dispersion: Dispersion,
    highest: f64,
    bend: f64,
}

/// Amplitude times wavenumber over tanh kh of the steepest wave that does not break (Stokes; Miche in shallow water).
const STEEPEST: f64 = 0.443;

/// Gravity has waves down to about a centimeter; what is shorter lives by surface tension.
const SHORTEST: f64 = 1e-3;

/// A surface [bends](FreeSurface::bend) like its shortest wave, but for those that hold this share of its variance.
const NEGLIGIBLE: f64 = 0.03;

impl Waves {
    /// The sum of these waves.
    ///
    /// # Errors
    /// If a number is not finite, a wave is shorter than 1 mm, an amplitude is negative or so large that the wave would break
    /// (amplitude · k > .443 tanh kh), a direction is zero, or the depth or gravity is not positive.
    pub fn new(dispersion: Dispersion, waves: &[Wave]) -> Result<Self, Error> {
        dispersion.check()?;
        for wave in waves {
            Error::check_not_negative("amplitude", wave.amplitude)?;
            let long = wave.wavelength >= SHORTEST && wave.wavelength.is_finite();
            Error::check(
                "wavelength",
                wave.wavelength,
                long,
                "at least 1 mm and finite",
            )?;
            Error::check_finite("phase", wave.phase)?;
            let length = math::hypot(wave.direction[0], wave.direction[1]);
            let requirement = "a direction: finite, and longer than zero";
            let points = length > 0.0 && length.is_finite();
            Error::check("length of a wave's direction", length, points, requirement)?;
            let k = core::f64::consts::TAU / wave.wavelength;
            let most = STEEPEST * math::tanh(k * dispersion.depth) / k;
            Error::check_range(
                "amplitude of a wave that does not break",
                wave.amplitude,
                0.0,
                most,
            )?;
        }
        let mut waves = waves.to_vec();
        waves.sort_by(|a, b| b.wavelength.total_cmp(&a.wavelength));
        let fours = waves.chunks(4).map(|four| {
            let mut of = Four::default();
            for (lane, wave) in four.iter().enumerate() {
                of.set(lane, wave, &dispersion);
            }
            of
        });
        Ok(Self {
            fours: fours.collect(),
            highest: waves.iter().map(|wave| wave.amplitude).sum(),
            bend: bend(&waves),
            waves,
            dispersion,
        })
    }

    /// The waves, from long to short.
    pub fn waves(&self) -> &[Wave] {
        &self.waves
    }

    /// The depth and gravity that the waves live by.
    pub fn dispersion(&self) -> Dispersion {
        self.dispersion
    }

    /// The same, with a lower [bound](FreeSurface::highest).
    pub(super) fn bounded(self, highest: f64) -> Self {
        Self {
            highest: self.highest.min(highest),
            ..self
        }
    }
}

impl Four {
    fn set(&mut self, lane: usize, wave: &Wave, dispersion: &Dispersion) {
        use core::f64::consts::TAU;
        let k = TAU / wave.wavelength;
        let omega = dispersion.frequency(k);
        let length = math::hypot(wave.direction[0], wave.direction[1]);
        let [x, z] = wave.direction.map(|d| d / length);
        let a = wave.amplitude;
        let rows = [
            k * x / TAU,
            k * z / TAU,
            omega / TAU,
            wave.phase / TAU % 1.0,
        ];
        for (row, number) in self.turns.iter_mut().zip(rows) {
            row[lane] = number;
        }
        for (row, number) in self.height.iter_mut().zip([a, a * k * x, a * k * z]) {
            row[lane] = number;
        }
        for (row, number) in self.velocity.iter_mut().zip([x, 1.0, z]) {
            row[lane] = number * a * omega;
        }
        self.wavenumber[lane] = k;
        self.bottom[lane] = math::exp(-2.0 * k * dispersion.depth);
    }
}

/// The wavelength below which the waves, in order from long to short, hold a negligible share of the variance.
fn bend(waves: &[Wave]) -> f64 {
    let variance = |waves: &[Wave]| waves.iter().map(|wave| wave.amplitude.powi(2)).sum::<f64>();
    let negligible = NEGLIGIBLE * variance(waves);
    let counts = (1..=waves.len())
        .rev()
        .find(|n| variance(&waves[n - 1..]) > negligible);
    counts.map_or(f64::INFINITY, |n| waves[n - 1].wavelength)
}

impl FreeSurface for Waves {
    fn elevation(&self, x: f64, z: f64, time: f64) -> Elevation {
        let mut sum = [0.0; 3];
        dispatch(Elevations {
            waves: &self.fours,
            place: Place::new(x, z, time),
            sum: &mut sum,
        });
        let [height, along_x, along_z] = sum;
        Elevation {
            height,
            slope: [along_x, along_z],
        }
    }

    fn velocity(&self, point: &Vector3<f64>, time: f64) -> Vector3<f64> {
        let mut sum = [0.0; 3];
        dispatch(Velocities {
            waves: &self.fours,
            place: Place::new(point.x, point.z, time),
            y: point.y,
            bottom: -self.dispersion.depth,
            sum: &mut sum,
        });
        sum.into()
    }

    fn highest(&self) -> f64 {
        self.highest
    }

    fn bend(&self) -> f64 {
        self.bend
    }

    fn is_still(&self) -> bool {
        self.waves.iter().all(|wave| wave.amplitude == 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impossible_waves_are_named() {
        let error = |change: &dyn Fn(&mut Wave)| {
            let mut wave = Wave::default();
            change(&mut wave);
            let waves = [Wave::default(), wave];
            Waves::new(Dispersion::default(), &waves)
                .unwrap_err()
                .to_string()
        };
        for bad in [f64::NAN, f64::INFINITY, -0.1] {
            assert!(error(&|wave| wave.amplitude = bad).starts_with("amplitude"));
            assert!(error(&|wave| wave.wavelength = bad).starts_with("wavelength"));
        }
        assert!(error(&|wave| wave.wavelength = 0.0).contains("but is 0"));
        assert!(error(&|wave| wave.phase = f64::NAN).starts_with("phase"));
        assert!(error(&|wave| wave.direction = [0.0; 2]).contains("direction"));
        assert!(error(&|wave| wave.direction[1] = f64::NAN).contains("direction"));
        // The steepest wave of 10 m is .705 m high.
        assert!(error(&|wave| wave.amplitude = 0.706).contains("does not break"));
        let steep = Wave {
            amplitude: 0.704,
            ..Wave::default()
        };
        assert!(Waves::new(Dispersion::default(), &[steep]).is_ok());
        let shallow = Dispersion {
            depth: 1.0,
            ..Dispersion::default()
        };
        assert!(Waves::new(shallow, &[steep]).is_err());
        for depth in [0.0, -1.0, f64::NAN] {
            let water = Dispersion { depth, ..shallow };
            assert!(Waves::new(water, &[]).is_err());
        }
    }

    /// Of a swell of 1 m and ripples, the bend is the swell's as long as the ripples hold less than three hundredths
    /// of the variance: .175 m is just under, .177 m is over.
    #[test]
    fn what_bends_and_what_does_not() {
        let bend = |ripple: f64| {
            let wave = |amplitude, wavelength| Wave {
                amplitude,
                wavelength,
                ..Wave::default()
            };
            let waves = [wave(ripple, 3.0), wave(1.0, 40.0)];
            let waves = Waves::new(Dispersion::default(), &waves).unwrap();
            assert_eq!(waves.highest(), 1.0 + ripple);
            waves.bend()
        };
        assert_eq!(bend(0.17), 40.0);
        assert_eq!(bend(0.18), 3.0);
        let none = Waves::new(Dispersion::default(), &[]).unwrap();
        assert!(none.is_still() && none.bend() == f64::INFINITY && none.highest() == 0.0);
    }
}
