//! What one side of a body is like to a fluid that comes from there, and the drag coefficient that follows.

use crate::geometry::Relief;
use crate::math;
use rapier3d::na::{Vector2, Vector3};

/// Depth of hollows, over the outline's minor width, beyond which more of it changes nothing: a hemispherical cup
/// has a third.
const DEEPEST: f64 = 0.5;
/// Windward pressure: of the mean of s², and of that at the outline.
const FRONT: (f64, f64) = (0.32, 0.58);
/// Pressure in hollows, per mean depth over the outline's minor width.
const HOLLOW: f64 = 0.75;
/// Suction of the wake behind a round shadow, and what an endless one has more.
const WAKE: (f64, f64) = (0.28, 0.68);
/// Ratio of the outline's radii of gyration, less one, at which half of that has come.
const HALF_LONG: f64 = 11.0;
/// Length over width at which half of the wake is attached again behind a sharp edge.
const REATTACHED: f64 = 1.3;
/// ⟨s²⟩ of a lee side below which it closes so gently that the wake is weaker, and the power with which it is.
const CLOSING: (f64, f64) = (0.5, 0.65);
/// Up to this s² at the outline a shoulder is round, and beyond `.1` more than it is sharp: a round one has no
/// more than the facets and the lines between which it lies leave.
const ROUND: (f64, f64) = (0.05, 0.3);

/// What one side of a body is like to a fluid that comes from there.
pub(super) struct Side {
    /// Shadow, m².
    pub area: f64,
    /// ⟨s²⟩ over it, and along its outline.
    pressure: f64,
    edge: f64,
    /// Mean depth of hollows, mean length of the body behind, over the outline's minor width.
    hollow: f64,
    length: f64,
    /// Ratio of the outline's radii of gyration.
    slenderness: f64,
    /// Centroid of the shadow, and where the windward pressure acts, along the grid's axes, m.
    pub middle: Vector2<f64>,
    pub pressure_point: Vector2<f64>,
    /// Moment and force across per angle of the motion toward the first and the second axis, over the dynamic
    /// pressure, m³ and m².
    pub moment_slope: Vector2<f64>,
    pub force_slope: Vector2<f64>,
    /// Outer surface that faces this side most, m².
    pub wetted: f64,
    /// About the grid's axes and the axis of the lines: shares of the surface that faces this side most.
    pub turning: [[f64; 3]; 3],
}

impl Side {
    /// `turned` is the relief from the other side.
    pub fn new(relief: &Relief, turned: &Relief) -> Self {
        let (lid, back) = (Lid::new(relief), Lid::new(turned));
        let (mut area, mut pressure, mut depth, mut length) = (0.0, 0.0, 0.0, 0.0);
        let (mut edge, mut outline) = (0.0, 0.0);
        let mut middle = Vector2::zeros();
        let mut acting = Vector2::zeros();
        let (mut slope, mut force_slope) = (Vector2::zeros(), Vector2::zeros());
        let (mut xx, mut yy, mut xy) = (0.0, 0.0, 0.0);
        let mut turning = [[0.0; 3]; 3];
        let mut wetted = 0.0;
        for (row, (band, range)) in relief.rows().enumerate() {
            for i in range.clone() {
                let piece = &relief.cells()[i];
                let (seen, cell) = (&piece.above, piece.width * band.width);
                let (x, y) = (piece.x, band.middle);
                let (height, normal) = lid.at(relief, row, i);
                let s2 = normal.z * normal.z;
                area += cell;
                pressure += s2 * cell;
                depth += (height - seen.height) * cell;
                // The turned row runs the other way.
                let behind = back.heights[range.start + range.end - 1 - i];
                length += (height + behind).max(0.0) * cell;
                middle += Vector2::new(x, y) * cell;
                (xx, yy, xy) = (xx + x * x * cell, yy + y * y * cell, xy + x * y * cell);
                let missing = |at: Option<usize>| f64::from(u8::from(at.is_none()));
                let [left, right, down, up] = relief.beside(i);
                let rim = (missing(left) + missing(right)) * band.width
                    + (missing(down) + missing(up)) * piece.width;
                edge += s2 * rim;
                outline += rim;
                // The pressure −s² n/n_z per shadow, and its moment about the center.
                let force = normal * (-normal.z);
                let r = Vector3::new(x, y, height);
                let moment = r.cross(&force);
                acting += Vector2::new(moment.y, -moment.x) * cell;
                // Moving toward the first axis as well changes it by 2 s n_x.
                let arm = r.cross(&normal);
                slope += Vector2::new(normal.x * arm.y, -normal.y * arm.x) * (2.0 * cell);
                force_slope += normal.xy().component_mul(&normal.xy()) * (2.0 * cell);
                // The surface itself, each piece of it from the side to which it turns most.
                let out = &seen.normal;
                let most = out.z * (1.0 + 1e-9);
                if out.x.abs() <= most && out.y.abs() <= most {
                    // One that turns to two sides or three alike is met from each.
                    let alike = [out.x, out.y].map(|x| u8::from(x.abs() * (1.0 + 1e-9) >= out.z));
                    let r = Vector3::new(x, y, seen.height);
                    let arm = r.cross(out);
                    let surface = cell / (out.z * f64::from(1 + alike[0] + alike[1]));
                    wetted += surface;
                    for (i, turning) in turning.iter_mut().enumerate() {
                        let lever = arm[i].abs();
                        turning[0] += 0.5 * lever * lever * surface;
                        turning[1] += 0.5 * lever.powi(3) * surface;
                        turning[2] += (r.norm_squared() - r[i] * r[i]) * surface;
                    }
                }
            }
        }
        let per = 1.0 / area.max(1e-300);
        let middle = middle * per;
        let (xx, yy) = (
            xx * per - middle.x * middle.x,
            yy * per - middle.y * middle.y,
        );
        let xy = xy * per - middle.x * middle.y;
        let (mean, spread) = (0.5 * (xx + yy), (0.25 * (xx - yy).powi(2) + xy * xy).sqrt());
        let slenderness = ((mean + spread) / (mean - spread).max(1e-12 * mean)).sqrt();
        let width = 2.0 * (area / (std::f64::consts::PI * slenderness)).sqrt();
        Self {
            area,
            pressure: pressure * per,
            edge: edge / outline.max(1e-300),
            hollow: (depth * per / width).min(DEEPEST),
            length: length * per / width,
            slenderness,
            middle,
            pressure_point: acting / pressure.max(1e-300),
            moment_slope: slope,
            force_slope,
            wetted,
            turning,
        }
    }

