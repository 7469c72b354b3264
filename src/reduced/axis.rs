//! One coordinate of a separated representation: a one-dimensional mesh with its basis functions.

use super::legendre::Rule;
use crate::Error;
use rapier3d::na::{DMatrix, DVector};

/// The largest polynomial degree of an element.
pub const MAX_DEGREE: usize = 63;

/// Which points carry the unknowns inside an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Family {
    /// Gauss–Lobatto points: for space, parameters and initial values. Degree 1 gives the linear
    /// finite elements of thesis §6.2.3, one element of high degree a spectral basis.
    Lobatto,
    /// The start of the element and the right Gauss–Radau points: for time. Collocation there is
    /// the Radau IIA method, equal to the discontinuous Galerkin method with Radau quadrature:
    /// stiffly accurate and L-stable, of order `2·degree − 1` at the ends of the elements.
    Radau,
}

/// How the integrals of a matrix or a load are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quadrature {
    /// At the nodes themselves: mass matrices are diagonal and products of functions are products
    /// of nodal values.
    Nodal,
    /// Gauss–Legendre with this many points per element (at least one).
    Gauss(usize),
}

/// What is stored of an axis; the rest follows.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
struct Mesh {
    family: Family,
    degree: usize,
    breaks: Vec<f64>,
    zero_start: bool,
    zero_end: bool,
}

/// A one-dimensional mesh of Lagrange elements: one coordinate (time, a parameter, an initial
/// value, a direction of space) of a separated representation.
///
/// The coordinate has whatever unit the user gives it. Functions are continuous and determined by
/// their values at [`Axis::nodes`]. An end where every function vanishes carries no node: see
/// [`Axis::with_zero_start`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
#[cfg_attr(feature = "serde-serialize", serde(try_from = "Mesh", into = "Mesh"))]
pub struct Axis {
    mesh: Mesh,
    reference: Vec<f64>,
    reference_weights: Vec<f64>,
    barycentric: Vec<f64>,
    nodes: Vec<f64>,
    weights: Vec<f64>,
}

impl TryFrom<Mesh> for Axis {
    type Error = Error;

    fn try_from(mesh: Mesh) -> Result<Self, Error> {
        if mesh.degree == 0 || mesh.degree > MAX_DEGREE {
            return Err(Error::InvalidParameter {
                parameter: "degree",
                requirement: "between 1 and 63",
                value: mesh.degree as f64,
            });
        }
        if mesh.breaks.len() < 2 {
            return Err(Error::WrongLength {
                what: "breaks of an axis",
                expected: 2,
                actual: mesh.breaks.len(),
            });
        }
        for pair in mesh.breaks.windows(2) {
            Error::check_positive("length of an element", pair[1] - pair[0])?;
        }
        Ok(Self::from_mesh(mesh))
    }
}

impl From<Axis> for Mesh {
    fn from(axis: Axis) -> Self {
        axis.mesh
    }
}

impl Axis {
    /// An axis over the elements between `breaks` (increasing, at least two).
    ///
    /// # Errors
    /// If `breaks` are fewer than two, not finite or not increasing, or if `degree` is outside of
    /// 1..=[`MAX_DEGREE`].
    pub fn new(family: Family, breaks: Vec<f64>, degree: usize) -> Result<Self, Error> {
        Self::try_from(Mesh {
            family,
            degree,
            breaks,
            zero_start: false,
            zero_end: false,
        })
    }

    /// `elements` equal Lobatto elements of the given degree from `start` to `end`.
    ///
    /// # Errors
    /// As [`Axis::new`]; `elements` must be positive.
    pub fn elements(start: f64, end: f64, elements: usize, degree: usize) -> Result<Self, Error> {
        Self::new(Family::Lobatto, uniform(start, end, elements)?, degree)
    }

    /// One element of degree `nodes − 1`: a spectral basis.
    ///
    /// # Errors
    /// As [`Axis::new`]; at least two nodes.
    pub fn spectral(start: f64, end: f64, nodes: usize) -> Result<Self, Error> {
        Self::elements(start, end, 1, nodes.saturating_sub(1))
    }

    /// A time axis from `start` to `end` for quantities that start at zero: `elements` equal Radau
    /// elements with `stages` nodes each.
    ///
    /// # Errors
    /// As [`Axis::new`]; `elements` must be positive.
    pub fn time(start: f64, end: f64, elements: usize, stages: usize) -> Result<Self, Error> {
        let axis = Self::new(Family::Radau, uniform(start, end, elements)?, stages)?;
        Ok(axis.with_zero_start())
    }

