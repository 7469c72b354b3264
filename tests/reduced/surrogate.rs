//! Surrogates of dynamics that are no polynomials, on the falling plate: error against horizon,
//! off the grid, relative to the standard deviation of the quantity over the domain.

use crate::errors::Truth;
use rapier3d_immersed::reduced::Axis;
use rapier3d_immersed::reduced::CrossParams;
use rapier3d_immersed::reduced::FallingPlate;
use rapier3d_immersed::reduced::Tolerances;
use rapier3d_immersed::reduced::{FlowMap, TrajectorySurrogate};
use std::f64::consts::{FRAC_PI_2, PI};

const TOLERANCES: Tolerances = Tolerances {
    relative: 1e-7,
    absolute: 1e-7,
    max_steps: 100_000,
};

/// Coefficients within 5 % of the defaults and I* in a range.
fn parameters(low: f64, high: f64, nodes: usize) -> Vec<Axis> {
    let around = |x: f64| Axis::spectral(0.95 * x, 1.05 * x, nodes).unwrap();
    vec![
        around(1.2),
        around(PI),
        around(1.4),
        Axis::spectral(low, high, nodes).unwrap(),
    ]
}

fn plate(p: &[f64]) -> FallingPlate {
    FallingPlate::with_coefficients(p[3], [p[0], p[1], p[2], 1.0, 0.2])
}

fn start(angle: f64) -> [f64; 6] {
    [1e-3, 1e-3, 1e-3, angle, 0.0, 0.0]
}

fn truth(low: f64, high: f64, end: f64) -> Truth {
    let mut axes = parameters(low, high, 2);
    axes.push(Axis::spectral(0.5, 1.0, 2).unwrap());
    Truth::new(&axes, &[end], 60, |p, times| {
        let states = plate(p).trajectory(&start(p[4]), times, TOLERANCES);
        states.iter().map(|state| [state[4], 0.0]).collect()
    })
}

fn trajectory_error(low: f64, high: f64, end: f64, max_evaluations: usize) -> f64 {
    let time = Axis::elements(0.0, end, (end / 2.0).ceil() as usize, 6).unwrap();
    let mut axes = parameters(low, high, 7);
    axes.push(Axis::spectral(0.5, 1.0, 9).unwrap());
    let model = |p: &[f64], times: &[f64], out: &mut [f64]| {
        let states = plate(p).trajectory(&start(p[4]), times, TOLERANCES);
        for (out, state) in out.iter_mut().zip(states) {
            *out = state[4];
        }
    };
    let params = CrossParams {
        tolerance: 1e-5,
        max_evaluations,
        ..CrossParams::default()
    };
    let (surrogate, _) = TrajectorySurrogate::bake(time, 1, axes, model, &params).unwrap();
    let errors = truth(low, high, end).errors(|p, times| {
        let positions = surrogate.evaluate(p, times);
        positions.iter().map(|x| [*x, 0.0]).collect()
    });
    errors[0].1
}

/// A separated trajectory is accurate over a short time and useless over a long one that crosses
/// the transition from flutter to tumbling (I* = 1.22). That it fails there is a property of the
/// function, not of the solver; the test keeps anyone from claiming otherwise.
#[test]
fn separated_trajectories_fail_at_the_transition() {
    let short = trajectory_error(1.1, 1.4, 2.0, 4000);
    let long = trajectory_error(1.1, 1.4, 20.0, 2000);
    println!("T = 2: {short:.1e}, T = 20: {long:.1e}");
    assert!(short < 1e-4, "{short:e}");
    assert!(long > 0.1, "{long:e}");
}

/// The flow map over 0.25 time units, iterated 80 times across the same domain, stays within a
/// tenth. A half turn of the body axes changes the signs of u and v alone, so that every angle can be
/// taken into (−π/2, π/2).
#[test]
fn iterated_flow_maps_cross_the_transition() {
    let step = 0.25;
    let state = vec![
        Axis::elements(-2.5, 2.5, 2, 4).unwrap(),
        Axis::elements(-1.6, 1.6, 2, 4).unwrap(),
        Axis::elements(-1.6, 1.6, 2, 4).unwrap(),
        Axis::spectral(-FRAC_PI_2, FRAC_PI_2, 8).unwrap(),
    ];
    let model = |s: &[f64], p: &[f64], change: &mut [f64]| {
        let mut end = [s[0], s[1], s[2], s[3], 0.0, 0.0];
        plate(p).advance(
            &mut end,
            step,
            Tolerances {
                relative: 1e-5,
                absolute: 1e-5,
                ..TOLERANCES
            },
        );
        for k in 0..4 {
            change[k] = end[k] - s[k];
        }
        change[4] = end[4];
    };
    let params = CrossParams {
        tolerance: 1e-4,
        max_evaluations: 60_000,
        max_rank: 30,
        rank_growth: 3,
        ..CrossParams::default()
    };
    let (map, report) =
        FlowMap::bake(step, state, parameters(1.1, 1.4, 3), 1, model, &params).unwrap();
    println!("{report:?}, ranks {:?}", map.train().ranks());
    let position = |p: &[f64], _: &[f64]| {
        let mut x = start(p[4]);
        let (mut change, mut scratch) = ([0.0; 5], Vec::new());
        for _ in 0..80 {
            let turns = (x[3] / PI).round();
            let sign = if turns % 2.0 == 0.0 { 1.0 } else { -1.0 };
            let reduced = [sign * x[0], sign * x[1], x[2], x[3] - turns * PI];
            map.change(&reduced, &p[..4], &mut change, &mut scratch);
            for (k, sign) in [sign, sign, 1.0, 1.0, 1.0].into_iter().enumerate() {
                x[k] += sign * change[k];
            }
        }
        vec![[x[4], 0.0]]
    };
    let error = truth(1.1, 1.4, 20.0).errors(position)[0].1;
    println!("T = 20: {error:.1e}");
    assert!(error < 0.1, "{error:e}");
}
