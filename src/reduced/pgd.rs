//! Proper generalised decomposition of a linear problem: greedy enrichment by alternating
//! directions and projection of the coefficients (thesis §6.2.2–6.3.2), and update of all factors (ours).

use super::alternating::{enrich, project, update};
use super::canonical::{Canonical, scale_rows};
use super::operator::{Factor, Operator};
use super::orthogonal::column_basis;
use super::params::PgdParams;
use crate::error::Error;
use rand::SeedableRng;
use rand_pcg::Pcg64;
use rapier3d::na::DVector;

/// How the enrichment went. An enrichment that does not converge is no error.
#[derive(Clone, Debug, PartialEq)]
pub struct PgdReport {
    /// Number of terms of the solution.
    pub modes: usize,
    /// Residual, relative to the source, after each enrichment.
    pub residuals: Vec<f64>,
    /// Whether the last residual met the tolerance.
    pub converged: bool,
}

/// Solves A u = b for u in separated form.
///
/// `metric` holds the weights of the L² product on the nodes of each dimension
/// ([`Axis::weights`](super::axis::Axis::weights)); the factors are normalised in it, and the
/// residual of a weak form is measured in its inverse. `A` should be coercive (Galerkin); for any
/// other, pass [`Operator::normal`] and [`Operator::normal_source`].
///
/// ```
/// use rapier3d_immersed::rapier3d::na::DVector;
/// use rapier3d_immersed::reduced::{Axis, Canonical, Factor, Operator, Quadrature};
/// use rapier3d_immersed::reduced::{PgdParams, Separated, solve};
///
/// // −k u″ = 1 on (0, 1) with u = 0 at both ends, for every k from 1 to 2 at once.
/// let x = Axis::elements(0.0, 1.0, 8, 2)?.with_zero_start().with_zero_end();
/// let k = Axis::spectral(1.0, 2.0, 8)?;
/// let weights = |axis: &Axis| DVector::from_column_slice(axis.weights());
/// let stiffness = Factor::Dense(x.matrix(Quadrature::Gauss(3), 1, 1, |_| 1.0));
/// let mut operator = Operator::zero(&[x.len(), k.len()]);
/// operator.push(vec![stiffness, Factor::Diagonal(weights(&k).component_mul(&k.sample(|k| k)))])?;
/// let mut source = Canonical::zeros(&[x.len(), k.len()]);
/// source.push(1.0, &[x.load(Quadrature::Gauss(3), |_| 1.0), weights(&k)])?;
///
/// let metric = [weights(&x), weights(&k)];
/// let (tensor, report) = solve(&operator, &source, &metric, &PgdParams::default())?;
/// assert!(report.converged && report.modes == 1);
/// let u = Separated::new(1, vec![x, k], &tensor)?;
/// assert!((u.evaluate(&[0.3, 1.6])[0] - 0.5 * 0.3 * 0.7 / 1.6).abs() < 1e-6);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
///
/// # Errors
/// If shapes differ, the metric is not positive, the source not finite or a parameter out of range.
pub fn solve(
    operator: &Operator,
    source: &Canonical,
    metric: &[DVector<f64>],
    params: &PgdParams,
) -> Result<(Canonical, PgdReport), Error> {
    params.check()?;
    let shape = operator.shape();
    Error::check_length("dimensions of the source", shape.len(), source.dimensions())?;
    Error::check_length("dimensions of the metric", shape.len(), metric.len())?;
    for ((size, entries), weights) in shape.iter().zip(source.shape()).zip(metric) {
        Error::check_length("entries of the source", *size, entries)?;
        Error::check_length("entries of the metric", *size, weights.len())?;
        for weight in weights.iter() {
            Error::check_positive("metric", *weight)?;
        }
    }
    Error::check_all_finite("weights of the source", source.weights())?;
    for dimension in 0..shape.len() {
        Error::check_all_finite(
            "factors of the source",
            source.factors(dimension).as_slice(),
        )?;
    }
    let dual: Vec<DVector<f64>> = metric.iter().map(|w| w.map(f64::recip)).collect();
    let scale = source.norm(&dual);
    let mut solution = Canonical::zeros(shape);
    let mut report = PgdReport {
        modes: 0,
        residuals: Vec::new(),
        converged: scale == 0.0,
    };
    let mut random = Pcg64::seed_from_u64(params.seed);
    let mut residual = source.clone();
    while !report.converged && solution.rank() < params.max_modes {
        let mode = enrich(operator, &residual, metric, &[], params, &mut random);
        solution = solution.plus(1.0, &mode);
        project(operator, source, &mut solution);
        for _ in 0..params.update_rounds {
            update(operator, source, metric, &[], &mut solution);
        }
        solution.normalize(metric);
        residual = source.plus(-1.0, &operator.apply(&solution));
        let size = residual.norm(&dual) / scale;
        report.converged = size <= params.tolerance;
        report.residuals.push(size);
        if !size.is_finite() || solution.rank() < report.residuals.len() {
            break;
        }
    }
    solution.sort();
    report.modes = solution.rank();
    Ok((solution, report))
}

