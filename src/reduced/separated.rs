//! Evaluation of a separated representation, which is what remains of a reduced model at run time.

use super::axis::{Axis, MAX_DEGREE};
use super::canonical::Canonical;
use crate::error::Error;
use rapier3d::na::{DMatrix, DVector};

/// A vector-valued function Σᵢ αᵢ T_i(x₀) Πⱼ U_iʲ(xⱼ) (thesis (6.1)): the factor of the first axis
/// carries the components, the others are shared by them.
///
/// It was baked over the ranges of its axes; outside of them it is evaluated at their nearer end.
///
/// ```
/// use rapier3d_immersed::reduced::{Axis, Canonical, Separated};
///
/// // sin t · e^x as one term.
/// let (time, x) = (Axis::spectral(0.0, 1.0, 10)?, Axis::spectral(0.0, 2.0, 10)?);
/// let mut tensor = Canonical::zeros(&[10, 10]);
/// tensor.push(1.0, &[time.sample(f64::sin), x.sample(f64::exp)])?;
/// let product = Separated::new(1, vec![time, x], &tensor)?;
/// let mut value = [0.0];
/// product.evaluator().evaluate(&[0.3, 1.1], &mut value); // allocates once for many points
/// assert!((value[0] - 0.3_f64.sin() * 1.1_f64.exp()).abs() < 1e-6);
/// assert_eq!(product.grid(&[&[0.3, 0.6], &[0.1, 0.5, 1.1]]).len(), 6);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Separated {
    pub(crate) components: usize,
    pub(crate) axes: Vec<Axis>,
    pub(crate) weights: Vec<f64>,
    /// For each axis, the values of all modes, node after node, and on axis 0 component after component.
    pub(crate) factors: Vec<Vec<f64>>,
}

impl Separated {
    /// Nodal values on `axes` as a function. The first dimension of the tensor holds the
    /// `components` in sequence, each with the nodes of the first axis.
    ///
    /// # Errors
    /// If the shape is not that of the axes and components, or an entry is not finite.
    pub fn new(components: usize, axes: Vec<Axis>, tensor: &Canonical) -> Result<Self, Error> {
        Error::check_length("dimensions of the tensor", axes.len(), tensor.dimensions())?;
        let factors = (0..axes.len()).map(|j| tensor.factors(j).transpose().as_slice().to_vec());
        let separated = Self {
            components,
            weights: tensor.weights().to_vec(),
            factors: factors.collect(),
            axes,
        };
        separated.check()?;
        Ok(separated)
    }

    /// Checks what must hold of anything that was built or loaded.
    pub(crate) fn check(&self) -> Result<(), Error> {
        Error::check_positive("components", self.components as f64)?;
        Error::check_positive("number of axes", self.axes.len() as f64)?;
        Error::check_length(
            "factors of a separated representation",
            self.axes.len(),
            self.factors.len(),
        )?;
        Error::check_all_finite("weights of the modes", &self.weights)?;
        for (j, (axis, factor)) in self.axes.iter().zip(&self.factors).enumerate() {
            let rows = axis
                .len()
                .checked_mul(if j == 0 { self.components } else { 1 });
            let expected = rows.and_then(|rows| rows.checked_mul(self.modes()));
            Error::check_length(
                "entries of a factor",
                expected.unwrap_or(usize::MAX),
                factor.len(),
            )?;
            Error::check_all_finite("factor of a separated representation", factor)?;
        }
        Ok(())
    }

    /// Number of terms.
    pub fn modes(&self) -> usize {
        self.weights.len()
    }

    /// Number of components of a value.
    pub fn components(&self) -> usize {
        self.components
    }

    /// The coordinates.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// The normalisation coefficients αᵢ.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// The value of a factor: mode `mode` along `axis` at `x`, of `component` if the axis is the
    /// first (thesis Fig. 6.3).
    ///
    /// # Panics
    /// If an index is out of range.
    pub fn factor(&self, axis: usize, mode: usize, component: usize, x: f64) -> f64 {
        assert!(mode < self.modes() && component < self.components);
        let mut basis = [0.0; MAX_DEGREE + 1];
        let (first, count) = self.axes[axis].basis(x, &mut basis);
        let offset = if axis == 0 {
            component * self.axes[0].len()
        } else {
            0
        } + first;
        let value = |i: usize| self.factors[axis][(offset + i) * self.modes() + mode];
        (0..count).map(|i| basis[i] * value(i)).sum()
    }

