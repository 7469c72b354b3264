//! A recorded fall, and what it amounts to: the thesis's two numbers of its path, and two of how it turns.

use crate::math;
use rapier3d::na::{Matrix2, Vector2, Vector3};

/// Where a body is and how it is turned at one moment. World axes, y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Center of mass, m.
    pub position: Vector3<f64>,
    /// Plate normal (shortest principal axis), unit.
    pub normal: Vector3<f64>,
    /// Longest principal axis, unit.
    pub long_axis: Vector3<f64>,
}

/// A fall, recorded at equal intervals from its release on.
///
/// [`Experiment::run`](crate::training::Experiment::run) records one; for a body in rapier, push a moment
/// after each step:
///
/// ```
/// use rapier3d_immersed::motion::{Moment, Trajectory};
/// use rapier3d_immersed::rapier3d::na::Vector3;
///
/// let mut fall = Trajectory { interval: 0.01, ..Trajectory::default() };
/// for i in 0..=100 {
///     let time = 0.01 * f64::from(i);
///     let position = Vector3::new(0.2 * time, -time, 0.0);
///     fall.moments.push(Moment { position, normal: Vector3::y(), long_axis: Vector3::x() });
/// }
/// assert!((fall.duration() - 1.0).abs() < 1e-12);
/// // Seen from above the path is a line of 0.2 m: its middle is 0.1 m away, its eccentricity 1.
/// let spread = fall.spread();
/// assert!((spread.distance - 0.1).abs() < 1e-12 && (spread.eccentricity - 1.0).abs() < 1e-6);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    /// Time between moments, s.
    pub interval: f64,
    /// The moments; the first is the release.
    pub moments: Vec<Moment>,
}

/// The horizontal spread of a path (thesis § 5.4.2): the mean and the principal axes of its
/// projection.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spread {
    /// d: distance of the mean from the origin, m.
    pub distance: f64,
    /// e: eccentricity √(1 − λ₂/λ₁) ∈ [0, 1] with the variances λ₁ ≥ λ₂ along the principal axes; 0
    /// for a path without any spread.
    pub eccentricity: f64,
}

impl Trajectory {
    /// Time from the first moment to the last, s.
    pub fn duration(&self) -> f64 {
        self.interval * self.moments.len().saturating_sub(1) as f64
    }

    /// (d, e) of the whole fall from the release point.
    pub fn spread(&self) -> Spread {
        Spread::of(&self.moments)
    }

    /// The moments between two times, s.
    pub fn between(&self, from: f64, to: f64) -> &[Moment] {
        let index = |time: f64| {
            let index = (time / self.interval).round().max(0.0) as usize;
            index.min(self.moments.len())
        };
        let (from, to) = (index(from), index(to));
        &self.moments[from..to.max(from)]
    }
}

impl Spread {
    /// (d, e) of a part of a fall, from its own first position.
    pub fn of(moments: &[Moment]) -> Self {
        let Some(first) = moments.first() else {
            return Self::default();
        };
        let flat = |m: &Moment| {
            let p = m.position - first.position;
            Vector2::new(p.x, p.z)
        };
        let count = moments.len() as f64;
        let mean: Vector2<f64> = moments.iter().map(flat).sum::<Vector2<f64>>() / count;
        let mut variance = Matrix2::zeros();
        for moment in moments {
            let p = flat(moment) - mean;
            variance += p * p.transpose() / count;
        }
        let [large, small] = principal_variances(&variance);
        Self {
            distance: mean.norm(),
            eccentricity: if large > 0.0 {
                (1.0 - small / large).clamp(0.0, 1.0).sqrt()
            } else {
                0.0
            },
        }
    }
}

/// How a body turns, in two numbers: what its path alone ([`Spread`]) does not tell.
///
/// ```
/// use rapier3d_immersed::motion::{AttitudeSpread, Moment};
/// use rapier3d_immersed::rapier3d::na::Vector3;
///
/// // A plate that swings by ±0.5 rad about z.
/// let swing: Vec<Moment> = (0..=200)
///     .map(|i| {
///         let tilt = 0.5 * (std::f64::consts::TAU * 0.01 * f64::from(i)).sin();
///         let normal = Vector3::new(tilt.sin(), tilt.cos(), 0.0);
///         Moment { position: Vector3::zeros(), normal, long_axis: Vector3::z() }
///     })
///     .collect();
/// let seen = AttitudeSpread::of(&swing);
/// assert!(seen.coherence < 1e-9); // it turns back as often
/// assert!(seen.tilt > 0.1);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct AttitudeSpread {
    /// Standard deviation of the tilt, the angle of the plate normal from the vertical whichever face is up,
    /// rad.
    pub tilt: f64,
    /// |∫ω dt| / ∫|ω| dt with ω the angular velocity across the normal in the body's frame, ∈ [0, 1]: 1 where
    /// the body turns on and on, near 0 where it swings back as far; 0 for one that does not turn.
    pub coherence: f64,
}

