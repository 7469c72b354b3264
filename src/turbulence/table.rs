//! The baked turbulence: k and ε over time along a followed particle, and over space and time.

use super::TurbulenceState;
use crate::error::Error;
use crate::file::{FileKind, Reader, Writer};
use rapier3d::math::{Real, Vector};
use std::sync::LazyLock;

/// k and ε of a baked flow in units of its own speed U₀ and length L: k/U₀² and εL/U₀³ against tU₀/L.
///
/// So one table serves every body; [`Turbulence`](super::Turbulence) holds the scales.
/// Look-ups are linear between entries and clamped at the ends.
///
/// ```
/// use rapier3d_immersed::turbulence::{TurbulenceState, TurbulenceTable};
///
/// // Two entries, 0.5 L/U₀ apart.
/// let state = |k| TurbulenceState { kinetic_energy: k, dissipation: k };
/// let table = TurbulenceTable::new(4000.0, 0.5, vec![state(1.5), state(0.5)], None)?;
/// assert_eq!(table.history_at(0.25).kinetic_energy, 1.0);
/// assert_eq!(table.history_at(9.0), state(0.5));
/// let bytes = table.to_bytes(); // std::fs::write(path, &bytes)
/// assert_eq!(TurbulenceTable::from_bytes(&bytes)?, table);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct TurbulenceTable {
    reynolds: f64,
    time_step: f64,
    history: Vec<TurbulenceState>,
    field: Option<TurbulenceField>,
}

/// k and ε on a regular grid of cell centers, at regular times. Axis 0 is along the stream.
#[derive(Clone, Debug, PartialEq)]
pub struct TurbulenceField {
    dims: [usize; 3],
    origin: [f64; 3],
    spacing: [f64; 3],
    time_step: f64,
    /// States frame after frame, inside a frame in the order of [`GridFlow`](crate::flow::GridFlow::new).
    states: Vec<TurbulenceState>,
}

const FILE: FileKind = FileKind {
    name: "turbulence table",
    magic: *b"R3ITURBT",
    version: 1,
};
/// What the file's numbers are measured in: 1 is U₀ and L, the only choice so far.
const UNITS: u64 = 1;
const MAX_ENTRIES: u64 = 1 << 28;

fn check_states(states: &[TurbulenceState]) -> Result<(), Error> {
    for state in states {
        Error::check_not_negative("kinetic_energy", state.kinetic_energy.into())?;
        Error::check_not_negative("dissipation", state.dissipation.into())?;
    }
    Ok(())
}

fn mix(a: TurbulenceState, b: TurbulenceState, weight: Real) -> TurbulenceState {
    TurbulenceState {
        kinetic_energy: a.kinetic_energy + (b.kinetic_energy - a.kinetic_energy) * weight,
        dissipation: a.dissipation + (b.dissipation - a.dissipation) * weight,
    }
}

/// Entry below `x` of `n` entries, clamped, and the weight of the next one.
fn bracket(x: f64, n: usize) -> (usize, usize, Real) {
    let x = x.clamp(0.0, (n - 1) as f64);
    let below = (x as usize).min(n.saturating_sub(2));
    (below, (below + 1).min(n - 1), (x - below as f64) as Real)
}

impl TurbulenceTable {
    /// A table of `history` every `time_step` (in L/U₀) of a flow of Reynolds number `reynolds`, U₀L/ν.
    ///
    /// # Errors
    /// If the history is empty, a state negative or not finite, a number not positive.
    pub fn new(
        reynolds: f64,
        time_step: f64,
        history: Vec<TurbulenceState>,
        field: Option<TurbulenceField>,
    ) -> Result<Self, Error> {
        Error::check_positive("reynolds", reynolds)?;
        Error::check_positive("time_step", time_step)?;
        let n = history.len() as u64;
        Error::check(
            "number of history entries",
            n as f64,
            n > 0 && n <= MAX_ENTRIES,
            "from 1 to 2^28",
        )?;
        check_states(&history)?;
        Ok(Self {
            reynolds,
            time_step,
            history,
            field,
        })
    }

