//! The coin, the paper and the leaf of thesis § 3.6, with their own sizes: what their falls do, by
//! positions and attitudes alone.

use super::{ROUND, deviations, positions, round_numbers};
use rapier3d_immersed::Fluid;
use rapier3d_immersed::motion::path::{
    Deviation, HorizontalShape, MotionPath, SynthesisParams, Synthesizer, TrajectoryDatabase,
};
use rapier3d_immersed::motion::{
    Classifier, DimensionlessNumbers, Moment, Observation, Outline, PhaseDiagram, Regime,
    Trajectory,
};
use rapier3d_immersed::rapier3d::math::Vector;
use rapier3d_immersed::rapier3d::na::Vector3;
use std::f64::consts::{PI, TAU};

/// What falls: L, a and b in m (b the thickness), kg/m³.
struct Body {
    name: &'static str,
    fluid: Fluid,
    length: f64,
    chord: f64,
    thickness: f64,
    density: f64,
}

/// The thesis prints the sizes. Of the densities, that of the coin is aluminium's; those of paper and leaf
/// are ours.
const BODIES: [Body; 3] = [
    Body {
        name: "coin",
        fluid: Fluid::WATER,
        length: 0.02,
        chord: 0.02,
        thickness: 0.0015,
        density: 2700.0,
    },
    Body {
        name: "paper",
        fluid: Fluid::AIR,
        length: 0.08,
        chord: 0.02,
        thickness: 0.0001,
        density: 800.0,
    },
    Body {
        name: "leaf",
        fluid: Fluid::AIR,
        length: 0.073,
        chord: 0.042,
        thickness: 0.0003,
        density: 400.0,
    },
];

impl Body {
    fn numbers(&self) -> DimensionlessNumbers {
        let (chord, thickness) = (self.chord, self.thickness);
        DimensionlessNumbers::new(
            Outline::Round,
            chord,
            thickness,
            self.density,
            &self.fluid,
            9.81,
        )
        .unwrap()
    }

    fn synthesizer(&self, params: SynthesisParams) -> Synthesizer {
        let database = TrajectoryDatabase::shipped();
        Synthesizer::new(&self.numbers(), self.length, database, params).unwrap()
    }

    /// U by (3.3), √((ρ_s/ρ_f − 1) g b).
    fn descent(&self) -> f64 {
        let ratio = self.density / f64::from(self.fluid.density());
        ((ratio - 1.0) * 9.81 * self.thickness).sqrt()
    }
}

/// A fall of some thirty swings, without anything drawn at random but which way it goes.
fn regular(body: &Body, regime: Regime) -> SynthesisParams {
    SynthesisParams {
        main: Some(regime),
        height: 100.0 * body.chord,
        interval: 0.01 * body.chord / body.descent(),
        variety: 0.0,
        deviations: deviations(Deviation {
            width: 0.0,
            ..ROUND
        }),
        ..round_numbers()
    }
}

/// What can be seen of a fall.
fn seen(path: &MotionPath) -> Trajectory {
    let moments = path.keys().iter().map(|key| {
        let axis = |axis: Vector| {
            let turned = key.attitude * axis;
            Vector3::from(turned.to_array().map(f64::from))
        };
        Moment {
            position: Vector3::from(key.position.to_array().map(f64::from)),
            normal: axis(Vector::Z),
            long_axis: axis(Vector::X),
        }
    });
    Trajectory {
        interval: f64::from(path.interval()),
        moments: moments.collect(),
    }
}

/// The direct classifier, which was made for falls under forces and knows nothing of how a path came
/// about, sees in each the regime that it was asked for. Of chaos, which a single fall shows by chance, it
/// sees both halves in twenty falls together. The helix of (3.7) has four equal petals, so that its
/// velocity goes round as evenly as a spiral's: what tells it from one is its outline (`projections`). The
/// coin goes round lying nearly flat, which counts as steady: it leans by a degree, AΩ² over gravity less
/// buoyancy.
#[test]
fn falls_are_seen_as_what_they_are() {
    let classifier = Classifier::default();
    for body in &BODIES {
        for regime in Regime::ALL {
            let synthesizer = body.synthesizer(regular(body, regime));
            let observed = (0..20).map(|seed| {
                let path = synthesizer.path_through(&[regime], seed).unwrap();
                classifier.classify(&seen(&path))
            });
            let observed: Vec<Observation> = observed.collect();
            let expected = match regime {
                Regime::TransitionalHelix | Regime::PeriodicSpiral => {
                    // 100 chords at U, of which a third is not looked at; a turn takes 6π chords.
                    let turns = 2.0 / 3.0 * 100.0 / (3.0 * TAU);
                    for found in &observed {
                        assert!((found.turns - turns).abs() < 0.2, "{regime} {found:?}");
                        assert!(found.roundness > 0.95, "{regime} {found:?}");
                    }
                    match body.name {
                        "coin" => Regime::SteadyDescent,
                        _ => Regime::PeriodicSpiral,
                    }
                }
                Regime::TransitionalChaotic => {
                    let flips: u32 = observed.iter().map(|o| o.flips).sum();
                    let reversals: u32 = observed.iter().map(|o| o.reversals).sum();
                    let share = f64::from(flips) / f64::from(flips + reversals);
                    println!(
                        "{}: {share:.2} of the turns of chaotic falls go on",
                        body.name
                    );
                    let chaotic = classifier.flutter_share..classifier.tumbling_share;
                    assert!(chaotic.contains(&share), "{} {share}", body.name);
                    continue;
                }
                other => other,
            };
            for found in observed {
                assert_eq!(found.regime, expected, "{} {regime}: {found:?}", body.name);
            }
        }
    }
}

