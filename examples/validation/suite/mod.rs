//! The cases, section by section.

mod drag;
pub mod report;
pub mod runner;

use report::{Row, Section};

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
    /// Drag of spheres and broadside discs over the Reynolds number
    Drag,
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
            Self::Drag => "drag",
        }
    }

    /// What it is about.
    pub fn title(self) -> &'static str {
        match self {
            Self::Drag => "drag of spheres and discs",
        }
    }

    /// # Errors
    /// What the library or the drawing says.
    pub fn compute(self, effort: Effort, progress: Progress) -> Result<Section, Failure> {
        let (rows, pictures) = match self {
            Self::Drag => drag::compute(effort, progress)?,
        };
        Ok(Section {
            name: self.name(),
            title: self.title(),
            rows,
            pictures,
        })
    }
}
