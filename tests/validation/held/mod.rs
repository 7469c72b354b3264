//! Bodies that something holds: one promise per module.

mod energy;
mod energy_scene;
mod extremes;
mod friction;
mod joints;
mod locked;
mod moments;
mod pendulum;
mod swimmer;
mod swing;
mod touching;
mod windmill;
