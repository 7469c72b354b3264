//! Lid-driven cavity against Ghia, Ghia & Shin (1982), J. Comput. Phys. 48, 387, Tables I and II;
//! projection around an obstacle; bad parameters.

use rapier3d_immersed::flow::Uniform;
use rapier3d_immersed::turbulence::grid::{Advection, Boundary, MacGrid, MacGridParams, Viscosity};
use std::sync::Arc;

/// y and u on the vertical line through the center, for Re 100 and 1000.
const U: [(f64, f64, f64); 15] = [
    (0.9766, 0.84123, 0.65928),
    (0.9688, 0.78871, 0.57492),
    (0.9609, 0.73722, 0.51117),
    (0.9531, 0.68717, 0.46604),
    (0.8516, 0.23151, 0.33304),
    (0.7344, 0.00332, 0.18719),
    (0.6172, -0.13641, 0.05702),
    (0.5000, -0.20581, -0.06080),
    (0.4531, -0.21090, -0.10648),
    (0.2813, -0.15662, -0.27805),
    (0.1719, -0.10150, -0.38289),
    (0.1016, -0.06434, -0.29730),
    (0.0703, -0.04775, -0.22220),
    (0.0625, -0.04192, -0.20196),
    (0.0547, -0.03717, -0.18109),
];

/// x and v on the horizontal line through the center, for Re 100 and 1000.
const V: [(f64, f64, f64); 15] = [
    (0.9688, -0.05906, -0.21388),
    (0.9609, -0.07391, -0.27669),
    (0.9531, -0.08864, -0.33714),
    (0.9453, -0.10313, -0.39188),
    (0.9063, -0.16914, -0.51550),
    (0.8594, -0.22445, -0.42665),
    (0.8047, -0.24533, -0.31966),
    (0.5000, 0.05454, 0.02526),
    (0.2344, 0.17527, 0.32235),
    (0.2266, 0.17507, 0.33075),
    (0.1563, 0.16077, 0.37095),
    (0.0938, 0.12317, 0.32627),
    (0.0781, 0.10890, 0.30353),
    (0.0703, 0.10091, 0.29012),
    (0.0625, 0.09233, 0.27485),
];

fn cavity(n: usize, reynolds: f64, advection: Advection) -> MacGrid {
    let wall = Boundary::Wall([0.0; 3]);
    let mut boundaries = [
        [wall.clone(), wall.clone()],
        [wall.clone(), wall],
        Default::default(),
    ];
    boundaries[1][1] = Boundary::Wall([1.0, 0.0, 0.0]);
    MacGrid::new(&MacGridParams {
        cells: [n, n, 1],
        cell_size: 1.0 / n as f64,
        viscosity: 1.0 / reynolds,
        boundaries,
        advection,
        viscous_step: Viscosity::Implicit,
    })
    .unwrap()
}

/// Steps until the speeds change by less than 2e-5 per unit of time; largest deviation from the tables.
fn deviation(grid: &mut MacGrid, courant: f64, column: usize, longest: f64) -> (f64, f64) {
    let dt = courant * grid.cell_size();
    let probe = |grid: &MacGrid| {
        let u = U.map(|row| grid.velocity([0.5, row.0, 0.0])[0]);
        let v = V.map(|row| grid.velocity([row.0, 0.5, 0.0])[1]);
        [u, v].concat()
    };
    let mut last = probe(grid);
    let mut next_check = grid.time() + 1.0;
    while grid.time() < longest {
        let report = grid.step(dt).unwrap();
        assert!(report.divergence < 1.0e-9, "{}", report.divergence);
        if grid.time() >= next_check {
            next_check += 1.0;
            let now = probe(grid);
            let change = now
                .iter()
                .zip(&last)
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f64::max);
            last = now;
            if change < 2.0e-5 {
                break;
            }
        }
    }
    let table = U
        .iter()
        .chain(&V)
        .map(|row| if column == 0 { row.1 } else { row.2 });
    let worst = last
        .iter()
        .zip(table)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    (worst, grid.time())
}

#[test]
fn cavity_at_reynolds_100_is_within_two_percent_on_64_cells() {
    let mut grid = cavity(64, 100.0, Advection::MacCormack);
    let (worst, time) = deviation(&mut grid, 1.5, 0, 25.0);
    println!("Re 100, 64²: largest deviation {worst:.5} of the lid speed, t = {time:.1}");
    assert!(worst < 0.02, "{worst}");
}

/// Takes most of a minute in a release build: `cargo test --release --features bake --test turbulence -- --ignored`.
#[test]
#[ignore = "a minute even with optimizations"]
fn cavity_at_reynolds_1000_is_within_five_percent_on_128_cells() {
    let mut grid = cavity(128, 1000.0, Advection::MacCormack);
    let (worst, time) = deviation(&mut grid, 2.0, 1, 60.0);
    println!("Re 1000, 128²: largest deviation {worst:.5} of the lid speed, t = {time:.1}");
    assert!(worst < 0.05, "{worst}");
}

