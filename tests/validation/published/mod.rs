//! How well this crate's bodies fall: measurements and exact results, section by section.
//!
//! The tests assert every bar at [`Effort::Quick`]; the example `validation` includes this module, computes
//! it at full effort and prints it as a table.

mod added_mass;
pub mod bluff;
mod discs;
mod drag;
#[path = "../../../examples/support/draw.rs"]
#[allow(dead_code, reason = "shared with examples")]
mod draw;
mod energy;
mod falling_plate;
mod falls;
mod gliders;
mod kirchhoff;
mod papers;
mod plates;
mod polars;
#[path = "../../../examples/support/previous.rs"]
mod previous;
pub mod report;
pub mod runner;
pub mod samara;
mod seed;
mod strips;
mod thesis;

use rapier3d_immersed::rapier3d::na::{UnitQuaternion, Vector3};
use report::{Row, Section};

/// World axes: y is up.
type Vec3 = Vector3<f64>;
type Quat = UnitQuaternion<f64>;

/// How much to compute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// Everything: minutes.
    Full,
    /// Fewer and shorter runs, for tests: seconds.
    Quick,
}

impl Effort {
    /// One of two values.
    pub fn choose<T>(self, full: T, quick: T) -> T {
        match self {
            Self::Full => full,
            Self::Quick => quick,
        }
    }
}

/// What can go wrong in a section: the library's errors, and those of drawing.
pub type Failure = Box<dyn std::error::Error>;

/// The rows of a section, and its pictures: file names and SVG.
pub type Computed = (Vec<Row>, Vec<(String, String)>);

/// Called with the share of a section that is done, 0 to 1.
pub type Progress<'a> = &'a dyn Fn(f64);

/// The sections, in the order of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum SectionName {
    /// Plates in water that tumble, go astray and flutter
    Plates,
    /// The map of falling discs
    Discs,
    /// Paper circles and hexagons in air
    Papers,
    /// Plates and discs in a steady stream
    Polars,
    /// Weighted cards that glide
    Gliders,
    /// Strips that tumble: how fast, and from which mass on
    Strips,
    /// A maple seed that spins
    Seed,
    /// Drag of spheres and broadside discs over the Reynolds number
    Drag,
    /// Drag of bodies that are not plates
    Bluff,
    /// Added mass against closed forms and tables
    AddedMass,
    /// Invariants of an ideal fluid, and a pendulum in it
    Kirchhoff,
    /// Energy in a fluid at rest
    Energy,
    /// The quasi-steady plate in two dimensions
    FallingPlate,
    /// Figures 5.4 and 5.13 of the thesis
    Thesis,
}

impl SectionName {
    /// Those asked for, each once and in the table's order; all if none is.
    pub fn chosen(only: &[Self]) -> Vec<Self> {
        let all = <Self as clap::ValueEnum>::value_variants().iter().copied();
        all.filter(|name| only.is_empty() || only.contains(name))
            .collect()
    }

    /// As on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plates => "plates",
            Self::Discs => "discs",
            Self::Papers => "papers",
            Self::Polars => "polars",
            Self::Gliders => "gliders",
            Self::Strips => "strips",
            Self::Seed => "seed",
            Self::Drag => "drag",
            Self::Bluff => "bluff",
            Self::AddedMass => "added-mass",
            Self::Kirchhoff => "kirchhoff",
            Self::Energy => "energy",
            Self::FallingPlate => "falling-plate",
            Self::Thesis => "thesis",
        }
    }

    /// What it is about.
    pub fn title(self) -> &'static str {
        match self {
            Self::Plates => "plates in water",
            Self::Discs => "the map of discs",
            Self::Papers => "paper in air",
            Self::Polars => "static polars",
            Self::Gliders => "gliders",
            Self::Strips => "strips that tumble",
            Self::Seed => "maple seed",
            Self::Drag => "drag of spheres and discs",
            Self::Bluff => "drag of bodies that are not plates",
            Self::AddedMass => "added mass",
            Self::Kirchhoff => "ideal fluid",
            Self::Energy => "energy in still fluid",
            Self::FallingPlate => "plate in two dimensions",
            Self::Thesis => "figures of the thesis",
        }
    }

    /// # Errors
    /// What the library or the drawing says.
    pub fn compute(self, effort: Effort, progress: Progress) -> Result<Section, Failure> {
        let (rows, pictures) = match self {
            Self::Plates => plates::compute(effort, progress)?,
            Self::Discs => discs::compute(effort, progress)?,
            Self::Papers => papers::compute(effort, progress)?,
            Self::Polars => polars::compute(effort, progress)?,
            Self::Gliders => gliders::compute(effort, progress)?,
            Self::Strips => strips::compute(effort, progress)?,
            Self::Seed => seed::compute(effort, progress)?,
            Self::Drag => drag::compute(effort, progress)?,
            Self::Bluff => bluff::compute(effort, progress)?,
            Self::AddedMass => added_mass::compute(effort, progress)?,
            Self::Kirchhoff => kirchhoff::compute(effort, progress)?,
            Self::Energy => energy::compute(effort, progress)?,
            Self::FallingPlate => falling_plate::compute(effort, progress)?,
            Self::Thesis => thesis::compute(effort, progress)?,
        };
        Ok(Section {
            name: self.name(),
            title: self.title(),
            rows,
            pictures,
        })
    }
}
