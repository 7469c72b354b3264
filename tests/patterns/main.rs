//! Motion patterns: training, planning and playback, end to end.

mod annealing;
mod sequences;
mod sketch;
mod support;
mod training;
