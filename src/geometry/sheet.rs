//! Open surfaces: paper, leaves and wings by their mid-surface.

use super::bisect::quarter;
use crate::error::Error;
use crate::math;
use rapier3d::na::Vector3;
use std::collections::HashMap;

/// The mid-surface of a thin body: a triangle mesh with free edges, oriented alike everywhere, and
/// the thickness of what it stands for.
///
/// The fluid feels the mid-surface; the thickness gives the sheet its displaced volume.
///
/// ```
/// use rapier3d_immersed::geometry::Sheet;
/// use rapier3d_immersed::rapier3d::na::Vector3;
///
/// // A sheet of paper, 0.1 mm thick, that is folded at a right angle along its middle.
/// let across = [[0.0, 0.1], [0.0, 0.0], [0.1, 0.0]]; // y and z of an edge, the fold, the other edge
/// let vertices = across.map(|[y, z]| [0.0, 0.1].map(|x| Vector3::new(x, y, z))).concat();
/// let triangles = [[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]];
/// let sheet = Sheet::new(&vertices, &triangles, 1e-4)?;
/// assert!((sheet.area() - 0.02).abs() < 1e-12);
/// assert!((sheet.volume() - 2e-6).abs() < 1e-12);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    vertices: Vec<Vector3<f64>>,
    triangles: Vec<[u32; 3]>,
    thickness: f64,
    on_rim: Vec<bool>,
    turned: usize,
}

impl Sheet {
    /// A sheet from its triangles. They may be listed in either sense of rotation: neighbors are
    /// turned alike, following the first triangle of each part ([`Sheet::turned`] counts).
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for the thickness (m, positive), [`Error::EmptyMesh`],
    /// [`Error::NonFiniteVertex`], [`Error::IndexOutOfRange`], [`Error::DegenerateTriangle`],
    /// [`Error::BranchingMesh`] where three triangles meet at an edge, and
    /// [`Error::OneSidedSheet`] for a Möbius strip.
    pub fn new(
        vertices: &[Vector3<f64>],
        triangles: &[[u32; 3]],
        thickness: f64,
    ) -> Result<Self, Error> {
        Error::check_positive("thickness", thickness)?;
        super::quality::check_indices(vertices, triangles)?;
        super::quality::check_triangles(vertices, triangles)?;
        let mut triangles = triangles.to_vec();
        let turned = orient(vertices, &mut triangles)?;
        Ok(Self::from_oriented(
            vertices.to_vec(),
            triangles,
            thickness,
            turned,
        ))
    }

    fn from_oriented(
        vertices: Vec<Vector3<f64>>,
        triangles: Vec<[u32; 3]>,
        thickness: f64,
        turned: usize,
    ) -> Self {
        let mut uses: HashMap<(u32, u32), u32> = HashMap::new();
        for t in &triangles {
            for i in 0..3 {
                let (a, b) = (t[i], t[(i + 1) % 3]);
                *uses.entry((a.min(b), a.max(b))).or_insert(0) += 1;
            }
        }
        let mut on_rim = vec![false; vertices.len()];
        for ((a, b), _) in uses.iter().filter(|(_, n)| **n == 1) {
            on_rim[*a as usize] = true;
            on_rim[*b as usize] = true;
        }
        Self {
            vertices,
            triangles,
            thickness,
            on_rim,
            turned,
        }
    }

