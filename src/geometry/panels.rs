//! Surfaces of rapier's shapes at a chosen resolution, fine toward their edges, as boundary elements
//! need them.

use super::graded::{both_ends, one_end};
use super::revolution::Facets;
use super::rounded::COARSE;
use super::tessellate::rounded_surface;
use super::{Ellipsoid, Surface};
use crate::error::Error;
use crate::math;
use rapier3d::na::Vector3;
use rapier3d::parry::shape::{Shape, TypedShape};
use std::f64::consts::{PI, TAU};

impl Surface {
    /// The surface of a shape with about `6 cells²` to `24 cells²` panels.
    ///
    /// Boxes, cylinders, cones and capsules, and compounds of them, are meshed anew: fine toward
    /// their edges, polygons around their axis, and with exactly the volume of the shape. Of all
    /// other shapes the surface is the one of [`Surface::from_shape`], with wider panels on rounded borders.
    ///
    /// ```
    /// use rapier3d_immersed::geometry::Surface;
    /// use rapier3d_immersed::rapier3d::prelude::*;
    ///
    /// let leaf = Cuboid::new(Vector::new(0.03, 0.0002, 0.02));
    /// let [coarse, fine] = [6, 12].map(|cells| Surface::panelled(&leaf, cells));
    /// let (coarse, fine) = (coarse?, fine?);
    /// assert!(fine.triangles().len() > 3 * coarse.triangles().len());
    /// let [a, b] = [coarse, fine].map(|surface| surface.volume_integrals().volume);
    /// assert!((a / b - 1.0).abs() < 1e-12);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Surface::from_shape`], and [`Error::InvalidParameter`] for less than 2 cells.
    pub fn panelled(shape: &dyn Shape, cells: usize) -> Result<Self, Error> {
        if cells < 2 {
            return Err(Error::InvalidParameter {
                parameter: "cells",
                requirement: "at least 2",
                value: cells as f64,
            });
        }
        match shape.as_typed_shape() {
            TypedShape::Ball(s) => Self::ellipsoid(
                &Ellipsoid {
                    semi_axes: Vector3::repeat(s.radius.into()),
                },
                cells,
            ),
            TypedShape::Cuboid(s) => cuboid(crate::math::to_f64(s.half_extents), cells),
            TypedShape::Cylinder(s) => {
                let (r, h) = (f64::from(s.radius), f64::from(s.half_height));
                let mut profile = cap(r, h, cells);
                profile.extend(side(r, h, cells));
                profile.extend(cap(r, -h, cells).into_iter().rev());
                revolve(&profile, 4 * cells, 2.0 * PI * r * r * h)
            }
            TypedShape::Cone(s) => {
                let (r, h) = (f64::from(s.radius), f64::from(s.half_height));
                let mut profile: Vec<_> = both_ends(cells)
                    .iter()
                    .map(|t| (r * t, h - 2.0 * h * t))
                    .collect();
                profile.pop();
                profile.extend(cap(r, -h, cells).into_iter().rev());
                revolve(&profile, 4 * cells, 2.0 / 3.0 * PI * r * r * h)
            }
            TypedShape::Capsule(s) => {
                let (r, h) = (f64::from(s.radius), f64::from(s.half_height()));
                let quarter: Vec<_> = (0..=cells)
                    .map(|i| math::sin_cos(PI / 2.0 * i as f64 / cells as f64))
                    .collect();
                let along = (((2.0 * h / r) * cells as f64 / (PI / 2.0)).ceil() as usize)
                    .clamp(1, 4 * cells);
                let mut profile: Vec<_> = quarter.iter().map(|(s, c)| (r * s, h + r * c)).collect();
                profile.extend((1..along).map(|i| (r, h - 2.0 * h * i as f64 / along as f64)));
                profile.extend(quarter.iter().rev().map(|(s, c)| (r * s, -h - r * c)));
                // The first point lies exactly on the axis.
                profile[0].0 = 0.0;
                let last = profile.len() - 1;
                profile[last].0 = 0.0;
                let volume = PI * r * r * (4.0 / 3.0 * r + 2.0 * h);
                let pose = rapier3d::math::Pose::from_parts(s.center(), s.rotation_wrt_y());
                Ok(revolve(&profile, 4 * cells, volume)?.posed(&pose))
            }
            TypedShape::Compound(s) => {
                let parts: Vec<_> = s.shapes().iter().map(|(p, s)| (*p, s.as_ref())).collect();
                Self::of_parts(&parts, |part| Self::panelled(part, cells))
            }
            _ => Self::panelled_as_is(shape),
        }
    }

