//! A flow in a volume: a fan's stream, a river, an updraft.

use super::Flow;
use crate::error::Error;
use rapier3d::geometry::SharedShape;
use rapier3d::math::{Pose, Real, Vector};

/// A flow inside a shape that fades outside of it: the whole flow inside, none from `falloff` meters away on, and between a
/// smooth passage, `1 − t²(3 − 2t)` of it at the share t of the way.
///
/// Fading makes a vorticity and a divergence of its own; the first is in [`Flow::vorticity`] by differences of the velocity,
/// the second means that fluid comes from nowhere at the edges, as in any such volume.
///
/// ```
/// use rapier3d_immersed::flow::{Flow, Layers, Uniform, Within};
/// use rapier3d_immersed::rapier3d::prelude::*;
///
/// // A fan's stream of 5 m/s, 1 m wide and 6 m long, in a breeze.
/// let stream = Within::new(
///     SharedShape::cuboid(3.0, 0.5, 0.5),
///     Pose::from_translation(Vector::X * 3.0),
///     0.3,
///     Uniform::new(5.0, 0.0, 0.0),
/// )?;
/// let flow = Layers::new().with(Uniform::new(0.0, 0.0, 1.0)).with(stream);
/// assert_eq!(flow.velocity(Vector::X * 2.0, 0.0), Vector::new(5.0, 0.0, 1.0));
/// assert_eq!(flow.velocity(Vector::new(2.0, 0.9, 0.0), 0.0), Vector::Z);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone)]
pub struct Within<F> {
    shape: SharedShape,
    pose: Pose,
    falloff: Real,
    flow: F,
}

impl<F: Flow> Within<F> {
    /// A flow inside a shape at a pose, fading over `falloff` meters outside of it (0 is a sharp edge).
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a falloff that is negative or no number; [`Error::NotFinite`] for the pose.
    pub fn new(shape: SharedShape, pose: Pose, falloff: Real, flow: F) -> Result<Self, Error> {
        Error::check_not_negative("falloff of a volume of flow", falloff.into())?;
        let place = pose.translation.to_array().map(f64::from);
        Error::check_all_finite("position of a volume of flow", &place)?;
        let turn = pose.rotation.to_array().map(f64::from);
        Error::check_all_finite("orientation of a volume of flow", &turn)?;
        Ok(Self {
            shape,
            pose,
            falloff,
            flow,
        })
    }

    /// Share of the flow at a point.
    fn share(&self, point: Vector) -> Real {
        let distance = self.shape.distance_to_point(&self.pose, point, true);
        if distance <= 0.0 {
            return 1.0;
        }
        if distance >= self.falloff {
            return 0.0;
        }
        let t = distance / self.falloff;
        1.0 - t * t * (3.0 - 2.0 * t)
    }
}

impl<F: Flow> Flow for Within<F> {
    fn velocity(&self, point: Vector, time: f64) -> Vector {
        let share = self.share(point);
        if share > 0.0 {
            self.flow.velocity(point, time) * share
        } else {
            Vector::ZERO
        }
    }

    fn vorticity(&self, point: Vector, time: f64) -> Vector {
        let share = self.share(point);
        if share <= 0.0 {
            return Vector::ZERO;
        }
        let inside = self.flow.vorticity(point, time) * share;
        if share == 1.0 {
            return inside;
        }
        // ∇share × U.
        let step = (0.02 * self.falloff).max(1e-4 * (1.0 + point.abs().max_element()));
        let slope = |axis: Vector| {
            (self.share(point + axis * step) - self.share(point - axis * step)) / (2.0 * step)
        };
        let slope = Vector::new(slope(Vector::X), slope(Vector::Y), slope(Vector::Z));
        inside + slope.cross(self.flow.velocity(point, time))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::tests::assert_curl_matches;
    use crate::flow::{Shear, Uniform};

    /// Whole inside, half at half of the falloff, none beyond; the vorticity is the curl on the way.
    #[test]
    fn flows_fade_outside() {
        let ball = || SharedShape::ball(1.0);
        let shear = Shear {
            across: Vector::Y,
            rate: Vector::X,
            ..Shear::default()
        };
        let stream = Within::new(ball(), Pose::IDENTITY, 1.0, shear).unwrap();
        let share = |x: Real| stream.velocity(Vector::new(x, 0.5, 0.0), 0.0).x / 0.5;
        assert_eq!(share(0.3), 1.0);
        assert_eq!(share(2.5), 0.0);
        let half = Within::new(ball(), Pose::IDENTITY, 1.0, Uniform::new(2.0, 0.0, 0.0)).unwrap();
        let middle = half.velocity(Vector::Z * 1.5, 0.0).x;
        assert!((middle - 1.0).abs() < 1e-5, "{middle}");
        for point in [
            Vector::new(1.1, 0.6, 0.3),
            Vector::new(0.2, 0.1, 0.3),
            Vector::new(-0.9, -1.2, 0.4),
        ] {
            assert_curl_matches(&stream, point, 0.0);
        }
        let sharp = Within::new(ball(), Pose::IDENTITY, 0.0, Uniform::new(2.0, 0.0, 0.0)).unwrap();
        assert_eq!(sharp.velocity(Vector::X * 1.01, 0.0), Vector::ZERO);
        assert!(Within::new(ball(), Pose::IDENTITY, -1.0, Uniform::default()).is_err());
        assert!(Within::new(ball(), Pose::IDENTITY, Real::NAN, Uniform::default()).is_err());
    }
}
