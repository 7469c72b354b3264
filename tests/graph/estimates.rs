//! The estimated numbers of chapter 3 made again: a small part of the own falls, all of the tracked ones.

#[path = "../../examples/synthesis/estimate.rs"]
#[allow(dead_code, reason = "the example writes the whole file with it")]
mod estimate;

use rapier3d_immersed::Fluid;
use rapier3d_immersed::motion::path::Deviation;
use rapier3d_immersed::motion::{
    DimensionlessNumbers, EstimateSource, FallEstimates, MotionGraph, Outline, PhaseDiagram, Regime,
};

const TRACKS: &str = include_str!("../data/paper/falls.csv");

/// Falls that are not among the 12 000 of the shipped file have its numbers within four standard errors of the
/// difference; rows of few observations, whose errors are not known either, are left out.
#[test]
fn other_falls_give_the_same_numbers() {
    let falls = estimate::falls(20_000, 20_400, || ()).unwrap();
    let shipped = FallEstimates::shipped();
    let mut compared = 0;
    for row in estimate::own(&falls) {
        let states = [row.main, row.from, row.to];
        let Some(other) = shipped.find(&row.quantity, EstimateSource::Own, states) else {
            assert!(row.count < 10, "{row:?}");
            continue;
        };
        if row.count < 40 {
            continue;
        }
        // A few falls may show no scatter at all: at least what the shipped error is for as many.
        let fewer = other.error * (other.count as f64 / row.count as f64).sqrt();
        let error = row.error.max(fewer).hypot(other.error);
        let off = (row.value - other.value).abs();
        assert!(off <= 4.0 * error + 1e-12, "{row:?} {other:?}");
        compared += 1;
    }
    assert!(compared > 40, "{compared}");
}

/// B and C of papers by hand from the table of tracked falls; and as the shipped file has them.
#[test]
fn tracked_falls_give_the_shipped_numbers() {
    let shipped = FallEstimates::shipped();
    for row in estimate::tracked(TRACKS).unwrap() {
        let states = [row.main, row.from, row.to];
        let other = shipped.find(&row.quantity, row.source, states).unwrap();
        assert!((row.value / other.value - 1.0).abs() < 1e-4, "{row:?}");
        assert_eq!(row.count, other.count);
    }
    let drifts = measured().filter(|(class, ..)| *class == "tumbling");
    let drifts: Vec<f64> = drifts
        .map(|(_, _, drift, descent)| drift / descent)
        .collect();
    let mean = drifts.iter().sum::<f64>() / drifts.len() as f64;
    let square = drifts.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / drifts.len() as f64;
    let deviation = Deviation::of(Regime::PeriodicTumbling);
    assert!((deviation.mean / mean - 1.0).abs() < 1e-3);
    assert!((deviation.width / (2.0 * square).sqrt() - 1.0).abs() < 1e-3);
}

/// Class, radius, drift and descent of each tracked segment.
fn measured() -> impl Iterator<Item = (&'static str, f64, f64, f64)> {
    TRACKS.lines().skip(1).map(|line| {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |column: usize| fields[column].parse::<f64>().unwrap();
        (fields[7], number(3), number(12), number(11))
    })
}

/// What the estimate of the mean descent says of itself: papers that tumble fall 0.72 times as fast in the median,
/// chaotic ones 0.80 times, to two digits. The diagram has the same regime at either Reynolds number.
#[test]
fn papers_fall_nearly_as_fast_as_estimated() {
    let (area_density, thickness) = (0.07, 2.5 / 36e3);
    let air = Fluid::new(1.2754, 1.48e-5).unwrap();
    let diagram = PhaseDiagram::default();
    for (class, expected) in [("tumbling", 0.72), ("chaotic", 0.80)] {
        let (mut ratios, mut same) = (Vec::new(), 0);
        for (_, radius, _, descent) in measured().filter(|(c, ..)| *c == class) {
            let density = area_density / thickness;
            let diameter = 2.0 * radius;
            let numbers =
                DimensionlessNumbers::new(Outline::Round, diameter, thickness, density, &air, 9.81);
            let numbers = numbers.unwrap();
            ratios.push(descent / numbers.broadside_descent());
            let fallen = diagram.regime(numbers.reynolds_at(descent), numbers.i_star);
            same += usize::from(fallen == diagram.regime_of(&numbers));
        }
        ratios.sort_by(f64::total_cmp);
        let median = ratios[ratios.len() / 2];
        println!(
            "{class}: {median:.3} of the estimate, same regime {same} of {}",
            ratios.len()
        );
        assert!((median - expected).abs() < 0.01, "{class} {median}");
        assert!(same as f64 >= 0.95 * ratios.len() as f64, "{class} {same}");
    }
}

/// What is not estimated is known: the helix has the spiral's numbers, in its own place.
#[test]
fn the_helix_is_a_convention() {
    let [helix, spiral] = [Regime::TransitionalHelix, Regime::PeriodicSpiral];
    let shipped = FallEstimates::shipped();
    let falls = |main| {
        let row = shipped.find("falls", EstimateSource::Own, [Some(main), None, None]);
        row.unwrap().count
    };
    assert!(falls(helix) < 10 && falls(spiral) > 1000);
    assert_eq!(Deviation::of(helix), Deviation::of(spiral));
    let [th, ps] = [helix, spiral].map(MotionGraph::free_fall);
    let [four, five] = [helix as usize, spiral as usize];
    assert_eq!(th.start(four), ps.start(five));
    // Nothing else follows flutter later than the two.
    assert_eq!(th.probability(1, four), ps.probability(1, five));
    // 212 of 5658 falls that oscillate are on the wrong side of the border between flutter and spiral.
    let wrong = shipped.find("spiral_wrong_side", EstimateSource::Own, [None; 3]);
    assert!(wrong.unwrap().value < 0.05);
}
