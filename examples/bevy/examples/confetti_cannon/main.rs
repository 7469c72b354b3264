//! A blast of air blows confetti out of a cannon: paper alone would stop within half a meter. It flutters down for seconds.
//!
//! `cargo run --release --example confetti_cannon` prints where they are, with `--features window` it shows them, a shot every eight
//! seconds.

#[path = "../support/mod.rs"]
mod support;

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use bevy_rapier3d_immersed::immersed::flow::Flow;
use bevy_rapier3d_immersed::immersed::turbulence::NoiseStream;
use bevy_rapier3d_immersed::prelude::*;

const HZ: f32 = 120.0;
/// Half extents, m, and density, kg/m³, of a piece of paper of 80 g/m².
const PIECE: [f32; 3] = [0.012, 0.00005, 0.008];
const DENSITY: f32 = 800.0;
/// Pieces per shot, and where the muzzle is, m.
const PIECES: u64 = 300;
const MUZZLE: Vec3 = Vec3::new(0.0, 1.0, 0.0);

/// Where the cannon points.
fn along() -> Vec3 {
    Vec3::new(0.5, 1.0, 0.0).normalize()
}

#[derive(Component)]
struct Confetti;

/// The air of a shot: a jet from the muzzle that widens, and dies within a second.
struct Blast {
    /// When it began, s.
    start: f64,
}

impl Flow for Blast {
    fn velocity(&self, point: Vec3, time: f64) -> Vec3 {
        let from = point - MUZZLE;
        let ahead = from.dot(along());
        let age = (time - self.start) as f32;
        if ahead < -0.2 || age < 0.0 {
            return Vec3::ZERO;
        }
        let aside = (from - along() * ahead).length();
        // m, m/s: a jet keeps its momentum as it widens.
        let radius = 0.15 + 0.1 * ahead.max(0.0);
        let speed = 30.0 * 0.15 / radius * (-age / 0.3).exp();
        along() * speed * (-(aside / radius).powi(2)).exp()
    }
}

/// Somewhat turbulent air, and a floor.
fn scene(app: &mut App) {
    app.insert_resource(Turbulence {
        kinetic_energy: 0.05,
        dissipation: 0.05,
        ..default()
    });
    app.world_mut().spawn(support::floor(0.0));
}

/// A shot upwards and to the right.
fn shoot(mut commands: Commands, context: Single<&RapierContextImmersion>) {
    let start = context.time();
    commands.insert_resource(Wind::field(Blast { start }));
    let [x, y, z] = PIECE;
    let groups = CollisionGroups::new(Group::GROUP_2, Group::GROUP_1);
    for number in 0..PIECES {
        let noise = |draw| NoiseStream::new(7, number).vector(0, draw);
        let turn = noise(0);
        let place = Transform::from_translation(MUZZLE + noise(1) * 0.03)
            .with_rotation(Quat::from_scaled_axis(turn));
        let velocity = Velocity {
            linear: along() * 10.0 + noise(2),
            angular: noise(3) * 20.0,
        };
        commands.spawn((
            RigidBody::Dynamic,
            Collider::cuboid(x, y, z),
            ColliderMassProperties::Density(DENSITY),
            // Pieces pass each other: what flutters hardly touches.
            groups,
            place,
            velocity,
            Immersed::default(),
            Confetti,
        ));
    }
}

/// Their mean place, m, and speed, m/s, and the share that has come down.
#[cfg(not(feature = "window"))]
fn mean(app: &mut App) -> (Vec3, f32, f32) {
    let world = app.world_mut();
    let mut confetti = world.query_filtered::<(&Transform, &Velocity), With<Confetti>>();
    let (mut place, mut speed, mut down) = (Vec3::ZERO, 0.0, 0.0);
    for (at, velocity) in confetti.iter(world) {
        place += at.translation;
        speed += velocity.linear.length();
        down += f32::from(u8::from(at.translation.y < 0.02));
    }
    let count = PIECES as f32;
    (place / count, speed / count, down / count)
}

#[cfg(not(feature = "window"))]
fn loaded() -> App {
    let mut app = support::headless(HZ);
    scene(&mut app);
    app.add_systems(Startup, shoot);
    // The first update has no time to step.
    app.update();
    app
}

#[cfg(not(feature = "window"))]
fn main() {
    let mut app = loaded();
    for time in [0.1, 0.3, 0.6, 1.0, 2.0, 3.0, 4.0] {
        let now = (app.world().resource::<Time>().elapsed_secs() * HZ).round() / HZ;
        support::advance(&mut app, HZ, time - now);
        let (at, speed, down) = mean(&mut app);
        println!(
            "after {time:.1} s: {:.2} m high, {:.2} m away, {speed:.1} m/s, {:.0} % on the floor",
            at.y,
            at.x,
            100.0 * down
        );
    }
}

#[cfg(feature = "window")]
fn main() {
    let (eye, target) = (Vec3::new(0.8, 1.6, 5.0), Vec3::new(0.8, 1.6, 0.0));
    support::open(HZ, eye, target, |app| {
        scene(app);
        app.add_systems(Update, (support::dress, reload));
    });
}

/// Every eight seconds the old ones go and new ones come.
#[cfg(feature = "window")]
fn reload(mut commands: Commands, old: Query<Entity, With<Confetti>>, time: Res<Time>) {
    if old.is_empty() || time.elapsed_secs() % 8.0 < time.delta_secs() {
        for entity in &old {
            commands.entity(entity).despawn();
        }
        commands.run_system_cached(shoot);
    }
}

/// The blast carries them some meters up, and then they are slower than 2 m/s.
#[cfg(all(test, not(feature = "window")))]
#[test]
fn confetti_rise_and_flutter() {
    let mut app = loaded();
    support::advance(&mut app, HZ, 0.6);
    let (at, _, _) = mean(&mut app);
    assert!((2.0..6.0).contains(&at.y), "{} m high", at.y);
    support::advance(&mut app, HZ, 1.0);
    let (at, speed, down) = mean(&mut app);
    assert!(
        speed < 2.0 && down < 0.3 && at.y > 1.0,
        "{at}, {speed} m/s, {down} down"
    );
}
