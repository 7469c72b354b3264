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

use super::{Quat, Vec3};
use rapier3d_immersed::rapier3d::na::{Matrix2, Vector2};
use std::f64::consts::PI;

/// One moment of a fall, world axes.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Time since the release, s.
    pub time: f64,
    /// Center of mass, m.
    pub position: Vec3,
    /// Orientation of the body's frame.
    pub orientation: Quat,
    /// Velocity of the center of mass, m/s.
    pub velocity: Vec3,
    /// Angular velocity, rad/s.
    pub spin: Vec3,
    /// Plate normal.
    pub normal: Vec3,
}

impl Sample {
    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        let vectors = [self.position, self.velocity, self.spin, self.normal];
        vectors.iter().flat_map(|v| v.iter()).all(|x| x.is_finite())
            && self.orientation.coords.iter().all(|x| x.is_finite())
    }
}

/// Statistics over the second half of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Statistics {
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

impl Statistics {
    /// Statistics of the second half of `samples`, which are in order of time. Zeros for fewer than
    /// three samples.
    pub fn of(samples: &[Sample]) -> Self {
        let (Some(first), Some(last)) = (samples.first(), samples.last()) else {
            return Self::default();
        };
        let middle = 0.5 * (first.time + last.time);
        let from = samples.partition_point(|s| s.time < middle - 1e-9 * last.time.abs());
        let half = &samples[from..];
        let duration = last.time - half[0].time;
        if half.len() < 2 || duration <= 0.0 {
            return Self::default();
        }
        let moved = last.position - half[0].position;
        let normals: Vec<Vec3> = half.iter().map(|s| s.normal).collect();
        let tilt_amplitude = tilt_amplitude(&normals);
        Self {
            mean_descent: -moved.y / duration,
            mean_horizontal: moved.x.hypot(moved.z) / duration,
            rotation_rate: net_rotation(&normals).abs() / duration,
            flips: flips(&normals),
            tilt_amplitude,
            frequency: frequency(half),
        }
    }
}

/// Smallest rotation that takes one unit vector to the next, as a rotation vector.
fn turn(from: &Vec3, to: &Vec3) -> Vec3 {
    let cross = from.cross(to);
    let sine = cross.norm();
    if sine < 1e-300 {
        return Vec3::zeros();
    }
    cross * (sine.atan2(from.dot(to)) / sine)
}

/// Net angle about the flipping axis, rad; its sign is that of the first passage.
fn net_rotation(normals: &[Vec3]) -> f64 {
    // Where n goes through the horizontal: index of the step, and its horizontal axis.
    let passages: Vec<(usize, Vec3)> = normals
        .windows(2)
        .enumerate()
        .filter(|(_, pair)| (pair[0].y > 0.0) != (pair[1].y > 0.0))
        .map(|(i, pair)| {
            let edge_on = pair[0] * pair[1].y.abs() + pair[1] * pair[0].y.abs();
            let axis = edge_on.cross(&Vec3::y()) * (pair[1].y - pair[0].y).signum();
            (i, axis)
        })
        .collect();
    let about = |range: std::ops::Range<usize>, axis: &Vec3| -> f64 {
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
fn passage_part(normals: &[Vec3], i: usize, axis: &Vec3) -> (f64, f64) {
    let whole = turn(&normals[i], &normals[i + 1]).dot(&axis.normalize());
    let (before, after) = (
        normals[i].y.abs().min(1.0).asin(),
        normals[i + 1].y.abs().min(1.0).asin(),
    );
    let share = if before + after > 0.0 {
        before / (before + after)
    } else {
        0.5
    };
    (whole * share, whole * (1.0 - share))
}

/// The horizontal axis about which the normal turns most.
fn swing_axis(normals: &[Vec3]) -> Option<Vec3> {
    let mut spread = Matrix2::zeros();
    for pair in normals.windows(2) {
        let turn = turn(&pair[0], &pair[1]);
        let flat = Vector2::new(turn.x, turn.z);
        spread += flat * flat.transpose();
    }
    let axis = principal(&spread)?;
    Some(Vec3::new(axis.x, 0.0, axis.y))
}

/// The eigenvector of the larger eigenvalue; `None` if both vanish.
fn principal(spread: &Matrix2<f64>) -> Option<Vector2<f64>> {
    let eigen = spread.symmetric_eigen();
    let index = usize::from(eigen.eigenvalues[1] > eigen.eigenvalues[0]);
    (eigen.eigenvalues[index] > 1e-24).then(|| eigen.eigenvectors.column(index).into_owned())
}

fn flips(normals: &[Vec3]) -> u32 {
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

fn tilt_amplitude(normals: &[Vec3]) -> f64 {
    let tilts: Vec<Vector2<f64>> = normals
        .iter()
        .map(|n| {
            let upward = if n.y < 0.0 { -n } else { *n };
            let flat = Vector2::new(upward.x, upward.z);
            let sine = flat.norm();
            flat * (sine.atan2(upward.y) / sine.max(1e-300))
        })
        .collect();
    let mut along = along_principal(&tilts);
    along.sort_by(f64::total_cmp);
    let skip = along.len() / 100;
    0.5 * (along[along.len() - 1 - skip] - along[skip])
}

fn frequency(half: &[Sample]) -> f64 {
    let flat: Vec<Vector2<f64>> = half
        .iter()
        .map(|s| Vector2::new(s.normal.x, s.normal.z))
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
            let share = a / (a - b);
            times.push(half[i - 1].time + share * (half[i].time - half[i - 1].time));
            armed = false;
        }
    }
    match (times.first(), times.last()) {
        (Some(first), Some(last)) if times.len() > 1 => (times.len() - 1) as f64 / (last - first),
        _ => 0.0,
    }
}
