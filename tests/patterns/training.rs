//! Training: what its labels depend on, and that both classifiers are more than chance.

use crate::support::LEAF;
use rapier3d_immersed::ThesisLaw;
use rapier3d_immersed::motion::{Classifier, Pattern};
use rapier3d_immersed::training::{Axis, Clusters, Experiment, Grid, Sample, Subspaces, Sweep};
use std::f64::consts::PI;
use std::ops::ControlFlow;

fn sweep(experiment: &Experiment, count: usize) -> Sweep {
    let mut sweep = Sweep::new(Grid::of_coefficients(count, PI).unwrap());
    sweep
        .run_coefficients(experiment, &Classifier::default(), |_, _| {
            ControlFlow::Continue(())
        })
        .unwrap();
    sweep
}

fn labels(experiment: &Experiment) -> Vec<Pattern> {
    sweep(experiment, 6).patterns().unwrap()
}

fn changed(a: &[Pattern], b: &[Pattern]) -> usize {
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}

/// A time step four times finer changes no more labels than three milliradians at the release, which no
/// hand is steady enough for: the boundaries between patterns are as fuzzy as that. (Counts of some 20
/// fluctuate by √20 ≈ 5, so that a single milliradian may come out lower by chance.)
#[test]
fn the_time_step_does_not_make_the_labels() {
    let experiment = LEAF.experiment.clone().for_training();
    let reference = labels(&experiment);
    let finer = Experiment {
        dt: experiment.dt / 4.0,
        ..experiment.clone()
    };
    let mut shaken = experiment;
    shaken.release.tilt += 3e-3;
    let by_step = changed(&reference, &labels(&finer));
    let by_release = changed(&reference, &labels(&shaken));
    println!("of 216 labels the step changes {by_step}, 3 mrad at the release {by_release}");
    assert!(by_step <= by_release + 10, "{by_step} {by_release}");
    assert!(by_step < 216 / 4);
}

/// The thesis's card: steady descent where drag is strong and lift weak, flutter elsewhere, and the two
/// classifications agree beyond chance.
#[test]
fn the_card_under_the_thesis_law() {
    let card = Experiment::thesis_card(ThesisLaw::new([1.0; 3])).unwrap();
    let sweep = sweep(&card.for_training(), 6);
    let samples: Vec<Sample> = sweep.samples().iter().flatten().copied().collect();
    let clusters = Clusters::find(&samples, 0.04, 1).unwrap();
    let agreement = clusters.agreement(&samples);
    // What independent labels with the same frequencies would agree by.
    let table = clusters.confusion(&samples);
    let total = samples.len() as f64;
    let chance: f64 = (0..4)
        .map(|i| {
            let row: usize = table[i].iter().sum();
            let column: usize = table.iter().map(|row| row[i]).sum();
            row as f64 * column as f64 / (total * total)
        })
        .sum();
    println!("agreement {agreement:.2}, by chance {chance:.2}: {table:?}");
    // Cohen's kappa more than two standard errors (√(¼/216)/(1 − chance) ≈ 0.05) above that of chance. It is
    // 0.2 give or take those: every tenth label is chaotic and changes with rounding.
    assert!((agreement - chance) / (1.0 - chance) > 0.1);
    let subspaces = Subspaces::new(sweep.grid().clone(), sweep.patterns().unwrap()).unwrap();
    assert_eq!(
        subspaces.pattern_at(&[3.0, 0.1, 0.1]),
        Pattern::SteadyDescent
    );
    let fractions = subspaces.volume_fractions();
    // Thesis § 5.4.2: "There are more data in ZZ zone than the others".
    assert!(fractions[Pattern::Zigzag.index()] > 0.5, "{fractions:?}");
}

/// Any parameter can be swept: density and release angle of the leaf under its own law. The heavier it
/// is (the larger I*), the more it tumbles (Field et al. 1997).
#[test]
fn heavier_leaves_tumble_more() {
    let axis = |low, high, count| Axis { low, high, count };
    let axes = vec![axis(60.0, 1500.0, 4), axis(0.1, 1.2, 12)];
    let mut sweep = Sweep::new(Grid::new(axes).unwrap());
    let drop = |point: &[f64]| {
        let mut experiment = LEAF.experiment.clone();
        let density = point[0] / 400.0;
        experiment.mass.mass *= density;
        experiment.mass.inertia *= density;
        experiment.release.tilt = point[1];
        Ok(Sample::of(&experiment.run()?, &Classifier::default()))
    };
    sweep.run(drop, |_, _| ControlFlow::Continue(())).unwrap();
    let tumbling: Vec<usize> = sweep
        .patterns()
        .unwrap()
        .chunks(12)
        .map(|row| row.iter().filter(|p| **p == Pattern::Autorotation).count())
        .collect();
    println!("tumbling of 12 releases by density: {tumbling:?}");
    assert!(tumbling[3] > tumbling[0], "{tumbling:?}");
}

/// A brick of granite falls steadily whatever its coefficients (thesis § 5.5.3).
#[test]
fn a_heavy_brick_is_always_steady() {
    let (hydro, mass) =
        rapier3d_immersed::training::thin_ellipsoid([0.1, 0.05, 0.04], 2700.0).unwrap();
    let brick = Experiment {
        seconds: 1.0,
        ..Experiment::new(hydro, mass, rapier3d_immersed::Fluid::AIR)
    };
    let sweep = sweep(&brick, 4);
    let patterns = sweep.patterns().unwrap();
    assert!(
        patterns.iter().all(|p| *p == Pattern::SteadyDescent),
        "{patterns:?}"
    );
}