    /// An evaluator of single points that does not allocate.
    pub fn evaluator(&self) -> Evaluator<'_> {
        Evaluator {
            separated: self,
            products: vec![0.0; self.modes()],
            sums: vec![0.0; self.modes()],
            basis: [0.0; MAX_DEGREE + 1],
        }
    }

    /// The value at one point, one coordinate per axis; for many points use
    /// [`Separated::evaluator`], for a grid of them [`Separated::grid`].
    ///
    /// # Panics
    /// If the point has another number of coordinates than the representation has axes.
    pub fn evaluate(&self, point: &[f64]) -> Vec<f64> {
        let mut value = vec![0.0; self.components];
        self.evaluator().evaluate(point, &mut value);
        value
    }

    /// All values on the grid that is the product of `coordinates`, a list per axis.
    ///
    /// The first axis runs fastest and the component slowest: value (c, i₀, i₁, …) is entry
    /// `i₀ + n₀ (i₁ + n₁ (i₂ + … c))`. Each factor is interpolated once per coordinate, not once
    /// per point, and one matrix product does the rest: here a separated representation is much cheaper
    /// than solving for every point (thesis Fig. 6.7b).
    ///
    /// # Panics
    /// If there is not one list per axis.
    pub fn grid(&self, coordinates: &[&[f64]]) -> Vec<f64> {
        assert_eq!(
            coordinates.len(),
            self.axes.len(),
            "one list of coordinates per axis"
        );
        let all: usize = coordinates.iter().map(|list| list.len()).product();
        // Axes before `split` index the rows of the product, the others its columns.
        let mut split = 1;
        let mut rows = coordinates[0].len();
        while split < self.axes.len() && rows * rows < all {
            rows *= coordinates[split].len();
            split += 1;
        }
        let later: Vec<DMatrix<f64>> = (1..self.axes.len())
            .map(|axis| self.interpolated(axis, 0, coordinates[axis]))
            .collect();
        let mut values = Vec::with_capacity(all * self.components);
        for component in 0..self.components {
            let mut first = self.interpolated(0, component, coordinates[0]);
            for (mut column, weight) in first.column_iter_mut().zip(&self.weights) {
                column *= *weight;
            }
            // Modes of other components (decoupled systems) vanish here.
            let modes: Vec<usize> = (0..self.modes())
                .filter(|m| first.column(*m).amax() > 0.0)
                .collect();
            let left = later[..split - 1]
                .iter()
                .fold(first.select_columns(&modes), |product, factor| {
                    row_products(&product, factor, &modes)
                });
            let ones = DMatrix::repeat(1, modes.len(), 1.0);
            let right = later[split - 1..].iter().fold(ones, |product, factor| {
                row_products(&product, factor, &modes)
            });
            values.extend_from_slice((left * right.transpose()).as_slice());
        }
        values
    }

    /// The factors of an axis at `points`: a row per point, a column per mode.
    fn interpolated(&self, axis: usize, component: usize, points: &[f64]) -> DMatrix<f64> {
        let (n, modes) = (self.axes[axis].len(), self.modes());
        let start = component * n * modes;
        let values =
            DMatrix::from_row_slice(n, modes, &self.factors[axis][start..start + n * modes]);
        self.axes[axis].interpolation_matrix(points) * values
    }

    /// The same function on other axes, to which its factors are interpolated. On meshes of low degree a
    /// point costs less, at the price of the interpolation's error.
    ///
    /// # Errors
    /// If there is not one axis per axis.
    pub fn resampled(&self, axes: Vec<Axis>) -> Result<Self, Error> {
        Error::check_length("axes to resample on", self.axes.len(), axes.len())?;
        let modes = self.modes();
        let mut factors = Vec::new();
        for (j, new) in axes.iter().enumerate() {
            let blocks = if j == 0 { self.components } else { 1 };
            let mut factor = Vec::with_capacity(blocks * new.len() * modes);
            for block in 0..blocks {
                let values = self.interpolated(j, block, new.nodes());
                factor.extend_from_slice(values.transpose().as_slice());
            }
            factors.push(factor);
        }
        let resampled = Self {
            components: self.components,
            axes,
            weights: self.weights.clone(),
            factors,
        };
        resampled.check()?;
        Ok(resampled)
    }

    /// The nodal values as a tensor, as for [`Separated::new`].
    pub fn to_canonical(&self) -> Canonical {
        let factors = self.factors.iter().map(|values| {
            DMatrix::from_row_slice(values.len() / self.modes().max(1), self.modes(), values)
        });
        Canonical::from_parts(self.weights.clone(), factors.collect())
    }

    /// The quadrature weights of the axes, the first repeated for every component.
    pub fn metric(&self) -> Vec<DVector<f64>> {
        let metric = |(j, axis): (usize, &Axis)| {
            let copies = if j == 0 { self.components } else { 1 };
            DVector::from_vec(axis.weights().repeat(copies))
        };
        self.axes.iter().enumerate().map(metric).collect()
    }
}

