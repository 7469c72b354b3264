//! Leaves in a bevy app. `cargo run --release` prints how they fall, `cargo run --release --features window`
//! shows them, `cargo test` compares one of them with a rapier world of its own.

#[cfg(any(test, not(feature = "window")))]
mod headless;
mod immersed;
#[cfg(feature = "window")]
mod window;

use bevy::app::Plugins;
use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use immersed::ImmersionPlugin;
use rapier3d_immersed::Fluid;

const STEP: f32 = 1.0 / 60.0;
/// Half extents, m, and density, kg/m³, of a leaf.
const LEAF: [f32; 3] = [0.0365, 0.00015, 0.021];
const DENSITY: f32 = 300.0;

/// An app with rapier, air and a floor.
fn app<M>(plugins: impl Plugins<M>) -> App {
    let mut app = App::new();
    app.add_plugins(plugins)
        .add_plugins(RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule())
        .add_plugins(ImmersionPlugin {
            fluid: Fluid::AIR,
            schedule: FixedUpdate,
        })
        .insert_resource(TimestepMode::Fixed {
            dt: STEP,
            substeps: 1,
        })
        .insert_resource(Time::<Fixed>::from_seconds(STEP.into()));
    let floor = Transform::from_xyz(0.0, -0.5, 0.0);
    app.world_mut()
        .spawn((Collider::cuboid(50.0, 0.5, 50.0), floor));
    app
}

fn leaf(at: Vec3, rotation: Quat) -> impl Bundle {
    let [x, y, z] = LEAF;
    (
        RigidBody::Dynamic,
        Collider::cuboid(x, y, z),
        ColliderMassProperties::Density(DENSITY),
        Transform::from_translation(at).with_rotation(rotation),
    )
}

fn main() {
    #[cfg(feature = "window")]
    app(DefaultPlugins).add_plugins(window::WindowPlugin).run();
    #[cfg(not(feature = "window"))]
    headless::print_falls();
}
