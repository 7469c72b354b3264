//! Convex polyhedra grown by a ball on all sides, as rapier's rounded shapes are.
//!
//! The surface is put together from what it is made of: each face moved out, a strip of a cylinder along each
//! edge, a piece of a sphere at each vertex. It is closed because its parts share their vertices, however
//! thin the border or the core. A core may be flat (two faces, back to back) or have edges of no length.

use super::Surface;
use crate::error::Error;
use crate::math;
use rapier3d::na::Vector3;
use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Largest angle between neighboring vertices of the sphere for boundary elements, of which there may not be too many.
pub(super) const COARSE: f64 = PI / 12.0;

/// The core of a rounded shape. Rotating about the edge from one face's normal to the other's sweeps the
/// directions that its part of the surface faces.
pub(super) struct Core {
    points: Vec<Vector3<f64>>,
    /// Vertices of each face, counter-clockwise seen from outside.
    faces: Vec<Vec<u32>>,
    normals: Vec<Vector3<f64>>,
}

impl Core {
    /// A box by its half extents, any of which may be zero.
    pub(super) fn cuboid(half: Vector3<f64>) -> Self {
        let points = (0..8)
            .map(|corner| {
                Vector3::from_fn(|k, _| {
                    if corner >> k & 1 == 1 {
                        half[k]
                    } else {
                        -half[k]
                    }
                })
            })
            .collect();
        let (mut faces, mut normals) = (Vec::new(), Vec::new());
        for k in 0..3 {
            let (a, b) = (1 << ((k + 1) % 3), 1 << ((k + 2) % 3));
            let mut normal = Vector3::zeros();
            normal[k] = 1.0;
            let top = 1 << k;
            faces.push(vec![top, top | a, top | a | b, top | b]);
            faces.push(vec![b, a | b, a, 0]);
            normals.extend([normal, -normal]);
        }
        Self {
            points,
            faces,
            normals,
        }
    }

    /// A triangle, seen from both sides.
    pub(super) fn triangle(points: [Vector3<f64>; 3]) -> Self {
        let [a, b, c] = points;
        let longest = [b - a, c - b, a - c]
            .into_iter()
            .max_by(|p, q| p.norm_squared().total_cmp(&q.norm_squared()))
            .unwrap_or_default();
        // A triangle that is a line faces any way across it.
        let across = (b - a).cross(&(c - a));
        let normal = if across.norm() > 1e-12 * longest.norm_squared() {
            across.normalize()
        } else {
            longest.cross(&smallest_axis(longest)).normalize()
        };
        Self {
            points: points.to_vec(),
            faces: vec![vec![0, 1, 2], vec![2, 1, 0]],
            normals: vec![normal, -normal],
        }
    }

    /// A convex polyhedron. `normals` stand in for those of faces that have no area.
    pub(super) fn polyhedron(
        points: Vec<Vector3<f64>>,
        faces: Vec<Vec<u32>>,
        normals: &[Vector3<f64>],
    ) -> Self {
        let normals = faces.iter().zip(normals).map(|(face, given)| {
            let area = area_vector(&points, face);
            let first = points[face[0] as usize];
            let size = face
                .iter()
                .map(|i| (points[*i as usize] - first).norm())
                .fold(0.0, f64::max);
            if area.norm() > 1e-12 * size * size {
                area.normalize()
            } else {
                *given
            }
        });
        Self {
            normals: normals.collect(),
            points,
            faces,
        }
    }

    /// Steiner's formula V + S r + M r² + 4π/3 r³, with the integral of the mean curvature
    /// M = ½ Σ length · angle over the edges, m³.
    pub(super) fn grown_volume(&self, border: f64) -> Result<f64, Error> {
        let origin = self.points[0];
        let (mut volume, mut area, mut curvature) = (0.0, 0.0, 0.0);
        for (face, normal) in self.faces.iter().zip(&self.normals) {
            let vector = area_vector(&self.points, face);
            volume += vector.dot(&(self.points[face[0] as usize] - origin)) / 3.0;
            area += vector.dot(normal);
        }
        for edge in self.edges()? {
            curvature += 0.5 * edge.angle * self.along(&edge).norm();
        }
        let r = border;
        Ok(volume + area * r + curvature * r * r + 4.0 / 3.0 * PI * r.powi(3))
    }

