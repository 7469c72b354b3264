//! Thin things: sheets, wings that are folded along their middle, domes of cloth.

use crate::Failure;
use crate::stage::double;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{HydroProperties, Part};
use std::f32::consts::{FRAC_PI_2, TAU};

/// Facets of a dome around it, and from its rim to its top.
const GORES: u32 = 16;
const RINGS: u32 = 8;

/// Turns the side of a wing that is toward +z or −z up by an angle, rad, about the x axis.
pub fn raised(right: bool, dihedral: f32) -> Pose {
    let angle = if right { -dihedral } else { dihedral };
    Pose::from_rotation(Rotation::from_rotation_x(angle))
}

/// Strips of a flat wing, its span along z, each folded up. They have the aspect ratio of the whole wing.
///
/// # Errors
/// Those of [`HydroProperties::strips_of_shape`].
pub fn strips(flat: &SharedShape, count: usize, dihedral: f32) -> Result<Vec<Part>, Failure> {
    let strips = HydroProperties::strips_of_shape(flat.as_ref(), count)?;
    let fold = |strip: HydroProperties| {
        let right = strip.planform.center.z > 0.0;
        Part::new(strip).at(double(&raised(right, dihedral)))
    };
    Ok(strips.into_iter().map(fold).collect())
}

/// A thin prism over a convex outline in the xz plane.
///
/// # Errors
/// An outline without area.
pub fn sheet(outline: &[[f32; 2]], thickness: f32) -> Result<SharedShape, Failure> {
    let at = |y: f32| outline.iter().map(move |[x, z]| Vector::new(*x, y, *z));
    let points: Vec<Vector> = at(0.5 * thickness).chain(at(-0.5 * thickness)).collect();
    SharedShape::convex_hull(&points).ok_or_else(|| "an outline without area".into())
}

/// A half spheroid of cloth, its rim in the xz plane and open below, as a closed mesh of a thickness.
///
/// # Errors
/// A mesh without volume.
pub fn dome(radius: f32, depth: f32, thickness: f32) -> Result<SharedShape, Failure> {
    let mut points = Vec::new();
    for inside in [0.0, thickness] {
        let (radius, depth) = (radius - inside, depth - inside);
        for ring in 0..RINGS {
            let (up, out) = (FRAC_PI_2 * ring as f32 / RINGS as f32).sin_cos();
            for gore in 0..GORES {
                let (z, x) = (TAU * gore as f32 / GORES as f32).sin_cos();
                points.push(Vector::new(x * out * radius, up * depth, z * out * radius));
            }
        }
        points.push(Vector::Y * depth);
    }
    let half = GORES * RINGS + 1;
    let mut triangles = Vec::new();
    for gore in 0..GORES {
        let next = (gore + 1) % GORES;
        let mut quad = |[a, b, c, d]: [u32; 4]| triangles.extend([[a, b, c], [a, c, d]]);
        for ring in 0..RINGS - 1 {
            let [low, high] = [ring, ring + 1].map(|r| r * GORES);
            quad([low + gore, high + gore, high + next, low + next]);
            let [low, high] = [low, high].map(|i| i + half);
            quad([low + gore, low + next, high + next, high + gore]);
        }
        quad([gore, next, next + half, gore + half]);
        let last = (RINGS - 1) * GORES;
        triangles.push([last + gore, half - 1, last + next]);
        triangles.push([half + last + gore, half + last + next, 2 * half - 1]);
    }
    Ok(SharedShape::trimesh(points, triangles)?)
}
