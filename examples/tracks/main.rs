//! Measured falls of paper circles and hexagons (`tests/data/paper`: Howison, Hughes & Iida 2020), beside this
//! crate's from the same start.
//!
//! ```text
//! cargo run --release --example tracks              # with the fits of tests/data/paper/fits.csv: a second
//! cargo run --release --example tracks -- --fit     # fits anew: minutes
//! cargo run --release --example tracks -- --track fall.csv --shape disc --size 0.02,0.0015 --density 2700 --fluid water
//! ```
//!
//! * **Forecasts.** The state at the first frame is estimated from 0.2 s of the track, under the default law as
//!   it is; from then on the fall goes on by itself. Printed: when it is a diameter off, beside a paper that
//!   goes straight on, and beside the measured repeat of the experiment.
//! * **Identification.** Coefficients of the law are fitted to 0.41 s of one track, with deviations and
//!   residual, and tried on the repeat, of which only the state is estimated.
//!
//! With `--track` it is a track of yours: printed is when the default law's fall from the same start parts from it, and how far;
//! `track.html` plays both side by side.
//!
//! `tracks.svg` has the paths with the attitude of the paper (as thesis Fig. 3.6 has them), `tracks_errors.svg`
//! the errors over time and the coefficients, `fits.csv` the fits.

#[path = "../support/draw.rs"]
#[allow(dead_code, reason = "shared with other examples")]
mod draw;
mod fits;
mod forecast;
mod measured;
mod own;
mod picture;
#[path = "../support/mod.rs"]
mod support;

use clap::Parser;
use fits::{FAMILIES, FallFit};
use forecast::{DEFAULT, FITTED, Family, KNOWN, PHYSICAL, THESIS, moved, straight_on};
use measured::{Fall, divergence};
use rayon::prelude::*;
use serde_json::json;
use std::process::ExitCode;
use support::options::{Json, Out};

type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Measured falls of paper, or one of your own, beside this crate's.
///
/// A body of a --track has 800 kg/m³ without --density.
#[derive(Parser)]
#[command(name = "tracks", version)]
struct Arguments {
    /// Fit anew instead of taking the fits of tests/data/paper/fits.csv
    #[arg(long)]
    fit: bool,
    #[command(flatten)]
    own: own::OwnArgs,
    #[command(flatten)]
    out: Out,
    #[command(flatten)]
    json: Json,
}

fn main() -> ExitCode {
    let arguments: Arguments = support::cli::parse();
    let outcome = match arguments.own.track.text() {
        Some(text) => own::compare(&text, &arguments),
        None => run(&arguments),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("error: {problem}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    let say = |line: String| {
        if !arguments.json.on {
            println!("{line}");
        }
    };
    let falls = Fall::all()?;
    let fits = if arguments.fit {
        fit(&falls)?
    } else {
        FallFit::shipped()?
    };
    let find = |fall: &Fall, family: &Family, of: &Fall| {
        let same = |f: &&FallFit| {
            (&*f.fall, &*f.law, &*f.coefficients_of) == (fall.name, family.name, of.name)
        };
        let found = fits.iter().find(same);
        found.ok_or_else(|| format!("fits.csv: no {} of {}", family.name, fall.name))
    };
    say(format!(
        "Seconds from the first frame until a diameter off; the state is estimated from the first {KNOWN} frames."
    ));
    say(format!(
        "{:22}{:>9}{:>9}{:>12}{:>10}{:>11}",
        "fall", "rms, mm", "ours", "straight on", "repeat", "views, r"
    ));
    let (mut forecasts, mut rows) = (Vec::new(), Vec::new());
    for (i, fall) in falls.iter().enumerate() {
        let forecast = find(fall, &DEFAULT, fall)?.forecast(fall, &DEFAULT)?;
        let until = |path: &[_]| divergence(path, &fall.positions, fall.diameter());
        let residual = 1e3 * forecast.residual();
        let [ours, straight, repeat] = [
            forecast.divergence,
            until(&straight_on(fall)),
            until(&moved(fall, &falls[i ^ 1])),
        ];
        let views = forecast.view_correlation(fall, KNOWN, 2 * KNOWN);
        say(format!(
            "{:22}{residual:9.1}{:>9}{:>12}{:>10}{views:11.2}",
            fall.name,
            seconds(ours),
            seconds(straight),
            seconds(repeat),
        ));
        rows.push(
            json!({ "fall": fall.name, "residual_mm": residual, "ours_s": ours,
            "straight_on_s": straight, "repeat_s": repeat, "views_correlation": views }),
        );
        forecasts.push(forecast);
    }
    say(format!(
        "\nCoefficients fitted to the first {FITTED} frames, and seconds until the repeat is a diameter off\n\
         (its state estimated from its first {KNOWN} frames; \"!\": at the end of its range)."
    ));
    let mut identified = Vec::new();
    for (i, fall) in falls.iter().enumerate() {
        for family in [&PHYSICAL, &THESIS] {
            let repeat = &falls[i ^ 1];
            let fit = find(fall, family, fall)?;
            let (coefficients, _) = fit.split(family);
            let held = find(repeat, family, fall)?.forecast(repeat, family)?;
            let named = family.coefficients.iter().enumerate().map(|(k, name)| {
                let mark = if fit.at_bound.contains(&k) { "!" } else { "" };
                format!(
                    "{name} {:.3}{mark} ± {:.3}",
                    coefficients[k], fit.deviations[k]
                )
            });
            let named: Vec<String> = named.collect();
            say(format!(
                "{:22}{:10}{}; residual {:.2}; repeat {}",
                fall.name,
                family.name,
                named.join(", "),
                fit.residual,
                seconds(held.divergence),
            ));
            identified.push(
                json!({ "fall": fall.name, "law": family.name, "names": family.coefficients,
                "coefficients": coefficients, "deviations": fit.deviations,
                "residual": fit.residual, "repeat_s": held.divergence }),
            );
        }
    }
    let out = &arguments.out.folder;
    std::fs::create_dir_all(out)?;
    let write = |name: &str, text: String| {
        let file = out.join(name);
        std::fs::write(&file, text).map_err(|e| format!("{}: {e}", file.display()))
    };
    write("tracks.svg", picture::paths(&falls, &forecasts)?)?;
    write(
        "tracks_errors.svg",
        picture::errors(&falls, &forecasts, &fits)?,
    )?;
    write("fits.csv", FallFit::csv(&fits))?;
    say(format!("Pictures and fits are in {}.", out.display()));
    if arguments.json.on {
        println!(
            "{:#}",
            json!({ "forecasts": rows, "identified": identified })
        );
    }
    Ok(())
}

/// Fits everything, and the states of repeats.
fn fit(falls: &[Fall]) -> Result<Vec<FallFit>, Failure> {
    let tasks: Vec<(usize, &Family)> = (0..falls.len())
        .flat_map(|i| FAMILIES.map(|family| (i, family)))
        .collect();
    let found = tasks.par_iter().map(|(i, family)| {
        let own = FallFit::new(&falls[*i], family, None)?;
        if family.coefficients.is_empty() {
            return Ok(vec![own]);
        }
        let repeat = FallFit::of_state(&falls[i ^ 1], family, &own)?;
        Ok(vec![own, repeat])
    });
    let found: Result<Vec<_>, rapier3d_immersed::Error> = found.collect();
    Ok(found?.concat())
}

fn seconds(time: Option<f64>) -> String {
    time.map_or("never".into(), |t| format!("{t:.2}"))
}
