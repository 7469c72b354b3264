//! Matrices and loads of an axis: the one-dimensional integrals of thesis (6.9).

use super::{Axis, Family, MAX_DEGREE};
use crate::error::Error;
use crate::reduced::legendre::Rule;
use rapier3d::na::{DMatrix, DVector};

/// How the integrals of a matrix or a load are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quadrature {
    /// At the nodes themselves: mass matrices are diagonal and products of functions are products
    /// of nodal values.
    Nodal,
    /// Gauss–Legendre with this many points per element (at least one).
    Gauss(usize),
}

impl Axis {
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
    ///
    /// ```
    /// use rapier3d_immersed::reduced::{Axis, Quadrature};
    ///
    /// // −u″ = 1 with u = 0 at both ends: u = x (1 − x)/2, exactly, at the nodes of linear elements.
    /// let axis = Axis::elements(0.0, 1.0, 4, 1)?.with_zero_start().with_zero_end();
    /// let stiffness = axis.matrix(Quadrature::Nodal, 1, 1, |_| 1.0);
    /// let u = stiffness.lu().solve(&axis.load(Quadrature::Nodal, |_| 1.0)).unwrap();
    /// for (x, u) in axis.nodes().iter().zip(&u) {
    ///     assert!((u - 0.5 * x * (1.0 - x)).abs() < 1e-12);
    /// }
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
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
        // The polynomial goes through the stages alone, as the start carries no rate; it has its own axis.
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

#[cfg(test)]
mod tests {
    use super::*;

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

    /// Three-stage Radau IIA coefficients, Hairer & Wanner II, § IV.5, and the exact integral
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
}
