//! What a body shows to two opposite sides: the outermost points of its surface on parallel lines.

use super::Surface;
use super::bands::{Band, Crossed, bands, merge, met};
use rapier3d::na::{Rotation3, Vector3};
use std::ops::Range;

/// Rows and columns, more where there are thin parts.
const LINES: usize = 64;

/// A point of the surface that is seen from outside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// Height along the lines, m.
    pub height: f64,
    /// Normal out of the body.
    pub normal: Vector3<f64>,
}

impl Seen {
    /// With the first and the third axis the other way round.
    fn turned(&self) -> Self {
        let n = &self.normal;
        Self {
            height: -self.height,
            normal: Vector3::new(-n.x, n.y, -n.z),
        }
    }
}

/// A piece of a row on which the body lies, in one column: what is seen on the line through its middle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    /// Place of its middle along the first axis, and its width, m.
    pub x: f64,
    pub width: f64,
    /// The column that it lies in.
    pub column: usize,
    /// Seen from the tip of the axis and from its tail.
    pub above: Seen,
    pub below: Seen,
}

/// A section of the body by a plane along the lines: the corners of the convex hull's upper and lower side, by their
/// places across the lines and their heights.
#[derive(Clone, Debug, Default)]
struct Section {
    upper: Vec<[f64; 2]>,
    lower: Vec<[f64; 2]>,
}

/// The outermost points of a surface on lines along an axis, from the side that the axis points to
/// and from the other. What lies behind them is not looked at: it does not matter whether a solid is one part
/// or is put together from several that touch or overlap.
///
/// The lines lie in rows, along which the body's shadow is exact: a row consists of the cells that it and the columns
/// have in common with the shadow. Rows and columns are also sections of the body, whose hulls are exact: walls that
/// are thinner than a cell are in them.
///
/// Coordinates are those of a right-handed frame whose third axis is along the lines.
#[derive(Clone, Debug)]
pub(crate) struct Relief {
    rows: Vec<Band>,
    columns: Vec<Band>,
    /// The cells of each row, from low to high.
    cells: Vec<Cell>,
    in_row: Vec<Range<usize>>,
    /// Of each cell those beside it in its row, before and after, and those in the rows before and after.
    beside: Vec<[Option<u32>; 4]>,
    /// Along each row and each column; none of a convex body.
    along_rows: Vec<Section>,
    along_columns: Vec<Section>,
}

/// What a row has in common with a triangle.
struct Stretch {
    from: [f64; 2],
    to: [f64; 2],
    normal: Vector3<f64>,
}

impl Relief {
    /// Of a surface, along the third axis of a frame with this origin. One that is `convex` has no hollows, and
    /// needs no sections.
    pub fn new(
        surface: &Surface,
        origin: Vector3<f64>,
        frame: &Rotation3<f64>,
        convex: bool,
    ) -> Self {
        let to_frame = frame.inverse();
        let vertices = surface.vertices().iter().map(|v| to_frame * (v - origin));
        let vertices: Vec<Vector3<f64>> = vertices.collect();
        let divided = |axis: usize| {
            let places: Vec<f64> = vertices.iter().map(|v| v[axis]).collect();
            bands(surface, &places, LINES)
        };
        let (columns, rows) = (divided(0), divided(1));
        let mut stretches: Vec<Vec<Stretch>> = Vec::new();
        stretches.resize_with(rows.len(), Vec::new);
        let mut along_columns = vec![Vec::new(); if convex { 0 } else { columns.len() }];
        for triangle in surface.triangles() {
            let corners = triangle.map(|i| vertices[i as usize]);
            let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
            let normal = normal.try_normalize(0.0).unwrap_or_default();
            if let Some(crossed) = Crossed::new(&corners, 1, 0) {
                for i in met(&rows, &corners, 1) {
                    let [from, to] = crossed.at(rows[i].middle);
                    stretches[i].push(Stretch { from, to, normal });
                }
            }
            if !convex && let Some(crossed) = Crossed::new(&corners, 0, 1) {
                for i in met(&columns, &corners, 0) {
                    along_columns[i].extend(crossed.at(columns[i].middle));
                }
            }
        }
        let mut relief = Self {
            rows,
            columns,
            cells: Vec::with_capacity(LINES * LINES),
            in_row: Vec::new(),
            beside: Vec::new(),
            along_rows: Vec::new(),
            along_columns: along_columns.into_iter().map(Section::of).collect(),
        };
        for row in &stretches {
            relief.add(row);
            if !convex {
                let ends = row.iter().flat_map(|s| [s.from, s.to]);
                relief.along_rows.push(Section::of(ends.collect()));
            }
        }
        relief.meet();
        relief
    }