    /// The surface of the core grown by `border` on all sides, a polyhedron of exactly its volume with at most
    /// `step` between the directions of neighbors.
    pub(super) fn grown(&self, border: f64, step: f64) -> Result<Surface, Error> {
        let volume = self.grown_volume(border)?;
        let skin = Skin::around(self, step)?;
        let surface = |r: f64| Surface::assembled(&skin.vertices(&self.points, r), &skin.triangles);
        // The inscribed polyhedron has too little by some tenths of a per cent: its border is made wider.
        let (mut r, mut found) = (border, surface(border)?);
        let mut slope = None;
        for _ in 0..8 {
            let missing = volume - found.volume_integrals().volume;
            if missing.abs() <= 1e-13 * volume || border == 0.0 {
                break;
            }
            // The first step takes the slope of a ball, which is right if the core is small.
            let wider = match slope {
                None => missing * border / (3.0 * volume),
                Some((wider, gained)) if gained != 0.0 => missing * wider / gained,
                Some(_) => break,
            };
            r += wider;
            let next = surface(r)?;
            let gained = next.volume_integrals().volume - (volume - missing);
            slope = Some((wider, gained));
            found = next;
        }
        Ok(found)
    }

    fn along(&self, edge: &Edge) -> Vector3<f64> {
        self.points[edge.ends[1] as usize] - self.points[edge.ends[0] as usize]
    }

    /// All edges, in the order of the faces that they are met at first.
    fn edges(&self) -> Result<Vec<Edge>, Error> {
        let owners = self.owners();
        let mut edges = Vec::with_capacity(owners.len() / 2);
        for (face, loop_) in self.faces.iter().enumerate() {
            for (from, to) in sides(loop_) {
                if from > to {
                    continue;
                }
                let other = *owners.get(&(to, from)).ok_or_else(|| self.open(from, to))?;
                let mut edge = Edge {
                    ends: [from, to],
                    faces: [face, other],
                    direction: Vector3::zeros(),
                    angle: 0.0,
                };
                let [n, m] = edge.faces.map(|i| self.normals[i]);
                // The normals say where the edge points, if they differ; faces that are back to back, or
                // all but parallel, leave it to the edge, and one of no length may point anywhere.
                let (across, along) = (n.cross(&m), self.along(&edge));
                edge.direction = if across.norm() > 1e-3 {
                    let sign = if across.dot(&along) < 0.0 { -1.0 } else { 1.0 };
                    across.normalize() * sign
                } else {
                    let along = along - n * along.dot(&n);
                    let usable = along.norm() > 0.0;
                    let along = if usable {
                        along
                    } else {
                        n.cross(&smallest_axis(n))
                    };
                    along.normalize()
                };
                edge.angle = math::atan2(across.dot(&edge.direction), n.dot(&m));
                if edge.angle < -FRAC_PI_2 {
                    edge.angle += TAU;
                }
                edges.push(edge);
            }
        }
        Ok(edges)
    }

    /// The face to the left of each side.
    fn owners(&self) -> HashMap<(u32, u32), usize> {
        let faces = self.faces.iter().enumerate();
        faces
            .flat_map(|(face, loop_)| sides(loop_).map(move |side| (side, face)))
            .collect()
    }

    fn open(&self, from: u32, to: u32) -> Error {
        Error::OpenMesh {
            open_edges: 1,
            from: self.points[from as usize].into(),
            to: self.points[to as usize].into(),
        }
    }
}

/// An edge of a core: from `ends[0]` to `ends[1]` counter-clockwise around `faces[0]`.
struct Edge {
    ends: [u32; 2],
    faces: [usize; 2],
    /// Unit vector along it.
    direction: Vector3<f64>,
    /// Angle from the first face's normal to the second's about the direction.
    angle: f64,
}

