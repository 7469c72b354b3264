//! The parameters of the thesis as printed, and the shipped table against a new bake of it.

use rapier3d_immersed::turbulence::grid::Advection;
use rapier3d_immersed::turbulence::{
    KEpsilon, ShearSource, TurbulenceParams, TurbulenceState, TurbulenceTable,
};

/// What the thesis prints in §4.4, §4.5 and under Fig. 4.2.
#[test]
fn the_thesis_preset_is_what_is_printed() {
    let params = TurbulenceParams::thesis();
    // Fig. 4.2: Re = 3.8 × 10³ on 32 × 32 × 16 cells.
    assert_eq!((params.reynolds, params.cells), (3.8e3, [32, 32, 16]));
    // Text after (4.15) and (4.16); its source for the constants is Launder & Sharma (1974).
    let printed = KEpsilon {
        c_mu: 0.09,
        c1: 1.44,
        c2: 1.92,
        sigma_k: 1.0,
        sigma_epsilon: 1.3,
    };
    assert_eq!(params.model, printed);
    // (4.18) and (4.19) have no diffusion, and Algorithm 1 no effect of the turbulence on the mean flow, which it convects
    // by a semi-Lagrangian scheme.
    assert!(!params.diffusion && !params.feedback);
    assert_eq!(params.advection, Advection::SemiLagrangian);
    // (4.20): k₀ = 3/2 U₀², ε₀ = C_μ^¾ k₀^(3/2)/l with l the size of a cell; (4.21): the inflow is U₀.
    assert_eq!((params.intensity, params.eddy_cells), (1.0, 1.0));
    let params = TurbulenceParams {
        shear: ShearSource::Nothing,
        spin_up: 0.0,
        duration: params.time_step,
        ..params
    };
    let (table, report) = TurbulenceTable::bake(&params).unwrap();
    let first = report.samples[0];
    let dissipation = 0.09f64.powf(0.75) * 1.5f64.powf(1.5) / params.cell_size;
    assert!((first.kinetic_energy - 1.5).abs() < 1e-12);
    assert!((first.dissipation / dissipation - 1.0).abs() < 1e-12);
    assert_eq!(table.reynolds(), 3.8e3);
    // The stream carries the particle along with U₀.
    let way = report.samples[1].position[0] - first.position[0];
    assert!((way / params.time_step - 1.0).abs() < 1e-9, "{way}");
}

/// Largest relative difference of the shipped history from the first of a bake.
fn difference(params: &TurbulenceParams) -> (f64, usize) {
    let shipped = TurbulenceTable::default_history();
    let (baked, report) = TurbulenceTable::bake(params).unwrap();
    assert_eq!(report.unconverged_steps, 0);
    assert_eq!(
        (baked.reynolds(), baked.time_step()),
        (shipped.reynolds(), shipped.time_step())
    );
    let pairs = baked.history().iter().zip(shipped.history());
    let miss = |of: fn(&TurbulenceState) -> f32| {
        pairs
            .clone()
            .map(|(a, b)| f64::from(of(a) / of(b) - 1.0).abs())
            .fold(0.0, f64::max)
    };
    let miss = miss(|s| s.kinetic_energy).max(miss(|s| s.dissipation));
    println!("{miss} over {} entries", baked.history().len());
    (miss, baked.history().len())
}

/// A machine whose arithmetic differs in the last bit of f64 (library functions do) is off by the tolerance of the pressure
/// solver, 10⁻⁶ of the largest divergence; the table holds seven digits.
const TOLERANCE: f64 = 1e-5;

/// The first entries, which have all of the flow's development before them.
#[test]
fn the_shipped_table_begins_as_a_new_bake() {
    let params = TurbulenceParams {
        duration: 0.5,
        ..TurbulenceParams::default()
    };
    let (miss, entries) = difference(&params);
    assert_eq!(entries, 11);
    assert!(miss < TOLERANCE, "{miss}");
}

/// All of it; `cargo run --release --features bake --example wind -- --write-default-table src/turbulence/default_table.bin`
/// writes it anew.
#[test]
#[cfg_attr(debug_assertions, ignore = "a minute without optimisation")]
fn the_shipped_table_is_a_new_bake() {
    let (miss, entries) = difference(&TurbulenceParams::default());
    assert_eq!(entries, TurbulenceTable::default_history().history().len());
    assert!(miss < TOLERANCE, "{miss}");
}
