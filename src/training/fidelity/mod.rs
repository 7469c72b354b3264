//! Fidelity: falls that were measured, and how well a law reproduces them.
//!
//! [`Fidelity`] holds the measured bodies: plates in water, the map of falling discs, falling paper; plates and
//! discs in a steady stream, of which wing theory and wind tunnels know the forces; and weighted cards, which glide.
//! [`Fidelity::run`] drops them all and gives a [`Report`] of the numbers side by side;
//! [`Report::cost`] is what the search for the default law's coefficients minimises
//! ([`searched`], [`places`], [`law_at`]).
//!
//! What drops a body is the caller's choice: [`Experiment::run`](super::Experiment::run) for the crate's
//! own integrator, or a function that does the same in a rapier world.
//!
//! ```
//! use rapier3d_immersed::ViscousLaw;
//! use rapier3d_immersed::training::Experiment;
//! use rapier3d_immersed::training::fidelity::{Effort, Fidelity, Plate};
//!
//! # fn main() -> Result<(), rapier3d_immersed::Error> {
//! // The plates only, from two release angles.
//! let fidelity = Fidelity { plates: Plate::targets()?, ..Fidelity::default() };
//! let effort = Effort { releases: 2, ..Effort::default() };
//! let report = fidelity.run(&ViscousLaw::default(), &effort, Experiment::run)?;
//! // The thickest plate tumbles, and descends at 11.5 cm/s within the law's accuracy.
//! let plate = &report.plates[0];
//! assert_eq!(plate.regime(), plate.plate.regime);
//! assert!((plate.mean(|fall| fall.descent) / plate.plate.descent.unwrap() - 1.0).abs() < 0.15);
//! # Ok(())
//! # }
//! ```

mod coefficients;
mod cost;
mod discs;
mod gliders;
mod measured_discs;
mod papers;
mod plates;
mod polars;
mod report;

pub use coefficients::{law_at, places, searched};
pub use cost::Cost;
pub use discs::{Disc, DiscFall};
pub use gliders::{Glider, GliderFall};
pub use papers::{Cut, PaperDrop, PaperFall, TumblingShare};
pub use plates::{Plate, PlateFall};
pub use polars::{Polar, PolarPoint, StaticPlate};
pub use report::{
    DiscMap, GliderResult, PaperResult, PlateResult, PolarResult, Report, ShareResult,
};

use super::{Experiment, Release};
use crate::body::DryMass;
use crate::error::Error;
use crate::hydro::viscous::ViscousLaw;
use crate::motion::Trajectory;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;
use rapier3d::na::{Matrix3, Vector3};

/// Release angles of plates and discs, degrees from flat, in the order in which they are used: the
/// first few are already spread out.
const TILTS: [f64; 6] = [15.0, 60.0, 30.0, 5.0, 45.0, 80.0];

/// Pitch (nose up) and roll of the flights of a glider, degrees, in the order in which they are used.
const FLIGHTS: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [20.0, 2.0],
    [-20.0, 0.0],
    [0.0, 2.0],
    [20.0, 0.0],
    [-20.0, 2.0],
];

/// How many falls are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Seed of what varies from release to release.
    pub seed: u64,
    /// Release angles per plate and disc, and flights per glider, 1 to 6 (default 6).
    pub releases: usize,
    /// Drops per set of papers (default 8), and half as many again for the shares of tumbling.
    pub drops: usize,
}

impl Default for Effort {
    fn default() -> Self {
        Self {
            seed: 1,
            releases: TILTS.len(),
            drops: 8,
        }
    }
}

/// Which of the measurements: for fitting to a part and scoring on the rest. Polars and gliders are in both:
/// few as they are, each stands for something of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Every second disc; the plates 1/8, 1/10 and 1/14; every second set of circles.
    Fitted,
    /// The other discs, the plates 1/9.5 and 1/11, the other circles, and the hexagons.
    HeldOut,
}