    /// A flat rectangle across z, `length` along x and `width` along y (m), centered, with
    /// `cells` × `cells` cells that shrink toward the edges, where the pressure is singular.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for sizes that are not positive, or no cells.
    pub fn rectangle(length: f64, width: f64, thickness: f64, cells: usize) -> Result<Self, Error> {
        Error::check_positive("length", length)?;
        Error::check_positive("width", width)?;
        Error::check_positive("cells", cells as f64)?;
        let line = super::graded::both_ends(cells);
        let mut vertices = Vec::new();
        for s in &line {
            vertices.extend(
                line.iter()
                    .map(|t| Vector3::new(length * (s - 0.5), width * (t - 0.5), 0.0)),
            );
        }
        let mut triangles = Vec::new();
        for i in 0..cells {
            for j in 0..cells {
                let id = |i: usize, j: usize| (i * (cells + 1) + j) as u32;
                let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
                // Diagonals point to the nearest corner of the rectangle, so that no triangle has
                // all its corners on the rim.
                if (2 * i < cells) == (2 * j < cells) {
                    triangles.extend([[a, b, c], [a, c, d]]);
                } else {
                    triangles.extend([[a, b, d], [b, c, d]]);
                }
            }
        }
        Self::new(&vertices, &triangles, thickness)
    }

    /// A flat elliptic disc across z with semi-axes along x and y (m), of `rings` rings and
    /// `6 × rings` panels around.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for sizes that are not positive, or no rings.
    pub fn elliptic_disc(
        semi_x: f64,
        semi_y: f64,
        thickness: f64,
        rings: usize,
    ) -> Result<Self, Error> {
        Error::check_positive("semi_x", semi_x)?;
        Error::check_positive("semi_y", semi_y)?;
        Error::check_positive("rings", rings as f64)?;
        let (vertices, triangles) = super::graded::disc(rings);
        // The polygon is blown up to the area of the ellipse.
        let sides = (6 * rings) as f64;
        let angle = std::f64::consts::TAU / sides;
        let grow = (angle / math::sin(angle)).sqrt();
        let vertices: Vec<_> = vertices
            .iter()
            .map(|v| Vector3::new(v.x * semi_x * grow, v.y * semi_y * grow, 0.0))
            .collect();
        Self::new(&vertices, &triangles, thickness)
    }

    /// A square sheet of paper folded to a dart: the keel's bottom along x, nose toward +x, wings
    /// spread in ±y. `side` is the length from nose to tail and the total unfolded width (m), a
    /// fifth of which makes the two sides of the keel; they open by 20°, the wings lie level.
    ///
    /// The thesis flies one of 8.3 × 8.3 × 0.01 cm (its § 4.6) without giving its folds; these are
    /// ours.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for sizes that are not positive, or fewer than 2 cells.
    pub fn paper_airplane(side: f64, thickness: f64, cells: usize) -> Result<Self, Error> {
        Error::check_positive("side", side)?;
        if cells < 2 {
            return Err(Error::InvalidParameter {
                parameter: "cells",
                requirement: "at least 2",
                value: cells as f64,
            });
        }
        let keel = 0.1 * side;
        let wing = 0.5 * side - keel;
        let tilt = 10f64.to_radians();
        let across = super::graded::both_ends(cells);
        let keel_cells = (cells / 3).max(2);
        // Distances from the keel's bottom along the paper, on one side.
        let mut half: Vec<f64> = (1..=keel_cells)
            .map(|i| keel * i as f64 / keel_cells as f64)
            .collect();
        half.extend(
            super::graded::one_end(cells)
                .iter()
                .skip(1)
                .map(|s| keel + wing * s),
        );
        let unfolded: Vec<f64> = half
            .iter()
            .rev()
            .map(|s| -s)
            .chain([0.0])
            .chain(half.iter().copied())
            .collect();
        let fold = |s: f64| {
            let (on_keel, on_wing) = (s.abs().min(keel), (s.abs() - keel).max(0.0));
            (
                s.signum() * (on_keel * math::sin(tilt) + on_wing),
                on_keel * math::cos(tilt),
            )
        };
        let mut vertices = Vec::new();
        for s in &unfolded {
            let (y, z) = fold(*s);
            // The leading edge sweeps from the nose to two fifths of the length at the wing tip.
            let sweep = 1.0 - 0.6 * ((s.abs() - keel).max(0.0) / wing);
            vertices.extend(
                across
                    .iter()
                    .map(|t| Vector3::new(side * (t * sweep - 0.5), y, z)),
            );
        }
        let mut triangles = Vec::new();
        for i in 0..unfolded.len() - 1 {
            for j in 0..cells {
                let id = |i: usize, j: usize| (i * (cells + 1) + j) as u32;
                let [a, b, c, d] = [id(i, j), id(i, j + 1), id(i + 1, j + 1), id(i + 1, j)];
                if (2 * i < unfolded.len() - 1) == (2 * j < cells) {
                    triangles.extend([[a, b, c], [a, c, d]]);
                } else {
                    triangles.extend([[a, b, d], [b, c, d]]);
                }
            }
        }
        Self::new(&vertices, &triangles, thickness)
    }