/// A stream past a sphere, in three dimensions: no divergence is left, the obstacle stays still, and what enters leaves.
#[test]
fn stream_goes_around_an_obstacle() {
    let cells = [24, 16, 16];
    let h = 1.0 / 16.0;
    let mut grid = MacGrid::new(&MacGridParams {
        cells,
        cell_size: h,
        viscosity: 1.0e-3,
        boundaries: [
            [
                Boundary::Inflow(Arc::new(Uniform::new(1.0, 0.0, 0.0))),
                Boundary::Outflow,
            ],
            [Boundary::FreeSlip, Boundary::FreeSlip],
            [Boundary::Periodic, Boundary::Periodic],
        ],
        ..MacGridParams::default()
    })
    .unwrap();
    grid.set_velocity(|_| [1.0, 0.0, 0.0]).unwrap();
    let inside =
        |x: [f64; 3]| (x[0] - 0.5).powi(2) + (x[1] - 0.5).powi(2) + (x[2] - 0.5).powi(2) < 0.04;
    grid.set_obstacle(inside).unwrap();
    for _ in 0..20 {
        let report = grid.step(0.04).unwrap();
        assert!(report.converged, "{report:?}");
        assert!(report.divergence < 1.0e-6, "{report:?}");
        assert!(report.iterations < 60, "{report:?}");
    }
    assert!(grid.is_solid([0.5, 0.5, 0.5]));
    assert!(
        grid.velocity([0.5, 0.5, 0.5])
            .iter()
            .all(|v| v.abs() < 1.0e-12)
    );
    // Past the side the stream is faster than far away, behind it slower.
    assert!(grid.velocity([0.5, 0.78, 0.5])[0] > 1.05);
    assert!(grid.velocity([0.8, 0.5, 0.5])[0] < 0.7);
    let mut out = 0.0;
    for j in 0..16 {
        for k in 0..16 {
            out +=
                grid.velocity([1.5, (f64::from(j) + 0.5) * h, (f64::from(k) + 0.5) * h])[0] / 256.0;
        }
    }
    assert!((out - 1.0).abs() < 1.0e-9, "{out}");
}

/// A uniform eddy viscosity does what the fluid's own would: the same decay of a shear wave, and of one along
/// the other component.
#[test]
fn eddy_viscosity_acts_like_viscosity() {
    let run = |viscosity: f64, eddy: f64, transposed: bool| {
        let mut grid = MacGrid::new(&MacGridParams {
            cells: [16, 16, 1],
            cell_size: 1.0 / 16.0,
            viscosity,
            viscous_step: Viscosity::Explicit,
            ..MacGridParams::default()
        })
        .unwrap();
        let wave = |x: f64| (std::f64::consts::TAU * x).sin();
        grid.set_velocity(|x| {
            if transposed {
                [0.0, wave(x[0]), 0.0]
            } else {
                [wave(x[1]), 0.0, 0.0]
            }
        })
        .unwrap();
        if eddy > 0.0 {
            grid.set_eddy_viscosity(vec![eddy; 256]).unwrap();
        }
        for _ in 0..20 {
            grid.step(0.01).unwrap();
        }
        grid.max_speed()
    };
    for transposed in [false, true] {
        let (fluid, eddies) = (run(0.02, 0.0, transposed), run(0.0, 0.02, transposed));
        assert!((fluid / eddies - 1.0).abs() < 1.0e-12, "{fluid} {eddies}");
        assert!(fluid < 0.9);
    }
    let mut grid = cavity(8, 100.0, Advection::SemiLagrangian);
    assert!(grid.set_eddy_viscosity(vec![0.0; 3]).is_err());
    assert!(grid.set_eddy_viscosity(vec![-1.0; 64]).is_err());
    assert!(grid.set_eddy_viscosity(vec![f64::NAN; 64]).is_err());
}

#[test]
fn bad_grids_and_steps_are_errors() {
    let bad = |change: &dyn Fn(&mut MacGridParams)| {
        let mut params = MacGridParams::default();
        change(&mut params);
        assert!(MacGrid::new(&params).is_err());
    };
    bad(&|p| p.cells = [0, 8, 8]);
    bad(&|p| p.cells = [2, 8, 8]);
    bad(&|p| p.cells = [100_000, 8, 8]);
    bad(&|p| p.cell_size = 0.0);
    bad(&|p| p.cell_size = f64::NAN);
    bad(&|p| p.viscosity = -1.0);
    bad(&|p| p.boundaries[0][1] = Boundary::Outflow);
    bad(&|p| p.boundaries[0] = [Boundary::Wall([f64::NAN; 3]), Boundary::FreeSlip]);
    bad(&|p| {
        p.cells[2] = 1;
        p.boundaries[2] = [Boundary::Wall([0.0; 3]), Boundary::FreeSlip];
    });
    let mut grid = MacGrid::new(&MacGridParams {
        cells: [8, 8, 1],
        viscosity: 1.0,
        viscous_step: Viscosity::Explicit,
        ..MacGridParams::default()
    })
    .unwrap();
    assert!(grid.set_velocity(|_| [f64::NAN; 3]).is_err());
    grid.set_velocity(|_| [1.0, 0.0, 0.0]).unwrap();
    assert!(grid.step(0.0).is_err());
    assert!(grid.step(f64::NAN).is_err());
    // Nine cells in one step, and explicit diffusion far beyond its limit.
    assert!(grid.step(9.0 / 32.0).is_err());
    assert!(grid.step(0.01).is_err());
    assert!(grid.step(1.0e-4).is_ok());
    assert!(grid.set_obstacle(|_| true).is_err());
}
