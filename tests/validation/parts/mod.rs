//! Bodies of several parts.

mod division;
mod energy;
mod laws;
mod sums;
mod thrust;
