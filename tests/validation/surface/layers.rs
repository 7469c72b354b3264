//! Media of several fluids: what is where, what moves, what is refused.

use super::Pond;
use rapier3d::prelude::*;
use rapier3d_immersed::flow::Uniform;
use rapier3d_immersed::free_surface::{Elevation, FreeSurface};
use rapier3d_immersed::rapier3d;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion, Layer, Medium, Warning};

/// High over the water a leaf falls to the bit as in air alone, and deep under it a plate as in water alone.
#[test]
fn far_from_the_surface_nothing_is_new() {
    for (height, fluid, density) in [(50.0, Fluid::AIR, 300.0), (-50.0, Fluid::WATER, 2700.0)] {
        let fall = |medium: Medium| {
            let mut world = PhysicsWorld::new();
            let leaf = ColliderBuilder::cuboid(0.0365, 0.0005, 0.021).density(density);
            let body = RigidBodyBuilder::dynamic()
                .translation(Vector::Y * height)
                .rotation(Vector::new(0.4, 0.1, 0.2));
            let (leaf, _) = world.insert(body, leaf);
            let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, leaf).unwrap();
            let mut immersion = Immersion::new(medium);
            immersion.insert(leaf, hydro);
            (0..240).for_each(|_| immersion.step(&mut world));
            *world.bodies[leaf].position()
        };
        assert_eq!(
            fall(fluid.into()),
            fall(Medium::layered(Fluid::AIR, Fluid::WATER))
        );
    }
}

/// A ball of 1050 kg/m³ comes to rest half in brine of 1100, half in water of 1000: at the boundary 2 m deep.
#[test]
fn a_ball_rests_between_layers() {
    let fluid = |density| Fluid::new(density, 1e-6).unwrap();
    let medium = Medium::layered(Fluid::AIR, fluid(1000.0));
    let medium = medium.with_layer_below(2.0, fluid(1100.0)).unwrap();
    let mut pond = Pond::new(
        RigidBodyBuilder::dynamic().translation(Vector::Y * 0.5),
        ColliderBuilder::ball(0.1).density(1050.0),
        60.0,
    );
    pond.immersion.set_medium(medium);
    pond.run(90.0);
    let depth = -pond.body().translation().y;
    assert!((depth - 2.0).abs() < 5e-3, "{depth}");
    assert!(pond.body().is_sleeping());
}

/// Up may be anywhere, and the level too.
#[test]
fn up_is_where_the_medium_says() {
    for up in [
        Vector::Z,
        -Vector::X,
        Vector::new(1.0, 2.0, -2.0) / 3.0,
        -Vector::Y,
    ] {
        let level = Vector::new(3.0, -2.0, 7.0);
        let mut pond = Pond::new(
            RigidBodyBuilder::dynamic().translation(level + up * 0.1),
            ColliderBuilder::ball(0.1).density(498.5),
            60.0,
        );
        pond.world.gravity = up * -9.81;
        let medium = Medium::layered(Fluid::AIR, Fluid::WATER);
        pond.immersion
            .set_medium(medium.with_up(up * 5.0).unwrap().with_level(level).unwrap());
        pond.run(20.0);
        let height = (pond.body().translation() - level).dot(up);
        assert!(height.abs() < 1e-3, "{up}: {height}");
        assert!(
            pond.immersion.warnings().is_empty(),
            "{:?}",
            pond.immersion.warnings()
        );
    }
}

/// What floats goes with the current and with the wind. As much of the raft is in the air as in the water, so that where
/// their drags balance its speed between those of water and air is as 1 to √(ρ_w/ρ_a) = 29: .483 m/s in a current of
/// .5 m/s under still air, and .33 m/s in a wind of 10 m/s over still water, if the drag coefficients are equal. That is
/// a leeway of 3.3 % of the wind, of which 1 to 5 % are observed (Breivik & Allen, *J. Mar. Syst.* 69, 99 (2008)).
#[test]
fn current_and_wind_move_what_floats() {
    let drift = |above: Layer, below: Layer| {
        let mut pond = Pond::new(
            RigidBodyBuilder::dynamic(),
            ColliderBuilder::cuboid(0.5, 0.1, 0.5).density(500.0),
            60.0,
        );
        pond.immersion.set_medium(Medium::layered(above, below));
        pond.run(400.0);
        pond.body().linvel().x
    };
    let still = |fluid: Fluid| Layer::new(fluid);
    let current = still(Fluid::WATER).with_flow(Uniform::new(0.5, 0.0, 0.0));
    let speed = drift(Fluid::AIR.into(), current);
    println!("in the current {speed}");
    assert!((speed - 0.483).abs() < 0.01, "{speed}");
    let wind = still(Fluid::AIR).with_flow(Uniform::new(10.0, 0.0, 0.0));
    let speed = drift(wind, Fluid::WATER.into());
    println!("leeway {speed}");
    assert!((speed / 0.334 - 1.0).abs() < 0.1, "{speed}");
}

/// A raft that sleeps wakes when the wind comes up, when the water begins to flow, and when it is put in another medium.
#[test]
fn a_sleeping_raft_wakes() {
    let changes: [fn(&mut Immersion); 3] = [
        |immersion| immersion.set_flow(Uniform::new(30.0, 0.0, 0.0)),
        |immersion| immersion.set_flow_of(1, Uniform::new(1.0, 0.0, 0.0)),
        |immersion| immersion.set_medium(Fluid::AIR),
    ];
    for change in changes {
        let mut pond = Pond::new(
            RigidBodyBuilder::dynamic(),
            ColliderBuilder::cuboid(0.5, 0.1, 0.5).density(500.0),
            60.0,
        );
        pond.run(20.0);
        assert!(pond.body().is_sleeping());
        change(&mut pond.immersion);
        pond.run(1.0);
        assert!(!pond.body().is_sleeping());
        assert!(pond.body().linvel().length() > 0.01);
    }
}

