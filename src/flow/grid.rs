//! A flow sampled on a grid, in memory or from a file.

use super::{Flow, FlowSample, alone, cells::Cells, lattice::Lattice, lattice::MAX_NODES};
use crate::error::Error;
use crate::file::{FileKind, Reader, Writer};
use crate::math::{Lanes, OnLanes, Row, dispatch};
use fearless_simd::{Simd, SimdBase};
use rapier3d::glamx::Vec4;
use rapier3d::math::Vector;

/// A steady flow given at the nodes of a regular grid, trilinear between them.
///
/// Outside, the flow is that of the nearest node, or repeats along the periodic axes. The vorticity
/// is that of the interpolated field: piecewise, and as coarse as the grid.
///
/// ```
/// use rapier3d_immersed::flow::{Flow, GridFlow};
/// use rapier3d_immersed::rapier3d::prelude::*;
///
/// // Two nodes along x, a meter apart; along y and z the flow is uniform.
/// let velocities = [Vector::ZERO, Vector::Y * 2.0];
/// let clamped = [false; 3];
/// let flow = GridFlow::new([2, 1, 1], clamped, Vector::ZERO, Vector::ONE, &velocities)?;
/// assert_eq!(flow.velocity(Vector::X * 0.5, 0.0), Vector::Y);
/// assert_eq!(flow.velocity(Vector::X * 9.0, 0.0), Vector::Y * 2.0);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct GridFlow {
    lattice: Lattice,
    nodes: Vec<Row>,
    /// Velocity with which the whole pattern is carried along, m/s (Taylor's frozen field). It does
    /// not change the node velocities, to which you add the mean wind yourself.
    pub drift: Vector,
}

const FILE: FileKind = FileKind {
    name: "grid flow",
    magic: *b"R3IFGRID",
    version: 1,
};

impl GridFlow {
    /// A flow through `velocities` (m/s, world axes): node (i, j, k) is at `origin + (i, j, k)·spacing`
    /// (m) and has number (k·ny + j)·nx + i. An axis with one node is uniform. Along a `periodic`
    /// axis, node n is node 0 again.
    ///
    /// # Errors
    /// If a dimension is 0, the number of velocities is not the product of `dims`, a spacing is not
    /// positive, or a number is not finite.
    pub fn new(
        dims: [usize; 3],
        periodic: [bool; 3],
        origin: Vector,
        spacing: Vector,
        velocities: &[Vector],
    ) -> Result<Self, Error> {
        let lattice = Lattice::new(dims, periodic, origin, spacing)?;
        Error::check(
            "number of velocities",
            velocities.len() as f64,
            velocities.len() == lattice.len(),
            "the product of the grid's dimensions",
        )?;
        for x in velocities.iter().flat_map(|velocity| velocity.to_array()) {
            Error::check_finite("velocity", x.into())?;
        }
        let nodes = lattice.pad(|node| velocities[node].extend(0.0).to_array());
        Ok(Self {
            lattice,
            nodes,
            drift: Vector::ZERO,
        })
    }

