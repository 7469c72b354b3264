//! A function as a weighted combination of its linearizations.

use crate::error::Error;
use crate::math;
use rapier3d::na::{DMatrix, DVector};

/// f(x) ≈ Σ wᵢ(x) (f(xᵢ) + Jᵢ (x − xᵢ)), with weights that only depend on which of the points are near (thesis (6.31);
/// Rewieński & White, *Linear Algebra Appl.* 415, 426 (2006)).
///
/// `wᵢ ∝ exp(−25 dᵢ/d)`, dᵢ being the scaled distance to xᵢ and d the least of them, so that Σ wᵢ = 1 and f is exact to first order at
/// each point. Points are taken along a training input, wherever it is farther than a distance from all those taken before.
/// Parameters are coordinates of x like any other.
///
/// ```
/// use rapier3d_immersed::reduced::PiecewiseLinear;
///
/// let sine = |x: &[f64], out: &mut [f64]| out[0] = x[0].sin();
/// let training = (0..=100).map(|i| vec![0.0628 * f64::from(i)]);
/// let model = PiecewiseLinear::bake(training, &[1.0], 0.3, (1, 100), sine)?;
/// assert!(model.points() <= 21);
/// let mut out = [0.0];
/// model.evaluate(&[1.0], &mut out);
/// assert!((out[0] - 1.0_f64.sin()).abs() < 0.05);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PiecewiseLinear {
    scales: Vec<f64>,
    outputs: usize,
    /// Scaled coordinates, one point after the other.
    places: Vec<f64>,
    pieces: Vec<Piece>,
    covered: bool,
}

/// A linearization.
#[derive(Clone, Debug, PartialEq)]
struct Piece {
    value: DVector<f64>,
    /// By the scaled coordinates.
    slope: DMatrix<f64>,
}

/// β of the weights: Rewieński & White's.
const SHARPNESS: f64 = 25.0;

impl PiecewiseLinear {
    /// Linearizes `model`, which writes `outputs` numbers, about points of `training` that are at least `distance` apart, each
    /// coordinate over its scale, and at most `max_points` of them.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if there are no points or a scale or the distance is not positive, [`Error::WrongLength`]
    /// if a point has not one coordinate per scale, [`Error::NotFinite`] if the model is not finite about one.
    pub fn bake(
        training: impl IntoIterator<Item = Vec<f64>>,
        scales: &[f64],
        distance: f64,
        (outputs, max_points): (usize, usize),
        mut model: impl FnMut(&[f64], &mut [f64]),
    ) -> Result<Self, Error> {
        Error::check_positive("outputs", outputs as f64)?;
        Error::check_positive("max_points", max_points as f64)?;
        Error::check_positive("distance", distance)?;
        for scale in scales {
            Error::check_positive("scale of a coordinate", *scale)?;
        }
        let mut all = Self {
            scales: scales.to_vec(),
            outputs,
            places: Vec::new(),
            pieces: Vec::new(),
            covered: true,
        };
        for point in training {
            Error::check_length("coordinates of a point", scales.len(), point.len())?;
            if all.nearest(&point) < distance * distance {
                continue;
            }
            if all.pieces.len() == max_points {
                all.covered = false;
                break;
            }
            let piece = Piece::of(&point, scales, outputs, &mut model)?;
            let place = point.iter().zip(scales).map(|(x, scale)| x / scale);
            all.places.extend(place);
            all.pieces.push(piece);
        }
        Error::check_positive("number of training points", all.pieces.len() as f64)?;
        Ok(all)
    }

    /// Number of linearizations.
    pub fn points(&self) -> usize {
        self.pieces.len()
    }

    /// Whether the points reach over the whole of the training input.
    pub fn covered(&self) -> bool {
        self.covered
    }

    /// Squares of the scaled distances to the points.
    fn distances(&self, x: &[f64]) -> impl Iterator<Item = f64> {
        let places = self.places.chunks_exact(self.scales.len());
        places.map(move |place| {
            let parts = place.iter().zip(x).zip(&self.scales);
            parts.map(|((p, x), scale)| (x / scale - p).powi(2)).sum()
        })
    }

    fn nearest(&self, x: &[f64]) -> f64 {
        self.distances(x).fold(f64::INFINITY, f64::min)
    }

    /// Writes the value at `x`.
    ///
    /// # Panics
    /// If `x` has not one coordinate per scale or `value` not one entry per output.
    pub fn evaluate(&self, x: &[f64], value: &mut [f64]) {
        assert_eq!(x.len(), self.scales.len(), "one coordinate per scale");
        assert_eq!(value.len(), self.outputs, "one entry per output");
        let least = self.nearest(x).sqrt().max(1e-300);
        value.fill(0.0);
        let mut total = 0.0;
        let places = self.places.chunks_exact(self.scales.len());
        for ((piece, place), d2) in self.pieces.iter().zip(places).zip(self.distances(x)) {
            // The nearest has e⁰: the common factor cancels.
            let weight = math::exp(SHARPNESS * (1.0 - d2.sqrt() / least));
            if weight < 1e-12 {
                continue;
            }
            total += weight;
            for (k, value) in value.iter_mut().enumerate() {
                let row = piece.slope.row(k);
                let way = row.iter().zip(place).zip(x.iter().zip(&self.scales));
                let change: f64 = way.map(|((s, p), (x, scale))| s * (x / scale - p)).sum();
                *value += weight * (piece.value[k] + change);
            }
        }
        value.iter_mut().for_each(|value| *value /= total);
    }
}

