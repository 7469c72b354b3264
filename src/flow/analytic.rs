//! Flows with a closed form: shear, vortex, gust.

use super::Flow;
use crate::error::Error;
use crate::math;
use rapier3d::math::{Real, Vector};

/// A flow whose velocity changes linearly across one direction: U = velocity + rate · (x − origin)·across.
///
/// It turns a body that follows it at half the vorticity, across × rate.
///
/// ```
/// use rapier3d_immersed::flow::{Flow, Shear};
/// use rapier3d_immersed::rapier3d::prelude::*;
///
/// // A wind along x that gains 0.5 m/s per meter of height.
/// let wind = Shear { across: Vector::Y, rate: Vector::X * 0.5, ..Shear::default() };
/// assert_eq!(wind.velocity(Vector::Y * 4.0, 0.0), Vector::X * 2.0);
/// // A ball that it carries along rolls forward, about −z.
/// assert_eq!(wind.vorticity(Vector::Y * 4.0, 0.0), Vector::Z * -0.5);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shear {
    /// A point where the fluid moves with `velocity`, m.
    pub origin: Vector,
    /// Velocity at `origin`, m/s.
    pub velocity: Vector,
    /// Direction along which the velocity changes; a unit vector.
    pub across: Vector,
    /// How much the velocity changes per meter along `across`, 1/s. In an incompressible flow it is
    /// perpendicular to `across`.
    pub rate: Vector,
}

impl Flow for Shear {
    fn velocity(&self, point: Vector, _time: f64) -> Vector {
        self.velocity + self.rate * (point - self.origin).dot(self.across)
    }

    fn vorticity(&self, _point: Vector, _time: f64) -> Vector {
        self.across.cross(self.rate)
    }
}

/// A Lamb–Oseen vortex: u_θ = Γ/(2πr) (1 − exp(−r²/r_c²)), finite on its axis.
///
/// Source: Lamb, Hydrodynamics, §334a. The vortex does not decay: `core_radius` is √(4νt) of one instant.
///
/// ```
/// use rapier3d_immersed::flow::{Flow, Vortex};
/// use rapier3d_immersed::rapier3d::prelude::*;
///
/// let vortex = Vortex::new(Vector::ZERO, Vector::Y, 1.0, 0.05)?;
/// // Far outside of the core it turns like a line vortex, with Γ/(2πr).
/// let speed = vortex.velocity(Vector::X, 0.0).length();
/// assert!((speed - 1.0 / std::f32::consts::TAU).abs() < 1e-6);
/// // It rests on its axis.
/// assert_eq!(vortex.velocity(Vector::Y, 0.0), Vector::ZERO);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vortex {
    center: Vector,
    axis: Vector,
    circulation: Real,
    core_radius: Real,
}

impl Vortex {
    /// A vortex around the line through `center` (m) along `axis` (normalized here), with
    /// `circulation` (m²/s, right-handed about `axis`) and `core_radius` (m).
    ///
    /// # Errors
    /// If a number is not finite, `axis` has no direction or `core_radius` is not positive.
    pub fn new(
        center: Vector,
        axis: Vector,
        circulation: Real,
        core_radius: Real,
    ) -> Result<Self, Error> {
        for value in center.to_array() {
            Error::check_finite("center", value.into())?;
        }
        Error::check_finite("circulation", circulation.into())?;
        Error::check_positive("core_radius", core_radius.into())?;
        Ok(Self {
            center,
            axis: unit("axis", axis)?,
            circulation,
            core_radius,
        })
    }
}

/// `direction` with length one, or the error that names it.
pub(super) fn unit(parameter: &'static str, direction: Vector) -> Result<Vector, Error> {
    let length = direction.length();
    Error::check(
        parameter,
        length.into(),
        length.is_finite() && length > 1.0e-12,
        "a finite vector that is not zero (its length is shown)",
    )?;
    Ok(direction / length)
}

impl Flow for Vortex {
    fn velocity(&self, point: Vector, _time: f64) -> Vector {
        let arm = point - self.center;
        let arm = arm - self.axis * arm.dot(self.axis);
        let core2 = self.core_radius * self.core_radius;
        let s = arm.length_squared() / core2;
        // (1 − e^{−s})/s, which is 1 on the axis.
        let fill = if s < 1.0e-3 {
            1.0 - 0.5 * s
        } else {
            -math::exp_m1(-s) / s
        };
        self.axis.cross(arm) * (self.circulation / (core::f32::consts::TAU * core2) * fill)
    }

    fn vorticity(&self, point: Vector, _time: f64) -> Vector {
        let arm = point - self.center;
        let arm = arm - self.axis * arm.dot(self.axis);
        let core2 = self.core_radius * self.core_radius;
        let s = arm.length_squared() / core2;
        self.axis * (self.circulation / (core::f32::consts::PI * core2) * math::exp(-s))
    }
}

/// A gust that rises and falls smoothly once, ½ V (1 − cos 2πτ), the "1-cos" gust of airworthiness rules.
///
/// τ = (t − start − slowness·x)/duration, and the flow is still outside 0 < τ < 1.
///
/// ```
/// use rapier3d_immersed::flow::{Flow, Gust};
/// use rapier3d_immersed::rapier3d::prelude::*;
///
/// // A gust of 8 m/s whose front travels along x at 10 m/s and that lasts for 2 s.
/// let gust = Gust { velocity: Vector::Y * 8.0, start: 0.0, duration: 2.0, slowness: Vector::X / 10.0 };
/// // It peaks at the origin after 1 s, and ten meters downwind one second later.
/// assert!((gust.velocity(Vector::ZERO, 1.0).y - 8.0).abs() < 1e-5);
/// assert!((gust.velocity(Vector::X * 10.0, 2.0).y - 8.0).abs() < 1e-5);
/// assert_eq!(gust.velocity(Vector::ZERO, 2.5), Vector::ZERO);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gust {
    /// Velocity at the peak, m/s.
    pub velocity: Vector,
    /// When the gust reaches the world's origin, s.
    pub start: f64,
    /// How long it lasts at one point, s. Unless this is positive, the flow is still everywhere.
    pub duration: f64,
    /// Direction in which the gust front travels, divided by its speed, s/m. Zero (the default)
    /// for a gust that is everywhere at once.
    pub slowness: Vector,
}