    /// Cuts the next row into cells, and looks at what is seen there.
    fn add(&mut self, stretches: &[Stretch]) {
        let width = |band: &Band| band.width;
        let rounding = 1e-9 * self.columns.iter().map(width).sum::<f64>();
        // A line that only grazes a triangle meets its neighbors.
        let shows = |s: &&Stretch| s.normal.z.abs() > 1e-9 && s.to[0] > s.from[0];
        let lengths = stretches.iter().filter(shows).map(|s| [s.from[0], s.to[0]]);
        let mut shadow: Vec<[f64; 2]> = lengths.collect();
        merge(&mut shadow, rounding);
        let first = self.cells.len();
        let nothing = |height| Seen {
            height,
            normal: Vector3::zeros(),
        };
        for [from, to] in shadow {
            let start = self
                .columns
                .partition_point(|band| band.end() <= from + rounding);
            for (column, band) in self.columns.iter().enumerate().skip(start) {
                let low = from.max(band.end() - band.width);
                let high = if band.end() < to - rounding {
                    band.end()
                } else {
                    to
                };
                if high > low {
                    self.cells.push(Cell {
                        x: 0.5 * (low + high),
                        width: high - low,
                        column,
                        above: nothing(f64::NEG_INFINITY),
                        below: nothing(f64::INFINITY),
                    });
                }
                if high >= to {
                    break;
                }
            }
        }
        let row = &mut self.cells[first..];
        for s in stretches.iter().filter(shows) {
            let start = row.partition_point(|cell| cell.x < s.from[0] - rounding);
            let slope = (s.to[1] - s.from[1]) / (s.to[0] - s.from[0]);
            for cell in row[start..]
                .iter_mut()
                .take_while(|cell| cell.x <= s.to[0] + rounding)
            {
                let height = s.from[1] + slope * (cell.x - s.from[0]);
                let seen = Seen {
                    height,
                    normal: s.normal,
                };
                if s.normal.z > 0.0 && height > cell.above.height {
                    cell.above = seen;
                } else if s.normal.z < 0.0 && height < cell.below.height {
                    cell.below = seen;
                }
            }
        }
        // Where rounding hides one of the two sides there is nothing to speak of.
        let complete = |cell: &Cell| cell.above.height >= cell.below.height;
        let mut kept = first;
        for i in first..self.cells.len() {
            if complete(&self.cells[i]) && self.cells[i].above.height.is_finite() {
                self.cells[kept] = self.cells[i];
                kept += 1;
            }
        }
        self.cells.truncate(kept);
        self.in_row.push(first..kept);
    }

    /// The cells, row by row.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// Width over the columns and over the rows together, m.
    pub fn size(&self) -> f64 {
        let all = self.columns.iter().chain(&self.rows);
        all.map(|band| band.width).sum()
    }

    /// One of the rows.
    pub fn row(&self, row: usize) -> Band {
        self.rows[row]
    }