/// The measured bodies.
///
/// ```
/// use rapier3d_immersed::training::fidelity::{Fidelity, Part};
///
/// let [fitted, held_out] = [Part::Fitted, Part::HeldOut].map(|part| Fidelity::new().map(|f| f.part(part)));
/// let (fitted, held_out) = (fitted?, held_out?);
/// assert_eq!(fitted.plates.len() + held_out.plates.len(), 5);
/// assert_eq!(fitted.discs.len() + held_out.discs.len(), 200);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Fidelity {
    /// Plates in water.
    pub plates: Vec<Plate>,
    /// The map of discs.
    pub discs: Vec<Disc>,
    /// Papers in air.
    pub papers: Vec<PaperDrop>,
    /// Shares of tumbling of paper circles.
    pub shares: Vec<TumblingShare>,
    /// Plates and discs in a steady stream.
    pub polars: Vec<StaticPlate>,
    /// Weighted cards that glide.
    pub gliders: Vec<Glider>,
}

impl Fidelity {
    /// All measured bodies.
    ///
    /// # Errors
    /// Those of [`Disc::new`], [`Plate::new`] and [`TumblingShare::new`], which the stored numbers do not
    /// give.
    pub fn new() -> Result<Self, Error> {
        Ok(Self {
            plates: Plate::targets()?,
            discs: Disc::measured()?,
            papers: PaperDrop::measured()?,
            shares: TumblingShare::measured()?,
            polars: StaticPlate::published()?,
            gliders: Glider::cards()?,
        })
    }

    /// Every `stride`-th disc, but all that tumble, which are few.
    pub fn thinned(mut self, stride: usize) -> Self {
        let mut count = 0;
        self.discs.retain(|disc| {
            count += 1;
            disc.regime == crate::motion::Regime::PeriodicTumbling
                || (count - 1) % stride.max(1) == 0
        });
        self
    }

    /// One part of the measured bodies.
    pub fn part(mut self, part: Part) -> Self {
        let keep = |index: usize| index.is_multiple_of(2) == (part == Part::Fitted);
        fn retain<T>(all: &mut Vec<T>, keep: impl Fn(usize) -> bool) {
            let mut index = 0;
            all.retain(|_| {
                index += 1;
                keep(index - 1)
            });
        }
        retain(&mut self.plates, keep);
        retain(&mut self.discs, keep);
        retain(&mut self.shares, keep);
        let circles = |drop: &PaperDrop| drop.cut == Cut::Circle;
        let mut index = 0;
        self.papers.retain(|drop| {
            index += 1;
            if circles(drop) {
                keep(index - 1)
            } else {
                part == Part::HeldOut
            }
        });
        self
    }

    /// Drops every body under `law` and compares. `fall` runs one experiment; with the feature `bake`
    /// all cores do. The result does not depend on the number of threads.
    ///
    /// # Errors
    /// Those of `fall`; [`Error::InvalidParameter`] or [`Error::OutOfRange`] if a coefficient of the
    /// law or the effort cannot be.
    pub fn run(
        &self,
        law: &ViscousLaw,
        effort: &Effort,
        fall: impl Fn(&Experiment) -> Result<Trajectory, Error> + Sync,
    ) -> Result<Report, Error> {
        Error::check_range("releases", effort.releases as f64, 1.0, TILTS.len() as f64)?;
        Error::check_range("drops", effort.drops as f64, 1.0, 1e6)?;
        let tilts = &TILTS[..effort.releases];
        // Every body and release has a seed of its own.
        let seed = |case: usize, release: usize| {
            effort.seed.wrapping_mul(1_000_003) + (case * 1000 + release) as u64
        };
        let plates = each(&self.plates, tilts.len(), |plate, case, release| {
            let tilt = tilts[release].to_radians();
            let experiment = plate.experiment(law, tilt, seed(case, release))?;
            Ok(plate.measure(&fall(&experiment)?))
        })?;
        let discs = each(&self.discs, tilts.len(), |disc, case, release| {
            let tilt = tilts[release].to_radians();
            let experiment = disc.experiment(law, tilt, seed(case, release))?;
            Ok(disc.measure(&experiment, &fall(&experiment)?))
        })?;
        let papers = each(&self.papers, effort.drops, |drop, case, release| {
            let experiment = drop.experiment(law, seed(case, release))?;
            Ok(PaperFall::of(&fall(&experiment)?))
        })?;
        let shares = each(
            &self.shares,
            effort.drops * 3 / 2,
            |share, case, release| {
                let experiment = share.experiment(law, seed(case, release))?;
                Ok(PaperFall::of(&fall(&experiment)?))
            },
        )?;
        let flights = &FLIGHTS[..effort.releases];
        let gliders = each(&self.gliders, flights.len(), |glider, _, release| {
            let [pitch, roll] = flights[release].map(f64::to_radians);
            let experiment = glider.experiment(law, pitch, roll)?;
            Ok(glider.measure(&fall(&experiment)?))
        })?;
        let polars = self.polars.iter().map(|plate| {
            Ok(PolarResult {
                plate: plate.clone(),
                polar: plate.polar(law)?,
            })
        });
        Ok(Report {
            polars: polars.collect::<Result<_, Error>>()?,
            gliders: zip(&self.gliders, gliders, |glider, falls| GliderResult {
                glider: glider.clone(),
                falls,
            }),
            plates: zip(&self.plates, plates, |plate, falls| PlateResult {
                plate: plate.clone(),
                falls,
            }),
            discs: DiscMap {
                falls: discs.into_iter().flatten().collect(),
            },
            papers: zip(&self.papers, papers, |drop, falls| PaperResult {
                drop: drop.clone(),
                falls: falls.into_iter().flatten().collect(),
            }),
            shares: zip(&self.shares, shares, |measured, falls| ShareResult {
                measured: measured.clone(),
                falls: falls.into_iter().flatten().collect(),
            }),
        })
    }
}

