//! Identifies the coefficients and the initial state of a falling body from its track: of a planar
//! plate, or of a card that flies by the crate's own dynamics under the thesis's law.
//!
//! ```text
//! cargo run --release --example identify -- --model card
//! ```
//!
//! Reads a CSV file as from a tracked video (seconds, metres with the vertical last, radians) with the
//! header `t,x,y,angle` (plate) or `t,x,y,z,qx,qy,qz,qw` (card: center and orientation, the long axis along
//! the body's x, the normal along its z). Without one it makes a track with noise and says how far off
//! the result is. Draws data, fit and residual into `identify.svg`.

mod card;
#[path = "../reduced_models/chart.rs"]
mod chart;
#[allow(dead_code, reason = "only its card is identified")]
#[path = "../reduced_models/free_fall.rs"]
mod free_fall;
mod model;

use chart::{COLORS, Mark, Panel, SeriesLabelPosition, draw};
use clap::{Parser, ValueEnum};
use model::Model;
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rapier3d_immersed::reduced::{Fit, FitParams, fit};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

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
#[command(allow_negative_numbers = true)]
struct Arguments {
    /// Which motion to look for.
    #[arg(long, value_enum, default_value = "plate")]
    model: ModelName,
    /// CSV file with the header t,x,y,angle (plate; s, m, m, rad) or t,x,y,z,qx,qy,qz,qw (card).
    /// Without it a track is made up.
    #[arg(long)]
    csv: Option<PathBuf>,
    /// Plate: I* = ρ_s b / (ρ_f a), b its half thickness, a its half chord.
    #[arg(long, default_value_t = 0.5)]
    inertia_ratio: f64,
    /// Plate: half chord a, m.
    #[arg(long, default_value_t = 1.0)]
    length: f64,
    /// Plate: √((ρ_s/ρ_f − 1) g b), m/s.
    #[arg(long, default_value_t = 1.0)]
    speed: f64,
    /// Card: ρ_s/ρ_f.
    #[arg(long, default_value_t = 667.0)]
    density_ratio: f64,
    /// Card: semi-axes, m; the fluid is air.
    #[arg(long, value_delimiter = ',', default_value = "0.035,0.02,0.0002")]
    semi_axes: Vec<f64>,
    /// Standard deviation of the data as a fraction of each coordinate's range.
    #[arg(long, default_value_t = 0.01)]
    noise: f64,
    /// Number of frames of the track that is made up.
    #[arg(long, default_value_t = 600)]
    frames: usize,
    /// Seed of its noise and of the search.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Directory for the picture.
    #[arg(long, default_value = "out")]
    out: PathBuf,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

/// Times, s from the first, and rows of the model's columns.
struct Track {
    times: Vec<f64>,
    data: Vec<f64>,
}

fn read(text: &str, model: &Model) -> Result<Track, String> {
    let mut lines = text.lines();
    let (header, expected) = (lines.next().unwrap_or_default().trim(), model.header);
    if header != expected {
        return Err(format!(
            "--csv: the header is '{header}' instead of '{expected}'"
        ));
    }
    let mut track = Track {
        times: Vec::new(),
        data: Vec::new(),
    };
    let fields = expected.split(',').count();
    for (number, line) in lines
        .enumerate()
        .filter(|(_, line)| !line.trim().is_empty())
    {
        let place = number + 2;
        let row: Result<Vec<f64>, _> = line
            .split(',')
            .map(|field| field.trim().parse::<f64>())
            .collect();
        let row = row.map_err(|error| format!("--csv: line {place}: {error}"))?;
        if row.len() != fields || row.iter().any(|x| !x.is_finite()) {
            return Err(format!(
                "--csv: line {place} is not {fields} finite numbers"
            ));
        }
        track.times.push(row[0]);
        let data = (model.row)(&row[1..])
            .ok_or_else(|| format!("--csv: line {place}: the quaternion is zero"))?;
        track.data.extend(data);
    }
    if track.times.len() < 20 {
        return Err(format!(
            "--csv: {} rows are fewer than 20",
            track.times.len()
        ));
    }
    if let Some(row) = track.times.windows(2).position(|pair| pair[0] >= pair[1]) {
        return Err(format!(
            "--csv: the times do not increase at line {}",
            row + 3
        ));
    }
    let first = track.times[0];
    track.times.iter_mut().for_each(|t| *t -= first);
    Ok(track)
}

fn check(arguments: &Arguments) -> Result<(), String> {
    for (flag, value) in [
        ("--inertia-ratio", arguments.inertia_ratio),
        ("--length", arguments.length),
        ("--speed", arguments.speed),
        ("--density-ratio", arguments.density_ratio),
        ("--noise", arguments.noise),
    ] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(format!("{flag}: {value} is not positive and finite"));
        }
    }
    if arguments.semi_axes.len() != 3 {
        let count = arguments.semi_axes.len();
        return Err(format!("--semi-axes: {count} lengths instead of 3"));
    }
    for x in &arguments.semi_axes {
        if !(*x > 0.0 && x.is_finite()) {
            return Err(format!("--semi-axes: {x} is not positive and finite"));
        }
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
    let mut random = rand_pcg::Pcg64::seed_from_u64(arguments.seed);
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
        ModelName::Plate => {
            model::plate(arguments.inertia_ratio, arguments.length, arguments.speed)
        }
        ModelName::Card => model::card(&arguments.semi_axes, arguments.density_ratio)
            .map_err(|error| format!("--semi-axes, --density-ratio: {error}"))?,
    };
    let track = match &arguments.csv {
        Some(path) => {
            let text = std::fs::read_to_string(path)
                .map_err(|e| format!("--csv: {}: {e}", path.display()))?;
            read(&text, &model)?
        }
        None => made_up(arguments, &model)?,
    };
    let columns = model.columns.len();
    let widths = widths(&track.data, columns, arguments.noise);
    let deviations = widths.repeat(track.times.len());
    let params = FitParams {
        stages: vec![0.15, 0.3, 0.6, 1.0],
        row: columns,
        seed: arguments.seed,
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
    .map_err(|error| format!("--csv: {error}"))?;
    let seconds = clock.elapsed().as_secs_f64();
    picture(arguments, &model, &track, &result, &widths)?;
    report(arguments, &model, &result, seconds);
    Ok(())
}

fn report(arguments: &Arguments, model: &Model, result: &Fit, seconds: f64) {
    let truth = arguments.csv.is_none().then_some(model.truth);
    if arguments.json {
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
            "seconds": seconds,
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
    if arguments.csv.is_none() {
        let truth = (0..model.coefficients)
            .map(|k| (k as f64 + 1.0, model.truth[k] / result.parameters[k]));
        ratio.add("truth", chart::BLACK, Mark::Dots, truth.collect());
    }
    std::fs::create_dir_all(&arguments.out)
        .map_err(|e| format!("--out: {}: {e}", arguments.out.display()))?;
    let file = arguments.out.join("identify.svg");
    draw(&file, 2, &[path, attitude, residual, ratio])
        .map_err(|e| format!("--out: {}: {e}", file.display()))
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
