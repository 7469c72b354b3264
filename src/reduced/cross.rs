//! Cross approximation: a tensor train from samples of a function (Oseledets & Tyrtyshnikov 2010),
//! with ranks that grow by rectangular maximal-volume submatrices (Mikhalev & Oseledets 2018).

use super::axis::Axis;
use super::orthogonal::column_basis;
use super::tensor_train::{Core, TensorTrain};
use crate::error::Error;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rapier3d::na::DMatrix;
use std::collections::HashMap;

/// Parameters of [`cross()`].
#[derive(Clone, Debug, PartialEq)]
pub struct CrossParams {
    /// The sweeps stop when the error at random nodes, relative to the values there, is at most
    /// this. Default 1e-6.
    pub tolerance: f64,
    /// Most samples of the function. Default 200 000.
    pub max_evaluations: usize,
    /// Largest rank. Default 40.
    pub max_rank: usize,
    /// Most sweeps there and back. Default 12.
    pub max_sweeps: usize,
    /// By how much a rank may grow each way. Default 2.
    pub rank_growth: usize,
    /// Number of random nodes that the error is measured at; they are samples too. Default 200.
    pub check_points: usize,
    /// Seed of the first indices and of the random nodes. Default 1.
    pub seed: u64,
}

impl Default for CrossParams {
    fn default() -> Self {
        Self {
            tolerance: 1e-6,
            max_evaluations: 200_000,
            max_rank: 40,
            max_sweeps: 12,
            rank_growth: 2,
            check_points: 200,
            seed: 1,
        }
    }
}

/// How the sampling went. A sampling that does not converge is no error.
#[derive(Clone, Debug, PartialEq)]
pub struct CrossReport {
    /// Samples of the function.
    pub evaluations: usize,
    /// Error at the random nodes relative to the values there, after each sweep.
    pub errors: Vec<f64>,
    /// Whether the last of them met the tolerance.
    pub converged: bool,
}

/// The function on the grid, each node sampled once.
struct Sampler<'a, F> {
    axes: &'a [Axis],
    outputs: usize,
    function: F,
    known: HashMap<Vec<u16>, Vec<f64>>,
    /// The first value that was not finite, if any.
    bad: Option<f64>,
}

impl<F: FnMut(&[f64], &mut [f64])> Sampler<'_, F> {
    /// One output at one node; the index of the output follows those of the axes.
    fn at(&mut self, index: &[u16]) -> f64 {
        let (node, output) = index.split_at(self.axes.len());
        let output = usize::from(output[0]);
        if let Some(values) = self.known.get(node) {
            return values[output];
        }
        let coordinates = self
            .axes
            .iter()
            .zip(node)
            .map(|(axis, i)| axis.nodes()[usize::from(*i)]);
        let point: Vec<f64> = coordinates.collect();
        let mut values = vec![0.0; self.outputs];
        (self.function)(&point, &mut values);
        if let Some(bad) = values.iter().find(|v| !v.is_finite()) {
            self.bad.get_or_insert(*bad);
            values.fill(0.0);
        }
        let value = values[output];
        self.known.insert(node.to_vec(), values);
        value
    }
}

