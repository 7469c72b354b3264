//! Laws of the reduced models.

mod anchors;
mod identify;
mod surrogate;
mod thesis;
