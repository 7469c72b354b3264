//! Sums of Kronecker products of matrices: linear operators on separated representations.

use super::canonical::{Canonical, scale_rows};
use crate::error::Error;
use rapier3d::na::{DMatrix, DVector};
use std::sync::Arc;

/// The part of an operator's term that acts on one dimension.
#[derive(Clone, Debug, PartialEq)]
pub enum Factor {
    /// A diagonal matrix: multiplication with a function, by nodal quadrature.
    Diagonal(DVector<f64>),
    /// Any square matrix.
    Dense(DMatrix<f64>),
    /// For a dimension of several components in sequence: `matrix · diag(scale)` from the
    /// component `column` to the component `row`, zero elsewhere.
    Block {
        /// Component that is written.
        row: usize,
        /// Component that is read.
        column: usize,
        /// Number of components.
        components: usize,
        /// What acts on the nodal values of one component.
        matrix: Arc<DMatrix<f64>>,
        /// Multiplies the nodal values first.
        scale: DVector<f64>,
    },
}

impl Factor {
    /// Rows, the same as columns.
    pub fn size(&self) -> usize {
        match self {
            Self::Diagonal(diagonal) => diagonal.len(),
            Self::Dense(matrix) => matrix.nrows(),
            Self::Block {
                components, scale, ..
            } => components * scale.len(),
        }
    }

    fn check(&self, expected: usize) -> Result<(), Error> {
        let check = |actual| Error::check_length("size of an operator's factor", expected, actual);
        check(self.size())?;
        match self {
            Self::Diagonal(_) => Ok(()),
            Self::Dense(matrix) => check(matrix.ncols()),
            Self::Block {
                row,
                column,
                components,
                matrix,
                scale,
            } => {
                check(matrix.nrows() * components)?;
                check(matrix.ncols() * components)?;
                Error::check_length("scale of a block", matrix.ncols(), scale.len())?;
                let last = components.saturating_sub(1);
                Error::check_length("component of a block", last, last.max(*row).max(*column))
            }
        }
    }

    /// This factor times every column.
    pub(crate) fn apply(&self, x: &DMatrix<f64>) -> DMatrix<f64> {
        match self {
            Self::Diagonal(diagonal) => scale_rows(x, diagonal),
            Self::Dense(matrix) => matrix * x,
            Self::Block {
                row,
                column,
                matrix,
                scale,
                ..
            } => {
                let n = scale.len();
                let mut result = DMatrix::zeros(x.nrows(), x.ncols());
                let part = scale_rows(&x.rows(column * n, n).into_owned(), scale);
                result
                    .rows_mut(row * n, n)
                    .copy_from(&(matrix.as_ref() * part));
                result
            }
        }
    }

    /// Xᵀ · this · X.
    pub(crate) fn gram(&self, test: &DMatrix<f64>, x: &DMatrix<f64>) -> DMatrix<f64> {
        match self {
            Self::Block {
                row,
                column,
                matrix,
                scale,
                ..
            } => {
                let n = scale.len();
                let part = scale_rows(&x.rows(column * n, n).into_owned(), scale);
                test.rows(row * n, n).tr_mul(&(matrix.as_ref() * part))
            }
            _ => test.tr_mul(&self.apply(x)),
        }
    }

    /// One entry.
    pub(crate) fn entry(&self, i: usize, j: usize) -> f64 {
        match self {
            Self::Diagonal(diagonal) => {
                if i == j {
                    diagonal[i]
                } else {
                    0.0
                }
            }
            Self::Dense(matrix) => matrix[(i, j)],
            Self::Block {
                row,
                column,
                matrix,
                scale,
                ..
            } => {
                let n = scale.len();
                if i / n == *row && j / n == *column {
                    matrix[(i % n, j % n)] * scale[j % n]
                } else {
                    0.0
                }
            }
        }
    }

    fn to_dense(&self) -> DMatrix<f64> {
        DMatrix::from_fn(self.size(), self.size(), |i, j| self.entry(i, j))
    }
}

/// A linear operator Σᵢ D¹ᵢ ⊗ … ⊗ Dᵈᵢ (thesis (6.10)).
///
/// [`solve`](super::solve) solves problems with it; applied to a tensor:
///
/// ```
/// use rapier3d_immersed::rapier3d::na::DVector;
/// use rapier3d_immersed::reduced::{Canonical, Factor, Operator};
///
/// // Multiplies entry (i, j) by i + j, in two terms.
/// let index = DVector::from_vec(vec![0.0, 1.0, 2.0]);
/// let (index, one) = (Factor::Diagonal(index), Factor::Diagonal(DVector::repeat(3, 1.0)));
/// let mut operator = Operator::zero(&[3, 3]);
/// operator.push(vec![index.clone(), one.clone()])?;
/// operator.push(vec![one, index])?;
/// let mut ones = Canonical::zeros(&[3, 3]);
/// ones.push(1.0, &vec![DVector::repeat(3, 1.0); 2])?;
/// assert_eq!(operator.apply(&ones).at(&[2, 1]), 3.0);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Operator {
    shape: Vec<usize>,
    terms: Vec<Vec<Factor>>,
}

