//! Components, colliders and masses that change while the body is in the fluid.

use crate::support::*;
use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use bevy_rapier3d::rapier::prelude as rapier;
use bevy_rapier3d_immersed::immersed::{BodyChanges, Part};
use bevy_rapier3d_immersed::prelude::*;

fn immersed(app: &mut App, entity: Entity) -> Mut<'_, Immersed> {
    app.world_mut().get_mut::<Immersed>(entity).unwrap()
}

/// Another law and other factors in mid-air are those of `insert` and `set_control`, to the bit.
#[test]
fn law_and_factors_may_change() {
    let mut app = app(FIXED);
    let leaf = spawn(&mut app, (leaf(place()), Immersed::default()));
    let mut own = Own::new(place(), Fluid::AIR);
    let thesis = ViscousLaw::Thesis(ThesisLaw::default());
    let factors = ForceFactors {
        drag: 3.0,
        ..ForceFactors::ONE
    };
    for step in 0..90 {
        if step == 30 {
            immersed(&mut app, leaf).law = thesis;
            let known = own.immersion.get(own.leaf).unwrap().clone();
            own.immersion
                .insert(own.leaf, known.with_law(thesis).unwrap());
        }
        if step == 60 {
            immersed(&mut app, leaf).factors = factors;
            own.immersion.set_control(own.leaf, factors);
        }
        app.update();
        own.step(STEP);
        assert_eq!(bits(body(&app, leaf)), bits(own.body()), "step {step}");
    }
    let mut still = Own::new(place(), Fluid::AIR);
    (0..90).for_each(|_| still.step(STEP));
    assert_ne!(bits(body(&app, leaf)), bits(still.body()));
    assert_eq!(
        immersion(&app, leaf).control(handle(&app, leaf)),
        Some(factors)
    );
}

/// What is set by hand is not set back by a component that has not changed, nor by one that is only touched.
#[test]
fn only_changes_are_told() {
    let mut app = app(FIXED);
    let leaf = spawn(&mut app, (leaf(place()), Immersed::default()));
    update(&mut app, 2);
    let (context, handle) = (context_of(&app, leaf), handle(&app, leaf));
    let factors = ForceFactors::from([2.0, 1.0, 1.0]);
    let mut entity = app.world_mut().entity_mut(context);
    let mut immersion = entity.get_mut::<RapierContextImmersion>().unwrap();
    immersion.set_control(handle, factors);
    immersed(&mut app, leaf).set_changed();
    update(&mut app, 2);
    let immersion = app.world().get::<RapierContextImmersion>(context).unwrap();
    assert_eq!(immersion.control(handle), Some(factors));
}

