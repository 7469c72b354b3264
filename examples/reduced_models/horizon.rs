//! Three ways to separate a falling plate over (C_T, C_R, A, density ratio, release angle): the
//! trajectory, the flow map over a short time, the rates. Error against horizon, off the grid.

use crate::Outcome;
use crate::alternatives;
use crate::chart::{COLORS, Mark, Panel, SeriesLabelPosition, draw};
use crate::errors::{Errors, Truth};
use crate::free_fall::Domain;
use crate::own_horizon::{self, Curves, FLOW_MAP, TRAJECTORY};
use crate::rates;
use indicatif::ProgressBar;
use rapier3d_immersed::reduced::Axis;
use rapier3d_immersed::reduced::FallingPlate;
use rapier3d_immersed::reduced::Tolerances;
use rapier3d_immersed::reduced::{CrossParams, cross};
use rapier3d_immersed::reduced::{FlowMap, TrajectorySurrogate};
use std::collections::BTreeMap;
use std::error::Error;
use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;
use std::time::Instant;

pub const TOLERANCES: Tolerances = Tolerances {
    relative: 1e-8,
    absolute: 1e-8,
    max_steps: 100_000,
};
pub const HORIZONS: [f64; 6] = [1.0, 2.0, 5.0, 10.0, 20.0, 40.0];
const STEP: f64 = 0.25;

pub fn plate(p: &[f64]) -> FallingPlate {
    FallingPlate::with_coefficients(p[3], [p[0], p[1], p[2], 1.0, 0.2])
}

pub fn start(angle: f64) -> [f64; 6] {
    [1e-3, 1e-3, 1e-3, angle, 0.0, 0.0]
}

/// Coefficients ± 5 %, and I* over the range.
pub fn parameters((low, high): (f64, f64), nodes: usize) -> Result<Vec<Axis>, Box<dyn Error>> {
    let around = |x: f64| Axis::spectral(0.95 * x, 1.05 * x, nodes);
    Ok(vec![
        around(1.2)?,
        around(PI)?,
        around(1.4)?,
        Axis::spectral(low, high, nodes)?,
    ])
}

pub fn release_angle() -> Result<Axis, Box<dyn Error>> {
    Ok(Axis::spectral(0.5, 1.0, 9)?)
}

/// The axes of (u, v, ω, θ): kinks of |ω|ω and at rest fall on the ends of elements.
fn state() -> Result<Vec<Axis>, Box<dyn Error>> {
    Ok(vec![
        Axis::elements(-2.5, 2.5, 2, 5)?,
        Axis::elements(-1.6, 1.6, 2, 5)?,
        Axis::elements(-1.6, 1.6, 2, 5)?,
        Axis::spectral(-FRAC_PI_2, FRAC_PI_2, 10)?,
    ])
}

/// Half turns of the body axes change the signs of u and v alone: the equal state with θ within
/// (−π/2, π/2), and the sign.
pub fn reduced(x: &[f64]) -> ([f64; 4], f64) {
    let turns = (x[3] / PI).round();
    let sign = if turns % 2.0 == 0.0 { 1.0 } else { -1.0 };
    ([sign * x[0], sign * x[1], x[2], x[3] - turns * PI], sign)
}

fn truth(range: (f64, f64)) -> Result<Truth, Box<dyn Error>> {
    let mut axes = parameters(range, 2)?;
    axes.push(release_angle()?);
    Ok(Truth::new(&axes, &HORIZONS, 150, |p, times| {
        let states = plate(p).trajectory(&start(p[4]), times, TOLERANCES);
        states.iter().map(|s| [s[4], 0.0]).collect()
    }))
}

/// One surrogate of whole trajectories per horizon, each with the same budget.
fn trajectories(range: (f64, f64), truth: &Truth) -> Result<Errors, Box<dyn Error>> {
    let mut errors = Vec::new();
    for (h, end) in HORIZONS.into_iter().enumerate() {
        let time = Axis::elements(0.0, end, (end / 2.0).ceil() as usize, 6)?;
        let mut axes = parameters(range, 9)?;
        axes.push(release_angle()?);
        let model = |p: &[f64], times: &[f64], out: &mut [f64]| {
            let states = plate(p).trajectory(&start(p[4]), times, TOLERANCES);
            out.iter_mut()
                .zip(states)
                .for_each(|(out, state)| *out = state[4]);
        };
        let params = CrossParams {
            tolerance: 1e-7,
            max_evaluations: 15_000,
            ..CrossParams::default()
        };
        let (surrogate, _) = TrajectorySurrogate::bake(time, 1, axes, model, &params)?;
        let all = truth.errors(|p, times| {
            let positions = surrogate.evaluate(p, times);
            positions.iter().map(|x| [*x, 0.0]).collect()
        });
        errors.push(all[h]);
    }
    Ok(errors)
}

/// The errors, and the microseconds of a step.
fn flow_map(range: (f64, f64), truth: &Truth) -> Result<(Errors, f64), Box<dyn Error>> {
    let model = |s: &[f64], p: &[f64], change: &mut [f64]| {
        let mut end = [s[0], s[1], s[2], s[3], 0.0, 0.0];
        plate(p).advance(&mut end, STEP, TOLERANCES);
        for k in 0..4 {
            change[k] = end[k] - s[k];
        }
        change[4] = end[4];
    };
    let params = CrossParams {
        tolerance: 1e-5,
        max_evaluations: 300_000,
        rank_growth: 3,
        max_rank: 60,
        ..CrossParams::default()
    };
    let (map, _) = FlowMap::bake(STEP, state()?, parameters(range, 4)?, 1, model, &params)?;
    let mut scratch = Vec::new();
    let (mut steps, clock) = (0, Instant::now());
    let errors = truth.errors(|p, _| {
        let mut x = start(p[4]);
        let mut change = [0.0; 5];
        let mut positions = Vec::new();
        for i in 1..=(HORIZONS[5] / STEP) as usize {
            let (inside, sign) = reduced(&x);
            map.change(&inside, &p[..4], &mut change, &mut scratch);
            for (k, sign) in [sign, sign, 1.0, 1.0, 1.0].into_iter().enumerate() {
                x[k] += sign * change[k];
            }
            steps += 1;
            if HORIZONS.iter().any(|h| (h - i as f64 * STEP).abs() < 1e-9) {
                positions.push([x[4], 0.0]);
            }
        }
        positions
    });
    Ok((
        errors,
        clock.elapsed().as_secs_f64() * 1e6 / f64::from(steps),
    ))
}