/// All products of a row of `product` with a row of `factor` (its columns `modes`), the rows of
/// `product` running faster.
fn row_products(product: &DMatrix<f64>, factor: &DMatrix<f64>, modes: &[usize]) -> DMatrix<f64> {
    let n = product.nrows();
    let mut result = DMatrix::zeros(n * factor.nrows(), modes.len());
    for (column, mode) in modes.iter().enumerate() {
        let mut target = result.column_mut(column);
        for (row, value) in factor.column(*mode).iter().enumerate() {
            target
                .rows_mut(row * n, n)
                .copy_from(&(product.column(column) * *value));
        }
    }
    result
}

/// Evaluates a [`Separated`] point by point; holds the scratch memory.
#[derive(Clone, Debug)]
pub struct Evaluator<'a> {
    separated: &'a Separated,
    products: Vec<f64>,
    sums: Vec<f64>,
    basis: [f64; MAX_DEGREE + 1],
}

impl Evaluator<'_> {
    /// Writes the value at `point`, one number per component.
    ///
    /// # Panics
    /// If `point` has not one coordinate per axis or `value` not one entry per component.
    #[inline]
    pub fn evaluate(&mut self, point: &[f64], value: &mut [f64]) {
        let separated = self.separated;
        assert_eq!(point.len(), separated.axes.len(), "one coordinate per axis");
        assert_eq!(value.len(), separated.components, "one entry per component");
        let modes = separated.modes();
        self.products.copy_from_slice(&separated.weights);
        if modes == 0 {
            value.fill(0.0);
            return;
        }
        let later = separated.axes.iter().zip(&separated.factors).zip(point);
        for ((axis, factor), x) in later.skip(1) {
            let (first, count) = axis.basis(*x, &mut self.basis);
            let rows = &factor[first * modes..(first + count) * modes];
            interpolate(&self.basis[..count], rows, &mut self.sums);
            for (product, sum) in self.products.iter_mut().zip(&self.sums) {
                *product *= sum;
            }
        }
        let (first, count) = separated.axes[0].basis(point[0], &mut self.basis);
        for (component, value) in value.iter_mut().enumerate() {
            let start = component * separated.axes[0].len() + first;
            let rows = &separated.factors[0][start * modes..(start + count) * modes];
            interpolate(&self.basis[..count], rows, &mut self.sums);
            *value = self
                .products
                .iter()
                .zip(&self.sums)
                .map(|(a, b)| a * b)
                .sum();
        }
    }
}

