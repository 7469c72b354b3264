//! A body in an ideal fluid without external forces conserves energy, world impulse and world
//! moment of impulse (Lamb, *Hydrodynamics*, chapter VI), and its planar motions have closed forms.

use crate::support::{solid_box, weightless};
use rapier3d_immersed::rapier3d::na::{UnitQuaternion, Vector3};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, FreeBody, HydroProperties, ImmersedBody, Immersion, ViscousLaw};

const SIZE: [f64; 3] = [0.2, 0.1, 0.04];

fn free_body(size: [f64; 3], density: f64) -> FreeBody {
    let (body, mass) = solid_box(size, density, ViscousLaw::Inviscid);
    let mut body = FreeBody::new(&body, &mass, &Fluid::WATER).unwrap();
    // Iterated to convergence, the scheme conserves all three at once.
    body.integrator.iterations = 8;
    body
}

#[test]
fn invariants_in_free_flight() {
    for spin in [1.0, 20.0] {
        let mut body = free_body(SIZE, 2000.0);
        body.set_orientation(UnitQuaternion::from_euler_angles(0.4, 1.0, -0.3));
        body.set_velocity(
            Vector3::new(0.3, 0.1, -0.2),
            Vector3::new(1.0, 2.0, -0.5).normalize() * spin,
        );
        let (energy, impulse, moment) =
            (body.kinetic_energy(), body.impulse(), body.impulse_moment());
        for _ in 0..10_000 {
            body.step(1e-3, Vector3::zeros());
        }
        assert!((body.kinetic_energy() / energy - 1.0).abs() < 1e-9);
        assert!((body.impulse() - impulse).norm() < 1e-9 * impulse.norm());
        assert!((body.impulse_moment() - moment).norm() < 1e-9 * moment.norm());
        // It did move: the invariants are not those of a body that stands still.
        assert!(body.position.norm() > 0.1);
    }
}

/// Planar motion of the angle φ from broadside: φ̈ = −½ω₀² sin 2φ with ω₀ = P √(Δ/J),
/// Δ = 1/M₁ − 1/M₂. The period is 4 K(sin φ₀)/ω₀, K by the arithmetic–geometric mean.
#[test]
fn pendulum_period() {
    let mut body = free_body(SIZE, 2000.0);
    let (m1, m2, j) = planar_inertia(&body);
    let omega0 = 2.0 * (1.0 / m1 - 1.0 / m2).sqrt() / j.sqrt();
    let amplitude: f64 = 1.0;
    let exact = 4.0 * elliptic_k(amplitude.sin()) / omega0;

    release_in_plane(&mut body, amplitude, 2.0, m1, m2);
    let dt = 2e-5;
    let (mut last, mut crossings, mut first, mut time) = (1.0, 0, 0.0, 0.0);
    while crossings < 3 {
        body.step(dt, Vector3::zeros());
        time += dt;
        let angle = broadside_angle(&body);
        if angle * last < 0.0 {
            let at = time - dt * angle / (angle - last);
            crossings += 1;
            if crossings == 1 {
                first = at;
            } else if crossings == 3 {
                assert!(
                    ((at - first) / exact - 1.0).abs() < 1e-6,
                    "{} {exact}",
                    at - first
                );
            }
        }
        last = angle;
    }
}

/// A golden value, computed independently: M₁ = 1.2, M₂ = 3, J = ½, P = 2, φ₀ = 1 → T = 4.17487646.
#[test]
fn period_formula_reproduces_the_golden_value() {
    let omega0 = 2.0 * ((1.0 / 1.2 - 1.0 / 3.0) / 0.5_f64).sqrt();
    let period = 4.0 * elliptic_k(1.0_f64.sin()) / omega0;
    assert!((period - 4.174_876_46).abs() < 5e-9, "{period}");
}

/// Edgewise motion is unstable and grows at the rate ω₀; broadside motion swings at ω₀.
#[test]
fn edgewise_grows_and_broadside_swings() {
    let mut body = free_body(SIZE, 2000.0);
    let (m1, m2, j) = planar_inertia(&body);
    let omega0 = 2.0 * ((1.0 / m1 - 1.0 / m2) / j).sqrt();

    // φ = π/2 − ψ with ψ = ψ₀ cosh ω₀t while it is small.
    let small = 1e-6;
    release_in_plane(&mut body, std::f64::consts::FRAC_PI_2 - small, 2.0, m1, m2);
    let deviation = |body: &FreeBody| std::f64::consts::FRAC_PI_2 - broadside_angle(body).abs();
    let dt = 1e-4;
    let steps = (6.0 / omega0 / dt) as usize;
    for _ in 0..steps {
        body.step(dt, Vector3::zeros());
    }
    let grown = (deviation(&body) / small).acosh() / (steps as f64 * dt);
    assert!((grown / omega0 - 1.0).abs() < 0.01, "{grown} {omega0}");

    let mut body = free_body(SIZE, 2000.0);
    release_in_plane(&mut body, small, 2.0, m1, m2);
    let (mut last, mut time, mut half) = (small, 0.0, None);
    let period = loop {
        body.step(dt, Vector3::zeros());
        time += dt;
        let angle = broadside_angle(&body);
        if angle * last < 0.0 {
            match half {
                None => half = Some(time),
                Some(first) => break 2.0 * (time - first),
            }
        }
        last = angle;
    };
    assert!((std::f64::consts::TAU / period / omega0 - 1.0).abs() < 0.01);
}

