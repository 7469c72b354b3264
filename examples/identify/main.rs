//! Identifies the coefficients and the initial state of a falling body from its track: of a planar
//! plate, or of a card that flies by the crate's own dynamics under the thesis's law.
//!
//! ```text
//! cargo run --release --example identify -- --model card
//! cargo run --release --example identify -- --model card --track fall.csv
//! ```
//!
//! Reads a table as from a tracked video, y up, with the columns `t_s,x_m,y_m,angle_rad` (plate) or `t_s,x_m,y_m,z_m,qx,qy,qz,qw`
//! (card: center and orientation, the long axis along the body's x, the normal along its z) among whatever others: the example
//! `drop` writes such a one of a `--shape leaf` with `--csv`. Without a track it makes one with noise and says how far off the result is.
//! Draws data, fit and residual into `identify.svg`.

mod card;
#[path = "../reduced_models/chart.rs"]
mod chart;
#[allow(dead_code, reason = "only its card is identified")]
#[path = "../reduced_models/free_fall.rs"]
mod free_fall;
mod model;
#[path = "../support/mod.rs"]
mod support;

use chart::{COLORS, Mark, Panel, SeriesLabelPosition, draw};
use clap::{Parser, ValueEnum};
use model::Model;
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rapier3d_immersed::reduced::{Fit, FitParams, fit};
use std::process::ExitCode;
use std::time::Instant;
use support::options::{Json, Out, Seed};
use support::track::TrackArgs;
use support::{Vec3, cli};

/// What is identified.
#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum ModelName {
    /// A plate in a plane: five coefficients, six initial values
    Plate,
    /// A card in space by the crate's own dynamics: C_D, C_L1, C_L2, twelve initial values
    Card,
}

/// Identify the coefficients of a falling body from its track.
#[derive(Parser)]
#[command(name = "identify", version, allow_negative_numbers = true)]
struct Arguments {
    /// Which motion to look for
    #[arg(long, value_enum, default_value = "plate")]
    model: ModelName,
    #[command(flatten)]
    track: TrackArgs,
    /// Plate: I* = ρ_s b / (ρ_f a), b its half thickness, a its half chord
    #[arg(long, value_name = "I", default_value = "0.5", value_parser = cli::positive)]
    inertia_ratio: f64,
    /// Plate: its chord 2 a, m
    #[arg(long, value_name = "M", default_value = "2", value_parser = cli::positive)]
    chord: f64,
    /// Plate: √((ρ_s/ρ_f − 1) g b), m/s
    #[arg(long, value_name = "M/S", default_value = "1", value_parser = cli::positive)]
    velocity_scale: f64,
    /// Card: ρ_s/ρ_f
    #[arg(long, value_name = "RATIO", default_value = "667", value_parser = cli::positive)]
    density_ratio: f64,
    /// Card, a thin ellipsoid: its length,width,thickness, m; the fluid is air
    #[arg(long, value_name = "A,B,C", default_value = "0.07,0.04,0.0004", value_parser = cli::vector)]
    card: Vec3,
    /// Standard deviation of the data as a fraction of each coordinate's range
    #[arg(long, value_name = "SHARE", default_value = "0.01", value_parser = cli::positive)]
    noise: f64,
    /// Number of frames of the track that is made up
    #[arg(long, value_name = "N", default_value = "600")]
    frames: usize,
    #[command(flatten)]
    seed: Seed,
    #[command(flatten)]
    out: Out,
    #[command(flatten)]
    json: Json,
}

/// Times, s from the first, and rows of the model's columns.
struct Track {
    times: Vec<f64>,
    data: Vec<f64>,
}

fn read(text: &str, model: &Model) -> Result<Track, String> {
    let (times, data) = (model.read)(text)?;
    if times.len() < 20 {
        return Err(format!("{} rows are fewer than 20", times.len()));
    }
    let first = times[0];
    let times = times.iter().map(|t| t - first).collect();
    Ok(Track { times, data })
}

