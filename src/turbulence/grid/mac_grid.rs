//! The grid and what is on it.

use super::array::Array3;
use super::boundary::Sides;
use super::params::{Advection, MacGridParams, Viscosity};
use super::projection::Projection;
use super::separable::Separable;
use super::viscosity;
use crate::error::Error;

/// An incompressible flow on a grid.
///
/// ```
/// use rapier3d_immersed::flow::Flow;
/// use rapier3d_immersed::rapier3d::prelude::*;
/// use rapier3d_immersed::turbulence::grid::{MacGrid, MacGridParams};
/// use std::f64::consts::TAU;
///
/// // Taylor–Green vortices in a periodic square of 1 m decay with exp(−2ν(2π)²t).
/// let params = MacGridParams {
///     cells: [32, 32, 1],
///     viscosity: 0.05,
///     ..MacGridParams::default()
/// };
/// let mut grid = MacGrid::new(&params)?;
/// let (sin, cos) = (|x: f64| (TAU * x).sin(), |x: f64| (TAU * x).cos());
/// grid.set_velocity(|[x, y, _]| [sin(x) * cos(y), -cos(x) * sin(y), 0.0])?;
/// for _ in 0..20 {
///     let report = grid.step(0.01)?;
///     assert!(report.divergence < 1e-10);
/// }
/// let decay = (-2.0 * 0.05 * TAU * TAU * 0.2).exp();
/// assert!((grid.velocity([0.25, 0.0, 0.0])[0] / decay - 1.0).abs() < 0.05);
/// // Bodies can be immersed in the flow as it is now.
/// let flow = grid.to_grid_flow(Vector::ZERO)?;
/// assert!((f64::from(flow.velocity(Vector::X * 0.25, 0.0).x) / decay - 1.0).abs() < 0.06);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
pub struct MacGrid {
    pub(crate) cells: [usize; 3],
    pub(crate) h: f64,
    pub(crate) sides: Sides,
    /// Components on faces: `faces[c]` has one node more than there are cells along c.
    pub(crate) faces: [Array3; 3],
    pub(super) solid: Vec<bool>,
    pub(super) eddy_viscosity: Option<Vec<f64>>,
    pub(super) viscosity: f64,
    pub(super) advection: Advection,
    pub(super) viscous_step: Viscosity,
    pub(super) projection: Projection,
    pub(super) diffusion: [Option<Separable>; 3],
    pub(super) time: f64,
}

impl MacGrid {
    /// Fluid at rest in a box with a corner at the origin.
    ///
    /// # Errors
    /// If a dimension is not 1 to 512 (periodic axes: 1 or at least 3), a size not positive, the viscosity
    /// negative, an axis periodic at one end only, or an inactive axis not periodic or free-slip.
    pub fn new(params: &MacGridParams) -> Result<Self, Error> {
        for n in params.cells {
            Error::check(
                "cells",
                n as f64,
                n == 1 || (3..=512).contains(&n),
                "1 or from 3 to 512 along each axis",
            )?;
        }
        Error::check_positive("cell_size", params.cell_size)?;
        Error::check_positive("1/cell_size²", params.cell_size.powi(-2))?;
        Error::check_not_negative("viscosity", params.viscosity)?;
        let cells = params.cells;
        let active = cells.map(|n| n > 1);
        let sides = Sides::new(params.boundaries.clone(), active)?;
        let faces: [Array3; 3] = core::array::from_fn(|c| {
            let mut dims = cells;
            dims[c] += usize::from(active[c]);
            Array3::new(dims, active)
        });
        let projection = Projection::new(cells, params.cell_size, &sides);
        let diffusion = viscosity::solvers(params.viscosity, cells, params.cell_size, &sides);
        let mut grid = Self {
            cells,
            h: params.cell_size,
            sides,
            faces,
            solid: vec![false; cells.iter().product()],
            eddy_viscosity: None,
            viscosity: params.viscosity,
            advection: params.advection,
            viscous_step: params.viscous_step,
            projection,
            diffusion,
            time: 0.0,
        };
        grid.apply_boundaries();
        Ok(grid)
    }

    /// Sets the velocity (m/s) from its value at points (m), then removes its divergence.
    ///
    /// # Errors
    /// If a value is not finite; the flow is then unchanged.
    pub fn set_velocity(&mut self, velocity: impl Fn([f64; 3]) -> [f64; 3]) -> Result<(), Error> {
        let mut faces = self.faces.clone();
        for c in (0..3).filter(|c| self.cells[*c] > 1) {
            for index in faces[c].indices() {
                let value = velocity(self.face_center(c, index))[c];
                faces[c].set(index, Error::check_finite("velocity", value)?);
            }
        }
        self.faces = faces;
        self.apply_boundaries();
        self.project();
        Ok(())
    }

