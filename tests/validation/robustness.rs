//! Never blow up: any body, any fluid, any dt.

use crate::support::{solid_box, weightless};
use proptest::prelude::*;
use rapier3d_immersed::rapier3d::na::{UnitQuaternion, Vector3};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{
    Fluid, FreeBody, HydroProperties, ImmersedBody, Immersion, StochasticLaw, ThesisLaw, ViscousLaw,
};

fn log_range(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low.ln()..high.ln()).prop_map(f64::exp)
}

fn direction() -> impl Strategy<Value = Vector3<f64>> {
    [-1.0..1.0, -1.0..1.0, -1.0..1.0_f64]
        .prop_filter("not zero", |v| v.iter().map(|x| x * x).sum::<f64>() > 1e-3)
        .prop_map(|[x, y, z]| Vector3::new(x, y, z).normalize())
}

/// A box in motion and the fluid around it: density ratios 10⁻³ … 10⁴, sizes 1 mm … 10 m (each edge on its
/// own), fluids from air to honey, dt from 1/1000 to 1/20 s, spins to 200 rad/s.
#[derive(Clone, Debug)]
struct Case {
    size: [f64; 3],
    density: f64,
    fluid: Fluid,
    dt: f64,
    velocity: Vector3<f64>,
    spin: Vector3<f64>,
}

prop_compose! {
    fn cases()(
        size in [log_range(1e-3, 10.0), log_range(1e-3, 10.0), log_range(1e-4, 1.0)],
        ratio in log_range(1e-3, 1e4),
        density in log_range(1.0, 1400.0),
        viscosity in log_range(1e-6, 1e-2),
        dt in log_range(1e-3, 0.05),
        speed in log_range(1e-3, 50.0),
        spin in log_range(1e-2, 200.0),
        u in direction(),
        w in direction(),
    ) -> Case {
        Case {
            size,
            density: ratio * density,
            fluid: Fluid::new(density as f32, viscosity as f32).unwrap(),
            dt,
            velocity: u * speed,
            spin: w * spin,
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, ..ProptestConfig::default() })]

    /// With the default law, in a still fluid without gravity, the energy of body and fluid never grows
    /// from step to step. The margin is rounding.
    #[test]
    fn energy_never_grows(case in cases()) {
        let (body, mass) = solid_box(case.size, case.density, ViscousLaw::default());
        let mut body = FreeBody::new(&body, &mass, &case.fluid).unwrap();
        body.set_velocity(case.velocity, case.spin);
        let mut energy = body.kinetic_energy();
        for step in 0..60 {
            body.step(case.dt, Vector3::zeros());
            let now = body.kinetic_energy();
            prop_assert!(now.is_finite() && body.position.iter().all(|x| x.is_finite()));
            prop_assert!(now <= energy * (1.0 + 1e-9), "step {step}: {energy} -> {now}");
            energy = now;
        }
    }

    /// The same through rapier, for every law and under gravity: nothing that rapier holds ever
    /// becomes NaN or infinite.
    #[test]
    fn rapier_never_sees_nan(
        case in cases(),
        law in 0..4_usize,
    ) {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = case.dt as Real;
        let vector = |v: Vector3<f64>| Vector::new(v.x as Real, v.y as Real, v.z as Real);
        let half = case.size.map(|x| (x / 2.0) as Real);
        let (handle, _) = world.insert(
            RigidBodyBuilder::dynamic()
                .linvel(vector(case.velocity))
                .angvel(vector(case.spin)),
            ColliderBuilder::cuboid(half[0], half[1], half[2]).density(case.density as Real),
        );
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
        let law = [
            ViscousLaw::default(),
            ViscousLaw::Thesis(ThesisLaw::new(ThesisLaw::AUTOROTATION)),
            ViscousLaw::Thesis(ThesisLaw::printed(ThesisLaw::AUTOROTATION)),
            ViscousLaw::Stochastic(StochasticLaw::default()),
        ][law];
        let mut immersion = Immersion::new(case.fluid);
        immersion.insert(handle, ImmersedBody::new(hydro).with_law(law).unwrap());
        for _ in 0..40 {
            immersion.step(&mut world);
            let body = &world.bodies[handle];
            prop_assert!(body.linvel().is_finite() && body.angvel().is_finite());
            prop_assert!(body.translation().is_finite() && body.rotation().is_finite());
            prop_assert!(body.user_force() == Vector::ZERO);
        }
        prop_assert!(world.quarantine().is_empty());
    }
}

