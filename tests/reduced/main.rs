//! Laws of the reduced models.

mod anchors;
mod thesis;
