//! Closed surfaces: where the volume, the planform and the boundary elements of a shape come from.

use crate::error::Error;
use rapier3d::na::{Matrix3, Vector3};
use std::collections::HashMap;
use std::hash::Hash;

/// A closed triangle mesh whose normals point out of the body, into the fluid. It is in f64, because
/// everything the fluid feels of a shape is computed from it once.
///
/// ```
/// use rapier3d_immersed::geometry::Surface;
/// use rapier3d_immersed::rapier3d::na::Vector3;
///
/// // The corner of a cube.
/// let vertices = [Vector3::zeros(), Vector3::x(), Vector3::y(), Vector3::z()];
/// let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let corner = Surface::new(&vertices, &triangles)?;
/// let integrals = corner.volume_integrals();
/// assert!((integrals.volume - 1.0 / 6.0).abs() < 1e-12);
/// assert!((integrals.centroid - Vector3::repeat(0.25)).norm() < 1e-12);
/// // A mesh with a hole is an error that names an edge of the hole.
/// assert!(Surface::new(&vertices, &triangles[..3]).is_err());
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    vertices: Vec<Vector3<f64>>,
    triangles: Vec<[u32; 3]>,
}

/// Volume integrals of the space that a [`Surface`] encloses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VolumeIntegrals {
    /// Enclosed volume, m³.
    pub volume: f64,
    /// Centroid, m.
    pub centroid: Vector3<f64>,
    /// `∫ (x − centroid)(x − centroid)ᵀ dV`, m⁵.
    pub second_moment: Matrix3<f64>,
}

impl VolumeIntegrals {
    /// Inertia tensor about the centroid at unit density: `tr(S)·1 − S`, m⁵.
    pub fn unit_inertia(&self) -> Matrix3<f64> {
        Matrix3::from_diagonal_element(self.second_moment.trace()) - self.second_moment
    }
}

impl Surface {
    /// A closed surface from its triangles, counter-clockwise seen from the fluid.
    ///
    /// Vertices at the same place (within 10⁻⁷ of the mesh's size) are merged, triangles that this
    /// collapses are dropped, and a mesh that is inside out as a whole is turned.
    ///
    /// # Errors
    /// [`Error::EmptyMesh`], [`Error::NonFiniteVertex`], [`Error::IndexOutOfRange`],
    /// [`Error::OpenMesh`] (naming an edge that does not have one triangle on each side) or
    /// [`Error::NoVolume`].
    pub fn new(vertices: &[Vector3<f64>], triangles: &[[u32; 3]]) -> Result<Self, Error> {
        super::quality::check_indices(vertices, triangles)?;
        let (vertices, triangles) = weld(vertices, triangles);
        if triangles.is_empty() {
            return Err(Error::EmptyMesh);
        }
        let mut surface = Self {
            vertices,
            triangles,
        };
        surface.check_closed()?;
        if surface.check_volume()? < 0.0 {
            for triangle in &mut surface.triangles {
                triangle.swap(1, 2);
            }
        }
        Ok(surface)
    }

    /// A surface whose triangles share their vertices by construction: only those at exactly the same place
    /// are merged, so that no part is too thin beside the whole. It faces outward.
    ///
    /// # Errors
    /// Those of [`Surface::new`].
    pub(super) fn assembled(
        vertices: &[Vector3<f64>],
        triangles: &[[u32; 3]],
    ) -> Result<Self, Error> {
        super::quality::check_indices(vertices, triangles)?;
        // Adding 0.0 turns −0.0 into 0.0.
        let place = |v: &Vector3<f64>| <[u64; 3]>::from(v.map(|x| (x + 0.0).to_bits()));
        let (vertices, triangles) = merge(vertices, triangles, place);
        if triangles.is_empty() {
            return Err(Error::EmptyMesh);
        }
        let surface = Self {
            vertices,
            triangles,
        };
        surface.check_closed()?;
        surface.check_volume()?;
        Ok(surface)
    }

    /// A surface of triangles of which nothing is known.
    pub(crate) fn unchecked(vertices: Vec<Vector3<f64>>, triangles: Vec<[u32; 3]>) -> Self {
        Self {
            vertices,
            triangles,
        }
    }

    /// The volume, which must be more than the rounding of a flat mesh's, or less where it is inside out.
    fn check_volume(&self) -> Result<f64, Error> {
        let (volume, size) = (self.volume_integrals().volume, self.size());
        if volume.abs() > 1e-12 * size.powi(3) {
            Ok(volume)
        } else {
            Err(Error::NoVolume { size })
        }
    }

