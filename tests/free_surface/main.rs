//! The surface between two fluids: linear waves, random seas, sampled heights.

mod field;
mod linear;
mod sea;

use rapier3d_immersed::free_surface::FreeSurface;
use rapier3d_immersed::rapier3d::na::{Matrix3, Vector3};

/// Derivatives of the velocity along x, y and z (columns), by central differences.
fn gradient(surface: &dyn FreeSurface, point: Vector3<f64>, time: f64, h: f64) -> Matrix3<f64> {
    Matrix3::from_columns(&[0, 1, 2].map(|axis| {
        let step = Vector3::ith(axis, h);
        let ahead = surface.velocity(&(point + step), time);
        (ahead - surface.velocity(&(point - step), time)) / (2.0 * h)
    }))
}

/// A point at the surface.
fn at_surface(surface: &dyn FreeSurface, x: f64, z: f64, time: f64) -> Vector3<f64> {
    Vector3::new(x, surface.elevation(x, z, time).height, z)
}

/// How fast the surface rises at a place of the level.
fn rise(surface: &dyn FreeSurface, x: f64, z: f64, time: f64) -> f64 {
    let height = |time| surface.elevation(x, z, time).height;
    (height(time + 1e-5) - height(time - 1e-5)) / 2e-5
}
