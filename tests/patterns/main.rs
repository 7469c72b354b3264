//! Motion patterns: training, planning and playback, end to end.

mod annealing;
mod conditions;
mod presets;
mod sequences;
mod sketch;
mod support;
mod training;
