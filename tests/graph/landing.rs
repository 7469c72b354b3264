//! Where falls land: normal about the asked mean with the asked deviation, along the heading and across
//! it, in every pattern.

use super::{ROUND, deviations, leaf, positions, up_to};
use rapier3d_immersed::motion::Regime;
use rapier3d_immersed::motion::path::{Deviation, SynthesisParams};

const FALLS: u64 = 2000;
const HEIGHT: f64 = 2.0;
const ASPECT: f64 = 0.073 / 0.042;

/// Normal distribution function by Simpson's rule; beyond 8 deviations it would be lost in rounding.
fn normal_below(z: f64) -> f64 {
    let density = |x: f64| (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
    let h = z.clamp(-8.0, 8.0) / 400.0;
    let sum: f64 = (0..200)
        .map(|i| {
            let x = 2.0 * h * f64::from(i);
            density(x) + 4.0 * density(x + h) + density(x + 2.0 * h)
        })
        .sum();
    0.5 + sum * h / 3.0
}

/// Anderson–Darling A² of values against the standard normal distribution, nothing estimated.
fn anderson_darling(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    let sum: f64 = (0..n)
        .map(|i| {
            let below = normal_below(values[i]).ln();
            let above = normal_below(-values[n - 1 - i]).ln();
            (2 * i + 1) as f64 * (below + above)
        })
        .sum();
    -(n as f64) - sum / n as f64
}

/// The test finds what is not normal, or not of unit deviation, and passes what is: A² of quantiles.
#[test]
fn the_test_can_fail() {
    let quantiles = |of: &dyn Fn(f64) -> f64| {
        let n = FALLS as f64;
        (0..FALLS)
            .map(|i| of((i as f64 + 0.5) / n))
            .collect::<Vec<_>>()
    };
    let normal = |p: f64| {
        let (mut low, mut high) = (-8.0, 8.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if normal_below(middle) < p {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    };
    assert!(anderson_darling(quantiles(&normal)) < 0.1);
    assert!(anderson_darling(quantiles(&|p| 1.1 * normal(p))) > CRITICAL);
    assert!(anderson_darling(quantiles(&|p| normal(p) + 0.1)) > CRITICAL);
    // Uniform of unit variance.
    assert!(anderson_darling(quantiles(&|p| (p - 0.5) * 12f64.sqrt())) > CRITICAL);
}

/// 1 % level for a distribution that is known (Stephens, *J. Am. Stat. Assoc.* 69, 1974).
const CRITICAL: f64 = 3.857;

/// D = k B (L/a) h and the deviation k C (L/a) h/√2 (thesis (3.9)) by hand, of k = 1, B = .3
/// and C = .15; a steady fall is asked to deviate a tenth as far.
#[test]
fn landings_are_normal_in_every_pattern() {
    let asked = deviations(Deviation {
        across: 0.08,
        ..ROUND
    });
    let distance = |per_height: f64| per_height * ASPECT * HEIGHT;
    for regime in Regime::ALL {
        let synthesizer = leaf(SynthesisParams {
            interval: 0.05,
            deviations: asked,
            ..up_to(regime, HEIGHT)
        });
        let share = match regime {
            Regime::SteadyDescent => 0.1,
            _ => 1.0,
        };
        let mean = share * distance(0.3);
        let spread = share * distance(0.15) / 2f64.sqrt();
        let spread_across = share * distance(0.08) / 2f64.sqrt();
        let (mut along, mut across) = (Vec::new(), Vec::new());
        for seed in 0..FALLS {
            let path = synthesizer.path_through(&[regime], seed).unwrap();
            let landing = *positions(&path).last().unwrap();
            assert!((landing.y + HEIGHT).abs() < 1e-5);
            along.push((landing.x - mean) / spread);
            across.push(landing.z / spread_across);
        }
        let n = FALLS as f64;
        let correlation = along.iter().zip(&across).map(|(a, b)| a * b).sum::<f64>() / n;
        let [along, across] = [along, across].map(anderson_darling);
        println!("{regime}: A² {along:.2} along, {across:.2} across, correlation {correlation:.3}");
        assert!(along < CRITICAL && across < CRITICAL, "{regime}");
        // Three standard errors.
        assert!(correlation.abs() < 3.0 / n.sqrt(), "{regime}");
    }
}

/// Without a width across falls that do not circle stay in a plane; with no width at all they land at one point.
#[test]
fn no_scatter_unless_asked() {
    for regime in Regime::ALL {
        let one_point = deviations(Deviation {
            width: 0.0,
            ..ROUND
        });
        let synthesizer = leaf(SynthesisParams {
            deviations: one_point,
            ..up_to(regime, HEIGHT)
        });
        let land = |seed| {
            let path = synthesizer.path_through(&[regime], seed).unwrap();
            *positions(&path).last().unwrap()
        };
        for seed in 1..20 {
            assert!((land(seed) - land(0)).norm() < 1e-5 && land(seed).z.abs() < 1e-5);
        }
    }
}
