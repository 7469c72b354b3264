//! Wind and turbulence in pictures:
//!
//! * `field_thesis.svg`: the gusty wind field at two heights, as Fig. 3.12 of the thesis, with its amplitudes,
//! * `field.svg`: the same with the default, measured spectrum, free of divergence,
//! * `spectra.svg`: the default's spectra against those of Kaimal et al. (1972),
//! * `paths.svg`: leaves carried off by winds of 1, 3 and 5 m/s, as Fig. 3.14,
//! * `history.svg`: ε/k and ε of the baked turbulence over time, as Fig. 4.2 of the thesis,
//! * `stream.svg`: the flow past the plate that it was baked from, with its turbulence.
//!
//! ```text
//! cargo run --release --features bake --example wind -- --out out --speed 4
//! ```

mod draw;
mod paths;

#[path = "../support/mod.rs"]
mod support;

use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use rapier3d_immersed::flow::{SpectralWind, WindParams};
use rapier3d_immersed::turbulence::{
    BakeReport, ShearSource, TurbulenceParams, TurbulenceState, TurbulenceTable,
};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;
use support::options::{Json, Out, Seed};

/// Draws wind fields, their spectra, and the baked turbulence.
#[derive(Parser)]
#[command(name = "wind", version)]
struct Arguments {
    #[command(flatten)]
    out: Out,
    /// Mean wind speed at a height of 10 m, m/s
    #[arg(
        long,
        value_name = "M/S",
        default_value_t = 4.0,
        allow_negative_numbers = true
    )]
    speed: f64,
    /// Roughness length of the ground, m
    #[arg(
        long,
        value_name = "M",
        default_value_t = 0.3,
        allow_negative_numbers = true
    )]
    roughness: f64,
    /// Nodes of the wind field along each horizontal axis
    #[arg(long, value_name = "N", default_value_t = 100)]
    nodes: usize,
    #[command(flatten)]
    seed: Seed,
    #[command(flatten)]
    json: Json,
    /// Also write the baked history as a table file, the one that the crate ships
    #[arg(long, value_name = "PATH")]
    write_default_table: Option<PathBuf>,
}

impl Arguments {
    /// The first flag whose value makes no sense, and what it should be.
    fn complaint(&self) -> Option<String> {
        let rules = [
            (
                "--speed",
                self.speed,
                self.speed > 0.0 && self.speed <= 100.0,
                "above 0 and at most 100 m/s",
            ),
            (
                "--roughness",
                self.roughness,
                self.roughness > 0.0 && self.roughness <= 2.0,
                "above 0 and at most 2 m",
            ),
            (
                "--nodes",
                self.nodes as f64,
                (4..=1024).contains(&self.nodes),
                "from 4 to 1024",
            ),
        ];
        rules
            .into_iter()
            .find(|rule| !rule.2)
            .map(|(flag, value, _, rule)| format!("{flag} must be {rule}, but is {value}"))
    }
}