    /// The table that ships with the crate: a plate across a stream, Re = 3.8e3, grid 32 × 32 × 16, and
    /// a particle followed past it (as the thesis's Fig. 4.2), by the full model; history only.
    ///
    /// Baked by `cargo run --release --features bake --example wind -- --write-default-table PATH`.
    pub fn default_history() -> Self {
        static TABLE: LazyLock<TurbulenceTable> = LazyLock::new(|| {
            TurbulenceTable::from_bytes(include_bytes!("default_table.bin"))
                .expect("the shipped table is valid, as a test asserts")
        });
        TABLE.clone()
    }

    /// Reynolds number U₀L/ν of the baked flow.
    pub fn reynolds(&self) -> f64 {
        self.reynolds
    }

    /// Time between history entries, in L/U₀.
    pub fn time_step(&self) -> f64 {
        self.time_step
    }

    /// The history, in U₀² and U₀³/L.
    pub fn history(&self) -> &[TurbulenceState] {
        &self.history
    }

    /// The field over space and time, if the table has one.
    pub fn field(&self) -> Option<&TurbulenceField> {
        self.field.as_ref()
    }

    /// The table without its field.
    #[must_use]
    pub fn without_field(self) -> Self {
        Self {
            field: None,
            ..self
        }
    }

    /// The history at `time` (in L/U₀) after the release, in U₀² and U₀³/L.
    #[inline]
    pub fn history_at(&self, time: f64) -> TurbulenceState {
        let (below, above, weight) = bracket(time / self.time_step, self.history.len());
        mix(self.history[below], self.history[above], weight)
    }

    /// The bytes of a file: magic (8 bytes), version (`u32`), length and FNV-1a checksum of the rest (`u64`),
    /// then the unit system, numbers of history entries, of field nodes along each axis and of frames
    /// (`u64`; zeros without field), Reynolds number, time step, the field's origin, spacing, time
    /// step (`f64`), then k, ε of history and field (`f32`); all little-endian.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut file = Writer::default();
        file.u64(UNITS);
        file.u64(self.history.len() as u64);
        let (dims, frames) = self
            .field
            .as_ref()
            .map_or(([0; 3], 0), |field| (field.dims, field.frames()));
        for n in dims {
            file.u64(n as u64);
        }
        file.u64(frames as u64);
        file.f64(self.reynolds);
        file.f64(self.time_step);
        let empty = ([0.0; 3], [0.0; 3], 0.0);
        let (origin, spacing, time_step) = self.field.as_ref().map_or(empty, |field| {
            (field.origin, field.spacing, field.time_step)
        });
        for x in origin.into_iter().chain(spacing) {
            file.f64(x);
        }
        file.f64(time_step);
        let field = self.field.iter().flat_map(|field| &field.states);
        for state in self.history.iter().chain(field) {
            file.f32(state.kinetic_energy);
            file.f32(state.dissipation);
        }
        file.finish(&FILE)
    }

    /// Reads what [`TurbulenceTable::to_bytes`] wrote.
    ///
    /// # Errors
    /// If the bytes are no such file, of another version or unit system, truncated, altered, or hold
    /// values that [`TurbulenceTable::new`] refuses.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let mut file = Reader::new(&FILE, bytes)?;
        let units = file.u64()?;
        Error::check(
            "unit system",
            units as f64,
            units == UNITS,
            "1 (the flow's own speed and length)",
        )?;
        let count = file.length("number of history entries", MAX_ENTRIES)?;
        let dims = file.lengths("field nodes", 1 << 10)?;
        let frames = file.length("field frames", 1 << 16)?;
        let reynolds = file.f64("reynolds")?;
        let time_step = file.f64("time_step")?;
        let (origin, spacing) = (file.three("field origin")?, file.three("field spacing")?);
        let field_step = file.f64("field time_step")?;
        let nodes = dims.iter().map(|n| *n as u64).product::<u64>() * frames as u64;
        file.expect_rest((count as u64 + nodes) * 8)?;
        let mut states = |n: u64| -> Result<Vec<_>, Error> {
            (0..n)
                .map(|_| {
                    Ok(TurbulenceState {
                        kinetic_energy: file.f32("kinetic_energy")?,
                        dissipation: file.f32("dissipation")?,
                    })
                })
                .collect()
        };
        let history = states(count as u64)?;
        let field = states(nodes)?;
        let field = if frames == 0 && dims == [0; 3] {
            None
        } else {
            Some(TurbulenceField::new(
                dims, origin, spacing, field_step, field,
            )?)
        };
        Self::new(reynolds, time_step, history, field)
    }
}

