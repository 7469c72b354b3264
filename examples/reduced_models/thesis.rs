//! The four examples of thesis §6.4.

use crate::Outcome;
use crate::chart::{COLORS, Mark, Panel, SeriesLabelPosition, draw};
use indicatif::ProgressBar;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rapier3d_immersed::reduced::Axis;
use rapier3d_immersed::reduced::PgdParams;
use rapier3d_immersed::reduced::QuadraticSystem;
use rapier3d_immersed::reduced::Separated;
use rapier3d_immersed::reduced::Tolerances;
use rapier3d_immersed::reduced::example_systems::{
    coupled_triple, falling_body, falling_body_solution, kirchhoff_ellipsoid, linear,
    linear_solution,
};
use rapier3d_immersed::reduced::{Coupling, EvolutionParams, evolve};
use std::path::Path;
use std::time::Instant;

const TIGHT: Tolerances = Tolerances {
    relative: 1e-10,
    absolute: 1e-11,
    max_steps: 100_000,
};
/// What a reference solver needs to be as accurate as the baked model.
const USUAL: Tolerances = Tolerances {
    relative: 1e-4,
    absolute: 1e-4,
    max_steps: 100_000,
};

fn params(max_modes: usize, coupling: Coupling) -> EvolutionParams {
    EvolutionParams {
        pgd: PgdParams {
            max_modes,
            tolerance: 1e-9,
            ..PgdParams::default()
        },
        coupling,
        ..EvolutionParams::default()
    }
}

fn sampled(count: usize, start: f64, end: f64, f: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let at = |i| start + (end - start) * i as f64 / (count - 1) as f64;
    (0..count).map(at).map(|x| (x, f(x))).collect()
}

/// L² error of u − u⁰ relative to it, at random points off the grid.
struct Checks<'a> {
    system: &'a QuadraticSystem,
    points: Vec<(Vec<f64>, Vec<f64>)>,
}

impl<'a> Checks<'a> {
    fn new(system: &'a QuadraticSystem, end: f64, count: usize) -> Self {
        let mut random = Pcg64::seed_from_u64(5);
        let mut points = Vec::new();
        while points.len() < count {
            let mut point = vec![random.random_range(0.0..end)];
            point.extend(
                system
                    .parameters
                    .iter()
                    .map(|a| random.random_range(a.start()..a.end())),
            );
            if let Ok(state) = system.integrate(&point[1..], point[0], TIGHT) {
                points.push((point, state));
            }
        }
        Self { system, points }
    }

    fn error(&self, u: &Separated) -> f64 {
        let (mut squares, mut norm) = (0.0, 0.0);
        for (point, exact) in &self.points {
            let start = self.system.initial_state(&point[1..]);
            for ((value, exact), start) in u.evaluate(point).iter().zip(exact).zip(start) {
                squares += (value - exact).powi(2);
                norm += (exact - start).powi(2);
            }
        }
        (squares / norm).sqrt()
    }
}

/// Thesis Figs. 6.2, 6.3.
pub fn linear_problem(path: &Path, _: &ProgressBar) -> Outcome {
    let k = Axis::spectral(1.0, 10.0, 52)?;
    let time = Axis::time(0.0, 10.0, 4, 2)?;
    let (u, report) = evolve(
        &linear(k.clone()),
        &time,
        &params(5, Coupling::Monolithic),
        |_, _| (),
    )?;
    let mut solution = Panel::new("(6.18): lines t(10/k − 1), dots separated", "t", "u");
    let mut error = Panel::new("error", "t", "|error|");
    error.log_y = true;
    let mut worst = 0.0_f64;
    for (color, k) in COLORS.iter().zip([1.0, 1.5, 2.5, 5.0, 10.0]) {
        let off = |t| (u.evaluate(&[t, k])[0] - linear_solution(t, k)).abs();
        solution.add(
            &format!("k = {k}"),
            *color,
            Mark::Line,
            sampled(2, 0.0, 10.0, |t| linear_solution(t, k)),
        );
        solution.add(
            "",
            *color,
            Mark::Dots,
            sampled(11, 0.0, 10.0, |t| u.evaluate(&[t, k])[0]),
        );
        let mut errors = sampled(41, 0.0, 10.0, off);
        worst = errors.iter().fold(worst, |w, (_, e)| w.max(*e));
        // At k = 10 the solution is zero, and so is the error but for underflow.
        errors.retain(|(_, error)| *error > 1e-16);
        if !errors.is_empty() {
            error.add(&format!("k = {k}"), *color, Mark::Line, errors);
        }
    }
    solution.legend = Some(SeriesLabelPosition::UpperLeft);
    error.legend = Some(SeriesLabelPosition::LowerRight);
    let mut factors = Panel::new("the only mode's factor in k", "k", "K(k), normalised");
    factors.add(
        "",
        COLORS[1],
        Mark::Line,
        sampled(200, 1.0, 10.0, |k| u.factor(1, 0, 0, k)),
    );
    draw(path, 3, &[solution, error, factors])?;
    Ok(serde_json::json!({ "modes": report.modes, "worst_error": worst }))
}

