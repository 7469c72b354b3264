//! Parameter identification: which parameters make a model reproduce measured data.

use crate::error::Error;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rapier3d::na::{DMatrix, DVector};

/// Parameters of [`fit`].
#[derive(Clone, Debug, PartialEq)]
pub struct FitParams {
    /// Where to start; `None` (the default) stands for the best of `random_starts`.
    pub start: Option<Vec<f64>>,
    /// Random points of the ranges at which the model is tried first. Default 500.
    pub random_starts: usize,
    /// Number of the best random points from which a descent is run. Default 3.
    pub descents: usize,
    /// Growing fractions of the data, which are in order of time, to descend on one after the other,
    /// each from the result of the last: a long track of a motion that amplifies small differences
    /// has many false minima, its first part has few. Default `[1.0]`; for tracks of several
    /// flutters, `[0.15, 0.3, 0.6, 1.0]` found the true minimum every time.
    pub stages: Vec<f64>,
    /// Number of data of one instant, which stages do not divide. Default 1.
    pub row: usize,
    /// Most steps of a descent. Default 60.
    pub max_iterations: usize,
    /// A descent ends when the sum of squares falls by less than this fraction. Default 1e-8.
    pub tolerance: f64,
    /// Half step of the central differences, as a fraction of each range. Default 1e-5.
    pub difference: f64,
    /// Seed of the random starts. Default 1.
    pub seed: u64,
}

impl Default for FitParams {
    fn default() -> Self {
        Self {
            start: None,
            random_starts: 500,
            descents: 3,
            stages: vec![1.0],
            row: 1,
            max_iterations: 60,
            tolerance: 1e-8,
            difference: 1e-5,
            seed: 1,
        }
    }
}

/// What [`fit`] found. A fit that does not converge is no error.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The parameters with the least weighted squares.
    pub parameters: Vec<f64>,
    /// Standard deviations of the parameters, from the covariance.
    pub deviations: Vec<f64>,
    /// Covariance of the parameters, linearised at the minimum: (JᵀJ)⁻¹ times the mean squared
    /// weighted residual per degree of freedom.
    pub covariance: DMatrix<f64>,
    /// Root of the mean squared weighted residual per degree of freedom: 1 if the given deviations of the
    /// data are right and the model holds.
    pub reduced_residual: f64,
    /// What the model gives with these parameters.
    pub prediction: Vec<f64>,
    /// How often the model was run.
    pub evaluations: usize,
    /// Whether the descent ended by the tolerance, inside of the ranges.
    pub converged: bool,
    /// Parameters that ended at an end of their range, beyond which the data would have them.
    pub at_bound: Vec<usize>,
}

struct Problem<'a, F> {
    model: F,
    data: &'a [f64],
    deviations: &'a [f64],
    ranges: &'a [(f64, f64)],
    evaluations: usize,
}

impl<F: FnMut(&[f64], &mut [f64])> Problem<'_, F> {
    fn parameters(&self, scaled: &DVector<f64>) -> Vec<f64> {
        let pairs = self.ranges.iter().zip(scaled.iter());
        pairs
            .map(|((low, high), s)| low + (high - low) * s)
            .collect()
    }

    fn prediction(&mut self, scaled: &DVector<f64>) -> Vec<f64> {
        let mut prediction = vec![0.0; self.data.len()];
        let parameters = self.parameters(scaled);
        (self.model)(&parameters, &mut prediction);
        self.evaluations += 1;
        prediction
    }

    /// (prediction − data) / deviation, and half of what it costs.
    fn residual(&mut self, scaled: &DVector<f64>) -> (DVector<f64>, f64) {
        let prediction = self.prediction(scaled);
        let pairs = prediction.iter().zip(self.data).zip(self.deviations);
        let all = pairs.map(|((p, d), s)| (p - d) / s);
        let residual = DVector::from_iterator(self.data.len(), all);
        let cost = residual.norm_squared();
        (
            residual,
            if cost.is_finite() {
                cost
            } else {
                f64::INFINITY
            },
        )
    }

    fn jacobian(&mut self, at: &DVector<f64>, step: f64) -> DMatrix<f64> {
        let mut jacobian = DMatrix::zeros(self.data.len(), at.len());
        for k in 0..at.len() {
            let (mut above, mut below) = (at.clone(), at.clone());
            above[k] = (at[k] + step).min(1.0);
            below[k] = (at[k] - step).max(0.0);
            let width = above[k] - below[k];
            let difference = (self.residual(&above).0 - self.residual(&below).0) / width;
            // There is no slope to follow if the model fails beside the point.
            jacobian.set_column(k, &difference.map(|x| if x.is_finite() { x } else { 0.0 }));
        }
        jacobian
    }
}

