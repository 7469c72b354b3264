//! `--estimate`: the numbers of chapter 3 that the thesis takes from experiments without printing them, estimated from
//! falls of this crate's discs under its default law.
//!
//! Discs cover the phase diagram, and releases all tilts, evenly: fall k is point k of a low-discrepancy
//! sequence (the R₃ of Roberts), so that the first few of many falls are a sample of all of it.

use rapier3d_immersed::motion::{
    Classifier, DimensionlessNumbers, Estimate, EstimateSource, FallEstimates, Moment, Regime,
};
use rapier3d_immersed::training::FallStatistics;
use rapier3d_immersed::training::fidelity::Disc;
use rapier3d_immersed::{Error, ViscousLaw};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Ranges of Re (of the broadside disc) and I*.
pub const REYNOLDS: [f64; 2] = [50.0, 3e4];
pub const I_STAR: [f64; 2] = [3e-4, 0.3];
/// Half periods π d/U that a label looks at.
pub const WINDOW: usize = 4;

/// What one fall showed.
#[derive(Clone, Debug)]
pub struct Fall {
    pub i_star: f64,
    /// The regime of the last three fifths.
    pub main: Regime,
    /// The regime about each half period.
    pub labels: Vec<Regime>,
    /// Horizontal distance of the landing over the height.
    pub deviation: f64,
    /// Ω, and horizontal velocity amplitude AΩ, of the last half: in U0/d and U0.
    pub frequency: f64,
    pub swing: f64,
}

fn between([low, high]: [f64; 2], share: f64) -> f64 {
    low * (high / low).powf(share)
}

/// Drops disc number `index`.
pub fn fall(index: u64) -> Result<Fall, Error> {
    // The root of x⁴ = x + 1.
    const PHI: f64 = 1.220_744_084_605_76;
    let share = |power: i32| (0.5 + (index + 1) as f64 / PHI.powi(power)).fract();
    let (reynolds, i_star) = (between(REYNOLDS, share(1)), between(I_STAR, share(2)));
    let disc = Disc::new(reynolds, i_star, Regime::SteadyDescent)?;
    let tilt = 0.5 * PI * share(3);
    let experiment = disc.experiment(&ViscousLaw::default(), tilt, index)?;
    let fall = experiment.run()?;
    let statistics = FallStatistics::of(&fall);
    let classifier = Classifier::default();
    let moments = &fall.moments;
    let numbers = DimensionlessNumbers::of(
        &experiment.body.hydro,
        &experiment.mass,
        &experiment.fluid,
        experiment.gravity,
    )?;
    let (diameter, speed) = (numbers.length, numbers.u0);
    let half_period = PI * diameter / speed;
    let step = half_period / fall.interval;
    let count = (moments.len() as f64 / step) as usize;
    let labels = (0..(count + 1).saturating_sub(WINDOW)).map(|k| {
        let at = |n: usize| ((n as f64 * step) as usize).min(moments.len());
        classifier.observe(&moments[at(k)..at(k + WINDOW)]).regime
    });
    let skipped = moments.len() * 2 / 5;
    let landing = moments[moments.len() - 1].position - moments[0].position;
    let swing = swing(&moments[moments.len() / 2..]);
    Ok(Fall {
        i_star,
        main: classifier.observe(&moments[skipped..]).regime,
        labels: labels.collect(),
        deviation: landing.x.hypot(landing.z) / -landing.y,
        frequency: 2.0 * PI * statistics.frequency * diameter / speed,
        swing: swing * 2.0 * PI * statistics.frequency / speed,
    })
}

/// Amplitude, m, of the horizontal oscillation about uniform motion: √2 standard deviations.
fn swing(moments: &[Moment]) -> f64 {
    let n = moments.len() as f64;
    let middle = 0.5 * (n - 1.0);
    let mut square = 0.0;
    for axis in [0, 2] {
        let x = |i: usize| moments[i].position[axis];
        let indices = 0..moments.len();
        let mean = indices.clone().map(x).sum::<f64>() / n;
        let slope = indices
            .clone()
            .map(|i| (i as f64 - middle) * x(i))
            .sum::<f64>()
            / indices
                .clone()
                .map(|i| (i as f64 - middle).powi(2))
                .sum::<f64>();
        square += indices
            .map(|i| (x(i) - mean - slope * (i as f64 - middle)).powi(2))
            .sum::<f64>()
            / n;
    }
    (2.0 * square).sqrt()
}

