//! Suspensions beside exact solutions, and beside the whole law of a small sphere.

use rapier3d_immersed::flow::{Flow, FlowSample, Shear, Uniform, Vortex};
use rapier3d_immersed::playback::{Particle, Suspension};
use rapier3d_immersed::rapier3d::na::{Matrix3, UnitQuaternion, Vector3};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::turbulence::{Turbulence, TurbulenceState, kolmogorov_constant};
use rapier3d_immersed::{DryMass, Fluid, FreeBody, HydroProperties, ImmersedBody, Layer};

const DOWN: Vector = Vector::new(0.0, -9.81, 0.0);

/// One particle that is let go in a layer.
fn one(layer: impl Into<Layer>, particle: Particle, at: Vector) -> Suspension {
    let mut suspension = Suspension::new(layer, particle).unwrap();
    suspension.insert(at, Vector::ZERO);
    suspension
}

/// The same sphere under the whole law.
fn whole(diameter: f64, density: f64, fluid: &Fluid) -> FreeBody {
    let ball = SharedShape::ball(0.5 * diameter as f32);
    let hydro = HydroProperties::from_shape(ball.as_ref()).unwrap();
    let mass = density * hydro.volume;
    let dry = DryMass {
        mass,
        center: Vector3::zeros(),
        inertia: Matrix3::identity() * (0.1 * mass * diameter * diameter),
    };
    FreeBody::new(&ImmersedBody::new(hydro), &dry, fluid).unwrap()
}

/// Dust, fine snow and grains of sand fall as under the whole law, which has the same published drag (Schiller and
/// Naumann's; Clift and Gauvin's second term is 10⁻⁴ of it here): within what single precision leaves of a sphere's mesh.
#[test]
fn spheres_settle_as_under_the_whole_law() {
    for (diameter, density, fluid) in [
        (30e-6, 2650.0, Fluid::AIR),
        (0.3e-3, 200.0, Fluid::AIR),
        (0.15e-3, 2650.0, Fluid::WATER),
        (0.2e-3, 100.0, Fluid::WATER),
    ] {
        let particle = Particle::sphere(diameter, density).unwrap();
        let (time, speed) = (
            particle.relaxation_time(&fluid),
            particle.settling_speed(&fluid, 9.81),
        );
        let mut suspension = one(fluid, particle, Vector::ZERO);
        let settling = suspension.settling_velocity(DOWN);
        assert!((f64::from(settling.y) / -speed - 1.0).abs() < 1e-5);
        let mut body = whole(diameter, density, &fluid);
        // Each step takes the drag of its beginning: some steps, until that is the end's.
        for _ in 0..60 {
            suspension.step(4.0 * time as f32, DOWN);
            body.step(4.0 * time, Vector3::y() * -9.81);
        }
        let ours = f64::from(suspension.particles()[0].velocity.y);
        let law = body.linear_velocity().y;
        let re = particle.reynolds_at(&fluid, speed.abs());
        println!("Re {re:.3}: {ours:.6} m/s, whole law {law:.6}, relaxes in {time:.2e} s");
        assert!((ours / -speed - 1.0).abs() < 1e-5);
        assert!((ours / law - 1.0).abs() < 2e-3, "{ours} {law}");
    }
}

