//! Discrete empirical interpolation: modes of snapshots, and the few entries that tell their coefficients.

use crate::error::Error;
use rapier3d::na::{DMatrix, DVector};

/// A linear space of vectors, learned from snapshots, in which a vector is found from as many of its entries as the space
/// has dimensions (Chaturantabut & Sorensen, *SIAM J. Sci. Comput.* 32, 2737 (2010); thesis § 6.5).
///
/// The modes are the left singular vectors of the snapshots (proper orthogonal decomposition). The entries are
/// picked greedily: of each mode in turn the one that the modes before it explain worst.
///
/// ```
/// use rapier3d_immersed::rapier3d::na::DMatrix;
/// use rapier3d_immersed::reduced::Deim;
///
/// // 1/(1 + cx) at 100 x for 20 c: six entries give all the others, for any c between.
/// let of = |c: f64, i: usize| 1.0 / (1.0 + c * i as f64 / 99.0);
/// let snapshots = DMatrix::from_fn(100, 20, |i, j| of(1.0 + j as f64 / 19.0, i));
/// let deim = Deim::new(&snapshots, 1e-6, 20)?;
/// assert!(deim.modes() <= 6);
/// let entries: Vec<f64> = deim.points().iter().map(|i| of(1.234, *i)).collect();
/// let all = deim.reconstruct(&entries);
/// assert!((0..100).all(|i| (all[i] - of(1.234, i)).abs() < 1e-5));
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Deim {
    /// Orthonormal columns.
    basis: DMatrix<f64>,
    points: Vec<usize>,
    /// From the entries at the points to the coefficients of the modes.
    coefficients: DMatrix<f64>,
    /// From the coefficients of snapshots to modes: V Σ⁻¹.
    combination: DMatrix<f64>,
}

impl Deim {
    /// Of the columns of `snapshots`, with the modes whose singular values are above `tolerance` times the largest, at most
    /// `max_modes` of them.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; [`Error::InvalidParameter`] if no snapshot differs from zero, or no mode is allowed.
    pub fn new(snapshots: &DMatrix<f64>, tolerance: f64, max_modes: usize) -> Result<Self, Error> {
        Error::check_all_finite("snapshots", snapshots.as_slice())?;
        Error::check_positive("max_modes", max_modes as f64)?;
        Error::check_not_negative("tolerance", tolerance)?;
        Error::check_positive("largest entry of the snapshots", snapshots.amax())?;
        // Through the smaller of the two sides, by QR, so that the singular vectors stay orthogonal.
        let qr = snapshots.clone().qr();
        let svd = qr.r().svd(true, true);
        let (u, v) = (svd.u.expect("asked for"), svd.v_t.expect("asked for"));
        let mut order: Vec<usize> = (0..svd.singular_values.len()).collect();
        order.sort_by(|a, b| svd.singular_values[*b].total_cmp(&svd.singular_values[*a]));
        let least = tolerance.max(1e-14) * svd.singular_values[order[0]];
        order.retain(|i| svd.singular_values[*i] > least);
        order.truncate(max_modes);
        let basis = qr.q() * u.select_columns(&order);
        let mut combination = v.select_rows(&order).transpose();
        for (mut column, i) in combination.column_iter_mut().zip(&order) {
            column /= svd.singular_values[*i];
        }
        let (points, coefficients) = interpolation(&basis)?;
        Ok(Self {
            basis,
            points,
            coefficients,
            combination,
        })
    }

    /// Number of modes, and of points.
    pub fn modes(&self) -> usize {
        self.points.len()
    }

    /// The entries that a vector is found from, in the order in which they were picked.
    pub fn points(&self) -> &[usize] {
        &self.points
    }

    /// The modes, of length 1 and at right angles.
    pub fn basis(&self) -> &DMatrix<f64> {
        &self.basis
    }

    /// How the modes are made of the snapshots: snapshots times this are the modes. What depends linearly on a snapshot
    /// (its integral, say) depends in the same way on a mode.
    pub fn combination(&self) -> &DMatrix<f64> {
        &self.combination
    }

    /// The vector with these entries at the [points](Self::points), in the space of the modes.
    ///
    /// # Panics
    /// If there are not as many as points.
    pub fn reconstruct(&self, entries: &[f64]) -> DVector<f64> {
        assert_eq!(entries.len(), self.modes(), "one entry per point");
        &self.basis * (&self.coefficients * DVector::from_column_slice(entries))
    }

