//! Triangles of a surface, to look at.

use super::FreeSurface;
use crate::error::Error;
use rapier3d::math::{Real, Vector};

/// Most cells along one side of a mesh.
const MOST_CELLS: f64 = 4096.0;

/// Vertices and triangles of the rectangular patch of a surface from `corner` to `corner + size` (x and z, m) at a time
/// (s), in level axes: vertex (i, j) of `cells` + 1 along x and z has number `j·(cells[0] + 1) + i`. Seen from above the triangles
/// are counterclockwise, two to a cell, cut along alternating diagonals. They are the same at all times.
///
/// ```
/// use rapier3d_immersed::free_surface::{Wave, Waves, Dispersion, mesh};
///
/// let waves = Waves::new(Dispersion::default(), &[Wave::default()])?;
/// let (vertices, triangles) = mesh(&waves, [-10.0, -5.0], [20.0, 10.0], [40, 20], 1.5)?;
/// assert_eq!((vertices.len(), triangles.len()), (41 * 21, 2 * 40 * 20));
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
///
/// # Errors
/// If the corner is not finite, the size not positive, or a number of cells not from 1 to 4096.
pub fn mesh(
    surface: &dyn FreeSurface,
    corner: [f64; 2],
    size: [f64; 2],
    cells: [usize; 2],
    time: f64,
) -> Result<(Vec<Vector>, Vec<[u32; 3]>), Error> {
    for axis in 0..2 {
        Error::check_finite("corner", corner[axis])?;
        Error::check_positive("size", size[axis])?;
        Error::check_range("cells", cells[axis] as f64, 1.0, MOST_CELLS)?;
    }
    let [nx, nz] = cells;
    let at = |axis: usize, i: usize| corner[axis] + size[axis] * i as f64 / cells[axis] as f64;
    let mut vertices = Vec::with_capacity((nx + 1) * (nz + 1));
    for j in 0..=nz {
        for i in 0..=nx {
            let (x, z) = (at(0, i), at(1, j));
            let y = surface.elevation(x, z, time).height;
            vertices.push(Vector::new(x as Real, y as Real, z as Real));
        }
    }
    let mut triangles = Vec::with_capacity(2 * nx * nz);
    for j in 0..nz {
        for i in 0..nx {
            let a = (j * (nx + 1) + i) as u32;
            let (b, c) = (a + 1, a + nx as u32 + 1);
            let d = c + 1;
            triangles.extend(if (i + j) % 2 == 0 {
                [[a, c, d], [a, d, b]]
            } else {
                [[a, c, b], [b, c, d]]
            });
        }
    }
    Ok((vertices, triangles))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::free_surface::{Level, Sea, Waves};

    /// Corners are where they should be, every normal points up, and the projected areas add up to the patch.
    #[test]
    fn a_patch_is_covered_once() {
        let sea = Waves::sea(&Sea::default()).unwrap();
        let (vertices, triangles) = mesh(&sea, [-3.0, 2.0], [12.0, 8.0], [24, 10], 3.0).unwrap();
        assert_eq!(vertices.len(), 25 * 11);
        let [first, last] = [vertices[0], vertices[25 * 11 - 1]];
        assert_eq!([first.x, first.z, last.x, last.z], [-3.0, 2.0, 9.0, 10.0]);
        let height = sea.elevation(last.x.into(), last.z.into(), 3.0).height;
        assert_eq!(last.y, height as Real);
        let mut area = 0.0;
        for triangle in &triangles {
            let [a, b, c] = triangle.map(|i| vertices[i as usize]);
            let up = (b - a).cross(c - a).y;
            assert!(up > 0.0);
            area += 0.5 * up;
        }
        assert!((area - 96.0).abs() < 1e-3, "{area}");
    }

    #[test]
    fn impossible_patches_are_named() {
        let error = |corner, size, cells| {
            let mesh = mesh(&Level, corner, size, cells, 0.0);
            mesh.unwrap_err().to_string()
        };
        assert!(error([f64::NAN, 0.0], [1.0; 2], [1; 2]).starts_with("corner"));
        assert!(error([0.0; 2], [1.0, 0.0], [1; 2]).starts_with("size"));
        assert!(error([0.0; 2], [1.0; 2], [0, 1]).starts_with("cells"));
        assert!(error([0.0; 2], [1.0; 2], [1, 4097]).starts_with("cells"));
    }
}
