//! What of a shape the default law does not see, as far as the shape itself tells.

use crate::geometry::Surface;
use crate::math;
use rapier3d::na::{Matrix6, Rotation3, Vector2, Vector3, Vector6};

/// Share of the convex outline around a shadow below which the gaps in it matter, of a plate and of another body. Paper
/// crosses of five squares (0.71) fall a third too slowly; a maple leaf of five lobes (0.725) is still a leaf. Of other
/// bodies no chord or span is asked, and a neck is no gap: a rod with a ball at its end has 0.67.
const GAPS: (f64, f64) = (0.72, 0.5);
/// Rise of a plate's middle surface, over its width or length, from which on it matters. By thin-airfoil theory a plate
/// bent to a parabola of rise f over its chord c lifts at no incidence as a flat one at 2 f/c does: here at 7°, half
/// of the angle at which a wing stalls. Leaves have less.
const CURVED: f64 = 0.06;
/// Sine of the mean pitch about an axis from which on its torque matters, of a plate and of another body: 6° and 12°.
/// Pebbles, hulls of random points, have up to 0.12.
const PITCHED: (f64, f64) = (0.1, 0.2);

/// A property of a shape that the default law, [`PhysicalLaw`](crate::PhysicalLaw), does not know of: what it
/// expects of such a body may be wrong by more than `docs/which-bodies.md` promises.
///
/// Only what the geometry of one rigid surface shows is found: that a body is porous or flexible no shape tells.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum OutOfScope {
    /// The flow goes through gaps of the outline: a cross, a ring, a frame, fingers. The law has chord and span of the
    /// box around it, and parts in each other's wake do not shelter each other.
    Gaps {
        /// Share of the convex outline around the shadow that the shadow fills.
        fill: f64,
    },
    /// A plate whose middle surface is cambered, dished or folded, where the law knows flat sections only: lift at no
    /// incidence and the moment of dihedral are missing. Give a [`PolarTable`](crate::PolarTable), or flat parts.
    Curved {
        /// Rise of the middle surface over the width or length along which it is curved.
        rise: f64,
    },
    /// Faces that are pitched about an axis, as those of a propeller, a screw or a windmill: a stream along the axis
    /// turns them, and one surface feels no such torque. Give each blade as a [`Part`](crate::Part).
    Pitched {
        /// Sine of the pitch in the mean over the faces, weighted by their distance from the axis.
        sine: f64,
    },
}

impl std::fmt::Display for OutOfScope {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Gaps { fill } => write!(
                f,
                "its shadow fills {:.0} % of the outline around it, and the law does not know of flow through gaps: \
                 expect errors of a third, or give its pieces as parts",
                100.0 * fill
            ),
            Self::Curved { rise } => write!(
                f,
                "its surface rises by {:.0} % of its width, and the law knows flat plates: lift at no incidence is \
                 missing; give it a polar table or flat parts",
                100.0 * rise
            ),
            Self::Pitched { sine } => write!(
                f,
                "its faces are pitched by {:.0}° about an axis, and one surface feels no torque of that: give its \
                 blades as parts",
                math::asin(sine.min(1.0)).to_degrees()
            ),
        }
    }
}

impl OutOfScope {
    /// What there is of a surface with this center, these principal axes, and shadows along them; a `plate` is judged
    /// by what it shows to its broad side alone. One that is `convex` has no gaps.
    pub(super) fn of(
        surface: &Surface,
        center: Vector3<f64>,
        axes: &Rotation3<f64>,
        shadows: &Vector3<f64>,
        plate: bool,
        convex: bool,
    ) -> Vec<Self> {
        let back = axes.inverse();
        let corners: Vec<[Vector3<f64>; 3]> = surface
            .corners()
            .map(|corners| corners.map(|v| back * (v - center)))
            .collect();
        let seen_along = if plate { 2..3 } else { 0..3 };
        let mut found = Vec::new();
        if !convex {
            let fill = |axis: usize| shadows[axis] / area_of_hull(corners.iter().flatten(), axis);
            let fill = seen_along.clone().map(fill).fold(f64::INFINITY, f64::min);
            if fill < if plate { GAPS.0 } else { GAPS.1 } {
                found.push(Self::Gaps { fill });
            }
        }
        if plate {
            let rise = rise(&corners);
            if rise > CURVED {
                found.push(Self::Curved { rise });
            }
        }
        let sine = seen_along
            .map(|axis| pitch(&corners, axis))
            .fold(0.0, f64::max);
        if sine > if plate { PITCHED.0 } else { PITCHED.1 } {
            found.push(Self::Pitched { sine });
        }
        found
    }
}

