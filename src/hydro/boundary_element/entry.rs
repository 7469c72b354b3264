//! The ways into the solver.

use super::params::{
    BoundaryElementParams, BoundaryElementReport, BoundaryElementSolution, ProgressFn,
};
use super::refine::{self, Body};
use crate::error::Error;
use crate::geometry::{Sheet, Surface};
use crate::hydro::AddedMass;

impl AddedMass {
    /// Added mass per unit density of the body inside a closed surface, about the **centroid of its
    /// volume** ([`AddedMass::about`] moves it), in the axes of its vertices.
    ///
    /// The polyhedron itself is what is solved for: refinement divides its triangles and does not
    /// know of a smooth shape that they may stand for.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] names a parameter; [`Error::DegenerateTriangle`] and
    /// [`Error::SelfIntersection`] name triangles; [`Error::TooManyPanels`] if the mesh itself is
    /// larger than [`BoundaryElementParams::max_panels`]. A solve that does not converge is no error; the
    /// report says so.
    pub fn solve(
        surface: &Surface,
        params: &BoundaryElementParams,
    ) -> Result<(Self, BoundaryElementReport), Error> {
        let solution = BoundaryElementSolution::of_surface(surface, params, &|_| ())?;
        Ok((solution.added_mass, solution.report))
    }

    /// Added mass per unit density of a sheet, about its **center of area**.
    ///
    /// This is the limit of zero thickness, where motions in the plane of a flat sheet meet no fluid. A real
    /// plate of thickness t has more, by some t/c ln(c/t) of a chord c: 1 % at t/c = 1/500.
    ///
    /// # Errors
    /// Those of [`AddedMass::solve`].
    pub fn solve_sheet(
        sheet: &Sheet,
        params: &BoundaryElementParams,
    ) -> Result<(Self, BoundaryElementReport), Error> {
        let solution = BoundaryElementSolution::of_sheet(sheet, params, &|_| ())?;
        Ok((solution.added_mass, solution.report))
    }
}

impl BoundaryElementSolution {
    /// [`AddedMass::solve`] with progress and potentials.
    ///
    /// # Errors
    /// Those of [`AddedMass::solve`].
    pub fn of_surface(
        surface: &Surface,
        params: &BoundaryElementParams,
        progress: ProgressFn,
    ) -> Result<Self, Error> {
        params.check()?;
        refine::adaptively(Body::Closed(surface.clone()), params, progress)
    }

    /// [`AddedMass::solve_sheet`] with progress and potentials.
    ///
    /// # Errors
    /// Those of [`AddedMass::solve`].
    pub fn of_sheet(
        sheet: &Sheet,
        params: &BoundaryElementParams,
        progress: ProgressFn,
    ) -> Result<Self, Error> {
        params.check()?;
        refine::adaptively(Body::Sheet(sheet.clone()), params, progress)
    }

    /// Solves for the limit of ever finer meshes of one body that the caller provides, such as a
    /// curved surface: `mesh(0)`, `mesh(1)` … until their difference meets the tolerance. Each should
    /// have about twice the panels of the one before.
    ///
    /// # Errors
    /// Those of [`AddedMass::solve`] and of `mesh`.
    pub fn of_meshes(
        mut mesh: impl FnMut(usize) -> Result<Surface, Error>,
        params: &BoundaryElementParams,
        progress: ProgressFn,
    ) -> Result<Self, Error> {
        params.check()?;
        refine::by_family(params, progress, |level| mesh(level).map(Body::Closed))
    }

    /// [`BoundaryElementSolution::of_meshes`] for sheets.
    ///
    /// # Errors
    /// Those of [`AddedMass::solve`] and of `mesh`.
    pub fn of_sheets(
        mut mesh: impl FnMut(usize) -> Result<Sheet, Error>,
        params: &BoundaryElementParams,
        progress: ProgressFn,
    ) -> Result<Self, Error> {
        params.check()?;
        refine::by_family(params, progress, |level| mesh(level).map(Body::Sheet))
    }
}