/// Samples `function(point, outputs)` on nodes of `axes` and approximates it by a tensor train.
///
/// ```
/// use rapier3d_immersed::reduced::{Axis, CrossParams, cross};
///
/// // Six coordinates: 9⁶ = 531 441 nodes, of which a few thousand are enough.
/// let axes = vec![Axis::spectral(0.0, 1.0, 9)?; 6];
/// let function = |x: &[f64], out: &mut [f64]| out[0] = 1.0 / (1.0 + x.iter().sum::<f64>());
/// let params = CrossParams { tolerance: 1e-5, ..CrossParams::default() };
/// let (train, report) = cross(axes, 1, function, &params)?;
/// assert!(report.converged && report.evaluations < 50_000);
/// let x = [0.11, 0.72, 0.35, 0.58, 0.93, 0.24];
/// assert!((train.evaluate(&x)[0] - 1.0 / (1.0 + x.iter().sum::<f64>())).abs() < 1e-4);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
///
/// # Errors
/// If there are no axes or outputs, an axis leaves an end out, there are more than 65 535 nodes or outputs, a
/// parameter is out of range, or a sample is not finite.
pub fn cross(
    axes: Vec<Axis>,
    outputs: usize,
    function: impl FnMut(&[f64], &mut [f64]),
    params: &CrossParams,
) -> Result<(TensorTrain, CrossReport), Error> {
    Error::check_positive("number of axes", axes.len() as f64)?;
    Error::check_positive("outputs", outputs as f64)?;
    axes.iter().try_for_each(Axis::check_free_ends)?;
    Error::check_positive("max_rank", params.max_rank as f64)?;
    Error::check_positive("max_sweeps", params.max_sweeps as f64)?;
    Error::check_positive("check_points", params.check_points as f64)?;
    let sizes: Vec<usize> = axes.iter().map(Axis::len).chain([outputs]).collect();
    for size in &sizes {
        if *size == 0 || *size > usize::from(u16::MAX) {
            return Err(Error::InvalidParameter {
                parameter: "nodes or outputs",
                requirement: "between 1 and 65535",
                value: *size as f64,
            });
        }
    }
    let mut sampler = Sampler {
        axes: &axes,
        outputs,
        function,
        known: HashMap::new(),
        bad: None,
    };
    let mut random = Pcg64::seed_from_u64(params.seed);
    let mut random_index = |from: usize, to: usize| -> Vec<u16> {
        sizes[from..to]
            .iter()
            .map(|n| random.random_range(0..*n) as u16)
            .collect()
    };
    let d = sizes.len();
    let checks: Vec<Vec<u16>> = (0..params.check_points)
        .map(|_| random_index(0, d))
        .collect();
    // left[k] has indices of the dimensions before k, right[k] of those from k on.
    let mut left: Vec<Vec<Vec<u16>>> = vec![vec![vec![]]; d + 1];
    let mut right: Vec<Vec<Vec<u16>>> = (0..=d)
        .map(|k| {
            if k == d {
                vec![vec![]]
            } else {
                (0..2).map(|_| random_index(k, d)).collect()
            }
        })
        .collect();
    right.iter_mut().for_each(|set| {
        set.dedup();
    });
    let mut report = CrossReport {
        evaluations: 0,
        errors: Vec::new(),
        converged: false,
    };
    let mut train = None;
    for _ in 0..params.max_sweeps {
        let mut cores = Vec::with_capacity(d);
        for k in 0..d {
            let (l, r) = (left[k].clone(), right[k + 1].clone());
            let unfolding = DMatrix::from_fn(l.len() * sizes[k], r.len(), |row, column| {
                let node = (row / l.len()) as u16;
                let index = [&l[row % l.len()][..], &[node], &r[column][..]].concat();
                sampler.at(&index)
            });
            if k + 1 == d {
                cores.push(Core::from_unfolding(&unfolding, l.len()));
            } else {
                let (rows, weights) = skeleton(&unfolding, params);
                let chosen = rows
                    .iter()
                    .map(|row| [&l[row % l.len()][..], &[(row / l.len()) as u16]].concat());
                left[k + 1] = chosen.collect();
                cores.push(Core::from_unfolding(&weights, l.len()));
            }
        }
        let candidate = TensorTrain {
            axes: axes.clone(),
            outputs,
            cores,
        };
        let error = error_at(&candidate, &checks, &mut sampler);
        report.errors.push(error);
        report.converged = error <= params.tolerance;
        train = Some(candidate);
        if report.converged || sampler.known.len() >= params.max_evaluations {
            break;
        }
        for k in (1..d).rev() {
            let (l, r) = (left[k].clone(), right[k + 1].clone());
            let unfolding = DMatrix::from_fn(sizes[k] * r.len(), l.len(), |row, column| {
                let node = (row / r.len()) as u16;
                let index = [&l[column][..], &[node], &r[row % r.len()][..]].concat();
                sampler.at(&index)
            });
            let (rows, _) = skeleton(&unfolding, params);
            let chosen = rows
                .iter()
                .map(|row| [&[(row / r.len()) as u16], &r[row % r.len()][..]].concat());
            right[k] = chosen.collect();
        }
    }
    report.evaluations = sampler.known.len();
    if let Some(value) = sampler.bad {
        return Err(Error::NotFinite {
            what: "sample of the function",
            index: 0,
            value,
        });
    }
    let train = train.expect("at least one sweep");
    train.check()?;
    Ok((train, report))
}

