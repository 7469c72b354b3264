//! What is not immersed moves as under bevy_rapier alone, to the bit.

use crate::support::*;
use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use bevy_rapier3d_immersed::prelude::*;

#[derive(Resource, Default)]
struct Seen(Vec<String>);

/// Entities have other numbers with more plugins: boxes are known by their names.
fn listen(mut events: MessageReader<CollisionEvent>, names: Query<&Name>, mut seen: ResMut<Seen>) {
    let name = |entity: &Entity| names.get(*entity).map_or("gone", Name::as_str);
    seen.0.extend(events.read().map(|event| match event {
        CollisionEvent::Started(a, b, flags) => format!("+ {} {} {flags:?}", name(a), name(b)),
        CollisionEvent::Stopped(a, b, flags) => format!("- {} {} {flags:?}", name(a), name(b)),
    }));
}

/// Boxes that fall on each other and a floor, one of them on a joint.
fn scene(app: &mut App) -> Vec<Entity> {
    app.init_resource::<Seen>().add_systems(Last, listen);
    let floor = Transform::from_xyz(0.0, -0.5, 0.0);
    let ground = Name::new("ground");
    spawn(app, (Collider::cuboid(50.0, 0.5, 50.0), floor, ground));
    let mut boxes = Vec::new();
    for i in 0..12u8 {
        let (row, turn) = (f32::from(i % 3), 0.3 * f32::from(i));
        let place = Transform::from_xyz(0.3 * row, 0.4 + 0.35 * f32::from(i / 3), 0.1 * row)
            .with_rotation(Quat::from_rotation_z(turn));
        let body = (
            RigidBody::Dynamic,
            Collider::cuboid(0.1, 0.15, 0.2),
            ActiveEvents::COLLISION_EVENTS,
            Name::new(format!("box {i}")),
            Velocity::linear(Vec3::new(0.2 * row, 0.0, 0.1)),
            place,
        );
        boxes.push(spawn(app, body));
    }
    let joint = SphericalJointBuilder::new().local_anchor1(Vec3::Y * 0.4);
    app.world_mut()
        .entity_mut(boxes[1])
        .insert(ImpulseJoint::new(boxes[0], joint));
    boxes
}

fn run(mut app: App) -> (Vec<Vec<u32>>, Vec<String>) {
    let boxes = scene(&mut app);
    for frame in 0..150u8 {
        frame_time(&mut app, 0.009 + 0.003 * f32::from(frame % 6));
        app.update();
        if frame == 90 {
            app.world_mut().despawn(boxes[5]);
        }
    }
    let left = boxes.iter().filter(|entity| **entity != boxes[5]);
    let bodies = left.map(|entity| bits(body(&app, *entity))).collect();
    (bodies, app.world().resource::<Seen>().0.clone())
}

fn modes() -> [TimestepMode; 5] {
    let (dt, time_scale) = (STEP, 0.9);
    [
        FIXED,
        TimestepMode::Fixed { dt, substeps: 3 },
        TimestepMode::Variable {
            max_dt: dt,
            time_scale,
            substeps: 2,
        },
        TimestepMode::Interpolated {
            dt,
            time_scale,
            substeps: 1,
        },
        TimestepMode::Interpolated {
            dt,
            time_scale,
            substeps: 2,
        },
    ]
}

#[test]
fn an_app_without_immersed_bodies_is_bevy_rapiers() {
    for mode in modes() {
        let plain = run(bare(mode));
        assert!(plain.1.len() > 10, "nothing touched");
        let with = run(app(mode));
        assert_eq!(plain.0, with.0, "{mode:?}");
        assert_eq!(plain.1, with.1, "{mode:?}");
    }
}

/// Wind is enough for the plugin to divide the updates by itself: the same bits and events all the same.
#[test]
fn the_division_of_updates_is_bevy_rapiers() {
    for mode in modes() {
        let mut windy = app(mode);
        windy.insert_resource(Wind::uniform(Vec3::X));
        assert_eq!(run(bare(mode)), run(windy), "{mode:?}");
    }
}
