//! Reduced models by separated representation (thesis chapter 6).

pub mod axis;
pub mod canonical;
mod legendre;
pub mod operator;
pub mod pgd;
pub mod dormand_prince;
pub mod quadratic;
pub mod evolution;
pub mod separated;