    /// The same mesh for functions that vanish at the start.
    #[must_use]
    pub fn with_zero_start(self) -> Self {
        Self::from_mesh(Mesh {
            zero_start: true,
            ..self.mesh
        })
    }

    /// The same mesh for functions that vanish at the end.
    #[must_use]
    pub fn with_zero_end(self) -> Self {
        Self::from_mesh(Mesh {
            zero_end: true,
            ..self.mesh
        })
    }

    /// The same mesh with a node at both ends.
    #[must_use]
    pub fn with_free_ends(self) -> Self {
        Self::from_mesh(Mesh {
            zero_start: false,
            zero_end: false,
            ..self.mesh
        })
    }

    fn from_mesh(mesh: Mesh) -> Self {
        let (reference, reference_weights) = match mesh.family {
            Family::Lobatto => {
                let rule = Rule::lobatto(mesh.degree + 1);
                (rule.nodes, rule.weights)
            }
            Family::Radau => {
                let rule = Rule::radau_right(mesh.degree);
                let with_start = |start: f64, rest: Vec<f64>| {
                    std::iter::once(start).chain(rest).collect::<Vec<_>>()
                };
                (with_start(-1.0, rule.nodes), with_start(0.0, rule.weights))
            }
        };
        let barycentric = (0..reference.len())
            .map(|i| {
                let others = (0..reference.len()).filter(|j| *j != i);
                others
                    .map(|j| reference[i] - reference[j])
                    .product::<f64>()
                    .recip()
            })
            .collect();
        let elements = mesh.breaks.len() - 1;
        let mut nodes = vec![mesh.breaks[0]];
        let mut weights = vec![0.0];
        for element in mesh.breaks.windows(2) {
            let half = 0.5 * (element[1] - element[0]);
            *weights.last_mut().expect("starts with one") += half * reference_weights[0];
            for i in 1..reference.len() {
                let end = i + 1 == reference.len();
                nodes.push(if end {
                    element[1]
                } else {
                    element[0] + half * (1.0 + reference[i])
                });
                weights.push(half * reference_weights[i]);
            }
        }
        debug_assert_eq!(nodes.len(), elements * mesh.degree + 1);
        if mesh.zero_end {
            nodes.pop();
            weights.pop();
        }
        if mesh.zero_start {
            nodes.remove(0);
            weights.remove(0);
        }
        Self {
            mesh,
            reference,
            reference_weights,
            barycentric,
            nodes,
            weights,
        }
    }

    /// The points that carry the unknowns, increasing.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// The weights of the quadrature at the nodes. They sum to the length of the axis unless an
    /// end is left out; all are positive but that of the free start of a Radau axis, which is 0.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether no node is left (one linear element that vanishes at both ends).
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Where the axis starts.
    pub fn start(&self) -> f64 {
        self.mesh.breaks[0]
    }

    /// Where the axis ends.
    pub fn end(&self) -> f64 {
        self.mesh.breaks[self.mesh.breaks.len() - 1]
    }

    /// Polynomial degree of the elements.
    pub fn degree(&self) -> usize {
        self.mesh.degree
    }

    /// Which points carry the unknowns.
    pub fn family(&self) -> Family {
        self.mesh.family
    }

    /// Whether the functions of this axis vanish at its start.
    pub fn vanishes_at_start(&self) -> bool {
        self.mesh.zero_start
    }

    /// For each element in turn, how many nodes lie in it and not in the ones before: what a
    /// causal (block lower triangular) system in time can be solved by.
    pub(crate) fn causal_blocks(&self) -> Vec<usize> {
        vec![self.mesh.degree; self.mesh.breaks.len() - 1]
    }

    /// The values at `x` of the basis functions that do not vanish there, written into `values`,
    /// and the index of the first. Coordinates outside of the axis count as its nearer end, NaN as
    /// its start.
    #[inline]
    pub(crate) fn basis(&self, x: f64, values: &mut [f64; MAX_DEGREE + 1]) -> (usize, usize) {
        let x = x.max(self.start()).min(self.end());
        let breaks = &self.mesh.breaks;
        let element = breaks[1..breaks.len() - 1].partition_point(|b| *b <= x);
        let (left, right) = (breaks[element], breaks[element + 1]);
        let n = self.mesh.degree + 1;
        self.lagrange((2.0 * x - left - right) / (right - left), values);
        let first = element * self.mesh.degree;
        let (mut begin, mut end) = (first, first + n);
        if self.mesh.zero_start {
            if element == 0 {
                values.copy_within(1..n, 0);
                end -= 1;
            } else {
                begin -= 1;
                end -= 1;
            }
        }
        (begin, end.min(self.nodes.len()) - begin)
    }

