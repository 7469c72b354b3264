//! What a free surface cuts off a hull, and the area that the hull cuts out of the free surface.
//!
//! With d the depth of a point under the free surface, the field (0, −d, 0) has divergence one and vanishes where the
//! body is cut. So the volume under water is `−∫ d n_y dS` over the wetted part of the body's own surface alone: a sum
//! of prisms between each wetted triangle and the free surface, signed by the way the triangle faces. The free surface
//! need not be a plane, and no cap has to be built. The integrals over the waterplane come from its outline, the
//! segments in which triangles are cut, by Green's theorem.

use crate::geometry::Ellipsoid;
use rapier3d::na::{Matrix3, Vector3};
use std::f64::consts::PI;
use std::ops::AddAssign;

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

impl AddAssign for Submerged {
    fn add_assign(&mut self, other: Self) {
        self.volume += other.volume;
        self.moment += other.moment;
        let (plane, more) = (&mut self.waterplane, &other.waterplane);
        plane.area += more.area;
        (0..2).for_each(|i| plane.first[i] += more.first[i]);
        (0..3).for_each(|i| plane.second[i] += more.second[i]);
    }
}

/// A point in level axes, and its depth.
pub(super) type Corner = (Vector3<f64>, f64);

impl Waterplane {
    /// Adds the triangle between the origin and a segment of the outline, seen from above.
    #[inline(always)]
    fn add_segment(&mut self, p: &Vector3<f64>, q: &Vector3<f64>) {
        let twice = p.x * q.z - p.z * q.x;
        self.area += 0.5 * twice;
        let sixth = twice / 6.0;
        let (x, z) = (p.x + q.x, p.z + q.z);
        self.first[0] += sixth * x;
        self.first[1] += sixth * z;
        // ∫ f g of functions that vanish at the origin.
        let twelfth = 0.5 * sixth;
        self.second[0] += twelfth * (x * x - p.x * q.x);
        self.second[1] += 0.5 * twelfth * (x * z + p.x * p.z + q.x * q.z);
        self.second[2] += twelfth * (z * z - p.z * q.z);
    }
}

impl Submerged {
    /// Adds the prism between a wetted triangle and the free surface.
    #[inline(always)]
    fn add_prism(&mut self, [(a, da), (b, db), (c, dc)]: [&Corner; 3]) {
        // Twice the area seen from above of a face that looks down.
        let twice = (b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x);
        let sum = da + db + dc;
        // ∫ f d of two linear functions is Area/12 (Σf Σd + Σ fd).
        let product = |f: [f64; 3]| (f[0] + f[1] + f[2]) * sum + f[0] * da + f[1] * db + f[2] * dc;
        // The middle of the line up to the surface.
        let middle = [a.y + 0.5 * da, b.y + 0.5 * db, c.y + 0.5 * dc];
        let products = Vector3::new(
            product([a.x, b.x, c.x]),
            product(middle),
            product([a.z, b.z, c.z]),
        );
        self.volume += twice / 6.0 * sum;
        self.moment += products * (twice / 24.0);
    }

    /// Adds what of a triangle is wetted.
    #[inline(always)]
    pub(super) fn add_triangle(&mut self, [a, b, c]: [&Corner; 3]) {
        // Turned so that the corner that is alone comes first.
        match [a.1 > 0.0, b.1 > 0.0, c.1 > 0.0] {
            [false, false, false] => {}
            [true, true, true] => self.add_prism([a, b, c]),
            [true, false, false] => self.add_tip([a, b, c]),
            [false, true, false] => self.add_tip([b, c, a]),
            [false, false, true] => self.add_tip([c, a, b]),
            [false, true, true] => self.add_stump([a, b, c]),
            [true, false, true] => self.add_stump([b, c, a]),
            [true, true, false] => self.add_stump([c, a, b]),
        }
    }

    /// Adds the wetted corner `a` of a triangle.
    #[inline(always)]
    fn add_tip(&mut self, [a, b, c]: [&Corner; 3]) {
        let (p, q) = (cut(a, b), cut(a, c));
        self.add_prism([a, &p, &q]);
        self.waterplane.add_segment(&p.0, &q.0);
    }

    /// Adds what is left of a triangle whose corner `a` is above.
    #[inline(always)]
    fn add_stump(&mut self, [a, b, c]: [&Corner; 3]) {
        let (p, q) = (cut(c, a), cut(b, a));
        self.add_prism([b, c, &p]);
        self.add_prism([b, &p, &q]);
        self.waterplane.add_segment(&p.0, &q.0);
    }
}

/// Where the line from a point under to one above the free surface meets it. Both triangles of an edge find the same.
#[inline(always)]
fn cut(under: &Corner, over: &Corner) -> Corner {
    let share = under.1 / (under.1 - over.1);
    (under.0 + (over.0 - under.0) * share, 0.0)
}

/// What of a polyhedron of at most `N` corners is under: each is placed once for all of its triangles.
#[inline(always)]
pub(super) fn under_few<const N: usize>(
    vertices: &[Vector3<f64>],
    triangles: &[[u32; 3]],
    place: impl Fn(&Vector3<f64>) -> Corner,
) -> Submerged {
    let mut submerged = Submerged::default();
    let mut placed = [(Vector3::zeros(), 0.0); N];
    for (to, v) in placed.iter_mut().zip(vertices) {
        *to = place(v);
    }
    for triangle in triangles {
        submerged.add_triangle(triangle.map(|i| &placed[i as usize % N]));
    }
    submerged
}

/// What of a polyhedron of any number of corners is under: they are placed once for each of their triangles.
pub(super) fn under_many(
    vertices: &[Vector3<f64>],
    triangles: &[[u32; 3]],
    place: impl Fn(&Vector3<f64>) -> Corner,
) -> Submerged {
    let mut submerged = Submerged::default();
    for triangle in triangles {
        let corners = triangle.map(|i| {
            let vertex = vertices.get(i as usize);
            vertex.map_or((Vector3::zeros(), -1.0), &place)
        });
        submerged.add_triangle(corners.each_ref());
    }
    submerged
}

/// What of an ellipsoid is under a plane, by the affine map that makes it the unit sphere. `axes` maps its own axes to
/// level ones, `depth` is that of the point that positions are counted from, and `normal` has a y of one.
pub(super) fn under_ellipsoid(
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
