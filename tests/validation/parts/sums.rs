//! What parts add up to.

use crate::support::solid_box;
use rapier3d_immersed::rapier3d::na::{Isometry3, Translation3, UnitQuaternion, Vector3};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{
    Fluid, FreeBody, HydroProperties, ImmersedBody, Immersion, Part, PhysicalLaw, ViscousLaw,
};

fn wide(v: Vector) -> Vector3<f64> {
    Vector3::new(v.x, v.y, v.z).map(f64::from)
}

/// A plate that is its own only part falls as the plate itself: two paths of code, one result, to rounding (a chaotic fall would
/// enlarge it: half a second is short of that).
#[test]
fn one_part_is_the_whole() {
    let (whole, mass) = solid_box([0.08, 1e-3, 0.05], 800.0, ViscousLaw::default());
    let part = whole.clone().with_parts([Part::new(whole.hydro.clone())]);
    let fly = |body: &ImmersedBody| {
        let mut free = FreeBody::new(body, &mass, &Fluid::AIR).unwrap();
        free.set_orientation(UnitQuaternion::from_euler_angles(0.3, 0.1, 0.2));
        for _ in 0..120 {
            free.step(1.0 / 240.0, Vector3::y() * -9.81);
        }
        free.position
    };
    let (a, b) = (fly(&whole), fly(&part));
    assert!((a - b).norm() < 1e-8 * a.norm(), "{a} {b}");
}

/// The same through rapier, in single precision: eight bodies side by side and one alone, at 60 Hz.
#[test]
fn one_part_is_the_whole_in_rapier() {
    let mut ends = Vec::new();
    for parts in [false, true] {
        let mut world = PhysicsWorld::new();
        let mut immersion = Immersion::new(Fluid::AIR);
        let mut handles = Vec::new();
        for i in 0..9 {
            let body = RigidBodyBuilder::dynamic()
                .translation(Vector::X * i as f32)
                .rotation(Vector::new(0.3, 0.05 * i as f32, 0.1));
            let leaf = ColliderBuilder::cuboid(0.0365, 0.000_15, 0.021).density(300.0);
            let (handle, _) = world.insert(body, leaf);
            let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle);
            let mut body = ImmersedBody::new(hydro.unwrap());
            if parts {
                let part = Part::new(body.hydro.clone());
                body = body.with_parts([part]);
            }
            immersion.insert(handle, body);
            handles.push(handle);
        }
        (0..40).for_each(|_| immersion.step(&mut world));
        assert_eq!(immersion.warnings(), []);
        ends.push(
            handles
                .iter()
                .map(|h| world.bodies[*h].translation())
                .collect::<Vec<_>>(),
        );
    }
    for (a, b) in ends[0].iter().zip(&ends[1]) {
        assert!((*a - *b).length() < 1e-4, "{a} {b}");
    }
}

/// Eight strips of a plate have the whole's aspect ratio, and so the whole's force in any translation across the span: to 1 % of
/// it (the pressure point of attached flow moves with the chord, the same for all).
#[test]
fn strips_are_the_plate_in_translation() {
    let size = [0.4, 2e-3, 0.05];
    let (whole, mass) = solid_box(size, 800.0, ViscousLaw::default());
    let half = size.map(|x| (x / 2.0) as f32);
    let strips = HydroProperties::strips_of_shape(&Cuboid::new(half.into()), 8).unwrap();
    let parts = whole.clone().with_parts(strips.into_iter().map(Part::new));
    for degree in [2.0, 5.0, 10.0, 20.0, 45.0, 90.0_f64] {
        let angle = degree.to_radians();
        let velocity = Vector3::new(0.0, -angle.sin(), angle.cos()) * 5.0;
        let force = |body: &ImmersedBody| {
            let mut free = FreeBody::new(body, &mass, &Fluid::AIR).unwrap();
            free.set_velocity(velocity, Vector3::zeros());
            let viscous = free.forces(Vector3::zeros()).viscous();
            (wide(viscous.force), wide(viscous.torque))
        };
        let ((f, t), (g, s)) = (force(&whole), force(&parts));
        assert!((f - g).norm() < 1e-2 * f.norm(), "{degree}: {f} {g}");
        assert!((t - s).norm() < 1e-2 * f.norm() * 0.05, "{degree}: {t} {s}");
    }
}

