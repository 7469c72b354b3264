//! Control of single bodies: factors on the law's forces, set by hand or replayed from a series.

use super::interning::{Content, HashIndex};
use crate::hydro::viscous::ForceFactors;
use crate::motion::ControlSeries;

/// What a contact does to a series that is being replayed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum OnContact {
    /// While the body touches something or sleeps it is under its own law; when it flies again, the
    /// pattern that was interrupted begins anew.
    #[default]
    Restart,
    /// The body goes on under its own law for good.
    Stop,
    /// The series goes on as if nothing had happened.
    Ignore,
}

/// Where a body is in the series that it replays.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct Replay {
    /// Index of the series.
    series: u32,
    on_contact: OnContact,
    /// Seconds since its beginning.
    time: f64,
}

/// The control of one body.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct BodyControl {
    /// Factors on the law's forces.
    pub factors: ForceFactors,
    replay: Option<Replay>,
}

impl BodyControl {
    /// Sets the factors and ends a replay. Factors that are not valid change nothing.
    pub fn set(&mut self, factors: ForceFactors) {
        if factors.check().is_ok() {
            *self = Self {
                factors,
                replay: None,
            };
        }
    }

    /// Begins a series of the table with the next step.
    pub fn replay(&mut self, series: u32, on_contact: OnContact) {
        self.replay = Some(Replay {
            series,
            on_contact,
            time: 0.0,
        });
    }

    /// Ends a replay, if there is one: the law is then the body's own.
    pub fn stop(&mut self) {
        if self.replay.is_some() {
            *self = Self::default();
        }
    }

    /// How far the replay has come, s.
    pub fn time(&self) -> Option<f64> {
        self.replay.map(|replay| replay.time)
    }

    /// Sets the factors of a body that replays a series for a step of `dt`, and moves on in the series.
    #[inline]
    pub fn advance(&mut self, touching: bool, table: &SeriesTable, dt: f64) {
        let Some(replay) = &mut self.replay else {
            return;
        };
        let Some(series) = table.get(replay.series) else {
            return;
        };
        if touching && replay.on_contact != OnContact::Ignore {
            self.factors = ForceFactors::ONE;
            if replay.on_contact == OnContact::Stop {
                self.replay = None;
            } else {
                replay.time = series.dwell_start(replay.time);
            }
        } else {
            self.factors = series.at(replay.time);
            replay.time += dt;
        }
    }
}

/// The series that bodies replay, equal ones once.
#[derive(Clone, Debug, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize),
    serde(
        from = "Vec<Option<ControlSeries>>",
        into = "Vec<Option<ControlSeries>>"
    )
)]
pub(super) struct SeriesTable {
    /// `None` where there is room for one.
    entries: Vec<Option<ControlSeries>>,
    index: HashIndex,
}

impl SeriesTable {
    fn get(&self, index: u32) -> Option<&ControlSeries> {
        self.entries.get(index as usize)?.as_ref()
    }

    /// Where a series is kept. When their number has doubled, those that no body replays any more make
    /// room: `controls` are those of all bodies.
    pub fn intern<'a>(
        &mut self,
        series: &ControlSeries,
        controls: impl Iterator<Item = &'a BodyControl>,
    ) -> u32 {
        let hash = series.content_hash();
        let known = |place: u32| self.get(place) == Some(series);
        if let Some(place) = self.index.find(hash, known) {
            return place;
        }
        if self.entries.len() >= 16 && self.entries.len().is_power_of_two() {
            self.keep_used(controls);
        }
        let place = match self.entries.iter().position(Option::is_none) {
            Some(place) => place,
            None => {
                self.entries.push(None);
                self.entries.len() - 1
            }
        };
        self.entries[place] = Some(series.clone());
        self.index.insert(hash, place as u32);
        place as u32
    }

    fn keep_used<'a>(&mut self, controls: impl Iterator<Item = &'a BodyControl>) {
        let mut used = vec![false; self.entries.len()];
        for replay in controls.filter_map(|control| control.replay) {
            if let Some(used) = used.get_mut(replay.series as usize) {
                *used = true;
            }
        }
        for (entry, used) in self.entries.iter_mut().zip(used) {
            if !used {
                *entry = None;
            }
        }
        self.find_again();
    }

    /// Makes the index anew.
    fn find_again(&mut self) {
        self.index.clear();
        for (place, series) in self.entries.iter().enumerate() {
            if let Some(series) = series {
                self.index.insert(series.content_hash(), place as u32);
            }
        }
    }
}

impl From<Vec<Option<ControlSeries>>> for SeriesTable {
    fn from(entries: Vec<Option<ControlSeries>>) -> Self {
        let mut table = Self {
            entries,
            index: HashIndex::default(),
        };
        table.find_again();
        table
    }
}

impl From<SeriesTable> for Vec<Option<ControlSeries>> {
    fn from(table: SeriesTable) -> Self {
        table.entries
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(interval: f64) -> ControlSeries {
        ControlSeries::new(interval, vec![ForceFactors::ONE], Vec::new()).unwrap()
    }

    /// Ever new series for one body do not pile up, equal ones are stored once, and those that are in use
    /// stay.
    #[test]
    fn series_make_room() {
        let mut table = SeriesTable::default();
        let mut kept = BodyControl::default();
        kept.replay(
            table.intern(&series(0.5), std::iter::empty()),
            OnContact::Stop,
        );
        let mut control = BodyControl::default();
        for i in 0..1000 {
            let other = series(1.0 + f64::from(i));
            let place = table.intern(&other, [kept, control].iter());
            assert_eq!(table.intern(&other, std::iter::empty()), place);
            control.replay(place, OnContact::Restart);
        }
        assert!(table.entries.len() <= 32);
        let interval = |control: &BodyControl| {
            let replay = control.replay.unwrap();
            table.get(replay.series).unwrap().interval()
        };
        assert_eq!((interval(&kept), interval(&control)), (0.5, 1000.0));
    }
}
