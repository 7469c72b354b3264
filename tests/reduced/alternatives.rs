//! What thesis § 6.5 weighs against each other, on the falling plate where it flutters: empirical interpolation follows whole
//! trajectories, a piecewise linear model the rates. (`examples/reduced_models`, figure `planar`, has the horizons.)

use crate::errors::Truth;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rapier3d_immersed::reduced::{
    Axis, DeimEvolution, DeimParams, FallingPlate, PiecewiseLinear, Snapshot, Tolerances, integrate,
};

const TOLERANCES: Tolerances = Tolerances {
    relative: 1e-8,
    absolute: 1e-8,
    max_steps: 100_000,
};

fn plate(p: &[f64]) -> FallingPlate {
    FallingPlate {
        inertia_ratio: p[0],
        translational_lift: p[1],
        ..FallingPlate::default()
    }
}

/// I*, C_T, release angle.
fn axes() -> Vec<Axis> {
    [(0.45, 0.55), (1.14, 1.26), (0.5, 1.0)]
        .map(|(low, high)| Axis::spectral(low, high, 2).unwrap())
        .to_vec()
}

fn start(p: &[f64]) -> [f64; 6] {
    [1e-3, 1e-3, 1e-3, p[2], 0.0, 0.0]
}

fn truth(end: f64) -> Truth {
    Truth::new(&axes(), &[end], 30, |p, times| {
        let states = plate(p).trajectory(&start(p), times, TOLERANCES);
        states.iter().map(|state| [state[4], 0.0]).collect()
    })
}

fn trained(count: usize) -> Vec<Vec<f64>> {
    let mut random = Pcg64::seed_from_u64(11);
    let mut point = || -> Vec<f64> {
        axes()
            .iter()
            .map(|axis| random.random_range(axis.start()..axis.end()))
            .collect()
    };
    (0..count).map(|_| point()).collect()
}

fn times(end: f64) -> Vec<f64> {
    let count = (20.0 * end) as u32;
    (0..=count).map(|i| f64::from(i) / 20.0).collect()
}

/// Forty trajectories over 2 time units span the others; the equations at as many points as modes choose among them.
#[test]
fn empirical_interpolation_follows_flutter() {
    let rate = |p: &[f64], x: &[f64], out: &mut [f64]| plate(p).rate(x, out);
    let snapshots: Vec<Snapshot> = trained(40)
        .into_iter()
        .map(|p| Snapshot {
            states: plate(&p)
                .trajectory(&start(&p), &times(2.0), TOLERANCES)
                .concat(),
            parameters: p,
        })
        .collect();
    let model = DeimEvolution::bake(6, &snapshots, rate, &DeimParams::default()).unwrap();
    let mut solved = 0;
    let error = truth(2.0).errors(|p, _| {
        let (states, converged) = model.solve(p, &start(p), rate);
        solved += usize::from(converged);
        vec![[states[states.len() - 2], 0.0]]
    })[0]
        .1;
    println!("{} modes, {solved} of 30, error {error:.1e}", model.modes());
    assert!(solved == 30 && error < 1e-2, "{solved}, {error:e}");
}

/// Linearizations a tenth of the state's range apart are good to some percent over 5 time units.
#[test]
fn piecewise_linear_rates_follow_flutter() {
    let model = |z: &[f64], out: &mut [f64]| {
        let mut rate = [0.0; 6];
        plate(&z[4..]).rate(&[z[0], z[1], z[2], z[3], 0.0, 0.0], &mut rate);
        out.copy_from_slice(&rate[..5]);
    };
    let input = trained(40).into_iter().flat_map(|p| {
        let states = plate(&p).trajectory(&start(&p), &times(5.0), TOLERANCES);
        let point = move |x: [f64; 6]| [&x[..4], &p[..2]].concat();
        states.into_iter().map(point).collect::<Vec<_>>()
    });
    let scales = [2.5, 1.6, 1.6, 3.0, 1.0, 1.2];
    let linear = PiecewiseLinear::bake(input, &scales, 0.05, (5, 2000), model).unwrap();
    let loose = Tolerances {
        relative: 1e-5,
        absolute: 1e-5,
        max_steps: 4000,
    };
    let error = truth(5.0).errors(|p, times| {
        let mut x = [0.0; 5];
        x[..4].copy_from_slice(&start(p)[..4]);
        let rate = |_: f64, x: &[f64], out: &mut [f64]| {
            linear.evaluate(&[&x[..4], &p[..2]].concat(), out);
        };
        integrate(rate, 0.0, times[0], &mut x, loose);
        vec![[x[4], 0.0]]
    })[0]
        .1;
    println!("{} points, error {error:.1e}", linear.points());
    assert!(error < 0.2, "{error:e}");
}