/// Finds the parameters within `ranges` (low, high) for which `model(parameters, prediction)`
/// comes closest to `data` in least squares, each datum weighted by its standard deviation: random
/// starts, then Levenberg–Marquardt descents.
///
/// The model may be a separated representation, a tensor train or the dynamics themselves. It
/// writes as many data as `prediction` holds: the first ones, where [`FitParams::stages`] asks for a
/// part of them. Where it fails it may write anything not finite.
///
/// ```
/// use rapier3d_immersed::reduced::{FitParams, fit};
///
/// // A damped oscillation of which frequency and damping are wanted.
/// let model = |parameters: &[f64], prediction: &mut [f64]| {
///     for (i, value) in prediction.iter_mut().enumerate() {
///         let time = 0.1 * i as f64;
///         *value = (-parameters[1] * time).exp() * (parameters[0] * time).cos();
///     }
/// };
/// let mut track = [0.0; 50];
/// model(&[3.0, 0.4], &mut track);
/// track.iter_mut().enumerate().for_each(|(i, x)| *x += 0.01 * (7.3 * i as f64).sin()); // "noise"
/// let ranges = [(1.0, 6.0), (0.05, 1.5)];
/// let found = fit(model, &track, &[0.01; 50], &ranges, &FitParams::default())?;
/// assert!(found.converged && found.at_bound.is_empty());
/// assert!((found.parameters[0] - 3.0).abs() < 4.0 * found.deviations[0]);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
///
/// # Errors
/// If the stages do not grow to 1, lists differ in length, data are fewer than parameters, an entry is not
/// finite, a deviation not positive, a range empty, or the start outside of its range.
pub fn fit(
    mut model: impl FnMut(&[f64], &mut [f64]),
    data: &[f64],
    deviations: &[f64],
    ranges: &[(f64, f64)],
    params: &FitParams,
) -> Result<Fit, Error> {
    check(data, deviations, ranges, params)?;
    let mut start = params.start.clone();
    let mut evaluations = 0;
    let mut last = None;
    for stage in &params.stages {
        let rows = (stage * (data.len() / params.row) as f64).round() as usize;
        let count = if *stage == 1.0 {
            data.len()
        } else {
            rows * params.row
        };
        let count = count
            .max(ranges.len().next_multiple_of(params.row))
            .min(data.len());
        let problem = Problem {
            model: &mut model,
            data: &data[..count],
            deviations: &deviations[..count],
            ranges,
            evaluations: 0,
        };
        let fit = fit_stage(problem, start, params);
        evaluations += fit.evaluations;
        start = Some(fit.parameters.clone());
        last = Some(Fit { evaluations, ..fit });
    }
    Ok(last.expect("at least one stage"))
}

fn fit_stage<F: FnMut(&[f64], &mut [f64])>(
    mut problem: Problem<'_, F>,
    start: Option<Vec<f64>>,
    params: &FitParams,
) -> Fit {
    let (ranges, data) = (problem.ranges, problem.data);
    let n = ranges.len();
    let mut starts: Vec<(f64, DVector<f64>)> = Vec::new();
    if let Some(start) = &start {
        let scaled = start
            .iter()
            .zip(ranges)
            .map(|(x, (low, high))| (x - low) / (high - low));
        let scaled = DVector::from_iterator(n, scaled);
        starts.push((0.0, scaled));
    } else {
        let mut random = Pcg64::seed_from_u64(params.seed);
        for _ in 0..params.random_starts {
            let point = DVector::from_fn(n, |_, _| random.random());
            starts.push((problem.residual(&point).1, point));
        }
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        starts.truncate(params.descents);
    }
    let mut best: Option<(f64, DVector<f64>, bool)> = None;
    for (_, start) in starts {
        let (cost, point, converged) = descend(&mut problem, start, params);
        if best.as_ref().is_none_or(|b| cost < b.0) {
            best = Some((cost, point, converged));
        }
    }
    let (cost, point, converged) = best.expect("at least one start");
    let jacobian = problem.jacobian(&point, params.difference);
    let freedom = (data.len() - n).max(1) as f64;
    let normal = jacobian.tr_mul(&jacobian);
    // Directions that the data do not determine get an infinite deviation, not a panic.
    let inverse = normal
        .try_inverse()
        .unwrap_or_else(|| DMatrix::from_diagonal_element(n, n, f64::INFINITY));
    let width = |k: usize| ranges[k].1 - ranges[k].0;
    let covariance = DMatrix::from_fn(n, n, |i, j| {
        inverse[(i, j)] * cost / freedom * width(i) * width(j)
    });
    let at_bound: Vec<usize> = (0..n)
        .filter(|k| point[*k] <= 0.0 || point[*k] >= 1.0)
        .collect();
    Fit {
        parameters: problem.parameters(&point),
        deviations: (0..n).map(|k| covariance[(k, k)].max(0.0).sqrt()).collect(),
        covariance,
        reduced_residual: (cost / freedom).sqrt(),
        prediction: problem.prediction(&point),
        evaluations: problem.evaluations,
        converged: converged && at_bound.is_empty(),
        at_bound,
    }
}