/// Relative error at nodes.
fn error_at<F: FnMut(&[f64], &mut [f64])>(
    train: &TensorTrain,
    checks: &[Vec<u16>],
    sampler: &mut Sampler<'_, F>,
) -> f64 {
    let (mut squares, mut norm) = (0.0, 0.0);
    for index in checks {
        let mut row = vec![1.0];
        for (core, node) in train.cores.iter().zip(index) {
            let size = core.left * core.right;
            let start = usize::from(*node) * size;
            let matrix =
                DMatrix::from_row_slice(core.left, core.right, &core.entries[start..start + size]);
            row = (matrix.transpose() * rapier3d::na::DVector::from_vec(row))
                .as_slice()
                .to_vec();
        }
        let exact = sampler.at(index);
        squares += (row[0] - exact).powi(2);
        norm += exact * exact;
    }
    if norm == 0.0 {
        squares.sqrt()
    } else {
        (squares / norm).sqrt()
    }
}

/// Rows of the matrix that span it well, and the weights W with `matrix ≈ W · matrix[rows]`.
fn skeleton(matrix: &DMatrix<f64>, params: &CrossParams) -> (Vec<usize>, DMatrix<f64>) {
    // What lies below rounding carries no information on which rows matter.
    let (q, _) = column_basis(matrix, 1e-13);
    if q.ncols() == 0 {
        // Any row represents a zero matrix.
        return (vec![0], DMatrix::zeros(matrix.nrows(), 1));
    }
    let mut rows = pivots(&q);
    let mut weights = q.clone() * inverse(&q.select_rows(&rows));
    // Rows are swapped as long as that enlarges the volume.
    for _ in 0..100 {
        let (mut row, mut column, mut most) = (0, 0, 0.0);
        for j in 0..weights.ncols() {
            for i in 0..weights.nrows() {
                if weights[(i, j)].abs() > most {
                    (row, column, most) = (i, j, weights[(i, j)].abs());
                }
            }
        }
        if most <= 1.02 {
            break;
        }
        rows[column] = row;
        weights = q.clone() * inverse(&q.select_rows(&rows));
    }
    // Further rows are taken where the weights are longest.
    let limit = params
        .max_rank
        .min(rows.len() + params.rank_growth)
        .min(matrix.nrows());
    while rows.len() < limit {
        let lengths = (0..weights.nrows()).map(|i| (i, weights.row(i).norm_squared()));
        let free = lengths.filter(|(i, _)| !rows.contains(i));
        let Some((row, length)) = free.max_by(|a, b| a.1.total_cmp(&b.1)) else {
            break;
        };
        let chosen = weights.row(row).transpose();
        let projection = &weights * &chosen / (1.0 + length);
        weights -= &projection * chosen.transpose();
        let columns = weights.ncols();
        weights = weights.insert_column(columns, 0.0);
        weights.set_column(columns, &projection);
        rows.push(row);
    }
    (rows, weights)
}

/// As many rows as columns, by Gaussian elimination with row pivoting.
fn pivots(q: &DMatrix<f64>) -> Vec<usize> {
    let mut rest = q.clone();
    let mut rows = Vec::new();
    for column in 0..q.ncols() {
        let free = (0..q.nrows()).filter(|i| !rows.contains(i));
        let best = free.max_by(|a, b| {
            rest[(*a, column)]
                .abs()
                .total_cmp(&rest[(*b, column)].abs())
        });
        let Some(row) = best else { break };
        rows.push(row);
        let pivot = rest[(row, column)];
        if pivot == 0.0 {
            continue;
        }
        let of_row = rest.row(row).into_owned();
        let factors = rest.column(column) / pivot;
        rest -= factors * of_row;
    }
    rows
}

