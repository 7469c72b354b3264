//! Laws of the reduced models.

mod anchors;
#[path = "../../examples/identify/card.rs"]
mod card;
#[path = "../../examples/reduced_models/errors.rs"]
mod errors;
#[path = "../../examples/reduced_models/force_coefficients.rs"]
mod force_coefficients;
#[path = "../../examples/reduced_models/free_fall.rs"]
mod free_fall;
mod identify;
mod identify_card;
mod own_dynamics;
mod surrogate;
mod thesis;