/// A plate that falls broadside and turns about its chord: strips feel the pressure ½ρC(v + ωx)|v + ωx| each at its place,
/// which for ωx ≪ v is `½ρC·2vω I₂` and for v = 0 is `½ρC ω² I₃`, with the integrals of the whole.
/// Ten strips miss 1 % of I₂ = Σ x²A (its own part is in the damping), and less of I₃.
#[test]
fn strips_damp_a_rotation_by_their_places() {
    let size = [0.4, 2e-3, 0.05];
    let fluid = Fluid::new(1.2, 1.5e-5).unwrap();
    // Without damping of a rotation in itself.
    let law = PhysicalLaw {
        translation_damping: 0.0,
        rotation_damping: 0.0,
        ..PhysicalLaw::default()
    };
    let (whole, mass) = solid_box(size, 800.0, ViscousLaw::Physical(law));
    let half = size.map(|x| (x / 2.0) as f32);
    let strips = HydroProperties::strips_of_shape(&Cuboid::new(half.into()), 10).unwrap();
    let parts = whole.clone().with_parts(strips.into_iter().map(Part::new));
    let mut free = FreeBody::new(&parts, &mass, &fluid).unwrap();
    let plate = &whole.hydro.planform;
    let mut torque = |velocity: f64, spin: f64| {
        free.set_velocity(Vector3::y() * -velocity, Vector3::z() * spin);
        -wide(free.forces(Vector3::zeros()).viscous().torque).z
    };
    let drag = {
        let still = torque(10.0, 0.0).abs();
        assert!(still < 1e-6, "{still}");
        let mut free = FreeBody::new(&parts, &mass, &fluid).unwrap();
        free.set_velocity(Vector3::y() * -10.0, Vector3::zeros());
        wide(free.forces(Vector3::zeros()).viscous().force).y / 100.0
    };
    // ½ρC of a square meter.
    let pressure = drag / plate.area;
    let exact = pressure * 2.0 * 10.0 * 0.5 * plate.second_moment.y;
    let found = torque(10.0, 0.5);
    assert!((found / exact - 1.0).abs() < 0.1, "{found} {exact}");
    let exact = pressure * 50.0 * 50.0 * plate.third_moment.y;
    let found = torque(0.0, 50.0);
    assert!((found / exact - 1.0).abs() < 0.1, "{found} {exact}");
}

/// Parts elsewhere and turned: the force is that of the part by itself at its velocity, turned back, and its moment that of
/// its place. An independent computation from the part alone.
#[test]
fn a_part_feels_its_own_velocity() {
    let (plate, plate_mass) = solid_box([0.1, 1e-3, 0.04], 800.0, ViscousLaw::default());
    let turn = UnitQuaternion::from_euler_angles(0.5, -1.1, 0.3);
    let place = Vector3::new(0.2, -0.3, 0.1);
    let part =
        Part::new(plate.hydro.clone()).at(Isometry3::from_parts(Translation3::from(place), turn));
    let body = plate.clone().with_parts([part]);
    let mut whole = FreeBody::new(&body, &plate_mass, &Fluid::WATER).unwrap();
    let mut alone = FreeBody::new(&plate, &plate_mass, &Fluid::WATER).unwrap();
    for i in 0..20 {
        let i = f64::from(i);
        let velocity = Vector3::new((1.7 * i).sin(), (2.3 * i).cos(), (0.9 * i).sin());
        let spin = Vector3::new((0.7 * i).cos(), (3.1 * i).sin(), (1.3 * i).cos()) * 3.0;
        whole.set_velocity(velocity, spin);
        let found = whole.forces(Vector3::zeros()).viscous();
        let (force, torque) = (wide(found.force), wide(found.torque));
        alone.set_velocity(
            turn.inverse() * (velocity + spin.cross(&place)),
            turn.inverse() * spin,
        );
        let own = alone.forces(Vector3::zeros()).viscous();
        let expected = turn * wide(own.force);
        let moment = turn * wide(own.torque) + place.cross(&expected);
        assert!((force - expected).norm() < 1e-5 * expected.norm(), "{i}");
        assert!((torque - moment).norm() < 1e-5 * moment.norm(), "{i}");
    }
}