    /// The vertices, m.
    pub fn vertices(&self) -> &[Vector3<f64>] {
        &self.vertices
    }

    /// Vertex indices of the triangles, counter-clockwise seen from the fluid.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The corners of each triangle.
    pub fn corners(&self) -> impl Iterator<Item = [Vector3<f64>; 3]> + '_ {
        self.triangles
            .iter()
            .map(|t| t.map(|i| self.vertices[i as usize]))
    }

    /// The surface with every vertex mapped by a motion or a uniform positive scaling.
    pub fn map(&self, f: impl Fn(Vector3<f64>) -> Vector3<f64>) -> Self {
        Self {
            vertices: self.vertices.iter().map(|v| f(*v)).collect(),
            triangles: self.triangles.clone(),
        }
    }

    /// Both surfaces, side by side. Where they overlap, the overlap counts twice, as it does in
    /// rapier's own mass properties.
    pub fn append(&mut self, other: &Self) {
        let offset = self.vertices.len() as u32;
        self.vertices.extend_from_slice(&other.vertices);
        self.triangles
            .extend(other.triangles.iter().map(|t| t.map(|i| i + offset)));
    }

    /// Diagonal of the bounding box, m.
    pub fn size(&self) -> f64 {
        let low = self
            .vertices
            .iter()
            .fold(Vector3::repeat(f64::INFINITY), |low, v| low.inf(v));
        let high = self
            .vertices
            .iter()
            .fold(Vector3::repeat(f64::NEG_INFINITY), |high, v| high.sup(v));
        (high - low).norm()
    }

    /// Volume, centroid and second moment of the enclosed space, exact for the mesh.
    pub fn volume_integrals(&self) -> VolumeIntegrals {
        // The tetrahedra share a point of the body, so that thin bodies far from the origin lose no digits.
        let origin = self.vertices[0];
        let (mut volume, mut first) = (0.0, Vector3::zeros());
        let mut second = Matrix3::zeros();
        for corners in self.corners() {
            let [a, b, c] = corners.map(|v| v - origin);
            let v = a.dot(&b.cross(&c)) / 6.0;
            let sum = a + b + c;
            volume += v;
            first += sum * (v / 4.0);
            second +=
                (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose())
                    * (v / 20.0);
        }
        if volume == 0.0 {
            return VolumeIntegrals {
                volume,
                centroid: origin,
                second_moment: Matrix3::zeros(),
            };
        }
        let shift = first / volume;
        VolumeIntegrals {
            volume,
            centroid: origin + shift,
            second_moment: second - shift * shift.transpose() * volume,
        }
    }

    /// Half the area that the surface shows to both sides along the unit vector `direction`, m²:
    /// the shadow of a body whose lines of sight in that direction enter and leave it once.
    pub fn projected_area(&self, direction: Vector3<f64>) -> f64 {
        self.corners()
            .map(|[a, b, c]| (b - a).cross(&(c - a)).dot(&direction).abs() / 4.0)
            .sum()
    }

    /// Whether the surface bounds one convex body: it is a sphere by its connections (Euler's formula), bends nowhere
    /// inward at an edge, and its angles at no corner add up to more than a whole turn. Such a surface is convex
    /// (Hadamard's theorem, for polyhedra).
    pub(crate) fn is_convex(&self) -> bool {
        let (vertices, triangles) = (self.vertices.len(), self.triangles.len());
        if vertices != triangles / 2 + 2 {
            return false;
        }
        let mut edges = Vec::with_capacity(3 * triangles);
        let mut turns = vec![0.0; vertices];
        for [a, b, c] in &self.triangles {
            for [i, j, k] in [[*a, *b, *c], [*b, *c, *a], [*c, *a, *b]] {
                edges.push((i.min(j), i.max(j), i < j, k));
                let [at, to, from] = [i, j, k].map(|i| self.vertices[i as usize]);
                turns[i as usize] += (to - at).angle(&(from - at));
            }
        }
        edges.sort_unstable();
        let rounding = 1e-9 * self.size();
        let bends_out = |pair: &[(u32, u32, bool, u32)]| {
            let [(i, j, true, k), (i2, j2, false, l)] = [pair[1], pair[0]] else {
                return false;
            };
            let [a, b, c, d] = [i, j, k, l].map(|i| self.vertices[i as usize]);
            let normal = (b - a).cross(&(c - a));
            (i, j) == (i2, j2) && (d - a).dot(&normal) <= rounding * normal.norm()
        };
        let whole = std::f64::consts::TAU * (1.0 + 1e-9);
        edges
            .chunks(2)
            .all(|pair| pair.len() == 2 && bends_out(pair))
            && turns.iter().all(|turn| *turn <= whole)
            && self.is_connected()
    }

    /// Whether all triangles hang together.
    fn is_connected(&self) -> bool {
        let mut bodies = self.bodies();
        bodies.dedup();
        bodies.len() == 1
    }

    /// Of each vertex the first of the body that it belongs to: triangles that share a vertex are one body.
    pub(crate) fn bodies(&self) -> Vec<u32> {
        fn root(before: &mut [u32], mut i: u32) -> u32 {
            while before[i as usize] != i {
                before[i as usize] = before[before[i as usize] as usize];
                i = before[i as usize];
            }
            i
        }
        // Each points at one of its own body that is not after it, the first of a body at itself.
        let mut before: Vec<u32> = (0..self.vertices.len() as u32).collect();
        for [a, b, c] in &self.triangles {
            for (i, j) in [(*a, *b), (*b, *c)] {
                let (i, j) = (root(&mut before, i), root(&mut before, j));
                before[i.max(j) as usize] = i.min(j);
            }
        }
        (0..before.len() as u32)
            .map(|i| root(&mut before, i))
            .collect()
    }

    /// Each edge must be used once in each direction.
    pub(crate) fn check_closed(&self) -> Result<(), Error> {
        let mut uses: HashMap<(u32, u32), i32> = HashMap::with_capacity(self.triangles.len() * 2);
        for [a, b, c] in &self.triangles {
            for (i, j) in [(*a, *b), (*b, *c), (*c, *a)] {
                let sign = if i < j { 1 } else { -1 };
                *uses.entry((i.min(j), i.max(j))).or_insert(0) += sign;
            }
        }
        let mut open: Vec<_> = uses
            .iter()
            .filter(|(_, n)| **n != 0)
            .map(|(e, _)| *e)
            .collect();
        open.sort_unstable();
        match open.first() {
            None => Ok(()),
            Some((i, j)) => Err(Error::OpenMesh {
                open_edges: open.len(),
                from: self.vertices[*i as usize].into(),
                to: self.vertices[*j as usize].into(),
            }),
        }
    }
}

