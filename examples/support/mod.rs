//! What the examples share: command line, meshes, scenes, statistics, pictures, animation files.
//!
//! Every example includes this module with `mod support;` and uses its own part of it.
#![allow(dead_code, reason = "each example uses its own part")]

pub mod airplane;
pub mod cli;
pub mod draw;
pub mod fall;
pub mod gallery;
pub mod glb;
pub mod law;
pub mod leaf;
pub mod mesh;
pub mod picture;
pub mod previous;
pub mod recording;
pub mod scene;
pub mod seed;
pub mod sheet;
pub mod specimen;
pub mod statistics;
pub mod summary;

/// World axes: y is up, as in rapier's default gravity and in glTF.
pub type Vec3 = rapier3d_immersed::rapier3d::na::Vector3<f64>;
/// An orientation in f64.
pub type Quat = rapier3d_immersed::rapier3d::na::UnitQuaternion<f64>;