impl TurbulenceField {
    /// A field on cell centers `origin + (i, j, k)·spacing` (in L), frames `time_step` (L/U₀) apart.
    ///
    /// # Errors
    /// If a dimension is 0, the number of states is not a positive multiple of the number of nodes, a
    /// spacing or the time step is not positive, or a state negative or not finite.
    pub fn new(
        dims: [usize; 3],
        origin: [f64; 3],
        spacing: [f64; 3],
        time_step: f64,
        states: Vec<TurbulenceState>,
    ) -> Result<Self, Error> {
        for n in dims {
            Error::check(
                "field nodes",
                n as f64,
                n > 0 && n <= 1 << 10,
                "from 1 to 1024 along each axis",
            )?;
        }
        for i in 0..3 {
            Error::check_finite("field origin", origin[i])?;
            Error::check_positive("field spacing", spacing[i])?;
        }
        Error::check_positive("field time_step", time_step)?;
        let nodes: usize = dims.iter().product();
        Error::check(
            "number of field states",
            states.len() as f64,
            !states.is_empty() && states.len().is_multiple_of(nodes),
            "a positive multiple of the number of field nodes",
        )?;
        check_states(&states)?;
        Ok(Self {
            dims,
            origin,
            spacing,
            time_step,
            states,
        })
    }

    /// Nodes along the stream and across it.
    pub fn dims(&self) -> [usize; 3] {
        self.dims
    }

    /// Number of stored instants.
    pub fn frames(&self) -> usize {
        self.states.len() / self.dims.iter().product::<usize>()
    }

    /// The states of one instant, in the order of [`GridFlow`](crate::flow::GridFlow::new). Beyond the last
    /// instant it is the last.
    pub fn frame(&self, frame: usize) -> &[TurbulenceState] {
        let nodes: usize = self.dims.iter().product();
        let first = frame.min(self.frames() - 1) * nodes;
        &self.states[first..first + nodes]
    }

