//! Incompressible flow on a staggered (MAC) grid, in two or three dimensions (thesis §4.5, Algorithm 1).
//!
//! Velocity components live on the faces of cubic cells (Harlow & Welch 1965), pressure in their
//! centers. A step is advection along the flow (semi-Lagrangian, Stam 1999; or its second-order
//! corrections), viscous diffusion, and a projection onto fields without divergence.
//!
//! [`MacGrid::new`] takes [`MacGridParams`]; then give it a velocity ([`MacGrid::set_velocity`]), an obstacle
//! ([`MacGrid::set_obstacle`]) or an inflow ([`Boundary::Inflow`]), call [`MacGrid::step`], and take the flow
//! out with [`MacGrid::to_grid_flow`].

mod advection;
mod array;
mod boundary;
mod diffusion;
mod mac_grid;
mod params;
mod projection;
mod query;
mod separable;
mod step;
mod viscosity;

pub use boundary::Boundary;
pub use mac_grid::MacGrid;
pub use params::{Advection, MacGridParams, StepReport, Viscosity};

pub(crate) use advection::advect;
pub(crate) use array::Array3;
