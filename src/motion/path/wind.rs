//! Falls in wind: displacement by the flow, Bézier smoothing, and leaning (thesis § 3.5.2).

use super::track::{Key, MotionPath};
use crate::error::Error;
use crate::flow::Flow;
use rapier3d::math::{Real, Rotation, Vector};

/// How a synthesized fall gives way to wind.
///
/// ```
/// use rapier3d_immersed::motion::path::WindResponse;
/// use rapier3d_immersed::rapier3d::prelude::*;
///
/// // In the mean wind along x a body leans downwind by 0.4 rad.
/// let lean = WindResponse::default().lean(Vector::X * 3.0);
/// assert!((lean * Vector::Y).angle_between(Vector::Y) - 0.4 < 1e-5);
/// assert!((lean * Vector::Y).x > 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindResponse {
    /// |U|: mean speed of the wind, m/s, that leaning is measured by. Default 3.
    pub mean_speed: Real,
    /// W of (3.19): how far the body leans in the mean wind, rad. "Maximum motion angle" in the thesis;
    /// gusts lean it up to twice as far here. Default 0.4.
    pub angle: Real,
    /// Time in which the body takes on the velocity of a gust, s, when it is blown along step by step.
    /// Default 0.1.
    pub delay: Real,
}

impl Default for WindResponse {
    fn default() -> Self {
        Self {
            mean_speed: 3.0,
            angle: 0.4,
            delay: 0.1,
        }
    }
}

impl WindResponse {
    /// # Errors
    /// [`Error::InvalidParameter`] or [`Error::OutOfRange`] names the value that cannot be.
    pub fn check(&self) -> Result<(), Error> {
        Error::check_positive("mean speed", self.mean_speed.into())?;
        Error::check_range("angle", self.angle.into(), 0.0, 1.5)?;
        Error::check_positive("delay", self.delay.into())?;
        Ok(())
    }

    /// Lean of a body in wind of this velocity, (3.19): θ = W |u|/|U|, downwind, about a horizontal
    /// axis. `up` is the fall's.
    #[inline]
    pub fn lean(&self, wind: Vector) -> Rotation {
        let axis = Vector::Y.cross(wind);
        let across = axis.length();
        if across < 1e-6 {
            return Rotation::IDENTITY;
        }
        let strength = (wind.length() / self.mean_speed).min(2.0);
        // A vertical wind has no axis to lean about, so that the lean fades toward it.
        let share = across / wind.length();
        Rotation::from_axis_angle(axis / across, self.angle * strength * share)
    }
}

/// A point of the composite cubic Bézier curve with control points p: piece i of a uniform B-spline,
/// `s` ∈ [0, 1] along it, by de Casteljau's construction. It passes through its first and last points
/// and is twice continuously differentiable.
///
/// One Bézier curve of all points (thesis § 3.5.2) would smooth everything away: with a hundred points
/// its basis functions are twenty points wide.
fn bezier(points: &[Vector], i: usize, s: Real) -> (Vector, Vector) {
    let last = points.len() - 1;
    let p = |k: isize| {
        if k < 0 {
            points[0] * 2.0 - points[1]
        } else if k as usize > last {
            points[last] * 2.0 - points[last - 1]
        } else {
            points[k as usize]
        }
    };
    let i = i as isize;
    let (a, b, c, d) = (p(i - 1), p(i), p(i + 1), p(i + 2));
    let b0 = (a + b * 4.0 + c) / 6.0;
    let b1 = (b * 2.0 + c) / 3.0;
    let b2 = (b + c * 2.0) / 3.0;
    let b3 = (b + c * 4.0 + d) / 6.0;
    let (l, m, n) = (b0.lerp(b1, s), b1.lerp(b2, s), b2.lerp(b3, s));
    let (l, m) = (l.lerp(m, s), m.lerp(n, s));
    (l.lerp(m, s), (m - l) * 3.0)
}