fn check(
    data: &[f64],
    deviations: &[f64],
    ranges: &[(f64, f64)],
    params: &FitParams,
) -> Result<(), Error> {
    Error::check_all_finite("data", data)?;
    Error::check_length("deviations of the data", data.len(), deviations.len())?;
    for deviation in deviations {
        Error::check_positive("deviation of a datum", *deviation)?;
    }
    Error::check_positive("number of parameters", ranges.len() as f64)?;
    for (low, high) in ranges {
        Error::check_all_finite("ends of a range", &[*low, *high])?;
        Error::check_positive("width of a range", high - low)?;
    }
    if data.len() < ranges.len() {
        return Err(Error::WrongLength {
            what: "data",
            expected: ranges.len(),
            actual: data.len(),
        });
    }
    Error::check_positive("difference", params.difference)?;
    Error::check_positive("row", params.row as f64)?;
    let grow = params.stages.windows(2).all(|pair| pair[0] < pair[1]);
    match params.stages[..] {
        [first, ..] if first > 0.0 && grow && params.stages.ends_with(&[1.0]) => {}
        _ => {
            return Err(Error::InvalidParameter {
                parameter: "stages",
                requirement: "positive, growing and at last 1",
                value: params.stages.last().copied().unwrap_or(0.0),
            });
        }
    }
    if let Some(start) = &params.start {
        Error::check_length("start", ranges.len(), start.len())?;
        for (value, (low, high)) in start.iter().zip(ranges) {
            if !(low..=high).contains(&value) {
                return Err(Error::InvalidParameter {
                    parameter: "start",
                    requirement: "within its range",
                    value: *value,
                });
            }
        }
        return Ok(());
    }
    Error::check_positive("random_starts", params.random_starts as f64)?;
    Error::check_positive("descents", params.descents as f64)?;
    Ok(())
}

