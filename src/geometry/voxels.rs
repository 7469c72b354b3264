//! The surface of a body of voxels.

use super::Surface;
use crate::error::Error;
use rapier3d::na::Vector3;
use rapier3d::parry::shape::Voxels;
use std::collections::{HashMap, HashSet};

/// The faces between full and empty cells. They meet at corners of the grid, which are whole numbers, so
/// that no rounding opens them, wherever the cells are.
pub(super) fn surface(voxels: &Voxels) -> Result<Surface, Error> {
    let size = crate::math::to_f64(voxels.voxel_size());
    for (name, value) in ["voxel_size.x", "voxel_size.y", "voxel_size.z"]
        .iter()
        .zip(size.iter())
    {
        Error::check_positive(name, *value)?;
    }
    let full: Vec<[i64; 3]> = voxels
        .voxels()
        .filter(|voxel| !voxel.state.is_empty())
        .map(|voxel| voxel.grid_coords.to_array().map(i64::from))
        .collect();
    let filled: HashSet<_> = full.iter().copied().collect();
    let mut corners: HashMap<[i64; 3], u32> = HashMap::new();
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for cell in &full {
        for k in 0..3 {
            for outward in [-1, 1] {
                let mut neighbor = *cell;
                neighbor[k] += outward;
                if filled.contains(&neighbor) {
                    continue;
                }
                let mut corner = |a: i64, b: i64| {
                    let mut at = *cell;
                    at[k] += i64::from(outward > 0);
                    at[(k + 1) % 3] += a;
                    at[(k + 2) % 3] += b;
                    *corners.entry(at).or_insert_with(|| {
                        vertices.push(Vector3::from_fn(|i, _| at[i] as f64 * size[i]));
                        vertices.len() as u32 - 1
                    })
                };
                let [p, q, r, s] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                triangles.extend(if outward > 0 {
                    [[p, q, r], [p, r, s]]
                } else {
                    [[p, r, q], [p, s, r]]
                });
            }
        }
    }
    Surface::assembled(&vertices, &triangles)
}
