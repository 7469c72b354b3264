//! How a falling strip turns: the plane model of Tanabe & Kaneko (*Phys. Rev. Lett.* 73, 1994), thesis
//! (3.4)–(3.5).
//!
//! # What is corrected
//! As the thesis prints the equations, gravity is missing in ÿ and the torque is not divided by the
//! mass per depth; and the sign (3.5) of the lift pushes a plate that glides edge-on *down* instead of
//! up (V = (1, −.2), θ = 0 gives k = 1 and ÿ < 0), so that nothing ever flutters. With the sign reversed
//! the lift opposes the velocity normal to the plate, and A⊥ = 4.1, A∥ = 0.9 flutters as in Fig. 3.4a.

use crate::error::Error;
use crate::math;
use std::f64::consts::{FRAC_PI_2, PI};

/// A strip in its glide plane: linear drag, Kutta lift, and the torque of its center of pressure.
///
/// ```
/// use rapier3d_immersed::motion::path::{Fall, TanabeKaneko};
///
/// // With the thesis's drag rates a strip that is released at 0.3 rad flutters (Fig. 3.4a).
/// let states = TanabeKaneko::default().solve(0.3, 4e-3, 5000); // 20 s
/// assert_eq!(Fall::of(&states), Fall::Flutter);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TanabeKaneko {
    /// A⊥: drag rate across the strip, 1/s. Default 4.1 (thesis Fig. 3.4a).
    pub across: f64,
    /// A∥: drag rate along the strip, 1/s. Default 0.9 (thesis Fig. 3.4a).
    pub along: f64,
    /// ρ_f L/m: mass of fluid L² over that of the strip, per depth. Default 0.14: with it the thesis's
    /// drag rates flutter; it prints none.
    pub fluid_share: f64,
    /// L: chord, m. Default 1.
    pub length: f64,
    /// Gravity, m/s². Default 9.8.
    pub gravity: f64,
}

impl Default for TanabeKaneko {
    fn default() -> Self {
        Self {
            across: 4.1,
            along: 0.9,
            fluid_share: 0.14,
            length: 1.0,
            gravity: 9.8,
        }
    }
}

/// Position x, y (m), angle θ of the chord (rad, counter-clockwise from x), and their rates.
pub type State = [f64; 6];

/// What a solution does once it has settled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fall {
    /// It swings from side to side at a steady amplitude.
    Flutter,
    /// It turns over in one direction.
    Tumbling,
    /// It does both in turn.
    Chaotic,
    /// A swing that dies away into a straight fall, or a fall that never swings: useless as a source of
    /// orientations (thesis Fig. 3.4b).
    Straight,
}

impl TanabeKaneko {
    /// # Errors
    /// [`Error::InvalidParameter`] names a value that is not finite, negative, or zero where it may not
    /// be (A⊥, L, gravity).
    pub fn check(&self) -> Result<(), Error> {
        Error::check_positive("drag rate across", self.across)?;
        Error::check_not_negative("drag rate along", self.along)?;
        Error::check_not_negative("fluid share", self.fluid_share)?;
        Error::check_positive("length", self.length)?;
        Error::check_positive("gravity", self.gravity)?;
        Ok(())
    }

    /// Rate of change of a state.
    pub fn rate(&self, state: &State) -> State {
        let [_, _, theta, u, v, spin] = *state;
        let (sin, cos) = math::sin_cos(theta);
        let speed2 = u * u + v * v;
        let speed = speed2.sqrt();
        // α = arctan(u/v): the velocity is σV (sin α, cos α), σ the sign of v.
        let sigma = if v >= 0.0 { 1.0 } else { -1.0 };
        let (sin_alpha, cos_alpha) = if speed > 0.0 {
            (sigma * u / speed, sigma * v / speed)
        } else {
            (0.0, 1.0)
        };
        let sin_beta = sin_alpha * cos + cos_alpha * sin;
        let cos_beta = cos_alpha * cos - sin_alpha * sin;
        let k = if sigma * sin_beta >= 0.0 { -1.0 } else { 1.0 };
        let lift = k * PI * self.fluid_share / self.length * speed2 * cos_beta;
        let (a, b) = (self.across, self.along);
        let mixed = (a - b) * sin * cos;
        [
            u,
            v,
            spin,
            -(a * sin * sin + b * cos * cos) * u + mixed * v - lift * cos_alpha,
            -(a * cos * cos + b * sin * sin) * v + mixed * u + lift * sin_alpha - self.gravity,
            -a * spin
                - 3.0 * PI * self.fluid_share / (self.length * self.length)
                    * speed2
                    * cos_beta
                    * sin_beta,
        ]
    }

