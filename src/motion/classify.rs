//! The direct classifier: how a body falls, from how it turns and where it goes.
//!
//! It looks at the plate normal n. A *pass* is n going through the horizontal, so that the
//! other face comes up; it turns about the horizontal axis e = ±n × y. Two passes with e₁·e₂ > 0 are
//! one rotation going on, with e₁·e₂ < 0 a swing beyond edge-on and back. A *swing* is a maximum of
//! the tilt between passes: the body turned back before it was edge-on. In tumbling all passes have one
//! sense, in flutter there are only swings, and chaotic motion has both; a body of constant tilt is steady
//! if it keeps its heading and spirals if it does not.
//!
//! The thesis's (d, e) ([`Spread`](super::Spread)) cannot see rotation; this classifier sees nothing
//! else, so that the two check each other.

use super::pattern::Regime;
use super::trajectory::{Moment, Trajectory, principal_variances};
use crate::math;
use rapier3d::na::{Matrix2, Vector2, Vector3};
use std::f64::consts::{PI, TAU};

/// The direct classifier, by its thresholds.
///
/// ```
/// use rapier3d_immersed::motion::{Classifier, Moment, Regime, Trajectory};
/// use rapier3d_immersed::rapier3d::na::Vector3;
///
/// // A plate that turns over and over at 10 rad/s about z while it drifts along x.
/// let moments = (0..360).map(|i| {
///     let time = f64::from(i) / 120.0;
///     let (sin, cos) = (10.0 * time).sin_cos();
///     Moment {
///         position: Vector3::new(0.5 * time, -time, 0.0),
///         normal: Vector3::new(-sin, cos, 0.0),
///         long_axis: Vector3::z(),
///     }
/// });
/// let fall = Trajectory { interval: 1.0 / 120.0, moments: moments.collect() };
/// let seen = Classifier::default().classify(&fall);
/// assert_eq!(seen.regime, Regime::PeriodicTumbling);
/// assert!(seen.flips >= 5 && seen.reversals == 0); // 2 s of 10 rad/s are 6.4 half turns
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Classifier {
    /// Share of the record, from its beginning, that is left out as the release's transient
    /// (default ⅓).
    pub transient: f64,
    /// Prominence of a maximum of the tilt that makes a swing, rad (default 12°).
    pub swing: f64,
    /// How far beyond edge-on makes a pass, rad (default 10°).
    pub pass: f64,
    /// The share of flips among flips and reversals from which on a fall is tumbling (default 0.8).
    pub tumbling_share: f64,
    /// The share of flips up to which a fall is flutter or steady (default 0.15).
    pub flutter_share: f64,
    /// A path is a helix if the ellipse of the horizontal velocity is rounder than this, smaller over
    /// larger semi-axis (default 0.35).
    pub helix_roundness: f64,
    /// It is a spiral if the ellipse is rounder than this (default 0.7).
    pub spiral_roundness: f64,
    /// The least number of turns of the horizontal velocity in a helix or spiral (default 1).
    pub least_turns: f64,
}

impl Default for Classifier {
    fn default() -> Self {
        Self {
            transient: 1.0 / 3.0,
            swing: 12f64.to_radians(),
            pass: 10f64.to_radians(),
            tumbling_share: 0.8,
            flutter_share: 0.15,
            helix_roundness: 0.35,
            spiral_roundness: 0.7,
            least_turns: 1.0,
        }
    }
}

/// What the classifier saw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// The verdict.
    pub regime: Regime,
    /// Passes after which the rotation went on: half turns of tumbling.
    pub flips: u32,
    /// Swings, and passes after which the body turned back.
    pub reversals: u32,
    /// Turns of the horizontal velocity about its mean, in either sense.
    pub turns: f64,
    /// Smaller over larger semi-axis of the horizontal velocity's ellipse.
    pub roundness: f64,
}

impl Observation {
    /// Share of flips among flips and reversals; 0 if there are none.
    pub fn tumbling(&self) -> f64 {
        let all = self.flips + self.reversals;
        f64::from(self.flips) / f64::from(all.max(1))
    }
}

/// An event in the motion of the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Event {
    /// It went through the horizontal, turning about this axis.
    Pass(Vector3<f64>),
    /// It turned back.
    Swing,
}

impl Classifier {
    /// Classifies a fall after its transient.
    pub fn classify(&self, fall: &Trajectory) -> Observation {
        self.observe(self.after_transient(fall))
    }