impl Default for Gust {
    /// No gust at all: zero velocity, 1 s long.
    fn default() -> Self {
        Self {
            velocity: Vector::ZERO,
            start: 0.0,
            duration: 1.0,
            slowness: Vector::ZERO,
        }
    }
}

impl Gust {
    /// Phase angle 2πτ if the gust blows at `point` and `time`.
    fn phase(&self, point: Vector, time: f64) -> Option<Real> {
        let tau = (time - self.start - f64::from(self.slowness.dot(point))) / self.duration;
        (self.duration > 0.0 && tau > 0.0 && tau < 1.0)
            .then_some((core::f64::consts::TAU * tau) as Real)
    }
}

impl Flow for Gust {
    fn velocity(&self, point: Vector, time: f64) -> Vector {
        self.phase(point, time).map_or(Vector::ZERO, |phase| {
            self.velocity * (0.5 * (1.0 - math::cos(phase)))
        })
    }

    fn vorticity(&self, point: Vector, time: f64) -> Vector {
        self.phase(point, time).map_or(Vector::ZERO, |phase| {
            let growth = math::sin(phase) * core::f32::consts::PI / self.duration as Real;
            -self.slowness.cross(self.velocity) * growth
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::tests::{assert_curl_matches, points};

    /// The vorticity of each flow agrees with central differences of its velocity.
    #[test]
    fn vorticity_is_the_curl_of_the_velocity() {
        let shear = Shear {
            origin: Vector::new(0.3, 0.1, -0.2),
            velocity: Vector::X,
            across: Vector::Y,
            rate: Vector::new(2.0, 0.0, -1.0),
        };
        let vortex = Vortex::new(Vector::ZERO, Vector::new(1.0, 2.0, 3.0), 1.5, 0.7).unwrap();
        let gust = Gust {
            velocity: Vector::new(0.0, 3.0, 1.0),
            start: -0.4,
            duration: 2.0,
            slowness: Vector::new(0.1, 0.0, 0.0),
        };
        for point in points() {
            assert_curl_matches(&shear, point, 0.5);
            assert_curl_matches(&vortex, point, 0.5);
            assert_curl_matches(&gust, point, 0.5);
        }
    }

    /// Circulation of a Lamb–Oseen vortex through r is Γ(1 − e^{−r²/r_c²}), by quadrature of u·dl.
    #[test]
    fn vortex_has_its_circulation() {
        let vortex = Vortex::new(Vector::new(1.0, 0.0, 0.0), Vector::Z, 2.0, 0.5).unwrap();
        for radius in [0.1f32, 0.5, 2.0] {
            let steps = 256;
            let mut sum = 0.0;
            for i in 0..steps {
                let angle = core::f32::consts::TAU * i as f32 / steps as f32;
                let (sin, cos) = angle.sin_cos();
                let point = Vector::new(1.0 + radius * cos, radius * sin, 0.3);
                sum += vortex.velocity(point, 0.0).dot(Vector::new(-sin, cos, 0.0));
            }
            let found = sum / steps as f32 * core::f32::consts::TAU * radius;
            let exact = 2.0 * (1.0 - (-radius * radius / 0.25).exp());
            // The tolerance is the rounding of a sum of 256 terms in f32.
            assert!((found - exact).abs() < 1.0e-5 * 2.0, "{found} {exact}");
        }
    }

    #[test]
    fn gust_peaks_halfway_and_ends() {
        let gust = Gust {
            velocity: Vector::X * 8.0,
            start: 1.0,
            duration: 2.0,
            slowness: Vector::X / 10.0,
        };
        let at = |x: f32, t: f64| gust.velocity(Vector::X * x, t).x;
        assert_eq!(at(0.0, 1.0), 0.0);
        assert!((at(0.0, 2.0) - 8.0).abs() < 1.0e-6);
        assert!((at(0.0, 1.5) - 4.0).abs() < 1.0e-6);
        assert_eq!(at(0.0, 3.0), 0.0);
        // Ten meters downwind everything happens a second later.
        assert!((at(10.0, 3.0) - 8.0).abs() < 1.0e-6);
        assert_eq!(
            Gust {
                duration: 0.0,
                ..gust
            }
            .velocity(Vector::ZERO, 1.0),
            Vector::ZERO
        );
    }

    #[test]
    fn bad_vortices_are_errors() {
        let new = |axis, circulation, core| Vortex::new(Vector::ZERO, axis, circulation, core);
        assert!(new(Vector::ZERO, 1.0, 1.0).is_err());
        assert!(new(Vector::Z, f32::NAN, 1.0).is_err());
        assert!(new(Vector::Z, 1.0, 0.0).is_err());
        assert!(new(Vector::new(f32::INFINITY, 0.0, 0.0), 1.0, 1.0).is_err());
        assert!(Vortex::new(Vector::NAN, Vector::Z, 1.0, 1.0).is_err());
    }
}
