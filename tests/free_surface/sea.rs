//! Random seas against their spectra.

use rapier3d_immersed::free_surface::{Dispersion, FreeSurface, Sea, WaveSpectrum, Waves};
use rapier3d_immersed::rapier3d::na::Vector3;
use rustfft::{FftPlanner, num_complex::Complex64};
use std::f64::consts::TAU;

const PERIOD: f64 = 5.0;
const STEP: f64 = 0.25;
const SAMPLES: usize = 8192;
const SEEDS: u64 = 60;

fn sea(peakedness: f64, seed: u64) -> Sea {
    Sea {
        spectrum: WaveSpectrum::jonswap(1.2, PERIOD, peakedness).unwrap(),
        seed,
        ..Sea::default()
    }
}

/// Heights at one place over time.
fn record(sea: &Waves, samples: usize, step: f64) -> Vec<f64> {
    (0..samples)
        .map(|i| sea.elevation(3.0, -2.0, step * i as f64).height)
        .collect()
}

/// Density of variance over bands of 5 %, of ω/ω_p from .7 on, by FFT of many records (with Hann's window, whose mean
/// square is ⅜), and what the spectrum has there.
fn bands(peakedness: f64) -> Vec<[f64; 3]> {
    let plan = FftPlanner::new().plan_fft_forward(SAMPLES);
    let mut power = vec![0.0; SAMPLES / 2];
    for seed in 0..SEEDS {
        let waves = Waves::sea(&sea(peakedness, seed)).unwrap();
        let mut line: Vec<Complex64> = record(&waves, SAMPLES, STEP)
            .into_iter()
            .enumerate()
            .map(|(i, height)| {
                let window = 0.5 - 0.5 * (TAU * i as f64 / SAMPLES as f64).cos();
                Complex64::new(height * window, 0.0)
            })
            .collect();
        plan.process(&mut line);
        for (sum, mode) in power.iter_mut().zip(&line) {
            *sum += 2.0 * mode.norm_sqr() / (SAMPLES as f64).powi(2) / 0.375 / SEEDS as f64;
        }
    }
    let (peak, bin) = (TAU / PERIOD, TAU / (STEP * SAMPLES as f64));
    let spectrum = sea(peakedness, 0).spectrum;
    let whole = 1.2_f64.powi(2) / 16.0 / spectrum.moment(0, 0.5 * peak, 4.0 * peak);
    (0..35)
        .map(|i| {
            let [from, to] = [i, i + 1].map(|i| (0.7 * 1.05_f64.powi(i) * peak / bin).round());
            let found: f64 = power[from as usize..to as usize].iter().sum();
            let [low, high] = [from, to].map(|m| (m - 0.5) * bin);
            let asked = whole * spectrum.moment(0, low, high);
            let width = high - low;
            [(low * high).sqrt() / peak, found / width, asked / width]
        })
        .collect()
}

/// Every band has the energy that was asked for: a band holds one or two waves of each of 60 seas, so that its mean scatters
/// by some .5/√60 = 6 %, and all 35 together by 1 %. The peak is where it should be, and beyond twice its frequency the density
/// falls with the power −5 + 5(ω_p/ω)⁴ of the formula, −4.9 between 2.2 and 3.7.
#[test]
fn records_have_the_spectrum() {
    for peakedness in [1.0, 3.3] {
        let bands = bands(peakedness);
        let mut mean = 0.0;
        for [x, found, asked] in &bands {
            println!("{x:.3} {found:.5} {asked:.5} {:.3}", found / asked);
            assert!((found / asked - 1.0).abs() < 0.2, "at {x}: {found} {asked}");
            mean += found / asked / bands.len() as f64;
        }
        assert!((mean - 1.0).abs() < 0.03, "{mean}");
        let highest = bands.iter().max_by(|a, b| a[1].total_cmp(&b[1])).unwrap();
        println!(
            "γ = {peakedness}: mean ratio {mean:.4}, peak at {:.3} ω_p",
            highest[0]
        );
        assert!((highest[0] - 1.0).abs() < 0.1, "{highest:?}");
        let tail: Vec<_> = bands
            .iter()
            .filter(|band| (2.2..3.7).contains(&band[0]))
            .collect();
        let n = tail.len() as f64;
        let logs = tail.iter().map(|[x, found, _]| (x.ln(), found.ln()));
        let (sx, sy) = logs
            .clone()
            .fold((0.0, 0.0), |s, (x, y)| (s.0 + x / n, s.1 + y / n));
        let slope = logs.clone().map(|(x, y)| (x - sx) * (y - sy)).sum::<f64>()
            / logs.map(|(x, _)| (x - sx).powi(2)).sum::<f64>();
        println!("  slope {slope:.3} over {n} bands");
        assert!((slope + 4.9).abs() < 0.2, "{slope}");
    }
}

