//! A body that the boundary of two fluids cuts.
//!
//! Between the fluids of a [`Medium`](crate::Medium) a body has a share in each: of its volume, which buoyancy and the
//! pressure of an accelerating flow act on, and with it of its added mass and of the forces of its law. So the body is
//! integrated as one of several parts, one for each fluid that it is in, each at the middle of what is in that fluid:
//! [`cut`] finds those, [`reaction`] adds their forces up. Where a body is whole in one fluid all of it is what it is
//! there.
//!
//! # Added mass that changes
//! The added mass is the share of the volume times that of the whole, at the middle of the share (exact for a body
//! that is cut in half along a plane of symmetry, by the image of what is wetted in the surface: the surface is free
//! of pressure, and does not reflect). When it changes from 𝕄₀ to 𝕄₁ the velocity does, too: [`transfer`].
//!
//! # Buoyancy
//! is that of the volume cut off, exact for a polyhedron, with the hydrostatic stiffness of the waterplane taken
//! linearly implicitly (average acceleration: a quarter of h²K on the left), so that a crate on a step of any length
//! bobs and does not blow up. The stiffness is limited to what the body can still displace or lift out on its way.

mod constants;
mod cut;
mod forces;
mod hydrostatics;
mod integrate;
mod portion;
mod reaction;
mod transfer;

pub(crate) use constants::CrossingConstants;
pub(crate) use cut::{Cut, Place};
pub use hydrostatics::Hydrostatics;
pub(crate) use integrate::{CrossingStep, Moved};
pub(crate) use portion::Portion;
pub(crate) use transfer::FluidMass;