    /// The Lagrange polynomials of the reference element at ξ ∈ [−1, 1]: products from both sides,
    /// which need neither a division nor a special case at the nodes.
    #[inline]
    fn lagrange(&self, xi: f64, values: &mut [f64; MAX_DEGREE + 1]) {
        let n = self.reference.len();
        let mut product = 1.0;
        for i in 0..n {
            values[i] = self.barycentric[i] * product;
            product *= xi - self.reference[i];
        }
        product = 1.0;
        for i in (0..n).rev() {
            values[i] *= product;
            product *= xi - self.reference[i];
        }
    }

    /// Derivatives of the Lagrange polynomials of the reference element at ξ.
    fn lagrange_slopes(&self, xi: f64) -> Vec<f64> {
        let n = self.reference.len();
        let slope = |i: usize| -> f64 {
            (0..n)
                .filter(|skip| *skip != i)
                .map(|skip| {
                    let rest = (0..n).filter(|j| *j != i && *j != skip);
                    rest.map(|j| xi - self.reference[j]).product::<f64>()
                })
                .sum()
        };
        (0..n).map(|i| self.barycentric[i] * slope(i)).collect()
    }

    /// The value at `x` of the function with these nodal values.
    ///
    /// # Panics
    /// If there are fewer `values` than nodes.
    pub fn interpolate(&self, values: &[f64], x: f64) -> f64 {
        let mut basis = [0.0; MAX_DEGREE + 1];
        let (first, count) = self.basis(x, &mut basis);
        (0..count).map(|i| basis[i] * values[first + i]).sum()
    }

    /// The matrix that takes nodal values to values at `points`.
    pub fn interpolation_matrix(&self, points: &[f64]) -> DMatrix<f64> {
        let mut matrix = DMatrix::zeros(points.len(), self.len());
        let mut basis = [0.0; MAX_DEGREE + 1];
        for (row, x) in points.iter().enumerate() {
            let (first, count) = self.basis(*x, &mut basis);
            for i in 0..count {
                matrix[(row, first + i)] = basis[i];
            }
        }
        matrix
    }

    /// Visits every quadrature point: its coordinate, its weight, the nodes around it (`None`
    /// where the function vanishes) and there the values and slopes of the basis functions.
    fn visit(
        &self,
        rule: Quadrature,
        mut visit: impl FnMut(f64, f64, &[Option<usize>], &[f64], &[f64]),
    ) {
        let rule = match rule {
            Quadrature::Nodal => Rule {
                nodes: self.reference.clone(),
                weights: self.reference_weights.clone(),
            },
            Quadrature::Gauss(points) => Rule::gauss(points.max(1)),
        };
        let mut values = [0.0; MAX_DEGREE + 1];
        let n = self.mesh.degree + 1;
        for (element, ends) in self.mesh.breaks.windows(2).enumerate() {
            let half = 0.5 * (ends[1] - ends[0]);
            let indices: Vec<Option<usize>> = (0..n)
                .map(|i| {
                    let shift = usize::from(self.mesh.zero_start);
                    let node = (element * self.mesh.degree + i).checked_sub(shift)?;
                    (node < self.len()).then_some(node)
                })
                .collect();
            for (xi, weight) in rule.nodes.iter().zip(&rule.weights) {
                self.lagrange(*xi, &mut values);
                let slopes: Vec<f64> = self.lagrange_slopes(*xi).iter().map(|s| s / half).collect();
                let x = ends[0] + half * (1.0 + xi);
                visit(x, weight * half, &indices, &values[..n], &slopes);
            }
        }
    }

