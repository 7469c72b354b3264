//! The boat's hull against Wigley's closed forms, its righting levers against soundings and the barge's formula, and its
//! motions against the sea's.

use crate::righting::{Vessel, heeled, vanishing};
use crate::seakeeping::{Voyage, response, significant};
use crate::support::mesh;
use crate::wigley::{CELLS, DINGHY};
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::na::Matrix3;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Medium};
use std::path::Path;

const CENTER: f64 = 0.05;

fn file() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/boat/wigley.obj")
}

fn hull() -> Surface {
    mesh::load(&file()).unwrap().solid(0.0).unwrap()
}

fn boat() -> Vessel {
    Vessel::new(hull(), CENTER)
}

/// The file is what the formula gives. `UPDATE_WIGLEY=1` writes it.
#[test]
fn the_file_is_of_the_formula() {
    let text = DINGHY.obj(CELLS);
    if std::env::var_os("UPDATE_WIGLEY").is_some() {
        std::fs::write(file(), &text).unwrap();
    }
    assert!(std::fs::read_to_string(file()).unwrap() == text);
    let triangles = hull().triangles().len();
    assert!((200..=400).contains(&triangles), "{triangles}");
}

/// Volume ⁴⁄₉ L B T, waterplane ⅔ L B, BM ³⁄₃₅ B²/T of the hull of parabolas. What is inscribed in a parabola of n pieces
/// misses 1/n² of its area, or 1/4n² of half of it; with both the volume is that of the formula to 2·10⁻³ here, and goes
/// there with the square of the cells.
#[test]
fn the_hull_is_wigleys() {
    let under = |cells: [usize; 2]| {
        let (vertices, triangles) = DINGHY.mesh(cells);
        let triangles: Vec<_> = triangles.iter().map(|t| t.map(|i| i as u32)).collect();
        let hull = Surface::new(&vertices, &triangles).unwrap();
        let hydro = HydroProperties::from_surface(&hull, Default::default());
        hydro.hull.under_plane(&Matrix3::identity(), 0.0, [0.0; 2])
    };
    for cells in [CELLS, CELLS.map(|n| 4 * n)] {
        let [along, down] = cells.map(|n| n as f64);
        let inscribed = (1.0 - 1.0 / (along * along)) * (1.0 - 0.25 / (down * down));
        let found = under(cells);
        let miss = found.volume / DINGHY.displacement() - 1.0;
        println!(
            "{cells:?}: volume {miss:+.2e}, inscribed {:+.2e}",
            inscribed - 1.0
        );
        assert!((found.volume / DINGHY.displacement() / inscribed - 1.0).abs() < 2e-3);
        let plane = found.waterplane.area / DINGHY.waterplane() / (1.0 - 1.0 / (along * along));
        assert!((plane - 1.0).abs() < 1e-6, "{plane}");
        let center = found.moment.y / found.volume;
        let metacenter = center + found.waterplane.second[2] / found.volume;
        let miss = metacenter / DINGHY.metacenter() - 1.0;
        println!("  metacenter {miss:+.2e}");
        assert!(miss.abs() < 8.0 / (along * along), "{miss}");
    }
}

/// A barge's GZ is sin θ (GM + ½ BM tan² θ) until its deck goes under (Attwood; Rawson & Tupper, *Basic Ship Theory*).
#[test]
fn levers_of_a_barge() {
    let barge = Vessel::barge([4.0, 1.0, 0.8], 0.3, 0.0);
    let heels: Vec<f64> = (1..=15)
        .map(|i| (2.0 * f64::from(i)).to_radians())
        .collect();
    let bm = 1.0 / (12.0 * 0.3);
    for (heel, lever) in heels.iter().zip(barge.levers(&heels)) {
        let exact = heel.sin() * (bm - 0.15 + 0.5 * bm * heel.tan().powi(2));
        assert!(
            (lever / exact - 1.0).abs() < 1e-4,
            "{heel}: {lever} for {exact}"
        );
    }
    // Soundings know it, too, to a fiftieth of their grid's 8 mm.
    for (heel, lever) in heels.iter().zip(barge.sounded_levers(&heels)) {
        let exact = heel.sin() * (bm - 0.15 + 0.5 * bm * heel.tan().powi(2));
        assert!(
            (lever - exact).abs() < 1.6e-4,
            "{heel}: {lever} for {exact}"
        );
    }
}

