//! Identifies the coefficients and the initial state of a falling plate from its track.
//!
//! Reads a CSV file with the header `t,x,y,angle` (seconds, metres with y up, radians; as from a
//! tracked video) or, without one, makes a track with noise and says how far off the result is.
//! Draws data, fit and residual into `identify.svg`.

#[path = "../reduced_models/chart.rs"]
mod chart;

use chart::{COLORS, Mark, Panel, SeriesLabelPosition, draw};
use clap::Parser;
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rapier3d_immersed::reduced::dormand_prince::Accuracy;
use rapier3d_immersed::reduced::falling_plate::FallingPlate;
use rapier3d_immersed::reduced::identify::{Fit, FitParams, fit};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

/// Identify the coefficients of a falling plate from its track.
#[derive(Parser)]
struct Arguments {
    /// CSV file with the header t,x,y,angle (s, m, m, rad). Without it a track is made up.
    #[arg(long)]
    csv: Option<PathBuf>,
    /// I* = ρ_s b / (ρ_f a) of the plate, b its half thickness, a its half chord.
    #[arg(long, default_value_t = 0.5)]
    inertia_ratio: f64,
    /// Half chord a, m.
    #[arg(long, default_value_t = 1.0)]
    length: f64,
    /// √((ρ_s/ρ_f − 1) g b), m/s.
    #[arg(long, default_value_t = 1.0)]
    speed: f64,
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

const NAMES: [&str; 11] = [
    "C_T", "C_R", "A", "B", "mu", "u0", "v0", "omega0", "angle0", "x0", "y0",
];
/// Coefficients of the track that is made up, and its start (dimensionless).
const TRUTH: [f64; 11] = [
    1.2,
    std::f64::consts::PI,
    1.4,
    1.0,
    0.2,
    0.5,
    -0.2,
    0.1,
    0.4,
    0.0,
    0.0,
];
const ACCURACY: Accuracy = Accuracy {
    relative: 1e-7,
    absolute: 1e-7,
    max_steps: 20_000,
};

/// Times and rows (x, y, angle), dimensionless.
struct Track {
    times: Vec<f64>,
    data: Vec<f64>,
}

fn model(inertia_ratio: f64, p: &[f64], times: &[f64], out: &mut [f64]) {
    let plate = FallingPlate::with_coefficients(inertia_ratio, [p[0], p[1], p[2], p[3], p[4]]);
    let start = [p[5], p[6], p[7], p[8], p[9], p[10]];
    let states = plate.trajectory(&start, &times[..out.len() / 3], ACCURACY);
    for (row, state) in out.chunks_exact_mut(3).zip(states) {
        row.copy_from_slice(&[state[4], state[5], state[3]]);
    }
}

fn read(text: &str, length: f64, speed: f64) -> Result<Track, String> {
    let mut lines = text.lines();
    let header = lines.next().unwrap_or_default().trim();
    if header != "t,x,y,angle" {
        return Err(format!(
            "--csv: the header is '{header}' instead of 't,x,y,angle'"
        ));
    }
    let mut track = Track {
        times: Vec::new(),
        data: Vec::new(),
    };
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
        if row.len() != 4 || row.iter().any(|x| !x.is_finite()) {
            return Err(format!("--csv: line {place} is not four finite numbers"));
        }
        track.times.push(row[0] * speed / length);
        track
            .data
            .extend([row[1] / length, row[2] / length, row[3]]);
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
        ("--noise", arguments.noise),
    ] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(format!("{flag}: {value} is not positive and finite"));
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

fn spread(data: &[f64], column: usize) -> f64 {
    let values = data.iter().skip(column).step_by(3);
    let (low, high) = values.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
    high - low
}

fn run(arguments: &Arguments) -> Result<(), String> {
    check(arguments)?;
    let track = match &arguments.csv {
        Some(path) => {
            let text = std::fs::read_to_string(path)
                .map_err(|e| format!("--csv: {}: {e}", path.display()))?;
            read(&text, arguments.length, arguments.speed)?
        }
        None => {
            let end = 20.0;
            let frames = arguments.frames;
            let times: Vec<f64> = (0..frames)
                .map(|i| end * i as f64 / (frames - 1) as f64)
                .collect();
            let mut data = vec![0.0; 3 * frames];
            model(arguments.inertia_ratio, &TRUTH, &times, &mut data);
            let mut random = rand_pcg::Pcg64::seed_from_u64(arguments.seed);
            let widths = [0, 1, 2].map(|k| arguments.noise * spread(&data, k));
            for (i, datum) in data.iter_mut().enumerate() {
                let noise = Normal::new(0.0, widths[i % 3]).map_err(|e| format!("--noise: {e}"))?;
                *datum += noise.sample(&mut random);
            }
            Track { times, data }
        }
    };
    let widths = [0, 1, 2].map(|k| (arguments.noise * spread(&track.data, k)).max(1e-9));
    let deviations = widths.repeat(track.times.len());
    let near = |x: f64, width: f64| (x - width, x + width);
    let ranges = [
        (0.4, 2.5),
        (1.0, 6.0),
        (0.7, 2.5),
        (0.3, 2.0),
        (0.05, 0.6),
        near(0.0, 2.0),
        near(0.0, 2.0),
        near(0.0, 1.5),
        near(track.data[2], 0.3),
        near(track.data[0], 0.3),
        near(track.data[1], 0.3),
    ];
    let params = FitParams {
        stages: vec![0.15, 0.3, 0.6, 1.0],
        row: 3,
        seed: arguments.seed,
        ..FitParams::default()
    };
    let clock = Instant::now();
    let result = fit(
        |p, out| model(arguments.inertia_ratio, p, &track.times, out),
        &track.data,
        &deviations,
        &ranges,
        &params,
    )
    .map_err(|error| format!("--csv: {error}"))?;
    let seconds = clock.elapsed().as_secs_f64();
    picture(arguments, &track, &result, widths)?;
    report(arguments, &result, seconds);
    Ok(())
}

fn report(arguments: &Arguments, result: &Fit, seconds: f64) {
    let truth = arguments.csv.is_none().then_some(TRUTH);
    if arguments.json {
        let parameters: serde_json::Map<String, serde_json::Value> = NAMES
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
    for (k, name) in NAMES.iter().enumerate() {
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
    track: &Track,
    result: &Fit,
    widths: [f64; 3],
) -> Result<(), String> {
    let pairs = |values: &[f64]| -> Vec<(f64, f64)> {
        values
            .chunks_exact(3)
            .map(|row| (row[0] * arguments.length, row[1] * arguments.length))
            .collect()
    };
    let mut path = Panel::new("track and fit", "x, m", "y, m");
    path.equal_axes = true;
    path.add("data", COLORS[5], Mark::Dots, pairs(&track.data));
    path.add("fit", COLORS[0], Mark::Line, pairs(&result.prediction));
    let seconds = arguments.length / arguments.speed;
    let column = |values: &[f64], k: usize| -> Vec<(f64, f64)> {
        let values = values.iter().skip(k).step_by(3);
        track
            .times
            .iter()
            .map(|t| t * seconds)
            .zip(values.copied())
            .collect()
    };
    let mut angle = Panel::new("angle", "time, s", "angle, rad");
    angle.add("data", COLORS[5], Mark::Dots, column(&track.data, 2));
    angle.add("fit", COLORS[1], Mark::Line, column(&result.prediction, 2));
    let mut residual = Panel::new(
        "data minus fit, in units of the noise",
        "time, s",
        "standard deviations",
    );
    for (k, name) in ["x", "y", "angle"].into_iter().enumerate() {
        let both = column(&track.data, k)
            .into_iter()
            .zip(column(&result.prediction, k));
        let points = both.map(|((t, d), (_, p))| (t, (d - p) / widths[k]));
        residual.add(name, COLORS[[0, 2, 1][k]], Mark::Dots, points.collect());
    }
    let mut ratio = Panel::new(
        "coefficients: value with ± 2 deviations, relative to it",
        "coefficient",
        "relative",
    );
    ratio.legend = Some(SeriesLabelPosition::LowerLeft);
    for k in 0..5 {
        let (value, deviation) = (result.parameters[k], result.deviations[k]);
        let bar = [-2.0, 0.0, 2.0].map(|s| (k as f64 + 1.0, 1.0 + s * deviation / value));
        ratio.add(
            &format!("{}: {}", k + 1, NAMES[k]),
            COLORS[k],
            Mark::LineAndDots,
            bar.to_vec(),
        );
    }
    if arguments.csv.is_none() {
        let truth = (0..5).map(|k| (k as f64 + 1.0, TRUTH[k] / result.parameters[k]));
        ratio.add("truth", chart::BLACK, Mark::Dots, truth.collect());
    }
    std::fs::create_dir_all(&arguments.out)
        .map_err(|e| format!("--out: {}: {e}", arguments.out.display()))?;
    let file = arguments.out.join("identify.svg");
    draw(&file, 2, &[path, angle, residual, ratio])
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
