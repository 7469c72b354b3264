//! Trilinear interpolation on a regular lattice, clamped or periodic along each axis.

use crate::Error;
use rapier3d::glamx::Vec4;
use rapier3d::math::{Real, Vector};

/// Most nodes along one axis, so that products of three fit comfortably into `u64`.
pub(crate) const MAX_NODES: u64 = 1 << 16;

/// Where the nodes are. Node (i, j, k) is at `origin + (i, j, k)·spacing`, number (k·ny + j)·nx + i.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lattice {
    pub dims: [usize; 3],
    pub periodic: [bool; 3],
    pub origin: Vector,
    pub spacing: Vector,
    per_spacing: Vector,
}

/// The cell around a point: eight node numbers and the position inside.
pub(crate) struct Cell {
    nodes: [usize; 8],
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
        Ok(Self {
            dims,
            periodic,
            origin,
            spacing,
            per_spacing: spacing.recip(),
        })
    }

    pub fn len(&self) -> usize {
        self.dims.iter().product()
    }

    /// Nodes below and above along one axis, and how far between them. Never out of bounds,
    /// whatever `x` is; if it is NaN, so is the weight.
    fn bracket(&self, axis: usize, x: Real) -> (usize, usize, Real) {
        let n = self.dims[axis];
        if n == 1 {
            return (0, 0, 0.0);
        }
        if self.periodic[axis] {
            let turns = x / n as Real;
            let x = (turns - turns.floor()) * n as Real;
            let below = (x as usize).min(n - 1);
            let above = if below + 1 == n { 0 } else { below + 1 };
            (below, above, (x - below as Real).min(1.0))
        } else {
            let x = x.clamp(0.0, (n - 1) as Real);
            let below = (x as usize).min(n - 2);
            (below, below + 1, x - below as Real)
        }
    }

    #[inline]
    pub fn locate(&self, point: Vector) -> Cell {
        let x = (point - self.origin) * self.per_spacing;
        let (i, i1, wx) = self.bracket(0, x.x);
        let (j, j1, wy) = self.bracket(1, x.y);
        let (k, k1, wz) = self.bracket(2, x.z);
        let [nx, ny, nz] = self.dims;
        let row = |j: usize, k: usize| (k * ny + j) * nx;
        let rows = [row(j, k), row(j1, k), row(j, k1), row(j1, k1)];
        Cell {
            nodes: [
                rows[0] + i,
                rows[0] + i1,
                rows[1] + i,
                rows[1] + i1,
                rows[2] + i,
                rows[2] + i1,
                rows[3] + i,
                rows[3] + i1,
            ],
            weight: Vector::new(wx, wy, wz),
            flat: nz == 1,
        }
    }

    /// Value inside `cell`, of what is `at` each node.
    #[inline]
    pub fn value(&self, cell: &Cell, at: impl Fn(usize) -> Vec4) -> Vec4 {
        let (n, w) = (&cell.nodes, cell.weight);
        let plane = |n: &[usize]| {
            lerp(
                lerp(at(n[0]), at(n[1]), w.x),
                lerp(at(n[2]), at(n[3]), w.x),
                w.y,
            )
        };
        if cell.flat {
            plane(&n[..4])
        } else {
            lerp(plane(&n[..4]), plane(&n[4..]), w.z)
        }
    }

    /// Value and gradient inside `cell`; beyond a clamped edge the gradient is the edge cell's.
    #[inline]
    pub fn jet(&self, cell: &Cell, at: impl Fn(usize) -> Vec4) -> Jet {
        let (n, w) = (&cell.nodes, cell.weight);
        let plane = |n: &[usize]| {
            let (a, b, c, d) = (at(n[0]), at(n[1]), at(n[2]), at(n[3]));
            let (near, far) = (lerp(a, b, w.x), lerp(c, d, w.x));
            (lerp(near, far, w.y), lerp(b - a, d - c, w.y), far - near)
        };
        let scale = self.per_spacing;
        let (low, low_dx, low_dy) = plane(&n[..4]);
        if cell.flat {
            return Jet {
                value: low,
                dx: low_dx * scale.x,
                dy: low_dy * scale.y,
                dz: Vec4::ZERO,
            };
        }
        let (high, high_dx, high_dy) = plane(&n[4..]);
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
    pub fn curl(&self) -> Vector {
        Vector::new(
            self.dy.z - self.dz.y,
            self.dz.x - self.dx.z,
            self.dx.y - self.dy.x,
        )
    }
}
