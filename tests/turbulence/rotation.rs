//! The stochastic method's law resists rotation as its drag does, so that the thesis's increments of the spin stay bounded.

use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::turbulence::{
    LangevinMode, Turbulence, TurbulenceState, TurbulentLayer, kolmogorov_constant,
};
use rapier3d_immersed::{
    DryMass, Fluid, FreeBody, HydroProperties, ImmersedBody, Immersion, StochasticLaw, ViscousLaw,
};

/// Half extents of a plate along its axes, m: x longest, z normal.
const HALF: [f64; 3] = [0.04, 0.01, 1e-4];

/// Torque of −½ρC_d|v|v per area at v = u + ω × r, over a grid of middles on the plate, N·m.
fn by_elements(u: &Vector3<f64>, w: &Vector3<f64>, pressure: f64) -> Vector3<f64> {
    let n = 400;
    let area = 4.0 * HALF[0] * HALF[1] / f64::from(n * n);
    let middle = |i: i32, half: f64| half * ((2.0 * f64::from(i) + 1.0) / f64::from(n) - 1.0);
    let mut torque = Vector3::zeros();
    for i in 0..n {
        for j in 0..n {
            let r = Vector3::new(middle(i, HALF[0]), middle(j, HALF[1]), 0.0);
            let v = u + w.cross(&r);
            torque -= r.cross(&v) * (v.norm() * pressure * area);
        }
    }
    torque
}

/// The damping is the drag of the plate's elements: exactly, for slow and for fast rotation about an axis in the plate;
/// within a tenth in between. About the normal the elements are taken at the radius of gyration r, which is exact for
/// slow rotation, and Ar³ for the integral of the cubes, a fifth less, for fast.
#[test]
fn damping_is_the_drag_of_the_elements() {
    let [x, y, z] = HALF.map(|half| half as f32);
    let hydro = HydroProperties::from_shape(&Cuboid::new(Vector::new(x, y, z))).unwrap();
    let law = |damping| StochasticLaw {
        drag: 1.3,
        lift: 0.0,
        arm: 0.0,
        damping,
    };
    let mass = 800.0 * hydro.volume;
    let dry = DryMass {
        mass,
        center: Vector3::zeros(),
        inertia: rapier3d_immersed::rapier3d::na::Matrix3::identity() * (mass * 1e-4),
    };
    let found = |damping: f64, u: &Vector3<f64>, w: &Vector3<f64>| {
        let body = ImmersedBody::new(hydro.clone())
            .with_law(ViscousLaw::Stochastic(law(damping)))
            .unwrap();
        let mut body = FreeBody::new(&body, &dry, &Fluid::AIR).unwrap();
        body.set_velocity(*u, *w);
        let torque = body.forces(Vector3::zeros()).damping.torque;
        Vector3::new(torque.x, torque.y, torque.z).map(f64::from)
    };
    let pressure = 0.5 * f64::from(Fluid::AIR.density()) * 1.3;
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let speeds = [
        Vector3::new(0.6, -0.3, 0.9),
        Vector3::new(0.0, 0.0, 1.2),
        Vector3::new(-0.7, 0.9, 0.0),
    ];
    for (i, axis) in axes.iter().enumerate() {
        for u in &speeds {
            for (spin, below, above) in [(0.01, 1e-3, 1e-3), (30.0, 0.1, 0.1), (100.0, 0.1, 0.1)] {
                let w = axis * spin;
                let exact = by_elements(u, &w, pressure)[i];
                let ratio = found(1.0, u, &w)[i] / exact;
                println!("axis {i}, {u:?}, {spin}: {ratio}");
                let below = if i == 2 && spin > 1.0 { 0.25 } else { below };
                assert!(
                    (1.0 - below..1.0 + above).contains(&ratio),
                    "{i} {u} {spin}: {ratio}"
                );
            }
        }
        let (u, w) = (Vector3::zeros(), axis * 70.0);
        let mut exact = by_elements(&u, &w, pressure)[i];
        if i == 2 {
            let gyration = ((HALF[0].powi(2) + HALF[1].powi(2)) / 3.0).sqrt();
            let of_gyration = -4.0 * HALF[0] * HALF[1] * pressure * gyration.powi(3) * w.z.powi(2);
            assert!((0.75..0.85).contains(&(of_gyration / exact)));
            exact = of_gyration;
        }
        let ratio = found(1.0, &u, &w)[i] / exact;
        println!("axis {i}, at rest: {ratio}");
        assert!((ratio - 1.0).abs() < 1e-4, "{i}: {ratio}");
        assert!((found(0.4, &u, &w) - found(1.0, &u, &w) * 0.4).norm() < 1e-9);
        assert_eq!(found(0.0, &speeds[0], &w), Vector3::zeros());
    }
}

const RADIUS: f64 = 0.1;
const DENSITY: f64 = 20.0;
const STATE: TurbulenceState = TurbulenceState {
    kinetic_energy: 1.0,
    dissipation: 5.0,
};

