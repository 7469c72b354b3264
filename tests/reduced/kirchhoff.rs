//! Thesis (6.24): a body that falls through an ideal fluid and turns, so that gravity turns in its axes. Against the
//! exact fall without a fluid, against impulses that are exact with one, and against the crate's own dynamics.

use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::na::{Matrix3, Matrix6, UnitQuaternion, Vector3};
use rapier3d_immersed::rapier3d::parry::shape::SharedShape;
use rapier3d_immersed::reduced::example_systems::{ballasted_ellipsoid, kirchhoff_ellipsoid};
use rapier3d_immersed::reduced::{Axis, KirchhoffBody, QuadraticSystem, Tolerances};
use rapier3d_immersed::{DryMass, Fluid, FreeBody, HydroProperties, ImmersedBody, ViscousLaw};

const TIGHT: Tolerances = Tolerances {
    relative: 1e-12,
    absolute: 1e-12,
    max_steps: 100_000,
};

/// u, ω and γ at the end.
fn end(system: &QuadraticSystem, start: &[f64; 6], time: f64) -> [Vector3<f64>; 3] {
    let state = system.integrate(start, time, TIGHT).unwrap();
    [0, 3, 6].map(|k| Vector3::new(state[k], state[k + 1], state[k + 2]))
}

fn axis() -> Axis {
    Axis::spectral(0.0, 1.0, 3).unwrap()
}

/// Without a fluid the world sees a constant acceleration, however the body spins: |u|² = |v₀ + gt|² and
/// u·γ = (v₀ + gt)·ĝ, to the integrator's tolerance.
#[test]
fn without_a_fluid_it_falls_straight() {
    let inertia = Vector3::new(0.4, 1.1, 1.3);
    let none = [Vector3::zeros(); 2];
    let body = KirchhoffBody::symmetric(2.5, inertia, none, 0.0, Vector3::zeros());
    let gravity = Vector3::new(-1.0, 2.0, -2.0) * (9.81 / 3.0);
    let system = body.system(&axis(), gravity).unwrap();
    let start = [0.9, 0.3, -0.7, 3.0, -2.0, 4.0];
    for time in [0.3, 2.0] {
        let [u, _, down] = end(&system, &start, time);
        let world = Vector3::new(0.9, 0.3, -0.7) + gravity * time;
        assert!((u.norm() - world.norm()).abs() < 1e-8);
        assert!((u.dot(&down) - world.dot(&gravity) / 9.81).abs() < 1e-8);
        assert!((down.norm() - 1.0).abs() < 1e-9);
        // In body axes gravity has turned by far: with a fixed direction none of this would hold.
        assert!((down - gravity / 9.81).norm() > 0.3, "{down}");
    }
}

/// With a fluid the impulse of body and fluid changes by (m − ρV) g t in the world: its size and its part along
/// gravity are exact. So is the energy ½ν·𝕄ν + potential, in which the torque of the center of buoyancy works.
#[test]
fn impulse_grows_by_the_weight() {
    let body = ballasted_ellipsoid();
    let system = kirchhoff_ellipsoid(&axis()).unwrap();
    let start = [0.9, 0.3, 0.7, 0.2, 0.8, 0.6];
    let impulse = |u: &Vector3<f64>, w: &Vector3<f64>| -> Vector3<f64> {
        body.mass.fixed_view::<3, 3>(0, 0) * u + body.mass.fixed_view::<3, 3>(0, 3) * w
    };
    let [u, w] = [0, 3].map(|k| Vector3::new(start[k], start[k + 1], start[k + 2]));
    let p0 = impulse(&u, &w);
    let down0 = Vector3::new(-1.0, 2.0, -2.0) / 3.0;
    for time in [0.5, 3.0] {
        let [u, w, down] = end(&system, &start, time);
        let p = impulse(&u, &w);
        let expected = p0 + down0 * (0.1 * 9.81 * time);
        assert!((p.norm() - expected.norm()).abs() < 1e-8);
        assert!((p.dot(&down) - expected.dot(&down0)).abs() < 1e-8);
        assert!((down.norm() - 1.0).abs() < 1e-9);
    }
}

/// A ballasted ellipsoid of 3 × 2 × 1 dm in water, off its center, by the crate's own dynamics under the inviscid law
/// at 0.1 ms: body velocities, spin and the direction of gravity after 0.5 s. What remains is the step's error, of second order.
#[test]
fn it_is_the_crates_own_dynamics() {
    let semi_axes = Vector3::new(0.3, 0.2, 0.1);
    let ball = SharedShape::ball(1.0);
    let surface = Surface::from_shape(ball.as_ref()).unwrap();
    let surface = surface.map(|v| v.component_mul(&semi_axes));
    let hydro = HydroProperties::from_surface(&surface, Vector3::zeros());
    let fluid = Fluid::WATER;
    let displaced = f64::from(fluid.density()) * hydro.volume;
    let (mass, center) = (1.2 * displaced, Vector3::new(0.01, 0.02, -0.03));
    let dry = DryMass {
        mass,
        center,
        inertia: Matrix3::from_diagonal(&Vector3::new(0.010, 0.020, 0.026)) * mass,
    };
    let added = hydro.added_mass_about(center).to_matrix6() * f64::from(fluid.density());
    let mut whole: Matrix6<f64> = added;
    for i in 0..3 {
        whole[(i, i)] += mass;
        whole[(i + 3, i + 3)] += dry.inertia[(i, i)];
    }
    let kirchhoff = KirchhoffBody {
        mass: whole,
        weight: mass - displaced,
        buoyancy: (hydro.centroid - center) * displaced,
    };
    let start = [0.4, -0.3, 0.2, 1.0, -2.0, 0.5];
    let down = Vector3::new(-1.0, 2.0, -2.0) / 3.0;
    let system = kirchhoff.system(&axis(), down * 9.81).unwrap();
    let [u, w, turned] = end(&system, &start, 0.5);

    let body = ImmersedBody::new(hydro)
        .with_law(ViscousLaw::Inviscid)
        .unwrap();
    let mut body = FreeBody::new(&body, &dry, &fluid).unwrap();
    body.set_orientation(UnitQuaternion::identity());
    body.set_velocity(
        Vector3::new(start[0], start[1], start[2]),
        Vector3::new(start[3], start[4], start[5]),
    );
    for _ in 0..5000 {
        body.step(1e-4, down * 9.81);
    }
    let back = body.orientation().inverse();
    let (linear, angular) = (
        back * body.linear_velocity(),
        back * body.angular_velocity(),
    );
    println!("{u} {linear} {w} {angular}");
    assert!((linear - u).norm() < 1e-5 * u.norm(), "{linear} {u}");
    assert!((angular - w).norm() < 1e-5 * w.norm(), "{angular} {w}");
    assert!((back * down - turned).norm() < 1e-5);
}

/// What is no body is named.
#[test]
fn bad_bodies_are_errors() {
    let good = ballasted_ellipsoid();
    let gravity = Vector3::new(0.0, 0.0, -9.81);
    let refused = |body: KirchhoffBody, gravity| {
        let error = body.system(&axis(), gravity).unwrap_err();
        error.to_string()
    };
    assert!(refused(good, Vector3::zeros()).contains("gravity"));
    let mut bad = good;
    bad.mass[(0, 4)] += 0.1;
    assert!(refused(bad, gravity).contains("asymmetry"));
    bad.mass = -good.mass;
    assert!(refused(bad, gravity).contains("eigenvalue"));
    bad = good;
    bad.weight = f64::NAN;
    assert!(refused(bad, gravity).contains("weight"));
}
