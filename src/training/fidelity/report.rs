//! Measured and computed side by side.

use super::discs::DiscFall;
use super::gliders::{Glider, GliderFall};
use super::papers::{PaperDrop, PaperFall, TumblingShare};
use super::plates::{Plate, PlateFall};
use super::polars::{Polar, StaticPlate};
use crate::motion::Regime;

/// The map's four classes, in the order of [`DiscMap::counts`].
const CLASSES: [Regime; 4] = [
    Regime::SteadyDescent,
    Regime::PeriodicFlutter,
    Regime::TransitionalChaotic,
    Regime::PeriodicTumbling,
];

/// How the bodies of a [`Fidelity`](super::Fidelity) fell.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Plates in water.
    pub plates: Vec<PlateResult>,
    /// The map of discs.
    pub discs: DiscMap,
    /// Papers in air.
    pub papers: Vec<PaperResult>,
    /// Shares of tumbling of paper circles.
    pub shares: Vec<ShareResult>,
    /// Plates and discs in a steady stream.
    pub polars: Vec<PolarResult>,
    /// Weighted cards that glide.
    pub gliders: Vec<GliderResult>,
}

/// One plate.
#[derive(Clone, Debug)]
pub struct PlateResult {
    /// What was measured.
    pub plate: Plate,
    /// The fall from each release angle.
    pub falls: Vec<PlateFall>,
}

/// All discs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DiscMap {
    /// The falls: all releases of the first disc, then all of the second, and so on.
    pub falls: Vec<DiscFall>,
}

/// One set of paper drops.
#[derive(Clone, Debug)]
pub struct PaperResult {
    /// What was measured.
    pub drop: PaperDrop,
    /// Every drop that reached the floor.
    pub falls: Vec<PaperFall>,
}

/// The share of tumbling of one size of paper circles.
#[derive(Clone, Debug)]
pub struct ShareResult {
    /// What was measured.
    pub measured: TumblingShare,
    /// What it did in each drop that reached the floor.
    pub falls: Vec<PaperFall>,
}

/// One plate in a steady stream.
#[derive(Clone, Debug)]
pub struct PolarResult {
    /// What is known of it.
    pub plate: StaticPlate,
    /// Its forces under the law.
    pub polar: Polar,
}

/// One weighted card.
#[derive(Clone, Debug)]
pub struct GliderResult {
    /// The card.
    pub glider: Glider,
    /// Its flights.
    pub falls: Vec<GliderFall>,
}

fn mean<T>(falls: &[T], quantity: impl Fn(&T) -> f64) -> f64 {
    falls.iter().map(quantity).sum::<f64>() / falls.len() as f64
}

impl PlateResult {
    /// Mean over the falls.
    pub fn mean(&self, quantity: impl Fn(&PlateFall) -> f64) -> f64 {
        mean(&self.falls, quantity)
    }

    /// How the plate falls, all releases together: tumbling from four fifths of flips on, flutter up to
    /// three twentieths, chaotic between.
    pub fn regime(&self) -> Regime {
        match self.mean(|fall| fall.tumbling) {
            share if share >= 0.8 => Regime::PeriodicTumbling,
            share if share <= 0.15 => Regime::PeriodicFlutter,
            _ => Regime::TransitionalChaotic,
        }
    }
}

impl PaperResult {
    /// Mean over the falls; NaN if none reached the floor.
    pub fn mean(&self, quantity: impl Fn(&PaperFall) -> f64) -> f64 {
        mean(&self.falls, quantity)
    }
}

impl ShareResult {
    /// Share of the drops that tumbled; NaN if none reached the floor.
    pub fn share(&self) -> f64 {
        mean(&self.falls, |fall| f64::from(u8::from(fall.tumbles)))
    }
}

impl GliderResult {
    /// The mean glide ratio of its flights; those that turned over count as 0.
    pub fn mean(&self) -> f64 {
        mean(&self.falls, GliderFall::glide)
    }

    /// The least glide ratio of its flights.
    pub fn least(&self) -> f64 {
        let glides = self.falls.iter().map(GliderFall::glide);
        glides.fold(f64::INFINITY, f64::min)
    }
}

impl Report {
    /// The I* at which half of the paper circles tumble, on straight lines between the sizes; `None` if
    /// the share does not cross ½ between the smallest and the largest.
    pub fn tumbling_crossing(&self) -> Option<f64> {
        let mut sizes: Vec<(f64, f64)> = self
            .shares
            .iter()
            .map(|result| (result.measured.i_star, result.share()))
            .collect();
        sizes.sort_by(|a, b| a.0.total_cmp(&b.0));
        sizes.windows(2).find_map(|pair| {
            let ((i0, s0), (i1, s1)) = (pair[0], pair[1]);
            (s0 < 0.5 && s1 >= 0.5).then(|| i0 + (i1 - i0) * (0.5 - s0) / (s1 - s0))
        })
    }
}

impl DiscMap {
    /// Falls by what the measured map expects (rows) and what they were (columns): steady, periodic,
    /// chaotic, tumbling.
    pub fn counts(&self) -> [[usize; 4]; 4] {
        let class = |regime| CLASSES.iter().position(|c| *c == regime);
        let mut counts = [[0; 4]; 4];
        for fall in &self.falls {
            if let (Some(expected), Some(seen)) = (class(fall.expected), class(fall.regime)) {
                counts[expected][seen] += 1;
            }
        }
        counts
    }

    /// Share of the falls that agree with the measured map.
    pub fn agreement(&self) -> f64 {
        mean(&self.falls, |fall| {
            f64::from(u8::from(fall.regime == fall.expected))
        })
    }

    /// The agreement by class: steady, periodic, chaotic, tumbling; NaN where nothing was expected.
    pub fn agreement_by_class(&self) -> [f64; 4] {
        let counts = self.counts();
        std::array::from_fn(|class| {
            let all: usize = counts[class].iter().sum();
            counts[class][class] as f64 / all as f64
        })
    }

    /// Share of the disagreeing falls within this factor of where the map would agree; 1 if all agree.
    pub fn near_misses(&self, margin: f64) -> f64 {
        let misses = self
            .falls
            .iter()
            .filter(|fall| fall.regime != fall.expected);
        let (near, all) = misses.fold((0, 0), |(near, all), fall| {
            (near + u32::from(fall.off_by <= margin), all + 1)
        });
        if all == 0 {
            1.0
        } else {
            f64::from(near) / f64::from(all)
        }
    }
}