/// Thesis Figs. 6.4, 6.5.
pub fn falling(path: &Path, _: &ProgressBar) -> Outcome {
    let system = falling_body(Axis::spectral(0.5, 2.0, 20)?);
    let time = Axis::time(0.0, 1.0, 24, 4)?;
    let mut history = Vec::new();
    let (u, report) = evolve(&system, &time, &params(12, Coupling::Monolithic), |n, u| {
        let (mut squares, mut norm) = (0.0, 0.0);
        for i in 0..=100 {
            for j in 0..=40 {
                let (t, drag) = (f64::from(i) / 100.0, 0.5 + 1.5 * f64::from(j) / 40.0);
                let exact = falling_body_solution(t, drag);
                squares += (u.evaluate(&[t, drag])[0] - exact).powi(2);
                norm += exact * exact;
            }
        }
        history.push((n as f64, (squares / norm).sqrt()));
    })?;
    let mut solution = Panel::new("(6.20): lines exact, dots separated", "t, s", "u, m/s");
    for (color, drag) in COLORS.iter().zip([0.5, 0.75, 1.0, 1.5, 2.0]) {
        let exact = sampled(200, 0.0, 1.0, |t| falling_body_solution(t, drag));
        solution.add(&format!("C_D = {drag}"), *color, Mark::Line, exact);
        solution.add(
            "",
            *color,
            Mark::Dots,
            sampled(21, 0.0, 1.0, |t| u.evaluate(&[t, drag])[0]),
        );
    }
    let mut convergence = Panel::new("convergence", "enrichments", "relative error");
    convergence.log_y = true;
    convergence.add("error", COLORS[0], Mark::LineAndDots, history.clone());
    let residuals = report
        .residuals
        .iter()
        .enumerate()
        .map(|(n, r)| (n as f64 + 1.0, *r));
    convergence.add(
        "residual",
        COLORS[5],
        Mark::LineAndDots,
        residuals.collect(),
    );
    draw(path, 2, &[solution, convergence])?;
    Ok(serde_json::json!({ "after_5": history[4].1, "finally": history[history.len() - 1].1 }))
}

/// Thesis Figs. 6.6, 6.7.
pub fn coupled(path: &Path, bar: &ProgressBar) -> Outcome {
    let system = coupled_triple(&Axis::spectral(0.0, 1.0, 10)?);
    let time = Axis::time(0.0, 0.5, 3, 4)?;
    let checks = Checks::new(&system, 0.5, 300);
    let mut convergence = Panel::new(
        "(6.22): convergence",
        "enrichments",
        "relative error of u − u⁰",
    );
    convergence.log_y = true;
    let mut numbers = serde_json::Map::new();
    let mut baked = None;
    for (color, name, coupling, modes) in [
        (COLORS[0], "monolithic", Coupling::Monolithic, 44),
        (COLORS[1], "decoupled", Coupling::Decoupled, 30),
    ] {
        bar.set_message(format!("coupled, {name}"));
        let clock = Instant::now();
        let mut history = Vec::new();
        let (u, _) = evolve(&system, &time, &params(modes, coupling), |n, u| {
            history.push((n as f64, checks.error(u)));
        })?;
        let seconds = clock.elapsed().as_secs_f64();
        numbers.insert(
            name.into(),
            serde_json::json!({ "after_8": history[7].1, "after_24": history[23].1,
                "finally": history[history.len() - 1].1, "seconds": seconds }),
        );
        convergence.add(name, color, Mark::LineAndDots, history);
        baked = Some(u);
    }
    let u = baked.expect("two were baked");
    let mut panels = Vec::new();
    for start in [
        [0.0, 0.0, 0.0],
        [0.2, 0.9, 0.5],
        [1.0, 0.3, 0.1],
        [0.0, 1.0, 1.0],
    ] {
        let mut panel = Panel::new(&format!("from {start:?}"), "t", "u (lines: reference)");
        for k in 0..3 {
            let exact = |t: f64| {
                system
                    .integrate(&start, t, TIGHT)
                    .map_or(f64::NAN, |state| state[k])
            };
            panel.add(
                &format!("u{}", k + 1),
                COLORS[[0, 2, 1][k]],
                Mark::Line,
                sampled(60, 0.0, 0.5, exact),
            );
            let value = |t: f64| u.evaluate(&[t, start[0], start[1], start[2]])[k];
            panel.add(
                "",
                COLORS[[0, 2, 1][k]],
                Mark::Dots,
                sampled(11, 0.0, 0.5, value),
            );
        }
        panel.legend = Some(SeriesLabelPosition::UpperLeft);
        panels.push(panel);
    }
    panels.push(convergence);
    bar.set_message("coupled, cost");
    let (cost, [separated, solved]) = cost(&system, &time)?;
    panels.push(cost);
    numbers.insert("separated_ms_at_20".into(), separated.into());
    numbers.insert("times_faster_at_20".into(), (solved / separated).into());
    draw(path, 3, &panels)?;
    Ok(numbers.into())
}

