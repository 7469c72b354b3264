//! The costs of the thesis's chapter 4: baking the turbulence, and a step of each body of its Table 4.2.

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use rapier3d_immersed::turbulence::{TurbulenceParams, TurbulenceTable};
use std::hint::black_box;

#[path = "../examples/stochastic/case.rs"]
#[allow(dead_code, reason = "shared with the example")]
mod case;
#[path = "../examples/support/mod.rs"]
mod support;

/// The thesis prints 182 ms for 32 × 32 × 8 cells (§4.6), not for how many steps; these are the 320 of the default
/// history.
fn bake(c: &mut Criterion) {
    let mut group = c.benchmark_group("k–ε on 32 × 32 × 8 cells, 320 steps");
    group.sample_size(10);
    for (name, preset) in [
        ("thesis's model", TurbulenceParams::thesis()),
        ("full model", TurbulenceParams::default()),
    ] {
        let params = TurbulenceParams {
            cells: [32, 32, 8],
            ..preset
        };
        group.bench_function(name, |b| {
            b.iter(|| TurbulenceTable::bake(black_box(&params)).unwrap());
        });
    }
    group.finish();
}

/// Steps that are timed together, from the release on.
const STEPS: u64 = 100;

fn steps(c: &mut Criterion) {
    let mut group = c.benchmark_group("100 steps of the stochastic method");
    group.throughput(Throughput::Elements(STEPS));
    for row in case::table_4_2() {
        let dt = 1e3 * row.case.dt;
        let name = format!(
            "{}, {} triangles, {dt} ms (thesis {} ms a step)",
            row.body, row.triangles, row.thesis
        );
        group.bench_function(name, |b| {
            b.iter_batched_ref(
                || row.case.world(case::Physics::Increments, 1),
                |world| (0..STEPS).for_each(|_| world.step()),
                BatchSize::PerIteration,
            );
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(std::time::Duration::from_millis(300))
        .measurement_time(std::time::Duration::from_millis(1000))
        .sample_size(20);
    targets = steps, bake
}
criterion_main!(benches);
