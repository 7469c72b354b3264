//! A reduced model of a law that drives bodies in the law's place.

use rapier3d_immersed::rapier3d::na::{Matrix3, UnitQuaternion, Vector3};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::reduced::CrossParams;
use rapier3d_immersed::{
    DryMass, Fluid, FreeBody, HydroProperties, ImmersedBody, Immersion, Part, PartLaw,
    SeparatedLaw, ThesisLaw, ViscousLaw,
};

/// A rectangle of paper, half extents in m.
fn leaf() -> HydroProperties {
    HydroProperties::from_shape(&Cuboid::new(Vector::new(0.0365, 0.00015, 0.021))).unwrap()
}

fn params(max_rank: usize) -> CrossParams {
    CrossParams {
        tolerance: 1e-3,
        max_rank,
        max_evaluations: 100_000,
        rank_growth: 4,
        ..CrossParams::default()
    }
}

/// The default law of the leaf, at a low rank: off by a fifth or so of its forces, which is what the tests of
/// stability want.
fn rough() -> SeparatedLaw {
    let law = ViscousLaw::default();
    SeparatedLaw::bake(&leaf(), law, [100.0, 2e4], &params(8))
        .unwrap()
        .0
}

fn driven(hydro: HydroProperties, law: SeparatedLaw) -> ImmersedBody {
    let part = Part::new(hydro.clone()).with_law(law);
    ImmersedBody::new(hydro).with_parts([part])
}

fn dry(hydro: &HydroProperties, density: f64) -> DryMass {
    let mass = density * hydro.volume;
    let half = hydro.planform.half_extents;
    let squares = [half.x, half.z, half.y].map(|x| x * x);
    DryMass {
        mass,
        center: Vector3::zeros(),
        inertia: Matrix3::from_diagonal(&Vector3::new(
            squares[1] + squares[2],
            squares[0] + squares[2],
            squares[0] + squares[1],
        )) * (mass / 3.0),
    }
}

/// The leaf's first swing under the default law and under its reduced model of rank 32 (error .11 over all motions, half of
/// which spin faster than they move; leaves do not): after 0.3 s, of which the fall makes 0.2 m, within 2 cm.
#[test]
fn it_falls_like_the_law() {
    let hydro = leaf();
    let dry = dry(&hydro, 300.0);
    let law = ViscousLaw::default();
    let (separated, _) = SeparatedLaw::bake(&hydro, law, [100.0, 2e4], &params(32)).unwrap();
    println!("error {:?}", separated.error());
    assert!(separated.error()[0] < 0.15);
    let fall = |body: &ImmersedBody| {
        let mut body = FreeBody::new(body, &dry, &Fluid::AIR).unwrap();
        body.set_orientation(UnitQuaternion::from_scaled_axis(Vector3::new(
            0.4, 0.0, 0.2,
        )));
        for _ in 0..150 {
            body.step(0.002, Vector3::new(0.0, -9.81, 0.0));
        }
        body.position
    };
    let exact = fall(&ImmersedBody::new(hydro.clone()));
    let found = fall(&driven(hydro, separated));
    println!("{exact} {found}");
    assert!(exact.norm() > 0.15);
    assert!((found - exact).norm() < 0.02, "{found} {exact}");
}

/// Whatever its error, and far beyond its Reynolds numbers (0.1 to 10⁶ here, for 100 to 20 000), it takes energy: that of
/// body and fluid in a still fluid without gravity never grows, at any step, and every number stays finite.
#[test]
fn it_never_gives_energy() {
    let law = rough();
    for size in [0.02, 1.0, 30.0] {
        let half = Vector::new(0.0365, 0.00015, 0.021) * size;
        let hydro = HydroProperties::from_shape(&Cuboid::new(half)).unwrap();
        for (density, fluid) in [(300.0, Fluid::AIR), (1100.0, Fluid::WATER)] {
            let dry = dry(&hydro, density);
            let body = driven(hydro.clone(), law.clone());
            let mut body = FreeBody::new(&body, &dry, &fluid).unwrap();
            for (speed, spin) in [(0.05, 0.1), (3.0, 40.0), (30.0, 1.0), (0.0, 100.0)] {
                let direction = Vector3::new(0.3, -0.8, 0.5);
                body.set_velocity(direction * speed, Vector3::new(0.6, 0.2, -0.7) * spin);
                for dt in [0.001, 1.0 / 60.0, 0.05] {
                    for _ in 0..60 {
                        let before = body.kinetic_energy();
                        body.step(dt, Vector3::zeros());
                        let after = body.kinetic_energy();
                        assert!(after <= before * (1.0 + 1e-9), "{before:e} {after:e}");
                    }
                }
                assert!(body.linear_velocity().norm().is_finite());
            }
        }
    }
}

