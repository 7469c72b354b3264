//! Transport of k and ε by the mean flow on the grid.

use super::KEpsilon;
use super::grid::{Advection, Array3, MacGrid, advect};
use crate::error::Error;
use rayon::prelude::*;

/// k (m²/s²) and ε (m²/s³) in the cell centers of a [`MacGrid`].
///
/// A step carries both along the flow (semi-Lagrangian: never outside the range of what was there), then
/// produces and dissipates with [`KEpsilon::advance`], then, in the full form, diffuses implicitly along one
/// axis after another. Each of the three keeps both positive for any `dt`.
///
/// ```
/// use rapier3d_immersed::turbulence::grid::{MacGrid, MacGridParams};
/// use rapier3d_immersed::turbulence::{KEpsilon, KEpsilonGrid};
///
/// let mut grid = MacGrid::new(&MacGridParams { cells: [8, 8, 1], ..MacGridParams::default() })?;
/// let mut turbulence = KEpsilonGrid::new(&grid, KEpsilon::default(), 1.0, 1.0, None)?;
/// for _ in 0..4 {
///     grid.step(0.5)?;
///     turbulence.step(&grid, 0.5)?;
/// }
/// // In fluid at rest the turbulence decays for 2 s as the model does alone.
/// let (k, _) = turbulence.at(&grid, [0.1, 0.1, 0.0]);
/// assert!((k - KEpsilon::default().advance(1.0, 1.0, 0.0, 2.0).0).abs() < 1e-9);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
pub struct KEpsilonGrid {
    model: KEpsilon,
    k: Array3,
    epsilon: Array3,
    inflow: [f64; 2],
    diffusion: Option<f64>,
}

impl KEpsilonGrid {
    /// The same k and ε everywhere on `grid`, and in what flows in.
    ///
    /// `diffusion` is the kinematic viscosity ν (m²/s) of the full form, thesis (4.15); `None` is the
    /// reduced form (4.18)–(4.19) without diffusion.
    ///
    /// # Errors
    /// If a constant is out of range, or k, ε or ν negative or not finite.
    pub fn new(
        grid: &MacGrid,
        model: KEpsilon,
        k: f64,
        epsilon: f64,
        diffusion: Option<f64>,
    ) -> Result<Self, Error> {
        model.validate()?;
        Error::check_not_negative("kinetic_energy", k)?;
        Error::check_not_negative("dissipation", epsilon)?;
        if let Some(viscosity) = diffusion {
            Error::check_not_negative("viscosity", viscosity)?;
        }
        let uniform = |value: f64| {
            let mut array = Array3::new(grid.cells, grid.cells.map(|n| n > 1));
            array.data.fill(value);
            array
        };
        Ok(Self {
            model,
            k: uniform(k),
            epsilon: uniform(epsilon),
            inflow: [k, epsilon],
            diffusion,
        })
    }

    /// Sets k and ε from their values at the cell centers (m).
    ///
    /// # Errors
    /// If a value is negative or not finite; the fields are then unchanged.
    pub fn set(
        &mut self,
        grid: &MacGrid,
        state: impl Fn([f64; 3]) -> (f64, f64),
    ) -> Result<(), Error> {
        let (mut k, mut epsilon) = (self.k.clone(), self.epsilon.clone());
        for index in self.k.indices() {
            let value = state(index.map(|i| (i as f64 + 0.5) * grid.h));
            k.set(index, Error::check_not_negative("kinetic_energy", value.0)?);
            epsilon.set(index, Error::check_not_negative("dissipation", value.1)?);
        }
        (self.k, self.epsilon) = (k, epsilon);
        Ok(())
    }

    /// Advances both by `dt` seconds in the present flow of `grid`, on which this was made.
    ///
    /// # Errors
    /// If `dt` is not positive or the grid has other dimensions.
    pub fn step(&mut self, grid: &MacGrid, dt: f64) -> Result<(), Error> {
        Error::check_positive("dt", dt)?;
        Error::check(
            "cells of the grid",
            grid.cells.iter().product::<usize>() as f64,
            grid.cells == self.k.dims,
            "those of the k–ε field",
        )?;
        self.complete(grid);
        let carry = |quantity: &Array3| {
            advect(
                grid,
                quantity,
                [0.5; 3],
                Advection::SemiLagrangian,
                dt,
                |_| {},
            )
        };
        (self.k, self.epsilon) = (carry(&self.k), carry(&self.epsilon));
        let indices: Vec<_> = self.k.indices().collect();
        let advanced: Vec<(f64, f64)> = indices
            .par_iter()
            .map(|index| {
                let (k, epsilon) = (self.k.get(*index), self.epsilon.get(*index));
                if grid.solid()[grid.cell_number(*index)] {
                    return (k, epsilon);
                }
                self.model.advance(k, epsilon, grid.strain2(*index), dt)
            })
            .collect();
        for (index, (k, epsilon)) in indices.iter().zip(advanced) {
            self.k.set(*index, k);
            self.epsilon.set(*index, epsilon);
        }
        if let Some(viscosity) = self.diffusion {
            self.diffuse(grid, viscosity, dt);
        }
        self.complete(grid);
        Ok(())
    }

