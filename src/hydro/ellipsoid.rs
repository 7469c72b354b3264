//! What potential flow and creeping flow say about ellipsoids in closed form.

use super::{AddedMass, carlson};
use crate::geometry::Ellipsoid;
use rapier3d::na::Vector3;
use std::f64::consts::PI;

/// The resistance of a body in creeping flow, per unit dynamic viscosity and along its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StokesResistance {
    /// Force over velocity and viscosity, m. A sphere of radius a: 6πa.
    pub linear: Vector3<f64>,
    /// Torque over angular velocity and viscosity, m³. A sphere of radius a: 8πa³.
    pub angular: Vector3<f64>,
}

/// The integrals `∫₀^∞ dλ / ((a_i² + λ) σ)` with `σ = √Π(a_j² + λ)`, in the combinations that
/// stay finite, and keep their digits, when the smallest semi-axis goes to zero.
struct Integrals {
    /// Depolarisation factors α₀, β₀, γ₀ = a b c × the integral; they sum to 2.
    depolarisation: Vector3<f64>,
    /// The integrals themselves, m⁻³; infinite for a semi-axis that is zero.
    bare: Vector3<f64>,
    /// a_i² × the integral, m⁻¹.
    weighted: Vector3<f64>,
    /// Index of the smallest semi-axis.
    thin: usize,
}

impl Ellipsoid {
    /// Added mass per unit fluid density about the center, in the ellipsoid's axes (Lamb,
    /// *Hydrodynamics*, §§ 114–115; thesis (5.10)–(5.11) with two corrections: **semi**-axes, and
    /// `b² + c²` to the first power).
    ///
    /// No quadrature is involved: the integrals are Carlson's, evaluated to rounding. A zero
    /// semi-axis gives the limit of the elliptic disc.
    pub fn added_mass(&self) -> AddedMass {
        let integrals = self.integrals();
        AddedMass::diagonal(
            Vector3::from_fn(|i, _| self.linear(&integrals, i)),
            Vector3::from_fn(|i, _| self.angular(&integrals, i)),
        )
    }

    /// Resistance in creeping flow (Oberbeck 1876, Edwardes 1892; Happel & Brenner, *Low Reynolds
    /// Number Hydrodynamics*, § 5-11). A zero semi-axis gives the elliptic disc.
    pub fn stokes_resistance(&self) -> StokesResistance {
        let integrals = self.integrals();
        let [a, b, c] = self.semi_axes.map(|s| s * s).into();
        let chi = 2.0 * carlson::rf(a, b, c);
        let w = integrals.weighted;
        let about =
            |(y2, wy): (f64, f64), (z2, wz): (f64, f64)| 16.0 * PI / 3.0 * (y2 + z2) / (wy + wz);
        StokesResistance {
            linear: w.map(|w| 16.0 * PI / (chi + w)),
            angular: Vector3::new(
                about((b, w.y), (c, w.z)),
                about((c, w.z), (a, w.x)),
                about((a, w.x), (b, w.y)),
            ),
        }
    }

    fn integrals(&self) -> Integrals {
        let s = self.semi_axes;
        let squares = s.map(|x| x * x);
        let thin = s.imin();
        let (j, k) = ((thin + 1) % 3, (thin + 2) % 3);
        let product = s.product();
        let mut bare = Vector3::zeros();
        for (i, other) in [(j, k), (k, j)] {
            bare[i] = 2.0 / 3.0 * carlson::rd(squares[other], squares[thin], squares[i]);
        }
        let mut depolarisation = bare * product;
        depolarisation[thin] = 2.0 - depolarisation[j] - depolarisation[k];
        bare[thin] = depolarisation[thin] / product;
        let mut weighted = bare.component_mul(&squares);
        weighted[thin] = depolarisation[thin] * s[thin] / (s[j] * s[k]);
        Integrals {
            depolarisation,
            bare,
            weighted,
            thin,
        }
    }

    /// `V α₀ / (2 − α₀)` for axis `i`; for the thin axis the vanishing V and 2 − α₀ are both
    /// divided by a b c.
    fn linear(&self, integrals: &Integrals, i: usize) -> f64 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let d = &integrals.depolarisation;
        if i == integrals.thin {
            4.0 / 3.0 * PI * d[i] / (integrals.bare[j] + integrals.bare[k])
        } else {
            self.volume() * d[i] / (d[j] + d[k])
        }
    }

    /// `V/5 (b²−c²)² (γ₀−β₀) / (2(b²−c²) + (b²+c²)(β₀−γ₀))` for rotation about axis `i`, with the
    /// denominator rewritten through α₀ + β₀ + γ₀ = 2 as a sum of positive terms.
    fn angular(&self, integrals: &Integrals, i: usize) -> f64 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let s = &self.semi_axes;
        let difference = (s[j] - s[k]) * (s[j] + s[k]);
        if difference == 0.0 {
            return 0.0;
        }
        let mean_square = 0.5 * (s[j] * s[j] + s[k] * s[k]);
        let (numerator, positive) = if difference.abs() < ALL_BUT_ROUND * mean_square {
            let [second, third] = round_integrals(mean_square, s[i]);
            (
                difference * difference * s.product() * third / 5.0,
                2.0 * (second - mean_square * third),
            )
        } else {
            (
                difference * (integrals.depolarisation[k] - integrals.depolarisation[j]) / 5.0,
                2.0 * (integrals.weighted[j] - integrals.weighted[k]) / difference,
            )
        };
        if i == integrals.thin {
            let denominator = integrals.depolarisation[i] + s.product() * positive;
            self.volume() * numerator / denominator
        } else {
            4.0 / 3.0 * PI * numerator / (integrals.bare[i] + positive)
        }
    }
}

