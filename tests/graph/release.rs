//! How a fall begins, and how its swings vary: the release angle as the orientation of the feature
//! vector V_0 (thesis § 3.3.5), and segments drawn from the K-means class of their feature vector.

use super::{ROUND, deviations, leaf, positions, up_to};
use rapier3d_immersed::motion::Regime;
use rapier3d_immersed::motion::path::{Deviation, MotionPath, SynthesisParams, TrajectoryDatabase};
use rapier3d_immersed::rapier3d::math::Vector;
use rapier3d_immersed::rapier3d::na::{Vector2, Vector3};
use std::f64::consts::PI;

/// Nearly no drift: what is left is the segments' own
/// motion.
fn params(main: Regime, height: f64) -> SynthesisParams {
    SynthesisParams {
        interval: 1.0 / 960.0,
        variety: 0.0,
        deviations: deviations(Deviation {
            mean: 3e-4,
            width: 0.0,
            ..ROUND
        }),
        ..up_to(main, height)
    }
}

/// Ends of the glides of a path that lies in the plane z = 0, with the drift taken out: where the
/// horizontal velocity changes its sign (not within a centimeter of the last time: at a turning point the
/// drift is all that moves it), and the two ends of the path.
fn turns(path: &MotionPath) -> Vec<Vector3<f64>> {
    let all = positions(path);
    let drift = (all[all.len() - 1].x - all[0].x) / (all.len() - 1) as f64;
    let at = |i: usize| all[i] - Vector3::x() * (drift * i as f64);
    let slope = |i: usize| at(i + 1).x - at(i).x;
    let mut turns = vec![at(0)];
    for i in 1..all.len() - 1 {
        let last = turns[turns.len() - 1];
        if slope(i - 1) * slope(i) < 0.0 && (at(i) - last).norm() > 0.01 {
            turns.push(at(i));
        }
    }
    let end = at(all.len() - 1);
    // A fall lands at a turning point, which may have been found just before.
    turns.pop_if(|last| (end - *last).norm() < 0.01);
    turns.push(end);
    turns
}

/// The body is let go at the release angle, glides toward its lower edge first, and that glide has the
/// angle's direction within the step of the database (30^(1/9) in slope, half of it either way).
#[test]
fn the_release_angle_directs_the_first_glide() {
    for degrees in [-75.0f64, -60.0, -40.0, 35.0, 50.0, 70.0, 80.0] {
        let angle = degrees.to_radians();
        for regime in [Regime::PeriodicFlutter, Regime::TransitionalChaotic] {
            let synthesizer = leaf(SynthesisParams {
                release_angle: Some(angle),
                ..params(regime, 3.0)
            });
            let path = synthesizer.path_through(&[regime], 2).unwrap();
            let chord = path.keys()[0].attitude * Vector::Y;
            let chord = chord * chord.x.signum();
            let lowered = f64::from((-chord.y).atan2(chord.x));
            assert!(
                (lowered - angle).abs() < 1e-3,
                "{regime} {degrees} {lowered}"
            );
            let turns = turns(&path);
            let first = turns[1] - turns[0];
            assert_eq!(first.x > 0.0, degrees > 0.0, "{regime} {degrees}");
            if regime == Regime::PeriodicFlutter {
                let slope = -first.y / first.x.abs() / angle.abs().tan();
                let step = 30f64.ln() / 9.0;
                assert!(slope.ln().abs() < 0.5 * step + 0.1, "{degrees} {slope}");
            }
        }
    }
}

/// The steeper the release, the narrower the chaotic fall: all of its segments have that orientation, so
/// that it travels cot(angle) across per height, within half a step of the database (30^(1/9) in slope).
#[test]
fn the_release_angle_shapes_chaotic_falls() {
    let width = |degrees: f64| {
        let synthesizer = leaf(SynthesisParams {
            release_angle: Some(degrees.to_radians()),
            ..params(Regime::TransitionalChaotic, 3.0)
        });
        let mut ratio = 0.0;
        for seed in 0..40 {
            let path = synthesizer
                .path_through(&[Regime::TransitionalChaotic], seed)
                .unwrap();
            let turns = turns(&path);
            let across: f64 = turns.windows(2).map(|p| (p[1].x - p[0].x).abs()).sum();
            ratio += across / 3.0 / 40.0;
        }
        ratio
    };
    let half_step = 0.5 * 30f64.ln() / 9.0;
    for degrees in [35.0f64, 45.0, 55.0, 65.0, 80.0] {
        let (found, asked) = (width(degrees), 1.0 / degrees.to_radians().tan());
        println!("{degrees}°: travel across over height {found:.2}, cot {asked:.2}");
        assert!(
            (found / asked).ln().abs() < half_step,
            "{degrees}: {found} {asked}"
        );
    }
}

/// Widths of the swings of a flutter, m.
fn swings(variety: f64, seed: u64) -> Vec<f64> {
    let synthesizer = leaf(SynthesisParams {
        variety,
        ..params(Regime::PeriodicFlutter, 3.0)
    });
    let path = synthesizer
        .path_through(&[Regime::PeriodicFlutter], seed)
        .unwrap();
    let turns = turns(&path);
    turns.windows(2).map(|p| (p[1].x - p[0].x).abs()).collect()
}

/// Spread over mean of the widths of the segments that swings to the left and to the right may be drawn
/// from, by looking at all of the database: the share `variety` of the class, nearest by ratio of lengths.
fn spread_of_segments(variety: f64) -> f64 {
    // A regular glide: twice the amplitude across, .75 L, and half a period down, in chords.
    let regular = Vector2::new(2.0 * 0.75 * 0.073 / 0.042, -PI);
    let database = TrajectoryDatabase::shipped();
    let (mut mean, mut square) = (0.0, 0.0);
    for sign in [-1.0, 1.0] {
        let class = database.class_of(Vector2::new(sign * regular.x, regular.y));
        let members = database.entries().iter().filter(|e| e.class == class);
        let near = members.map(|entry| {
            let feature = entry.segment.feature();
            let width = sign * feature.x;
            let across = ((width + 1e-3) / (regular.x + 1e-3)).ln();
            (across.hypot((feature.y / regular.y).ln()), width)
        });
        let mut near: Vec<(f64, f64)> = near.collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        near.truncate((variety * near.len() as f64) as usize);
        for (_, width) in &near {
            mean += 0.5 * width / near.len() as f64;
            square += 0.5 * width * width / near.len() as f64;
        }
    }
    (square - mean * mean).sqrt() / mean
}

/// Without variety a flutter is periodic: every swing has the same width. With some, swings differ as much
/// as the segments that they are drawn from: to three standard errors, 1/√(2n) of a spread of n swings.
#[test]
fn variety_of_swings() {
    let spread = |variety: f64| {
        let all: Vec<f64> = (0..10).flat_map(|seed| swings(variety, seed)).collect();
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        let square = all.iter().map(|w| (w - mean).powi(2)).sum::<f64>();
        let error = 1.0 / (2.0 * all.len() as f64).sqrt();
        ((square / all.len() as f64).sqrt() / mean, error)
    };
    let (none, _) = spread(0.0);
    assert!(none < 1e-3, "{none}");
    for variety in [0.05, 0.2, 0.8] {
        let ((found, error), expected) = (spread(variety), spread_of_segments(variety));
        println!(
            "variety {variety}: spread {found:.3} of the mean width, of segments {expected:.3}, {error:.3}"
        );
        assert!(
            (found / expected - 1.0).abs() < 3.0 * error,
            "{found} {expected}"
        );
    }
}
