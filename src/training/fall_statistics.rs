//! What a free fall amounts to: means, rotation, flips, amplitude and frequency over the second half
//! of a run.
//!
//! A body's attitude is seen through **n**, its plate normal (the shortest principal axis), because
//! that is what experiments film. With y up:
//!
//! * **net rotation**: the normal passes through the horizontal plane ("edge-on"). There it moves
//!   about the horizontal axis e = ±n × y, whatever else the body does. Two successive passages with
//!   e₁·e₂ > 0 are the same rotation going on, half a turn apart; with e₁·e₂ < 0 the body has swung
//!   back. What is left before the first and after the last passage is the rotation of n about the
//!   nearest passage's e. This is the exact angle for a plate that tumbles about a fixed horizontal
//!   axis, at any rate however uneven, and also for a disc whose axis precesses (by less than 90° per
//!   half turn). A body that never shows its edge flutters: its net rotation is that of n about the
//!   horizontal axis that it swings about most.
//! * **flips**: how often the other face came up and stayed (beyond 10° from edge-on), either way
//!   round.
//! * **tilt**: the vector of length acos |n_y| along the horizontal part of the normal (the one that
//!   points up). Its amplitude is half of its range along its principal direction, less 1 % of the
//!   samples at each end: A for a flutter or a cone of ±A, however inclined in the mean; π/2 for
//!   tumbling; 0 for a steady glide.
//! * **frequency**: of the horizontal part of n along its principal direction, by upward passages
//!   through its mean with a hysteresis of ¼ of its amplitude: swings per second for a flutter, full
//!   turns per second for tumbling; 0 below 0.01 rad or with less than two passages.

use crate::math;
use crate::motion::{Moment, Trajectory};
use rapier3d::na::{Matrix2, Vector2, Vector3};
use std::f64::consts::PI;

/// Statistics of a fall over the second half of its record.
///
/// ```
/// use rapier3d_immersed::ThesisLaw;
/// use rapier3d_immersed::training::{Experiment, FallStatistics};
///
/// # fn main() -> Result<(), rapier3d_immersed::Error> {
/// let card = Experiment::thesis_card(ThesisLaw::new(ThesisLaw::ZIGZAG))?;
/// let statistics = FallStatistics::of(&card.run()?);
/// println!("{:.2} m/s down, {} flips", statistics.mean_descent, statistics.flips);
/// assert!(statistics.mean_descent > 0.3);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FallStatistics {
    /// Mean speed downward, m/s.
    pub mean_descent: f64,
    /// Net horizontal displacement over time, m/s.
    pub mean_horizontal: f64,
    /// Net rotation about the flipping axis over time, without sign, rad/s.
    pub rotation_rate: f64,
    /// How often the other face came up.
    pub flips: u32,
    /// Amplitude of the tilt, rad.
    pub tilt_amplitude: f64,
    /// Frequency of the oscillation or rotation, Hz.
    pub frequency: f64,
}

/// sin 10°: how far beyond edge-on a body has to turn before it counts as flipped.
const FLIPPED: f64 = 0.173_648;
/// Amplitude below which there is no oscillation to measure.
const STEADY: f64 = 0.01;

impl FallStatistics {
    /// Statistics of the second half of a fall. They are zero if that half has fewer than two moments.
    pub fn of(fall: &Trajectory) -> Self {
        let Some(last) = fall.moments.len().checked_sub(1) else {
            return Self::default();
        };
        let time = |index: usize| index as f64 * fall.interval;
        let half = &fall.moments[last.div_ceil(2)..];
        let duration = time(last) - time(last.div_ceil(2));
        if half.len() < 2 || duration.is_nan() || duration <= 0.0 {
            return Self::default();
        }
        let moved = half[half.len() - 1].position - half[0].position;
        let normals: Vec<Vector3<f64>> = half.iter().map(|m| m.normal).collect();
        Self {
            mean_descent: -moved.y / duration,
            mean_horizontal: math::hypot(moved.x, moved.z) / duration,
            rotation_rate: net_rotation(&normals).abs() / duration,
            flips: flips(&normals),
            tilt_amplitude: tilt_amplitude(&normals),
            frequency: frequency(half, fall.interval),
        }
    }
}

