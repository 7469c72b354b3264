//! Proper generalised decomposition of a linear problem: greedy enrichment by alternating
//! directions, projection of the coefficients, update of all factors (thesis §6.2.2–6.3.2).

use super::canonical::{Canonical, scale_rows};
use super::operator::{Factor, Operator};
use super::orthogonal::column_basis;
use crate::Error;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rapier3d::na::{DMatrix, DVector};

/// How a separated solution is sought.
#[derive(Clone, Debug, PartialEq)]
pub struct PgdParams {
    /// Most terms of the solution. Default 30.
    pub max_modes: usize,
    /// The enrichment stops when the residual, relative to the source, is at most this. Default 1e-8.
    pub tolerance: f64,
    /// Most rounds over all dimensions in the search of one new term. Default 12.
    pub fixed_point_rounds: usize,
    /// That search also stops when the term changes by less than this fraction (thesis (6.13)).
    /// Default 1e-4: a rough term is good enough where updates follow.
    pub fixed_point_tolerance: f64,
    /// Rounds over all dimensions, after each enrichment, in which the factors of *all* terms are
    /// solved for together. 0 is the thesis's algorithm; with a few the terms come close to
    /// the best separation of their number. Default 2.
    pub update_rounds: usize,
    /// Seed of the random starts of the fixed point. Default 1.
    pub seed: u64,
}

impl Default for PgdParams {
    fn default() -> Self {
        Self {
            max_modes: 30,
            tolerance: 1e-8,
            fixed_point_rounds: 12,
            fixed_point_tolerance: 1e-4,
            update_rounds: 2,
            seed: 1,
        }
    }
}

impl PgdParams {
    pub(crate) fn check(&self) -> Result<(), Error> {
        Error::check_positive("max_modes", self.max_modes as f64)?;
        Error::check_positive("fixed_point_rounds", self.fixed_point_rounds as f64)?;
        for (parameter, value) in [
            ("tolerance", self.tolerance),
            ("fixed_point_tolerance", self.fixed_point_tolerance),
        ] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(Error::InvalidParameter {
                    parameter,
                    requirement: "finite and not negative",
                    value,
                });
            }
        }
        Ok(())
    }
}

