#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod error;
pub mod flow;
pub mod fluid;
pub mod reduced;

pub use error::Error;
pub use fluid::Fluid;
pub use rapier3d;
