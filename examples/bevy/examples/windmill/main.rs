//! A windmill: three pitched blades on one hub, which a joint lets turn about the wind's axis.
//!
//! `cargo run --release --example windmill` prints how fast it turns as the wind rises, with `--features window` it shows it:
//! the arrow keys change the wind, F shows the forces.
//!
//! The blades are strips: what the fluid feels is given, not found from the colliders.

#[path = "../support/mod.rs"]
mod support;

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use bevy_rapier3d::rapier::prelude::SharedShape;
use bevy_rapier3d_immersed::immersed::rapier3d::na::{
    Isometry3, Translation3, UnitQuaternion, Vector3,
};
use bevy_rapier3d_immersed::immersed::{Error, Part};
use bevy_rapier3d_immersed::prelude::*;
use std::f64::consts::TAU;

const HZ: f32 = 240.0;
/// Half thickness, length and chord of a blade, and where its middle is, m; height of the hub, m.
const BLADE: [f32; 3] = [0.0008, 0.2, 0.03];
const MIDDLE: f64 = 0.25;
const HEIGHT: f32 = 0.6;

/// What turns.
#[derive(Component)]
struct Rotor;

/// Where blades are: of y along them, x the axis of the wind, pitched by so much, rad, out of the plane in which they turn.
fn places(pitch: f64) -> [Isometry3<f64>; 3] {
    [0.0, 1.0, 2.0].map(|third| {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), TAU * third / 3.0);
        let pitched = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), pitch);
        let middle = Translation3::from(turn * (Vector3::y() * MIDDLE));
        Isometry3::from_parts(middle, turn * pitched)
    })
}

fn transform(place: &Isometry3<f64>) -> Transform {
    let at = place.translation.vector.map(|x| x as f32);
    let q = place.rotation.coords.map(|x| x as f32);
    Transform::from_xyz(at.x, at.y, at.z).with_rotation(Quat::from_xyzw(q.x, q.y, q.z, q.w))
}

/// # Errors
/// Those of the description, which these sizes do not give.
fn scene(app: &mut App, pitch: f64) -> Result<Entity, Error> {
    let [thickness, length, chord] = BLADE;
    let blade = SharedShape::cuboid(thickness, length, chord);
    let mut parts = Vec::new();
    for place in places(pitch) {
        let strips = HydroProperties::strips_of_shape(blade.as_ref(), 6)?;
        parts.extend(strips.into_iter().map(|strip| Part::new(strip).at(place)));
    }
    let hydro = HydroProperties::from_shape(SharedShape::ball(0.04).as_ref())?;
    let body = ImmersedBody::new(hydro).with_parts(parts);
    app.insert_resource(Wind::uniform(Vec3::X * 6.0));
    let world = app.world_mut();
    world.spawn(support::floor(0.0));
    let hub = Transform::from_xyz(0.0, HEIGHT, 0.0);
    let tower = world.spawn((RigidBody::Fixed, hub)).id();
    let axle = RevoluteJointBuilder::new(Vec3::X);
    let rotor = world
        .spawn((
            RigidBody::Dynamic,
            Collider::ball(0.04),
            ColliderMassProperties::Density(1000.0),
            hub,
            Velocity::zero(),
            ImpulseJoint::new(tower, axle),
            Immersed::with_body(body),
            Rotor,
        ))
        .id();
    for place in places(pitch) {
        world.spawn((
            Collider::cuboid(thickness, length, chord),
            ColliderMassProperties::Density(300.0),
            transform(&place),
            ChildOf(rotor),
        ));
    }
    Ok(rotor)
}

/// Angular velocity about the wind, rad/s, after so many seconds of a wind, m/s.
#[cfg(not(feature = "window"))]
fn turns(app: &mut App, rotor: Entity, wind: f32, seconds: f32) -> f32 {
    app.insert_resource(Wind::uniform(Vec3::X * wind));
    support::advance(app, HZ, seconds);
    app.world()
        .get::<Velocity>(rotor)
        .map_or(0.0, |velocity| velocity.angular.x)
}

#[cfg(not(feature = "window"))]
fn main() -> Result<(), Error> {
    let mut app = support::headless(HZ);
    let rotor = scene(&mut app, 20f64.to_radians())?;
    for wind in [2.0, 4.0, 6.0, 8.0] {
        let speed = turns(&mut app, rotor, wind, 5.0);
        println!("a wind of {wind} m/s: {speed:.1} rad/s");
    }
    Ok(())
}

#[cfg(feature = "window")]
fn main() -> Result<(), Error> {
    let (eye, target) = (Vec3::new(-0.8, 0.9, 1.2), Vec3::Y * HEIGHT);
    let mut built = Ok(());
    support::open(HZ, eye, target, |app| {
        built = scene(app, 20f64.to_radians()).map(|_| ());
        app.add_systems(Update, (support::dress, blow));
    });
    built
}

#[cfg(feature = "window")]
fn blow(keys: Res<ButtonInput<KeyCode>>, mut wind: ResMut<Wind>) {
    for (key, change) in [(KeyCode::ArrowUp, 1.0), (KeyCode::ArrowDown, -1.0)] {
        if keys.just_pressed(key) {
            wind.velocity.x += change;
        }
    }
}

/// It turns the way its blades are pitched, faster in a stronger wind, and not without pitch.
#[cfg(all(test, not(feature = "window")))]
#[test]
fn a_windmill_turns() {
    let speed = |pitch: f64| {
        let mut app = support::headless(HZ);
        let rotor = scene(&mut app, pitch.to_radians()).unwrap();
        [4.0, 8.0].map(|wind| turns(&mut app, rotor, wind, 3.0))
    };
    let [slow, fast] = speed(20.0);
    assert!(
        slow.abs() > 3.0 && fast / slow > 1.3,
        "{slow} and {fast} rad/s"
    );
    let [other, _] = speed(-20.0);
    assert!(
        (other + slow).abs() < 0.02 * slow.abs(),
        "{other} and {slow} rad/s"
    );
    assert!(speed(0.0)[1].abs() < 0.1);
}
