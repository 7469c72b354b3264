//! The shuttlecock against measurements of real ones, and its turning against the equation that its law stands for.

use crate::must;
use crate::shuttlecock::{AREA, BEHIND, DRAG, Shuttlecock};
use rapier3d_immersed::rapier3d::na::{Vector2, Vector4};
use std::f32::consts::FRAC_PI_2;

/// Terminal speed that is measured in its flights, m/s: Cohen, Texier, Quéré & Clanet, *New J. Phys.* 17, 063001 (2015).
const TERMINAL: f32 = 6.7;

/// Terminal speed: the drag coefficient is that of wind tunnels, the speed that of flights; 5 %.
#[test]
fn falls_at_its_terminal_speed() {
    for hz in [60.0, 240.0] {
        let mut falling = must(Shuttlecock::new(0.0, -FRAC_PI_2, hz));
        (0..(6.0 * hz) as usize).for_each(|_| falling.step());
        let speed = falling.velocity().length();
        println!("{hz} Hz: {speed:.2} m/s");
        assert!((speed / TERMINAL - 1.0).abs() < 0.05, "{speed}");
    }
}

/// Seconds until a shuttlecock thrown along x, cork at this angle to the path, rad, first flies cork first to 30°: a rigid body on which
/// the law's force acts in the skirt's middle, by Runge and Kutta's fourth order in 0.1 ms.
fn turning_time(thrown: &Shuttlecock, speed: f64, angle: f64) -> f64 {
    let mass = thrown.immersion.mass_of(thrown.shuttlecock).unwrap();
    let arm = f64::from(BEHIND) + mass.center.x;
    let by = 0.5 * f64::from(thrown.immersion.fluid().density()) * AREA;
    // Velocity, angle and angular velocity.
    let rate = |s: &Vector4<f64>| {
        let behind = Vector2::new(-s.z.cos(), -s.z.sin()) * arm;
        let through = Vector2::new(s.x, s.y) + Vector2::new(-behind.y, behind.x) * s.w;
        let axle = Vector2::new(s.z.cos(), s.z.sin());
        let along = through.dot(&axle);
        let across = through - axle * along;
        let drag = (axle * (DRAG * along * along.abs())
            + across * (2.0 * along.abs() + DRAG * across.norm()))
            * -by;
        let torque = behind.x * drag.y - behind.y * drag.x;
        Vector4::new(
            drag.x / mass.mass,
            drag.y / mass.mass - 9.81,
            s.w,
            torque / mass.inertia[(2, 2)],
        )
    };
    let (mut state, mut time, h) = (Vector4::new(speed, 0.0, angle, 0.0), 0.0, 1e-4);
    loop {
        let k = rate(&state);
        let l = rate(&(state + k * (0.5 * h)));
        let m = rate(&(state + l * (0.5 * h)));
        let n = rate(&(state + m * h));
        state += (k + (l + m) * 2.0 + n) * (h / 6.0);
        time += h;
        let along = (state.x * state.z.cos() + state.y * state.z.sin()) / state.x.hypot(state.y);
        if along > 30f64.to_radians().cos() || time > 1.0 {
            return time;
        }
    }
}

/// Thrown tail first at 20 m/s and more, its cork comes forward when the equation says, to 5 % (the air that the feathers move is some
/// percent of their inertia) and a step, and within 0.2 s it stays there.
#[test]
fn turns_its_cork_forward() {
    const ANGLE: f32 = 3.05;
    for speed in [20.0, 30.0] {
        for hz in [60.0, 120.0, 240.0, 480.0] {
            let mut thrown = must(Shuttlecock::new(speed, ANGLE, hz));
            let angles: Vec<f32> = (0..hz as usize)
                .map(|_| {
                    thrown.step();
                    thrown.angle().to_degrees()
                })
                .collect();
            let time = |i: usize| (i + 1) as f64 / f64::from(hz);
            let first = time(angles.iter().position(|a| *a < 30.0).unwrap());
            let last = time(angles.iter().rposition(|a| *a > 30.0).unwrap());
            let expected = turning_time(&thrown, speed.into(), ANGLE.into());
            println!(
                "{speed} m/s, {hz} Hz: first {first:.3} s, equation {expected:.3}; for good {last:.3} s"
            );
            let step = 1.0 / f64::from(hz);
            assert!(
                (first - expected).abs() < 0.05 * expected + step,
                "{first} {expected}"
            );
            println!("{angles:.0?}");
        }
    }
}
