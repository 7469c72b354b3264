//! Point distributions and meshes that are fine toward sharp edges.
//!
//! At a convex edge the potential goes like distance to the power ½ (a sheet) to 1 (no edge). Points
//! at the square of an even spacing resolve the worst of them at the order of a smooth function.

use crate::math;
use rapier3d::na::Vector3;
use std::f64::consts::TAU;

/// `cells + 1` points from 0 to 1, close together near 1.
pub(crate) fn one_end(cells: usize) -> Vec<f64> {
    (0..=cells)
        .map(|i| 1.0 - (1.0 - i as f64 / cells as f64).powi(2))
        .collect()
}

/// `cells + 1` points from 0 to 1, close together near both.
pub(crate) fn both_ends(cells: usize) -> Vec<f64> {
    (0..=cells)
        .map(|i| {
            let s = 2.0 * i as f64 / cells as f64 - 1.0;
            0.5 + 0.5 * s.signum() * (1.0 - (1.0 - s.abs()).powi(2))
        })
        .collect()
}

/// The unit disc across z: `rings` rings with radii `sin(π/2 · i/rings)`, the i-th of 6 i vertices,
/// 6 rings² triangles.
pub(crate) fn disc(rings: usize) -> (Vec<Vector3<f64>>, Vec<[u32; 3]>) {
    let mut vertices = vec![Vector3::zeros()];
    let mut triangles = Vec::with_capacity(6 * rings * rings);
    let start = |ring: usize| {
        if ring == 0 {
            0
        } else {
            1 + 3 * ring * (ring - 1)
        }
    };
    for ring in 1..=rings {
        let radius = math::sin(TAU / 4.0 * ring as f64 / rings as f64);
        vertices.extend((0..6 * ring).map(|i| {
            let (sin, cos) = math::sin_cos(TAU * i as f64 / (6 * ring) as f64);
            Vector3::new(radius * cos, radius * sin, 0.0)
        }));
        let inner = |i: usize| {
            let count = (6 * (ring - 1)).max(1);
            (start(ring - 1) + i % count) as u32
        };
        let outer = |i: usize| (start(ring) + i % (6 * ring)) as u32;
        for sector in 0..6 {
            for i in 0..ring {
                let (o, n) = (sector * ring + i, sector * (ring - 1) + i);
                triangles.push([outer(o), outer(o + 1), inner(n)]);
                if i + 1 < ring {
                    triangles.push([outer(o + 1), inner(n + 1), inner(n)]);
                }
            }
        }
    }
    (vertices, triangles)
}
