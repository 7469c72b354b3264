//! Each command does what it says, and none can break the bench.

use immersed_workbench::{
    Bench, Change, Command, Fluids, Law, Placement, Rain, Setting, Shape, kind,
};
use rapier3d_immersed::flow::Uniform;
use rapier3d_immersed::rapier3d::math::{Pose, Vector};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::training::Release;
use rapier3d_immersed::{Immersion, preset};

fn change(bench: &mut Bench, change: Change) {
    bench.apply(Command::Change(change)).unwrap();
}

fn set(bench: &mut Bench, setting: Setting) {
    change(bench, Change::Set(setting));
}

fn step(bench: &mut Bench, count: u64) {
    bench.apply(Command::Step(count)).unwrap();
}

fn place(bench: &Bench, body: usize) -> Vector {
    let handle = bench.state().handle(body).unwrap();
    bench.state().world().bodies[handle].center_of_mass()
}

fn velocity(bench: &Bench, body: usize) -> Vector {
    let handle = bench.state().handle(body).unwrap();
    bench.state().world().bodies[handle].linvel()
}

/// The bench is rapier and the crate, and nothing else: a thrown leaf in a wind goes the same way, bit by bit, in a world
/// that is put together by hand.
#[test]
fn a_thrown_leaf_goes_as_in_a_world_by_hand() {
    let mut bench = Bench::default();
    set(&mut bench, Setting::Wind([1.5, 0.0, -0.5]));
    set(&mut bench, Setting::Factors([1.2, 0.8, 1.1]));
    let thrown = Placement {
        position: [0.1, 1.2, -0.2],
        velocity: [2.0, 1.0, 0.5],
        spin: [3.0, 0.0, 1.0],
        heading: 30.0,
        ..Placement::default()
    };
    change(&mut bench, Change::Place(thrown));
    step(&mut bench, 150);

    let leaf = kind(Shape::Leaf, 1.0).unwrap();
    let mut world = PhysicsWorld::new();
    preset::leaf_scale(&mut world.integration_parameters);
    let floor = ColliderBuilder::cuboid(20.0, 0.05, 20.0).friction(0.6);
    let at = Pose::from_translation(Vector::Y * -0.05);
    world.insert(RigidBodyBuilder::fixed().pose(at), floor);
    let release = Release {
        tilt: 20f64.to_radians(),
        tilt_axis: 80f64.to_radians(),
        heading: 30f64.to_radians(),
        ..Release::default()
    };
    let turn = release.orientation(&leaf.body.hydro);
    let origin = immersed_workbench::Vec3::new(0.1, 1.2, -0.2) - turn * leaf.dry.center;
    let origin = Vector::new(origin.x as f32, origin.y as f32, origin.z as f32);
    let body = RigidBodyBuilder::dynamic()
        .pose(Pose::from_parts(origin, release.rotation(&leaf.body.hydro)))
        .linvel(Vector::new(2.0, 1.0, 0.5))
        .angvel(Vector::new(3.0, 0.0, 1.0))
        .additional_mass_properties(leaf.dry.to_mass_properties());
    let collider = ColliderBuilder::new(leaf.collision.clone());
    let collider = collider.density(0.0).friction(0.6).restitution(0.0);
    let (handle, _) = world.insert(preset::leaf_body(body), collider);
    let mut immersion = Immersion::new(rapier3d_immersed::Fluid::AIR);
    immersion.set_flow(Uniform::new(1.5, 0.0, -0.5));
    immersion.insert(handle, (*leaf.body).clone());
    immersion.set_control(handle, [1.2, 0.8, 1.1].into());
    (0..150).for_each(|_| immersion.step(&mut world));
    let by_hand = &world.bodies[handle];
    assert!((place(&bench, 0) - by_hand.center_of_mass()).length() < 1e-6);
    assert!((velocity(&bench, 0) - by_hand.linvel()).length() < 1e-5);
    // It has gone somewhere.
    assert!((by_hand.center_of_mass() - origin).length() > 0.3);
}