fn sides(face: &[u32]) -> impl Iterator<Item = (u32, u32)> + '_ {
    (0..face.len()).map(|i| (face[i], face[(i + 1) % face.len()]))
}

/// The area of a polygon along its normal.
fn area_vector(points: &[Vector3<f64>], face: &[u32]) -> Vector3<f64> {
    let first = points[face[0] as usize];
    let corner = |i: u32| points[i as usize] - first;
    sides(face)
        .map(|(i, j)| corner(i).cross(&corner(j)) * 0.5)
        .sum()
}

fn smallest_axis(v: Vector3<f64>) -> Vector3<f64> {
    let mut axis = Vector3::zeros();
    axis[v.iamin()] = 1.0;
    axis
}

/// The surface around a core: each vertex lies in a direction from one of its points.
struct Skin {
    vertices: Vec<(u32, Vector3<f64>)>,
    triangles: Vec<[u32; 3]>,
    /// Largest angle between neighboring vertices.
    step: f64,
}

impl Skin {
    fn around(core: &Core, step: f64) -> Result<Self, Error> {
        let mut skin = Self {
            step,
            vertices: Vec::new(),
            triangles: Vec::new(),
        };
        // Vertices of each face's corners: (face, point).
        let mut corners = HashMap::new();
        for (face, loop_) in core.faces.iter().enumerate() {
            let start = skin.vertices.len() as u32;
            for point in loop_ {
                let vertex = skin.vertex(*point, core.normals[face]);
                corners.insert((face, *point), vertex);
            }
            let fan = (1..loop_.len() as u32 - 1).map(|i| [start, start + i, start + i + 1]);
            skin.triangles.extend(fan);
        }
        // Vertices along the arc at each end of an edge, keyed by the directed side away from the end:
        // from the face to its right to the face to its left.
        let mut arcs = HashMap::new();
        for edge in core.edges()? {
            let n = core.normals[edge.faces[0]];
            let sideways = edge.direction.cross(&n).normalize();
            let count = (edge.angle.abs() / step).ceil().max(1.0) as usize;
            let [near, far] = edge.ends.map(|end| {
                let mut arc = vec![corners[&(edge.faces[0], end)]];
                for i in 1..count {
                    let (sin, cos) = math::sin_cos(edge.angle * i as f64 / count as f64);
                    arc.push(skin.vertex(end, n * cos + sideways * sin));
                }
                arc.push(corners[&(edge.faces[1], end)]);
                arc
            });
            for i in 0..count {
                skin.triangles.push([far[i], near[i], near[i + 1]]);
                skin.triangles.push([far[i], near[i + 1], far[i + 1]]);
            }
            let [from, to] = edge.ends;
            arcs.insert((from, to), near.into_iter().rev().collect::<Vec<_>>());
            arcs.insert((to, from), far);
        }
        skin.close_points(core, &arcs)?;
        Ok(skin)
    }

    /// The pieces of spheres at the points. Each is bounded by the arcs of the edges around the point.
    fn close_points(
        &mut self,
        core: &Core,
        arcs: &HashMap<(u32, u32), Vec<u32>>,
    ) -> Result<(), Error> {
        let owners = core.owners();
        let mut before = HashMap::new();
        for (face, loop_) in core.faces.iter().enumerate() {
            before.extend(sides(loop_).map(|(from, to)| ((face, to), from)));
        }
        let mut done = vec![false; core.points.len()];
        for (first, loop_) in core.faces.iter().enumerate() {
            for point in loop_ {
                if std::mem::replace(&mut done[*point as usize], true) {
                    continue;
                }
                let mut boundary: Vec<u32> = Vec::new();
                let mut face = first;
                for _ in 0..core.faces.len() {
                    let other = before[&(face, *point)];
                    let open = || core.open(*point, other);
                    let arc = arcs.get(&(*point, other)).ok_or_else(open)?;
                    boundary.extend(&arc[..arc.len() - 1]);
                    face = *owners.get(&(*point, other)).ok_or_else(open)?;
                    if face == first {
                        break;
                    }
                }
                self.cap(*point, &boundary);
            }
        }
        Ok(())
    }

