//! Motion segments: a harmonic flutter cut at its turning points (thesis (3.6)).

use crate::error::Error;
use crate::math;
use rapier3d::na::Vector2;
use std::f64::consts::{FRAC_PI_2, PI};

/// The flutter of thesis (3.6): x = −(A_x/Ω) sin Ωt, y = −Ut − (A_y/2Ω) cos 2Ωt, in the glide plane.
///
/// In units of the mean descent U and a length L of the body, so that U = 1: velocities in U, times in
/// L/U. The thesis calls A_x vertical and A_y horizontal; it is the other way round.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct HarmonicFlutter {
    /// A_x: amplitude of the horizontal velocity, in U.
    pub horizontal: f64,
    /// A_y: amplitude of the vertical velocity, in U.
    pub vertical: f64,
    /// Ω: angular frequency, in U/L.
    pub frequency: f64,
}

impl HarmonicFlutter {
    /// # Errors
    /// [`Error::InvalidParameter`] if the frequency is not positive or an amplitude is negative;
    /// neither may be infinite.
    pub fn check(&self) -> Result<(), Error> {
        Error::check_not_negative("horizontal amplitude", self.horizontal)?;
        Error::check_not_negative("vertical amplitude", self.vertical)?;
        Error::check_positive("frequency", self.frequency)?;
        Ok(())
    }

    /// Position at time `t`.
    pub fn position(&self, t: f64) -> Vector2<f64> {
        let phase = self.frequency * t;
        Vector2::new(
            -self.horizontal / self.frequency * math::sin(phase),
            -t - 0.5 * self.vertical / self.frequency * math::cos(2.0 * phase),
        )
    }

    /// Velocity at time `t`.
    pub fn velocity(&self, t: f64) -> Vector2<f64> {
        let phase = self.frequency * t;
        Vector2::new(
            -self.horizontal * math::cos(phase),
            -1.0 + self.vertical * math::sin(2.0 * phase),
        )
    }

    /// Time of the k-th turning point, (2k+1)π/(2Ω): there the horizontal velocity is zero and the
    /// vertical one −U, whatever the amplitudes.
    pub fn turning_point(&self, k: i32) -> f64 {
        f64::from(2 * k + 1) * FRAC_PI_2 / self.frequency
    }
}

/// Which way a segment glides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Glide {
    /// It glides toward −x.
    Left,
    /// It glides toward +x.
    Right,
}

impl Glide {
    /// −1 or 1.
    pub const fn sign(self) -> f64 {
        match self {
            Self::Left => -1.0,
            Self::Right => 1.0,
        }
    }

    /// The way of a number's sign.
    pub const fn toward(x: f64) -> Self {
        if x < 0.0 { Self::Left } else { Self::Right }
    }

    /// The other way.
    pub const fn reversed(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}

/// A flutter between two successive turning points.
///
/// Every segment begins and ends with the velocity (0, −U): any two of them join smoothly.
///
/// ```
/// use rapier3d_immersed::motion::path::{Glide, HarmonicFlutter, Segment};
///
/// let flutter = HarmonicFlutter { horizontal: 1.5, vertical: 0.5, frequency: 2.0 };
/// let right = Segment { flutter, glide: Glide::Right };
/// // From turn to turn it goes 2A_x/Ω across and π/Ω down.
/// let feature = right.feature();
/// assert!((feature.x - 1.5).abs() < 1e-12);
/// assert!((feature.y + std::f64::consts::FRAC_PI_2).abs() < 1e-12);
/// assert!((right.velocity(0.0) - right.velocity(right.duration())).norm() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Segment {
    /// The flutter that it is cut from.
    pub flutter: HarmonicFlutter,
    /// Which way it glides.
    pub glide: Glide,
}

impl Segment {
    /// Beginning, in the time of the flutter: the turning point before the glide. (3.6) begins at the
    /// right-hand turn with k = −1.
    fn start(&self) -> f64 {
        self.flutter.turning_point(match self.glide {
            Glide::Left => -1,
            Glide::Right => 0,
        })
    }

    /// How long it lasts, in L/U.
    pub fn duration(&self) -> f64 {
        PI / self.flutter.frequency
    }

    /// Position relative to its first point, `t` after its beginning.
    pub fn position(&self, t: f64) -> Vector2<f64> {
        let start = self.start();
        self.flutter.position(start + t) - self.flutter.position(start)
    }

    /// Velocity `t` after its beginning.
    pub fn velocity(&self, t: f64) -> Vector2<f64> {
        self.flutter.velocity(self.start() + t)
    }

    /// Feature vector: from its first point to its last (thesis § 3.3.2), (±2A_x/Ω, −π/Ω), in L.
    pub fn feature(&self) -> Vector2<f64> {
        Vector2::new(self.glide.sign() * 2.0 * self.flutter.horizontal, -PI)
            / self.flutter.frequency
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLUTTER: HarmonicFlutter = HarmonicFlutter {
        horizontal: 1.3,
        vertical: 0.7,
        frequency: 2.1,
    };

    /// Velocities are derivatives of positions; central differences of 1e-5 leave 1e-9.
    #[test]
    fn velocity_is_the_derivative() {
        for i in 0..20 {
            let t = -1.0 + 0.3 * f64::from(i);
            let h = 1e-5;
            let slope = (FLUTTER.position(t + h) - FLUTTER.position(t - h)) / (2.0 * h);
            assert!((slope - FLUTTER.velocity(t)).norm() < 1e-8);
        }
    }

    /// At turning points there is no horizontal velocity, and the vertical one is the same for all flutters.
    #[test]
    fn every_segment_begins_and_ends_alike() {
        for glide in [Glide::Left, Glide::Right] {
            let segment = Segment {
                flutter: FLUTTER,
                glide,
            };
            for t in [0.0, segment.duration()] {
                assert!((segment.velocity(t) - Vector2::new(0.0, -1.0)).norm() < 1e-12);
            }
            let end = segment.position(segment.duration());
            assert!((end - segment.feature()).norm() < 1e-12);
            assert_eq!(end.x > 0.0, glide == Glide::Right);
            // U is the mean descent of each segment.
            assert!((end.y / segment.duration() + 1.0).abs() < 1e-12);
        }
    }

    /// The pieces of (3.6) between its turning points, put end to end, are (3.6).
    #[test]
    fn segments_make_up_the_flutter() {
        let mut at = FLUTTER.position(FLUTTER.turning_point(0));
        for k in 0..4 {
            let glide = if k % 2 == 0 {
                Glide::Right
            } else {
                Glide::Left
            };
            let segment = Segment {
                flutter: FLUTTER,
                glide,
            };
            let start = FLUTTER.turning_point(k);
            for i in 0..=8 {
                let t = segment.duration() * f64::from(i) / 8.0;
                let error = at + segment.position(t) - FLUTTER.position(start + t);
                assert!(error.norm() < 1e-12);
            }
            at += segment.feature();
        }
    }
}