/// Wind carries, turbulence shakes, water carries more than air, a pond lets wood float and coins sink.
#[test]
fn the_fluid_is_what_is_set() {
    let fall = |settings: &[Setting], shape: Shape, steps: u64| {
        let mut bench = Bench::default();
        settings.iter().for_each(|s| set(&mut bench, *s));
        let body = Placement {
            shape,
            ..Placement::default()
        };
        change(&mut bench, Change::Place(body));
        step(&mut bench, steps);
        bench
    };
    let still = fall(&[], Shape::Ball, 120);
    let windy = fall(&[Setting::Wind([5.0, 0.0, 0.0])], Shape::Ball, 120);
    let carried = place(&windy, 0).x - place(&still, 0).x;
    assert!(
        carried > 0.1,
        "{carried} {} {:?}",
        velocity(&windy, 0),
        windy.state().forces(0)
    );
    assert!(place(&still, 0).x.abs() < 1e-3);

    let gusty = fall(&[Setting::Turbulence(1.0)], Shape::Leaf, 60);
    let calm = fall(&[], Shape::Leaf, 60);
    assert!((place(&gusty, 0) - place(&calm, 0)).length() > 0.01);

    let in_water = fall(&[Setting::Fluids(Fluids::Water)], Shape::Coin, 60);
    let in_air = fall(&[], Shape::Coin, 60);
    assert!(place(&in_water, 0).y - place(&in_air, 0).y > 0.15);

    let pond = [Setting::Fluids(Fluids::Pond), Setting::Level(0.6)];
    let wood = fall(&pond, Shape::Block, 1200);
    // Half as dense as water, it floats with about half of it under the level.
    assert!(
        (place(&wood, 0).y - 0.6).abs() < 0.012,
        "{}",
        place(&wood, 0)
    );
    let coin = fall(&pond, Shape::Coin, 1200);
    assert!(place(&coin, 0).y < 0.02);
    // Water that is let out lets it fall.
    let mut wood = wood;
    set(&mut wood, Setting::Fluids(Fluids::Air));
    step(&mut wood, 240);
    assert!(place(&wood, 0).y < 0.06);
}

/// Laws, their coefficients and the factors on their forces change a fall, and what does not act does not.
#[test]
fn laws_and_coefficients_act() {
    let fall = |settings: &[Setting]| {
        let mut bench = Bench::default();
        settings.iter().for_each(|s| set(&mut bench, *s));
        change(&mut bench, Change::Place(Placement::default()));
        step(&mut bench, 100);
        place(&bench, 0)
    };
    let usual = fall(&[]);
    let thesis = fall(&[Setting::Law(Law::Thesis)]);
    let steady = fall(&[
        Setting::Law(Law::Thesis),
        Setting::Coefficients([1.81, 0.31, 0.31]),
    ]);
    let ideal = fall(&[Setting::Law(Law::Inviscid)]);
    let dragged = fall(&[Setting::Factors([3.0, 1.0, 1.0])]);
    let all = [usual, thesis, steady, ideal, dragged];
    for (i, a) in all.iter().enumerate() {
        for b in &all[i + 1..] {
            assert!((a - b).length() > 0.01, "{all:?}");
        }
    }
    // The coefficients are the thesis's law's.
    assert_eq!(fall(&[Setting::Coefficients([1.81, 0.31, 0.31])]), usual);
    // Three times the drag falls more slowly, an ideal fluid hardly holds it.
    assert!(dragged.y > usual.y && ideal.y < usual.y);
}

/// Bodies at the same place go on top of each other, and none begins in the ground.
#[test]
fn bodies_do_not_begin_in_each_other() {
    let mut bench = Bench::default();
    let at = Placement {
        shape: Shape::Block,
        position: [0.0, 0.0, 0.0],
        ..Placement::default()
    };
    for _ in 0..6 {
        change(&mut bench, Change::Place(at));
        assert!(bench.message.contains("higher"), "{}", bench.message);
    }
    let heights: Vec<f32> = (0..6).map(|body| place(&bench, body).y).collect();
    assert!(heights.is_sorted() && heights[0] > 0.02, "{heights:?}");
    step(&mut bench, 480);
    for body in 0..6 {
        assert!(place(&bench, body).y > 0.015);
        assert!(velocity(&bench, body).length() < 3.0);
    }
}

