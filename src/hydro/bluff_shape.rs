//! What a body that is not a plate shows to the six sides: shadows, drag coefficients, pressure points.
//!
//! All of it is read off the body's geometry, from its relief along its principal axes; nothing
//! asks what kind of shape it is. What is inside does not count, so that a solid may be one part or be put
//! together from many that touch or overlap.

use crate::error::Error;
use crate::geometry::{Ellipsoid, Relief, Seen, Surface};
use rapier3d::na::{Rotation3, Vector2, Vector3};

/// Depth of hollows, over the outline's minor width, beyond which more of it changes nothing: a hemispherical cup
/// has a third.
const DEEPEST: f64 = 0.5;
/// Relative error of a relief's shadow from which on its lines are too few for the body, and the drag coefficient
/// of such a body: one of thin parts far from each other.
const UNRESOLVED: (f64, f64) = (0.25, 1.0);
/// Friction coefficient of the wetted surface, that of a laminar plate, 1.33 Re^−½ (Blasius), at Re 2·10⁵.
const FRICTION: f64 = 0.003;
/// A sphere's wetted surface over its shadow: the friction of so much is in the other terms.
const SPHERES: f64 = 4.0;
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

/// What the law of bluff bodies knows of one. The axes are those of the planform; of two entries the first is
/// for motion along, the second for motion against an axis.
///
/// # The drag coefficient
///
/// For motion along an axis, on the shadow along it, at Re 10⁴ to 10⁵ (below, and past the drag crisis, see
/// [`PhysicalLaw`](crate::PhysicalLaw)):
///
/// ```text
/// C_D = 0.32 ⟨s²⟩ + 0.58 s_e² + 0.75 d  +  (b₀ + b₁ (a − 1)/(a + 10)) · (1 − s_e² T) · B  +  0.003 (S/A − 4)
/// ```
///
/// * s is the cosine between the surface's normal and the motion: s² is Newton's pressure, ⟨⟩ its mean over
///   the shadow's windward side, s_e² its mean along the outline. On a flat face and a cone both are alike; a
///   round shoulder (s_e = 0) lets the flow past with suction there.
/// * d is the mean depth of hollows on the windward side, in which the fluid is at rest; the pressure acts on
///   the lid over them, the windward side's hull along both axes; of the outline's minor width, ½ at most.
/// * the wake's suction is b₀ = 0.28 for a round shadow, and b₁ = 0.68 more for an endlessly long one, a the
///   ratio of the outline's two radii of gyration.
/// * behind a sharp windward edge the flow attaches again to sides that are long enough,
///   T = l⁴/(l⁴ + 1.3⁴), l the mean length along the motion over the outline's minor width;
/// * a lee side that closes more gently than a sphere's has a smaller wake, B = min(1, 2⟨s²⟩)^0.65, with its
///   own ⟨s²⟩;
/// * S/A is the wetted surface over the shadow, 4 for a sphere: friction where there is more of it.
///
/// Thin parts far from each other, which the lines of the relief miss, have C_D = 1 on their shadow.
///
/// The numbers were fitted to some published bodies and tested on others: `tests/validation/bluff/table.rs`
/// has both, `docs/bluff-bodies.md` shows them.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct BluffShape {
    /// Shadows along the axes, m².
    pub shadow: Vector3<f64>,
    /// Drag coefficients for motion along the axes and against them, on the shadows, at Re 10⁴–10⁵.
    pub drag: [Vector3<f64>; 2],
    /// How round the shoulders are that the flow passes, from 0 (an edge) to 1 (a sphere's): only round ones
    /// have a drag crisis.
    pub roundness: [Vector3<f64>; 2],
    /// Where the force acts, from the center of volume, m: one point for each axis of the motion.
    pub pressure_point: [[Vector3<f64>; 3]; 2],
    /// `½ ∫ (r × n)ᵢ² dS` over the outer surface, m⁴: for a plate ∫y² dA of its planform, for a body that is
    /// round about the axis nothing.
    pub second_moment: Vector3<f64>,
    /// `½ ∫ |r × n|ᵢ³ dS`, m⁵.
    pub third_moment: Vector3<f64>,
    /// `∫ (r² − rᵢ²) dS`, m⁴: the arm of friction.
    pub friction_moment: Vector3<f64>,
}

