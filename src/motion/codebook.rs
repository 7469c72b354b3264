//! Codebooks: series of control parameters that make a body fall in planned patterns.

use super::pattern::Pattern;
use super::planned_for::PlannedFor;
use crate::error::Error;
use crate::hydro::viscous::ForceFactors;
use rand::{Rng, RngExt};

/// A stretch of a series in which one pattern is meant to be seen.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Dwell {
    /// The pattern.
    pub pattern: Pattern,
    /// Index of the first entry of the series that belongs to it.
    pub from: usize,
}

/// Control parameters c̃ over time, factors on the forces of a body's law, each held for `interval`.
///
/// ```
/// use rapier3d_immersed::ForceFactors;
/// use rapier3d_immersed::motion::ControlSeries;
///
/// let braked = ForceFactors { drag: 3.0, ..ForceFactors::ONE };
/// let series = ControlSeries::new(0.5, vec![ForceFactors::ONE, braked], Vec::new())?;
/// assert_eq!(series.at(0.2), ForceFactors::ONE);
/// assert_eq!(series.at(7.0), braked); // the last entry stays
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct ControlSeries {
    interval: f64,
    controls: Vec<ForceFactors>,
    dwells: Vec<Dwell>,
}

/// Entries that a series may have.
const MOST_ENTRIES: f64 = 1e6;
/// A control parameter that is larger than this is refused.
const MOST_CONTROL: f64 = 100.0;

impl ControlSeries {
    /// A series of controls, each held for `interval` seconds.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`], [`Error::OutOfRange`] or [`Error::WrongLength`] if the interval is
    /// not positive, there is no entry, an entry is not finite, has a negative drag or is larger than
    /// 100, or the dwells do not begin at 0 and ascend.
    pub fn new(
        interval: f64,
        controls: Vec<ForceFactors>,
        dwells: Vec<Dwell>,
    ) -> Result<Self, Error> {
        let series = Self {
            interval,
            controls,
            dwells,
        };
        series.check()?;
        Ok(series)
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        Error::check_positive("interval", self.interval)?;
        Error::check_range(
            "entries of the series",
            self.controls.len() as f64,
            1.0,
            MOST_ENTRIES,
        )?;
        for factors in &self.controls {
            Error::check_range("drag control", factors.drag.into(), 0.0, MOST_CONTROL)?;
            for lift in [factors.rotational_lift, factors.translational_lift] {
                Error::check_range("lift control", lift.into(), -MOST_CONTROL, MOST_CONTROL)?;
            }
        }
        let mut next = 0;
        for (index, dwell) in self.dwells.iter().enumerate() {
            let valid = if index == 0 {
                dwell.from == 0
            } else {
                dwell.from >= next
            };
            let from = dwell.from as f64;
            Error::check("dwell", from, valid, "first 0, and ascending")?;
            Error::check_range("dwell", from, 0.0, self.controls.len() as f64 - 1.0)?;
            next = dwell.from + 1;
        }
        Ok(())
    }

    /// Time that each entry is held, s.
    pub fn interval(&self) -> f64 {
        self.interval
    }

    /// The entries.
    pub fn controls(&self) -> &[ForceFactors] {
        &self.controls
    }

    /// The planned patterns.
    pub fn dwells(&self) -> &[Dwell] {
        &self.dwells
    }

    /// Length, s.
    pub fn duration(&self) -> f64 {
        self.interval * self.controls.len() as f64
    }

    /// c̃ at a time since the beginning, s; the last entry is held for ever.
    #[inline]
    pub fn at(&self, time: f64) -> ForceFactors {
        // A time that rounding puts just below a whole number of intervals belongs to the next entry.
        let index = (time / self.interval + 1e-6).max(0.0) as usize;
        self.controls[index.min(self.controls.len() - 1)]
    }

    /// Times between which each dwell lasts, s.
    pub fn dwell_times(&self) -> Vec<(Pattern, f64, f64)> {
        let ends = self.dwells.iter().skip(1).map(|dwell| dwell.from);
        let ends = ends.chain(std::iter::once(self.controls.len()));
        let times = self.dwells.iter().zip(ends).map(|(dwell, end)| {
            let time = |index: usize| index as f64 * self.interval;
            (dwell.pattern, time(dwell.from), time(end))
        });
        times.collect()
    }

    /// Beginning of the dwell that a time lies in, s.
    pub fn dwell_start(&self, time: f64) -> f64 {
        let index = (time / self.interval + 1e-6).max(0.0) as usize;
        let after = self.dwells.partition_point(|dwell| dwell.from <= index);
        let from = self.dwells[..after].last().map_or(0, |dwell| dwell.from);
        from as f64 * self.interval
    }

