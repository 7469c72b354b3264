//! What a body that is not a plate shows to the six sides: shadows, drag coefficients, pressure points.
//!
//! All of it is read off the body's geometry, from its relief along its principal axes; nothing
//! asks what kind of shape it is. What is inside does not count, so that a solid may be one part or be put
//! together from many that touch or overlap.

use super::bluff_side::Side;
use crate::error::Error;
use crate::geometry::{Ellipsoid, Relief, Surface};
use crate::math;
use rapier3d::na::{Rotation3, Vector2, Vector3};

/// Relative error of a relief's shadow from which on its lines are too few for the body, and the drag coefficient
/// of such a body: one of thin parts far from each other.
const UNRESOLVED: (f64, f64) = (0.25, 1.0);
/// Friction coefficient of the wetted surface, that of a laminar plate, 1.33 Re^−½ (Blasius), at Re 2·10⁵.
const FRICTION: f64 = 0.003;
/// A sphere's wetted surface over its shadow: the friction of so much is in the other terms.
const SPHERES: f64 = 4.0;
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
            let along = Relief::new(surface, center, &frame, convex);
            let against = along.turned();
            let sides = [Side::new(&along, &against), Side::new(&against, &along)];
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
            friction_moment: shadow * (8.0 / 3.0 * math::powf(a * b * c, 2.0 / 3.0)),
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
