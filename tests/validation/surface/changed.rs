//! Floating bodies whose users, contacts and surroundings change.

use super::{Pond, ideal};
use rapier3d::prelude::*;
use rapier3d_immersed::flow::Uniform;
use rapier3d_immersed::free_surface::{Dispersion, Elevation, FreeSurface, Wave, Waves};
use rapier3d_immersed::rapier3d;
use rapier3d_immersed::{Fluid, Layer, Medium};

fn raft() -> ColliderBuilder {
    ColliderBuilder::cuboid(0.5, 0.1, 0.4).density(500.0)
}

/// An ideal pond with a raft that moves at 1 m/s along x.
fn drifting() -> Pond {
    let body = RigidBodyBuilder::dynamic().linvel(Vector::X);
    let mut pond = Pond::over(Fluid::WATER, body, raft(), 60.0, ideal);
    pond.run(0.5);
    pond
}

/// Who lifts a raft out of the water or pushes it under has done the work: its speed along the water stays.
#[test]
fn lifting_takes_no_speed() {
    for by in [0.03, 0.05, -0.03] {
        let mut pond = drifting();
        let (before, at) = (pond.body().linvel().x, pond.body().translation());
        pond.world.bodies[pond.body].set_translation(at + Vector::Y * by, true);
        pond.run(1.0 / 60.0);
        let after = pond.body().linvel().x;
        assert!((after / before - 1.0).abs() < 1e-3, "{by}: {after}");
    }
}

/// A raft that was carried through the surface as a kinematic body goes on at the velocity that it is given.
#[test]
fn carrying_changes_no_velocity() {
    for by in [0.08, -0.15, 0.15] {
        let mut pond = drifting();
        let at = pond.body().translation();
        let kinematic = RigidBodyType::KinematicPositionBased;
        pond.world.bodies[pond.body].set_body_type(kinematic, true);
        pond.run(0.1);
        pond.world.bodies[pond.body].set_translation(at + Vector::Y * by, true);
        pond.run(0.1);
        let body = &mut pond.world.bodies[pond.body];
        body.set_body_type(RigidBodyType::Dynamic, true);
        body.set_linvel(Vector::X * 2.0, true);
        body.set_angvel(Vector::ZERO, true);
        pond.run(1.0 / 60.0);
        let speed = pond.body().linvel().x;
        assert!((speed - 2.0).abs() < 1e-3, "{by}: {speed}");
    }
}

/// Gravity that is off the medium's up pulls along the water: g t m/(m + A) in an ideal fluid.
#[test]
fn tilted_gravity_pulls_along_the_water() {
    let mut pond = Pond::over(
        Fluid::WATER,
        RigidBodyBuilder::dynamic(),
        raft(),
        60.0,
        ideal,
    );
    pond.world.gravity = Vector::new(1.0, -9.81, 0.0);
    pond.run(2.0);
    let whole = pond.immersion.mass_matrix_of(pond.body).unwrap();
    let exact = 2.0 * pond.immersion.mass_of(pond.body).unwrap().mass / whole[(0, 0)];
    let speed = f64::from(pond.body().linvel().x);
    assert!((speed / exact - 1.0).abs() < 5e-3, "{speed} for {exact}");
}

/// A ball that enters at 45° keeps its momentum along and across: both velocities shrink by (m + ½ρ_aV)/(m + ½ρ_wV),
/// though the water turns it while it is half under.
#[test]
fn oblique_entry_conserves_momentum() {
    for hertz in [60.0, 240.0] {
        let body = RigidBodyBuilder::dynamic()
            .translation(Vector::Y * 0.5)
            .linvel(Vector::new(3.0, -3.0, 0.0));
        let ball = ColliderBuilder::ball(0.1).density(500.0);
        let mut pond = Pond::over(Fluid::WATER, body, ball, hertz, ideal);
        pond.world.gravity = Vector::ZERO;
        pond.run(0.6);
        let exact = 3.0 * (500.0 + 0.5 * 1.184) / (500.0 + 0.5 * 997.0);
        let v = pond.body().linvel();
        let miss = (v - Vector::new(exact, -exact, 0.0)).length() / exact;
        assert!(miss < 2e-3, "{hertz}: {v} for {exact}");
    }
}