    /// [`Surface::from_shape`] with wider panels on rounded borders.
    pub(crate) fn panelled_as_is(shape: &dyn Shape) -> Result<Self, Error> {
        rounded_surface(
            shape,
            &Facets {
                step: COARSE,
                ..Facets::FINE
            },
        )
    }

    /// Whether [`Surface::panelled`] makes a better surface of this shape from more cells.
    #[cfg_attr(not(feature = "bake"), allow(dead_code))]
    pub(crate) fn follows_cells(shape: &dyn Shape) -> bool {
        match shape.as_typed_shape() {
            TypedShape::Ball(_)
            | TypedShape::Cuboid(_)
            | TypedShape::Cylinder(_)
            | TypedShape::Cone(_)
            | TypedShape::Capsule(_) => true,
            TypedShape::Compound(s) => s
                .shapes()
                .iter()
                .all(|(_, s)| Self::follows_cells(s.as_ref())),
            _ => false,
        }
    }

    /// An ellipsoid of `20 cells²` panels: the icosahedron's faces divided, mapped to the ellipsoid,
    /// and blown up to its volume. However thin the ellipsoid, its panels shrink toward the rim as
    /// the square of the distance.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a semi-axis that is not positive, or no cells.
    pub fn ellipsoid(ellipsoid: &Ellipsoid, cells: usize) -> Result<Self, Error> {
        for (name, value) in ["semi_axes.x", "semi_axes.y", "semi_axes.z"]
            .iter()
            .zip(ellipsoid.semi_axes.iter())
        {
            Error::check_positive(name, *value)?;
        }
        Error::check_positive("cells", cells as f64)?;
        let sphere = icosphere(cells)?;
        let grow = math::cbrt(4.0 / 3.0 * PI / sphere.volume_integrals().volume);
        Ok(sphere.map(|v| v.component_mul(&ellipsoid.semi_axes) * grow))
    }
}

/// Points (distance from the axis, height) from the axis to the rim.
fn cap(radius: f64, height: f64, cells: usize) -> Vec<(f64, f64)> {
    one_end(cells / 2 + 1)
        .iter()
        .map(|s| (radius * s, height))
        .collect()
}

/// Points between two rims, without those on the rims.
fn side(radius: f64, half_height: f64, cells: usize) -> Vec<(f64, f64)> {
    let count = share(2.0 * half_height, 2.0 * radius, cells);
    let line = both_ends(count);
    line[1..count]
        .iter()
        .map(|s| (radius, half_height * (1.0 - 2.0 * s)))
        .collect()
}

/// Cells for a length when another has `cells`: the square root of their ratio, because cells that
/// are fine toward both ends follow the ends and not the length.
fn share(length: f64, other: f64, cells: usize) -> usize {
    ((length / other).sqrt() * cells as f64)
        .round()
        .clamp(2.0, 4.0 * cells as f64) as usize
}

fn cuboid(half: Vector3<f64>, cells: usize) -> Result<Surface, Error> {
    for (name, value) in ["half_extents.x", "half_extents.y", "half_extents.z"]
        .iter()
        .zip(half.iter())
    {
        Error::check_positive(name, *value)?;
    }
    let lines: [Vec<f64>; 3] = [0, 1, 2].map(|k| {
        both_ends(share(half[k], half.max(), cells))
            .iter()
            .map(|s| half[k] * (2.0 * s - 1.0))
            .collect()
    });
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for k in 0..3 {
        let (a, b) = ((k + 1) % 3, (k + 2) % 3);
        let (na, nb) = (lines[a].len(), lines[b].len());
        for (side, outward) in [(-half[k], false), (half[k], true)] {
            let base = vertices.len();
            for s in &lines[a] {
                for t in &lines[b] {
                    let mut x = Vector3::zeros();
                    (x[k], x[a], x[b]) = (side, *s, *t);
                    vertices.push(x);
                }
            }
            for i in 0..na - 1 {
                for j in 0..nb - 1 {
                    let id = |i: usize, j: usize| (base + i * nb + j) as u32;
                    let [p, q, r, s] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
                    // Diagonals toward the nearest corner keep the mesh as symmetric as the box.
                    let halves = if (2 * i < na - 1) == (2 * j < nb - 1) {
                        [[p, q, r], [p, r, s]]
                    } else {
                        [[p, q, s], [q, r, s]]
                    };
                    triangles.extend(halves.map(
                        |[x, y, z]| {
                            if outward { [x, y, z] } else { [x, z, y] }
                        },
                    ));
                }
            }
        }
    }
    Surface::new(&vertices, &triangles)
}

