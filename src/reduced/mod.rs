//! Reduced models by separated representation (thesis chapter 6).

pub mod axis;
pub mod canonical;
pub mod cross;
pub mod dormand_prince;
pub mod evolution;
pub mod example_systems;
pub mod falling_plate;
#[cfg(feature = "serde-serialize")]
mod file;
pub mod identify;
mod legendre;
pub mod operator;
mod orthogonal;
pub mod pgd;
pub mod quadratic;
pub mod separated;
pub mod surrogate;
pub mod tensor_train;