    /// k and ε at a point (m), linear between the cell centers.
    pub fn at(&self, grid: &MacGrid, point: [f64; 3]) -> (f64, f64) {
        let x = grid.sides.confine(point.map(|x| x / grid.h), grid.cells);
        let x = x.map(|x| x - 0.5);
        (self.k.sample(x), self.epsilon.sample(x))
    }

    /// k and ε of the cell with `index`.
    pub fn cell(&self, index: [usize; 3]) -> (f64, f64) {
        (self.k.get(index), self.epsilon.get(index))
    }

    /// Eddy viscosity of every cell, m²/s, x fastest.
    pub fn eddy_viscosity(&self) -> Vec<f64> {
        self.k
            .indices()
            .map(|index| {
                let (k, epsilon) = self.cell(index);
                self.model.eddy_viscosity(k, epsilon)
            })
            .collect()
    }

    /// Sets the ghosts, and gives solid cells the mean of their fluid neighbors, so that nothing of what
    /// they held leaks into the flow by interpolation.
    fn complete(&mut self, grid: &MacGrid) {
        let solid = grid.solid();
        for (array, inflow) in [&mut self.k, &mut self.epsilon]
            .into_iter()
            .zip(self.inflow)
        {
            if solid.contains(&true) {
                let source = array.clone();
                for index in source.indices().filter(|i| solid[grid.cell_number(*i)]) {
                    let (mut sum, mut count) = (0.0, 0.0);
                    for axis in 0..3 {
                        for step in [-1isize, 1] {
                            let mut neighbor = index;
                            let i = index[axis].wrapping_add_signed(step);
                            if i < grid.cells[axis] {
                                neighbor[axis] = i;
                                if !solid[grid.cell_number(neighbor)] {
                                    sum += source.get(neighbor);
                                    count += 1.0;
                                }
                            }
                        }
                    }
                    if count > 0.0 {
                        array.set(index, sum / count);
                    }
                }
            }
            grid.sides.set_center_ghosts(array, inflow);
        }
    }

    /// Diffuses implicitly with ν + ν_T/σ, axis by axis: the matrix of each is a tridiagonal M-matrix, which
    /// keeps positive what is positive. Nothing diffuses through solid faces.
    fn diffuse(&mut self, grid: &MacGrid, viscosity: f64, dt: f64) {
        let mut eddy = self.k.clone();
        for ((eddy, k), epsilon) in eddy
            .data
            .iter_mut()
            .zip(&self.k.data)
            .zip(&self.epsilon.data)
        {
            *eddy = self.model.eddy_viscosity(*k, *epsilon);
        }
        let prandtl = [self.model.sigma_k, self.model.sigma_epsilon];
        let inflow = self.inflow;
        for (array, (sigma, inflow)) in [&mut self.k, &mut self.epsilon]
            .into_iter()
            .zip(prandtl.into_iter().zip(inflow))
        {
            for axis in (0..3).filter(|axis| grid.cells[*axis] > 1) {
                grid.sides.set_center_ghosts(array, inflow);
                let n = grid.cells[axis];
                let periodic = grid.sides.is_periodic(axis);
                let scale = dt / (grid.h * grid.h);
                for start in array.indices().filter(|index| index[axis] == 0) {
                    let at = |i: usize| {
                        let mut index = start;
                        index[axis] = i % n;
                        index
                    };
                    // Conductance of face i, between cells i − 1 and i.
                    let conductance: Vec<f64> = (0..=n)
                        .map(|i| {
                            let (low, high) = ((i + n - 1) % n, i % n);
                            let outside = !periodic && (i == 0 || i == n);
                            let solid = [low, high]
                                .into_iter()
                                .any(|i| grid.solid()[grid.cell_number(at(i))]);
                            if outside || solid {
                                return 0.0;
                            }
                            let nu = 0.5 * (eddy.get(at(low)) + eddy.get(at(high)));
                            (scale * (viscosity + nu / sigma)).min(WELL_MIXED)
                        })
                        .collect();
                    let mut line: Vec<f64> = (0..n).map(|i| array.get(at(i))).collect();
                    let low = line.iter().copied().fold(f64::INFINITY, f64::min);
                    let high = line.iter().copied().fold(0.0, f64::max);
                    solve_line(&conductance, &mut line);
                    for (i, value) in line.into_iter().enumerate() {
                        // Rounding could break the maximum principle.
                        array.set(at(i), value.clamp(low, high));
                    }
                }
            }
        }
    }
}

