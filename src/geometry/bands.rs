//! Where the parallel lines are placed along which a body is looked at.

use super::Surface;
use rapier3d::na::Vector3;
use std::ops::Range;

/// Planes across an axis that a body is cut into bands by, besides its ends.
const MOST_CUTS: usize = 64;

/// A band across an axis, with a line in its middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Band {
    /// Place of its middle along the axis, m.
    pub middle: f64,
    /// Its width, m.
    pub width: f64,
}

impl Band {
    /// Where it ends, m.
    pub fn end(&self) -> f64 {
        self.middle + 0.5 * self.width
    }
}

/// Bands from end to end of a surface whose vertices are at these places along an axis, about `count` of them. Between
/// two planes that have vertices, or between which the parts lie that it consists of, half of them are spread evenly,
/// and half by length: nothing that ends at such planes is so thin that lines miss it.
pub(crate) fn bands(surface: &Surface, places: &[f64], count: usize) -> Vec<Band> {
    let cuts = cuts(places.iter().copied())
        .or_else(|| cuts(extents(surface, places).into_iter().flatten()))
        .unwrap_or_else(|| {
            let low = places.iter().copied().fold(f64::INFINITY, f64::min);
            let high = places.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            vec![low, high]
        });
    let (first, last) = (cuts[0], cuts[cuts.len() - 1]);
    let even = 0.5 * count as f64 / (cuts.len() - 1).max(1) as f64;
    let mut bands = Vec::with_capacity(2 * count);
    for ends in cuts.windows(2) {
        let length = ends[1] - ends[0];
        let by_length = 0.5 * count as f64 * length / (last - first);
        let n = (even + by_length).round().max(1.0);
        let width = length / n;
        bands.extend((0..n as usize).map(|i| Band {
            middle: ends[0] + (i as f64 + 0.5) * width,
            width,
        }));
    }
    bands
}

/// Places in rising order without those that are alike; `None` if there are many.
fn cuts(places: impl Iterator<Item = f64>) -> Option<Vec<f64>> {
    let mut cuts: Vec<f64> = places.collect();
    cuts.sort_unstable_by(f64::total_cmp);
    // Single precision tells apart what was meant to be alike.
    let alike = 1e-6 * (cuts.last()? - cuts.first()?);
    cuts.dedup_by(|next, kept| *next - *kept <= alike);
    (2..=MOST_CUTS + 2).contains(&cuts.len()).then_some(cuts)
}

/// Between which places each of the bodies lies that a surface consists of.
fn extents(surface: &Surface, places: &[f64]) -> Vec<[f64; 2]> {
    let mut extents = vec![[f64::INFINITY, f64::NEG_INFINITY]; places.len()];
    for (body, place) in surface.bodies().into_iter().zip(places) {
        let [low, high] = &mut extents[body as usize];
        (*low, *high) = (low.min(*place), high.max(*place));
    }
    extents.retain(|[low, high]| low <= high);
    extents
}

/// A triangle that is crossed by planes of one coordinate, each in a segment of the other two: its corners in the
/// order of that coordinate, and how those two change along its edges.
pub(crate) struct Crossed {
    low: [f64; 3],
    middle: [f64; 3],
    /// Of the edges from the lowest to the middle corner, from there to the highest, and from the lowest to that.
    slopes: [[f64; 2]; 3],
}

impl Crossed {
    /// By planes of the coordinate `across`, in segments of `along` and the third; `None` if it lies in such a plane.
    pub fn new(triangle: &[Vector3<f64>; 3], across: usize, along: usize) -> Option<Self> {
        let [mut a, mut b, mut c] = triangle.map(|v| [v[across], v[along], v[2]]);
        let order = |p: &mut [f64; 3], q: &mut [f64; 3]| {
            if p[0] > q[0] {
                std::mem::swap(p, q);
            }
        };
        order(&mut a, &mut b);
        order(&mut b, &mut c);
        order(&mut a, &mut b);
        // From the lower end of an edge, whichever triangle it belongs to: neighbors meet it at the same point.
        let slope = |p: &[f64; 3], q: &[f64; 3]| {
            let per = 1.0 / (q[0] - p[0]);
            [1, 2].map(|i| (q[i] - p[i]) * per)
        };
        (a[0] < c[0]).then(|| Self {
            slopes: [slope(&a, &b), slope(&b, &c), slope(&a, &c)],
            low: a,
            middle: b,
        })
    }

    /// The ends of the segment in the plane at a place, in rising order; upright ones go from low to high. The place
    /// lies between the lowest and the highest corner.
    pub fn at(&self, place: f64) -> [[f64; 2]; 2] {
        let point = |from: &[f64; 3], slope: &[f64; 2]| {
            let by = place - from[0];
            [from[1] + slope[0] * by, from[2] + slope[1] * by]
        };
        let long = point(&self.low, &self.slopes[2]);
        let short = if place < self.middle[0] {
            point(&self.low, &self.slopes[0])
        } else if self.slopes[1][0].is_finite() {
            point(&self.middle, &self.slopes[1])
        } else {
            // The upper edge lies in a plane itself.
            [self.middle[1], self.middle[2]]
        };
        if (long[0], long[1]) <= (short[0], short[1]) {
            [long, short]
        } else {
            [short, long]
        }
    }
}

