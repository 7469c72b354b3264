//! A surface that was computed or measured elsewhere, sampled in space and time.

use super::{Elevation, FreeSurface};
use crate::error::Error;
use crate::file::{FileKind, Reader, Writer};
use crate::math;
use rapier3d::na::Vector3;

/// Where and when the heights of a [`HeightField`] are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightGrid {
    /// Nodes along x and z. Along an axis with one node the surface is level.
    pub nodes: [usize; 2],
    /// Distance between neighbors along x and z, m.
    pub spacing: [f64; 2],
    /// Where the first node is, x and z, m. Default the origin.
    pub origin: [f64; 2],
    /// Whether node n along x and z is node 0 again. Otherwise, beyond the grid, the surface goes on as high as the
    /// nearest node; it bends to that within one more cell. Default neither.
    pub periodic: [bool; 2],
    /// Samples in time. Default 1.
    pub frames: usize,
    /// Time between them, s. The first is at time 0, and stands before. Default 1.
    pub interval: f64,
    /// Whether frame n is frame 0 again. Otherwise the last one stands. Default false.
    pub repeats: bool,
    /// Depth below the surface, m, over which the water's velocity falls to 1/e; infinite if the water moves alike down to
    /// the bottom. For waves it is the wavelength over 2π. Default 1.
    pub decay: f64,
}

impl Default for HeightGrid {
    fn default() -> Self {
        Self {
            nodes: [1; 2],
            spacing: [1.0; 2],
            origin: [0.0; 2],
            periodic: [false; 2],
            frames: 1,
            interval: 1.0,
            repeats: false,
            decay: 1.0,
        }
    }
}

/// Most nodes along an axis, and most frames.
const MOST: u64 = 1 << 16;

/// Spacings (m) and intervals (s) that neither over- nor underflow.
const SHORTEST: f64 = 1e-6;
const LONGEST: f64 = 1e9;

impl HeightGrid {
    fn check(&self) -> Result<(), Error> {
        let many = |n: usize| (1..=MOST as usize).contains(&n);
        for axis in 0..2 {
            let n = self.nodes[axis];
            Error::check(
                "nodes",
                n as f64,
                many(n),
                "from 1 to 65536 along each axis",
            )?;
            Error::check_range("spacing", self.spacing[axis], SHORTEST, LONGEST)?;
            Error::check_finite("origin", self.origin[axis])?;
        }
        Error::check(
            "frames",
            self.frames as f64,
            many(self.frames),
            "from 1 to 65536",
        )?;
        Error::check_range("interval", self.interval, SHORTEST, LONGEST)?;
        let requirement = "positive (infinite for water that moves alike at every depth)";
        Error::check("decay", self.decay, self.decay > 0.0, requirement)?;
        Ok(())
    }

    /// Heights that there have to be.
    fn len(&self) -> usize {
        self.nodes[0] * self.nodes[1] * self.frames
    }

    /// The four nodes around a place along each axis and in time.
    fn locate(&self, x: f64, z: f64, time: f64) -> [Four; 3] {
        let of = |v: f64, origin: f64, spacing: f64, n: usize, wraps: bool| {
            Four::new((v - origin) / spacing, n, wraps)
        };
        let along = |axis: usize, v: f64| {
            let (origin, spacing) = (self.origin[axis], self.spacing[axis]);
            of(v, origin, spacing, self.nodes[axis], self.periodic[axis])
        };
        let frame = of(time, 0.0, self.interval, self.frames, self.repeats);
        [along(0, x), along(1, z), frame]
    }
}

/// Four nodes in a row, with their weights (Catmull and Rom 1974) and the weights of the derivative per spacing.
struct Four {
    nodes: [usize; 4],
    weights: [f64; 4],
    slopes: [f64; 4],
}

impl Four {
    /// Around a position between nodes; what is not finite counts as zero.
    fn new(position: f64, nodes: usize, wraps: bool) -> Self {
        let n = nodes as f64;
        let position = match position.is_finite() {
            true if wraps => position - n * (position / n).floor(),
            true => position.clamp(-2.0, n + 1.0),
            false => 0.0,
        };
        let (whole, t) = (position.floor(), position - position.floor());
        let node = |i: usize| {
            let at = whole as i64 + i as i64 - 1;
            let n = nodes as i64;
            (if wraps {
                at.rem_euclid(n)
            } else {
                at.clamp(0, n - 1)
            }) as usize
        };
        if nodes == 1 {
            return Self {
                nodes: [0; 4],
                weights: [0.0, 1.0, 0.0, 0.0],
                slopes: [0.0; 4],
            };
        }
        Self {
            nodes: core::array::from_fn(node),
            weights: [
                0.5 * t * (-1.0 + t * (2.0 - t)),
                1.0 + 0.5 * t * t * (3.0 * t - 5.0),
                0.5 * t * (1.0 + t * (4.0 - 3.0 * t)),
                0.5 * t * t * (t - 1.0),
            ],
            slopes: [
                0.5 * (-1.0 + t * (4.0 - 3.0 * t)),
                0.5 * t * (9.0 * t - 10.0),
                0.5 * (1.0 + t * (8.0 - 9.0 * t)),
                0.5 * t * (3.0 * t - 2.0),
            ],
        }
    }

