//! The frisbee's precession, and what spin is for.

use crate::frisbee::{AXIAL, Frisbee, RADIUS};
use crate::must;
use rapier3d_immersed::rapier3d::prelude::*;
use std::f64::consts::PI;

/// A fast top's axle goes at M/(I_z ω), to where the moment M points: over a second, against the published C_M at the angle and
/// speed that it has in each moment. 5 %: the axle nods about its mean by 1/(ω t I_z/I_x), 1 to 2 % of the way.
#[test]
fn precesses_by_its_pitching_moment() {
    for hz in [60.0, 240.0] {
        for spin in [60.0, -60.0, 90.0] {
            let mut frisbee = must(Frisbee::new(spin, hz));
            let density = f64::from(frisbee.immersion.fluid().density());
            let radius = f64::from(RADIUS);
            let before = frisbee.up();
            let mut expected = Vector::ZERO;
            for _ in 0..hz as usize {
                let body = &frisbee.world.bodies[frisbee.frisbee];
                let (up, velocity) = (frisbee.up(), body.linvel());
                let rising = velocity.dot(up);
                let forward = (velocity - up * rising).normalize();
                let angle = f64::from(-rising).atan2(velocity.dot(forward).into());
                let pressure = 0.5 * density * f64::from(velocity.length_squared());
                let moment = pressure * PI * radius.powi(2) * 2.0 * radius * (-0.08 + 0.43 * angle);
                let turning = body.angvel().dot(up);
                let rate = moment as f32 / (AXIAL * turning);
                expected += forward.cross(up) * (rate / hz);
                frisbee.step();
            }
            let turned = frisbee.up() - before;
            assert!(
                (turned - expected).length() < 0.05 * expected.length(),
                "{turned} {expected}"
            );
        }
    }
}

/// It flies for seconds with its upper side up if it spins, and turns over without.
#[test]
fn spin_keeps_it_flying() {
    for hz in [60.0, 240.0] {
        let fly = |spin: f32| {
            let mut frisbee = must(Frisbee::new(spin, hz));
            let mut least = 1f32;
            let mut steps = 0;
            while frisbee.position().y > 0.0 && steps < 10_000 {
                frisbee.step();
                least = least.min(frisbee.up().y);
                steps += 1;
            }
            (frisbee.position().x, least.acos().to_degrees())
        };
        let (far, tilted) = fly(60.0);
        let (near, over) = fly(0.0);
        assert!(tilted < 30.0 && over > 90.0, "{tilted} {over}");
        assert!(far > 2.0 * near, "{far} {near}");
    }
}
