//! A drawn path is followed: what the search found, replayed by an ordinary body in rapier.

use crate::support::{LEAF, collider};
use rapier3d_immersed::motion::Sketch;
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::training::Experiment;
use rapier3d_immersed::training::{FollowParams, Followed};

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