/// Smallest rotation that takes one unit vector to the next, as a rotation vector.
fn turn(from: &Vector3<f64>, to: &Vector3<f64>) -> Vector3<f64> {
    let cross = from.cross(to);
    let sine = cross.norm();
    if sine < 1e-300 {
        return Vector3::zeros();
    }
    cross * (math::atan2(sine, from.dot(to)) / sine)
}

/// Net angle about the flipping axis, rad; its sign is that of the first passage.
fn net_rotation(normals: &[Vector3<f64>]) -> f64 {
    // Where n goes through the horizontal: index of the step, and its horizontal axis.
    let passages: Vec<(usize, Vector3<f64>)> = normals
        .windows(2)
        .enumerate()
        .filter(|(_, pair)| (pair[0].y > 0.0) != (pair[1].y > 0.0))
        .map(|(i, pair)| {
            let edge_on = pair[0] * pair[1].y.abs() + pair[1] * pair[0].y.abs();
            let axis = edge_on.cross(&Vector3::y()) * (pair[1].y - pair[0].y).signum();
            (i, axis)
        })
        .collect();
    let about = |range: std::ops::Range<usize>, axis: &Vector3<f64>| -> f64 {
        let axis = axis.normalize();
        range
            .map(|i| turn(&normals[i], &normals[i + 1]).dot(&axis))
            .sum()
    };
    let steps = normals.len() - 1;
    let (Some((first, first_axis)), Some((last, last_axis))) = (passages.first(), passages.last())
    else {
        return swing_axis(normals).map_or(0.0, |axis| about(0..steps, &axis));
    };
    // Angle of n in the plane across the axis, at the middle of a passage's step: the steps of the
    // passages themselves are shared between before and after.
    let mut sign = 1.0;
    let mut angle = about(0..*first, first_axis) + passage_part(normals, *first, first_axis).0;
    for pair in passages.windows(2) {
        if pair[0].1.dot(&pair[1].1) > 0.0 {
            angle += sign * PI;
        } else {
            sign = -sign;
        }
    }
    angle += sign * passage_part(normals, *last, last_axis).1;
    angle + sign * about(*last + 1..steps, last_axis)
}

/// The rotation within the step of a passage, before and after the normal is horizontal.
fn passage_part(normals: &[Vector3<f64>], i: usize, axis: &Vector3<f64>) -> (f64, f64) {
    let whole = turn(&normals[i], &normals[i + 1]).dot(&axis.normalize());
    let (before, after) = (
        math::asin(normals[i].y.abs().min(1.0)),
        math::asin(normals[i + 1].y.abs().min(1.0)),
    );
    let share = if before + after > 0.0 {
        before / (before + after)
    } else {
        0.5
    };
    (whole * share, whole * (1.0 - share))
}

/// The horizontal axis about which the normal turns most.
fn swing_axis(normals: &[Vector3<f64>]) -> Option<Vector3<f64>> {
    let mut spread = Matrix2::zeros();
    for pair in normals.windows(2) {
        let turn = turn(&pair[0], &pair[1]);
        let flat = Vector2::new(turn.x, turn.z);
        spread += flat * flat.transpose();
    }
    let axis = principal(&spread)?;
    Some(Vector3::new(axis.x, 0.0, axis.y))
}

/// The eigenvector of the larger eigenvalue; `None` if both vanish.
fn principal(spread: &Matrix2<f64>) -> Option<Vector2<f64>> {
    let eigen = spread.symmetric_eigen();
    let index = usize::from(eigen.eigenvalues[1] > eigen.eigenvalues[0]);
    (eigen.eigenvalues[index] > 1e-24).then(|| eigen.eigenvectors.column(index).into_owned())
}

fn flips(normals: &[Vector3<f64>]) -> u32 {
    let mut up = normals[0].y > 0.0;
    let mut count = 0;
    for n in normals {
        if (up && n.y < -FLIPPED) || (!up && n.y > FLIPPED) {
            up = !up;
            count += 1;
        }
    }
    count
}

/// Values along the principal direction of their scatter about the mean, less that mean.
fn along_principal(points: &[Vector2<f64>]) -> Vec<f64> {
    let mean = points.iter().sum::<Vector2<f64>>() / points.len() as f64;
    let mut spread = Matrix2::zeros();
    for p in points {
        spread += (p - mean) * (p - mean).transpose();
    }
    match principal(&spread) {
        Some(axis) => points.iter().map(|p| (p - mean).dot(&axis)).collect(),
        None => vec![0.0; points.len()],
    }
}

