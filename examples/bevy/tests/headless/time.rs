//! All modes of time: each substep is one of the fluid's, to the bit.

use crate::support::*;
use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use bevy_rapier3d_immersed::prelude::*;

/// The leaf of an app after so many updates, and of its own world after the steps that these are made of.
fn compare(app: &mut App, leaf: Entity, own: &mut Own, steps: impl IntoIterator<Item = Vec<f32>>) {
    for (update, steps) in steps.into_iter().enumerate() {
        app.update();
        steps.into_iter().for_each(|dt| own.step(dt));
        assert_eq!(bits(body(app, leaf)), bits(own.body()), "update {update}");
    }
}

#[test]
fn substeps_are_steps() {
    let dt = STEP;
    let mut app = app(TimestepMode::Fixed { dt, substeps: 4 });
    let leaf = spawn(&mut app, (leaf(place()), Immersed::default()));
    let mut own = Own::new(place(), Fluid::AIR);
    compare(&mut app, leaf, &mut own, vec![vec![dt / 4.0; 4]; 120]);
    // Between updates the context reads what bevy_rapier says it does.
    let context = context_of(&app, leaf);
    let simulation = app.world().get::<RapierContextSimulation>(context).unwrap();
    assert_eq!(simulation.integration_parameters.dt, dt);
    let mode = app.world().resource::<TimestepMode>();
    assert_eq!(*mode, TimestepMode::Fixed { dt, substeps: 4 });
    assert!((immersion(&app, leaf).time() - 2.0).abs() < 1e-6);
}

#[test]
fn a_variable_step_is_as_long_as_the_frame() {
    let (max_dt, time_scale) = (1.0 / 50.0, 0.5);
    let mode = TimestepMode::Variable {
        max_dt,
        time_scale,
        substeps: 2,
    };
    let mut app = app(mode);
    let leaf = spawn(&mut app, (leaf(place()), Immersed::default()));
    let mut own = Own::new(place(), Fluid::AIR);
    // The first update has no time.
    app.update();
    for frame in 0..120u8 {
        // From 8 to 58 ms: some are cut.
        let seconds = 0.008 + 0.002 * f32::from(frame % 26);
        frame_time(&mut app, seconds);
        app.update();
        let dt = (app.world().resource::<Time>().delta_secs() * time_scale).min(max_dt) / 2.0;
        own.step(dt);
        own.step(dt);
        assert_eq!(bits(body(&app, leaf)), bits(own.body()), "frame {frame}");
    }
    let time = own.immersion.time();
    assert!((immersion(&app, leaf).time() - time).abs() < 1e-9);
}

/// Frames that are shorter and longer than a step: bevy_rapier's account of the time, and its interpolation.
#[test]
fn interpolated_steps_are_of_one_length() {
    let (dt, time_scale) = (STEP, 0.5);
    let mode = TimestepMode::Interpolated {
        dt,
        time_scale,
        substeps: 2,
    };
    let mut app = app(mode);
    let bundle = (
        leaf(place()),
        Immersed::default(),
        TransformInterpolation::default(),
    );
    let leaf = spawn(&mut app, bundle);
    let mut own = Own::new(place(), Fluid::AIR);
    let (mut account, mut steps, mut between) = (0.0, 0, 0);
    for frame in 0..200u8 {
        // From 4 to 40 ms: none, one or three steps.
        frame_time(&mut app, 0.004 + 0.012 * f32::from(frame % 4));
        app.update();
        account += app.world().resource::<Time>().delta_secs();
        let mut before = own.body().position().translation;
        while account > 0.0 {
            before = own.body().position().translation;
            own.step(dt / 2.0 * time_scale);
            own.step(dt / 2.0 * time_scale);
            account -= dt;
            steps += 1;
        }
        assert_eq!(bits(body(&app, leaf)), bits(own.body()), "frame {frame}");
        let after = own.body().position().translation;
        let shown = app.world().get::<Transform>(leaf).unwrap().translation;
        if before != after {
            let share = (dt + account) / dt;
            assert!(
                (shown - before.lerp(after, share)).length() < 1e-5,
                "frame {frame}"
            );
            between += usize::from(share > 0.2 && share < 0.8);
        }
    }
    assert!(
        steps > 150 && between > 20,
        "{steps} steps, {between} between"
    );
}