    /// A piece of a sphere about a point, in rings from its boundary to its middle.
    fn cap(&mut self, point: u32, boundary: &[u32]) {
        let edge: Vec<_> = boundary
            .iter()
            .map(|i| self.vertices[*i as usize].1)
            .collect();
        // The mean direction of the piece is half the moment of its boundary; where the boundary goes there
        // and back and leaves no piece, any of its directions will do.
        let next = |i: usize| (i + 1) % boundary.len();
        let moment: Vector3<f64> = (0..edge.len()).map(|i| edge[i].cross(&edge[next(i)])).sum();
        let sum: Vector3<f64> = edge.iter().sum();
        let middle = moment.try_normalize(1e-9).or(sum.try_normalize(1e-9));
        let middle = middle.unwrap_or(edge[0]);
        let widest = edge.iter().map(|d| middle.angle(d)).fold(0.0, f64::max);
        let rings = (widest / self.step).ceil().max(1.0) as usize;
        let mut outer = boundary.to_vec();
        for ring in 1..rings {
            let t = ring as f64 / rings as f64;
            let inner: Vec<u32> = edge
                .iter()
                .map(|d| self.vertex(point, toward(*d, middle, t)))
                .collect();
            for i in 0..boundary.len() {
                let j = next(i);
                self.triangles.push([outer[i], outer[j], inner[j]]);
                self.triangles.push([outer[i], inner[j], inner[i]]);
            }
            outer = inner;
        }
        let center = self.vertex(point, middle);
        for i in 0..boundary.len() {
            self.triangles.push([outer[i], outer[next(i)], center]);
        }
    }

    fn vertex(&mut self, point: u32, direction: Vector3<f64>) -> u32 {
        self.vertices.push((point, direction));
        self.vertices.len() as u32 - 1
    }

    fn vertices(&self, points: &[Vector3<f64>], border: f64) -> Vec<Vector3<f64>> {
        let at =
            |(point, direction): &(u32, Vector3<f64>)| points[*point as usize] + direction * border;
        self.vertices.iter().map(at).collect()
    }
}

/// The direction at the share `t` of the way from one to another, along the great circle.
fn toward(from: Vector3<f64>, to: Vector3<f64>, t: f64) -> Vector3<f64> {
    let angle = from.angle(&to);
    let sin = math::sin(angle);
    if sin < 1e-9 {
        return from;
    }
    (from * math::sin((1.0 - t) * angle) + to * math::sin(t * angle)) / sin
}

#[cfg(test)]
mod tests {
    use super::super::revolution::Facets;
    use super::*;
    use approx::assert_relative_eq;

    /// ∫ f over [low, high] by Simpson's rule.
    fn integrate(low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
        const N: usize = 2000;
        let h = (high - low) / N as f64;
        let weight = |i| match i {
            0 | N => 1.0,
            i if i % 2 == 1 => 4.0,
            _ => 2.0,
        };
        (0..=N)
            .map(|i| weight(i) * f(low + h * i as f64))
            .sum::<f64>()
            * h
            / 3.0
    }

    /// A box with half extents a, b, c and a border r: cross-sections across x are rectangles with borders,
    /// of the width r up to |x| = a and √(r² − (|x| − a)²) beyond.
    fn sections([a, b, c]: [f64; 3], r: f64, weight: impl Fn(f64) -> f64) -> f64 {
        let area = |w: f64| 4.0 * b * c + 4.0 * (b + c) * w + PI * w * w;
        // x = a + r sin t takes the root out of the end of the integral.
        let cap = |t: f64| weight(a + r * t.sin()) * area(r * t.cos()) * r * t.cos();
        2.0 * integrate(0.0, a, |x| weight(x) * area(r)) + 2.0 * integrate(0.0, PI / 2.0, cap)
    }