/// A mean with its standard error.
fn mean(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
    (mean, (square / (n * (n - 1.0).max(1.0))).sqrt())
}

/// A ratio of sums over falls, Σa/Σb, with its standard error by the scatter between falls: half periods of
/// one fall are not independent.
fn ratio(pairs: &[(f64, f64)]) -> (f64, f64) {
    let whole: f64 = pairs.iter().map(|(_, b)| b).sum();
    let value = pairs.iter().map(|(a, _)| a).sum::<f64>() / whole;
    let square = pairs.iter().map(|(a, b)| (a - value * b).powi(2));
    (value, square.sum::<f64>().sqrt() / whole)
}

/// C = √2 σ with the standard error of σ, σ √((κ − 1)/4n) with the kurtosis κ.
fn width(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let (mean, _) = mean(values);
    let moment = |power| values.iter().map(|v| (v - mean).powi(power)).sum::<f64>() / n;
    let deviation = moment(2).sqrt();
    let kurtosis = moment(4) / moment(2).powi(2);
    let width = 2f64.sqrt() * deviation;
    (width, width * ((kurtosis - 1.0) / (4.0 * n)).sqrt())
}

/// The median with its standard error, half of the distance of the order statistics √n/2 to either side.
fn median(mut values: Vec<f64>) -> (f64, f64) {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    let aside = (0.5 * (n as f64).sqrt()).ceil() as usize;
    let at = |i: usize| values[i.min(n - 1)];
    let error = 0.5 * (at(n / 2 + aside) - at((n / 2).saturating_sub(aside)));
    (values[n / 2], error)
}

/// The I* below which falls circle that oscillate: what separates spirals from flutters with the fewest on
/// the wrong side, and how many are.
fn border(falls: &[(f64, bool)]) -> (f64, usize) {
    let mut sorted = falls.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let flutters = sorted.iter().filter(|(_, spiral)| !spiral).count();
    let spirals = sorted.len() - flutters;
    // With the border below all of them every spiral is on the wrong side.
    let (mut wrong, mut best) = (spirals, (sorted[0].0, spirals));
    for pair in sorted.windows(2) {
        wrong = if pair[0].1 { wrong - 1 } else { wrong + 1 };
        if wrong < best.1 {
            best = ((pair[0].0 * pair[1].0).sqrt(), wrong);
        }
    }
    best
}

