//! The bodies on offer.

use rapier3d_immersed::Error;
use rapier3d_immersed::boundary_element::{
    BoundaryElementParams, BoundaryElementSolution, ProgressFn,
};
use rapier3d_immersed::geometry::{Ellipsoid, Sheet, Surface};
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::rapier3d::parry::shape::SharedShape;
use std::path::Path;

#[derive(Clone, Copy, Debug, PartialEq, clap::ValueEnum)]
pub enum Kind {
    Ball,
    Box,
    Cylinder,
    Cone,
    Capsule,
    Ellipsoid,
    /// An ellipsoid of the size of the thesis's leaf, 7.3 × 4.2 × 0.03 cm.
    Leaf,
    /// A dart of folded paper, 8.3 × 8.3 × 0.01 cm.
    Airplane,
}

pub enum Body {
    Shape(SharedShape),
    Ellipsoid(Ellipsoid),
    Surface(Surface),
    Sheet(Sheet),
    /// Side and thickness, m.
    Airplane(f64, f64),
}

/// Cells of ever finer meshes.
fn cells(level: usize) -> usize {
    [6, 8, 11, 16, 22][level.min(4)] + 8 * level.saturating_sub(4)
}

pub struct Case {
    pub name: String,
    pub body: Body,
}

impl Case {
    pub fn built_in(kind: Kind, size: &[f64]) -> Result<Self, String> {
        let default: &[f64] = match kind {
            Kind::Ball => &[0.1],
            Kind::Box => &[0.1, 0.1, 0.1],
            Kind::Cylinder | Kind::Cone | Kind::Capsule => &[0.1, 0.2],
            Kind::Ellipsoid => &[0.3, 0.2, 0.1],
            Kind::Leaf => &[0.073, 0.042, 0.0003],
            Kind::Airplane => &[0.083, 0.0001],
        };
        let size = if size.is_empty() { default } else { size };
        if size.len() != default.len() {
            return Err(format!(
                "--size: {} values given where {} are needed",
                size.len(),
                default.len()
            ));
        }
        if let Some(bad) = size.iter().find(|s| !(**s > 0.0 && s.is_finite())) {
            return Err(format!("--size {bad}: must be positive and finite"));
        }
        let half = |i: usize| (size[i] / 2.0) as f32;
        let body = match kind {
            Kind::Ball => Body::Shape(SharedShape::ball(half(0))),
            Kind::Box => Body::Shape(SharedShape::cuboid(half(0), half(1), half(2))),
            Kind::Cylinder => Body::Shape(SharedShape::cylinder(half(1), half(0))),
            Kind::Cone => Body::Shape(SharedShape::cone(half(1), half(0))),
            Kind::Capsule => Body::Shape(SharedShape::capsule_y(half(1) - half(0), half(0))),
            Kind::Ellipsoid | Kind::Leaf => Body::Ellipsoid(Ellipsoid {
                semi_axes: Vector3::new(size[0], size[1], size[2]) / 2.0,
            }),
            Kind::Airplane => Body::Airplane(size[0], size[1]),
        };
        if kind == Kind::Capsule && size[1] <= size[0] {
            return Err("--size: a capsule must be higher than its diameter".into());
        }
        Ok(Self {
            name: format!("{kind:?}").to_lowercase(),
            body,
        })
    }

    pub fn load(path: &Path, scale: Option<f64>, thickness: Option<f64>) -> Result<Self, String> {
        let failed = |e: &dyn std::fmt::Display| format!("--mesh {}: {e}", path.display());
        if let Some(bad) = scale.filter(|s| !(*s > 0.0 && s.is_finite())) {
            return Err(format!("--scale {bad}: must be positive and finite"));
        }
        let mesh = crate::mesh::load_scaled(path, scale).map_err(|e| format!("--mesh {e}"))?;
        let (vertices, triangles) = (mesh.vertices, mesh.triangles);
        let body = match thickness {
            Some(thickness) => Sheet::new(&vertices, &triangles, thickness).map(Body::Sheet),
            None => Surface::new(&vertices, &triangles).map(Body::Surface),
        };
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        Ok(Self {
            name: name.into_owned(),
            body: body.map_err(|e| failed(&e))?,
        })
    }

    pub fn solve(
        &self,
        params: &BoundaryElementParams,
        progress: ProgressFn,
    ) -> Result<BoundaryElementSolution, Error> {
        match &self.body {
            Body::Shape(shape) => {
                BoundaryElementSolution::of_shape(shape.as_ref(), params, progress)
            }
            Body::Surface(surface) => {
                BoundaryElementSolution::of_surface(surface, params, progress)
            }
            Body::Sheet(sheet) => BoundaryElementSolution::of_sheet(sheet, params, progress),
            Body::Ellipsoid(body) => BoundaryElementSolution::of_meshes(
                |level| Surface::ellipsoid(body, cells(level)),
                params,
                progress,
            ),
            Body::Airplane(side, thickness) => BoundaryElementSolution::of_sheets(
                |level| Sheet::paper_airplane(*side, *thickness, 2 * cells(level)),
                params,
                progress,
            ),
        }
    }

    /// Displaced volume, m³.
    pub fn volume(&self) -> f64 {
        match &self.body {
            Body::Sheet(sheet) => sheet.volume(),
            Body::Airplane(side, thickness) => {
                Sheet::paper_airplane(*side, *thickness, 2).map_or(0.0, |s| s.volume())
            }
            Body::Ellipsoid(ellipsoid) => ellipsoid.volume(),
            _ => self.surface().map_or(0.0, |s| s.volume_integrals().volume),
        }
    }

    pub fn is_sheet(&self) -> bool {
        matches!(self.body, Body::Sheet(_) | Body::Airplane(..))
    }

    /// The closed surface, if the body is not a sheet.
    pub fn surface(&self) -> Option<Surface> {
        match &self.body {
            Body::Shape(shape) => Surface::panelled(shape.as_ref(), 8).ok(),
            Body::Surface(surface) => Some(surface.clone()),
            Body::Ellipsoid(ellipsoid) => Surface::ellipsoid(ellipsoid, 16).ok(),
            Body::Sheet(_) | Body::Airplane(..) => None,
        }
    }
}
