//! One step of the flow: advection, diffusion, projection.

use super::advection;
use super::array::Array3;
use super::diffusion;
use super::mac_grid::MacGrid;
use super::params::{StepReport, Viscosity};
use crate::error::Error;

impl MacGrid {
    /// Advances the flow by `dt` seconds.
    ///
    /// # Errors
    /// If `dt` is not positive, so large that the fluid would cross more cells than there are, or,
    /// with explicit diffusion, unstable (ν dt Σ 1/h² > ½). The flow is then unchanged.
    pub fn step(&mut self, dt: f64) -> Result<StepReport, Error> {
        Error::check_positive("dt", dt)?;
        let courant = self.courant(dt);
        let widest = self.cells.into_iter().max().unwrap_or(1) as f64;
        Error::check(
            "Courant number",
            courant,
            courant <= widest,
            "at most the number of cells: use a shorter dt",
        )?;
        let dimensions = self.cells.iter().filter(|n| **n > 1).count() as f64;
        let diffusion_number = self.viscosity * dt * dimensions / (self.h * self.h);
        if self.viscous_step == Viscosity::Explicit {
            Error::check(
                "ν dt Σ 1/h²",
                diffusion_number,
                diffusion_number <= 0.5,
                "at most 1/2 for explicit diffusion",
            )?;
        }
        self.faces = advection::advect_velocity(self, dt);
        self.time += dt;
        self.apply_boundaries();
        if self.viscosity > 0.0 {
            diffusion::diffuse(self, dt);
            self.apply_boundaries();
        }
        if let Some(eddy) = self.eddy_viscosity.take() {
            diffusion::diffuse_eddies(self, &eddy, dt);
            self.apply_boundaries();
            self.eddy_viscosity = Some(eddy);
        }
        let mut report = self.project();
        report.courant = courant;
        Ok(report)
    }

    /// Removes the divergence.
    pub(super) fn project(&mut self) -> StepReport {
        let mut divergence = self.divergence();
        let (iterations, converged) = self.projection.solve(&mut divergence, &self.solid);
        subtract_gradient(self, &divergence);
        self.apply_boundaries();
        let speed = self.max_speed();
        let left = self.max_divergence();
        StepReport {
            divergence: if speed > 0.0 {
                left * self.h / speed
            } else {
                0.0
            },
            iterations,
            converged,
            courant: 0.0,
        }
    }
}

/// Subtracts the gradient of `pressure` from the faces between fluid cells and at open ends.
fn subtract_gradient(grid: &mut MacGrid, pressure: &[f64]) {
    for c in (0..3).filter(|c| grid.cells[*c] > 1) {
        let n = grid.cells[c];
        let (first, count) = grid.sides.unknown_faces(c, n);
        let mut faces = core::mem::replace(&mut grid.faces[c], Array3::new([1; 3], [false; 3]));
        for index in faces.indices() {
            let face = index[c];
            if face < first || face >= first + count {
                continue;
            }
            let cell = |i: usize| {
                let mut cell = index;
                cell[c] = i;
                grid.cell_number(cell)
            };
            let (low, high) = if grid.sides.is_periodic(c) {
                (Some(cell((face + n - 1) % n)), Some(cell(face % n)))
            } else {
                (
                    (face > 0).then(|| cell(face - 1)),
                    (face < n).then(|| cell(face)),
                )
            };
            let solid = [low, high]
                .into_iter()
                .flatten()
                .any(|cell| grid.solid()[cell]);
            if solid {
                continue;
            }
            let slope = match (low, high) {
                (Some(low), Some(high)) => pressure[high] - pressure[low],
                (Some(low), None) => -2.0 * pressure[low],
                (None, Some(high)) => 2.0 * pressure[high],
                (None, None) => 0.0,
            };
            let at = faces.position(index);
            faces.data[at] -= slope / grid.h;
        }
        grid.faces[c] = faces;
    }
}
