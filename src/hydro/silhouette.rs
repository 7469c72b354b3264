//! The shadow of a surface, whatever is behind its outermost faces.

use crate::geometry::Surface;
use crate::geometry::bands::{Crossed, bands, merge, met};
use rapier3d::na::{Rotation3, Vector2, Vector3};

/// Lines that a shadow is measured along.
const LINES: usize = 512;

/// Area and moments of a shadow, from the intervals that parallel lines have in common with it: exact along
/// them, by the midpoint rule across.
#[derive(Clone, Debug)]
pub(super) struct Silhouette {
    /// Area, m².
    pub area: f64,
    /// Its centroid, m, in the frame of projection.
    pub center: Vector2<f64>,
    /// `∫y² dA` and `∫x² dA` from the centroid, m⁴.
    pub second_moment: Vector2<f64>,
    /// `∫|y|³ dA` and `∫|x|³ dA` from the centroid, m⁵.
    pub third_moment: Vector2<f64>,
}

impl Silhouette {
    /// The three shadows along the axes of a frame with this origin; the third is that in its plane.
    pub fn around(surface: &Surface, origin: Vector3<f64>, axes: &Rotation3<f64>) -> [Self; 3] {
        let to_frame = axes.inverse();
        let vertices = surface.vertices().iter().map(|v| to_frame * (v - origin));
        let vertices: Vec<Vector3<f64>> = vertices.collect();
        [0, 1, 2].map(|axis| {
            let turned =
                |v: &Vector3<f64>| Vector3::new(v[(axis + 1) % 3], v[(axis + 2) % 3], v[axis]);
            let vertices: Vec<Vector3<f64>> = vertices.iter().map(turned).collect();
            Self::of(surface, &vertices)
        })
    }

    /// Along the third axis, with the surface's vertices in such a frame.
    fn of(surface: &Surface, vertices: &[Vector3<f64>]) -> Self {
        let places: Vec<f64> = vertices.iter().map(|v| v.y).collect();
        let bands = bands(surface, &places, LINES);
        let mut lines: Vec<Vec<[f64; 2]>> = vec![Vec::new(); bands.len()];
        for triangle in surface.triangles() {
            let corners = triangle.map(|i| vertices[i as usize]);
            let Some(crossed) = Crossed::new(&corners, 1, 0) else {
                continue;
            };
            for i in met(&bands, &corners, 1) {
                let [from, to] = crossed.at(bands[i].middle);
                if from[0] < to[0] {
                    lines[i].push([from[0], to[0]]);
                }
            }
        }
        for line in &mut lines {
            merge(line, 0.0);
        }
        let strips = || {
            bands.iter().zip(&lines).flat_map(|(band, line)| {
                let (y, step) = (band.middle, band.width);
                line.iter()
                    .map(move |[left, right]| (y, step, *left, *right))
            })
        };
        let mut area = 0.0;
        let mut center = Vector2::zeros();
        for (y, step, left, right) in strips() {
            let width = right - left;
            area += width * step;
            center += Vector2::new(0.5 * (left + right), y) * (width * step);
        }
        center /= area;
        let (mut second, mut third) = (Vector2::zeros(), Vector2::zeros());
        for (y, step, left, right) in strips() {
            let (y, left, right) = ((y - center.y).abs(), left - center.x, right - center.x);
            let cell = (right - left) * step;
            let square = (y * y + step * step / 12.0) * cell;
            second += Vector2::new(square, (right.powi(3) - left.powi(3)) / 3.0 * step);
            // The integral of |x|³ is x|x|³/4.
            let quarter = |x: f64| 0.25 * x * x.abs().powi(3);
            let cube = (y * y + 0.25 * step * step) * y * cell;
            third += Vector2::new(cube, (quarter(right) - quarter(left)) * step);
        }
        Self {
            area,
            center,
            second_moment: second,
            third_moment: third,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rapier3d::parry::shape::{Ball, Cuboid};

    /// A box from its closed forms, a ball from those of the disc; a second part inside changes nothing.
    #[test]
    fn boxes_and_balls() {
        let half = rapier3d::math::Vector::new(0.3, 0.2, 0.1);
        let mut surface = Surface::from_shape(&Cuboid::new(half)).unwrap();
        let inside = Surface::from_shape(&Ball::new(0.09)).unwrap();
        for _ in 0..2 {
            let [x, y, z] = Silhouette::around(&surface, Vector3::zeros(), &Rotation3::identity());
            let close = |ours: f64, exact: f64| {
                // Half extents in single precision.
                assert!((ours / exact - 1.0).abs() < 1e-6, "{ours} {exact}");
            };
            close(x.area, 0.08);
            close(y.area, 0.12);
            close(z.area, 0.24);
            close(z.second_moment.x, 0.6 * 0.4_f64.powi(3) / 12.0);
            close(z.second_moment.y, 0.4 * 0.6_f64.powi(3) / 12.0);
            close(z.third_moment.x, 0.6 * 0.2_f64.powi(4) / 2.0);
            close(z.third_moment.y, 0.4 * 0.3_f64.powi(4) / 2.0);
            assert!(z.center.norm() < 1e-7);
            surface.append(&inside);
        }
        let ball = Surface::from_shape(&Ball::new(0.5)).unwrap();
        let [_, _, z] = Silhouette::around(&ball, Vector3::zeros(), &Rotation3::identity());
        let shown = ball.projected_area(Vector3::z());
        assert!((z.area / shown - 1.0).abs() < 3e-4, "{} {shown}", z.area);
    }
}
