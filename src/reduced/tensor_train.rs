//! Tensor trains: separated functions of many coordinates and high rank, made by sampling a black box on
//! well chosen lines (cross approximation).

use super::axis::{Axis, MAX_DEGREE};
use super::orthogonal::column_basis;
use crate::error::Error;
use rapier3d::na::{DMatrix, DVector};

/// One core: for every node a matrix from the rank on the left to the rank on the right.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(crate) struct Core {
    pub left: usize,
    pub right: usize,
    /// The matrices, indexed `[node][left][right]`.
    pub entries: Vec<f64>,
}

impl Core {
    pub fn from_unfolding(unfolding: &DMatrix<f64>, left: usize) -> Self {
        // The entry is in row l + left · node of the unfolding and in column r.
        let transposed = unfolding.transpose();
        Self {
            left,
            right: unfolding.ncols(),
            entries: transposed.as_slice().to_vec(),
        }
    }

    pub fn unfolding(&self) -> DMatrix<f64> {
        let rows = self.entries.len() / self.right.max(1);
        DMatrix::from_row_slice(rows, self.right, &self.entries)
    }
}

/// A vector-valued function of several coordinates, G¹(x₁) G²(x₂) … Gᵈ(x_d) · outputs, each Gʲ a
/// matrix that depends on one coordinate (Oseledets 2011).
///
/// Outside of the ranges of its axes it is evaluated at their nearer end. [`cross()`](super::cross()) makes
/// one:
///
/// ```
/// use rapier3d_immersed::reduced::{Axis, CrossParams, cross};
///
/// // The sum of three numbers has rank two.
/// let axes = vec![Axis::spectral(0.0, 1.0, 4)?; 3];
/// let function = |x: &[f64], out: &mut [f64]| out[0] = x[0] + x[1] + x[2];
/// let (train, _) = cross(axes, 1, function, &CrossParams::default())?;
/// let train = train.rounded(1e-9);
/// assert_eq!(train.ranks(), [2, 2, 1]);
/// assert!((train.evaluate(&[0.1, 0.2, 0.4])[0] - 0.7).abs() < 1e-9);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct TensorTrain {
    pub(crate) axes: Vec<Axis>,
    pub(crate) outputs: usize,
    /// One core per axis and a last one whose nodes are the outputs.
    pub(crate) cores: Vec<Core>,
}

impl TensorTrain {
    pub(crate) fn check(&self) -> Result<(), Error> {
        Error::check_positive("number of axes", self.axes.len() as f64)?;
        Error::check_positive("outputs", self.outputs as f64)?;
        Error::check_length(
            "cores of a tensor train",
            self.axes.len() + 1,
            self.cores.len(),
        )?;
        let nodes = self.axes.iter().map(Axis::len).chain([self.outputs]);
        let mut rank = 1;
        for (core, nodes) in self.cores.iter().zip(nodes) {
            Error::check_length("left rank of a core", rank, core.left)?;
            Error::check_positive("right rank of a core", core.right as f64)?;
            let expected = nodes
                .checked_mul(core.left)
                .and_then(|n| n.checked_mul(core.right));
            Error::check_length(
                "entries of a core",
                expected.unwrap_or(usize::MAX),
                core.entries.len(),
            )?;
            Error::check_all_finite("core of a tensor train", &core.entries)?;
            rank = core.right;
        }
        Error::check_length("last rank of a tensor train", 1, rank)
    }

    /// The coordinates.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Number of components of a value.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// The ranks between the cores; the last is the one before the outputs.
    pub fn ranks(&self) -> Vec<usize> {
        self.cores[..self.cores.len() - 1]
            .iter()
            .map(|core| core.right)
            .collect()
    }

    /// Writes the value at `point`. `scratch` keeps memory between calls; start with an empty one.
    ///
    /// # Panics
    /// If `point` has not one coordinate per axis or `value` not one entry per output.
    pub fn evaluate_into(&self, point: &[f64], value: &mut [f64], scratch: &mut Vec<f64>) {
        let widest = self.cores.iter().map(|core| core.right).max().unwrap_or(1);
        scratch.clear();
        scratch.resize(2 * widest, 0.0);
        self.contract(point, value, scratch);
    }

    /// The same with scratch memory of at least twice the largest rank.
    pub(crate) fn contract(&self, point: &[f64], value: &mut [f64], scratch: &mut [f64]) {
        assert_eq!(point.len(), self.axes.len(), "one coordinate per axis");
        assert_eq!(value.len(), self.outputs, "one entry per output");
        let half = scratch.len() / 2;
        let (mut row, mut next) = scratch.split_at_mut(half);
        row[0] = 1.0;
        let mut basis = [0.0; MAX_DEGREE + 1];
        for ((axis, core), x) in self.axes.iter().zip(&self.cores).zip(point) {
            let (first, count) = axis.basis(*x, &mut basis);
            let size = core.left * core.right;
            let target = &mut next[..core.right];
            target.fill(0.0);
            for (i, value) in basis[..count].iter().enumerate() {
                let matrix = &core.entries[(first + i) * size..(first + i + 1) * size];
                for (left, entries) in row.iter().zip(matrix.chunks_exact(core.right)) {
                    let scale = value * left;
                    for (sum, entry) in target.iter_mut().zip(entries) {
                        *sum += scale * entry;
                    }
                }
            }
            (row, next) = (next, row);
        }
        let last = &self.cores[self.axes.len()];
        for (value, column) in value.iter_mut().zip(last.entries.chunks_exact(last.left)) {
            *value = column.iter().zip(row.iter()).map(|(a, b)| a * b).sum();
        }
    }