    /// Nodes that count, with weight and weight of the derivative.
    fn iter(&self) -> impl Iterator<Item = (usize, f64, f64)> + '_ {
        let all = (0..4).map(|i| (self.nodes[i], self.weights[i], self.slopes[i]));
        all.filter(|(_, weight, slope)| *weight != 0.0 || *slope != 0.0)
    }
}

/// No weighted mean of four nodes along one axis is larger than this times the largest of them.
const OVERSHOOT: f64 = 1.25;

/// A surface given by heights at the nodes of a grid at equal times.
///
/// Between nodes and between frames the heights are cubic (Catmull and Rom), so that slope and rise never jump,
/// and pass through what was given. The water at the surface rises with it, w = ∂η/∂t + u·∇η, where u is its level velocity, if
/// [given](Self::with_velocities), else zero. Below, both fall as e^(y/[decay](HeightGrid::decay)).
///
/// ```
/// use rapier3d_immersed::free_surface::{FreeSurface, HeightField, HeightGrid};
///
/// // A standing wave in a basin of 8 m, one node per meter and ten frames a period of 2 s.
/// let grid = HeightGrid { nodes: [9, 1], frames: 10, interval: 0.2, repeats: true, ..HeightGrid::default() };
/// let heights = (0..90).map(|i| {
///     let (x, t) = ((i % 9) as f32, (i / 9) as f32 * 0.2);
///     0.1 * (std::f32::consts::PI * x / 8.0).cos() * (std::f32::consts::PI * t).cos()
/// });
/// let basin = HeightField::new(grid, heights.collect())?;
/// assert!((basin.elevation(0.0, 0.0, 2.0).height - 0.1).abs() < 1e-6);
/// assert!((basin.elevation(2.5, 3.0, 0.25).height - 0.0393).abs() < 2e-3);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct HeightField {
    grid: HeightGrid,
    heights: Vec<f32>,
    /// Of the water at the surface along x and z; empty if none was given.
    velocities: Vec<[f32; 2]>,
    highest: f64,
}

const FILE: FileKind = FileKind {
    name: "height field",
    magic: *b"R3IFHGHT",
    version: 1,
};

impl HeightField {
    /// A surface of these heights (m): that of node (i, j) of frame k, at `origin + (i, j)·spacing` and `k·interval`, has
    /// number (k·nz + j)·nx + i.
    ///
    /// # Errors
    /// If there are not as many heights as nodes, one is not finite, a spacing or interval not from 10⁻⁶ to 10⁹, a decay not positive, or a
    /// number of nodes or frames not from 1 to 65,536.
    pub fn new(grid: HeightGrid, heights: Vec<f32>) -> Result<Self, Error> {
        grid.check()?;
        Error::check_length("heights", grid.len(), heights.len())?;
        check_finite("heights", &heights)?;
        let [nx, nz] = grid.nodes;
        let cubic = [nx, nz, grid.frames].iter().filter(|n| **n > 1).count();
        let largest = heights
            .iter()
            .fold(0.0, |most, height| height.abs().max(most));
        Ok(Self {
            grid,
            heights,
            velocities: Vec::new(),
            highest: f64::from(largest) * OVERSHOOT.powi(cubic as i32),
        })
    }

    /// With level velocities of the water at the surface (m/s along x and z), in the order of the heights.
    ///
    /// # Errors
    /// If there are not as many as heights, or one is not finite.
    pub fn with_velocities(mut self, velocities: Vec<[f32; 2]>) -> Result<Self, Error> {
        Error::check_length("velocities", self.heights.len(), velocities.len())?;
        check_finite("velocities", velocities.as_flattened())?;
        self.velocities = velocities;
        Ok(self)
    }