/// The variance of every sea is H_s²/16; that of a record of 400 peak periods within what its length allows. Zero upcrossings
/// follow each other after 2π√(m₀/m₂), which is .7382 T_p for Pierson and Moskowitz cut off at 4 ω_p:
/// m₀ ∝ ⅕ exp(−1.25/4⁴), m₂ ∝ ¼√(π/1.25) erfc(√1.25/4²).
#[test]
fn heights_and_periods_are_as_asked() {
    // So dense that hardly a pair of crossings is missed: at .25 s it would be .7 % of them, at .1 s .1 %.
    let (samples, step) = (20_000, 0.1);
    let (mut crossings, mut duration, mut variance) = (0, 0.0, 0.0);
    let (mut fourth, mut most): (f64, f64) = (0.0, 0.0);
    for seed in 0..SEEDS {
        let waves = Waves::sea(&sea(1.0, seed)).unwrap();
        let sum: f64 = waves
            .waves()
            .iter()
            .map(|wave| wave.amplitude.powi(2))
            .sum();
        assert!((0.5 * sum - 1.2 * 1.2 / 16.0).abs() < 1e-12);
        assert!(waves.highest() == 2.4 && waves.bend() > 2.4 && waves.bend() < 10.0);
        let heights = record(&waves, samples, step);
        crossings += heights
            .windows(2)
            .filter(|pair| pair[0] < 0.0 && pair[1] >= 0.0)
            .count();
        duration += step * samples as f64;
        for height in heights {
            variance += height.powi(2) / (SEEDS as f64 * samples as f64);
            fourth += height.powi(4) / (SEEDS as f64 * samples as f64);
            most = most.max(height.abs());
        }
    }
    let period = duration / crossings as f64;
    let significant = 4.0 * variance.sqrt();
    println!(
        "H_s {significant:.4}, T_z/T_p {:.4}, kurtosis {:.3}, highest {most:.2}",
        period / PERIOD,
        fourth / variance.powi(2)
    );
    assert!((significant / 1.2 - 1.0).abs() < 0.005, "{significant}");
    assert!((period / PERIOD / 0.7382 - 1.0).abs() < 0.01, "{period}");
    // Gaussian.
    assert!((fourth / variance.powi(2) - 3.0).abs() < 0.15);
    assert!(most < 2.4);
}

/// Slopes and velocities show where the waves run to: ⟨η_x²⟩ − ⟨η_z²⟩ over their sum is ⟨cos 2θ⟩ = s(s − 1)/((s + 1)(s + 2)),
/// and the water at a crest runs along the wave, ⟨ηu⟩ over Σ½a²ω is ⟨cos θ⟩ = s/(s + 1).
#[test]
fn waves_spread_about_their_direction() {
    for (s, second, first) in [
        (2.0, 2.0 / 12.0, 2.0 / 3.0),
        (10.0, 90.0 / 132.0, 10.0 / 11.0),
    ] {
        for direction in [[2.0, 0.0], [0.0, -0.5]] {
            let (mut slopes, mut cross, mut carried, mut whole) = ([0.0; 2], 0.0, [0.0; 2], 0.0);
            for seed in 0..SEEDS {
                let waves = Waves::sea(&Sea {
                    spreading: s,
                    direction,
                    ..sea(3.3, seed)
                })
                .unwrap();
                for i in 0..500 {
                    let t = 2.3 * f64::from(i);
                    let surface = waves.elevation(0.0, 0.0, t);
                    let velocity = waves.velocity(&Vector3::zeros(), t);
                    let [x, z] = surface.slope;
                    slopes = [slopes[0] + x * x, slopes[1] + z * z];
                    cross += x * z;
                    let [u, w] = [velocity.x, velocity.z].map(|u| u * surface.height);
                    carried = [carried[0] + u, carried[1] + w];
                }
                whole += waves
                    .waves()
                    .iter()
                    .map(|wave| {
                        let period = waves.dispersion().period(wave.wavelength).unwrap();
                        0.5 * wave.amplitude.powi(2) * TAU / period * 500.0
                    })
                    .sum::<f64>();
            }
            let sum = slopes[0] + slopes[1];
            let along_x = direction[0] > 0.0;
            let difference = (slopes[0] - slopes[1]) / sum * if along_x { 1.0 } else { -1.0 };
            let (along, across) = if along_x {
                (carried[0], carried[1])
            } else {
                (-carried[1], carried[0])
            };
            println!(
                "s = {s}: {difference:.3} for {second:.3}, {:.3} for {first:.3}",
                along / whole
            );
            assert!((difference - second).abs() < 0.03, "{difference} {second}");
            assert!((along / whole - first).abs() < 0.03, "{along} {whole}");
            assert!((cross / sum).abs() < 0.02 && (across / whole).abs() < 0.04);
        }
    }
}

#[test]
fn seeds_repeat_a_sea() {
    let [a, b, c] = [3, 3, 4].map(|seed| Waves::sea(&sea(3.3, seed)).unwrap());
    assert_eq!(a, b);
    assert_ne!(a, c);
    let long = Waves::sea(&Sea {
        spreading: f64::INFINITY,
        ..sea(3.3, 1)
    })
    .unwrap();
    assert!(long.waves().iter().all(|wave| wave.direction == [1.0, 0.0]));
    // In water of 3 m, waves of 5 s are shorter than the 39 m of the deep.
    let dispersion = Dispersion {
        depth: 3.0,
        ..Dispersion::default()
    };
    let shallow = Waves::sea(&Sea {
        dispersion,
        ..sea(3.3, 3)
    })
    .unwrap();
    for (deep, shallow) in a.waves().iter().zip(shallow.waves()) {
        let period = a.dispersion().period(deep.wavelength).unwrap();
        assert!((dispersion.wavelength(period).unwrap() / shallow.wavelength - 1.0).abs() < 1e-9);
        assert_eq!(deep.amplitude, shallow.amplitude);
    }
}
