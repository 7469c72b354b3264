//! Transport along the flow.

use super::array::Array3;
use super::mac_grid::MacGrid;
use super::params::Advection;
use rayon::prelude::*;

/// Where a node sits inside its cell, in cells from the corner.
type Offset = [f64; 3];

/// Position (in cells) that the fluid at `x` left `dt` ago, by the midpoint rule.
#[inline]
pub(crate) fn trace(grid: &MacGrid, x: [f64; 3], dt: f64) -> [f64; 3] {
    let steps = dt / grid.h;
    let v = grid.velocity_in_cells(x);
    let middle = core::array::from_fn(|i| x[i] - 0.5 * steps * v[i]);
    let v = grid.velocity_in_cells(grid.sides.confine(middle, grid.cells));
    grid.sides
        .confine(core::array::from_fn(|i| x[i] - steps * v[i]), grid.cells)
}

/// `value` at every node of `shape`, in parallel; the result does not depend on the threads.
fn fill<T: Send + Copy + Default>(
    shape: &Array3,
    value: impl Fn([usize; 3]) -> T + Sync,
) -> Vec<T> {
    let [nx, ny, _] = shape.dims;
    let mut values = vec![T::default(); shape.len()];
    values
        .par_chunks_mut(nx)
        .enumerate()
        .for_each(|(row, line)| {
            for (i, to) in line.iter_mut().enumerate() {
                *to = value([i, row % ny, row / ny]);
            }
        });
    values
}

fn store(shape: &Array3, values: &[f64]) -> Array3 {
    let mut array = shape.clone();
    for (index, value) in shape.indices().zip(values) {
        array.set(index, *value);
    }
    array
}

/// Carries one quantity along the grid's flow for `dt`. `ghosts` completes intermediate fields.
pub(crate) fn advect(
    grid: &MacGrid,
    quantity: &Array3,
    offset: Offset,
    scheme: Advection,
    dt: f64,
    ghosts: impl Fn(&mut Array3),
) -> Array3 {
    let at = |index: [usize; 3]| core::array::from_fn(|i| index[i] as f64 + offset[i]);
    let nodes = |x: [f64; 3]| core::array::from_fn(|i| x[i] - offset[i]);
    let origins: Vec<[f64; 3]> = fill(quantity, |index| nodes(trace(grid, at(index), dt)));
    let number =
        |index: [usize; 3]| (index[2] * quantity.dims[1] + index[1]) * quantity.dims[0] + index[0];
    let mut once = store(
        quantity,
        &fill(quantity, |index| quantity.sample(origins[number(index)])),
    );
    if scheme == Advection::SemiLagrangian {
        return once;
    }
    ghosts(&mut once);
    let error = |index: [usize; 3]| {
        let back = once.sample(nodes(trace(grid, at(index), -dt)));
        0.5 * (quantity.get(index) - back)
    };
    // The limiter allows nothing outside the range of the values that the node came from.
    let limited = |index: [usize; 3], value: f64| {
        let (low, high) = quantity.range(origins[number(index)]);
        value.clamp(low, high)
    };
    if scheme == Advection::MacCormack {
        let values = fill(quantity, |index| {
            limited(index, once.get(index) + error(index))
        });
        return store(quantity, &values);
    }
    let mut compensated = store(
        quantity,
        &fill(quantity, |index| quantity.get(index) + error(index)),
    );
    ghosts(&mut compensated);
    let values = fill(quantity, |index| {
        limited(index, compensated.sample(origins[number(index)]))
    });
    store(quantity, &values)
}

/// The three components after `dt`, without the boundary conditions.
pub(crate) fn advect_velocity(grid: &MacGrid, dt: f64) -> [Array3; 3] {
    core::array::from_fn(|c| {
        if grid.cells[c] == 1 {
            return grid.faces[c].clone();
        }
        let mut offset = [0.5; 3];
        offset[c] = 0.0;
        advect(grid, &grid.faces[c], offset, grid.advection, dt, |field| {
            grid.sides.set_faces(c, field, grid.h, grid.time());
            grid.sides.set_ghosts(c, field, grid.h, grid.time());
        })
    })
}