    /// ∫ f Nᵢ⁽ᵃ⁾ Nⱼ⁽ᵇ⁾ dx: row i is tested with the `test_order`-th (0 or 1) derivative of its basis
    /// function, column j is the `trial_order`-th of its own (thesis (6.9)).
    ///
    /// A mass matrix has orders 0, 0; a stiffness matrix 1, 1; a first derivative 0, 1.
    pub fn matrix(
        &self,
        rule: Quadrature,
        test_order: usize,
        trial_order: usize,
        f: impl Fn(f64) -> f64,
    ) -> DMatrix<f64> {
        let mut matrix = DMatrix::zeros(self.len(), self.len());
        self.visit(rule, |x, weight, indices, values, slopes| {
            let test = if test_order == 0 { values } else { slopes };
            let trial = if trial_order == 0 { values } else { slopes };
            let scale = weight * f(x);
            for (i, row) in indices.iter().enumerate() {
                for (j, column) in indices.iter().enumerate() {
                    if let (Some(row), Some(column)) = (row, column) {
                        matrix[(*row, *column)] += scale * test[i] * trial[j];
                    }
                }
            }
        });
        matrix
    }

    /// ∫ f Nᵢ dx.
    pub fn load(&self, rule: Quadrature, f: impl Fn(f64) -> f64) -> DVector<f64> {
        let mut load = DVector::zeros(self.len());
        self.visit(rule, |x, weight, indices, values, _| {
            for (i, row) in indices.iter().enumerate() {
                if let Some(row) = row {
                    load[*row] += weight * f(x) * values[i];
                }
            }
        });
        load
    }

    /// The values of `f` at the nodes.
    pub fn sample(&self, f: impl Fn(f64) -> f64) -> DVector<f64> {
        DVector::from_iterator(self.len(), self.nodes.iter().map(|x| f(*x)))
    }

    /// The matrix that takes the nodal values of f on a time axis ([`Axis::time`]) to those of
    /// ∫ f dt from the start: the Radau IIA coefficients, one element after the other.
    ///
    /// # Errors
    /// If the axis is not a Radau axis with zero start and free end.
    pub fn integral(&self) -> Result<DMatrix<f64>, Error> {
        if self.mesh.family != Family::Radau || !self.mesh.zero_start || self.mesh.zero_end {
            return Err(Error::InvalidParameter {
                parameter: "time axis",
                requirement: "a Radau axis with zero start and free end",
                value: self.start(),
            });
        }
        let stages = self.mesh.degree;
        // The polynomial through the stages alone (the start carries no rate), by its own axis.
        let gauss = Rule::gauss(stages);
        let nodes = &self.reference[1..];
        let lagrange = |j: usize, x: f64| -> f64 {
            let others = (0..stages).filter(|k| *k != j);
            others
                .map(|k| (x - nodes[k]) / (nodes[j] - nodes[k]))
                .product()
        };
        let butcher = DMatrix::from_fn(stages, stages, |i, j| {
            let half = 0.5 * (nodes[i] + 1.0);
            let points = gauss.nodes.iter().zip(&gauss.weights);
            half * points
                .map(|(x, w)| w * lagrange(j, -1.0 + half * (1.0 + x)))
                .sum::<f64>()
        });
        let mut integral = DMatrix::zeros(self.len(), self.len());
        for (element, ends) in self.mesh.breaks.windows(2).enumerate() {
            let half = 0.5 * (ends[1] - ends[0]);
            let first = element * stages;
            for j in 0..stages {
                for i in 0..stages {
                    integral[(first + i, first + j)] = half * butcher[(i, j)];
                }
                for later in first + stages..self.len() {
                    integral[(later, first + j)] = self.weights[first + j];
                }
            }
        }
        Ok(integral)
    }
}

