//! An orthonormal basis of the columns of a matrix, whatever its rank.

use rapier3d::na::DMatrix;

/// Q and C with matrix = Q C. Q has orthonormal columns, as many as the rank, by pivoted QR without the
/// pivots below `tolerance` of the largest. A zero matrix gives no columns.
///
/// nalgebra's singular vectors of a rank-deficient matrix are inaccurate, its pivoted QR is not;
/// where singular values are needed, take those of C.
pub(crate) fn column_basis(matrix: &DMatrix<f64>, tolerance: f64) -> (DMatrix<f64>, DMatrix<f64>) {
    let qr = matrix.clone().col_piv_qr();
    let (q, mut r) = (qr.q(), qr.r());
    let pivot = |i: usize| r[(i, i)].abs();
    let possible = r.nrows().min(r.ncols());
    let kept = (0..possible)
        .take_while(|i| pivot(*i) > tolerance * pivot(0))
        .count();
    r = r.rows(0, kept).into_owned();
    qr.p().inv_permute_columns(&mut r);
    (q.columns(0, kept).into_owned(), r)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// It works for tall, wide, rank-deficient and zero matrices.
    #[test]
    fn the_basis_spans_the_columns() {
        for (rows, columns, rank) in [(9, 4, 2), (4, 9, 3), (6, 6, 6), (5, 3, 0)] {
            let left = DMatrix::from_fn(rows, rank, |i, j| {
                ((i * i * 7 + i * j * 5 + j * 3) as f64).sin()
            });
            let right = DMatrix::from_fn(rank, columns, |i, j| {
                ((j * j * 5 + i * j * 3 + i * 11) as f64).cos()
            });
            let matrix = left * right;
            let (q, c) = column_basis(&matrix, 1e-13);
            assert_eq!(q.ncols(), rank);
            assert!((&q * &c - &matrix).iter().all(|x| x.abs() < 1e-13));
            assert!(
                (q.tr_mul(&q) - DMatrix::identity(rank, rank))
                    .iter()
                    .all(|x| x.abs() < 1e-13)
            );
        }
    }
}
