//! Identification of C̃ and the initial state of a card that flies by the crate's own dynamics.

use crate::card::{COLUMNS, PARAMETERS, TRUTH, ranges, simulate};
use crate::free_fall::Specimen;
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rand_pcg::Pcg64;
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::reduced::{FitParams, fit};

/// 600 frames of the first 0.6 s after a throw, every coordinate with noise of 1 % of its range: all
/// three coefficients within 5 %, and so are velocity, spin, orientation and position at the start.
/// (The spin is what the track says least about.)
#[test]
fn noisy_tracks_of_a_card_give_its_coefficients_back() {
    let card = Specimen::card().unwrap();
    let times: Vec<f64> = (0..600).map(|i| 0.6 * f64::from(i) / 599.0).collect();
    let columns = COLUMNS.len();
    let mut data = vec![0.0; columns * times.len()];
    simulate(&card, 667.0, &TRUTH, &times, &mut data);
    let range = |k: usize| {
        let values = data.iter().skip(k).step_by(columns);
        let (low, high) = values.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
        high - low
    };
    let row: Vec<f64> = (0..columns).map(|k| 0.01 * range(k)).collect();
    let deviations = row.repeat(times.len());
    for seed in [1, 2] {
        let mut random = Pcg64::seed_from_u64(seed);
        let noisy = data.iter().zip(&deviations).map(|(datum, deviation)| {
            datum + Normal::new(0.0, *deviation).unwrap().sample(&mut random)
        });
        let noisy: Vec<f64> = noisy.collect();
        let params = FitParams {
            stages: vec![0.15, 0.3, 0.6, 1.0],
            row: columns,
            seed,
            ..FitParams::default()
        };
        let model = |p: &[f64], out: &mut [f64]| simulate(&card, 667.0, p, &times, out);
        let fit = fit(model, &noisy, &deviations, &ranges(&noisy), &params).unwrap();
        println!(
            "{} runs, residual {}",
            fit.evaluations, fit.reduced_residual
        );
        assert!(fit.converged, "{fit:?}");
        for (k, truth) in TRUTH.iter().enumerate() {
            let off = fit.parameters[k] - truth;
            let deviation = fit.deviations[k];
            println!(
                "{}: {truth} off by {off:.4} ± {deviation:.4}",
                PARAMETERS[k]
            );
            assert!(k >= 3 || off.abs() < 0.05 * truth, "{}", PARAMETERS[k]);
        }
        // Velocity, spin, orientation and position as vectors.
        for first in [3, 6, 9, 12] {
            let vector = |p: &[f64]| Vector3::from_column_slice(&p[first..first + 3]);
            let off = (vector(&fit.parameters) - vector(&TRUTH)).norm() / vector(&TRUTH).norm();
            println!("{}…: off by {:.2} %", PARAMETERS[first], 100.0 * off);
            assert!(off < 0.05, "{}…: {off}", PARAMETERS[first]);
        }
        // It fits better than the truth does: this is the least minimum or below it.
        let squares = |prediction: &[f64]| -> f64 {
            let all = prediction.iter().zip(&noisy).zip(&deviations);
            all.map(|((p, d), s)| ((p - d) / s).powi(2)).sum()
        };
        assert!(squares(&fit.prediction) <= squares(&data));
        // 5400 data: the root of the mean square of the noise is within .04 of 1 by four of its
        // deviations.
        assert!((fit.reduced_residual - 1.0).abs() < 0.04, "{fit:?}");
    }
}