    /// The state at `point` (in L, field axes) and `time` (in L/U₀), clamped to the field.
    pub fn at(&self, point: Vector, time: f64) -> TurbulenceState {
        let axis = |i: usize, x: Real| {
            bracket(
                (f64::from(x) - self.origin[i]) / self.spacing[i],
                self.dims[i],
            )
        };
        let (i, i1, wx) = axis(0, point.x);
        let (j, j1, wy) = axis(1, point.y);
        let (k, k1, wz) = axis(2, point.z);
        let (f, f1, wt) = bracket(time / self.time_step, self.frames());
        let [nx, ny, nz] = self.dims;
        let line = |f: usize, k: usize, j: usize| {
            let row = ((f * nz + k) * ny + j) * nx;
            mix(self.states[row + i], self.states[row + i1], wx)
        };
        let plane = |f: usize, k: usize| mix(line(f, k, j), line(f, k, j1), wy);
        let frame = |f: usize| mix(plane(f, k), plane(f, k1), wz);
        mix(frame(f), frame(f1), wt)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(kinetic_energy: f32, dissipation: f32) -> TurbulenceState {
        TurbulenceState {
            kinetic_energy,
            dissipation,
        }
    }

    fn table() -> TurbulenceTable {
        let states = (0..3 * 2 * 2 * 2).map(|n| state(n as f32, 1.0)).collect();
        let field =
            TurbulenceField::new([3, 2, 2], [0.5; 3], [1.0, 2.0, 1.0], 0.5, states).unwrap();
        let history = vec![state(4.0, 1.0), state(2.0, 3.0), state(1.0, 1.0)];
        TurbulenceTable::new(3800.0, 0.25, history, Some(field)).unwrap()
    }

    #[test]
    fn history_is_linear_between_and_clamped_at_the_ends() {
        let table = table();
        assert_eq!(table.history_at(0.125), state(3.0, 2.0));
        assert_eq!(table.history_at(-1.0), state(4.0, 1.0));
        assert_eq!(table.history_at(1.0e9), state(1.0, 1.0));
        assert_eq!(table.history_at(0.5), state(1.0, 1.0));
        let one = TurbulenceTable::new(1.0, 1.0, vec![state(1.0, 2.0)], None).unwrap();
        assert_eq!(one.history_at(3.0), state(1.0, 2.0));
    }

    /// The states count up by 1 along x, 3 along y, 6 along z and 12 in time.
    #[test]
    fn field_is_linear_in_space_and_time() {
        let table = table();
        let field = table.field().unwrap();
        let at = |x, y, z, t| field.at(Vector::new(x, y, z), t).kinetic_energy;
        assert_eq!(at(0.5, 0.5, 0.5, 0.0), 0.0);
        assert!((at(1.0, 1.5, 0.75, 0.125) - (0.5 + 1.5 + 1.5 + 3.0)).abs() < 1.0e-5);
        assert_eq!(at(99.0, 99.0, 99.0, 99.0), 23.0);
        assert_eq!(at(-99.0, -99.0, -99.0, -99.0), 0.0);
    }

    #[test]
    fn shipped_table_loads_and_is_turbulence() {
        let table = TurbulenceTable::from_bytes(include_bytes!("default_table.bin")).unwrap();
        assert_eq!(table, TurbulenceTable::default_history());
        assert_eq!(table.reynolds(), 3800.0);
        let first = table.history()[0];
        // Thesis (4.20): k0 = 3/2 U0².
        assert!((first.kinetic_energy - 1.5).abs() < 1.0e-5);
        let last = table.history().last().unwrap();
        assert!(last.kinetic_energy > 0.0 && last.kinetic_energy < first.kinetic_energy);
    }

    #[test]
    fn files_come_back_whole_or_not_at_all() {
        let table = table();
        let bytes = table.to_bytes();
        assert_eq!(TurbulenceTable::from_bytes(&bytes).unwrap(), table);
        let history = table.clone().without_field();
        assert_eq!(
            TurbulenceTable::from_bytes(&history.to_bytes()).unwrap(),
            history
        );
        for length in 0..bytes.len() {
            assert!(TurbulenceTable::from_bytes(&bytes[..length]).is_err());
        }
        for bit in 0..bytes.len() * 8 {
            let mut altered = bytes.clone();
            altered[bit / 8] ^= 1 << (bit % 8);
            assert!(TurbulenceTable::from_bytes(&altered).is_err(), "bit {bit}");
        }
    }

    #[test]
    fn bad_tables_are_errors() {
        let ok = vec![state(1.0, 1.0)];
        let new = |re, dt, history: &[TurbulenceState]| {
            TurbulenceTable::new(re, dt, history.to_vec(), None).is_err()
        };
        assert!(new(0.0, 1.0, &ok));
        assert!(new(1.0, f64::NAN, &ok));
        assert!(new(1.0, 1.0, &[]));
        assert!(new(1.0, 1.0, &[state(1.0, -1.0)]));
        assert!(new(1.0, 1.0, &[state(f32::INFINITY, 1.0)]));
        let field = |dims, h: f64, dt, n: usize| {
            TurbulenceField::new(dims, [0.0; 3], [h; 3], dt, vec![state(1.0, 1.0); n]).is_err()
        };
        assert!(field([0, 1, 1], 1.0, 1.0, 1));
        assert!(field([1, 1, 1], 0.0, 1.0, 1));
        assert!(field([1, 1, 1], 1.0, -1.0, 1));
        assert!(field([2, 1, 1], 1.0, 1.0, 3));
        assert!(field([1, 1, 1], 1.0, 1.0, 0));
    }
}
