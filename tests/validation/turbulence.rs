//! Bodies in turbulence: what theory says of their velocities, whatever the time step.

use crate::support::weightless;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::turbulence::{
    LangevinMode, Turbulence, TurbulenceState, TurbulentLayer, kolmogorov_constant,
};
use rapier3d_immersed::{Fluid, HydroProperties, ImmersedBody, Immersion, ViscousLaw};

/// ⅔k = ⅔, memory of a tracer 1/(¾ C₀ χ) ≈ .48 s in the fluid below.
const STATE: TurbulenceState = TurbulenceState {
    kinetic_energy: 1.0,
    dissipation: 5.0,
};
const RADIUS: f32 = 0.01;

/// So viscous that a sphere of 1 cm obeys Stokes' law at 1 m/s.
fn syrup() -> Fluid {
    Fluid::new(1.0, 0.1).unwrap()
}

fn c0() -> f32 {
    kolmogorov_constant(STATE.taylor_reynolds_squared(syrup().kinematic_viscosity()))
}

/// Spheres far apart, of `density` (kg/m³, the fluid's is 1).
fn spheres(
    count: usize,
    density: f32,
    dt: f32,
    layer: TurbulentLayer,
) -> (PhysicsWorld, Immersion) {
    let mut world = weightless();
    world.integration_parameters.dt = dt;
    let ball = ColliderBuilder::ball(RADIUS).density(density);
    let handles: Vec<_> = (0..count)
        .map(|i| {
            let body = RigidBodyBuilder::dynamic().translation(Vector::X * (10.0 * i as f32));
            world.insert(body, ball.clone()).0
        })
        .collect();
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handles[0]).unwrap();
    let mut immersion = Immersion::new(syrup());
    immersion.insert_all(handles, hydro);
    immersion.set_turbulence(layer);
    (world, immersion)
}

fn layer(seed: u64) -> TurbulentLayer {
    TurbulentLayer {
        seed,
        ..Turbulence::Homogeneous(STATE).into()
    }
}

/// Variance of a velocity component over all bodies, and its standard error, after `seconds`.
fn variance(world: &mut PhysicsWorld, immersion: &mut Immersion, seconds: f32) -> (f64, f64) {
    let steps = (seconds / world.integration_parameters.dt).round() as usize;
    for _ in 0..steps {
        immersion.step(world);
    }
    let components = world
        .bodies
        .iter()
        .flat_map(|(_, body)| body.linvel().to_array());
    let squares: Vec<f64> = components.map(|v| f64::from(v).powi(2)).collect();
    let n = squares.len() as f64;
    let mean = squares.iter().sum::<f64>() / n;
    (mean, mean * (2.0 / n).sqrt())
}

/// A neutrally buoyant sphere is a tracer: ⟨v²⟩ = ⅔k, at coarse and at fine steps.
#[test]
fn a_tracer_moves_as_the_fluid() {
    for (seed, dt) in [(1, 1.0 / 20.0), (2, 1.0 / 240.0)] {
        let (mut world, mut immersion) = spheres(400, 1.0, dt, layer(seed));
        let (found, error) = variance(&mut world, &mut immersion, 2.0);
        assert!(
            (found - 2.0 / 3.0).abs() < 3.0 * error,
            "{dt}: {found} ± {error}"
        );
    }
}

/// A heavy sphere filters: its variance is that of Stokes' law driven by the same process, integrated
/// here in small steps by Euler's rule with random numbers of its own.
#[test]
fn a_heavy_body_filters() {
    let density = 2250.0;
    // Relaxation time (ρ_s + ρ/2) V/(6πρν r): half a second.
    let relaxation = f64::from((density + 0.5) * 4.0 / 3.0 * RADIUS * RADIUS / (6.0 * 0.1));
    let (mut world, mut immersion) = spheres(400, density, 1.0 / 60.0, layer(3));
    let (found, error) = variance(&mut world, &mut immersion, 5.0);

    let rate = 0.75 * f64::from(c0() * STATE.turnover_rate());
    let sigma = (2.0f64 / 3.0).sqrt();
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
    let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
    let (n, dt) = (1000, 2e-3);
    let mut sum = 0.0;
    for _ in 0..n {
        let mut u = [normal(), normal(), normal()].map(|x| x * sigma);
        let (mut v, mut slip) = ([0.0; 3], [0.0f64; 3]);
        for _ in 0..2500 {
            // The memory follows the slip, averaged over ten memories of a tracer.
            let slip2: f64 = slip.iter().map(|s| s * s).sum();
            let tracer = rate;
            let rate = rate * (1.0 + slip2 / (sigma * sigma)).sqrt();
            for i in 0..3 {
                slip[i] += (v[i] - u[i] - slip[i]) * tracer * dt / 10.0;
                v[i] += (u[i] - v[i]) * dt / relaxation;
                u[i] += -u[i] * rate * dt + sigma * (2.0 * rate * dt).sqrt() * normal();
            }
        }
        sum += v.iter().map(|v| v * v).sum::<f64>() / 3.0;
    }
    let theory = sum / f64::from(n);
    let error = error.hypot(theory * (2.0 / (3.0 * f64::from(n))).sqrt());
    assert!(
        (found - theory).abs() < 3.0 * error,
        "{found} {theory} ± {error}"
    );
    assert!(found < 0.6 * 2.0 / 3.0, "{found}");
}