/// The body of revolution about y of a profile from its top to its bottom, blown up across the axis
/// to the given volume.
fn revolve(profile: &[(f64, f64)], around: usize, volume: f64) -> Result<Surface, Error> {
    let mut vertices = Vec::with_capacity(profile.len() * around);
    for (distance, height) in profile {
        vertices.extend((0..around).map(|i| {
            let (sin, cos) = math::sin_cos(TAU * i as f64 / around as f64);
            Vector3::new(distance * sin, *height, distance * cos)
        }));
    }
    let mut triangles = Vec::with_capacity(profile.len() * around * 2);
    for ring in 0..profile.len() - 1 {
        for i in 0..around {
            let id = |ring: usize, i: usize| (ring * around + i % around) as u32;
            let [a, b, c, d] = [
                id(ring, i),
                id(ring, i + 1),
                id(ring + 1, i),
                id(ring + 1, i + 1),
            ];
            // Diagonals alternate, so that the mesh has no handedness.
            if i % 2 == 0 {
                triangles.extend([[a, c, d], [a, d, b]]);
            } else {
                triangles.extend([[a, c, b], [b, c, d]]);
            }
        }
    }
    let inscribed = Surface::new(&vertices, &triangles)?;
    let grow = (volume / inscribed.volume_integrals().volume).sqrt();
    Ok(inscribed.map(|v| Vector3::new(v.x * grow, v.y, v.z * grow)))
}

/// The icosahedron's faces divided into `cells²` each, on the unit sphere.
fn icosphere(cells: usize) -> Result<Surface, Error> {
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let mut corners = Vec::with_capacity(12);
    for k in 0..3 {
        for (s, t) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            let mut x = Vector3::zeros();
            (x[k], x[(k + 1) % 3]) = (s, t * golden);
            corners.push(x);
        }
    }
    let neighbors = |i: usize, j: usize| (corners[i] - corners[j]).norm() < 2.1;
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if !(neighbors(a, b) && neighbors(b, c) && neighbors(c, a)) {
                    continue;
                }
                let [a, mut b, mut c] = [a, b, c].map(|i| corners[i]);
                if a.dot(&b.cross(&c)) < 0.0 {
                    std::mem::swap(&mut b, &mut c);
                }
                let start = vertices.len();
                let row = |i: usize| start + i * (i + 1) / 2;
                for i in 0..=cells {
                    for j in 0..=i {
                        let (s, t) = (i as f64 / cells as f64, j as f64 / cells as f64);
                        vertices.push((a * (1.0 - s) + b * (s - t) + c * t).normalize());
                    }
                }
                for i in 0..cells {
                    for j in 0..=i {
                        let (up, down) = (row(i) + j, row(i + 1) + j);
                        triangles.push([up as u32, down as u32, down as u32 + 1]);
                        if j < i {
                            triangles.push([up as u32, down as u32 + 1, up as u32 + 1]);
                        }
                    }
                }
            }
        }
    }
    Surface::new(&vertices, &triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use rapier3d::math::Vector;
    use rapier3d::parry::shape::SharedShape;

    /// Meshes are closed (which their construction checks), face outward, and have the shape's own volume.
    #[test]
    fn volumes_are_exact() {
        let capsule = PI * 0.25 * 2.0 + 4.0 / 3.0 * PI * 0.125;
        for (shape, volume) in [
            (SharedShape::ball(0.3), 4.0 / 3.0 * PI * 0.027),
            (SharedShape::cuboid(0.1, 0.2, 0.0003), 0.000048),
            (SharedShape::cylinder(0.01, 0.4), PI * 0.16 * 0.02),
            (SharedShape::cone(0.5, 0.2), PI * 0.04 / 3.0),
            (
                SharedShape::capsule(Vector::X, Vector::X * 3.0, 0.5),
                capsule,
            ),
        ] {
            for cells in [3, 6] {
                let surface = Surface::panelled(shape.as_ref(), cells).unwrap();
                let found = surface.volume_integrals();
                // The sizes are f32.
                assert_relative_eq!(found.volume, volume, max_relative = 3e-7);
                let coarse = Surface::from_shape(shape.as_ref())
                    .unwrap()
                    .volume_integrals();
                assert!((found.centroid - coarse.centroid).norm() < 1e-6);
            }
        }
        let ellipsoid = Ellipsoid {
            semi_axes: Vector3::new(3.0, 2.0, 0.01),
        };
        let surface = Surface::ellipsoid(&ellipsoid, 8).unwrap();
        assert_eq!(surface.triangles().len(), 20 * 64);
        assert_relative_eq!(
            surface.volume_integrals().volume,
            ellipsoid.volume(),
            max_relative = 1e-9
        );
    }
}
