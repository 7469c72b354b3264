//! The closed surface of a body as a free surface cuts it: volume, centroid and waterplane of what is under.
//!
//! # Integrals without a cap
//! With d the depth of a point under the free surface, the field (0, −d, 0) has divergence one and vanishes where the
//! body is cut. So the volume under water is `−∫ d n_y dS` over the wetted part of the body's own surface alone: a sum
//! of prisms between each wetted triangle and the free surface, signed by the way the triangle faces. The surface need
//! not be a plane, no cap has to be built, and the integrals of x, y, z over the volume and of 1, x, z, x², xz, z² over
//! the waterplane come from the same triangles. For a polyhedron and a plane all of them are exact.

use crate::geometry::{Ellipsoid, Surface};
use rapier3d::na::{Matrix3, Rotation3, Vector3};
use std::f64::consts::PI;

/// Corners that are looked at once for all of their triangles; of a hull that has more, once for each.
const SHARED_CORNERS: usize = 64;

/// The closed surface of a body or part.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Hull {
    /// An ellipsoid: cut in closed form.
    Ellipsoid {
        /// Its center, m.
        center: Vector3<f64>,
        /// From its own axes to the frame.
        axes: Rotation3<f64>,
        /// Its semi-axes.
        shape: Ellipsoid,
    },
    /// A polyhedron, its triangles counter-clockwise seen from the fluid.
    Polyhedron {
        /// Its corners, m.
        vertices: Vec<Vector3<f64>>,
        /// Indices of each triangle's corners.
        triangles: Vec<[u32; 3]>,
    },
}

/// What of a hull is under a free surface: level axes, y up, about the point that positions are counted from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Submerged {
    /// Its volume, m³.
    pub volume: f64,
    /// `∫ r dV`, m⁴.
    pub moment: Vector3<f64>,
    /// Where the free surface cuts the body.
    pub waterplane: Waterplane,
}

/// The area that a body cuts out of a free surface, seen from above.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Waterplane {
    /// Area, m².
    pub area: f64,
    /// `∫ x dA` and `∫ z dA`, m³.
    pub first: [f64; 2],
    /// `∫ x² dA`, `∫ xz dA`, `∫ z² dA`, m⁴.
    pub second: [f64; 3],
}

impl Submerged {
    /// Adds the prism between a wetted triangle and the free surface. Corners are given with their depths.
    #[inline(always)]
    fn add_prism(&mut self, corners: [(Vector3<f64>, f64); 3]) {
        let [(a, da), (b, db), (c, dc)] = corners;
        // Twice the area seen from above of a face that looks down.
        let twice = (b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x);
        let (third, twelfth) = (twice / 6.0, twice / 24.0);
        // ∫ f g of two linear functions is Area/12 (Σf Σg + Σ fg).
        let product = |f: [f64; 3], g: [f64; 3]| {
            let sums = (f[0] + f[1] + f[2]) * (g[0] + g[1] + g[2]);
            twelfth * (sums + f[0] * g[0] + f[1] * g[1] + f[2] * g[2])
        };
        let (x, z, d) = ([a.x, b.x, c.x], [a.z, b.z, c.z], [da, db, dc]);
        let middle = [a.y + 0.5 * da, b.y + 0.5 * db, c.y + 0.5 * dc];
        self.volume += third * (da + db + dc);
        self.moment.x += product(x, d);
        self.moment.y += product(middle, d);
        self.moment.z += product(z, d);
        let plane = &mut self.waterplane;
        plane.area += 0.5 * twice;
        plane.first[0] += third * (a.x + b.x + c.x);
        plane.first[1] += third * (a.z + b.z + c.z);
        plane.second[0] += product(x, x);
        plane.second[1] += product(x, z);
        plane.second[2] += product(z, z);
    }