impl MotionPath {
    /// The same fall in a wind, released at `start` (world axes, m) and `time` (s) and turned by
    /// `heading` about the vertical (rad): p₁ = p′ + u δt at every keyframe, smoothed by Bézier curves
    /// with these as control points, and leaning with the wind. The result is relative to `start` in world
    /// axes, so that its own heading is 0.
    ///
    /// ```
    /// use rapier3d_immersed::flow::Uniform;
    /// use rapier3d_immersed::motion::Regime;
    /// use rapier3d_immersed::motion::path::{Key, MotionPath, WindResponse};
    /// use rapier3d_immersed::rapier3d::prelude::*;
    ///
    /// let keys = (0..=120).map(|i| Key {
    ///     position: Vector::Y * (-i as f32 / 120.0),
    ///     velocity: -Vector::Y,
    ///     attitude: Rotation::IDENTITY,
    /// });
    /// let fall = MotionPath::new(1.0 / 120.0, keys.collect(), vec![(0.0, Regime::SteadyDescent)])?;
    /// let wind = Uniform::new(2.0, 0.0, 0.0);
    /// let blown = fall.in_wind(&wind, Vector::ZERO, 0.0, 0.0, &WindResponse::default())?;
    /// // After a second in a wind of 2 m/s it lands 2 m downwind.
    /// assert!((blown.at(1.0).position - Vector::new(2.0, -1.0, 0.0)).length() < 0.02);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`WindResponse::check`]; [`Error::NotFinite`] if the flow or the release is not finite.
    pub fn in_wind(
        &self,
        flow: &dyn Flow,
        start: Vector,
        heading: Real,
        time: f64,
        response: &WindResponse,
    ) -> Result<Self, Error> {
        response.check()?;
        let turn = Rotation::from_axis_angle(Vector::Y, heading);
        let h = self.interval();
        let mut points = Vec::with_capacity(self.keys().len());
        let mut winds = Vec::with_capacity(self.keys().len());
        let mut drift = Vector::ZERO;
        for (i, key) in self.keys().iter().enumerate() {
            let point = turn * key.position + drift;
            let now = time + i as f64 * f64::from(h);
            let wind = flow.velocity(start + point, now);
            points.push(point);
            winds.push(wind);
            drift += wind * h;
        }
        let keys = self.keys().iter().enumerate().map(|(i, key)| {
            let last = points.len() - 2;
            let (position, slope) = bezier(&points, i.min(last), if i > last { 1.0 } else { 0.0 });
            Key {
                position,
                velocity: slope / h,
                attitude: (response.lean(winds[i]) * turn * key.attitude).normalize(),
            }
        });
        Self::new(h, keys.collect(), self.regimes().to_vec())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::{Still, Uniform};
    use crate::motion::Regime;

    fn fall() -> MotionPath {
        let keys = (0..=240).map(|i| {
            let t = i as Real / 120.0;
            let phase = 8.0 * t;
            Key {
                position: Vector::new(0.1 * (1.0 - phase.cos()), -t, 0.0),
                velocity: Vector::new(0.8 * phase.sin(), -1.0, 0.0),
                attitude: Rotation::IDENTITY,
            }
        });
        MotionPath::new(
            1.0 / 120.0,
            keys.collect(),
            vec![(0.0, Regime::PeriodicFlutter)],
        )
        .unwrap()
    }

    /// Neighbouring pieces share their end, its velocity and its curvature; a straight line stays one.
    #[test]
    fn bezier_pieces_join() {
        let points: Vec<Vector> = (0..9)
            .map(|i| Vector::new(i as Real, ((i * i) % 7) as Real, 0.0))
            .collect();
        let bend = |i, s: Real| {
            let e = 0.05;
            (bezier(&points, i, s + e).1 - bezier(&points, i, s - e).1) / (2.0 * e)
        };
        for i in 0..7 {
            let (p, v) = bezier(&points, i, 1.0);
            let (q, w) = bezier(&points, i + 1, 0.0);
            assert!((p - q).length() < 1e-5 && (v - w).length() < 1e-5);
            // The bend is linear within a piece, so that two bends inside give those at its ends.
            let end = bend(i, 0.8) + (bend(i, 0.8) - bend(i, 0.6));
            let start = bend(i + 1, 0.2) - (bend(i + 1, 0.4) - bend(i + 1, 0.2));
            assert!((end - start).length() < 1e-3, "{end} {start}");
        }
        assert!((bezier(&points, 0, 0.0).0 - points[0]).length() < 1e-6);
        assert!((bezier(&points, 7, 1.0).0 - points[8]).length() < 1e-5);
    }

    /// Without wind the smoothing takes (2 + cos ωδ)/3 of an oscillation: 0.15 % at 8 rad/s and 120 Hz.
    /// A uniform wind carries the body along, and leans it by W.
    #[test]
    fn uniform_wind() {
        let fall = fall();
        let response = WindResponse::default();
        let still = fall
            .in_wind(&Still, Vector::ZERO, 0.0, 0.0, &response)
            .unwrap();
        for (a, b) in fall.keys().iter().zip(still.keys()) {
            assert!((a.position - b.position).length() < 2e-4);
            assert_eq!(a.attitude, b.attitude);
        }
        let blown = fall
            .in_wind(&Uniform::new(3.0, 0.0, 0.0), Vector::Y, 0.0, 0.0, &response)
            .unwrap();
        for t in [0.5, 1.0, 1.5] {
            let shift = blown.at(t).position - still.at(t).position;
            assert!((shift - Vector::X * (3.0 * t)).length() < 1e-4, "{shift}");
        }
        let normal = blown.at(1.0).attitude * Vector::Y;
        assert!((normal.angle_between(Vector::Y) - response.angle).abs() < 1e-3);
        assert!(normal.x > 0.0);
    }

    #[test]
    fn bad_winds_are_refused() {
        let bad = WindResponse {
            mean_speed: 0.0,
            ..WindResponse::default()
        };
        let blow = |flow: &dyn Flow, response| {
            fall()
                .in_wind(flow, Vector::ZERO, 0.0, 0.0, response)
                .is_err()
        };
        assert!(blow(&Still, &bad));
        assert!(blow(
            &Uniform::new(Real::NAN, 0.0, 0.0),
            &WindResponse::default()
        ));
    }
}
