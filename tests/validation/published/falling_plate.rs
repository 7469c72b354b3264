//! The quasi-steady plate in two dimensions (thesis (2.14)–(2.20) in the thin-plate limit of Andersen,
//! Pesavento & Wang 2005) against golden values: it verifies code and is no model of real plates.

use super::draw::{self, Item, Panel, Point};
use super::report::Row;
use super::{Computed, Effort, Failure, Progress};
use plotters::style::RGBColor;
use rapier3d_immersed::reduced::FallingPlate;
use rapier3d_immersed::reduced::Tolerances;
use std::f64::consts::{FRAC_PI_4, PI};

/// I*, whether it tumbles, period (tumbling: per half turn), mean drift and descent, largest spin.
/// Recomputed with DOP853 at a relative tolerance of 1e-11.
const GOLDEN: [(f64, bool, [f64; 4]); 5] = [
    (0.5, false, [6.3771, 0.0, 0.30110, 0.92683]),
    (0.8, false, [9.2849, 0.0, 0.32611, 0.81957]),
    (1.0, false, [13.3145, 0.0, 0.45283, 0.56126]),
    (1.1, false, [15.9530, 0.0, 0.58453, 0.53174]),
    (1.4, true, [6.4214, 0.75593, 0.32667, 0.79218]),
];
const SOURCE: &str = "golden value, DOP853 to 1e-11";
/// Where the same start changes from flutter to tumbling.
const TRANSITION: f64 = 1.21915;
const SAMPLES: usize = 2000;
const START: [f64; 6] = [1e-3, 1e-3, 1e-3, FRAC_PI_4, 0.0, 0.0];

fn plate(inertia_ratio: f64) -> FallingPlate {
    FallingPlate {
        inertia_ratio,
        ..FallingPlate::default()
    }
}

fn tolerances() -> Tolerances {
    Tolerances {
        relative: 1e-11,
        absolute: 1e-11,
        ..Tolerances::default()
    }
}

/// After a transient of 400: the states over 10 golden periods.
fn late(i_star: f64, period: f64) -> Vec<[f64; 6]> {
    let plate = plate(i_star);
    let mut start = START;
    plate.advance(&mut start, 400.0, tolerances());
    let last = 10 * SAMPLES;
    let times: Vec<f64> = (0..=last)
        .map(|i| period * i as f64 / SAMPLES as f64)
        .collect();
    plate.trajectory(&start, &times, tolerances())
}

/// Times at which `phase` grows through zero, by linear interpolation.
fn crossings(states: &[[f64; 6]], dt: f64, phase: impl Fn(&[f64; 6]) -> f64) -> Vec<f64> {
    let values: Vec<f64> = states.iter().map(phase).collect();
    (1..values.len())
        .filter(|i| values[i - 1] < 0.0 && values[*i] >= 0.0)
        .map(|i| dt * (i as f64 - values[i] / (values[i] - values[i - 1])))
        .collect()
}

pub fn compute(_: Effort, progress: Progress) -> Result<Computed, Failure> {
    let mut rows = Vec::new();
    let mut panels = Vec::new();
    for (case, (i_star, tumbles, golden)) in GOLDEN.into_iter().enumerate() {
        let [period, drift, descent, spin] = golden;
        let states = late(i_star, period);
        let dt = period / SAMPLES as f64;
        let times = if tumbles {
            // Upright once per half turn.
            let sense = states[states.len() - 1][3] - states[0][3];
            crossings(&states, dt, |s| {
                (s[3] * sense.signum()).sin() * (s[3]).cos()
            })
        } else {
            crossings(&states, dt, |s| s[2])
        };
        let [first, .., last] = times[..] else {
            return Err(format!("I* = {i_star}: no period found").into());
        };
        let cycles = (times.len() - 1) as f64;
        let between = |k: usize| (states[10 * SAMPLES][k] - states[0][k]) / (10.0 * period);
        let fastest = states.iter().map(|s| s[2].abs()).fold(0.0, f64::max);
        let mut row = |what: &str, pair: [f64; 2]| {
            let case = format!("I* = {i_star}, {what}");
            rows.push(Row::number(case, pair, "", Some(1e-3), SOURCE));
        };
        row("period", [period, (last - first) / cycles]);
        row("descent", [descent, -between(5)]);
        row("largest spin", [spin, fastest]);
        if tumbles {
            row("drift", [drift, between(4).abs()]);
        } else {
            let case = format!("I* = {i_star}, drift (none)");
            let ours = between(4).abs();
            rows.push(Row::at_most(case, ours, Some(1e-3), SOURCE));
        }
        panels.push(panel(i_star, tumbles, &states));
        progress((case + 1) as f64 / 6.0);
    }
    for (i_star, expected) in [
        (TRANSITION - 1e-4, "flutter"),
        (TRANSITION + 1e-4, "tumbling"),
    ] {
        let mut state = START;
        plate(i_star).advance(&mut state, 600.0, tolerances());
        let turned = (state[3] / PI).abs();
        let ours = if turned > 10.0 { "tumbling" } else { "flutter" };
        let case = format!("I* = {i_star}: a transition at 1.21915");
        rows.push(Row::word(case, [expected, ours], SOURCE));
    }
    let title =
        "The quasi-steady plate of Andersen, Pesavento & Wang 2005: path and section, two periods";
    let picture = draw::svg(title, &panels, 5, (280, 560))?;
    Ok((rows, vec![("falling_plate.svg".into(), picture)]))
}

fn panel(i_star: f64, tumbles: bool, states: &[[f64; 6]]) -> Panel {
    let regime = if tumbles { "tumbling" } else { "flutter" };
    let title = format!("I* = {i_star}: {regime}");
    let mut panel = Panel::new(title, "semi-chords", "semi-chords").equal();
    let cycles = if tumbles { 4 } else { 2 };
    let shown = &states[..cycles * SAMPLES];
    let path: Vec<Point> = shown.iter().step_by(10).map(|s| (s[4], s[5])).collect();
    panel
        .items
        .push(Item::Line(path, RGBColor(150, 150, 150), 1));
    for s in shown.iter().step_by(cycles * SAMPLES / 48) {
        let (sin, cos) = s[3].sin_cos();
        let ends = vec![(s[4] - cos, s[5] - sin), (s[4] + cos, s[5] + sin)];
        panel.items.push(Item::Line(ends, RGBColor(30, 60, 150), 2));
    }
    panel
}