/// Two rafts, one on the other, go with a slow current and with a swell: neither may sleep.
#[test]
fn a_stack_drifts_and_does_not_sleep() {
    let current = Layer::new(Fluid::WATER).with_flow(Uniform::new(0.2, 0.0, 0.0));
    let wave = Wave {
        amplitude: 0.2,
        wavelength: 60.0,
        ..Wave::default()
    };
    let swell = Waves::new(Dispersion::default(), &[wave]).unwrap();
    let media = [
        Medium::layered(Fluid::AIR, current),
        Medium::layered(Fluid::AIR, Fluid::WATER).with_surface(swell),
    ];
    for medium in media {
        let mut pond = Pond::new(RigidBodyBuilder::dynamic(), raft(), 60.0);
        let upper = RigidBodyBuilder::dynamic().translation(Vector::Y * 0.2);
        let (upper, _) = pond.world.insert(upper, raft());
        let like = pond.immersion.get(pond.body).unwrap().clone();
        pond.immersion.insert(upper, like);
        pond.immersion.set_medium(medium);
        for _ in 0..1800 {
            pond.immersion.step(&mut pond.world);
            assert!(!pond.body().is_sleeping());
        }
    }
}

/// A surface that jumps by more than can be counted.
struct Cliffs;

impl FreeSurface for Cliffs {
    fn elevation(&self, x: f64, z: f64, _time: f64) -> Elevation {
        let height = if (x * 30.0).sin() * (z * 40.0).cos() > 0.0 {
            1e300
        } else {
            -1.0
        };
        Elevation {
            height,
            slope: [50.0, -80.0],
        }
    }

    fn highest(&self) -> f64 {
        1.0
    }

    fn bend(&self) -> f64 {
        0.1
    }
}

/// Whatever the surface is, not more of a body is under than there is, and its numbers are numbers.
#[test]
fn a_share_is_at_most_one() {
    let mut pond = Pond::new(RigidBodyBuilder::dynamic(), raft(), 60.0);
    let medium = Medium::layered(Fluid::AIR, Fluid::WATER);
    pond.immersion.set_medium(medium.with_surface(Cliffs));
    for _ in 0..240 {
        pond.immersion.step(&mut pond.world);
        let floats = pond.immersion.hydrostatics(&pond.world.bodies, pond.body);
        let share = floats.unwrap().submerged_share;
        assert!((0.0..=1.0).contains(&share), "{share}");
        assert!(pond.body().linvel().is_finite());
    }
}

/// Light bars that fall on ground at the water's edge do not bounce higher than they fell from: their contacts feel the
/// mass that they have there, and not that under water.
#[test]
fn the_ground_gives_no_energy() {
    let cases = [
        ([0.026, 0.021, 0.325], 58.0),
        ([0.105, 0.023, 0.059], 95.0),
        ([0.034, 0.5, 0.27], 66.0),
    ];
    for (half, density) in cases {
        let [x, y, z] = half;
        let body = RigidBodyBuilder::dynamic()
            .translation(Vector::Y)
            .rotation(Vector::new(0.5, 0.3, 0.4))
            .linvel(Vector::new(1.0, 0.0, 0.9));
        let bar = ColliderBuilder::cuboid(x, y, z).density(density);
        let mut pond = Pond::over(Fluid::WATER, body, bar, 60.0, ideal);
        let ground = ColliderBuilder::cuboid(20.0, 0.1, 20.0).rotation(Vector::Z * 0.1);
        pond.world.insert(RigidBodyBuilder::fixed(), ground);
        // ½v² of the fall and the start, and a little.
        let most = (2.0 * 9.81 * 1.2 + 2.0_f32).sqrt();
        for i in 0..300 {
            pond.immersion.step(&mut pond.world);
            let speed = pond.body().linvel().length();
            assert!(speed < most, "{half:?}, step {i}: {speed}");
        }
    }
}
