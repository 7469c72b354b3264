//! The weather vane's swing against the weathervane formula about its axle.

use crate::weather_vane::{BEHIND, CHORD, HEIGHT, WIND, WeatherVane};
use crate::{helmbold, must, oscillation};
use rapier3d_immersed::rapier3d::na::{Vector3, Vector6};
use std::f64::consts::TAU;

/// `√(½ρV²A·l·C_Lα/I)/2π` with the lift slope of Helmbold, l from the axle to the fin's quarter chord, and the inertia about
/// the axle: of the vane and of the air that it moves.
fn weathervane(vane: &WeatherVane) -> f64 {
    let [height, chord, behind, wind] = [HEIGHT, CHORD, BEHIND, WIND].map(f64::from);
    let center = vane.immersion.mass_of(vane.vane).unwrap().center;
    let matrix = vane.immersion.mass_matrix_of(vane.vane).unwrap();
    // What moves when it turns at 1 rad/s.
    let moves = Vector3::y().cross(&center);
    let motion = Vector6::new(moves.x, moves.y, moves.z, 0.0, 1.0, 0.0);
    let inertia = motion.dot(&(matrix * motion));
    let arm = behind - 0.25 * chord;
    let pressure = 0.5 * f64::from(vane.immersion.fluid().density()) * wind * wind;
    (pressure * height * chord * arm * helmbold(height / chord) / inertia).sqrt() / TAU
}

/// Let go at 3°, where the fin's lift is linear. 3 %: the formula leaves out the moment of the rod's own air (Munk's) and that the
/// lift's point is not quite at the quarter chord.
#[test]
fn swings_as_a_weathervane() {
    for hz in [60.0, 240.0] {
        let mut vane = must(WeatherVane::new(3f32.to_radians(), hz));
        vane.step();
        let expected = weathervane(&vane);
        let (frequency, _) = oscillation(&vane.curve(3.0));
        let frequency = frequency / TAU;
        assert!(
            (frequency / expected - 1.0).abs() < 0.03,
            "{frequency} {expected}"
        );
    }
}

/// From any angle but straight with the wind, where it is in balance, it comes to point into it.
#[test]
fn turns_into_the_wind() {
    for hz in [60.0, 240.0] {
        for degrees in (-175..180).step_by(25) {
            let mut vane = must(WeatherVane::new((degrees as f32).to_radians(), hz));
            vane.curve(6.0);
            let end = vane.angle().to_degrees();
            assert!(end.abs() < 0.5, "{degrees}: {end}");
        }
    }
}
