//! Nodes and weights of the Gauss–Legendre, Gauss–Lobatto and Gauss–Radau rules on [−1, 1].

use crate::math;

/// The Legendre polynomials of degree `n` and `n − 1` at `x` (`n ≥ 1`), by their recurrence.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut previous, mut current) = (1.0, x);
    for k in 1..n {
        let k = k as f64;
        (previous, current) = (
            current,
            ((2.0 * k + 1.0) * x * current - k * previous) / (k + 1.0),
        );
    }
    (current, previous)
}

/// A quadrature rule on [−1, 1], nodes increasing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Rule {
    pub nodes: Vec<f64>,
    pub weights: Vec<f64>,
}

impl Rule {
    fn from_fn(n: usize, mut node_weight: impl FnMut(usize) -> (f64, f64)) -> Self {
        let (nodes, weights) = (0..n).map(&mut node_weight).unzip();
        Self { nodes, weights }
    }

    /// `n ≥ 1` interior nodes, exact for polynomials of degree `2n − 1`.
    pub fn gauss(n: usize) -> Self {
        let count = n as f64;
        Self::from_fn(n, |i| {
            let guess = -math::cos((i as f64 + 0.75) / (count + 0.5) * std::f64::consts::PI);
            let slope = |x: f64| {
                let (p, q) = legendre(n, x);
                (p, count * (x * p - q) / (x * x - 1.0))
            };
            let x = newton(guess, slope);
            let derivative = slope(x).1;
            (x, 2.0 / ((1.0 - x * x) * derivative * derivative))
        })
    }

    /// `n ≥ 2` nodes, both ends among them, exact for polynomials of degree `2n − 3`.
    pub fn lobatto(n: usize) -> Self {
        let degree = n - 1;
        let scale = (degree * n) as f64;
        Self::from_fn(n, |i| {
            let x = if i == 0 {
                -1.0
            } else if i == degree {
                1.0
            } else {
                let guess = -math::cos(i as f64 * std::f64::consts::PI / degree as f64);
                // The roots of P'ₙ₋₁: (1 − x²)P' = n(Pₙ₋₁ − xPₙ) and ((1 − x²)P')' = −n(n+1)Pₙ.
                newton(guess, |x| {
                    let (p, q) = legendre(degree, x);
                    (degree as f64 * (q - x * p), -scale * p)
                })
            };
            let p = legendre(degree, x).0;
            (x, 2.0 / (scale * p * p))
        })
    }

    /// `n ≥ 1` nodes, the right end among them, exact for polynomials of degree `2n − 2`.
    pub fn radau_right(n: usize) -> Self {
        let count = n as f64;
        // It is the mirror image of the left rule, whose nodes are the roots of Pₙ₋₁ + Pₙ.
        let mut rule = Self::from_fn(n, |i| {
            let left = n - 1 - i;
            let x = if left == 0 {
                -1.0
            } else {
                let guess =
                    -math::cos(2.0 * std::f64::consts::PI * left as f64 / (2.0 * count - 1.0));
                newton(guess, |x| {
                    let (p, q) = legendre(n, x);
                    let r = if n == 1 { 0.0 } else { legendre(n - 1, x).1 };
                    let derivative = count * (x * p - q) / (x * x - 1.0)
                        + (count - 1.0) * (x * q - r) / (x * x - 1.0);
                    (p + q, derivative)
                })
            };
            let q = if n == 1 { 1.0 } else { legendre(n - 1, x).0 };
            (-x, (1.0 - x) / (count * count * q * q))
        });
        rule.nodes[n - 1] = 1.0;
        rule
    }
}

/// Newton's iteration from a guess close enough to converge quadratically.
fn newton(guess: f64, value_slope: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut x = guess;
    for _ in 0..30 {
        let (value, slope) = value_slope(x);
        let step = value / slope;
        x -= step;
        if step.abs() < 1e-16 {
            break;
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every rule integrates every monomial up to its degree of exactness, and not the next even one.
    #[test]
    fn degrees_of_exactness() {
        let moment = |rule: &Rule, degree: usize| -> f64 {
            let powers = rule.nodes.iter().map(|x| x.powi(degree as i32));
            powers.zip(&rule.weights).map(|(p, w)| p * w).sum()
        };
        for n in 2..=40 {
            let rules = [
                (Rule::gauss(n), 2 * n - 1),
                (Rule::lobatto(n), 2 * n - 3),
                (Rule::radau_right(n), 2 * n - 2),
            ];
            for (rule, exact) in rules {
                assert!(rule.nodes.windows(2).all(|pair| pair[0] < pair[1]));
                for degree in 0..=exact {
                    let expected = if degree % 2 == 0 {
                        2.0 / (degree as f64 + 1.0)
                    } else {
                        0.0
                    };
                    let error = (moment(&rule, degree) - expected).abs();
                    assert!(error < 1e-13, "n = {n}, degree {degree}: {error:e}");
                }
                if n <= 8 {
                    let next = exact + 1 + exact % 2;
                    let next = if next == exact + 1 { next } else { exact + 1 };
                    let expected = if next % 2 == 0 {
                        2.0 / (next as f64 + 1.0)
                    } else {
                        0.0
                    };
                    assert!((moment(&rule, next) - expected).abs() > 1e-9, "n = {n}");
                }
            }
        }
    }

    /// Radau IIA of two and three stages, Hairer & Wanner, Solving ODEs II, § IV.5.
    #[test]
    fn radau_nodes_of_the_literature() {
        let two = Rule::radau_right(2);
        assert!((two.nodes[0] - (2.0 / 3.0 - 1.0)).abs() < 1e-15);
        assert!((two.weights[0] - 1.5).abs() < 1e-14);
        let three = Rule::radau_right(3);
        let expected = 2.0 * (4.0 - 6.0_f64.sqrt()) / 10.0 - 1.0;
        assert!((three.nodes[0] - expected).abs() < 1e-15);
        assert_eq!(
            Rule::radau_right(1),
            Rule {
                nodes: vec![1.0],
                weights: vec![2.0]
            }
        );
    }
}
