//! What a body shows to two opposite sides: the outermost points of its surface on a grid of parallel lines.

use super::Surface;
use rapier3d::na::{Rotation3, Vector3};

/// Lines per side of the grid.
const LINES: usize = 64;

/// A point of the surface that is seen from outside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// Height along the lines, m.
    pub height: f64,
    /// Normal out of the body.
    pub normal: Vector3<f64>,
}

/// The outermost points of a surface on a grid of lines along an axis, from the side that the axis points to
/// and from the other. What lies behind them is not looked at: it does not matter whether a solid is one part
/// or is put together from several that touch or overlap.
///
/// Coordinates are those of a right-handed frame whose third axis is along the lines.
#[derive(Clone, Debug)]
pub(crate) struct Relief {
    /// Low corner of the grid and the distance of its lines, m.
    low: [f64; 2],
    step: [f64; 2],
    /// Seen from the tip of the axis and from its tail, row by row; `None` where a line misses the body.
    above: Vec<Option<Seen>>,
    below: Vec<Option<Seen>>,
}

impl Relief {
    /// Of a surface, along the third axis of a frame with this origin.
    pub fn new(surface: &Surface, origin: Vector3<f64>, frame: &Rotation3<f64>) -> Self {
        let to_frame = frame.inverse();
        let triangles: Vec<[Vector3<f64>; 3]> = surface
            .corners()
            .map(|corners| corners.map(|v| to_frame * (v - origin)))
            .collect();
        let far = Vector3::repeat(f64::INFINITY);
        let corners = || triangles.iter().flatten();
        let low = corners().fold(far, |low, v| low.inf(v));
        let high = corners().fold(-far, |high, v| high.sup(v));
        let step = (high - low) / LINES as f64;
        let mut relief = Self {
            low: [low.x, low.y],
            step: [step.x, step.y],
            above: vec![None; LINES * LINES],
            below: vec![None; LINES * LINES],
        };
        for triangle in &triangles {
            relief.add(triangle);
        }
        relief
    }

    /// Number of lines per side.
    pub const fn lines() -> usize {
        LINES
    }

    /// Where a line passes, m.
    pub fn place(&self, column: usize, row: usize) -> [f64; 2] {
        [
            self.low[0] + (column as f64 + 0.5) * self.step[0],
            self.low[1] + (row as f64 + 0.5) * self.step[1],
        ]
    }

    /// Distance between lines along the first and second axis, m.
    pub fn step(&self) -> [f64; 2] {
        self.step
    }

    /// What is seen on a line from the tip of the axis.
    pub fn above(&self, column: usize, row: usize) -> Option<Seen> {
        self.above[row * LINES + column]
    }

    /// The same relief with the axis the other way round, and the first axis, too.
    pub fn turned(&self) -> Self {
        let mirror = |side: &[Option<Seen>]| {
            (0..LINES * LINES)
                .map(|i| {
                    let (row, column) = (i / LINES, i % LINES);
                    side[row * LINES + LINES - 1 - column].map(|seen| Seen {
                        height: -seen.height,
                        normal: Vector3::new(-seen.normal.x, seen.normal.y, -seen.normal.z),
                    })
                })
                .collect()
        };
        Self {
            low: [-(self.low[0] + LINES as f64 * self.step[0]), self.low[1]],
            step: self.step,
            above: mirror(&self.below),
            below: mirror(&self.above),
        }
    }

    fn add(&mut self, triangle: &[Vector3<f64>; 3]) {
        let [a, b, c] = triangle;
        let normal = (b - a).cross(&(c - a));
        let size = normal.norm();
        // A line that only grazes a triangle meets its neighbours.
        if normal.z.abs() <= 1e-9 * size || size == 0.0 {
            return;
        }
        let unit = normal / size;
        let span = |axis: usize| {
            let values =
                [a[axis], b[axis], c[axis]].map(|x| (x - self.low[axis]) / self.step[axis]);
            let low = values.iter().copied().fold(f64::INFINITY, f64::min) - 0.5;
            let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - 0.5;
            let first = (low - 1e-9).ceil().max(0.0) as usize;
            let end = ((high + 1e-9).floor() + 1.0).clamp(0.0, LINES as f64) as usize;
            first..end
        };
        // Lines that pass an edge belong to both sides of it: none falls between.
        let slack = 1e-9 * normal.z.abs();
        for row in span(1) {
            for column in span(0) {
                let [x, y] = self.place(column, row);
                let inside = |p: &Vector3<f64>, q: &Vector3<f64>| {
                    let area = (q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x);
                    area * normal.z.signum() >= -slack
                };
                if !(inside(a, b) && inside(b, c) && inside(c, a)) {
                    continue;
                }
                let slope = [unit.x / unit.z, unit.y / unit.z];
                let seen = Seen {
                    height: a.z - slope[0] * (x - a.x) - slope[1] * (y - a.y),
                    normal: unit,
                };
                let i = row * LINES + column;
                if unit.z > 0.0 && self.above[i].is_none_or(|old| seen.height > old.height) {
                    self.above[i] = Some(seen);
                }
                if unit.z < 0.0 && self.below[i].is_none_or(|old| seen.height < old.height) {
                    self.below[i] = Some(seen);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rapier3d::parry::shape::{Ball, Cuboid};

    /// Shadow of a ball and of a turned box, and what of them is seen: as many cells as the area has, each at
    /// its height. The outline passes through 2 π · 32 cells of 3200, which it leaves to one side or the other.
    #[test]
    fn a_ball_and_a_box() {
        let surface = Surface::from_shape(&Ball::new(0.5)).unwrap();
        let relief = Relief::new(&surface, Vector3::zeros(), &Rotation3::identity());
        let mut area = 0.0;
        for (row, column) in (0..LINES).flat_map(|row| (0..LINES).map(move |column| (row, column)))
        {
            let [x, y] = relief.place(column, row);
            let Some(seen) = relief.above(column, row) else {
                continue;
            };
            area += relief.step()[0] * relief.step()[1];
            let exact = (0.25 - x * x - y * y).max(0.0).sqrt();
            assert!(
                (seen.height - exact).abs() < 0.05,
                "{x} {y} {}",
                seen.height
            );
            let out = Vector3::new(x, y, seen.height).normalize();
            assert!((seen.normal - out).norm() < 0.15);
        }
        assert!(
            (area / std::f64::consts::FRAC_PI_4 - 1.0).abs() < 0.01,
            "{area}"
        );
        let half = rapier3d::math::Vector::new(0.3, 0.2, 0.1);
        let surface = Surface::from_shape(&Cuboid::new(half)).unwrap();
        let frame = Rotation3::from_axis_angle(&Vector3::x_axis(), 0.5);
        let relief = Relief::new(&surface, Vector3::new(0.0, 0.0, 1.0), &frame).turned();
        for row in 0..LINES {
            let [_, y] = relief.place(0, row);
            // In the box's axes, from its center: the line y, and the direction −z of the frame.
            let seen = relief.above(10, row).unwrap();
            let point = frame * Vector3::new(0.0, y, -seen.height) + Vector3::z();
            let on_face = (point.y.abs() - 0.2).abs().min((point.z.abs() - 0.1).abs());
            assert!(on_face < 1e-6, "{point}");
            assert!(seen.normal.z > 0.0);
        }
    }
}
