//! A leaf falls as it does without bevy, and what is asked about it is right.

use crate::support::*;
use bevy::ecs::system::RunSystemOnce;
use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use bevy_rapier3d::rapier::prelude as rapier;
use bevy_rapier3d_immersed::immersed::flow::{Layers, Shear, Uniform};
use bevy_rapier3d_immersed::immersed::turbulence::{self, TurbulenceState, TurbulentLayer};
use bevy_rapier3d_immersed::prelude::*;

/// Three seconds, through the air and onto a floor, to the bit.
#[test]
fn bevy_changes_nothing() {
    let mut app = app(FIXED);
    let leaf = spawn(&mut app, (leaf(place()), Immersed::default()));
    let floor = Transform::from_xyz(0.0, -0.5, 0.0);
    spawn(&mut app, (Collider::cuboid(50.0, 0.5, 50.0), floor));
    let ground = rapier::ColliderBuilder::cuboid(50.0, 0.5, 50.0)
        .translation(rapier::Vector::new(0.0, -0.5, 0.0));
    // Bevy_rapier inserts it first: the order of colliders is part of the result.
    let mut own = Own::over(Some(ground), place(), Fluid::AIR);
    let mut touched = false;
    for step in 0..180 {
        app.update();
        own.step(STEP);
        assert_eq!(bits(body(&app, leaf)), bits(own.body()), "step {step}");
        touched |= own.body().translation().y < 0.03;
    }
    assert!(touched, "it never came down");
    let shown = app.world().get::<Transform>(leaf).unwrap().translation;
    assert!((shown - own.body().translation()).length() < 1e-6);
}

/// In wind and turbulence, too, whose noise is of the seed.
#[test]
fn wind_and_turbulence_are_the_immersions() {
    let turbulence = Turbulence {
        kinetic_energy: 0.2,
        dissipation: 0.3,
        seed: 5,
        ..default()
    };
    let shear = Shear {
        across: Vec3::Y,
        rate: Vec3::Z,
        ..default()
    };
    let mut app = app(FIXED);
    let mut wind = Wind::field(shear);
    wind.velocity = Vec3::X;
    app.insert_resource(turbulence).insert_resource(wind);
    let leaf = spawn(&mut app, (leaf(place()), Immersed::default()));
    let mut own = Own::new(place(), Fluid::AIR);
    let breeze = Uniform::new(1.0, 0.0, 0.0);
    own.immersion
        .set_flow(Layers::new().with(breeze).with(shear));
    let state = TurbulenceState {
        kinetic_energy: 0.2,
        dissipation: 0.3,
    };
    own.immersion.set_turbulence(TurbulentLayer {
        seed: 5,
        ..turbulence::Turbulence::Homogeneous(state).into()
    });
    for step in 0..90 {
        app.update();
        own.step(STEP);
        assert_eq!(bits(body(&app, leaf)), bits(own.body()), "step {step}");
    }
    assert!(own.body().translation().z > 0.2, "no wind");
}

/// The schedule is found, whichever it is.
#[test]
fn the_fixed_schedule_is_as_good() {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin))
        .add_plugins(RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule())
        .add_plugins(ImmersedPlugin::<NoUserData>::default())
        .insert_resource(FIXED)
        .insert_resource(Time::<Fixed>::from_seconds(STEP.into()));
    frame_time(&mut app, STEP);
    let leaf = spawn(&mut app, (leaf(place()), Immersed::default()));
    let mut own = Own::new(place(), Fluid::AIR);
    // The first update has no time to step.
    app.update();
    for _ in 0..60 {
        app.update();
        own.step(STEP);
    }
    assert_eq!(bits(body(&app, leaf)), bits(own.body()));
}

/// Whoever forgets bevy_rapier's plugin is told.
#[test]
#[should_panic(expected = "ImmersedPlugin goes after RapierPhysicsPlugin")]
fn the_plugin_needs_rapiers() {
    App::new()
        .add_plugins((MinimalPlugins, TransformPlugin))
        .add_plugins(ImmersedPlugin::<NoUserData>::default());
}