/// Squares of the spins of many balls in the thesis's turbulence, about the axes in the planform and about its normal,
/// in the mean of three instants, rad²/s². The balls are held in their place by setting their velocity back, so that
/// rotation alone is damped.
fn spins(damping: f64, [from, every]: [usize; 2]) -> ([f64; 2], usize) {
    let mut world = PhysicsWorld::new();
    world.gravity = Vector::ZERO;
    world.integration_parameters.dt = 1.0 / 240.0;
    let ball = ColliderBuilder::ball(RADIUS as f32).density(DENSITY as f32);
    let handles: Vec<_> = (0..400)
        .map(|i| {
            let body = RigidBodyBuilder::dynamic().translation(Vector::X * (10.0 * i as f32));
            world.insert(body, ball.clone()).0
        })
        .collect();
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handles[0]).unwrap();
    let axes = hydro.planform.axes;
    let law = StochasticLaw {
        lift: 0.0,
        arm: 0.0,
        damping,
        ..StochasticLaw::default()
    };
    let body = ImmersedBody::new(hydro)
        .with_law(ViscousLaw::Stochastic(law))
        .unwrap();
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.insert_all(handles.iter().copied(), body);
    immersion.set_turbulence(TurbulentLayer {
        mode: LangevinMode::BodyIncrements,
        seed: 31,
        ..Turbulence::Homogeneous(STATE).into()
    });
    let mut sums = [0.0; 2];
    for step in 1..=from + 2 * every {
        immersion.step(&mut world);
        for handle in &handles {
            let body = &mut world.bodies[*handle];
            body.set_linvel(Vector::ZERO, true);
            if step >= from && (step - from).is_multiple_of(every) {
                let spin = body.rotation().inverse() * body.angvel();
                let spin = Vector3::new(spin.x, spin.y, spin.z).map(f64::from);
                let spin = axes.inverse() * spin;
                sums[0] += spin.xy().norm_squared();
                sums[1] += spin.z * spin.z;
            }
        }
    }
    let count = 3 * handles.len();
    (sums.map(|sum| sum / count as f64), count)
}

/// I dω = −κ|ω|ω dt + I D dW with D = √(C₀ε)/L has the stationary density exp(−2κ|ω|³/(3ID²)) (Fokker & Planck), in one
/// dimension about the normal and in two about the axes in the planform. With x = 3ID²/2κ the mean squares are
/// x^⅔ Γ(1)/Γ(⅓) and x^⅔ Γ(4/3)/Γ(⅔). Without the damping it grows as D²t per axis.
#[test]
fn spin_in_strong_turbulence_is_bounded_with_the_variance_of_theory() {
    let viscosity = Fluid::AIR.kinematic_viscosity();
    let c0 = f64::from(kolmogorov_constant(
        STATE.taylor_reynolds_squared(viscosity),
    ));
    let diffusion = c0 * f64::from(STATE.dissipation) / RADIUS.powi(2);
    let inertia = 0.4 * DENSITY * 4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(5);
    let pressure = 0.5 * f64::from(Fluid::AIR.density()) * StochasticLaw::default().drag;
    // ∫|d|³dA of a disc from a diameter, and its area times the cube of its radius of gyration a/√2.
    let in_plane = pressure * 8.0 / 15.0 * RADIUS.powi(5);
    let normal = pressure * std::f64::consts::PI * 0.5f64.powf(1.5) * RADIUS.powi(5);
    let scale = |kappa: f64| (1.5 * inertia * diffusion / kappa).powf(2.0 / 3.0);
    let theory = [
        scale(in_plane) * 0.892_979_5 / 1.354_117_9,
        scale(normal) / 2.678_938_5,
    ];
    // The memory I/(κω) is a second.
    let (found, count) = spins(1.0, [1200, 300]);
    println!("{found:?} {theory:?}");
    // ⟨ω⁴⟩/⟨ω²⟩² is Γ(⅔)/Γ(4/3)² = 1.70 in two dimensions and Γ(5/3)Γ(⅓) = 2.42 in one. A percent is left for the
    // polyhedron that the ball is, and for the increment of the velocity, a tenth of ωL, which damps a little, too.
    for ((found, theory), spread) in found.into_iter().zip(theory).zip([0.698f64, 1.418]) {
        let error = (spread / count as f64).sqrt();
        assert!(
            (found / theory - 1.0).abs() < 3.0 * error + 0.01,
            "{found} {theory} ± {error}"
        );
    }
    let (undamped, count) = spins(0.0, [600, 1]);
    let grown = diffusion * 601.0 / 240.0;
    for (found, axes) in undamped.into_iter().zip([2.0, 1.0]) {
        // The three instants are one after another: a third of the values count.
        let error = (2.0 / axes / (count as f64 / 3.0)).sqrt();
        assert!(
            (found / axes / grown - 1.0).abs() < 3.0 * error,
            "{found} {grown} ± {error}"
        );
    }
}