    /// Reads heights from text: in each row those along x, separated by commas, semicolons or spaces; one row per node
    /// along z; frame after frame. Empty rows and what follows `#` are left out.
    ///
    /// # Errors
    /// [`Error::UnreadableRow`] names a row that has not `nodes[0]` numbers; those of [`HeightField::new`].
    pub fn from_csv(grid: HeightGrid, text: &str) -> Result<Self, Error> {
        grid.check()?;
        let rows = text
            .lines()
            .map(|line| line.split('#').next().unwrap_or_default().trim());
        let mut heights = Vec::new();
        for (row, line) in rows.filter(|line| !line.is_empty()).enumerate() {
            let cells = line.split(|c: char| c == ',' || c == ';' || c.is_whitespace());
            let numbers = cells.filter(|cell| !cell.is_empty()).map(str::parse);
            let numbers: Option<Vec<f32>> = numbers.collect::<Result<_, _>>().ok();
            match numbers {
                Some(numbers) if numbers.len() == grid.nodes[0] => heights.extend(numbers),
                _ => {
                    return Err(Error::UnreadableRow {
                        row: row + 1,
                        text: line.to_owned(),
                    });
                }
            }
        }
        Self::new(grid, heights)
    }

    /// Reads heights from bytes that are nothing but little-endian `f32`, in the order of [`HeightField::new`].
    ///
    /// # Errors
    /// If the number of bytes is not four times that of the nodes; those of [`HeightField::new`].
    pub fn from_raw(grid: HeightGrid, bytes: &[u8]) -> Result<Self, Error> {
        grid.check()?;
        Error::check_length("bytes of heights", 4 * grid.len(), bytes.len())?;
        let (numbers, _) = bytes.as_chunks();
        Self::new(
            grid,
            numbers.iter().copied().map(f32::from_le_bytes).collect(),
        )
    }

    /// Where and when the heights are.
    pub fn grid(&self) -> &HeightGrid {
        &self.grid
    }

    /// The heights, m, in the order of [`HeightField::new`].
    pub fn heights(&self) -> &[f32] {
        &self.heights
    }

    /// The bytes of a file: magic (8 bytes), version (`u32`), length and FNV-1a checksum of the rest (`u64`), then the
    /// numbers of nodes and frames, a bit mask (periodic along x, along z, in time; with velocities) (`u64`), origin, spacing,
    /// interval, decay or 0 for infinite (`f64`), heights, velocities (`f32`); all little-endian.
    ///
    /// ```
    /// use rapier3d_immersed::free_surface::{HeightField, HeightGrid};
    ///
    /// let step = HeightField::new(HeightGrid { nodes: [2, 1], ..HeightGrid::default() }, vec![0.0, 0.5])?;
    /// let bytes = step.to_bytes(); // std::fs::write(path, &bytes)
    /// assert_eq!(HeightField::from_bytes(&bytes)?, step);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn to_bytes(&self) -> Vec<u8> {
        let grid = &self.grid;
        let mut file = Writer::default();
        for n in [grid.nodes[0], grid.nodes[1], grid.frames] {
            file.u64(n as u64);
        }
        let [along_x, along_z] = grid.periodic;
        let bits = [along_x, along_z, grid.repeats, !self.velocities.is_empty()];
        file.u64((0..4).map(|i| u64::from(bits[i]) << i).sum());
        let decay = if grid.decay.is_finite() {
            grid.decay
        } else {
            0.0
        };
        for x in [grid.origin, grid.spacing, [grid.interval, decay]].as_flattened() {
            file.f64(*x);
        }
        for x in self.heights.iter().chain(self.velocities.as_flattened()) {
            file.f32(*x);
        }
        file.finish(&FILE)
    }

    /// Reads what [`HeightField::to_bytes`] wrote.
    ///
    /// # Errors
    /// If the bytes are no such file, of another version, truncated, altered, or hold values that [`HeightField::new`]
    /// refuses.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let mut file = Reader::new(&FILE, bytes)?;
        let [nx, nz, frames] = file.lengths("nodes and frames", MOST)?;
        let bits = file.length("bit mask", 15)?;
        let mut two = |parameter| Ok::<_, Error>([file.f64(parameter)?, file.f64(parameter)?]);
        let (origin, spacing) = (two("origin")?, two("spacing")?);
        let [interval, decay] = two("interval and decay")?;
        let grid = HeightGrid {
            nodes: [nx, nz],
            spacing,
            origin,
            periodic: [bits & 1 != 0, bits & 2 != 0],
            frames,
            interval,
            repeats: bits & 4 != 0,
            decay: if decay == 0.0 { f64::INFINITY } else { decay },
        };
        let moves = bits & 8 != 0;
        let count = [nx, nz, frames].iter().map(|n| *n as u64).product::<u64>();
        file.expect_rest(count * if moves { 12 } else { 4 })?;
        let mut heights = Vec::with_capacity(count as usize);
        for _ in 0..count {
            heights.push(file.f32("height")?);
        }
        let field = Self::new(grid, heights)?;
        if !moves {
            return Ok(field);
        }
        let mut velocities = Vec::with_capacity(count as usize);
        for _ in 0..count {
            velocities.push([file.f32("velocity")?, file.f32("velocity")?]);
        }
        field.with_velocities(velocities)
    }

    /// The sum over the nodes around a place of what `add` makes of their numbers and weights: along x and z and in time.
    #[inline(always)]
    fn around(&self, [x, z, time]: &[Four; 3], mut add: impl FnMut(usize, [[f64; 2]; 3])) {
        let [nx, nz] = self.grid.nodes;
        for (k, weight_k, slope_k) in time.iter() {
            for (j, weight_j, slope_j) in z.iter() {
                let row = (k * nz + j) * nx;
                for (i, weight_i, slope_i) in x.iter() {
                    let weights = [
                        [weight_i, slope_i],
                        [weight_j, slope_j],
                        [weight_k, slope_k],
                    ];
                    add(row + i, weights);
                }
            }
        }
    }

    /// The elevation and how fast it grows at a place.
    fn surface(&self, around: &[Four; 3]) -> (Elevation, f64) {
        let mut sums = [0.0; 4];
        self.around(around, |node, [[x, dx], [z, dz], [t, dt]]| {
            let height = f64::from(self.heights[node]);
            for (sum, weight) in
                sums.iter_mut()
                    .zip([x * z * t, dx * z * t, x * dz * t, x * z * dt])
            {
                *sum += height * weight;
            }
        });
        let [height, along_x, along_z, rise] = sums;
        let [dx, dz] = self.grid.spacing;
        let slope = [along_x / dx, along_z / dz];
        (Elevation { height, slope }, rise / self.grid.interval)
    }
}

