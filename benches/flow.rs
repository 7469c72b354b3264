//! What wind and turbulence cost: baking a gust field, looking it up, one Langevin step.

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use rapier3d::math::Vector;
use rapier3d_immersed::flow::{Flow, FlowSample, GridFlow, SpectralWind, WindParams};
use rapier3d_immersed::rapier3d;
use rapier3d_immersed::turbulence::{
    NoiseStream, SeenFluctuation, Turbulence, TurbulenceState, TurbulenceTable, kolmogorov_constant,
};
use std::hint::black_box;
use std::sync::Arc;

/// Points of a batch; times below are for all of them.
const BATCH: usize = 1000;

fn points() -> Vec<Vector> {
    let stream = NoiseStream::new(5, 0);
    (0..BATCH as u64)
        .map(|i| stream.vector(i, 0) * 10.0 + Vector::Y * 12.0)
        .collect()
}

fn bake(c: &mut Criterion) {
    let mut group = c.benchmark_group("bake");
    group.sample_size(10);
    for divergence_free in [false, true] {
        for nodes in [[100, 100, 1], [100, 100, 100]] {
            let params = WindParams {
                nodes,
                divergence_free,
                ..WindParams::default()
            };
            let [x, y, z] = nodes;
            let name = format!("wind {x}x{y}x{z} divergence_free={divergence_free}");
            group.bench_function(name, |b| {
                b.iter(|| SpectralWind::bake(black_box(&params)).unwrap());
            });
        }
    }
    group.finish();
}

fn lookup(c: &mut Criterion) {
    let points = points();
    let mut samples = vec![FlowSample::default(); BATCH];
    let mut group = c.benchmark_group("lookup of 1000 points");
    for nodes in [[100, 100, 1], [100, 100, 100]] {
        let params = WindParams {
            nodes,
            ..WindParams::default()
        };
        let wind = SpectralWind::bake(&params).unwrap();
        let [x, y, z] = nodes;
        group.bench_function(format!("wind {x}x{y}x{z} velocity"), |b| {
            b.iter(|| {
                let sum: Vector = points.iter().map(|p| wind.velocity(*p, 1.5)).sum();
                black_box(sum)
            });
        });
        group.bench_function(format!("wind {x}x{y}x{z} sample with vorticity"), |b| {
            b.iter(|| wind.sample(black_box(&points), 1.5, &mut samples));
        });
        let h = Vector::ONE;
        let grid = GridFlow::sampled(&wind, 0.0, nodes, [true; 3], Vector::ZERO, h).unwrap();
        group.bench_function(format!("grid {x}x{y}x{z} velocity"), |b| {
            b.iter(|| {
                let sum: Vector = points.iter().map(|p| grid.velocity(*p, 1.5)).sum();
                black_box(sum)
            });
        });
        group.bench_function(format!("grid {x}x{y}x{z} sample with vorticity"), |b| {
            b.iter(|| grid.sample(black_box(&points), 1.5, &mut samples));
        });
    }
    group.finish();
}

fn langevin(c: &mut Criterion) {
    let streams: Vec<_> = (0..BATCH as u64).map(|i| NoiseStream::new(1, i)).collect();
    let mut seen: Vec<_> = streams
        .iter()
        .map(|stream| SeenFluctuation::stationary(stream.vector(0, 0)))
        .collect();
    let mut group = c.benchmark_group("langevin of 1000 bodies");
    let mut step = 0;
    group.bench_function("three Gaussian numbers", |b| {
        b.iter(|| {
            step += 1;
            let sum: Vector = streams.iter().map(|stream| stream.vector(step, 0)).sum();
            black_box(sum)
        });
    });
    let state = TurbulenceState {
        kinetic_energy: 1.0,
        dissipation: 0.5,
    };
    let c0 = kolmogorov_constant(state.taylor_reynolds_squared(1.5e-5));
    group.bench_function("step of the seen velocity, same turbulence for all", |b| {
        b.iter(|| {
            step += 1;
            for (stream, seen) in streams.iter().zip(&mut seen) {
                let noise = stream.vector(step, 0);
                black_box(seen.advance(&state, c0, 0.5, 0.01, noise));
            }
        });
    });
    let source = Turbulence::History {
        table: Arc::new(TurbulenceTable::default_history()),
        velocity_scale: 1.0,
        length_scale: 0.1,
    };
    group.bench_function("step of the seen velocity, table and C0 per body", |b| {
        b.iter(|| {
            step += 1;
            for (i, (stream, seen)) in streams.iter().zip(&mut seen).enumerate() {
                let state = source.at(Vector::ZERO, 0.0, 0.0003 * i as f64);
                let c0 = kolmogorov_constant(state.taylor_reynolds_squared(1.5e-5));
                let noise = stream.vector(step, 0);
                black_box(seen.advance(&state, c0, 0.5, 0.01, noise));
            }
        });
    });
    group.bench_function("table look-up", |b| {
        b.iter_batched(
            || (),
            |()| {
                for i in 0..BATCH {
                    black_box(source.at(Vector::ZERO, 0.0, 0.0003 * i as f64));
                }
            },
            BatchSize::SmallInput,
        );
    });
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(std::time::Duration::from_millis(300))
        .measurement_time(std::time::Duration::from_millis(1000))
        .sample_size(20);
    targets = langevin, lookup, bake
}
criterion_main!(benches);
