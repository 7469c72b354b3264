//! Measured falls: the bars that the default law was calibrated to reach. The example `validation` has
//! the whole table.

use rapier3d_immersed::ViscousLaw;
use rapier3d_immersed::motion::Regime;
use rapier3d_immersed::training::Experiment;
use rapier3d_immersed::training::fidelity::{Effort, Fidelity, Part, Plate};

/// Other releases than those of the calibration, whose seed is 1.
const EFFORT: Effort = Effort {
    seed: 29,
    releases: 3,
    drops: 12,
};

#[test]
fn plates_tumble_flutter_and_are_chaotic() {
    let fidelity = Fidelity {
        plates: Plate::targets().unwrap(),
        ..Fidelity::default()
    };
    let report = fidelity
        .run(&ViscousLaw::default(), &EFFORT, Experiment::run)
        .unwrap();
    for result in &report.plates {
        let plate = &result.plate;
        let share = result.mean(|fall| fall.tumbling);
        if plate.regime == Regime::TransitionalChaotic {
            // Both kinds of turns, in every plate. (1/9.5 and 1/10 turn back in a fifth of them, for which
            // our word is still tumbling: the example shows that as not met.)
            assert!((0.15..0.95).contains(&share), "{}: {share}", plate.beta);
        } else {
            assert_eq!(result.regime(), plate.regime, "{}: {share}", plate.beta);
        }
        let means = [
            (plate.drift, result.mean(|fall| fall.drift)),
            (plate.descent, result.mean(|fall| fall.descent)),
            (plate.spin, result.mean(|fall| fall.spin)),
        ];
        for (measured, ours) in means {
            let Some(measured) = measured else { continue };
            // The fluttering plate descends an eighth too fast.
            let bar = if plate.beta < 0.08 { 0.15 } else { 0.1 };
            assert!((ours / measured - 1.0).abs() < bar, "{ours} {measured}");
        }
    }
    assert_eq!(report.plates[0].plate.regime, Regime::PeriodicTumbling);
}

#[test]
fn discs_fall_as_the_map_says() {
    let mut fidelity = Fidelity::new().unwrap();
    fidelity.plates.clear();
    fidelity.papers.clear();
    fidelity.shares.clear();
    let report = fidelity
        .run(&ViscousLaw::default(), &EFFORT, Experiment::run)
        .unwrap();
    let map = &report.discs;
    assert!(map.agreement() > 0.85, "{}", map.agreement());
    for (class, agreement) in map.agreement_by_class().iter().enumerate() {
        assert!(*agreement > 0.7, "{class}: {agreement}");
    }
    assert!(map.near_misses(0.2) > 0.7, "{}", map.near_misses(0.2));
}

/// Descent within 10 % of what was measured for five sets of nine, the others within 18 %. Which of them tumble is not
/// told by their size as it is measured (half of the circles at I* = .043 to .049): about as many of all sizes do.
#[test]
fn papers_fall_as_fast_as_paper() {
    let mut fidelity = Fidelity::new().unwrap();
    fidelity.plates.clear();
    fidelity.discs.clear();
    let report = fidelity
        .run(&ViscousLaw::default(), &EFFORT, Experiment::run)
        .unwrap();
    let errors = report.papers.iter().map(|result| {
        let ours = result.mean(|fall| fall.descent);
        (ours / result.drop.descent - 1.0).abs()
    });
    let errors: Vec<f64> = errors.collect();
    let within = |bar: f64| errors.iter().filter(|error| **error < bar).count();
    assert!(within(0.1) >= 5 && within(0.18) == 9, "{errors:?}");
    let shares: Vec<f64> = report.shares.iter().map(|result| result.share()).collect();
    assert!(
        shares.iter().all(|share| (0.4..0.9).contains(share)),
        "{shares:?}"
    );
}

#[test]
fn parts_share_nothing_and_leave_nothing_out() {
    let all = Fidelity::new().unwrap();
    let fitted = all.clone().part(Part::Fitted);
    let held_out = all.clone().part(Part::HeldOut);
    assert_eq!(fitted.discs.len() + held_out.discs.len(), 200);
    assert_eq!(
        fitted.papers.len() + held_out.papers.len(),
        all.papers.len()
    );
    let betas = |part: &Fidelity| -> Vec<f64> { part.plates.iter().map(|p| p.beta).collect() };
    assert_eq!(betas(&fitted), [1.0 / 8.0, 1.0 / 10.0, 1.0 / 14.0]);
    assert_eq!(betas(&held_out), [1.0 / 9.5, 1.0 / 11.0]);
    let error = all.run(
        &ViscousLaw::default(),
        &Effort {
            releases: 0,
            ..EFFORT
        },
        Experiment::run,
    );
    assert!(error.unwrap_err().to_string().contains("releases"));
}
