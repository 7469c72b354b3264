//! The thesis's card: Figs. 5.6 (its four patterns) and 5.12 (the curvature of their paths), and how far apart
//! they land under what the thesis leaves open.

use crate::Context;
use crate::draw::{Item, Panel, color};
use crate::falls::{GREY, side};
use rapier3d_immersed::motion::{Classifier, Pattern, Spread, Trajectory, TurnFinder};
use rapier3d_immersed::training::{Experiment, Parameter};
use rapier3d_immersed::{Error, ThesisLaw};
use serde_json::{Value, json};

/// Pattern, coefficients as printed, those of the damped law where there are any, printed d (cm; that of AZ by the list of
/// figures: the caption repeats 1.25) and e.
type Case = (Pattern, [f64; 3], Option<[f64; 3]>, [f64; 2]);

const PATTERNS: [Case; 4] = [
    (
        Pattern::SteadyDescent,
        ThesisLaw::STEADY_DESCENT,
        Some(ThesisLaw::DAMPED_STEADY_DESCENT),
        [1.25, 0.72],
    ),
    (
        Pattern::Zigzag,
        ThesisLaw::ZIGZAG,
        Some(ThesisLaw::DAMPED_ZIGZAG),
        [5.69, 0.79],
    ),
    (
        Pattern::AutorotationZigzag,
        ThesisLaw::AUTOROTATION_ZIGZAG,
        Some(ThesisLaw::DAMPED_AUTOROTATION_ZIGZAG),
        [13.72, 0.93],
    ),
    (
        Pattern::Autorotation,
        ThesisLaw::AUTOROTATION,
        None,
        [22.43, 0.92],
    ),
];

/// The numbers of one fall.
fn row(fall: &Trajectory) -> Value {
    let spread = fall.spread();
    let seen = Classifier::default().classify(fall);
    let seconds = fall.duration() * (1.0 - Classifier::default().transient);
    json!({
        "d_cm": 100.0 * spread.distance,
        "e": spread.eccentricity,
        "direct": seen.regime.abbreviation(),
        "pattern_seen": Pattern::from(seen.regime).abbreviation(),
        "half_turns_per_second": f64::from(seen.flips) / seconds,
    })
}

/// Figs. 5.6 and 5.12.
pub fn four_patterns(context: &Context) -> Result<(Value, Value), Error> {
    let (mut panels, mut rows) = (Vec::new(), Vec::new());
    let mut curves = Panel::new("", "time, s", "curvature, 1/cm (ZZ, AZ, AR raised)");
    let mut turns = Vec::new();
    for (index, (pattern, printed, damped, [d, e])) in PATTERNS.into_iter().enumerate() {
        let fall_under = |law| Experiment::thesis_card(law)?.for_training().run();
        let fall = fall_under(ThesisLaw::printed(printed))?;
        let numbers = row(&fall);
        let title = format!(
            "{pattern}: d = {:.1} cm, seen as {}",
            100.0 * fall.spread().distance,
            Classifier::default().classify(&fall).regime
        );
        let mut panel = Panel::new(title, "x, cm", "y, cm");
        panel.items = side(&fall, 0.07, 15, color(pattern));
        panels.push(panel);
        rows.push(json!({
            "pattern": pattern.abbreviation(),
            "coefficients": printed,
            "printed": { "d_cm": d, "e": e },
            "as_printed": numbers,
            "damped_coefficients": damped,
            "damped": match damped {
                Some(damped) => row(&fall_under(ThesisLaw::new(damped))?),
                None => json!(null),
            },
        }));
        turns.push(curvature(&mut curves, &fall, pattern, 0.2 * index as f64));
    }
    let title = "Fig. 5.6: card of semi-axes 3.5 × 2 × 0.01 cm, the law as printed, from rest at 10°, 3 s (scales differ)";
    context.write("fig_5_6_patterns.svg", title, &panels, 4, (330, 520));
    curves.window = Some([(0.0, 3.0), (0.0, 1.2)]);
    let title = "Fig. 5.12: curvature of the paths of Fig. 5.6 and its maxima (red SD, green ZZ, blue AZ, magenta AR)";
    context.write("fig_5_12_curvature.svg", title, &[curves], 1, (980, 460));
    let readings = readings()?;
    Ok((
        json!({ "patterns": rows, "distances_under_readings": readings }),
        json!(turns),
    ))
}

