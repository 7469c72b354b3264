//! Coulomb's friction under a fluid: no slide below μN, slide above.

use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion};

/// Plates and balls on the floor of the sea, a leaf on the ground: pulled by a share of
/// `μN = ½(m − ρV)g`, they stay or slide (by more than 5 mm in a second, where 1.3 μN alone would make
/// half a meter).
#[test]
fn pulled_bodies_slide_above_the_limit() {
    let plate = ColliderBuilder::cuboid(0.1, 0.0005, 0.1).density(2700.0);
    let leaf = ColliderBuilder::cuboid(0.0365, 0.000_15, 0.021).density(300.0);
    let ball = ColliderBuilder::ball(0.05).density(2700.0);
    for (fluid, name, collider, height) in [
        (Fluid::WATER, "plate", plate, 0.001),
        (Fluid::AIR, "leaf", leaf, 0.001),
        (Fluid::WATER, "ball", ball.clone(), 0.05),
        (Fluid::AIR, "ball", ball, 0.05),
    ] {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = 1.0 / 240.0;
        world.insert(
            RigidBodyBuilder::fixed().translation(Vector::Y * -0.5),
            ColliderBuilder::cuboid(50.0, 0.5, 50.0),
        );
        let mut body = RigidBodyBuilder::dynamic()
            .translation(Vector::Y * height)
            .can_sleep(false);
        if name == "ball" {
            body = body.lock_rotations();
        }
        let (handle, _) = world.insert(body, collider.friction(0.5));
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
        let mass = world.colliders[world.bodies[handle].colliders()[0]].mass();
        let limit = 0.5 * 9.81 * (mass - fluid.density() * hydro.volume as Real);
        let mut immersion = Immersion::new(fluid);
        immersion.insert(handle, hydro);
        for _ in 0..480 {
            immersion.step(&mut world);
        }
        for share in [0.0, 0.05, 0.2, 0.5, 0.8, 1.3, 2.0] {
            let body = &mut world.bodies[handle];
            body.reset_forces(true);
            body.set_linvel(Vector::ZERO, true);
            body.add_force(Vector::X * (share * limit), true);
            let from = body.translation().x;
            for _ in 0..240 {
                immersion.step(&mut world);
            }
            let slid = world.bodies[handle].translation().x - from;
            assert_eq!(slid > 5e-3, share > 1.0, "{name} {share}: {slid}");
        }
    }
}
