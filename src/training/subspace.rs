//! Subspaces: the part of the parameter space where a body shows a pattern (thesis § 5.4.3).

use super::grid::Grid;
use crate::error::Error;
use crate::motion::Pattern;
use rand::{Rng, RngExt};

/// A labelled grid: every point of the parameter space belongs to the pattern of its nearest node.
///
/// ```
/// use rapier3d_immersed::motion::Pattern;
/// use rapier3d_immersed::training::{Axis, Grid, Subspaces};
///
/// let drag = Axis { low: 0.0, high: 3.0, count: 4 };
/// let labels = [Pattern::Autorotation, Pattern::Zigzag, Pattern::Zigzag, Pattern::SteadyDescent];
/// let subspaces = Subspaces::new(Grid::new(vec![drag])?, labels.to_vec())?;
/// assert_eq!(subspaces.pattern_at(&[1.8]), Pattern::Zigzag);
/// assert_eq!(subspaces.nearest(Pattern::SteadyDescent, &[1.0]), Some(3));
/// // By volume: cells at the ends are half as large.
/// assert_eq!(subspaces.volume_fractions()[Pattern::Zigzag.index()], 2.0 / 3.0);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Subspaces {
    grid: Grid,
    labels: Vec<Pattern>,
}

impl Subspaces {
    /// # Errors
    /// [`Error::WrongLength`] if there is not one label per node.
    pub fn new(grid: Grid, labels: Vec<Pattern>) -> Result<Self, Error> {
        let subspaces = Self { grid, labels };
        subspaces.check()?;
        Ok(subspaces)
    }

