//! What a search for coefficients minimises.

use super::report::{DiscMap, PaperResult, PlateResult, Report, ShareResult};
use crate::motion::Regime;

/// How far a report is from the measurements, by kind. Each is 0 if everything is right; an error as large
/// as its bar costs a few hundredths, a larger one a multiple of the excess.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Cost {
    /// Regimes and mean motion of the plates (bar: 10 %).
    pub plates: f64,
    /// The disc map, its classes weighed alike (bars: 85 %, each class 70 %).
    pub discs: f64,
    /// Mean motion of the papers (bars: descent 10 %, drift 30 %).
    pub papers: f64,
    /// Shares of tumbling of paper circles.
    pub shares: f64,
}

impl Cost {
    /// The sum of all kinds.
    pub fn total(&self) -> f64 {
        self.plates + self.discs + self.papers + self.shares
    }
}

impl Report {
    /// How far this report is from the measurements.
    pub fn cost(&self) -> Cost {
        Cost {
            plates: self.plates.iter().map(plate).sum(),
            discs: discs(&self.discs),
            papers: self.papers.iter().map(paper).sum(),
            shares: self.shares.iter().map(share).sum(),
        }
    }
}

/// The error in units of its bar, not more than 5, so that one very bad case does not outweigh the rest.
fn error(ours: f64, measured: f64, bar: f64) -> f64 {
    let error = (ours / measured - 1.0).abs() / bar;
    if error.is_finite() {
        error.min(5.0)
    } else {
        5.0
    }
}

fn plate(result: &PlateResult) -> f64 {
    let tumbling = result.mean(|fall| fall.tumbling);
    let regime = match result.plate.regime {
        Regime::PeriodicTumbling => 4.0 * (1.0 - tumbling),
        // In chaos each fall is a mixture by itself, not only all of them together.
        Regime::TransitionalChaotic => result.mean(|fall| {
            let share = fall.tumbling;
            (0.3 - share).max(0.0) / 0.3 + (share - 0.7).max(0.0) / 0.3
        }),
        _ => 4.0 * tumbling,
    };
    let means = [
        (result.plate.drift, result.mean(|fall| fall.drift)),
        (result.plate.descent, result.mean(|fall| fall.descent)),
        (result.plate.spin, result.mean(|fall| fall.spin)),
    ];
    let means = means.iter().filter_map(|(measured, ours)| {
        let error = error(*ours, (*measured)?, 0.1);
        Some(0.04 * error + 0.25 * (error - 0.7).max(0.0))
    });
    regime + means.sum::<f64>()
}

fn discs(map: &DiscMap) -> f64 {
    if map.falls.is_empty() {
        return 0.0;
    }
    let counts = map.counts();
    let agreement = map.agreement_by_class();
    let classes: f64 = (0..4)
        .map(|class| {
            let all: usize = counts[class].iter().sum();
            if all == 0 {
                return 0.0;
            }
            (1.0 - agreement[class]) * 0.5 + 2.0 * (0.75 - agreement[class]).max(0.0)
        })
        .sum();
    // A disc that is wrong far from the boundary is worse than one beside it.
    let misses = map.falls.iter().filter(|fall| fall.regime != fall.expected);
    let far: f64 = misses.map(|fall| (fall.off_by / 0.4).min(1.5)).sum();
    classes + 3.0 * far / map.falls.len() as f64 + 3.0 * (0.88 - map.agreement()).max(0.0)
}

fn paper(result: &PaperResult) -> f64 {
    let descent = error(result.mean(|fall| fall.descent), result.drop.descent, 0.1);
    let drift = error(result.mean(|fall| fall.drift), result.drop.drift, 0.3);
    let beyond = (descent - 0.8).max(0.0) + (drift - 0.8).max(0.0);
    0.02 * (descent + drift) + 0.15 * beyond
}

fn share(result: &ShareResult) -> f64 {
    let error = result.share() - result.measured.share;
    if error.is_finite() {
        error * error
    } else {
        1.0
    }
}