fn check(arguments: &Arguments) -> Result<(), String> {
    if let Some(x) = arguments.card.iter().find(|x| **x <= 0.0) {
        return Err(format!("--card: {x} is no length"));
    }
    if !(20..=100_000).contains(&arguments.frames) {
        return Err(format!(
            "--frames: {} is not within 20..=100000",
            arguments.frames
        ));
    }
    Ok(())
}

/// Standard deviation of each column.
fn widths(data: &[f64], columns: usize, noise: f64) -> Vec<f64> {
    let width = |column: usize| {
        let values = data.iter().skip(column).step_by(columns);
        let (low, high) = values.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
        (noise * (high - low)).max(1e-9)
    };
    (0..columns).map(width).collect()
}

/// The model's own track with noise.
fn made_up(arguments: &Arguments, model: &Model) -> Result<Track, String> {
    let (frames, columns) = (arguments.frames, model.columns.len());
    let times: Vec<f64> = (0..frames)
        .map(|i| model.seconds * i as f64 / (frames - 1) as f64)
        .collect();
    let mut data = vec![0.0; columns * frames];
    (model.simulate)(model.truth, &times, &mut data);
    let mut random = rand_pcg::Pcg64::seed_from_u64(arguments.seed.value);
    let widths = widths(&data, columns, arguments.noise);
    for (datum, width) in data.iter_mut().zip(widths.iter().cycle()) {
        let noise = Normal::new(0.0, *width).map_err(|e| format!("--noise: {e}"))?;
        *datum += noise.sample(&mut random);
    }
    Ok(Track { times, data })
}

fn run(arguments: &Arguments) -> Result<(), String> {
    check(arguments)?;
    let model = match arguments.model {
        ModelName::Plate => model::plate(
            arguments.inertia_ratio,
            0.5 * arguments.chord,
            arguments.velocity_scale,
        ),
        ModelName::Card => {
            let semi_axes = (0.5 * arguments.card).into();
            model::card(semi_axes, arguments.density_ratio)
                .map_err(|error| format!("--card, --density-ratio: {error}"))?
        }
    };
    let track = match arguments.track.text() {
        Some(text) => read(&text, &model).map_err(|problem| format!("--track: {problem}"))?,
        None => made_up(arguments, &model)?,
    };
    let columns = model.columns.len();
    let widths = widths(&track.data, columns, arguments.noise);
    let deviations = widths.repeat(track.times.len());
    let params = FitParams {
        stages: vec![0.15, 0.3, 0.6, 1.0],
        row: columns,
        seed: arguments.seed.value,
        ..FitParams::default()
    };
    let clock = Instant::now();
    let result = fit(
        |p, out| (model.simulate)(p, &track.times, out),
        &track.data,
        &deviations,
        &(model.ranges)(&track.data),
        &params,
    )
    .map_err(|error| format!("--track: {error}"))?;
    let seconds = clock.elapsed().as_secs_f64();
    picture(arguments, &model, &track, &result, &widths)?;
    report(arguments, &model, &result, seconds);
    Ok(())
}

fn report(arguments: &Arguments, model: &Model, result: &Fit, seconds: f64) {
    let truth = arguments.track.track.is_none().then_some(model.truth);
    if arguments.json.on {
        let parameters: serde_json::Map<String, serde_json::Value> = model
            .parameters
            .iter()
            .enumerate()
            .map(|(k, name)| {
                let value = serde_json::json!({
                    "value": result.parameters[k],
                    "deviation": result.deviations[k],
                    "truth": truth.map(|t| t[k]),
                });
                ((*name).to_string(), value)
            })
            .collect();
        let all = serde_json::json!({
            "parameters": parameters,
            "reduced_residual": result.reduced_residual,
            "converged": result.converged,
            "evaluations": result.evaluations,
            "wall_time_s": seconds,
        });
        println!("{all:#}");
        return;
    }
    println!(
        "parameter     value   deviation{}",
        if truth.is_some() { "     truth" } else { "" }
    );
    for (k, name) in model.parameters.iter().enumerate() {
        let (value, deviation) = (result.parameters[k], result.deviations[k]);
        let truth = truth.map(|t| format!("{:10.4}", t[k])).unwrap_or_default();
        println!("{name:9} {value:9.4} {deviation:11.4}{truth}");
    }
    println!(
        "residual {:.3} of the stated noise, converged: {}, {} model runs in {seconds:.2} s",
        result.reduced_residual, result.converged, result.evaluations
    );
}

