//! One coordinate of a separated representation: a one-dimensional mesh with its basis functions.

use super::legendre::Rule;
use crate::error::Error;
use rapier3d::na::{DMatrix, DVector};

mod assembly;

pub use assembly::Quadrature;

/// The largest polynomial degree of an element.
pub const MAX_DEGREE: usize = 63;

/// Which points carry the unknowns inside an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Family {
    /// Gauss–Lobatto points: for space, parameters and initial values. Degree 1 gives linear
    /// finite elements (thesis § 6.2.3 names no degree), one element of high degree a spectral basis.
    Lobatto,
    /// The start of the element and the right Gauss–Radau points: for time. Collocation there is
    /// the Radau IIA method, equal to the discontinuous Galerkin method with Radau quadrature. It is
    /// stiffly accurate, L-stable, and of order `2·degree − 1` at the ends of the elements.
    Radau,
}

/// What is stored of an axis, from which the rest follows.
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
///
/// ```
/// use rapier3d_immersed::reduced::Axis;
///
/// // Twelve nodes interpolate a smooth function on [0, 2] to nine digits.
/// let axis = Axis::spectral(0.0, 2.0, 12)?;
/// let sine = axis.sample(f64::sin);
/// assert!((axis.interpolate(sine.as_slice(), 1.234) - 1.234_f64.sin()).abs() < 1e-9);
/// // The weights integrate.
/// let integral: f64 = axis.weights().iter().zip(&sine).map(|(weight, value)| weight * value).sum();
/// assert!((integral - (1.0 - 2.0_f64.cos())).abs() < 1e-9);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
#[cfg_attr(feature = "serde-serialize", serde(try_from = "Mesh", into = "Mesh"))]
pub struct Axis {
    mesh: Mesh,
    /// The nodes of the element [−1, 1], their quadrature weights and barycentric weights.
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
    /// Those of [`Axis::new`]; `elements` must be positive.
    pub fn elements(start: f64, end: f64, elements: usize, degree: usize) -> Result<Self, Error> {
        Self::new(Family::Lobatto, uniform(start, end, elements)?, degree)
    }

    /// One element of degree `nodes − 1`: a spectral basis.
    ///
    /// # Errors
    /// Those of [`Axis::new`]; there must be at least two nodes.
    pub fn spectral(start: f64, end: f64, nodes: usize) -> Result<Self, Error> {
        Self::elements(start, end, 1, nodes.saturating_sub(1))
    }

    /// A time axis from `start` to `end` for quantities that start at zero: `elements` equal Radau
    /// elements with `stages` nodes each.
    ///
    /// # Errors
    /// Those of [`Axis::new`]; `elements` must be positive.
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
    pub(crate) fn with_free_ends(self) -> Self {
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

    /// An error if functions on this axis have to vanish at an end.
    pub(crate) fn check_free_ends(&self) -> Result<(), Error> {
        let nodes = self.mesh.degree * (self.mesh.breaks.len() - 1) + 1;
        Error::check_length(
            "nodes of a parameter's axis, which needs both ends",
            nodes,
            self.len(),
        )
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
        let all = self.reference.iter().zip(&self.barycentric);
        for (value, (node, weight)) in values.iter_mut().zip(all) {
            *value = weight * product;
            product *= xi - node;
        }
        product = 1.0;
        for (value, node) in values[..n].iter_mut().zip(&self.reference).rev() {
            *value *= product;
            product *= xi - node;
        }
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
    pub(crate) fn interpolation_matrix(&self, points: &[f64]) -> DMatrix<f64> {
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

    /// The values of `f` at the nodes.
    pub fn sample(&self, f: impl Fn(f64) -> f64) -> DVector<f64> {
        DVector::from_iterator(self.len(), self.nodes.iter().map(|x| f(*x)))
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
