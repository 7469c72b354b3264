//! What was measured and what is known exactly must come out, at the quick effort of the example
//! `validation`: every bar is asserted, and those that are known to be missed are listed.

use crate::published::report::{self, Quantity, Row, Section, Verdict};
use crate::published::runner::Runner;
use crate::published::{Effort, SectionName};
use clap::ValueEnum;
use rapier3d_immersed::ViscousLaw;
use rapier3d_immersed::motion::Regime;
use rapier3d_immersed::training::fidelity::Plate;

/// Computes a section, asserts that it has so many bars and meets all but `missed`, and draws.
///
/// A bar in `missed` that is met fails as well: the list says what the crate cannot do today.
fn assert_bars(name: SectionName, bars: usize, missed: &[&str]) -> Section {
    let section = name.compute(Effort::Quick, &|share| {
        assert!((0.0..=1.0).contains(&share), "{share}");
    });
    let section = section.unwrap_or_else(|problem| panic!("{}: {problem}", name.name()));
    let rows = || section.rows.iter();
    let failures: Vec<String> = rows()
        .filter_map(|row| {
            let known = missed.contains(&row.case.as_str());
            match (row.verdict, known) {
                (Verdict::NotMet, false) => Some(format!("missed: {row:?}")),
                (Verdict::Met, true) => Some(format!("met, so strike it off the list: {row:?}")),
                (Verdict::Shown, true) => Some(format!("has no bar: {row:?}")),
                _ => None,
            }
        })
        .collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    for case in missed {
        let found = rows().filter(|row| row.case == *case).count();
        assert_eq!(found, 1, "no such case, or several: {case}");
    }
    let counted = section.count(Verdict::Met) + section.count(Verdict::NotMet);
    assert_eq!(counted, bars, "{} has another number of bars", name.name());
    for (file, svg) in &section.pictures {
        assert!(svg.starts_with("<svg") && svg.len() > 2000, "{file}");
        assert!(!svg.contains("NaN"), "{file}");
    }
    section
}

/// The same for measured falls, which every runner does.
fn assert_falls(name: SectionName, bars: usize, missed: &[&str]) {
    let section = assert_bars(name, bars, missed);
    for runner in ["stand-alone", "dt/2", "rapier, dt", "rapier, 4 dt"] {
        let mut rows = section.rows.iter().filter(|row| row.case.ends_with(runner));
        assert!(rows.any(|row| matches!(row.ours, Quantity::Number(x, _) if x.is_finite())));
    }
}

#[test]
fn plates_in_water() {
    assert_falls(
        SectionName::Plates,
        41,
        &[
            "plate β = 1/9.5, regime, dt/2",
            "plate β = 1/14, descent, stand-alone",
            "plate β = 1/14, descent, rapier, 4 dt",
        ],
    );
}

#[test]
fn map_of_discs() {
    assert_falls(
        SectionName::Discs,
        10,
        &["discs, misses within 20 % of a boundary, stand-alone"],
    );
}

#[test]
fn paper_in_air() {
    assert_falls(
        SectionName::Papers,
        28,
        &[
            "circle of 17.0 mm, edge down, descent, stand-alone",
            "circle of 45.5 mm, edge down, drift, stand-alone",
            "circle of 17.4 mm, flat, drift, stand-alone",
            "circle of 27.0 mm, flat, descent, stand-alone",
            "circle of 27.0 mm, flat, drift, stand-alone",
            "circle of 46.1 mm, flat, drift, stand-alone",
            "I* where half of the circles tumble, stand-alone",
            "I* where half of the circles tumble, rapier, dt",
            "I* where half of the circles tumble, rapier, 4 dt",
            "I* where half of the circles tumble, rapier, 4 dt, fine substeps",
        ],
    );
}

/// Flat plates and discs as wings.
#[test]
fn static_polars() {
    assert_bars(SectionName::Polars, 33, &[]);
}

/// Weighted cards glide, upright whatever the release.
#[test]
fn gliders() {
    assert_bars(SectionName::Gliders, 2, &[]);
}

/// How fast strips tumble, and from which mass on.
#[test]
fn strips_that_tumble() {
    assert_bars(
        SectionName::Strips,
        3,
        &[
            "cards that tumble, exponent of the spin by width",
            "strips between flutter and tumbling, Froude number",
        ],
    );
}

