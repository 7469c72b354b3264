//! The underwater vehicle.

use crate::rov::{DIAMETER, DOWNWARD, HALF, LINEAR, MASS, QUADRATIC, Rov, STIFFNESS, THRUST};
use rapier3d_immersed::Fluid;
use rapier3d_immersed::rapier3d::prelude::*;

/// Depth is kept within 2 cm in a current of 0.3 m/s. Where it settles, the vertical two balance what is left of the buoyancy and
/// Fossen's damping `d w + d₂ w|w|` in the current's downward part, with a thrust that is less by the inflow, `1 −
/// k₁J/k₀`: within 3 % of that offset.
#[test]
fn keeps_its_depth() {
    let mut rov = Rov::new(60.0).unwrap();
    for _ in 0..100 {
        let at = rov.run(0.2);
        assert!(at.y.abs() < 0.02, "{at}");
        assert!(at.length() < 0.1, "{at}");
    }
    let density = f64::from(Fluid::WATER.density());
    let volume = 8.0 * f64::from(HALF.x) * f64::from(HALF.y) * f64::from(HALF.z);
    let current = f64::from(DOWNWARD);
    let load = (density * volume - f64::from(MASS)) * 9.81
        - (LINEAR[1] * current + QUADRATIC[1] * current * current);
    // Both push half of what is asked for: at so many turns per second it would be that at a standstill.
    let mut offset = load / f64::from(STIFFNESS);
    for _ in 0..20 {
        let each = -0.5 * offset * f64::from(STIFFNESS);
        let turns = (each / (density * DIAMETER.powi(4) * THRUST[0])).sqrt();
        let advance = current / (turns * DIAMETER);
        offset = load / f64::from(STIFFNESS) / (1.0 - THRUST[1] / THRUST[0] * advance);
    }
    let found = f64::from(rov.run(0.0).y);
    assert!((found / offset - 1.0).abs() < 0.03, "{found} {offset}");
    assert_eq!(rov.immersion.warnings(), []);
}

/// A step of 1 m is taken within 5 s and overshot by less than 10 %, at 60 and at 240 Hz.
#[test]
fn takes_a_step() {
    for hz in [60.0, 240.0] {
        let mut rov = Rov::new(hz).unwrap();
        rov.run(10.0);
        rov.target = Vector::Y * -1.0;
        let mut deepest = 0.0_f32;
        for i in 0..100 {
            let at = rov.run(0.1);
            deepest = deepest.min(at.y);
            assert!(i < 50 || (at.y + 1.0).abs() < 0.02, "{hz}: {at}");
        }
        assert!(deepest > -1.1, "{hz}: {deepest}");
    }
}
