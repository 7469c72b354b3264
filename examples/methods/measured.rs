//! Measured falls of paper circles that were let go edge down.

use crate::Failure;
use crate::means::Means;
use rapier3d_immersed::motion::{MotionGraph, Pattern, Regime};

/// All segments of all measured falls; its neighbour README.md says what the columns are.
const MEASURED: &str = include_str!("../../tests/data/paper/falls.csv");
/// Radii that are taken together, m: the class of `repeats.csv` around 24 mm.
const RADII: [f64; 2] = [0.021, 0.0271];

/// A part of a fall in one regime, as seen by eye.
struct Segment {
    /// Number of the fall; its segments follow each other.
    fall: String,
    regime: Regime,
    seconds: f64,
    descent: f64,
    drift: f64,
}

fn segments() -> Result<Vec<Segment>, Failure> {
    let mut lines = MEASURED.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let mut segments = Vec::new();
    for line in lines {
        let row: Vec<&str> = line.split(',').collect();
        let field = |name: &str| {
            let at = header.iter().position(|column| *column == name);
            let field = at.and_then(|at| row.get(at)).copied();
            field.ok_or_else(|| format!("falls.csv, {line}: no {name}"))
        };
        let number = |name: &str| -> Result<f64, Failure> { Ok(field(name)?.parse()?) };
        let radius = number("radius_m")?;
        let taken = (field("shape")?, field("release")?) == ("circle", "edge");
        if !taken || !(RADII[0]..=RADII[1]).contains(&radius) {
            continue;
        }
        segments.push(Segment {
            fall: field("fall")?.into(),
            regime: match field("class_human")? {
                "tumbling" => Regime::PeriodicTumbling,
                "chaotic" => Regime::TransitionalChaotic,
                other => return Err(format!("falls.csv: an edge-down circle is {other}").into()),
            },
            seconds: number("time_s")?,
            descent: number("descent_mps")?,
            drift: number("drift_mps")?,
        });
    }
    Ok(segments)
}

/// Means over the segments, weighted by their time.
pub fn means() -> Result<Means, Failure> {
    let segments = segments()?;
    let time: f64 = segments.iter().map(|s| s.seconds).sum();
    let mut means = Means {
        falls: segments.len(),
        ..Means::default()
    };
    for segment in segments {
        let share = segment.seconds / time;
        means.descent += share * segment.descent;
        means.drift += share * segment.drift;
        means.shares[segment.regime as usize] += share;
    }
    Ok(means)
}

/// The transitions that were seen, as the thesis counts its own: over the six regimes, and over the four patterns.
pub fn graphs() -> Result<[MotionGraph; 2], Failure> {
    let segments = segments()?;
    let falls = segments.chunk_by(|a, b| a.fall == b.fall);
    let falls: Vec<Vec<Regime>> = falls
        .map(|fall| fall.iter().map(|s| s.regime).collect())
        .collect();
    let states = |of: fn(Regime) -> usize| -> Vec<Vec<usize>> {
        let falls = falls.iter();
        falls
            .map(|fall| fall.iter().map(|r| of(*r)).collect())
            .collect()
    };
    Ok([
        MotionGraph::estimate(&states(|regime| regime as usize), 6)?,
        MotionGraph::estimate(&states(|regime| Pattern::from(regime).index()), 4)?,
    ])
}
