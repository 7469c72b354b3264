//! What a cut of a hull by a free surface costs: a box, a cylinder, a ball, a capsule, and a mesh of six thousand
//! triangles, at 64 attitudes and drafts.

use criterion::{Criterion, criterion_group, criterion_main};
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::na::{Matrix3, Rotation3};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Hull, Submerged};
use std::hint::black_box;

/// An attitude and a draft per body, so that no branch is foreseen.
fn cuts() -> Vec<(Matrix3<f64>, f64)> {
    (0..64)
        .map(|i| {
            let i = f64::from(i);
            let turn = Rotation3::from_euler_angles(1.1 * i, 0.7 * i, 2.3 * i);
            (*turn.matrix(), 0.2 * i.sin())
        })
        .collect()
}

fn hulls(criterion: &mut Criterion) {
    let hull = |shape: SharedShape| Hull::from_shape(shape.as_ref()).unwrap();
    let capsule = SharedShape::capsule_y(0.5, 0.3);
    let mesh = Surface::from_shape(capsule.as_ref()).unwrap();
    let cuts = cuts();
    for (name, hull) in [
        ("box", hull(SharedShape::cuboid(0.5, 0.3, 0.4))),
        ("cylinder", hull(SharedShape::cylinder(0.5, 0.3))),
        ("ball", hull(SharedShape::ball(0.4))),
        ("capsule", hull(capsule)),
        ("mesh", Hull::from_surface(&mesh)),
    ] {
        let name = format!("{name}, {} triangles, 64 cuts", hull.triangles());
        criterion.bench_function(&name, |bencher| {
            bencher.iter(|| {
                let mut volume = 0.0;
                for (turn, depth) in &cuts {
                    let under: Submerged = black_box(&hull).under_plane(turn, *depth, [0.02, 0.03]);
                    volume += under.volume + under.waterplane.second[0];
                }
                volume
            });
        });
    }
}

criterion_group!(benches, hulls);
criterion_main!(benches);
