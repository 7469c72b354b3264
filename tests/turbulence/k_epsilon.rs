//! k–ε on the grid: homogeneous decay, pure shear, positivity; the baked table.

use rapier3d::math::Vector;
use rapier3d_immersed::flow::Shear;
use rapier3d_immersed::rapier3d;
use rapier3d_immersed::turbulence::grid::{Boundary, MacGrid, MacGridParams};
use rapier3d_immersed::turbulence::{
    KEpsilon, KEpsilonGrid, ShearSource, Turbulence, TurbulenceParams, TurbulenceTable,
};
use std::sync::Arc;

/// Couette flow between plates that move at ±1: a steady pure shear of rate 2 everywhere.
fn couette() -> MacGrid {
    let mut boundaries: [[Boundary; 2]; 3] = Default::default();
    boundaries[1] = [
        Boundary::Wall([-1.0, 0.0, 0.0]),
        Boundary::Wall([1.0, 0.0, 0.0]),
    ];
    let mut grid = MacGrid::new(&MacGridParams {
        cells: [8, 16, 1],
        cell_size: 1.0 / 16.0,
        viscosity: 0.1,
        boundaries,
        ..MacGridParams::default()
    })
    .unwrap();
    grid.set_velocity(|x| [2.0 * x[1] - 1.0, 0.0, 0.0]).unwrap();
    grid
}

/// 2 S:S of u = S y is S², in every cell, those at the walls too; and the flow is steady.
#[test]
fn pure_shear_has_its_rate_of_strain_and_stays() {
    let mut grid = couette();
    for _ in 0..20 {
        grid.step(0.05).unwrap();
    }
    for j in 0..16 {
        assert!((grid.strain2([3, j, 0]) - 4.0).abs() < 1.0e-9, "{j}");
    }
}

/// In pure shear the grid reproduces the homogeneous solution: production is in the right place. In the
/// reduced and in the full form alike, because nothing varies in space.
#[test]
fn pure_shear_produces_what_the_homogeneous_solution_says() {
    let mut grid = couette();
    let model = KEpsilon::default();
    for diffusion in [None, Some(0.1)] {
        let mut field = KEpsilonGrid::new(&grid, model, 0.3, 0.2, diffusion).unwrap();
        for _ in 0..40 {
            grid.step(0.05).unwrap();
            field.step(&grid, 0.05).unwrap();
        }
        let exact = model.advance(0.3, 0.2, 4.0, 2.0);
        for j in 0..16 {
            let (k, epsilon) = field.cell([5, j, 0]);
            assert!((k / exact.0 - 1.0).abs() < 1.0e-9, "{k} {}", exact.0);
            assert!((epsilon / exact.1 - 1.0).abs() < 1.0e-9);
        }
    }
}

/// Large steps, strong shear, strong gradients of k and ε: both stay positive and finite.
#[test]
fn any_step_keeps_the_fields_positive() {
    let mut grid = couette();
    for diffusion in [None, Some(1.0e-4)] {
        let mut field = KEpsilonGrid::new(&grid, KEpsilon::default(), 1.0, 1.0, diffusion).unwrap();
        field
            .set(&grid, |x| {
                let spike = (x[0] * 37.0).sin().powi(8) + 1.0e-9;
                (spike, 1.0e3 * (x[1] * 23.0).cos().powi(8) + 1.0e-9)
            })
            .unwrap();
        for dt in [1.0e-4, 0.1, 0.5, 100.0] {
            if dt < 0.5 {
                grid.step(dt).unwrap();
            }
            field.step(&grid, dt).unwrap();
            for j in 0..16 {
                for i in 0..8 {
                    let (k, epsilon) = field.cell([i, j, 0]);
                    assert!(k > 0.0 && k.is_finite(), "{k}");
                    assert!(epsilon > 0.0 && epsilon.is_finite(), "{epsilon}");
                }
            }
        }
    }
}

fn small() -> TurbulenceParams {
    TurbulenceParams {
        cells: [16, 12, 8],
        cell_size: 0.25,
        duration: 6.0,
        spin_up: 1.0,
        time_step: 0.1,
        field_frames: 4,
        ..TurbulenceParams::default()
    }
}

