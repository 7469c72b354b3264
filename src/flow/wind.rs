//! Gusty wind over ground: a log-law mean and a baked turbulent field carried along by it.

use super::cells::{Cells, Pair};
use super::lattice::{Lattice, MAX_NODES, cos_sin, fraction};
use super::{Flow, FlowSample, LogLaw, alone};
use crate::error::Error;
use crate::file::{FileKind, Reader, Writer};
use crate::math;
use crate::math::{Lanes, MOST_LANES, OnLanes, Row, Scalar, dispatch};
use fearless_simd::{Simd, SimdBase};
use rapier3d::glamx::Vec4;
use rapier3d::math::{Real, Vector};

/// How the gusts change with height.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HeightLaw {
    /// Gusts are as strong at every height above the reference height and fade like the mean wind below
    /// it: in the surface layer σ/u* does not depend on height (Kaimal et al. 1972). This is the default.
    #[default]
    SurfaceLayer,
    /// Gusts are in proportion to the mean wind at every height, thesis (3.18).
    Proportional,
}

/// Wind with gusts of a prescribed spectrum (thesis §3.5), looked up from one periodic field.
///
/// It is made by `SpectralWind::bake` (feature `bake`) or read from a file with
/// [`SpectralWind::from_bytes`].
///
/// The field is frozen and carried by the mean wind at the reference height (Taylor's hypothesis).
/// With an evolution time T it also turns over: two independent fields are mixed as
/// A cos(2πt/T) + B sin(2πt/T), which never jumps and whose expected variance is the same at every
/// instant.
/// A field one node high is a horizontal slice that is used at every height, as the thesis does.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectralWind {
    pub(super) mean: LogLaw,
    pub(super) axes: [Vector; 3],
    to_field: [Vec4; 3],
    to_world: [Vec4; 3],
    pub(super) reference_height: Real,
    pub(super) roughness: Real,
    pub(super) ground: Real,
    pub(super) mean_speed: f64,
    pub(super) evolution_time: f64,
    pub(super) height_law: HeightLaw,
    pub(super) lattice: Lattice,
    /// Fluctuations along the wind, across it and up, m/s, of both fields at each node.
    pub(super) nodes: Vec<Pair>,
    /// 1/ln(h₀/z₀), 1/z₀, and the largest strength of the gusts.
    per_log: Real,
    per_roughness: Real,
    cap: Real,
    /// Length of the field along the wind, m, and how many times a second the wind carries it past and
    /// how many times it turns over.
    length: f64,
    per_second: [f64; 2],
}

const FILE: FileKind = FileKind {
    name: "spectral wind",
    magic: *b"R3IFWIND",
    version: 1,
};

/// What all points share at one time.
struct Instant {
    carried: Vec4,
    mix: [Real; 2],
}

/// The wind's dependence on height.
struct Profile<T> {
    speed: T,
    shear: T,
    strength: T,
    growth: T,
}

impl SpectralWind {
    /// Assembles the run-time wind; every argument has been checked.
    #[allow(clippy::too_many_arguments)]
    pub(super) fn assemble(
        direction: Vector,
        up: Vector,
        mean_speed: f64,
        reference_height: Real,
        roughness: Real,
        ground: Real,
        evolution_time: f64,
        height_law: HeightLaw,
        lattice: Lattice,
        nodes: &[Pair],
    ) -> Result<Self, Error> {
        let mean = LogLaw::new(
            direction,
            up,
            mean_speed as Real,
            reference_height,
            roughness,
        )?
        .with_ground(ground)?;
        let along = direction.normalize();
        let up = up.normalize();
        let axes = [along, up.cross(along), up];
        let length = f64::from(lattice.spacing.x) * lattice.dims[0] as f64;
        let row = |i: usize| Vec4::new(axes[0][i], axes[1][i], axes[2][i], 0.0);
        Ok(Self {
            mean,
            axes,
            to_field: [row(0), row(1), row(2)],
            to_world: axes.map(|axis| axis.extend(0.0)),
            reference_height,
            roughness,
            ground,
            mean_speed,
            evolution_time,
            height_law,
            nodes: lattice.pad(|node| nodes[node]),
            lattice,
            per_log: 1.0 / math::ln(reference_height / roughness),
            per_roughness: 1.0 / roughness,
            cap: match height_law {
                HeightLaw::SurfaceLayer => 1.0,
                HeightLaw::Proportional => Real::INFINITY,
            },
            length,
            per_second: [mean_speed / length, 1.0 / evolution_time],
        })
    }

    /// The mean wind under the gusts.
    pub fn mean(&self) -> &LogLaw {
        &self.mean
    }

    /// Nodes of the field along the wind, across it and up.
    pub fn dims(&self) -> [usize; 3] {
        self.lattice.dims
    }