    /// ‖(PᵀU)⁻¹‖: a vector's error is at most this times that of its best approximation by the modes.
    pub fn amplification(&self) -> f64 {
        self.coefficients.singular_values().max()
    }
}

/// The points, and the inverse of the basis there.
fn interpolation(basis: &DMatrix<f64>) -> Result<(Vec<usize>, DMatrix<f64>), Error> {
    let mut points: Vec<usize> = Vec::new();
    for k in 0..basis.ncols() {
        let mode = basis.column(k);
        let residual = if k == 0 {
            mode.into_owned()
        } else {
            let known = basis.columns(0, k);
            let square = known.select_rows(&points);
            let entries = DVector::from_fn(k, |i, _| mode[points[i]]);
            mode - known * solved(&square, &entries)?
        };
        points.push(residual.iamax());
    }
    let square = basis.select_rows(&points);
    let inverse = square.try_inverse().ok_or_else(|| dependent(basis))?;
    Ok((points, inverse))
}

fn solved(square: &DMatrix<f64>, entries: &DVector<f64>) -> Result<DVector<f64>, Error> {
    let solution = square.clone().lu().solve(entries);
    solution.ok_or_else(|| dependent(square))
}

fn dependent(matrix: &DMatrix<f64>) -> Error {
    Error::InvalidParameter {
        parameter: "modes that are independent at their points",
        requirement: "all",
        value: matrix.ncols() as f64,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first points of a matrix small enough to do by hand: modes e₁·.8 + e₂·.6 and its complement. The
    /// first is where the first mode is largest; the second where the second is least explained.
    #[test]
    fn points_are_picked_greedily() {
        let basis = DMatrix::from_column_slice(3, 2, &[0.8, 0.6, 0.0, 0.6, -0.8, 0.0]);
        let (points, inverse) = interpolation(&basis).unwrap();
        // Mode 2 less 0.6/0.8 of mode 1 is (0, −1.25, 0).
        assert_eq!(points, [0, 1]);
        let product = inverse * basis.select_rows(&points);
        assert!((product - DMatrix::identity(2, 2)).amax() < 1e-14);
    }

    /// A vector of the space is found exactly; of another the error is at most `amplification` times that of its
    /// projection (Chaturantabut & Sorensen 2010, lemma 3.2). Modes are combinations of snapshots, and at right angles.
    #[test]
    fn errors_are_bounded() {
        let of = |c: f64, i: usize| (c * (0.1 * i as f64)).sin() / (1.0 + c);
        let snapshots = DMatrix::from_fn(60, 15, |i, j| of(0.5 + 0.1 * j as f64, i));
        let deim = Deim::new(&snapshots, 1e-3, 15).unwrap();
        let modes = deim.modes();
        assert!(modes < 15 && modes > 2, "{modes}");
        let gram = deim.basis().tr_mul(deim.basis());
        assert!((gram - DMatrix::identity(modes, modes)).amax() < 1e-12);
        let combined = &snapshots * deim.combination();
        assert!((combined - deim.basis()).amax() < 1e-10);
        let found = |vector: &DVector<f64>| {
            let entries: Vec<f64> = deim.points().iter().map(|i| vector[*i]).collect();
            (deim.reconstruct(&entries) - vector).norm()
        };
        let inside = deim.basis() * DVector::from_fn(modes, |i, _| 1.0 / (1.0 + i as f64));
        assert!(found(&inside) < 1e-11);
        let outside = DVector::from_fn(60, |i, _| of(1.234, i));
        let projected = deim.basis() * deim.basis().tr_mul(&outside);
        let best = (&projected - &outside).norm();
        let error = found(&outside);
        println!("{error:e} {best:e} {}", deim.amplification());
        assert!(
            error >= best * (1.0 - 1e-9) && error <= best * deim.amplification() * (1.0 + 1e-9)
        );
    }

    #[test]
    fn bad_snapshots_are_errors() {
        let zero = DMatrix::zeros(5, 3);
        assert!(Deim::new(&zero, 1e-6, 3).is_err());
        let mut bad = zero.clone();
        bad[(1, 1)] = f64::NAN;
        assert!(Deim::new(&bad, 1e-6, 3).is_err());
        bad[(1, 1)] = 1.0;
        assert!(Deim::new(&bad, 1e-6, 0).is_err());
        assert_eq!(Deim::new(&bad, 1e-6, 3).unwrap().points(), [1]);
    }
}
