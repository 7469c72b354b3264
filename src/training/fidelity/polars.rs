//! Flat plates and discs held in a steady stream: their lift, drag and center of pressure.

use super::{uniform_box, uniform_disc};
use crate::body::{DryMass, ImmersedBody};
use crate::dynamics::FreeBody;
use crate::error::Error;
use crate::fluid::Fluid;
use crate::hydro::HydroProperties;
use crate::hydro::viscous::ViscousLaw;
use crate::math;
use rapier3d::math::Vector;
use rapier3d::na::Vector3;
use rapier3d::parry::shape::{Cuboid, Cylinder};
use std::f64::consts::PI;

/// Chord of every plate, m, in a stream of water at [`SPEED`]: Re = 3·10⁴.
const CHORD: f64 = 0.1;
const SPEED: f64 = 0.3;
/// Thickness over chord: a thin plate's …
const THIN: f64 = 5e-3;
/// … and that of a throwing disc.
const FRISBEE: f64 = 0.1;
/// Span over chord of the plate that stands for two dimensions: its slope is 3 % below 2π.
const TWO_DIMENSIONAL: f64 = 60.0;
/// Angle of attack at which the lift slope is read, degrees.
const SLOPE_AT: usize = 3;
/// Angle of attack of the measured center of pressure, degrees.
const PRESSURE_AT: usize = 5;

/// A plate in a stream, and what is known of it.
///
/// ```
/// use rapier3d_immersed::ViscousLaw;
/// use rapier3d_immersed::training::fidelity::StaticPlate;
///
/// // A square plate: half the lift slope of one of aspect ratio 3.
/// let plates = StaticPlate::published()?;
/// assert!((plates[0].lift_slope - 1.48).abs() < 0.01);
/// let polar = plates[0].polar(&ViscousLaw::default())?;
/// // Broadside on there is drag and no lift.
/// let broadside = polar.points[90];
/// assert!(broadside.lift.abs() < 1e-3 && (broadside.drag - 1.16).abs() < 0.05);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct StaticPlate {
    /// Span²/area: 4/π for a disc, 0.0167 … ∞.
    pub aspect: f64,
    /// Whether it is a disc (otherwise a rectangle).
    pub round: bool,
    /// dC_L/dα at small angles of attack, 1/rad.
    pub lift_slope: f64,
    /// Greatest lift coefficient before the stall.
    pub max_lift: Option<f64>,
    /// Between which angles of attack that is, degrees.
    pub stall: Option<[f64; 2]>,
    /// Center of pressure at 5°, in chords from the leading edge.
    pub pressure_point: Option<f64>,
    /// Drag coefficient edge on, where it is not skin friction alone.
    pub edgewise_drag: Option<f64>,
    hydro: HydroProperties,
    mass: DryMass,
}

/// The forces at one angle of attack.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct PolarPoint {
    /// C_L on the planform's area.
    pub lift: f64,
    /// C_D.
    pub drag: f64,
    /// Center of pressure of the normal force, in chords from the leading edge; NaN edge on.
    pub pressure_point: f64,
}

/// A plate's forces at 0°, 1°, … 90°.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Polar {
    /// By whole degrees of the angle of attack.
    pub points: Vec<PolarPoint>,
}

impl StaticPlate {
    /// Rectangles of aspect ratio 1, 2, 6 and (as good as) ∞, and two discs.
    ///
    /// Lift slopes are Helmbold's (1942), `2π AR/(2 + √(AR² + 4))`; centers of pressure were computed with
    /// a vortex lattice; greatest lifts are those of thin flat plates at Re > 10⁴ in the literature, from
    /// memory: the uncertainty is in the bars. The drag of the thick disc is a throwing disc's (Potts &
    /// Crowther 2002).
    ///
    /// # Errors
    /// Those of [`HydroProperties::from_shape`], which the stored sizes do not give.
    pub fn published() -> Result<Vec<Self>, Error> {
        let square = Self {
            max_lift: Some(1.2),
            stall: Some([40.0, 45.0]),
            pressure_point: Some(0.170),
            ..Self::rectangle(1.0)?
        };
        let two = Self {
            max_lift: Some(0.95),
            stall: Some([20.0, 25.0]),
            pressure_point: Some(0.212),
            ..Self::rectangle(2.0)?
        };
        let six = Self {
            max_lift: Some(0.8),
            stall: Some([12.0, 15.0]),
            pressure_point: Some(0.240),
            ..Self::rectangle(6.0)?
        };
        let frisbee = Self {
            edgewise_drag: Some(0.08),
            ..Self::disc(FRISBEE)?
        };
        let strip = Self::rectangle(TWO_DIMENSIONAL)?;
        Ok(vec![square, two, six, strip, Self::disc(THIN)?, frisbee])
    }