/// Diffusion number ν_T dt/h² beyond which a line is mixed completely within one step anyway, and
/// more would only drown its mean in rounding.
const WELL_MIXED: f64 = 1.0e8;

/// Solves x_i + c_i (x_i − x_{i−1}) + c_{i+1} (x_i − x_{i+1}) = f_i, periodic if c_0 = c_n ≠ 0, by
/// elimination (Thomas) with the Sherman–Morrison correction.
fn solve_line(conductance: &[f64], f: &mut [f64]) {
    let n = f.len();
    let wrap = conductance[0];
    let mut diagonal: Vec<f64> = (0..n)
        .map(|i| 1.0 + conductance[i] + conductance[i + 1])
        .collect();
    // The periodic corners are a matrix of rank one, with γ = −diagonal[0], plus changes of two diagonal
    // entries.
    let gamma = -diagonal[0];
    let mut correction = vec![0.0; n];
    if wrap > 0.0 {
        diagonal[0] -= gamma;
        diagonal[n - 1] -= wrap * wrap / gamma;
        correction[0] = gamma;
        correction[n - 1] = -wrap;
    }
    let mut previous = diagonal[0];
    for i in 1..n {
        let factor = conductance[i] / previous;
        previous = diagonal[i] - factor * conductance[i];
        diagonal[i] = previous;
        f[i] += factor * f[i - 1];
        correction[i] += factor * correction[i - 1];
    }
    for x in [&mut *f, &mut correction] {
        x[n - 1] /= diagonal[n - 1];
        for i in (0..n - 1).rev() {
            x[i] = (x[i] + conductance[i + 1] * x[i + 1]) / diagonal[i];
        }
    }
    if wrap > 0.0 {
        let ratio = -wrap / gamma;
        let share = (f[0] + ratio * f[n - 1]) / (1.0 + correction[0] + ratio * correction[n - 1]);
        for (x, correction) in f.iter_mut().zip(&correction) {
            *x -= share * correction;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::turbulence::grid::MacGridParams;

    /// Both kinds of lines solve their equations.
    #[test]
    fn lines_are_solved_to_rounding() {
        for wrap in [0.0, 0.7] {
            let mut c = [0.3, 1.4, 0.0, 5.0, 2.0, 0.9, 0.1];
            c[0] = wrap;
            c[6] = wrap;
            let f = [1.0, -2.0, 0.5, 3.0, 0.0, 4.0];
            let mut x = f;
            solve_line(&c, &mut x);
            for i in 0..6 {
                let (low, high) = ((i + 5) % 6, (i + 1) % 6);
                let sum = x[i] + c[i] * (x[i] - x[low]) + c[i + 1] * (x[i] - x[high]);
                assert!((sum - f[i]).abs() < 1.0e-12, "{wrap}: {sum} {}", f[i]);
            }
        }
    }

    /// Diffusion alone conserves the integral of k in a periodic box and shrinks its variance.
    #[test]
    fn diffusion_conserves_and_smooths() {
        let grid = MacGrid::new(&MacGridParams {
            cells: [16, 12, 1],
            cell_size: 0.1,
            ..MacGridParams::default()
        })
        .unwrap();
        let model = KEpsilon::default();
        let mut field = KEpsilonGrid::new(&grid, model, 1.0, 1.0, Some(0.01)).unwrap();
        field
            .set(&grid, |x| {
                (1.0 + 0.8 * (x[0] * 4.0).sin() * x[1].cos(), 0.7)
            })
            .unwrap();
        let moments = |field: &KEpsilonGrid| {
            let values: Vec<f64> = field.k.indices().map(|i| field.k.get(i)).collect();
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let spread = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
            (mean, spread)
        };
        let before = moments(&field);
        field.diffuse(&grid, 0.01, 0.5);
        let after = moments(&field);
        assert!((after.0 / before.0 - 1.0).abs() < 1.0e-12);
        assert!(after.1 < 0.5 * before.1);
        assert!(field.k.indices().all(|i| field.k.get(i) > 0.0));
    }
}