/// The rates themselves as a tensor train, integrated as they are.
fn separated_rates(range: (f64, f64), truth: &Truth) -> Result<Errors, Box<dyn Error>> {
    let params = CrossParams {
        tolerance: 1e-5,
        max_evaluations: 300_000,
        rank_growth: 3,
        max_rank: 60,
        ..CrossParams::default()
    };
    let axes = [state()?, parameters(range, 4)?].concat();
    let (train, _) = cross(axes, 5, rates::exact, &params)?;
    let train = train.rounded(1e-6);
    let loose = Tolerances {
        relative: 1e-5,
        absolute: 1e-5,
        max_steps: 20_000,
    };
    let mut scratch = Vec::new();
    Ok(truth.errors(|p, _| {
        rates::integrated(p, &HORIZONS, loose, |point, out| {
            train.evaluate_into(point, out, &mut scratch);
        })
    }))
}

const RATES: &str = "separated rates, integrated";

fn panel(name: &str, unit: &str, curves: &Curves) -> Panel {
    let mut panel = Panel::new(
        name,
        &format!("horizon T{unit}"),
        "error of position(T) / its spread over the domain",
    );
    (panel.log_x, panel.log_y) = (true, true);
    for (label, errors) in curves {
        let color = match *label {
            TRAJECTORY => COLORS[0],
            FLOW_MAP => COLORS[1],
            alternatives::DEIM => COLORS[3],
            alternatives::PIECEWISE_LINEAR => COLORS[4],
            _ => COLORS[2],
        };
        panel.add(label, color, Mark::LineAndDots, errors.clone());
    }
    panel.legend = Some(SeriesLabelPosition::LowerRight);
    panel
}

/// One panel per domain: within one pattern, and across the boundary of two.
fn draw_panels(
    path: &Path,
    unit: &str,
    all: Vec<(&'static str, Curves)>,
    mut numbers: serde_json::Map<String, serde_json::Value>,
) -> Outcome {
    let mut panels = Vec::new();
    for (name, curves) in all {
        panels.push(panel(name, unit, &curves));
        let curves: BTreeMap<&str, Errors> = curves.into_iter().collect();
        numbers.insert(name.into(), serde_json::json!(curves));
    }
    draw(path, 2, &panels)?;
    Ok(numbers.into())
}

/// The plate of this module, by every method.
pub fn planar(path: &Path, bar: &ProgressBar) -> Outcome {
    let mut numbers = serde_json::Map::new();
    let mut all = Vec::new();
    for (name, range) in [
        ("planar model: flutter, I* .45 to .55", (0.45, 0.55)),
        ("planar model: across tumbling, I* 1.1 to 1.4", (1.1, 1.4)),
    ] {
        let truth = truth(range)?;
        let mut curves = Vec::new();
        let mut costs = serde_json::Map::new();
        bar.set_message(format!("{name}: trajectories"));
        curves.push((TRAJECTORY, trajectories(range, &truth)?));
        bar.set_message(format!("{name}: flow map"));
        let (errors, microseconds) = flow_map(range, &truth)?;
        costs.insert(format!("{FLOW_MAP}, µs per step"), microseconds.into());
        curves.push((FLOW_MAP, errors));
        bar.set_message(format!("{name}: rates"));
        curves.push((RATES, separated_rates(range, &truth)?));
        bar.set_message(format!("{name}: DEIM"));
        let (errors, cost) = alternatives::deim(range, &truth)?;
        curves.push((alternatives::DEIM, errors));
        costs.insert(alternatives::DEIM.into(), cost);
        bar.set_message(format!("{name}: piecewise linear"));
        let (errors, cost) = alternatives::piecewise_linear(range, &truth)?;
        curves.push((alternatives::PIECEWISE_LINEAR, errors));
        costs.insert(alternatives::PIECEWISE_LINEAR.into(), cost);
        numbers.insert(format!("{name}: cost"), costs.into());
        all.push((name, curves));
    }
    draw_panels(path, ", dimensionless", all, numbers)
}

/// The crate's own dynamics: a plate in water under the default law.
pub fn plate_in_water(path: &Path, bar: &ProgressBar) -> Outcome {
    let domains = [Domain::LIGHT, Domain::HEAVY];
    let curves = domains.map(|d| own_horizon::plate(&d, bar).map(|c| (d.name, c)));
    let all = curves.into_iter().collect::<Result<_, _>>()?;
    draw_panels(path, ", s", all, serde_json::Map::new())
}

/// The crate's own dynamics: a card in air under the thesis's law.
pub fn card_in_air(path: &Path, bar: &ProgressBar) -> Outcome {
    let domains = [Domain::ZIGZAG, Domain::AUTOROTATION];
    let curves = domains.map(|d| own_horizon::card(&d, bar).map(|c| (d.name, c)));
    let all = curves.into_iter().collect::<Result<_, _>>()?;
    draw_panels(path, ", s", all, serde_json::Map::new())
}
