//! Costs of reduced models: one point, a grid of initial values against solving each (thesis
//! Fig. 6.7b), what baking takes, and a step under a reduced model of the default law.

use criterion::{Criterion, criterion_group, criterion_main};
use differential_equations::prelude::{ExplicitRungeKutta, IVP, ODE};
use rapier3d::na::{DVector, Matrix3, Vector3};
use rapier3d::prelude::{Cuboid, Vector};
use rapier3d_immersed::reduced::Axis;
use rapier3d_immersed::reduced::Canonical;
use rapier3d_immersed::reduced::CrossParams;
use rapier3d_immersed::reduced::PgdParams;
use rapier3d_immersed::reduced::Separated;
use rapier3d_immersed::reduced::example_systems::coupled_triple;
use rapier3d_immersed::reduced::{Coupling, EvolutionParams, evolve};
use rapier3d_immersed::{
    DryMass, Fluid, FreeBody, HydroProperties, ImmersedBody, Part, SeparatedLaw, ViscousLaw,
};
use std::hint::black_box;

/// The size the thesis states in §6.2.1: 15 modes, 6 dimensions, 300 nodes each.
fn thesis_size(degree: usize) -> Separated {
    let axis = Axis::elements(0.0, 1.0, 299 / degree, degree).unwrap();
    let mut tensor = Canonical::zeros(&[axis.len(); 6]);
    for mode in 0..15 {
        let factor = |j: usize| axis.sample(|x| 1.0 + 0.1 * ((mode + j) as f64 * x).sin());
        let factors: Vec<DVector<f64>> = (0..6).map(factor).collect();
        tensor.push(1.0 / (1.0 + mode as f64), &factors).unwrap();
    }
    Separated::new(1, vec![axis; 6], &tensor).unwrap()
}

fn one_point(criterion: &mut Criterion) {
    let points: Vec<[f64; 6]> = (0..1000)
        .map(|i| [1.0, 2.0, 3.0, 5.0, 7.0, 11.0].map(|p: f64| (i as f64 * p.sqrt()).fract()))
        .collect();
    for degree in [1, 3] {
        let separated = thesis_size(degree);
        let mut evaluator = separated.evaluator();
        let mut next = 0;
        let mut value = [0.0];
        criterion.bench_function(
            &format!("one point, 15 modes, 6 dimensions, degree {degree}"),
            |b| {
                b.iter(|| {
                    next = (next + 1) % points.len();
                    evaluator.evaluate(black_box(&points[next]), &mut value);
                    value[0]
                })
            },
        );
    }
}

/// Thesis (6.22) written out, so that the reference pays nothing for the generality of a system.
struct CoupledTriple;

impl ODE<f64, [f64; 3]> for CoupledTriple {
    fn diff(&self, _: f64, u: &[f64; 3], rate: &mut [f64; 3]) {
        *rate = [1.0 - u[1] * u[2], 2.0 - u[0] * u[2], 3.0 - u[0] * u[1]];
    }
}

fn grid_of_initial_values(criterion: &mut Criterion) {
    let system = coupled_triple(&Axis::spectral(0.0, 1.0, 9).unwrap());
    let time = Axis::time(0.0, 0.5, 3, 4).unwrap();
    let params = EvolutionParams {
        pgd: PgdParams {
            max_modes: 12,
            tolerance: 1e-7,
            ..PgdParams::default()
        },
        coupling: Coupling::Decoupled,
        ..EvolutionParams::default()
    };
    criterion.bench_function("bake thesis (6.22), 12 enrichments", |b| {
        b.iter(|| evolve(&system, &time, &params, |_, _| ()).unwrap())
    });
    let (solution, _) = evolve(&system, &time, &params, |_, _| ()).unwrap();
    let values: Vec<f64> = (0..20).map(|i| i as f64 / 19.0).collect();
    let times: Vec<f64> = (1..=20).map(|i| i as f64 / 40.0).collect();
    criterion.bench_function("20³ initial values, final state", |b| {
        b.iter(|| solution.grid(&[&[0.5], &values, &values, &values]))
    });
    criterion.bench_function("20³ initial values, 20 times", |b| {
        b.iter(|| solution.grid(&[&times, &values, &values, &values]))
    });
    criterion.bench_function("20³ initial values, DOP853 at 1e-4", |b| {
        b.iter(|| {
            let mut sum = 0.0;
            for x in &values {
                for y in &values {
                    for z in &values {
                        let start = [*x, *y, *z];
                        let solved = IVP::ode(&CoupledTriple, 0.0, 0.5, start)
                            .method(ExplicitRungeKutta::dop853().rtol(1e-4).atol(1e-4))
                            .solve()
                            .unwrap();
                        sum += solved.y.last().unwrap()[0];
                    }
                }
            }
            sum
        })
    });
}

/// A leaf's force by the reduced model of the default law, and a step of a leaf under either.
fn separated_law(criterion: &mut Criterion) {
    let shape = Cuboid::new(Vector::new(0.0365, 0.00015, 0.021));
    let hydro = HydroProperties::from_shape(&shape).unwrap();
    let mass = 300.0 * hydro.volume;
    let dry = DryMass {
        mass,
        center: Vector3::zeros(),
        inertia: Matrix3::from_diagonal(&Vector3::new(1.5e-4, 5.9e-4, 4.4e-4)) * mass,
    };
    let mut step = |name: &str, body: &ImmersedBody| {
        let mut body = FreeBody::new(body, &dry, &Fluid::AIR).unwrap();
        body.set_velocity(Vector3::new(0.5, -1.0, 0.3), Vector3::new(2.0, 1.0, 5.0));
        let gravity = Vector3::new(0.0, -9.81, 0.0);
        criterion.bench_function(name, |b| b.iter(|| body.step(1.0 / 240.0, gravity)));
    };
    step(
        "a leaf's step, default law",
        &ImmersedBody::new(hydro.clone()),
    );
    for max_rank in [8, 16, 32] {
        let params = CrossParams {
            tolerance: 1e-3,
            max_rank,
            max_evaluations: 300_000,
            rank_growth: 4,
            ..CrossParams::default()
        };
        let law = ViscousLaw::default();
        let (law, _) = SeparatedLaw::bake(&hydro, law, [100.0, 2e4], &params).unwrap();
        let part = Part::new(hydro.clone()).with_law(law);
        let body = ImmersedBody::new(hydro.clone()).with_parts([part]);
        step(
            &format!("a leaf's step, separated law of rank {max_rank}"),
            &body,
        );
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20);
    targets = one_point, grid_of_initial_values, separated_law
}
criterion_main!(benches);