/// Adds the curvature of a path, raised by `offset`, and its maxima with a tolerance of 0.1 /cm.
fn curvature(panel: &mut Panel, fall: &Trajectory, pattern: Pattern, offset: f64) -> Value {
    let per_cm: Vec<f64> = fall.curvatures().iter().map(|k| 0.01 * k).collect();
    let time = |i: usize| (i + 1) as f64 * fall.interval;
    let line = per_cm.iter().enumerate();
    let line = line
        .map(|(i, k)| (time(i), (k + offset).min(1.2)))
        .collect();
    panel.items.push(Item::Line(line, color(pattern), 1));
    let mut finder = TurnFinder::new(0.035, TurnFinder::TOLERANCE);
    let (mut found, mut since) = (Vec::new(), 0);
    for (i, moment) in fall.moments.iter().enumerate() {
        if finder.push(moment.position) {
            let end = (i - 1).min(per_cm.len());
            let highest = (since..end).max_by(|a, b| per_cm[*a].total_cmp(&per_cm[*b]));
            found.extend(highest);
            since = end;
        }
    }
    let dots = found
        .iter()
        .map(|i| (time(*i), (per_cm[*i] + offset).min(1.2)));
    panel
        .items
        .push(Item::Dots(dots.collect(), color(pattern), 3));
    let mut sorted = per_cm.clone();
    sorted.sort_by(f64::total_cmp);
    json!({
        "pattern": pattern.abbreviation(),
        "maxima": found.len(),
        "median_curvature_per_cm": sorted[sorted.len() / 2],
        "first_maxima_s": found.iter().take(5).map(|i| time(*i)).collect::<Vec<_>>(),
    })
}

/// Where a fall ends that is compared.
enum End {
    Seconds(f64),
    Depth(f64),
}

/// The four distances d under several readings of what the thesis leaves open: medians of five releases
/// around 10°, since chaos makes single ones arbitrary.
fn readings() -> Result<Value, Error> {
    let plane = Some(0.0);
    let cases = [
        ("the card, 3 s", 1.0, None, End::Seconds(3.0)),
        (
            "exactly about the short axis, 3 s",
            1.0,
            plane,
            End::Seconds(3.0),
        ),
        ("the same, 4.5 m deep", 1.0, plane, End::Depth(4.5)),
        ("twice the mass, 3 s", 2.0, None, End::Seconds(3.0)),
        (
            "twice the mass, exactly about the short axis, 3 s",
            2.0,
            plane,
            End::Seconds(3.0),
        ),
        (
            "twice the mass, exactly about the short axis, 5 s",
            2.0,
            plane,
            End::Seconds(5.0),
        ),
    ];
    let mut rows = Vec::new();
    for (name, heavier, tilt_axis, end) in cases {
        let (mut distances, mut seen) = (Vec::new(), Vec::new());
        let mut off = 0.0;
        for (_, printed, _, [printed_distance, _]) in PATTERNS {
            let mut card = Experiment::thesis_card(ThesisLaw::printed(printed))?.for_training();
            Parameter::Mass.set(heavier * card.mass.mass, &mut card, &mut [1.0; 3])?;
            card.release.tilt_axis = tilt_axis.unwrap_or(card.release.tilt_axis);
            card.seconds = match end {
                End::Seconds(seconds) => seconds,
                End::Depth(_) => 6.0,
            };
            let mut sorted = Vec::new();
            for tenth in -2..=2 {
                card.release.tilt = (10.0 + 0.1 * f64::from(tenth)).to_radians();
                let fall = card.run()?;
                let count = match end {
                    End::Seconds(_) => fall.moments.len(),
                    End::Depth(depth) => {
                        let arrived = fall.moments.iter().position(|m| m.position.y < -depth);
                        arrived.unwrap_or(fall.moments.len() - 1) + 1
                    }
                };
                let part = fall.moments[..count].to_vec();
                let part = Trajectory {
                    moments: part,
                    ..fall
                };
                let regime = Classifier::default().classify(&part).regime;
                sorted.push((100.0 * Spread::of(&part.moments).distance, regime));
            }
            sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
            off += (sorted[2].0 / printed_distance).ln().abs() / 4.0;
            distances.push(sorted[2].0);
            seen.push(
                sorted
                    .iter()
                    .map(|s| s.1.abbreviation())
                    .collect::<Vec<_>>(),
            );
        }
        rows.push(json!({
            "reading": name,
            "d_cm": distances,
            "direct": seen,
            "mean_factor_off": f64::exp(off),
        }));
    }
    Ok(json!(rows))
}

