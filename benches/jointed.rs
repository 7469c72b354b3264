//! Pairs of plates on joints, falling through water: time per step with and without the fluid.
//! `cargo bench --bench jointed`; with a number as argument, so many steps and nothing else, to count
//! instructions.

use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion};
use std::time::Instant;

const PAIRS: usize = 1000;

/// Two plates edge to edge on a hinge, many times, each pair at another attitude.
fn pairs() -> (PhysicsWorld, Immersion) {
    let mut world = PhysicsWorld::new();
    let half = Vector::new(0.1, 0.002, 0.05);
    let plate = ColliderBuilder::cuboid(half.x, half.y, half.z).density(2700.0);
    let mut handles = vec![];
    for i in 0..PAIRS {
        let x = i as Real;
        let attitude = Rotation::from_scaled_axis(Vector::new(x, 0.3 * x, 0.7));
        let at = Vector::new(x % 32.0, 0.0, (x / 32.0).floor());
        let ends = [-1.0, 1.0].map(|side| {
            let pose = Pose::from_parts(at + attitude * (Vector::X * half.x * side), attitude);
            let body = RigidBodyBuilder::dynamic().pose(pose);
            let collider = plate.clone().collision_groups(InteractionGroups::none());
            world.insert(body, collider).0
        });
        let hinge = RevoluteJointBuilder::new(Vector::Z)
            .local_anchor1(Vector::X * half.x)
            .local_anchor2(Vector::X * -half.x);
        world.insert_impulse_joint(ends[0], ends[1], hinge);
        handles.extend(ends);
    }
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handles[0]).unwrap();
    let mut immersion = Immersion::new(Fluid::WATER);
    immersion.insert_all(handles, hydro);
    (world, immersion)
}

fn main() {
    let steps = std::env::args().find_map(|arg| arg.parse().ok());
    let quick = std::env::args().any(|arg| arg == "--test");
    for fluid in [true, false] {
        let (mut world, mut immersion) = pairs();
        immersion.set_enabled(fluid);
        let count = steps.unwrap_or(if quick { 2 } else { 240 });
        let start = Instant::now();
        for _ in 0..count {
            immersion.step(&mut world);
        }
        let time = start.elapsed().as_secs_f64() / count as f64;
        println!(
            "{PAIRS} pairs of plates, fluid {fluid}: {:.2} ms/step",
            time * 1e3
        );
        if steps.is_some() {
            return;
        }
    }
}