    /// The windward pressure's share of the drag coefficient.
    pub fn front(&self) -> f64 {
        FRONT.0 * self.pressure + FRONT.1 * self.edge + HOLLOW * self.hollow
    }

    /// Drag coefficient of this side in front, `lee` behind.
    pub fn drag(&self, lee: &Self) -> f64 {
        let more = self.slenderness - 1.0;
        let wake = WAKE.0 + WAKE.1 * more / (more + HALF_LONG);
        let long = (self.length / REATTACHED).powi(4);
        let attached = self.edge * long / (long + 1.0);
        let closing = math::powf((lee.pressure / CLOSING.0).min(1.0), CLOSING.1);
        self.front() + wake * (1.0 - attached) * closing
    }

    pub fn roundness(&self) -> f64 {
        (1.0 - (self.edge - ROUND.0) / ROUND.1).clamp(0.0, 1.0)
    }
}

/// The lid over the hollows of a relief: the hull of its sections along rows and columns, at each cell.
struct Lid {
    heights: Vec<f64>,
    /// Height above the surface from which on the lid is a lid, m: more than the rounding of single precision. Sections
    /// are exact, so that where the surface bulges out the hull lies on it.
    least: f64,
}

impl Lid {
    fn new(relief: &Relief) -> Self {
        let mut heights = Vec::with_capacity(relief.cells().len());
        for (row, (_, range)) in relief.rows().enumerate() {
            for cell in &relief.cells()[range] {
                heights.push(relief.hull(row, cell).max(cell.above.height));
            }
        }
        Self {
            heights,
            least: 1e-6 * relief.size(),
        }
    }

    /// Height and normal of the lid, which are the surface's own where it lies on it.
    fn at(&self, relief: &Relief, row: usize, i: usize) -> (f64, Vector3<f64>) {
        let (height, cell) = (self.heights[i], &relief.cells()[i]);
        if height - cell.above.height < self.least {
            return (cell.above.height, cell.above.normal);
        }
        let [left, right, down, up] = relief.beside(i);
        let x = |i: usize| relief.cells()[i].x;
        let y = |row: usize| relief.row(row).middle;
        let slope = |low: Option<(f64, usize)>, high: Option<(f64, usize)>, here: f64| {
            let (from, to) = (low.unwrap_or((here, i)), high.unwrap_or((here, i)));
            let run = to.0 - from.0;
            let rise = self.heights[to.1] - self.heights[from.1];
            if run > 0.0 { rise / run } else { 0.0 }
        };
        let along = slope(left.map(|i| (x(i), i)), right.map(|i| (x(i), i)), cell.x);
        let before = down.map(|i| (y(row - 1), i));
        let across = slope(before, up.map(|i| (y(row + 1), i)), y(row));
        (height, Vector3::new(-along, -across, 1.0).normalize())
    }
}
