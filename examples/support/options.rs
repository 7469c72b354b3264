//! Options that several examples have: each is declared once, here or in `cli`, `shape` and `film`, so that its name, unit and
//! meaning are the same everywhere (`tests/house` looks). Where an example's default is its own, its command says so with
//! `mut_arg`.

use super::cli::{self, not_negative, positive};
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};

/// Where files go.
#[derive(Args, Clone, Debug)]
pub struct Out {
    /// Folder for the files
    #[arg(id = "out", long = "out", value_name = "DIR", default_value = "out")]
    pub folder: PathBuf,
}

impl Out {
    /// A file's place.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Writes a file, or ends the program; returns its place.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        cli::write(&path, content);
        path
    }
}

/// "wrote a, b, c".
pub fn wrote<P: AsRef<Path>>(files: &[P]) -> String {
    let names: Vec<String> = files
        .iter()
        .map(|path| path.as_ref().display().to_string())
        .collect();
    format!("wrote {}", names.join(", "))
}

/// How numbers are printed.
#[derive(Args, Clone, Copy, Debug)]
pub struct Json {
    /// Print one JSON object instead of text; units are at the ends of names: _s, _m, _mps, _kgpm3
    #[arg(id = "json", long = "json")]
    pub on: bool,
}

/// A name with its unit after an underscore, as tables and JSON have it: `descent_mps`.
pub fn key(name: &str, unit: &str) -> String {
    let unit = unit.replace('/', "p").replace('²', "2").replace('³', "3");
    match &unit[..] {
        "" => name.to_owned(),
        unit => format!("{name}_{unit}"),
    }
}

/// What is random.
#[derive(Args, Clone, Copy, Debug)]
pub struct Seed {
    /// Seed of all that is random
    #[arg(id = "seed", long = "seed", value_name = "N", default_value = "1")]
    pub value: u64,
}

/// How long.
#[derive(Args, Clone, Copy, Debug)]
pub struct Seconds {
    /// Simulated time, s
    #[arg(long, value_name = "S", value_parser = positive)]
    pub seconds: Option<f64>,
}

impl Seconds {
    /// The time, s, of an example that has a default.
    pub fn given(&self) -> f64 {
        self.seconds.expect("the command has a default")
    }
}

/// In which steps.
#[derive(Args, Clone, Copy, Debug)]
pub struct TimeStep {
    /// Time step, s
    #[arg(long, value_name = "S", value_parser = positive)]
    pub dt: Option<f64>,
}

impl TimeStep {
    /// The step, s, of an example that has a default.
    pub fn given(&self) -> f64 {
        self.dt.expect("the command has a default")
    }
}

/// How many.
#[derive(Args, Clone, Copy, Debug)]
pub struct Count {
    /// Number of bodies: leaves, flakes
    #[arg(long, value_name = "N", visible_aliases = ["leaves", "flakes", "bodies"])]
    pub count: Option<u32>,
}

impl Count {
    /// The number, of an example that has a default, or an end of the program if it is out of bounds.
    pub fn within(&self, bounds: std::ops::RangeInclusive<u32>) -> u32 {
        let count = self.count.expect("the command has a default");
        self.check(bounds);
        count
    }

    /// Ends the program if there is a number and it is out of bounds.
    pub fn check(&self, bounds: std::ops::RangeInclusive<u32>) {
        if let Some(count) = self.count.filter(|count| !bounds.contains(count)) {
            let (least, most) = (bounds.start(), bounds.end());
            cli::bad_value("--count", format!("{count} is not from {least} to {most}"));
        }
    }
}

/// Of what.
#[derive(Args, Clone, Copy, Debug)]
pub struct Material {
    /// Density of the body, kg/m³
    #[arg(long, value_name = "KG/M3", value_parser = positive)]
    pub density: Option<f64>,
}

/// The wind.
#[derive(Args, Clone, Copy, Debug)]
pub struct Wind {
    /// Wind along x at a height of 2 m, m/s; it grows with the logarithm of height
    #[arg(id = "wind", long = "wind", value_name = "M/S", default_value = "0", value_parser = not_negative)]
    pub speed: f64,
}

/// A part of what an example has.
#[derive(Args, Clone, Debug)]
pub struct Only<T: ValueEnum + Send + Sync + 'static> {
    /// Only these, parted by commas
    #[arg(long, value_enum, value_delimiter = ',', value_name = "NAME")]
    pub only: Vec<T>,
}
