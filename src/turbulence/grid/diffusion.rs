//! The viscous step.

use super::mac_grid::MacGrid;
use super::params::Viscosity;
use super::viscosity::unknowns;

/// Diffuses for `dt`. Boundaries and ghosts must have been applied.
///
/// The unknown is the change of the velocity, which is zero where the velocity is prescribed, so that the
/// boundary values enter through the ghosts alone. Inside an obstacle the caller keeps the velocity at
/// zero, to first order in dt.
pub(super) fn diffuse(grid: &mut MacGrid, dt: f64) {
    let amount = grid.viscosity * dt;
    for c in 0..3 {
        let Some(solver) = &grid.diffusion[c] else {
            continue;
        };
        let (first, dims) = unknowns(c, grid.cells, &grid.sides);
        let faces = &mut grid.faces[c];
        let positions = || {
            let [nx, ny, nz] = dims;
            (0..nz).flat_map(move |k| {
                (0..ny).flat_map(move |j| {
                    (0..nx).map(move |i| [i + first[0], j + first[1], k + first[2]])
                })
            })
        };
        let mut change: Vec<f64> = positions()
            .map(|index| {
                let at = faces.position(index);
                let sum: f64 = (0..3)
                    .filter(|axis| grid.cells[*axis] > 1)
                    .map(|axis| {
                        let step = faces.stride[axis];
                        faces.data[at + step] + faces.data[at - step] - 2.0 * faces.data[at]
                    })
                    .sum();
                amount * sum / (grid.h * grid.h)
            })
            .collect();
        match grid.viscous_step {
            Viscosity::Explicit => {}
            Viscosity::Implicit => solver.solve(1.0, amount, &mut change),
            Viscosity::CrankNicolson => solver.solve(1.0, 0.5 * amount, &mut change),
        }
        for (index, change) in positions().zip(&change) {
            let at = faces.position(index);
            faces.data[at] += change;
        }
    }
}

/// Diffuses explicitly for `dt` with an eddy viscosity per cell (m²/s), as ∇·(ν_T ∇u).
///
/// The eddy viscosity is cut off at a diffusion number of .15 per axis, where explicit diffusion is stable in
/// three dimensions: beyond it a cell is mixed with its neighbors within a few steps anyway.
pub(super) fn diffuse_eddies(grid: &mut MacGrid, eddy: &[f64], dt: f64) {
    let scale = dt / (grid.h * grid.h);
    let number = |cell: [usize; 3]| (scale * eddy[grid.cell_number(cell)]).min(0.15);
    let changes: Vec<Vec<([usize; 3], f64)>> = (0..3)
        .filter(|c| grid.cells[*c] > 1)
        .map(|c| {
            let (first, dims) = unknowns(c, grid.cells, &grid.sides);
            let faces = &grid.faces[c];
            let n = grid.cells[c];
            // Diffusion numbers of the two cells beside a face; an end counts its one cell twice.
            let beside = |index: [usize; 3]| {
                let (mut low, mut high) = (index, index);
                let periodic = grid.sides.is_periodic(c);
                low[c] = match (index[c], periodic) {
                    (0, true) => n - 1,
                    (0, false) => 0,
                    (i, _) => i - 1,
                };
                high[c] = match (index[c] == n, periodic) {
                    (true, true) => 0,
                    (true, false) => n - 1,
                    (false, _) => index[c],
                };
                (number(low), number(high))
            };
            let mean = |index: [usize; 3]| {
                let (low, high) = beside(index);
                0.5 * (low + high)
            };
            faces
                .indices()
                .filter(|index| (0..3).all(|i| (first[i]..first[i] + dims[i]).contains(&index[i])))
                .map(|index| {
                    let at = faces.position(index);
                    let here = mean(index);
                    let mut change = 0.0;
                    for axis in (0..3).filter(|axis| grid.cells[*axis] > 1) {
                        let step = faces.stride[axis];
                        let (below, above) = if axis == c {
                            beside(index)
                        } else {
                            let m = grid.cells[axis];
                            let periodic = grid.sides.is_periodic(axis);
                            let side = |up: bool| {
                                let mut other = index;
                                other[axis] = match (index[axis], up, periodic) {
                                    (i, true, true) => (i + 1) % m,
                                    (i, true, false) => (i + 1).min(m - 1),
                                    (i, false, true) => (i + m - 1) % m,
                                    (i, false, false) => i.saturating_sub(1),
                                };
                                0.5 * (here + mean(other))
                            };
                            (side(false), side(true))
                        };
                        let u = &faces.data;
                        change += above * (u[at + step] - u[at]) - below * (u[at] - u[at - step]);
                    }
                    (index, change)
                })
                .collect()
        })
        .collect();
    let active: Vec<usize> = (0..3).filter(|c| grid.cells[*c] > 1).collect();
    for (c, changes) in active.into_iter().zip(changes) {
        for (index, change) in changes {
            let at = grid.faces[c].position(index);
            grid.faces[c].data[at] += change;
        }
    }
}
