//! The app without a window.

use crate::immersed::Immersed;
use crate::{STEP, app, leaf};
use bevy::prelude::*;
use bevy::time::TimeUpdateStrategy;
use std::time::Duration;

/// Where a leaf was dropped.
#[cfg(not(feature = "window"))]
#[derive(Component)]
struct Dropped(Vec3);

/// One step per update, however fast the machine is.
fn headless() -> App {
    let mut app = app((MinimalPlugins, TransformPlugin));
    let step = Duration::from_secs_f32(STEP);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(step));
    app
}

/// Four hundred leaves, every other one in air.
#[cfg(not(feature = "window"))]
pub fn print_falls() {
    let mut app = headless();
    for i in 0..400 {
        let at = Vec3::new((i / 20) as f32 - 9.5, 2.0, (i % 20) as f32 - 9.5);
        let tilt = Quat::from_rotation_x(0.1 + 0.003 * i as f32);
        let mut entity = app.world_mut().spawn((leaf(at, tilt), Dropped(at)));
        if i % 2 == 0 {
            entity.insert(Immersed);
        }
    }
    for second in 0..=4 {
        for fluid in [true, false] {
            let mut leaves = app
                .world_mut()
                .query::<(&Transform, &Dropped, Has<Immersed>)>();
            let (mut height, mut drift, mut count) = (0.0, 0.0, 0.0);
            for (now, Dropped(from), immersed) in leaves.iter(app.world()) {
                if immersed == fluid {
                    height += now.translation.y;
                    drift += (now.translation - from).with_y(0.0).length();
                    count += 1.0;
                }
            }
            println!(
                "after {second} s, {}: {:.2} m high, {:.3} m aside",
                if fluid { "immersed" } else { "   plain" },
                height / count,
                drift / count
            );
        }
        (0..60).for_each(|_| app.update());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DENSITY, LEAF};
    use rapier3d_immersed::rapier3d::prelude as rapier;
    use rapier3d_immersed::{Fluid, HydroProperties, Immersion};

    /// A leaf falls as it does in a rapier world of its own.
    #[test]
    fn bevy_changes_nothing() {
        let at = Vec3::new(0.3, 2.0, -0.2);
        let mut app = headless();
        let bundle = (leaf(at, Quat::from_rotation_x(0.3)), Immersed);
        let entity = app.world_mut().spawn(bundle).id();

        let [x, y, z] = LEAF;
        let mut world = rapier::PhysicsWorld::new();
        world.integration_parameters.dt = STEP;
        let body = rapier::RigidBodyBuilder::dynamic()
            .translation(rapier::Vector::new(at.x, at.y, at.z))
            .rotation(rapier::Vector::X * 0.3);
        let collider = rapier::ColliderBuilder::cuboid(x, y, z).density(DENSITY);
        let (handle, _) = world.insert(body, collider);
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.insert(handle, hydro);

        // The first update has no time to step.
        app.update();
        for step in 0..120 {
            app.update();
            immersion.step(&mut world);
            let bevy = app.world().get::<Transform>(entity).unwrap().translation;
            let own = world.bodies[handle].translation();
            let apart = (bevy - Vec3::new(own.x, own.y, own.z)).length();
            assert!(apart < 1e-4, "step {step}: {bevy} and {own}");
        }
    }
}
