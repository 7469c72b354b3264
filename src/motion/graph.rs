//! Which pattern follows which: a Markov chain (thesis § 5.5.2).

use crate::error::Error;
use crate::math;
use rand::{Rng, RngExt};

/// A motion graph over any number of states: a start distribution and the probabilities of going from
/// one state to another, or of staying, at each turn of the path.
///
/// ```
/// use rapier3d_immersed::motion::{MotionGraph, Pattern};
///
/// // Leaves that flutter half of the time before they tumble, and then tumble on.
/// let (zigzag, tumble) = (Pattern::Zigzag.index(), Pattern::Autorotation.index());
/// let films = [vec![zigzag, zigzag, tumble], vec![zigzag, tumble, tumble]];
/// let graph = MotionGraph::estimate(&films, 4)?;
/// assert_eq!(graph.start(zigzag), 1.0);
/// assert!((graph.probability(zigzag, tumble) - 2.0 / 3.0).abs() < 1e-12);
/// assert!(graph.is_absorbing(tumble));
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "Unchecked")
)]
pub struct MotionGraph {
    start: Vec<f64>,
    /// Probabilities of what follows, one row per state.
    transitions: Vec<Vec<f64>>,
}

/// A graph as it stands in a file.
#[cfg(feature = "serde-serialize")]
#[derive(serde::Deserialize)]
struct Unchecked {
    start: Vec<f64>,
    transitions: Vec<Vec<f64>>,
}

#[cfg(feature = "serde-serialize")]
impl TryFrom<Unchecked> for MotionGraph {
    type Error = Error;

    fn try_from(file: Unchecked) -> Result<Self, Error> {
        let graph = Self {
            start: file.start,
            transitions: file.transitions,
        };
        // Rows that are right already would change by rounding if they were normalised again.
        graph.check().map(|()| graph)
    }
}

/// How far a row's sum may be from 1: the thesis prints three digits.
const ROUNDING: f64 = 2e-3;

impl MotionGraph {
    /// A graph of a start distribution and a square matrix whose row i holds the probabilities of going
    /// on from state i.
    ///
    /// # Errors
    /// [`Error::WrongLength`] if the matrix is not square or does not fit `start`;
    /// [`Error::OutOfRange`] if an entry is not in [0, 1]; [`Error::InvalidParameter`] if `start` or a
    /// row does not sum to 1 within 0.002. Rows are then normalised.
    pub fn new(start: Vec<f64>, transitions: Vec<Vec<f64>>) -> Result<Self, Error> {
        let mut graph = Self { start, transitions };
        graph.check()?;
        let rows = std::iter::once(&mut graph.start).chain(&mut graph.transitions);
        for row in rows {
            let sum: f64 = row.iter().sum();
            row.iter_mut().for_each(|p| *p /= sum);
        }
        Ok(graph)
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        let states = self.start.len();
        Error::check_range("states of the motion graph", states as f64, 1.0, 1e3)?;
        Error::check_length(
            "rows of the transition matrix",
            states,
            self.transitions.len(),
        )?;
        let check_row = |parameter, row: &[f64]| {
            for p in row {
                Error::check_range(parameter, *p, 0.0, 1.0)?;
            }
            let sum = row.iter().sum::<f64>();
            Error::check(parameter, sum, (sum - 1.0).abs() <= ROUNDING, "of sum 1").map(|_| ())
        };
        check_row("start distribution", &self.start)?;
        for row in &self.transitions {
            Error::check_length("columns of the transition matrix", states, row.len())?;
            check_row("row of the transition matrix", row)?;
        }
        Ok(())
    }

    /// The graph of the thesis over SD, AR, AZ, ZZ ([`Pattern::ALL`](super::Pattern::ALL)): the
    /// transitions of (5.25), counted in its films.
    ///
    /// The start distribution is "a normal distribution" over the four (§ 5.5.2), without numbers: here
    /// the masses of a Gaussian about the middle of the order with a standard deviation of one pattern
    /// at −1.5, −0.5, 0.5 and 1.5.
    pub fn thesis() -> Self {
        let gauss = |x: f64| math::exp(-0.5 * x * x);
        let masses = [-1.5, -0.5, 0.5, 1.5].map(gauss);
        let sum: f64 = masses.iter().sum();
        Self {
            start: masses.map(|m| m / sum).to_vec(),
            transitions: vec![
                vec![0.154, 0.385, 0.038, 0.423],
                vec![0.0, 0.383, 0.086, 0.531],
                vec![0.0, 0.0, 0.652, 0.348],
                vec![0.0, 0.0, 0.0, 1.0],
            ],
        }
    }

