//! Which colliders become parts.

use rapier3d_immersed::rapier3d::na::{Matrix3, Vector3};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Division, DryMass, Fluid, FreeBody, HydroProperties, ImmersedBody};

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

/// Half of a wing of span 0.6 m and chord 0.1 m along z, turned up about its root by a dihedral, rad.
fn half(sign: f32, dihedral: f32) -> ColliderBuilder {
    let turn = Rotation::from_rotation_z(dihedral * sign);
    let out = Pose::from_parts(turn * (Vector::X * (0.15 * sign)), turn);
    ColliderBuilder::cuboid(0.15, 0.001, 0.05)
        .position(out)
        .density(500.0)
}

/// What Helmbold's law takes for the aspect ratio of a part's wing when it moves along z: 4b²/A of the whole.
fn aspect(part: &HydroProperties) -> f64 {
    let plate = &part.planform;
    let span = |axis: usize| {
        let along = plate.axes.matrix().column(axis).into_owned();
        let across = Vector3::new(along.x, along.y, 0.0).norm();
        (2.0 * plate.half_extents[axis] * across).powi(2)
    };
    (span(0) + span(1)) * plate.fraction / plate.area
}

/// The halves of a wing with dihedral are two parts, but one wing: together they lift as the flat wing times cos²Γ (Purser &
/// Campbell, NACA Rep. 823 (1945)), since each meets α cos Γ and its force leans by Γ. Unjoined, they would have 0.74 of that
/// (Helmbold's slope for half the aspect ratio).
#[test]
fn a_wing_with_dihedral_lifts_as_one() {
    let body = |colliders: &[ColliderBuilder]| {
        let hydro = hydro(colliders, Division::Automatic);
        ImmersedBody::new(hydro)
    };
    let flat = body(&[half(1.0, 0.0), half(-1.0, 0.0)]);
    assert_eq!(flat.parts.len(), 0);
    let mass = DryMass {
        mass: 0.1,
        center: Vector3::zeros(),
        inertia: Matrix3::identity() * 1e-3,
    };
    let lift = |body: &ImmersedBody, angle: f64| {
        let mut free = FreeBody::new(body, &mass, &Fluid::AIR).unwrap();
        let (sine, cosine) = angle.sin_cos();
        free.set_velocity(Vector3::new(0.0, -sine, cosine) * 8.0, Vector3::zeros());
        let force = free.forces(Vector3::zeros()).viscous().force;
        f64::from(force.y) * cosine + f64::from(force.z) * sine
    };
    for degrees in [5.0, 10.0, 20.0, 28.0_f32] {
        let dihedral = degrees.to_radians();
        let bent = body(&[half(1.0, dihedral), half(-1.0, dihedral)]);
        assert_eq!(bent.parts.len(), 2);
        for part in &bent.parts {
            assert!((aspect(&part.hydro) - 6.0).abs() < 0.05);
        }
        bent.check().unwrap();
        for angle in [0.03, 0.07] {
            let found = lift(&bent, angle) / lift(&flat, angle);
            let exact = f64::from(dihedral).cos().powi(2);
            assert!(
                (found / exact - 1.0).abs() < 0.02,
                "{degrees}: {found} {exact}"
            );
        }
    }
    // Without the law's say in it: the added mass across the span is the flat wing's, turned.
    let bent = body(&[half(1.0, 0.2), half(-1.0, 0.2)]).hydro.added_mass;
    let share = bent.linear[(1, 1)] / flat.hydro.added_mass.linear[(1, 1)];
    assert!(
        (share / 0.2_f64.cos().powi(2) - 1.0).abs() < 0.01,
        "{share}"
    );
}

/// A middle piece with two outer ones, and a wing with a flap, are one bent plate each; steep ends, fins, plates that cross
/// and rings of plates are not.
#[test]
fn which_plates_are_one_bent_plate() {
    let shares = |colliders: &[ColliderBuilder]| {
        let parts = hydro(colliders, Division::Automatic).parts;
        let fractions = parts.iter().map(|part| part.planform.fraction);
        (fractions.collect::<Vec<_>>(), parts)
    };
    let near = |found: &[f64], exact: &[f64]| {
        assert_eq!(found.len(), exact.len(), "{found:?}");
        for (found, exact) in found.iter().zip(exact) {
            assert!((found - exact).abs() < 5e-3, "{found} {exact}");
        }
    };
    // Tips of 0.1 m on a middle piece of 0.4 m, turned up by 30° and by 80°.
    let tip = |sign: f32, angle: f32| {
        let turn = Rotation::from_rotation_z(angle * sign);
        let at = Vector::X * (0.2 * sign) + turn * (Vector::X * (0.05 * sign));
        let at = Pose::from_parts(at, turn);
        ColliderBuilder::cuboid(0.05, 0.001, 0.05).position(at)
    };
    let middle = cuboid([0.2, 0.001, 0.05], [0.0; 3]);
    let turned_up = |angle: f32| [middle.clone(), tip(1.0, angle), tip(-1.0, angle)];
    let (found, parts) = shares(&turned_up(0.52));
    near(&found, &[2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0]);
    parts.iter().for_each(|part| part.check().unwrap());
    assert!((aspect(&parts[0]) - 6.0).abs() < 0.05);
    near(&shares(&turned_up(1.4)).0, &[1.0; 3]);
    // A flap of 3 cm behind a chord of 7 cm, down by 15°: the same wing of 0.4 m by 0.1 m to what flies along z.
    let turn = Rotation::from_rotation_x(0.26);
    let at = Vector::Z * -0.035 + turn * (Vector::Z * -0.015);
    let flap = ColliderBuilder::cuboid(0.2, 0.001, 0.015).position(Pose::from_parts(at, turn));
    let (found, parts) = shares(&[cuboid([0.2, 0.001, 0.035], [0.0; 3]), flap]);
    near(&found, &[0.7, 0.3]);
    parts
        .iter()
        .for_each(|part| assert!((aspect(part) - 4.0).abs() < 0.1));
    // A fin on a tailplane, upright and leaning; plates that cross.
    let leaning = |angle: f32, up: f32| {
        let turn = Rotation::from_rotation_z(angle);
        let at = Pose::from_parts(turn * (Vector::Y * up), turn);
        ColliderBuilder::cuboid(0.001, 0.05, 0.05).position(at)
    };
    near(&shares(&[middle.clone(), leaning(0.0, 0.05)]).0, &[1.0; 2]);
    near(&shares(&[middle.clone(), leaning(0.9, 0.05)]).0, &[1.0; 2]);
    near(&shares(&[middle.clone(), leaning(1.1, 0.0)]).0, &[1.0; 2]);
    // An octagonal pipe: each bend is 45°, but no three of its sides are one plate.
    let side = |i: i32| {
        let turn = Rotation::from_rotation_z(std::f32::consts::FRAC_PI_4 * i as f32);
        let at = Pose::from_parts(turn * (Vector::Y * 0.1207), turn);
        ColliderBuilder::cuboid(0.05, 0.0005, 0.1).position(at)
    };
    let (found, _) = shares(&(0..8).map(side).collect::<Vec<_>>());
    assert!(found.iter().all(|share| *share > 0.45), "{found:?}");
}
