//! Laws of the reduced models.

mod anchors;
mod surrogate;
mod thesis;