/// In creeping flow a release from rest has velocity w(1 − e^(−t/τ)) and way w(t − τ(1 − e^(−t/τ))): after one step of
/// any length, and after many; and so it does under the whole law in small steps.
#[test]
fn the_relaxation_is_exact_in_one_step() {
    // So viscous that the drag is Stokes's alone.
    let fluid = Fluid::new(1000.0, 10.0).unwrap();
    let particle = Particle::sphere(0.01, 3000.0).unwrap();
    let tau = particle.relaxation_time(&fluid);
    let speed = particle.settling_speed(&fluid, 9.81);
    assert!(particle.reynolds_at(&fluid, speed) < 2e-8);
    for (t, steps) in [(0.01 * tau, 1), (tau, 1), (tau, 50), (30.0 * tau, 1)] {
        let mut suspension = one(fluid, particle, Vector::ZERO);
        for _ in 0..steps {
            suspension.step((t / f64::from(steps)) as f32, DOWN);
        }
        let found = suspension.particles()[0];
        let gone = -(-t / tau).exp_m1();
        let (velocity, way) = (-speed * gone, -speed * (t - tau * gone));
        assert!(
            (f64::from(found.velocity.y) / velocity - 1.0).abs() < 1e-5,
            "{t} {steps}"
        );
        // The way of a short step is the difference of two that are a hundred times as long.
        let tolerance = 1e-5 * (1.0 + tau / t);
        assert!(
            (f64::from(found.position.y) / way - 1.0).abs() < tolerance,
            "{t} {steps}"
        );
    }
    let mut body = whole(0.01, 3000.0, &fluid);
    for _ in 0..1000 {
        body.step(tau / 1000.0, Vector3::y() * -9.81);
    }
    let exact = -speed * -(-1.0f64).exp_m1();
    assert!(
        (body.linear_velocity().y / exact - 1.0).abs() < 3e-3,
        "{} {exact}",
        body.linear_velocity()
    );
}

/// A grain that sinks through a shear flow u = γy is left behind by (1 − b)γw τ(1 − e^(−t/τ)), where b is the share of the
/// flow's acceleration that carries it: exact at any step, and so it drifts under the whole law.
#[test]
fn drift_in_shear() {
    let fluid = Fluid::new(1000.0, 1e-2).unwrap();
    let (diameter, density, rate) = (2e-3, 3000.0, 5.0);
    let particle = Particle::sphere(diameter, density).unwrap();
    let tau = particle.relaxation_time(&fluid);
    let speed = particle.settling_speed(&fluid, 9.81);
    let shear = Shear {
        across: Vector::Y,
        rate: Vector::X * rate as f32,
        ..Shear::default()
    };
    // From its terminal velocity on.
    let drift = |dt: f64, steps: usize| {
        let layer = Layer::new(fluid).with_flow(shear);
        let mut suspension = Suspension::new(layer, particle).unwrap();
        suspension.insert(Vector::ZERO, suspension.settling_velocity(DOWN));
        for _ in 0..steps {
            suspension.step(dt as f32, DOWN);
        }
        let found = suspension.particles()[0].position;
        [f64::from(found.x), f64::from(found.y)]
    };
    let carried = 1.5 * 1000.0 / (density + 500.0);
    let t = 20.0 * tau;
    let fluid_way = -0.5 * rate * speed * t * t;
    let behind = (1.0 - carried) * rate * speed * tau * (t - tau * -(-t / tau).exp_m1());
    let exact = fluid_way + behind;
    assert!(
        behind > 0.05 * exact.abs(),
        "the lag shows: {behind} {exact}"
    );
    for steps in [4, 40, 400] {
        let [x, y] = drift(t / steps as f64, steps);
        println!("{steps} steps: {x:.6e} and {y:.6e} m; exact {exact:.6e}");
        // The drag over Stokes's is that of Re = 10⁻³.
        assert!((x / exact - 1.0).abs() < 1e-3, "{steps}: {x} {exact}");
        assert!((y / (-speed * t) - 1.0).abs() < 1e-4, "{y}");
    }
    let mut body = whole(diameter, density, &fluid);
    body.set_velocity(Vector3::y() * -speed, Vector3::zeros());
    for step in 0..2000 {
        let at = body.position.map(|x| x as f32);
        let at = Vector::new(at.x, at.y, at.z);
        let flow = FlowSample {
            velocity: shear.velocity(at, f64::from(step)),
            ..FlowSample::default()
        };
        body.step_in(t / 2000.0, Vector3::y() * -9.81, &flow);
    }
    println!("the whole law drifts by {:.6e} m", body.position.x);
    assert!(
        (body.position.x / exact - 1.0).abs() < 5e-3,
        "{} {exact}",
        body.position
    );
}

