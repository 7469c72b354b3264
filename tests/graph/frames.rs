//! The graph of frames beside the graph of regimes (thesis § 3.4.3): what the splices have to hide.

use super::{leaf, up_to};
use rapier3d_immersed::motion::path::{FrameGraph, FrameGraphParams, SynthesisParams};
use rapier3d_immersed::motion::{MotionGraph, Regime};
use std::f64::consts::PI;

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(s, n), v| (s + v * v, n + 1.0));
    (sum / count).sqrt()
}

/// Between regimes in a plane the graph of regimes has no jump of the velocity, which at turning points is that of
/// the mean descent in all of them, and one of the attitude of half a radian. Frames that are chosen where two motions
/// are alike have less than half of the latter, and half of the descent as a jump of the velocity.
#[test]
fn what_splices_hide() {
    let main = Regime::PeriodicTumbling;
    let leaf = leaf(up_to(main, 2.0));
    let clip = |regime: &Regime| leaf.path_through(&[*regime], 1).unwrap();
    let clips: Vec<_> = Regime::ALL[..4].iter().map(clip).collect();
    let half_period = PI * 0.042 / leaf.descent();
    let graph =
        FrameGraph::new(&clips, FrameGraphParams::new([0.073, 0.042], half_period)).unwrap();
    let splices = graph.splices().iter();
    let of_frames: Vec<_> = splices
        .filter(|s| graph.regime(s.from) != graph.regime(s.to))
        .collect();
    let of_regimes: Vec<_> = (0..200).flat_map(|seed| leaf.splices(seed)).collect();
    assert!(of_regimes.iter().all(|s| s.regimes[0] < s.regimes[1]));
    let velocity = [
        rms(of_frames.iter().map(|s| s.velocity)),
        rms(of_regimes.iter().map(|s| s.velocity)),
    ];
    let angle = [
        rms(of_frames.iter().map(|s| s.angle)),
        rms(of_regimes.iter().map(|s| s.angle)),
    ];
    println!(
        "{} frames, {} in use; {} of {} splices and {} of regimes change the regime: velocity {velocity:?} m/s, attitude {angle:?} rad",
        graph.frames(),
        graph.frames_in_use(),
        of_frames.len(),
        graph.splices().len(),
        of_regimes.len(),
    );
    assert!(of_frames.len() > 500 && of_regimes.len() > 100);
    assert!(
        velocity[1] < 1e-9 && (0.3..0.8).contains(&velocity[0]),
        "{velocity:?}"
    );
    assert!(
        (0.4..0.8).contains(&angle[1]) && angle[0] < 0.5 * angle[1],
        "{angle:?}"
    );
}

/// A walk shows the regimes in their order, lands, and is as continuous as its clips.
#[test]
fn walks_follow_the_chain() {
    let leaf = leaf(SynthesisParams {
        interval: 1.0 / 60.0,
        ..up_to(Regime::PeriodicTumbling, 3.0)
    });
    let clips = [Regime::PeriodicFlutter, Regime::TransitionalChaotic]
        .map(|regime| leaf.path_through(&[regime], 1).unwrap());
    let half_period = PI * 0.042 / leaf.descent();
    let graph =
        FrameGraph::new(&clips, FrameGraphParams::new([0.073, 0.042], half_period)).unwrap();
    let chain = MotionGraph::free_fall(Regime::TransitionalChaotic);
    let mut both = 0;
    for seed in 0..40 {
        let path = graph.walk(&chain, 4.0, seed).unwrap();
        let last = path.keys().last().unwrap().position.y;
        assert!((-4.2..=-4.0).contains(&last), "{last}");
        assert!(path.sequence().windows(2).all(|pair| pair[0] < pair[1]));
        both += usize::from(path.sequence().len() == 2);
    }
    assert!(both > 5, "{both}");
}