    /// Adds what of a triangle is wetted.
    #[inline(always)]
    fn add_triangle(&mut self, corners: [(Vector3<f64>, f64); 3]) {
        let [a, b, c] = corners;
        let wet = [a.1 > 0.0, b.1 > 0.0, c.1 > 0.0];
        let cut = |under: (Vector3<f64>, f64), over: (Vector3<f64>, f64)| {
            let share = under.1 / (under.1 - over.1);
            (under.0 + (over.0 - under.0) * share, 0.0)
        };
        match wet {
            [false, false, false] => {}
            [true, true, true] => self.add_prism(corners),
            // Turned so that the corner that is alone comes first.
            [true, false, false] => self.add_prism([a, cut(a, b), cut(a, c)]),
            [false, true, false] => self.add_prism([b, cut(b, c), cut(b, a)]),
            [false, false, true] => self.add_prism([c, cut(c, a), cut(c, b)]),
            [false, true, true] => self.add_quadrilateral([b, c, cut(c, a), cut(b, a)]),
            [true, false, true] => self.add_quadrilateral([c, a, cut(a, b), cut(c, b)]),
            [true, true, false] => self.add_quadrilateral([a, b, cut(b, c), cut(a, c)]),
        }
    }

    fn add_quadrilateral(&mut self, [a, b, c, d]: [(Vector3<f64>, f64); 4]) {
        self.add_prism([a, b, c]);
        self.add_prism([a, c, d]);
    }
}

impl Hull {
    /// The hull of a closed surface.
    pub fn from_surface(surface: &Surface) -> Self {
        Self::Polyhedron {
            vertices: surface.vertices().to_vec(),
            triangles: surface.triangles().to_vec(),
        }
    }

    /// Number of triangles that a cut looks at; none for an ellipsoid.
    pub fn triangles(&self) -> usize {
        match self {
            Self::Ellipsoid { .. } => 0,
            Self::Polyhedron { triangles, .. } => triangles.len(),
        }
    }

    /// The hull in another frame.
    pub fn posed(&self, rotation: &Rotation3<f64>, translation: &Vector3<f64>) -> Self {
        match self {
            Self::Ellipsoid {
                center,
                axes,
                shape,
            } => Self::Ellipsoid {
                center: rotation * center + translation,
                axes: rotation * axes,
                shape: *shape,
            },
            Self::Polyhedron {
                vertices,
                triangles,
            } => Self::Polyhedron {
                vertices: vertices
                    .iter()
                    .map(|v| rotation * v + translation)
                    .collect(),
                triangles: triangles.clone(),
            },
        }
    }

    /// Largest distance of a point of the hull from the origin, m.
    pub fn radius(&self) -> f64 {
        match self {
            Self::Ellipsoid { center, shape, .. } => center.norm() + shape.semi_axes.max(),
            Self::Polyhedron { vertices, .. } => {
                vertices.iter().map(|v| v.norm()).fold(0.0, f64::max)
            }
        }
    }

    /// Whether every number is finite, every index that of a vertex, and no semi-axis negative.
    pub fn is_valid(&self) -> bool {
        match self {
            Self::Ellipsoid {
                center,
                axes,
                shape,
            } => {
                let finite = center.iter().chain(axes.matrix()).all(|x| x.is_finite());
                finite && shape.semi_axes.iter().all(|x| x.is_finite() && *x >= 0.0)
            }
            Self::Polyhedron {
                vertices,
                triangles,
            } => {
                let count = vertices.len() as u32;
                vertices.iter().all(|v| v.iter().all(|x| x.is_finite()))
                    && triangles.iter().flatten().all(|i| *i < count)
            }
        }
    }

    /// What is under a plane: `depth` is how far the point that positions are counted from is under it, along y, and
    /// `slope` how fast the surface rises along x and z. `turn` maps the hull's frame to level axes.
    pub fn under_plane(&self, turn: &Matrix3<f64>, depth: f64, slope: [f64; 2]) -> Submerged {
        let [along_x, along_z] = slope;
        let normal = Vector3::new(-along_x, 1.0, -along_z);
        match self {
            Self::Ellipsoid {
                center,
                axes,
                shape,
            } => under_ellipsoid(
                turn * center,
                &(turn * axes.matrix()),
                shape,
                depth,
                &normal,
            ),
            Self::Polyhedron { .. } => self.under(turn, |r| depth - normal.dot(r)),
        }
    }

