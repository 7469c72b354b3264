//! Bodies at the surface between two fluids.

mod exact;
