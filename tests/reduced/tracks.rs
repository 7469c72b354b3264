//! Measured falls of paper (Howison, Hughes & Iida 2020, `tests/data/paper`): forecasts of them, and coefficients
//! identified from them. The fits are those of `fits.csv`, which the example `tracks` writes; some are made again.

use crate::fits::FallFit;
use crate::forecast::{DEFAULT, Family, KNOWN, PHYSICAL, THESIS, defaults, moved, straight_on};
use crate::measured::{CAMERAS, Fall, Paper, RATE, STATE, divergence};
use rapier3d_immersed::ViscousLaw;
use rapier3d_immersed::rapier3d::na::Vector3;

const FALLS: &str = include_str!("../data/paper/falls.csv");
const REPEATS: &str = include_str!("../data/paper/repeats.csv");

fn fit<'a>(fits: &'a [FallFit], fall: &Fall, family: &Family, of: &Fall) -> &'a FallFit {
    let names = (fall.name, family.name, of.name);
    let mut found = fits.iter();
    found
        .find(|f| (&*f.fall, &*f.law, &*f.coefficients_of) == names)
        .unwrap_or_else(|| panic!("no fit {names:?}"))
}

/// The cells of a file, by column.
fn table(text: &'static str) -> impl Fn(&str) -> Vec<&'static str> {
    let mut lines = text.lines();
    let heads: Vec<&str> = lines.next().unwrap().split(',').collect();
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    move |head| {
        let column = heads.iter().position(|h| *h == head).unwrap();
        rows.iter().map(|row| row[column]).collect()
    }
}

fn numbers(cells: &[&str]) -> Vec<f64> {
    cells.iter().map(|cell| cell.parse().unwrap()).collect()
}

/// Numbers of segments by class are those of the published files, and mean descent and drift of the circles
/// those that were computed from them before, independently.
#[test]
fn the_table_of_falls_is_that_of_the_published_segments() {
    let column = table(FALLS);
    let (shapes, classes) = (column("shape"), column("class_automatic"));
    let (descent, drift) = (
        numbers(&column("descent_mps")),
        numbers(&column("drift_mps")),
    );
    for (shape, class, count, means) in [
        ("circle", "tumbling", 69, Some([0.724, 0.415])),
        ("circle", "chaotic", 101, Some([0.776, 0.295])),
        ("circle", "steady_or_periodic", 48, None),
        ("hexagon", "tumbling", 34, None),
        ("hexagon", "chaotic", 87, None),
        ("hexagon", "steady_or_periodic", 48, None),
    ] {
        let rows = (0..shapes.len()).filter(|i| (shapes[*i], classes[*i]) == (shape, class));
        let rows: Vec<usize> = rows.collect();
        assert_eq!(rows.len(), count, "{shape}, {class}");
        for (values, mean) in [&descent, &drift]
            .into_iter()
            .zip(means.into_iter().flatten())
        {
            let ours = rows.iter().map(|i| values[*i]).sum::<f64>() / count as f64;
            assert!((ours - mean).abs() < 6e-4, "{shape}, {class}: {ours}");
        }
    }
    // Re from its definition, to what is lost where it and the descent were rounded.
    let (re, radius) = (numbers(&column("re")), numbers(&column("radius_m")));
    for i in 0..re.len() {
        let own = 2.0 * radius[i] * descent[i] / 1.48e-5;
        let rounded = 0.5 + 2.0 * radius[i] * 5e-5 / 1.48e-5;
        assert!(
            (re[i] - own).abs() < 1.01 * rounded,
            "{i}: {} and {own}",
            re[i]
        );
    }
}

/// The tracks end with the segments of the table, and repeats of one experiment are a diameter apart as soon as
/// most pairs of that size are.
#[test]
fn tracks_belong_to_the_table_and_repeats_part_soon() {
    let column = table(FALLS);
    let (shapes, falls, last) = (column("shape"), column("fall"), column("last_frame"));
    let indices = [
        "5", "27", "3", "29", "2", "77", "22", "23", "115", "117", "18", "21",
    ];
    let tracks = Fall::all().unwrap();
    for (track, index) in tracks.iter().zip(indices) {
        let shape = if track.hexagon { "hexagon" } else { "circle" };
        let row = (0..falls.len()).rfind(|i| (shapes[*i], falls[*i]) == (shape, index));
        let end = track.times[track.times.len() - 1] * RATE;
        assert_eq!(format!("{end:.0}"), last[row.unwrap()], "{}", track.name);
        assert!(
            track.positions[track.positions.len() - 1].z > 0.049,
            "{}",
            track.name
        );
    }
    let column = table(REPEATS);
    let slow = numbers(&column("divergence_three_quarters_s"));
    assert!(slow.iter().all(|t| *t < 0.6), "{slow:?}");
    for pair in tracks.chunks(2) {
        let parted = divergence(
            &moved(&pair[0], &pair[1]),
            &pair[0].positions,
            pair[0].diameter(),
        );
        assert!(parted.unwrap() < 0.35, "{}: {parted:?}", pair[0].name);
    }
}

/// A paper that falls edge on hardly feels the air at first: g t²/2, averaged over five frames as the tracks
/// are. One that lies flat shows each camera its area times the cosine to its normal, over the distance's
/// square.
#[test]
fn a_paper_is_seen_as_the_cameras_saw_it() {
    let falls = Fall::all().unwrap();
    let (edge, flat) = (&falls[0], &falls[6]);
    assert!(edge.edge_down && !flat.edge_down);
    let state: [f64; STATE.len()] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.1, 0.2, 0.9];
    let law = ViscousLaw::default();
    let seen = Paper::new(edge).unwrap().fall(law, &state, 8).unwrap();
    for (frame, position) in seen.positions.iter().enumerate() {
        let times = (frame..frame + 5).map(|k| k as f64 / RATE);
        let fallen = times.map(|t| 0.5 * 9.81 * t * t).sum::<f64>() / 5.0;
        // Friction takes 0.3 % of the speed by then.
        let off = (0.9 - position.z) / fallen - 1.0;
        assert!((-0.02..1e-6).contains(&off), "{frame}: {off}");
        assert!((position.xy() - Vector3::new(0.1, 0.2, 0.0).xy()).norm() < 1e-9);
        assert!(seen.normals[frame].x.abs() > 0.999_999);
    }
    let seen = Paper::new(flat).unwrap().fall(law, &state, 1).unwrap();
    for (view, camera) in seen.views.iter().zip(CAMERAS) {
        let sight = seen.positions[0] - camera;
        let expected = sight.z.abs() / sight.norm() / sight.norm_squared();
        assert!(
            (view[0] / expected - 1.0).abs() < 1e-4,
            "{} and {expected}",
            view[0]
        );
    }
}