/// Which of the bands have their middles between the ends of a triangle.
pub(crate) fn met(bands: &[Band], corners: &[Vector3<f64>; 3], axis: usize) -> Range<usize> {
    let [a, b, c] = corners.map(|v| v[axis]);
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let start = bands.partition_point(|band| band.middle < low);
    let count = bands[start..].partition_point(|band| band.middle <= high);
    start..start + count
}

/// Intervals that overlap, or are no farther apart than a gap, become one.
pub(crate) fn merge(intervals: &mut Vec<[f64; 2]>, gap: f64) {
    intervals.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
    intervals.dedup_by(|next, kept| {
        let one = next[0] <= kept[1] + gap;
        if one {
            kept[1] = kept[1].max(next[1]);
        }
        one
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use rapier3d::math::{Pose, Vector};
    use rapier3d::parry::shape::{Ball, Cuboid, SharedShape};

    fn places(surface: &Surface, axis: usize) -> Vec<f64> {
        surface.vertices().iter().map(|v| v[axis]).collect()
    }

    /// The bands of a cube are equal and fill it; of two balls far apart each has a sixth of them at least, though
    /// they take up a thousandth of the length.
    #[test]
    fn bands_are_where_the_body_is() {
        let cube = Surface::from_shape(&Cuboid::new(Vector::splat(0.5))).unwrap();
        let found = bands(&cube, &places(&cube, 0), 64);
        assert_eq!(found.len(), 64);
        assert_eq!(
            found[0],
            Band {
                middle: -0.5 + 1.0 / 128.0,
                width: 1.0 / 64.0
            }
        );
        assert!((found[63].end() - 0.5).abs() < 1e-12);

        let pair = [-1.0, 1.0].map(|x| {
            let ball = SharedShape::new(Ball::new(0.001));
            (Pose::from_translation(Vector::X * x), ball)
        });
        let pair = SharedShape::compound(pair.to_vec());
        let pair = Surface::from_shape(pair.as_ref()).unwrap();
        let found = bands(&pair, &places(&pair, 0), 64);
        for side in [-1.0, 1.0] {
            let on = found
                .iter()
                .filter(|band| (band.middle - side).abs() < 0.001);
            assert_eq!(on.count(), 11);
        }
        let whole: f64 = found.iter().map(|band| band.width).sum();
        // The facets of a ball have its volume, and reach beyond it.
        assert!((whole - 2.002).abs() < 1e-5, "{whole}");
    }

    /// A plane across a triangle, by hand, from whichever corner; at its highest corner it is a point; an upright
    /// triangle is crossed from low to high, and one that lies in a plane not at all.
    #[test]
    fn triangles_are_crossed() {
        let a = Vector3::zeros();
        let b = Vector3::new(2.0, 0.0, 2.0);
        let c = Vector3::new(0.0, 1.0, 4.0);
        for turned in [[a, b, c], [b, c, a], [c, b, a]] {
            let crossed = Crossed::new(&turned, 1, 0).unwrap();
            assert_eq!(crossed.at(0.25), [[0.0, 1.0], [1.5, 2.5]]);
            assert_eq!(crossed.at(1.0), [[0.0, 4.0]; 2]);
        }
        let below = Crossed::new(&[-a, -b, -c], 1, 0).unwrap();
        assert_eq!(below.at(-0.25), [[-1.5, -2.5], [0.0, -1.0]]);
        let oblique = [a, Vector3::new(4.0, 1.0, 0.0), Vector3::new(0.0, 2.0, 6.0)];
        let crossed = Crossed::new(&oblique, 1, 0).unwrap();
        assert_eq!(crossed.at(0.5), [[0.0, 1.5], [2.0, 0.0]]);
        assert_eq!(crossed.at(1.5), [[0.0, 4.5], [2.0, 3.0]]);
        let upright = [a, Vector3::z() * 2.0, Vector3::new(0.0, 1.0, 2.0)];
        let crossed = Crossed::new(&upright, 1, 0).unwrap();
        assert_eq!(crossed.at(0.5), [[0.0, 1.0], [0.0, 2.0]]);
        assert!(Crossed::new(&[a, b, Vector3::x()], 1, 0).is_none());
    }

    /// Intervals become one where they overlap or the gap is small, whatever their order.
    #[test]
    fn intervals_are_merged() {
        let mut intervals = vec![[3.0, 4.0], [0.0, 2.0], [0.5, 1.0], [2.1, 2.5]];
        merge(&mut intervals, 0.2);
        assert_eq!(intervals, [[0.0, 2.5], [3.0, 4.0]]);
    }
}