/// An error that names the first number that is not finite.
fn check_finite(what: &'static str, numbers: &[f32]) -> Result<(), Error> {
    match numbers.iter().position(|x| !x.is_finite()) {
        None => Ok(()),
        Some(index) => Err(Error::NotFinite {
            what,
            index,
            value: numbers[index].into(),
        }),
    }
}

impl FreeSurface for HeightField {
    fn elevation(&self, x: f64, z: f64, time: f64) -> Elevation {
        self.surface(&self.grid.locate(x, z, time)).0
    }

    fn velocity(&self, point: &Vector3<f64>, time: f64) -> Vector3<f64> {
        let around = self.grid.locate(point.x, point.z, time);
        let (surface, rise) = self.surface(&around);
        let mut level = [0.0; 2];
        if !self.velocities.is_empty() {
            self.around(&around, |node, [[x, _], [z, _], [t, _]]| {
                let [u, w] = self.velocities[node].map(f64::from);
                level[0] += u * (x * z * t);
                level[1] += w * (x * z * t);
            });
        }
        let up = rise + level[0] * surface.slope[0] + level[1] * surface.slope[1];
        // What is above the surface moves like the surface.
        let decay = math::exp((point.y - surface.height).min(0.0) / self.grid.decay);
        Vector3::new(level[0], up, level[1]) * decay
    }

    fn highest(&self) -> f64 {
        self.highest
    }

    /// Four cells, the shortest wave that a grid shows.
    fn bend(&self) -> f64 {
        let HeightGrid { nodes, spacing, .. } = self.grid;
        let axes = (0..2).filter(|axis| nodes[*axis] > 1);
        axes.fold(f64::INFINITY, |bend, axis| bend.min(4.0 * spacing[axis]))
    }

