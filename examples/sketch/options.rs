//! The command line.

use crate::support::Vec3;
use crate::support::cli::{self, finite};
use crate::support::film::{FilmArgs, FrameRate};
use crate::support::options::{Count, Out, Seed};
use clap::{Parser, ValueEnum};
use rapier3d_immersed::OnContact;
use rapier3d_immersed::motion::Pattern;
use std::path::PathBuf;

/// Leaves follow sketches, land where they are asked to, or fall in a series of patterns.
///
/// Without --count there is one leaf for each --land.
#[derive(Parser, Debug)]
#[command(name = "sketch", version, allow_negative_numbers = true)]
pub struct Options {
    /// Sketch to follow: an SVG file (its first path) or a CSV table of t, x, y, z (s and m, or with units in a header)
    #[arg(long, value_name = "FILE", conflicts_with_all = ["land", "patterns", "load"])]
    pub sketch: Option<PathBuf>,
    /// Place on the floor to land at, m; several for several leaves, in turn [default: 0.4,0.2 without any other request]
    #[arg(long, value_name = "X,Z", allow_hyphen_values = true, value_parser = numbers::<2>, conflicts_with_all = ["patterns", "load"])]
    pub land: Vec<[f64; 2]>,
    /// Point to pass on the way to the landing place, m; several from above to below
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = cli::vector)]
    pub pass: Vec<Vec3>,
    /// Patterns in their order: sd, ar, az, zz
    #[arg(long, value_delimiter = ',', conflicts_with = "load")]
    pub patterns: Vec<Pattern>,
    /// Codebook to play again, as --save has written it
    #[arg(long, value_name = "FILE")]
    pub load: Option<PathBuf>,
    /// Codebook to write: what each leaf was steered by, and beside it in .json its release and sketch
    #[arg(long, value_name = "FILE")]
    pub save: Option<PathBuf>,
    #[command(flatten)]
    pub count: Count,
    /// How far the start (of --sketch: the whole sketch) of a leaf is from that of the one before, m
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, default_value = "0.15,0,0", value_parser = cli::vector)]
    pub spread: Vec3,
    /// Height of the start, m [default: 2; of a CSV table its own, of patterns their descent]
    #[arg(long, value_name = "M", value_parser = cli::positive)]
    pub height: Option<f64>,
    /// Time for the way along an SVG path, s [default: that of a fall broadside from its height]
    #[arg(long, value_name = "S", value_parser = cli::positive)]
    pub pace: Option<f64>,
    /// A ball that stands in the way: center and radius, m
    #[arg(long, value_name = "X,Y,Z,R", allow_hyphen_values = true, value_parser = numbers::<4>)]
    pub obstacle: Vec<[f64; 4]>,
    /// A box that stands in the way: center and extents, m
    #[arg(long = "box", value_name = "X,Y,Z,A,B,C", allow_hyphen_values = true, value_parser = numbers::<6>)]
    pub boxes: Vec<[f64; 6]>,
    /// Wind that is the same everywhere, m/s
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, default_value = "0,0,0", value_parser = cli::vector)]
    pub uniform_wind: Vec3,
    /// What a contact does to a series that is played (--patterns, --load)
    #[arg(long, value_enum, default_value = "ignore")]
    pub on_contact: Contact,
    #[command(flatten)]
    pub seed: Seed,
    #[command(flatten)]
    pub frame_rate: FrameRate,
    #[command(flatten)]
    pub film: FilmArgs,
    #[command(flatten)]
    pub out: Out,
}

/// [`OnContact`] by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Contact {
    /// The series goes on
    Ignore,
    /// The leaf's own law moves it from then on
    Stop,
    /// The leaf's own law moves it while it touches, then the pattern begins anew
    Restart,
}

impl From<Contact> for OnContact {
    fn from(contact: Contact) -> Self {
        match contact {
            Contact::Ignore => Self::Ignore,
            Contact::Stop => Self::Stop,
            Contact::Restart => Self::Restart,
        }
    }
}

/// `N` finite numbers, parted by commas; the last of four is a radius and those after the third of six are extents.
fn numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let values = text.split(',').map(finite).collect::<Result<Vec<_>, _>>()?;
    let values = <[f64; N]>::try_from(values).map_err(|_| format!("must be {N} numbers"))?;
    match values
        .get(3..)
        .and_then(|sizes| sizes.iter().find(|size| **size <= 0.0))
    {
        Some(size) => Err(format!("{size} is no size: it must be above zero")),
        None => Ok(values),
    }
}
