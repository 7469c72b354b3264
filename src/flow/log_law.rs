//! The surface layer of the atmosphere: the mean wind grows with the logarithm of height.

use super::{Flow, analytic::unit};
use crate::error::Error;
use crate::math;
use rapier3d::math::{Real, Vector};
use rapier3d::na::ComplexField;

/// von Kármán's constant, 0.40 (the thesis's and the usual value; measured 0.38 to 0.42).
pub(super) const VON_KARMAN: Real = 0.40;

/// Mean wind over rough ground: U(h) = (u*/κ) ln(h/z₀), zero at and below z₀ (thesis (3.14)).
///
/// `h` is the height above ground less the displacement height of what grows on it.
///
/// ```
/// use rapier3d_immersed::flow::{Flow, LogLaw};
/// use rapier3d_immersed::rapier3d::prelude::*;
///
/// // 4 m/s at a height of 10 m, over ground of roughness length 0.3 m.
/// let wind = LogLaw::new(Vector::X, Vector::Y, 4.0, 10.0, 0.3)?;
/// assert!((wind.velocity(Vector::Y * 10.0, 0.0).x - 4.0).abs() < 1e-5);
/// // Three quarters of the logarithm's way down, at 0.3·(10/0.3)^¼ m, a quarter of it is left.
/// assert!((wind.speed(0.3 * (10.0_f32 / 0.3).powf(0.25)) - 1.0).abs() < 1e-5);
/// assert_eq!(wind.speed(0.3), 0.0);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogLaw {
    direction: Vector,
    up: Vector,
    friction_velocity: Real,
    roughness: Real,
    ground: Real,
}

impl LogLaw {
    /// Wind along `direction` (normalized here) that blows with `speed` (m/s) at `height` (m above
    /// ground), over ground of roughness length `roughness` (m: grass 0.03, thesis 0.3, town 1)
    /// at the world's origin. `up` is opposite to gravity, perpendicular to `direction`.
    ///
    /// # Errors
    /// If a number is not finite, a vector has no direction, the two are not perpendicular,
    /// `roughness` is not positive or `height` not above it.
    pub fn new(
        direction: Vector,
        up: Vector,
        speed: Real,
        height: Real,
        roughness: Real,
    ) -> Result<Self, Error> {
        let (direction, up) = (unit("direction", direction)?, unit("up", up)?);
        let tilt = direction.dot(up);
        Error::check(
            "direction · up",
            tilt.into(),
            tilt.abs() < 1.0e-3,
            "zero: wind blows along the ground",
        )?;
        Error::check_finite("speed", speed.into())?;
        Error::check_positive("roughness", roughness.into())?;
        Error::check(
            "height",
            height.into(),
            height.is_finite() && height > roughness,
            "finite and above the roughness length",
        )?;
        Ok(Self {
            direction,
            up,
            friction_velocity: speed * VON_KARMAN / math::ln(height / roughness),
            roughness,
            ground: 0.0,
        })
    }

    /// The same wind over ground whose zero-plane is at `ground` (m along `up`): the ground's
    /// height plus the displacement height, about ⅔ of the height of a crop or a forest.
    ///
    /// # Errors
    /// If `ground` is not finite.
    pub fn with_ground(self, ground: Real) -> Result<Self, Error> {
        Error::check_finite("ground", ground.into())?;
        Ok(Self { ground, ..self })
    }

    /// Friction velocity u*, m/s.
    pub fn friction_velocity(&self) -> Real {
        self.friction_velocity
    }

    /// Height of `point` above the zero-plane, m.
    pub fn height(&self, point: Vector) -> Real {
        point.dot(self.up) - self.ground
    }

    /// Mean wind speed at `height` (m above the zero-plane), m/s.
    pub fn speed(&self, height: Real) -> Real {
        if height > self.roughness {
            self.friction_velocity / VON_KARMAN * ComplexField::ln(height / self.roughness)
        } else {
            0.0
        }
    }

    /// Turbulent kinetic energy of the equilibrium layer, u*²/√C_μ = 3.33 u*², m²/s². Measurements in
    /// the field find 5.5 u*², which includes the inactive large eddies.
    pub fn turbulent_kinetic_energy(&self) -> Real {
        self.friction_velocity * self.friction_velocity / 0.3
    }

    /// Dissipation rate u*³/(κ h) at `height` (m above the zero-plane; held below z₀), m²/s³.
    pub fn dissipation(&self, height: Real) -> Real {
        self.friction_velocity.abs().powi(3) / (VON_KARMAN * height.max(self.roughness))
    }
}

impl Flow for LogLaw {
    fn velocity(&self, point: Vector, _time: f64) -> Vector {
        self.direction * self.speed(self.height(point))
    }

    fn vorticity(&self, point: Vector, _time: f64) -> Vector {
        let height = self.height(point);
        if height > self.roughness {
            self.up.cross(self.direction) * (self.friction_velocity / (VON_KARMAN * height))
        } else {
            Vector::ZERO
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::tests::{assert_curl_matches, points};

    #[test]
    fn log_law_is_the_given_speed_and_zero_at_the_roughness_height() {
        let wind = LogLaw::new(Vector::Z, Vector::Y, 4.0, 10.0, 0.3).unwrap();
        let at = |h: f32| wind.velocity(Vector::new(3.0, h, 1.0), 0.0);
        assert!((at(10.0) - Vector::Z * 4.0).length() < 1.0e-5);
        assert_eq!(at(0.3), Vector::ZERO);
        assert_eq!(at(-5.0), Vector::ZERO);
        // u* = κU/ln(h/z0) = .4·4/ln(33.33) = .45629
        assert!((wind.friction_velocity() - 0.45629).abs() < 1.0e-5);
        for point in points() {
            assert_curl_matches(&wind, point + Vector::Y, 0.0);
        }
        let raised = wind.with_ground(2.0).unwrap();
        assert!((raised.velocity(Vector::Y * 12.0, 0.0).z - 4.0).abs() < 1.0e-5);
    }

    /// In the equilibrium layer production −u'w' dU/dh = u*³/(κh) equals dissipation, and the
    /// k–ε eddy viscosity C_μk²/ε equals κu*h.
    #[test]
    fn surface_layer_is_in_equilibrium() {
        let wind = LogLaw::new(Vector::X, Vector::Y, 5.0, 10.0, 0.03).unwrap();
        let (us, h) = (wind.friction_velocity(), 4.0);
        let (k, epsilon) = (wind.turbulent_kinetic_energy(), wind.dissipation(h));
        let shear = wind.vorticity(Vector::Y * h, 0.0).length();
        assert!((us * us * shear / epsilon - 1.0).abs() < 1.0e-5);
        assert!((0.09 * k * k / epsilon / (VON_KARMAN * us * h) - 1.0).abs() < 1.0e-5);
    }

    #[test]
    fn bad_log_laws_are_errors() {
        let new = |d, u, speed, height, z0| LogLaw::new(d, u, speed, height, z0).is_err();
        assert!(new(Vector::ZERO, Vector::Y, 1.0, 10.0, 0.1));
        assert!(new(Vector::Y, Vector::Y, 1.0, 10.0, 0.1));
        assert!(new(Vector::X, Vector::Y, f32::NAN, 10.0, 0.1));
        assert!(new(Vector::X, Vector::Y, 1.0, 0.05, 0.1));
        assert!(new(Vector::X, Vector::Y, 1.0, 10.0, 0.0));
        let wind = LogLaw::new(Vector::X, Vector::Y, 1.0, 10.0, 0.1).unwrap();
        assert!(wind.with_ground(f32::INFINITY).is_err());
    }
}
