//! Draws the examples of thesis §6.4 (its Figs. 6.2 to 6.8), what the reduced models of its §6.5 are worth on a
//! falling plate and on the crate's own dynamics (error against horizon), and leaves that a reduced model drives in
//! rapier (§7.3), and prints the errors.
//!
//! ```text
//! cargo run --release --example reduced_models -- --out out                             # a minute
//! cargo run --release --example reduced_models -- --out out --only planar,plate,card    # some five minutes
//! ```
//!
//! The errors against the horizon are measured at 150 points off the grid of each of two domains, by up to five methods:
//! those three figures are drawn only when they are named.

mod alternatives;
mod chart;
mod driven;
mod errors;
mod force_coefficients;
mod free_fall;
mod horizon;
mod own_horizon;
mod thesis;

use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Bake and draw reduced models.
#[derive(Parser)]
struct Arguments {
    /// Directory for the pictures.
    #[arg(long, default_value = "out")]
    out: PathBuf,
    /// Draw only these. All there are: linear, falling, coupled, kirchhoff, driven, and, of half a minute to several each,
    /// planar, plate, card
    #[arg(
        long,
        value_delimiter = ',',
        default_value = "linear,falling,coupled,kirchhoff,driven"
    )]
    only: Vec<String>,
    /// Print the numbers behind the pictures as JSON.
    #[arg(long)]
    json: bool,
}

type Outcome = Result<serde_json::Value, Box<dyn Error>>;
type Figure = fn(&Path, &ProgressBar) -> Outcome;

const FIGURES: [(&str, Figure); 8] = [
    ("linear", thesis::linear_problem),
    ("falling", thesis::falling),
    ("coupled", thesis::coupled),
    ("kirchhoff", thesis::kirchhoff),
    ("planar", horizon::planar),
    ("plate", horizon::plate_in_water),
    ("card", horizon::card_in_air),
    ("driven", driven::driven),
];

fn run(arguments: &Arguments) -> Result<(), String> {
    if let Some(name) = arguments
        .only
        .iter()
        .find(|name| !FIGURES.iter().any(|(known, _)| known == name))
    {
        return Err(format!("--only: there is no figure '{name}'"));
    }
    std::fs::create_dir_all(&arguments.out)
        .map_err(|e| format!("--out: {}: {e}", arguments.out.display()))?;
    let chosen: Vec<_> = FIGURES
        .iter()
        .filter(|(name, _)| arguments.only.iter().any(|o| o == name))
        .collect();
    let style = ProgressStyle::with_template("{elapsed_precise} [{bar:30}] {pos}/{len} {msg}")
        .map_err(|e| e.to_string())?;
    let bar = ProgressBar::new(chosen.len() as u64).with_style(style);
    let mut numbers = serde_json::Map::new();
    for (name, figure) in chosen {
        bar.set_message((*name).to_string());
        let path = arguments.out.join(format!("{name}.svg"));
        let values = figure(&path, &bar).map_err(|e| format!("{}: {e}", path.display()))?;
        numbers.insert((*name).to_string(), values);
        bar.inc(1);
    }
    bar.finish_and_clear();
    if arguments.json {
        println!("{:#}", serde_json::Value::Object(numbers));
    } else {
        for (name, values) in &numbers {
            println!("{name}: {values}");
        }
    }
    Ok(())
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}
