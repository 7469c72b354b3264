//! The numbers that place a body on the phase diagram: U0, Re and I*.

use crate::body::DryMass;
use crate::error::Error;
use crate::fluid::Fluid;
use crate::hydro::HydroProperties;
use std::f64::consts::PI;

/// Which of the two definitions of I* fits a planform.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outline {
    /// Disc or ellipse: π ρ_s t/(64 ρ_f d), d the minor axis.
    Round,
    /// Rectangle: 8 ρ_s (a² + t²) t/(3π ρ_f a³), a the chord (the shorter in-plane side).
    Rectangular,
}

/// Dimensionless numbers of one body in one fluid.
///
/// ```
/// use rapier3d_immersed::Fluid;
/// use rapier3d_immersed::motion::{DimensionlessNumbers, Outline};
///
/// // A disc of aluminium, 2 cm across and 1.5 mm thick, in water.
/// let coin = DimensionlessNumbers::new(Outline::Round, 0.02, 0.0015, 2700.0, &Fluid::WATER, 9.81)?;
/// let exact = std::f64::consts::PI * 2700.0 * 0.0015 / (64.0 * 997.0 * 0.02);
/// assert!((coin.i_star / exact - 1.0).abs() < 1e-6);
/// assert!((coin.u0 - (1.708 * 9.81 * 0.0015_f64).sqrt()).abs() < 1e-3); // 0.16 m/s
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DimensionlessNumbers {
    /// L: minor axis or chord, twice the shorter in-plane half extent, m.
    pub length: f64,
    /// t: mean thickness, volume over planform area, m.
    pub thickness: f64,
    /// ρ_s/ρ_f, with ρ_s the body's mass over its volume.
    pub density_ratio: f64,
    /// U0 = √(|ρ_s/ρ_f − 1| g t), m/s (thesis § 3.3.1).
    pub u0: f64,
    /// Re = U0 L/ν. The measured phase diagram has another Reynolds number: that of the mean descent
    /// ([`DimensionlessNumbers::reynolds_at`]).
    pub reynolds_u0: f64,
    /// I*: moment of inertia about the long axis over that of a body of fluid.
    pub i_star: f64,
    /// Definition of `i_star`.
    pub outline: Outline,
    /// ν, m²/s.
    pub kinematic_viscosity: f64,
}

impl DimensionlessNumbers {
    /// Dimensionless numbers of a body of this shape and mass under gravity of size `gravity`, m/s².
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if mass, gravity or the shape's extents are not positive and
    /// finite.
    pub fn of(
        hydro: &HydroProperties,
        mass: &DryMass,
        fluid: &Fluid,
        gravity: f64,
    ) -> Result<Self, Error> {
        mass.check()?;
        let plate = &hydro.planform;
        let area = Error::check_positive("planform area", plate.area)?;
        let volume = Error::check_positive("volume", hydro.volume)?;
        let extents = plate.half_extents;
        Error::check_positive("half extent", extents.x)?;
        Error::check_positive("half extent", extents.y)?;
        // The boundary lies halfway between an ellipse's π/4 and a rectangle's 1.
        let fill = area / (4.0 * extents.x * extents.y);
        let outline = if fill < 0.5 * (1.0 + PI / 4.0) {
            Outline::Round
        } else {
            Outline::Rectangular
        };
        Self::new(
            outline,
            2.0 * extents.y,
            volume / area,
            mass.mass / volume,
            fluid,
            gravity,
        )
    }

