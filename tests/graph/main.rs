//! Graph-based synthesis: what falls that are put together from segments must keep to.

mod players;

use rapier3d_immersed::Fluid;
use rapier3d_immersed::motion::path::{
    HorizontalShape, MotionPath, SynthesisParams, Synthesizer, TrajectoryDatabase,
};
use rapier3d_immersed::motion::{Numbers, Outline, PhaseDiagram, Regime};
use rapier3d_immersed::rapier3d::na::Vector3;
use std::collections::HashSet;

/// A leaf of the thesis's size (7.3 × 4.2 × 0.03 cm) and 400 kg/m³ in air.
fn leaf(params: SynthesisParams) -> Synthesizer {
    let numbers = Numbers::new(Outline::Round, 0.042, 0.0003, 400.0, &Fluid::AIR, 9.81).unwrap();
    Synthesizer::new(&numbers, 0.073, TrajectoryDatabase::shipped(), params).unwrap()
}

fn up_to(main: Regime, height: f64) -> SynthesisParams {
    SynthesisParams {
        main: Some(main),
        height,
        ..SynthesisParams::default()
    }
}

fn positions(path: &MotionPath) -> Vec<Vector3<f64>> {
    let keys = path.keys().iter();
    keys.map(|key| Vector3::from(key.position.to_array().map(f64::from)))
        .collect()
}

/// The last `seconds` of a path without the mean drift over them, which the landing adds.
fn end_of(path: &MotionPath, seconds: f64) -> Vec<Vector3<f64>> {
    let all = positions(path);
    let count = (seconds / f64::from(path.interval())).round() as usize;
    let part = &all[all.len() - 1 - count..];
    let drift = (part[count] - part[0]) / count as f64;
    (0..count).map(|i| part[i] - drift * i as f64).collect()
}

/// At the (Re, I*) that the thesis prints for its three bodies falls end in its patterns. Its coin lies
/// 12 % above the measured boundary between flutter and chaos, within the 20 % by which discs scatter
/// about it, so that flutter is only a neighbour there.
#[test]
fn the_worked_bodies() {
    let diagram = PhaseDiagram::default();
    for case in PhaseDiagram::THESIS_CASES {
        let regime = diagram.regime(case.reynolds, case.i_star);
        let near = diagram.neighbours(case.reynolds, case.i_star, 0.2);
        if case.regime == Regime::PeriodicFlutter {
            assert!(near.contains(&case.regime));
        } else {
            assert_eq!(regime, case.regime);
        }
        let height = 3.1;
        let params = up_to(case.regime, height);
        let fall = leaf(params).path_through(&[case.regime], 1).unwrap();
        assert_eq!(fall.sequence(), [case.regime]);
    }
}

/// (3.11): with a main regime of level three there are seven motion classes; the chain makes them all,
/// and no other.
#[test]
fn seven_classes() {
    let synthesizer = leaf(up_to(Regime::TransitionalChaotic, 1.0));
    let mut seen = HashSet::new();
    for seed in 0..400 {
        let sequence = synthesizer.path(seed).sequence();
        assert!(sequence.windows(2).all(|pair| pair[0] < pair[1]));
        seen.insert(sequence);
    }
    assert_eq!(seen.len(), 7, "{seen:?}");
}