    /// Samples `flow` at the nodes of a grid: a costly flow of your own turned into a cheap one.
    ///
    /// # Errors
    /// Those of [`GridFlow::new`], also if `flow` returns a velocity that is not finite.
    ///
    /// ```
    /// use rapier3d_immersed::flow::{Flow, GridFlow, Vortex};
    /// use rapier3d_immersed::rapier3d::prelude::*;
    ///
    /// let vortex = Vortex::new(Vector::ZERO, Vector::Z, 1.0, 0.5)?;
    /// let (corner, spacing) = (Vector::new(-2.0, -2.0, 0.0), Vector::splat(0.05));
    /// let grid = GridFlow::sampled(&vortex, 0.0, [81, 81, 1], [false; 3], corner, spacing)?;
    /// let between = Vector::new(0.97, 0.33, 5.0); // no node is here
    /// let error = grid.velocity(between, 0.0) - vortex.velocity(between, 0.0);
    /// assert!(error.length() < 1e-3);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn sampled(
        flow: &dyn Flow,
        time: f64,
        dims: [usize; 3],
        periodic: [bool; 3],
        origin: Vector,
        spacing: Vector,
    ) -> Result<Self, Error> {
        let lattice = Lattice::new(dims, periodic, origin, spacing)?;
        let velocities: Vec<_> = (0..lattice.len())
            .map(|node| {
                let (row, i) = (node / dims[0], node % dims[0]);
                let (k, j) = (row / dims[1], row % dims[1]);
                let index = Vector::new(i as f32, j as f32, k as f32);
                flow.velocity(origin + index * spacing, time)
            })
            .collect();
        Self::new(dims, periodic, origin, spacing, &velocities)
    }

    /// Number of nodes along each axis.
    pub fn dims(&self) -> [usize; 3] {
        self.lattice.dims
    }

    /// Velocities at the nodes, m/s, in the order of [`GridFlow::new`].
    pub fn velocities(&self) -> impl Iterator<Item = Vector> + '_ {
        self.lattice
            .unpad(&self.nodes)
            .map(|node| Vector::new(node[0], node[1], node[2]))
    }

    /// The bytes of a file: magic (8 bytes), version (`u32`), length and FNV-1a checksum of the rest (`u64`),
    /// then the dimensions and a bit mask of periodic axes (`u64`), origin, spacing, drift (`f64`),
    /// velocities (`f32`); all little-endian.
    ///
    /// ```
    /// use rapier3d_immersed::flow::GridFlow;
    /// use rapier3d_immersed::rapier3d::prelude::*;
    ///
    /// let flow = GridFlow::new([1; 3], [true; 3], Vector::ZERO, Vector::ONE, &[Vector::X])?;
    /// let bytes = flow.to_bytes(); // std::fs::write(path, &bytes)
    /// assert_eq!(GridFlow::from_bytes(&bytes)?, flow);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut file = Writer::default();
        for n in self.lattice.dims {
            file.u64(n as u64);
        }
        let mask = (0..3).fold(0, |mask, i| mask | u64::from(self.lattice.periodic[i]) << i);
        file.u64(mask);
        for vector in [self.lattice.origin, self.lattice.spacing, self.drift] {
            for x in vector.to_array() {
                file.f64(x.into());
            }
        }
        for velocity in self.velocities() {
            for x in velocity.to_array() {
                file.f32(x);
            }
        }
        file.finish(&FILE)
    }

    /// Reads what [`GridFlow::to_bytes`] wrote.
    ///
    /// # Errors
    /// If the bytes are no such file, of another version, truncated, altered, or hold values that
    /// [`GridFlow::new`] refuses.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let mut file = Reader::new(&FILE, bytes)?;
        let dims = file.lengths("nodes", MAX_NODES)?;
        let mask = file.length("periodic axes", 7)?;
        let periodic = [mask & 1 != 0, mask & 2 != 0, mask & 4 != 0];
        let (origin, spacing, drift) = (
            file.vector("origin")?,
            file.vector("spacing")?,
            file.vector("drift")?,
        );
        let count = dims.iter().map(|n| *n as u64).product::<u64>();
        file.expect_rest(count * 12)?;
        let mut velocities = Vec::with_capacity(count as usize);
        for _ in 0..count {
            velocities.push(Vector::new(
                file.f32("velocity")?,
                file.f32("velocity")?,
                file.f32("velocity")?,
            ));
        }
        let mut flow = Self::new(dims, periodic, origin, spacing, &velocities)?;
        flow.drift = drift;
        Ok(flow)
    }

    /// How far the pattern has been carried, m; wrapped in `f64`, so that it stays precise for as
    /// long as the flow lasts.
    #[inline(always)]
    fn carried(&self, time: f64) -> Vector {
        if self.drift == Vector::ZERO {
            return Vector::ZERO;
        }
        let wrap = |axis: usize, drift: f32| {
            let way = f64::from(drift) * time;
            if self.lattice.periodic[axis] {
                let period = self.lattice.dims[axis] as f64
                    * f64::from(self.lattice.spacing.to_array()[axis]);
                super::lattice::wrap(way, period) as f32
            } else {
                way as f32
            }
        };
        Vector::new(
            wrap(0, self.drift.x),
            wrap(1, self.drift.y),
            wrap(2, self.drift.z),
        )
    }
}

impl Flow for GridFlow {
    fn velocity(&self, point: Vector, time: f64) -> Vector {
        let cell = self
            .lattice
            .locate((point - self.carried(time)).extend(0.0));
        self.lattice
            .value(&cell, &self.nodes, |node| Vec4::from_array(*node))
            .truncate()
    }

    fn vorticity(&self, point: Vector, time: f64) -> Vector {
        alone(self, point, time).vorticity
    }

    fn sample(&self, points: &[Vector], time: f64, samples: &mut [FlowSample]) {
        dispatch(Batch {
            flow: self,
            carried: self.carried(time),
            points,
            samples,
        });
    }
}

/// A batch of points, to be looked up in lanes.
struct Batch<'a> {
    flow: &'a GridFlow,
    carried: Vector,
    points: &'a [Vector],
    samples: &'a mut [FlowSample],
}

