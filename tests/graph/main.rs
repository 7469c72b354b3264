//! Graph-based synthesis: what falls that are put together from segments must keep to.

mod bodies;
mod chain;
mod estimates;
mod frames;
mod kinematic;
mod landing;
mod players;
mod release;
#[cfg(feature = "serde-serialize")]
mod snapshot;

use rapier3d_immersed::Fluid;
use rapier3d_immersed::motion::path::{
    Deviation, HorizontalShape, MotionPath, SynthesisParams, Synthesizer, TrajectoryDatabase,
};
use rapier3d_immersed::motion::{DimensionlessNumbers, MotionGraph, Outline, Regime};
use rapier3d_immersed::rapier3d::na::Vector3;
use std::collections::HashSet;

/// A leaf of the thesis's size (7.3 × 4.2 × 0.03 cm) and 400 kg/m³ in air.
fn leaf(params: SynthesisParams) -> Synthesizer {
    let numbers =
        DimensionlessNumbers::new(Outline::Round, 0.042, 0.0003, 400.0, &Fluid::AIR, 9.81).unwrap();
    Synthesizer::new(&numbers, 0.073, TrajectoryDatabase::shipped(), params).unwrap()
}

/// Parameters in round numbers, whatever the estimates are that the defaults have: a fall stays in a regime
/// with ¾, each regime further on is half as likely as the one before it, and any start is as likely as any
/// other; it lands (.3 ± .15/√2) of its height away, a steady one a tenth as far.
fn round_numbers() -> SynthesisParams {
    let row = |from: usize| -> Vec<f64> {
        let ahead = |to: usize| match to > from {
            true => 0.5f64.powi((to - from) as i32),
            false => 0.0,
        };
        let sum: f64 = (0..6).map(ahead).sum();
        let stay = if from == 5 { 1.0 } else { 0.75 };
        let leave = |to: usize| {
            if sum > 0.0 {
                0.25 * ahead(to) / sum
            } else {
                0.0
            }
        };
        (0..6)
            .map(|to| if to == from { stay } else { leave(to) })
            .collect()
    };
    let graph = MotionGraph::new(vec![1.0 / 6.0; 6], (0..6).map(row).collect());
    SynthesisParams {
        graph: Some(graph.unwrap()),
        deviations: deviations(ROUND),
        ..SynthesisParams::default()
    }
}

/// B = .3 and C = .15.
const ROUND: Deviation = Deviation {
    coefficient: 1.0,
    mean: 0.3,
    width: 0.15,
    across: 0.0,
};

/// The same deviation in every regime, but a tenth of it in steady descent.
fn deviations(deviation: Deviation) -> [Deviation; 6] {
    Regime::ALL.map(|regime| Deviation {
        coefficient: match regime {
            Regime::SteadyDescent => 0.1,
            _ => 1.0,
        },
        ..deviation
    })
}

fn up_to(main: Regime, height: f64) -> SynthesisParams {
    SynthesisParams {
        main: Some(main),
        height,
        ..round_numbers()
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

/// The mean descent is U = √((ρ_s/ρ_f − 1) g b) (3.3): over every fall of the chain (it takes h/U), over
/// every stay in a regime within it, and by least squares, for every main regime and 200 seeds.
///
/// At turning points the height is that of a steady descent to rounding: what is left, less than a
/// thousandth, is the interpolation between keyframes, of which a chaotic glide of a tenth of the regular
/// size has few, so that they are closer here. Between them a glide hangs below the line through its ends by A_y/(2Ω) of
/// a regular one, on average: below .45 chords. Where that sets in, at worst in the middle of a fall, it
/// bends the slope by 1.5 times that over the height: .9 % of 3 m.
#[test]
fn mean_descent() {
    let descent = ((400.0 / 1.184 - 1.0) * 9.81 * 0.0003f64).sqrt();
    for main in Regime::ALL {
        let synthesizer = leaf(SynthesisParams {
            interval: 1.0 / 960.0,
            ..up_to(main, 3.0)
        });
        let (mut worst, mut stays, mut bend) = (0.0f64, 0, 0.0f64);
        for seed in 0..200 {
            let path = synthesizer.path(seed);
            let mean = |from: f32, to: f32| {
                let fallen = path.at(from).position.y - path.at(to).position.y;
                f64::from(fallen) / f64::from(to - from) / descent
            };
            let whole = mean(0.0, path.duration());
            assert!((whole - 1.0).abs() < 1e-5, "{main} {whole}");
            let times = path.regimes().iter().map(|(from, _)| *from);
            let times: Vec<f32> = times.chain([path.duration()]).collect();
            for stay in times.windows(2) {
                worst = worst.max((mean(stay[0], stay[1]) - 1.0).abs());
                stays += 1;
            }
            bend = bend.max((slope(&path) / descent - 1.0).abs());
        }
        println!(
            "{main}: {stays} stays, mean descent within {:.3} % of U; slope by least squares {:.2} %",
            worst * 100.0,
            bend * 100.0
        );
        assert!(worst < 1e-3 && bend < 0.0095, "{main} {worst} {bend}");
    }
}

/// The descent of a fall by least squares of height over time, m/s.
fn slope(path: &MotionPath) -> f64 {
    let all = positions(path);
    let middle = 0.5 * (all.len() - 1) as f64;
    let (mut up, mut down) = (0.0, 0.0);
    for (i, point) in all.iter().enumerate() {
        let t = i as f64 - middle;
        up += t * point.y;
        down += t * t;
    }
    -up / down / f64::from(path.interval())
}

/// Where segments are spliced neither place nor velocity nor attitude jumps, in 60 falls through all
/// regimes. Between successive steps of a path without such jumps the largest change of the velocity times
/// the step is of second order in the step, and the largest turn of first order: with a sixteenth of the step
/// a 256th and a sixteenth. A jump of the velocity would leave a sixteenth of the former, one of the place or
/// the attitude all of it. Half is left for the orders beyond: at the coarse step the body turns by 18°.
#[test]
fn splices_are_continuous() {
    let largest = |rate: f64| {
        let synthesizer = leaf(SynthesisParams {
            interval: 1.0 / rate,
            ..up_to(Regime::PeriodicSpiral, 3.0)
        });
        let (mut farthest, mut widest) = (0.0f32, 0.0f32);
        for seed in 0..60 {
            let path = synthesizer.path(seed);
            for keys in path.keys().windows(3) {
                let [a, b, c] = [&keys[0], &keys[1], &keys[2]];
                let jump = (c.position - b.position * 2.0 + a.position).length();
                let turn = b.attitude.angle_between(a.attitude);
                farthest = farthest.max(jump);
                widest = widest.max(turn);
            }
        }
        println!(
            "at {rate} Hz: {:.4} mm, {:.3}°",
            farthest * 1e3,
            widest.to_degrees()
        );
        [farthest, widest]
    };
    let [coarse, fine] = [240.0, 3840.0].map(largest);
    assert!(coarse[0] > 128.0 * fine[0], "{coarse:?} {fine:?}");
    assert!(coarse[1] > 8.0 * fine[1], "{coarse:?} {fine:?}");
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