    /// After these lengths (m) along the wind, across it and up the gusts repeat.
    pub fn period(&self) -> [Real; 3] {
        core::array::from_fn(|i| self.lattice.dims[i] as Real * self.lattice.spacing[i])
    }

    /// Fluctuations at the nodes at time 0 at the reference height: along the wind, across it, up, m/s.
    pub fn fluctuations(&self) -> impl Iterator<Item = Vector> + '_ {
        self.lattice
            .unpad(&self.nodes)
            .map(|Pair([node, _])| Vector::new(node[0], node[1], node[2]))
    }

    #[inline(always)]
    fn instant(&self, time: f64) -> Instant {
        let [passed, turned] = self.per_second;
        let way = fraction(time * passed) * self.length;
        // An infinitely slow evolution makes no turns, unless time is infinite too.
        let mix = cos_sin(time * turned);
        Instant {
            carried: Vec4::new(way as Real, 0.0, self.ground, 0.0),
            mix,
        }
    }

    /// Mean speed, strength of the gusts relative to the reference height, and growth per meter of
    /// both, at `height`.
    #[inline(always)]
    fn profile<T: Scalar>(&self, height: T) -> Profile<T> {
        let constant = |value: Real| height.constant(value.into());
        let (zero, one, lowest) = (constant(0.0), constant(1.0), constant(self.roughness));
        // NaN and what is not above the lowest height count as the lowest height, infinity as a great one.
        let above = height.select_lt(lowest, height, lowest);
        let above = above.min(constant(Real::MAX));
        let over = (above * constant(self.per_roughness)).min(constant(Real::MAX));
        let raw = over.ln().max(zero) * constant(self.per_log);
        let growth = (constant(self.per_log) / above).select_lt(lowest, height, zero);
        let (cap, speed) = (constant(self.cap), constant(self.mean_speed as Real));
        Profile {
            speed: speed * raw,
            shear: speed * growth,
            strength: raw.min(cap),
            growth: growth * one.select_lt(raw, cap, zero),
        }
    }

    /// A point in the field's axes, carried back with the mean wind, height above ground.
    #[inline(always)]
    fn to_field(&self, point: Vector, instant: &Instant) -> Vec4 {
        let [x, y, z] = self.to_field;
        x * point.x + y * point.y + z * point.z - instant.carried
    }

    #[inline(always)]
    fn to_world(&self, vector: Vec4) -> Vector {
        let [along, across, up] = self.to_world;
        (along * vector.x + across * vector.y + up * vector.z).truncate()
    }

    #[inline(always)]
    fn velocity_at(&self, point: Vector, instant: &Instant) -> Vector {
        let x = self.to_field(point, instant);
        let cell = self.lattice.locate(x);
        let [a, b] = instant.mix;
        let gust = self
            .lattice
            .value(&cell, &self.nodes, |node| mixed(node, [a, b]));
        let profile = self.profile(x.z);
        self.to_world(gust * profile.strength + Vec4::X * profile.speed)
    }

    /// The bytes of a file: magic (8 bytes), version (`u32`), length and FNV-1a checksum of the rest (`u64`),
    /// then the dimensions and the height law (`u64`), direction, up, spacing, mean speed, reference
    /// height, roughness, ground, evolution time or 0 for never (`f64`), six components per node
    /// (`f32`); all little-endian.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut file = Writer::default();
        for n in self.lattice.dims {
            file.u64(n as u64);
        }
        file.u64(u64::from(self.height_law == HeightLaw::Proportional));
        for vector in [self.axes[0], self.axes[2], self.lattice.spacing] {
            for x in vector.to_array() {
                file.f64(x.into());
            }
        }
        file.f64(self.mean_speed);
        file.f64(self.reference_height.into());
        file.f64(self.roughness.into());
        file.f64(self.ground.into());
        let evolves = self.evolution_time.is_finite();
        file.f64(if evolves { self.evolution_time } else { 0.0 });
        for node in self.lattice.unpad(&self.nodes) {
            for x in node.0.iter().flat_map(|field| &field[..3]) {
                file.f32(*x);
            }
        }
        file.finish(&FILE)
    }

    /// Reads what [`SpectralWind::to_bytes`] wrote.
    ///
    /// # Errors
    /// If the bytes are no such file, of another version, truncated, altered, or hold values that
    /// are out of range.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let mut file = Reader::new(&FILE, bytes)?;
        let dims = file.lengths("nodes", MAX_NODES)?;
        let height_law = match file.length("height law", 1)? {
            0 => HeightLaw::SurfaceLayer,
            _ => HeightLaw::Proportional,
        };
        let (direction, up) = (file.vector("direction")?, file.vector("up")?);
        let spacing = file.vector("spacing")?;
        let mean_speed = file.f64("mean_speed")?;
        let reference_height = file.f64("reference_height")? as Real;
        let roughness = file.f64("roughness")? as Real;
        let ground = file.f64("ground")? as Real;
        let evolution_time = file.f64("evolution_time")?;
        Error::check_not_negative("evolution_time", evolution_time)?;
        let count = dims.iter().map(|n| *n as u64).product::<u64>();
        file.expect_rest(count * 24)?;
        let lattice = Lattice::new(dims, [true; 3], Vector::ZERO, spacing)?;
        let mut nodes = Vec::with_capacity(count as usize);
        for _ in 0..count {
            let mut node = Pair::default();
            for field in &mut node.0 {
                for component in &mut field[..3] {
                    *component = file.f32("fluctuation")?;
                }
            }
            nodes.push(node);
        }
        Self::assemble(
            direction,
            up,
            mean_speed,
            reference_height,
            roughness,
            ground,
            if evolution_time > 0.0 {
                evolution_time
            } else {
                f64::INFINITY
            },
            height_law,
            lattice,
            &nodes,
        )
    }
}

