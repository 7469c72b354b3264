//! What immersion costs per body and step, next to plain rapier in the same run.
//!
//! `cargo bench --bench step` times whole steps with criterion, then prints, for each number of
//! bodies, the marginal cost from medians of runs that alternate between plain and immersed.

use criterion::{BenchmarkId, Criterion};
use rapier3d_immersed::flow::GridFlow;
#[cfg(feature = "bake")]
use rapier3d_immersed::flow::{SpectralWind, WindParams};
use rapier3d_immersed::motion::{ControlSeries, Dwell, Pattern};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::turbulence::{NoiseStream, Turbulence, TurbulenceState};
use rapier3d_immersed::{Fluid, HydroProperties, Immersion, OnContact, RapierSets};
use std::time::{Duration, Instant};

/// Leaves in still air, far enough apart that few pairs form, with a spread of attitudes.
fn leaves(count: usize) -> (PhysicsWorld, Vec<RigidBodyHandle>) {
    spread(count, 0.5)
}

/// Leaves `spacing` meters apart.
fn spread(count: usize, spacing: Real) -> (PhysicsWorld, Vec<RigidBodyHandle>) {
    let mut world = PhysicsWorld::new();
    let side = (count as f64).cbrt().ceil() as usize;
    let handles = (0..count)
        .map(|i| {
            let cell = [i % side, i / side % side, i / side / side].map(|x| x as Real * spacing);
            let turn = Vector::new(0.3 + cell[0], 0.7 + cell[1], cell[2]);
            let body = RigidBodyBuilder::dynamic()
                .translation(Vector::from_array(cell) + Vector::Y * 100.0)
                .rotation(turn);
            let leaf = ColliderBuilder::cuboid(0.0365, 0.000_15, 0.021).density(300.0);
            world.insert(body, leaf).0
        })
        .collect();
    (world, handles)
}

fn immersed(world: &PhysicsWorld, handles: &[RigidBodyHandle]) -> Immersion {
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handles[0]).unwrap();
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.insert_all(handles.iter().copied(), hydro);
    immersion
}

/// A gusty wind on a grid, as a user would load one.
fn grid_wind() -> GridFlow {
    let noise = NoiseStream::new(3, 0);
    let velocities: Vec<_> = (0..32 * 32 * 32)
        .map(|i| Vector::X * 3.0 + noise.vector(i, 0))
        .collect();
    let spacing = Vector::splat(0.5);
    GridFlow::new([32; 3], [true; 3], Vector::ZERO, spacing, &velocities).unwrap()
}

fn turbulence() -> Turbulence {
    Turbulence::Homogeneous(TurbulenceState {
        kinetic_energy: 0.1,
        dissipation: 0.05,
    })
}

/// A wind that evolves, of so many layers.
#[cfg(feature = "bake")]
fn spectral_wind(layers: usize) -> SpectralWind {
    SpectralWind::bake(&WindParams {
        nodes: [100, 100, layers],
        up: Vector::Y,
        ..WindParams::default()
    })
    .unwrap()
}

