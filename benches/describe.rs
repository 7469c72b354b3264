//! Time of describing a shape to the fluid, once for each kind of body: `HydroProperties::from_shape`.

use criterion::{Criterion, criterion_group, criterion_main};
use rapier3d_immersed::HydroProperties;
use rapier3d_immersed::rapier3d::prelude::*;
use std::hint::black_box;

/// A half ball's shell of radius 1 and this thickness, open above.
fn cup(thickness: f32) -> SharedShape {
    const N: u32 = 32;
    const RINGS: u32 = 12;
    let mut points = Vec::new();
    for radius in [1.0, 1.0 - thickness] {
        for ring in 0..=RINGS {
            let (sine, cosine) =
                (std::f32::consts::FRAC_PI_2 * ring as f32 / RINGS as f32).sin_cos();
            for i in 0..N {
                let (z, x) = (std::f32::consts::TAU * i as f32 / N as f32).sin_cos();
                points.push(Vector::new(x * cosine, -sine, z * cosine) * radius);
            }
        }
    }
    let half = N * (RINGS + 1);
    let mut triangles = Vec::new();
    for i in 0..N {
        let j = (i + 1) % N;
        let mut quad = |[a, b, c, d]: [u32; 4]| triangles.extend([[a, b, c], [a, c, d]]);
        for ring in 0..RINGS {
            let (low, high) = (ring * N, (ring + 1) * N);
            quad([low + i, low + j, high + j, high + i]);
            quad([
                half + low + i,
                half + high + i,
                half + high + j,
                half + low + j,
            ]);
        }
        quad([i, half + i, half + j, j]);
    }
    SharedShape::trimesh(points, triangles).expect("a closed mesh")
}

/// The twelve edges of a cube of 1 m.
fn frame(thickness: f32) -> SharedShape {
    let mut bars = Vec::new();
    for (axis, corner) in (0..3).flat_map(|axis| (0..4).map(move |corner| (axis, corner))) {
        let mut half = Vector::splat(0.5 * thickness);
        half[axis] = 0.5;
        let mut at = Vector::ZERO;
        at[(axis + 1) % 3] = if corner & 1 == 0 { -0.5 } else { 0.5 };
        at[(axis + 2) % 3] = if corner & 2 == 0 { -0.5 } else { 0.5 };
        let bar = SharedShape::cuboid(half.x, half.y, half.z);
        bars.push((Pose::from_translation(at), bar));
    }
    SharedShape::compound(bars)
}

fn describe(criterion: &mut Criterion) {
    let shapes = [
        ("leaf", SharedShape::cuboid(0.0365, 0.000_15, 0.021)),
        ("cube", SharedShape::cuboid(0.5, 0.5, 0.5)),
        ("ball", SharedShape::ball(0.5)),
        ("cylinder", SharedShape::cylinder(0.5, 0.5)),
        ("capsule", SharedShape::capsule_y(0.5, 0.5)),
        ("cup", cup(0.04)),
        ("frame", frame(0.02)),
    ];
    let mut group = criterion.benchmark_group("describe");
    group.sample_size(10);
    for (name, shape) in &shapes {
        group.bench_function(*name, |b| {
            b.iter(|| HydroProperties::from_shape(black_box(shape.as_ref())));
        });
    }
    group.finish();
}

criterion_group!(benches, describe);
criterion_main!(benches);
