//! The thesis's order of a step (§4.3.2): gravity, then the Langevin increments, then the loads.

use rapier3d_immersed::rapier3d::na::{Matrix3, UnitQuaternion, Vector3};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::training::{BodyInWorld, BodyState};
use rapier3d_immersed::turbulence::{
    LangevinMode, Turbulence, TurbulenceState, TurbulentLayer, kolmogorov_constant,
};
use rapier3d_immersed::{DryMass, Fluid, HydroProperties, ImmersedBody, Immersion, ViscousLaw};

const GRAVITY: f64 = 9.81;

fn layer(state: TurbulenceState, mode: LangevinMode) -> TurbulentLayer {
    TurbulentLayer {
        mode,
        seed: 21,
        ..Turbulence::Homogeneous(state).into()
    }
}

/// The relaxation rate (½ + ¾C₀)ε/k of thesis (4.10).
fn relaxation(state: TurbulenceState, fluid: &Fluid) -> f64 {
    let viscosity = fluid.kinematic_viscosity();
    let c0 = kolmogorov_constant(state.taylor_reynolds_squared(viscosity));
    (0.5 + 0.75 * f64::from(c0)) * f64::from(state.turnover_rate())
}

/// Velocity along gravity of a ball, 3 times as dense as the fluid, `steps` after its release; and its acceleration by
/// weight and buoyancy.
fn ball(
    radius: f32,
    law: ViscousLaw,
    fluid: Fluid,
    layer: TurbulentLayer,
    (dt, steps): (f64, usize),
) -> (f64, f64) {
    let ball = ColliderBuilder::ball(radius).density(3.0 * fluid.density());
    let hydro = HydroProperties::from_shape(ball.shape.as_ref()).unwrap();
    // A fluid of density 1; the ball's surface is a polyhedron.
    let mass = 4.0 * std::f64::consts::PI * f64::from(radius).powi(3);
    let gravity = GRAVITY * (mass - hydro.volume) / (mass + hydro.added_mass.linear[(1, 1)]);
    assert!((gravity / GRAVITY * 3.5 / 2.0 - 1.0).abs() < 1e-3);
    let body = ImmersedBody::new(hydro).with_law(law).unwrap();
    let release = BodyState::default();
    let mut world = BodyInWorld::with_collider(body, ball, fluid, &release, dt, GRAVITY).unwrap();
    world.immersion.set_turbulence(layer);
    for _ in 0..steps {
        world.step();
    }
    (-world.state().velocity.y, gravity)
}

/// Without loads the two orders are v ← κv + g'dt + noise and v ← κ(v + g'dt) + noise with the same noise, κ = e^(−αdt).
/// So after n steps they differ by −g'dt(1 − κⁿ), whatever the noise was.
#[test]
fn orders_differ_by_what_gravity_gives_in_a_step() {
    let fluid = Fluid::new(1.0, 0.1).unwrap();
    let state = TurbulenceState {
        kinetic_energy: 1.0,
        dissipation: 5.0,
    };
    let alpha = relaxation(state, &fluid);
    for (dt, steps) in [
        (1.0 / 30.0, 1),
        (1.0 / 60.0, 3),
        (1.0 / 60.0, 40),
        (1.0 / 480.0, 300),
    ] {
        let [(together, gravity), (gravity_first, _)] =
            [LangevinMode::BodyIncrements, LangevinMode::FractionalStep].map(|mode| {
                let (law, layer) = (ViscousLaw::Inviscid, layer(state, mode));
                // So large that the increments of its spin, which a step follows to second order, hardly turn it.
                ball(10.0, law, fluid, layer, (dt, steps))
            });
        let exact = -gravity * dt * (1.0 - (-alpha * dt * steps as f64).exp());
        let found = gravity_first - together;
        // Velocities of some m/s in single precision, rounded in each step, whose error is kept for 1/α.
        assert!(
            (found - exact).abs() < 1e-5,
            "{dt}, {steps}: {found} {exact}"
        );
    }
}