/// Thesis Fig. 3.8: what swings in a plane is a line from above, the spiral a circle, the helix a rose
/// of four petals, or of eight for ε > 1.
#[test]
fn projections() {
    for regime in [
        Regime::PeriodicFlutter,
        Regime::TransitionalChaotic,
        Regime::PeriodicTumbling,
    ] {
        let path = leaf(up_to(regime, 3.0)).path_through(&[regime], 3).unwrap();
        let shape = HorizontalShape::of(&positions(&path));
        assert!(shape.linearity > 0.999, "{regime} {shape:?}");
    }
    // One turn: the frequency is U/a over the slowness.
    let turn = |s: &Synthesizer| std::f64::consts::TAU * 3.0 * 0.042 / s.descent();
    let spiral = leaf(up_to(Regime::PeriodicSpiral, 4.0));
    let path = spiral.path_through(&[Regime::PeriodicSpiral], 3).unwrap();
    let shape = HorizontalShape::of(&end_of(&path, turn(&spiral)));
    // The turn is cut at a keyframe: it closes to 1 %.
    assert!(shape.circularity > 0.98, "{shape:?}");
    for (ellipticity, petals) in [(0.3, 4), (1.8, 8)] {
        let helix = leaf(SynthesisParams {
            ellipticity,
            ..up_to(Regime::TransitionalHelix, 4.0)
        });
        let path = helix.path_through(&[Regime::TransitionalHelix], 3).unwrap();
        let shape = HorizontalShape::of(&end_of(&path, turn(&helix)));
        assert_eq!(shape.petals, petals, "{ellipticity}: {shape:?}");
        assert!(shape.circularity < 0.97);
    }
    let steady = leaf(up_to(Regime::SteadyDescent, 3.0));
    let path = steady.path_through(&[Regime::SteadyDescent], 3).unwrap();
    assert!(HorizontalShape::of(&end_of(&path, 1.0)).extent < 1e-5);
}

/// Falls of the chain take h/U; and within them the height falls steadily: its slope over time, by
/// least squares, is U within 2 % in every regime but the chaotic one, whose few large segments bend it.
#[test]
fn mean_descent() {
    let slope = |path: &MotionPath| {
        let all = positions(path);
        let middle = 0.5 * (all.len() - 1) as f64;
        let (mut up, mut down) = (0.0, 0.0);
        for (i, point) in all.iter().enumerate() {
            let t = i as f64 - middle;
            up += t * point.y;
            down += t * t;
        }
        -up / down / f64::from(path.interval())
    };
    let synthesizer = leaf(up_to(Regime::PeriodicSpiral, 3.0));
    let mut worst = 0.0f64;
    for seed in 0..200 {
        let path = synthesizer.path(seed);
        let all = positions(&path);
        let mean = (all[0].y - all[all.len() - 1].y) / f64::from(path.duration());
        // In f32.
        assert!((mean / synthesizer.descent() - 1.0).abs() < 1e-5);
        worst = worst.max((slope(&path) / synthesizer.descent() - 1.0).abs());
    }
    println!(
        "slope of the chain's falls: within {:.2} % of U",
        worst * 100.0
    );
    for regime in Regime::ALL {
        let path = synthesizer.path_through(&[regime], 1).unwrap();
        let ratio = slope(&path) / synthesizer.descent();
        println!("{regime}: slope {ratio:.4} U");
        let chaotic = regime == Regime::TransitionalChaotic;
        assert!(chaotic || (ratio - 1.0).abs() < 0.02, "{regime} {ratio}");
    }
}

/// Landing distances of flutter are normal with the asked mean and deviation: mean and spread of 4000 within 4
/// standard errors, and the Kolmogorov–Smirnov distance below 1.63/√n (1 % level).
#[test]
fn landings() {
    let synthesizer = leaf(SynthesisParams {
        interval: 0.05,
        ..up_to(Regime::PeriodicFlutter, 2.0)
    });
    let params = SynthesisParams::default();
    let aspect = 0.073 / 0.042;
    let (mean, spread) = (
        params.deviation.distance(aspect, 2.0),
        params.deviation.spread(aspect, 2.0),
    );
    let mut landings: Vec<f64> = (0..4000)
        .map(|seed| synthesizer.path_through(&[Regime::PeriodicFlutter], seed))
        .map(|path| *positions(&path.unwrap()).last().unwrap())
        .map(|landing| {
            assert!((landing.y + 2.0).abs() < 1e-5 && landing.z.abs() < 1e-5);
            landing.x
        })
        .collect();
    landings.sort_by(f64::total_cmp);
    let n = landings.len() as f64;
    let found = landings.iter().sum::<f64>() / n;
    let variance = landings.iter().map(|r| (r - found).powi(2)).sum::<f64>() / n;
    assert!((found - mean).abs() < 4.0 * spread / n.sqrt());
    assert!((variance.sqrt() / spread - 1.0).abs() < 4.0 / (2.0 * n).sqrt());
    let distance = landings.iter().enumerate().map(|(i, r)| {
        let normal = normal_below((r - mean) / spread);
        (normal - i as f64 / n)
            .abs()
            .max((normal - (i + 1) as f64 / n).abs())
    });
    let distance = distance.fold(0.0, f64::max);
    assert!(distance < 1.63 / n.sqrt(), "{distance}");
}

