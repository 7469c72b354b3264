//! A recorded fall, and the thesis's two numbers of it.

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

/// Eigenvalues of a symmetric 2×2 matrix, the larger first.
pub(crate) fn principal_variances(m: &Matrix2<f64>) -> [f64; 2] {
    let mean = 0.5 * (m[(0, 0)] + m[(1, 1)]);
    let radius = (0.5 * (m[(0, 0)] - m[(1, 1)])).hypot(m[(0, 1)]);
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
            let (x, z) = (a * (2.0 * PI * t).cos(), b * (2.0 * PI * t).sin());
            Vector3::new(
                1.0 + turn.cos() * x - turn.sin() * z,
                -5.0 * t,
                turn.sin() * x + turn.cos() * z,
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

    #[test]
    fn parts_by_time() {
        let fall = path(0.1, 11, |t| Vector3::new(t, 0.0, 0.0));
        assert_eq!(fall.between(0.2, 0.5).len(), 3);
        assert_eq!(fall.between(0.8, 5.0).len(), 3);
        assert!(fall.between(7.0, 5.0).is_empty());
        assert!((fall.duration() - 1.0).abs() < 1e-12);
    }
}