    /// Makes the cells whose centers (m) are inside an obstacle solid and at rest.
    ///
    /// # Errors
    /// If no fluid cell is left.
    pub fn set_obstacle(&mut self, inside: impl Fn([f64; 3]) -> bool) -> Result<(), Error> {
        let solid: Vec<bool> = Array3::new(self.cells, [false; 3])
            .indices()
            .map(|index| inside(index.map(|i| (i as f64 + 0.5) * self.h)))
            .collect();
        let fluid = solid.iter().filter(|solid| !**solid).count();
        Error::check(
            "number of fluid cells",
            fluid as f64,
            fluid > 0,
            "positive: the obstacle fills the box",
        )?;
        self.solid = solid;
        self.projection.set_obstacle(&self.solid, &self.sides);
        self.apply_boundaries();
        self.project();
        Ok(())
    }

    /// Lets unresolved turbulence mix the flow from now on: an eddy viscosity (m²/s) per cell, x
    /// fastest, on top of the fluid's own.
    ///
    /// # Errors
    /// If the number of values is not that of the cells, or one is negative or not finite.
    pub fn set_eddy_viscosity(&mut self, eddy_viscosity: Vec<f64>) -> Result<(), Error> {
        Error::check(
            "number of eddy viscosities",
            eddy_viscosity.len() as f64,
            eddy_viscosity.len() == self.solid.len(),
            "the number of cells",
        )?;
        for value in &eddy_viscosity {
            Error::check_not_negative("eddy_viscosity", *value)?;
        }
        self.eddy_viscosity = Some(eddy_viscosity);
        Ok(())
    }

    /// Time since the flow was created, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Cells along each axis.
    pub fn cells(&self) -> [usize; 3] {
        self.cells
    }

    /// Edge of a cell, m.
    pub fn cell_size(&self) -> f64 {
        self.h
    }

    /// Velocity at `x`, in cells from the corner.
    pub(crate) fn velocity_in_cells(&self, x: [f64; 3]) -> [f64; 3] {
        core::array::from_fn(|c| {
            if self.cells[c] == 1 {
                return 0.0;
            }
            let mut at = x.map(|x| x - 0.5);
            at[c] = x[c];
            self.faces[c].sample(at)
        })
    }

    /// Center of a face, m.
    pub(crate) fn face_center(&self, c: usize, index: [usize; 3]) -> [f64; 3] {
        core::array::from_fn(|i| {
            let offset = if i == c && self.cells[i] > 1 {
                0.0
            } else {
                0.5
            };
            (index[i] as f64 + offset) * self.h
        })
    }

    pub(crate) fn cell_number(&self, index: [usize; 3]) -> usize {
        (index[2] * self.cells[1] + index[1]) * self.cells[0] + index[0]
    }

    pub(crate) fn solid(&self) -> &[bool] {
        &self.solid
    }

    pub(super) fn courant(&self, dt: f64) -> f64 {
        self.max_speed() * dt / self.h
    }

    /// Divergence of the fluid cells, 1/s; 0 in solid ones.
    pub(super) fn divergence(&self) -> Vec<f64> {
        Array3::new(self.cells, [false; 3])
            .indices()
            .zip(&self.solid)
            .map(|(index, solid)| {
                let sum: f64 = (0..3)
                    .filter(|c| self.cells[*c] > 1)
                    .map(|c| {
                        let faces = &self.faces[c];
                        let low = faces.position(index);
                        faces.data[low + faces.stride[c]] - faces.data[low]
                    })
                    .sum();
                if *solid { 0.0 } else { sum / self.h }
            })
            .collect()
    }

    /// Sets boundary faces, solid faces and ghosts.
    pub(super) fn apply_boundaries(&mut self) {
        for c in 0..3 {
            self.sides
                .set_faces(c, &mut self.faces[c], self.h, self.time);
        }
        self.clear_solid_faces();
        for c in 0..3 {
            self.sides
                .set_ghosts(c, &mut self.faces[c], self.h, self.time);
        }
    }

    fn clear_solid_faces(&mut self) {
        if !self.solid.contains(&true) {
            return;
        }
        let cells = Array3::new(self.cells, [false; 3]);
        for (index, solid) in cells.indices().zip(&self.solid) {
            for c in (0..3).filter(|c| *solid && self.cells[*c] > 1) {
                self.faces[c].set(index, 0.0);
                let mut next = index;
                next[c] += 1;
                self.faces[c].set(next, 0.0);
                if self.sides.is_periodic(c) {
                    // Faces 0 and n are the same one.
                    let n = self.cells[c];
                    for (a, b) in [(0, n), (n, 0)] {
                        if index[c] == a || next[c] == a {
                            let mut twin = index;
                            twin[c] = b;
                            self.faces[c].set(twin, 0.0);
                        }
                    }
                }
            }
        }
    }
}