/// Relative difference of the squares of two semi-axes below which their integrals agree to so many digits
/// that the difference has none; those of a round cross-section differ from them by its square.
const ALL_BUT_ROUND: f64 = 1e-4;

/// `∫₀^∞ dλ / ((m + λ)ⁿ √(a² + λ))` for n = 2 and 3: what the integrals of two equal semi-axes √m come to
/// when their differences are divided by that of the squares.
fn round_integrals(m: f64, a: f64) -> [f64; 2] {
    let second = 2.0 / 3.0 * carlson::rd(m, a * a, m);
    let e = 1.0 - a * a / m;
    let third = if e.abs() < 0.1 {
        // With t² = m/(m + λ): 2 m^(−5/2) ∫₀¹ t⁴ (1 − e t²)^(−½) dt, term by term.
        let (mut power, mut sum) = (1.0, 0.0);
        for k in 0..14 {
            let k = f64::from(k);
            sum += power / (2.0 * k + 5.0);
            power *= e * (2.0 * k + 1.0) / (2.0 * k + 2.0);
        }
        2.0 * sum / (m * m * m.sqrt())
    } else {
        // From the integral of d/dλ [(m + λ)⁻² √(a² + λ)].
        (1.5 * second - a / (m * m)) / (2.0 * m * e)
    };
    [second, third]
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn ellipsoid(a: f64, b: f64, c: f64) -> Ellipsoid {
        Ellipsoid {
            semi_axes: Vector3::new(a, b, c),
        }
    }

    /// Lamb's coefficients, added mass over displaced mass and added over displaced moment of
    /// inertia, recomputed from the integrals with an independent program (printed to 5 digits).
    #[test]
    fn lamb_table() {
        #[rustfmt::skip]
        let table: [([f64; 3], [f64; 3], [f64; 3]); 6] = [
            ([1.0, 1.0, 1.0], [0.5, 0.5, 0.5], [0.0, 0.0, 0.0]),
            ([2.0, 1.0, 1.0], [0.21002, 0.70421, 0.70421], [0.0, 0.23942, 0.23942]),
            ([10.0, 1.0, 1.0], [0.02071, 0.96023, 0.96023], [0.0, 0.88354, 0.88354]),
            ([1.0, 1.0, 0.5], [0.30959, 0.30959, 1.11506], [0.33858, 0.33858, 0.0]),
            ([1.0, 1.0, 0.1], [0.07480, 0.07480, 6.18413], [4.02230, 4.02230, 0.0]),
            ([3.0, 2.0, 1.0], [0.18526, 0.36454, 1.36153], [0.38327, 0.70824, 0.05990]),
        ];
        for ([a, b, c], k, k_rot) in table {
            let body = ellipsoid(a, b, c);
            let added = body.added_mass();
            let v = body.volume();
            let solid = Vector3::new(b * b + c * c, a * a + c * c, a * a + b * b) * (v / 5.0);
            for i in 0..3 {
                assert!(
                    (added.linear[(i, i)] / v - k[i]).abs() <= 1e-5,
                    "{a}:{b}:{c} {i}"
                );
                let rotation = added.angular[(i, i)] / solid[i];
                assert!(
                    (rotation - k_rot[i]).abs() <= 1e-5,
                    "{a}:{b}:{c} {i} {rotation}"
                );
            }
        }
    }

    /// The integrals against direct quadrature of their definition.
    #[test]
    fn depolarisation_matches_quadrature() {
        // λ = exp(π/2 sinh t) maps the half line to ℝ; the trapezoidal rule then converges
        // exponentially, so that 4000 points leave rounding only.
        let quadrature = |body: &Ellipsoid, i: usize| {
            let squares = body.semi_axes.map(|s| s * s);
            let (n, limit) = (4000, 4.2);
            let step = 2.0 * limit / f64::from(n);
            (0..=n)
                .map(|j| {
                    let t = -limit + f64::from(j) * step;
                    let lambda = (PI / 2.0 * t.sinh()).exp();
                    let sigma = squares.map(|s| s + lambda).product().sqrt();
                    let jacobian = lambda * PI / 2.0 * t.cosh();
                    jacobian / ((squares[i] + lambda) * sigma) * step
                })
                .sum::<f64>()
                * body.semi_axes.product()
        };
        for (a, b, c) in [
            (1.0, 1.0, 1.0),
            (3.0, 2.0, 1.0),
            (0.1, 2.0, 0.7),
            (3.65, 2.1, 0.015),
        ] {
            let body = ellipsoid(a, b, c);
            let d = body.integrals().depolarisation;
            for i in 0..3 {
                assert_relative_eq!(d[i], quadrature(&body, i), max_relative = 1e-9);
            }
        }
    }

    /// Disc of radius a: 8/3 a³ broadside, 16/45 a⁵ about a diameter, nothing else (Lamb § 108).
    /// Elliptic disc 2:1: 4/3 π a b²/E(e) and the two rotations (recomputed independently).
    #[test]
    fn discs_are_exact_limits() {
        let disc = ellipsoid(0.5, 0.5, 0.0).added_mass();
        assert_relative_eq!(disc.linear[(2, 2)], 8.0 / 3.0 * 0.125, max_relative = 1e-13);
        assert_relative_eq!(
            disc.angular[(0, 0)],
            16.0 / 45.0 / 32.0,
            max_relative = 1e-13
        );
        assert_eq!(disc.linear[(0, 0)], 0.0);
        assert_eq!(disc.angular[(2, 2)], 0.0);

        let elliptic = ellipsoid(2.0, 1.0, 0.0).added_mass();
        assert_relative_eq!(elliptic.linear[(2, 2)], 6.91758, max_relative = 1e-6);
        assert_relative_eq!(elliptic.angular[(0, 0)], 0.79523, max_relative = 1e-5);
        assert_relative_eq!(elliptic.angular[(1, 1)], 4.39131, max_relative = 1e-5);
        // A leaf 0.3 mm thick is close to that limit, and no digits are lost.
        let thin = ellipsoid(2.0, 1.0, 1e-9).added_mass();
        assert_relative_eq!(
            thin.linear[(2, 2)],
            elliptic.linear[(2, 2)],
            max_relative = 1e-8
        );
        assert_relative_eq!(
            thin.angular[(1, 1)],
            elliptic.angular[(1, 1)],
            max_relative = 1e-8
        );
    }

    /// Through the switch to the round cross-section, and down to a difference of one bit, the rotation about
    /// the all but round axis goes as the square of the difference, as it must.
    #[test]
    fn all_but_round_ellipsoids() {
        for a in [1e-3, 0.5, 0.97, 1.03, 2.0, 300.0] {
            let over_square = |d: f64| {
                let body = ellipsoid(a, 1.0 + 0.5 * d, 1.0 - 0.5 * d);
                body.added_mass().angular[(0, 0)] / (d * d)
            };
            let wide = over_square(2e-3);
            for d in [1.01e-4, 0.99e-4, 5.1e-5, 4.9e-5, 1e-6, 1e-9, 3e-16] {
                // Even terms only: (2·10⁻³)² between the two, and 10⁻¹² over the difference of rounding.
                let expected = if d < 1e-15 { 0.4 } else { 1e-5 };
                assert!((over_square(d) / wide - 1.0).abs() < expected, "{a} {d}");
            }
        }
    }

    /// The order of the axes does not matter, whichever is the smallest.
    #[test]
    fn permuting_axes_permutes_the_result() {
        let reference = ellipsoid(3.0, 2.0, 1.0).added_mass();
        let turned = ellipsoid(1.0, 3.0, 2.0).added_mass();
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            assert_relative_eq!(
                reference.linear[(i, i)],
                turned.linear[(j, j)],
                max_relative = 1e-12
            );
            assert_relative_eq!(
                reference.angular[(i, i)],
                turned.angular[(j, j)],
                max_relative = 1e-12
            );
        }
    }

    /// Stokes 1851 for the sphere; exact values for the disc (Lamb § 339, Jeffery 1922).
    #[test]
    fn creeping_flow_limits() {
        let sphere = ellipsoid(0.3, 0.3, 0.3).stokes_resistance();
        assert_relative_eq!(sphere.linear.x, 6.0 * PI * 0.3, max_relative = 1e-12);
        assert_relative_eq!(sphere.angular.z, 8.0 * PI * 0.027, max_relative = 1e-12);
        let disc = ellipsoid(1.0, 1.0, 0.0).stokes_resistance();
        assert_relative_eq!(disc.linear.z, 16.0, max_relative = 1e-12);
        assert_relative_eq!(disc.linear.x, 32.0 / 3.0, max_relative = 1e-12);
        assert_relative_eq!(disc.angular.x, 32.0 / 3.0, max_relative = 1e-12);
        assert_relative_eq!(disc.angular.z, 32.0 / 3.0, max_relative = 1e-12);
    }
}