/// With Stokes' drag of rate c and steps that are short against it, a falling ball is slower in the thesis's order by
/// g'dt (α + ½c)/(α + c): of what gravity gave in a step, the increments take αdt and the loads, midway implicit,
/// half of cdt too much.
#[test]
fn a_slowly_falling_ball_converges_to_the_other_order() {
    let fluid = Fluid::new(1.0, 100.0).unwrap();
    let state = TurbulenceState {
        kinetic_energy: 1.0,
        dissipation: 20.0,
    };
    let (alpha, radius) = (relaxation(state, &fluid), 3.0f64);
    let stokes = 6.0 * 100.0 * radius / (3.5 * 4.0 / 3.0 * radius.powi(3));
    let difference = |dt: f64| {
        let [(together, gravity), (gravity_first, _)] =
            [LangevinMode::BodyIncrements, LangevinMode::FractionalStep].map(|mode| {
                let steps = (1.0 / dt).round() as usize;
                let layer = layer(state, mode);
                ball(
                    radius as f32,
                    ViscousLaw::default(),
                    fluid,
                    layer,
                    (dt, steps),
                )
            });
        (gravity_first - together) / gravity
    };
    let [coarse, fine] = [1.0 / 240.0, 1.0 / 480.0].map(|dt| difference(dt) / dt);
    let exact = -(alpha + 0.5 * stokes) / (alpha + stokes);
    println!("{coarse} {fine} {exact} per dt, α {alpha}, c {stokes}");
    // The limit is approached linearly in dt; drag is 1 % above Stokes' at the Reynolds number of 0.02.
    assert!((coarse / exact - 1.0).abs() < 0.05, "{coarse} {exact}");
    assert!(
        (2.0 * fine - coarse - exact).abs() < 0.01 * exact.abs(),
        "{fine} {coarse} {exact}"
    );
}

/// Without turbulence the orders are two integrators of one equation, for a body whose buoyancy turns it, too: the
/// difference of the places after a third of a second is of first order in dt.
#[test]
fn a_body_that_buoyancy_turns_converges_to_the_other_order() {
    let still = TurbulenceState {
        kinetic_energy: 1.0,
        dissipation: 0.0,
    };
    let shape = SharedShape::cuboid(0.1, 0.02, 0.04);
    let hydro = HydroProperties::from_shape(shape.as_ref()).unwrap();
    let mass = 1500.0 * hydro.volume;
    let dry = DryMass {
        mass,
        center: Vector3::new(0.03, 0.004, 0.01),
        inertia: Matrix3::from_diagonal(&Vector3::new(7e-4, 4e-3, 4e-3)) * mass,
    };
    let release = BodyState {
        orientation: UnitQuaternion::from_euler_angles(0.4, 0.3, -0.2),
        ..BodyState::default()
    };
    let run = |dt: f64, mode| {
        let body = hydro.clone();
        let mut world = BodyInWorld::new(body, &dry, Fluid::WATER, &release, dt, GRAVITY).unwrap();
        world.immersion.set_turbulence(layer(still, mode));
        for _ in 0..(0.3 / dt).round() as usize {
            world.step();
        }
        let state = world.state();
        (state.position, state.orientation)
    };
    let apart = |dt: f64| {
        let (place, turn) = run(dt, LangevinMode::BodyIncrements);
        let (other_place, other_turn) = run(dt, LangevinMode::FractionalStep);
        [(place - other_place).norm(), turn.angle_to(&other_turn)]
    };
    let [coarse, fine] = [1.0 / 250.0, 1.0 / 500.0].map(apart);
    println!("{coarse:?} {fine:?} m and rad");
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        // Halving the step halves it; a fifth is left for terms of second order.
        assert!((coarse / fine / 2.0 - 1.0).abs() < 0.2, "{coarse} {fine}");
    }
    // A step's fall is ½g'dt² per step: dt times the velocity, at most, in the whole.
    assert!(fine[0] < 2e-3 && fine[1] < 0.02, "{fine:?}");
}

/// A held body goes the usual way, to the bit.
#[test]
fn held_bodies_keep_the_usual_order() {
    let state = TurbulenceState {
        kinetic_energy: 0.1,
        dissipation: 0.5,
    };
    let run = |mode, locks| {
        let mut world = PhysicsWorld::new();
        let leaf = ColliderBuilder::cuboid(0.04, 0.0005, 0.02).density(400.0);
        let body = RigidBodyBuilder::dynamic().locked_axes(locks);
        let (handle, _) = world.insert(body, leaf);
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.insert(handle, hydro);
        immersion.set_turbulence(layer(state, mode));
        for _ in 0..60 {
            immersion.step(&mut world);
        }
        *world.bodies[handle].position()
    };
    let [usual, thesis] = [LangevinMode::BodyIncrements, LangevinMode::FractionalStep];
    let locks = LockedAxes::ROTATION_LOCKED;
    assert_eq!(run(usual, locks), run(thesis, locks));
    let free = LockedAxes::empty();
    assert_ne!(run(usual, free), run(thesis, free));
}