/// A particle as heavy as the fluid goes around with it, with an error of second order in dt.
#[test]
fn tracers_go_with_the_fluid() {
    let fluid = Fluid::WATER;
    let tracer = Particle::sphere(50e-6, fluid.density().into()).unwrap();
    let vortex = Vortex::new(Vector::ZERO, Vector::Y, 1.0, 10.0).unwrap();
    // Nearly rigid rotation at Γ/(2πr_c²) inside of the core.
    let period = (std::f64::consts::TAU.powi(2) * 100.0) as f32;
    let miss = |steps: u32| {
        let layer = Layer::new(fluid).with_flow(vortex);
        let mut suspension = one(layer, tracer, Vector::X * 0.2);
        for _ in 0..steps {
            suspension.step(period / steps as f32, DOWN);
        }
        let found = suspension.particles()[0];
        (found.position - Vector::X * 0.2).length()
    };
    let [coarse, fine] = [40, 80].map(miss);
    println!("after a turn {coarse} m and {fine} m off");
    assert!((3.5..4.5).contains(&(coarse / fine)), "{coarse} {fine}");
    assert!(fine < 0.01);
}

/// In homogeneous turbulence a tracer's velocity has the variance ⅔k per component, exactly; what is heavy filters it, by
/// T/(T + τ) with the memory T of what it sees (Tchen 1947), which is at most a tracer's and at least that of its largest slip.
#[test]
fn turbulence_moves_tracers_whole_and_heavy_ones_less() {
    let (k, epsilon) = (0.15f32, 0.6f32);
    let state = TurbulenceState {
        kinetic_energy: k,
        dissipation: epsilon,
    };
    let fluid = Fluid::AIR;
    let c0 = kolmogorov_constant(state.taylor_reynolds_squared(fluid.kinematic_viscosity()));
    let memory = f64::from(k / (0.75 * c0 * epsilon));
    let variance = |particle: Particle| {
        let layer = Layer::new(fluid).with_turbulence(Turbulence::Homogeneous(state));
        let mut suspension = Suspension::new(layer, particle).unwrap();
        for _ in 0..2000 {
            suspension.insert(Vector::ZERO, Vector::ZERO);
        }
        let (mut sum, mut count) = (0.0, 0);
        for step in 0..300 {
            suspension.step((0.2 * memory) as f32, Vector::ZERO);
            if step >= 50 && step % 10 == 0 {
                let all = suspension.particles().iter();
                sum += all
                    .map(|p| f64::from(p.velocity.length_squared()) / 3.0)
                    .sum::<f64>();
                count += suspension.particles().len();
            }
        }
        sum / f64::from(count as u32) / (2.0 / 3.0 * f64::from(k))
    };
    // 2000 particles of 3 components at 25 times that are two memories apart: 150,000 values, of which a mean square is √(2/150000) off.
    let tracer = variance(Particle::sphere(20e-6, fluid.density().into()).unwrap());
    assert!((tracer - 1.0).abs() < 0.015, "{tracer}");
    let heavy = Particle::sphere(60e-6, 4000.0).unwrap();
    let tau = heavy.relaxation_time(&fluid);
    let low = memory / 2.0 / (memory / 2.0 + tau);
    let high = memory / (memory + tau);
    let found = variance(heavy);
    println!(
        "τ/T {:.3}: {found:.4} between {low:.4} and {high:.4}; tracer {tracer:.4}",
        tau / memory
    );
    assert!((low..high).contains(&found), "{low} {found} {high}");
}

/// Steps of any length are stable, and particles settle where their way ends, on the floor and on a ball over it.
#[test]
fn particles_settle_on_what_they_meet() {
    let mut world = PhysicsWorld::new();
    let floor = ColliderBuilder::cuboid(50.0, 0.1, 50.0).translation(Vector::Y * -0.1);
    world.insert(RigidBodyBuilder::fixed(), floor);
    world.insert(RigidBodyBuilder::fixed(), ColliderBuilder::ball(0.5));
    world.step();
    let flake = Particle::sphere(0.3e-3, 200.0).unwrap();
    for dt in [1.0 / 60.0, 0.5, 20.0] {
        let layer = Layer::new(Fluid::AIR).with_flow(Uniform::new(0.1, 0.0, 0.0));
        let mut snow = Suspension::new(layer, flake).unwrap();
        let falling = snow.settling_velocity(DOWN);
        snow.insert(Vector::new(-0.3, 1.0, 0.0), falling);
        snow.insert(Vector::new(5.0, 1.0, 0.0), falling);
        for _ in 0..(8.0 / dt).ceil() as u32 {
            snow.step_in_world(dt, &world);
        }
        let [on_ball, on_floor] = [0, 1].map(|i| snow.particles()[i]);
        assert!(on_ball.settled && on_floor.settled);
        assert_eq!(on_ball.velocity, Vector::ZERO);
        assert!(
            (on_ball.position.length() - 0.5).abs() < 1e-3,
            "{}",
            on_ball.position
        );
        assert!(on_floor.position.y.abs() < 1e-4, "{}", on_floor.position);
        let way = on_floor.position.x - 5.0;
        assert!((way / (0.1 / -falling.y) - 1.0).abs() < 1e-3, "{dt}: {way}");
        snow.retain(|flake| flake.position.x > 1.0);
        assert_eq!(
            snow.particles()
                .iter()
                .map(|flake| flake.number)
                .collect::<Vec<_>>(),
            [1]
        );
    }
}