    /// Dimensionless numbers from a length L, a thickness t (m), a density (kg/m³) and gravity (m/s²).
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] names what is not positive and finite.
    pub fn new(
        outline: Outline,
        length: f64,
        thickness: f64,
        density: f64,
        fluid: &Fluid,
        gravity: f64,
    ) -> Result<Self, Error> {
        Error::check_positive("length", length)?;
        Error::check_positive("thickness", thickness)?;
        Error::check_positive("density", density)?;
        Error::check_positive("gravity", gravity)?;
        let ratio = density / f64::from(fluid.density());
        let kinematic_viscosity = f64::from(fluid.kinematic_viscosity());
        let u0 = ((ratio - 1.0).abs() * gravity * thickness).sqrt();
        let (a, t) = (length, thickness);
        let i_star = match outline {
            Outline::Round => PI * ratio * t / (64.0 * a),
            Outline::Rectangular => 8.0 * ratio * (a * a + t * t) * t / (3.0 * PI * a.powi(3)),
        };
        Ok(Self {
            length,
            thickness,
            density_ratio: ratio,
            u0,
            reynolds_u0: u0 * length / kinematic_viscosity,
            i_star,
            outline,
            kinematic_viscosity,
        })
    }

    /// Reynolds number of a measured mean descent, m/s: the one of the measured phase diagram.
    pub fn reynolds_at(&self, descent: f64) -> f64 {
        descent.abs() * self.length / self.kinematic_viscosity
    }

    /// Speed, m/s, at which the drag of a broadside disc carries the weight less buoyancy: an
    /// estimate of the mean descent for placing a body on the diagram before it has been dropped.
    /// Tumbling bodies fall up to a third more slowly.
    ///
    /// `C_D = (64/πRe)(1 + 0.138 Re^0.792)` (Pitter, Pruppacher & Hamielec 1973), 1.17 at least.
    pub fn broadside_descent(&self) -> f64 {
        let drag = |re: f64| (64.0 / (PI * re) * (1.0 + 0.138 * re.powf(0.792))).max(1.17);
        // In ½U²C_D(Re) = U0², C_D U² grows with U, so that bisection of log U finds the only root.
        let (mut low, mut high) = (1e-12 * self.u0, 2.0 * self.u0);
        if self.u0 == 0.0 {
            return 0.0;
        }
        for _ in 0..120 {
            let middle = (low * high).sqrt();
            let lifted = 0.5 * middle * middle * drag(self.reynolds_at(middle));
            if lifted < self.u0 * self.u0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::training::thin_ellipsoid;
    use rapier3d::geometry::SharedShape;
    use rapier3d::na::{Matrix3, Vector3};

    /// The yen coin of thesis § 3.6, printed as Re = 3.55·10³ and I* = 10⁻². Both follow with 2700 kg/m³ for
    /// aluminium, and 1000 kg/m³ and 0.89·10⁻⁶ m²/s for water, which it does not print.
    #[test]
    fn the_yen_coin() {
        let water = Fluid::new(1000.0, 0.89e-6).unwrap();
        let coin =
            DimensionlessNumbers::new(Outline::Round, 0.02, 0.0015, 2700.0, &water, 9.81).unwrap();
        assert!((coin.i_star / 1.0e-2 - 1.0).abs() < 0.01, "{coin:?}");
        assert!((coin.reynolds_u0 / 3.55e3 - 1.0).abs() < 0.01, "{coin:?}");
    }

    /// A box's own numbers follow from the definitions: I* is its moment of inertia about the long
    /// axis over that of the cylinder of fluid around the chord, πρ_f a⁴ s/32.
    #[test]
    fn the_moment_of_inertia_of_a_box() {
        let half = [0.05f32, 0.001, 0.01];
        let shape = SharedShape::cuboid(half[0], half[1], half[2]);
        let hydro = HydroProperties::from_shape(shape.as_ref()).unwrap();
        let [s, t, a] = half.map(|h| 2.0 * f64::from(h));
        let mass = 800.0 * s * t * a;
        let inertia = mass * Vector3::new(a * a + t * t, s * s + a * a, s * s + t * t) / 12.0;
        let dry = DryMass {
            mass,
            center: Vector3::zeros(),
            inertia: Matrix3::from_diagonal(&inertia),
        };
        let numbers = DimensionlessNumbers::of(&hydro, &dry, &Fluid::AIR, 9.81).unwrap();
        assert_eq!(numbers.outline, Outline::Rectangular);
        let fluid = PI * f64::from(Fluid::AIR.density()) * a.powi(4) / 32.0 * s;
        let exact = inertia.x / fluid;
        // The shape is in f32.
        assert!((numbers.i_star / exact - 1.0).abs() < 1e-5);
        assert!((numbers.length / a - 1.0).abs() < 1e-6);
    }

    #[test]
    fn an_ellipse_is_round_and_its_thickness_the_mean() {
        let (hydro, dry) = thin_ellipsoid([0.035, 0.02, 0.0002], 800.0).unwrap();
        let numbers = DimensionlessNumbers::of(&hydro, &dry, &Fluid::AIR, 9.81).unwrap();
        assert_eq!(numbers.outline, Outline::Round);
        // V/A of an ellipsoid is 4/3 of its semi-axis; the mesh is a few percent coarse.
        assert!((numbers.thickness / (4.0 / 3.0 * 0.0002) - 1.0).abs() < 0.05);
    }

    /// The estimate balances weight and drag, in creeping flow too: Stokes's broadside disc falls at
    /// U = π (ρ_s − ρ_f) g t d/(32 μ) (resistance 16 μ a U).
    #[test]
    fn the_estimated_descent_balances_the_weight() {
        let syrup = Fluid::new(1000.0, 0.1).unwrap();
        let disc =
            DimensionlessNumbers::new(Outline::Round, 0.01, 0.0005, 2700.0, &syrup, 9.81).unwrap();
        let stokes = PI * 1700.0 * 9.81 * 0.0005 * 0.01 / (32.0 * 100.0);
        let fall = disc.broadside_descent();
        assert!((fall / stokes - 1.0).abs() < 0.02, "{fall} {stokes}");
        let water =
            DimensionlessNumbers::new(Outline::Round, 0.02, 0.0015, 2700.0, &Fluid::WATER, 9.81)
                .unwrap();
        let fall = water.broadside_descent();
        assert!((fall / (water.u0 * (2.0f64 / 1.17).sqrt()) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn impossible_bodies_are_refused() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(
                DimensionlessNumbers::new(Outline::Round, bad, 1e-3, 1.0, &Fluid::AIR, 9.81)
                    .is_err()
            );
            assert!(
                DimensionlessNumbers::new(Outline::Round, 1e-2, 1e-3, 1.0, &Fluid::AIR, bad)
                    .is_err()
            );
        }
    }
}
