//! Double integrals of 1/|x − y| over two panels.

use super::panel::Panel;
use rapier3d::na::Vector3;

/// Points of a symmetric quadrature rule on a triangle: barycentric coordinates and weight (the
/// weights sum to one).
type Rule = [([f64; 3], f64)];

/// Exact for quadratic polynomials.
pub(super) const THREE_POINTS: [([f64; 3], f64); 3] = {
    const A: f64 = 2.0 / 3.0;
    const B: f64 = 1.0 / 6.0;
    const W: f64 = 1.0 / 3.0;
    [([A, B, B], W), ([B, A, B], W), ([B, B, A], W)]
};

/// Exact for polynomials of degree 5 (Radon 1948).
const SEVEN_POINTS: [([f64; 3], f64); 7] = {
    const A: f64 = 0.101_286_507_323_456_34;
    const B: f64 = 0.470_142_064_105_115_1;
    const WA: f64 = 0.125_939_180_544_827_15;
    const WB: f64 = 0.132_394_152_788_506_2;
    const A1: f64 = 1.0 - 2.0 * A;
    const B1: f64 = 1.0 - 2.0 * B;
    const THIRD: f64 = 1.0 / 3.0;
    [
        ([THIRD, THIRD, THIRD], 0.225),
        ([A1, A, A], WA),
        ([A, A1, A], WA),
        ([A, A, A1], WA),
        ([B1, B, B], WB),
        ([B, B1, B], WB),
        ([B, B, B1], WB),
    ]
};

/// Meshes are full of equal lengths. Comparing to a little more than the other side makes the choice
/// between equals independent of rounding, and so of the axes that a body is given in.
pub(super) const TIE: f64 = 1.0 + 1e-7;

/// How finely the outer integral of close panels is resolved.
#[derive(Clone, Copy, Debug)]
pub(super) struct NearField {
    /// Panels whose centroids are farther apart than this multiple of the sum of their radii
    /// interact through three quadrature points each.
    pub far: f64,
    /// Halvings of a panel toward an edge or a corner that it shares with the other.
    pub touching_levels: u32,
    /// Halvings of a panel that does not touch the other.
    pub close_levels: u32,
}

/// Double integrals over a pair of panels P and Q, without the factor 1/4π.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moments {
    /// `∫_P ∫_Q 1/|x − y|`, m³.
    pub uniform: f64,
    /// `∫_P ∫_Q x/|x − y|` with x on P, m⁴.
    pub first_p: Vector3<f64>,
    /// `∫_P ∫_Q y/|x − y|` with y on Q, m⁴.
    pub first_q: Vector3<f64>,
}

impl NearField {
    /// The integrals over two different panels that are close to or touch each other: exact over
    /// one, adaptive quadrature over the other.
    ///
    /// The potential of a uniform panel is analytic except at its edges, across which its slope has a
    /// logarithmic singularity; so the other panel is halved until its parts are smaller than their
    /// distance to those edges.
    pub fn moments(&self, p: &Panel, q: &Panel, touching: bool) -> Moments {
        let levels = if touching {
            self.touching_levels
        } else {
            self.close_levels
        };
        let mut sum = Moments::default();
        if p.radius <= q.radius * TIE {
            integrate(p.corners, p.area, q, levels, &mut sum);
            sum
        } else {
            integrate(q.corners, q.area, p, levels, &mut sum);
            Moments {
                first_p: sum.first_q,
                first_q: sum.first_p,
                ..sum
            }
        }
    }

    /// The integrals of a panel with itself.
    pub fn self_moments(&self, p: &Panel) -> Moments {
        let mut sum = Moments::default();
        integrate(p.corners, p.area, p, self.touching_levels, &mut sum);
        let uniform = p.self_interaction();
        let first = sum.first_p * (uniform / sum.uniform);
        Moments {
            uniform,
            first_p: first,
            first_q: first,
        }
    }
}

fn integrate(outer: [Vector3<f64>; 3], area: f64, inner: &Panel, levels: u32, sum: &mut Moments) {
    let [a, b, c] = outer;
    let lengths = [(b - c), (c - a), (a - b)].map(|e| e.norm_squared());
    let mut longest = 0;
    for i in 1..3 {
        if lengths[i] > lengths[longest] * TIE {
            longest = i;
        }
    }
    let size = 0.5 * lengths[longest].sqrt();
    let distance = inner.distance_to_edges((a + b + c) / 3.0);
    if levels > 0 && distance < size * TIE {
        let [apex, from, to] = [longest, (longest + 1) % 3, (longest + 2) % 3].map(|i| outer[i]);
        let middle = (from + to) * 0.5;
        integrate([apex, from, middle], 0.5 * area, inner, levels - 1, sum);
        integrate([apex, middle, to], 0.5 * area, inner, levels - 1, sum);
        return;
    }
    let rule: &Rule = if distance > 3.0 * TIE * size {
        &THREE_POINTS
    } else {
        &SEVEN_POINTS
    };
    for ([l0, l1, l2], weight) in rule {
        let x = a * *l0 + b * *l1 + c * *l2;
        let potential = inner.potential(x);
        let w = weight * area;
        sum.uniform += w * potential.uniform;
        sum.first_p += x * (w * potential.uniform);
        sum.first_q += potential.first * w;
    }
}
