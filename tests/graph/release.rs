//! How a fall begins, and how its swings vary: the release angle as the orientation of the feature
//! vector V_0 (thesis § 3.3.5), and segments drawn from the K-means class of their feature vector.

use super::{leaf, positions, up_to};
use rapier3d_immersed::motion::Regime;
use rapier3d_immersed::motion::path::{Deviation, MotionPath, SynthesisParams};
use rapier3d_immersed::rapier3d::math::Vector;
use rapier3d_immersed::rapier3d::na::Vector3;

/// Nearly no drift, and the swing that the default drift gives: what is left is the segments' own
/// motion.
fn params(main: Regime, height: f64) -> SynthesisParams {
    SynthesisParams {
        interval: 1.0 / 960.0,
        variety: 0.0,
        deviation: Deviation {
            mean: 1e-3 * Deviation::default().mean,
            width: 0.0,
            ..Deviation::default()
        },
        swing: 1e3 * SynthesisParams::default().swing,
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
    turns.push(at(all.len() - 1));
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

/// The steeper the release, the narrower the chaotic fall: all of its segments have that orientation.
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
    let [flat, middle, steep] = [35.0, 55.0, 80.0].map(width);
    println!("travel across over height: {flat:.2} {middle:.2} {steep:.2}");
    // Drift adds to what cot(angle) gives: 1.43, .70, .18.
    assert!(
        flat > 1.3 * middle && middle > 1.3 * steep,
        "{flat} {middle} {steep}"
    );
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

/// Without variety a flutter is periodic: every swing has the same width. With some, swings differ, the
/// more the more variety.
#[test]
fn variety_of_swings() {
    let spread = |variety: f64| {
        let all: Vec<f64> = (0..10).flat_map(|seed| swings(variety, seed)).collect();
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        let square = all.iter().map(|w| (w - mean).powi(2)).sum::<f64>();
        (square / all.len() as f64).sqrt() / mean
    };
    let [none, little, much] = [0.0, 0.05, 0.8].map(spread);
    println!("spread of the swings' width over their mean: {none:.3} {little:.3} {much:.3}");
    assert!(none < 1e-3, "{none}");
    assert!(
        little > 0.1 && much > 1.3 * little,
        "{none} {little} {much}"
    );
}
