//! Graph-based synthesis (thesis chapter 3): falls put together from motion segments, without forces.
//!
//! Cheap motion that can be directed: [`Segment`]s cut from a harmonic flutter (3.6), orientation from
//! the equations of [`TanabeKaneko`] (3.4), the [`UnifiedCurve`] of spirals and helices (3.7), and a
//! Markov chain over the six regimes that says what follows what.
//!
//! Two sorts of coordinates: the *glide plane* has x along the glide and y up, angles counter-clockwise
//! from x to y; the *fall's frame* has y up, the glide plane at z = 0, and the release at its origin.

pub mod amplitude;
pub mod curve;
pub mod segment;
pub mod shape;
pub mod tanabe_kaneko;

pub use amplitude::{Deviation, chaotic_factor};
pub use curve::UnifiedCurve;
pub use segment::{Glide, HarmonicFlutter, Segment};
pub use shape::HorizontalShape;
pub use tanabe_kaneko::{AngleCurve, Fall, TanabeKaneko};
