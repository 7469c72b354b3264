//! Properties of a shape with its own added mass instead of the proxy's.

use super::params::{BoundaryElementParams, BoundaryElementReport, BoundaryElementSolution};
use super::shape::cells;
use crate::error::Error;
use crate::geometry::Surface;
use crate::hydro::{AddedMass, AddedMassSource, HydroProperties};
use rapier3d::math::{Pose, Vector};
use rapier3d::na::Vector3;
use rapier3d::parry::shape::Shape;

impl HydroProperties {
    /// The same properties with the added mass of these shapes together, posed in the frame.
    pub(crate) fn solved(
        self,
        parts: &[(Pose, &dyn Shape)],
        tolerance: f64,
    ) -> Result<Self, Error> {
        let (added_mass, report) = match parts {
            // A shape that is alone is solved in its own axes, where a ball is exact.
            [(pose, shape)] => {
                let (own, report) = AddedMass::of_shape(*shape, Vector::ZERO, tolerance)?;
                let pose = crate::math::isometry(pose);
                let turned = own.rotated(&pose.rotation.to_rotation_matrix());
                let offset = self.reference - pose.translation.vector;
                (turned.about(offset), report)
            }
            _ => of_parts(parts, self.reference, tolerance)?,
        };
        if !(report.converged && report.definite) {
            log::warn!(
                "added mass on {} panels: estimated error {:?} for a tolerance of {tolerance}, \
                 matrix positive definite: {}",
                report.panels,
                report.estimated_error,
                report.definite,
            );
        }
        // A rotation rounds, and its rounding must not count as asymmetry.
        let added_mass = AddedMass::from_matrix6(&added_mass.to_matrix6());
        let mut found = self.with_added_mass(added_mass)?;
        found.added_mass_source = AddedMassSource::BoundaryElements {
            estimated_error: report.estimated_error.unwrap_or(f64::INFINITY),
        };
        Ok(found)
    }
}

fn of_parts(
    parts: &[(Pose, &dyn Shape)],
    reference: Vector3<f64>,
    tolerance: f64,
) -> Result<(AddedMass, BoundaryElementReport), Error> {
    let params = BoundaryElementParams {
        tolerance,
        ..BoundaryElementParams::default()
    };
    let no_progress = &|_| ();
    let solution = if parts.iter().all(|(_, s)| Surface::follows_cells(*s)) {
        let mesh = |level| Surface::of_parts(parts, |s| Surface::panelled(s, cells(level)));
        BoundaryElementSolution::of_meshes(mesh, &params, no_progress)?
    } else {
        let surface = Surface::of_parts(parts, Surface::panelled_as_is)?;
        BoundaryElementSolution::of_surface(&surface, &params, no_progress)?
    };
    let about = solution.added_mass.about(reference - solution.center);
    Ok((about, solution.report))
}