/// One Levenberg–Marquardt descent in the unit box: cost, point, whether it converged.
fn descend<F: FnMut(&[f64], &mut [f64])>(
    problem: &mut Problem<'_, F>,
    start: DVector<f64>,
    params: &FitParams,
) -> (f64, DVector<f64>, bool) {
    let mut point = start;
    let (mut residual, mut cost) = problem.residual(&point);
    let mut damping = 1e-2;
    for _ in 0..params.max_iterations {
        if !cost.is_finite() {
            return (cost, point, false);
        }
        let jacobian = problem.jacobian(&point, params.difference);
        let gradient = jacobian.tr_mul(&residual);
        let mut normal = jacobian.tr_mul(&jacobian);
        // Parameters at a bound that the descent would push across it stay there.
        let held: Vec<usize> = (0..point.len())
            .filter(|k| {
                (point[*k] <= 0.0 && gradient[*k] > 0.0) || (point[*k] >= 1.0 && gradient[*k] < 0.0)
            })
            .collect();
        let mut right = -&gradient;
        for k in held {
            normal.row_mut(k).fill(0.0);
            normal.column_mut(k).fill(0.0);
            normal[(k, k)] = 1.0;
            right[k] = 0.0;
        }
        let floor = 1e-12 * normal.diagonal().amax();
        loop {
            let mut damped = normal.clone();
            for k in 0..point.len() {
                damped[(k, k)] += damping * damped[(k, k)].max(floor);
            }
            let step = damped.cholesky().map(|c| c.solve(&right));
            let trial = step.map(|s| (&point + s).map(|x| x.clamp(0.0, 1.0)));
            if let Some(trial) = trial {
                let (new_residual, new_cost) = problem.residual(&trial);
                if new_cost < cost {
                    let gain = (cost - new_cost) / cost;
                    (point, residual, cost) = (trial, new_residual, new_cost);
                    damping = (damping * 0.2).max(1e-12);
                    if gain < params.tolerance {
                        return (cost, point, true);
                    }
                    break;
                }
            }
            damping *= 4.0;
            if damping > 1e10 {
                // No direction descends any more, so that this is a minimum.
                return (cost, point, true);
            }
        }
    }
    (cost, point, false)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_distr::{Distribution, Normal};

    fn decay(p: &[f64], out: &mut [f64]) {
        for (i, out) in out.iter_mut().enumerate() {
            *out = p[0] * (-p[1] * i as f64 * 0.05).exp() * (p[2] * i as f64 * 0.05).cos();
        }
    }

    /// The parameters of a damped oscillation lie within their stated deviations: over many noise seeds, two
    /// thirds within one deviation.
    #[test]
    fn deviations_are_honest() {
        let truth = [2.0, 0.4, 3.0];
        let ranges = [(0.5, 4.0), (0.05, 1.5), (1.0, 6.0)];
        let (mut within, mut total) = (0, 0);
        for seed in 0..40 {
            let mut data = vec![0.0; 120];
            decay(&truth, &mut data);
            let mut random = Pcg64::seed_from_u64(seed);
            let noise = Normal::new(0.0, 0.05).unwrap();
            data.iter_mut()
                .for_each(|d| *d += noise.sample(&mut random));
            let fit = fit(
                decay,
                &data,
                &[0.05; 120],
                &ranges,
                &FitParams {
                    seed,
                    ..FitParams::default()
                },
            )
            .unwrap();
            assert!(fit.converged, "{fit:?}");
            assert!((fit.reduced_residual - 1.0).abs() < 0.3, "{fit:?}");
            for (k, truth) in truth.iter().enumerate() {
                let off = (fit.parameters[k] - truth).abs() / fit.deviations[k];
                assert!(off < 4.5, "seed {seed}, parameter {k}: {off} deviations");
                within += usize::from(off < 1.0);
                total += 1;
            }
        }
        // 68 % of 120 are expected; three standard deviations of a binomial count are 15.
        assert!((67..=97).contains(&within), "{within} of {total}");
    }

    #[test]
    fn a_bound_is_reported() {
        let mut data = vec![0.0; 60];
        decay(&[2.0, 0.4, 3.0], &mut data);
        let ranges = [(0.5, 1.5), (0.05, 1.5), (1.0, 6.0)];
        let fit = fit(decay, &data, &[0.05; 60], &ranges, &FitParams::default()).unwrap();
        assert!(!fit.converged);
        assert_eq!(fit.at_bound, [0]);
    }

    #[test]
    fn bad_input_is_an_error() {
        let params = FitParams::default();
        let run = |data: &[f64], s: &[f64], ranges: &[(f64, f64)], params: &FitParams| {
            fit(decay, data, s, ranges, params)
        };
        let good = [(0.0, 1.0); 3];
        assert!(run(&[1.0; 2], &[1.0; 2], &good, &params).is_err());
        assert!(run(&[f64::NAN; 9], &[1.0; 9], &good, &params).is_err());
        assert!(run(&[1.0; 9], &[0.0; 9], &good, &params).is_err());
        assert!(run(&[1.0; 9], &[1.0; 8], &good, &params).is_err());
        assert!(run(&[1.0; 9], &[1.0; 9], &[(1.0, 1.0)], &params).is_err());
        assert!(run(&[1.0; 9], &[1.0; 9], &[], &params).is_err());
        for stages in [
            vec![],
            vec![0.5],
            vec![0.0, 1.0],
            vec![0.7, 0.2, 1.0],
            vec![f64::NAN, 1.0],
        ] {
            let params = FitParams {
                stages,
                ..params.clone()
            };
            assert!(run(&[1.0; 9], &[1.0; 9], &good, &params).is_err());
        }
        let outside = FitParams {
            start: Some(vec![2.0; 3]),
            ..params
        };
        assert!(run(&[1.0; 9], &[1.0; 9], &good, &outside).is_err());
        // A model that always fails does not panic.
        let failing = |_: &[f64], out: &mut [f64]| out.fill(f64::NAN);
        let fit = fit(failing, &[1.0; 9], &[1.0; 9], &good, &FitParams::default()).unwrap();
        assert!(!fit.converged);
    }
}
