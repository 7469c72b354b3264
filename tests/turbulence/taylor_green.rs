//! Taylor–Green vortices decay as e^{−2νt}: order of the schemes in space and time together.

use rapier3d_immersed::turbulence::grid::{Advection, MacGrid, MacGridParams, Viscosity};
use std::f64::consts::TAU;

/// Largest error of u after `time` on n² cells with a Courant number of about `courant`.
fn error(n: usize, advection: Advection, viscosity: f64, courant: f64) -> f64 {
    let h = TAU / n as f64;
    let mut grid = MacGrid::new(&MacGridParams {
        cells: [n, n, 1],
        cell_size: h,
        viscosity,
        advection,
        viscous_step: Viscosity::CrankNicolson,
        ..MacGridParams::default()
    })
    .unwrap();
    let exact = |x: [f64; 3], t: f64| {
        let decay = (-2.0 * viscosity * t).exp();
        [
            x[0].sin() * x[1].cos() * decay,
            -x[0].cos() * x[1].sin() * decay,
            0.0,
        ]
    };
    grid.set_velocity(|x| exact(x, 0.0)).unwrap();
    let steps = (1.0 / (courant * h)).ceil() as usize;
    let dt = 1.0 / steps as f64;
    for _ in 0..steps {
        let report = grid.step(dt).unwrap();
        assert!(report.divergence < 1.0e-9, "{}", report.divergence);
    }
    let mut worst: f64 = 0.0;
    for j in 0..n {
        for i in 0..n {
            // Faces of u, where nothing is interpolated.
            let x = [i as f64 * h, (j as f64 + 0.5) * h, 0.5 * h];
            worst = worst.max((grid.velocity(x)[0] - exact(x, 1.0)[0]).abs());
        }
    }
    worst
}

/// Semi-Lagrangian advection is of first order along dt ∝ h. The corrected schemes are of second
/// order in space, seen along dt ∝ h²; in time the splitting of advection and projection leaves
/// first order (Zehnder et al. 2018), at a fraction of the semi-Lagrangian error.
#[test]
fn orders_are_as_advertised() {
    let coarse = error(48, Advection::SemiLagrangian, 0.05, 0.5);
    let fine = error(96, Advection::SemiLagrangian, 0.05, 0.5);
    let order = (coarse / fine).log2();
    println!("semi-Lagrangian: errors {coarse:.5} {fine:.5}, order {order:.2}");
    assert!((order - 1.0).abs() < 0.15, "{order}");
    for advection in [Advection::MacCormack, Advection::Bfecc] {
        let errors = [16, 32, 64].map(|n| error(n, advection, 0.05, 8.0 / n as f64));
        let orders = [errors[0] / errors[1], errors[1] / errors[2]].map(f64::log2);
        println!("{advection:?}: errors {errors:.5?}, orders {orders:.2?} along dt ~ h²");
        assert!(orders[1] > 1.75, "{orders:?}");
        let along_h = [32, 64].map(|n| error(n, advection, 0.05, 0.5));
        println!(
            "  along dt ~ h {along_h:.5?}, order {:.2}",
            (along_h[0] / along_h[1]).log2()
        );
        assert!(along_h[1] < 0.4 * coarse);
    }
}

/// Viscous decay alone, at tiny advection error: the kinetic energy of a shear wave falls as e^{−2νk²t}, which
/// advection does not touch; each viscous step at its own order in dt.
#[test]
fn shear_wave_decays_at_the_order_of_the_viscous_step() {
    let run = |viscous_step, steps: u32| {
        let n = 16;
        let mut grid = MacGrid::new(&MacGridParams {
            cells: [n, n, 1],
            cell_size: TAU / n as f64,
            viscosity: 0.5,
            viscous_step,
            ..MacGridParams::default()
        })
        .unwrap();
        grid.set_velocity(|x| [x[1].sin(), 0.0, 0.0]).unwrap();
        for _ in 0..steps {
            grid.step(1.0 / f64::from(steps)).unwrap();
        }
        // The second difference of sin has eigenvalue (2/h sin(h/2))².
        let h = TAU / 16.0;
        let exact = (-0.5 * (2.0 / h * (0.5 * h).sin()).powi(2)).exp();
        let x = [0.0, 3.5 * h, 0.0];
        (grid.velocity(x)[0] / (x[1].sin()) - exact).abs()
    };
    for (step, order) in [
        (Viscosity::Explicit, 1.0),
        (Viscosity::Implicit, 1.0),
        (Viscosity::CrankNicolson, 2.0),
    ] {
        let found = (run(step, 40) / run(step, 80)).log2();
        println!("{step:?}: order {found}");
        assert!((found - order).abs() < 0.05, "{step:?}: {found}");
    }
}
