//! A path's helix in numbers (thesis Fig. 5.5: a card that autorotates along a helix).

use super::classify::Classifier;
use super::trajectory::Moment;
use crate::math;
use rapier3d::na::{Matrix3, Vector3};
use std::f64::consts::{PI, TAU};

/// The circle that fits the path of a fall seen from above best, and how the path goes round it.
///
/// ```
/// use rapier3d_immersed::motion::{HelixFit, Moment};
/// use rapier3d_immersed::rapier3d::na::Vector3;
///
/// // Two turns of 30 cm in radius, 80 cm down each.
/// let moments: Vec<Moment> = (0..=400)
///     .map(|i| {
///         let turn = std::f64::consts::TAU * f64::from(i) / 200.0;
///         let position = Vector3::new(0.3 * turn.cos(), -0.004 * f64::from(i), 0.3 * turn.sin());
///         Moment { position, normal: Vector3::y(), long_axis: Vector3::x() }
///     })
///     .collect();
/// let helix = HelixFit::of(&moments).unwrap();
/// assert!((helix.radius - 0.3).abs() < 1e-9 && helix.residual < 1e-9);
/// assert!((helix.turns - 2.0).abs() < 1e-9 && (helix.pitch - 0.8).abs() < 1e-9);
/// assert!(helix.is_helix());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HelixFit {
    /// Radius of the circle, m.
    pub radius: f64,
    /// Root mean square distance of the path from the circle, over its radius.
    pub residual: f64,
    /// Turns about the circle's center, from x to z positive.
    pub turns: f64,
    /// Descent per turn, m; infinite for a path that does not go round.
    pub pitch: f64,
    /// Turn of the azimuth per half turn of the body (a flip of the [`Classifier`]), rad; 0 if the body makes
    /// none.
    pub azimuth_per_half_turn: f64,
}

impl HelixFit {
    /// A path is a helix if it goes round at least this often …
    pub const LEAST_TURNS: f64 = 1.0;
    /// … and is no farther from the circle than this share of its radius (root mean square).
    pub const LARGEST_RESIDUAL: f64 = 0.2;

    /// The fit to a part of a fall; `None` if there are less than three moments or the path from above is a
    /// line. The circle is the algebraic least-squares fit (Kåsa 1976), exact for a path on a circle.
    pub fn of(moments: &[Moment]) -> Option<Self> {
        let count = moments.len();
        if count < 3 {
            return None;
        }
        let middle = moments.iter().map(|m| m.position).sum::<Vector3<f64>>() / count as f64;
        let flat = || moments.iter().map(|m| m.position - middle);
        // x² + z² = 2ax + 2bz + c.
        let (mut normal, mut rhs) = (Matrix3::zeros(), Vector3::zeros());
        for p in flat() {
            let row = Vector3::new(2.0 * p.x, 2.0 * p.z, 1.0);
            normal += row * row.transpose();
            rhs += row * (p.x * p.x + p.z * p.z);
        }
        let [a, b, c]: [f64; 3] = (normal.try_inverse()? * rhs).into();
        let radius = (c + a * a + b * b).sqrt();
        if !(radius.is_finite() && radius > 0.0) {
            return None;
        }
        let distance = |p: Vector3<f64>| math::hypot(p.x - a, p.z - b) - radius;
        let square = flat().map(|p| distance(p).powi(2)).sum::<f64>() / count as f64;
        let (mut angle, mut last) = (0.0, None);
        for p in flat() {
            let azimuth = math::atan2(p.z - b, p.x - a);
            if let Some(last) = last {
                let step: f64 = azimuth - last;
                angle += (step + PI).rem_euclid(TAU) - PI;
            }
            last = Some(azimuth);
        }
        let turns = angle / TAU;
        let descent = moments[0].position.y - moments[count - 1].position.y;
        let flips = Classifier::default().observe(moments).flips;
        Some(Self {
            radius,
            residual: square.sqrt() / radius,
            turns,
            pitch: descent / turns.abs(),
            azimuth_per_half_turn: if flips > 0 {
                angle / f64::from(flips)
            } else {
                0.0
            },
        })
    }

    /// Whether the path is one, by the two limits.
    pub fn is_helix(&self) -> bool {
        self.turns.abs() >= Self::LEAST_TURNS && self.residual <= Self::LARGEST_RESIDUAL
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A card that makes `flips` half turns while its path goes `turns` times round.
    fn fall(turns: f64, flips: f64, radius: impl Fn(f64) -> f64) -> Vec<Moment> {
        let moment = |i: usize| {
            let share = i as f64 / 2000.0;
            let (sine, cosine) = (TAU * turns * share).sin_cos();
            let (up, along) = (PI * flips * share + 0.1).sin_cos();
            Moment {
                position: Vector3::new(
                    1.0 + radius(share) * cosine,
                    -3.0 * share,
                    radius(share) * sine,
                ),
                normal: Vector3::new(-sine * up, along, cosine * up),
                long_axis: Vector3::new(cosine, 0.0, sine),
            }
        };
        (0..=2000).map(moment).collect()
    }

    #[test]
    fn an_exact_helix() {
        for sense in [1.0, -1.0] {
            let fit = HelixFit::of(&fall(2.5 * sense, 20.0, |_| 0.4)).unwrap();
            assert!((fit.radius - 0.4).abs() < 1e-9 && fit.residual < 1e-9);
            assert!((fit.turns - 2.5 * sense).abs() < 1e-9);
            assert!((fit.pitch - 3.0 / 2.5).abs() < 1e-9);
            let per_half_turn = TAU * 2.5 / 20.0 * sense;
            // One flip at either end may be missed.
            assert!((fit.azimuth_per_half_turn / per_half_turn - 1.0).abs() < 0.06);
            assert!(fit.is_helix());
        }
    }

    /// A radius that swings by 10 % has the residual 0.1/√2; a spiral that widens fourfold is no helix, nor is
    /// a path that goes half round.
    #[test]
    fn what_is_not_quite_one() {
        let wavy = HelixFit::of(&fall(3.0, 20.0, |s| 0.4 + 0.04 * (TAU * 30.0 * s).sin())).unwrap();
        assert!((wavy.residual - 0.1 / 2f64.sqrt()).abs() < 2e-3, "{wavy:?}");
        assert!(wavy.is_helix());
        let widening = HelixFit::of(&fall(3.0, 20.0, |s| 0.1 + 0.3 * s)).unwrap();
        assert!(!widening.is_helix(), "{widening:?}");
        assert!(!HelixFit::of(&fall(0.5, 20.0, |_| 0.4)).unwrap().is_helix());
        let line: Vec<Moment> = fall(0.0, 5.0, |s| s);
        assert_eq!(HelixFit::of(&line), None);
        assert_eq!(HelixFit::of(&line[..2]), None);
    }
}
