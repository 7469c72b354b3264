//! Trilinear interpolation on a regular lattice, clamped or periodic along each axis.

use crate::error::Error;
use rapier3d::glamx::Vec4;
use rapier3d::math::{Real, Vector};

/// Most nodes along one axis, so that products of three fit comfortably into `u64`.
pub(crate) const MAX_NODES: u64 = 1 << 16;

/// Where the nodes are. Node (i, j, k) is at `origin + (i, j, k)·spacing`.
///
/// Node values are stored [padded](Lattice::pad): every periodic or one-node axis has its first node once
/// more at its end, so that the nodes of a cell are always neighbors in memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lattice {
    pub dims: [usize; 3],
    pub periodic: [bool; 3],
    pub origin: Vector,
    pub spacing: Vector,
    stored: [usize; 3],
    lanes: Lanes,
}

/// The lattice as four-lane constants, so that the three axes are bracketed at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lanes {
    pub origin: Vec4,
    pub per_spacing: Vec4,
    pub nodes: Vec4,
    pub per_node: Vec4,
    /// 1 along periodic axes, 0 along the others: the mask's own type differs between glam's builds.
    pub periodic: Vec4,
    /// Largest position and largest node below a cell.
    pub end: Vec4,
    pub last: Vec4,
}

/// The cell around a point: the first nodes of its four rows and the position inside.
pub(crate) struct Cell {
    rows: [usize; 4],
    weight: Vec4,
    flat: bool,
}

/// 1.5·2⁵²: f64 has no fractions here, so that a sum with it rounds to a whole number.
const WHOLE: f64 = 6_755_399_441_055_744.0;

/// `x` as a whole number and a rest within ±½. NaN and what is not smaller than 2⁵¹ count as zero.
#[inline(always)]
fn split(x: f64) -> (f64, f64) {
    if x.abs() < WHOLE / 3.0 {
        let whole = (x + WHOLE) - WHOLE;
        (whole, x - whole)
    } else {
        (0.0, 0.0)
    }
}

/// `x` modulo `period`, within ±½ period: several times faster than `rem_euclid` (which divides bit by
/// bit), and without the library's `floor`.
#[inline(always)]
pub(crate) fn wrap(x: f64, period: f64) -> f64 {
    fraction(x / period) * period
}

/// `turns` without its whole number, within ±½.
#[inline(always)]
pub(super) fn fraction(turns: f64) -> f64 {
    split(turns).1
}

/// Cosine and sine of 2π·`turns`, to two units in the last place of f32, in a fraction of the library's
/// time.
#[inline(always)]
pub(super) fn cos_sin(turns: f64) -> [Real; 2] {
    let (quarters, rest) = split(4.0 * turns);
    let x = rest * core::f64::consts::FRAC_PI_2;
    let x2 = x * x;
    // These are Taylor's series for |x| ≤ π/4.
    const PER_FACTORIAL: [f64; 8] = [
        -1.0 / 2.0,
        -1.0 / 6.0,
        1.0 / 24.0,
        1.0 / 120.0,
        -1.0 / 720.0,
        -1.0 / 5040.0,
        1.0 / 40_320.0,
        1.0 / 362_880.0,
    ];
    let series = |[a, b, c, d]: [f64; 4]| 1.0 + x2 * (a + x2 * (b + x2 * (c + x2 * d)));
    let [a2, a3, a4, a5, a6, a7, a8, a9] = PER_FACTORIAL;
    let (sine, cosine) = (x * series([a3, a5, a7, a9]), series([a2, a4, a6, a8]));
    let (cos, sin) = match quarters as i64 & 3 {
        0 => (cosine, sine),
        1 => (-sine, cosine),
        2 => (-cosine, -sine),
        _ => (sine, -cosine),
    };
    [cos as Real, sin as Real]
}

/// Beyond this number of periods, f32 has too few digits left for fractions of one to matter.
pub(super) const FAR: Real = 4_194_304.0;

/// The largest whole number that is not larger than x, for |x| ≤ [`FAR`]: a sum as large as `shift` has no
/// room for a fraction. Where SSE 4.1 cannot be taken for granted, this is several times cheaper than the
/// library's `floor`.
#[inline(always)]
fn floor(x: Vec4) -> Vec4 {
    let shift = Vec4::splat(12_582_912.0);
    let near = (x + shift) - shift;
    Vec4::select(x.cmplt(near), near - Vec4::ONE, near)
}

#[inline(always)]
fn lerp(a: Vec4, b: Vec4, weight: Real) -> Vec4 {
    a + (b - a) * weight
}

