//! Added mass of any shape by boundary elements.
//!
//! [`HydroProperties::from_shape_with`](super::HydroProperties::from_shape_with) and
//! [`Accuracy::Mesh`](super::Accuracy) are all that most users need. Below that, [`AddedMass::of_shape`]
//! takes a collider's shape and a tolerance, [`AddedMass::solve`] a closed mesh, [`AddedMass::solve_sheet`]
//! an open one with a thickness; each gives the whole tensor, couplings included. An [`AddedMassCache`]
//! solves equal shapes once, and a [`BoundaryElementSolution`] also holds the potentials on the mesh.
//!
//! ```
//! use rapier3d_immersed::AddedMass;
//! use rapier3d_immersed::rapier3d::prelude::*;
//!
//! let (cube, report) = AddedMass::of_shape(&Cuboid::new(Vector::splat(0.5)), Vector::ZERO, 0.02)?;
//! assert!(report.converged);
//! // 0.639 of the displaced volume.
//! assert!((cube.linear[(0, 0)] - 0.639).abs() < 0.01);
//! # Ok::<(), rapier3d_immersed::Error>(())
//! ```
//!
//! The method is a Galerkin discretisation of the hypersingular operator with continuous, piecewise
//! linear potentials. Its integrals reduce to those of 1/|x − y| over pairs of triangles, done
//! exactly on one and adaptively on the other; the matrix is symmetric and positive, so that the
//! added mass converges from one side with twice the order of the potential; and nothing degenerates
//! when two faces approach: a leaf needs no more panels than a ball.
//!
//! # Thin bodies
//! A closed surface is solved as such however thin it is: an ellipsoid 10⁻⁵ as thick as long, on 1280
//! panels, is right to 0.2 % broadside. There is no thickness at which to switch to another formulation, and
//! none is switched to; [`Sheet`] is for meshes that have no thickness to begin with. What thin
//! bodies do lose is the relative accuracy of entries that are tiny beside the others: the added mass
//! of a leaf in its own plane, 10⁻⁴ of the broadside one, is right in its order of magnitude only.
//!
//! # When the proxy ellipsoid will do
//! See the table at [`Accuracy`](super::Accuracy), by which
//! [`HydroProperties::from_shape_with`](super::HydroProperties::from_shape_with) solves.
//!
//! # Cost
//! There are half as many unknowns as panels. Processor time on one core (divide by the cores) for a ball of
//! 320, 1280, 5120 and 9680 panels: 0.010, 0.09, 1.4 and 4.9 s, growing as panels to the power 1.6,
//! 1.9, 2.0; a leaf takes about twice as long. It needs `4 × panels²` bytes, 100 MB for 5000 panels.
//!
//! The solve is direct. Even at 9680 panels the factorisation is an eighth of the work and the rest
//! is integration, so that an iterative solver would gain next to nothing; going further needs a
//! compressed matrix, and by then the error of the added mass is far below that of the shape.

mod assemble;
mod cache;
mod pair;
mod panel;
mod properties;
mod refine;
mod shape;
mod solve;

pub use cache::{AddedMassCache, SolvedShape};

use crate::error::Error;
use crate::geometry::{Sheet, Surface};
use crate::hydro::AddedMass;
use rapier3d::na::Vector3;
use refine::Body;

/// How well, and how large, to solve.
///
/// ```
/// use rapier3d_immersed::AddedMass;
/// use rapier3d_immersed::boundary_element::BoundaryElementParams;
/// use rapier3d_immersed::geometry::Sheet;
///
/// let disc = Sheet::elliptic_disc(1.0, 1.0, 0.001, 8)?;
/// let as_given = BoundaryElementParams { tolerance: f64::INFINITY, ..Default::default() };
/// let (added_mass, report) = AddedMass::solve_sheet(&disc, &as_given)?;
/// assert_eq!(report.panels, disc.triangles().len());
/// assert!((added_mass.linear[(2, 2)] / (8.0 / 3.0) - 1.0).abs() < 0.02);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundaryElementParams {
    /// Relative error to refine to, see [`BoundaryElementReport::estimated_error`]. An infinite one solves
    /// once, on the mesh as it is given. Default: 0.01.
    pub tolerance: f64,
    /// Refinement stops before it exceeds this many panels. Default: 6000.
    pub max_panels: usize,
    /// Panels farther apart than this multiple of the sum of their radii interact through three
    /// points each. Default: 1.5; 3 changes the result by 3·10⁻⁵.
    pub far: f64,
    /// How many times a panel is halved toward an edge or corner that it shares with another.
    /// Default: 4; 8 changes the result by 5·10⁻⁵.
    pub touching_levels: u32,
    /// How many times at most a panel is halved toward the edges of another that is close, such as
    /// the opposite face of a leaf. Extremely thin bodies need more and get it: a matrix that is not
    /// positive definite is integrated again with four more, twice. Default: 8.
    pub close_levels: u32,
}

