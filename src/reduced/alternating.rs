//! Alternating directions: the Galerkin problems of one dimension at a time, for one term (thesis
//! §6.3.1) or for all, and the projection (§6.3.2).

use super::canonical::Canonical;
use super::operator::{Factor, Operator};
use super::params::PgdParams;
use rand::RngExt;
use rand_pcg::Pcg64;
use rapier3d::na::{DMatrix, DVector};

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

    /// These products for the source, with its weights.
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
    if x.rank() == 0 {
        return;
    }
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
    if x.rank() == 0 {
        return;
    }
    let mut projections = Projections::new(operator, source, x);
    for (dimension, weights) in metric.iter().enumerate() {
        let blocks = if dimension == 0 { causal } else { &[] };
        solve_dimension(operator, source, &projections, dimension, blocks, x);
        // Only this dimension changed, so that only it needs normalising.
        let before = x.rank();
        normalize_one(x, dimension, weights);
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
    // Row p and column i hold the load on node p of term i.
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

/// Solves the equations of the nodes `indices` for the unknowns there, with the others as they are.
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
    // The unknowns outside of the block contribute to the right-hand side.
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
/// terms that have become parallel make the matrix singular, and their parts must not diverge.
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