    /// What is under any surface. `depth` says how far a point, given in level axes, is under it along y; negative above.
    /// An ellipsoid is cut by the plane that touches this surface over or under its center.
    pub fn under(&self, turn: &Matrix3<f64>, depth: impl Fn(&Vector3<f64>) -> f64) -> Submerged {
        let (vertices, triangles) = match self {
            Self::Ellipsoid { center, shape, .. } => {
                let at = turn * center;
                let step = (1e-3 * shape.semi_axes.max()).max(1e-9);
                let along = |axis: Vector3<f64>| {
                    let [ahead, behind] = [at + axis * step, at - axis * step].map(|r| depth(&r));
                    (ahead - behind) / (2.0 * step)
                };
                let slope = [along(Vector3::x()), along(Vector3::z())];
                let here = depth(&at) + at.y - slope[0] * at.x - slope[1] * at.z;
                return self.under_plane(turn, here, slope);
            }
            Self::Polyhedron {
                vertices,
                triangles,
            } => (vertices, triangles),
        };
        let mut submerged = Submerged::default();
        let place = |v: &Vector3<f64>| {
            let r = turn * v;
            (r, depth(&r))
        };
        if vertices.len() <= SHARED_CORNERS {
            let mut placed = [(Vector3::zeros(), 0.0); SHARED_CORNERS];
            for (to, v) in placed.iter_mut().zip(vertices) {
                *to = place(v);
            }
            for triangle in triangles {
                submerged.add_triangle(triangle.map(|i| placed[i as usize % SHARED_CORNERS]));
            }
        } else {
            for triangle in triangles {
                let corner = |i: u32| {
                    vertices
                        .get(i as usize)
                        .map_or((Vector3::zeros(), -1.0), place)
                };
                submerged.add_triangle(triangle.map(corner));
            }
        }
        submerged
    }
}

/// What of an ellipsoid is under a plane, by the affine map that makes it the unit sphere. `axes` maps its own axes to
/// level ones.
fn under_ellipsoid(
    center: Vector3<f64>,
    axes: &Matrix3<f64>,
    shape: &Ellipsoid,
    depth: f64,
    normal: &Vector3<f64>,
) -> Submerged {
    let stretch = axes * Matrix3::from_diagonal(&shape.semi_axes);
    let scale = shape.semi_axes.product();
    let toward = stretch.transpose() * normal;
    let reach = toward.norm();
    let height = depth - normal.dot(&center);
    if height <= -reach || reach == 0.0 {
        return Submerged::default();
    }
    let whole = 4.0 / 3.0 * PI * scale;
    if height >= reach {
        return Submerged {
            volume: whole,
            moment: center * whole,
            waterplane: Waterplane::default(),
        };
    }
    // The plane cuts the unit sphere at q·m = t.
    let (m, t) = (toward / reach, height / reach);
    let disc = 1.0 - t * t;
    let volume = scale * PI * (2.0 / 3.0 + t - t * t * t / 3.0);
    let area = scale * PI * disc / reach;
    let off = stretch * m;
    let middle = center + off * t;
    let spread = (stretch * stretch.transpose() - off * off.transpose()) * (0.25 * disc);
    let second = |i: usize, j: usize| area * (middle[i] * middle[j] + spread[(i, j)]);
    Submerged {
        volume,
        moment: center * volume - off * (scale * 0.25 * PI * disc * disc),
        waterplane: Waterplane {
            area,
            first: [area * middle.x, area * middle.z],
            second: [second(0, 0), second(0, 2), second(2, 2)],
        },
    }
}