/// What stirs the air of an immersion.
type Air = (&'static str, fn(&mut Immersion));

fn airs() -> Vec<Air> {
    let airs: Vec<Air> = vec![
        ("still air", |_| {}),
        ("turbulence", |i| i.set_turbulence(turbulence())),
        ("grid wind", |i| i.set_flow(grid_wind())),
    ];
    #[cfg(feature = "bake")]
    let airs = {
        let baked: Vec<Air> = vec![
            ("spectral wind 100²", |i| i.set_flow(spectral_wind(1))),
            ("spectral wind 100³", |i| i.set_flow(spectral_wind(100))),
        ];
        [airs, baked].concat()
    };
    airs
}

/// Time per body of `before_step` in each of these airs, in turn. The leaves start so far apart that wind
/// does not drive them into pairs, which cost on their own.
fn added(count: usize, rounds: usize, airs: &[Air]) -> Vec<Vec<f64>> {
    let mut runs: Vec<_> = airs
        .iter()
        .map(|(_, stir)| {
            let (world, handles) = spread(count, 2.0);
            let mut immersion = immersed(&world, &handles);
            stir(&mut immersion);
            (world, immersion)
        })
        .collect();
    let mut times = vec![Vec::new(); airs.len()];
    for round in 0..rounds + 10 {
        for ((world, immersion), list) in runs.iter_mut().zip(&mut times) {
            let start = Instant::now();
            immersion.before_step(&mut RapierSets::of(world));
            let before = start.elapsed();
            world.step();
            immersion.after_step(&mut RapierSets::of(world));
            if round >= 10 {
                list.push(before.as_secs_f64() * 1e9 / count as f64);
            }
        }
    }
    times
}

/// Time of one step, plain and immersed in turn, and of the hook alone. Warm-up is not counted.
fn interleaved(count: usize, rounds: usize) -> [Vec<f64>; 3] {
    let (mut plain, _) = leaves(count);
    let (mut world, handles) = leaves(count);
    let mut immersion = immersed(&world, &handles);
    let mut times = [const { Vec::new() }; 3];
    for round in 0..rounds + 10 {
        let start = Instant::now();
        plain.step();
        let plain = start.elapsed();

        let start = Instant::now();
        immersion.before_step(&mut RapierSets::of(&mut world));
        let before = start.elapsed();
        world.step();
        let middle = Instant::now();
        immersion.after_step(&mut RapierSets::of(&mut world));
        let whole = start.elapsed();
        let hook = before + middle.elapsed();
        if round >= 10 {
            for (list, time) in times.iter_mut().zip([plain, whole, hook]) {
                list.push(time.as_secs_f64() * 1e9 / count as f64);
            }
        }
    }
    times
}

/// What replaying a series of control parameters costs per body-step over constant ones, ns: the hook
/// alone, of two equal worlds in turn.
fn replaying(count: usize, rounds: usize) -> f64 {
    let (mut worlds, mut immersions) = (Vec::new(), Vec::new());
    let book: Vec<ControlSeries> = (0..16)
        .map(|i| {
            let controls = (0..400).map(|k| [1.0 + 1e-3 * (i + k) as f32, 1.0, 1.0].into());
            let dwell = Dwell {
                pattern: Pattern::Zigzag,
                from: 0,
            };
            ControlSeries::new(1.0 / 30.0, controls.collect(), vec![dwell]).unwrap()
        })
        .collect();
    for player in [false, true] {
        let (world, handles) = leaves(count);
        let mut immersion = immersed(&world, &handles);
        for (i, handle) in handles.iter().enumerate() {
            if player {
                immersion.replay(*handle, &book[i % book.len()], OnContact::Restart);
            } else {
                immersion.set_control(*handle, [1.1, 1.0, 1.0].into());
            }
        }
        worlds.push(world);
        immersions.push(immersion);
    }
    let mut differences = Vec::new();
    for round in 0..rounds + 10 {
        let mut times = [0.0; 2];
        // The first of a pair warms the caches: each goes first in turn.
        for which in [round % 2, 1 - round % 2] {
            let (world, immersion) = (&mut worlds[which], &mut immersions[which]);
            let start = Instant::now();
            immersion.before_step(&mut RapierSets::of(world));
            let before = start.elapsed();
            world.step();
            immersion.after_step(&mut RapierSets::of(world));
            times[which] = before.as_secs_f64() * 1e9 / count as f64;
        }
        if round >= 10 {
            differences.push(times[1] - times[0]);
        }
    }
    median(&mut differences)
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Leaves at rest on the floor, asleep.
fn sleeping(count: usize) -> f64 {
    let (mut world, handles) = leaves(count);
    let mut immersion = immersed(&world, &handles);
    immersion.step(&mut world);
    for handle in &handles {
        world.bodies[*handle].sleep();
    }
    world.step();
    let mut times: Vec<_> = (0..200)
        .map(|_| {
            let start = Instant::now();
            immersion.before_step(&mut RapierSets::of(&mut world));
            immersion.after_step(&mut RapierSets::of(&mut world));
            start.elapsed().as_secs_f64() * 1e9 / count as f64
        })
        .collect();
    median(&mut times)
}

fn main() {
    let mut criterion = Criterion::default()
        .configure_from_args()
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2))
        .sample_size(20);
    {
        let mut group = criterion.benchmark_group("step");
        for count in [1_000, 10_000] {
            let (mut world, _) = leaves(count);
            group.bench_function(BenchmarkId::new("plain", count), |b| {
                b.iter(|| world.step())
            });
            let (mut world, handles) = leaves(count);
            let mut immersion = immersed(&world, &handles);
            group.bench_function(BenchmarkId::new("immersed", count), |b| {
                b.iter(|| immersion.step(&mut world));
            });
        }
        group.finish();
    }
    criterion.final_summary();

    // `cargo test --benches` only checks that it runs.
    let quick = std::env::args().any(|arg| arg == "--test");
    for (count, rounds) in [(1_000, 400), (10_000, 60), (100_000, 12)] {
        let (count, rounds) = if quick { (100, 3) } else { (count, rounds) };
        let [mut plain, mut whole, mut hook] = interleaved(count, rounds);
        let (plain, whole) = (median(&mut plain), median(&mut whole));
        println!(
            "immersion: {count} bodies: {:.0} ns per body-step over plain, ratio {:.2} \
             (plain {plain:.0} ns, hook alone {:.0} ns)",
            whole - plain,
            whole / plain,
            median(&mut hook),
        );
    }
    let count = if quick { 100 } else { 10_000 };
    let airs = airs();
    let mut times = added(count, if quick { 3 } else { 60 }, &airs);
    let costs: Vec<_> = times.iter_mut().map(|times| median(times)).collect();
    let added = airs.iter().zip(&costs).skip(1);
    let added: Vec<_> = added
        .map(|((name, _), cost)| format!("{name} {:.0}", cost - costs[0]))
        .collect();
    println!(
        "immersion: {count} bodies: ns per body-step that are added by {}",
        added.join(", ")
    );
    println!(
        "immersion: {count} bodies that replay a series: {:.1} ns per body-step more than constant \
         coefficients",
        replaying(count, if quick { 4 } else { 100 })
    );
    println!(
        "immersion: {count} sleeping bodies: {:.1} ns per body-step",
        sleeping(count)
    );
}
