//! Laws of the reduced models.

mod alternatives;
mod anchors;
#[path = "../../examples/identify/card.rs"]
mod card;
mod driven;
#[path = "../../examples/reduced_models/errors.rs"]
mod errors;
#[allow(dead_code, reason = "the example writes them, too")]
#[path = "../../examples/tracks/fits.rs"]
mod fits;
#[path = "../../examples/reduced_models/force_coefficients.rs"]
mod force_coefficients;
#[allow(dead_code, reason = "shared with the example's pictures")]
#[path = "../../examples/tracks/forecast.rs"]
mod forecast;
#[path = "../../examples/reduced_models/free_fall.rs"]
mod free_fall;
mod identify;
mod identify_card;
mod kirchhoff;
#[path = "../../examples/tracks/measured.rs"]
mod measured;
mod own_dynamics;
mod surrogate;
mod thesis;
mod tracks;