/// Thin plates in water, random attitude and 10 rad/s: the cases on which explicit added mass fails
/// in most runs (4 × 20 cm: in all of them, at any dt down to 1/1000).
#[test]
fn thin_plates_in_water_are_stable() {
    for (size, runs) in [([0.04, 0.04], 5), ([0.2, 0.04], 5)] {
        for thickness in [1e-3, 1e-4] {
            for dt in [1.0 / 60.0, 1.0 / 240.0, 1.0 / 1000.0] {
                for run in 0..runs {
                    let mut world = PhysicsWorld::new();
                    world.integration_parameters.dt = dt;
                    let turn = Vector::new(1.0, 0.3 * run as Real, 0.7 - run as Real);
                    let (handle, _) = world.insert(
                        RigidBodyBuilder::dynamic()
                            .rotation(turn)
                            .angvel(turn.normalize() * 10.0),
                        ColliderBuilder::cuboid(size[0] / 2.0, thickness / 2.0, size[1] / 2.0)
                            .density(2700.0),
                    );
                    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle)
                        .unwrap();
                    let mut immersion = Immersion::new(Fluid::WATER);
                    immersion.insert(handle, hydro);
                    for _ in 0..(2.0 / dt) as usize {
                        immersion.step(&mut world);
                    }
                    let body = &world.bodies[handle];
                    // Terminal speeds edgewise are below 2 m/s; a blow-up passes any bound.
                    assert!(body.linvel().length() < 3.0, "{size:?} {thickness} {dt}");
                    assert!(body.angvel().length() < 200.0, "{size:?} {thickness} {dt}");
                }
            }
        }
    }
}

/// A gravity, a fluid or a body position that is absurd does not make NaN either.
#[test]
fn absurd_worlds() {
    for gravity in [0.0, 1e4, -1e4] {
        let mut world = weightless();
        world.gravity = Vector::Y * gravity;
        let (handle, _) = world.insert(
            RigidBodyBuilder::dynamic().translation(Vector::splat(1e5)),
            ColliderBuilder::cuboid(0.1, 0.001, 0.1).density(1e-3),
        );
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
        let mut immersion = Immersion::new(Fluid::WATER);
        immersion.insert(handle, hydro);
        for _ in 0..300 {
            immersion.step(&mut world);
        }
        assert!(world.bodies[handle].linvel().is_finite());
    }
    let body = solid_box([0.1, 0.1, 0.001], 500.0, ViscousLaw::default());
    let mut body = FreeBody::new(&body.0, &body.1, &Fluid::AIR).unwrap();
    body.set_orientation(UnitQuaternion::from_euler_angles(1.0, 2.0, 3.0));
    for dt in [0.0, -1.0, f64::NAN, 1e3] {
        body.step(dt, Vector3::new(0.0, -9.81, 0.0));
        assert!(body.linear_velocity().iter().all(|x| x.is_finite()), "{dt}");
    }
}

/// Limits on substeps that make no sense: the body falls on, finite, as fast as it can at most.
#[test]
fn absurd_integrators() {
    for limit in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for (max_turn, max_travel) in [(limit, 0.3), (0.2, limit), (limit, limit)] {
            let mut world = PhysicsWorld::new();
            let (handle, _) = world.insert(
                RigidBodyBuilder::dynamic(),
                ColliderBuilder::cuboid(0.03, 0.0002, 0.02).density(300.0),
            );
            let hydro =
                HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
            let mut immersion = Immersion::new(Fluid::AIR);
            immersion.insert(handle, hydro);
            immersion.integrator.max_turn = max_turn;
            immersion.integrator.max_travel = max_travel;
            for _ in 0..120 {
                immersion.step(&mut world);
            }
            let body = &world.bodies[handle];
            let fall = -body.translation().y;
            // Two seconds of free fall are 19.6 m.
            assert!(fall > 0.1 && fall < 19.7, "{max_turn} {max_travel}: {fall}");
            assert!(body.angvel().is_finite(), "{max_turn} {max_travel}");
        }
    }
}