/// Σ over the nodes of the basis value times the row of the node.
#[inline]
fn interpolate(basis: &[f64], rows: &[f64], sums: &mut [f64]) {
    sums.fill(0.0);
    for (value, row) in basis.iter().zip(rows.chunks_exact(sums.len())) {
        for (sum, entry) in sums.iter_mut().zip(row) {
            *sum += value * entry;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two components of three coordinates: sin t · (1 + x) · y² and cos t · (1 + x) · y².
    fn example() -> Separated {
        let axes = vec![
            Axis::elements(0.0, 2.0, 3, 6).unwrap(),
            Axis::elements(-1.0, 1.0, 4, 1).unwrap(),
            Axis::spectral(0.0, 3.0, 4).unwrap(),
        ];
        let t = axes[0].nodes().iter();
        let both = t.clone().map(|t| t.sin()).chain(t.map(|t| t.cos()));
        let mut tensor = Canonical::zeros(&[2 * axes[0].len(), axes[1].len(), axes[2].len()]);
        let first = DVector::from_vec(both.collect());
        let x = axes[1].sample(|x| 1.0 + x);
        let y = axes[2].sample(|y| y * y);
        tensor
            .push(0.25, &[first.clone(), x.clone(), y.clone()])
            .unwrap();
        tensor.push(0.75, &[first, x, y]).unwrap();
        Separated::new(2, axes, &tensor).unwrap()
    }

    #[test]
    fn points_and_grids_agree_with_the_function() {
        let separated = example();
        let lists: [&[f64]; 3] = [&[0.1, 0.9, 1.7], &[-0.3, 0.77], &[0.2, 1.1, 2.9, 3.0]];
        let grid = separated.grid(&lists);
        let mut entry = 0;
        for y in lists[2] {
            for x in lists[1] {
                for t in lists[0] {
                    let value = separated.evaluate(&[*t, *x, *y]);
                    let rest = (1.0 + x) * y * y;
                    // The sine is interpolated by sextic elements of length 2/3, to about 1e-8.
                    assert!((value[0] - t.sin() * rest).abs() < 1e-6);
                    assert!((value[1] - t.cos() * rest).abs() < 1e-6);
                    for (component, c) in value.iter().enumerate() {
                        assert!((grid[component * 24 + entry] - c).abs() < 1e-13);
                    }
                    entry += 1;
                }
            }
        }
        assert_eq!(2 * entry, grid.len());
        assert!((separated.factor(0, 0, 1, 0.4) - 0.4_f64.cos()).abs() < 1e-7);
    }

    /// Beyond the axes the value is that of the nearer end, and NaN counts as the start.
    #[test]
    fn evaluation_is_clamped() {
        let separated = example();
        assert_eq!(
            separated.evaluate(&[-5.0, 9.0, f64::NAN]),
            separated.evaluate(&[0.0, 1.0, 0.0])
        );
        assert_eq!(
            separated.evaluate(&[f64::INFINITY, 0.0, 1.0]),
            separated.evaluate(&[2.0, 0.0, 1.0])
        );
    }

    #[test]
    fn resampling_keeps_the_function() {
        let separated = example();
        let axes = vec![
            Axis::elements(0.0, 2.0, 20, 3).unwrap(),
            Axis::elements(-1.0, 1.0, 7, 2).unwrap(),
            Axis::elements(0.0, 3.0, 2, 2).unwrap(),
        ];
        let other = separated.resampled(axes).unwrap();
        for point in [[0.3, 0.2, 1.0], [1.9, -0.9, 2.5]] {
            for (a, b) in separated
                .evaluate(&point)
                .iter()
                .zip(other.evaluate(&point))
            {
                assert!((a - b).abs() < 1e-5);
            }
        }
        assert!(separated.resampled(vec![]).is_err());
    }

    #[test]
    fn wrong_shapes_are_errors() {
        let axis = Axis::spectral(0.0, 1.0, 4).unwrap();
        let mut tensor = Canonical::zeros(&[4, 4]);
        assert!(
            Separated::new(2, vec![axis.clone(); 2], &{
                let mut t = tensor.clone();
                t.push(1.0, &[DVector::zeros(4), DVector::zeros(4)])
                    .unwrap();
                t
            })
            .is_err()
        );
        assert!(Separated::new(1, vec![axis.clone(); 3], &tensor).is_err());
        tensor
            .push(f64::NAN, &[DVector::zeros(4), DVector::zeros(4)])
            .unwrap();
        assert!(Separated::new(1, vec![axis; 2], &tensor).is_err());
    }
}
