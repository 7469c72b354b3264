//! A random sea from above, and its spectrum against the one that was asked for: a picture.
//!
//! ```text
//! cargo run --release --example sea
//! ```
//!
//! Writes `sea.svg`.

mod support;

use clap::Parser;
use plotters::prelude::*;
use rapier3d_immersed::free_surface::{FreeSurface, Sea, WaveSpectrum, Waves};
use rustfft::{FftPlanner, num_complex::Complex64};
use std::error::Error;
use std::f64::consts::TAU;
use support::options::{Out, wrote};

const SAMPLES: usize = 8192;
const STEP: f64 = 0.25;
const SEEDS: u64 = 40;

/// Density of variance (m²s) of records at one place, by frequency (rad/s), in bands of 4 %.
fn density(sea: &Sea) -> Result<Vec<(f64, f64)>, Box<dyn Error>> {
    let plan = FftPlanner::new().plan_fft_forward(SAMPLES);
    let mut power = vec![0.0; SAMPLES / 2];
    for seed in 0..SEEDS {
        let waves = Waves::sea(&Sea { seed, ..*sea })?;
        let sample = |i: usize| {
            // Hann's window, of mean square ⅜, keeps the peak out of the tail.
            let window = 0.5 - 0.5 * (TAU * i as f64 / SAMPLES as f64).cos();
            let height = waves.elevation(0.0, 0.0, STEP * i as f64).height;
            Complex64::new(height * window, 0.0)
        };
        let mut record: Vec<_> = (0..SAMPLES).map(sample).collect();
        plan.process(&mut record);
        for (sum, mode) in power.iter_mut().zip(&record) {
            *sum += 2.0 * mode.norm_sqr() / (SAMPLES as f64).powi(2) / 0.375 / SEEDS as f64;
        }
    }
    let bin = TAU / (STEP * SAMPLES as f64);
    let edge = |i: i32| (0.4 * 1.04_f64.powi(i) / bin).round() as usize;
    let density = (0..60).map(|i| {
        let (from, to) = (edge(i), edge(i + 1));
        let sum: f64 = power[from..to].iter().sum();
        let frequency = bin * (from + to - 1) as f64 / 2.0;
        (frequency, sum / bin / (to - from) as f64)
    });
    Ok(density.collect())
}

/// A random sea from above, and its spectrum against the one that was asked for.
#[derive(Parser)]
#[command(name = "sea", version)]
struct Options {
    #[command(flatten)]
    out: Out,
}

fn main() -> Result<(), Box<dyn Error>> {
    let options: Options = support::cli::parse();
    std::fs::create_dir_all(&options.out.folder)?;
    let path = options.out.path("sea.svg");
    let spectrum = WaveSpectrum::jonswap(2.0, 6.0, 3.3)?;
    let sea = Sea {
        spectrum,
        waves: 150,
        seed: 5,
        ..Sea::default()
    };
    let waves = Waves::sea(&sea)?;

    let root = SVGBackend::new(&path, (1240, 600)).into_drawing_area();
    root.fill(&WHITE)?;
    let font = ("sans-serif", 20);
    let (left, right) = root.split_horizontally(610);
    let mut map = ChartBuilder::on(&left)
        .caption("JONSWAP sea, 2 m and 6 s, to the right", font)
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(50)
        .build_cartesian_2d(0.0..240.0, 0.0..240.0)?;
    map.configure_mesh()
        .disable_mesh()
        .x_desc("x, m")
        .y_desc("z, m")
        .draw()?;
    let cells = (0..120 * 120).map(|n| (f64::from(n % 120) * 2.0, f64::from(n / 120) * 2.0));
    map.draw_series(cells.map(|(x, z)| {
        let height = waves.elevation(x + 1.0, z + 1.0, 0.0).height;
        let shade = ViridisRGB.get_color((0.5 + height / 3.2).clamp(0.0, 1.0));
        Rectangle::new([(x, z), (x + 2.0, z + 2.0)], shade.filled())
    }))?;

    let mut chart = ChartBuilder::on(&right)
        .caption("Records of 40 seeds (dots), spectrum (line)", font)
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(60)
        .build_cartesian_2d((0.4..4.4).log_scale(), (2e-4..2.0).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("angular frequency, rad/s")
        .y_desc("S, m²s")
        .draw()?;
    let line = (0..400).map(|i| 0.4 * 11f64.powf(f64::from(i) / 400.0));
    let line = line.map(|frequency| (frequency, spectrum.density(frequency)));
    let shown = |point: &(f64, f64)| point.1 > 2e-4;
    chart.draw_series(LineSeries::new(line.filter(shown), BLUE.stroke_width(2)))?;
    let dots = density(&sea)?.into_iter().filter(shown);
    chart.draw_series(dots.map(|point| Circle::new(point, 3, RED.filled())))?;
    root.present()?;
    println!("{}", wrote(&[&path]));
    Ok(())
}
