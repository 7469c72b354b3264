//! Paper that falls through air: Howison, Hughes & Iida, *Nature Machine Intelligence* 2 (2020), data
//! of their public repository.

use super::{Shake, uniform_disc};
use crate::body::{DryMass, ImmersedBody};
use crate::error::Error;
use crate::fluid::Fluid;
use crate::hydro::HydroProperties;
use crate::hydro::viscous::ViscousLaw;
use crate::math;
use crate::motion::{Classifier, Trajectory};
use crate::training::{Experiment, Release};
use rapier3d::geometry::SharedShape;
use rapier3d::math::Vector;
use rapier3d::na::{Matrix3, Vector3};
use std::f64::consts::{FRAC_PI_2, PI};

/// 70 g/m² paper of 69.4 µm.
const GRAMMAGE: f64 = 0.070;
const THICKNESS: f64 = 69.4e-6;
/// The air of the published analysis.
const AIR: (f32, f32) = (1.2754, 1.48e-5);
/// A drop is taken as 1.1 m high. Means are over what lies between 0.7 m (ours) and 0.05 m above the floor
/// (where the published analysis ends): depths below the release, m.
const WINDOW: (f64, f64) = (0.40, 1.05);
/// A robot dropped them, how evenly is not known to us: these deviations of tilt (rad) and spin (rad/s) are
/// ours.
const SHAKE: (f64, f64) = (0.1, 0.3);
/// A drop tumbles if it flips at least so often, and at least this share of its turns go on. The numbers are
/// ours, since one flip is no tumbling. The published analysis puts the tracks into two clusters, by how
/// often the visible area peaks and how much the vertical speed varies.
const TUMBLES: (u32, f64) = (2, 0.8);

/// Outline of a piece of paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Cut {
    /// A circle.
    Circle,
    /// A regular hexagon; its radius is the apothem.
    Hexagon,
}

/// A set of drops of one piece of paper, and what was measured.
#[derive(Clone, Debug)]
pub struct PaperDrop {
    /// Outline.
    pub cut: Cut,
    /// Radius or apothem, m.
    pub radius: f64,
    /// Whether it was released edge down (otherwise flat).
    pub edge_down: bool,
    /// Mean descent, m/s.
    pub descent: f64,
    /// Standard deviation of the descent among drops, m/s.
    pub descent_deviation: f64,
    /// Mean horizontal speed from end to end, m/s.
    pub drift: f64,
    /// Standard deviation of the drift among drops, m/s.
    pub drift_deviation: f64,
    paper: Paper,
}

/// The measured share of tumbling at one size, drops of both releases together.
#[derive(Clone, Debug)]
pub struct TumblingShare {
    /// I* of the circles.
    pub i_star: f64,
    /// Tumbling over tumbling and chaotic.
    pub share: f64,
    paper: Paper,
}

/// A piece of paper.
#[derive(Clone, Debug)]
struct Paper {
    hydro: HydroProperties,
    mass: DryMass,
}

/// What one drop did inside the window.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct PaperFall {
    /// Descent, m/s.
    pub descent: f64,
    /// Horizontal speed from end to end, m/s.
    pub drift: f64,
    /// Whether it tumbled.
    pub tumbles: bool,
}

impl PaperFall {
    /// What a fall did; `None` if it did not reach the end of the window.
    pub fn of(fall: &Trajectory) -> Option<Self> {
        let below = |depth: f64| fall.moments.iter().position(|m| m.position.y < -depth);
        let (from, to) = (below(WINDOW.0)?, below(WINDOW.1)?);
        let moments = &fall.moments[from..=to];
        let time = fall.interval * (to - from).max(1) as f64;
        let moved = moments[moments.len() - 1].position - moments[0].position;
        let seen = Classifier::default().observe(moments);
        Some(Self {
            descent: -moved.y / time,
            drift: math::hypot(moved.x, moved.z) / time,
            tumbles: seen.flips >= TUMBLES.0 && seen.tumbling() >= TUMBLES.1,
        })
    }
}

impl PaperDrop {
    /// The sets, with means and deviations that were computed from the tracks in the public repository.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a size that cannot be, which the stored numbers do not give.
    pub fn measured() -> Result<Vec<Self>, Error> {
        // Each row: radius in mm, whether edge down, descent ± deviation, drift ± deviation, m/s.
        const CIRCLES: [(f64, bool, [f64; 4]); 8] = [
            (17.0, true, [0.722, 0.047, 0.481, 0.101]),
            (22.2, true, [0.700, 0.068, 0.431, 0.136]),
            (27.6, true, [0.669, 0.066, 0.528, 0.083]),
            (37.2, true, [0.690, 0.059, 0.531, 0.102]),
            (45.5, true, [0.772, 0.215, 0.272, 0.158]),
            (17.4, false, [0.794, 0.121, 0.363, 0.181]),
            (27.0, false, [0.731, 0.041, 0.448, 0.108]),
            (46.1, false, [0.833, 0.148, 0.328, 0.177]),
        ];
        const HEXAGONS: [(f64, bool, [f64; 4]); 1] = [(17.8, true, [0.705, 0.022, 0.446, 0.131])];
        let circles = CIRCLES.iter().map(|case| (Cut::Circle, case));
        let hexagons = HEXAGONS.iter().map(|case| (Cut::Hexagon, case));
        circles
            .chain(hexagons)
            .map(|(cut, (radius, edge_down, numbers))| {
                let radius = radius * 1e-3;
                let [descent, descent_deviation, drift, drift_deviation] = *numbers;
                Ok(Self {
                    cut,
                    radius,
                    edge_down: *edge_down,
                    descent,
                    descent_deviation,
                    drift,
                    drift_deviation,
                    paper: Paper::new(cut, radius)?,
                })
            })
            .collect()
    }

