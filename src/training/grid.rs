//! A regular grid over any number of parameters.

use crate::error::Error;

/// One parameter: `count` nodes from `low` to `high`, both included.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Axis {
    /// Value at the first node.
    pub low: f64,
    /// Value at the last node.
    pub high: f64,
    /// Number of nodes, at least 2.
    pub count: usize,
}

impl Axis {
    /// Distance between nodes.
    pub fn spacing(&self) -> f64 {
        (self.high - self.low) / (self.count - 1) as f64
    }

    /// Value at a node.
    pub fn value(&self, node: usize) -> f64 {
        self.low + self.spacing() * node as f64
    }

    /// The node nearest to a value.
    pub fn nearest(&self, value: f64) -> usize {
        let node = ((value - self.low) / self.spacing()).round();
        // The maximum of NaN and 0 is 0, the first node.
        (node.max(0.0) as usize).min(self.count - 1)
    }

    /// What lies nearer to a node than to any other, within the axis.
    pub fn cell(&self, node: usize) -> [f64; 2] {
        let (middle, half) = (self.value(node), 0.5 * self.spacing());
        [
            (middle - half).max(self.low),
            (middle + half).min(self.high),
        ]
    }
}

/// Nodes at every combination of the axes' values; the last axis varies fastest.
///
/// ```
/// use rapier3d_immersed::training::{Axis, Grid};
///
/// let drag = Axis { low: 0.5, high: 2.5, count: 5 };
/// let lift = Axis { low: 0.0, high: 1.0, count: 3 };
/// let grid = Grid::new(vec![drag, lift])?;
/// assert_eq!(grid.len(), 15);
/// assert_eq!(grid.point(4), [1.0, 0.5]);
/// assert_eq!(grid.nearest(&[1.1, 0.4]), 4);
/// assert_eq!(grid.refined()?.len(), 9 * 5);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Grid {
    axes: Vec<Axis>,
}

/// Nodes that a grid may have.
const MOST_NODES: f64 = 1e7;

impl Grid {
    /// A grid over these axes.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] or [`Error::OutOfRange`] if there is no axis, an axis has less than
    /// two nodes or does not ascend between finite values, or there are more than 10⁷ nodes.
    pub fn new(axes: Vec<Axis>) -> Result<Self, Error> {
        let grid = Self { axes };
        grid.check()?;
        Ok(grid)
    }

    /// The grid of the thesis's control parameters: `count` nodes per axis over (0, limit)³, which
    /// leaves out the two per cent next to 0, where a force is absent.
    ///
    /// # Errors
    /// Those of [`Grid::new`].
    pub fn of_coefficients(count: usize, limit: f64) -> Result<Self, Error> {
        let axis = Axis {
            low: 0.02 * limit,
            high: limit,
            count,
        };
        Self::new(vec![axis; 3])
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        Error::check_range("axes of the grid", self.axes.len() as f64, 1.0, 16.0)?;
        let mut nodes = 1.0;
        for axis in &self.axes {
            Error::check_finite("low", axis.low)?;
            Error::check_finite("high", axis.high)?;
            Error::check("high", axis.high, axis.high > axis.low, "above low")?;
            Error::check_range("count", axis.count as f64, 2.0, MOST_NODES)?;
            nodes *= axis.count as f64;
        }
        Error::check_range("nodes of the grid", nodes, 1.0, MOST_NODES)?;
        Ok(())
    }

