//! The bench: a world that goes on and back by commands.

use crate::change::Change;
use crate::film::Film;
use crate::history::History;
use crate::methods;
use crate::saved::Saved;
use crate::state::{Body, State};
use crate::view::View;
use rapier3d_immersed::preset;
use rapier3d_immersed::rapier3d::prelude::RigidBodyHandle;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

/// Steps of the longest fall: ten minutes.
pub const LONGEST_FALL: u64 = 240 * 600;
const OVER: &str = "ten minutes are over: go back";
/// Steps between two settings of the same thing that were made in one go, by a slider.
const ONE_GO: u64 = 30;
/// Steps that are made for one picture at most; beyond, the bench runs slower than asked.
const MOST_STEPS: u64 = 12;
/// Slowest and fastest motion, times real time.
pub(crate) const SPEEDS: RangeInclusive<f64> = 0.02..=2.0;

/// What the bench is asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Changes the world. What had been undone or rewound is forgotten.
    Change(Change),
    /// Lets time go on, or stops it.
    Play(bool),
    /// How fast time goes, times real time.
    Speed(f64),
    /// So many steps.
    Step(u64),
    /// Back by a time, s.
    Rewind(f64),
    /// Takes the last change back.
    Undo,
    /// Begins a film, or drops the one that was begun.
    Record(bool),
    /// Writes the film: `.html`, `.gif` or `.glb`, by the name.
    Film(PathBuf),
    /// Writes the scene.
    Save(PathBuf),
    /// Reads a scene.
    Load(PathBuf),
}

/// A change, and the step before which it was made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// The step.
    pub step: u64,
    /// What was changed.
    pub change: Change,
}

/// A world, all that was changed in it, and the moments that were.
///
/// Everything that happens follows from the changes and the steps at which they were made: going back is to take a snapshot and
/// go on from it, and a file has the changes alone.
pub struct Bench {
    state: State,
    changes: Vec<Entry>,
    /// How many of the changes have been made; the others are in the future.
    done: usize,
    history: History,
    film: Option<Film>,
    playing: bool,
    speed: f64,
    /// Time that is still to be stepped, s.
    owed: f64,
    /// How it is looked at.
    pub view: View,
    /// What the last command has come to.
    pub message: String,
}

impl Default for Bench {
    fn default() -> Self {
        let state = State::default();
        let mut history = History::default();
        // The beginning is always kept, so that there is something to go back to.
        let message = history.keep(&state, 0).err().unwrap_or_default();
        Self {
            state,
            changes: Vec::new(),
            done: 0,
            history,
            film: None,
            playing: true,
            speed: 1.0,
            owed: 0.0,
            view: View::default(),
            message,
        }
    }
}

impl Bench {
    /// The world as it is.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The body that is spoken of, and rapier's handle of it.
    pub fn selected(&self) -> Option<(&Body, RigidBodyHandle)> {
        let index = self.view.selected?;
        Some((self.state.bodies.get(index)?, self.state.handle(index)?))
    }

    /// What has been changed.
    pub fn changes(&self) -> &[Entry] {
        &self.changes[..self.done]
    }

    /// Whether time goes on.
    pub fn is_playing(&self) -> bool {
        self.playing
    }

    /// How fast it goes, times real time.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Length of the film that is being made, s.
    pub fn film_length(&self) -> Option<f64> {
        self.film.as_ref().map(Film::length)
    }

    /// Carries a command out, and says in [`Bench::message`] what has come of it.
    ///
    /// # Errors
    /// Why it cannot be; the world is then as it was.
    pub fn apply(&mut self, command: Command) -> Result<(), String> {
        let outcome = self.carry_out(command);
        self.message = match &outcome {
            Ok(notes) => notes.clone(),
            Err(problem) => problem.clone(),
        };
        outcome.map(|_| ())
    }

    fn carry_out(&mut self, command: Command) -> Result<String, String> {
        match command {
            Command::Change(change) => self.change(change),
            Command::Play(playing) => {
                (self.playing, self.owed) = (playing, 0.0);
                Ok(String::new())
            }
            Command::Speed(speed) if speed.is_finite() => {
                self.speed = speed.clamp(*SPEEDS.start(), *SPEEDS.end());
                Ok(String::new())
            }
            Command::Speed(_) => Err("the speed is no number".into()),
            Command::Step(count) => {
                let end = self.state.step.saturating_add(count).min(LONGEST_FALL);
                self.step_to(end)?;
                Ok(self.notes())
            }
            Command::Rewind(seconds) => self.rewind(seconds),
            Command::Undo => self.undo(),
            Command::Record(on) => {
                self.film = on.then(|| Film::begin(&self.state));
                Ok(String::new())
            }
            Command::Film(path) => {
                let film = self.film.as_ref().ok_or("no film was begun")?;
                write(&path, &film.file(&path, &self.state)?)?;
                self.film = None;
                Ok(format!("{} written", path.display()))
            }
            Command::Save(path) => {
                let saved = Saved::new(self.state.step, self.view, self.changes().to_vec());
                write(&path, saved.to_text()?.as_bytes())?;
                Ok(format!("{} written", path.display()))
            }
            Command::Load(path) => {
                let text = std::fs::read_to_string(&path);
                let text = text.map_err(|error| format!("{}: {error}", path.display()))?;
                let read = Saved::from_text(&text).and_then(Self::load);
                *self = read.map_err(|problem| format!("{}: {problem}", path.display()))?;
                Ok(format!("{} read", path.display()))
            }
        }
    }