    /// The graph of a body that stays in one state of `states`: a heavy brick in air is always SD
    /// (thesis § 5.5.3).
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if there is no such state.
    pub fn always(state: usize, states: usize) -> Result<Self, Error> {
        Error::check_range("state", state as f64, 0.0, states as f64 - 1.0)?;
        let unit = |i: usize| (0..states).map(|j| f64::from(u8::from(i == j))).collect();
        Self::new(unit(state), (0..states).map(unit).collect())
    }

    /// Estimates the graph by counting: P_ij = N_ij/N_i and the share of sequences that start with each
    /// state. A state that is never left is absorbing.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a sequence has a state that is not below `states`;
    /// [`Error::WrongLength`] if no sequence has an entry.
    pub fn estimate(sequences: &[Vec<usize>], states: usize) -> Result<Self, Error> {
        let mut start = vec![0.0; states];
        let mut counts = vec![vec![0.0; states]; states];
        for sequence in sequences {
            for state in sequence {
                Error::check_range("state", *state as f64, 0.0, states as f64 - 1.0)?;
            }
            if let Some(first) = sequence.first() {
                start[*first] += 1.0;
            }
            for pair in sequence.windows(2) {
                counts[pair[0]][pair[1]] += 1.0;
            }
        }
        let whole: f64 = start.iter().sum();
        if whole == 0.0 {
            return Err(Error::WrongLength {
                what: "labelled sequences",
                expected: 1,
                actual: 0,
            });
        }
        start.iter_mut().for_each(|p| *p /= whole);
        for (state, row) in counts.iter_mut().enumerate() {
            let sum: f64 = row.iter().sum();
            if sum > 0.0 {
                row.iter_mut().for_each(|p| *p /= sum);
            } else {
                row[state] = 1.0;
            }
        }
        Self::new(start, counts)
    }

    /// The same graph without the states that a body cannot show (an empty subspace, say). Their
    /// probability goes to the others in proportion; a state that could only go to such ones stays.
    ///
    /// # Errors
    /// [`Error::WrongLength`] if `possible` does not have one entry per state;
    /// [`Error::InvalidParameter`] if no state is possible.
    pub fn restricted(&self, possible: &[bool]) -> Result<Self, Error> {
        let states = self.start.len();
        Error::check_length("possible states", states, possible.len())?;
        let count = possible.iter().filter(|p| **p).count();
        Error::check("possible states", count as f64, count > 0, "at least one")?;
        let restrict = |row: &[f64], fallback: &dyn Fn(usize) -> f64| -> Vec<f64> {
            let sum: f64 = row
                .iter()
                .zip(possible)
                .filter(|(_, p)| **p)
                .map(|(x, _)| x)
                .sum();
            (0..states)
                .map(|i| match (sum > 0.0, possible[i]) {
                    (true, true) => row[i] / sum,
                    (true, false) => 0.0,
                    (false, _) => fallback(i),
                })
                .collect()
        };
        let even = |i: usize| f64::from(u8::from(possible[i])) / count as f64;
        let start = restrict(&self.start, &even);
        let rows = self.transitions.iter().enumerate();
        let transitions =
            rows.map(|(state, row)| restrict(row, &|i| f64::from(u8::from(i == state))));
        Self::new(start, transitions.collect())
    }

    /// Number of states.
    pub fn states(&self) -> usize {
        self.start.len()
    }

    /// Probability of starting in a state.
    pub fn start(&self, state: usize) -> f64 {
        self.start[state]
    }

    /// Probability of going on with `to` after `from`.
    pub fn probability(&self, from: usize, to: usize) -> f64 {
        self.transitions[from][to]
    }

    /// Whether a state is never left.
    pub fn is_absorbing(&self, state: usize) -> bool {
        self.transitions[state][state] == 1.0
    }

    /// Whether a state can ever occur.
    pub fn is_reachable(&self, state: usize) -> bool {
        let mut reached: Vec<bool> = self.start.iter().map(|p| *p > 0.0).collect();
        for _ in 0..self.states() {
            for from in 0..self.states() {
                if reached[from] {
                    for (to, p) in self.transitions[from].iter().enumerate() {
                        reached[to] |= *p > 0.0;
                    }
                }
            }
        }
        reached[state]
    }

    /// Whether no state is ever followed by an earlier one.
    pub fn is_unidirectional(&self) -> bool {
        let rows = self.transitions.iter().enumerate();
        let mut backward = rows.flat_map(|(i, row)| &row[..i]);
        backward.all(|p| *p == 0.0)
    }

    /// Draws a start.
    pub fn draw_start(&self, random: &mut impl Rng) -> usize {
        draw(&self.start, random)
    }

