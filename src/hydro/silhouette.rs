//! The shadow of a surface, whatever is behind its outermost faces.

use crate::geometry::Surface;
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
        let triangles: Vec<[Vector3<f64>; 3]> = surface
            .corners()
            .map(|corners| corners.map(|v| to_frame * (v - origin)))
            .collect();
        [[1, 2], [2, 0], [0, 1]].map(|[x, y]| {
            let flat = triangles
                .iter()
                .map(|corners| corners.map(|v| Vector2::new(v[x], v[y])));
            Self::of(flat)
        })
    }

    fn of(triangles: impl Iterator<Item = [Vector2<f64>; 3]> + Clone) -> Self {
        let rows = triangles.clone().flatten().map(|v| v.y);
        let low = rows.clone().fold(f64::INFINITY, f64::min);
        let high = rows.fold(f64::NEG_INFINITY, f64::max);
        let step = (high - low) / LINES as f64;
        let mut lines: Vec<Vec<(f64, f64)>> = vec![Vec::new(); LINES];
        for corners in triangles {
            let ys = corners.map(|v| (v.y - low) / step);
            let bottom = ys.iter().copied().fold(f64::INFINITY, f64::min);
            let top = ys.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            // A triangle on edge has no share: `bottom` and `top` are then NaN or between two lines.
            let first = (bottom - 0.5).ceil().max(0.0) as usize;
            for (i, line) in lines.iter_mut().enumerate().skip(first) {
                let y = i as f64 + 0.5;
                if y > top {
                    break;
                }
                let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
                for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                    let (ya, yb) = (ys[a], ys[b]);
                    if ya == yb || (y - ya) * (y - yb) > 0.0 {
                        continue;
                    }
                    let x = corners[a].x + (corners[b].x - corners[a].x) * ((y - ya) / (yb - ya));
                    (left, right) = (left.min(x), right.max(x));
                }
                if left < right {
                    line.push((left, right));
                }
            }
        }
        for line in &mut lines {
            merge(line);
        }
        let strips = || {
            lines.iter().enumerate().flat_map(|(i, line)| {
                let y = low + (i as f64 + 0.5) * step;
                line.iter().map(move |(left, right)| (y, *left, *right))
            })
        };
        let mut area = 0.0;
        let mut center = Vector2::zeros();
        for (y, left, right) in strips() {
            let width = right - left;
            area += width * step;
            center += Vector2::new(0.5 * (left + right), y) * (width * step);
        }
        center /= area;
        let (mut second, mut third) = (Vector2::zeros(), Vector2::zeros());
        for (y, left, right) in strips() {
            let (y, left, right) = ((y - center.y).abs(), left - center.x, right - center.x);
            let cell = (right - left) * step;
            second += Vector2::new(y * y * cell, (right.powi(3) - left.powi(3)) / 3.0 * step);
            // The integral of |x|³ is x|x|³/4.
            let quarter = |x: f64| 0.25 * x * x.abs().powi(3);
            third += Vector2::new(y.powi(3) * cell, (quarter(right) - quarter(left)) * step);
        }
        Self {
            area,
            center,
            second_moment: second,
            third_moment: third,
        }
    }
}

/// Intervals that touch or overlap become one.
fn merge(intervals: &mut Vec<(f64, f64)>) {
    intervals.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut kept = 0;
    for i in 0..intervals.len() {
        let next = intervals[i];
        if kept > 0 && next.0 <= intervals[kept - 1].1 {
            intervals[kept - 1].1 = intervals[kept - 1].1.max(next.1);
        } else {
            intervals[kept] = next;
            kept += 1;
        }
    }
    intervals.truncate(kept);
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
                // Half extents in single precision; the midpoint rule misses 1/(4·512²) of ∫y².
                assert!((ours / exact - 1.0).abs() < 1e-5, "{ours} {exact}");
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
