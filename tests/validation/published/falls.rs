//! What the measured falls have in common: every runner, several seeds, medians.

use super::runner::Runner;
use super::{Effort, Failure, Progress};
use rapier3d_immersed::ViscousLaw;
use rapier3d_immersed::training::fidelity::{self, Fidelity, Report};

/// The runners; the first is the reference of the others.
pub const RUNNERS: [Runner; 5] = [
    Runner::Alone,
    Runner::HalfStep,
    Runner::Rapier(1),
    Runner::Rapier(4),
    Runner::Fine(4),
];

/// What the step is, for the column of sources.
pub const STEPS: &str = "dt = 1/240 s, 4 dt = 1/60 s";

/// One report per seed.
pub type Reports = Vec<Report>;

/// Drops everything in `measured` with every runner, under the default law.
///
/// # Errors
/// Those of the runs.
pub fn reports(
    measured: &Fidelity,
    effort: Effort,
    progress: Progress,
) -> Result<[Reports; 5], Failure> {
    let seeds: usize = effort.choose(4, 1);
    let mut all: [Reports; 5] = Default::default();
    let mut done = 0usize;
    for (reports, runner) in all.iter_mut().zip(RUNNERS) {
        for seed in 1..=seeds as u64 {
            let effort = fidelity::Effort {
                seed,
                releases: effort.choose(6, 2),
                drops: effort.choose(8, 3),
            };
            let law = ViscousLaw::default();
            reports.push(measured.run(&law, &effort, |experiment| runner.run(experiment))?);
            done += 1;
            progress(done as f64 / (RUNNERS.len() * seeds) as f64);
        }
    }
    Ok(all)
}

/// Median over the seeds of a number of each report; that of an even count is the mean of the middle two.
pub fn median(reports: &[Report], number: impl Fn(&Report) -> f64) -> f64 {
    let mut numbers: Vec<f64> = reports.iter().map(number).collect();
    numbers.sort_by(f64::total_cmp);
    let n = numbers.len();
    0.5 * (numbers[(n - 1) / 2] + numbers[n / 2])
}