impl AttitudeSpread {
    /// Of a part of a fall, recorded at equal intervals in which the normal turns by less than half a turn.
    pub fn of(moments: &[Moment]) -> Self {
        let count = moments.len().max(1) as f64;
        let tilts = || {
            moments
                .iter()
                .map(|m| math::acos(m.normal.y.abs().min(1.0)))
        };
        let mean = tilts().sum::<f64>() / count;
        let variance = tilts().map(|tilt| (tilt - mean).powi(2)).sum::<f64>() / count;
        let (mut net, mut whole) = (Vector2::zeros(), 0.0);
        for pair in moments.windows(2) {
            let [before, now] = [&pair[0], &pair[1]];
            let across = before.normal.cross(&now.normal);
            let sine = across.norm();
            if sine > 0.0 {
                let angle = math::atan2(sine, before.normal.dot(&now.normal));
                let turn = across * (angle / sine);
                let third = before.normal.cross(&before.long_axis);
                net += Vector2::new(turn.dot(&before.long_axis), turn.dot(&third));
                whole += angle;
            }
        }
        Self {
            tilt: variance.sqrt(),
            coherence: if whole > 0.0 {
                (net.norm() / whole).min(1.0)
            } else {
                0.0
            },
        }
    }
}

/// Eigenvalues of a symmetric 2×2 matrix, the larger first.
pub(crate) fn principal_variances(m: &Matrix2<f64>) -> [f64; 2] {
    let mean = 0.5 * (m[(0, 0)] + m[(1, 1)]);
    let radius = math::hypot(0.5 * (m[(0, 0)] - m[(1, 1)]), m[(0, 1)]);
    [mean + radius, (mean - radius).max(0.0)]
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// A path whose normal is up.
    pub fn path(interval: f64, count: usize, at: impl Fn(f64) -> Vector3<f64>) -> Trajectory {
        let moment = |i| Moment {
            position: at(i as f64 * interval),
            normal: Vector3::y(),
            long_axis: Vector3::x(),
        };
        Trajectory {
            interval,
            moments: (0..count).map(moment).collect(),
        }
    }

    /// An ellipse of semi-axes A, B about a point: variances A²/2, B²/2, hence e = √(1 − B²/A²),
    /// however it is turned.
    #[test]
    fn eccentricity_of_an_ellipse() {
        let (a, b, turn) = (0.3, 0.12, 0.7f64);
        let around = path(0.01, 101, |t| {
            let (x, z) = (a * math::cos(2.0 * PI * t), b * math::sin(2.0 * PI * t));
            Vector3::new(
                1.0 + math::cos(turn) * x - math::sin(turn) * z,
                -5.0 * t,
                math::sin(turn) * x + math::cos(turn) * z,
            )
        });
        let open = Trajectory {
            moments: around.moments[..100].to_vec(),
            ..around
        };
        let spread = open.spread();
        assert!((spread.eccentricity - (1.0 - (b / a) * (b / a)).sqrt()).abs() < 1e-12);
        // The mean is the center, A from the release.
        assert!((spread.distance - a).abs() < 1e-12);
        let straight = path(0.01, 50, |t| Vector3::new(0.0, -t, 0.0)).spread();
        assert_eq!((straight.distance, straight.eccentricity), (0.0, 0.0));
        let glide = path(0.01, 50, |t| Vector3::new(t, -t, 2.0 * t)).spread();
        assert!((glide.eccentricity - 1.0).abs() < 1e-12);
    }

    /// A tilt A sin ωt about a body axis has the standard deviation A √(½ − 4/π²) of its size |A sin ωt|, and
    /// turns back as far as it turns; a steady rotation is coherent about either axis, and its tilt is
    /// even over 0 … π/2: π/(2√12).
    #[test]
    fn how_a_body_turns() {
        let turning = |angle: &dyn Fn(f64) -> f64, long: bool| {
            let moment = |i: usize| {
                let (sine, cosine) = math::sin_cos(angle(i as f64 / 1000.0));
                let along = Vector3::new(cosine, -sine, 0.0);
                Moment {
                    position: Vector3::zeros(),
                    normal: Vector3::new(sine, cosine, 0.0),
                    long_axis: if long { Vector3::z() } else { along },
                }
            };
            AttitudeSpread::of(&(0..4000).map(moment).collect::<Vec<_>>())
        };
        let swing = turning(&|t| 0.6 * math::sin(2.0 * PI * t), true);
        let exact = 0.6 * (0.5 - 4.0 / (PI * PI)).sqrt();
        assert!((swing.tilt - exact).abs() < 1e-4, "{swing:?}");
        assert!(swing.coherence < 1e-3, "{swing:?}");
        for long in [false, true] {
            let tumble = turning(&|t| -2.0 * PI * t, long);
            assert!((tumble.tilt - PI / 2.0 / 12f64.sqrt()).abs() < 1e-4);
            assert!((tumble.coherence - 1.0).abs() < 1e-9, "{tumble:?}");
        }
        // Three quarters of the way on, one quarter back: half of it is left.
        let uneven = turning(&|t| if t < 3.0 { t } else { 6.0 - t }, true);
        assert!((uneven.coherence - 0.5).abs() < 2e-3, "{uneven:?}");
        assert_eq!(AttitudeSpread::of(&[]), AttitudeSpread::default());
    }

    #[test]
    fn parts_by_time() {
        let fall = path(0.1, 11, |t| Vector3::new(t, 0.0, 0.0));
        assert_eq!(fall.between(0.2, 0.5).len(), 3);
        assert_eq!(fall.between(0.8, 5.0).len(), 3);
        assert!(fall.between(7.0, 5.0).is_empty());
        assert!((fall.duration() - 1.0).abs() < 1e-12);
    }
}
