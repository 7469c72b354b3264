#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod binary;
pub mod error;
pub mod flow;
pub mod fluid;
pub mod turbulence;

pub use error::Error;
pub use fluid::Fluid;
pub use rapier3d;