/// Without shear the baked history is the exact homogeneous decay; with a body it is not.
#[test]
fn baked_history_decays_without_shear_and_is_fed_by_a_body() {
    let (table, report) = TurbulenceTable::bake(&TurbulenceParams {
        shear: ShearSource::Nothing,
        release: [0.0; 3],
        ..small()
    })
    .unwrap();
    let (k0, length) = (1.5f64, 0.25);
    let e0 = 0.09f64.powf(0.75) * k0.powf(1.5) / length;
    for sample in &report.samples {
        let exact = k0 * (1.0 + 0.92 * e0 * sample.time / k0).powf(-1.0 / 0.92);
        // Upwind of the particle enters fresh turbulence, which catches up with it by interpolation only:
        // 16 cells of numerical diffusion, hence exact until it comes near.
        if sample.time <= 0.5 {
            assert!(
                (sample.kinetic_energy / exact - 1.0).abs() < 2.0e-3,
                "{sample:?} {exact}"
            );
        }
    }
    assert!(table.history_at(0.0).kinetic_energy == 1.5);

    let (body, with_body) = TurbulenceTable::bake(&small()).unwrap();
    assert!(
        with_body.worst_divergence < 1.0e-6,
        "{}",
        with_body.worst_divergence
    );
    assert_eq!(with_body.unconverged_steps, 0);
    let strain = |samples: &[rapier3d_immersed::turbulence::BakeSample]| {
        samples.iter().map(|s| s.strain).fold(0.0, f64::max)
    };
    assert!(strain(&with_body.samples) > 1.0);
    // With the turbulence wearing down the shear, k stays of the order of U₀² everywhere.
    let field = body.field().unwrap();
    let most = field
        .frame(3)
        .iter()
        .map(|s| s.kinetic_energy)
        .fold(0.0, f32::max);
    println!("largest k in the wake: {most} U₀²");
    assert!(most < 10.0, "{most}");
    assert!(strain(&report.samples) < 1.0e-9);
    assert_eq!(body.field().unwrap().dims(), [16, 12, 8]);
    assert_eq!(body.field().unwrap().frames(), 4);
}

/// An inflow with shear produces turbulence in an empty box.
#[test]
fn sheared_inflow_feeds_the_turbulence() {
    let inflow = Shear {
        origin: Vector::Y * 1.5,
        velocity: Vector::X,
        across: Vector::Y,
        rate: Vector::X * 0.6,
    };
    let (_, sheared) = TurbulenceTable::bake(&TurbulenceParams {
        shear: ShearSource::Inflow(Arc::new(inflow)),
        ..small()
    })
    .unwrap();
    assert!(sheared.samples[5].strain > 0.4, "{:?}", sheared.samples[5]);
}

#[test]
fn baking_is_the_same_on_any_number_of_threads_and_reports_progress() {
    let mut seen = Vec::new();
    let (table, _) =
        TurbulenceTable::bake_with_progress(&small(), &mut |share| seen.push(share)).unwrap();
    assert!(seen.windows(2).all(|w| w[0] < w[1]));
    assert_eq!(*seen.last().unwrap(), 1.0);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    let (alone, _) = pool.install(|| TurbulenceTable::bake(&small()).unwrap());
    assert_eq!(table, alone);
    let loaded = TurbulenceTable::from_bytes(&table.to_bytes()).unwrap();
    assert_eq!(loaded, table);
    // The field is centered on the body: upstream of it turbulence is fresh.
    let source = Turbulence::Field {
        table: Arc::new(table),
        velocity_scale: 2.0,
        length_scale: 0.1,
        pose: rapier3d::math::Pose::default(),
    };
    let fresh = source.at(Vector::X * -0.13, 0.0, 0.0);
    assert!(
        (fresh.kinetic_energy / 6.0 - 1.0).abs() < 1.0e-3,
        "{fresh:?}"
    );
}

#[test]
fn bad_bakes_are_errors() {
    let bad = |change: &dyn Fn(&mut TurbulenceParams)| {
        let mut params = small();
        change(&mut params);
        assert!(TurbulenceTable::bake(&params).is_err());
    };
    bad(&|p| p.reynolds = 0.0);
    bad(&|p| p.cells = [0, 12, 8]);
    bad(&|p| p.cell_size = f64::NAN);
    bad(&|p| p.intensity = -1.0);
    bad(&|p| p.eddy_cells = 0.0);
    bad(&|p| p.time_step = 0.0);
    bad(&|p| p.time_step = 1.0e-9);
    bad(&|p| p.time_step = 5.9);
    bad(&|p| p.spin_up = f64::INFINITY);
    bad(&|p| p.duration = -1.0);
    bad(&|p| p.release = [f64::NAN; 3]);
    bad(&|p| p.field_frames = 1);
    bad(&|p| p.model.c1 = 0.5);
    bad(&|p| p.shear = ShearSource::Ellipsoid([0.0, 1.0, 1.0]));
    bad(&|p| p.shear = ShearSource::Ellipsoid([100.0; 3]));
}
