//! Leaves and confetti: outlines, and the thin solids made of them.

use super::Vec3;
use rapier3d_immersed::Error;
use rapier3d_immersed::geometry::Surface;
use std::f64::consts::{PI, TAU};

/// Shape of a blade, star-shaped about its middle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outline {
    /// Widest in the middle: beech.
    Elliptic,
    /// Widest near the stalk: pear.
    Ovate,
    /// Long and narrow: willow.
    Lanceolate,
    /// Five lobes: maple.
    Maple,
    /// A rectangle: confetti.
    Rectangle,
}

impl Outline {
    /// The outline within a box of `length` × `width` (m), `count` points counter-clockwise in the
    /// x–z plane (x along the leaf).
    pub fn points(self, length: f64, width: f64, count: usize) -> Vec<[f64; 2]> {
        if self == Self::Rectangle {
            return rectangle(length, width, count);
        }
        let raw: Vec<[f64; 2]> = (0..count)
            .map(|i| self.raw(i as f64 / count as f64))
            .collect();
        let range = |axis: usize| {
            let values = raw.iter().map(move |p| p[axis]);
            let low = values.clone().fold(f64::INFINITY, f64::min);
            (low, values.fold(f64::NEG_INFINITY, f64::max))
        };
        let ((left, right), (low, high)) = (range(0), range(1));
        let fit =
            |value: f64, from: f64, to: f64, size: f64| ((value - from) / (to - from) - 0.5) * size;
        raw.iter()
            .map(|p| [fit(p[0], left, right, length), fit(p[1], low, high, width)])
            .collect()
    }

    /// A point of the outline, `s` ∈ [0, 1) once around; any scale.
    fn raw(self, s: f64) -> [f64; 2] {
        let angle = TAU * s;
        let (sin, cos) = angle.sin_cos();
        match self {
            Self::Elliptic => [cos, sin],
            // The widest place moves toward the stalk at x = −1, and the tip sharpens.
            Self::Ovate => [cos, sin * (1.0 - 0.45 * cos)],
            Self::Lanceolate => [cos, sin * sin.abs().powf(0.6) * (1.0 - 0.25 * cos)],
            Self::Maple => {
                // Five lobes over the upper 240°, a notch at the stalk (angle π).
                let from_stalk = 1.0 - (angle - PI).abs() / PI;
                let lobes = 0.75 + 0.25 * (5.0 * angle).cos();
                let radius = lobes * (1.0 - 0.35 * (1.0 - from_stalk).powi(2));
                // The stalk's end, opposite to the tip, is drawn in.
                let radius = radius * (1.0 - 0.3 * (-8.0 * (angle - PI).powi(2)).exp());
                [radius * cos, radius * sin]
            }
            Self::Rectangle => unreachable!("drawn by its corners"),
        }
    }
}

fn rectangle(length: f64, width: f64, count: usize) -> Vec<[f64; 2]> {
    let per_side = (count / 4).max(1);
    let corners = [[0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]];
    (0..4)
        .flat_map(|side| {
            let (a, b) = (corners[side], corners[(side + 1) % 4]);
            (0..per_side).map(move |i| {
                let s = i as f64 / per_side as f64;
                let at = |k: usize| a[k] + (b[k] - a[k]) * s;
                [at(0) * length, at(1) * width]
            })
        })
        .collect()
}

/// A blade: outline, size and how it is bent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blade {
    /// Its shape.
    pub outline: Outline,
    /// Extent along x, m.
    pub length: f64,
    /// Extent along z, m.
    pub width: f64,
    /// Thickness, m.
    pub thickness: f64,
    /// Rise of the edges over the middle, m, along and across.
    pub camber: [f64; 2],
}

impl Blade {
    /// The blade as a closed solid: x along it, y up (the normal), z across.
    ///
    /// # Errors
    /// Those of [`Surface::new`], e.g. for a blade of no thickness.
    pub fn solid(&self) -> Result<Surface, Error> {
        self.solid_of(40, 3)
    }

    /// The same of so many points of the outline, and so many rings between the middle and the edge.
    ///
    /// # Errors
    /// Those of [`Surface::new`].
    pub fn solid_of(&self, around: usize, rings: usize) -> Result<Surface, Error> {
        let outline = self.outline.points(self.length, self.width, around);
        let around = outline.len() as u32;
        let rise = |x: f64, z: f64| {
            let (s, t) = (2.0 * x / self.length, 2.0 * z / self.width);
            self.camber[0] * s * s + self.camber[1] * t * t
        };
        let mut sheet = vec![[0.0, 0.0]];
        for ring in 1..=rings {
            let s = ring as f64 / rings as f64;
            sheet.extend(outline.iter().map(|p| [p[0] * s, p[1] * s]));
        }
        let count = sheet.len() as u32;
        let side = |offset: f64| {
            let sheet = sheet.iter();
            sheet.map(move |p| Vec3::new(p[0], rise(p[0], p[1]) + offset, p[1]))
        };
        let half = 0.5 * self.thickness;
        let vertices: Vec<Vec3> = side(half).chain(side(-half)).collect();

        // Seen from above (+y), x to the right and z down: the outline runs clockwise.
        let mut top = Vec::new();
        let at = |ring: u32, i: u32| 1 + (ring - 1) * around + i % around;
        for i in 0..around {
            top.push([0, at(1, i + 1), at(1, i)]);
            for ring in 1..rings as u32 {
                let [a, b] = [at(ring, i), at(ring, i + 1)];
                let [c, d] = [at(ring + 1, i), at(ring + 1, i + 1)];
                top.push([a, b, d]);
                top.push([a, d, c]);
            }
        }
        let mut triangles = top.clone();
        triangles.extend(top.iter().map(|t| [t[2], t[1], t[0]].map(|v| v + count)));
        let edge = rings as u32;
        for i in 0..around {
            let [a, b] = [at(edge, i), at(edge, i + 1)];
            triangles.push([a, b, b + count]);
            triangles.push([a, b + count, a + count]);
        }
        Surface::new(&vertices, &triangles)
    }
}