/// Re and I* by the formulas, with the regime that the published table of the measured boundaries has
/// there, read by hand: chaos above I* = .0086 to .0091 between Re = 2000 and 5000, tumbling above .0396
/// to .0401 between 1000 and 2000, and above .0401 to .0410 between 2000 and 5000. None of the three is
/// what the thesis shows of the body; that is what the cases are for ([`SynthesisParams::of_case`]).
#[test]
fn computed_numbers_give_what_was_measured() {
    let by_hand = [
        // Re and I* of the coin are the printed ones, 3.55e3 and 1.0e-2, to their digits.
        (3.55e3, 1.0e-2, Regime::TransitionalChaotic),
        (1.042e3, 1.658e-1, Regime::PeriodicTumbling),
        (2.677e3, 1.185e-1, Regime::PeriodicTumbling),
    ];
    for ((body, case), (reynolds, i_star, measured)) in
        BODIES.iter().zip(PhaseDiagram::THESIS_CASES).zip(by_hand)
    {
        let numbers = body.numbers();
        let close = |a: f64, b: f64| (a / b - 1.0).abs() < 0.01;
        assert!(close(numbers.reynolds_u0, reynolds), "{numbers:?}");
        assert!(close(numbers.i_star, i_star), "{numbers:?}");
        // The diagram has the Reynolds number of the mean descent: of a broadside disc at C_D = 1.17.
        let broadside = (2.0f64 / 1.17).sqrt() * numbers.reynolds_u0;
        assert!(close(numbers.reynolds(), broadside), "{numbers:?}");
        let computed = body.synthesizer(SynthesisParams::default());
        assert_eq!(computed.main(), measured, "{}", body.name);
        assert_ne!(measured, case.regime, "{}", body.name);
        let as_shown = body.synthesizer(SynthesisParams::of_case(&case));
        let ends = (0..200).map(|seed| *as_shown.path(seed).sequence().last().unwrap());
        assert_eq!(ends.max(), Some(case.regime), "{}", body.name);
    }
}

/// Where the horizontal velocity along the glide changes its sign.
fn turning_points(path: &MotionPath) -> Vec<usize> {
    let all = positions(path);
    let drift = (all[all.len() - 1].x - all[0].x) / (all.len() - 1) as f64;
    let slope = |i: usize| all[i + 1].x - all[i].x - drift;
    (1..all.len() - 1)
        .filter(|i| slope(i - 1) * slope(*i) < 0.0)
        .collect()
}

/// U, Ω = U/a and A = .75 (L/a) U/Ω (thesis (3.3), § 3.3.5, its A_0 in units of our own) by hand, against the path: how fast it
/// falls, how often a flutter turns back, and how wide and how fast a spiral goes round (three times as
/// slowly, a convention).
#[test]
fn falls_have_the_scales_of_their_body() {
    for body in &BODIES {
        let fall = |regime| {
            let synthesizer = body.synthesizer(regular(body, regime));
            synthesizer.path_through(&[regime], 1).unwrap()
        };
        let (chord, descent) = (body.chord, body.descent());
        let half_period = PI * chord / descent;

        let flutter = fall(Regime::PeriodicFlutter);
        let fallen = -positions(&flutter).last().unwrap().y / f64::from(flutter.duration());
        assert!((fallen / descent - 1.0).abs() < 1e-5, "{fallen} {descent}");
        let turns = turning_points(&flutter);
        let (first, last) = (turns[0], turns[turns.len() - 1]);
        let interval = f64::from(flutter.interval()) * (last - first) as f64;
        let swing = interval / (turns.len() - 1) as f64;
        // The segments of the database are 17 % apart in Ω, which is met within half of that.
        assert!(
            (swing / half_period).ln().abs() < 0.085,
            "{swing} {half_period}"
        );

        let spiral = positions(&fall(Regime::PeriodicSpiral));
        let turn = 3.0 * TAU * chord / descent;
        let interval = 0.01 * chord / descent;
        let count = (turn / interval).round() as usize;
        let end = &spiral[spiral.len() - 1 - count..];
        // Without the drift to the landing, which is the same everywhere.
        let drift = (end[count] - end[0]) / count as f64;
        let circle: Vec<_> = (0..count).map(|i| end[i] - drift * i as f64).collect();
        let radius = HorizontalShape::of(&circle).extent;
        let amplitude = 0.75 * (body.length / chord) * chord;
        // One turn is cut at a keyframe: a hundredth of U/a in 19.
        assert!(
            (radius / amplitude - 1.0).abs() < 0.01,
            "{radius} {amplitude}"
        );
    }
}

/// Tumbling and chaos are e times as unlikely to begin in a wind of 1.5 U, and e⁴ times in one of 3 U:
/// whatever U is, which differs among the bodies. (The number is a choice: see
/// [`SynthesisParams::calming_wind`].)
#[test]
fn wind_is_measured_by_the_descent() {
    for body in &BODIES {
        let odds = |wind: f64| {
            let synthesizer = body.synthesizer(SynthesisParams {
                wind,
                ..regular(body, Regime::PeriodicSpiral)
            });
            let graph = synthesizer.graph();
            [Regime::TransitionalChaotic, Regime::PeriodicTumbling].map(|wild| {
                graph.start(wild as usize) / graph.start(Regime::PeriodicFlutter as usize)
            })
        };
        let still = odds(0.0);
        for (winds, power) in [(1.5, 1.0), (3.0, 4.0)] {
            for (found, still) in odds(winds * body.descent()).iter().zip(still) {
                let expected = still * f64::exp(-power);
                // The density of a fluid is in f32.
                assert!(
                    (found / expected - 1.0).abs() < 1e-5,
                    "{} {winds}",
                    body.name
                );
            }
        }
    }
}
