//! Engines: what pushes a body by itself.

use crate::error::Error;
use rapier3d::na::Vector3;

/// A thruster, propeller or jet fixed to a body. [`Immersion::set_thrust`](crate::Immersion::set_thrust) drives it.
///
/// ```
/// use rapier3d_immersed::rapier3d::na::Vector3;
/// use rapier3d_immersed::{Propeller, Thruster};
///
/// // So many newtons along +x …
/// let jet = Thruster::new(Vector3::new(-0.2, 0.0, 0.1), Vector3::x())?;
/// // … or so many turns per second of a propeller of 76 mm, K_T = 0.45 − 0.4 J, K_Q = 0.06 − 0.05 J.
/// let screw = jet.with_propeller(Propeller::new(0.076, [0.45, 0.4], [0.06, 0.05])?);
/// assert!(Thruster::new(Vector3::zeros(), Vector3::zeros()).is_err());
/// // At a standstill, 50 turns/s in fresh water: ρ n² D⁴ K_T.
/// let [thrust, _] = screw.action(50.0, 0.0, 1000.0);
/// assert!((thrust - 1000.0 * 2500.0 * 0.076f64.powi(4) * 0.45).abs() < 1e-9);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Thruster {
    /// Where it pushes, m, in the body's frame.
    pub point: Vector3<f64>,
    /// Where it pushes to, of length 1, in the body's frame.
    pub direction: Vector3<f64>,
    /// The propeller that it is driven by; `None` is driven by a force.
    pub propeller: Option<Propeller>,
}

/// A propeller in open water: thrust `ρ n² D⁴ K_T` and torque `ρ n² D⁵ K_Q` at n turns per second, with `K = k₀ − k₁ J`, linear in
/// the advance ratio `J = V/(nD)` (Carlton, *Marine Propellers and Propulsion*, ch. 6), V being its velocity through the
/// fluid along its thrust.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Propeller {
    /// D, m.
    pub diameter: f64,
    /// k₀ and k₁ of K_T.
    pub thrust: [f64; 2],
    /// k₀ and k₁ of K_Q. The body feels the torque's reaction: against a right-handed turn about the thrust if
    /// k₀ is positive; negative ones are those of a left-handed propeller.
    pub torque: [f64; 2],
}

impl Propeller {
    /// # Errors
    /// [`Error::InvalidParameter`] or [`Error::NotFinite`]: the diameter must be positive, k₁ of the thrust not negative,
    /// and all finite.
    pub fn new(diameter: f64, thrust: [f64; 2], torque: [f64; 2]) -> Result<Self, Error> {
        let new = Self {
            diameter,
            thrust,
            torque,
        };
        new.check()?;
        Ok(new)
    }

    /// # Errors
    /// As of [`Propeller::new`].
    pub fn check(&self) -> Result<(), Error> {
        Error::check_positive("diameter of a propeller", self.diameter)?;
        Error::check_all_finite("coefficients of a propeller", &self.thrust)?;
        Error::check_all_finite("coefficients of a propeller", &self.torque)?;
        Error::check_not_negative("slope of a propeller's thrust", self.thrust[1])?;
        Ok(())
    }
}

impl Thruster {
    /// Pushes at a point, m, of the body's frame in a direction of any length but zero.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; [`Error::InvalidParameter`] if the direction has no length.
    pub fn new(point: Vector3<f64>, direction: Vector3<f64>) -> Result<Self, Error> {
        Error::check_all_finite("point of a thruster", point.as_slice())?;
        Error::check_all_finite("direction of a thruster", direction.as_slice())?;
        Error::check_positive("length of the direction of a thruster", direction.norm())?;
        Ok(Self {
            point,
            direction: direction.normalize(),
            propeller: None,
        })
    }

    /// The same thruster, driven by turns of a propeller.
    pub fn with_propeller(self, propeller: Propeller) -> Self {
        Self {
            propeller: Some(propeller),
            ..self
        }
    }

    /// # Errors
    /// Those of [`Thruster::new`] and [`Propeller::new`].
    pub fn check(&self) -> Result<(), Error> {
        let length = self.direction.norm();
        let unit =
            (Self::new(self.point, self.direction)?.direction - self.direction).norm() < 1e-6;
        Error::check("length of the direction of a thruster", length, unit, "1")?;
        self.propeller.map_or(Ok(()), |propeller| propeller.check())
    }

    /// Thrust, N, and torque about its direction, N·m, that the body feels: of a drive (N, or turns per second), at a
    /// speed (m/s) along the thrust through a fluid of a density (kg/m³).
    pub fn action(&self, drive: f64, speed: f64, density: f64) -> [f64; 2] {
        let Some(p) = &self.propeller else {
            return [drive, 0.0];
        };
        let (n, d) = (drive, p.diameter);
        // ρ n|n| D⁴ (k₀ − k₁ J): backward it is as good as forward.
        let of = |[first, second]: [f64; 2]| {
            density * d.powi(4) * n.abs() * (first * n - second * speed / d)
        };
        [of(p.thrust), -of(p.torque) * d]
    }

    /// How much less thrust a m/s more along it makes, N·s/m.
    pub(crate) fn slope(&self, drive: f64, density: f64) -> f64 {
        let of = |p: &Propeller| density * p.diameter.powi(3) * drive.abs() * p.thrust[1];
        self.propeller.as_ref().map_or(0.0, of)
    }
}