/// What is out of range is held and said, what is no number is refused, and neither moves the world on.
#[test]
fn numbers_are_held_or_refused() {
    let mut bench = Bench::default();
    set(&mut bench, Setting::Wind([1e9, 0.0, 0.0]));
    assert_eq!(bench.state().settings.wind[0], 10.0);
    assert!(bench.message.contains("wind"), "{}", bench.message);
    let body = Placement {
        size: 0.0,
        ..Placement::default()
    };
    change(&mut bench, Change::Place(body));
    assert_eq!(bench.state().bodies[0].size, 0.3);
    let before = (
        bench.state().bits(),
        bench.state().settings,
        bench.changes().len(),
    );
    let nowhere = Placement {
        position: [f64::NAN, 1.0, 0.0],
        ..Placement::default()
    };
    for refused in [
        Command::Change(Change::Place(nowhere)),
        Command::Change(Change::Set(Setting::Level(f64::INFINITY))),
        Command::Change(Change::Draw(vec![[0.0, 1.0, 0.0]])),
        Command::Change(Change::Draw(vec![[0.0, 1.0, 0.0], [0.0, 1.5, 0.0]])),
        Command::Change(Change::Remove(7)),
        Command::Speed(f64::NAN),
        Command::Rewind(f64::NAN),
        Command::Load("there is no such file.json".into()),
        Command::Film("film.html".into()),
    ] {
        let outcome = bench.apply(refused.clone());
        assert_eq!(outcome, Err(bench.message.clone()), "{refused:?}");
        assert!(!bench.message.is_empty());
        let now = (
            bench.state().bits(),
            bench.state().settings,
            bench.changes().len(),
        );
        assert_eq!(before, now, "{refused:?}");
    }
}

/// Under every extreme setting, thrown and rained bodies of every shape stay numbers, on the ground and within its bounds.
#[test]
fn nothing_blows_up() {
    let extremes = [
        vec![],
        vec![
            Setting::Wind([1e3, -1e3, 1e3]),
            Setting::Turbulence(1e3),
            Setting::Eddy(0.0),
        ],
        vec![Setting::Fluids(Fluids::Water), Setting::Factors([1e3; 3])],
        vec![
            Setting::Fluids(Fluids::Pond),
            Setting::Waves(1e3),
            Setting::Current([-1e3, 1e3, 0.0]),
            Setting::Law(Law::Inviscid),
        ],
        vec![
            Setting::Law(Law::Thesis),
            Setting::Coefficients([0.0, 1e3, 1e3]),
        ],
        vec![
            Setting::Law(Law::Stochastic),
            Setting::Factors([0.0, 1e3, 1e3]),
        ],
    ];
    let mut bench = Bench::default();
    for (round, settings) in extremes.iter().enumerate() {
        settings.iter().for_each(|s| set(&mut bench, *s));
        for (index, shape) in Shape::ALL.into_iter().enumerate() {
            let thrown = Placement {
                shape,
                size: if index % 2 == 0 { 1e9 } else { 0.0 },
                position: [0.0, 0.0, 0.0],
                tilt: 1e4,
                velocity: [1e9, 1e9, -1e9],
                spin: [-1e9, 1e9, 0.0],
                ..Placement::default()
            };
            change(&mut bench, Change::Place(thrown));
        }
        let rain = Rain {
            shape: Shape::Confetti,
            count: 5.0,
            spread: 0.0,
            seed: round as u64,
            ..Rain::default()
        };
        change(&mut bench, Change::Rain(rain));
        step(&mut bench, 120);
        for body in 0..bench.state().bodies.len() {
            let (at, speed) = (place(&bench, body), velocity(&bench, body).length());
            assert!(at.is_finite() && speed.is_finite(), "{settings:?} {body}");
            assert!(
                at.length() < 30.0 && speed < 81.0,
                "{settings:?}: {at} {speed}"
            );
        }
    }
    // The bench is full at some number, and says so.
    let many = Rain {
        count: 200.0,
        ..Rain::default()
    };
    for _ in 0..3 {
        let _ = bench.apply(Command::Change(Change::Rain(many)));
    }
    assert_eq!(bench.state().bodies.len(), 400);
    assert!(bench.message.contains("400"), "{}", bench.message);
}

/// Removing and clearing take away what was meant, and the others go on.
#[test]
fn bodies_are_removed() {
    let mut bench = Bench::default();
    for x in [-0.4, 0.0, 0.4] {
        let body = Placement {
            position: [x, 1.5, 0.0],
            ..Placement::default()
        };
        change(&mut bench, Change::Place(body));
    }
    step(&mut bench, 30);
    let last = place(&bench, 2);
    change(&mut bench, Change::Remove(1));
    assert_eq!(bench.state().bodies.len(), 2);
    assert_eq!(place(&bench, 1), last);
    step(&mut bench, 30);
    assert!(place(&bench, 1).y < last.y);
    change(&mut bench, Change::Clear);
    assert!(bench.state().bodies.is_empty() && bench.state().immersion.is_empty());
}