impl BluffShape {
    /// Of a surface with this center, these principal axes and shadows along them. One that is `convex` has no
    /// hollows to look for.
    pub(super) fn new(
        surface: &Surface,
        center: Vector3<f64>,
        axes: &Rotation3<f64>,
        shadow: Vector3<f64>,
        convex: bool,
    ) -> Self {
        let mut shape = Self {
            shadow,
            drag: [Vector3::zeros(); 2],
            roundness: [Vector3::zeros(); 2],
            pressure_point: [[Vector3::zeros(); 3]; 2],
            second_moment: Vector3::zeros(),
            third_moment: Vector3::zeros(),
            friction_moment: Vector3::zeros(),
        };
        let mut slopes = [[[Vector2::zeros(); 2]; 2]; 3];
        let mut wetted = 0.0;
        for (axis, slopes) in slopes.iter_mut().enumerate() {
            let frame = axes * frame_along(axis);
            let along = Relief::new(surface, center, &frame);
            let against = along.turned();
            let sides = [
                Side::new(&along, &against, convex),
                Side::new(&against, &along, convex),
            ];
            let off = (sides[0].area / shadow[axis] - 1.0).abs();
            if off.is_nan() || off > UNRESOLVED.0 {
                shape.drag[0][axis] = UNRESOLVED.1;
                shape.drag[1][axis] = UNRESOLVED.1;
                continue;
            }
            shape.shadow[axis] = sides[0].area;
            for (sign, (side, lee)) in [(&sides[0], &sides[1]), (&sides[1], &sides[0])]
                .into_iter()
                .enumerate()
            {
                // The turned relief's first axis points the other way.
                let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
                let flip = if sign == 0 { 1.0 } else { -1.0 };
                shape.drag[sign][axis] = side.drag(lee);
                wetted += side.wetted;
                shape.roundness[sign][axis] = side.roundness() * lee.roundness();
                let share = side.front() / side.drag(lee).max(1e-9);
                let point = side.pressure_point * share + side.middle * (1.0 - share);
                shape.pressure_point[sign][axis][first] = flip * point.x;
                shape.pressure_point[sign][axis][second] = point.y;
                slopes[sign] = [side.moment_slope * flip, side.force_slope];
                let mut add = |i: usize, [square, cube, arm]: [f64; 3]| {
                    shape.second_moment[i] += square;
                    shape.third_moment[i] += cube;
                    shape.friction_moment[i] += arm;
                };
                add(first, side.turning[0]);
                add(second, side.turning[1]);
                add(axis, side.turning[2]);
            }
        }
        for i in 0..3 {
            let more = (wetted / shape.shadow[i] - SPHERES).max(0.0);
            for drag in &mut shape.drag {
                drag[i] += FRICTION * more;
            }
        }
        // Moving a little to one side as well: of the force that the law has across, the windward faces have
        // their share at a point of their own, and the rest acts where the flow across acts alone.
        for (axis, slopes) in slopes.iter().enumerate() {
            for (sign, [moment, force]) in slopes.iter().enumerate() {
                let mut arm = 0.0;
                for (i, across) in [(axis + 1) % 3, (axis + 2) % 3].into_iter().enumerate() {
                    let whole = shape.drag_area(across) * shape.share(across, axis).sqrt();
                    let rest = (1.0 - force[i] / whole).clamp(0.0, 1.0);
                    let points = [0, 1].map(|side: usize| shape.pressure_point[side][across][axis]);
                    arm += 0.5 * (moment[i] / whole + rest * 0.5 * (points[0] + points[1]));
                }
                shape.pressure_point[sign][axis][axis] = arm;
            }
        }
        // Where hardly any force goes along or across, its moment says nothing about a point.
        let back = axes.inverse();
        let corners = || surface.corners().flatten().map(|v| back * (v - center));
        let low = corners().fold(Vector3::zeros(), |low: Vector3<f64>, v| low.inf(&v));
        let high = corners().fold(Vector3::zeros(), |high: Vector3<f64>, v| high.sup(&v));
        for point in shape.pressure_point.iter_mut().flatten() {
            *point = point.sup(&low).inf(&high);
        }
        shape
    }

    /// Of an ellipsoid, which is as round as a sphere; what a body has of which nothing else is known.
    pub(super) fn of_ellipsoid(ellipsoid: &Ellipsoid) -> Self {
        let [a, b, c] = ellipsoid.semi_axes.into();
        let shadow = Vector3::new(b * c, a * c, a * b) * std::f64::consts::PI;
        Self {
            shadow,
            drag: [Vector3::repeat(SPHERE); 2],
            roundness: [Vector3::repeat(1.0); 2],
            pressure_point: [[Vector3::zeros(); 3]; 2],
            second_moment: Vector3::zeros(),
            third_moment: Vector3::zeros(),
            friction_moment: shadow * (8.0 / 3.0 * (a * b * c).powf(2.0 / 3.0)),
        }
    }