    /// The planned patterns in their order, repeats merged.
    pub fn sequence(&self) -> Vec<Pattern> {
        let mut sequence: Vec<Pattern> = self.dwells.iter().map(|dwell| dwell.pattern).collect();
        sequence.dedup();
        sequence
    }
}

/// Series for one body, to be replayed at run time.
///
/// [`Planner::codebook`](crate::training::Planner::codebook) fills one; a scene draws from it, and
/// [`Immersion::replay_planned`](crate::Immersion::replay_planned) plays a series, if body, fluid, release and
/// time step are those that it was planned for:
///
/// ```
/// use rapier3d_immersed::motion::{Codebook, ControlSeries, Dwell, Pattern, PlannedFor};
/// use rapier3d_immersed::training::thin_ellipsoid;
/// use rapier3d_immersed::{Fluid, ForceFactors};
///
/// let series = |pattern| {
///     ControlSeries::new(0.5, vec![ForceFactors::ONE; 4], vec![Dwell { pattern, from: 0 }])
/// };
/// let (leaf, mass) = thin_ellipsoid([0.0365, 0.021, 0.00015], 400.0)?;
/// let book = Codebook::new(
///     "leaf, 7.3 × 4.2 cm",
///     PlannedFor::new(leaf, mass, Fluid::AIR, 1.0 / 120.0),
///     vec![series(Pattern::Zigzag)?, series(Pattern::Autorotation)?],
/// )?;
/// assert_eq!(book.starting_with(Pattern::Zigzag).count(), 1);
/// assert_eq!(book.series()[1].sequence(), [Pattern::Autorotation]);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Codebook {
    /// Which body it is for, in the user's words.
    pub body: String,
    /// What the series were planned for: the body under its law, the fluid, the release, the time step.
    pub planned_for: PlannedFor,
    series: Vec<ControlSeries>,
}

#[cfg(feature = "serde-serialize")]
const FILE: crate::file::FileKind = crate::file::FileKind {
    name: "codebook",
    magic: *b"R3DI-CBK",
    version: 2,
};

impl Codebook {
    /// # Errors
    /// [`Error::WrongLength`] if there is no series; those of [`PlannedFor::check`].
    pub fn new(
        body: impl Into<String>,
        planned_for: PlannedFor,
        series: Vec<ControlSeries>,
    ) -> Result<Self, Error> {
        let book = Self {
            body: body.into(),
            planned_for,
            series,
        };
        book.check()?;
        Ok(book)
    }

    fn check(&self) -> Result<(), Error> {
        self.planned_for.check()?;
        if self.series.is_empty() {
            return Err(Error::WrongLength {
                what: "series of the codebook",
                expected: 1,
                actual: 0,
            });
        }
        self.series.iter().try_for_each(ControlSeries::check)
    }

    /// All series.
    pub fn series(&self) -> &[ControlSeries] {
        &self.series
    }

    /// The series that begin with a pattern.
    pub fn starting_with(&self, pattern: Pattern) -> impl Iterator<Item = &ControlSeries> {
        self.series
            .iter()
            .filter(move |series| series.dwells.first().is_some_and(|d| d.pattern == pattern))
    }

    /// The series whose planned sequence, repeats merged, is this one.
    pub fn with_sequence(&self, sequence: &[Pattern]) -> impl Iterator<Item = &ControlSeries> {
        self.series
            .iter()
            .filter(move |series| series.sequence() == sequence)
    }

    /// A series at random, all equally likely, for one of many leaves.
    pub fn draw(&self, random: &mut impl Rng) -> &ControlSeries {
        &self.series[random.random_range(0..self.series.len())]
    }

    /// The bytes of a file that holds this codebook.
    #[cfg(feature = "serde-serialize")]
    pub fn to_bytes(&self) -> Vec<u8> {
        crate::file::encode(&FILE, self)
    }

    /// Reads what `to_bytes` wrote.
    ///
    /// # Errors
    /// If the bytes are of another kind or version, truncated, altered, or describe something
    /// inconsistent, not finite or out of range.
    #[cfg(feature = "serde-serialize")]
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let loaded: Self = crate::file::decode(&FILE, bytes)?;
        loaded.check()?;
        Ok(loaded)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fluid::Fluid;