    /// The part of a fall that [`Classifier::classify`] looks at.
    pub fn after_transient<'a>(&self, fall: &'a Trajectory) -> &'a [Moment] {
        let skipped = (fall.moments.len() as f64 * self.transient.clamp(0.0, 1.0)) as usize;
        &fall.moments[skipped.min(fall.moments.len())..]
    }

    /// Classifies all of a part of a fall, recorded at equal intervals.
    pub fn observe(&self, moments: &[Moment]) -> Observation {
        let (flips, reversals) = flips_and_reversals(&self.events(moments));
        let (turns, roundness) = circling(moments);
        let mut seen = Observation {
            regime: Regime::SteadyDescent,
            flips,
            reversals,
            turns,
            roundness,
        };
        let share = seen.tumbling();
        seen.regime = if flips > 0 && share >= self.tumbling_share {
            Regime::PeriodicTumbling
        } else if flips > 0 && share > self.flutter_share {
            Regime::TransitionalChaotic
        } else {
            let leaning = mean_tilt(moments) > self.swing;
            let round = turns >= self.least_turns && (leaning || reversals > 0);
            if round && roundness > self.spiral_roundness {
                Regime::PeriodicSpiral
            } else if round && roundness > self.helix_roundness {
                Regime::TransitionalHelix
            } else if reversals > 0 {
                Regime::PeriodicFlutter
            } else {
                Regime::SteadyDescent
            }
        };
        seen
    }

    /// Passes and swings in their order.
    fn events(&self, moments: &[Moment]) -> Vec<Event> {
        let mut events = Vec::new();
        let Some(first) = moments.first() else {
            return events;
        };
        let mut side = first.normal.y.signum();
        // This is the last rotation of the normal through the horizontal, until it is far enough beyond.
        let mut crossing = None;
        let beyond = math::sin(self.pass);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut rising = false;
        for pair in moments.windows(2) {
            let [before, now] = [pair[0].normal, pair[1].normal];
            if (before.y > 0.0) != (now.y > 0.0) {
                let edge_on = before * now.y.abs() + now * before.y.abs();
                crossing = Some(edge_on.cross(&Vector3::y()) * (now.y - before.y).signum());
            }
            if now.y * side < -beyond {
                side = -side;
                events.push(Event::Pass(crossing.unwrap_or_default()));
                (low, high, rising) = (f64::INFINITY, f64::NEG_INFINITY, false);
                continue;
            }
            // The tilt of the face that is up is beyond π/2 until the pass is complete.
            let tilt = math::acos((now.y * side).clamp(-1.0, 1.0));
            if rising {
                high = high.max(tilt);
                if tilt < high - self.swing {
                    events.push(Event::Swing);
                    (low, rising) = (tilt, false);
                }
            } else {
                low = low.min(tilt);
                if tilt > low + self.swing {
                    (high, rising) = (tilt, true);
                }
            }
        }
        events
    }
}

/// Flips and reversals among events. A record may begin between a pass and the one that undoes it:
/// without its first pass it then shows fewer flips and no fewer reversals.
fn flips_and_reversals(events: &[Event]) -> (u32, u32) {
    let whole = count(events);
    match events.split_first() {
        Some((Event::Pass(_), rest)) if whole.1 > 0 => {
            let other = count(rest);
            if other.1 >= whole.1 { other } else { whole }
        }
        _ => whole,
    }
}

fn count(events: &[Event]) -> (u32, u32) {
    let (mut flips, mut reversals) = (0, 0);
    // The last pass counts as a flip once it is known that the next does not undo it.
    let mut open: Option<Vector3<f64>> = None;
    // Whether that pass went on from the one before.
    let mut going_on = false;
    for event in events {
        match (event, open) {
            (Event::Swing, _) => {
                flips += u32::from(open.take().is_some());
                reversals += 1;
                going_on = false;
            }
            (Event::Pass(axis), Some(last)) if axis.dot(&last) < 0.0 => {
                // The two passes are one swing beyond edge-on and back.
                reversals += 1;
                (open, going_on) = (None, false);
            }
            (Event::Pass(axis), _) => {
                going_on = open.is_some();
                flips += u32::from(going_on);
                open = Some(*axis);
            }
        }
    }
    // Whether the last pass would have been undone is not known; it is not if it went on, or if
    // nothing ever turned back.
    let last = open.is_some() && (going_on || reversals == 0);
    (flips + u32::from(last), reversals)
}

/// Mean angle between the normal and the vertical, rad.
fn mean_tilt(moments: &[Moment]) -> f64 {
    let tilts = moments
        .iter()
        .map(|m| math::acos(m.normal.y.abs().min(1.0)));
    tilts.sum::<f64>() / moments.len().max(1) as f64
}

