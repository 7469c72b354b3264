//! A film of any world shows its bodies where they are.

use crate::support::film::{Film, FilmArgs};
use crate::support::from_rapier;
use crate::support::options::Out;
use crate::support::recording::Forces;
use crate::support::reel::Reel;
use crate::support::sheet::bounds;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion};

/// A plate of two colliders on a rope of half a meter from a post on a floor, and a ball.
fn world() -> (PhysicsWorld, Immersion, RigidBodyHandle) {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = 1.0 / 120.0;
    let post = ColliderBuilder::cuboid(0.05, 1.0, 0.05).translation(Vector::Y);
    let (post, _) = world.insert(RigidBodyBuilder::fixed(), post);
    let floor = ColliderBuilder::cuboid(2.0, 0.1, 2.0).translation(Vector::Y * -0.1);
    world.insert(RigidBodyBuilder::fixed(), floor);
    let plate = RigidBodyBuilder::dynamic().translation(Vector::new(0.5, 2.0, 0.0));
    let side = |x: f32| {
        let half = ColliderBuilder::cuboid(0.05, 0.005, 0.1).density(500.0);
        half.translation(Vector::X * x)
    };
    let (plate, _) = world.insert(plate, side(-0.05));
    world.insert_collider(side(0.05), Some(plate));
    let rope = RopeJointBuilder::new(0.5).local_anchor1(Vector::Y * 2.0);
    world.insert_impulse_joint(post, plate, rope);
    let ball = RigidBodyBuilder::dynamic().translation(Vector::new(-1.0, 2.0, 0.0));
    world.insert(ball, ColliderBuilder::ball(0.1).density(500.0));
    // Nothing to see.
    world.insert_body(RigidBodyBuilder::dynamic());
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, plate).unwrap();
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.insert(plate, hydro);
    (world, immersion, plate)
}

#[test]
fn bodies_and_lines_are_where_they_are() {
    let (mut first, mut immersion, plate) = world();
    let mut reel = Reel::new(&first, 30.0);
    reel.take("in air", &first);
    reel.shoot(&mut first, &mut immersion, 0.5);
    let (mut second, ..) = world();
    reel.take("plain", &second);
    reel.keep(&second, None);
    for _ in 0..60 {
        second.step();
        reel.keep(&second, None);
    }
    let scene = reel.scene();
    // The plate, the ball and the rope; what is fixed, the widest first.
    assert_eq!((scene.pieces.len(), scene.obstacles.len()), (3, 2));
    let [low, high] = crate::support::scene::corners(&scene.obstacles[0].look.solid);
    assert!((high - low).x > 3.9, "the floor is the first");
    let [low, high] = crate::support::scene::corners(&scene.look(0).solid);
    assert!(
        (high.x - low.x - 0.2).abs() < 1e-6,
        "both colliders are seen"
    );
    let runs: Vec<_> = reel.recordings().collect();
    assert_eq!([runs[0].0, runs[1].0], ["in air", "plain"]);
    let (air, plain) = (runs[0].1, runs[1].1);
    // Sixty steps are fifteen frames after the first.
    assert_eq!((air.frames.len(), plain.frames.len()), (16, 16));
    assert!((air.times[15] - 0.5).abs() < 1e-6);
    let place = from_rapier(first.bodies[plate].translation());
    assert!((air.frames[15][0].0 - place).norm() < 1e-6);
    // The rope is between the post's top and the plate, along its own y.
    let (middle, turn) = air.frames[15][2];
    let top = from_rapier(Vector::Y * 2.0);
    assert!((middle - 0.5 * (place + top)).norm() < 1e-6);
    let along = turn * crate::support::Vec3::y();
    assert!(along.cross(&(place - top)).norm() < 1e-6);
    assert!(plain.forces.is_empty());
    let drag = immersion.forces(&first.bodies, plate).unwrap().drag.force;
    assert_eq!(air.forces[15][0][0], [drag.x, drag.y, drag.z]);
    assert_eq!(
        air.forces[15][1],
        Forces::default(),
        "of the ball that no fluid feels"
    );
}

#[test]
fn what_is_large_fits_into_the_view() {
    let (first, ..) = world();
    let mut reel = Reel::new(&first, 30.0);
    reel.keep(&first, None);
    let (_, run) = reel.recordings().next().unwrap();
    let [low, high] = bounds(reel.scene(), &[run]);
    for (place, _) in &run.frames[0] {
        assert!((place - low).min() > 0.09 && (high - place).min() > 0.09);
    }
}

#[test]
fn a_film_is_a_page_a_glb_and_a_gif_if_asked_for() {
    let (mut world, mut immersion, _) = world();
    let mut reel = Reel::new(&world, 30.0).with_water([4.0, 4.0]);
    reel.shoot(&mut world, &mut immersion, 0.2);
    let scene = reel.scene();
    assert!(scene.water.is_some() && scene.obstacles.len() == 3);
    let out = Out {
        folder: std::env::temp_dir().join(format!("reel-{}", std::process::id())),
    };
    let runs: Vec<_> = reel.recordings().collect();
    for gif in [false, true] {
        let film = Film {
            name: "seen",
            title: "A plate on a rope",
            scene,
            runs: &runs,
            camera: None,
            follow: false,
        };
        let files = film.write(&out, &FilmArgs { gif, open: false });
        let names = ["seen.html", "seen.glb", "seen.gif"].map(|name| out.path(name));
        assert_eq!(files, names[..2 + usize::from(gif)]);
        let page = std::fs::read_to_string(&files[0]).unwrap();
        assert!(page.contains("A plate on a rope"));
        assert_eq!(std::fs::read(&files[1]).unwrap()[..4], *b"glTF");
        for file in files {
            std::fs::remove_file(file).unwrap();
        }
    }
    std::fs::remove_dir(&out.folder).unwrap();
}
