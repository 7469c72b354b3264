//! What the examples share: command line, meshes, scenes, pictures, animation files.
//!
//! Every example includes this module with `mod support;` and uses its own part of it;
//! `draw.rs` and `previous.rs`, which need nothing else of it, are included by their path.
#![allow(dead_code, reason = "each example uses its own part")]

pub mod airplane;
pub mod cli;
pub mod fall;
pub mod film;
pub mod gallery;
pub mod gif;
pub mod glb;
pub mod html;
pub mod law;
pub mod leaf;
pub mod mesh;
pub mod options;
pub mod picture;
pub mod raster;
pub mod recording;
pub mod reel;
pub mod replay;
pub mod scene;
pub mod series;
pub mod shape;
pub mod sheet;
pub mod specimen;
pub mod summary;
pub mod track;

use rapier3d_immersed::rapier3d::math::Vector;

/// World axes: y is up, as in rapier's default gravity and in glTF.
pub type Vec3 = rapier3d_immersed::rapier3d::na::Vector3<f64>;
/// An orientation in f64.
pub type Quat = rapier3d_immersed::rapier3d::na::UnitQuaternion<f64>;

/// From rapier's single precision.
pub fn from_rapier(v: Vector) -> Vec3 {
    Vec3::new(v.x.into(), v.y.into(), v.z.into())
}

/// To rapier's single precision.
pub fn to_rapier(v: &Vec3) -> Vector {
    Vector::new(v.x as f32, v.y as f32, v.z as f32)
}