/// Systems set up by hand step once, and to the same bits.
#[test]
fn systems_may_be_set_up_by_hand() {
    type Rapier = RapierPhysicsPlugin<NoUserData>;
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin))
        .add_plugins(Rapier::default().with_default_system_setup(false))
        .add_plugins(ImmersedPlugin::<NoUserData>::default().with_default_system_setup(false))
        .insert_resource(FIXED);
    frame_time(&mut app, STEP);
    let sets = (
        PhysicsSet::SyncBackend,
        PhysicsSet::StepSimulation,
        PhysicsSet::Writeback,
    );
    app.configure_sets(Update, sets.chain())
        .add_systems(Update, Rapier::get_systems(PhysicsSet::SyncBackend))
        .add_systems(Update, ImmersedPlugin::<NoUserData>::get_systems())
        .add_systems(Update, Rapier::get_systems(PhysicsSet::Writeback));
    let leaf = spawn(&mut app, (leaf(place()), Immersed::default()));
    let mut own = Own::new(place(), Fluid::AIR);
    for _ in 0..60 {
        app.update();
        own.step(STEP);
    }
    assert_eq!(bits(body(&app, leaf)), bits(own.body()));
}

/// A cube of 0.2 m displaces 8 l of water; the component shows what the immersion says.
#[test]
fn forces_are_written_where_they_are_asked_for() {
    let mut app = app(FIXED);
    app.insert_resource(Medium::from(Fluid::WATER));
    let cube = (
        RigidBody::Dynamic,
        Collider::cuboid(0.1, 0.1, 0.1),
        Transform::default(),
        ColliderMassProperties::Density(1200.0),
        Immersed::default(),
        FluidForces::default(),
    );
    let cube = spawn(&mut app, cube);
    update(&mut app, 30);
    let forces = *app.world().get::<FluidForces>(cube).unwrap();
    let buoyancy = 997.0 * 0.008 * 9.81;
    assert!((forces.buoyancy.force.y - buoyancy).abs() < 1e-3 * buoyancy);
    assert!(forces.drag.force.y > 0.0, "it sinks");
    let handle = handle(&app, cube);
    let set = app
        .world()
        .get::<RapierRigidBodySet>(context_of(&app, cube));
    let told = immersion(&app, cube).forces(&set.unwrap().bodies, handle);
    assert_eq!(*forces, told.unwrap());
    app.world_mut().entity_mut(cube).remove::<Immersed>();
    update(&mut app, 1);
    let forces = *app.world().get::<FluidForces>(cube).unwrap();
    assert_eq!(forces, FluidForces::default(), "out of the fluid");
}

/// A push through the immersion moves the water along: a ball as heavy as water gets two thirds of J/m.
#[test]
fn pushes_move_the_fluid_along() {
    let mut app = app(FIXED);
    app.insert_resource(Medium::from(Fluid::WATER));
    let ball = (
        RigidBody::Dynamic,
        Collider::ball(0.1),
        Transform::default(),
        ColliderMassProperties::Density(997.0),
        Immersed::default(),
    );
    let ball = spawn(&mut app, ball);
    update(&mut app, 1);
    let mass = 997.0 * 4.0 / 3.0 * std::f32::consts::PI * 0.001;
    let before = body(&app, ball).linvel();
    let push = move |mut immersions: WriteImmersion| {
        let ball = immersions.get(ball).unwrap();
        ball.immersion
            .apply_impulse(ball.bodies, ball.handle, Vec3::X * mass);
    };
    app.world_mut().run_system_once(push).unwrap();
    let change = body(&app, ball).linvel() - before;
    assert!((change.x - 2.0 / 3.0).abs() < 2e-3, "{change}");
}

/// Hooks reach rapier in every substep: one that refuses all contacts lets the leaf through the floor.
#[test]
fn hooks_are_bevy_rapiers() {
    #[derive(bevy::ecs::system::SystemParam)]
    struct NoContacts;
    impl BevyPhysicsHooks for NoContacts {
        fn filter_contact_pair(&self, _: PairFilterContextView) -> Option<rapier::SolverFlags> {
            None
        }
    }
    let mode = TimestepMode::Fixed {
        dt: STEP,
        substeps: 2,
    };
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin))
        .add_plugins(RapierPhysicsPlugin::<NoContacts>::default())
        .add_plugins(ImmersedPlugin::<NoContacts>::default())
        .insert_resource(mode);
    frame_time(&mut app, STEP);
    let hooked = (Immersed::default(), ActiveHooks::FILTER_CONTACT_PAIRS);
    let through = spawn(&mut app, (leaf(place()), hooked));
    let aside = place().with_translation(Vec3::new(2.0, 2.0, 0.0));
    let held = spawn(&mut app, (leaf(aside), Immersed::default()));
    let floor = Transform::from_xyz(0.0, 0.5, 0.0);
    spawn(&mut app, (Collider::cuboid(50.0, 0.5, 50.0), floor));
    update(&mut app, 240);
    assert!(body(&app, through).translation().y < 0.5);
    assert!(body(&app, held).translation().y > 0.9);
}