/// Normal distribution function by Simpson's rule.
fn normal_below(z: f64) -> f64 {
    let density = |x: f64| (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
    let h = z / 200.0;
    let sum: f64 = (0..100)
        .map(|i| {
            let x = 2.0 * h * f64::from(i);
            density(x) + 4.0 * density(x + h) + density(x + 2.0 * h)
        })
        .sum();
    0.5 + sum * h / 3.0
}

/// No jump above 1 % of the body's smaller extent or 2° where segments are spliced, in 60 falls through
/// all regimes: differences of successive steps. They contain the true acceleration too, which shrinks
/// with the step; a jump would not. At 1/240 s, to compare, they are printed.
#[test]
fn splices_are_continuous() {
    let largest = |rate: f64, falls: u64| {
        let synthesizer = leaf(SynthesisParams {
            interval: 1.0 / rate,
            ..up_to(Regime::PeriodicSpiral, 3.0)
        });
        let (mut farthest, mut widest) = (0.0f32, 0.0f32);
        for seed in 0..falls {
            let path = synthesizer.path(seed);
            for keys in path.keys().windows(3) {
                let [a, b, c] = [&keys[0], &keys[1], &keys[2]];
                let jump = (c.position - b.position * 2.0 + a.position).length();
                let step = b.attitude * a.attitude.inverse();
                let next = c.attitude * b.attitude.inverse();
                farthest = farthest.max(jump);
                widest = widest.max(step.angle_between(next).to_degrees());
            }
        }
        let share = farthest / 0.042 * 100.0;
        println!("at {rate} Hz: {share:.4} % of 4.2 cm, {widest:.3}°");
        (share, widest)
    };
    largest(240.0, 60);
    let (share, widest) = largest(3840.0, 60);
    assert!(share < 1.0 && widest < 2.0, "{share} {widest}");
}

/// Strong wind suppresses tumbling (thesis Fig. 3.17): its share of the time at 0, 3 and 5 m/s.
#[test]
fn wind_suppresses_tumbling() {
    let shares = [0.0, 3.0, 5.0].map(|wind| {
        let synthesizer = leaf(SynthesisParams {
            wind,
            ..up_to(Regime::TransitionalHelix, 2.0)
        });
        let (mut tumbling, mut all) = (0, 0);
        for seed in 0..300 {
            let path = synthesizer.path(seed);
            for i in 0..100 {
                let regime = path.regime_at(path.duration() * (i as f32 / 100.0));
                tumbling += usize::from(regime == Regime::PeriodicTumbling);
                all += 1;
            }
        }
        tumbling as f64 / all as f64
    });
    println!("tumbling at 0, 3, 5 m/s: {shares:.4?}");
    assert!(shares[0] > 0.15, "{shares:?}");
    assert!(shares[1] < 0.1 * shares[0] && shares[2] < 0.01 * shares[0]);
}

/// The same seed gives the same fall, bit by bit, in another synthesizer too.
#[test]
fn determinism() {
    for seed in 0..20 {
        let fall = || leaf(up_to(Regime::PeriodicSpiral, 2.0)).path(seed);
        assert_eq!(fall(), fall());
    }
}

/// A database with any byte altered, or cut short, is refused.
#[test]
fn bad_databases() {
    let bytes = TrajectoryDatabase::shipped().to_bytes();
    for i in 0..200 {
        let at = i * bytes.len() / 200;
        let mut altered = bytes.clone();
        altered[at] ^= 0x20;
        assert!(TrajectoryDatabase::from_bytes(&altered).is_err());
        assert!(TrajectoryDatabase::from_bytes(&bytes[..at]).is_err());
    }
}