    /// The vertices, m.
    pub fn vertices(&self) -> &[Vector3<f64>] {
        &self.vertices
    }

    /// Vertex indices of the triangles, neighbors oriented alike.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Thickness, m.
    pub fn thickness(&self) -> f64 {
        self.thickness
    }

    /// Whether each vertex lies on a free edge.
    pub fn on_rim(&self) -> &[bool] {
        &self.on_rim
    }

    /// How many triangles were turned to agree with their neighbors.
    pub fn turned(&self) -> usize {
        self.turned
    }

    /// The corners of each triangle.
    pub fn corners(&self) -> impl Iterator<Item = [Vector3<f64>; 3]> + '_ {
        self.triangles
            .iter()
            .map(|t| t.map(|i| self.vertices[i as usize]))
    }

    /// Area of one side, m².
    pub fn area(&self) -> f64 {
        self.corners()
            .map(|[a, b, c]| (b - a).cross(&(c - a)).norm() / 2.0)
            .sum()
    }

    /// Displaced volume: area times thickness, m³.
    pub fn volume(&self) -> f64 {
        self.area() * self.thickness
    }

    /// Center of area, m.
    pub fn centroid(&self) -> Vector3<f64> {
        let sum: Vector3<f64> = self
            .corners()
            .map(|[a, b, c]| (a + b + c) * ((b - a).cross(&(c - a)).norm() / 6.0))
            .sum();
        sum / self.area()
    }

    /// The sheet with every vertex mapped by a rigid motion or a uniform scaling; the thickness
    /// stays.
    pub fn map(&self, f: impl Fn(Vector3<f64>) -> Vector3<f64>) -> Self {
        Self {
            vertices: self.vertices.iter().map(|v| f(*v)).collect(),
            ..self.clone()
        }
    }

    /// The same sheet with the marked triangles quartered.
    #[cfg_attr(not(feature = "bake"), allow(dead_code))]
    pub(crate) fn quartered(&self, marked: &[bool]) -> Self {
        let mut vertices = self.vertices.clone();
        let triangles = quarter(&mut vertices, &self.triangles, marked);
        Self::from_oriented(vertices, triangles, self.thickness, self.turned)
    }
}

