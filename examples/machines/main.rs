//! Machines that air and water drive: built of rapier's bodies, their parts and joints.
//!
//! ```text
//! cargo run --release --example machines -- windmill
//! cargo run --release --example machines -- boomerang --open    # plays in the browser
//! cargo run --release --example machines -- all                 # every one of them
//! ```
//!
//! Each writes `NAME.svg`, `NAME.html` (plays in a browser) and `NAME.glb` (the same for 3-D tools), and prints what it did beside
//! what it should do. Each is one file here, of the body and its parts first.

mod anemometer;
mod arrow;
mod boomerang;
mod dart;
#[path = "../support/draw.rs"]
#[allow(dead_code, reason = "shared with other examples")]
mod draw;
mod film;
mod fold;
mod frisbee;
mod glider;
mod kite;
mod parachute;
mod reels;
mod rov;
mod shuttlecock;
mod stage;
#[path = "../support/mod.rs"]
mod support;
mod twig;
mod weather_vane;
mod windmill;

use clap::Parser;
use clap::builder::{PossibleValue, PossibleValuesParser};
use film::Shown;
use std::process::ExitCode;
use support::cli;
use support::film::{FilmArgs, FrameRate};
use support::options::Out;

type Failure = Box<dyn std::error::Error>;

/// Machines that air and water drive.
#[derive(Parser)]
#[command(name = "machines", version)]
#[command(mut_arg("out", |out| out.default_value("out/machines")))]
struct Options {
    /// Which of them, or all
    #[arg(value_name = "NAME", required = true, value_parser = PossibleValuesParser::new(names()))]
    names: Vec<String>,
    #[command(flatten)]
    frame_rate: FrameRate,
    #[command(flatten)]
    film: FilmArgs,
    #[command(flatten)]
    out: Out,
}

/// What can be asked for, with what it is.
fn names() -> Vec<PossibleValue> {
    let machines = MACHINES.iter();
    let machines = machines.map(|(name, what, _)| PossibleValue::new(*name).help(*what));
    machines.chain([PossibleValue::new("all")]).collect()
}

/// A machine: its name, what it is, and its run.
type Machine = (&'static str, &'static str, fn() -> Result<Shown, Failure>);

const MACHINES: &[Machine] = &[
    (
        "dart",
        "a paper airplane that flies across a room",
        dart::show,
    ),
    (
        "glider",
        "eight plates, put together in three ways",
        glider::show,
    ),
    (
        "kite",
        "a diamond on a bridle and a line, with a tail",
        kite::show,
    ),
    (
        "parachute",
        "a canopy and a load on eight lines",
        parachute::show,
    ),
    ("rov", "six thrusters keep depth in a current", rov::show),
    ("twig", "leaves on a twig that sways in gusts", twig::show),
    (
        "windmill",
        "three blades of strips on a hub, free to turn",
        windmill::show,
    ),
    (
        "anemometer",
        "four cups on arms about a vertical axle",
        anemometer::show,
    ),
    (
        "weather_vane",
        "a tail fin on a rod that turns into the wind",
        weather_vane::show,
    ),
    (
        "arrow",
        "a heavy point and crossed fins, let go askew",
        arrow::show,
    ),
    (
        "shuttlecock",
        "a cork and sixteen feathers, thrown tail first",
        shuttlecock::show,
    ),
    (
        "frisbee",
        "a disc under published coefficients, with and without spin",
        frisbee::show,
    ),
    (
        "boomerang",
        "four cambered blades of strips that come back",
        boomerang::show,
    ),
];

fn main() -> ExitCode {
    let options: Options = cli::parse();
    let asked = |name: &str| options.names.iter().any(|own| own == name || own == "all");
    for (name, what, show) in MACHINES.iter().filter(|(name, ..)| asked(name)) {
        println!("{name}: {what}");
        let written = show().and_then(|shown| write(name, what, &shown, &options));
        if let Err(problem) = written {
            eprintln!("{name}: {problem}");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

fn write(name: &str, what: &str, shown: &Shown, options: &Options) -> Result<(), Failure> {
    for line in &shown.lines {
        println!("  {line}");
    }
    let reel = reels::reel(name, options.frame_rate.hertz)?;
    let mut files = reel.write((name, what), None, &options.out, &options.film);
    let picture = options.out.path(&format!("{name}.svg"));
    film::write(&picture, shown)?;
    files.push(picture);
    println!("  {}", support::options::wrote(&files));
    Ok(())
}
