//! The Markov chain over the six regimes (thesis § 3.4).

use crate::error::Error;
use crate::motion::{MotionGraph, Regime};

/// Probability that a fall goes on in its regime at a turning point, by default.
const STAY: f64 = 0.75;

impl MotionGraph {
    /// The graph of thesis Fig. 3.10 over the six [regimes](Regime::ALL), L₁ = SD … L₆ = PS: block upper
    /// triangular (3.13), so that sequences strictly increase once repeats are merged.
    ///
    /// The thesis prints the form of P and how to count it, but no numbers. These are ours: a fall stays
    /// in its regime for four segments on average (probability ¾); each regime further on is half as
    /// likely as the one before it; any start is as likely as any other ("starts from a random
    /// motion pattern"). [`MotionGraph::estimate`] counts a graph from labelled falls.
    ///
    /// ```
    /// use rapier3d_immersed::motion::{MotionGraph, Regime};
    ///
    /// let graph = MotionGraph::free_fall();
    /// let [flutter, tumbling] = [Regime::PeriodicFlutter, Regime::PeriodicTumbling].map(|r| r as usize);
    /// assert_eq!(graph.probability(flutter, flutter), 0.75);
    /// // Nothing leads back.
    /// assert!(graph.probability(flutter, tumbling) > 0.0);
    /// assert_eq!(graph.probability(tumbling, flutter), 0.0);
    /// ```
    pub fn free_fall() -> Self {
        let states = Regime::ALL.len();
        let row = |from: usize| -> Vec<f64> {
            let ahead = |to: usize| 0.5f64.powi((to - from) as i32);
            let sum: f64 = (from + 1..states).map(ahead).sum();
            let leave = |to: usize| (1.0 - STAY) * ahead(to) / sum;
            (0..states)
                .map(|to| match to.cmp(&from) {
                    std::cmp::Ordering::Less => 0.0,
                    std::cmp::Ordering::Equal if sum == 0.0 => 1.0,
                    std::cmp::Ordering::Equal => STAY,
                    std::cmp::Ordering::Greater => leave(to),
                })
                .collect()
        };
        let start = vec![1.0 / states as f64; states];
        Self::new(start, (0..states).map(row).collect()).expect("rows sum to one by construction")
    }
}

/// Motion classes up to a main regime: every set of regimes up to it, in order. There are Σ C(k, i) =
/// 2^k − 1 of them (3.11) if it is the k-th. [`Synthesizer::path_through`](super::Synthesizer::path_through)
/// makes a fall of one.
///
/// ```
/// use rapier3d_immersed::motion::Regime;
/// use rapier3d_immersed::motion::path::motion_classes;
///
/// let classes = motion_classes(Regime::PeriodicFlutter);
/// let (steady, flutter) = (Regime::SteadyDescent, Regime::PeriodicFlutter);
/// assert_eq!(classes, [vec![steady], vec![flutter], vec![steady, flutter]]);
/// ```
pub fn motion_classes(main: Regime) -> Vec<Vec<Regime>> {
    let level = main as u32 + 1;
    (1..1u32 << level)
        .map(|set| {
            let has = |regime: &Regime| set & (1 << *regime as u32) != 0;
            Regime::ALL.into_iter().filter(has).collect()
        })
        .collect()
}

/// The graph with tumbling and chaotic motion `share` times as likely to begin or go on.
pub(super) fn calmed(graph: &MotionGraph, share: f64) -> Result<MotionGraph, Error> {
    let states = graph.states();
    let calm = |p: f64, to: usize| match Regime::ALL[to] {
        Regime::TransitionalChaotic | Regime::PeriodicTumbling => p * share,
        _ => p,
    };
    let row = |of: &dyn Fn(usize) -> f64, fallback: usize| -> Vec<f64> {
        let row: Vec<f64> = (0..states).map(|to| calm(of(to), to)).collect();
        let sum: f64 = row.iter().sum();
        if sum > 0.0 {
            row.into_iter().map(|p| p / sum).collect()
        } else {
            (0..states)
                .map(|to| f64::from(u8::from(to == fallback)))
                .collect()
        }
    };
    let rows = (0..states).map(|from| row(&|to| graph.probability(from, to), from));
    MotionGraph::new(row(&|to| graph.start(to), 0), rows.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nothing leads back, neither within the plane patterns nor from the spatial ones (3.13).
    #[test]
    fn the_graph_is_block_triangular() {
        let graph = MotionGraph::free_fall();
        assert_eq!(graph.check(), Ok(()));
        assert!(graph.is_unidirectional());
        let planar = Regime::PeriodicTumbling as usize;
        for spatial in planar + 1..6 {
            assert!((0..=planar).all(|to| graph.probability(spatial, to) == 0.0));
        }
        assert!(graph.is_absorbing(5) && !graph.is_absorbing(4));
        assert!((graph.probability(0, 1) / graph.probability(0, 2) - 2.0).abs() < 1e-12);
    }

    /// (3.11) by summing binomials.
    #[test]
    fn class_counts() {
        for (index, main) in Regime::ALL.into_iter().enumerate() {
            let k = index as u64 + 1;
            let binomial = |i: u64| (0..i).fold(1, |c, j| c * (k - j) / (j + 1));
            let classes = motion_classes(main);
            assert_eq!(classes.len() as u64, (1..=k).map(binomial).sum::<u64>());
            assert!(classes.iter().all(|c| c.windows(2).all(|p| p[0] < p[1])));
        }
    }

    /// With a share s the odds of tumbling and of chaos against any other pattern are s times what they
    /// were, whatever came before; those among the others, and of the two against each other, stay.
    #[test]
    fn calming_multiplies_odds() {
        let graph = MotionGraph::free_fall();
        let share = 0.3;
        let calm = calmed(&graph, share).unwrap();
        assert_eq!(calm.check(), Ok(()));
        let wild = |state: usize| state == 2 || state == 3;
        let mut compared = 0;
        for from in 0..7 {
            let [before, after] = [&graph, &calm].map(|graph| {
                let row = |to| match from {
                    6 => graph.start(to),
                    _ => graph.probability(from, to),
                };
                std::array::from_fn::<f64, 6, _>(row)
            });
            for a in 0..6 {
                for b in 0..6 {
                    if before[a] == 0.0 || before[b] == 0.0 {
                        assert_eq!(before[a] == 0.0, after[a] == 0.0);
                        continue;
                    }
                    let factor = match (wild(a), wild(b)) {
                        (true, false) => share,
                        (false, true) => 1.0 / share,
                        _ => 1.0,
                    };
                    let odds = after[a] / after[b] / (before[a] / before[b]);
                    assert!((odds / factor - 1.0).abs() < 1e-12, "{from} {a} {b}");
                    compared += 1;
                }
            }
        }
        // All pairs of what can follow: 36, 25, 16, 9, 4 and 1, and 36 of the start.
        assert_eq!(compared, 127);
        // Where nothing else can follow, there is nothing to calm.
        let tumbling = MotionGraph::always(3, 6).unwrap();
        let still = calmed(&tumbling, 0.0).unwrap();
        assert_eq!(still.probability(3, 3), 1.0);
    }
}