fn main() -> ExitCode {
    let arguments: Arguments = support::cli::parse();
    if let Some(complaint) = arguments.complaint() {
        eprintln!("error: {complaint}");
        return ExitCode::from(2);
    }
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn std::error::Error>> {
    std::fs::create_dir_all(&arguments.out.folder)?;
    let params = |preset: WindParams| WindParams {
        mean_speed: arguments.speed,
        roughness: arguments.roughness,
        nodes: [arguments.nodes, arguments.nodes, 1],
        seed: arguments.seed.value,
        ..preset
    };
    let thesis = params(WindParams::thesis());
    let wind = SpectralWind::bake(&thesis)?;
    draw::field(&arguments.out.path("field_thesis.svg"), &wind, &thesis)?;
    let params = params(WindParams::default());
    let clock = Instant::now();
    let wind = SpectralWind::bake(&params)?;
    let wind_time = clock.elapsed().as_secs_f64();
    draw::field(&arguments.out.path("field.svg"), &wind, &params)?;
    draw::spectra(
        &arguments.out.path("spectra.svg"),
        &params,
        &spectra(&params)?,
    )?;

    let winds = paths::SPEEDS.map(|speed| paths::Paths::fly(&params, speed));
    let winds: Vec<_> = winds.into_iter().collect::<Result<_, _>>()?;
    paths::draw(&arguments.out.path("paths.svg"), &winds)?;

    let bar = ProgressBar::new(1000).with_style(ProgressStyle::with_template(
        "baking turbulence {bar:40} {percent} % {eta}",
    )?);
    let bake = |shear: ShearSource, field_frames: usize, preset: TurbulenceParams| {
        let params = TurbulenceParams {
            shear,
            field_frames,
            ..preset
        };
        TurbulenceTable::bake_with_progress(&params, &mut |share| {
            bar.set_position((1000.0 * share) as u64);
        })
    };
    let clock = Instant::now();
    let (table, plate) = bake(ShearSource::Plate, 2, TurbulenceParams::default())?;
    let bake_time = clock.elapsed().as_secs_f64();
    let (_, thesis) = bake(ShearSource::Plate, 0, TurbulenceParams::thesis())?;
    let (_, nothing) = bake(ShearSource::Nothing, 0, TurbulenceParams::thesis())?;
    bar.finish_and_clear();
    draw::history(
        &arguments.out.path("history.svg"),
        &plate,
        &thesis,
        &nothing,
    )?;
    draw::stream(&arguments.out.path("stream.svg"), &table, &plate)?;
    if let Some(path) = &arguments.write_default_table {
        std::fs::write(path, table.clone().without_field().to_bytes())?;
    }
    report(arguments, &wind, wind_time, bake_time, &plate, &table);
    if !arguments.json.on {
        for wind in &winds {
            println!(
                "leaves from 10 m height at {} m/s: {:.0} m off",
                wind.speed,
                wind.drift()
            );
        }
    }
    Ok(())
}

/// One-sided spectra along the wind of the three components: pairs of frequency (Hz, for a fixed
/// observer) and power per frequency (m²/s² per Hz), averaged over the lines of a few large fields.
fn spectra(params: &WindParams) -> Result<[Vec<(f64, f64)>; 3], rapier3d_immersed::Error> {
    let (length, nodes, seeds) = (4000.0, 1024usize, 4);
    let lines = nodes / 2;
    let mut power = [0, 1, 2].map(|_| vec![0.0; nodes / 2]);
    let plan = rustfft::FftPlanner::new().plan_fft_forward(nodes);
    for seed in 0..seeds {
        let wind = SpectralWind::bake(&WindParams {
            nodes: [nodes, lines, 1],
            size: [length, length / 2.0, 1.0],
            divergence_free: false,
            seed,
            ..params.clone()
        })?;
        for (c, power) in power.iter_mut().enumerate() {
            let values: Vec<f64> = wind
                .fluctuations()
                .map(|v| f64::from(v.to_array()[c]))
                .collect();
            for line in values.chunks(nodes) {
                let mut line: Vec<_> = line
                    .iter()
                    .map(|x| rustfft::num_complex::Complex64::new(*x, 0.0))
                    .collect();
                plan.process(&mut line);
                for (m, power) in power.iter_mut().enumerate() {
                    *power += 2.0 * line[m].norm_sqr() / (nodes * nodes) as f64;
                }
            }
        }
    }
    let step = params.mean_speed / length;
    Ok(power.map(|power| {
        let mean = |m: usize| power[m] / (lines * seeds as usize) as f64;
        (1..nodes / 2)
            .map(|m| (m as f64 * step, mean(m) / step))
            .collect()
    }))
}

fn report(
    arguments: &Arguments,
    wind: &SpectralWind,
    wind_time: f64,
    bake_time: f64,
    plate: &BakeReport,
    table: &TurbulenceTable,
) {
    let count = wind.fluctuations().count() as f32;
    let deviation = [0, 1, 2].map(|c| {
        let sum: f32 = wind.fluctuations().map(|v| v.to_array()[c].powi(2)).sum();
        (sum / count).sqrt()
    });
    let friction = wind.mean().friction_velocity();
    let chi = |state: &TurbulenceState| state.turnover_rate();
    let history = table.history();
    let peak = history.iter().map(chi).fold(0.0, f32::max);
    if arguments.json.on {
        let text = serde_json::json!({
            "friction_velocity_m_s": friction,
            "gust_deviation_m_s": deviation,
            "wind_bake_s": wind_time,
            "turbulence_bake_s": bake_time,
            "turnover_rate_first_peak_last": [chi(&history[0]), peak, chi(&history[history.len() - 1])],
            "left_box_at": plate.left_box_at,
            "worst_divergence": plate.worst_divergence,
            "unconverged_steps": plate.unconverged_steps,
            "largest_courant": plate.largest_courant,
            "pictures": arguments.out.folder,
        });
        println!("{text}");
        return;
    }
    println!(
        "friction velocity {friction:.3} m/s, gusts {deviation:.2?} m/s, baked in {:.1} ms",
        1e3 * wind_time
    );
    println!(
        "turbulence baked in {bake_time:.2} s: ε/k {:.2} at the release, at most {peak:.2}, {:.3} at the end (U₀/L)",
        chi(&history[0]),
        chi(&history[history.len() - 1]),
    );
    println!(
        "  divergence left {:.1e} U/h, {} steps not converged, Courant number at most {:.2}",
        plate.worst_divergence, plate.unconverged_steps, plate.largest_courant
    );
    if let Some(time) = plate.left_box_at {
        println!("  the particle left the box at {time:.2} L/U₀");
    }
    println!("pictures in {}", arguments.out.folder.display());
}

/// Spectrum S(n) of a component in the neutral surface layer, Kaimal et al. (1972).
fn kaimal(params: &WindParams, c: usize, n: f64) -> f64 {
    let (z, u) = (params.reference_height, params.mean_speed);
    let friction = 0.4 * u / (z / params.roughness).ln();
    let f = n * z / u;
    let reduced = match c {
        0 => 105.0 * f / (1.0 + 33.0 * f).powf(5.0 / 3.0),
        1 => 17.0 * f / (1.0 + 9.5 * f).powf(5.0 / 3.0),
        _ => 2.0 * f / (1.0 + 5.3 * f.powf(5.0 / 3.0)),
    };
    reduced * friction * friction / n
}
