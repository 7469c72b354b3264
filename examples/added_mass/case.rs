//! The bodies on offer, as the boundary elements take them.

use crate::support::shape::{Shaped, Solid};
use rapier3d_immersed::Error;
use rapier3d_immersed::boundary_element::{
    BoundaryElementParams, BoundaryElementSolution, ProgressFn,
};
use rapier3d_immersed::geometry::{Sheet, Surface};

/// Cells of ever finer meshes.
fn cells(level: usize) -> usize {
    [6, 8, 11, 16, 22][level.min(4)] + 8 * level.saturating_sub(4)
}

pub fn solve(
    body: &Shaped,
    params: &BoundaryElementParams,
    progress: ProgressFn,
) -> Result<BoundaryElementSolution, Error> {
    match &body.solid {
        Solid::Shape(shape) => BoundaryElementSolution::of_shape(shape.as_ref(), params, progress),
        Solid::Surface(surface) => BoundaryElementSolution::of_surface(surface, params, progress),
        Solid::Sheet(raw, thickness) => {
            let sheet = Sheet::new(&raw.vertices, &raw.triangles, *thickness)?;
            BoundaryElementSolution::of_sheet(&sheet, params, progress)
        }
        Solid::Ellipsoid(body) => BoundaryElementSolution::of_meshes(
            |level| Surface::ellipsoid(body, cells(level)),
            params,
            progress,
        ),
        Solid::Airplane(side, thickness) => BoundaryElementSolution::of_sheets(
            |level| Sheet::paper_airplane(*side, *thickness, 2 * cells(level)),
            params,
            progress,
        ),
    }
}

/// Displaced volume, m³.
pub fn volume(body: &Shaped) -> f64 {
    match &body.solid {
        Solid::Sheet(raw, thickness) => {
            Sheet::new(&raw.vertices, &raw.triangles, *thickness).map_or(0.0, |s| s.volume())
        }
        Solid::Airplane(side, thickness) => {
            Sheet::paper_airplane(*side, *thickness, 2).map_or(0.0, |s| s.volume())
        }
        Solid::Ellipsoid(ellipsoid) => ellipsoid.volume(),
        _ => surface(body).map_or(0.0, |s| s.volume_integrals().volume),
    }
}

pub fn is_sheet(body: &Shaped) -> bool {
    matches!(body.solid, Solid::Sheet(..) | Solid::Airplane(..))
}

/// The closed surface, if the body is not a sheet.
pub fn surface(body: &Shaped) -> Option<Surface> {
    match &body.solid {
        Solid::Shape(shape) => Surface::panelled(shape.as_ref(), 8).ok(),
        Solid::Surface(surface) => Some(surface.clone()),
        Solid::Ellipsoid(ellipsoid) => Surface::ellipsoid(ellipsoid, 16).ok(),
        Solid::Sheet(..) | Solid::Airplane(..) => None,
    }
}