/// In shear each part is in its own wind, and turbulence far apart is not alike: what the immersion reads out of a dumbbell of two
/// plates in a wind that grows with height is the sum of both in theirs, and a step accelerates it by that.
#[test]
fn each_part_has_a_flow_of_its_own() {
    use rapier3d_immersed::flow::Flow;
    #[derive(Debug)]
    struct Shear;
    impl Flow for Shear {
        fn velocity(&self, point: Vector, _time: f64) -> Vector {
            Vector::X * (3.0 + 2.0 * point.y)
        }
    }
    let mut world = PhysicsWorld {
        gravity: Vector::ZERO,
        ..PhysicsWorld::new()
    };
    let plate = |y: f32| {
        ColliderBuilder::cuboid(0.001, 0.05, 0.05)
            .translation(Vector::Y * y)
            .density(500.0)
    };
    let (handle, _) = world.insert(RigidBodyBuilder::dynamic(), plate(0.6));
    world.insert_collider(plate(-0.6), Some(handle));
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
    assert_eq!(hydro.parts.len(), 2);
    let area = hydro.parts[0].planform.area as f32;
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.insert(handle, hydro);
    immersion.set_flow(Shear);
    immersion.step(&mut world);
    world.bodies[handle].set_linvel(Vector::ZERO, true);
    world.bodies[handle].set_angvel(Vector::ZERO, true);
    let found = immersion.forces(&world.bodies, handle).unwrap().viscous();
    // C_D of a square plate broadside, DNV-RP-C205: 1.16; ½ρA C (4.2² and 1.8²).
    let pressure = 0.5 * immersion.fluid().density() * area * 1.16;
    let (top, bottom) = (pressure * 4.2 * 4.2, pressure * 1.8 * 1.8);
    let sum = found.force.x;
    assert!(
        (sum / (top + bottom) - 1.0).abs() < 0.02,
        "{sum} {top} {bottom}"
    );
    let moment = -found.torque.z;
    let exact = 0.6 * (top - bottom);
    assert!((moment / exact - 1.0).abs() < 0.03, "{moment} {exact}");
    let part = immersion.part_forces(&world.bodies, handle, 0).unwrap();
    assert!((part.viscous().force.x / top - 1.0).abs() < 0.02);
    let mass = immersion.mass_matrix_of(handle).unwrap();
    immersion.step(&mut world);
    let body = &world.bodies[handle];
    let push = f64::from(body.linvel().x) * mass[(0, 0)] * 60.0;
    // Over a step the relative velocity falls by 1 %.
    assert!((push / f64::from(sum) - 1.0).abs() < 0.05, "{push} {sum}");
    assert!(body.angvel().z < 0.0);
}

/// A plate that turns about its normal in a stream is not braked more by being divided: the forces of strips have the arms that
/// the whole's damping stands for, and what is their own vanishes with their width.
#[test]
fn strips_spin_as_easily_as_the_plate() {
    let (whole, mass) = solid_box([0.4, 2e-3, 0.05], 800.0, ViscousLaw::default());
    let braked = |count: usize| {
        let strips =
            HydroProperties::strips_of_shape(&Cuboid::new(Vector::new(0.2, 1e-3, 0.025)), count);
        let parts = strips.unwrap().into_iter().map(Part::new);
        let body = whole.clone().with_parts(parts);
        let mut free = FreeBody::new(&body, &mass, &Fluid::AIR).unwrap();
        free.set_velocity(Vector3::z() * 5.0, Vector3::y() * 10.0);
        -wide(free.forces(Vector3::zeros()).viscous().torque).y
    };
    let (one, some, many) = (braked(1), braked(8), braked(64));
    assert!(
        some < 1.05 * one && many < 1.05 * one,
        "{one} {some} {many}"
    );
    assert!((many / some - 1.0).abs() < 0.05, "{some} {many}");
}