    /// A thin rectangle of this span over chord, of which the lift slope alone is known.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if `aspect` is not positive and finite.
    pub fn rectangle(aspect: f64) -> Result<Self, Error> {
        Error::check_positive("aspect", aspect)?;
        let extents = [aspect * CHORD, THIN * CHORD, CHORD];
        let half = extents.map(|extent| 0.5 * extent as f32);
        let shape = Cuboid::new(Vector::from_array(half));
        Ok(Self {
            aspect,
            round: false,
            lift_slope: helmbold(aspect),
            max_lift: None,
            stall: None,
            pressure_point: None,
            edgewise_drag: None,
            hydro: HydroProperties::from_shape(&shape)?,
            mass: uniform_box(extents, 1000.0),
        })
    }

    /// A disc of this thickness over diameter, of which the lift slope alone is known.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if `thickness` is not positive and finite.
    pub fn disc(thickness: f64) -> Result<Self, Error> {
        Error::check_positive("thickness", thickness)?;
        let size = thickness * CHORD;
        let shape = Cylinder::new(0.5 * size as f32, 0.5 * CHORD as f32);
        let aspect = 4.0 / PI;
        Ok(Self {
            round: true,
            hydro: HydroProperties::from_shape(&shape)?,
            mass: uniform_disc(CHORD, size, 1000.0),
            ..Self::rectangle(aspect)?
        })
    }

    /// Its polar under this law.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] or [`Error::OutOfRange`] if a coefficient of the law cannot be.
    pub fn polar(&self, law: &ViscousLaw) -> Result<Polar, Error> {
        let density = 1000.0;
        let water = Fluid::new(density as f32, 1e-6)?;
        let body = ImmersedBody::new(self.hydro.clone()).with_law(*law)?;
        let mut plate = FreeBody::new(&body, &self.mass, &water)?;
        let force = 0.5 * density * SPEED * SPEED * self.hydro.planform.area;
        let point = |degree: u32| {
            let (sine, cosine) = math::sin_cos(f64::from(degree).to_radians());
            // The chord lies along z, the normal along y, and the pressure is from below.
            let velocity = Vector3::new(0.0, -sine, cosine) * SPEED;
            plate.set_velocity(velocity, Vector3::zeros());
            let viscous = plate.forces(Vector3::zeros()).viscous();
            let (normal, along) = (f64::from(viscous.force.y), f64::from(viscous.force.z));
            PolarPoint {
                lift: (normal * cosine + along * sine) / force,
                drag: (normal * sine - along * cosine) / force,
                pressure_point: 0.5 + f64::from(viscous.torque.x) / (normal * CHORD),
            }
        };
        Ok(Polar {
            points: (0..=90).map(point).collect(),
        })
    }
}

/// Helmbold's lift slope, 1/rad.
fn helmbold(aspect: f64) -> f64 {
    2.0 * PI * aspect / (2.0 + (aspect * aspect + 4.0).sqrt())
}

impl Polar {
    /// Lift slope at small angles of attack, 1/rad.
    pub fn lift_slope(&self) -> f64 {
        self.points[SLOPE_AT].lift / (SLOPE_AT as f64).to_radians()
    }

    /// Angle of attack in degrees and lift coefficient where the lift has its first maximum (over the next
    /// 3°), or is greatest if it has none.
    pub fn stall(&self) -> (f64, f64) {
        let lift = |degree: usize| self.points[degree].lift;
        let falls = |degree: &usize| (1..=3).all(|more| lift(degree + more) < lift(*degree));
        let greatest = || (0..=90).max_by(|a, b| lift(*a).total_cmp(&lift(*b)));
        let degree = (4..=87).find(falls).or_else(greatest).unwrap_or(0);
        (degree as f64, lift(degree))
    }