    fn ball() -> PlannedFor {
        let shape = rapier3d::geometry::SharedShape::ball(0.01);
        let hydro = crate::hydro::HydroProperties::from_shape(shape.as_ref()).unwrap();
        let mass = crate::body::DryMass::of_shape(shape.as_ref(), 400.0).unwrap();
        PlannedFor::new(hydro, mass, Fluid::AIR, 1.0 / 120.0)
    }

    fn series() -> ControlSeries {
        let dwell = |pattern, from| Dwell { pattern, from };
        let dwells = vec![
            dwell(Pattern::SteadyDescent, 0),
            dwell(Pattern::Zigzag, 2),
            dwell(Pattern::Zigzag, 5),
        ];
        let controls = (0..8).map(|i| ForceFactors::from([i as f32, 0.5, -1.0]));
        let controls = controls.collect();
        ControlSeries::new(0.1, controls, dwells).unwrap()
    }

    #[test]
    fn entries_are_held() {
        let series = series();
        assert_eq!(series.at(-1.0).drag, 0.0);
        assert_eq!(series.at(0.05).drag, 0.0);
        assert_eq!(series.at(0.1 + 0.2).drag, 3.0);
        assert_eq!(series.at(7.0).drag, 7.0);
        assert_eq!(series.sequence(), [Pattern::SteadyDescent, Pattern::Zigzag]);
        assert_eq!(series.dwell_start(0.49), 0.2);
        assert_eq!(series.dwell_start(9.0), 0.5);
        let times = series.dwell_times();
        assert_eq!(times.len(), 3);
        assert!((times[1].1 - 0.2).abs() < 1e-12 && (times[2].2 - 0.8).abs() < 1e-12);
    }

    #[test]
    fn bad_series_are_refused() {
        let good = series();
        let make = |interval, controls: Vec<ForceFactors>, from: [usize; 2]| {
            let dwells = from.map(|from| Dwell {
                pattern: Pattern::Zigzag,
                from,
            });
            ControlSeries::new(interval, controls, dwells.to_vec())
        };
        let controls = good.controls.clone();
        assert!(make(0.1, controls.clone(), [0, 3]).is_ok());
        assert!(make(0.0, controls.clone(), [0, 3]).is_err());
        assert!(make(f64::NAN, controls.clone(), [0, 3]).is_err());
        assert!(make(0.1, Vec::new(), [0, 3]).is_err());
        assert!(make(0.1, vec![[-1.0, 0.0, 0.0].into(); 4], [0, 3]).is_err());
        assert!(make(0.1, vec![[1.0, f32::NAN, 0.0].into(); 4], [0, 3]).is_err());
        assert!(make(0.1, vec![[1.0, 1e9, 0.0].into(); 4], [0, 3]).is_err());
        assert!(make(0.1, controls.clone(), [1, 3]).is_err());
        assert!(make(0.1, controls.clone(), [0, 0]).is_err());
        assert!(make(0.1, controls, [0, 8]).is_err());
        assert!(Codebook::new("leaf", ball(), Vec::new()).is_err());
    }

    #[cfg(feature = "serde-serialize")]
    #[test]
    fn what_is_saved_is_loaded() {
        let book = Codebook::new("leaf", ball(), vec![series(); 2]).unwrap();
        let bytes = book.to_bytes();
        assert_eq!(Codebook::from_bytes(&bytes).as_ref(), Ok(&book));
        assert_eq!(book.starting_with(Pattern::SteadyDescent).count(), 2);
        assert_eq!(book.with_sequence(&[Pattern::Zigzag]).count(), 0);
        for length in (0..bytes.len()).step_by(5) {
            assert!(Codebook::from_bytes(&bytes[..length]).is_err());
        }
        // Every byte of the header and of the end, and one in seven between.
        for at in (0..bytes.len()).filter(|at| *at < 64 || at % 7 == 0 || at + 64 > bytes.len()) {
            let mut altered = bytes.clone();
            altered[at] ^= 0x10;
            assert!(Codebook::from_bytes(&altered).is_err(), "byte {at}");
        }
        // The frame of the file is right, but its content is out of range.
        let mut bad = book;
        bad.series[0].controls[3].drag = f32::INFINITY;
        assert!(Codebook::from_bytes(&bad.to_bytes()).is_err());
        bad.series[0] = series();
        bad.series[1].dwells[1].from = 99;
        assert!(Codebook::from_bytes(&bad.to_bytes()).is_err());
        bad.series[1] = series();
        assert!(Codebook::from_bytes(&bad.to_bytes()).is_ok());
        bad.planned_for.mass.mass = -1.0;
        assert!(Codebook::from_bytes(&bad.to_bytes()).is_err());
    }
}