fn picture(
    arguments: &Arguments,
    model: &Model,
    track: &Track,
    result: &Fit,
    widths: &[f64],
) -> Result<(), String> {
    let columns = model.columns.len();
    let [across, up] = model.path;
    let pairs = |values: &[f64]| -> Vec<(f64, f64)> {
        let rows = values.chunks_exact(columns);
        rows.map(|row| (row[across], row[up])).collect()
    };
    let name = |k: usize| format!("{}, m", model.columns[k]);
    let mut path = Panel::new("track and fit", &name(across), &name(up));
    path.equal_axes = true;
    path.add("data", COLORS[5], Mark::Dots, pairs(&track.data));
    path.add("fit", COLORS[0], Mark::Line, pairs(&result.prediction));
    let column = |values: &[f64], k: usize| -> Vec<(f64, f64)> {
        let values = values.iter().skip(k).step_by(columns);
        track.times.iter().copied().zip(values.copied()).collect()
    };
    let mut attitude = Panel::new(model.attitude_title, "time, s", model.attitude_title);
    for (i, k) in model.attitude.iter().enumerate() {
        let label = if i == 0 { "data" } else { "" };
        attitude.add(label, COLORS[5], Mark::Dots, column(&track.data, *k));
    }
    for (i, k) in model.attitude.iter().enumerate() {
        let fit = column(&result.prediction, *k);
        let label = format!("fit, {}", model.columns[*k]);
        attitude.add(&label, COLORS[[1, 0, 2][i % 3]], Mark::Line, fit);
    }
    let mut residual = Panel::new(
        "data minus fit, in units of the noise",
        "time, s",
        "standard deviations",
    );
    // Position, or all of a planar motion, in colors; the rest in grey behind them.
    for k in (3..columns).chain(0..3) {
        let both = column(&track.data, k)
            .into_iter()
            .zip(column(&result.prediction, k));
        let points = both.map(|((t, d), (_, p))| (t, (d - p) / widths[k]));
        let (label, color) = match k {
            0..3 => (model.columns[k], COLORS[[0, 2, 1][k]]),
            3 => ("axes", COLORS[5]),
            _ => ("", COLORS[5]),
        };
        residual.add(label, color, Mark::Dots, points.collect());
    }
    let mut ratio = Panel::new(
        "coefficients: value with ± 2 deviations, relative to it",
        "coefficient",
        "relative",
    );
    ratio.legend = Some(SeriesLabelPosition::LowerLeft);
    for (k, color) in COLORS.into_iter().enumerate().take(model.coefficients) {
        let (value, deviation) = (result.parameters[k], result.deviations[k]);
        let bar = [-2.0, 0.0, 2.0].map(|s| (k as f64 + 1.0, 1.0 + s * deviation / value));
        ratio.add(
            &format!("{}: {}", k + 1, model.parameters[k]),
            color,
            Mark::LineAndDots,
            bar.to_vec(),
        );
    }
    if arguments.track.track.is_none() {
        let truth = (0..model.coefficients)
            .map(|k| (k as f64 + 1.0, model.truth[k] / result.parameters[k]));
        ratio.add("truth", chart::BLACK, Mark::Dots, truth.collect());
    }
    let folder = &arguments.out.folder;
    std::fs::create_dir_all(folder).map_err(|e| format!("--out: {}: {e}", folder.display()))?;
    let file = arguments.out.path("identify.svg");
    draw(&file, 2, &[path, attitude, residual, ratio])
        .map_err(|e| format!("--out: {}: {e}", file.display()))
}

fn main() -> ExitCode {
    match run(&cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}