/// Merges vertices at the same place, within 10⁻⁷ of the largest coordinate, and drops triangles that this
/// collapses.
fn weld(vertices: &[Vector3<f64>], triangles: &[[u32; 3]]) -> (Vec<Vector3<f64>>, Vec<[u32; 3]>) {
    let scale = vertices.iter().map(|v| v.amax()).fold(0.0, f64::max);
    if scale == 0.0 {
        return (Vec::new(), Vec::new());
    }
    let grid = 1e7 / scale;
    merge(vertices, triangles, |v| {
        <[i64; 3]>::from(v.map(|x| (x * grid).round() as i64))
    })
}

/// Merges vertices of the same `place`, and drops triangles that this collapses.
fn merge<P: Eq + Hash>(
    vertices: &[Vector3<f64>],
    triangles: &[[u32; 3]],
    place: impl Fn(&Vector3<f64>) -> P,
) -> (Vec<Vector3<f64>>, Vec<[u32; 3]>) {
    let mut seen = HashMap::with_capacity(vertices.len());
    let mut merged = Vec::with_capacity(vertices.len());
    let index: Vec<u32> = vertices
        .iter()
        .map(|v| {
            *seen.entry(place(v)).or_insert_with(|| {
                merged.push(*v);
                merged.len() as u32 - 1
            })
        })
        .collect();
    let triangles = triangles
        .iter()
        .map(|t| t.map(|i| index[i as usize]))
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect();
    (merged, triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn tetrahedron() -> (Vec<Vector3<f64>>, Vec<[u32; 3]>) {
        let v = vec![Vector3::zeros(), Vector3::x(), Vector3::y(), Vector3::z()];
        (v, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    }

    /// A ball of thousands of facets is convex, and a coin, whose faces are flat; a ball with a dent is not.
    #[test]
    fn many_facets_are_judged_too() {
        use rapier3d::parry::shape::{Ball, Cylinder};
        let ball = Surface::from_shape(&Ball::new(0.3)).unwrap();
        assert!(ball.triangles().len() > 1000 && ball.is_convex());
        assert!(
            Surface::from_shape(&Cylinder::new(0.01, 0.5))
                .unwrap()
                .is_convex()
        );
        // One vertex of the ball pulled in by a hundredth of its radius.
        let dented = ball.map(|v| {
            if v == ball.vertices()[77] {
                v * 0.99
            } else {
                v
            }
        });
        assert!(!dented.is_convex());
    }

    /// A tetrahedron is convex; with a vertex pushed in through the face before it, or put together from two, it is not.
    #[test]
    fn convex_bodies_are_known() {
        let (v, t) = tetrahedron();
        let one = Surface::new(&v, &t).unwrap();
        assert!(one.is_convex());
        let mut twice = one.clone();
        twice.append(&one);
        assert!(!twice.is_convex());
        let beside = one.map(|v| v + Vector3::x() * 3.0);
        let mut apart = one.clone();
        apart.append(&beside);
        assert!(!apart.is_convex());
        // The far face has a vertex in its middle, at the height of a dent or of a cap.
        for (height, convex) in [(-0.1, false), (0.1, true)] {
            let mut vertices = v.clone();
            vertices.push(Vector3::repeat((1.0 + height) / 3.0));
            let triangles = [
                [0, 2, 1],
                [0, 1, 3],
                [0, 3, 2],
                [1, 2, 4],
                [2, 3, 4],
                [3, 1, 4],
            ];
            let surface = Surface::new(&vertices, &triangles).unwrap();
            assert_eq!(surface.is_convex(), convex, "{height}");
        }
    }

    /// Unit corner tetrahedron: V = 1/6, centroid ¼, ∫x² dV = 1/60, ∫xy dV = 1/120.
    #[test]
    fn integrals_of_the_corner_tetrahedron() {
        let (v, t) = tetrahedron();
        let far = Vector3::new(100.0, -50.0, 7.0);
        let moved: Vec<_> = v.iter().map(|v| v + far).collect();
        for (vertices, shift) in [(v, Vector3::zeros()), (moved, far)] {
            let surface = Surface::new(&vertices, &t).unwrap();
            let i = surface.volume_integrals();
            assert_relative_eq!(i.volume, 1.0 / 6.0, max_relative = 1e-12);
            assert_relative_eq!(i.centroid, shift + Vector3::repeat(0.25), epsilon = 1e-12);
            let about_centroid = 1.0 / 60.0 - 1.0 / 96.0;
            assert_relative_eq!(
                i.second_moment[(0, 0)],
                about_centroid,
                max_relative = 1e-10
            );
            let product = 1.0 / 120.0 - 1.0 / 96.0;
            assert_relative_eq!(i.second_moment[(0, 1)], product, max_relative = 1e-10);
            assert_relative_eq!(
                surface.projected_area(Vector3::z()),
                0.5,
                max_relative = 1e-12
            );
        }
    }

    #[test]
    fn inside_out_is_turned_and_open_is_refused() {
        let (v, t) = tetrahedron();
        let inverted: Vec<_> = t.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
        let surface = Surface::new(&v, &inverted).unwrap();
        assert!(surface.volume_integrals().volume > 0.0);

        let open = Surface::new(&v, &t[..3]).unwrap_err();
        assert!(
            matches!(open, Error::OpenMesh { open_edges: 3, .. }),
            "{open}"
        );
        assert_eq!(Surface::new(&v, &[]), Err(Error::EmptyMesh));
        assert!(matches!(
            Surface::new(&v, &[[0, 1, 9]]),
            Err(Error::IndexOutOfRange {
                index: 9,
                vertices: 4
            })
        ));
        let mut bad = v;
        bad[2].y = f64::NAN;
        assert_eq!(
            Surface::new(&bad, &t),
            Err(Error::NonFiniteVertex { index: 2 })
        );
    }

    /// A flat double-sided sheet is closed but encloses nothing.
    #[test]
    fn double_sheet_has_no_volume() {
        let v = [Vector3::zeros(), Vector3::x(), Vector3::y()];
        let flat = Surface::new(&v, &[[0, 1, 2], [0, 2, 1]]);
        assert!(matches!(flat, Err(Error::NoVolume { .. })));
    }
}