/// Area of the convex hull of points seen along an axis (the monotone chain of Andrew, 1979), m².
fn area_of_hull<'a>(points: impl Iterator<Item = &'a Vector3<f64>>, axis: usize) -> f64 {
    let flat = points.map(|v| Vector2::new(v[(axis + 1) % 3], v[(axis + 2) % 3]));
    let mut points: Vec<Vector2<f64>> = flat.collect();
    points.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let chain = |sign: f64| {
        let mut chain: Vec<Vector2<f64>> = Vec::new();
        for p in &points {
            while let [.., a, b] = chain[..]
                && sign * (b - a).perp(&(p - a)) <= 0.0
            {
                chain.pop();
            }
            chain.push(*p);
        }
        chain
    };
    let under = |chain: Vec<Vector2<f64>>| -> f64 {
        let pieces = chain.windows(2);
        pieces
            .map(|ab| 0.5 * (ab[1].x - ab[0].x) * (ab[0].y + ab[1].y))
            .sum()
    };
    under(chain(-1.0)) - under(chain(1.0))
}

/// How much the middle surface of a plate rises over its width or its length, whichever is worse, in plate axes: the
/// quadratic terms of the surface of second order that fits its faces best.
fn rise(corners: &[[Vector3<f64>; 3]]) -> f64 {
    let far = Vector3::repeat(f64::INFINITY);
    let all = || corners.iter().flatten();
    let low = all().fold(far, |low, v| low.inf(v));
    let high = all().fold(-far, |high, v| high.sup(v));
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let (mut square, mut product) = (Matrix6::zeros(), Vector6::zeros());
    for &[a, b, c] in corners {
        let area = (b - a).cross(&(c - a)).z.abs();
        for (weight, u, v) in QUARTIC {
            for [p, q, r] in [[a, b, c], [b, c, a], [c, a, b]] {
                let point = p * u + q * v + r * (1.0 - u - v) - middle;
                let (x, y) = (point.x / half.x, point.y / half.y);
                let terms = Vector6::new(1.0, x, y, x * x, x * y, y * y);
                square += terms * terms.transpose() * (weight * area);
                product += terms * (weight * area * point.z);
            }
        }
    }
    let Some(fit) = square.lu().solve(&product) else {
        return 0.0;
    };
    (fit[3].abs() / (2.0 * half.x)).max(fit[5].abs() / (2.0 * half.y))
}

/// Weight and two coordinates of the points of a triangle, to be permuted: exact for polynomials of fourth degree
/// (Dunavant 1985, six points).
const QUARTIC: [(f64, f64, f64); 2] = [
    (
        0.223_381_589_678_011,
        0.108_103_018_168_070,
        0.445_948_490_915_965,
    ),
    (
        0.109_951_743_655_322,
        0.816_847_572_980_459,
        0.091_576_213_509_771,
    ),
];

/// Sine of the mean pitch of faces about an axis through the center: `∫ n (r × n) dS` along it over `∫ |n| r dS`, by
/// the middles of the triangles' sides, which is exact for the first.
fn pitch(corners: &[[Vector3<f64>; 3]], axis: usize) -> f64 {
    let (mut torque, mut arm) = (0.0, 0.0);
    for &[a, b, c] in corners {
        let normal = (b - a).cross(&(c - a));
        let size = normal.norm();
        if size == 0.0 {
            continue;
        }
        for middle in [a + b, b + c, c + a].map(|sum| 0.5 * sum) {
            torque += normal[axis] * middle.cross(&normal)[axis] / size;
            let distance = math::hypot(middle[(axis + 1) % 3], middle[(axis + 2) % 3]);
            arm += normal[axis].abs() * distance;
        }
    }
    torque.abs() / arm.max(f64::MIN_POSITIVE)
}