    /// Draws what follows a state.
    pub fn draw_next(&self, state: usize, random: &mut impl Rng) -> usize {
        draw(&self.transitions[state], random)
    }
}

/// An index with the given probabilities, never one of probability zero.
fn draw(probabilities: &[f64], random: &mut impl Rng) -> usize {
    let mut left: f64 = random.random_range(0.0..1.0);
    let mut last = 0;
    for (index, p) in probabilities.iter().enumerate().filter(|(_, p)| **p > 0.0) {
        last = index;
        left -= p;
        if left < 0.0 {
            break;
        }
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_pcg::Pcg64Mcg;

    #[test]
    fn the_thesis_graph() {
        let graph = MotionGraph::thesis();
        assert_eq!(graph.check(), Ok(()));
        assert!(graph.is_unidirectional());
        assert!(graph.is_absorbing(3) && !graph.is_absorbing(2));
        assert!((0..4).all(|state| graph.is_reachable(state)));
        // Every state but the absorbing one can be left, and rows as printed sum to exactly 1.
        for state in 0..4 {
            let sum: f64 = (0..4).map(|to| graph.probability(state, to)).sum();
            assert!((sum - 1.0).abs() < 1e-12);
        }
    }

    /// Sequences drawn from the graph give it back by counting: each probability within 5 standard
    /// deviations √(p(1−p)/N_i), zeros exactly.
    #[test]
    fn counting_recovers_the_graph() {
        let graph = MotionGraph::thesis();
        let mut random = Pcg64Mcg::seed_from_u64(5);
        let mut visits = [0.0; 4];
        let sequences: Vec<Vec<usize>> = (0..4000)
            .map(|_| {
                let mut state = graph.draw_start(&mut random);
                let mut sequence = vec![state];
                for _ in 0..6 {
                    visits[state] += 1.0;
                    state = graph.draw_next(state, &mut random);
                    sequence.push(state);
                }
                sequence
            })
            .collect();
        let estimate = MotionGraph::estimate(&sequences, 4).unwrap();
        for (from, visits) in visits.into_iter().enumerate() {
            for to in 0..4 {
                let p = graph.probability(from, to);
                let deviation: f64 = (p * (1.0 - p) / visits).sqrt();
                let error = (estimate.probability(from, to) - p).abs();
                assert!(error <= 5.0 * deviation, "{from} {to}: {error} {deviation}");
            }
        }
        assert!(estimate.is_unidirectional());
    }

    #[test]
    fn impossible_states_are_left_out() {
        let graph = MotionGraph::thesis();
        let without = graph.restricted(&[true, false, true, true]).unwrap();
        assert_eq!((without.start(1), without.probability(0, 1)), (0.0, 0.0));
        assert!((without.probability(0, 2) - 0.038 / 0.615).abs() < 1e-12);
        assert!(!without.is_reachable(1));
        // Where autorotation and what follows are impossible, steady descent stays what it is.
        let brick = graph.restricted(&[true, false, false, false]).unwrap();
        assert!(brick.start(0) == 1.0 && brick.is_absorbing(0));
        assert!((1..4).all(|state| !brick.is_reachable(state)));
        let always = MotionGraph::always(0, 4).unwrap();
        assert!(always.start(0) == 1.0 && always.is_absorbing(0));
        let mut random = Pcg64Mcg::seed_from_u64(1);
        for graph in [&brick, &always] {
            assert_eq!(graph.draw_start(&mut random), 0);
            assert!((0..100).all(|_| graph.draw_next(0, &mut random) == 0));
        }
        // A state that only led to impossible ones becomes absorbing.
        let last = graph.restricted(&[true, true, true, false]).unwrap();
        assert_eq!(last.probability(3, 3), 1.0);
        assert!(graph.restricted(&[false; 4]).is_err());
    }

    #[test]
    fn bad_graphs_are_refused() {
        let half = vec![0.5, 0.5];
        assert!(MotionGraph::new(half.clone(), vec![half.clone(); 2]).is_ok());
        assert!(MotionGraph::new(half.clone(), vec![half.clone(); 3]).is_err());
        assert!(MotionGraph::new(half.clone(), vec![half.clone(), vec![1.0]]).is_err());
        assert!(MotionGraph::new(half.clone(), vec![half.clone(), vec![0.5, 0.6]]).is_err());
        assert!(MotionGraph::new(half.clone(), vec![half.clone(), vec![1.5, -0.5]]).is_err());
        assert!(MotionGraph::new(vec![f64::NAN, 1.0], vec![half; 2]).is_err());
        assert!(MotionGraph::estimate(&[vec![0, 4]], 4).is_err());
        assert!(MotionGraph::estimate(&[], 4).is_err());
        assert!(MotionGraph::always(4, 4).is_err());
    }
}
