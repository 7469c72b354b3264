//! The statistics of a fall must be right for motions whose rotation, amplitude and frequency are
//! known by construction.

use crate::support::statistics::{Sample, Statistics};
use crate::support::{Quat, Vec3};
use std::f64::consts::{PI, TAU};

const DT: f64 = 0.004;

/// Samples of `seconds` of a motion whose normal is the body's y axis.
fn motion(
    seconds: f64,
    position: impl Fn(f64) -> Vec3,
    orientation: impl Fn(f64) -> Quat,
) -> Vec<Sample> {
    let steps = (seconds / DT).round() as usize;
    (0..=steps)
        .map(|i| {
            let time = i as f64 * DT;
            let orientation = orientation(time);
            Sample {
                time,
                position: position(time),
                orientation,
                velocity: Vec3::zeros(),
                spin: Vec3::zeros(),
                normal: orientation * Vec3::y(),
            }
        })
        .collect()
}

fn turning(seconds: f64, orientation: impl Fn(f64) -> Quat) -> Statistics {
    Statistics::of(&motion(seconds, |_| Vec3::zeros(), orientation))
}

fn about(axis: Vec3, angle: f64) -> Quat {
    Quat::from_scaled_axis(axis * angle)
}

#[test]
fn means_are_of_the_second_half() {
    // 3 m/s down and 0.5 m/s sideways after an arbitrary first half.
    let position = |t: f64| {
        let late = (t - 2.0).max(0.0);
        Vec3::new(0.3 * late, t.min(2.0).sin() - 3.0 * late, -0.4 * late)
    };
    let statistics = Statistics::of(&motion(4.0, position, |_| Quat::identity()));
    assert!((statistics.mean_descent - 3.0).abs() < 1e-12);
    assert!((statistics.mean_horizontal - 0.5).abs() < 1e-12);
}

#[test]
fn uniform_tumbling_has_its_exact_rate() {
    for (rate, seconds) in [(14.8, 4.0), (-3.0, 20.0), (150.0, 1.0), (0.4, 120.0)] {
        for heading in [0.0, 0.7, 2.5] {
            let axis = Vec3::new(f64::cos(heading), 0.0, f64::sin(heading));
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
    let statistics = turning(5.0, |t| about(Vec3::x(), angle(t)));
    let exact = (angle(5.0) - angle(2.5)) / 2.5;
    assert!((statistics.rotation_rate - exact).abs() < 1e-9);
}

#[test]
fn the_tumbling_axis_may_precess_and_the_body_may_spin_about_its_normal() {
    // Heading turns at 1.5 rad/s while the normal turns at 12 rad/s about it: 22° per half turn.
    let statistics = turning(8.0, |t| {
        about(Vec3::y(), 1.5 * t) * about(Vec3::x(), 12.0 * t) * about(Vec3::y(), 5.0 * t)
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
    let axis = Vec3::new(0.6, 0.0, 0.8);
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
    let statistics = turning(8.0, |t| about(Vec3::z(), 2.0 * (TAU * 0.5 * t).sin()));
    assert!(statistics.rotation_rate < 1e-9, "{statistics:?}");
    assert_eq!(statistics.flips, 2 * 4);
    assert!((statistics.tilt_amplitude - PI / 2.0).abs() < 0.05);
}

#[test]
fn a_spiral_has_the_amplitude_of_its_cone() {
    // The normal goes round a cone of 0.5 rad twice a second.
    let statistics = turning(6.0, |t| {
        about(Vec3::y(), TAU * 2.0 * t) * about(Vec3::x(), 0.5) * about(Vec3::y(), -TAU * 2.0 * t)
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
    let statistics = turning(3.0, |t| about(Vec3::x(), 0.3) * about(Vec3::y(), 40.0 * t));
    assert!(statistics.tilt_amplitude < 1e-9);
    assert_eq!(statistics.frequency, 0.0);
    assert!(statistics.rotation_rate < 1e-9);
}

#[test]
fn few_samples_give_zeros() {
    let samples = motion(DT * 2.0, |t| Vec3::new(0.0, -t, 0.0), |_| Quat::identity());
    assert_eq!(Statistics::of(&[]), Statistics::default());
    assert_eq!(Statistics::of(&samples[..1]), Statistics::default());
    assert!((Statistics::of(&samples).mean_descent - 1.0).abs() < 1e-9);
}
