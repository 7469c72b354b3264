//! Graph-based synthesis (thesis chapter 3): falls put together from motion segments, without forces.
//!
//! This is cheap motion that can be directed: [`Segment`]s cut from a harmonic flutter (3.6), orientation
//! from the equations of [`TanabeKaneko`] (3.4), the [`UnifiedCurve`] of spirals and helices (3.7), and a
//! Markov chain over the six regimes that says what follows what.
//!
//! A [`Synthesizer`] makes falls of one body in one fluid out of a [`TrajectoryDatabase`], the one that
//! ships or one of your own, as [`SynthesisParams`] ask for; [`Synthesizer::path`] gives one per seed. The
//! result is a [`MotionPath`], to be evaluated at any time, bent by wind ([`MotionPath::in_wind`]) or played
//! by a body ([`MotionPlayers`](crate::playback::MotionPlayers)).
//!
//! Two sorts of coordinates: the *glide plane* has x along the glide and y up, angles counter-clockwise
//! from x to y; the *fall's frame* has y up, the glide plane at z = 0, and the release at its origin.

mod amplitude;
#[cfg(feature = "bake")]
mod bake;
mod chain;
mod curve;
mod database;
mod database_file;
mod drift;
mod frame_walk;
mod frames;
mod level;
mod params;
mod piece;
mod search_tree;
mod segment;
mod shape;
mod synthesis;
mod tanabe_kaneko;
mod track;
mod wind;

pub use amplitude::Deviation;
#[cfg(feature = "bake")]
pub use bake::{BakeReport, DatabaseParams};
pub use chain::motion_classes;
pub use curve::UnifiedCurve;
pub use database::{Entry, TrajectoryDatabase};
pub use frames::{FrameGraph, FrameGraphParams, FrameSplice};
pub use params::SynthesisParams;

pub use segment::{Glide, HarmonicFlutter, Segment};
pub use shape::HorizontalShape;
pub use synthesis::{Splice, Synthesizer};
pub use tanabe_kaneko::{AngleCurve, Fall, State, TanabeKaneko};
pub use track::{Key, MotionPath};
pub use wind::WindResponse;