impl Default for BoundaryElementParams {
    fn default() -> Self {
        Self {
            tolerance: 0.01,
            max_panels: 6000,
            far: 1.5,
            touching_levels: 4,
            close_levels: 8,
        }
    }
}

impl BoundaryElementParams {
    fn check(&self) -> Result<(), Error> {
        let positive = |parameter, value: f64| {
            if value > 0.0 {
                Ok(())
            } else {
                Err(Error::InvalidParameter {
                    parameter,
                    requirement: "positive",
                    value,
                })
            }
        };
        positive("tolerance", self.tolerance)?;
        positive("max_panels", self.max_panels as f64)?;
        if !(self.far >= 1.0 && self.far.is_finite()) {
            return Err(Error::InvalidParameter {
                parameter: "far",
                requirement: "at least 1 and finite",
                value: self.far,
            });
        }
        for (parameter, levels) in [
            ("touching_levels", self.touching_levels),
            ("close_levels", self.close_levels),
        ] {
            if levels > 30 {
                return Err(Error::InvalidParameter {
                    parameter,
                    requirement: "at most 30",
                    value: levels.into(),
                });
            }
        }
        Ok(())
    }
}

/// How a solve went.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct BoundaryElementReport {
    /// Panels of the finest mesh.
    pub panels: usize,
    /// Unknowns on it.
    pub unknowns: usize,
    /// Estimated relative error: of the linear block against its norm, of the angular block against
    /// its norm or that of the displaced fluid's inertia, of the coupling against their geometric
    /// mean, whichever is largest. It follows from the differences of the last meshes, and is `None` if
    /// there was only one.
    pub estimated_error: Option<f64>,
    /// Whether the tolerance was reached.
    pub converged: bool,
    /// Largest difference, relative in the same way, between two ways to compute the coupling and
    /// between transposed entries, before they were averaged: the error of the quadrature.
    pub asymmetry: f64,
    /// Whether the matrix was positive definite in the end. If not, the body is too thin for the quadrature,
    /// and the result is not to be trusted.
    pub definite: bool,
    /// Panels of every mesh that was solved, and the relative change from the one before it.
    pub history: Vec<(usize, f64)>,
}

/// A solved body: the added mass, how it went, and the potentials.
///
/// ```
/// use rapier3d_immersed::boundary_element::{BoundaryElementParams, BoundaryElementSolution};
/// use rapier3d_immersed::geometry::{Ellipsoid, Surface};
/// use rapier3d_immersed::rapier3d::na::Vector3;
///
/// let ball = Surface::ellipsoid(&Ellipsoid { semi_axes: Vector3::repeat(1.0) }, 4)?;
/// let params = BoundaryElementParams { tolerance: f64::INFINITY, ..Default::default() };
/// let solution = BoundaryElementSolution::of_surface(&ball, &params, &|_| ())?;
/// // A ball that moves along x has the potential −x/2 on its surface, up to the sign of the convention.
/// for (vertex, potential) in solution.vertices.iter().zip(&solution.potentials) {
///     assert!((potential[0].abs() - 0.5 * vertex.x.abs()).abs() < 0.02);
/// }
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct BoundaryElementSolution {
    /// Per unit density, about [`BoundaryElementSolution::center`].
    pub added_mass: AddedMass,
    /// Centroid of the enclosed volume, or of a sheet's area, m.
    pub center: Vector3<f64>,
    /// How it went.
    pub report: BoundaryElementReport,
    /// Vertices of the finest mesh, m.
    pub vertices: Vec<Vector3<f64>>,
    /// Its triangles.
    pub triangles: Vec<[u32; 3]>,
    /// By vertex, the potential in the fluid due to unit velocity along x, y, z (m²/s) and unit
    /// angular velocity about x, y, z through the center (m³/s); across a sheet its jump, front
    /// minus back.
    pub potentials: Vec<[f64; 6]>,
}

/// Where a long solve is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundaryElementProgress {
    /// Number of the mesh, from 0.
    pub level: usize,
    /// Its panels.
    pub panels: usize,
    /// Share of the work on it that is done, 0 to 1.
    pub share: f64,
}

/// Called from time to time during a solve, from any thread.
pub type ProgressFn<'a> = &'a (dyn Fn(BoundaryElementProgress) + Sync);

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