/// Fewer terms for the same tensor: orthogonalises the factors of every dimension, drops the
/// directions that the tensor does not need, and separates what is left anew, with
/// `params.tolerance` on the relative error. In two dimensions and with enough updates this is the
/// truncated singular value decomposition.
///
/// ```
/// use rapier3d_immersed::rapier3d::na::DVector;
/// use rapier3d_immersed::reduced::{Axis, Canonical, PgdParams, Separated, compress};
///
/// // sin(x + y), written as the sum of two terms and of a third that is twice the first.
/// let axis = Axis::spectral(0.0, 1.0, 10)?;
/// let [sin, cos]: [DVector<f64>; 2] = [f64::sin, f64::cos].map(|f| axis.sample(f));
/// let mut tensor = Canonical::zeros(&[10, 10]);
/// tensor.push(-1.0, &[sin.clone(), cos.clone()])?;
/// tensor.push(1.0, &[cos.clone(), sin.clone()])?;
/// tensor.push(2.0, &[sin, cos])?;
/// let wave = Separated::new(1, vec![axis.clone(), axis.clone()], &tensor)?;
/// let (fewer, _) = compress(&wave.to_canonical(), &wave.metric(), &PgdParams::default())?;
/// assert_eq!(fewer.rank(), 2);
/// let wave = Separated::new(1, vec![axis.clone(), axis], &fewer)?;
/// assert!((wave.evaluate(&[0.2, 0.5])[0] - 0.7_f64.sin()).abs() < 1e-6);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
///
/// # Errors
/// If the metric does not fit or is not positive, or a parameter is out of range.
pub fn compress(
    tensor: &Canonical,
    metric: &[DVector<f64>],
    params: &PgdParams,
) -> Result<(Canonical, PgdReport), Error> {
    Error::check_length(
        "dimensions of the metric",
        tensor.dimensions(),
        metric.len(),
    )?;
    let mut bases = Vec::new();
    let mut coordinates = Vec::new();
    for (dimension, weights) in metric.iter().enumerate() {
        let factors = tensor.factors(dimension);
        Error::check_length("entries of the metric", factors.nrows(), weights.len())?;
        for weight in weights.iter() {
            Error::check_positive("metric", *weight)?;
        }
        let scaled = scale_rows(factors, &weights.map(f64::sqrt));
        let (basis, columns) = column_basis(&scaled, 1e-14);
        coordinates.push(columns);
        bases.push(scale_rows(&basis, &weights.map(|w| w.sqrt().recip())));
    }
    if coordinates.iter().any(|c| c.nrows() == 0) {
        let report = PgdReport {
            modes: 0,
            residuals: Vec::new(),
            converged: true,
        };
        return Ok((Canonical::zeros(&tensor.shape()), report));
    }
    let small = Canonical::from_parts(tensor.weights().to_vec(), coordinates);
    let unit: Vec<_> = small
        .shape()
        .iter()
        .map(|n| DVector::repeat(*n, 1.0))
        .collect();
    let mut identity = Operator::zero(&small.shape());
    identity.push(unit.iter().cloned().map(Factor::Diagonal).collect())?;
    let (separated, report) = solve(&identity, &small, &unit, params)?;
    let factors = bases
        .iter()
        .enumerate()
        .map(|(j, basis)| basis * separated.factors(j));
    let compressed = Canonical::from_parts(separated.weights().to_vec(), factors.collect());
    Ok((compressed, report))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn problem() -> (Operator, Canonical, Vec<DVector<f64>>) {
        let diagonal = |s: f64| Factor::Diagonal(DVector::from_fn(6, |i, _| 1.0 + s * i as f64));
        let mut operator = Operator::zero(&[6, 6, 6]);
        operator
            .push(vec![diagonal(0.0), diagonal(0.1), diagonal(0.2)])
            .unwrap();
        operator
            .push(vec![diagonal(0.3), diagonal(0.0), diagonal(0.1)])
            .unwrap();
        let mut source = Canonical::zeros(&[6, 6, 6]);
        source.push(1.0, &vec![DVector::repeat(6, 1.0); 3]).unwrap();
        (operator, source, vec![DVector::repeat(6, 1.0); 3])
    }

    /// A diagonal problem is solved entry by entry: the separated solution must agree with it,
    /// by Galerkin and, with the sign of the operator reversed, by least squares.
    #[test]
    fn a_diagonal_problem() {
        let (operator, source, metric) = problem();
        let params = PgdParams {
            tolerance: 1e-9,
            update_rounds: 20,
            ..PgdParams::default()
        };
        let (galerkin, report) = solve(&operator, &source, &metric, &params).unwrap();
        assert!(report.converged, "{report:?}");
        let normal = operator.normal(&metric);
        let normal_source = operator.normal_source(&metric, &source);
        let (squares, _) = solve(&normal, &normal_source, &metric, &params).unwrap();
        for index in [[0, 0, 0], [5, 2, 1], [3, 3, 5], [5, 5, 5]] {
            let [i, j, k] = index.map(|i| i as f64);
            let diagonal = (1.0 + 0.1 * j) * (1.0 + 0.2 * k) + (1.0 + 0.3 * i) * (1.0 + 0.1 * k);
            assert!((galerkin.at(&index) - 1.0 / diagonal).abs() < 1e-8);
            assert!((squares.at(&index) - 1.0 / diagonal).abs() < 1e-6);
        }
    }

    /// The thesis's algorithm, without updates, converges as well, with more modes.
    #[test]
    fn updates_save_modes() {
        let (operator, source, metric) = problem();
        let modes = |update_rounds| {
            let params = PgdParams {
                tolerance: 1e-6,
                update_rounds,
                max_modes: 60,
                ..PgdParams::default()
            };
            let (_, report) = solve(&operator, &source, &metric, &params).unwrap();
            assert!(report.converged, "{report:?}");
            report.modes
        };
        let (plain, updated) = (modes(0), modes(10));
        assert!(updated < plain, "{updated} with updates, {plain} without");
    }

    /// Redundant terms go, the tensor stays.
    #[test]
    fn compression_finds_the_rank() {
        let metric = vec![DVector::from_fn(7, |i, _| 0.5 + i as f64); 3];
        let factor =
            |k: usize, j: usize| DVector::from_fn(7, |i, _| ((i * (k + 1) + j) as f64).sin());
        let mut tensor = Canonical::zeros(&[7, 7, 7]);
        for scale in [1.0, -0.3, 0.7] {
            for k in 0..2 {
                tensor
                    .push(scale, &[factor(k, 0), factor(k, 1), factor(k, 2)])
                    .unwrap();
            }
        }
        let params = PgdParams {
            tolerance: 1e-10,
            update_rounds: 50,
            ..PgdParams::default()
        };
        let (compressed, report) = compress(&tensor, &metric, &params).unwrap();
        assert!(report.converged && report.modes == 2, "{report:?}");
        assert!(compressed.plus(-1.0, &tensor).norm(&metric) < 1e-8 * tensor.norm(&metric));
        let (nothing, _) = compress(&Canonical::zeros(&[7, 7, 7]), &metric, &params).unwrap();
        assert_eq!(nothing.rank(), 0);
    }

    #[test]
    fn bad_input_is_an_error() {
        let (operator, source, metric) = problem();
        let params = PgdParams::default();
        assert!(solve(&operator, &Canonical::zeros(&[6, 6]), &metric, &params).is_err());
        assert!(solve(&operator, &source, &metric[1..], &params).is_err());
        let mut wrong = metric.clone();
        wrong[1][2] = -1.0;
        assert!(solve(&operator, &source, &wrong, &params).is_err());
        let mut nan = source.clone();
        nan.push(f64::NAN, &vec![DVector::zeros(6); 3]).unwrap();
        assert!(solve(&operator, &nan, &metric, &params).is_err());
        let negative = PgdParams {
            tolerance: -1.0,
            ..params
        };
        assert!(solve(&operator, &source, &metric, &negative).is_err());
    }
}
