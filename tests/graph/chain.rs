//! Falls follow the Markov chain (thesis § 3.4), in wind too: what a path says of its regimes against a chain
//! by hand in round numbers.

use super::{leaf, up_to};
use rapier3d_immersed::motion::Regime;
use rapier3d_immersed::motion::path::{MotionPath, SynthesisParams};

type Row = [f64; 6];

/// U of the leaf by (3.3), m/s, and its half period πa/U, s.
const DESCENT: f64 = 0.99565;
const HALF_PERIOD: f64 = 0.13252;

/// exp(−(wind/(1.5 U))²): what the probability of tumbling and chaos is multiplied by in a wind, m/s.
fn calm(wind: f64) -> f64 {
    (-(wind / (1.5 * DESCENT)).powi(2)).exp()
}

/// Start and transitions: any start alike; a fall stays with ¾, and each regime further on is half as likely
/// as the one before it. Tumbling and chaos are `calm` times as likely, and what is not `possible` is left
/// out; then everything sums to one again.
fn by_hand(calm: f64, possible: [bool; 6]) -> (Row, [Row; 6]) {
    let normal = |row: Row| {
        let mut row = row;
        for (state, p) in row.iter_mut().enumerate() {
            *p *= match state {
                2 | 3 => calm,
                _ => 1.0,
            } * f64::from(u8::from(possible[state]));
        }
        let sum: f64 = row.iter().sum();
        row.map(|p| p / sum)
    };
    let leaving = [
        [0.0, 16.0, 8.0, 4.0, 2.0, 1.0].map(|p| p / 31.0 / 4.0),
        [0.0, 0.0, 8.0, 4.0, 2.0, 1.0].map(|p| p / 15.0 / 4.0),
        [0.0, 0.0, 0.0, 4.0, 2.0, 1.0].map(|p| p / 7.0 / 4.0),
        [0.0, 0.0, 0.0, 0.0, 2.0, 1.0].map(|p| p / 3.0 / 4.0),
        [0.0, 0.0, 0.0, 0.0, 0.0, 1.0].map(|p| p / 4.0),
        [0.0; 6],
    ];
    let mut rows = leaving;
    for (state, row) in rows.iter_mut().enumerate() {
        row[state] = if state == 5 { 1.0 } else { 0.75 };
        *row = normal(*row);
    }
    (normal([1.0; 6]), rows)
}

/// Upper 0.1 % point of the χ² distribution with 1 … 5 degrees of freedom (standard tables).
const CHI_SQUARED: [f64; 5] = [10.828, 13.816, 16.266, 18.467, 20.515];

/// Counts against probabilities; what is impossible must not occur.
fn check(what: &str, counts: &[f64], expected: &[f64]) {
    let whole: f64 = counts.iter().sum();
    let (mut chi2, mut cells) = (0.0, 0);
    for (count, p) in counts.iter().zip(expected) {
        if *p == 0.0 {
            assert_eq!(*count, 0.0, "{what}: {counts:?}");
        } else {
            chi2 += (count - whole * p).powi(2) / (whole * p);
            cells += 1;
        }
    }
    println!("{what}: {counts:?}, χ² {chi2:.2} of {cells} cells");
    assert!(whole > 200.0, "{what}: {counts:?}");
    assert!(cells < 2 || chi2 < CHI_SQUARED[cells - 2], "{what}: {chi2}");
}

/// Falls of two meters from so many seeds; keyframes do not matter here.
fn falls(params: SynthesisParams, count: u64) -> impl Iterator<Item = MotionPath> {
    let synthesizer = leaf(SynthesisParams {
        interval: 0.1,
        ..params
    });
    (0..count).map(move |seed| synthesizer.path(seed))
}