/// Turns of the horizontal velocity about its mean, and the roundness of its ellipse.
fn circling(moments: &[Moment]) -> (f64, f64) {
    let steps: Vec<Vector2<f64>> = moments
        .windows(2)
        .map(|pair| {
            let d = pair[1].position - pair[0].position;
            Vector2::new(d.x, d.z)
        })
        .collect();
    if steps.len() < 2 {
        return (0.0, 0.0);
    }
    let mean = steps.iter().sum::<Vector2<f64>>() / steps.len() as f64;
    let mut variance = Matrix2::zeros();
    let (mut angle, mut last) = (0.0, None);
    for step in &steps {
        let v = step - mean;
        variance += v * v.transpose();
        let heading = math::atan2(v.y, v.x);
        if let Some(last) = last {
            let turn: f64 = heading - last;
            angle += (turn + PI).rem_euclid(TAU) - PI;
        }
        last = Some(heading);
    }
    let [large, small] = principal_variances(&variance);
    let roundness = if large > 0.0 {
        (small / large).sqrt()
    } else {
        0.0
    };
    (angle.abs() / TAU, roundness)
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 0.005;

    /// A fall whose normal and path are given.
    fn fall(
        seconds: f64,
        normal: impl Fn(f64) -> Vector3<f64>,
        position: impl Fn(f64) -> Vector3<f64>,
    ) -> Trajectory {
        let count = (seconds / DT) as usize;
        let moment = |i| {
            let t = i as f64 * DT;
            Moment {
                position: position(t),
                normal: normal(t).normalize(),
                long_axis: Vector3::z(),
            }
        };
        Trajectory {
            interval: DT,
            moments: (0..count).map(moment).collect(),
        }
    }

    /// The normal after a rotation by `angle` about the horizontal axis z, then by `heading` about y.
    fn turned(angle: f64, heading: f64) -> Vector3<f64> {
        Vector3::new(
            angle.sin() * heading.cos(),
            angle.cos(),
            angle.sin() * heading.sin(),
        )
    }

    fn regime(fall: &Trajectory) -> Regime {
        Classifier::default().classify(fall).regime
    }

    #[test]
    fn motions_that_are_known() {
        let down = |t: f64| Vector3::new(0.0, -t, 0.0);
        let steady = fall(3.0, |t| turned(0.1 * (-t).exp(), 0.0), down);
        assert_eq!(regime(&steady), Regime::SteadyDescent);
        let glide = fall(3.0, |_| turned(0.3, 0.0), |t| Vector3::new(t, -t, 0.0));
        assert_eq!(regime(&glide), Regime::SteadyDescent);
        // The axis precesses in a flutter of ±50°, and in one of ±110°, beyond edge-on.
        for amplitude in [50f64, 110.0] {
            let flutter = fall(
                3.0,
                |t| turned(amplitude.to_radians() * (9.0 * t).sin(), 0.5 * t),
                |t| Vector3::new(0.1 * (9.0 * t).sin(), -t, 0.0),
            );
            assert_eq!(regime(&flutter), Regime::PeriodicFlutter, "{amplitude}");
        }
        // A tumbling of uneven rate precesses.
        let tumbling = fall(
            3.0,
            |t| turned(-12.0 * t - 0.9 * (12.0 * t).sin(), 0.4 * t),
            |t| Vector3::new(t, -t, 0.0),
        );
        assert_eq!(regime(&tumbling), Regime::PeriodicTumbling);
        let observed = Classifier::default().classify(&tumbling);
        // 2 s of 12 rad/s are 7.6 half turns.
        assert!((7..=8).contains(&observed.flips) && observed.reversals == 0);
        // A chaotic fall does each for half a second in turn.
        let chaotic = fall(
            6.0,
            |t| {
                let whole = (t % 1.0).min(0.5) + 0.5 * t.floor();
                turned(12.0 * whole + 0.8 * (4.0 * PI * t).sin(), 0.0)
            },
            |t| Vector3::new(0.3 * t, -t, 0.0),
        );
        assert_eq!(regime(&chaotic), Regime::TransitionalChaotic);
        let spiral = |ratio: f64| {
            fall(
                3.0,
                |t| turned(0.5, 7.0 * t),
                move |t| Vector3::new(0.1 * (7.0 * t).cos(), -t, ratio * 0.1 * (7.0 * t).sin()),
            )
        };
        assert_eq!(regime(&spiral(1.0)), Regime::PeriodicSpiral);
        assert_eq!(regime(&spiral(0.5)), Regime::TransitionalHelix);
    }

    /// A tumble and a half at the release must not make a flutter chaotic, nor a late start of
    /// tumbling.
    #[test]
    fn transients_do_not_count() {
        let late = |t: f64| (t - 0.8).max(0.0);
        let flutter = fall(
            3.0,
            |t| turned(12.0 * t.min(0.8) + 0.8 * (9.0 * late(t)).sin(), 0.0),
            |t| Vector3::new(0.0, -t, 0.0),
        );
        // 9.6 rad is about three half turns: it flutters about the other face.
        assert_eq!(regime(&flutter), Regime::PeriodicFlutter);
        let tumbling = fall(
            3.0,
            |t| turned(0.8 * (9.0 * t.min(0.8)).sin() + 12.0 * late(t), 0.0),
            |t| Vector3::new(0.0, -t, 0.0),
        );
        assert_eq!(regime(&tumbling), Regime::PeriodicTumbling);
    }

    #[test]
    fn nothing_is_steady() {
        let classifier = Classifier::default();
        assert_eq!(classifier.observe(&[]).regime, Regime::SteadyDescent);
        let empty = Trajectory::default();
        assert_eq!(classifier.classify(&empty).flips, 0);
    }
}
