//! Sums of Kronecker products of vectors: the algebra of separated representations.

use crate::error::Error;
use rapier3d::na::{DMatrix, DVector};

/// Largest number of terms whose norm is computed by orthogonal factorisations.
const ACCURATE_NORM_TERMS: usize = 160;

/// A tensor Σᵢ αᵢ U¹ᵢ ⊗ … ⊗ Uᵈᵢ (thesis (6.10)), as nodal values or as a weak-form source.
///
/// ```
/// use rapier3d_immersed::rapier3d::na::DVector;
/// use rapier3d_immersed::reduced::Canonical;
///
/// // The matrix 2 (1, 2)ᵀ (3, 4, 5) as one term.
/// let mut tensor = Canonical::zeros(&[2, 3]);
/// tensor.push(2.0, &[DVector::from_vec(vec![1.0, 2.0]), DVector::from_vec(vec![3.0, 4.0, 5.0])])?;
/// assert_eq!((tensor.rank(), tensor.at(&[1, 2])), (1, 20.0));
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Canonical {
    weights: Vec<f64>,
    /// One matrix per dimension, one column per term.
    factors: Vec<DMatrix<f64>>,
}

impl Canonical {
    /// The zero tensor of this shape (at least one dimension).
    pub fn zeros(shape: &[usize]) -> Self {
        Self {
            weights: Vec::new(),
            factors: shape.iter().map(|n| DMatrix::zeros(*n, 0)).collect(),
        }
    }

    /// Number of entries along each dimension.
    pub fn shape(&self) -> Vec<usize> {
        self.factors.iter().map(DMatrix::nrows).collect()
    }

    /// Number of terms.
    pub fn rank(&self) -> usize {
        self.weights.len()
    }

    /// Number of dimensions.
    pub fn dimensions(&self) -> usize {
        self.factors.len()
    }

    /// The coefficients αᵢ.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// The factors of one dimension, a column per term.
    pub fn factors(&self, dimension: usize) -> &DMatrix<f64> {
        &self.factors[dimension]
    }

    /// Adds the term `weight · factors[0] ⊗ factors[1] ⊗ …`.
    ///
    /// # Errors
    /// If the number or the lengths of the factors differ from the shape.
    pub fn push(&mut self, weight: f64, factors: &[DVector<f64>]) -> Result<(), Error> {
        Error::check_length("factors of a term", self.dimensions(), factors.len())?;
        for (matrix, factor) in self.factors.iter().zip(factors) {
            Error::check_length("entries of a factor", matrix.nrows(), factor.len())?;
        }
        for (matrix, factor) in self.factors.iter_mut().zip(factors) {
            let columns = matrix.ncols();
            matrix.resize_horizontally_mut(columns + 1, 0.0);
            matrix.set_column(columns, factor);
        }
        self.weights.push(weight);
        Ok(())
    }

    /// A tensor from its weights and, for each dimension, the matrix of its factors.
    pub(crate) fn from_parts(weights: Vec<f64>, factors: Vec<DMatrix<f64>>) -> Self {
        debug_assert!(factors.iter().all(|f| f.ncols() == weights.len()));
        Self { weights, factors }
    }

    pub(crate) fn parts_mut(&mut self) -> (&mut Vec<f64>, &mut Vec<DMatrix<f64>>) {
        (&mut self.weights, &mut self.factors)
    }

    /// The terms of `self`, then those of `other` times `scale`.
    ///
    /// # Panics
    /// If the shapes differ.
    #[must_use]
    pub fn plus(&self, scale: f64, other: &Self) -> Self {
        let weights = self.weights.iter().copied();
        let others = other.weights.iter().map(|w| w * scale);
        let columns = self.rank() + other.rank();
        let factors = self.factors.iter().zip(&other.factors).map(|(a, b)| {
            assert_eq!(a.nrows(), b.nrows(), "tensors of different shape");
            let mut both = a.clone().resize_horizontally(columns, 0.0);
            both.columns_mut(a.ncols(), b.ncols()).copy_from(b);
            both
        });
        Self {
            weights: weights.chain(others).collect(),
            factors: factors.collect(),
        }
    }