/// A cross of two plates: one part to the fluid, or two, as the component says.
fn cross(app: &mut App, immersed: Immersed) -> (Entity, [Entity; 2]) {
    let body = (
        RigidBody::Dynamic,
        Transform::from_xyz(0.0, 2.0, 0.0),
        immersed,
    );
    let body = spawn(app, body);
    let plate = |app: &mut App, half: [f32; 3]| {
        let [x, y, z] = half;
        let mass = ColliderMassProperties::Density(100.0);
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
    let plates = [[0.1, 0.001, 0.1], [0.1, 0.1, 0.001]].map(|half| plate(app, half));
    (body, plates)
}

fn parts(app: &App, entity: Entity) -> usize {
    let known = immersion(app, entity).get(handle(app, entity));
    known.unwrap().parts.len()
}

#[test]
fn descriptions_may_change() {
    let mut app = app(FIXED);
    let (cross, _) = cross(&mut app, Immersed::default());
    update(&mut app, 3);
    assert_eq!(parts(&app, cross), 2);
    immersed(&mut app, cross).description = Description::Whole;
    update(&mut app, 1);
    assert_eq!(parts(&app, cross), 0);
    immersed(&mut app, cross).description = Description::EachCollider;
    update(&mut app, 1);
    assert_eq!(parts(&app, cross), 2);
    let mass = immersion(&app, cross).mass_of(handle(&app, cross)).unwrap();
    let exact = 2.0 * 100.0 * 8.0 * 0.1 * 0.001 * 0.1;
    assert!((mass.mass / exact - 1.0).abs() < 1e-4, "{} kg", mass.mass);
}

/// Children that come and go: by the immersion itself for what it can describe, by the plugin for the rest.
#[test]
fn child_colliders_may_come_and_go() {
    for description in [
        Description::Colliders,
        Description::Whole,
        Description::EachCollider,
    ] {
        let mut app = app(FIXED);
        let divided = description != Description::Whole;
        let (cross, plates) = cross(
            &mut app,
            Immersed {
                description,
                ..default()
            },
        );
        update(&mut app, 5);
        let plate = 8.0 * 0.1 * 0.001 * 0.1;
        let volume = |app: &App| {
            let known = immersion(app, cross).get(handle(app, cross)).unwrap();
            (known.hydro.volume / plate, known.parts.len())
        };
        let factors = |app: &App| immersion(app, cross).control(handle(app, cross)).unwrap();
        immersed(&mut app, cross).factors = ForceFactors::from([2.0, 1.0, 1.0]);
        let upright = (
            Collider::cuboid(0.001, 0.1, 0.1),
            ColliderMassProperties::Density(100.0),
            // Away from the others, so that volumes add up.
            Transform::from_xyz(0.3, 0.0, 0.0),
            ChildOf(cross),
        );
        let third = spawn(&mut app, upright);
        update(&mut app, 2);
        let (now, count) = volume(&app);
        assert!((now - 3.0).abs() < 0.02, "{now}");
        assert_eq!(count, if divided { 3 } else { 0 });
        app.world_mut().despawn(third);
        // The first one, which has all the mass while the body is in the fluid.
        app.world_mut().despawn(plates[0]);
        update(&mut app, 2);
        let (now, count) = volume(&app);
        assert!((now - 1.0).abs() < 0.01, "{now}");
        assert!(count <= 1, "{count} parts");
        assert_eq!(factors(&app).drag, 2.0, "factors stay");
        let mass = immersion(&app, cross).mass_of(handle(&app, cross)).unwrap();
        assert!((mass.mass / (100.0 * plate) - 1.0).abs() < 1e-3);
    }
}

/// A description that is the user's own is followed by nobody, nor is any with `BodyChanges::Ignore`.
#[test]
fn what_shall_stay_stays() {
    let mut app = app(FIXED);
    let (cross, plates) = cross(
        &mut app,
        Immersed {
            description: Description::EachCollider,
            ..default()
        },
    );
    update(&mut app, 5);
    let context = context_of(&app, cross);
    let mut entity = app.world_mut().entity_mut(context);
    let mut immersion = entity.get_mut::<RapierContextImmersion>().unwrap();
    immersion.body_changes = BodyChanges::Ignore;
    app.world_mut().despawn(plates[1]);
    update(&mut app, 5);
    assert_eq!(parts(&app, cross), 2);
}

#[test]
fn mass_may_change() {
    let mut app = app(FIXED);
    let leaf = spawn(&mut app, (leaf(place()), Immersed::default()));
    update(&mut app, 60);
    let mass = |app: &App| {
        let mass = immersion(app, leaf).mass_of(handle(app, leaf));
        mass.unwrap().mass / (8.0 * LEAF.iter().map(|half| f64::from(*half)).product::<f64>())
    };
    assert!((mass(&app) - 300.0).abs() < 0.1, "{} kg/m³", mass(&app));
    let heavy = ColliderMassProperties::Density(3000.0);
    app.world_mut().entity_mut(leaf).insert(heavy);
    update(&mut app, 2);
    assert!((mass(&app) - 3000.0).abs() < 1.0, "{} kg/m³", mass(&app));
    let speed = body(&app, leaf).linvel().y;
    update(&mut app, 30);
    assert!(
        body(&app, leaf).linvel().y < 1.5 * speed,
        "it fell no faster"
    );
}

/// A body of the user's own description, in a place of the body's frame.
#[test]
fn descriptions_may_be_given() {
    let mut app = app(FIXED);
    let wing = rapier::SharedShape::cuboid(0.2, 0.002, 0.05);
    let hydro = HydroProperties::from_shape(wing.as_ref()).unwrap();
    let strips = HydroProperties::strips_of_shape(wing.as_ref(), 4).unwrap();
    let given = ImmersedBody::new(hydro).with_parts(strips.into_iter().map(Part::new));
    let given = given.with_law(ViscousLaw::Stochastic(StochasticLaw::default()));
    let component = Immersed::with_body(given.unwrap());
    let leaf = spawn(&mut app, (leaf(place()), component.clone()));
    update(&mut app, 2);
    let known = immersion(&app, leaf).get(handle(&app, leaf)).unwrap();
    assert_eq!(known.parts.len(), 4);
    assert_eq!(known.law, component.law);
    // Another law goes on top.
    immersed(&mut app, leaf).law = ViscousLaw::Inviscid;
    update(&mut app, 1);
    let known = immersion(&app, leaf).get(handle(&app, leaf)).unwrap();
    assert_eq!((known.parts.len(), known.law), (4, ViscousLaw::Inviscid));
    // From the beginning, too.
    let component = Immersed {
        law: ViscousLaw::Inviscid,
        ..component
    };
    let other = spawn(&mut app, (super::support::leaf(place()), component));
    update(&mut app, 2);
    let known = immersion(&app, other).get(handle(&app, other)).unwrap();
    assert_eq!((known.parts.len(), known.law), (4, ViscousLaw::Inviscid));
}

/// A collider that becomes a sensor displaces nothing any more, and again when it is solid.
#[test]
fn sensors_displace_nothing() {
    for description in [Description::Colliders, Description::Whole] {
        let mut app = app(FIXED);
        let immersed = Immersed {
            description,
            ..default()
        };
        let (cross, plates) = cross(&mut app, immersed);
        let volume = |app: &App| {
            let known = immersion(app, cross).get(handle(app, cross)).unwrap();
            known.hydro.volume / (8.0 * 0.1 * 0.001 * 0.1)
        };
        update(&mut app, 5);
        let whole = volume(&app);
        app.world_mut().entity_mut(plates[1]).insert(Sensor);
        update(&mut app, 3);
        assert!((volume(&app) - 1.0).abs() < 0.01, "{}", volume(&app));
        app.world_mut().entity_mut(plates[1]).remove::<Sensor>();
        update(&mut app, 3);
        assert!(whole > 1.9 && (volume(&app) - whole).abs() < 1e-6);
    }
}