fn tilt_amplitude(normals: &[Vector3<f64>]) -> f64 {
    let tilts: Vec<Vector2<f64>> = normals
        .iter()
        .map(|n| {
            let upward = if n.y < 0.0 { -n } else { *n };
            let flat = Vector2::new(upward.x, upward.z);
            let sine = flat.norm();
            flat * (math::atan2(sine, upward.y) / sine.max(1e-300))
        })
        .collect();
    let mut along = along_principal(&tilts);
    along.sort_by(f64::total_cmp);
    let skip = along.len() / 100;
    0.5 * (along[along.len() - 1 - skip] - along[skip])
}

fn frequency(half: &[Moment], interval: f64) -> f64 {
    let flat: Vec<Vector2<f64>> = half
        .iter()
        .map(|m| Vector2::new(m.normal.x, m.normal.z))
        .collect();
    let along = along_principal(&flat);
    let top = along.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if top < STEADY {
        return 0.0;
    }
    // Upward passages through the mean, armed by an excursion below −¼ of the amplitude.
    let mut armed = false;
    let mut times = Vec::new();
    for i in 1..along.len() {
        armed |= along[i] < -0.25 * top;
        let (a, b) = (along[i - 1], along[i]);
        if armed && a < 0.0 && b >= 0.0 {
            times.push(interval * ((i - 1) as f64 + a / (a - b)));
            armed = false;
        }
    }
    match (times.first(), times.last()) {
        (Some(first), Some(last)) if times.len() > 1 => (times.len() - 1) as f64 / (last - first),
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rapier3d::na::UnitQuaternion;
    use std::f64::consts::TAU;

    const DT: f64 = 0.004;

    /// A record of `seconds` of a motion whose normal is the body's y axis.
    fn motion(
        seconds: f64,
        position: impl Fn(f64) -> Vector3<f64>,
        orientation: impl Fn(f64) -> UnitQuaternion<f64>,
    ) -> Trajectory {
        let steps = (seconds / DT).round() as usize;
        let moment = |i: usize| {
            let time = i as f64 * DT;
            let orientation = orientation(time);
            Moment {
                position: position(time),
                normal: orientation * Vector3::y(),
                long_axis: orientation * Vector3::x(),
            }
        };
        Trajectory {
            interval: DT,
            moments: (0..=steps).map(moment).collect(),
        }
    }

    fn turning(seconds: f64, orientation: impl Fn(f64) -> UnitQuaternion<f64>) -> FallStatistics {
        FallStatistics::of(&motion(seconds, |_| Vector3::zeros(), orientation))
    }

    fn about(axis: Vector3<f64>, angle: f64) -> UnitQuaternion<f64> {
        UnitQuaternion::from_scaled_axis(axis * angle)
    }

    #[test]
    fn means_are_of_the_second_half() {
        // 3 m/s down and 0.5 m/s sideways after an arbitrary first half.
        let position = |t: f64| {
            let late = (t - 2.0).max(0.0);
            Vector3::new(0.3 * late, t.min(2.0).sin() - 3.0 * late, -0.4 * late)
        };
        let statistics = FallStatistics::of(&motion(4.0, position, |_| UnitQuaternion::identity()));
        assert!((statistics.mean_descent - 3.0).abs() < 1e-12);
        assert!((statistics.mean_horizontal - 0.5).abs() < 1e-12);
    }

    #[test]
    fn uniform_tumbling_has_its_exact_rate() {
        for (rate, seconds) in [(14.8, 4.0), (-3.0, 20.0), (150.0, 1.0), (0.4, 120.0)] {
            for heading in [0.0, 0.7, 2.5] {
                let axis = Vector3::new(f64::cos(heading), 0.0, f64::sin(heading));
                let statistics = turning(seconds, |t| about(axis, rate * t + 0.3));
                // Planar rotation is summed without approximation: rounding only.
                let error = (statistics.rotation_rate - f64::abs(rate)).abs();
                assert!(error < 1e-9 * rate.abs(), "{rate}: {statistics:?}");
                assert!((statistics.frequency - rate.abs() / TAU).abs() < 2e-3 * rate.abs() / TAU);
                let half_turns = rate.abs() * seconds / 2.0 / PI;
                assert!((f64::from(statistics.flips) - half_turns).abs() <= 1.0);
            }
        }
    }

    #[test]
    fn uneven_tumbling_has_its_exact_mean_rate() {
        let angle = |t: f64| 9.0 * t + 0.8 * (18.0 * t).sin();
        let statistics = turning(5.0, |t| about(Vector3::x(), angle(t)));
        let exact = (angle(5.0) - angle(2.5)) / 2.5;
        assert!((statistics.rotation_rate - exact).abs() < 1e-9);
    }

    #[test]
    fn the_tumbling_axis_may_precess_and_the_body_may_spin_about_its_normal() {
        // Heading turns at 1.5 rad/s while the normal turns at 12 rad/s about it: 22° per half turn.
        let statistics = turning(8.0, |t| {
            about(Vector3::y(), 1.5 * t)
                * about(Vector3::x(), 12.0 * t)
                * about(Vector3::y(), 5.0 * t)
        });
        // Only the pieces before the first and after the last passage are approximate: each is below
        // half a turn, out of 15 half turns, and off by the cosine of less than 22°.
        assert!(
            (statistics.rotation_rate - 12.0).abs() < 0.01 * 12.0,
            "{statistics:?}"
        );
    }

    #[test]
    fn flutter_has_no_net_rotation_and_the_amplitude_it_was_given() {
        let (amplitude, frequency, mean) = (0.7, 1.5, 0.15);
        let axis = Vector3::new(0.6, 0.0, 0.8);
        let statistics = turning(8.0, |t| {
            about(axis, mean + amplitude * (TAU * frequency * t).sin())
        });
        // 1 % of the samples are cut at each end: a sine then loses 1 − cos(0.01π) = 0.0005 of itself.
        assert!(
            (statistics.tilt_amplitude - amplitude).abs() < 1e-3 * amplitude,
            "{statistics:?}"
        );
        assert!((statistics.frequency - frequency).abs() < 1e-3);
        assert_eq!(statistics.flips, 0);
        // Four seconds are six whole swings.
        assert!(statistics.rotation_rate < 1e-9, "{statistics:?}");
    }

    #[test]
    fn swinging_over_and_back_is_no_rotation() {
        // ±115° about level: the other face comes up twice per swing.
        let statistics = turning(8.0, |t| about(Vector3::z(), 2.0 * (TAU * 0.5 * t).sin()));
        assert!(statistics.rotation_rate < 1e-9, "{statistics:?}");
        assert_eq!(statistics.flips, 2 * 4);
        assert!((statistics.tilt_amplitude - PI / 2.0).abs() < 0.05);
    }

    #[test]
    fn a_spiral_has_the_amplitude_of_its_cone() {
        // The normal goes round a cone of 0.5 rad twice a second.
        let statistics = turning(6.0, |t| {
            about(Vector3::y(), TAU * 2.0 * t)
                * about(Vector3::x(), 0.5)
                * about(Vector3::y(), -TAU * 2.0 * t)
        });
        assert!(
            (statistics.tilt_amplitude - 0.5).abs() < 1e-3 * 0.5,
            "{statistics:?}"
        );
        assert!((statistics.frequency - 2.0).abs() < 2e-3);
        assert_eq!(statistics.flips, 0);
        assert!(statistics.rotation_rate < 0.05, "{statistics:?}");
    }

    #[test]
    fn a_steady_glide_has_neither_amplitude_nor_frequency() {
        let statistics = turning(3.0, |t| {
            about(Vector3::x(), 0.3) * about(Vector3::y(), 40.0 * t)
        });
        assert!(statistics.tilt_amplitude < 1e-9);
        assert_eq!(statistics.frequency, 0.0);
        assert!(statistics.rotation_rate < 1e-9);
    }

    #[test]
    fn short_records() {
        let whole = motion(
            DT * 4.0,
            |t| Vector3::new(0.0, -t, 0.0),
            |_| UnitQuaternion::identity(),
        );
        assert!((FallStatistics::of(&whole).mean_descent - 1.0).abs() < 1e-9);
        for count in 0..2 {
            let moments = whole.moments[..count].to_vec();
            let short = Trajectory { moments, ..whole };
            assert_eq!(FallStatistics::of(&short), FallStatistics::default());
        }
        let timeless = Trajectory {
            interval: f64::NAN,
            ..whole
        };
        assert_eq!(FallStatistics::of(&timeless), FallStatistics::default());
    }
}
