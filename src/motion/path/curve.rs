//! Steady descent, spiral and helix as one curve (thesis (3.7)–(3.8)).

use crate::error::Error;
use crate::math;
use rapier3d::na::Vector3;

/// x = A cos φ (1 + ε sin kφ), z = A sin φ (1 + ε sin kφ), y = −Ut with φ = Ωt, y up (the thesis's z).
///
/// ε = 0 is a spiral (the thesis's PS), A = 0 steady descent (SD), ε ≠ 0 and k = 4 a helix (TH): a rose
/// of four petals for ε < 1. For ε > 1 the radius changes sign and there are eight, as the thesis says.
///
/// ```
/// use rapier3d_immersed::motion::path::UnifiedCurve;
///
/// // A spiral of 10 cm that turns once per second while it descends 0.8 m.
/// let spiral = UnifiedCurve::spiral(0.1, std::f64::consts::TAU, 0.8);
/// let (start, turn) = (spiral.position(0.0), spiral.position(1.0));
/// assert!((turn - start).xz().norm() < 1e-12 && (turn.y + 0.8).abs() < 1e-12);
/// let centripetal = 0.1 * std::f64::consts::TAU.powi(2);
/// assert!((spiral.acceleration(0.3).norm() - centripetal).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnifiedCurve {
    /// A: mean radius, m.
    pub amplitude: f64,
    /// ε: depth of the petals.
    pub ellipticity: f64,
    /// k: petals per turn. With a whole number the projection closes.
    pub petals: f64,
    /// Ω: angular frequency about the axis, rad/s.
    pub frequency: f64,
    /// U: descent, m/s.
    pub descent: f64,
}

impl UnifiedCurve {
    /// A fall straight down.
    pub fn steady(descent: f64) -> Self {
        Self {
            amplitude: 0.0,
            ellipticity: 0.0,
            petals: 0.0,
            frequency: 0.0,
            descent,
        }
    }

    /// A spiral: the projection is a circle.
    pub fn spiral(amplitude: f64, frequency: f64, descent: f64) -> Self {
        Self {
            amplitude,
            ellipticity: 0.0,
            petals: 1.0,
            frequency,
            descent,
        }
    }

    /// A helix with k = 4.
    pub fn helix(amplitude: f64, ellipticity: f64, frequency: f64, descent: f64) -> Self {
        Self {
            amplitude,
            ellipticity,
            petals: 4.0,
            frequency,
            descent,
        }
    }

    /// # Errors
    /// [`Error::InvalidParameter`] names a value that is not finite, or is negative.
    pub fn check(&self) -> Result<(), Error> {
        Error::check_not_negative("amplitude", self.amplitude)?;
        Error::check_not_negative("ellipticity", self.ellipticity)?;
        Error::check_not_negative("petals", self.petals)?;
        Error::check_not_negative("frequency", self.frequency)?;
        Error::check_not_negative("descent", self.descent)?;
        Ok(())
    }

    /// Radius, and its first two derivatives by φ.
    fn radius(&self, phi: f64) -> [f64; 3] {
        let (a, e, k) = (self.amplitude, self.ellipticity, self.petals);
        let (sin, cos) = math::sin_cos(k * phi);
        [a * (1.0 + e * sin), a * e * k * cos, -a * e * k * k * sin]
    }

    /// Position at time `t`, m.
    pub fn position(&self, t: f64) -> Vector3<f64> {
        let phi = self.frequency * t;
        let [r, ..] = self.radius(phi);
        Vector3::new(r * math::cos(phi), -self.descent * t, r * math::sin(phi))
    }

    /// Velocity at time `t`, m/s.
    pub fn velocity(&self, t: f64) -> Vector3<f64> {
        let phi = self.frequency * t;
        let [r, dr, _] = self.radius(phi);
        let (sin, cos) = math::sin_cos(phi);
        Vector3::new(dr * cos - r * sin, 0.0, dr * sin + r * cos) * self.frequency
            - Vector3::y() * self.descent
    }

    /// Acceleration at time `t`, m/s²; horizontal.
    pub fn acceleration(&self, t: f64) -> Vector3<f64> {
        let phi = self.frequency * t;
        let [r, dr, ddr] = self.radius(phi);
        let (sin, cos) = math::sin_cos(phi);
        let (radial, around) = (ddr - r, 2.0 * dr);
        Vector3::new(
            radial * cos - around * sin,
            0.0,
            radial * sin + around * cos,
        ) * (self.frequency * self.frequency)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::path::HorizontalShape;
    use std::f64::consts::TAU;

    #[test]
    fn derivatives() {
        let curve = UnifiedCurve::helix(0.05, 0.4, 3.0, 0.7);
        for i in 0..20 {
            let (t, h) = (0.11 * f64::from(i), 1e-5);
            let slope = (curve.position(t + h) - curve.position(t - h)) / (2.0 * h);
            assert!((slope - curve.velocity(t)).norm() < 1e-8);
            let bend = (curve.velocity(t + h) - curve.velocity(t - h)) / (2.0 * h);
            assert!((bend - curve.acceleration(t)).norm() < 1e-6);
        }
    }

    /// (3.8), with the erratum of the helix: four petals for ε < 1, eight for ε > 1.
    #[test]
    fn shapes_of_figure_3_8() {
        let shape = |curve: UnifiedCurve| {
            let turn = TAU / curve.frequency.max(1e-9);
            let points = (0..720).map(|i| curve.position(turn * f64::from(i) / 720.0));
            HorizontalShape::of(&points.collect::<Vec<_>>())
        };
        let spiral = shape(UnifiedCurve::spiral(0.05, 3.0, 1.0));
        // A polygon of 720 sides is a circle to (π/720)²/3.
        assert!((spiral.circularity - 1.0).abs() < 1e-4, "{spiral:?}");
        assert_eq!(spiral.petals, 0);
        for (ellipticity, petals) in [(0.2, 4), (0.6, 4), (1.5, 8), (2.5, 8)] {
            let helix = shape(UnifiedCurve::helix(0.05, ellipticity, 3.0, 1.0));
            assert_eq!(helix.petals, petals, "{ellipticity}");
            assert!(helix.circularity < 0.95);
        }
        let steady = shape(UnifiedCurve::steady(1.0));
        assert_eq!(steady.extent, 0.0);
    }
}
