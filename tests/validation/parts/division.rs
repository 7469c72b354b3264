//! Which colliders become parts.

use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Division, HydroProperties};

fn hydro(colliders: &[ColliderBuilder], division: Division) -> HydroProperties {
    let mut world = PhysicsWorld::new();
    let (handle, _) = world.insert(RigidBodyBuilder::dynamic(), colliders[0].clone());
    for collider in &colliders[1..] {
        world.insert_collider(collider.clone(), Some(handle));
    }
    let (bodies, colliders) = (&world.bodies, &world.colliders);
    HydroProperties::from_body_divided(bodies, colliders, handle, division).unwrap()
}

fn parts(colliders: &[ColliderBuilder]) -> usize {
    hydro(colliders, Division::Automatic).parts.len()
}

fn cuboid(half: [f32; 3], at: [f32; 3]) -> ColliderBuilder {
    ColliderBuilder::cuboid(half[0], half[1], half[2])
        .translation(at.into())
        .density(500.0)
}

#[test]
fn colliders_that_are_one_surface() {
    let tile = |x: f32, z: f32| cuboid([0.1, 0.001, 0.1], [x, 0.0, z]);
    assert_eq!(parts(&[tile(0.0, 0.0)]), 0);
    // An L of three tiles in one plane.
    assert_eq!(parts(&[tile(0.0, 0.0), tile(0.2, 0.0), tile(0.2, 0.2)]), 0);
    // A stack of sheets, and a brick of eight: their hulls.
    let sheet = |y: f32| cuboid([0.1, 0.001, 0.1], [0.0, y, 0.0]);
    assert_eq!(parts(&[sheet(0.0), sheet(0.002), sheet(0.004)]), 0);
    let eighth = |i: i32| {
        let side = |bit: i32| if i >> bit & 1 == 1 { 0.05 } else { -0.05 };
        cuboid([0.05; 3], [side(0), side(1), side(2)])
    };
    assert_eq!(parts(&(0..8).map(eighth).collect::<Vec<_>>()), 0);
    // The pieces of something bent and solid.
    let handle = cuboid([0.2, 0.02, 0.02], [0.0; 3]);
    let head = cuboid([0.04, 0.06, 0.03], [0.22, 0.0, 0.0]);
    assert_eq!(parts(&[handle, head]), 0);
}

#[test]
fn colliders_that_are_several() {
    let wing = cuboid([0.3, 0.001, 0.05], [0.0; 3]);
    let fin = cuboid([0.001, 0.05, 0.05], [0.0, 0.05, 0.2]);
    assert_eq!(parts(&[wing.clone(), fin.clone()]), 2);
    // Halves of a wing with a kink of 10°.
    let half = |sign: f32| {
        cuboid([0.15, 0.001, 0.05], [0.15 * sign, 0.026, 0.0]).rotation(Vector::Z * (0.174 * sign))
    };
    assert_eq!(parts(&[half(1.0), half(-1.0)]), 2);
    // Two parallel plates that do not touch; two in one plane that do not.
    assert_eq!(
        parts(&[wing.clone(), cuboid([0.3, 0.001, 0.05], [0.0, 0.1, 0.0])]),
        2
    );
    assert_eq!(
        parts(&[wing.clone(), cuboid([0.3, 0.001, 0.05], [0.0, 0.0, 0.4])]),
        2
    );
    // An arrow: shaft and crossed fins.
    let shaft = cuboid([0.35, 0.003, 0.003], [0.0; 3]);
    let fins = [
        cuboid([0.02, 0.02, 0.0003], [-0.33, 0.0, 0.0]),
        cuboid([0.02, 0.0003, 0.02], [-0.33, 0.0, 0.0]),
    ];
    assert_eq!(parts(&[shaft, fins[0].clone(), fins[1].clone()]), 3);
    // One compound collider is its shapes.
    let shape = |half: Vector| SharedShape::cuboid(half.x, half.y, half.z);
    let compound = ColliderBuilder::compound(vec![
        (Pose::IDENTITY, shape(Vector::new(0.3, 0.001, 0.05))),
        (
            Pose::from_translation(Vector::Y * 0.05),
            shape(Vector::new(0.001, 0.05, 0.05)),
        ),
    ]);
    assert_eq!(parts(&[compound.density(100.0)]), 2);
    assert_eq!(
        hydro(&[wing.clone(), fin.clone()], Division::Whole).parts,
        []
    );
    assert_eq!(
        hydro(&[wing.clone(), wing], Division::EachCollider)
            .parts
            .len(),
        2
    );
}

/// Parts refer to the body's center of mass, and the whole's added mass is their sum.
#[test]
fn parts_add_up() {
    let wing = cuboid([0.3, 0.001, 0.05], [0.0; 3]);
    let tail = cuboid([0.1, 0.001, 0.03], [0.0, 0.0, 0.4]);
    let whole = hydro(&[wing, tail], Division::Automatic);
    let sum = whole.parts[0].added_mass + whole.parts[1].added_mass;
    assert_eq!(whole.added_mass, sum);
    let volume: f64 = whole.parts.iter().map(|part| part.volume).sum();
    assert!((volume / whole.volume - 1.0).abs() < 1e-9);
    whole.check().unwrap();
}
