//! What falls do on average, to compare with what others do.

use crate::support::Vec3;
use rapier3d_immersed::motion::{Classifier, Regime, Trajectory};
use serde_json::{Value, json};

/// Depths below the release between which a fall counts, m: the release is 1.1 m high, and the published analysis ends
/// 5 cm above the floor.
const WINDOW: [f64; 2] = [0.40, 1.05];

/// What falls do on average.
#[derive(Clone, Debug, Default)]
pub struct Means {
    pub falls: usize,
    /// Vertical and horizontal distance of the ends over the time, m/s.
    pub descent: f64,
    pub drift: f64,
    /// Shares of the regimes, in the order of [`Regime::ALL`].
    pub shares: [f64; 6],
}

impl Means {
    pub fn json(&self) -> Value {
        let shares = Regime::ALL.iter().zip(self.shares);
        let shares = shares.map(|(regime, share)| (regime.abbreviation().into(), json!(share)));
        json!({
            "falls": self.falls,
            "descent": self.descent,
            "drift": self.drift,
            "regimes": Value::Object(shares.collect()),
        })
    }

    /// Relative errors of descent and drift, and the share of falls in another regime than the measured ones: half the
    /// sum of the differences.
    pub fn errors(&self, measured: &Self) -> [f64; 3] {
        let pairs = self.shares.iter().zip(measured.shares);
        [
            self.descent / measured.descent - 1.0,
            self.drift / measured.drift - 1.0,
            0.5 * pairs.map(|(a, b)| (a - b).abs()).sum::<f64>(),
        ]
    }

    /// The regimes that occur, the three most frequent first.
    pub fn regimes(&self) -> String {
        let mut all: Vec<_> = Regime::ALL.iter().zip(self.shares).collect();
        all.sort_by(|a, b| b.1.total_cmp(&a.1));
        let some = all.iter().filter(|(_, share)| *share > 0.0);
        let words = some
            .take(3)
            .map(|(regime, share)| format!("{} {:.0}", regime.abbreviation(), 100.0 * share));
        words.collect::<Vec<_>>().join(", ")
    }

    /// What falls do between the two depths; those that never come there do not count.
    pub fn of(falls: &[Trajectory]) -> Self {
        let mut means = Self::default();
        for fall in falls {
            let below = |depth: f64| fall.moments.iter().position(|m| m.position.y < -depth);
            let (Some(from), Some(to)) = (below(WINDOW[0]), below(WINDOW[1])) else {
                continue;
            };
            let moments = &fall.moments[from..=to];
            let time = fall.interval * (to - from).max(1) as f64;
            let way: Vec3 = moments[moments.len() - 1].position - moments[0].position;
            means.falls += 1;
            means.descent += -way.y / time;
            means.drift += way.x.hypot(way.z) / time;
            let regime = Classifier::default().observe(moments).regime;
            means.shares[regime as usize] += 1.0;
        }
        let count = means.falls.max(1) as f64;
        means.descent /= count;
        means.drift /= count;
        means.shares = means.shares.map(|share| share / count);
        means
    }
}
