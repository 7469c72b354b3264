//! Bodies that leave the fluid, or the world.

use crate::support::*;
use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use bevy_rapier3d_immersed::prelude::*;

/// Without the component the body is rapier's own: its mass, and its acceleration.
#[test]
fn without_the_component_it_is_rapiers_own() {
    let mut app = app(FIXED);
    let leaf = spawn(&mut app, (leaf(place()), Immersed::default()));
    update(&mut app, 60);
    let volume: f32 = 8.0 * LEAF.iter().product::<f32>();
    app.world_mut().entity_mut(leaf).remove::<Immersed>();
    assert!(immersion(&app, leaf).is_empty(), "at once");
    let before = body(&app, leaf).linvel();
    update(&mut app, 1);
    let now = body(&app, leaf);
    let fallen = now.linvel() - before;
    assert!(
        (fallen - Vec3::Y * (-9.81 * STEP)).length() < 1e-5,
        "{fallen}"
    );
    assert!((now.mass() / (DENSITY * volume) - 1.0).abs() < 1e-5);
    // And back into the fluid, where it is slowed down.
    update(&mut app, 30);
    let speed = body(&app, leaf).linvel().length();
    app.world_mut().entity_mut(leaf).insert(Immersed::default());
    update(&mut app, 60);
    assert!(body(&app, leaf).linvel().length() < 0.5 * speed);
}

/// An entity that goes leaves nothing behind, and others alone; its handle may be another's.
#[test]
fn an_entity_may_go() {
    let mut app = app(FIXED);
    let aside = place().with_translation(Vec3::new(5.0, 2.0, 0.0));
    let goes = spawn(&mut app, (leaf(aside), Immersed::default()));
    let stays = spawn(&mut app, (leaf(place()), Immersed::default()));
    update(&mut app, 20);
    app.world_mut().despawn(goes);
    update(&mut app, 1);
    assert_eq!(immersion(&app, stays).len(), 1);
    let next = spawn(&mut app, leaf(aside));
    update(&mut app, 30);
    let fallen = body(&app, next).linvel().y + 30.0 * 9.81 * STEP;
    assert!(fallen.abs() < 1e-3, "who takes the place is not immersed");
    assert!(body(&app, stays).linvel().length() < 3.0);
}

/// Without its collider, or without rapier's body, it is not in the fluid; with them it is again.
#[test]
fn collider_and_body_may_go_and_come() {
    let mut app = app(FIXED);
    let body = spawn(&mut app, (RigidBody::Dynamic, place(), Immersed::default()));
    let [x, y, z] = LEAF;
    let collider = |app: &mut App| {
        let mass = ColliderMassProperties::Density(DENSITY);
        spawn(
            app,
            (
                Collider::cuboid(x, y, z),
                mass,
                Transform::default(),
                ChildOf(body),
            ),
        )
    };
    let in_fluid = |app: &App| {
        let set = app.world().get::<RapierRigidBodySet>(context_of(app, body));
        let forces = immersion(app, body).forces(&set.unwrap().bodies, handle(app, body));
        forces.is_some()
    };
    // A body may be there before its colliders.
    update(&mut app, 3);
    assert!(!in_fluid(&app));
    let first = collider(&mut app);
    update(&mut app, 2);
    assert!(in_fluid(&app));
    app.world_mut().despawn(first);
    update(&mut app, 3);
    assert!(!in_fluid(&app));
    let second = collider(&mut app);
    update(&mut app, 3);
    assert!(in_fluid(&app));
    app.world_mut().entity_mut(body).remove::<RigidBody>();
    update(&mut app, 2);
    assert!(app.world().get::<RapierRigidBodyHandle>(body).is_none());
    app.world_mut().entity_mut(body).insert(RigidBody::Dynamic);
    // Bevy_rapier gives a new body none of its children's old colliders.
    app.world_mut().despawn(second);
    collider(&mut app);
    update(&mut app, 3);
    assert!(in_fluid(&app));
}

/// A body that is disabled, or not dynamic, waits.
#[test]
fn bodies_wait() {
    let mut app = app(FIXED);
    let fixed = spawn(&mut app, (leaf(place()), Immersed::default()));
    app.world_mut().entity_mut(fixed).insert(RigidBody::Fixed);
    update(&mut app, 10);
    assert_eq!(body(&app, fixed).translation().y, 2.0);
    app.world_mut().entity_mut(fixed).insert(RigidBody::Dynamic);
    update(&mut app, 90);
    let speed = body(&app, fixed).linvel().length();
    assert!(speed > 0.2 && speed < 4.0, "{speed} m/s");
}
