//! What thesis § 6.5 weighs against each other, on the falling plate: discrete empirical interpolation and
//! piecewise linear models, beside the tensor trains of `horizon`.

use crate::errors::{Errors, Truth};
use crate::horizon::{HORIZONS, TOLERANCES, parameters, plate, reduced, release_angle, start};
use crate::rates;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rapier3d_immersed::reduced::{
    DeimEvolution, DeimParams, PiecewiseLinear, Snapshot, Tolerances,
};
use std::error::Error;
use std::f64::consts::PI;
use std::time::Instant;

pub const DEIM: &str = "empirical interpolation (DEIM)";
pub const PIECEWISE_LINEAR: &str = "piecewise linear rates";

/// Trained trajectories of each.
const TRAINED: usize = 200;
/// Times of a snapshot per unit of time.
const PER_UNIT: f64 = 20.0;

/// Random parameters with the release angle, others than those that the errors are measured at.
fn training(range: (f64, f64)) -> Result<Vec<Vec<f64>>, Box<dyn Error>> {
    let mut axes = parameters(range, 2)?;
    axes.push(release_angle()?);
    let mut random = Pcg64::seed_from_u64(11);
    let mut point = || -> Vec<f64> {
        let ends = axes.iter().map(|axis| axis.start()..axis.end());
        ends.map(|ends| random.random_range(ends)).collect()
    };
    Ok((0..TRAINED).map(|_| point()).collect())
}

/// One reduced model per horizon: 200 trajectories give the modes, the equations at as many points the rest.
pub fn deim(
    range: (f64, f64),
    truth: &Truth,
) -> Result<(Errors, serde_json::Value), Box<dyn Error>> {
    let rate = |p: &[f64], x: &[f64], out: &mut [f64]| plate(p).rate(x, out);
    let training = training(range)?;
    let mut errors = Vec::new();
    let mut cost = Vec::new();
    for (h, end) in HORIZONS.into_iter().enumerate() {
        let count = (end * PER_UNIT).round() as usize;
        let times: Vec<f64> = (0..=count).map(|i| i as f64 / PER_UNIT).collect();
        let snapshots: Vec<Snapshot> = training
            .iter()
            .map(|p| Snapshot {
                parameters: p.clone(),
                states: plate(p)
                    .trajectory(&start(p[4]), &times, TOLERANCES)
                    .concat(),
            })
            .collect();
        let params = DeimParams {
            max_modes: 150,
            ..DeimParams::default()
        };
        let model = DeimEvolution::bake(6, &snapshots, rate, &params)?;
        let (mut failed, mut solved, clock) = (0, 0, Instant::now());
        let all = truth.errors(|p, horizons| {
            let (states, converged) = model.solve(p, &start(p[4]), rate);
            failed += usize::from(!converged);
            solved += 1;
            let last = states[states.len() - 2];
            horizons.iter().map(|_| [last, 0.0]).collect()
        });
        errors.push(all[h]);
        let milliseconds = clock.elapsed().as_secs_f64() * 1e3 / solved as f64;
        cost.push(serde_json::json!({ "horizon": end, "modes": model.modes(),
            "not_converged": failed as f64 / solved as f64, "ms_per_trajectory": milliseconds }));
    }
    Ok((errors, cost.into()))
}

/// The rates about points of 200 trajectories of the longest horizon, over state and parameters, integrated.
pub fn piecewise_linear(
    range: (f64, f64),
    truth: &Truth,
) -> Result<(Errors, serde_json::Value), Box<dyn Error>> {
    let end = HORIZONS[HORIZONS.len() - 1];
    let times: Vec<f64> = (0..=(end * PER_UNIT) as usize)
        .map(|i| i as f64 / PER_UNIT)
        .collect();
    let input = training(range)?.into_iter().flat_map(|p| {
        let states = plate(&p).trajectory(&start(p[4]), &times, TOLERANCES);
        let point = move |x: [f64; 6]| [&reduced(&x).0[..], &p[..4]].concat();
        states.into_iter().map(point).collect::<Vec<_>>()
    });
    // The state by its range; the parameters, which do little, by ten of theirs.
    let scales = [2.5, 1.6, 1.6, PI, 1.2, PI, 1.4, 10.0 * (range.1 - range.0)];
    let linear = PiecewiseLinear::bake(input, &scales, 0.03, (5, 4000), rates::exact)?;
    let loose = Tolerances {
        relative: 1e-4,
        absolute: 1e-4,
        max_steps: 4000,
    };
    let (mut evaluations, clock) = (0_u32, Instant::now());
    let errors = truth.errors(|p, horizons| {
        rates::integrated(p, horizons, loose, |point, out| {
            linear.evaluate(point, out);
            evaluations += 1;
        })
    });
    let microseconds = clock.elapsed().as_secs_f64() * 1e6 / f64::from(evaluations);
    let cost = serde_json::json!({ "points": linear.points(), "covered": linear.covered(),
        "us_per_rate": microseconds });
    Ok((errors, cost))
}
