//! Bodies of revolution, and the exact volume of their profiles.

use super::Surface;
use crate::error::Error;
use crate::math;
use rapier3d::na::Vector3;
use std::f64::consts::{PI, TAU};

/// How finely round surfaces are divided into facets.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facets {
    /// How many go around a body of revolution …
    pub around: usize,
    /// … and along half a circle of its profile.
    pub along: usize,
    /// Largest angle between neighboring directions of the rounded edges of a polyhedron.
    pub step: f64,
}

impl Facets {
    /// For integrals that are right to about 10⁻³.
    pub const FINE: Self = Self {
        around: 64,
        along: 48,
        step: PI / 24.0,
    };
}

/// Points (distance from the axis, height) of a circular arc between two polar angles.
pub(super) fn arc(radius: f64, from: f64, to: f64, facets: &Facets) -> Vec<(f64, f64)> {
    let segments = (facets.along as f64 * (to - from) / PI).ceil().max(1.0) as usize;
    (0..=segments)
        .map(|i| {
            let angle = from + (to - from) * i as f64 / segments as f64;
            // The poles lie exactly on the axis, so that they weld to one vertex.
            let at_pole = i == 0 && from == 0.0 || i == segments && to == PI;
            let distance = if at_pole {
                0.0
            } else {
                radius * math::sin(angle)
            };
            (distance, radius * math::cos(angle))
        })
        .collect()
}

/// The body of revolution about y of a profile from its top to its bottom, with distances from the
/// axis scaled so that the volume is exactly `volume`.
pub(super) fn revolve(
    profile: &[(f64, f64)],
    volume: f64,
    facets: &Facets,
) -> Result<Surface, Error> {
    let around = facets.around;
    let build = |scale: f64| {
        let mut vertices = Vec::with_capacity(profile.len() * around);
        for (distance, height) in profile {
            vertices.extend((0..around).map(|i| {
                let (sin, cos) = math::sin_cos(TAU * i as f64 / around as f64);
                Vector3::new(scale * distance * sin, *height, scale * distance * cos)
            }));
        }
        let mut triangles = Vec::with_capacity(profile.len() * around * 2);
        for ring in 0..profile.len() - 1 {
            for i in 0..around {
                let next = (i + 1) % around;
                let [a, b] = [i, next].map(|i| (ring * around + i) as u32);
                let [c, d] = [i, next].map(|i| ((ring + 1) * around + i) as u32);
                triangles.push([a, c, d]);
                triangles.push([a, d, b]);
            }
        }
        Surface::assembled(&vertices, &triangles)
    };
    let inscribed = build(1.0)?.volume_integrals().volume;
    build((volume / inscribed).sqrt())
}

/// A body of revolution with rounded edges, by its profile.
pub(super) struct RoundBody {
    /// Points (distance from the axis, height) from the top of the axis to its bottom.
    points: Vec<(f64, f64)>,
    /// What the profile encloses with its arcs round, m³.
    pub(super) volume: f64,
    facets: Facets,
}

impl RoundBody {
    /// A cylinder about y, grown by `border` on all sides.
    pub(super) fn cylinder(r: f64, h: f64, border: f64, facets: &Facets) -> Self {
        let mut profile = Self::from_top(h + border, facets);
        profile.line_to((r, h + border));
        profile.arc((r, h), border, 0.0, PI / 2.0);
        profile.line_to((r + border, -h));
        profile.arc((r, -h), border, PI / 2.0, PI);
        profile.line_to((0.0, -h - border));
        profile
    }

    /// A cone about y, its tip up, grown by `border` on all sides.
    pub(super) fn cone(r: f64, h: f64, border: f64, facets: &Facets) -> Self {
        // The angle of the slope's normal from the axis.
        let slope = math::atan2(2.0 * h, r);
        let (sin, cos) = math::sin_cos(slope);
        let mut profile = Self::from_top(h + border, facets);
        profile.arc((0.0, h), border, 0.0, slope);
        profile.line_to((r + border * sin, -h + border * cos));
        profile.arc((r, -h), border, slope, PI);
        profile.line_to((0.0, -h - border));
        profile
    }

    /// Its surface, a polyhedron of exactly its volume.
    pub(super) fn surface(&self) -> Result<Surface, Error> {
        revolve(&self.points, self.volume, &self.facets)
    }

    /// Begins on the axis.
    fn from_top(height: f64, facets: &Facets) -> Self {
        Self {
            points: vec![(0.0, height)],
            volume: 0.0,
            facets: *facets,
        }
    }

    /// A straight line to a point: the frustum π/3 Δy (x₁² + x₁x₂ + x₂²).
    fn line_to(&mut self, (x, y): (f64, f64)) {
        let (x0, y0) = self.points[self.points.len() - 1];
        self.volume += PI / 3.0 * (y0 - y) * (x0 * x0 + x0 * x + x * x);
        self.points.push((x, y));
    }

    /// An arc about `center` between two angles from the upward axis, beginning where the last piece
    /// ended: π ∫ (c + r sin φ)² r sin φ dφ.
    fn arc(&mut self, (cx, cy): (f64, f64), r: f64, from: f64, to: f64) {
        let integral = |angle: f64| {
            let (sin, cos) = math::sin_cos(angle);
            -cx * cx * r * cos
                + cx * r * r * (angle - sin * cos)
                + r.powi(3) * (cos.powi(3) / 3.0 - cos)
        };
        self.volume += PI * (integral(to) - integral(from));
        let points = arc(r, from, to, &self.facets);
        self.points
            .extend(points.iter().skip(1).map(|(x, y)| (cx + x, cy + y)));
    }
}