fn inverse(square: &DMatrix<f64>) -> DMatrix<f64> {
    let n = square.nrows();
    square.clone().try_inverse().unwrap_or_else(|| {
        let svd = square.clone().svd(true, true);
        svd.pseudo_inverse(1e-14)
            .unwrap_or_else(|_| DMatrix::identity(n, n))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1/(1 + Σx) in six dimensions, with a second output, is right off the grid.
    #[test]
    fn a_smooth_function_of_six_variables() {
        let axes = vec![Axis::spectral(0.0, 1.0, 9).unwrap(); 6];
        let exact = |x: &[f64]| {
            let sum: f64 = x.iter().sum();
            [1.0 / (1.0 + sum), (sum + x[0] * x[5]).sin()]
        };
        let function = |x: &[f64], out: &mut [f64]| out.copy_from_slice(&exact(x));
        let params = CrossParams {
            tolerance: 1e-8,
            ..CrossParams::default()
        };
        let (train, report) = cross(axes, 2, function, &params).unwrap();
        assert!(report.converged, "{report:?}");
        // These are far fewer samples than the 9⁶ = 531 441 of the grid.
        assert!(report.evaluations < 60_000, "{report:?}");
        let rounded = train.rounded(1e-7);
        assert!(rounded.ranks().iter().sum::<usize>() < train.ranks().iter().sum());
        let mut random = Pcg64::seed_from_u64(3);
        for _ in 0..200 {
            let x: Vec<f64> = (0..6).map(|_| random.random()).collect();
            let (a, b) = (train.evaluate(&x), rounded.evaluate(&x));
            for k in 0..2 {
                // Interpolation with nine points is right to 1e-6 for a function that is singular at −1.
                assert!((a[k] - exact(&x)[k]).abs() < 1e-6, "{x:?}: {a:?}");
                assert!((a[k] - b[k]).abs() < 1e-6);
            }
        }
    }

    /// Ranks are exact: x + y + z has tensor-train rank two, x·y·z one, zero none.
    #[test]
    fn exact_ranks() {
        let axes = vec![Axis::spectral(-1.0, 1.0, 6).unwrap(); 3];
        let learn = |f: fn(&[f64]) -> f64| {
            let function = |x: &[f64], out: &mut [f64]| out[0] = f(x);
            cross(axes.clone(), 1, function, &CrossParams::default())
                .unwrap()
                .0
                .rounded(1e-10)
        };
        assert_eq!(learn(|x| x.iter().sum()).ranks(), [2, 2, 1]);
        assert_eq!(
            learn(|x| x.iter().product::<f64>() + 0.0).ranks(),
            [1, 1, 1]
        );
        assert_eq!(learn(|_| 0.0).evaluate(&[0.3, 0.2, 0.1]), [0.0]);
    }

    #[test]
    fn bad_input_is_an_error() {
        let axes = vec![Axis::spectral(0.0, 1.0, 4).unwrap(); 2];
        let zero = |_: &[f64], out: &mut [f64]| out.fill(0.0);
        let params = CrossParams::default();
        assert!(cross(vec![], 1, zero, &params).is_err());
        assert!(cross(axes.clone(), 0, zero, &params).is_err());
        let ends = axes.clone().into_iter().map(Axis::with_zero_end).collect();
        assert!(cross(ends, 1, zero, &params).is_err());
        let nan = |x: &[f64], out: &mut [f64]| out[0] = if x[0] > 0.5 { f64::NAN } else { 1.0 };
        assert!(matches!(
            cross(axes, 1, nan, &params),
            Err(Error::NotFinite { .. })
        ));
    }
}