    /// The rows, each with the indices of its cells.
    pub fn rows(&self) -> impl Iterator<Item = (Band, Range<usize>)> + '_ {
        self.rows.iter().copied().zip(self.in_row.iter().cloned())
    }

    /// The cells beside one: in its row before and after it, and at its middle in the rows before and after.
    pub fn beside(&self, i: usize) -> [Option<usize>; 4] {
        self.beside[i].map(|i| i.map(|i| i as usize))
    }

    /// Finds the cells beside each.
    fn meet(&mut self) {
        let rounding = 1e-9 * self.size();
        self.beside = vec![[None; 4]; self.cells.len()];
        let low = |cell: &Cell| cell.x - 0.5 * cell.width;
        let high = |cell: &Cell| cell.x + 0.5 * cell.width;
        for (row, range) in self.in_row.iter().enumerate() {
            for i in range.start + 1..range.end {
                if low(&self.cells[i]) - high(&self.cells[i - 1]) <= rounding {
                    self.beside[i][0] = Some(i as u32 - 1);
                    self.beside[i - 1][1] = Some(i as u32);
                }
            }
            let others = [row.checked_sub(1), Some(row + 1)];
            for (side, other) in others.into_iter().enumerate() {
                let Some(other) = other.and_then(|row| self.in_row.get(row)) else {
                    continue;
                };
                let mut next = other.start;
                for i in range.clone() {
                    let x = self.cells[i].x;
                    while next < other.end && high(&self.cells[next]) < x {
                        next += 1;
                    }
                    if next < other.end && low(&self.cells[next]) <= x {
                        self.beside[i][2 + side] = Some(next as u32);
                    }
                }
            }
        }
    }

    /// Height at a cell of the convex hulls of the sections along its row and its column, as far as the cell lies in
    /// the middle of the column; minus infinity for a convex body.
    pub fn hull(&self, row: usize, cell: &Cell) -> f64 {
        let Some(along_row) = self.along_rows.get(row) else {
            return f64::NEG_INFINITY;
        };
        let height = along_row.height(cell.x);
        let column = &self.columns[cell.column];
        if (cell.x - column.middle).abs() > 1e-6 * column.width {
            return height;
        }
        height.max(self.along_columns[cell.column].height(self.rows[row].middle))
    }

    /// The same relief with the axis the other way round, and the first axis, too. The cell at an index is then as
    /// far from the end of its row as it was from the start.
    pub fn turned(&self) -> Self {
        let mut cells = Vec::with_capacity(self.cells.len());
        for range in &self.in_row {
            cells.extend(self.cells[range.clone()].iter().rev().map(|cell| Cell {
                x: -cell.x,
                width: cell.width,
                column: self.columns.len() - 1 - cell.column,
                above: cell.below.turned(),
                below: cell.above.turned(),
            }));
        }
        let mut beside = Vec::with_capacity(cells.len());
        let at = |i: u32, row: usize| {
            let range = &self.in_row[row];
            (range.start + range.end - 1) as u32 - i
        };
        for (row, range) in self.in_row.iter().enumerate() {
            for [left, right, down, up] in self.beside[range.clone()].iter().rev() {
                beside.push([
                    right.map(|i| at(i, row)),
                    left.map(|i| at(i, row)),
                    down.map(|i| at(i, row - 1)),
                    up.map(|i| at(i, row + 1)),
                ]);
            }
        }
        let columns = self.columns.iter().rev().map(|band| Band {
            middle: -band.middle,
            ..*band
        });
        let turned = |section: &Section| section.turned(true);
        Self {
            rows: self.rows.clone(),
            columns: columns.collect(),
            cells,
            in_row: self.in_row.clone(),
            beside,
            along_rows: self.along_rows.iter().map(turned).collect(),
            along_columns: self
                .along_columns
                .iter()
                .rev()
                .map(|s| s.turned(false))
                .collect(),
        }
    }
}

impl Section {
    /// The hull of points (the monotone chain of Andrew, 1979).
    fn of(mut points: Vec<[f64; 2]>) -> Self {
        points.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        let chain = |sign: f64| {
            let mut chain: Vec<[f64; 2]> = Vec::new();
            for &[x, z] in &points {
                while let [.., [x0, z0], [x1, z1]] = chain[..]
                    && sign * ((x1 - x0) * (z - z0) - (z1 - z0) * (x - x0)) >= 0.0
                {
                    chain.pop();
                }
                chain.push([x, z]);
            }
            chain
        };
        Self {
            upper: chain(1.0),
            lower: chain(-1.0),
        }
    }

    /// Height of the upper side of the hull at a place, m; minus infinity beside it.
    fn height(&self, x: f64) -> f64 {
        let i = self.upper.partition_point(|corner| corner[0] < x);
        match (self.upper.get(i.wrapping_sub(1)), self.upper.get(i)) {
            (Some([x0, z0]), Some([x1, z1])) => z0 + (z1 - z0) * (x - x0) / (x1 - x0),
            (None, Some([x1, z1])) if *x1 == x => *z1,
            _ => f64::NEG_INFINITY,
        }
    }

