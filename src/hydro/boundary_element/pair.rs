//! Double integrals of 1/|x − y| over two panels.

use super::panel::Panel;
use rapier3d::na::Vector3;

/// Points of a symmetric quadrature rule on a triangle: barycentric coordinates and weight (the
/// weights sum to one).
type Rule = [([f64; 3], f64)];

/// A rule that is exact for quadratic polynomials.
pub(super) const THREE_POINTS: [([f64; 3], f64); 3] = {
    const A: f64 = 2.0 / 3.0;
    const B: f64 = 1.0 / 6.0;
    const W: f64 = 1.0 / 3.0;
    [([A, B, B], W), ([B, A, B], W), ([B, B, A], W)]
};

/// A rule that is exact for polynomials of degree 5 (Radon 1948).
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

/// Meshes have many equal lengths. Comparing with a little more than the other length makes the choice
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

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const DEEP: NearField = NearField {
        far: 1.5,
        touching_levels: 12,
        close_levels: 12,
    };
    const DEFAULT: NearField = NearField {
        far: 1.5,
        touching_levels: 4,
        close_levels: 8,
    };

    fn panel(corners: [[f64; 3]; 3]) -> Panel {
        Panel::new(corners.map(Vector3::from))
    }

    /// The mean of 1/r between two points of the unit square is 4 ln(1+√2) − 4/3 (√2−1) (a
    /// classical result for the capacitance of a plate). The square's two halves touch along the
    /// diagonal.
    #[test]
    fn unit_square_from_its_halves() {
        let p = panel([[0., 0., 0.], [1., 0., 0.], [1., 1., 0.]]);
        let q = panel([[0., 0., 0.], [1., 1., 0.], [0., 1., 0.]]);
        let root = 2f64.sqrt();
        let exact = 4.0 * (1.0 + root).ln() - 4.0 / 3.0 * (root - 1.0);
        // Two more levels halve the strip along the diagonal that is not resolved, and the share of the
        // integral that lies there falls with its square.
        for (near_field, tolerance) in [(DEFAULT, 1e-3), (DEEP, 1e-5)] {
            let both = near_field.moments(&p, &q, true);
            let sum = p.self_interaction() + q.self_interaction() + 2.0 * both.uniform;
            assert_relative_eq!(sum, exact, max_relative = tolerance);
            // By symmetry the mean of x + y over the square is its center.
            let [own_p, own_q] = [&p, &q].map(|p| near_field.self_moments(p).first_p);
            let first = own_p + own_q + both.first_p + both.first_q;
            assert_relative_eq!(first.x, exact / 2.0, max_relative = tolerance);
            assert_relative_eq!(first.y, exact / 2.0, max_relative = tolerance);
        }
    }

    /// For opposite faces of a leaf, much closer than they are wide, the default agrees with a far deeper
    /// quadrature, whichever panel is the outer one.
    #[test]
    fn opposite_panels() {
        let lower = panel([[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]]);
        for distance in [0.3, 0.03, 0.003] {
            let d = distance;
            let upper = panel([[0., 0., d], [0.0, 1.1, d], [1.1, 0.0, d]]);
            let deep = DEEP.moments(&lower, &upper, false);
            let found = DEFAULT.moments(&lower, &upper, false);
            assert_relative_eq!(found.uniform, deep.uniform, max_relative = 1e-4);
            assert_relative_eq!(found.first_q, deep.first_q, max_relative = 2e-4);
            let swapped = DEFAULT.moments(&upper, &lower, false);
            assert_relative_eq!(swapped.first_p, found.first_q, max_relative = 1e-12);
        }
    }
}