/// The estimates from these own falls.
pub fn own(falls: &[Fall]) -> Vec<Estimate> {
    let mut rows = Vec::new();
    let mut add =
        |quantity: &str, states: [Option<Regime>; 3], (value, error): (f64, f64), count| {
            rows.push(Estimate {
                quantity: quantity.into(),
                source: EstimateSource::Own,
                main: states[0],
                from: states[1],
                to: states[2],
                value,
                error,
                count: count as u64,
            });
        };
    let n = falls.len() as f64;
    for main in Regime::ALL {
        let these: Vec<&Fall> = falls.iter().filter(|fall| fall.main == main).collect();
        let share = these.len() as f64 / n;
        let error = (share * (1.0 - share) / n).sqrt();
        add(
            "falls",
            [Some(main), None, None],
            (share, error),
            these.len(),
        );
        if these.len() < 2 {
            continue;
        }
        for first in Regime::ALL {
            let hits = these
                .iter()
                .filter(|fall| fall.labels.first() == Some(&first));
            let hits = hits.count();
            let share = hits as f64 / these.len() as f64;
            let error = (share * (1.0 - share) / these.len() as f64).sqrt();
            if hits > 0 {
                add(
                    "start",
                    [Some(main), None, Some(first)],
                    (share, error),
                    hits,
                );
            }
        }
        for from in Regime::ALL {
            for to in Regime::ALL {
                let counts = these.iter().map(|fall| {
                    let pairs = || fall.labels.windows(2).filter(|pair| pair[0] == from);
                    let there = pairs().filter(|pair| pair[1] == to).count();
                    (there as f64, pairs().count() as f64)
                });
                let counts: Vec<(f64, f64)> = counts.collect();
                let hits: f64 = counts.iter().map(|(there, _)| there).sum();
                if hits > 0.0 {
                    let states = [Some(main), Some(from), Some(to)];
                    add("transition", states, ratio(&counts), hits as usize);
                }
            }
        }
        let of = |value: fn(&Fall) -> f64| -> Vec<f64> { these.iter().map(|f| value(f)).collect() };
        let (whole, count) = ([Some(main), None, None], these.len());
        add("deviation_mean", whole, mean(&of(|f| f.deviation)), count);
        add("deviation_width", whole, width(&of(|f| f.deviation)), count);
        add("frequency", whole, median(of(|f| f.frequency)), count);
        add("swing", whole, median(of(|f| f.swing)), count);
    }
    let oscillating = falls.iter().filter_map(|fall| match fall.main {
        Regime::PeriodicFlutter => Some((fall.i_star, false)),
        Regime::PeriodicSpiral => Some((fall.i_star, true)),
        _ => None,
    });
    let oscillating: Vec<(f64, bool)> = oscillating.collect();
    if oscillating.len() > 1 {
        // Ten disjoint tenths, each of which has √10 times the error of the whole.
        let tenths = (0..10).map(|part| {
            let part: Vec<_> = oscillating.iter().skip(part).step_by(10).copied().collect();
            border(&part).0
        });
        let tenths: Vec<f64> = match oscillating.len() >= 100 {
            true => tenths.collect(),
            false => vec![border(&oscillating).0; 2],
        };
        let (value, wrong) = border(&oscillating);
        let none = [None; 3];
        add(
            "spiral_below",
            none,
            (value, mean(&tenths).1),
            oscillating.len(),
        );
        let share = wrong as f64 / oscillating.len() as f64;
        let error = (share * (1.0 - share) / oscillating.len() as f64).sqrt();
        add("spiral_wrong_side", none, (share, error), wrong);
    }
    let changes: Vec<(f64, f64)> = falls
        .iter()
        .map(|fall| {
            let pairs = || fall.labels.windows(2);
            let back = pairs().filter(|pair| pair[1] < pair[0]).count();
            (
                back as f64,
                pairs().filter(|pair| pair[1] != pair[0]).count() as f64,
            )
        })
        .collect();
    let count: f64 = changes.iter().map(|(_, all)| all).sum();
    if count > 0.0 {
        add("backward_share", [None; 3], ratio(&changes), count as usize);
    }
    rows
}

/// A row of the table of tracked falls.
struct Track {
    fall: String,
    class: Option<Regime>,
    deviation: f64,
}

fn tracks(text: &str) -> Result<Vec<Track>, String> {
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let column = |name: &str| {
        let found = header.iter().position(|column| *column == name);
        found.ok_or_else(|| format!("the table of tracked falls has no column {name}"))
    };
    let [shape, fall, class] = [column("shape")?, column("fall")?, column("class_human")?];
    let [drift, descent] = [column("drift_mps")?, column("descent_mps")?];
    lines
        .map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            let number = |column: usize| {
                let field = fields.get(column).ok_or("a short row")?;
                field
                    .parse::<f64>()
                    .map_err(|_| format!("{field} is no number"))
            };
            Ok(Track {
                fall: format!("{} {}", fields[shape], fields[fall]),
                class: match fields[class] {
                    "tumbling" => Some(Regime::PeriodicTumbling),
                    "chaotic" => Some(Regime::TransitionalChaotic),
                    _ => None,
                },
                deviation: number(drift)? / number(descent)?,
            })
        })
        .collect()
}

/// The classes of each tracked fall in their order, without the beginnings, which are no terminal motion.
pub fn tracked_sequences(text: &str) -> Result<Vec<Vec<Regime>>, String> {
    let tracks = tracks(text)?;
    let falls = tracks.chunk_by(|a, b| a.fall == b.fall);
    let sequences = falls.map(|fall| fall.iter().filter_map(|track| track.class).collect());
    Ok(sequences
        .filter(|sequence: &Vec<_>| !sequence.is_empty())
        .collect())
}

