//! What a solve is asked for, and what it reports.

use crate::error::Error;
use crate::hydro::AddedMass;
use rapier3d::na::Vector3;

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
    pub(super) fn check(&self) -> Result<(), Error> {
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