/// From a state that was estimated from 0.2 s, each fall under the default law stays within a diameter for
/// longer than the repeat of the experiment does, and than a paper that would go straight on, and shows the
/// cameras as much as the measured one for another 0.2 s (correlation above one half); what does not is listed.
/// The estimate itself is good to 5 mm, 2.5 deviations of the data, for the small papers only: the large ones
/// dive and pull up more sharply than the law lets them (and paper of 84 mm bends).
#[test]
fn forecasts_outlast_repeats() {
    const MISSED: &[(&str, &str)] = &[
        ("circle_16mm_edge_a", "straight on"),
        ("circle_16mm_edge_a", "views"),
        ("circle_16mm_edge_b", "straight on"),
        ("circle_16mm_edge_b", "views"),
        ("circle_44mm_edge_a", "estimate"),
        ("circle_44mm_edge_a", "views"),
        ("circle_44mm_edge_b", "estimate"),
        ("circle_44mm_edge_b", "views"),
        ("circle_18mm_flat_a", "straight on"),
        ("circle_18mm_flat_a", "views"),
        ("circle_18mm_flat_b", "views"),
        ("hexagon_18mm_edge_a", "repeat"),
        ("hexagon_18mm_edge_a", "straight on"),
        ("hexagon_18mm_edge_a", "views"),
        ("hexagon_42mm_edge_a", "estimate"),
        ("hexagon_42mm_edge_a", "views"),
        ("hexagon_42mm_edge_b", "estimate"),
    ];
    let (falls, fits) = (Fall::all().unwrap(), FallFit::shipped().unwrap());
    let mut missed = Vec::new();
    for (i, fall) in falls.iter().enumerate() {
        let forecast = fit(&fits, fall, &DEFAULT, fall)
            .forecast(fall, &DEFAULT)
            .unwrap();
        let until = |path: &[Vector3<f64>]| {
            divergence(path, &fall.positions, fall.diameter()).unwrap_or(f64::INFINITY)
        };
        let ours = forecast.divergence.unwrap_or(f64::INFINITY);
        let bars = [
            ("repeat", ours > until(&moved(fall, &falls[i ^ 1]))),
            ("straight on", ours > until(&straight_on(fall))),
            ("estimate", forecast.residual() < 0.005),
            (
                "views",
                forecast.view_correlation(fall, KNOWN, 2 * KNOWN) > 0.5,
            ),
        ];
        missed.extend(
            bars.iter()
                .filter(|bar| !bar.1)
                .map(|bar| (fall.name, bar.0)),
        );
    }
    assert_eq!(missed, MISSED);
}