/// The thesis's mode, without other forces: the body's own velocity is the process, with variance
/// (⅔k) C₀/(C₀ + ⅔), whatever its mass; its spin gains C₀ε dt/L² per step.
#[test]
fn increments_have_the_variance_of_the_thesis() {
    let layer = |seed| TurbulentLayer {
        source: Turbulence::Homogeneous(STATE),
        mode: LangevinMode::BodyIncrements,
        seed,
    };
    for (seed, density, dt) in [(5, 100.0, 1.0 / 20.0), (6, 3.0, 1.0 / 240.0)] {
        let mut world = weightless();
        world.integration_parameters.dt = dt;
        let mut immersion = Immersion::new(syrup());
        let handles: Vec<_> = (0..400)
            .map(|i| {
                let body = RigidBodyBuilder::dynamic().translation(Vector::X * (10.0 * i as f32));
                let ball = ColliderBuilder::ball(RADIUS).density(density);
                world.insert(body, ball).0
            })
            .collect();
        let hydro =
            HydroProperties::from_body(&world.bodies, &world.colliders, handles[0]).unwrap();
        let body = ImmersedBody::new(hydro)
            .with_law(ViscousLaw::Inviscid)
            .unwrap();
        immersion.insert_all(handles, body);
        immersion.set_turbulence(layer(seed));
        let seconds = 2.0;
        let (found, error) = variance(&mut world, &mut immersion, seconds);
        let c0 = f64::from(c0());
        let theory = 2.0 / 3.0 * c0 / (c0 + 2.0 / 3.0);
        assert!(
            (found - theory).abs() < 3.0 * error,
            "{dt}: {found} {theory} ± {error}"
        );

        let spins = world
            .bodies
            .iter()
            .flat_map(|(_, body)| body.angvel().to_array());
        let spins: Vec<f64> = spins.map(|w| f64::from(w).powi(2)).collect();
        let found = spins.iter().sum::<f64>() / spins.len() as f64;
        let length = f64::from(RADIUS);
        let theory = c0 * f64::from(STATE.dissipation) * f64::from(seconds) / (length * length);
        let error = theory * (2.0 / spins.len() as f64).sqrt();
        assert!(
            (found - theory).abs() < 3.0 * error,
            "{dt}: {found} {theory} ± {error}"
        );
    }
}

/// Decaying turbulence: the tracer's variance follows ⅔k (k₀ = ε₀ = 1: .32156 after 2 s).
#[test]
fn a_tracer_calms_down_with_the_turbulence() {
    let initial = TurbulenceState {
        kinetic_energy: 1.0,
        dissipation: 1.0,
    };
    let decaying = TurbulentLayer {
        seed: 9,
        ..Turbulence::Decaying { initial }.into()
    };
    let (mut world, mut immersion) = spheres(400, 1.0, 1.0 / 60.0, decaying);
    let (found, error) = variance(&mut world, &mut immersion, 2.0);
    let theory = 2.0 / 3.0 * 0.32156;
    assert!(
        (found - theory).abs() < 3.0 * error,
        "{found} {theory} ± {error}"
    );
}

/// The same seed gives the same bits, another one others; and turbulence that ends leaves no trace.
#[test]
fn the_seed_decides() {
    let run = |seed| {
        let (mut world, mut immersion) = spheres(5, 10.0, 1.0 / 60.0, layer(seed));
        for _ in 0..50 {
            immersion.step(&mut world);
        }
        let stirred: Vec<_> = world.bodies.iter().map(|(_, b)| b.linvel()).collect();
        immersion.clear_turbulence();
        for _ in 0..600 {
            immersion.step(&mut world);
        }
        assert!(world.bodies.iter().all(|(_, b)| b.linvel().length() < 1e-3));
        stirred
    };
    assert_eq!(run(1), run(1));
    assert_ne!(run(1), run(2));
}

/// Wild turbulence reaches rapier as finite numbers.
#[test]
fn any_turbulence_is_survived() {
    let values = [0.0, 1e-30, 1e-6, 1.0, 1e6, f32::MAX];
    for (kinetic_energy, dissipation) in values
        .into_iter()
        .flat_map(|k| values.map(|epsilon| (k, epsilon)))
    {
        for mode in [LangevinMode::FluidSeen, LangevinMode::BodyIncrements] {
            let layer = TurbulentLayer {
                source: Turbulence::Homogeneous(TurbulenceState {
                    kinetic_energy,
                    dissipation,
                }),
                mode,
                seed: 1,
            };
            let (mut world, mut immersion) = spheres(3, 100.0, 1.0 / 60.0, layer);
            for _ in 0..20 {
                immersion.step(&mut world);
            }
            for (_, body) in world.bodies.iter() {
                let finite = body.linvel().is_finite()
                    && body.angvel().is_finite()
                    && body.translation().is_finite();
                assert!(finite, "{kinetic_energy} {dissipation} {mode:?}");
            }
        }
    }
}

/// The read-out names the fluctuation's share: in still air without it there is none.
#[test]
fn the_readout_shows_turbulence() {
    let (mut world, mut immersion) = spheres(1, 100.0, 1.0 / 60.0, layer(4));
    for _ in 0..10 {
        immersion.step(&mut world);
    }
    let (handle, _) = world.bodies.iter().next().unwrap();
    let forces = immersion.forces(&world.bodies, handle).unwrap();
    assert!(forces.turbulence.force.length() > 0.0);
    // Stokes' law is linear: drag of the body in still fluid, plus that of the fluctuation.
    let v = world.bodies[handle].linvel();
    assert!(forces.drag.force.dot(v) < 0.0);
    immersion.clear_turbulence();
    let forces = immersion.forces(&world.bodies, handle).unwrap();
    assert_eq!(forces.turbulence.force, Vector::ZERO);
}