    /// The value at `point`.
    ///
    /// # Panics
    /// If `point` has not one coordinate per axis.
    pub fn evaluate(&self, point: &[f64]) -> Vec<f64> {
        let mut value = vec![0.0; self.outputs];
        self.evaluate_into(point, &mut value, &mut Vec::new());
        value
    }

    /// Orthogonalises the cores and cuts the ranks so that the nodal values change by at most
    /// `tolerance` of their norm (Oseledets 2011, algorithm 2).
    #[must_use]
    pub fn rounded(&self, tolerance: f64) -> Self {
        let mut cores = self.cores.clone();
        let last = cores.len() - 1;
        for k in 0..last {
            let qr = cores[k].unfolding().qr();
            let (q, r) = (qr.q(), qr.r());
            cores[k] = Core::from_unfolding(&q, cores[k].left);
            cores[k + 1] = multiplied(&r, &cores[k + 1]);
        }
        let norm = cores[last]
            .entries
            .iter()
            .map(|x| x * x)
            .sum::<f64>()
            .sqrt();
        let threshold = tolerance * norm / (last as f64).sqrt();
        for k in (1..=last).rev() {
            let core = &cores[k];
            let nodes = core.entries.len() / (core.left * core.right);
            // Rows are the left rank; columns are node and right rank.
            let matrix = DMatrix::from_fn(core.left, nodes * core.right, |l, c| {
                core.entries[(c / core.right * core.left + l) * core.right + c % core.right]
            });
            let (u, singular_values, v) = singular_values(&matrix);
            let mut order: Vec<usize> = (0..singular_values.len()).collect();
            order.sort_by(|a, b| singular_values[*b].total_cmp(&singular_values[*a]));
            let mut tail = 0.0;
            while order.len() > 1 {
                let smallest = singular_values[order[order.len() - 1]];
                tail += smallest * smallest;
                if tail.sqrt() > threshold {
                    break;
                }
                order.pop();
            }
            let rank = order.len();
            let right = core.right;
            let mut entries = vec![0.0; nodes * rank * right];
            for (new, old) in order.iter().enumerate() {
                for c in 0..nodes * right {
                    entries[(c / right * rank + new) * right + c % right] = v[(*old, c)];
                }
            }
            cores[k] = Core {
                left: rank,
                right,
                entries,
            };
            let mut scaled = u.select_columns(&order);
            for (mut column, old) in scaled.column_iter_mut().zip(&order) {
                column *= singular_values[*old];
            }
            let before = &cores[k - 1];
            cores[k - 1] = Core::from_unfolding(&(before.unfolding() * scaled), before.left);
        }
        Self {
            axes: self.axes.clone(),
            outputs: self.outputs,
            cores,
        }
    }
}

/// The singular values of a matrix other than zero and its singular vectors, in the accuracy of
/// [`column_basis`].
fn singular_values(matrix: &DMatrix<f64>) -> (DMatrix<f64>, DVector<f64>, DMatrix<f64>) {
    let (q, columns) = column_basis(&matrix.transpose(), 1e-15);
    if q.ncols() == 0 {
        let (rows, columns) = matrix.shape();
        return (
            DMatrix::zeros(rows, 1),
            DVector::zeros(1),
            DMatrix::zeros(1, columns),
        );
    }
    let svd = columns.transpose().svd(true, true);
    let (u, v) = (svd.u.expect("asked for"), svd.v_t.expect("asked for"));
    (u, svd.singular_values, v * q.transpose())
}

/// `matrix` times the core from the left.
fn multiplied(matrix: &DMatrix<f64>, core: &Core) -> Core {
    let size = core.left * core.right;
    let mut entries = Vec::with_capacity(core.entries.len() / core.left * matrix.nrows());
    for node in core.entries.chunks_exact(size) {
        let product = matrix * DMatrix::from_row_slice(core.left, core.right, node);
        entries.extend_from_slice(product.transpose().as_slice());
    }
    Core {
        left: matrix.nrows(),
        right: core.right,
        entries,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A train of rank three written with rank six, every core twice: rounding finds three, and
    /// the value stays to rounding errors.
    #[test]
    fn rounding_finds_the_rank() {
        let axes = vec![Axis::spectral(0.0, 1.0, 5).unwrap(); 3];
        let core = |left: usize, right: usize, nodes: usize, seed: f64| {
            let small = |n: usize, l: usize, r: usize| {
                ((n * 9 + l % 3 * 3 + r % 3) as f64 * seed).sin()
                    + if l % 3 == r % 3 { 1.0 } else { 0.0 }
            };
            let mut entries = Vec::new();
            for n in 0..nodes {
                for l in 0..left {
                    entries.extend((0..right).map(|r| small(n, l, r)));
                }
            }
            Core {
                left,
                right,
                entries,
            }
        };
        let cores = vec![
            core(1, 6, 5, 1.1),
            core(6, 6, 5, 0.7),
            core(6, 6, 5, 1.9),
            core(6, 1, 2, 0.3),
        ];
        let train = TensorTrain {
            axes,
            outputs: 2,
            cores,
        };
        train.check().unwrap();
        let rounded = train.rounded(1e-12);
        rounded.check().unwrap();
        // The last cut is between the axes and two outputs.
        assert_eq!(rounded.ranks(), [3, 3, 2]);
        for point in [[0.1, 0.5, 0.9], [1.0, 0.0, 0.3]] {
            for (a, b) in train.evaluate(&point).iter().zip(rounded.evaluate(&point)) {
                assert!((a - b).abs() < 1e-11 * a.abs(), "{a} {b}");
            }
        }
    }
}
