//! The rates of the falling plate, by whatever model of them, and where they lead.

use crate::horizon::{plate, reduced, start};
use rapier3d_immersed::reduced::{Tolerances, integrate};

/// The rates of u, v, ω, θ and x (as [`reduced`] has the state) over state and parameters.
pub fn exact(point: &[f64], out: &mut [f64]) {
    let mut rate = [0.0; 6];
    plate(&point[4..]).rate(
        &[point[0], point[1], point[2], point[3], 0.0, 0.0],
        &mut rate,
    );
    out.copy_from_slice(&rate[..5]);
}

/// Where a plate of the parameters is at the horizons, by a model of its rates that is integrated to these tolerances.
pub fn integrated(
    parameters: &[f64],
    horizons: &[f64],
    tolerances: Tolerances,
    mut model: impl FnMut(&[f64], &mut [f64]),
) -> Vec<[f64; 2]> {
    let mut x = [0.0; 5];
    x[..4].copy_from_slice(&start(parameters[4])[..4]);
    let mut now = 0.0;
    let mut rate = |_: f64, x: &[f64], out: &mut [f64]| {
        let (inside, sign) = reduced(x);
        model(&[&inside[..], &parameters[..4]].concat(), out);
        out[0] *= sign;
        out[1] *= sign;
    };
    let mut positions = Vec::new();
    for horizon in horizons {
        integrate(&mut rate, now, *horizon, &mut x, tolerances);
        now = *horizon;
        positions.push([x[4], 0.0]);
    }
    positions
}
