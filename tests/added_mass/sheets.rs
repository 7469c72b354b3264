//! Bodies without thickness.

use crate::{as_is, assert_within, ellipsoid, solve_ellipsoid};
use rapier3d_immersed::AddedMass;
use rapier3d_immersed::boundary_element::BoundaryElementParams;
use rapier3d_immersed::geometry::Sheet;
use std::f64::consts::PI;

fn solve(sheet: &Sheet) -> AddedMass {
    AddedMass::solve_sheet(sheet, &as_is()).unwrap().0
}

/// 8/3 ρa³ broadside and 16/45 ρa⁵ about a diameter (Lamb § 108).
#[test]
fn circular_disc() {
    let disc = solve(&Sheet::elliptic_disc(1.0, 1.0, 0.001, 12).unwrap());
    assert_within(disc.linear[(2, 2)], 8.0 / 3.0, 0.01, "broadside");
    assert_within(disc.angular[(0, 0)], 16.0 / 45.0, 0.01, "about a diameter");
    assert_within(disc.angular[(1, 1)], 16.0 / 45.0, 0.01, "about the other");
    // Nothing else moves fluid.
    assert!(disc.linear[(0, 0)].abs() < 1e-11 && disc.angular[(2, 2)].abs() < 1e-11);
    assert!(disc.is_physical());
    assert!(disc.coupling.norm() < 1e-3);
}

/// Thin rectangles b × a: m / (π/4 ρa²b), I about the long axis / (π/128 ρa⁴b), about the short one
/// / (π/48 ρa²b³), from an independent hypersingular collocation with Richardson extrapolation; the
/// first column agrees with DNV-RP-C205.
#[test]
fn rectangles() {
    for (b, mass, about_long, about_short) in [
        (1.0, 0.57901, 0.8176, 0.3066),
        (2.0, 0.75688, 0.9079, 0.4947),
        (5.0, 0.89668, 0.963, 0.7348),
        (10.0, 0.94758, 0.982, 0.8545),
    ] {
        let plate = solve(&Sheet::rectangle(b, 1.0, 0.001, 20).unwrap());
        let what = |name| format!("{b}:1 {name}");
        assert_within(
            plate.linear[(2, 2)] / (PI / 4.0 * b),
            mass,
            0.01,
            &what("mass"),
        );
        let long = plate.angular[(0, 0)] / (PI / 128.0 * b);
        assert_within(long, about_long, 0.01, &what("about the long axis"));
        let short = plate.angular[(1, 1)] / (PI / 48.0 * b.powi(3));
        assert_within(short, about_short, 0.01, &what("about the short axis"));
    }
}

/// The leaf of 7.3 × 4.2 cm, 0.3 mm thick: closed surface, sheet and exact elliptic disc within 2 %.
#[test]
fn leaf_as_sheet_as_solid_and_exactly() {
    let exact = ellipsoid(3.65, 2.1, 0.0).added_mass();
    let sheet = solve(&Sheet::elliptic_disc(3.65, 2.1, 0.03, 12).unwrap());
    let solid = solve_ellipsoid(&ellipsoid(3.65, 2.1, 0.015), 8);
    for (added, name) in [(&sheet, "sheet"), (&solid, "solid")] {
        assert_within(added.linear[(2, 2)], exact.linear[(2, 2)], 0.01, name);
        for i in 0..2 {
            assert_within(added.angular[(i, i)], exact.angular[(i, i)], 0.01, name);
        }
    }
    for i in 0..2 {
        assert_within(
            sheet.angular[(i, i)],
            solid.angular[(i, i)],
            0.02,
            "sheet to solid",
        );
    }
}

/// A coarse sheet is refined by itself: toward its free edges.
#[test]
fn coarse_sheet_is_refined() {
    let sheet = Sheet::rectangle(1.0, 1.0, 0.001, 2).unwrap();
    let params = BoundaryElementParams {
        tolerance: 0.02,
        max_panels: 4000,
        ..BoundaryElementParams::default()
    };
    let (plate, report) = AddedMass::solve_sheet(&sheet, &params).unwrap();
    println!("{report:?}");
    assert!(report.converged, "{report:?}");
    assert_within(plate.linear[(2, 2)] / (PI / 4.0), 0.57901, 0.02, "square");
}

/// A sheet all of whose vertices lie on its rim has no unknown: as it is it moves nothing, refined it
/// does.
#[test]
fn sheet_without_unknowns() {
    let sheet = Sheet::rectangle(1.0, 1.0, 0.001, 1).unwrap();
    assert_eq!(sheet.triangles().len(), 2);
    assert!(solve(&sheet).linear.norm() < 1e-12);
    let params = BoundaryElementParams {
        tolerance: 0.05,
        ..BoundaryElementParams::default()
    };
    let (refined, _) = AddedMass::solve_sheet(&sheet, &params).unwrap();
    assert_within(refined.linear[(2, 2)] / (PI / 4.0), 0.57901, 0.05, "square");
}