    /// Volume and second moments of boxes of all aspects against integrals over their cross-sections:
    /// leaves with borders of micrometres, needles, plates that are all border, dice that are all but balls.
    #[test]
    fn boxes_against_their_cross_sections() {
        for (half, r) in [
            ([0.4, 0.6, 0.2], 0.05),
            ([0.0365, 0.00015, 0.021], 3e-6),
            ([0.0365, 0.0005, 0.021], 0.00005),
            ([1.0, 0.001, 0.001], 1.0),
            ([1.0, 0.002, 0.7], 0.3),
            ([50.0, 1e-5, 1e-5], 1e-3),
            ([0.5, 0.0, 0.5], 1e-3),
            ([0.0, 2.0, 0.0], 0.5),
            ([0.001, 0.001, 0.001], 1.0),
            ([1.0, 1.0, 1.0], 1e-6),
        ] {
            let core = Core::cuboid(Vector3::from(half));
            let found = core.grown(r, Facets::FINE.step).unwrap().volume_integrals();
            let volume = sections(half, r, |_| 1.0);
            assert_relative_eq!(core.grown_volume(r).unwrap(), volume, max_relative = 1e-9);
            assert_relative_eq!(found.volume, volume, max_relative = 1e-12);
            let size = half.iter().fold(r, |size, x| size.max(x + r));
            assert!(found.centroid.norm() < 1e-12 * size, "{half:?} {r}");
            for k in 0..3 {
                let turned = [half[k], half[(k + 1) % 3], half[(k + 2) % 3]];
                let second = sections(turned, r, |x| x * x);
                // The sphere's facets of 7.5° leave out up to 1 − cos 3.75° = 2·10⁻³ of its radius; the
                // right volume takes most of it back.
                let moment = found.second_moment[(k, k)];
                assert_relative_eq!(moment, second, max_relative = 1e-3);
            }
        }
    }

    /// Triangles have the volume 2 A r + ½ P r² π + 4π/3 r³; one that is a line is a capsule.
    #[test]
    fn triangles_are_plates_with_round_edges() {
        let point = |x: f64, y: f64| Vector3::new(x, 0.3 * x, y);
        for points in [
            [point(0.0, 0.0), point(1.0, 0.0), point(0.2, 0.7)],
            [point(0.0, 0.0), point(3.0, 0.0), point(1.0, 1e-4)],
            [point(0.0, 0.0), point(1.0, 1.0), point(3.0, 3.0)],
            [point(3.0, 3.0), point(0.0, 0.0), point(1.0, 1.0)],
            [point(0.0, 0.0), point(0.0, 0.0), point(2.0, 1.0)],
        ] {
            let [a, b, c] = points;
            let area = (b - a).cross(&(c - a)).norm() / 2.0;
            let perimeter = (b - a).norm() + (c - b).norm() + (a - c).norm();
            for r in [1e-5, 0.02, 1.0, 30.0] {
                let exact =
                    2.0 * area * r + PI / 2.0 * perimeter * r * r + 4.0 / 3.0 * PI * r.powi(3);
                let surface = Core::triangle(points).grown(r, Facets::FINE.step).unwrap();
                let found = surface.volume_integrals();
                // Products of vertices at the far end of a needle across all axes have lost (length/r)²
                // of their digits.
                let length = 0.5 * perimeter;
                let tolerance = 1e-9 + f64::EPSILON * (length / r).powi(2);
                assert_relative_eq!(found.volume, exact, max_relative = tolerance);
            }
        }
    }

    /// A face that leaves its neighbor without a partner is an error, not a panic.
    #[test]
    fn open_cores_are_refused() {
        let mut core = Core::cuboid(Vector3::repeat(1.0));
        core.faces.pop();
        core.normals.pop();
        assert!(matches!(
            core.grown(0.1, Facets::FINE.step),
            Err(Error::OpenMesh { .. })
        ));
    }
}
