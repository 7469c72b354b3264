//! Bodies that something holds.

mod energy;
mod energy_scene;