/// A body that its user has just moved from the water into the air, or back, is read out as where it is: buoyancy is ρVg of
/// the fluid there.
#[test]
fn forces_are_those_of_the_place() {
    let mut pond = Pond::new(
        RigidBodyBuilder::dynamic(),
        ColliderBuilder::cuboid(0.5, 0.1, 0.5).density(500.0),
        60.0,
    );
    for (from, to, fluid) in [
        (0.0, 5.0, Fluid::AIR),
        (5.0, -5.0, Fluid::WATER),
        (-5.0, 5.0, Fluid::AIR),
    ] {
        pond.world.bodies[pond.body].set_translation(Vector::Y * from, true);
        pond.run(0.02);
        pond.world.bodies[pond.body].set_translation(Vector::Y * to, true);
        let forces = pond.immersion.forces(&pond.world.bodies, pond.body);
        let lift = forces.unwrap().buoyancy.force.y;
        let exact = fluid.density() * 0.2 * 9.81;
        assert!(
            (lift / exact - 1.0).abs() < 1e-3,
            "{to}: {lift} for {exact}"
        );
    }
}

/// A surface of the user's own that is no number counts as level, and one that has a hole does no harm.
struct NotANumber;

impl FreeSurface for NotANumber {
    fn elevation(&self, _x: f64, _z: f64, _time: f64) -> Elevation {
        Elevation {
            height: f64::NAN,
            slope: [f64::INFINITY; 2],
        }
    }

    fn highest(&self) -> f64 {
        1.0
    }
}

#[test]
fn a_surface_that_is_no_number_is_level() {
    let mut pond = Pond::new(
        RigidBodyBuilder::dynamic().translation(Vector::Y * 0.5),
        ColliderBuilder::cuboid(0.2, 0.2, 0.2).density(500.0),
        60.0,
    );
    let medium = Medium::layered(Fluid::AIR, Fluid::WATER);
    pond.immersion.set_medium(medium.with_surface(NotANumber));
    pond.run(20.0);
    assert!(pond.body().translation().y.abs() < 0.02);
}

/// Without gravity a body at rest in the surface stays there, and one that is shot at any speed stays a number.
#[test]
fn extremes_stay_numbers() {
    for (gravity, speed, hertz) in [
        (0.0, 0.0, 60.0),
        (9.81, 300.0, 60.0),
        (9.81, 1e4, 1.0),
        (1e3, 10.0, 5.0),
    ] {
        let mut pond = Pond::new(
            RigidBodyBuilder::dynamic()
                .translation(Vector::Y * 0.02)
                .linvel(Vector::Y * -speed),
            ColliderBuilder::cuboid(0.05, 0.0005, 0.03).density(300.0),
            hertz,
        );
        pond.world.gravity = Vector::Y * -gravity;
        pond.run(20.0);
        let (at, v) = (pond.body().translation(), pond.body().linvel());
        assert!((at + v).is_finite());
        if gravity == 0.0 {
            assert!(v.length() < 1e-3 && (at - Vector::Y * 0.02).length() < 1e-3);
        } else {
            // What hits the water is slowed down at once; what gravity makes of a leaf in 20 m of air bounds the rest.
            assert!(
                v.length() < speed.max((40.0 * gravity).sqrt()),
                "{speed}: {v}"
            );
        }
    }
}

/// What cannot be is refused by name, and what is odd is said once.
#[test]
fn bad_media_are_named() {
    let layered = || Medium::layered(Fluid::AIR, Fluid::WATER);
    let text = |result: Result<Medium, rapier3d_immersed::Error>| match result {
        Ok(_) => panic!("not refused"),
        Err(error) => error.to_string(),
    };
    assert!(text(layered().with_layer_below(0.0, Fluid::WATER)).contains("depth of a layer"));
    assert!(text(layered().with_layer_below(f64::NAN, Fluid::WATER)).contains("depth of a layer"));
    let deep = layered().with_layer_below(3.0, Fluid::WATER).unwrap();
    assert!(text(deep.with_layer_below(2.0, Fluid::WATER)).contains("2"));
    assert!(text(Medium::new(Fluid::AIR).with_layer_below(1.0, Fluid::WATER)).contains("layers"));
    assert!(text(layered().with_up(Vector::ZERO)).contains("up"));
    assert!(text(layered().with_up(Vector::splat(f32::NAN))).contains("up"));
    assert!(text(layered().with_level(Vector::splat(f32::INFINITY))).contains("level"));

    let upside_down = Immersion::new(Medium::layered(Fluid::WATER, Fluid::AIR));
    let odd = |warning: &Warning| matches!(warning, Warning::LighterBelow { layer: 1, .. });
    assert_eq!(upside_down.warnings().iter().filter(|w| odd(w)).count(), 1);

    let mut tilted = Pond::new(
        RigidBodyBuilder::dynamic(),
        ColliderBuilder::ball(0.1).density(500.0),
        60.0,
    );
    tilted.world.gravity = Vector::new(5.0, -8.0, 0.0);
    tilted.run(1.0);
    let warnings = tilted.immersion.warnings();
    assert_eq!(
        warnings
            .iter()
            .filter(|w| **w == Warning::TiltedGravity)
            .count(),
        1
    );
    assert!(tilted.body().linvel().is_finite());
}
