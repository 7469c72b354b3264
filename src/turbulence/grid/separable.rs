//! Direct solver for (a − b∇²) x = f on a box, by diagonalizing each axis (Lynch, Rice & Thomas 1964).
//!
//! The second difference along one axis is a small symmetric matrix for every mixture of walls,
//! outflow and periodicity, so the box's operator is a Kronecker sum and its inverse two dense products per
//! axis around one division. For the sizes baked here (up to a few hundred nodes per axis) these
//! products run at the speed of matrix multiplication, need no special sizes, and leave a residual
//! at rounding level: no iteration, no tolerance. The pressure and the implicit viscous step share it.

use rapier3d::na::{DMatrix, DMatrixView, DMatrixViewMut};

/// What holds at one end of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// Joined to the other end.
    Periodic,
    /// Zero slope half a cell beyond the last node.
    Slope,
    /// Zero value half a cell beyond the last node.
    HalfValue,
    /// Zero value one cell beyond the last node.
    Value,
}

struct Axis {
    vectors: DMatrix<f64>,
    transposed: DMatrix<f64>,
    values: Vec<f64>,
}

/// The factored operator.
pub(crate) struct Separable {
    dims: [usize; 3],
    axes: [Option<Axis>; 3],
    largest: f64,
}

/// Second difference along `n` nodes, times −1.
fn second_difference(n: usize, ends: [End; 2]) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(n, n);
    for i in 0..n {
        matrix[(i, i)] += 2.0;
        for (outside, neighbor, end) in [
            (i == 0, i.wrapping_sub(1), ends[0]),
            (i + 1 == n, i + 1, ends[1]),
        ] {
            if !outside {
                matrix[(i, neighbor)] -= 1.0;
                continue;
            }
            match end {
                End::Periodic => matrix[(i, if i == 0 { n - 1 } else { 0 })] -= 1.0,
                End::Slope => matrix[(i, i)] -= 1.0,
                End::HalfValue => matrix[(i, i)] += 1.0,
                End::Value => {}
            }
        }
    }
    matrix
}

impl Separable {
    /// Factors −∇² on `dims` nodes with `spacing`; axes with one node do not count.
    pub fn new(dims: [usize; 3], spacing: f64, ends: [[End; 2]; 3]) -> Self {
        let mut largest = 0.0;
        let axes = core::array::from_fn(|i| {
            (dims[i] > 1).then(|| {
                let matrix = second_difference(dims[i], ends[i]) / (spacing * spacing);
                let eigen = matrix.symmetric_eigen();
                largest += eigen.eigenvalues.max();
                Axis {
                    transposed: eigen.eigenvectors.transpose(),
                    vectors: eigen.eigenvectors,
                    values: eigen.eigenvalues.iter().copied().collect(),
                }
            })
        });
        Self {
            dims,
            axes,
            largest,
        }
    }

    /// Solves (a − b∇²) x = f in place, f with x fastest. Where the operator is singular (all ends
    /// `Slope` or periodic and a = 0) the component that it cannot see is set to zero: the mean.
    pub fn solve(&self, a: f64, b: f64, f: &mut Vec<f64>) {
        let mut spare = vec![0.0; f.len()];
        self.transform(f, &mut spare, true);
        let [nx, ny, _] = self.dims;
        let value = |axis: usize, i: usize| self.axes[axis].as_ref().map_or(0.0, |a| a.values[i]);
        let floor = 1.0e-12 * (a + b * self.largest);
        for (row, line) in f.chunks_exact_mut(nx).enumerate() {
            let (j, k) = (row % ny, row / ny);
            let rest = a + b * (value(1, j) + value(2, k));
            for (i, x) in line.iter_mut().enumerate() {
                let pivot = rest + b * value(0, i);
                *x = if pivot > floor { *x / pivot } else { 0.0 };
            }
        }
        self.transform(f, &mut spare, false);
    }

    /// Takes `f` into (`forward`) or out of the basis of eigenvectors along every axis.
    fn transform(&self, f: &mut Vec<f64>, spare: &mut Vec<f64>, forward: bool) {
        let [nx, ny, nz] = self.dims;
        if let Some(axis) = &self.axes[0] {
            let from = DMatrixView::from_slice(f, nx, ny * nz);
            let mut to = DMatrixViewMut::from_slice(spare, nx, ny * nz);
            // gemm_tr would not use the fast product.
            let left = if forward {
                &axis.transposed
            } else {
                &axis.vectors
            };
            to.gemm(1.0, left, &from, 0.0);
            core::mem::swap(f, spare);
        }
        // The product from the right is F V forward and F Vᵀ backward.
        let mut right = |axis: &Axis, rows: usize, columns: usize| {
            let right = if forward {
                &axis.vectors
            } else {
                &axis.transposed
            };
            let block = rows * columns;
            for (from, to) in f.chunks_exact(block).zip(spare.chunks_exact_mut(block)) {
                let from = DMatrixView::from_slice(from, rows, columns);
                let mut to = DMatrixViewMut::from_slice(to, rows, columns);
                to.gemm(1.0, &from, right, 0.0);
            }
            core::mem::swap(f, spare);
        };
        if let Some(axis) = &self.axes[1] {
            right(axis, nx, ny);
        }
        if let Some(axis) = &self.axes[2] {
            right(axis, nx * ny, nz);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The residual, by plain second differences, is at rounding level for every kind of end.
    #[test]
    fn residual_is_at_rounding_level() {
        let kinds = [
            [End::Periodic; 2],
            [End::Slope; 2],
            [End::Slope, End::HalfValue],
            [End::Value, End::Slope],
        ];
        for x in kinds {
            for y in kinds {
                let (dims, ends) = ([7, 5, 4], [x, y, [End::HalfValue, End::Value]]);
                let solver = Separable::new(dims, 0.5, ends);
                let f: Vec<f64> = (0..140).map(|n| ((n * n) as f64).sin()).collect();
                let mut u = f.clone();
                solver.solve(0.3, 2.0, &mut u);
                let matrices: Vec<_> = (0..3)
                    .map(|i| second_difference(dims[i], ends[i]) / 0.25)
                    .collect();
                for n in 0..140 {
                    let index = [n % 7, n / 7 % 5, n / 35];
                    let mut sum = 0.3 * u[n];
                    for axis in 0..3 {
                        for m in 0..dims[axis] {
                            let mut other = index;
                            other[axis] = m;
                            let at = (other[2] * 5 + other[1]) * 7 + other[0];
                            sum += 2.0 * matrices[axis][(index[axis], m)] * u[at];
                        }
                    }
                    assert!((sum - f[n]).abs() < 1.0e-12, "{x:?} {y:?}: {sum} {}", f[n]);
                }
            }
        }
    }

    #[test]
    fn singular_operator_gives_the_solution_without_mean() {
        let solver = Separable::new([8, 6, 1], 1.0, [[End::Slope; 2]; 3]);
        let mut f: Vec<f64> = (0..48).map(|n| ((3 * n) as f64).cos()).collect();
        let mean = f.iter().sum::<f64>() / 48.0;
        f.iter_mut().for_each(|f| *f -= mean);
        solver.solve(0.0, 1.0, &mut f);
        assert!(f.iter().sum::<f64>().abs() < 1.0e-12);
        assert!(f.iter().any(|x| x.abs() > 0.1));
    }
}
