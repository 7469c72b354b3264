//! Added mass of any shape by boundary elements.

mod assemble;
mod pair;
mod panel;
mod solve;
#[cfg(test)]
mod scratch;
