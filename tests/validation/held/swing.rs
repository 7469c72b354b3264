//! Bodies on ropes and pivots, against their equations.

use rapier3d_immersed::flow::{Flow, Uniform};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, ImmersedBody, Immersion, ViscousLaw};
use std::f64::consts::TAU;

/// A ball on a massless rod under water, an ideal fluid: `T = 2π √(L/g · (m + ½ρV)/(m − ρV))` for small
/// swings, the ball's rotation taken with it: (m + ½ρV)L² + ⅖mr² in place of the mass. Two balls of
/// different density, each at two steps.
#[test]
fn pendulum_under_water() {
    for density in [1500.0, 7800.0] {
        for hz in [60.0, 240.0] {
            let mut world = PhysicsWorld::new();
            world.integration_parameters.dt = 1.0 / hz;
            let (radius, length, tilt) = (0.05_f64, 1.0_f64, 0.05_f64);
            let at = Vector::new(
                (length * tilt.sin()) as f32,
                -(length * tilt.cos()) as f32,
                0.0,
            );
            let post = world.insert_body(RigidBodyBuilder::fixed());
            let (ball, _) = world.insert(
                RigidBodyBuilder::dynamic()
                    .translation(at)
                    .rotation(Vector::Z * tilt as f32)
                    .can_sleep(false),
                ColliderBuilder::ball(radius as f32).density(density),
            );
            let pivot =
                RevoluteJointBuilder::new(Vector::Z).local_anchor2(Vector::Y * length as f32);
            world.insert_impulse_joint(post, ball, pivot);
            let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, ball).unwrap();
            let displaced = 997.0 * hydro.volume;
            let mass = f64::from(density) * hydro.volume;
            let body = ImmersedBody::new(hydro).with_law(ViscousLaw::Inviscid);
            let mut immersion = Immersion::new(Fluid::WATER);
            immersion.insert(ball, body.unwrap());
            let inertia = (mass + 0.5 * displaced) * length * length + 0.4 * mass * radius * radius;
            let period = TAU * (inertia / ((mass - displaced) * 9.81 * length)).sqrt();
            // Time of the fourth passage through the vertical from one side.
            let (mut before, mut passages) = (at.x, vec![]);
            for step in 1..(6.0 * period * f64::from(hz)) as usize {
                immersion.step(&mut world);
                let now = world.bodies[ball].translation().x;
                if before > 0.0 && now <= 0.0 {
                    let share = f64::from(before / (before - now));
                    passages.push((step as f64 - 1.0 + share) / f64::from(hz));
                }
                before = now;
            }
            let measured = (passages[4] - passages[0]) / 4.0;
            assert!(
                (measured / period - 1.0).abs() < 0.02,
                "{density} {hz}: {measured} {period}"
            );
        }
    }
}

/// A fluid that hardly moves, and never twice alike.
struct Trembling;

impl Flow for Trembling {
    fn velocity(&self, _point: Vector, time: f64) -> Vector {
        Vector::X * (1e-5 * (700.0 * time).sin()) as Real
    }
}

/// A plate on a hinge at its edge swings under water, in an ideal fluid, as far in a fluid that trembles by 10⁻⁵ m/s as
/// in a still one: what its energy may be is found in another way where the fluid's velocity changes, by what the
/// fluid does in the motion that was integrated, less what the hinge's force **and** moment were counted on for.
#[test]
fn a_plate_swings_as_far_in_a_trembling_fluid() {
    let swing = |trembles: bool| {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = 1.0 / 240.0;
        let post = world.insert_body(RigidBodyBuilder::fixed());
        let tilt = 0.3_f32;
        let at = Vector::new(tilt.sin(), -tilt.cos(), 0.0) * 0.1;
        let body = RigidBodyBuilder::dynamic()
            .translation(at)
            .rotation(Vector::Z * tilt)
            .can_sleep(false);
        let shape = ColliderBuilder::cuboid(0.004, 0.1, 0.05).density(7800.0);
        let (plate, _) = world.insert(body, shape);
        let hinge = RevoluteJointBuilder::new(Vector::Z).local_anchor2(Vector::Y * 0.1);
        world.insert_impulse_joint(post, plate, hinge);
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, plate).unwrap();
        let mut immersion = Immersion::new(Fluid::WATER);
        let ideal = ImmersedBody::new(hydro).with_law(ViscousLaw::Inviscid);
        immersion.insert(plate, ideal.unwrap());
        if trembles {
            immersion.set_flow(Trembling);
        }
        let mut farthest = 0.0_f32;
        for step in 0..5 * 240 {
            immersion.step(&mut world);
            if step > 3 * 240 {
                farthest = farthest.max(world.bodies[plate].translation().x.abs());
            }
        }
        farthest / at.x
    };
    let (still, trembling) = (swing(false), swing(true));
    println!("{still} {trembling}");
    assert!(
        (trembling / still - 1.0).abs() < 0.02,
        "{still} {trembling}"
    );
}

/// A tethered balloon in wind leans until drag, lift and weight are in line with the rope,
/// `tan = drag/(buoyancy − weight)` with the read-out's drag, and does not spin up.
#[test]
fn a_tethered_balloon_leans() {
    for hz in [60.0, 240.0] {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = 1.0 / hz;
        let post = world.insert_body(RigidBodyBuilder::fixed());
        let radius = 0.14;
        let (balloon, _) = world.insert(
            RigidBodyBuilder::dynamic()
                .translation(Vector::Y * 2.0)
                .can_sleep(false),
            ColliderBuilder::ball(radius).mass(0.0044),
        );
        let rope = RopeJointBuilder::new(2.0).local_anchor2(Vector::Y * -radius);
        world.insert_impulse_joint(post, balloon, rope);
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, balloon).unwrap();
        let lift = (1.184 * hydro.volume - 0.0044) * 9.81;
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.set_flow(Uniform::new(1.0, 0.0, 0.0));
        immersion.insert(balloon, hydro);
        let (mut lean, mut expected, mut spin, mut count) = (0.0, 0.0, 0.0_f32, 0.0);
        for step in 0..(30.0 * hz) as usize {
            immersion.step(&mut world);
            let body = &world.bodies[balloon];
            spin = spin.max(body.angvel().length());
            if step > (20.0 * hz) as usize {
                let end = body.position() * (Vector::Y * -radius);
                lean += f64::from(end.x / end.y);
                let forces = immersion.forces(&world.bodies, balloon).unwrap();
                let force = forces.viscous().force;
                expected += f64::from(force.x) / (lift + f64::from(force.y));
                count += 1.0;
            }
        }
        let (lean, expected) = (lean / count, expected / count);
        assert!(
            (lean / expected - 1.0).abs() < 0.05,
            "{hz}: {lean} {expected}"
        );
        assert!(spin < 5.0, "{hz}: {spin} rad/s");
    }
}
