//! The machines of the example `machines`, against exact, published or independently computed numbers.

#[allow(dead_code, reason = "tests draw nothing")]
#[path = "../../examples/support/draw.rs"]
mod draw;
#[allow(dead_code, reason = "tests draw nothing")]
#[path = "../../examples/machines/film.rs"]
mod film;
#[path = "../../examples/machines/fold.rs"]
mod fold;

#[allow(dead_code, reason = "tests draw nothing")]
#[path = "../../examples/machines/dart.rs"]
mod dart;
#[allow(dead_code, reason = "tests draw nothing")]
#[path = "../../examples/machines/glider.rs"]
mod glider;
#[allow(dead_code, reason = "tests draw nothing")]
#[path = "../../examples/machines/kite.rs"]
mod kite;
#[allow(dead_code, reason = "tests draw nothing")]
#[path = "../../examples/machines/parachute.rs"]
mod parachute;
#[allow(dead_code, reason = "tests draw nothing")]
#[path = "../../examples/machines/rov.rs"]
mod rov;
#[allow(dead_code, reason = "tests draw nothing")]
#[path = "../../examples/machines/twig.rs"]
mod twig;

#[path = "dart.rs"]
mod test_of_dart;
#[path = "glider.rs"]
mod test_of_glider;
#[path = "kite.rs"]
mod test_of_kite;
#[path = "parachute.rs"]
mod test_of_parachute;
#[path = "rov.rs"]
mod test_of_rov;
#[path = "twig.rs"]
mod test_of_twig;

type Failure = Box<dyn std::error::Error>;