fn uniform(start: f64, end: f64, elements: usize) -> Result<Vec<f64>, Error> {
    if !start.is_finite() {
        return Err(Error::InvalidParameter {
            parameter: "start of an axis",
            requirement: "finite",
            value: start,
        });
    }
    Error::check_positive("length of an axis", end - start)?;
    Error::check_positive("number of elements", elements as f64)?;
    let step = (end - start) / elements as f64;
    let inner = (1..elements).map(|i| start + step * i as f64);
    Ok(std::iter::once(start).chain(inner).chain([end]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A polynomial of the element's degree is its own interpolant, on every kind of axis.
    #[test]
    fn polynomials_are_reproduced() {
        for family in [Family::Lobatto, Family::Radau] {
            for degree in [1, 2, 5, 12] {
                let axis = Axis::new(family, vec![-1.0, 0.5, 0.9, 3.0], degree).unwrap();
                let f = |x: f64| {
                    (0..=degree)
                        .map(|k| (k as f64 - 1.7) * (x / 3.0).powi(k as i32))
                        .sum::<f64>()
                };
                let values = axis.sample(f);
                for i in 0..=40 {
                    let x = -1.0 + i as f64 * 0.1;
                    let error = (axis.interpolate(values.as_slice(), x) - f(x)).abs();
                    assert!(
                        error < 1e-11,
                        "{family:?}, degree {degree}, x = {x}: {error:e}"
                    );
                }
            }
        }
    }

    #[test]
    fn ends_without_a_node_vanish() {
        let axis = Axis::elements(0.0, 1.0, 4, 3)
            .unwrap()
            .with_zero_start()
            .with_zero_end();
        assert_eq!(axis.len(), 4 * 3 + 1 - 2);
        let f = |x: f64| x * (1.0 - x);
        let values = axis.sample(f);
        for x in [0.0, 1e-3, 0.1, 0.25, 0.5, 0.77, 0.999, 1.0] {
            assert!((axis.interpolate(values.as_slice(), x) - f(x)).abs() < 1e-14);
        }
        // Beyond the ends, and for NaN, the value is that of the end.
        for x in [-3.0, 7.0, f64::NAN] {
            assert_eq!(axis.interpolate(values.as_slice(), x), 0.0);
        }
    }

    /// Integrals of polynomials that both rules must get exactly.
    #[test]
    fn matrices_integrate_polynomials() {
        let axis = Axis::elements(0.0, 2.0, 3, 4).unwrap();
        let f = axis.sample(|x| x * x);
        let g = axis.sample(|x| 1.0 + x.powi(3));
        let gauss = Quadrature::Gauss(6);
        let mass = f.dot(&(axis.matrix(gauss, 0, 0, |x| x) * &g));
        assert!((mass - (16.0 / 4.0 + 128.0 / 7.0)).abs() < 1e-12); // ∫ x³ + x⁶
        let stiffness = f.dot(&(axis.matrix(gauss, 1, 1, |_| 1.0) * &g));
        assert!((stiffness - 6.0 * 16.0 / 4.0).abs() < 1e-12); // ∫ 2x · 3x²
        let derivative = f.dot(&(axis.matrix(Quadrature::Nodal, 0, 1, |_| 1.0) * &g));
        assert!((derivative - 3.0 * 32.0 / 5.0).abs() < 1e-12); // ∫ x² · 3x²
        assert!((axis.load(gauss, |x| x).sum() - 2.0).abs() < 1e-13);
        assert!((axis.weights().iter().sum::<f64>() - 2.0).abs() < 1e-13);
    }

    /// Three-stage Radau IIA coefficients, Hairer & Wanner II, table IV.5.6, and the exact integral
    /// of the polynomials it covers.
    #[test]
    fn integral_is_radau_iia() {
        let axis = Axis::time(0.0, 1.0, 1, 3).unwrap();
        let integral = axis.integral().unwrap();
        let root = 6.0_f64.sqrt();
        assert!((integral[(0, 0)] - (88.0 - 7.0 * root) / 360.0).abs() < 1e-14);
        assert!((integral[(1, 0)] - (296.0 + 169.0 * root) / 1800.0).abs() < 1e-14);
        assert!((integral[(2, 2)] - 1.0 / 9.0).abs() < 1e-14);
        let axis = Axis::time(1.0, 3.0, 4, 3).unwrap();
        let error = axis.integral().unwrap() * axis.sample(|t| t * t)
            - axis.sample(|t| (t.powi(3) - 1.0) / 3.0);
        assert!(error.amax() < 1e-13);
    }

    #[test]
    fn bad_axes_are_errors() {
        assert!(Axis::elements(0.0, 0.0, 2, 1).is_err());
        assert!(Axis::elements(0.0, f64::NAN, 2, 1).is_err());
        assert!(Axis::elements(f64::NEG_INFINITY, 1.0, 2, 1).is_err());
        assert!(Axis::elements(0.0, 1.0, 0, 1).is_err());
        assert!(Axis::elements(0.0, 1.0, 1, 0).is_err());
        assert!(Axis::spectral(0.0, 1.0, 0).is_err());
        assert!(Axis::spectral(0.0, 1.0, 99).is_err());
        assert!(Axis::new(Family::Lobatto, vec![0.0, 1.0, 0.5], 1).is_err());
        assert!(Axis::new(Family::Lobatto, vec![0.0], 1).is_err());
        assert!(Axis::elements(0.0, 1.0, 2, 2).unwrap().integral().is_err());
    }
}
