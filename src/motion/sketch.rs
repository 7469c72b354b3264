//! Sketches: paths over time, drawn by a user.

use crate::error::Error;
use rapier3d::na::Vector3;

/// A path over time: points with times, smooth in between.
///
/// [`Sketch::follow`] makes a body follow it, [`Sketch::landing`] draws one through a few points, [`Sketch::from_csv`] reads a table:
///
/// ```
/// use rapier3d_immersed::motion::Sketch;
/// use rapier3d_immersed::rapier3d::na::Vector3;
///
/// let sketch = Sketch::new(vec![
///     (0.0, Vector3::new(0.0, 2.0, 0.0)),
///     (1.0, Vector3::new(0.3, 1.0, 0.0)),
///     (2.0, Vector3::new(0.0, 0.0, 0.0)),
/// ])?;
/// assert_eq!(sketch.at(1.0), Vector3::new(0.3, 1.0, 0.0));
/// // Between points the path is a smooth curve; beyond its end it goes on straight.
/// assert!(sketch.at(0.5).x > 0.15 && sketch.at(3.0).y < -0.9);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Sketch {
    points: Vec<(f64, Vector3<f64>)>,
}

impl Sketch {
    /// A path through points (m, world axes, y up) at times (s).
    ///
    /// # Errors
    /// [`Error::WrongLength`] if there are less than two points; [`Error::InvalidParameter`] or
    /// [`Error::NotFinite`] if the times do not start at 0 and ascend or a value is not finite.
    pub fn new(points: Vec<(f64, Vector3<f64>)>) -> Result<Self, Error> {
        if points.len() < 2 {
            return Err(Error::WrongLength {
                what: "points of the sketch",
                expected: 2,
                actual: points.len(),
            });
        }
        Error::check(
            "time of the first point",
            points[0].0,
            points[0].0 == 0.0,
            "0",
        )?;
        for (time, point) in &points {
            Error::check_range("time of a point", *time, 0.0, 1e3)?;
            Error::check_all_finite("point of the sketch", point.as_slice())?;
        }
        for pair in points.windows(2) {
            let later = pair[1].0 > pair[0].0;
            Error::check(
                "time of a point",
                pair[1].0,
                later,
                "later than the one before",
            )?;
        }
        Ok(Self { points })
    }

    /// The points.
    pub fn points(&self) -> &[(f64, Vector3<f64>)] {
        &self.points
    }

    /// Time of the last point, s.
    pub fn duration(&self) -> f64 {
        self.points[self.points.len() - 1].0
    }

    /// Where the path is at a time: a cubic through each pair of points whose velocities are those of the
    /// parabola through three (Catmull–Rom for uneven times). Beyond the ends it goes on straight.
    pub fn at(&self, time: f64) -> Vector3<f64> {
        let p = &self.points;
        let i = p.partition_point(|(t, _)| *t <= time).clamp(1, p.len() - 1) - 1;
        let ((t0, a), (t1, b)) = (p[i], p[i + 1]);
        let (va, vb) = (self.velocity(i), self.velocity(i + 1));
        if time < t0 {
            return a + va * (time - t0);
        }
        if time > t1 {
            return b + vb * (time - t1);
        }
        let h = t1 - t0;
        let s = (time - t0) / h;
        let (s2, s3) = (s * s, s * s * s);
        a * (2.0 * s3 - 3.0 * s2 + 1.0)
            + va * (h * (s3 - 2.0 * s2 + s))
            + b * (3.0 * s2 - 2.0 * s3)
            + vb * (h * (s3 - s2))
    }

    /// Velocity of the path at a point, m/s.
    pub(crate) fn velocity(&self, i: usize) -> Vector3<f64> {
        let p = &self.points;
        let slope = |i: usize| (p[i + 1].1 - p[i].1) / (p[i + 1].0 - p[i].0);
        if i == 0 {
            return slope(0);
        }
        if i + 1 == p.len() {
            return slope(i - 1);
        }
        let (before, after) = (p[i].0 - p[i - 1].0, p[i + 1].0 - p[i].0);
        (slope(i - 1) * after + slope(i) * before) / (before + after)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn v(x: f64, y: f64, z: f64) -> Vector3<f64> {
        Vector3::new(x, y, z)
    }

    #[test]
    fn the_path_passes_through_its_points_smoothly() {
        let points = vec![
            (0.0, v(0.0, 1.0, 0.0)),
            (0.4, v(0.3, 0.8, 0.1)),
            (1.0, v(0.0, 0.4, 0.0)),
            (1.2, v(0.1, 0.0, -0.2)),
        ];
        let sketch = Sketch::new(points.clone()).unwrap();
        for (time, point) in &points {
            assert!((sketch.at(*time) - point).norm() < 1e-12);
            let h = 1e-6;
            let before = (sketch.at(*time) - sketch.at(time - h)) / h;
            let after = (sketch.at(time + h) - sketch.at(*time)) / h;
            assert!((before - after).norm() < 1e-4);
        }
        // A uniform motion is met exactly.
        let straight = [0.0, 0.3, 1.0].map(|t| (t, v(2.0 * t, -t, 0.0)));
        let straight = Sketch::new(straight.to_vec()).unwrap();
        for t in [-0.5, 0.1, 0.77, 3.0] {
            assert!((straight.at(t) - v(2.0 * t, -t, 0.0)).norm() < 1e-12);
        }
    }

    #[test]
    fn bad_sketches_are_refused() {
        let point = v(0.0, 0.0, 0.0);
        assert!(Sketch::new(vec![(0.0, point)]).is_err());
        assert!(Sketch::new(vec![(0.1, point), (1.0, point)]).is_err());
        assert!(Sketch::new(vec![(0.0, point), (0.0, point)]).is_err());
        assert!(Sketch::new(vec![(0.0, point), (f64::NAN, point)]).is_err());
        assert!(Sketch::new(vec![(0.0, point), (1.0, v(f64::INFINITY, 0.0, 0.0))]).is_err());
    }
}
