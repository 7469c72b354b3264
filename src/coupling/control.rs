//! Control of single bodies: factors on the law's forces, set by hand or replayed from a series.

use crate::hydro::viscous::ForceFactors;
use crate::interning::Interned;
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

    /// Index of the series that the body replays.
    pub fn series(&self) -> Option<u32> {
        self.replay.map(|replay| replay.series)
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
pub(super) type SeriesTable = Interned<ControlSeries>;