impl Lattice {
    pub fn new(
        dims: [usize; 3],
        periodic: [bool; 3],
        origin: Vector,
        spacing: Vector,
    ) -> Result<Self, Error> {
        for (n, h) in dims.into_iter().zip(spacing.to_array()) {
            Error::check(
                "nodes",
                n as f64,
                n > 0 && n as u64 <= MAX_NODES,
                "from 1 to 65536 along each axis",
            )?;
            Error::check_positive("spacing", h.into())?;
            Error::check_positive("1/spacing", (1.0 / h).into())?;
        }
        for x in origin.to_array() {
            Error::check_finite("origin", x.into())?;
        }
        let wraps: [bool; 3] = core::array::from_fn(|i| periodic[i] || dims[i] == 1);
        let stored: [usize; 3] = core::array::from_fn(|i| dims[i] + usize::from(wraps[i]));
        let all = stored.iter().map(|n| *n as f64).product::<f64>();
        Error::check(
            "nodes in all",
            all,
            all < f64::from(i32::MAX),
            "less than 2³¹",
        )?;
        let lanes = |value: &dyn Fn(usize) -> usize| {
            Vec4::new(value(0) as Real, value(1) as Real, value(2) as Real, 1.0)
        };
        let nodes = lanes(&|i| dims[i]);
        Ok(Self {
            dims,
            periodic,
            origin,
            spacing,
            stored,
            lanes: Lanes {
                origin: origin.extend(0.0),
                per_spacing: spacing.recip().extend(0.0),
                nodes,
                per_node: nodes.recip(),
                periodic: Vec4::from_array(core::array::from_fn(|i| {
                    f32::from(u8::from(i == 3 || wraps[i]))
                })),
                end: lanes(&|i| stored[i] - 1),
                last: lanes(&|i| stored[i] - 2),
            },
        })
    }

    pub(super) fn lanes(&self) -> &Lanes {
        &self.lanes
    }

    /// How far apart stored nodes are that are neighbors along y and z.
    pub(super) fn strides(&self) -> [u32; 2] {
        let [x, y, _] = self.stored;
        [x as u32, (x * y) as u32]
    }

    pub fn len(&self) -> usize {
        self.dims.iter().product()
    }

    /// Nodes as they are stored, from nodes with x fastest.
    pub fn pad<T>(&self, node: impl Fn(usize) -> T) -> Vec<T> {
        let [nx, ny, nz] = self.dims;
        let [sx, sy, sz] = self.stored;
        let mut nodes = Vec::with_capacity(sx * sy * sz);
        for k in 0..sz {
            for j in 0..sy {
                let row = (k % nz * ny + j % ny) * nx;
                nodes.extend((0..sx).map(|i| node(row + i % nx)));
            }
        }
        nodes
    }

    /// The stored nodes without padding, x fastest.
    pub fn unpad<'a, T>(&self, nodes: &'a [T]) -> impl Iterator<Item = &'a T> + use<'a, T> {
        let ([nx, ny, nz], [sx, sy, _]) = (self.dims, self.stored);
        (0..nz)
            .flat_map(move |k| (0..ny).flat_map(move |j| nodes[(k * sy + j) * sx..][..nx].iter()))
    }

    /// The cell around a point (the fourth lane is ignored). Its nodes are never out of bounds, and
    /// its weights never NaN, whatever the point is.
    #[inline(always)]
    pub fn locate(&self, point: Vec4) -> Cell {
        let lanes = &self.lanes;
        let x = (point - lanes.origin) * lanes.per_spacing;
        let turns = (x * lanes.per_node).clamp(Vec4::splat(-FAR), Vec4::splat(FAR));
        let wrapped = (turns - floor(turns)) * lanes.nodes;
        let x =
            Vec4::select(lanes.periodic.cmpgt(Vec4::ZERO), wrapped, x).clamp(Vec4::ZERO, lanes.end);
        let below = floor(x).min(lanes.last);
        let weight = (x - below).max(Vec4::ZERO);
        let [i, j, k, _] = below.to_array().map(|x| x as i32 as usize);
        let [sx, sy, _] = self.stored;
        let low = (k * sy + j) * sx + i;
        let high = low + sy * sx;
        Cell {
            rows: [low, low + sx, high, high + sx],
            weight,
            flat: self.dims[2] == 1,
        }
    }

    /// Value inside `cell` of `nodes`, each seen through `at`.
    #[inline(always)]
    pub fn value<T>(&self, cell: &Cell, nodes: &[T], at: impl Fn(&T) -> Vec4) -> Vec4 {
        let w = cell.weight;
        let line = |row: usize| {
            let pair = &nodes[row..row + 2];
            lerp(at(&pair[0]), at(&pair[1]), w.x)
        };
        let [a, b, c, d] = cell.rows;
        let low = lerp(line(a), line(b), w.y);
        if cell.flat {
            low
        } else {
            lerp(low, lerp(line(c), line(d), w.y), w.z)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn circle_and_period_agree_with_the_library() {
        for i in -2000..2000 {
            let turns = f64::from(i) * 0.001_7;
            let [cos, sin] = cos_sin(turns);
            let (s, c) = (turns * core::f64::consts::TAU).sin_cos();
            // The first term left out is (π/4)¹⁰/10! = 2.5e-8, and f32 rounds by 3e-8.
            assert!((f64::from(cos) - c).abs() < 1.0e-7, "{turns}");
            assert!((f64::from(sin) - s).abs() < 1.0e-7, "{turns}");
            let x = f64::from(i) * 0.37;
            let miss = wrap(x, 2.5) - x.rem_euclid(2.5);
            assert!(
                miss.abs() < 1.0e-9 || (miss + 2.5).abs() < 1.0e-9,
                "{x}: {miss}"
            );
        }
        for wild in [1.0e18, -1.0e300, f64::INFINITY, f64::NAN] {
            assert_eq!(cos_sin(wild), [1.0, 0.0]);
            assert_eq!(wrap(wild, 2.5), 0.0);
        }
    }
}
