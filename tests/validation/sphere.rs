//! Spheres, for which everything is known.

use crate::support::sphere;
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::{Fluid, FreeBody};

/// Drag coefficient of Clift & Gauvin 1971.
fn clift_gauvin(re: f64) -> f64 {
    24.0 / re * (1.0 + 0.15 * re.powf(0.687)) + 0.42 / (1.0 + 42500.0 * re.powf(-1.16))
}

/// Terminal speed over a Reynolds number range of six decades, by choosing the density excess
/// for each: the drag at the wanted speed must balance the weight.
#[test]
fn terminal_speed_follows_the_drag_curve() {
    let (radius, fluid) = (0.01, Fluid::new(1.0, 1e-4).unwrap());
    let gravity = 9.81;
    for exponent in -1..=5 {
        let re = 10f64.powi(exponent);
        let speed = re * 1e-4 / (2.0 * radius);
        let drag = 0.5 * clift_gauvin(re) * std::f64::consts::PI * radius * radius * speed * speed;
        let volume = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
        let density = 1.0 + drag / (volume * gravity);
        let (body, mass) = sphere(radius, density);
        let mut body = FreeBody::new(&body, &mass, &fluid).unwrap();
        // Long enough for 20 relaxation times m v/F.
        let relaxation = (density + 0.5) * volume * speed / drag;
        for _ in 0..4000 {
            body.step(relaxation / 200.0, Vector3::new(0.0, -gravity, 0.0));
        }
        let fall = -body.linear_velocity().y;
        assert!(
            (fall / speed - 1.0).abs() < 0.02,
            "Re {re}: {fall} instead of {speed}"
        );
    }
}

#[test]
fn neutrally_buoyant_sphere_hangs_still() {
    let density = f64::from(Fluid::WATER.density());
    let (body, mass) = sphere(0.05, density);
    let mut body = FreeBody::new(&body, &mass, &Fluid::WATER).unwrap();
    for _ in 0..600 {
        body.step(1.0 / 60.0, Vector3::new(0.0, -9.81, 0.0));
    }
    assert!(body.position.norm() < 1e-6, "{}", body.position);
}

/// At first a light sphere rises with (ρ − ρ_s) g / (ρ_s + ρ/2): it drags half its volume along.
#[test]
fn light_sphere_feels_its_added_mass() {
    let (rho, rho_s) = (f64::from(Fluid::WATER.density()), 30.0);
    let (body, mass) = sphere(0.05, rho_s);
    let mut body = FreeBody::new(&body, &mass, &Fluid::WATER).unwrap();
    let dt = 1e-4;
    body.step(dt, Vector3::new(0.0, -9.81, 0.0));
    let exact = (rho - rho_s) * 9.81 / (rho_s + rho / 2.0);
    let acceleration = body.linear_velocity().y / dt;
    assert!(
        (acceleration / exact - 1.0).abs() < 0.01,
        "{acceleration} {exact}"
    );
}