/// `run` for every case and repetition, by case.
fn each<C: Sync, R: Send>(
    cases: &[C],
    repetitions: usize,
    run: impl Fn(&C, usize, usize) -> Result<R, Error> + Sync,
) -> Result<Vec<Vec<R>>, Error> {
    let one = |index: usize| {
        let (case, repetition) = (index / repetitions, index % repetitions);
        run(&cases[case], case, repetition)
    };
    let all = 0..cases.len() * repetitions;
    #[cfg(feature = "bake")]
    let results: Vec<Result<R, Error>> = {
        use rayon::prelude::*;
        all.into_par_iter().map(one).collect()
    };
    #[cfg(not(feature = "bake"))]
    let results: Vec<Result<R, Error>> = all.map(one).collect();
    let mut results = results.into_iter();
    let case = |_| results.by_ref().take(repetitions).collect();
    (0..cases.len()).map(case).collect()
}

fn zip<C, R, T>(cases: &[C], results: Vec<Vec<R>>, pair: impl Fn(&C, Vec<R>) -> T) -> Vec<T> {
    let cases = cases.iter().zip(results);
    cases.map(|(case, falls)| pair(case, falls)).collect()
}

/// The random deviations of a release.
struct Shake(Pcg64Mcg);

impl Shake {
    fn new(seed: u64) -> Self {
        Self(Pcg64Mcg::seed_from_u64(seed))
    }

    fn normal(&mut self, deviation: f64) -> f64 {
        let unit: f64 = StandardNormal.sample(&mut self.0);
        deviation * unit
    }

    /// A release whose tilt, tilt axis and spin are off by these deviations.
    fn release(&mut self, release: Release, tilt: f64, spin: f64) -> Release {
        Release {
            tilt: release.tilt + self.normal(tilt),
            tilt_axis: release.tilt_axis + self.normal(1f64.to_radians()),
            spin: release.spin + Vector3::from_fn(|_, _| self.normal(spin)),
            ..release
        }
    }
}

/// A box of these full extents, m, and density, kg/m³.
fn uniform_box(extents: [f64; 3], density: f64) -> DryMass {
    let mass = density * extents.iter().product::<f64>();
    let [x, y, z] = extents.map(|e| e * e);
    DryMass {
        mass,
        center: Vector3::zeros(),
        inertia: Matrix3::from_diagonal(&Vector3::new(y + z, x + z, x + y)) * (mass / 12.0),
    }
}

/// A disc with its normal along y, as rapier's cylinder.
fn uniform_disc(diameter: f64, thickness: f64, density: f64) -> DryMass {
    let r2 = 0.25 * diameter * diameter;
    let mass = density * std::f64::consts::PI * r2 * thickness;
    let across = 0.25 * r2 + thickness * thickness / 12.0;
    DryMass {
        mass,
        center: Vector3::zeros(),
        inertia: Matrix3::from_diagonal(&Vector3::new(across, 0.5 * r2, across)) * mass,
    }
}
