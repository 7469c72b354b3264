//! Several rapier contexts: each has a fluid of its own.

use crate::support::*;
use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use bevy_rapier3d_immersed::immersed::flow::Uniform;
use bevy_rapier3d_immersed::immersed::free_surface::{Sea, Waves};
use bevy_rapier3d_immersed::prelude::*;

/// A second context, of water.
fn water(app: &mut App) -> Entity {
    let surroundings = ContextSurroundings {
        medium: Some(Fluid::WATER.into()),
        ..default()
    };
    spawn(app, (RapierContextSimulation::default(), surroundings))
}

/// A leaf in each falls as if alone.
#[test]
fn each_context_has_its_own_fluid() {
    let mut app = app(FIXED);
    let context = water(&mut app);
    let in_air = spawn(&mut app, (leaf(place()), Immersed::default()));
    let link = RapierContextEntityLink(context);
    let in_water = spawn(&mut app, (leaf(place()), Immersed::default(), link));
    let mut own = [
        Own::new(place(), Fluid::AIR),
        Own::new(place(), Fluid::WATER),
    ];
    for _ in 0..90 {
        app.update();
        own.iter_mut().for_each(|own| own.step(STEP));
        assert_eq!(bits(body(&app, in_air)), bits(own[0].body()));
        assert_eq!(bits(body(&app, in_water)), bits(own[1].body()));
    }
    let apart = own[0].body().translation() - own[1].body().translation();
    assert!(apart.y.abs() > 0.5, "the fluids are no different");
}

/// A body that moves to another context is in that one's fluid, and in no other.
#[test]
fn bodies_change_contexts() {
    let mut app = app(FIXED);
    let context = water(&mut app);
    let leaf = spawn(&mut app, (leaf(place()), Immersed::default()));
    update(&mut app, 10);
    let air = context_of(&app, leaf);
    app.world_mut()
        .entity_mut(leaf)
        .insert(RapierContextEntityLink(context));
    update(&mut app, 3);
    let count = |app: &App, context| {
        let immersion = app.world().get::<RapierContextImmersion>(context).unwrap();
        let set = app.world().get::<RapierRigidBodySet>(context).unwrap();
        immersion.len_in(&set.bodies)
    };
    assert_eq!([count(&app, air), count(&app, context)], [0, 1]);
    update(&mut app, 60);
    // It weighs less than the water that it displaces.
    assert!(body(&app, leaf).linvel().y > 0.0);
}

/// A context that goes with its bodies leaves the others alone.
#[test]
fn a_context_may_go() {
    let mut app = app(FIXED);
    let context = water(&mut app);
    let stays = spawn(&mut app, (leaf(place()), Immersed::default()));
    let link = RapierContextEntityLink(context);
    let goes = spawn(&mut app, (leaf(place()), Immersed::default(), link));
    let mut own = Own::new(place(), Fluid::AIR);
    for step in 0..60 {
        if step == 20 {
            app.world_mut().despawn(context);
            app.world_mut().despawn(goes);
        }
        app.update();
        own.step(STEP);
    }
    assert_eq!(bits(body(&app, stays)), bits(own.body()));
}

