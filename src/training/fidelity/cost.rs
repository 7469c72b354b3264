//! What a search for coefficients minimises.

use super::report::{
    DiscMap, GliderResult, PaperResult, PlateResult, PolarResult, Report, ShareResult,
};
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
    /// Static polars (bars: slope 10 %, greatest lift 15 % and its angle 5°, center of pressure .04 chord,
    /// thrust along a stalled plate 5 % of the normal force).
    pub polars: f64,
    /// Glide ratios (3 at least for the best card).
    pub gliders: f64,
}

impl Cost {
    /// The sum of all kinds, by weights that were chosen so that none could be had at the others' expense: what
    /// few bodies show (plates, gliders) counts more, what rests on assumptions about the release (papers)
    /// less.
    pub fn total(&self) -> f64 {
        2.0 * self.plates
            + 1.5 * self.discs
            + 0.6 * self.papers
            + self.shares
            + 2.0 * self.polars
            + 3.0 * self.gliders
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
            polars: self.polars.iter().map(polar).sum(),
            gliders: gliders(&self.gliders),
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
    // Each fall by itself: two that err to opposite sides are not right.
    let falls = result.mean(|fall| {
        let known = [
            (result.plate.drift, fall.drift),
            (result.plate.descent, fall.descent),
            (result.plate.spin, fall.spin),
        ];
        let known = known.iter().filter_map(|(measured, ours)| {
            let measured = (*measured)?;
            Some(beyond_bar(error(*ours, measured, 0.1)))
        });
        // A plate that dives edge on is not chaotic, however its turns look.
        let dives = match result.plate.descent {
            None => ((fall.descent - 0.16).max(0.0) / 0.2).min(1.0),
            Some(_) => 0.0,
        };
        known.sum::<f64>() + dives
    });
    regime + falls
}

/// The cost of an error in units of its bar.
fn beyond_bar(error: f64) -> f64 {
    0.04 * error + 0.25 * (error - 0.7).max(0.0)
}

fn polar(result: &PolarResult) -> f64 {
    let (plate, polar) = (&result.plate, &result.polar);
    let (angle, lift) = polar.stall();
    let max_lift = plate.max_lift.map_or(0.0, |known| error(lift, known, 0.15));
    let stall = plate.stall.map_or(0.0, |[low, high]| {
        ((low - angle).max(angle - high).max(0.0) / 5.0).min(5.0)
    });
    let pressure = plate.pressure_point.map_or(0.0, |known| {
        ((polar.pressure_point() - known).abs() / 0.04).min(5.0)
    });
    let edgewise = plate
        .edgewise_drag
        .map_or(0.0, |known| error(polar.points[0].drag, known, 0.5));
    // Plates this wide have stalled by 30°.
    let separated = if plate.aspect > 5.0 {
        error(polar.stalled_normal(), 1.0, 0.25)
    } else {
        0.0
    };
    let order = if polar.pressure_goes_back() { 0.0 } else { 0.2 };
    let errors = [
        error(polar.lift_slope(), plate.lift_slope, 0.1),
        max_lift,
        stall,
        pressure,
        edgewise,
        separated,
        (polar.stalled_thrust().max(0.0) / 0.05).min(5.0),
    ];
    errors.map(beyond_bar).iter().sum::<f64>() + order
}

/// The best card counts; its flights by themselves, since a glide that some releases end is none.
fn gliders(results: &[GliderResult]) -> f64 {
    let lacking = |result: &GliderResult| {
        let flights = result.falls.iter();
        let lack = flights.map(|fall| ((3.0 - fall.glide()) / 3.0).max(0.0));
        lack.sum::<f64>() / result.falls.len() as f64
    };
    results.iter().map(lacking).reduce(f64::min).unwrap_or(0.0)
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
    let beyond = 2.0 * (descent - 0.8).max(0.0) + (drift - 0.8).max(0.0);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::training::fidelity::{
        Glider, GliderFall, Plate, PlateFall, Polar, PolarPoint, StaticPlate,
    };

    /// A glide of 3 costs nothing, half of it a half, turning over 1; the best card counts.
    #[test]
    fn glides_by_themselves() {
        let card = |flights: [(f64, bool); 2]| GliderResult {
            glider: Glider::new(0.2).unwrap(),
            falls: flights
                .map(|(ratio, upright)| GliderFall { ratio, upright })
                .to_vec(),
        };
        assert_eq!(gliders(&[]), 0.0);
        assert_eq!(gliders(&[card([(3.0, true), (7.0, true)])]), 0.0);
        assert_eq!(gliders(&[card([(1.5, true), (4.0, true)])]), 0.25);
        assert_eq!(gliders(&[card([(4.0, true), (4.0, false)])]), 0.5);
        assert_eq!(gliders(&[card([(f64::NAN, true), (f64::NAN, true)])]), 1.0);
        let (good, bad) = (card([(2.4, true), (2.4, true)]), card([(0.0, true); 2]));
        assert!((gliders(&[bad, good]) - 0.2).abs() < 1e-12);
    }

    /// Two falls that err to opposite sides are as bad as two that err to the same, and a chaotic plate that dives is
    /// charged for it.
    #[test]
    fn falls_by_themselves() {
        let of = |index: usize, falls: &[(f64, f64)]| {
            let plate = Plate::targets().unwrap()[index].clone();
            let falls = falls.iter().map(|(descent, tumbling)| PlateFall {
                tumbling: *tumbling,
                drift: 0.0,
                descent: *descent,
                spin: 0.0,
            });
            super::plate(&PlateResult {
                falls: falls.collect(),
                plate,
            })
        };
        // The plate 1/14 flutters and descends at 9 cm/s.
        assert!(of(4, &[(0.09, 0.0), (0.09, 0.0)]) < 1e-9);
        let opposite = of(4, &[(0.072, 0.0), (0.108, 0.0)]);
        // Twice the bar: 0.04 · 2 + 0.25 · 1.3.
        assert!((opposite - 0.405).abs() < 1e-9, "{opposite}");
        assert!((of(4, &[(0.108, 0.0)]) - opposite).abs() < 1e-9);
        // The plate 1/10 is chaotic: half of its turns flips.
        assert_eq!(of(2, &[(0.1, 0.5)]), 0.0);
        assert!((of(2, &[(0.26, 0.5)]) - 0.5).abs() < 1e-9);
    }

    /// A wing's polar costs next to nothing; with twice the lift, a thrust along the plate, or the pressure in the middle
    /// it costs a multiple.
    #[test]
    fn wings_cost_nothing() {
        let six = || StaticPlate::published().unwrap().swap_remove(2);
        let cost = |lifts: f64, along: f64, forward: f64| {
            let point = |degree: u32| {
                let angle = f64::from(degree).to_radians();
                let (sine, cosine) = angle.sin_cos();
                let stalled = 1.3 * 0.505 / (0.222 + 0.283 / sine.max(1e-9));
                let attached = 4.53 * sine;
                let normal = lifts * if degree <= 11 { attached } else { stalled };
                let thrust = if degree > 11 { along * normal } else { 0.0 };
                PolarPoint {
                    lift: normal * cosine + thrust * sine,
                    drag: normal * sine - thrust * cosine,
                    pressure_point: 0.5 - forward * cosine,
                }
            };
            let points = (0..=90).map(point).collect();
            super::polar(&PolarResult {
                plate: six(),
                polar: Polar { points },
            })
        };
        let good = cost(1.0, 0.0, 0.26);
        assert!(good < 0.15, "{good}");
        assert!(cost(2.0, 0.0, 0.26) > good + 1.0);
        assert!(cost(1.0, 0.2, 0.26) > good + 0.5);
        assert!(cost(1.0, -0.2, 0.26) < good + 0.1);
        assert!(cost(1.0, 0.0, 0.0) > good + 0.5);
        assert!(cost(1.0, 0.0, -0.26) > good + 1.0);
    }
}
