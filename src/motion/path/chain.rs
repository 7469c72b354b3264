//! The Markov chain over the six regimes (thesis § 3.4).

use crate::error::Error;
use crate::motion::{FallEstimates, MotionGraph, Regime};

impl MotionGraph {
    /// The graph of thesis Fig. 3.10 over the six [regimes](Regime::ALL), L₁ = SD … L₆ = PS, of falls with
    /// this main regime: block upper triangular (3.13), so that sequences strictly increase once repeats are
    /// merged.
    ///
    /// The thesis prints the form of P and how to count it, but no numbers. These are p_ij = N_ij/N_i, counted
    /// half period by half period in 12 000 falls of discs under this crate's default law
    /// ([`FallEstimates`]); given that a fall does not go back. A quarter of the changes in those falls do,
    /// against the thesis's hypothesis: [`FallEstimates::transitions`] has them too, for a graph with them by
    /// [`MotionGraph::new`]. A regime that is never left for a later one is absorbing.
    ///
    /// A convention: the helix, which was the main regime of four falls only, takes the graph of the spiral
    /// with the two in each other's place.
    ///
    /// ```
    /// use rapier3d_immersed::motion::{MotionGraph, Regime};
    ///
    /// let graph = MotionGraph::free_fall(Regime::PeriodicTumbling);
    /// let [chaos, tumbling] = [Regime::TransitionalChaotic, Regime::PeriodicTumbling].map(|r| r as usize);
    /// // What tumbles in the end leaves chaos within a few half periods, and nothing leads back.
    /// assert!(graph.probability(chaos, tumbling) > 0.1);
    /// assert_eq!(graph.probability(tumbling, chaos), 0.0);
    /// ```
    pub fn free_fall(main: Regime) -> Self {
        let (helix, spiral) = (Regime::TransitionalHelix, Regime::PeriodicSpiral);
        let (shown, swapped) = match main == helix {
            true => (spiral, true),
            false => (main, false),
        };
        let place = |state: usize| match Regime::ALL[state] {
            regime if swapped && regime == helix => spiral as usize,
            regime if swapped && regime == spiral => helix as usize,
            _ => state,
        };
        let estimates = FallEstimates::shipped();
        let (starts, counts) = (estimates.starts(shown), estimates.transitions(shown));
        let states = Regime::ALL.len();
        let row = |from: usize| -> Vec<f64> {
            let ahead = |to: usize| match to >= from {
                true => counts[place(from)][place(to)] as f64,
                false => 0.0,
            };
            let sum: f64 = (0..states).map(ahead).sum();
            let share = |to: usize| match sum > 0.0 {
                true => ahead(to) / sum,
                false => f64::from(u8::from(to == from)),
            };
            (0..states).map(share).collect()
        };
        let falls: u64 = starts.iter().sum();
        let start = (0..states).map(|state| starts[place(state)] as f64 / falls as f64);
        Self::new(start.collect(), (0..states).map(row).collect())
            .expect("shares of the shipped counts sum to one")
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

    /// Nothing leads back, neither within the plane patterns nor from the spatial ones (3.13); and what follows
    /// is counted: chaos that will be tumbling by hand from the rows of the shipped file.
    #[test]
    fn the_graph_is_block_triangular_and_counted() {
        for main in Regime::ALL {
            let graph = MotionGraph::free_fall(main);
            assert_eq!(graph.check(), Ok(()));
            assert!(graph.is_unidirectional(), "{main}");
            assert!(graph.is_reachable(main as usize), "{main}");
            let planar = Regime::PeriodicTumbling as usize;
            for spatial in planar + 1..6 {
                assert!((0..=planar).all(|to| graph.probability(spatial, to) == 0.0));
            }
        }
        let text = include_str!("../estimates.csv");
        let count = |row: &str| -> f64 {
            let mut lines = text.lines();
            let line = lines.find(|line| line.starts_with(row)).unwrap();
            line.rsplit(',').next().unwrap().parse().unwrap()
        };
        let [stay, leave] =
            ["TC,TC", "TC,PT"].map(|pair| count(&format!("transition,own,PT,{pair}")));
        let graph = MotionGraph::free_fall(Regime::PeriodicTumbling);
        // A few go on to a spiral for a while.
        assert!((graph.probability(2, 3) / (leave / (stay + leave)) - 1.0).abs() < 0.01);
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
        // Everything further on can follow.
        let ahead = |from: usize, to: usize| {
            if to >= from {
                1.0 / (6 - from) as f64
            } else {
                0.0
            }
        };
        let row = |from: usize| (0..6).map(|to| ahead(from, to)).collect();
        let graph = MotionGraph::new(row(0), (0..6).map(row).collect()).unwrap();
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