    /// The axes.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.axes.iter().map(|axis| axis.count).product()
    }

    /// Always false: a grid has at least two nodes.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Position of a node along each axis.
    pub fn indices(&self, node: usize) -> Vec<usize> {
        let mut rest = node;
        let mut indices = vec![0; self.axes.len()];
        for (index, axis) in indices.iter_mut().zip(&self.axes).rev() {
            *index = rest % axis.count;
            rest /= axis.count;
        }
        indices
    }

    /// The node at a position along each axis.
    pub fn node(&self, indices: &[usize]) -> usize {
        let pairs = indices.iter().zip(&self.axes);
        pairs.fold(0, |node, (index, axis)| node * axis.count + index)
    }

    /// Parameters at a node.
    pub fn point(&self, node: usize) -> Vec<f64> {
        let indices = self.indices(node);
        let pairs = self.axes.iter().zip(indices);
        pairs.map(|(axis, index)| axis.value(index)).collect()
    }

    /// The node nearest to a point, in units of the axes' spacings.
    pub fn nearest(&self, point: &[f64]) -> usize {
        let pairs = self.axes.iter().zip(point);
        let indices: Vec<usize> = pairs.map(|(axis, value)| axis.nearest(*value)).collect();
        self.node(&indices)
    }

    /// The nodes one step away along one axis: 6 of an inner node in three dimensions.
    pub fn neighbours(&self, node: usize) -> Vec<usize> {
        let indices = self.indices(node);
        let mut found = Vec::with_capacity(2 * indices.len());
        let mut stride = 1;
        for (index, axis) in indices.iter().zip(&self.axes).rev() {
            if *index > 0 {
                found.push(node - stride);
            }
            if index + 1 < axis.count {
                found.push(node + stride);
            }
            stride *= axis.count;
        }
        found
    }

    /// A grid that is twice as fine, with a node halfway between any two.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if that is more than 10⁷ nodes.
    pub fn refined(&self) -> Result<Self, Error> {
        let axes = self.axes.iter().map(|axis| Axis {
            count: 2 * axis.count - 1,
            ..*axis
        });
        Self::new(axes.collect())
    }

    /// The nodes of this grid nearest to `fine`, a node of the grid refined once: itself, or the two,
    /// four, … it lies between.
    pub fn around(&self, fine: &[usize]) -> Vec<usize> {
        let mut corners = vec![Vec::with_capacity(fine.len())];
        for index in fine {
            let low = index / 2;
            if index % 2 == 1 {
                let upper = corners.iter().map(|corner| {
                    let mut upper: Vec<usize> = corner.clone();
                    upper.push(low + 1);
                    upper
                });
                let upper: Vec<_> = upper.collect();
                corners.iter_mut().for_each(|corner| corner.push(low));
                corners.extend(upper);
            } else {
                corners.iter_mut().for_each(|corner| corner.push(low));
            }
        }
        corners.iter().map(|corner| self.node(corner)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Grid {
        let axis = |low, high, count| Axis { low, high, count };
        Grid::new(vec![axis(0.0, 3.0, 4), axis(-1.0, 1.0, 3)]).unwrap()
    }

    #[test]
    fn nodes_and_points_agree() {
        let grid = grid();
        assert_eq!(grid.len(), 12);
        for node in 0..grid.len() {
            assert_eq!(grid.node(&grid.indices(node)), node);
            assert_eq!(grid.nearest(&grid.point(node)), node);
        }
        assert_eq!(grid.point(4), [1.0, 0.0]);
        assert_eq!(grid.nearest(&[9.0, f64::NAN]), grid.node(&[3, 0]));
        let cells: f64 = (0..4)
            .map(|i| grid.axes()[0].cell(i))
            .map(|c| c[1] - c[0])
            .sum();
        assert_eq!(cells, 3.0);
    }

    /// An inner node has two neighbours per axis, and being neighbours is mutual.
    #[test]
    fn neighbours() {
        let grid = grid();
        assert_eq!(grid.neighbours(4), vec![3, 5, 1, 7]);
        for node in 0..grid.len() {
            for other in grid.neighbours(node) {
                assert!(grid.neighbours(other).contains(&node));
            }
        }
    }

    /// 9³ = 729 nodes become 17³ = 4913, the numbers of the thesis.
    #[test]
    fn refinement() {
        let coarse = Grid::of_coefficients(9, 3.0).unwrap();
        let fine = coarse.refined().unwrap();
        assert_eq!((coarse.len(), fine.len()), (729, 4913));
        assert_eq!(coarse.around(&[2, 4, 6]), [coarse.node(&[1, 2, 3])]);
        let corners = coarse.around(&[1, 4, 15]);
        assert_eq!(corners.len(), 4);
        let middle = corners.iter().fold([0.0; 3], |sum, corner| {
            let p = coarse.point(*corner);
            [0, 1, 2].map(|i| sum[i] + 0.25 * p[i])
        });
        let point = fine.point(fine.node(&[1, 4, 15]));
        assert!(
            middle
                .iter()
                .zip(&point)
                .all(|(a, b)| (a - b).abs() < 1e-12)
        );
    }

    #[test]
    fn bad_grids_are_refused() {
        let axis = |low, high, count| Axis { low, high, count };
        for bad in [
            axis(1.0, 1.0, 3),
            axis(0.0, 1.0, 1),
            axis(0.0, f64::NAN, 3),
            axis(0.0, 1.0, 100_000_000),
        ] {
            assert!(Grid::new(vec![bad]).is_err());
        }
        assert!(Grid::new(Vec::new()).is_err());
        assert!(Grid::new(vec![axis(0.0, 1.0, 1000); 3]).is_err());
    }
}
