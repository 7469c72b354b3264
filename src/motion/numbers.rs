//! The numbers that place a body on the phase diagram: U0, Re and I*.

use crate::body::DryMass;
use crate::error::Error;
use crate::fluid::Fluid;
use crate::hydro::HydroProperties;
use crate::math;
use rapier3d::na::Matrix3;
use std::f64::consts::PI;

/// Which of the two definitions of I* fits a planform. Both are the moment of inertia about the long axis
/// over ρ_f L⁴ s, with L the chord and s the longer in-plane extent, in different units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outline {
    /// I/(ρ_f L⁴ s): of a thin disc or elliptic plate π ρ_s t/(64 ρ_f d), d the minor axis. For s = L this
    /// is thesis (3.2).
    Round,
    /// I over that of the cylinder of fluid around the chord, π ρ_f L⁴ s/32: of a rectangle
    /// 8 ρ_s (a² + t²) t/(3π ρ_f a³), a the chord (the shorter in-plane side).
    Rectangular,
}

impl Outline {
    /// The unit of I*, in ρ_f L⁴ s.
    fn unit(self) -> f64 {
        match self {
            Self::Round => 1.0,
            Self::Rectangular => PI / 32.0,
        }
    }
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
    /// Re = U0 L/ν as thesis (3.1) and (3.3) print it, to be shown beside the thesis's numbers. The
    /// phase diagram has another one, that of the mean descent: [`DimensionlessNumbers::reynolds`].
    pub reynolds_u0: f64,
    /// I*: moment of inertia about the long axis through the center of mass, in the unit of `outline`.
    pub i_star: f64,
    /// Definition of `i_star`.
    pub outline: Outline,
    /// ν, m²/s.
    pub kinematic_viscosity: f64,
}

