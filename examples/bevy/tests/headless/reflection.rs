//! What an inspector does: it finds the types by name, reads their fields and writes them.

use crate::support::*;
use bevy::ecs::reflect::ReflectComponent;
use bevy::prelude::*;
use bevy::reflect::{GetPath, PartialReflect, Reflect};
use bevy_rapier3d_immersed::prelude::*;

/// A component by the path of its type, as a value of unknown type.
fn component<'a>(app: &'a mut App, entity: Entity, path: &str) -> Mut<'a, dyn Reflect> {
    let registry = app.world().resource::<AppTypeRegistry>().clone();
    let registry = registry.read();
    let known = registry.get_with_short_type_path(path).expect(path);
    let data = known.data::<ReflectComponent>().expect(path).clone();
    data.reflect_mut(app.world_mut().entity_mut(entity))
        .unwrap()
}

/// The entity of a resource, which is a component of its own.
fn resource<R: Resource>(app: &App) -> Entity {
    let id = app.world().components().component_id::<R>().unwrap();
    app.world().resource_entities().get(id).unwrap()
}

fn number(value: &dyn Reflect, path: &str) -> f64 {
    let field = value.reflect_path(path).expect(path);
    let single = field
        .try_downcast_ref::<f32>()
        .map(|number| f64::from(*number));
    single
        .or_else(|| field.try_downcast_ref::<f64>().copied())
        .expect(path)
}

/// Speed of a leaf after a second in which an inspector has done something at the beginning.
fn fall(edit: impl FnOnce(&mut App, Entity)) -> Vec3 {
    let mut app = app(FIXED);
    let leaf = spawn(
        &mut app,
        (leaf(place()), Immersed::default(), FluidForces::default()),
    );
    update(&mut app, 1);
    edit(&mut app, leaf);
    update(&mut app, 60);
    body(&app, leaf).linvel()
}

#[test]
fn fields_are_read_and_change_the_fall() {
    let plain = fall(|_, _| ());
    let braked = fall(|app, leaf| {
        let mut immersed = component(app, leaf, "Immersed");
        assert_eq!(number(&*immersed, "factors.drag"), 1.0);
        assert_eq!(
            number(&*immersed, "law.0.friction"),
            PhysicalLaw::default().friction
        );
        let drag = immersed.reflect_path_mut("factors.drag").unwrap();
        drag.apply(20.0f32.as_partial_reflect());
    });
    assert!(braked.length() < 0.7 * plain.length(), "{braked}, {plain}");
    let other_law = fall(|app, leaf| {
        let mut immersed = component(app, leaf, "Immersed");
        let munk = immersed.reflect_path_mut("law.0.munk").unwrap();
        munk.apply(1.0f64.as_partial_reflect());
    });
    assert!((other_law - plain).length() > 0.01, "{other_law}");
    let blown = fall(|app, _| {
        let wind = resource::<Wind>(app);
        let mut wind = component(app, wind, "Wind");
        let x = wind.reflect_path_mut("velocity.x").unwrap();
        x.apply(5.0f32.as_partial_reflect());
    });
    assert!(blown.x > plain.x + 1.0, "{blown}");
    let drowned = fall(|app, _| {
        let medium = resource::<Medium>(app);
        let mut medium = component(app, medium, "Medium");
        assert!((number(&*medium, "layers[0].density") - 1.184).abs() < 1e-6);
        let density = medium.reflect_path_mut("layers[0].density").unwrap();
        density.apply(997.0f32.as_partial_reflect());
    });
    assert!(drowned.y > 0.0, "{drowned}");
}

/// A law of another kind, as an inspector's list of variants sets it, and the read-out.
#[test]
fn variants_and_read_outs() {
    let mut app = app(FIXED);
    let leaf = spawn(
        &mut app,
        (leaf(place()), Immersed::default(), FluidForces::default()),
    );
    update(&mut app, 30);
    let forces = component(&mut app, leaf, "FluidForces");
    let drag = number(&*forces, ".0.drag.force.y");
    assert!(drag > 0.0, "{drag}");
    let thesis = Immersed::with_law(ViscousLaw::Thesis(ThesisLaw::default()));
    let law = thesis.reflect_path("law").unwrap().to_dynamic().unwrap();
    let mut immersed = component(&mut app, leaf, "Immersed");
    immersed.reflect_path_mut("law").unwrap().apply(&*law);
    update(&mut app, 1);
    let known = immersion(&app, leaf).get(handle(&app, leaf)).unwrap();
    assert_eq!(known.law, thesis.law);
}