/// GZ of the crate's forces against vertical soundings of the same triangles: within 1 % up to 60°, and the heel at which
/// it vanishes within .2°. Its slope upright is GM.
#[test]
fn levers_of_the_boat() {
    let boat = boat();
    let heels: Vec<f64> = (0..=60)
        .map(|i| (3.0 * f64::from(i)).to_radians())
        .collect();
    let [ours, sounded] = [boat.levers(&heels), boat.sounded_levers(&heels)];
    let most = ours.iter().copied().fold(0.0, f64::max);
    for ((heel, a), b) in heels.iter().zip(&ours).zip(&sounded) {
        println!("{:5.0}° {a:.5} {b:.5}", heel.to_degrees());
        assert!((a - b).abs() < 0.01 * most, "{heel}: {a} for {b}");
        if *heel > 0.01 && *heel < 61_f64.to_radians() {
            assert!((a / b - 1.0).abs() < 0.01, "{heel}: {a} for {b}");
        }
    }
    let ends = [&ours, &sounded].map(|curve| vanishing(&heels, curve).unwrap().to_degrees());
    println!("vanishing at {ends:?}");
    assert!((ends[0] - ends[1]).abs() < 0.2, "{ends:?}");
    let slope = boat.levers(&[0.01])[0] / 0.01;
    let metacentric = DINGHY.metacenter() - CENTER;
    println!("GM {slope} for {metacentric}");
    assert!((slope / metacentric - 1.0).abs() < 0.05);
}

/// Let go short of the heel at which the lever vanishes the boat comes back upright, beyond it it turns over: through
/// rapier, with all that moves.
#[test]
fn the_vanishing_heel_decides() {
    let boat = boat();
    let heels: Vec<f64> = (0..=60)
        .map(|i| (3.0 * f64::from(i)).to_radians())
        .collect();
    let vanishing = vanishing(&heels, &boat.levers(&heels)).unwrap();
    for (beyond, upright) in [(-0.1, true), (0.1, false)] {
        let heel = vanishing + beyond;
        let medium = Medium::layered(Fluid::AIR, Fluid::WATER);
        let mut afloat = boat.afloat(medium, heeled(heel, boat.height(heel)), 1.0 / 60.0);
        (0..1800).for_each(|_| afloat.step());
        let up = (afloat.body().rotation() * Vector::Y).y;
        println!("let go at {:.1}°: {up}", heel.to_degrees());
        assert_eq!(up > 0.95, upright, "{up}");
        assert!(upright || up < 0.0, "{up}");
    }
}

/// In a sea much longer than the boat it goes up and down with the water; nothing is lost in its record.
#[test]
fn the_boat_follows_a_long_sea() {
    let voyage = Voyage {
        height: 0.6,
        period: 7.0,
        seed: 2,
        heading: 1.0,
        seconds: 160.0,
    };
    let record = voyage.record(&boat()).unwrap();
    assert_eq!(record.times.len(), record.heave.len());
    assert!(
        record
            .heave
            .iter()
            .chain(&record.roll)
            .all(|x| x.is_finite())
    );
    let [sea, heave] = [&record.elevation, &record.heave].map(|series| significant(series));
    println!(
        "{sea} {heave}, roll {}",
        significant(&record.roll).to_degrees()
    );
    assert!((heave / sea - 1.0).abs() < 0.05, "{heave} of {sea}");
    let follows = response(&record.elevation, &record.heave);
    for (frequency, share) in follows {
        if frequency < 0.2 {
            assert!((share - 1.0).abs() < 0.06, "{frequency}: {share}");
        }
    }
    assert!(record.submerged[0] < 0.9 && record.submerged[1] > 0.0);
}
