//! The factored Laplacians of the viscous step.

use super::boundary::Sides;
use super::separable::Separable;

/// Shape of the unknowns of component `c`: faces that no boundary prescribes.
pub(super) fn unknowns(c: usize, cells: [usize; 3], sides: &Sides) -> ([usize; 3], [usize; 3]) {
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
