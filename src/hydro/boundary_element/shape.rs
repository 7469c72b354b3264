//! The added mass of rapier's shapes, meshed as finely as an accuracy asks for.

use super::params::{
    BoundaryElementParams, BoundaryElementReport, BoundaryElementSolution, ProgressFn,
};
use crate::error::Error;
use crate::geometry::{Ellipsoid, Surface};
use crate::hydro::AddedMass;
use rapier3d::math::Vector;
use rapier3d::na::Vector3;
use rapier3d::parry::shape::{Shape, TypedShape};

/// Cells of the first mesh of a primitive, see [`Surface::panelled`].
const FIRST_CELLS: usize = 6;

impl AddedMass {
    /// Added mass per unit density of a shape, about `reference_point` (m, shape's frame; a body's
    /// center of mass) in the shape's axes, to a relative error `tolerance`.
    ///
    /// A ball is exact. Boxes, cylinders, cones, capsules and compounds of them are meshed finer
    /// until the tolerance is met; any other shape is refined as the polyhedron that it is.
    ///
    /// # Errors
    /// Those of [`Surface::from_shape`] and [`AddedMass::solve`]. An open triangle mesh has no
    /// inside: make a [`Sheet`](crate::geometry::Sheet) of it. Parts of a compound that touch or
    /// overlap are a [`Error::SelfIntersection`].
    pub fn of_shape(
        shape: &dyn Shape,
        reference_point: Vector,
        tolerance: f64,
    ) -> Result<(Self, BoundaryElementReport), Error> {
        let params = BoundaryElementParams {
            tolerance,
            ..BoundaryElementParams::default()
        };
        params.check()?;
        let reference = crate::math::to_f64(reference_point);
        let names = [
            "reference_point.x",
            "reference_point.y",
            "reference_point.z",
        ];
        for (parameter, value) in names.into_iter().zip(reference.iter()) {
            Error::check_finite(parameter, *value)?;
        }
        if let TypedShape::Ball(ball) = shape.as_typed_shape() {
            let radius = Error::check_positive("radius", ball.radius.into())?;
            let ball = Ellipsoid {
                semi_axes: Vector3::repeat(radius),
            };
            let report = BoundaryElementReport {
                panels: 0,
                unknowns: 0,
                estimated_error: Some(0.0),
                converged: true,
                asymmetry: 0.0,
                definite: true,
                history: Vec::new(),
            };
            return Ok((ball.added_mass().about(reference), report));
        }
        let solution = BoundaryElementSolution::of_shape(shape, &params, &|_| ())?;
        let about = solution.added_mass.about(reference - solution.center);
        Ok((about, solution.report))
    }
}

impl BoundaryElementSolution {
    /// Solves for the shape of a collider, in its own frame, with progress and potentials.
    ///
    /// # Errors
    /// Those of [`AddedMass::of_shape`].
    pub fn of_shape(
        shape: &dyn Shape,
        params: &BoundaryElementParams,
        progress: ProgressFn,
    ) -> Result<Self, Error> {
        params.check()?;
        if !Surface::follows_cells(shape) {
            return Self::of_surface(&Surface::panelled_as_is(shape)?, params, progress);
        }
        let mesh = |level| Surface::panelled(shape, cells(level));
        Self::of_meshes(mesh, params, progress)
    }
}

/// Cells of each mesh: half as many again as the one before, 6, 9, 14, 21, 32 …
pub(super) fn cells(level: usize) -> usize {
    (0..level).fold(FIRST_CELLS, |cells, _| cells + cells.div_ceil(2))
}
