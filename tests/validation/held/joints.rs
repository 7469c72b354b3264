//! Joints feel the whole force of the fluid, and its added mass.

use crate::support::weightless;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, ImmersedBody, Immersion, ViscousLaw};

fn immerse(
    world: &PhysicsWorld,
    immersion: &mut Immersion,
    handle: RigidBodyHandle,
    law: ViscousLaw,
) -> HydroProperties {
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
    let body = ImmersedBody::new(hydro.clone()).with_law(law).unwrap();
    immersion.insert(handle, body);
    hydro
}

/// A parachute: a thin disc of 50 g and 0.5 m radius, broadside on, with a ball of 1 kg on a joint below,
/// falls at the speed where drag is weight. One rigid body of both falls at 4.34 m/s (4.35 by
/// `C_D = 1.12` and 1.184 kg/m³), at any step.
#[test]
fn a_jointed_load_falls_at_the_discs_speed() {
    for hz in [30.0, 60.0, 240.0, 1000.0] {
        for rope in [false, true] {
            let mut world = PhysicsWorld::new();
            world.integration_parameters.dt = 1.0 / hz;
            let upright = || {
                RigidBodyBuilder::dynamic()
                    .lock_rotations()
                    .enabled_translations(false, true, false)
            };
            let disc = ColliderBuilder::cylinder(0.002, 0.5).mass(0.05);
            let (disc, _) = world.insert(upright().translation(Vector::Y), disc);
            let (load, _) = world.insert(upright(), ColliderBuilder::ball(0.05).mass(1.0));
            let joint: GenericJoint = if rope {
                RopeJointBuilder::new(1.0).into()
            } else {
                FixedJointBuilder::new().local_anchor1(-Vector::Y).into()
            };
            world.insert_impulse_joint(disc, load, joint);
            let mut immersion = Immersion::new(Fluid::AIR);
            immerse(&world, &mut immersion, disc, ViscousLaw::default());
            for _ in 0..(8.0 * hz) as usize {
                immersion.step(&mut world);
            }
            let speed = -world.bodies[disc].linvel().y;
            assert!((speed / 4.35 - 1.0).abs() < 0.02, "{hz} {rope}: {speed}");
        }
    }
}

/// A ball of 1 kg pulls a plate broadside through water by 5 N, in an ideal fluid:
/// `a = F/(m + ΣA)`, A as `HydroProperties` has it, from the first step on. (Under plain rapier a multibody's
/// links read the velocity of one substep before, three quarters of it in the first step.)
#[test]
fn a_joint_feels_the_added_mass() {
    for multibody in [false, true] {
        let mut world = weightless();
        let mut immersion = Immersion::new(Fluid::WATER);
        let radius = (1.0 / 997.0 * 0.75 / std::f32::consts::PI).cbrt();
        let gap = Vector::Z * 0.3;
        let (ball, _) = world.insert(
            RigidBodyBuilder::dynamic(),
            ColliderBuilder::ball(radius).density(997.0),
        );
        let (plate, _) = world.insert(
            RigidBodyBuilder::dynamic().translation(gap),
            ColliderBuilder::cuboid(0.1, 0.1, 0.0005).density(2700.0),
        );
        let mut mass = world.bodies[ball].mass() + world.bodies[plate].mass();
        mass = mass.max(1.108);
        for handle in [ball, plate] {
            let hydro = immerse(&world, &mut immersion, handle, ViscousLaw::Inviscid);
            mass += 997.0 * hydro.added_mass.linear[(2, 2)] as Real;
        }
        let joint = FixedJointBuilder::new()
            .local_anchor1(gap / 2.0)
            .local_anchor2(-gap / 2.0);
        if multibody {
            world.insert_multibody_joint(ball, plate, joint);
        } else {
            world.insert_impulse_joint(ball, plate, joint);
        }
        world.bodies[ball].add_force(Vector::Z * 5.0, true);
        let exact = 5.0 / mass;
        immersion.step(&mut world);
        let first = world.bodies[ball].linvel().z;
        assert!((first * 60.0 / exact - 1.0).abs() < 0.03, "{first}");
        for _ in 0..29 {
            immersion.step(&mut world);
        }
        let mean = (world.bodies[plate].linvel().z - first) / (29.0 / 60.0);
        assert!(
            (mean / exact - 1.0).abs() < 0.03,
            "{multibody}: {mean} {exact}"
        );
        // Released, the ball goes on with its own mass and half of that of the water it displaces.
        if multibody {
            let bodies = &world.bodies;
            let joints = &mut world.multibody_joints;
            let joint = joints.attached_joints(ball).next().unwrap().2;
            joints.remove(joint, true);
            assert!(joints.iter().next().is_none() && bodies.contains(ball));
        } else {
            let joint = world.impulse_joints.iter().next().unwrap().0;
            world.impulse_joints.remove(joint, true);
        }
        let [before, plate_before] = [ball, plate].map(|h| world.bodies[h].linvel().z);
        immersion.step(&mut world);
        let [change, plate_change] = [
            world.bodies[ball].linvel().z - before,
            world.bodies[plate].linvel().z - plate_before,
        ];
        let own = 5.0 / 60.0 / 1.5;
        assert!((change / own - 1.0).abs() < 0.03, "{change} {own}");
        assert!(plate_change.abs() < 0.03 * own, "{plate_change}");
    }
}

/// A ball on a rope at rest in water is let go at the rope's length with 1 m/s outwards: it bounces off, or
/// stops, and nothing makes it faster in the steps that follow, as a wrong guess of the rope's pull would.
#[test]
fn a_rope_stops_once() {
    let mut world = weightless();
    let mut immersion = Immersion::new(Fluid::WATER);
    let post = world.insert_body(RigidBodyBuilder::fixed());
    let (plate, _) = world.insert(
        RigidBodyBuilder::dynamic()
            .translation(Vector::Z * 0.9)
            .linvel(Vector::Z),
        ColliderBuilder::cuboid(0.1, 0.1, 0.0005).density(2700.0),
    );
    world.insert_impulse_joint(post, plate, RopeJointBuilder::new(1.0));
    immerse(&world, &mut immersion, plate, ViscousLaw::Inviscid);
    let mut stopped = None;
    for step in 0..60 {
        immersion.step(&mut world);
        let speed = world.bodies[plate].linvel().z;
        assert!(speed < 1.001, "{step}: {speed}");
        if stopped.is_none() && speed < 0.5 {
            stopped = Some(step);
        }
        if stopped.is_some_and(|s| step > s + 2) {
            assert!((-0.05..0.05).contains(&speed), "{step}: {speed}");
        }
    }
    assert!(stopped.is_some());
}