/// The resources are those of every context that has none of its own; what is set by hand stays.
#[test]
fn surroundings_are_told_when_they_change() {
    let mut app = app(FIXED);
    let context = water(&mut app);
    app.update();
    let mut contexts = app
        .world_mut()
        .query_filtered::<Entity, With<DefaultRapierContext>>();
    let air = contexts.single(app.world()).unwrap();
    let look = |app: &App, context| {
        let immersion = app.world().get::<RapierContextImmersion>(context).unwrap();
        let upper = &immersion.medium().layers()[0];
        let wind = upper
            .flow
            .as_ref()
            .map(|flow| flow.velocity(Vec3::ZERO, 0.0));
        let wind = wind.filter(|wind| *wind != Vec3::ZERO);
        (upper.fluid.density(), wind, upper.turbulence.is_some())
    };
    assert_eq!(look(&app, air), (1.184, None, false));
    assert_eq!(look(&app, context), (997.0, None, false));

    app.insert_resource(Wind::uniform(Vec3::X));
    app.insert_resource(Turbulence {
        kinetic_energy: 0.1,
        dissipation: 0.1,
        ..default()
    });
    app.update();
    assert_eq!(look(&app, air), (1.184, Some(Vec3::X), true));
    assert_eq!(look(&app, context), (997.0, Some(Vec3::X), true));

    // A medium takes the wind over, and the context's own goes before the resource's.
    let mut own = ContextSurroundings {
        medium: Some(Fluid::WATER.into()),
        wind: Some(Wind::field(Uniform::new(0.0, 0.0, 2.0))),
        turbulence: Some(Turbulence::default()),
    };
    app.world_mut().entity_mut(context).insert(own.clone());
    app.insert_resource(Medium::from(Fluid::new(2.0, 1e-5).unwrap()));
    app.update();
    assert_eq!(look(&app, air), (2.0, Some(Vec3::X), true));
    assert_eq!(look(&app, context), (997.0, Some(Vec3::Z * 2.0), false));

    // By hand, until the next change.
    let mut entity = app.world_mut().entity_mut(context);
    let mut immersion = entity.get_mut::<RapierContextImmersion>().unwrap();
    immersion.set_flow(Uniform::new(0.0, 3.0, 0.0));
    update(&mut app, 5);
    assert_eq!(look(&app, context).1, Some(Vec3::Y * 3.0));
    own.wind = Some(Wind::default());
    app.world_mut().entity_mut(context).insert(own);
    update(&mut app, 1);
    assert_eq!(look(&app, context).1, None);

    // What cannot be is not taken.
    let mut bad = Medium::default();
    bad.layers[0].density = -1.0;
    app.insert_resource(bad);
    app.insert_resource(Wind::default());
    app.insert_resource(Turbulence::default());
    update(&mut app, 1);
    assert_eq!(look(&app, air), (2.0, None, false));
}

/// Layers with a current under a free surface: what floats drifts with the water, not with the wind's layer.
#[test]
fn bodies_float_on_layers() {
    let mut app = app(FIXED);
    let mut lake = Medium::layered([Fluid::AIR, Fluid::WATER]);
    lake.layers[1].current = Vec3::X * 0.5;
    lake.level = Vec3::Y * 0.3;
    app.insert_resource(lake);
    let raft = (
        RigidBody::Dynamic,
        Collider::cuboid(0.3, 0.1, 0.3),
        Transform::from_xyz(0.0, 0.5, 0.0),
        ColliderMassProperties::Density(600.0),
        Immersed::default(),
    );
    let raft = spawn(&mut app, raft);
    update(&mut app, 1200);
    let body = body(&app, raft);
    let draft = 0.3 + 0.1 - body.translation().y;
    assert!((draft - 0.2 * 600.0 / 997.0).abs() < 3e-3, "{draft} m");
    // Water alone would take it along altogether; what is out of it stands in the air.
    let speed = body.linvel().x;
    assert!((0.35..0.5).contains(&speed), "{speed} m/s");
}

/// Waves go on although nobody is in them, so that who comes later meets them where they are.
#[test]
fn time_goes_on_for_what_moves() {
    let time = |medium: Medium, wind: Wind| {
        let mut app = app(FIXED);
        app.insert_resource(medium).insert_resource(wind);
        update(&mut app, 30);
        let mut contexts = app.world_mut().query::<&RapierContextImmersion>();
        contexts.single(app.world()).unwrap().time()
    };
    let lake = Medium::layered([Fluid::AIR, Fluid::WATER]);
    let sea = lake
        .clone()
        .with_surface(Waves::sea(&Sea::default()).unwrap());
    assert!((time(sea, Wind::default()) - 0.5).abs() < 1e-6);
    assert!((time(lake.clone(), Wind::uniform(Vec3::X)) - 0.5).abs() < 1e-6);
    assert_eq!(time(lake, Wind::default()), 0.0);
}