/// Turns triangles so that neighbors traverse their common edge in opposite senses.
fn orient(vertices: &[Vector3<f64>], triangles: &mut [[u32; 3]]) -> Result<usize, Error> {
    let mut around: HashMap<(u32, u32), Vec<usize>> = HashMap::new();
    for (n, t) in triangles.iter().enumerate() {
        for i in 0..3 {
            let (a, b) = (t[i], t[(i + 1) % 3]);
            around.entry((a.min(b), a.max(b))).or_default().push(n);
        }
    }
    let branching = around.iter().filter(|(_, n)| n.len() > 2).map(|(e, _)| e);
    if let Some((a, b)) = branching.min() {
        return Err(Error::BranchingMesh {
            from: vertices[*a as usize].into(),
            to: vertices[*b as usize].into(),
        });
    }
    let has = |t: &[u32; 3], a: u32, b: u32| (0..3).any(|i| t[i] == a && t[(i + 1) % 3] == b);
    let mut seen = vec![false; triangles.len()];
    let mut turned = 0;
    for start in 0..triangles.len() {
        let mut stack = vec![start];
        if std::mem::replace(&mut seen[start], true) {
            continue;
        }
        while let Some(n) = stack.pop() {
            for i in 0..3 {
                let (a, b) = (triangles[n][i], triangles[n][(i + 1) % 3]);
                let neighbors = &around[&(a.min(b), a.max(b))];
                for other in neighbors.iter().copied().filter(|other| *other != n) {
                    let agrees = has(&triangles[other], b, a);
                    if !seen[other] {
                        seen[other] = true;
                        if !agrees {
                            triangles[other].swap(1, 2);
                            turned += 1;
                        }
                        stack.push(other);
                    } else if !agrees {
                        return Err(Error::OneSidedSheet {
                            from: vertices[a as usize].into(),
                            to: vertices[b as usize].into(),
                        });
                    }
                }
            }
        }
    }
    Ok(turned)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn areas_and_rims() {
        let sheet = Sheet::rectangle(2.0, 1.0, 0.01, 7).unwrap();
        assert_relative_eq!(sheet.area(), 2.0, max_relative = 1e-12);
        assert_relative_eq!(sheet.volume(), 0.02, max_relative = 1e-12);
        assert_eq!(sheet.on_rim().iter().filter(|r| **r).count(), 4 * 7);
        // A triangle in a corner with all three vertices on the rim would be wasted.
        let stuck = |t: &[u32; 3]| t.iter().all(|v| sheet.on_rim()[*v as usize]);
        assert!(!sheet.triangles().iter().any(stuck));
        let disc = Sheet::elliptic_disc(2.0, 1.0, 0.01, 5).unwrap();
        assert_relative_eq!(disc.area(), std::f64::consts::TAU, max_relative = 1e-12);
        assert!(disc.centroid().norm() < 1e-12);
    }

    #[test]
    fn airplane_has_the_paper_s_symmetry() {
        let plane = Sheet::paper_airplane(0.083, 1e-4, 6).unwrap();
        assert!(plane.centroid().y.abs() < 1e-12);
        // The area is that of the square less the two triangles that the sweep folds away.
        let wing = 0.4 * 0.083;
        let area = 0.083 * 0.083 - 2.0 * 0.5 * wing * 0.6 * 0.083;
        assert_relative_eq!(plane.area(), area, max_relative = 1e-12);
    }

    #[test]
    fn turned_branching_and_one_sided_sheets() {
        let v = [
            Vector3::zeros(),
            Vector3::x(),
            Vector3::y(),
            Vector3::new(1.0, 1.0, 0.0),
            Vector3::z(),
        ];
        let sheet = Sheet::new(&v, &[[0, 1, 2], [1, 2, 3]], 0.1).unwrap();
        assert_eq!(sheet.turned(), 1);
        let three = Sheet::new(&v, &[[0, 1, 2], [1, 3, 2], [1, 2, 4]], 0.1);
        assert!(
            matches!(three, Err(Error::BranchingMesh { .. })),
            "{three:?}"
        );
        assert!(Sheet::new(&v, &[[0, 1, 2]], 0.0).is_err());
        assert!(matches!(
            Sheet::new(&v, &[[0, 1, 1]], 0.1),
            Err(Error::DegenerateTriangle { triangle: 0, .. })
        ));
        // A Möbius strip is a ring of five triangles with a half twist.
        let strip: Vec<_> = (0..5)
            .map(|i| {
                let angle = std::f64::consts::TAU * f64::from(i) / 5.0;
                Vector3::new(angle.cos(), angle.sin(), f64::from(i % 2))
            })
            .collect();
        let mobius: Vec<[u32; 3]> = (0..5).map(|i| [i, (i + 1) % 5, (i + 2) % 5]).collect();
        let one_sided = Sheet::new(&strip, &mobius, 0.1);
        assert!(
            matches!(one_sided, Err(Error::OneSidedSheet { .. })),
            "{one_sided:?}"
        );
    }
}
