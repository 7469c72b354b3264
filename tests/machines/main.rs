//! The machines of the example `machines`, against exact, published and independently integrated values.

#[path = "../../examples/machines/anemometer.rs"]
#[allow(dead_code, reason = "shared with the example")]
mod anemometer;
#[path = "../../examples/machines/arrow.rs"]
#[allow(dead_code, reason = "shared with the example")]
mod arrow;
#[path = "../../examples/machines/boomerang.rs"]
#[allow(dead_code, reason = "shared with the example")]
mod boomerang;
#[path = "../../examples/support/draw.rs"]
#[allow(dead_code, reason = "shared with the examples")]
mod draw;
#[path = "../../examples/machines/film.rs"]
#[allow(dead_code, reason = "shared with the example")]
mod film;
#[path = "../../examples/machines/frisbee.rs"]
#[allow(dead_code, reason = "shared with the example")]
mod frisbee;
#[path = "../../examples/machines/shuttlecock.rs"]
#[allow(dead_code, reason = "shared with the example")]
mod shuttlecock;
#[path = "../../examples/machines/stage.rs"]
mod stage;
#[path = "../../examples/machines/weather_vane.rs"]
#[allow(dead_code, reason = "shared with the example")]
mod weather_vane;
#[path = "../../examples/machines/windmill.rs"]
#[allow(dead_code, reason = "shared with the example")]
mod windmill;

#[path = "anemometer.rs"]
mod anemometer_test;
#[path = "arrow.rs"]
mod arrow_test;
#[path = "boomerang.rs"]
mod boomerang_test;
#[allow(dead_code, reason = "tests draw nothing")]
#[path = "../../examples/machines/dart.rs"]
mod dart;
#[path = "../../examples/machines/fold.rs"]
mod fold;
#[path = "frisbee.rs"]
mod frisbee_test;
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
#[path = "scope.rs"]
mod scope_test;
#[path = "shuttlecock.rs"]
mod shuttlecock_test;
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
#[allow(dead_code, reason = "tests draw nothing")]
#[path = "../../examples/machines/twig.rs"]
mod twig;
#[path = "weather_vane.rs"]
mod weather_vane_test;
#[path = "windmill.rs"]
mod windmill_test;

type Failure = Box<dyn std::error::Error>;

/// Slope of the lift of a wing of an aspect ratio, 1/rad: H. B. Helmbold, *Jb. 1942 dt. Luftfahrtforschung* I, 111.
fn helmbold(aspect: f64) -> f64 {
    std::f64::consts::TAU * aspect / (2.0 + (aspect * aspect + 4.0).sqrt())
}

/// Undamped angular frequency of an oscillation that decays, rad/s, and its decay rate, 1/s, from (time, angle): between its
/// first two passages through zero and by its first two extremes after the first of them.
fn oscillation(curve: &[(f64, f64)]) -> (f64, f64) {
    let passages: Vec<usize> = (1..curve.len())
        .filter(|i| curve[i - 1].1 * curve[*i].1 <= 0.0)
        .collect();
    let time = |i: usize| {
        let ((s, a), (t, b)) = (curve[i - 1], curve[i]);
        s + (t - s) * a / (a - b)
    };
    let extreme = |from: usize, to: usize| {
        let inside = curve[from..to].iter().map(|(_, angle)| angle.abs());
        inside.fold(0.0, f64::max)
    };
    assert!(passages.len() > 2, "{} passages", passages.len());
    let half = time(passages[1]) - time(passages[0]);
    let first = extreme(passages[0], passages[1]);
    let second = extreme(passages[1], passages[2]);
    let decay = (first / second).ln() / half;
    let damped = std::f64::consts::PI / half;
    (damped.hypot(decay), decay)
}

/// What the description of a machine gives, or its problem.
fn must<T>(made: Result<T, Failure>) -> T {
    made.unwrap_or_else(|problem| panic!("{problem}"))
}
