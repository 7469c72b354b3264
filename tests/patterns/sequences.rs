//! A planned body falls as planned: in rapier, not only in the planner's own integration.

use crate::support::LEAF;
use rapier3d_immersed::motion::{
    Classifier, ControlSeries, MotionGraph, Pattern, Spread, Trajectory, TurnFinder,
};
use rapier3d_immersed::training::{Plan, PlannerParams};
use std::sync::LazyLock;

const RUNS: u64 = 200;

pub static PLANS: LazyLock<Vec<Plan>> = LazyLock::new(|| {
    let planner = LEAF.planner(PlannerParams::default());
    (0..RUNS).map(|seed| planner.plan(seed).unwrap()).collect()
});

/// The pattern that the direct classifier sees in each dwell, repeats merged.
fn measured(fall: &Trajectory, series: &ControlSeries) -> Vec<Pattern> {
    let classifier = Classifier::default();
    let times = series.dwell_times().into_iter();
    let mut sequence: Vec<Pattern> = times
        .map(|(_, from, to)| {
            let part = Trajectory {
                interval: fall.interval,
                moments: fall.between(from, to).to_vec(),
            };
            classifier.classify(&part).regime.into()
        })
        .collect();
    sequence.dedup();
    sequence
}

#[test]
fn planned_sequences_are_seen_in_rapier() {
    let plans = &*PLANS;
    let series: Vec<&ControlSeries> = plans.iter().map(|plan| &plan.series).collect();
    let falls = LEAF.play(&series);
    let mut as_planned = 0;
    let mut spreads = [(0.0, 0.0, 0.0); 4];
    for (fall, series) in falls.iter().zip(&series) {
        let seen = measured(fall, series);
        as_planned += u32::from(seen == series.sequence());
        for (pattern, from, to) in series.dwell_times() {
            let Spread {
                distance,
                eccentricity,
            } = Spread::of(fall.between(from, to));
            let sum = &mut spreads[pattern.index()];
            *sum = (sum.0 + distance, sum.1 + eccentricity, sum.2 + 1.0);
        }
    }
    println!("as planned: {as_planned} of {RUNS}");
    for (pattern, (d, e, count)) in Pattern::ALL.into_iter().zip(spreads) {
        let (d, e) = (100.0 * d / count, e / count);
        println!(
            "{pattern}: {count} dwells, mean d {d:.1} cm, mean e {e:.2}, each from its own origin"
        );
    }
    assert!(f64::from(as_planned) >= 0.8 * RUNS as f64, "{as_planned}");
}

/// Upper 1 % point of the χ² distribution with 1 … 3 degrees of freedom (standard tables).
const CHI_SQUARED: [f64; 3] = [6.635, 9.210, 11.345];

/// What the planner draws follows the graph's transitions, row by row, and cells of probability zero
/// stay empty: watching each dwell must not favour any pattern.
#[test]
fn transitions_follow_the_graph() {
    let graph = MotionGraph::thesis();
    let (mut counts, mut starts) = ([[0.0; 4]; 4], [0.0; 4]);
    for plan in PLANS.iter() {
        starts[plan.dwells[0].planned.index()] += 1.0;
        for pair in plan.dwells.windows(2) {
            counts[pair[0].planned.index()][pair[1].planned.index()] += 1.0;
        }
    }
    let check = |name: &str, observed: &[f64], expected: &dyn Fn(usize) -> f64| {
        let whole: f64 = observed.iter().sum();
        let (mut chi2, mut cells) = (0.0, 0);
        for (state, count) in observed.iter().enumerate() {
            let p = expected(state);
            if p == 0.0 {
                assert_eq!(*count, 0.0, "{name}: a forbidden transition to {state}");
            } else {
                chi2 += (count - whole * p).powi(2) / (whole * p);
                cells += 1;
            }
        }
        println!("{name}: {observed:?}, χ² {chi2:.2} of {cells} cells");
        if cells > 1 {
            assert!(chi2 < CHI_SQUARED[cells - 2], "{name}: {chi2}");
        }
    };
    check("start", &starts, &|to| graph.start(to));
    for pattern in Pattern::ALL {
        let from = pattern.index();
        check(pattern.abbreviation(), &counts[from], &|to| {
            graph.probability(from, to)
        });
    }
}

/// Sequences only go on in the order of the patterns, and every change follows at least three turns (or
/// a second without any).
#[test]
fn sequences_never_go_back() {
    for plan in PLANS.iter() {
        let sequence = plan.series.sequence();
        assert!(
            sequence.windows(2).all(|pair| pair[0] < pair[1]),
            "{sequence:?}"
        );
        let mut finder = TurnFinder::new(0.0365, TurnFinder::TOLERANCE);
        // The planner's finder begins with the first moment after the release.
        let after = plan.fall.moments.iter().enumerate().skip(1);
        let turns: Vec<f64> = after
            .filter(|(_, moment)| finder.push(moment.position))
            .map(|(index, _)| index as f64 * plan.fall.interval)
            .collect();
        for (_, from, to) in plan.series.dwell_times() {
            let within = |t: &&f64| (from + 1e-9..to + 1e-9).contains(*t);
            let turned = turns.iter().filter(within).count();
            let steady = turned == 0 && to - from >= 1.0 - 1e-9;
            let longest = to - from >= 3.0 - 1e-9;
            assert!(turned >= 3 || steady || longest, "{turned} in {from}..{to}");
        }
    }
}

#[test]
fn a_seed_gives_one_plan() {
    let planner = LEAF.planner(PlannerParams::default());
    assert_eq!(planner.plan(7).unwrap(), PLANS[7]);
    assert_ne!(PLANS[7].series, PLANS[8].series);
    let book = planner.codebook("leaf", 5..9).unwrap();
    let planned: Vec<&ControlSeries> = PLANS[5..9].iter().map(|plan| &plan.series).collect();
    assert!(book.series().iter().eq(planned));
    let sequence = [Pattern::Zigzag, Pattern::Autorotation];
    let asked = planner.plan_sequence(&sequence, 3).unwrap();
    // A user may ask for what the graph would never draw.
    assert_eq!(asked.series.sequence(), sequence);
}
