//! What the example `methods` compares: means of measured falls, and of its own.

use crate::means::Means;
use crate::measured;
use crate::support::Vec3;
use rapier3d_immersed::motion::{Moment, Pattern, Regime, Trajectory};

/// Computed independently, by a script over `tests/data/paper/falls.csv`.
#[test]
fn measured_falls_are_averaged_by_their_time() {
    let measured = measured::means().unwrap();
    assert_eq!(measured.falls, 23);
    assert!((measured.descent - 0.683_297_988).abs() < 1e-8);
    assert!((measured.drift - 0.408_203_331).abs() < 1e-8);
    let tumbling = measured.shares[Regime::PeriodicTumbling as usize];
    assert!((tumbling - 0.977_130_524).abs() < 1e-8);
    let chaotic = measured.shares[Regime::TransitionalChaotic as usize];
    assert!((tumbling + chaotic - 1.0).abs() < 1e-12);
}

#[test]
fn measured_transitions_are_those_of_the_regimes_that_were_seen() {
    let [regimes, patterns] = measured::graphs().unwrap();
    assert_eq!((regimes.states(), patterns.states()), (6, 4));
    let start = regimes.start(Regime::PeriodicTumbling as usize);
    assert!(start > 0.9);
    assert_eq!(start, patterns.start(Pattern::Autorotation.index()));
    assert_eq!(regimes.start(Regime::PeriodicFlutter as usize), 0.0);
}

/// Down at 0.8 m/s and aside at 0.3 and 0.4 along x and z, turning over at 12 rad/s.
fn straight() -> Trajectory {
    let moments = (0..400).map(|i| {
        let time = f64::from(i) / 200.0;
        let (sine, cosine) = (12.0 * time).sin_cos();
        Moment {
            position: Vec3::new(0.3, -0.8, 0.4) * time,
            normal: Vec3::new(-sine, cosine, 0.0),
            long_axis: Vec3::z(),
        }
    });
    Trajectory {
        interval: 1.0 / 200.0,
        moments: moments.collect(),
    }
}

#[test]
fn falls_are_averaged_between_two_depths() {
    let fall = straight();
    // This one does not come down far enough to count.
    let short = Trajectory {
        moments: fall.moments[..200].to_vec(),
        ..fall
    };
    let means = Means::of(&[fall, short]);
    assert_eq!(means.falls, 1);
    assert!((means.descent - 0.8).abs() < 1e-9 && (means.drift - 0.5).abs() < 1e-9);
    assert_eq!(means.shares[Regime::PeriodicTumbling as usize], 1.0);
    let measured = Means {
        descent: 1.0,
        drift: 0.4,
        shares: [0.25, 0.0, 0.0, 0.75, 0.0, 0.0],
        ..Means::default()
    };
    let [descent, drift, regimes] = means.errors(&measured);
    assert!((descent + 0.2).abs() < 1e-9 && (drift - 0.25).abs() < 1e-9);
    // A quarter of the falls is in another regime.
    assert!((regimes - 0.25).abs() < 1e-12);
    assert_eq!(means.regimes(), "PT 100");
}