    /// The bench at the end of a saved scene.
    ///
    /// # Errors
    /// If a change cannot be made.
    pub fn load(saved: Saved) -> Result<Self, String> {
        let mut bench = Self {
            changes: saved.changes,
            view: saved.view,
            playing: false,
            ..Self::default()
        };
        bench.step_to(saved.step)?;
        bench.make_due()?;
        Ok(bench)
    }

    /// Goes on by a time of the user's, s, at the speed that is set.
    pub fn advance(&mut self, seconds: f64) {
        if !self.playing {
            return;
        }
        let dt = f64::from(preset::LEAF_DT);
        self.owed += seconds.max(0.0) * self.speed;
        let steps = (self.owed / dt) as u64;
        self.owed = if steps > MOST_STEPS {
            0.0
        } else {
            self.owed - steps as f64 * dt
        };
        let end = (self.state.step + steps.min(MOST_STEPS)).min(LONGEST_FALL);
        let outcome = self.step_to(end).map(|()| self.notes());
        let message = outcome.unwrap_or_else(|problem| problem);
        if !message.is_empty() {
            self.message = message;
        }
        if self.state.step == LONGEST_FALL {
            self.playing = false;
            self.message = OVER.into();
        }
    }

    /// Whether a command has to prepare something first, which takes a second or more.
    pub fn must_prepare(&self, command: &Command) -> bool {
        let mut settings = self.state.settings;
        let new = match command {
            Command::Change(Change::Set(setting)) => {
                setting.put(&mut settings);
                None
            }
            Command::Change(Change::Place(body)) => Some((body.shape, body.size)),
            Command::Change(Change::Rain(rain)) => Some((rain.shape, rain.size)),
            _ => return false,
        };
        let known = self.state.bodies.iter().map(|body| (body.shape, body.size));
        known
            .chain(new)
            .any(|(shape, size)| methods::must_prepare(settings.method, shape, size, &settings))
    }

    fn change(&mut self, change: Change) -> Result<String, String> {
        let (change, mut notes) = change.held()?;
        if self.state.step == LONGEST_FALL {
            return Err(OVER.into());
        }
        self.state.change(&change)?;
        self.view.forget(&change);
        self.changes.truncate(self.done);
        self.history.forget(self.state.step, self.done);
        let step = self.state.step;
        match self.changes.last_mut() {
            Some(last) if last.step == step && change.replaces(&last.change) => {
                last.change = change;
            }
            _ => self.changes.push(Entry { step, change }),
        }
        self.done = self.changes.len();
        notes.push(self.notes());
        notes.retain(|note| !note.is_empty());
        notes.dedup();
        Ok(notes.join("; "))
    }

    /// What the world has noted since this was last asked.
    fn notes(&mut self) -> String {
        let mut notes = std::mem::take(&mut self.state.notes);
        notes.dedup();
        notes.join("; ")
    }

    /// Makes the changes that were made at this step.
    fn make_due(&mut self) -> Result<(), String> {
        while let Some(entry) = self.changes.get(self.done)
            && entry.step == self.state.step
        {
            self.state.change(&entry.change)?;
            self.done += 1;
        }
        Ok(())
    }

    fn step_to(&mut self, end: u64) -> Result<(), String> {
        while self.state.step < end {
            self.make_due()?;
            self.state.step();
            self.history.keep(&self.state, self.done)?;
            if let Some(film) = &mut self.film {
                film.keep(&self.state);
            }
        }
        self.make_due()
    }

    fn rewind(&mut self, seconds: f64) -> Result<String, String> {
        if !seconds.is_finite() {
            return Err("the time is no number".into());
        }
        let back = (seconds.max(0.0) / f64::from(preset::LEAF_DT)).round() as u64;
        self.go_to(self.state.step.saturating_sub(back))?;
        self.owed = 0.0;
        Ok(String::new())
    }

    /// The world as it was at a step, with the changes that were made then.
    fn go_to(&mut self, step: u64) -> Result<(), String> {
        let (state, done) = self.history.before(step)?;
        (self.state, self.done) = (state, done);
        if let Some(film) = &mut self.film {
            film.cut(step);
        }
        self.step_to(step)
    }

    /// Takes back the last change; of settings that a slider has made in one go, all.
    fn undo(&mut self) -> Result<String, String> {
        let step = self.state.step;
        let mut first = self.done.checked_sub(1).ok_or("nothing to undo")?;
        let changes = &mut self.changes;
        while let Some([before, after]) =
            first.checked_sub(1).map(|i| [&changes[i], &changes[first]])
            && after.change.replaces(&before.change)
            && after.step - before.step < ONE_GO
        {
            first -= 1;
        }
        let began = changes[first].step;
        changes.truncate(first);
        self.history.forget(step, first);
        if let Some(film) = &mut self.film {
            film.cut(began);
        }
        self.go_to(step)?;
        Ok(String::new())
    }
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    std::fs::write(path, bytes).map_err(|error| format!("{}: {error}", path.display()))
}