    /// Center of pressure at 5°, in chords from the leading edge.
    pub fn pressure_point(&self) -> f64 {
        self.points[PRESSURE_AT].pressure_point
    }

    /// Whether the center of pressure goes back, or stays, at each degree from 2° to 90°.
    pub fn pressure_goes_back(&self) -> bool {
        let points = &self.points[2..];
        points
            .windows(2)
            .all(|pair| pair[1].pressure_point >= pair[0].pressure_point - 1e-4)
    }

    /// The mean normal force at 30°, 45° and 60° over that of the same plate by the law of separated flow in
    /// two dimensions, `C_N ∝ 1/(0.222 + 0.283/sin α)` (Hoerner, *Fluid-Dynamic Drag*), which is anchored at
    /// its own broadside drag: for plates that stall before.
    pub fn stalled_normal(&self) -> f64 {
        let by_angle = |degree: usize| {
            let (sine, cosine) = math::sin_cos((degree as f64).to_radians());
            let PolarPoint { lift, drag, .. } = self.points[degree];
            let separated = 0.505 / (0.222 + 0.283 / sine) * self.points[90].drag;
            (lift * cosine + drag * sine) / separated
        };
        [30, 45, 60].map(by_angle).iter().sum::<f64>() / 3.0
    }

    /// The greatest force along the plate toward its leading edge, over the force normal to it, beyond the
    /// stall.
    pub fn stalled_thrust(&self) -> f64 {
        let from = self.stall().0 as usize + 1;
        let thrust = |degree: usize| {
            let (sine, cosine) = math::sin_cos((degree as f64).to_radians());
            let PolarPoint { lift, drag, .. } = self.points[degree];
            (lift * sine - drag * cosine) / (lift * cosine + drag * sine)
        };
        (from..=90).map(thrust).fold(f64::MIN, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polar(points: impl Fn(f64) -> [f64; 3]) -> Polar {
        let point = |degree: u32| {
            let [lift, drag, pressure_point] = points(f64::from(degree).to_radians());
            PolarPoint {
                lift,
                drag,
                pressure_point,
            }
        };
        Polar {
            points: (0..=90).map(point).collect(),
        }
    }

    /// Helmbold's formula at its limits: Jones's πAR/2 of slender wings, 2π of wide ones, and the values
    /// that references print for 1, 2 and 6.
    #[test]
    fn slopes_of_finite_wings() {
        assert!((helmbold(1e-3) / (PI / 2.0 * 1e-3) - 1.0).abs() < 1e-3);
        assert!((helmbold(1e4) / (2.0 * PI) - 1.0).abs() < 1e-3);
        for (aspect, slope) in [(1.0, 1.48), (2.0, 2.60), (6.0, 4.53)] {
            assert!((helmbold(aspect) - slope).abs() < 0.01, "{aspect}");
        }
    }

    /// The readings of a polar that is known: a force normal to the plate, 2 sin α up to 20°, then half.
    #[test]
    fn readings() {
        let stalls = polar(|angle| {
            let stalled = angle > 20.5f64.to_radians();
            let normal = 2.0 * angle.sin() * if stalled { 0.5 } else { 1.0 };
            [
                normal * angle.cos(),
                normal * angle.sin(),
                0.25 + angle / (2.0 * PI),
            ]
        });
        assert!((stalls.lift_slope() - 2.0).abs() < 0.01);
        assert_eq!(stalls.stall().0, 20.0);
        assert!((stalls.stall().1 - 40f64.to_radians().sin()).abs() < 1e-12);
        assert!(stalls.stalled_thrust().abs() < 1e-12);
        assert!(stalls.pressure_goes_back());
        assert!((stalls.pressure_point() - 0.25 - 5.0 / 360.0).abs() < 1e-12);
        // Lift alone, which pulls forward as the tangent of the angle; a pressure point that comes forward.
        let pulls = polar(|angle| [(2.0 * angle).sin(), 1e-9, 0.5 - 0.1 * angle]);
        assert_eq!(pulls.stall().0, 45.0);
        assert!((pulls.stalled_thrust() - 89f64.to_radians().tan()).abs() < 0.1);
        assert!(!pulls.pressure_goes_back());
        assert!(StaticPlate::rectangle(0.0).is_err() && StaticPlate::disc(f64::NAN).is_err());
    }
}