/// A body in all attitudes alike settles at the mean of its three: as plates do in creeping flow, in which they keep theirs.
#[test]
fn a_plate_has_the_mean_mobility_of_its_attitudes() {
    let fluid = Fluid::new(1000.0, 1.0).unwrap();
    let shape = SharedShape::cuboid(2e-3, 1e-4, 1e-3);
    let hydro = HydroProperties::from_shape(shape.as_ref()).unwrap();
    let mass = 1500.0 * hydro.volume;
    let dry = DryMass {
        mass,
        center: Vector3::zeros(),
        inertia: Matrix3::identity() * (mass * 1e-6),
    };
    let particle = Particle::of_body(&hydro, &dry).unwrap();
    let speed = particle.settling_speed(&fluid, 9.81);
    let turns = [Vector3::zeros(), Vector3::x(), Vector3::z()];
    let speeds = turns.map(|axis| {
        let mut body = FreeBody::new(&hydro.clone().into(), &dry, &fluid).unwrap();
        body.set_orientation(UnitQuaternion::from_scaled_axis(
            axis * std::f64::consts::FRAC_PI_2,
        ));
        for _ in 0..50 {
            body.step(1e-4, Vector3::y() * -9.81);
        }
        -body.linear_velocity().y
    });
    let mean = speeds.iter().sum::<f64>() / 3.0;
    println!("{speeds:?}: mean {mean:.4e}, particle {speed:.4e} m/s");
    assert!((mean / speed - 1.0).abs() < 0.02, "{mean} {speed}");
}

#[test]
fn bad_particles_are_refused_and_bad_places_ignored() {
    assert!(Particle::sphere(0.0, 100.0).is_err());
    assert!(Particle::sphere(1e-3, f64::NAN).is_err());
    let good = Particle::sphere(1e-3, 100.0).unwrap();
    let bad = Particle { mass: -1.0, ..good };
    assert!(Suspension::new(Fluid::AIR, bad).is_err());
    let bad = Particle {
        resistance: 1e60,
        ..good
    };
    assert!(Suspension::new(Fluid::AIR, bad).is_err());
    let mut suspension = Suspension::new(Fluid::AIR, good).unwrap();
    suspension.insert(Vector::X * f32::NAN, Vector::ZERO);
    suspension.insert(Vector::ZERO, Vector::X * f32::INFINITY);
    assert!(suspension.particles().is_empty());
    suspension.insert(Vector::ZERO, Vector::ZERO);
    let before = suspension.particles()[0];
    suspension.step(f32::NAN, DOWN);
    suspension.step(-1.0, DOWN);
    suspension.step(1.0, Vector::X * f32::NAN);
    assert_eq!(suspension.particles()[0], before);
    assert_eq!(suspension.time(), 0.0);
    // Neither a flow that is no number nor a step beyond all bounds makes it one.
    let layer = Layer::new(Fluid::AIR).with_flow(Uniform::new(f32::NAN, 0.0, 0.0));
    let mut suspension = one(layer, good, Vector::ZERO);
    suspension.step(0.1, DOWN);
    suspension.step(f32::MAX, DOWN);
    let found = suspension.particles()[0];
    assert!((found.position + found.velocity).is_finite() && found.position.y < 0.0);
}