    pub(super) fn check(&self) -> Result<(), Error> {
        self.grid.check()?;
        Error::check_length("labels of the grid", self.grid.len(), self.labels.len())
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Pattern of each node.
    pub fn labels(&self) -> &[Pattern] {
        &self.labels
    }

    /// Pattern at a point. Points outside belong to their nearest node.
    pub fn pattern_at(&self, point: &[f64]) -> Pattern {
        self.labels[self.grid.nearest(point)]
    }

    /// Nodes of a pattern.
    pub fn nodes(&self, pattern: Pattern) -> Vec<usize> {
        (0..self.labels.len())
            .filter(|node| self.labels[*node] == pattern)
            .collect()
    }

    /// The node of a pattern nearest to a point, in units of the axes' spacings; `None` if the body
    /// never shows the pattern.
    pub fn nearest(&self, pattern: Pattern, point: &[f64]) -> Option<usize> {
        let distance = |node: usize| -> f64 {
            let there = self.grid.point(node);
            let axes = self.grid.axes().iter();
            axes.zip(there.iter().zip(point))
                .map(|(axis, (a, b))| ((a - b) / axis.spacing()).powi(2))
                .sum()
        };
        let nodes = self.nodes(pattern).into_iter();
        nodes.min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
    }

    /// The box of points that belong to a node, by axis.
    pub fn cell(&self, node: usize) -> Vec<[f64; 2]> {
        let pairs = self.grid.indices(node).into_iter().zip(self.grid.axes());
        pairs.map(|(index, axis)| axis.cell(index)).collect()
    }

    fn cell_volume(&self, node: usize) -> f64 {
        self.cell(node)
            .iter()
            .map(|[low, high]| high - low)
            .product()
    }

    /// Share of the parameter space that each pattern has, in the order of [`Pattern::ALL`].
    pub fn volume_fractions(&self) -> [f64; 4] {
        let mut fractions = [0.0; 4];
        for (node, label) in self.labels.iter().enumerate() {
            fractions[label.index()] += self.cell_volume(node);
        }
        let whole: f64 = fractions.iter().sum();
        fractions.map(|volume| volume / whole)
    }

    /// The connected regions of a pattern, largest first: the nodes of each.
    pub fn regions(&self, pattern: Pattern) -> Vec<Vec<usize>> {
        let mut seen = vec![false; self.labels.len()];
        let mut regions = Vec::new();
        for start in 0..self.labels.len() {
            if seen[start] || self.labels[start] != pattern {
                continue;
            }
            seen[start] = true;
            let (mut region, mut next) = (Vec::new(), vec![start]);
            while let Some(node) = next.pop() {
                region.push(node);
                for neighbour in self.grid.neighbours(node) {
                    if !seen[neighbour] && self.labels[neighbour] == pattern {
                        seen[neighbour] = true;
                        next.push(neighbour);
                    }
                }
            }
            region.sort_unstable();
            regions.push(region);
        }
        regions.sort_by_key(|region| std::cmp::Reverse(region.len()));
        regions
    }

    /// A point of a pattern's subspace, uniformly distributed over it; `None` if it is empty.
    pub fn sample(&self, pattern: Pattern, random: &mut impl Rng) -> Option<Vec<f64>> {
        let nodes = self.nodes(pattern);
        let whole: f64 = nodes.iter().map(|node| self.cell_volume(*node)).sum();
        let mut left = random.random_range(0.0..1.0) * whole;
        let node = nodes.iter().copied().find(|node| {
            left -= self.cell_volume(*node);
            left < 0.0
        });
        let cell = self.cell(node.or(nodes.last().copied())?);
        let within = |[low, high]: [f64; 2]| random.random_range(low..high);
        Some(cell.into_iter().map(within).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::training::Axis;
    use rand::SeedableRng;
    use rand_pcg::Pcg64Mcg;

    /// On [0, 4]: SD, SD, ZZ, AR, SD at 0, 1, 2, 3, 4.
    fn line() -> Subspaces {
        use Pattern::*;
        let axis = Axis {
            low: 0.0,
            high: 4.0,
            count: 5,
        };
        let labels = vec![
            SteadyDescent,
            SteadyDescent,
            Zigzag,
            Autorotation,
            SteadyDescent,
        ];
        Subspaces::new(Grid::new(vec![axis]).unwrap(), labels).unwrap()
    }

    #[test]
    fn membership_and_volume() {
        let line = line();
        assert_eq!(line.pattern_at(&[1.4]), Pattern::SteadyDescent);
        assert_eq!(line.pattern_at(&[1.6]), Pattern::Zigzag);
        assert_eq!(line.pattern_at(&[-7.0]), Pattern::SteadyDescent);
        // Cells at the ends are half as long.
        assert_eq!(line.volume_fractions(), [0.5, 0.25, 0.0, 0.25]);
        assert_eq!(line.nearest(Pattern::Zigzag, &[0.0]), Some(2));
        assert_eq!(line.nearest(Pattern::AutorotationZigzag, &[0.0]), None);
        let regions = line.regions(Pattern::SteadyDescent);
        assert_eq!(regions, vec![vec![0, 1], vec![4]]);
    }

    #[test]
    fn samples_are_uniform_over_the_subspace() {
        let line = line();
        let mut random = Pcg64Mcg::seed_from_u64(1);
        let mut last_region = 0;
        let count = 4000;
        for _ in 0..count {
            let point = line.sample(Pattern::SteadyDescent, &mut random).unwrap();
            assert_eq!(line.pattern_at(&point), Pattern::SteadyDescent);
            last_region += u32::from(point[0] > 3.0);
        }
        // It is a quarter of the volume: 5 standard deviations of a binomial are 5 · √(n p q) = 5 · 27.
        assert!(
            (f64::from(last_region) - 1000.0).abs() < 5.0 * 27.4,
            "{last_region}"
        );
        assert!(
            line.sample(Pattern::AutorotationZigzag, &mut random)
                .is_none()
        );
    }

    #[test]
    fn labels_must_fit() {
        let line = line();
        assert!(Subspaces::new(line.grid().clone(), vec![Pattern::Zigzag; 4]).is_err());
    }
}