/// How the enrichment went. Not to converge is no error.
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
    Error::check_finite("weights of the source", source.weights())?;
    for dimension in 0..shape.len() {
        Error::check_finite(
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

/// One new term for the residual, by the alternating-direction fixed point (thesis §6.3.1).
pub(crate) fn enrich(
    operator: &Operator,
    residual: &Canonical,
    metric: &[DVector<f64>],
    causal: &[usize],
    params: &PgdParams,
    random: &mut Pcg64,
) -> Canonical {
    let mut mode = Canonical::zeros(operator.shape());
    let start: Vec<DVector<f64>> = operator
        .shape()
        .iter()
        .map(|n| DVector::from_fn(*n, |_, _| 1.0 + random.random_range(-0.5..0.5)))
        .collect();
    mode.push(1.0, &start)
        .expect("the start has the shape of the operator");
    mode.normalize(metric);
    for _ in 0..params.fixed_point_rounds {
        let previous = mode.clone();
        update(operator, residual, metric, causal, &mut mode);
        if mode.rank() == 0 {
            break;
        }
        let change = mode.plus(-1.0, &previous).norm(metric);
        if change <= params.fixed_point_tolerance * mode.norm(metric) {
            break;
        }
    }
    mode
}

/// The Galerkin products of operator, source and terms, dimension by dimension.
struct Projections {
    /// `operator[dimension][k]` = Xᵀ Dₖ X.
    operator: Vec<Vec<DMatrix<f64>>>,
    /// `source[dimension]` = Xᵀ B.
    source: Vec<DMatrix<f64>>,
}

impl Projections {
    fn new(operator: &Operator, source: &Canonical, x: &Canonical) -> Self {
        let mut all = Self {
            operator: vec![Vec::new(); x.dimensions()],
            source: vec![DMatrix::zeros(0, 0); x.dimensions()],
        };
        for dimension in 0..x.dimensions() {
            all.refresh(operator, source, x, dimension);
        }
        all
    }

    fn refresh(
        &mut self,
        operator: &Operator,
        source: &Canonical,
        x: &Canonical,
        dimension: usize,
    ) {
        let factors = x.factors(dimension);
        let terms = operator.terms().iter();
        self.operator[dimension] = terms.map(|t| t[dimension].gram(factors, factors)).collect();
        self.source[dimension] = factors.tr_mul(source.factors(dimension));
    }

    /// The products over all dimensions but `skip`, for each term of the operator.
    fn operator_without(&self, skip: Option<usize>) -> Vec<DMatrix<f64>> {
        let modes = self.source[0].nrows();
        let mut products = vec![DMatrix::repeat(modes, modes, 1.0); self.operator[0].len()];
        for (dimension, grams) in self.operator.iter().enumerate() {
            if Some(dimension) != skip {
                for (product, gram) in products.iter_mut().zip(grams) {
                    product.component_mul_assign(gram);
                }
            }
        }
        products
    }

    /// The same for the source, with its weights.
    fn source_without(&self, skip: Option<usize>, weights: &[f64]) -> DMatrix<f64> {
        let rows = self.source[0].nrows();
        let mut product = DMatrix::from_fn(rows, weights.len(), |_, m| weights[m]);
        for (dimension, gram) in self.source.iter().enumerate() {
            if Some(dimension) != skip {
                product.component_mul_assign(gram);
            }
        }
        product
    }
}

/// The projection step (thesis (6.15)): the coefficients of all terms, their factors kept.
pub(crate) fn project(operator: &Operator, source: &Canonical, x: &mut Canonical) {
    let projections = Projections::new(operator, source, x);
    let matrices = projections.operator_without(None);
    let mut matrix = DMatrix::zeros(x.rank(), x.rank());
    for term in matrices {
        matrix += term;
    }
    let rhs = projections
        .source_without(None, source.weights())
        .column_sum();
    let mut weights = DVector::from_column_slice(x.weights());
    correct(&matrix, &rhs, &mut weights);
    x.parts_mut().0.copy_from_slice(weights.as_slice());
}

/// One round of the alternating directions over all terms of `x` together: for each dimension in
/// turn, the Galerkin problem for its factors with those of the others kept.
///
/// `causal` lists the sizes of the consecutive blocks of dimension 0 (per component) in which its
/// matrices are block lower triangular; empty if they are not.
pub(crate) fn update(
    operator: &Operator,
    source: &Canonical,
    metric: &[DVector<f64>],
    causal: &[usize],
    x: &mut Canonical,
) {
    let mut projections = Projections::new(operator, source, x);
    for dimension in 0..x.dimensions() {
        let blocks = if dimension == 0 { causal } else { &[] };
        solve_dimension(operator, source, &projections, dimension, blocks, x);
        // Only this dimension changed, so only it needs normalising.
        let before = x.rank();
        normalize_one(x, dimension, &metric[dimension]);
        if x.rank() == 0 {
            return;
        }
        if x.rank() < before {
            projections = Projections::new(operator, source, x);
        } else {
            projections.refresh(operator, source, x, dimension);
        }
    }
}

fn normalize_one(x: &mut Canonical, dimension: usize, weights: &DVector<f64>) {
    let (coefficients, factors) = x.parts_mut();
    let mut kept = Vec::new();
    for (i, mut column) in factors[dimension].column_iter_mut().enumerate() {
        let squares = column.iter().zip(weights.iter()).map(|(x, w)| x * x * w);
        let length = squares.sum::<f64>().sqrt();
        coefficients[i] = length;
        if length > 0.0 && length.is_finite() {
            column /= length;
            kept.push(i);
        }
    }
    if kept.len() < coefficients.len() {
        *coefficients = kept.iter().map(|i| coefficients[*i]).collect();
        for factor in factors {
            *factor = factor.select_columns(&kept);
        }
    }
}

fn solve_dimension(
    operator: &Operator,
    source: &Canonical,
    projections: &Projections,
    dimension: usize,
    causal: &[usize],
    x: &mut Canonical,
) {
    let products = projections.operator_without(Some(dimension));
    let loads = projections.source_without(Some(dimension), source.weights());
    // Row p, column i: the load on node p of term i.
    let rhs = source.factors(dimension) * loads.transpose();
    let weights = x.weights().to_vec();
    let mut unknown = x.factors(dimension).clone();
    for (mut column, weight) in unknown.column_iter_mut().zip(&weights) {
        column *= *weight;
    }
    let factors: Vec<&Factor> = operator.terms().iter().map(|t| &t[dimension]).collect();
    let nodes = unknown.nrows();
    if factors.iter().all(|f| matches!(f, Factor::Diagonal(_))) {
        for node in 0..nodes {
            solve_nodes(&factors, &products, &rhs, &[node], &mut unknown);
        }
    } else if causal.is_empty() {
        let all: Vec<usize> = (0..nodes).collect();
        solve_nodes(&factors, &products, &rhs, &all, &mut unknown);
    } else {
        let per_component: usize = causal.iter().sum();
        let mut first = 0;
        for block in causal {
            let of_component = |c: usize| (0..*block).map(move |i| c * per_component + first + i);
            let indices: Vec<usize> = (0..nodes / per_component).flat_map(of_component).collect();
            solve_nodes(&factors, &products, &rhs, &indices, &mut unknown);
            first += block;
        }
    }
    let (coefficients, all) = x.parts_mut();
    coefficients.fill(1.0);
    all[dimension] = unknown;
}

/// Solves the equations of the nodes `indices` for the unknowns there, the others as they are.
fn solve_nodes(
    factors: &[&Factor],
    products: &[DMatrix<f64>],
    rhs: &DMatrix<f64>,
    indices: &[usize],
    unknown: &mut DMatrix<f64>,
) {
    let modes = unknown.ncols();
    let count = indices.len();
    let mut matrix = DMatrix::zeros(count * modes, count * modes);
    for (factor, product) in factors.iter().zip(products) {
        for (p, row) in indices.iter().enumerate() {
            for (q, column) in indices.iter().enumerate() {
                let entry = factor.entry(*row, *column);
                if entry != 0.0 {
                    let mut block = matrix.view_mut((p * modes, q * modes), (modes, modes));
                    block.zip_apply(product, |b, value| *b += entry * value);
                }
            }
        }
    }
    let mut load = DVector::zeros(count * modes);
    for (p, row) in indices.iter().enumerate() {
        for mode in 0..modes {
            load[p * modes + mode] = rhs[(*row, mode)];
        }
    }
    // What the unknowns outside of the block contribute.
    if count < unknown.nrows() && count > 1 {
        let mut outside = unknown.clone();
        for row in indices {
            outside.row_mut(*row).fill(0.0);
        }
        for (factor, product) in factors.iter().zip(products) {
            let applied = factor.apply(&outside);
            let selected = applied.select_rows(indices) * product.transpose();
            for p in 0..count {
                for mode in 0..modes {
                    load[p * modes + mode] -= selected[(p, mode)];
                }
            }
        }
    }
    let mut values = DVector::from_fn(count * modes, |i, _| {
        unknown[(indices[i / modes], i % modes)]
    });
    correct(&matrix, &load, &mut values);
    for (p, row) in indices.iter().enumerate() {
        for mode in 0..modes {
            unknown[(*row, mode)] = values[p * modes + mode];
        }
    }
}

/// Solves for the correction of `values`, damped so slightly that the fixed point does not move:
/// terms that have become parallel make the matrix singular, and their parts must not run away.
fn correct(matrix: &DMatrix<f64>, rhs: &DVector<f64>, values: &mut DVector<f64>) {
    const DAMPING: f64 = 1e-13;
    let residual = rhs - matrix * &*values;
    let mut damped = matrix.clone();
    let largest = damped.diagonal().amax();
    for i in 0..damped.nrows() {
        let sign = if damped[(i, i)] < 0.0 { -1.0 } else { 1.0 };
        damped[(i, i)] += sign * DAMPING * largest;
    }
    if let Some(step) = damped.lu().solve(&residual)
        && step.iter().all(|x| x.is_finite())
    {
        *values += step;
    }
}

/// Fewer terms for the same tensor: orthogonalises the factors of every dimension, drops the
/// directions that the tensor does not need, and separates what is left anew, with
/// `params.tolerance` on the relative error. In two dimensions and with enough updates this is the
/// truncated singular value decomposition.
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