    /// The state `dt` later, by the classical Runge–Kutta method of fourth order.
    pub fn step(&self, state: &State, dt: f64) -> State {
        let add = |rate: &State, h: f64| {
            let mut moved = *state;
            for (x, r) in moved.iter_mut().zip(rate) {
                *x += h * r;
            }
            moved
        };
        let a = self.rate(state);
        let b = self.rate(&add(&a, 0.5 * dt));
        let c = self.rate(&add(&b, 0.5 * dt));
        let d = self.rate(&add(&c, dt));
        let mut next = *state;
        for i in 0..6 {
            next[i] += dt / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
        }
        next
    }

    /// The states at `count` equal steps after a release from rest at an angle, the release first.
    pub fn solve(&self, release_angle: f64, dt: f64, count: usize) -> Vec<State> {
        let mut state = [0.0, 0.0, release_angle, 0.0, 0.0, 0.0];
        let mut states = vec![state];
        for _ in 0..count {
            state = self.step(&state, dt);
            states.push(state);
        }
        states
    }
}

impl Fall {
    /// What the second half of a solution does.
    pub fn of(states: &[State]) -> Self {
        let half = &states[states.len() / 2..];
        let (first, last) = half.split_at(half.len() / 2);
        let swing = |part: &[State]| {
            let angles = || part.iter().map(|s| s[2]);
            angles().fold(f64::NEG_INFINITY, f64::max) - angles().fold(f64::INFINITY, f64::min)
        };
        let finite = half.iter().all(|s| s.iter().all(|x| x.is_finite()));
        if !finite || half.len() < 4 {
            return Self::Straight;
        }
        let turned = (half[half.len() - 1][2] - half[0][2]).abs();
        let traversed: f64 = half.windows(2).map(|p| (p[1][2] - p[0][2]).abs()).sum();
        let reversals = turning_points(half).len();
        if turned > 0.9 * traversed && turned > 2.0 * PI {
            Self::Tumbling
        } else if swing(half) > PI {
            Self::Chaotic
        } else if reversals >= 2 && swing(last) > 0.5 && swing(last) > 0.8 * swing(first) {
            Self::Flutter
        } else {
            Self::Straight
        }
    }
}

/// Indices after which the horizontal velocity changes its sign.
fn turning_points(states: &[State]) -> Vec<usize> {
    let pairs = states.windows(2).enumerate();
    pairs
        .filter(|(_, pair)| pair[0][3] * pair[1][3] < 0.0)
        .map(|(index, _)| index + 1)
        .collect()
}

/// The angle over one segment of a solution, as a glide to the right.
#[derive(Clone, Debug, PartialEq)]
pub struct AngleCurve {
    /// Horizontal distance over descent of the segment; what a segment of the database is matched by.
    pub slope: f64,
    /// θ at equal times, rad, [`AngleCurve::SAMPLES`] of them. A flutter goes from −θ_m to θ_m, a tumble
    /// from −π/2 to π/2.
    pub angles: [f64; Self::SAMPLES],
}

impl AngleCurve {
    /// Number of angles.
    pub const SAMPLES: usize = 17;

    /// θ at a share of the segment's time, linear between samples (thesis § 3.3.2).
    pub fn at(&self, share: f64) -> f64 {
        let place = share.clamp(0.0, 1.0) * (Self::SAMPLES - 1) as f64;
        let index = (place as usize).min(Self::SAMPLES - 2);
        let part = place - index as f64;
        self.angles[index] * (1.0 - part) + self.angles[index + 1] * part
    }