impl Flow for SpectralWind {
    fn velocity(&self, point: Vector, time: f64) -> Vector {
        self.velocity_at(point, &self.instant(time))
    }

    fn vorticity(&self, point: Vector, time: f64) -> Vector {
        alone(self, point, time).vorticity
    }

    fn sample(&self, points: &[Vector], time: f64, samples: &mut [FlowSample]) {
        dispatch(Batch {
            wind: self,
            instant: self.instant(time),
            points,
            samples,
        });
    }
}

/// A batch of points, to be looked up in lanes.
struct Batch<'a> {
    wind: &'a SpectralWind,
    instant: Instant,
    points: &'a [Vector],
    samples: &'a mut [FlowSample],
}

impl OnLanes for Batch<'_> {
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self {
            wind,
            instant,
            points,
            samples,
        } = self;
        let cells = Cells::new(simd, &wind.lattice);
        let [along, across, up] = wind.axes.map(|axis| {
            let [x, y, z] = axis.to_array();
            [
                Lanes::splat(simd, x),
                Lanes::splat(simd, y),
                Lanes::splat(simd, z),
            ]
        });
        let carried = Lanes::splat(simd, instant.carried.x);
        let ground = Lanes::splat(simd, wind.ground);
        let groups = points.chunks(Lanes::<S>::COUNT);
        for (points, samples) in groups.zip(samples.chunks_mut(Lanes::<S>::COUNT)) {
            let [x, y, z, zero] = Lanes::points(simd, points);
            let point = [x, y, z];
            let height = dot(&point, &up) - ground;
            let found = cells.locate([dot(&point, &along) - carried, dot(&point, &across), height]);
            let mut gusts = [Row::default(); MOST_LANES];
            let mut curls = [Row::default(); MOST_LANES];
            for lane in 0..points.len() {
                let both = cells.jet(&found, lane, &wind.nodes);
                let jet = both.mixed(simd, instant.mix);
                gusts[lane].copy_from_slice(jet.value.as_slice());
                let [x, y, z] = jet.curl().to_array();
                curls[lane] = [x, y, z, 0.0];
            }
            let [u, v, w, _] = Lanes::side_by_side(simd, |lane| gusts[lane]);
            let [p, q, r, _] = Lanes::side_by_side(simd, |lane| curls[lane]);
            let profile = wind.profile(height);
            let strength = profile.strength;
            let velocity = [u * strength + profile.speed, v * strength, w * strength];
            // curl(strength·gust + U e₁), with ẑ × e₁ = e₂.
            let vorticity = [
                p * strength - v * profile.growth,
                q * strength + u * profile.growth + profile.shear,
                r * strength,
            ];
            let [x, y, z] = in_world(&velocity, &along, &across, &up);
            let [p, q, r] = in_world(&vorticity, &along, &across, &up);
            Lanes::apart([x, y, z, zero], |lane, [x, y, z, _]| {
                if let Some(sample) = samples.get_mut(lane) {
                    sample.velocity = Vector::new(x, y, z);
                }
            });
            Lanes::apart([p, q, r, zero], |lane, [x, y, z, _]| {
                if let Some(sample) = samples.get_mut(lane) {
                    sample.vorticity = Vector::new(x, y, z);
                }
            });
        }
    }
}

#[inline(always)]
fn mixed(Pair([first, second]): &Pair, [a, b]: [Real; 2]) -> Vec4 {
    Vec4::from_array(*first) * a + Vec4::from_array(*second) * b
}

#[inline(always)]
fn dot<T: Scalar>(a: &[T; 3], b: &[T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A vector of the field's axes in those of the world.
#[inline(always)]
fn in_world<T: Scalar>(v: &[T; 3], along: &[T; 3], across: &[T; 3], up: &[T; 3]) -> [T; 3] {
    [
        along[0] * v[0] + across[0] * v[1] + up[0] * v[2],
        along[1] * v[0] + across[1] * v[1] + up[1] * v[2],
        along[2] * v[0] + across[2] * v[1] + up[2] * v[2],
    ]
}