    /// One drop.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] or [`Error::OutOfRange`] if a coefficient of the law cannot be.
    pub fn experiment(&self, law: &ViscousLaw, seed: u64) -> Result<Experiment, Error> {
        self.paper.experiment(law, self.edge_down, seed)
    }
}

impl TumblingShare {
    /// Five classes of size, with shares that were counted from the labels in the public repository.
    ///
    /// # Errors
    /// Those of [`TumblingShare::new`], which the stored numbers do not give.
    pub fn measured() -> Result<Vec<Self>, Error> {
        const SHARES: [(f64, f64); 5] = [
            (0.079, 0.92),
            (0.061, 0.75),
            (0.049, 0.65),
            (0.043, 0.24),
            (0.033, 0.02),
        ];
        let shares = SHARES.iter();
        shares
            .map(|(i_star, share)| Self::new(*i_star, *share))
            .collect()
    }

    /// Circles of this I*, of which `share` tumbled.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if `i_star` is not positive and finite, [`Error::OutOfRange`] if
    /// `share` is none.
    pub fn new(i_star: f64, share: f64) -> Result<Self, Error> {
        Error::check_positive("i_star", i_star)?;
        Error::check_range("share", share, 0.0, 1.0)?;
        // This is I* = π σ/(64 ρ_f d).
        let radius = PI * GRAMMAGE / (128.0 * f64::from(AIR.0) * i_star);
        Ok(Self {
            i_star,
            share,
            paper: Paper::new(Cut::Circle, radius)?,
        })
    }

    /// One drop, edge down and flat by turns.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] or [`Error::OutOfRange`] if a coefficient of the law cannot be.
    pub fn experiment(&self, law: &ViscousLaw, seed: u64) -> Result<Experiment, Error> {
        self.paper.experiment(law, seed.is_multiple_of(2), seed)
    }
}

impl Paper {
    fn new(cut: Cut, radius: f64) -> Result<Self, Error> {
        let density = GRAMMAGE / THICKNESS;
        let (r, half) = (radius as f32, 0.5 * THICKNESS as f32);
        Ok(match cut {
            Cut::Circle => Self {
                hydro: HydroProperties::from_shape(SharedShape::cylinder(half, r).as_ref())?,
                mass: uniform_disc(2.0 * radius, THICKNESS, density),
            },
            Cut::Hexagon => {
                let corner = |k: u8| {
                    let angle = (f32::from(k % 6) + 0.5) * std::f32::consts::FRAC_PI_3;
                    let out = r * 2.0 / 3f32.sqrt();
                    let y = if k < 6 { -half } else { half };
                    Vector::new(out * math::cos(angle), y, out * math::sin(angle))
                };
                let corners: Vec<Vector> = (0..12).map(corner).collect();
                let hull = SharedShape::convex_hull(&corners).expect("twelve corners of a prism");
                let mass = GRAMMAGE * 2.0 * 3f64.sqrt() * radius * radius;
                // A hexagon of side s = 2r/√3: 5/24 s² m about an axis in its plane, 5/12 s² m about its
                // normal.
                let across = mass * (5.0 / 18.0 * radius * radius + THICKNESS * THICKNESS / 12.0);
                let about = mass * 5.0 / 9.0 * radius * radius;
                Self {
                    hydro: HydroProperties::from_shape(hull.as_ref())?,
                    mass: DryMass {
                        mass,
                        center: Vector3::zeros(),
                        inertia: Matrix3::from_diagonal(&Vector3::new(across, about, across)),
                    },
                }
            }
        })
    }

    fn experiment(
        &self,
        law: &ViscousLaw,
        edge_down: bool,
        seed: u64,
    ) -> Result<Experiment, Error> {
        let body = ImmersedBody::new(self.hydro.clone()).with_law(*law)?;
        let mut experiment = Experiment::new(body, self.mass, Fluid::new(AIR.0, AIR.1)?);
        let mut shake = Shake::new(seed);
        let tilt = if edge_down { FRAC_PI_2 } else { 0.0 };
        experiment.release = shake.release(
            Release {
                tilt,
                ..Release::default()
            },
            SHAKE.0,
            SHAKE.1,
        );
        experiment.dt = 1.0 / 240.0;
        experiment.seconds = 2.6;
        Ok(experiment)
    }
}
