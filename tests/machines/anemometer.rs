//! The anemometer's rate against the same cups' drag, integrated over a turn.

use crate::anemometer::{ARM, Anemometer, OPEN_FIRST, ROUND_FIRST};
use crate::must;
use std::f64::consts::TAU;

/// Torque of a cup over ½ρAV²R, averaged over a turn at a tip speed of λ winds: its drag by its own speed through the air
/// along its path, round side first where it is positive.
fn mean_torque(lambda: f64) -> f64 {
    const STEPS: usize = 10_000;
    let each = |i: usize| {
        let through = lambda + (TAU * (i as f64 + 0.5) / STEPS as f64).sin();
        let drag = if through > 0.0 {
            ROUND_FIRST
        } else {
            OPEN_FIRST
        };
        -drag * through * through.abs()
    };
    (0..STEPS).map(each).sum::<f64>() / STEPS as f64
}

/// λ at which that vanishes: by bisection.
fn free_running() -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if mean_torque(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Tip speed over wind is one number for all winds, that of the quasi-steady drag of its cups, to 0.5 %: a rotor of some inertia
/// keeps its speed over a turn, as the integral assumes.
#[test]
fn turns_in_proportion_to_the_wind() {
    let exact = free_running();
    for wind in [3.0, 6.0, 12.0] {
        for hz in [60.0, 240.0] {
            let mut rotor = must(Anemometer::new(wind, hz));
            rotor.run(60.0 / wind);
            let lambda = rotor.run(20.0 / wind) * ARM / f64::from(wind);
            assert!(
                (lambda / exact - 1.0).abs() < 0.005,
                "{wind}, {hz}: {lambda} {exact}"
            );
        }
    }
}
