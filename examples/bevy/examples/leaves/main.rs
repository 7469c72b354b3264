//! Four hundred leaves fall, every other one in air.
//!
//! `cargo run --release --example leaves` prints how, with `--features window` it shows them: F shows the forces, the space bar
//! switches the air off and on.

#[path = "../support/mod.rs"]
mod support;

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use bevy_rapier3d_immersed::prelude::*;

const HZ: f32 = 60.0;
/// Half extents, m, and density, kg/m³, of a leaf.
const LEAF: [f32; 3] = [0.0365, 0.00015, 0.021];
const DENSITY: f32 = 300.0;

/// Where a leaf was dropped.
#[derive(Component)]
struct Dropped(Vec3);

fn scene(app: &mut App) {
    let world = app.world_mut();
    world.spawn(support::floor(0.0));
    let [x, y, z] = LEAF;
    for i in 0..400u16 {
        let at = Vec3::new(
            0.2 * (f32::from(i / 20) - 9.5),
            2.0,
            0.2 * (f32::from(i % 20) - 9.5),
        );
        let tilt = Quat::from_rotation_x(0.1 + 0.003 * f32::from(i));
        let mut leaf = world.spawn((
            RigidBody::Dynamic,
            Collider::cuboid(x, y, z),
            ColliderMassProperties::Density(DENSITY),
            Transform::from_translation(at).with_rotation(tilt),
            Velocity::zero(),
            Dropped(at),
        ));
        if i % 2 == 0 {
            leaf.insert(Immersed::default());
        }
    }
}

/// Mean height and way aside, m, of the leaves in air or of the others.
#[cfg(not(feature = "window"))]
fn mean(app: &mut App, immersed: bool) -> [f32; 2] {
    let world = app.world_mut();
    let mut leaves = world.query::<(&Transform, &Dropped, Has<Immersed>)>();
    let leaves = leaves.iter(world).filter(|leaf| leaf.2 == immersed);
    let (mut height, mut aside, mut count) = (0.0, 0.0, 0.0);
    for (now, Dropped(from), _) in leaves {
        height += now.translation.y;
        aside += (now.translation - from).with_y(0.0).length();
        count += 1.0;
    }
    [height / count, aside / count]
}

#[cfg(not(feature = "window"))]
fn main() {
    let mut app = support::headless(HZ);
    scene(&mut app);
    for second in 0..=4 {
        for (immersed, name) in [(true, "immersed"), (false, "   plain")] {
            let [height, aside] = mean(&mut app, immersed);
            println!("after {second} s, {name}: {height:.2} m high, {aside:.3} m aside");
        }
        support::advance(&mut app, HZ, 1.0);
    }
}

#[cfg(feature = "window")]
fn main() {
    let (eye, target) = (Vec3::new(0.0, 1.5, 3.4), Vec3::new(0.0, 0.8, 0.0));
    support::open(HZ, eye, target, |app| {
        scene(app);
        app.add_systems(Update, (support::dress, pick_up));
    });
}

/// Leaves that have come down fall again.
#[cfg(feature = "window")]
fn pick_up(mut leaves: Query<(&mut Transform, &mut Velocity, &Dropped)>, time: Res<Time>) {
    if time.elapsed_secs() % 6.0 < time.delta_secs() {
        for (mut place, mut velocity, Dropped(from)) in &mut leaves {
            place.translation = *from;
            *velocity = Velocity::zero();
        }
    }
}

/// After a second plain leaves have fallen twice as far as those in air, and straight down.
#[cfg(all(test, not(feature = "window")))]
#[test]
fn leaves_fall_like_leaves() {
    let mut app = support::headless(HZ);
    scene(&mut app);
    // The first update has no time to step.
    app.update();
    support::advance(&mut app, HZ, 0.6);
    let [leaves, aside] = mean(&mut app, true);
    let [plain, straight] = mean(&mut app, false);
    assert!(
        2.0 - leaves < 0.7 * (2.0 - plain),
        "{leaves} m and {plain} m"
    );
    assert!(straight < 1e-3 && aside > 0.02, "{aside} m aside");
}
