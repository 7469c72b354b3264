//! Pushes move a body and the fluid that it drags along.

use super::changed_body::Scene;
use crate::support::weightless;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, ImmersedBody, Immersion};

/// An impulse of 𝕄 (Δv, 0) at the center of mass changes the velocity by Δv; one at a point acts with its
/// lever; locked axes stay; without fluid it is rapier's.
#[test]
fn impulses_move_body_and_fluid() {
    let mut scene = Scene::new(Fluid::WATER, 0.0);
    let push = Vector::new(0.1, -0.2, 0.3);
    // Not in the fluid yet.
    let mass = scene.world.bodies[scene.body].mass();
    scene
        .immersion
        .apply_impulse(&mut scene.world.bodies, scene.body, push * mass);
    let v = scene.world.bodies[scene.body].linvel();
    assert!((v - push).length() < 1e-6, "{v}");

    scene.immerse();
    scene.steps(5);
    let matrix = scene.immersion.mass_matrix_of(scene.body).unwrap();
    let dry = scene.immersion.mass_of(scene.body).unwrap().mass;
    assert!(matrix[(1, 1)] > 5.0 * dry, "{matrix}");
    for lever in [Vector::ZERO, Vector::new(0.02, 0.01, -0.03)] {
        let body = &scene.world.bodies[scene.body];
        let (rotation, center) = (*body.rotation(), body.center_of_mass());
        let (linear, angular) = (body.linvel(), body.angvel());
        scene.immersion.apply_impulse_at_point(
            &mut scene.world.bodies,
            scene.body,
            push * 0.1,
            center + lever,
        );
        let body = &scene.world.bodies[scene.body];
        let [v, w] = [body.linvel() - linear, body.angvel() - angular]
            .map(|change| rotation.inverse() * change);
        let change = [v.x, v.y, v.z, w.x, w.y, w.z].map(f64::from);
        let momentum = matrix * rapier3d_immersed::rapier3d::na::Vector6::from(change);
        let moment = rotation.inverse() * lever.cross(push * 0.1);
        let push = rotation.inverse() * (push * 0.1);
        let expected = [push.x, push.y, push.z, moment.x, moment.y, moment.z];
        for (is, should) in momentum.iter().zip(expected) {
            assert!((is - f64::from(should)).abs() < 1e-5 * f64::from(push.length()));
        }
    }

    scene
        .rigid_body()
        .set_locked_axes(LockedAxes::TRANSLATION_LOCKED_X, true);
    scene.rigid_body().set_linvel(Vector::ZERO, true);
    let Scene {
        world,
        immersion,
        body,
        ..
    } = &mut scene;
    let point = world.bodies[*body].center_of_mass() + Vector::Z * 0.03;
    let spin = world.bodies[*body].angvel();
    immersion.apply_impulse_at_point(&mut world.bodies, *body, Vector::splat(0.1), point);
    let moved = &world.bodies[*body];
    let (v, w) = (moved.linvel(), moved.angvel() - spin);
    assert_eq!(v.x, 0.0);
    // The lock takes what it must along x; the rest of the momentum is the push.
    let [v_own, w_own] = [v, w].map(|change| moved.rotation().inverse() * change);
    let change = [v_own.x, v_own.y, v_own.z, w_own.x, w_own.y, w_own.z].map(f64::from);
    let momentum = matrix * rapier3d_immersed::rapier3d::na::Vector6::from(change);
    let world_axes = |from: usize| {
        let part = momentum.fixed_rows::<3>(from);
        *moved.rotation() * Vector::new(part[0] as f32, part[1] as f32, part[2] as f32)
    };
    let (linear, angular) = (world_axes(0), world_axes(3));
    let moment = (Vector::Z * 0.03).cross(Vector::splat(0.1));
    assert!(
        (linear.y - 0.1).abs() + (linear.z - 0.1).abs() < 1e-4,
        "{linear}"
    );
    assert!((angular - moment).length() < 1e-5, "{angular}");
}

/// The change of velocity survives the next step of a fluid that only adds mass.
#[test]
fn an_impulse_lasts() {
    let mut world = weightless();
    let (body, _) = world.insert(
        RigidBodyBuilder::dynamic(),
        ColliderBuilder::ball(0.1).density(997.0),
    );
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, body).unwrap();
    let mut immersion = Immersion::new(Fluid::WATER);
    let ideal = rapier3d_immersed::ViscousLaw::Inviscid;
    immersion.insert(body, ImmersedBody::new(hydro).with_law(ideal).unwrap());
    (0..3).for_each(|_| immersion.step(&mut world));
    let mass = immersion.mass_matrix_of(body).unwrap()[(0, 0)] as Real;
    immersion.apply_impulse(&mut world.bodies, body, Vector::X * mass);
    (0..3).for_each(|_| immersion.step(&mut world));
    let v = world.bodies[body].linvel();
    assert!((v - Vector::X).length() < 1e-5, "{v}");
}