impl DimensionlessNumbers {
    /// Dimensionless numbers of a body of this shape and mass under gravity of size `gravity`, m/s². I* is
    /// that of its inertia tensor, whatever its outline and however its mass is spread.
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
        let (chord, span) = (2.0 * extents.y, 2.0 * extents.x);
        let density = mass.mass / volume;
        let numbers = Self::new(outline, chord, volume / area, density, fluid, gravity)?;
        // The tensor is in units of ρ_f L⁵.
        let tensor = Self::i_star_tensor(hydro, mass, fluid)?;
        Ok(Self {
            i_star: tensor[(0, 0)] * chord / (span * outline.unit()),
            ..numbers
        })
    }

    /// The tensor of thesis (3.2): the body's own inertia about its center of mass along the plate axes
    /// (x the longest, z the normal) over ρ_f a⁵, with a the chord [`length`](Self::length).
    ///
    /// ```
    /// use rapier3d_immersed::motion::DimensionlessNumbers;
    /// use rapier3d_immersed::rapier3d::prelude::*;
    /// use rapier3d_immersed::{DryMass, Fluid, HydroProperties};
    ///
    /// // A square card turns about its normal twice as heavily as about either side.
    /// let card = Cuboid::new(Vector::new(0.02, 0.02, 1e-4));
    /// let (hydro, mass) = (HydroProperties::from_shape(&card)?, DryMass::of_shape(&card, 800.0)?);
    /// let tensor = DimensionlessNumbers::i_star_tensor(&hydro, &mass, &Fluid::AIR)?;
    /// assert!((tensor[(2, 2)] / (tensor[(0, 0)] + tensor[(1, 1)]) - 1.0).abs() < 1e-4);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if the mass or the chord is not positive and finite.
    pub fn i_star_tensor(
        hydro: &HydroProperties,
        mass: &DryMass,
        fluid: &Fluid,
    ) -> Result<Matrix3<f64>, Error> {
        mass.check()?;
        let plate = &hydro.planform;
        let chord = 2.0 * Error::check_positive("half extent", plate.half_extents.y)?;
        let axes = plate.axes.matrix();
        let unit = f64::from(fluid.density()) * chord.powi(5);
        Ok(axes.transpose() * mass.inertia * axes / unit)
    }

    /// Dimensionless numbers of a uniform plate from a length L, a thickness t (m), a density (kg/m³) and
    /// gravity (m/s²), with the closed form of I* of its outline.
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

    /// Re of the mean descent as far as it can be known before a fall: that of
    /// [`broadside_descent`](Self::broadside_descent). With this one a body is looked up on the
    /// [`PhaseDiagram`](super::PhaseDiagram) everywhere in this crate until it has fallen.
    pub fn reynolds(&self) -> f64 {
        self.reynolds_at(self.broadside_descent())
    }

    /// Speed, m/s, at which the drag of a broadside disc carries the weight less buoyancy: an
    /// estimate of the mean descent for placing a body on the diagram before it has been dropped.
    ///
    /// It is that of steady descent. Discs and hexagons of paper that tumble fall 0.72 times as fast in the
    /// median, chaotic ones 0.80 times (the 291 segments in `tests/data/paper/falls.csv`), which matters
    /// little: where bodies are that fast, the diagram hardly depends on Re.
    ///
    /// `C_D = (64/πRe)(1 + 0.138 Re^0.792)` (Pitter, Pruppacher & Hamielec 1973), 1.17 at least.
    pub fn broadside_descent(&self) -> f64 {
        let drag = |re: f64| (64.0 / (PI * re) * (1.0 + 0.138 * math::powf(re, 0.792))).max(1.17);
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

    /// I* of discs, ellipsoids and hexagons by their moments of inertia from a table, m d²/16 + m t²/12,
    /// m (b² + c²)/5 and 5/24 m R² + m t²/12. Shapes are in f32; the extents of round ones are those of a mesh,
    /// a few thousandths off the exact ones, which is taken out where I* has the fifth power of them.
    #[test]
    fn the_inertia_tensor_of_any_body() {
        let (density, fluid) = (800.0, Fluid::AIR);
        let ratio = density / f64::from(fluid.density());
        let of = |hydro: &HydroProperties, dry: &DryMass| {
            let numbers = DimensionlessNumbers::of(hydro, dry, &fluid, 9.81).unwrap();
            let tensor = DimensionlessNumbers::i_star_tensor(hydro, dry, &fluid).unwrap();
            (numbers, tensor)
        };
        let close = |a: f64, b: f64, tolerance: f64| {
            assert!((a / b - 1.0).abs() < tolerance, "{a} {b}");
        };

        // The mesh's extents over the exact ones.
        let mesh = |hydro: &HydroProperties, exact: [f64; 2]| {
            let half = hydro.planform.half_extents;
            let found = [2.0 * half.x / exact[0], 2.0 * half.y / exact[1]];
            found.iter().for_each(|ratio| close(*ratio, 1.0, 5e-3));
            found
        };

        // A disc: the closed form, and what it leaves out of the thickness, 4/3 (t/d)².
        let (d, t) = (0.04, 0.002);
        let shape = SharedShape::cylinder(0.5 * t as f32, 0.5 * d as f32);
        let hydro = HydroProperties::from_shape(shape.as_ref()).unwrap();
        let mass = density * PI / 4.0 * d * d * t;
        let across = mass * (d * d / 16.0 + t * t / 12.0);
        let dry = DryMass {
            mass,
            center: Vector3::zeros(),
            inertia: Matrix3::from_diagonal(&Vector3::new(across, mass * d * d / 8.0, across)),
        };
        let (numbers, tensor) = of(&hydro, &dry);
        assert_eq!(numbers.outline, Outline::Round);
        let closed = PI * ratio * t / (64.0 * d);
        let thick = 1.0 + 4.0 / 3.0 * (t / d) * (t / d);
        let [wide, deep] = mesh(&hydro, [d, d]);
        close(numbers.i_star * wide * deep.powi(4), closed * thick, 1e-5);
        close(tensor[(2, 2)] * deep.powi(5), 2.0 * closed, 1e-5);

        // A thin ellipsoid: four fifths of the elliptic plate of the same mean thickness.
        let [a, b, c] = [0.035, 0.02, 0.0002];
        let (hydro, dry) = thin_ellipsoid([a, b, c], density).unwrap();
        let (numbers, tensor) = of(&hydro, &dry);
        let exact = PI * ratio * c * (b * b + c * c) / (120.0 * b.powi(3));
        let [wide, deep] = mesh(&hydro, [2.0 * a, 2.0 * b]);
        close(numbers.i_star * wide * deep.powi(4), exact, 1e-5);
        close(tensor[(0, 0)] * deep.powi(5), exact * a / b, 1e-5);
        let principal = (a * a + c * c) / (b * b + c * c);
        close(tensor[(1, 1)] / tensor[(0, 0)], principal, 1e-6);

        // A hexagon of apothem r. What Howison et al. (2020) list as its I* is 1.5 times that of (3.2): they
        // take the polar moment of inertia, and r for the circumradius (tests/data/paper/falls.csv has
        // .1303 for r = 19 mm of 70 g/m² in air of 1.2754 kg/m³).
        let (r, t): (f64, f64) = (0.019, 2.5 / 36e3);
        let circumradius = 2.0 * r / 3f64.sqrt();
        let corners: Vec<_> = (0..12)
            .map(|i| {
                let (sin, cos) = (PI / 3.0 * f64::from(i / 2)).sin_cos();
                let side = if i % 2 == 0 { 0.5 } else { -0.5 };
                rapier3d::math::Vector::new(
                    (circumradius * cos) as f32,
                    (circumradius * sin) as f32,
                    (side * t) as f32,
                )
            })
            .collect();
        let shape = SharedShape::convex_hull(&corners).unwrap();
        let hydro = HydroProperties::from_shape(shape.as_ref()).unwrap();
        let dry = DryMass::of_shape(shape.as_ref(), 0.07 / t).unwrap();
        let air = Fluid::new(1.2754, 1.48e-5).unwrap();
        let tensor = DimensionlessNumbers::i_star_tensor(&hydro, &dry, &air).unwrap();
        let plane = dry.mass * (5.0 / 24.0 * circumradius.powi(2) + t * t / 12.0);
        // A convex hull of so thin a body is good to a few parts in a thousand in f32.
        close(tensor[(0, 0)], plane / (1.2754 * (2.0 * r).powi(5)), 5e-3);
        close(1.5 * tensor[(0, 0)], 0.1303, 5e-3);
        let numbers = DimensionlessNumbers::of(&hydro, &dry, &air, 9.81).unwrap();
        assert_eq!(numbers.outline, Outline::Round);
        close(numbers.i_star, tensor[(0, 0)] * r / circumradius, 1e-5);
    }

    /// A card with a weight at one end of its chord: the parallel axis theorem by hand, whichever way the
    /// card lies in its frame. A weight in its middle changes the mass and not I*.
    #[test]
    fn a_weight_changes_what_the_closed_form_does_not_see() {
        let [s, a, t] = [0.1, 0.04, 0.0005];
        let card = DryMass {
            mass: 800.0 * s * a * t,
            center: Vector3::zeros(),
            inertia: Matrix3::from_diagonal(&Vector3::new(
                a * a + t * t,
                s * s + t * t,
                s * s + a * a,
            )) * (800.0 * s * a * t / 12.0),
        };
        let weight = |at: f64| DryMass {
            mass: 1e-3,
            center: Vector3::new(0.0, at, 0.0),
            inertia: Matrix3::identity() * 1e-12,
        };
        let half = [s, a, t].map(|x| 0.5 * x as f32);
        let shape = SharedShape::cuboid(half[0], half[1], half[2]);
        let hydro = HydroProperties::from_shape(shape.as_ref()).unwrap();
        let i_star = |dry: &DryMass| {
            let numbers = DimensionlessNumbers::of(&hydro, dry, &Fluid::AIR, 9.81).unwrap();
            numbers.i_star
        };
        let unit = PI * f64::from(Fluid::AIR.density()) * a.powi(4) * s / 32.0;
        let bare = i_star(&card);
        assert!((bare * unit / card.inertia[(0, 0)] - 1.0).abs() < 1e-5);
        let middle = i_star(&card.combined(&weight(0.0)));
        assert!((middle - bare - 1e-12 / unit).abs() < 1e-5 * bare);
        let ahead = i_star(&card.combined(&weight(0.02)));
        let reduced = card.mass * 1e-3 / (card.mass + 1e-3);
        let exact = bare + (reduced * 0.02 * 0.02 + 1e-12) / unit;
        assert!((ahead / exact - 1.0).abs() < 1e-5, "{ahead} {exact}");
        assert!(ahead > 1.2 * bare);
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