    /// # Errors
    /// [`Error::InvalidParameter`], [`Error::OutOfRange`] or [`Error::NotFinite`] names what cannot be.
    pub(super) fn check(&self) -> Result<(), Error> {
        for shadow in self.shadow.iter() {
            Error::check_positive("shadow", *shadow)?;
        }
        for side in 0..2 {
            for drag in self.drag[side].iter() {
                Error::check_not_negative("drag coefficient", *drag)?;
            }
            for roundness in self.roundness[side].iter() {
                Error::check_range("roundness", *roundness, 0.0, 1.0)?;
            }
            for point in &self.pressure_point[side] {
                Error::check_all_finite("pressure point", point.as_slice())?;
            }
        }
        let second = self.second_moment.iter().chain(&self.third_moment);
        for moment in second.chain(&self.friction_moment) {
            Error::check_not_negative("moment of the surface", *moment)?;
        }
        Ok(())
    }

    /// Mean of the drag areas for motion along an axis and against it, m².
    fn drag_area(&self, axis: usize) -> f64 {
        0.5 * (self.drag[0][axis] + self.drag[1][axis]) * self.shadow[axis]
    }

    /// How much the square of the speed along the axis `other` counts for the force along `axis`: all of it
    /// for a cube, next to nothing for a rod that moves along itself, whose force across is that of the
    /// flow across alone.
    pub(super) fn share(&self, axis: usize, other: usize) -> f64 {
        (self.drag_area(other) / self.drag_area(axis).max(1e-30)).min(1.0)
    }
}

/// Drag coefficient of a sphere at Re 10⁴–10⁵.
pub(super) const SPHERE: f64 = 0.45;

/// The frame whose third axis is this one, the first the next.
fn frame_along(axis: usize) -> Rotation3<f64> {
    let unit = |i: usize| Vector3::ith(i % 3, 1.0);
    Rotation3::from_basis_unchecked(&[unit(axis + 1), unit(axis + 2), unit(axis)])
}

/// What one side of a body is like to a fluid that comes from there.
struct Side {
    /// Shadow, m².
    area: f64,
    /// ⟨s²⟩ over it, and along its outline.
    pressure: f64,
    edge: f64,
    /// Mean depth of hollows, mean length of the body behind, over the outline's minor width.
    hollow: f64,
    length: f64,
    /// Ratio of the outline's radii of gyration.
    slenderness: f64,
    /// Centroid of the shadow, and where the windward pressure acts, along the grid's axes, m.
    middle: Vector2<f64>,
    pressure_point: Vector2<f64>,
    /// Moment and force across per angle of the motion toward the first and the second axis, over the dynamic
    /// pressure, m³ and m².
    moment_slope: Vector2<f64>,
    force_slope: Vector2<f64>,
    /// Outer surface that faces this side most, m².
    wetted: f64,
    /// About the grid's axes and the axis of the lines: shares of the surface that faces this side most.
    turning: [[f64; 3]; 3],
}