/// Fig. 5.11: the motion graph, its states from left to right, with the measured transition probabilities.
pub fn graph(context: &Context) -> Value {
    let graph = rapier3d_immersed::motion::MotionGraph::thesis();
    let mut panel = Panel::bare("");
    let at = |state: usize| 3.0 * state as f64;
    for from in 0..4 {
        for to in from..4 {
            let probability = graph.probability(from, to);
            if probability == 0.0 {
                continue;
            }
            let (a, b) = (at(from), at(to));
            // Arcs over the states: to itself a loop, to the next a line, farther ones higher, every second below.
            let span = (to - from) as f64;
            let side = if (to - from) == 2 { -1.0 } else { 1.0 };
            let arc = (0..=40).map(|i| {
                let s = f64::from(i) / 40.0;
                if to == from {
                    let turn = std::f64::consts::TAU * s;
                    (a - 0.45 * turn.sin(), 0.75 - 0.45 * turn.cos())
                } else {
                    let height = if to - from == 1 { 0.0 } else { 0.75 * span };
                    let x = a + 0.55 + (b - a - 1.1) * s;
                    (x, side * 4.0 * height * s * (1.0 - s))
                }
            });
            let arc: Vec<(f64, f64)> = arc.collect();
            let middle = arc[20];
            let tip = arc[40];
            panel.items.push(Item::Line(arc.clone(), GREY, 2));
            if to != from {
                let before = arc[37];
                let (dx, dy) = (tip.0 - before.0, tip.1 - before.1);
                let size = dx.hypot(dy) / 0.16;
                let (dx, dy) = (dx / size, dy / size);
                let head = vec![
                    (tip.0 - dx + 0.6 * dy, tip.1 - dy - 0.6 * dx),
                    tip,
                    (tip.0 - dx - 0.6 * dy, tip.1 - dy + 0.6 * dx),
                ];
                panel.items.push(Item::Line(head, GREY, 2));
            }
            let above = (middle.0, middle.1 + if to == from { 0.3 } else { 0.25 });
            panel
                .items
                .push(Item::Label(above, format!("{probability}"), GREY));
        }
    }
    for pattern in Pattern::ALL {
        let x = at(pattern.index());
        let circle = (0..=48).map(|i| {
            let turn = std::f64::consts::TAU * f64::from(i) / 48.0;
            (x + 0.3 * turn.cos(), 0.3 * turn.sin())
        });
        let ink = color(pattern);
        panel.items.push(Item::Line(circle.collect(), ink, 3));
        panel
            .items
            .push(Item::Label((x, 0.0), pattern.to_string(), ink));
    }
    let title =
        "Fig. 5.11: transitions of the motion graph with the measured probabilities, thesis (5.25)";
    context.write("fig_5_11_graph.svg", title, &[panel], 1, (980, 520));
    let rows: Vec<Vec<f64>> = (0..4)
        .map(|from| (0..4).map(|to| graph.probability(from, to)).collect())
        .collect();
    json!({ "states": Pattern::ALL.map(Pattern::abbreviation), "probabilities": rows })
}
