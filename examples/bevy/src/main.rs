//! Leaves in a bevy app, without a window: `cargo run --release` prints how they fall, `cargo test` compares
//! one of them with a rapier world of its own. With bevy's default features and a camera they can be seen.

mod immersed;

use bevy::prelude::*;
use bevy::time::TimeUpdateStrategy;
use bevy_rapier3d::prelude::*;
use immersed::{Immersed, ImmersionPlugin};
use rapier3d_immersed::Fluid;
use std::time::Duration;

const STEP: f32 = 1.0 / 60.0;
/// Half extents, m, and density, kg/m³, of a leaf.
const LEAF: [f32; 3] = [0.0365, 0.00015, 0.021];
const DENSITY: f32 = 300.0;

/// Where a leaf was dropped.
#[derive(Component)]
struct Dropped(Vec3);

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin))
        .add_plugins(RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule())
        .add_plugins(ImmersionPlugin {
            fluid: Fluid::AIR,
            schedule: FixedUpdate,
        })
        .insert_resource(TimestepMode::Fixed {
            dt: STEP,
            substeps: 1,
        })
        .insert_resource(Time::<Fixed>::from_seconds(STEP.into()))
        // One step per update, however fast the machine is.
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(
            STEP,
        )));
    app
}

fn leaf(at: Vec3, tilt: f32) -> impl Bundle {
    let [x, y, z] = LEAF;
    (
        Dropped(at),
        RigidBody::Dynamic,
        Collider::cuboid(x, y, z),
        ColliderMassProperties::Density(DENSITY),
        Transform::from_translation(at).with_rotation(Quat::from_rotation_x(tilt)),
    )
}

fn main() {
    let mut app = app();
    let ground = Transform::from_xyz(0.0, -0.5, 0.0);
    app.world_mut()
        .spawn((Collider::cuboid(50.0, 0.5, 50.0), ground));
    for i in 0..400 {
        let at = Vec3::new((i / 20) as f32 - 9.5, 2.0, (i % 20) as f32 - 9.5);
        let tilt = 0.1 + 0.003 * i as f32;
        let mut entity = app.world_mut().spawn(leaf(at, tilt));
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
    use rapier3d_immersed::rapier3d::prelude as rapier;
    use rapier3d_immersed::{HydroProperties, Immersion};

    /// A leaf falls as it does in a rapier world of its own.
    #[test]
    fn bevy_changes_nothing() {
        let at = Vec3::new(0.3, 2.0, -0.2);
        let mut app = app();
        let entity = app.world_mut().spawn((leaf(at, 0.3), Immersed)).id();

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