/// The file is read as it was written, and what it says of one state is a minimum: a descent from there ends
/// there.
#[test]
fn a_shipped_state_is_found_again() {
    let (falls, fits) = (Fall::all().unwrap(), FallFit::shipped().unwrap());
    assert_eq!(FallFit::csv(&fits), include_str!("../data/paper/fits.csv"));
    let fall = &falls[2];
    let shipped = fit(&fits, fall, &DEFAULT, fall);
    assert!(shipped.converged);
    let again = FallFit::new(fall, &DEFAULT, Some(&shipped.parameters)).unwrap();
    assert!(
        (again.residual / shipped.residual - 1.0).abs() < 2e-3,
        "{again:?}"
    );
    for (k, name) in STATE.iter().enumerate() {
        let off = (again.parameters[k] - shipped.parameters[k]) / shipped.deviations[k];
        assert!(off.abs() < 0.2, "{name}: {off} deviations");
        // Made again elsewhere, deviations are the same to the precision of differences.
        let ratio = again.deviations[k] / shipped.deviations[k];
        assert!((ratio - 1.0).abs() < 0.1, "{name}: {ratio}");
    }
}

/// Four coefficients of the default law from 0.41 s of a circle of 24 mm, and from its repeat: three of them
/// agree within two deviations, ε does not (the deviations are too small by up to √5, since the errors of five
/// frames go together). With the coefficients of the one fall, and its own state, the other stays within a
/// diameter of its forecast for longer than straight on and than the repeat; and for longer than under the law as
/// it is in one of two cases. C_s is about half of what the calibration on many plates has.
#[test]
fn coefficients_of_a_circle_are_identified_and_hold_for_its_repeat() {
    let (falls, fits) = (Fall::all().unwrap(), FallFit::shipped().unwrap());
    let pair = [&falls[2], &falls[3]];
    let found = pair.map(|fall| fit(&fits, fall, &PHYSICAL, fall));
    let again = FallFit::new(pair[0], &PHYSICAL, Some(&found[0].parameters)).unwrap();
    assert!(
        (again.residual / found[0].residual - 1.0).abs() < 0.01,
        "{again:?}"
    );
    let count = PHYSICAL.coefficients.len();
    for fit in found {
        assert!(fit.residual < 1.0, "{fit:?}");
        assert!(fit.at_bound.iter().all(|k| *k >= count), "{fit:?}");
        let below = (defaults()[0] - fit.parameters[0]) / fit.deviations[0];
        assert!(below > 3.0, "C_s: {below} deviations");
    }
    let apart: Vec<f64> = (0..count)
        .map(|k| {
            let deviation = found[0].deviations[k].hypot(found[1].deviations[k]);
            (found[0].parameters[k] - found[1].parameters[k]).abs() / deviation
        })
        .collect();
    let agree: Vec<bool> = apart.iter().map(|a| *a < 2.0).collect();
    assert_eq!(agree, [true, true, false, true], "{apart:?}");
    let mut longer = 0;
    for (one, other) in [(0, 1), (1, 0)] {
        let fall = pair[other];
        let until = |path: &[Vector3<f64>]| divergence(path, &fall.positions, fall.diameter());
        let held = fit(&fits, fall, &PHYSICAL, pair[one]);
        let held = held.forecast(fall, &PHYSICAL).unwrap().divergence;
        let as_is = fit(&fits, fall, &DEFAULT, fall);
        let as_is = as_is.forecast(fall, &DEFAULT).unwrap().divergence;
        assert!(held > until(&straight_on(fall)), "{held:?}");
        assert!(held > until(&moved(fall, pair[one])), "{held:?}");
        longer += usize::from(held > as_is);
    }
    assert_eq!(longer, 1);
}

/// The thesis's law, fitted to four circles that tumble: its C_D is that of a disc broadside on (1.17, Hoerner)
/// within 5 %. Its C_L1 is negative each time, however: no set of coefficients that the thesis prints (C_L1 of 0.31 to
/// 2.71) is that of paper that tumbles.
#[test]
fn the_thesis_law_finds_the_drag_of_a_disc_in_tracks_and_another_lift() {
    let (falls, fits) = (Fall::all().unwrap(), FallFit::shipped().unwrap());
    for fall in &falls[..4] {
        let shipped = fit(&fits, fall, &THESIS, fall);
        assert!(shipped.residual < 1.6, "{shipped:?}");
        let [drag, lift] = [shipped.parameters[0], shipped.parameters[1]];
        assert!((drag / 1.17 - 1.0).abs() < 0.05, "{}: {drag}", fall.name);
        assert!(
            lift + 5.0 * shipped.deviations[1] < 0.0,
            "{}: {lift}",
            fall.name
        );
    }
    // What of the file is made again here.
    let shipped = fit(&fits, &falls[1], &THESIS, &falls[1]);
    let again = FallFit::new(&falls[1], &THESIS, Some(&shipped.parameters)).unwrap();
    assert!(
        (again.residual / shipped.residual - 1.0).abs() < 0.01,
        "{again:?}"
    );
}
