//! Solved added mass where bodies use it: in their properties and in flight through rapier.

use crate::assert_within;
use rapier3d_immersed::rapier3d::math::Pose;
use rapier3d_immersed::rapier3d::na::{Quaternion, UnitQuaternion, Vector3};
use rapier3d_immersed::rapier3d::parry::shape::SharedShape;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{
    Accuracy, AddedMassSource, DryMass, Error, Fluid, FreeBody, HydroProperties, ImmersedBody,
    Immersion, ViscousLaw,
};
use std::f64::consts::PI;

/// A square plate of no thickness has 0.57901 · π/4 (see `sheets.rs`); 10⁻⁴ of its side adds some
/// 10⁻⁴ ln 10⁴ ≈ 0.1 %, within the tolerance asked for.
#[test]
fn thin_square_plate() {
    let plate = SharedShape::cuboid(0.5, 0.5, 0.5e-4);
    let mesh = Accuracy::Mesh { tolerance: 0.01 };
    let hydro = HydroProperties::from_shape_with(plate.as_ref(), mesh).unwrap();
    assert_within(
        hydro.added_mass.linear[(2, 2)] / (PI / 4.0),
        0.57901,
        0.01,
        "square",
    );
    let proxy = HydroProperties::from_shape(plate.as_ref()).unwrap();
    assert_eq!(
        HydroProperties::from_shape_with(plate.as_ref(), Accuracy::default()),
        Ok(proxy.clone())
    );
    // All but the added mass is the same.
    let mut exchanged = hydro.with_added_mass(proxy.added_mass).unwrap();
    assert_eq!(exchanged.added_mass_source, AddedMassSource::Given);
    exchanged.added_mass_source = proxy.added_mass_source;
    assert_eq!(exchanged, proxy);
}

#[test]
fn tolerances_that_are_none_are_named() {
    for shape in [SharedShape::ball(0.5), SharedShape::cuboid(0.5, 0.5, 0.5)] {
        for tolerance in [0.0, -1.0, f64::NAN] {
            let found =
                HydroProperties::from_shape_with(shape.as_ref(), Accuracy::Mesh { tolerance });
            assert!(matches!(
                found,
                Err(Error::InvalidParameter {
                    parameter: "tolerance",
                    ..
                })
            ));
        }
    }
}

/// Two balls on one body, far apart: each has ½ of its volume about its own center, and neither
/// feels the other by more than (r/d)³ ≈ 10⁻³. One ball alone, off the origin, is exact.
#[test]
fn colliders_are_solved_together_where_they_are() {
    let mesh = Accuracy::Mesh { tolerance: 0.05 };
    let of = |places: &[Vector]| {
        let mut world = PhysicsWorld::new();
        let handle = world.bodies.insert(RigidBodyBuilder::dynamic());
        for place in places {
            let ball =
                ColliderBuilder::ball(0.1).position(Pose::new(*place, Vector::new(0.3, 1.0, -0.2)));
            world
                .colliders
                .insert_with_parent(ball, handle, &mut world.bodies);
        }
        HydroProperties::from_body_with(&world.bodies, &world.colliders, handle, mesh)
    };
    let half_volume = 2.0 / 3.0 * PI * 1e-3;
    let one = of(&[Vector::X]).unwrap();
    assert_within(one.added_mass.linear[(1, 1)], half_volume, 1e-6, "one ball");
    // About its own center, where the body's mass is.
    assert!(one.added_mass.angular.norm() < 1e-12);
    let two = of(&[Vector::X * 0.5, Vector::X * -0.5]).unwrap();
    let (linear, angular) = (two.added_mass.linear, two.added_mass.angular);
    assert_within(linear[(1, 1)], 2.0 * half_volume, 0.05, "two balls, y");
    // At distance ½ from the axis.
    assert_within(
        angular[(2, 2)],
        0.5 * half_volume,
        0.05,
        "two balls, about z",
    );
    let touching = of(&[Vector::X * 0.05, Vector::X * -0.05]);
    assert!(matches!(touching, Err(Error::SelfIntersection { .. })));
}

/// A cone cut in half along its axis, solved with its coupling A₁₂, flies through rapier: in an ideal
/// fluid its kinetic energy (of body and fluid, evaluated in f64 at rapier's state) stays.
#[test]
fn half_cone_flies() {
    let mut points = vec![Vector::Y * 0.2];
    points.extend((0..=8).map(|i| {
        let (sin, cos) = (std::f32::consts::PI * i as f32 / 8.0).sin_cos();
        Vector::new(0.1 * cos, 0.0, 0.1 * sin)
    }));
    let mut world = PhysicsWorld {
        gravity: Vector::ZERO,
        ..PhysicsWorld::new()
    };
    world.integration_parameters.dt = 1.0 / 240.0;
    let (handle, _) = world.insert(
        RigidBodyBuilder::dynamic()
            .linvel(Vector::new(0.3, 0.1, -0.2))
            .angvel(Vector::new(1.0, 4.0, -2.0)),
        ColliderBuilder::convex_hull(&points)
            .unwrap()
            .density(1500.0),
    );
    let hydro = HydroProperties::from_body_with(
        &world.bodies,
        &world.colliders,
        handle,
        Accuracy::Mesh { tolerance: 0.02 },
    )
    .unwrap();
    // The proxy's coupling is only that of its centroid being elsewhere than the center of mass,
    // which for a uniform body is nowhere.
    let proxy = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
    let added = hydro.added_mass;
    let scale = (added.linear.norm() * added.angular.norm()).sqrt();
    assert!(proxy.added_mass.coupling.norm() < 1e-6 * scale);
    assert!(added.coupling.norm() > 0.05 * scale, "{added:?}");

    let body = ImmersedBody::new(hydro)
        .with_law(ViscousLaw::Inviscid)
        .unwrap();
    let mass = DryMass::of_body(&world.bodies, &world.colliders, handle).unwrap();
    let mut twin = FreeBody::new(&body, &mass, &Fluid::WATER).unwrap();
    let vector = |v: Vector| Vector3::new(v.x.into(), v.y.into(), v.z.into());
    let mut energy = |world: &PhysicsWorld| {
        let body = &world.bodies[handle];
        let q = body.rotation();
        twin.set_orientation(UnitQuaternion::from_quaternion(Quaternion::new(
            q.w.into(),
            q.x.into(),
            q.y.into(),
            q.z.into(),
        )));
        twin.set_velocity(vector(body.linvel()), vector(body.angvel()));
        twin.kinetic_energy()
    };
    let mut immersion = Immersion::new(Fluid::WATER);
    immersion.insert(handle, body);
    let start = energy(&world);
    let mut worst = 0.0_f64;
    for _ in 0..2400 {
        immersion.step(&mut world);
        let now = energy(&world);
        assert!(now.is_finite());
        worst = worst.max((now / start - 1.0).abs());
    }
    println!("energy, ten seconds: {worst:.1e}");
    // 2400 steps in f32, each rounding by 10⁻⁷ of the velocities, twice that of the energy.
    assert!(worst < 1e-4, "{worst}");
    assert!(world.bodies[handle].translation().length() > 0.5);
}