impl OnLanes for Batch<'_> {
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let cells = Cells::new(simd, &self.flow.lattice);
        let carried = [self.carried.x, self.carried.y, self.carried.z];
        let [a, b, c] = carried.map(|way| Lanes::splat(simd, way));
        let groups = self.points.chunks(Lanes::<S>::COUNT);
        for (points, samples) in groups.zip(self.samples.chunks_mut(Lanes::<S>::COUNT)) {
            let [x, y, z, _] = Lanes::points(simd, points);
            let found = cells.locate([x - a, y - b, z - c]);
            for (lane, sample) in samples.iter_mut().enumerate() {
                let jet = cells.jet(&found, lane, &self.flow.nodes);
                let value = jet.value.as_slice();
                sample.velocity = Vector::new(value[0], value[1], value[2]);
                sample.vorticity = jet.curl();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::{Shear, Vortex, tests::assert_curl_matches};

    fn shear_grid() -> GridFlow {
        let shear = Shear {
            velocity: Vector::new(1.0, -2.0, 0.5),
            across: Vector::Z,
            rate: Vector::new(0.5, 1.5, 0.0),
            ..Shear::default()
        };
        let origin = Vector::new(-2.0, -1.0, -1.5);
        let spacing = Vector::new(0.5, 1.0, 0.75);
        GridFlow::sampled(&shear, 0.0, [9, 5, 6], [false; 3], origin, spacing).unwrap()
    }

    /// Trilinear interpolation is exact for a linear field, and its curl is the field's.
    #[test]
    fn linear_flow_is_reproduced_and_clamped() {
        let grid = shear_grid();
        for (x, y, z) in [(0.1, 0.2, 0.3), (-1.9, 2.9, 2.2), (0.0, 0.0, 0.0)] {
            let point = Vector::new(x, y, z);
            let exact = Vector::new(1.0 + 0.5 * z, -2.0 + 1.5 * z, 0.5);
            assert!((grid.velocity(point, 0.0) - exact).length() < 1.0e-5);
            assert_curl_matches(&grid, point, 0.0);
        }
        let edge = grid.velocity(Vector::new(0.0, 0.0, 2.25), 0.0);
        assert!((grid.velocity(Vector::new(0.0, 0.0, 99.0), 0.0) - edge).length() < 1.0e-6);
        assert!(
            grid.velocity(Vector::new(1.0e30, -1.0e30, 0.0), 0.0)
                .is_finite()
        );
    }

    #[test]
    fn periodic_flow_repeats_and_drifts() {
        let vortex = Vortex::new(Vector::ONE * 2.0, Vector::Z, 1.0, 0.8).unwrap();
        let mut grid = GridFlow::sampled(
            &vortex,
            0.0,
            [8, 8, 1],
            [true; 3],
            Vector::ZERO,
            Vector::ONE * 0.5,
        )
        .unwrap();
        let point = Vector::new(1.3, 3.9, 7.0);
        let here = grid.velocity(point, 0.0);
        for shift in [Vector::X * 4.0, Vector::Y * -8.0, Vector::Z * 3.3] {
            assert!((grid.velocity(point + shift, 0.0) - here).length() < 1.0e-5);
        }
        grid.drift = Vector::new(3.0, -1.0, 0.0);
        // After a whole number of periods of both axes nothing has changed, however long ago.
        let later = grid.velocity(point, 4.0e6);
        assert!((later - here).length() < 1.0e-5, "{later} {here}");
        let moved = grid.velocity(point + grid.drift * 0.7, 0.7);
        assert!((moved - here).length() < 1.0e-5);
    }

    #[test]
    fn files_come_back_whole_or_not_at_all() {
        let mut grid = shear_grid();
        grid.drift = Vector::X;
        let bytes = grid.to_bytes();
        assert_eq!(GridFlow::from_bytes(&bytes).unwrap(), grid);
        for length in 0..bytes.len() {
            assert!(GridFlow::from_bytes(&bytes[..length]).is_err(), "{length}");
        }
        for byte in 0..bytes.len() {
            let mut altered = bytes.clone();
            altered[byte] ^= 0x40;
            assert!(GridFlow::from_bytes(&altered).is_err(), "{byte}");
        }
        let mut longer = bytes.clone();
        longer.push(0);
        assert!(matches!(
            GridFlow::from_bytes(&longer),
            Err(Error::WrongFileLength { .. })
        ));
    }

    #[test]
    fn bad_grids_are_errors() {
        let new = |dims, spacing, velocities: &[Vector]| {
            GridFlow::new(dims, [false; 3], Vector::ZERO, spacing, velocities).is_err()
        };
        assert!(new([0, 1, 1], Vector::ONE, &[]));
        assert!(new([2, 1, 1], Vector::ONE, &[Vector::ZERO]));
        assert!(new([1, 1, 1], Vector::new(1.0, 0.0, 1.0), &[Vector::ZERO]));
        assert!(new([1, 1, 1], Vector::NAN, &[Vector::ZERO]));
        assert!(new([1, 1, 1], Vector::ONE, &[Vector::NAN]));
        assert!(!new([1, 1, 1], Vector::ONE, &[Vector::ONE]));
    }
}
