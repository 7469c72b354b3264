//! Locked axes.

use crate::support::weightless;
use rapier3d_immersed::flow::Uniform;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion};

/// A ball that cannot translate, in a wind of 2 m/s, spinning at 10 rad/s: the fluid can only brake it, by
/// creeping flow with 0.04/s (1.36·10⁻⁶ N·m·s over the ball's 3.45·10⁻⁵ kg·m²) and by friction with
/// ½ρ 0.005 u (8π/3)R⁴/I = 0.55/s: 10 e^−1.18 = 3.1 rad/s are left after two seconds.
#[test]
fn a_held_ball_in_wind_is_braked() {
    for hz in [30.0, 60.0, 240.0, 1000.0] {
        let mut world = weightless();
        world.integration_parameters.dt = 1.0 / hz;
        let ball = RigidBodyBuilder::dynamic()
            .lock_translations()
            .angvel(Vector::Z * 10.0)
            .can_sleep(false);
        let (ball, _) = world.insert(ball, ColliderBuilder::ball(0.14).mass(0.0044));
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, ball).unwrap();
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.set_flow(Uniform::new(2.0, 0.0, 0.0));
        immersion.insert(ball, hydro);
        for _ in 0..(2.0 * hz) as usize {
            immersion.step(&mut world);
        }
        let spin = world.bodies[ball].angvel().z;
        assert!((2.9..3.3).contains(&spin), "{hz}: {spin}");
    }
}

/// A tilted rod with a locked axis about which it turns at 6 rad/s for ever, which drives the rest: the
/// others stay below twenty-five times that. (What a lock with a velocity does to the energy has no bound but
/// that. In water the rod comes to lie almost across the locked axis and spins about itself, where little
/// brakes it, with 89 rad/s at this step and 47 at an eighth of it.)
#[test]
fn a_driven_rod_does_not_run_away() {
    for (fluid, locks) in [
        (Fluid::AIR, LockedAxes::ROTATION_LOCKED_X),
        (Fluid::WATER, LockedAxes::ROTATION_LOCKED_X),
        (Fluid::AIR, LockedAxes::ROTATION_LOCKED_Y),
        (Fluid::WATER, LockedAxes::ROTATION_LOCKED_Z),
    ] {
        let mut world = weightless();
        let rod = RigidBodyBuilder::dynamic()
            .rotation(Vector::new(0.5, 1.0, 0.8))
            .angvel(Vector::new(6.0, 5.0, 6.0))
            .locked_axes(locks);
        let collider = ColliderBuilder::cuboid(0.2, 0.005, 0.005).density(500.0);
        let (rod, _) = world.insert(rod, collider);
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, rod).unwrap();
        let mut immersion = Immersion::new(fluid);
        immersion.insert(rod, hydro);
        for _ in 0..600 {
            immersion.step(&mut world);
            let spin = world.bodies[rod].angvel();
            assert!(spin.length() < 150.0, "{spin}");
        }
    }
}
