//! A plate that falls in a plane, the test dynamics of surrogates and identification.

use super::dormand_prince::{Tolerances, integrate};
use crate::math;

/// The thin-plate limit of the quasi-steady model of Andersen, Pesavento & Wang (J. Fluid Mech.
/// 541, 2005): flutter, tumbling and chaos from six ordinary differential equations.
///
/// Lengths are in semi-chords a, speeds in √((ρ_s/ρ_f − 1) g b) with b the half thickness. It
/// verifies code; its transition lies at I* = 1.22, that of real plates at .2 to .34.
///
/// ```
/// use rapier3d_immersed::reduced::{FallingPlate, Tolerances};
///
/// // A heavy plate turns over and over, a light one only swings.
/// let turns = |inertia_ratio| {
///     let plate = FallingPlate { inertia_ratio, ..FallingPlate::default() };
///     let mut state = [0.5, 0.0, 0.0, 0.3, 0.0, 0.0];
///     plate.advance(&mut state, 60.0, Tolerances::default());
///     state[3].abs() / std::f64::consts::PI
/// };
/// assert!(turns(1.4) > 5.0);
/// assert!(turns(0.5) < 0.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FallingPlate {
    /// I* = ρ_s b / (ρ_f a).
    pub inertia_ratio: f64,
    /// C_T, circulation from translation. Default 1.2.
    pub translational_lift: f64,
    /// C_R, circulation from rotation. Default π.
    pub rotational_lift: f64,
    /// A of the drag A − B cos 2α. Default 1.4.
    pub drag_mean: f64,
    /// B of the drag. Default 1.0.
    pub drag_variation: f64,
    /// μ₁ = μ₂ of the torque (μ₁ + μ₂|ω|) ω. Default 0.2.
    pub rotational_drag: f64,
}

impl Default for FallingPlate {
    fn default() -> Self {
        Self {
            inertia_ratio: 0.5,
            translational_lift: 1.2,
            rotational_lift: std::f64::consts::PI,
            drag_mean: 1.4,
            drag_variation: 1.0,
            rotational_drag: 0.2,
        }
    }
}

impl FallingPlate {
    /// Writes the rate of (u, v, ω, θ, x, y): velocity along chord and normal, spin, angle of the
    /// chord to the horizontal, and position (y up).
    pub fn rate(&self, state: &[f64], out: &mut [f64]) {
        use std::f64::consts::PI;
        let [u, v, spin, angle] = [state[0], state[1], state[2], state[3]];
        let squared = u * u + v * v;
        let speed = squared.sqrt();
        // All terms below vanish with the speed, but their quotients do not exist at rest.
        let inverse = if speed > 0.0 { 1.0 / speed } else { 0.0 };
        let circulation =
            2.0 / PI * (self.rotational_lift * spin - self.translational_lift * u * v * inverse);
        let drag = (self.drag_mean * speed - self.drag_variation * (u * u - v * v) * inverse) / PI;
        let torque = self.rotational_drag * (1.0 + spin.abs()) * spin;
        let i = self.inertia_ratio;
        let (sin, cos) = math::sin_cos(angle);
        out[0] = ((i + 1.0) * spin * v - circulation * v - sin - drag * u) / i;
        out[1] = (-i * spin * u + circulation * u - cos - drag * v) / (i + 1.0);
        out[2] = 4.0 * (-u * v - torque) / (i + 0.5);
        out[3] = spin;
        out[4] = u * cos - v * sin;
        out[5] = u * sin + v * cos;
    }

    /// The plate with these (C_T, C_R, A, B, μ), as identification varies them.
    pub fn with_coefficients(inertia_ratio: f64, coefficients: [f64; 5]) -> Self {
        let [
            translational_lift,
            rotational_lift,
            drag_mean,
            drag_variation,
            rotational_drag,
        ] = coefficients;
        Self {
            inertia_ratio,
            translational_lift,
            rotational_lift,
            drag_mean,
            drag_variation,
            rotational_drag,
        }
    }

    /// Advances the state by `duration`, and returns the time that was reached.
    pub fn advance(&self, state: &mut [f64], duration: f64, tolerances: Tolerances) -> f64 {
        integrate(
            |_, x, out| self.rate(x, out),
            0.0,
            duration,
            state,
            tolerances,
        )
    }

    /// The states at increasing `times` (≥ 0) from `start` at time 0, one after the other.
    pub fn trajectory(
        &self,
        start: &[f64; 6],
        times: &[f64],
        tolerances: Tolerances,
    ) -> Vec<[f64; 6]> {
        let mut state = *start;
        let mut now = 0.0;
        let mut states = Vec::with_capacity(times.len());
        for time in times {
            if *time > now {
                self.advance(&mut state, time - now, tolerances);
                now = *time;
            }
            states.push(state);
        }
        states
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn late(inertia_ratio: f64, span: f64) -> Vec<[f64; 6]> {
        let plate = FallingPlate {
            inertia_ratio,
            ..FallingPlate::default()
        };
        let mut start = [1e-3, 1e-3, 1e-3, std::f64::consts::FRAC_PI_4, 0.0, 0.0];
        let tolerances = Tolerances {
            relative: 1e-10,
            absolute: 1e-10,
            ..Tolerances::default()
        };
        plate.advance(&mut start, 200.0, tolerances);
        let times: Vec<f64> = (0..=4000).map(|i| span * f64::from(i) / 4000.0).collect();
        plate.trajectory(&start, &times, tolerances)
    }

    /// Flutter at I* = 0.5: period 6.3771, descent −.30110, max |ω| .92683; no drift (recomputed
    /// from the paper's equations with DOP853).
    #[test]
    fn flutter() {
        let period = 6.3771;
        let states = late(0.5, period);
        let (first, last) = (states[0], states[states.len() - 1]);
        for k in 0..4 {
            assert!((first[k] - last[k]).abs() < 2e-4, "{first:?} {last:?}");
        }
        assert!((last[4] - first[4]).abs() < 2e-3);
        assert!(((last[5] - first[5]) / period + 0.30110).abs() < 1e-4);
        let fastest = states.iter().map(|s| s[2].abs()).fold(0.0, f64::max);
        assert!((fastest - 0.92683).abs() < 1e-4, "{fastest}");
    }

    /// Tumbling at I* = 1.4: 6.4214 per half-turn, drift .75593, descent −.32667.
    #[test]
    fn tumbling() {
        let half_turn = 6.4214;
        let states = late(1.4, half_turn);
        let (first, last) = (states[0], states[states.len() - 1]);
        assert!(((last[3] - first[3]).abs() - std::f64::consts::PI).abs() < 1e-3);
        assert!(((last[4] - first[4]).abs() / half_turn - 0.75593).abs() < 2e-4);
        assert!(((last[5] - first[5]) / half_turn + 0.32667).abs() < 2e-4);
    }
}
