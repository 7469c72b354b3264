//! A drawn path is followed: what the search found, replayed by an ordinary body in rapier.

use crate::support::{LEAF, collider};
use rapier3d_immersed::flow::Uniform;
use rapier3d_immersed::motion::ControlSeries;
use rapier3d_immersed::motion::Sketch;
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::training::{
    BodyInWorld, BodyState, Experiment, FollowParams, Followed, SketchFollower,
};
use rapier3d_immersed::{Immersion, OnContact};

/// Length of the leaf, m.
const LENGTH: f64 = 0.073;

fn v(x: f64, y: f64, z: f64) -> Vector3<f64> {
    Vector3::new(x, y, z)
}

fn sketch(name: &str) -> Sketch {
    let points = match name {
        "swing" => [
            (0.0, v(0.0, 2.0, 0.0)),
            (0.5, v(0.15, 1.6, 0.0)),
            (1.0, v(0.0, 1.2, 0.05)),
            (1.5, v(0.15, 0.8, 0.1)),
            (2.0, v(0.0, 0.4, 0.1)),
        ],
        "glide" => [
            (0.0, v(0.0, 2.0, 0.0)),
            (0.5, v(0.2, 1.6, 0.0)),
            (1.0, v(0.5, 1.2, 0.0)),
            (1.5, v(0.8, 0.8, 0.0)),
            (2.0, v(1.0, 0.4, 0.0)),
        ],
        _ => [0.0, 0.5, 1.0, 1.5, 2.0].map(|t: f64| {
            let (sine, cosine) = (1.5 * t).sin_cos();
            (t, v(0.25 * cosine, 2.0 - 0.8 * t, 0.25 * sine))
        }),
    };
    Sketch::new(points.to_vec()).unwrap()
}

/// Mean distance from the sketch when a leaf with an ordinary collider replays what was found, m.
fn replayed(sketch: &Sketch, found: &Followed) -> f64 {
    let fall = &LEAF.play_from(&found.release, &[&found.series])[0];
    let start = sketch.at(0.0);
    let count = (sketch.duration() / fall.interval) as usize + 1;
    let distance = |i: usize| {
        let at = start + fall.moments[i].position;
        (at - sketch.at(i as f64 * fall.interval)).norm()
    };
    (0..count).map(distance).sum::<f64>() / count as f64
}

#[test]
fn five_points_are_followed_within_a_body_length() {
    for name in ["swing", "glide", "helix"] {
        let sketch = sketch(name);
        let found = sketch
            .follow(&LEAF.experiment, collider(), &FollowParams::default())
            .unwrap();
        let replayed = replayed(&sketch, &found);
        println!(
            "{name}: mean distance {:.1} cm, replayed {:.1} cm, at the points {:.1?} cm",
            100.0 * found.mean_distance,
            100.0 * replayed,
            found
                .at_points
                .iter()
                .map(|d| 100.0 * d)
                .collect::<Vec<_>>()
        );
        assert!(
            found.mean_distance < LENGTH,
            "{name}: {}",
            found.mean_distance
        );
        assert!(replayed < LENGTH, "{name}: {replayed}");
        // Without steering the leaf goes elsewhere.
        let unsteered = Experiment {
            release: found.release,
            seconds: sketch.duration(),
            ..LEAF.experiment.clone()
        };
        let fall = unsteered.run().unwrap();
        let end = sketch.at(0.0) + fall.moments[fall.moments.len() - 1].position;
        assert!((end - sketch.at(sketch.duration())).norm() > 2.0 * LENGTH);
    }
}

/// "Land here, pass there."
#[test]
fn a_leaf_lands_where_it_is_asked_to() {
    let experiment = &LEAF.experiment;
    let (start, landing) = (v(0.0, 2.0, 0.0), v(0.4, 0.0, 0.3));
    let pass = v(0.3, 1.0, 0.0);
    let goal = Sketch::landing(experiment, start, &[pass], landing).unwrap();
    let found = goal
        .follow(experiment, collider(), &FollowParams::default())
        .unwrap();
    println!(
        "pass and landing: {:.1?} cm",
        found
            .at_points
            .iter()
            .map(|d| 100.0 * d)
            .collect::<Vec<_>>()
    );
    // What the search says, and where a leaf of its own that replays it gets to.
    let fall = &LEAF.play_from(&found.release, &[&found.series])[0];
    for ((time, point), said) in goal.points().iter().zip(&found.at_points) {
        let moment = fall.moments[(time / fall.interval).round() as usize];
        let away = (start + moment.position - point).norm();
        assert!(*said < LENGTH && away < LENGTH, "{time}: {said} {away}");
    }
    assert_eq!(
        goal.follow(experiment, collider(), &FollowParams::default())
            .unwrap(),
        found
    );
}