    /// Upside down, and the other way round if it is `mirrored`.
    fn turned(&self, mirrored: bool) -> Self {
        let turned = |side: &[[f64; 2]]| {
            let sign = if mirrored { -1.0 } else { 1.0 };
            let mut side: Vec<_> = side.iter().map(|[x, z]| [sign * x, -z]).collect();
            if mirrored {
                side.reverse();
            }
            side
        };
        Self {
            upper: turned(&self.lower),
            lower: turned(&self.upper),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rapier3d::math::{Pose, Rotation, Vector};
    use rapier3d::parry::shape::{Ball, Cuboid, SharedShape};

    fn area(relief: &Relief) -> f64 {
        let in_row = |(row, range): (Band, Range<usize>)| -> f64 {
            let cells = relief.cells()[range].iter();
            row.width * cells.map(|cell| cell.width).sum::<f64>()
        };
        relief.rows().map(in_row).sum()
    }

    fn along_z(surface: &Surface) -> Relief {
        Relief::new(surface, Vector3::zeros(), &Rotation3::identity(), false)
    }

    /// Shadow of a ball and of a turned box, and what of them is seen: each cell at its height.
    #[test]
    fn a_ball_and_a_box() {
        let surface = Surface::from_shape(&Ball::new(0.5)).unwrap();
        let relief = along_z(&surface);
        for (row, range) in relief.rows() {
            for cell in &relief.cells()[range] {
                let (x, y) = (cell.x, row.middle);
                let exact = (0.25 - x * x - y * y).max(0.0).sqrt();
                let seen = &cell.above;
                assert!(
                    (seen.height - exact).abs() < 0.05,
                    "{x} {y} {}",
                    seen.height
                );
                let out = Vector3::new(x, y, seen.height).normalize();
                assert!((seen.normal - out).norm() < 0.15);
                assert!((cell.below.height + seen.height).abs() < 0.02);
            }
        }
        // The facets lie inside, and the midpoint rule takes the chord of each row's middle.
        let whole = area(&relief) / std::f64::consts::FRAC_PI_4;
        assert!((whole - 1.0).abs() < 5e-3, "{whole}");
        let half = Vector::new(0.3, 0.2, 0.1);
        let surface = Surface::from_shape(&Cuboid::new(half)).unwrap();
        let frame = Rotation3::from_axis_angle(&Vector3::x_axis(), 0.5);
        let relief = Relief::new(&surface, Vector3::new(0.0, 0.0, 1.0), &frame, true).turned();
        let shadow = 0.6 * 2.0 * (0.2 * 0.5_f64.cos() + 0.1 * 0.5_f64.sin());
        assert!((area(&relief) / shadow - 1.0).abs() < 1e-6);
        for (row, range) in relief.rows() {
            // In the box's axes, from its center: the line y, and the direction −z of the frame.
            let seen = &relief.cells()[range][10].above;
            let point = frame * Vector3::new(0.0, row.middle, -seen.height) + Vector3::z();
            let on_face = (point.y.abs() - 0.2).abs().min((point.z.abs() - 0.1).abs());
            assert!(on_face < 1e-6, "{point}");
            assert!(seen.normal.z > 0.0);
        }
    }

    /// Shadows of rods far thinner than a column and a row: of 1 × .002 along both axes, to rounding, and in a V
    /// at ± 45°, where each row's chord is √2 as long as the rod is thick.
    #[test]
    fn thin_rods_are_not_missed() {
        let rod = |at: Vector, turn: f32| {
            let turn = Rotation::from_rotation_z(turn);
            let shape = SharedShape::cuboid(0.5, 0.001, 0.001);
            (Pose::from_parts(at, turn), shape)
        };
        let quarter = std::f32::consts::FRAC_PI_2;
        let of = |rods: Vec<(Pose, SharedShape)>| {
            let shape = SharedShape::compound(rods);
            area(&along_z(&Surface::from_shape(shape.as_ref()).unwrap()))
        };
        let far = Vector::new(3.0, 0.7, 0.0);
        let ours = of(vec![rod(Vector::ZERO, 0.0), rod(far, quarter)]);
        assert!((ours / 0.004 - 1.0).abs() < 1e-3, "{ours}");
        let arms = [0.5, -0.5].map(|side| rod(Vector::X * 2.0 * side, quarter * side));
        let ours = of(arms.to_vec());
        assert!((ours / 0.004 - 1.0).abs() < 0.01, "{ours}");
    }

    /// The hull over a basket with walls of a thousandth of its width: their top, everywhere between them.
    #[test]
    fn thin_walls_hold_up_the_hull() {
        let wall = |x: f32, y: f32, half: [f32; 3]| {
            let shape = SharedShape::cuboid(half[0], half[1], half[2]);
            (Pose::from_translation(Vector::new(x, y, 0.5)), shape)
        };
        let mut parts = vec![(Pose::IDENTITY, SharedShape::cuboid(0.5, 0.5, 0.001))];
        for side in [-0.4995, 0.4995] {
            parts.push(wall(side, 0.0, [0.0005, 0.5, 0.5]));
            parts.push(wall(0.0, side, [0.5, 0.0005, 0.5]));
        }
        let basket = SharedShape::compound(parts);
        for turn in [0.0, 0.3] {
            let frame = Rotation3::from_axis_angle(&Vector3::z_axis(), turn);
            let surface = Surface::from_shape(basket.as_ref()).unwrap();
            let relief = Relief::new(&surface, Vector3::zeros(), &frame, false);
            for (i, (_, range)) in relief.rows().enumerate() {
                for cell in &relief.cells()[range] {
                    let hull = relief.hull(i, cell);
                    assert!((hull - 1.0).abs() < 1e-6, "{hull} {cell:?}");
                }
            }
            let turned = relief.turned();
            for (i, (_, range)) in turned.rows().enumerate() {
                for cell in &turned.cells()[range] {
                    let hull = turned.hull(i, cell);
                    assert!((hull - 0.001).abs() < 1e-6, "{hull} {cell:?}");
                }
            }
        }
    }
}
