//! An adaptive explicit integrator, which computes the data of surrogates and finds singularities.

use crate::math;

/// Tolerances of [`integrate`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Error per step relative to the state. Default 1e-9.
    pub relative: f64,
    /// Error per step where the state is small, in its units. Default 1e-9.
    pub absolute: f64,
    /// Most steps, rejected ones included. Default 100 000.
    pub max_steps: usize,
}

impl Default for Tolerances {
    fn default() -> Self {
        Self {
            relative: 1e-9,
            absolute: 1e-9,
            max_steps: 100_000,
        }
    }
}

const NODES: [f64; 7] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
const STAGES: [[f64; 6]; 6] = [
    [0.2, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [
        19372.0 / 6561.0,
        -25360.0 / 2187.0,
        64448.0 / 6561.0,
        -212.0 / 729.0,
        0.0,
        0.0,
    ],
    [
        9017.0 / 3168.0,
        -355.0 / 33.0,
        46732.0 / 5247.0,
        49.0 / 176.0,
        -5103.0 / 18656.0,
        0.0,
    ],
    [
        35.0 / 384.0,
        0.0,
        500.0 / 1113.0,
        125.0 / 192.0,
        -2187.0 / 6784.0,
        11.0 / 84.0,
    ],
];
/// Weights of the fifth-order solution minus those of the fourth-order one.
const ERROR: [f64; 7] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// Advances `state` from `start` to `end` by the pair 5(4) of Dormand & Prince (1980).
///
/// `rate(t, state, out)` writes the time derivative. Returns the time that was reached: `end`, or
/// less where the steps became too small or too many (the solution is singular, or the rate not
/// finite); `state` is then the last one accepted.
///
/// ```
/// use rapier3d_immersed::reduced::{Tolerances, integrate};
///
/// // A harmonic oscillator comes back after a period.
/// let mut state = [1.0, 0.0];
/// let rate = |_: f64, x: &[f64], out: &mut [f64]| (out[0], out[1]) = (x[1], -x[0]);
/// let period = std::f64::consts::TAU;
/// assert_eq!(integrate(rate, 0.0, period, &mut state, Tolerances::default()), period);
/// assert!((state[0] - 1.0).abs() < 1e-6 && state[1].abs() < 1e-6);
/// ```
pub fn integrate(
    mut rate: impl FnMut(f64, &[f64], &mut [f64]),
    start: f64,
    end: f64,
    state: &mut [f64],
    tolerances: Tolerances,
) -> f64 {
    let n = state.len();
    let mut slopes = vec![vec![0.0; n]; 7];
    let mut trial = vec![0.0; n];
    let mut t = start;
    let span = end - start;
    let mut step = span * 1e-3;
    rate(t, state, &mut slopes[0]);
    for _ in 0..tolerances.max_steps {
        if t >= end {
            return end;
        }
        let last = t + step >= end;
        let h = if last { end - t } else { step };
        if h < 1e-13 * span {
            break;
        }
        for stage in 1..7 {
            for i in 0..n {
                let sum: f64 = (0..stage)
                    .map(|k| STAGES[stage - 1][k] * slopes[k][i])
                    .sum();
                trial[i] = state[i] + h * sum;
            }
            rate(t + NODES[stage] * h, &trial, &mut slopes[stage]);
        }
        let mut error = 0.0_f64;
        for i in 0..n {
            let difference: f64 = (0..7).map(|k| ERROR[k] * slopes[k][i]).sum();
            let size =
                tolerances.absolute + tolerances.relative * state[i].abs().max(trial[i].abs());
            let scaled = (h * difference / size).abs();
            error = if scaled.is_nan() {
                f64::INFINITY
            } else {
                error.max(scaled)
            };
        }
        if error <= 1.0 {
            t = if last { end } else { t + h };
            state.copy_from_slice(&trial);
            slopes.swap(0, 6);
        }
        step = h * (0.9 * math::powf(error, -0.2)).clamp(0.2, 5.0);
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Kepler's ellipse of eccentricity 0.5 returns to its start after 2π.
    #[test]
    fn an_orbit_closes() {
        let start = [0.5, 0.0, 0.0, 3.0_f64.sqrt()];
        let mut state = start;
        let rate = |_: f64, x: &[f64], out: &mut [f64]| {
            let cube = (x[0] * x[0] + x[1] * x[1]).powf(1.5);
            out.copy_from_slice(&[x[2], x[3], -x[0] / cube, -x[1] / cube]);
        };
        let tolerances = Tolerances {
            relative: 1e-12,
            absolute: 1e-12,
            ..Tolerances::default()
        };
        let end = 2.0 * std::f64::consts::PI;
        assert_eq!(integrate(rate, 0.0, end, &mut state, tolerances), end);
        for (a, b) in state.iter().zip(start) {
            assert!((a - b).abs() < 1e-9, "{state:?}");
        }
    }

    /// u̇ = u² from 1 is singular at t = 1: the integrator stops there, and does not panic.
    #[test]
    fn it_stops_at_a_singularity() {
        let mut state = [1.0];
        let reached = integrate(
            |_, x, out| out[0] = x[0] * x[0],
            0.0,
            2.0,
            &mut state,
            Tolerances::default(),
        );
        assert!((reached - 1.0).abs() < 1e-4, "{reached}");
        let reached = integrate(
            |_, _, out| out[0] = f64::NAN,
            0.0,
            2.0,
            &mut state,
            Tolerances::default(),
        );
        assert_eq!(reached, 0.0);
    }
}
