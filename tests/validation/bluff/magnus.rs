//! Lift of spinning balls.

use super::to_f64;
use crate::support::sphere;
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::{Fluid, FreeBody, PhysicalLaw, ViscousLaw};

/// Lift coefficient of a ball of 7 cm that spins about `axis` at the spin ratio, at 20 m/s along x.
fn lift(law: PhysicalLaw, ratio: f64, axis: Vector3<f64>) -> Vector3<f64> {
    let radius = 0.035;
    let (mut body, mass) = sphere(radius, 700.0);
    body.law = ViscousLaw::Physical(law);
    let mut free = FreeBody::new(&body, &mass, &Fluid::AIR).unwrap();
    let speed = 20.0;
    free.set_velocity(Vector3::x() * speed, axis * (ratio * speed / radius));
    let dynamic = 0.5 * f64::from(Fluid::AIR.density()) * speed * speed;
    let area = std::f64::consts::PI * radius * radius;
    to_f64(free.forces(Vector3::zeros()).rotational_lift.force) / (dynamic * area)
}

/// Three published curves of baseballs, from S = 0.05 to 1: the fit that the law has, `S/(2.32 S + 0.4)`
/// (Nathan's, of the data collected in *Am. J. Phys.* 76, 119 (2008)); that of Sawicki, Hubbard & Stronge,
/// *Am. J. Phys.* 71, 1152 (2003), `1.5 S` up to S = 0.1, `0.09 + 0.6 S` above; and Nathan's trajectory
/// calculator's, `1.12 S/(0.583 + 2.333 S)`. They differ from each other by up to a third.
#[test]
fn lift_of_balls_is_as_measured() {
    for ratio in [0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0] {
        let found = lift(PhysicalLaw::default(), ratio, Vector3::z());
        // Spin about z, motion along x: ω × u is along y.
        assert!(found.x.abs() + found.z.abs() < 1e-6, "{found}");
        let fit = ratio / (2.32 * ratio + 0.4);
        let facets = 0.01;
        assert!(
            (found.y / fit - 1.0).abs() < facets,
            "{ratio}: {found} {fit}"
        );
        let calculator = 1.12 * ratio / (0.583 + 2.333 * ratio);
        assert!((found.y / calculator - 1.0).abs() < 0.3, "{ratio}: {found}");
        if (0.1..=0.6).contains(&ratio) {
            let sawicki = 0.09 + 0.6 * ratio;
            assert!((found.y / sawicki - 1.0).abs() < 0.3, "{ratio}: {found}");
        }
    }
}

/// Spin along the motion lifts nothing, and is not counted where there is spin across as well; twice the
/// coefficient is twice the lift, and none is none.
#[test]
fn only_spin_across_the_motion_lifts() {
    let law = PhysicalLaw::default();
    let along = lift(law, 0.3, Vector3::x());
    assert!(along.norm() < 1e-6, "{along}");
    let across = lift(law, 0.3, Vector3::y());
    let both = lift(law, 0.3, Vector3::new(2.0, 1.0, 0.0));
    assert!((both - across).norm() < 1e-5, "{both} {across}");
    assert!(across.z < -0.1, "{across}");
    let twice = lift(PhysicalLaw { magnus: 2.0, ..law }, 0.3, Vector3::y());
    assert!((twice - across * 2.0).norm() < 1e-5);
    let none = lift(PhysicalLaw { magnus: 0.0, ..law }, 0.3, Vector3::y());
    // The facets of its surface leave next to nothing of a plate.
    assert!(none.norm() < 1e-12, "{none}");
}