    /// The segments of a settled solution: of a flutter from turning point to turning point, of a tumble
    /// from one upright position to the next. The curve is the mean of all of them, left ones mirrored, and
    /// the ends of a flutter are made equal and opposite. It is `None` if the solution is neither, or too
    /// short.
    pub fn of(states: &[State]) -> Option<(Fall, Self)> {
        let fall = Fall::of(states);
        let half = &states[states.len() / 2..];
        let cuts = match fall {
            Fall::Flutter => turning_points(half),
            Fall::Tumbling => {
                let turn = |s: &State| ((s[2] + FRAC_PI_2) / PI).floor();
                let pairs = half.windows(2).enumerate();
                pairs
                    .filter(|(_, pair)| turn(&pair[0]) != turn(&pair[1]))
                    .map(|(index, _)| index + 1)
                    .collect()
            }
            Fall::Chaotic | Fall::Straight => return None,
        };
        let mut mean = [0.0; Self::SAMPLES];
        let (mut across, mut down, mut count) = (0.0, 0.0, 0.0);
        for pair in cuts.windows(2) {
            let part = &half[pair[0]..=pair[1]];
            let (first, last) = (part[0], part[part.len() - 1]);
            let sign = (last[0] - first[0]).signum();
            let whole = match fall {
                // The middle of a tumbling segment is a multiple of π.
                Fall::Tumbling => PI * (0.5 * (first[2] + last[2]) / PI).round(),
                _ => 0.0,
            };
            for (i, angle) in mean.iter_mut().enumerate() {
                let at = i * (part.len() - 1) / (Self::SAMPLES - 1);
                *angle += sign * (part[at][2] - whole);
            }
            across += (last[0] - first[0]).abs();
            down += first[1] - last[1];
            count += 1.0;
        }
        if count == 0.0 || down <= 0.0 {
            return None;
        }
        mean.iter_mut().for_each(|angle| *angle /= count);
        let last = Self::SAMPLES - 1;
        let end = match fall {
            Fall::Tumbling => FRAC_PI_2,
            _ => 0.5 * (mean[last] - mean[0]),
        };
        if end <= 0.0 {
            return None;
        }
        let (low, high) = (mean[0], mean[last]);
        for angle in &mut mean {
            *angle = -end + (*angle - low) * 2.0 * end / (high - low);
        }
        let slope = across / down;
        let angles = mean;
        Some((fall, Self { slope, angles }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: f64, b: f64, tolerance: f64) {
        assert!((a - b).abs() < tolerance, "{a} {b}");
    }

    /// Without fluid mass the strip keeps its angle, and along and across it v = (g/A)(1 − e^(−At)).
    #[test]
    fn drag_alone_is_solved_exactly() {
        let model = TanabeKaneko {
            fluid_share: 0.0,
            ..TanabeKaneko::default()
        };
        let angle = 0.4f64;
        let state = *model.solve(angle, 1e-3, 700).last().unwrap();
        let fall = |rate: f64, pull: f64| pull / rate * (1.0 - (-rate * 0.7).exp());
        let along = fall(model.along, -9.8 * angle.sin());
        let across = fall(model.across, -9.8 * angle.cos());
        let (sin, cos) = angle.sin_cos();
        close(state[3], along * cos - across * sin, 1e-10);
        close(state[4], along * sin + across * cos, 1e-10);
        assert_eq!(state[2], angle);
    }

    /// Lift does no work, opposes the velocity across the strip, and is π ρ_f V² L sin(angle of attack).
    #[test]
    fn lift() {
        let model = TanabeKaneko {
            across: 0.0,
            along: 0.0,
            gravity: 0.0,
            ..TanabeKaneko::default()
        };
        for i in 0..40 {
            let theta = 0.37 * f64::from(i);
            let way = 0.83 * f64::from(i) + 0.1;
            let (u, v) = (1.7 * way.cos(), 1.7 * way.sin());
            let rate = model.rate(&[0.0, 0.0, theta, u, v, 0.0]);
            close(rate[3] * u + rate[4] * v, 0.0, 1e-12);
            let across = |x: f64, y: f64| -x * theta.sin() + y * theta.cos();
            assert!(across(rate[3], rate[4]) * across(u, v) <= 0.0);
            let attack = (way - theta).sin().abs();
            let size = rate[3].hypot(rate[4]);
            close(size, PI * 0.14 * 1.7 * 1.7 * attack, 1e-12);
            // The center of pressure leads: θ̈ = −3πρ_f/m (V·n)(V·t).
            let along = u * theta.cos() + v * theta.sin();
            close(rate[5], -3.0 * PI * 0.14 * across(u, v) * along, 1e-12);
        }
    }

    /// Halving the step divides the error by 2⁴ while the lift keeps its side.
    #[test]
    fn fourth_order() {
        let model = TanabeKaneko::default();
        let start = [0.0, 0.0, 0.2, 2.0, -1.0, 0.0];
        let end = |steps: u32| {
            let dt = 0.2 / f64::from(steps);
            (0..steps).fold(start, |s, _| model.step(&s, dt))
        };
        let exact = end(4096);
        let error = |steps| {
            let state = end(steps);
            (0..6)
                .map(|i| (state[i] - exact[i]).abs())
                .fold(0.0, f64::max)
        };
        let order = (error(16) / error(32)).log2();
        assert!((order - 4.0).abs() < 0.3, "{order}");
    }

    fn solution(across: f64, along: f64, fluid_share: f64) -> Vec<State> {
        let model = TanabeKaneko {
            across,
            along,
            fluid_share,
            ..TanabeKaneko::default()
        };
        model.solve(0.3, 4e-3, 5000)
    }

    /// Fig. 3.4a flutters; a lighter fluid gives the swing that dies of Fig. 3.4b, which is dropped; a
    /// smaller drag along the strip tumbles.
    #[test]
    fn useless_solutions_are_dropped() {
        let flutter = solution(4.1, 0.9, 0.14);
        assert_eq!(Fall::of(&flutter), Fall::Flutter);
        let (_, curve) = AngleCurve::of(&flutter).unwrap();
        // Where the solution turns back, by its horizontal extremes alone: the angle there, and how far
        // across and down it is from one to the next.
        let half = &flutter[flutter.len() / 2..];
        let turns: Vec<&State> = half
            .windows(3)
            .filter(|s| (s[1][0] - s[0][0]) * (s[2][0] - s[1][0]) < 0.0)
            .map(|s| &s[1])
            .collect();
        let mean = |of: &dyn Fn(&State, &State) -> f64| {
            let pairs = turns.windows(2).map(|p| of(p[0], p[1]));
            pairs.sum::<f64>() / (turns.len() - 1) as f64
        };
        let angle = mean(&|a, b| (b[2] - a[2]) * (b[0] - a[0]).signum() / 2.0);
        let slope = mean(&|a, b| (b[0] - a[0]).abs()) / mean(&|a, b| a[1] - b[1]);
        // A turn is found to a step of 4 ms of a swing of some hundred.
        close(curve.angles[16], angle, 0.02 * angle);
        close(curve.slope, slope, 0.02 * slope);
        let dying = solution(4.6, 0.9, 0.05);
        assert_eq!(Fall::of(&dying), Fall::Straight);
        assert_eq!(AngleCurve::of(&dying), None);
        let tumbling = solution(4.6, 0.15, 0.14);
        assert_eq!(Fall::of(&tumbling), Fall::Tumbling);
        let (_, curve) = AngleCurve::of(&tumbling).unwrap();
        // A tumbling strip turns all the time: backward when it drifts to the left, mirrored here.
        assert!(curve.angles.windows(2).all(|p| p[1] > p[0]), "{curve:?}");
        // Between samples it is a straight line.
        let between = 0.75 * curve.angles[3] + 0.25 * curve.angles[4];
        close(curve.at(3.25 / 16.0), between, 1e-12);
    }
}