#[test]
fn maple_seed() {
    assert_bars(
        SectionName::Seed,
        12,
        &[
            "maple seed: descent, as one plate, stand-alone, 1/1920 s",
            "maple seed: spin, as one plate, stand-alone, 1/1920 s",
        ],
    );
}

#[test]
fn drag_of_spheres_and_discs() {
    assert_bars(SectionName::Drag, 22, &[]);
}

#[test]
fn drag_of_bodies_that_are_not_plates() {
    assert_bars(SectionName::Bluff, 31, &[]);
}

#[test]
fn added_mass() {
    // Boundary elements: three motions of two plates, and a cube.
    let solved = if cfg!(feature = "bake") { 7 } else { 0 };
    assert_bars(SectionName::AddedMass, 29 + solved, &[]);
}

#[test]
fn ideal_fluid() {
    assert_bars(SectionName::Kirchhoff, 20, &[]);
}

#[test]
fn energy_in_still_fluid() {
    assert_bars(SectionName::Energy, 3, &[]);
}

#[test]
fn plate_in_two_dimensions() {
    assert_bars(SectionName::FallingPlate, 22, &[]);
}

#[test]
fn figures_of_the_thesis() {
    assert_bars(SectionName::Thesis, 11, &[]);
}

/// Half the step has twice the moments, and four times the step a quarter.
#[test]
fn runners_record_every_step() {
    let plate = Plate::new(1.0 / 8.0, Regime::PeriodicTumbling).unwrap();
    let mut experiment = plate.experiment(&ViscousLaw::default(), 0.8, 1).unwrap();
    experiment.seconds = 0.5;
    for (runner, count) in [
        (Runner::Alone, 121),
        (Runner::HalfStep, 241),
        (Runner::Rapier(1), 121),
        (Runner::Rapier(4), 31),
        (Runner::Fine(4), 31),
    ] {
        let fall = runner.run(&experiment).unwrap();
        assert_eq!(fall.moments.len(), count, "{}", runner.name());
    }
}

/// Bars, misses and what is only shown, in the table and for machines.
#[test]
fn what_is_not_met_is_shown_as_not_met() {
    let rows = vec![
        Row::number("close", [2.0, 2.1], "m/s", Some(0.1), "a book"),
        Row::number("far", [2.0, 1.0], "m/s", Some(0.1), "a book"),
        Row::number("lost", [2.0, f64::NAN], "m/s", Some(0.1), "a book"),
        Row::share("few", 0.5, 0.7, "a map"),
        Row::within("none", [1.0, 2.0], None, "a map"),
        Row::word("regime", ["flutter", "flutter"], "a film"),
        Row::at_most("context", 0.3, None, "a film"),
    ];
    let verdicts: Vec<Verdict> = rows.iter().map(|row| row.verdict).collect();
    use Verdict::{Met, NotMet, Shown};
    assert_eq!(verdicts, [Met, NotMet, NotMet, NotMet, NotMet, Met, Shown]);
    assert_eq!(rows[0].measured, Quantity::Number(2.0, "m/s"));
    let sections = [Section {
        name: "test",
        title: "rows",
        rows,
        pictures: Vec::new(),
    }];
    let table = report::table(&sections);
    assert_eq!(table.matches("NOT MET").count(), 4);
    assert!(table.contains("| far     | 2.000 m/s"), "{table}");
    let summary = report::summary(&sections);
    assert_eq!(summary, "2 of 6 bars are met, 1 numbers have none.");
    let json = report::json(&sections);
    assert_eq!(json["sections"][0]["rows"][1]["verdict"], "not met");
    assert_eq!(json["sections"][0]["rows"][1]["error"], -0.5);
}

#[test]
fn sections_come_in_order_and_once() {
    let all = SectionName::chosen(&[]);
    assert_eq!(all, SectionName::value_variants());
    assert_eq!(Effort::Full.choose(1, 2), 1);
    let two = SectionName::chosen(&[SectionName::Energy, SectionName::Drag, SectionName::Energy]);
    assert_eq!(two, [SectionName::Drag, SectionName::Energy]);
}
