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
mod rates;
#[path = "../support/mod.rs"]
mod support;
mod thesis;

use clap::{Parser, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use std::error::Error;
use std::path::Path;
use std::process::ExitCode;
use support::options::{Json, Only, Out};

/// Bake and draw reduced models.
#[derive(Parser)]
#[command(name = "reduced_models", version)]
#[command(mut_arg("only", |only| only.default_value("linear,falling,coupled,kirchhoff,driven")))]
struct Arguments {
    #[command(flatten)]
    out: Out,
    #[command(flatten)]
    only: Only<Name>,
    #[command(flatten)]
    json: Json,
}

/// Figures by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Name {
    /// A parametric linear model
    Linear,
    /// A falling body
    Falling,
    /// Coupled equations
    Coupled,
    /// Kirchhoff's equations
    Kirchhoff,
    /// A plate's horizon and the alternatives: half a minute
    Planar,
    /// A plate in water: minutes
    Plate,
    /// A card in air: minutes
    Card,
    /// A body in rapier by a reduced law
    Driven,
}

type Outcome = Result<serde_json::Value, Box<dyn Error>>;
type Figure = fn(&Path, &ProgressBar) -> Outcome;

const FIGURES: [(Name, &str, Figure); 8] = [
    (Name::Linear, "linear", thesis::linear_problem),
    (Name::Falling, "falling", thesis::falling),
    (Name::Coupled, "coupled", thesis::coupled),
    (Name::Kirchhoff, "kirchhoff", thesis::kirchhoff),
    (Name::Planar, "planar", horizon::planar),
    (Name::Plate, "plate", horizon::plate_in_water),
    (Name::Card, "card", horizon::card_in_air),
    (Name::Driven, "driven", driven::driven),
];

fn run(arguments: &Arguments) -> Result<(), String> {
    let folder = &arguments.out.folder;
    std::fs::create_dir_all(folder).map_err(|e| format!("--out: {}: {e}", folder.display()))?;
    let chosen: Vec<_> = FIGURES
        .iter()
        .filter(|(name, ..)| arguments.only.only.contains(name))
        .collect();
    let style = ProgressStyle::with_template("{elapsed_precise} [{bar:30}] {pos}/{len} {msg}")
        .map_err(|e| e.to_string())?;
    let bar = ProgressBar::new(chosen.len() as u64).with_style(style);
    let mut numbers = serde_json::Map::new();
    for (_, name, figure) in chosen {
        bar.set_message((*name).to_string());
        let path = arguments.out.path(&format!("{name}.svg"));
        let values = figure(&path, &bar).map_err(|e| format!("{}: {e}", path.display()))?;
        numbers.insert((*name).to_string(), values);
        bar.inc(1);
    }
    bar.finish_and_clear();
    if arguments.json.on {
        println!("{:#}", serde_json::Value::Object(numbers));
    } else {
        for (name, values) in &numbers {
            println!("{name}: {values}");
        }
    }
    Ok(())
}

fn main() -> ExitCode {
    match run(&support::cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}
