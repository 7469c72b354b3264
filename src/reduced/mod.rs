//! Reduced models by separated representation (thesis chapter 6).

pub mod axis;
mod legendre;