/// Contexts that began at different times step when it is their time, and no more often.
#[test]
fn interpolated_contexts_keep_accounts_of_their_own() {
    let mode = TimestepMode::Interpolated {
        dt: STEP,
        time_scale: 1.0,
        substeps: 1,
    };
    let mut app = app(mode);
    // The first update has no time.
    app.update();
    frame_time(&mut app, 0.7 * STEP);
    let first = spawn(&mut app, (leaf(place()), Immersed::default()));
    let mut own = [Own::new(place(), Fluid::AIR), Own::new(place(), Fluid::AIR)];
    let mut accounts = [0.0; 2];
    let mut second = None;
    let mut alone = 0;
    for frame in 0..60 {
        if frame == 3 {
            let context = spawn(&mut app, RapierContextSimulation::default());
            let link = RapierContextEntityLink(context);
            second = Some(spawn(&mut app, (leaf(place()), Immersed::default(), link)));
        }
        app.update();
        let delta = app.world().resource::<Time>().delta_secs();
        let leaves = [Some(first), second];
        let mut steps = [0; 2];
        for (index, leaf) in leaves.into_iter().enumerate() {
            let Some(leaf) = leaf else { continue };
            accounts[index] += delta;
            while accounts[index] > 0.0 {
                own[index].step(STEP);
                accounts[index] -= STEP;
                steps[index] += 1;
            }
            assert_eq!(
                bits(body(&app, leaf)),
                bits(own[index].body()),
                "frame {frame}"
            );
        }
        alone += usize::from(steps[0] != steps[1]);
    }
    assert!(alone > 10, "they always stepped together");
}

/// A disc sinks through water at the same speed in all modes, within 1 %.
#[test]
fn the_fall_is_the_same_in_all_modes() {
    let fall = |mode| {
        let mut app = app(mode);
        app.insert_resource(Medium::from(Fluid::WATER));
        let ball = (
            RigidBody::Dynamic,
            Collider::ball(0.05),
            Transform::default(),
            ColliderMassProperties::Density(2000.0),
            Immersed::default(),
        );
        let ball = spawn(&mut app, ball);
        update(&mut app, 121);
        let fallen = -body(&app, ball).translation().y;
        fallen / immersion(&app, ball).time() as f32
    };
    let (dt, time_scale) = (STEP, 1.0);
    let fixed = fall(FIXED);
    assert!(fixed > 0.5, "{fixed} m/s");
    for substeps in [1, 3] {
        for mode in [
            TimestepMode::Fixed { dt, substeps },
            TimestepMode::Variable {
                max_dt: dt,
                time_scale,
                substeps,
            },
            TimestepMode::Interpolated {
                dt,
                time_scale,
                substeps,
            },
        ] {
            let speed = fall(mode);
            println!("{mode:?}: {speed} m/s");
            assert!(
                (speed / fixed - 1.0).abs() < 0.01,
                "{mode:?}: {speed} and {fixed} m/s"
            );
        }
    }
}

/// Nothing steps while the pipeline is off, and a body may enter meanwhile.
#[test]
fn a_context_that_is_off_stands_still() {
    let mut app = app(FIXED);
    app.update();
    let configuration = |app: &mut App, active| {
        let mut contexts = app.world_mut().query::<&mut RapierConfiguration>();
        let mut context = contexts.single_mut(app.world_mut()).unwrap();
        context.physics_pipeline_active = active;
    };
    configuration(&mut app, false);
    let leaf = spawn(&mut app, (leaf(place()), Immersed::default()));
    update(&mut app, 10);
    assert_eq!(body(&app, leaf).translation().y, 2.0);
    assert_eq!(immersion(&app, leaf).time(), 0.0);
    configuration(&mut app, true);
    let mut own = Own::new(place(), Fluid::AIR);
    compare(&mut app, leaf, &mut own, vec![vec![STEP]; 30]);
}

/// Where only collisions are looked for no fluid acts, and its time stands still.
#[test]
fn a_context_of_collisions_only_has_no_fluid() {
    let mut app = app(FIXED);
    app.update();
    let mut contexts = app.world_mut().query::<&mut RapierConfiguration>();
    let mut context = contexts.single_mut(app.world_mut()).unwrap();
    context.simulation_mode = SimulationMode::CollisionOnly;
    let leaf = spawn(&mut app, (leaf(place()), Immersed::default()));
    update(&mut app, 10);
    assert_eq!(body(&app, leaf).translation().y, 2.0);
    assert_eq!(body(&app, leaf).user_force(), Vec3::ZERO);
    assert_eq!(immersion(&app, leaf).time(), 0.0);
}