/// Where falls begin, what follows what, and how long steady descent lasts: in still air and in a wind that
/// makes tumbling and chaos a third as likely. What follows, given that something does, does not depend on
/// how long the one before lasted, so that the landing, which cuts falls off, does no harm.
#[test]
fn falls_are_drawn_from_the_chain() {
    for wind in [0.0, 1.5] {
        let (start, rows) = by_hand(calm(wind), [true; 6]);
        let (mut starts, mut jumps, mut stays) = ([0.0; 6], [[0.0; 6]; 6], [0.0; 6]);
        let params = SynthesisParams {
            wind,
            ..up_to(Regime::PeriodicSpiral, 2.0)
        };
        for path in falls(params, 6000) {
            let regimes = path.regimes();
            starts[regimes[0].1 as usize] += 1.0;
            for pair in regimes.windows(2) {
                jumps[pair[0].1 as usize][pair[1].1 as usize] += 1.0;
            }
            if regimes[0].1 == Regime::SteadyDescent {
                let lasted = regimes.get(1).map_or(path.duration(), |next| next.0);
                // A fall is stretched by less than half of its 15 half periods.
                let segments = (f64::from(lasted) / HALF_PERIOD).round() as usize;
                stays[segments.min(6) - 1] += 1.0;
            }
        }
        check(&format!("start at {wind} m/s"), &starts, &start);
        for regime in &Regime::ALL[..5] {
            let from = *regime as usize;
            let mut leaving = rows[from];
            leaving[from] = 0.0;
            let sum: f64 = leaving.iter().sum();
            let leaving = leaving.map(|p| p / sum);
            check(&format!("after {regime}"), &jumps[from], &leaving);
        }
        // Geometric: one segment, two, … and six or more.
        let stay = rows[0][0];
        let mut expected = [0.0; 6];
        for (n, p) in expected.iter_mut().enumerate() {
            *p = stay.powi(n as i32) * if n < 5 { 1.0 - stay } else { 1.0 };
        }
        check("segments of steady descent", &stays, &expected);
    }
}

/// The share of the time that each regime has, by powers of the transition matrix, where all segments last
/// alike: without chaos and without variety, whose segments then take half a period within 2 %. Three and
/// a half standard errors, from the scatter among falls.
#[test]
fn shares_of_time_are_those_of_the_chain() {
    let possible = [true, true, false, true, true, true];
    for wind in [0.0, 0.8, 1.5] {
        let (mut occupied, rows) = by_hand(calm(wind), possible);
        // 2 m at U are 15.16 half periods.
        let (segments, count) = (15, 4000);
        let mut expected = [0.0; 6];
        for _ in 0..segments {
            let mut next = [0.0; 6];
            for from in 0..6 {
                expected[from] += occupied[from] / f64::from(segments);
                for to in 0..6 {
                    next[to] += occupied[from] * rows[from][to];
                }
            }
            occupied = next;
        }
        let all = up_to(Regime::PeriodicSpiral, 2.0).graph.unwrap();
        let params = SynthesisParams {
            wind,
            variety: 0.0,
            graph: Some(all.restricted(&possible).unwrap()),
            ..up_to(Regime::PeriodicSpiral, 2.0)
        };
        let (mut sums, mut squares) = ([0.0; 6], [0.0; 6]);
        for path in falls(params, count) {
            let mut shares = [0.0; 6];
            for i in 0..segments {
                let at = (i as f32 + 0.5) / segments as f32 * path.duration();
                shares[path.regime_at(at) as usize] += 1.0 / f64::from(segments);
            }
            for state in 0..6 {
                sums[state] += shares[state];
                squares[state] += shares[state] * shares[state];
            }
        }
        let n = count as f64;
        for regime in Regime::ALL {
            let state = regime as usize;
            let mean = sums[state] / n;
            let error = ((squares[state] / n - mean * mean) / n).sqrt();
            println!(
                "{regime} at {wind} m/s: {mean:.4} ± {error:.4}, by the chain {:.4}",
                expected[state]
            );
            assert!(
                (mean - expected[state]).abs() <= 3.5 * error,
                "{regime} {wind}"
            );
        }
    }
}

/// The stronger the wind, the less likely tumbling and chaos and the more likely all else, after any
/// regime and for any main one; in a gale nothing but what always tumbled does.
#[test]
fn wind_calms_every_fall() {
    for main in Regime::ALL {
        let row = |wind, from| -> Row {
            let synthesizer = leaf(SynthesisParams {
                wind,
                ..up_to(main, 2.0)
            });
            let graph = synthesizer.graph();
            std::array::from_fn(|to| match from {
                6 => graph.start(to),
                _ => graph.probability(from, to),
            })
        };
        for from in 0..7 {
            let rows = [0.0, 0.3, 0.6, 1.2, 2.4, 10.0].map(|wind| row(wind, from));
            let other: f64 = [0, 1, 4, 5].iter().map(|to| rows[0][*to]).sum();
            for pair in rows.windows(2) {
                for (to, (before, after)) in pair[0].iter().zip(pair[1]).enumerate() {
                    let change = after - before;
                    match to {
                        2 | 3 if other == 0.0 => assert!(change.abs() < 1e-12),
                        2 | 3 if *before > 0.0 => assert!(change < 0.0),
                        _ => assert!(change >= -1e-12, "{main} {from} {to}"),
                    }
                }
            }
            let last = rows[5];
            assert!(other == 0.0 || last[2] + last[3] < 1e-12, "{main} {from}");
        }
    }
}
