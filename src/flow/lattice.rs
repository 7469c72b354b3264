//! Trilinear interpolation on a regular lattice, clamped or periodic along each axis.

use crate::Error;
use rapier3d::glamx::Vec4;
use rapier3d::math::{Real, Vector};

/// Most nodes along one axis, so that products of three fit comfortably into `u64`.
pub(crate) const MAX_NODES: u64 = 1 << 16;

/// Where the nodes are. Node (i, j, k) is at `origin + (i, j, k)·spacing`.
///
/// Node values are stored [padded](Lattice::pad): every periodic or one-node axis has its first node once more
/// at its end, so that the nodes of a cell are always neighbors in memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lattice {
    pub dims: [usize; 3],
    pub periodic: [bool; 3],
    pub origin: Vector,
    pub spacing: Vector,
    per_spacing: Vector,
    stored: [usize; 3],
}

/// The cell around a point: the first nodes of its four rows and the position inside.
pub(crate) struct Cell {
    rows: [usize; 4],
    weight: Vector,
    flat: bool,
}

/// A value and its derivatives along the axes.
pub(crate) struct Jet {
    pub value: Vec4,
    pub dx: Vec4,
    pub dy: Vec4,
    pub dz: Vec4,
}

#[inline]
fn lerp(a: Vec4, b: Vec4, weight: Real) -> Vec4 {
    a + (b - a) * weight
}

/// What lies between 0 and 1, and 0 if it is NaN.
#[inline]
fn fraction(x: Real) -> Real {
    x.max(0.0).min(1.0)
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
        Ok(Self {
            dims,
            periodic,
            origin,
            spacing,
            per_spacing: spacing.recip(),
            stored: core::array::from_fn(|i| dims[i] + usize::from(periodic[i] || dims[i] == 1)),
        })
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

    /// Node below along one axis, and how far to the next. Never out of bounds, whatever `x` is.
    #[inline]
    fn bracket(&self, axis: usize, x: Real) -> (usize, Real) {
        let n = self.dims[axis];
        let last = self.stored[axis] - 2;
        let x = if self.periodic[axis] || n == 1 {
            // Without floor(), which is a function call on x86-64 without SSE 4.1.
            let turns = x / n as Real;
            let part = turns - turns as i32 as Real;
            (if part < 0.0 { part + 1.0 } else { part }) * n as Real
        } else {
            x
        };
        let below = (x.max(0.0) as u32 as usize).min(last);
        (below, fraction(x - below as Real))
    }

    #[inline]
    pub fn locate(&self, point: Vector) -> Cell {
        let x = (point - self.origin) * self.per_spacing;
        let (i, wx) = self.bracket(0, x.x);
        let (j, wy) = self.bracket(1, x.y);
        let [sx, sy, _] = self.stored;
        let flat = self.dims[2] == 1;
        let (k, wz) = if flat { (0, 0.0) } else { self.bracket(2, x.z) };
        let low = (k * sy + j) * sx + i;
        let high = low + sy * sx;
        Cell {
            rows: [low, low + sx, high, high + sx],
            weight: Vector::new(wx, wy, wz),
            flat,
        }
    }

    /// Value inside `cell` of `nodes`, each seen through `at`.
    #[inline]
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

    /// Value and gradient inside `cell`; beyond a clamped edge the gradient is the edge cell's.
    #[inline]
    pub fn jet<T>(&self, cell: &Cell, nodes: &[T], at: impl Fn(&T) -> Vec4) -> Jet {
        let w = cell.weight;
        let line = |row: usize| {
            let pair = &nodes[row..row + 2];
            let (a, b) = (at(&pair[0]), at(&pair[1]));
            (lerp(a, b, w.x), b - a)
        };
        let plane = |near: usize, far: usize| {
            let ((near, near_dx), (far, far_dx)) = (line(near), line(far));
            (lerp(near, far, w.y), lerp(near_dx, far_dx, w.y), far - near)
        };
        let scale = self.per_spacing;
        let (low, low_dx, low_dy) = plane(cell.rows[0], cell.rows[1]);
        if cell.flat {
            return Jet {
                value: low,
                dx: low_dx * scale.x,
                dy: low_dy * scale.y,
                dz: Vec4::ZERO,
            };
        }
        let (high, high_dx, high_dy) = plane(cell.rows[2], cell.rows[3]);
        Jet {
            value: lerp(low, high, w.z),
            dx: lerp(low_dx, high_dx, w.z) * scale.x,
            dy: lerp(low_dy, high_dy, w.z) * scale.y,
            dz: (high - low) * scale.z,
        }
    }
}

impl Jet {
    /// Curl of the first three components.
    #[inline]
    pub fn curl(&self) -> Vector {
        Vector::new(
            self.dy.z - self.dz.y,
            self.dz.x - self.dx.z,
            self.dx.y - self.dy.x,
        )
    }
}
