//! Identification of the coefficients and the initial state of a falling plate from its track.

use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rand_pcg::Pcg64;
use rapier3d_immersed::reduced::FallingPlate;
use rapier3d_immersed::reduced::Tolerances;
use rapier3d_immersed::reduced::{FitParams, fit};

const TOLERANCES: Tolerances = Tolerances {
    relative: 1e-7,
    absolute: 1e-7,
    max_steps: 10_000,
};

/// (x, y, θ) at the times, from (C_T, C_R, A, B, μ, u, v, ω, θ, x, y).
fn track(inertia_ratio: f64, p: &[f64], times: &[f64], out: &mut [f64]) {
    let plate = FallingPlate::with_coefficients(inertia_ratio, [p[0], p[1], p[2], p[3], p[4]]);
    let start = [p[5], p[6], p[7], p[8], p[9], p[10]];
    let states = plate.trajectory(&start, &times[..out.len() / 3], TOLERANCES);
    for (row, state) in out.chunks_exact_mut(3).zip(states) {
        row.copy_from_slice(&[state[4], state[5], state[3]]);
    }
}

/// 600 frames of three flutter periods and of two tumbles, every coordinate with noise of 1 % of
/// its range: all five coefficients within 5 %, everything within four stated deviations.
#[test]
fn noisy_tracks_give_the_coefficients_back() {
    let truth = [
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
    let ranges = [
        (0.4, 2.5),
        (1.0, 6.0),
        (0.7, 2.5),
        (0.3, 2.0),
        (0.05, 0.6),
        (-1.5, 1.5),
        (-1.5, 1.5),
        (-1.0, 1.0),
        (-0.5, 1.5),
        (-0.2, 0.2),
        (-0.2, 0.2),
    ];
    for (inertia_ratio, end, seed) in [(0.5, 20.0, 1), (1.4, 13.0, 2)] {
        let times: Vec<f64> = (0..600).map(|i| end * f64::from(i) / 599.0).collect();
        let mut data = vec![0.0; 3 * times.len()];
        track(inertia_ratio, &truth, &times, &mut data);
        let range = |k: usize| {
            let values = data.iter().skip(k).step_by(3);
            let (low, high) = values.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
            high - low
        };
        let deviations: Vec<f64> =
            [0.01 * range(0), 0.01 * range(1), 0.01 * range(2)].repeat(times.len());
        let mut random = Pcg64::seed_from_u64(seed);
        for (datum, deviation) in data.iter_mut().zip(&deviations) {
            *datum += Normal::new(0.0, *deviation).unwrap().sample(&mut random);
        }
        let params = FitParams {
            stages: vec![0.15, 0.3, 0.6, 1.0],
            row: 3,
            seed,
            ..FitParams::default()
        };
        let model = |p: &[f64], out: &mut [f64]| track(inertia_ratio, p, &times, out);
        let fit = fit(model, &data, &deviations, &ranges, &params).unwrap();
        assert!(fit.converged, "{fit:?}");
        for (k, truth) in truth.iter().enumerate() {
            let off = fit.parameters[k] - truth;
            println!(
                "{k}: {:.4} ± {:.4}, off by {off:.4}",
                fit.parameters[k], fit.deviations[k]
            );
            assert!(off.abs() < 4.0 * fit.deviations[k], "parameter {k}");
            assert!(
                k >= 5 || (off / truth).abs() < 0.05,
                "coefficient {k}: {off}"
            );
        }
        assert!(
            (fit.reduced_residual - 1.0).abs() < 0.1,
            "{}",
            fit.reduced_residual
        );
    }
}