    fn is_still(&self) -> bool {
        self.grid.frames == 1 && self.velocities.as_flattened().iter().all(|v| *v == 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> HeightGrid {
        HeightGrid {
            nodes: [5, 4],
            spacing: [0.5, 0.25],
            origin: [-1.0, 2.0],
            frames: 3,
            interval: 0.1,
            ..HeightGrid::default()
        }
    }

    fn heights(count: usize) -> Vec<f32> {
        (0..count).map(|i| (i as f32 * 1.7).sin()).collect()
    }

    fn error(result: Result<HeightField, Error>) -> String {
        result.unwrap_err().to_string()
    }

    #[test]
    fn impossible_fields_are_named() {
        let new = |change: &dyn Fn(&mut HeightGrid)| {
            let mut grid = grid();
            change(&mut grid);
            error(HeightField::new(grid, heights(60)))
        };
        assert!(new(&|grid| grid.nodes = [0, 4]).starts_with("nodes"));
        assert!(new(&|grid| grid.nodes = [5, 70_000]).starts_with("nodes"));
        assert!(new(&|grid| grid.nodes = [5, 5]).contains("60 given where 75 are needed"));
        assert!(new(&|grid| grid.frames = 0).starts_with("frames"));
        assert!(
            new(&|grid| grid.spacing[1] = 0.0)
                .contains("spacing must lie between 0.000001 and 1000000000, but is 0")
        );
        assert!(new(&|grid| grid.interval = -1.0).starts_with("interval"));
        assert!(new(&|grid| grid.decay = f64::NAN).starts_with("decay"));
        assert!(new(&|grid| grid.origin[0] = f64::INFINITY).starts_with("origin"));
        let mut bad = heights(60);
        bad[17] = f32::NAN;
        assert_eq!(
            error(HeightField::new(grid(), bad)),
            "heights: entry 17 is NaN"
        );
        let good = HeightField::new(grid(), heights(60)).unwrap();
        let few = good.clone().with_velocities(vec![[0.0; 2]; 59]);
        assert!(error(few).contains("59 given where 60"));
        let mut velocities = vec![[0.0; 2]; 60];
        velocities[3][1] = f32::INFINITY;
        assert_eq!(
            error(good.with_velocities(velocities)),
            "velocities: entry 7 is inf"
        );
    }

    #[test]
    fn text_and_bytes_hold_the_same_heights() {
        let grid = HeightGrid {
            nodes: [3, 2],
            ..HeightGrid::default()
        };
        let numbers = vec![0.0, 0.5, 1.0, -1.0, 2e-1, 7.0];
        let field = HeightField::new(grid, numbers.clone()).unwrap();
        let text = "# z = 0\n0, .5, 1\n\n-1; 0.2 7 # z = 1\n";
        assert_eq!(HeightField::from_csv(grid, text).unwrap(), field);
        let raw: Vec<u8> = numbers.iter().flat_map(|x: &f32| x.to_le_bytes()).collect();
        assert_eq!(HeightField::from_raw(grid, &raw).unwrap(), field);
        assert!(error(HeightField::from_raw(grid, &raw[1..])).contains("23 given where 24"));
        let row = "row 2 of the table cannot be read: \"1, x, 3\"";
        assert_eq!(error(HeightField::from_csv(grid, "0,0,0\n1, x, 3")), row);
        assert!(error(HeightField::from_csv(grid, "0,0\n1,2,3")).starts_with("row 1"));
        assert!(error(HeightField::from_csv(grid, "0,0,0")).contains("3 given where 6"));
        let nan = error(HeightField::from_csv(grid, "0,0,0\n1,NaN,3"));
        assert_eq!(nan, "heights: entry 4 is NaN");
    }

    #[test]
    fn files_come_back_whole_or_not_at_all() {
        let still = HeightField::new(grid(), heights(60)).unwrap();
        let endless = HeightGrid {
            decay: f64::INFINITY,
            periodic: [true, false],
            repeats: true,
            ..grid()
        };
        let moving = HeightField::new(endless, heights(60)).unwrap();
        let moving = moving.with_velocities(vec![[0.5, -1.0]; 60]).unwrap();
        for field in [still, moving] {
            let bytes = field.to_bytes();
            assert_eq!(HeightField::from_bytes(&bytes).unwrap(), field);
            for length in 0..bytes.len() {
                assert!(
                    HeightField::from_bytes(&bytes[..length]).is_err(),
                    "{length}"
                );
            }
            for byte in 0..bytes.len() {
                let mut altered = bytes.clone();
                altered[byte] ^= 0x40;
                assert!(HeightField::from_bytes(&altered).is_err(), "{byte}");
            }
        }
    }

    /// No four weights, of whatever sign the heights are, exceed the bound, which is reached half way.
    #[test]
    fn overshoot_is_bounded() {
        let most = (0..=1000).map(|i| {
            let four = Four::new(1.0 + f64::from(i) / 1000.0, 5, false);
            assert!((four.weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            assert!(four.slopes.iter().sum::<f64>().abs() < 1e-15);
            four.weights.iter().map(|w| w.abs()).sum::<f64>()
        });
        let most = most.fold(0.0, f64::max);
        assert!(
            most <= OVERSHOOT + 1e-15 && most > 0.999 * OVERSHOOT,
            "{most}"
        );
    }
}