/// Cost of all final states over the number of initial values along each axis (Fig. 6.7b), with a
/// model of 12 enrichments: the picture, and the milliseconds at 20, separated and solved one by one.
fn cost(
    system: &QuadraticSystem,
    time: &Axis,
) -> Result<(Panel, [f64; 2]), Box<dyn std::error::Error>> {
    let (u, _) = evolve(system, time, &params(12, Coupling::Decoupled), |_, _| ())?;
    let (mut separated, mut solved) = (Vec::new(), Vec::new());
    for n in [2, 5, 10, 20, 40] {
        let values: Vec<f64> = (0..n).map(|i| f64::from(i) / f64::from(n - 1)).collect();
        let median = |mut work: Box<dyn FnMut() -> f64 + '_>| -> f64 {
            let mut times: Vec<f64> = (0..7)
                .map(|_| {
                    let clock = Instant::now();
                    std::hint::black_box(work());
                    clock.elapsed().as_secs_f64() * 1e3
                })
                .collect();
            times.sort_by(f64::total_cmp);
            times[3]
        };
        let grid = || u.grid(&[&[0.5], &values, &values, &values])[0];
        separated.push((f64::from(n), median(Box::new(grid))));
        let all = || {
            let mut sum = 0.0;
            for x in &values {
                for y in &values {
                    for z in &values {
                        let mut state = [*x, *y, *z];
                        let rate = |_: f64, u: &[f64], out: &mut [f64]| {
                            out.copy_from_slice(&[
                                1.0 - u[1] * u[2],
                                2.0 - u[0] * u[2],
                                3.0 - u[0] * u[1],
                            ]);
                        };
                        rapier3d_immersed::reduced::integrate(rate, 0.0, 0.5, &mut state, USUAL);
                        sum += state[0];
                    }
                }
            }
            sum
        };
        solved.push((f64::from(n), median(Box::new(all))));
    }
    let at_20 = [separated[3].1, solved[3].1];
    let mut panel = Panel::new(
        "cost of all final states",
        "initial values per axis",
        "time, ms",
    );
    (panel.log_x, panel.log_y) = (true, true);
    panel.add("solving each", COLORS[5], Mark::LineAndDots, solved);
    panel.add("separated", COLORS[0], Mark::LineAndDots, separated);
    panel.legend = Some(SeriesLabelPosition::UpperLeft);
    Ok((panel, at_20))
}

/// Thesis Fig. 6.8.
pub fn kirchhoff(path: &Path, _: &ProgressBar) -> Outcome {
    let system = kirchhoff_ellipsoid(&Axis::spectral(0.0, 1.0, 5)?)?;
    let time = Axis::time(0.0, 1.0, 3, 3)?;
    let checks = Checks::new(&system, 1.0, 300);
    let mut history = Vec::new();
    let clock = Instant::now();
    let (u, report) = evolve(&system, &time, &params(45, Coupling::Decoupled), |n, u| {
        history.push((n as f64, checks.error(u)));
    })?;
    let seconds = clock.elapsed().as_secs_f64();
    let exact = |t: f64, k: usize| {
        system
            .integrate(&[1.0; 6], t, TIGHT)
            .map_or(f64::NAN, |state| state[k])
    };
    let value = |t: f64, k: usize| u.evaluate(&[t, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0])[k];
    let mut motion = Panel::new("(6.24) from (1, 1, 1, 1, 1, 1)", "t, s", "u, m/s; ω, rad/s");
    let mut error = Panel::new("error", "t, s", "|error|");
    for k in 0..6 {
        let name = ["u1", "u2", "u3", "ω1", "ω2", "ω3"][k];
        motion.add(
            name,
            COLORS[k],
            Mark::Line,
            sampled(60, 0.0, 1.0, |t| exact(t, k)),
        );
        motion.add(
            "",
            COLORS[k],
            Mark::Dots,
            sampled(11, 0.0, 1.0, |t| value(t, k)),
        );
    }
    for (name, color, range) in [
        ("translation", COLORS[0], 0..3),
        ("rotation", COLORS[2], 3..6),
    ] {
        let off = |t: f64| {
            range
                .clone()
                .map(|k| (value(t, k) - exact(t, k)).powi(2))
                .sum::<f64>()
                .sqrt()
        };
        error.add(name, color, Mark::Line, sampled(60, 0.0, 1.0, off));
    }
    motion.legend = Some(SeriesLabelPosition::LowerLeft);
    error.legend = Some(SeriesLabelPosition::UpperLeft);
    let mut convergence = Panel::new(
        "convergence over [0, 1]⁶",
        "enrichments",
        "relative error of u − u⁰",
    );
    convergence.log_y = true;
    convergence.add("", COLORS[0], Mark::LineAndDots, history.clone());
    draw(path, 3, &[motion, error, convergence])?;
    Ok(
        serde_json::json!({ "error": history[history.len() - 1].1, "modes": report.modes, "seconds": seconds }),
    )
}