    /// The entrywise product; ranks multiply.
    ///
    /// # Panics
    /// If the shapes differ.
    #[must_use]
    pub fn hadamard(&self, other: &Self) -> Self {
        let pairs: Vec<(usize, usize)> = (0..self.rank())
            .flat_map(|i| (0..other.rank()).map(move |j| (i, j)))
            .collect();
        let factors = self.factors.iter().zip(&other.factors).map(|(a, b)| {
            let mut product = DMatrix::zeros(a.nrows(), pairs.len());
            for (mut column, (i, j)) in product.column_iter_mut().zip(&pairs) {
                column.copy_from(&a.column(*i).component_mul(&b.column(*j)));
            }
            product
        });
        let factors = factors.collect();
        let weights = pairs
            .iter()
            .map(|(i, j)| self.weights[*i] * other.weights[*j]);
        Self {
            weights: weights.collect(),
            factors,
        }
    }

    /// Every term multiplied by one vector per dimension, and by `scale`.
    #[must_use]
    pub fn scaled(mut self, scale: f64, vectors: &[DVector<f64>]) -> Self {
        self.weights.iter_mut().for_each(|w| *w *= scale);
        for (factor, vector) in self.factors.iter_mut().zip(vectors) {
            *factor = scale_rows(factor, vector);
        }
        self
    }

    /// The entry at one multi-index.
    ///
    /// # Panics
    /// If the index is out of the shape.
    pub fn at(&self, index: &[usize]) -> f64 {
        (0..self.rank())
            .map(|term| {
                let factors = self.factors.iter().zip(index);
                self.weights[term] * factors.map(|(f, i)| f[(*i, term)]).product::<f64>()
            })
            .sum()
    }

    /// Σ over all entries of `self · other · metric`, the metric being diagonal: one weight per
    /// entry of each dimension (for nodal values, the quadrature weights).
    pub fn inner(&self, other: &Self, metric: &[DVector<f64>]) -> f64 {
        let mut product = DMatrix::from_fn(self.rank(), other.rank(), |i, j| {
            self.weights[i] * other.weights[j]
        });
        for ((a, b), weights) in self.factors.iter().zip(&other.factors).zip(metric) {
            product.component_mul_assign(&(a.transpose() * scale_rows(b, weights)));
        }
        product.sum()
    }

    /// The norm that belongs to [`Canonical::inner`]. If terms are few, orthogonal factorisations make it
    /// accurate to their rounding; if they are many, cancellation among them leaves an error of about 1e-8
    /// of the largest.
    pub fn norm(&self, metric: &[DVector<f64>]) -> f64 {
        if self.rank() == 0 {
            return 0.0;
        }
        if self.rank() > ACCURATE_NORM_TERMS {
            return self.inner(self, metric).max(0.0).sqrt();
        }
        // R keeps all inner products of the partial products of the terms.
        let mut r = DMatrix::from_row_slice(1, self.rank(), &self.weights);
        for (factor, weights) in self.factors.iter().zip(metric) {
            let scaled = scale_rows(factor, &weights.map(f64::sqrt));
            let mut product = DMatrix::zeros(r.nrows() * scaled.nrows(), self.rank());
            for term in 0..self.rank() {
                product.set_column(term, &r.column(term).kronecker(&scaled.column(term)));
            }
            r = if product.nrows() > self.rank() {
                product.qr().r()
            } else {
                product
            };
        }
        r.column_sum().norm()
    }

