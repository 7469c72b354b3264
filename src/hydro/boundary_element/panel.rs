//! One flat triangle and the exact potential of a uniform layer on it.

use crate::math;
use rapier3d::na::Vector3;

/// A flat triangle with what the integrals need of it.
#[derive(Clone, Debug)]
pub(super) struct Panel {
    pub corners: [Vector3<f64>; 3],
    /// Unit normal, right-handed about the corners.
    pub normal: Vector3<f64>,
    pub area: f64,
    pub centroid: Vector3<f64>,
    /// Distance from the centroid to the farthest corner.
    pub radius: f64,
    edges: [Edge; 3],
}

#[derive(Clone, Copy, Debug)]
struct Edge {
    direction: Vector3<f64>,
    /// Unit normal of the edge in the panel's plane, pointing away from the triangle.
    outward: Vector3<f64>,
    length: f64,
}

/// Integrals over a panel of a uniform layer, seen from one point x, without the factor 1/4π.
#[derive(Clone, Copy, Debug)]
pub(super) struct Potential {
    /// `∫ dS_y / |x − y|`, m.
    pub uniform: f64,
    /// `∫ y dS_y / |x − y|`, m².
    pub first: Vector3<f64>,
}

impl Panel {
    pub fn new(corners: [Vector3<f64>; 3]) -> Self {
        let [a, b, c] = corners;
        let cross = (b - a).cross(&(c - a));
        let normal = cross.normalize();
        let centroid = (a + b + c) / 3.0;
        let edges = [(a, b), (b, c), (c, a)].map(|(from, to)| {
            let length = (to - from).norm();
            let direction = (to - from) / length;
            Edge {
                direction,
                outward: direction.cross(&normal),
                length,
            }
        });
        Self {
            corners,
            normal,
            area: 0.5 * cross.norm(),
            centroid,
            radius: corners
                .iter()
                .map(|v| (v - centroid).norm())
                .fold(0.0, f64::max),
            edges,
        }
    }

    /// Surface curls `n × ∇λ_i` of the three hat functions, constant on the panel, 1/m.
    pub fn curls(&self) -> [Vector3<f64>; 3] {
        // The edge opposite of corner i, over twice the area.
        [1, 2, 0].map(|e| self.edges[e].direction * (-self.edges[e].length / (2.0 * self.area)))
    }

    /// Potential of a uniform layer by Gauss's and Stokes's theorems: edge logarithms and one solid
    /// angle (Hess & Smith 1967; in the form of Wilton et al. 1984, IEEE Trans. Antennas Propag. 32;
    /// solid angle by van Oosterom & Strackee 1983). It is exact at any distance, zero included.
    pub fn potential(&self, x: Vector3<f64>) -> Potential {
        let to = self.corners.map(|v| v - x);
        let distance = to.map(|v| v.norm());
        let height = self.normal.dot(&to[0]);
        let foot = x + self.normal * height;
        let mut uniform = 0.0;
        let mut first = Vector3::zeros();
        for (i, edge) in self.edges.iter().enumerate() {
            let (near, far) = (distance[i], distance[(i + 1) % 3]);
            let start = edge.direction.dot(&to[i]);
            let end = start + edge.length;
            let inward = edge.outward.dot(&to[i]);
            let sum = near + far;
            // A point on the edge has inward = 0, and 0 · ln(∞) must stay finite.
            let gap = (sum - edge.length).max(f64::MIN_POSITIVE);
            let logarithm = math::ln((sum + edge.length) / gap);
            uniform += inward * logarithm;
            let line = end * far - start * near + (inward * inward + height * height) * logarithm;
            first += edge.outward * (0.5 * line);
        }
        if height != 0.0 {
            let [a, b, c] = to;
            let [ra, rb, rc] = distance;
            let triple = 2.0 * self.area * height.abs();
            let denominator = ra * rb * rc + a.dot(&b) * rc + b.dot(&c) * ra + c.dot(&a) * rb;
            uniform -= 2.0 * height.abs() * math::atan2(triple, denominator);
        }
        Potential {
            uniform,
            first: first + foot * uniform,
        }
    }

    /// Distance from a point to the nearest of the three edges, m.
    pub fn distance_to_edges(&self, x: Vector3<f64>) -> f64 {
        (0..3)
            .map(|i| {
                let (edge, to) = (&self.edges[i], x - self.corners[i]);
                let along = edge.direction.dot(&to).clamp(0.0, edge.length);
                (to - edge.direction * along).norm_squared()
            })
            .fold(f64::INFINITY, f64::min)
            .sqrt()
    }