/// The estimates from tracked falls of paper: B and C of whole segments, and how often a fall that begins
/// `steady_or_periodic` goes on as either.
pub fn tracked(text: &str) -> Result<Vec<Estimate>, String> {
    let tracks = tracks(text)?;
    let mut rows = Vec::new();
    let mut add = |quantity: &str, main, (value, error): (f64, f64), count: usize| {
        rows.push(Estimate {
            quantity: quantity.into(),
            source: EstimateSource::Tracks,
            main: Some(main),
            from: None,
            to: None,
            value,
            error,
            count: count as u64,
        });
    };
    for regime in [Regime::TransitionalChaotic, Regime::PeriodicTumbling] {
        let these = tracks.iter().filter(|track| track.class == Some(regime));
        let values: Vec<f64> = these.map(|track| track.deviation).collect();
        add("deviation_mean", regime, mean(&values), values.len());
        add("deviation_width", regime, width(&values), values.len());
        let pairs = tracks
            .windows(2)
            .filter(|pair| pair[0].fall == pair[1].fall);
        let (mut hits, mut all) = (0, 0);
        for pair in pairs {
            all += 1;
            hits += usize::from(pair[0].class.is_none() && pair[1].class == Some(regime));
        }
        let share = hits as f64 / all as f64;
        let error = (share * (1.0 - share) / all as f64).sqrt();
        add("after_beginning", regime, (share, error), hits);
    }
    Ok(rows)
}

/// Falls number `first` to `last`, on all cores.
///
/// # Errors
/// Those of an experiment, which these discs do not give.
pub fn falls(first: u64, last: u64, done: impl Fn() + Sync) -> Result<Vec<Fall>, Error> {
    let indices = (first..last).into_par_iter();
    indices
        .map(|index| fall(index).inspect(|_| done()))
        .collect()
}

/// The file that ships.
pub fn table(count: u64, tracked_falls: &str, done: impl Fn() + Sync) -> Result<String, String> {
    let falls = falls(0, count, done).map_err(|error| error.to_string())?;
    let mut rows = own(&falls);
    rows.extend(tracked(tracked_falls)?);
    let [re, i] = [REYNOLDS, I_STAR];
    let mut text = format!(
        "\
# Written by: cargo run --release --features bake --example synthesis -- --estimate src/motion/estimates.csv
# own: {count} falls of thin discs from rest, by 130 diameters, under the default law. Re of the broadside disc
# {}..{}, I* {}..{} and tilt 0..90 degrees: points 1 to {count} of the R3 sequence; the seed of the small
# deviations of a release is the number of its fall. main: the regime of the last three fifths of a fall; from, to:
# of one half period pi d/U0 and the next, each seen in a window of {WINDOW} of them (Classifier::default).
# tracks: tests/data/paper/falls.csv, class_human (Howison et al. 2020; papers from 1 m).
# falls: how many; start, transition: probabilities, their counts; error: standard error, by the scatter between falls.
# deviation_mean, deviation_width: B and C of (3.9). frequency: angular, of swings (turns when tumbling), in U0/d;
# swing: amplitude of the horizontal velocity, in U0; both medians. spiral_below: I* between flutter and spiral, and
# spiral_wrong_side the share of both beyond it. backward_share: of the changes, those to an earlier regime.
# after_beginning: of the papers that are dropped flat, how many are seen in which class after the beginning.
{}
",
        re[0],
        re[1],
        i[0],
        i[1],
        FallEstimates::HEADER
    );
    for row in rows {
        let name = |regime: Option<Regime>| regime.map_or("", Regime::abbreviation);
        let source = match row.source {
            EstimateSource::Own => "own",
            EstimateSource::Tracks => "tracks",
        };
        let states = [row.main, row.from, row.to].map(name).join(",");
        text += &format!(
            "{},{source},{states},{:.4e},{:.1e},{}\n",
            row.quantity, row.value, row.error, row.count
        );
    }
    Ok(text)
}