impl Side {
    /// `turned` is the relief from the other side.
    fn new(relief: &Relief, turned: &Relief, convex: bool) -> Self {
        let n = Relief::lines();
        let lid = Lid::new(relief, convex);
        let back = Lid::new(turned, convex);
        let [du, dv] = relief.step();
        let cell = du * dv;
        let (mut area, mut pressure, mut depth, mut length) = (0.0, 0.0, 0.0, 0.0);
        let (mut edge, mut outline) = (0.0, 0.0);
        let mut middle = Vector2::zeros();
        let mut acting = Vector2::zeros();
        let (mut slope, mut force_slope) = (Vector2::zeros(), Vector2::zeros());
        let (mut xx, mut yy, mut xy) = (0.0, 0.0, 0.0);
        let mut turning = [[0.0; 3]; 3];
        let mut wetted = 0.0;
        for (row, column) in (0..n).flat_map(|row| (0..n).map(move |column| (row, column))) {
            let Some(seen) = relief.above(column, row) else {
                continue;
            };
            let [x, y] = relief.place(column, row);
            let (height, normal) = lid.at(column, row, &seen);
            let s2 = normal.z * normal.z;
            area += cell;
            pressure += s2 * cell;
            depth += (height - seen.height) * cell;
            length += (height + back.height(n - 1 - column, row)).max(0.0) * cell;
            middle += Vector2::new(x, y) * cell;
            (xx, yy, xy) = (xx + x * x * cell, yy + y * y * cell, xy + x * y * cell);
            let missing = |du: isize, dv: isize| {
                let at = (column as isize + du, row as isize + dv);
                let inside = |i: isize| (0..n as isize).contains(&i);
                let there = inside(at.0) && inside(at.1);
                !(there && relief.above(at.0 as usize, at.1 as usize).is_some())
            };
            let ends = |a: bool, b: bool| f64::from(u8::from(a) + u8::from(b));
            let rim =
                ends(missing(-1, 0), missing(1, 0)) * dv + ends(missing(0, -1), missing(0, 1)) * du;
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
    fn front(&self) -> f64 {
        FRONT.0 * self.pressure + FRONT.1 * self.edge + HOLLOW * self.hollow
    }

    /// Drag coefficient of this side in front, `lee` behind.
    fn drag(&self, lee: &Self) -> f64 {
        let more = self.slenderness - 1.0;
        let wake = WAKE.0 + WAKE.1 * more / (more + HALF_LONG);
        let long = (self.length / REATTACHED).powi(4);
        let attached = self.edge * long / (long + 1.0);
        let closing = (lee.pressure / CLOSING.0).min(1.0).powf(CLOSING.1);
        self.front() + wake * (1.0 - attached) * closing
    }

    fn roundness(&self) -> f64 {
        (1.0 - (self.edge - ROUND.0) / ROUND.1).clamp(0.0, 1.0)
    }
}

/// The lid over the hollows of a relief: the hull of its heights along its rows and columns.
struct Lid {
    heights: Vec<f64>,
    size: f64,
    step: [f64; 2],
}

impl Lid {
    fn new(relief: &Relief, convex: bool) -> Self {
        let n = Relief::lines();
        let height = |i: usize| relief.above(i % n, i / n).map(|seen| seen.height);
        let on_surface = |i: usize| height(i).unwrap_or(f64::NEG_INFINITY);
        let mut heights: Vec<f64> = (0..n * n).map(on_surface).collect();
        let [du, dv] = relief.step();
        let mut line = Vec::with_capacity(n);
        for i in 0..if convex { 0 } else { n } {
            for along_row in [true, false] {
                let index = |k: usize| if along_row { (k, i) } else { (i, k) };
                line.clear();
                line.extend((0..n).filter_map(|k| {
                    let (column, row) = index(k);
                    relief.above(column, row).map(|seen| (k, seen.height))
                }));
                for (k, height) in hull(&line) {
                    let (column, row) = index(k);
                    let place = &mut heights[row * n + column];
                    *place = place.max(height);
                }
            }
        }
        Self {
            heights,
            size: (du + dv) * n as f64,
            step: [du, dv],
        }
    }

    fn height(&self, column: usize, row: usize) -> f64 {
        self.heights[row * Relief::lines() + column]
    }

    /// Height and normal of the lid, which are the surface's own where it lies on it.
    fn at(&self, column: usize, row: usize, seen: &Seen) -> (f64, Vector3<f64>) {
        let height = self.height(column, row);
        if height - seen.height < 0.01 * self.size {
            return (seen.height, seen.normal);
        }
        let n = Relief::lines();
        let slope = |low: Option<f64>, high: Option<f64>, step: f64| {
            let known = |h: Option<f64>| h.filter(|h| h.is_finite());
            match (known(low), known(high)) {
                (Some(low), Some(high)) => (high - low) / (2.0 * step),
                (Some(low), None) => (height - low) / step,
                (None, Some(high)) => (high - height) / step,
                (None, None) => 0.0,
            }
        };
        let left = (column > 0).then(|| self.height(column - 1, row));
        let right = (column + 1 < n).then(|| self.height(column + 1, row));
        let down = (row > 0).then(|| self.height(column, row - 1));
        let up = (row + 1 < n).then(|| self.height(column, row + 1));
        let x = slope(left, right, self.step[0]);
        let y = slope(down, up, self.step[1]);
        (height, Vector3::new(-x, -y, 1.0).normalize())
    }
}

/// The upper hull of heights at rising places, at those places.
fn hull(line: &[(usize, f64)]) -> Vec<(usize, f64)> {
    let mut corners: Vec<(usize, f64)> = Vec::with_capacity(line.len());
    for &(k, height) in line {
        while let [.., (k0, h0), (k1, h1)] = corners[..] {
            let (a, b) = ((k1 - k0) as f64, (k - k0) as f64);
            if (h1 - h0) * b <= (height - h0) * a {
                corners.pop();
            } else {
                break;
            }
        }
        corners.push((k, height));
    }
    let mut next = 0;
    line.iter()
        .map(|&(k, height)| {
            while next + 1 < corners.len() && corners[next + 1].0 <= k {
                next += 1;
            }
            let (k0, h0) = corners[next];
            let Some(&(k1, h1)) = corners.get(next + 1) else {
                return (k, h0.max(height));
            };
            let share = (k - k0) as f64 / (k1 - k0) as f64;
            (k, (h0 + (h1 - h0) * share).max(height))
        })
        .collect()
}