    /// `∫∫ dS_x dS_y / |x − y|` of the panel with itself, m³ (Eibert & Hansen 1995, IEEE Trans.
    /// Antennas Propag. 43, for constant elements).
    pub fn self_interaction(&self) -> f64 {
        let half: f64 = self.edges.iter().map(|e| e.length).sum::<f64>() / 2.0;
        let sum: f64 = self
            .edges
            .iter()
            .map(|e| -math::ln_1p(-e.length / half) / e.length)
            .sum();
        4.0 / 3.0 * self.area * self.area * sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn panel() -> Panel {
        Panel::new([
            Vector3::new(0.1, 0.2, -0.3),
            Vector3::new(1.3, 0.1, 0.2),
            Vector3::new(0.4, 1.1, 0.5),
        ])
    }

    /// Midpoint rule on n² congruent triangles: error O(n⁻²) where x keeps its distance.
    fn midpoint(panel: &Panel, x: Vector3<f64>, n: usize) -> (f64, Vector3<f64>) {
        let [a, b, c] = panel.corners;
        let mut sum = (0.0, Vector3::zeros());
        let mut add = |s: f64, t: f64| {
            let y = a + (b - a) * s + (c - a) * t;
            let w = panel.area / (n * n) as f64 / (x - y).norm();
            sum.0 += w;
            sum.1 += y * w;
        };
        for i in 0..n {
            for j in 0..n - i {
                let at = |o: f64| ((i as f64 + o) / n as f64, (j as f64 + o) / n as f64);
                let (s, t) = at(1.0 / 3.0);
                add(s, t);
                if i + j + 1 < n {
                    let (s, t) = at(2.0 / 3.0);
                    add(s, t);
                }
            }
        }
        sum
    }

    #[test]
    fn potential_matches_brute_force() {
        let p = panel();
        for x in [
            Vector3::new(1.0, 2.0, 0.7),
            Vector3::new(-0.3, 0.3, -0.2),
            p.centroid + p.normal * 0.3,
            p.centroid - p.normal * 0.3,
            // A point in the plane, outside of the panel.
            p.corners[0] + (p.corners[1] - p.corners[0]) * 1.4,
        ] {
            // h² / 24 · ∇²-like factor at a distance ≥ .25: below 1e-5 for n = 600.
            let (uniform, first) = midpoint(&p, x, 600);
            let exact = p.potential(x);
            assert_relative_eq!(exact.uniform, uniform, max_relative = 1e-5);
            assert_relative_eq!(exact.first, first, max_relative = 1e-5);
        }
    }

    /// At the centroid of an equilateral triangle with inscribed radius ρ: 6 ρ ln(2 + √3)… from
    /// three edges of ρ · 2 asinh(√3).
    #[test]
    fn potential_on_the_panel_itself() {
        let corner = |i: f64| {
            let angle = std::f64::consts::TAU * i / 3.0;
            Vector3::new(angle.cos(), angle.sin(), 0.0)
        };
        let p = Panel::new([corner(0.0), corner(1.0), corner(2.0)]);
        let exact = 3.0 * 0.5 * 2.0 * 3f64.sqrt().asinh();
        let found = p.potential(Vector3::zeros());
        assert_relative_eq!(found.uniform, exact, max_relative = 1e-13);
        assert!(found.first.norm() < 1e-13);
        // At corners and edges the potential is finite and continuous.
        for x in [p.corners[0], (p.corners[0] + p.corners[1]) / 2.0] {
            let inside = x + (p.centroid - x) * 1e-9;
            let (on, close) = (p.potential(x), p.potential(inside));
            assert_relative_eq!(on.uniform, close.uniform, max_relative = 1e-6);
        }
    }

    /// The self-interaction is the average of the exact potential over n² sub-triangles' centroids; as the
    /// potential has a log-singular slope at the rim, the difference is O(n⁻² ln n).
    #[test]
    fn self_interaction_matches_averaged_potential() {
        let p = panel();
        let [a, b, c] = p.corners;
        let n = 120;
        let mut sum = 0.0;
        for i in 0..n {
            for j in 0..n - i {
                for (o, inside) in [(1.0 / 3.0, true), (2.0 / 3.0, i + j + 1 < n)] {
                    if inside {
                        let (s, t) = ((i as f64 + o) / n as f64, (j as f64 + o) / n as f64);
                        sum += p.potential(a + (b - a) * s + (c - a) * t).uniform;
                    }
                }
            }
        }
        let average = sum * p.area / (n * n) as f64;
        assert_relative_eq!(p.self_interaction(), average, max_relative = 2e-4);
    }

    #[test]
    fn curls_of_the_hats_sum_to_zero() {
        let p = panel();
        let [a, b, c] = p.curls();
        assert!((a + b + c).norm() < 1e-14);
        // n × ∇λ turned back is a gradient that is 1 across the height over corner 0.
        let gradient = a.cross(&p.normal);
        assert_relative_eq!(
            gradient.dot(&(p.corners[0] - p.corners[1])),
            1.0,
            epsilon = 1e-13
        );
        assert!(gradient.dot(&(p.corners[2] - p.corners[1])).abs() < 1e-13);
    }
}
