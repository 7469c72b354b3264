//! Turning points: maxima of a path's curvature, where patterns change (thesis § 5.5.3).

use super::trajectory::{Moment, Trajectory};
use rapier3d::na::Vector3;

/// Finds turning points while a path grows, point by point at equal intervals.
///
/// A turn is a maximum of the curvature κL (L the body's major semi-axis) that rises above the minimum
/// before it, and is followed by a fall, by `tolerance`. It is reported when it is over, a few points
/// late. The thesis's tolerance of 0.1 (Fig. 5.12) has no unit; it is read as 0.1 per centimeter, because
/// its Fig. 5.6 is in centimeters, with L = 3.5 cm.
///
/// ```
/// use rapier3d_immersed::motion::TurnFinder;
/// use rapier3d_immersed::rapier3d::na::Vector3;
///
/// // A leaf of semi-axis 3.5 cm swings at 1 Hz for 3 s.
/// let mut finder = TurnFinder::new(0.035, TurnFinder::TOLERANCE);
/// let path = (0..360).map(|i| {
///     let time = f64::from(i) / 120.0;
///     Vector3::new(0.1 * (std::f64::consts::TAU * time).sin(), -0.5 * time, 0.0)
/// });
/// assert_eq!(path.filter(|point| finder.push(*point)).count(), 6);
/// ```
#[derive(Clone, Debug)]
pub struct TurnFinder {
    length: f64,
    tolerance: f64,
    last: [Option<Vector3<f64>>; 2],
    low: f64,
    high: f64,
    rising: bool,
}

impl TurnFinder {
    /// The thesis's tolerance in units of the major semi-axis, as we read it: 0.1 /cm × 3.5 cm.
    pub const TOLERANCE: f64 = 0.35;

    /// A finder for a body of major semi-axis `length`, m.
    pub fn new(length: f64, tolerance: f64) -> Self {
        Self {
            length,
            tolerance,
            last: [None; 2],
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
            rising: false,
        }
    }

    /// Takes the next point, m, and says whether a turn is over.
    pub fn push(&mut self, point: Vector3<f64>) -> bool {
        let [before, last] = self.last;
        self.last = [last, Some(point)];
        let (Some(before), Some(last)) = (before, last) else {
            return false;
        };
        let curvature = curvature(&before, &last, &point) * self.length;
        if self.rising {
            self.high = self.high.max(curvature);
            if curvature < self.high - self.tolerance {
                (self.low, self.rising) = (curvature, false);
                return true;
            }
        } else {
            self.low = self.low.min(curvature);
            if curvature > self.low + self.tolerance {
                (self.high, self.rising) = (curvature, true);
            }
        }
        false
    }
}

impl Trajectory {
    /// Curvature of the path at each moment but the first and the last, 1/m: that of the circle through the point
    /// and its two neighbours (thesis Fig. 5.12).
    pub fn curvatures(&self) -> Vec<f64> {
        let points = self.moments.windows(3);
        let curvature = |m: &[Moment]| curvature(&m[0].position, &m[1].position, &m[2].position);
        points.map(curvature).collect()
    }
}

/// Curvature of the circle through three points, 1/m (Menger): four times the triangle's area over the
/// product of its sides. It is zero for points that coincide.
fn curvature(a: &Vector3<f64>, b: &Vector3<f64>, c: &Vector3<f64>) -> f64 {
    let (ab, bc, ca) = (b - a, c - b, a - c);
    let sides = ab.norm() * bc.norm() * ca.norm();
    if sides > 0.0 {
        2.0 * ab.cross(&bc).norm() / sides
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curvature_of_a_circle() {
        let at = |t: f64| Vector3::new(0.3 * t.cos(), 0.3 * t.sin(), 1.0);
        let k = curvature(&at(0.1), &at(0.4), &at(0.45));
        assert!((k - 1.0 / 0.3).abs() < 1e-9);
        assert_eq!(curvature(&at(0.1), &at(0.1), &at(0.2)), 0.0);
        let round = crate::motion::trajectory::tests::path(0.1, 20, at);
        let curvatures = round.curvatures();
        assert_eq!(curvatures.len(), 18);
        assert!(curvatures.iter().all(|k| (k - 1.0 / 0.3).abs() < 1e-9));
    }

    /// A falling path that swings at 2 Hz turns twice per period, whatever the rate of points.
    #[test]
    fn a_flutter_turns_twice_per_period() {
        for rate in [60.0, 120.0, 480.0] {
            let mut finder = TurnFinder::new(0.0365, TurnFinder::TOLERANCE);
            let mut turns = Vec::new();
            for i in 0..(3.0 * rate) as usize {
                let t = i as f64 / rate;
                let phase = 4.0 * std::f64::consts::PI * t;
                if finder.push(Vector3::new(0.1 * phase.sin(), -0.6 * t, 0.0)) {
                    turns.push(t);
                }
            }
            assert_eq!(turns.len(), 12, "{rate}");
            // Each is reported soon after the turn at (k + ½)/4 s.
            assert!((0.0..0.08).contains(&(turns[0] - 0.125)), "{turns:?}");
        }
        let mut straight = TurnFinder::new(0.0365, TurnFinder::TOLERANCE);
        assert!((0..100).all(|i| !straight.push(Vector3::y() * (-0.01 * f64::from(i)))));
    }
}
