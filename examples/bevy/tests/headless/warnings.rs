//! What users are told: once, in the log and as messages.

use crate::support::*;
use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use bevy_rapier3d_immersed::immersed::Warning;
use bevy_rapier3d_immersed::prelude::*;
use std::cell::Cell;

thread_local! {
    /// Lines about bodies that are not immersed, of the test on this thread: without bevy's `multi_threaded` systems run there.
    static LINES: Cell<usize> = const { Cell::new(0) };
}

struct Count;

impl log::Log for Count {
    fn enabled(&self, _: &log::Metadata) -> bool {
        true
    }

    fn log(&self, record: &log::Record) {
        if record.args().to_string().contains("is not immersed") {
            LINES.set(LINES.get() + 1);
        }
    }

    fn flush(&self) {}
}

#[derive(Resource, Default)]
struct Told(Vec<ImmersionWarning>);

fn listen(mut messages: MessageReader<ImmersionWarning>, mut told: ResMut<Told>) {
    told.0.extend(messages.read().cloned());
}

fn listening() -> App {
    // Another test may have set it.
    let _ = log::set_logger(&Count);
    log::set_max_level(log::LevelFilter::Warn);
    let mut app = app(FIXED);
    app.init_resource::<Told>().add_systems(Last, listen);
    app
}

/// A body without a collider, and one without mass, are refused once each, by name.
#[test]
fn refusals_are_told_once() {
    let mut app = listening();
    let bare = spawn(&mut app, (RigidBody::Dynamic, place(), Immersed::default()));
    let weightless = (
        RigidBody::Dynamic,
        Collider::ball(0.1),
        ColliderMassProperties::Density(0.0),
        place(),
        Immersed::default(),
    );
    let weightless = spawn(&mut app, weightless);
    update(&mut app, 60);
    // Another shape is tried, and refused for the same reason.
    for size in 1..5u8 {
        let ball = Collider::ball(0.1 * f32::from(size));
        app.world_mut().entity_mut(weightless).insert(ball);
        update(&mut app, 2);
    }
    let told = &app.world().resource::<Told>().0;
    let about = |entity| told.iter().filter(|told| told.body == Some(entity)).count();
    assert_eq!([about(bare), about(weightless)], [1, 1], "{told:?}");
    for told in told {
        assert!(matches!(told.warning, Warning::Refused { .. }), "{told:?}");
        assert_eq!(told.context, context_of(&app, bare));
    }
    assert_eq!(LINES.get(), 2);
    // With mass it is in the fluid.
    let mass = ColliderMassProperties::Density(100.0);
    app.world_mut().entity_mut(weightless).insert(mass);
    update(&mut app, 3);
    assert!(
        immersion(&app, weightless)
            .mass_of(handle(&app, weightless))
            .is_some()
    );
    assert_eq!(LINES.get(), 2);
}

/// What the immersion itself finds comes through with its entity, and once although its list is kept.
#[test]
fn warnings_come_through() {
    let mut app = listening();
    let law = ViscousLaw::Stochastic(StochasticLaw {
        drag: f64::NAN,
        ..StochasticLaw::default()
    });
    let refused = spawn(&mut app, (leaf(place()), Immersed::with_law(law)));
    app.insert_resource(Medium {
        layers: vec![Fluid::WATER.into(), Fluid::AIR.into()],
        ..default()
    });
    update(&mut app, 30);
    let told = &app.world().resource::<Told>().0;
    let refusals = told.iter().filter(|told| told.body == Some(refused));
    let refusals: Vec<_> = refusals
        .filter(|told| matches!(told.warning, Warning::Refused { .. }))
        .collect();
    assert_eq!(refusals.len(), 1, "{told:?}");
    let upside_down = told
        .iter()
        .filter(|told| matches!(told.warning, Warning::LighterBelow { .. }));
    assert_eq!(upside_down.count(), 1, "{told:?}");
    // It falls as plain rapier lets it.
    let fallen = body(&app, refused).linvel().y + 30.0 * 9.81 * STEP;
    assert!(fallen.abs() < 1e-3, "{fallen}");
}