/// Through rapier, in f32 and from rapier's own pose and velocities.
#[test]
fn invariants_through_rapier() {
    for spin in [30., 6., 1.0] {
        let mut world = weightless();
        world.integration_parameters.dt = 1.0 / 240.0;
        let half = SIZE.map(|x| (x / 2.0) as Real);
        let (handle, _) = world.insert(
            RigidBodyBuilder::dynamic()
                .linvel(Vector::new(0.3, 0.1, -0.2))
                .angvel(Vector::new(1.0, 2.0, -0.5).normalize() * spin),
            ColliderBuilder::cuboid(half[0], half[1], half[2]).density(2000.0),
        );
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
        let body = ImmersedBody::new(hydro)
            .with_law(ViscousLaw::Inviscid)
            .unwrap();
        let (_, mass) = solid_box(SIZE, 2000.0, ViscousLaw::Inviscid);
        // A twin in f64 only evaluates the invariants at rapier's state.
        let mut twin = FreeBody::new(&body, &mass, &Fluid::WATER).unwrap();
        let mut invariants = |world: &PhysicsWorld| {
            let body = &world.bodies[handle];
            let [v, w] = [body.linvel(), body.angvel()].map(vector);
            let q = body.rotation();
            twin.position = vector(body.center_of_mass());
            twin.set_orientation(UnitQuaternion::from_quaternion(
                rapier3d_immersed::rapier3d::na::Quaternion::new(
                    q.w.into(),
                    q.x.into(),
                    q.y.into(),
                    q.z.into(),
                ),
            ));
            twin.set_velocity(v, w);
            (twin.kinetic_energy(), twin.impulse(), twin.impulse_moment())
        };
        let mut immersion = Immersion::new(Fluid::WATER);
        immersion.insert(handle, body);
        let (energy, impulse, moment) = invariants(&world);
        let mut worst = [0.0_f64; 3];
        for _ in 0..2400 {
            immersion.step(&mut world);
            let (e, p, l) = invariants(&world);
            let errors = [
                (e / energy - 1.0).abs(),
                (p - impulse).norm() / impulse.norm(),
                // The moment about the origin is a small difference once the body is far from it.
                (l - moment).norm()
                    / (moment.norm()
                        + world.bodies[handle].translation().length() as f64 * p.norm()),
            ];
            worst = std::array::from_fn(|i| worst[i].max(errors[i]));
        }
        eprintln!("{spin} {worst:?}");
        assert!(
            worst.iter().all(|error| *error < 1e-4),
            "spin {spin}: {worst:?}"
        );
    }
}

fn vector(v: Vector) -> Vector3<f64> {
    Vector3::new(v.x.into(), v.y.into(), v.z.into())
}

/// M₁ (along the longest axis), M₂ (along the shortest) and J (about the middle one), from the
/// kinetic energies of unit motions.
fn planar_inertia(body: &FreeBody) -> (f64, f64, f64) {
    let mut probe = body.clone();
    let mut twice_energy = |linear, angular| {
        probe.set_velocity(linear, angular);
        2.0 * probe.kinetic_energy()
    };
    (
        twice_energy(Vector3::x(), Vector3::zeros()),
        twice_energy(Vector3::z(), Vector3::zeros()),
        twice_energy(Vector3::zeros(), Vector3::y()),
    )
}

/// World impulse `p` along z, the plate normal turned by `angle` from it about y, no spin.
fn release_in_plane(body: &mut FreeBody, angle: f64, p: f64, m1: f64, m2: f64) {
    body.set_orientation(UnitQuaternion::from_axis_angle(&Vector3::y_axis(), angle));
    let (sin, cos) = angle.sin_cos();
    // Impulse in body axes is (−p sin, 0, p cos).
    let u = Vector3::new(-p * sin / m1, 0.0, p * cos / m2);
    body.set_velocity(body.orientation() * u, Vector3::zeros());
}

fn broadside_angle(body: &FreeBody) -> f64 {
    let n = body.normal();
    n.x.atan2(n.z)
}

/// Complete elliptic integral of the first kind by the arithmetic–geometric mean.
fn elliptic_k(modulus: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - modulus * modulus).sqrt());
    while (a - b).abs() > 1e-15 {
        (a, b) = ((a + b) / 2.0, (a * b).sqrt());
    }
    std::f64::consts::PI / (2.0 * a)
}