/// One table serves equal shapes of all sizes in all fluids: at the same Reynolds number the deceleration of a body of twice the
/// size, at half the speed, is an eighth of the smaller's.
#[test]
fn it_is_dimensionless() {
    let law = rough();
    let lost = |size: f32, speed: f64| {
        let half = Vector::new(0.0365, 0.00015, 0.021) * size;
        let hydro = HydroProperties::from_shape(&Cuboid::new(half)).unwrap();
        let body = driven(hydro.clone(), law.clone());
        let mut body = FreeBody::new(&body, &dry(&hydro, 300.0), &Fluid::AIR).unwrap();
        let start = Vector3::new(0.3, -0.8, 0.5) * speed;
        body.set_velocity(
            start,
            Vector3::new(2.0, 1.0, -3.0) * (speed / f64::from(size)),
        );
        body.step(1e-6, Vector3::zeros());
        (body.linear_velocity() - start).norm() / 1e-6
    };
    let ratio = lost(1.0, 1.0) / lost(2.0, 0.5);
    // f32 half extents and volumes.
    assert!((ratio - 8.0).abs() < 1e-3, "{ratio}");
}

/// In a world: the same twice, bit by bit, and the same in lanes as by itself.
#[test]
fn worlds_repeat_themselves() {
    let body = driven(leaf(), rough());
    let run = |count: usize| {
        let mut world = PhysicsWorld::new();
        let mut immersion = Immersion::new(Fluid::AIR);
        let mut leaves = Vec::new();
        for i in 0..count {
            let leaf = RigidBodyBuilder::dynamic()
                .translation(Vector::X * i as f32)
                .rotation(Vector::new(0.3, 0.1 * i as f32, 0.1));
            let collider = ColliderBuilder::cuboid(0.0365, 0.00015, 0.021).density(300.0);
            let (leaf, _) = world.insert(leaf, collider);
            immersion.insert(leaf, body.clone());
            leaves.push(leaf);
        }
        for _ in 0..120 {
            immersion.step(&mut world);
        }
        leaves
            .iter()
            .map(|leaf| *world.bodies[*leaf].position())
            .collect::<Vec<_>>()
    };
    let (many, again, one) = (run(11), run(11), run(1));
    assert_eq!(many, again);
    assert_eq!(many[0], one[0]);
    assert!(many.iter().all(|pose| pose.translation.y < -0.3));
}

/// What has no separation, or is put on another shape, is refused and named.
#[test]
fn what_does_not_fit_is_refused() {
    let thesis = ViscousLaw::Thesis(ThesisLaw::new(ThesisLaw::ZIGZAG));
    let error = SeparatedLaw::bake(&leaf(), thesis, [100.0, 2e4], &params(8)).unwrap_err();
    assert!(error.to_string().contains("asymmetry"), "{error}");
    let falls = SeparatedLaw::bake(&leaf(), ViscousLaw::default(), [2e4, 100.0], &params(8));
    assert!(falls.is_err());
    let square = HydroProperties::from_shape(&Cuboid::new(Vector::new(0.03, 0.00015, 0.03)));
    let error = driven(square.unwrap(), rough()).check().unwrap_err();
    assert!(error.to_string().contains("half extent"), "{error}");
}

/// It is part of what is saved: to the bit, as snapshots are (text would round the last digit).
#[cfg(feature = "serde-serialize")]
#[test]
fn it_is_saved_and_loaded() {
    let law = PartLaw::from(rough());
    let bytes = postcard::to_stdvec(&law).unwrap();
    let loaded: PartLaw = postcard::from_bytes(&bytes).unwrap();
    assert!(loaded.check().is_ok());
    assert!(loaded == law);
}

#[cfg(not(feature = "serde-serialize"))]
#[test]
fn a_clone_is_equal() {
    let law = PartLaw::from(rough());
    assert_eq!(law.clone(), law);
}