impl Piece {
    /// By central differences over a millionth of the scales.
    fn of(
        point: &[f64],
        scales: &[f64],
        outputs: usize,
        model: &mut impl FnMut(&[f64], &mut [f64]),
    ) -> Result<Self, Error> {
        const STEP: f64 = 1e-6;
        let mut at = |x: &[f64]| {
            let mut out = DVector::zeros(outputs);
            model(x, out.as_mut_slice());
            out
        };
        let value = at(point);
        let mut slope = DMatrix::zeros(outputs, scales.len());
        let mut x = point.to_vec();
        for (k, scale) in scales.iter().enumerate() {
            x[k] = point[k] + STEP * scale;
            let after = at(&x);
            x[k] = point[k] - STEP * scale;
            let before = at(&x);
            x[k] = point[k];
            slope.set_column(k, &((after - before) / (2.0 * STEP)));
        }
        Error::check_all_finite("value of a piecewise linear model", value.as_slice())?;
        Error::check_all_finite("slope of a piecewise linear model", slope.as_slice())?;
        Ok(Self { value, slope })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quadratic(x: &[f64], out: &mut [f64]) {
        out.copy_from_slice(&[x[0] * x[0] - 2.0 * x[1], x[0] * x[1]]);
    }

    fn grid(count: u32) -> impl Iterator<Item = Vec<f64>> {
        let at = move |i: u32| f64::from(i) / f64::from(count - 1);
        (0..count * count).map(move |i| vec![at(i % count), 3.0 * at(i / count)])
    }

    /// At its points value and slope are the function's; between them the error falls with the square of their distance,
    /// here from .25 to .125 of the scale: a quarter.
    #[test]
    fn it_is_exact_to_first_order_at_its_points() {
        let scales = [1.0, 3.0];
        let model = |distance| {
            PiecewiseLinear::bake(grid(9), &scales, distance, (2, 100), quadratic).unwrap()
        };
        let fine = model(0.12);
        assert!(fine.points() == 81 && fine.covered());
        let (mut value, mut exact) = ([0.0; 2], [0.0; 2]);
        for x in [[0.25, 1.5], [0.25 + 1e-4, 1.5 - 2e-4]] {
            fine.evaluate(&x, &mut value);
            quadratic(&x, &mut exact);
            for k in 0..2 {
                // Second order in the way of 1e-4.
                assert!((value[k] - exact[k]).abs() < 1e-7, "{value:?} {exact:?}");
            }
        }
        // At the same places between the points: of a quadratic function the errors are alike.
        let worst = |model: &PiecewiseLinear, count: u32| {
            grid(count).fold(0.0_f64, |worst, x| {
                let (mut value, mut exact) = ([0.0; 2], [0.0; 2]);
                model.evaluate(&x, &mut value);
                quadratic(&x, &mut exact);
                worst.max((value[0] - exact[0]).abs())
            })
        };
        let coarse = PiecewiseLinear::bake(grid(5), &scales, 0.2, (2, 100), quadratic).unwrap();
        let ratio = worst(&coarse, 33) / worst(&fine, 65);
        // Central differences are good to nine digits.
        assert!((ratio - 4.0).abs() < 1e-6, "{ratio}");
    }

    /// Linear functions are exact anywhere: the weights sum to one.
    #[test]
    fn linear_functions_are_exact() {
        let linear = |x: &[f64], out: &mut [f64]| out[0] = 3.0 + 2.0 * x[0] - x[1];
        let model = PiecewiseLinear::bake(grid(4), &[1.0, 3.0], 0.3, (1, 100), linear).unwrap();
        for x in [[0.1, 0.2], [0.77, 2.9], [4.0, -7.0]] {
            let (mut value, mut exact) = ([0.0], [0.0]);
            model.evaluate(&x, &mut value);
            linear(&x, &mut exact);
            assert!((value[0] - exact[0]).abs() < 1e-8);
        }
    }

    #[test]
    fn bad_training_is_an_error() {
        let bake = |training: Vec<Vec<f64>>, distance| {
            PiecewiseLinear::bake(training, &[1.0, 1.0], distance, (2, 10), quadratic)
        };
        assert!(bake(vec![], 0.1).is_err());
        assert!(bake(vec![vec![1.0]], 0.1).is_err());
        assert!(bake(vec![vec![1.0, 1.0]], 0.0).is_err());
        assert!(bake(vec![vec![f64::NAN, 1.0]], 0.1).is_err());
        let few = PiecewiseLinear::bake(grid(9), &[1.0, 3.0], 0.12, (2, 10), quadratic).unwrap();
        assert!(few.points() == 10 && !few.covered());
    }
}