impl Operator {
    /// The zero operator on tensors of this shape.
    pub fn zero(shape: &[usize]) -> Self {
        Self {
            shape: shape.to_vec(),
            terms: Vec::new(),
        }
    }

    /// Adds a term, one factor per dimension.
    ///
    /// # Errors
    /// If the number or the sizes of the factors differ from the shape.
    pub fn push(&mut self, factors: Vec<Factor>) -> Result<(), Error> {
        Error::check_length(
            "factors of an operator's term",
            self.shape.len(),
            factors.len(),
        )?;
        for (factor, size) in factors.iter().zip(&self.shape) {
            factor.check(*size)?;
        }
        self.terms.push(factors);
        Ok(())
    }

    /// Number of entries along each dimension of the tensors it acts on.
    pub fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// The terms, each with one factor per dimension.
    pub fn terms(&self) -> &[Vec<Factor>] {
        &self.terms
    }

    /// The operator times a tensor; ranks multiply.
    ///
    /// # Panics
    /// If the shapes differ.
    pub fn apply(&self, x: &Canonical) -> Canonical {
        let mut weights = Vec::new();
        for _ in &self.terms {
            weights.extend_from_slice(x.weights());
        }
        let factors = (0..self.shape.len()).map(|dimension| {
            let mut all = DMatrix::zeros(self.shape[dimension], weights.len());
            for (k, term) in self.terms.iter().enumerate() {
                let part = term[dimension].apply(x.factors(dimension));
                all.columns_mut(k * x.rank(), x.rank()).copy_from(&part);
            }
            all
        });
        let factors = factors.collect();
        Canonical::from_parts(weights, factors)
    }

    /// Aᵀ M⁻¹ A for a diagonal metric M: the operator of the least-squares problem, whose minimum
    /// exists and attracts the alternating directions whatever the sign of A. Terms square.
    #[must_use]
    pub fn normal(&self, metric: &[DVector<f64>]) -> Self {
        let weighted = self.transposed_weighted(metric);
        let mut normal = Self::zero(&self.shape);
        for left in &weighted {
            for right in &self.terms {
                let factors = left.iter().zip(right).map(|pair| match pair {
                    (Factor::Diagonal(a), Factor::Diagonal(b)) => {
                        Factor::Diagonal(a.component_mul(b))
                    }
                    (a, b) => Factor::Dense(a.apply(&b.to_dense())),
                });
                normal.terms.push(factors.collect());
            }
        }
        normal
    }

    /// Aᵀ M⁻¹ b: the source of the least-squares problem.
    #[must_use]
    pub fn normal_source(&self, metric: &[DVector<f64>], source: &Canonical) -> Canonical {
        let transposed = Self {
            shape: self.shape.clone(),
            terms: self.transposed_weighted(metric),
        };
        transposed.apply(source)
    }

    fn transposed_weighted(&self, metric: &[DVector<f64>]) -> Vec<Vec<Factor>> {
        let transpose = |(factor, weights): (&Factor, &DVector<f64>)| match factor {
            Factor::Diagonal(diagonal) => Factor::Diagonal(diagonal.component_div(weights)),
            other => {
                let inverse = weights.map(f64::recip);
                Factor::Dense(scale_rows(&other.to_dense(), &inverse).transpose())
            }
        };
        let terms = self.terms.iter();
        terms
            .map(|term| term.iter().zip(metric).map(transpose).collect())
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A block factor is the dense matrix with the same entries.
    #[test]
    fn block_equals_dense() {
        let block = Factor::Block {
            row: 1,
            column: 0,
            components: 2,
            matrix: Arc::new(DMatrix::from_fn(3, 3, |i, j| (i * 3 + j) as f64)),
            scale: DVector::from_vec(vec![1.0, -2.0, 0.5]),
        };
        let dense = block.to_dense();
        assert_eq!(dense[(4, 1)], 4.0 * -2.0);
        let x = DMatrix::from_fn(6, 2, |i, j| (i as f64 + 1.3 * j as f64).sin());
        assert!((block.apply(&x) - &dense * &x).amax() < 1e-14);
        assert!((block.gram(&x, &x) - x.tr_mul(&(&dense * &x))).amax() < 1e-14);
    }

    #[test]
    fn sizes_are_checked() {
        let mut operator = Operator::zero(&[2, 3]);
        let diagonal = |n| Factor::Diagonal(DVector::zeros(n));
        assert!(operator.push(vec![diagonal(2)]).is_err());
        assert!(operator.push(vec![diagonal(3), diagonal(2)]).is_err());
        assert!(
            operator
                .push(vec![diagonal(2), Factor::Dense(DMatrix::zeros(3, 2))])
                .is_err()
        );
        assert!(operator.push(vec![diagonal(2), diagonal(3)]).is_ok());
    }
}