    /// Moves the length of every factor (in the metric) into the weights, thesis (6.14). Terms of
    /// length zero are dropped.
    pub fn normalize(&mut self, metric: &[DVector<f64>]) {
        for (factor, weights) in self.factors.iter_mut().zip(metric) {
            for (mut column, weight) in factor.column_iter_mut().zip(&mut self.weights) {
                let squares = column.iter().zip(weights.iter()).map(|(x, w)| x * x * w);
                let length = squares.sum::<f64>().sqrt();
                *weight *= length;
                if length > 0.0 {
                    column /= length;
                }
            }
        }
        let kept: Vec<usize> = (0..self.rank())
            .filter(|i| self.weights[*i] != 0.0)
            .collect();
        if kept.len() < self.rank() {
            self.weights = kept.iter().map(|i| self.weights[*i]).collect();
            for factor in &mut self.factors {
                *factor = factor.select_columns(&kept);
            }
        }
    }

    /// The terms in the order of decreasing |αᵢ|.
    pub fn sort(&mut self) {
        let mut order: Vec<usize> = (0..self.rank()).collect();
        order.sort_by(|a, b| self.weights[*b].abs().total_cmp(&self.weights[*a].abs()));
        self.weights = order.iter().map(|i| self.weights[*i]).collect();
        for factor in &mut self.factors {
            *factor = factor.select_columns(&order);
        }
    }
}

/// diag(`weights`) · `matrix`.
pub(crate) fn scale_rows(matrix: &DMatrix<f64>, weights: &DVector<f64>) -> DMatrix<f64> {
    let mut scaled = matrix.clone();
    for mut column in scaled.column_iter_mut() {
        column.component_mul_assign(weights);
    }
    scaled
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> (Canonical, Vec<DVector<f64>>) {
        let mut tensor = Canonical::zeros(&[3, 2, 4]);
        for k in 0..3 {
            let factor = |n: usize, s: f64| DVector::from_fn(n, |i, _| ((i + k) as f64 * s).sin());
            tensor
                .push(
                    1.0 + k as f64,
                    &[factor(3, 1.0), factor(2, 2.0), factor(4, 0.7)],
                )
                .unwrap();
        }
        let metric = [3, 2, 4]
            .map(|n| DVector::from_fn(n, |i, _| 0.5 + i as f64))
            .to_vec();
        (tensor, metric)
    }

    /// Both norms and the inner product agree with the sum over all entries.
    #[test]
    fn norms_agree_with_the_full_tensor() {
        let (tensor, metric) = example();
        let mut sum = 0.0;
        for i in 0..3 {
            for j in 0..2 {
                for k in 0..4 {
                    sum +=
                        metric[0][i] * metric[1][j] * metric[2][k] * tensor.at(&[i, j, k]).powi(2);
                }
            }
        }
        assert!((tensor.norm(&metric) - sum.sqrt()).abs() < 1e-13);
        assert!((tensor.inner(&tensor, &metric) - sum).abs() < 1e-12);
        let mut normal = tensor.clone();
        normal.normalize(&metric);
        assert!((normal.at(&[2, 1, 3]) - tensor.at(&[2, 1, 3])).abs() < 1e-14);
    }

    /// The difference of equal tensors vanishes to rounding, not to its square root.
    #[test]
    fn accurate_norm_of_a_difference() {
        let (tensor, metric) = example();
        let mut other = tensor.clone();
        other.normalize(&metric);
        let difference = tensor.plus(-1.0, &other).norm(&metric);
        assert!(difference < 1e-13, "{difference:e}");
    }

    #[test]
    fn shapes_are_checked() {
        let mut tensor = Canonical::zeros(&[2, 3]);
        assert!(tensor.push(1.0, &[DVector::zeros(2)]).is_err());
        assert!(
            tensor
                .push(1.0, &[DVector::zeros(3), DVector::zeros(2)])
                .is_err()
        );
        assert_eq!(tensor.rank(), 0);
        assert_eq!(tensor.norm(&[DVector::zeros(2), DVector::zeros(3)]), 0.0);
    }
}
