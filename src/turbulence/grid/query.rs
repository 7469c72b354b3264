//! What can be asked of the flow.

use super::array::Array3;
use super::mac_grid::MacGrid;
use crate::error::Error;
use crate::flow::GridFlow;
use rapier3d::math::{Real, Vector};

impl MacGrid {
    /// Largest speed along an axis, m/s.
    pub fn max_speed(&self) -> f64 {
        self.faces
            .iter()
            .flat_map(|faces| faces.indices().map(|index| faces.get(index).abs()))
            .fold(0.0, f64::max)
    }

    /// Velocity (m/s) at a point (m), linear between the faces; clamped or periodic outside.
    pub fn velocity(&self, point: [f64; 3]) -> [f64; 3] {
        let x = self.sides.confine(point.map(|x| x / self.h), self.cells);
        self.velocity_in_cells(x)
    }

    /// Whether the cell around a point (m) is solid.
    pub fn is_solid(&self, point: [f64; 3]) -> bool {
        let x = self.sides.confine(point.map(|x| x / self.h), self.cells);
        let index = core::array::from_fn(|i| (x[i] as usize).min(self.cells[i] - 1));
        self.solid[self.cell_number(index)]
    }

    /// Largest divergence in a fluid cell, 1/s.
    pub fn max_divergence(&self) -> f64 {
        let divergence = self.divergence();
        divergence.iter().fold(0.0, |max, d| d.abs().max(max))
    }

    /// 2 S:S of the cell with `index`, 1/s²: twice the squared rate of strain, which produces turbulence.
    pub fn strain2(&self, index: [usize; 3]) -> f64 {
        let mut gradient = [[0.0; 3]; 3];
        for (c, faces) in self.faces.iter().enumerate() {
            if self.cells[c] == 1 {
                continue;
            }
            let low = faces.position(index);
            let high = low + faces.stride[c];
            for (a, slope) in gradient[c].iter_mut().enumerate() {
                let step = faces.stride[a];
                *slope = if self.cells[a] == 1 {
                    0.0
                } else if a == c {
                    (faces.data[high] - faces.data[low]) / self.h
                } else {
                    let d = |at: usize| faces.data[at + step] - faces.data[at - step];
                    (d(low) + d(high)) / (4.0 * self.h)
                };
            }
        }
        let mut sum = 0.0;
        for (i, row) in gradient.iter().enumerate() {
            for (j, slope) in row.iter().enumerate() {
                sum += (slope + gradient[j][i]).powi(2) / 4.0;
            }
        }
        2.0 * sum
    }

    /// The flow as it is now, for bodies: sampled at the cell centers, with the grid's corner at `corner`.
    ///
    /// # Errors
    /// If the flow left the range of `f32`.
    pub fn to_grid_flow(&self, corner: Vector) -> Result<GridFlow, Error> {
        let velocities: Vec<_> = Array3::new(self.cells, [false; 3])
            .indices()
            .map(|index| {
                let x = index.map(|i| i as f64 + 0.5);
                Vector::from_array(self.velocity_in_cells(x).map(|x| x as Real))
            })
            .collect();
        let h = self.h as Real;
        let periodic = core::array::from_fn(|i| self.sides.is_periodic(i) && self.cells[i] > 1);
        GridFlow::new(
            self.cells,
            periodic,
            corner + Vector::ONE * (0.5 * h),
            Vector::ONE * h,
            &velocities,
        )
    }
}