/// The leaf's own world, with a wind along x and a ball in the way.
fn windy(release: &BodyState, wind: f32, ball: Option<[f32; 4]>) -> BodyInWorld {
    let leaf = &LEAF.experiment;
    let (body, dt) = (leaf.body.clone(), leaf.dt);
    let mut own =
        BodyInWorld::with_collider(body, collider(), leaf.fluid, release, dt, leaf.gravity)
            .unwrap();
    own.immersion.set_flow(Uniform::new(wind, 0.0, 0.0));
    if let Some([x, y, z, radius]) = ball {
        let place = Vector::new(x, y, z);
        let ball = ColliderBuilder::ball(radius).translation(place);
        own.world.insert(RigidBodyBuilder::fixed(), ball);
    }
    own
}

/// A leaf that is steered in that world, and the release that it had.
fn steered(sketch: &Sketch, wind: f32, ball: Option<[f32; 4]>) -> (Followed, BodyState) {
    let mut air = Immersion::new(LEAF.experiment.fluid);
    air.set_flow(Uniform::new(wind, 0.0, 0.0));
    let params = FollowParams::default();
    let mut follower = SketchFollower::new(sketch, &LEAF.experiment, &air, &params).unwrap();
    let release = follower.release_state();
    let mut own = windy(&release, wind, ball);
    for _ in 0..follower.steps() {
        follower.before_step(own.handle, &own.world.bodies, &mut own.immersion);
        own.step();
    }
    let followed = follower.followed(own.handle, &own.world.bodies).unwrap();
    (followed, release)
}

/// The path of a series that is replayed in that world.
fn path_of(
    series: &ControlSeries,
    release: &BodyState,
    wind: f32,
    ball: Option<[f32; 4]>,
    steps: usize,
) -> Vec<Vector3<f64>> {
    let mut own = windy(release, wind, ball);
    own.immersion.replay(own.handle, series, OnContact::Ignore);
    let mut path = vec![own.state().position];
    for _ in 0..steps {
        own.step();
        path.push(own.state().position);
    }
    path
}

/// A leaf is steered against a wind, which one that was planned in still air is not, and back to its path behind a ball
/// that it meets; what it was steered by can be played again in the same world.
#[test]
fn wind_is_reckoned_with_and_obstacles_are_got_over() {
    let sketch = sketch("swing");
    let params = FollowParams::default();
    let wind = -0.8;
    let (found, release) = steered(&sketch, wind, None);
    let still = sketch
        .follow(&LEAF.experiment, collider(), &params)
        .unwrap();
    let steps = found.path.len() - 1;
    let blown = path_of(&still.series, &release, wind, None, steps);
    let apart = |path: &[Vector3<f64>], time: f64| {
        let step = (time / LEAF.experiment.dt).round() as usize;
        (path[step.min(steps)] - sketch.at(time)).norm()
    };
    let ball = Some([0.03, 1.2, 0.0, 0.06]);
    let (hit, _) = steered(&sketch, wind, ball);
    println!(
        "in the wind {:.1} cm off on average, {:.1} at the end; planned in still air {:.1} at the end; \
         with a ball in the way {:.1} on average, {:.1} at most, {:.1} at the end",
        100.0 * found.mean_distance,
        100.0 * apart(&found.path, 2.0),
        100.0 * apart(&blown, 2.0),
        100.0 * hit.mean_distance,
        100.0 * hit.largest_distance,
        100.0 * apart(&hit.path, 2.0),
    );
    assert!(found.mean_distance < LENGTH, "{}", found.mean_distance);
    assert!(apart(&blown, 2.0) > 5.0 * LENGTH);
    // It has met the ball, and comes back to within two lengths of where it should be.
    assert!(hit.largest_distance > 1.5 * found.largest_distance);
    assert!(apart(&hit.path, 2.0) < 2.0 * LENGTH);
    for (followed, ball) in [(found, None), (hit, ball)] {
        let again = path_of(&followed.series, &release, wind, ball, steps);
        let miss = again
            .iter()
            .zip(&followed.path)
            .map(|(a, b)| (a - b).norm());
        assert_eq!(miss.fold(0.0, f64::max), 0.0);
    }
}
