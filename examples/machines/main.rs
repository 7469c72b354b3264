//! Machines that air and water drive: built of rapier's bodies, their parts and joints.
//!
//! ```text
//! cargo run --release --example machines -- windmill
//! cargo run --release --example machines -- all      # every one of them
//! ```
//!
//! Each writes `out/machines/NAME.svg` and prints what it did beside what it should do. Each is one file here, of the
//! body and its parts first.

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
mod rov;
mod shuttlecock;
mod stage;
mod twig;
mod weather_vane;
mod windmill;

use film::Shown;
use std::path::Path;
use std::process::ExitCode;

type Failure = Box<dyn std::error::Error>;

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
    let wanted = std::env::args().nth(1).unwrap_or_default();
    let chosen: Vec<_> = MACHINES
        .iter()
        .filter(|(name, ..)| wanted == "all" || wanted == *name)
        .collect();
    if chosen.is_empty() {
        eprintln!("machines NAME, where NAME is one of:");
        for (name, what, _) in MACHINES {
            eprintln!("  {name:14} {what}");
        }
        eprintln!("  all");
        return ExitCode::FAILURE;
    }
    for (name, what, show) in chosen {
        println!("{name}: {what}");
        let path = format!("out/machines/{name}.svg");
        let written = show().and_then(|shown| {
            for line in &shown.lines {
                println!("  {line}");
            }
            film::write(Path::new(&path), &shown)
        });
        if let Err(problem) = written {
            eprintln!("{name}: {problem}");
            return ExitCode::FAILURE;
        }
        println!("  → {path}");
    }
    ExitCode::SUCCESS
}
