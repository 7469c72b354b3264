//! The viscous step.

use super::{MacGrid, Separable, Sides};

/// How velocity diffuses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Viscosity {
    /// Forward Euler: cheap, stable only for ν dt Σ 1/h² ≤ ½.
    Explicit,
    /// Backward Euler: stable for any step, first order in time. The default.
    #[default]
    Implicit,
    /// The trapezoidal rule: stable, second order in time.
    CrankNicolson,
}

/// Shape of the unknowns of component `c`: faces that no boundary prescribes.
fn unknowns(c: usize, cells: [usize; 3], sides: &Sides) -> ([usize; 3], [usize; 3]) {
    let (mut first, mut dims) = ([0; 3], cells);
    (first[c], dims[c]) = sides.unknown_faces(c, cells[c]);
    (first, dims)
}

/// The factored Laplacians of the three components; none without viscosity.
pub(super) fn solvers(
    viscosity: f64,
    cells: [usize; 3],
    h: f64,
    sides: &Sides,
) -> [Option<Separable>; 3] {
    core::array::from_fn(|c| {
        (viscosity > 0.0 && cells[c] > 1).then(|| {
            let (_, dims) = unknowns(c, cells, sides);
            let ends = core::array::from_fn(|axis| sides.velocity_ends(c, axis));
            Separable::new(dims, h, ends)
        })
    })
}

/// Diffuses for `dt`. Boundaries and ghosts must have been applied.
///
/// Solved for the change of the velocity, which is zero where the velocity is prescribed: so the
/// boundary values enter through the ghosts alone. Inside an obstacle the velocity is kept at zero
/// by the caller, to first order in dt.
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
