//! What a question to a free surface costs.

use criterion::{Criterion, criterion_group, criterion_main};
use rapier3d_immersed::free_surface::{FreeSurface, HeightField, HeightGrid, Sea, Waves};
use rapier3d_immersed::rapier3d::na::Vector3;
use std::hint::black_box;

fn ask(criterion: &mut Criterion, name: &str, surface: &dyn FreeSurface) {
    criterion.bench_function(&format!("{name}: elevation"), |bencher| {
        bencher.iter(|| surface.elevation(black_box(3.0), 1.0, 7.0));
    });
    criterion.bench_function(&format!("{name}: velocity"), |bencher| {
        bencher.iter(|| surface.velocity(&Vector3::new(black_box(3.0), -0.2, 1.0), 7.0));
    });
}

fn surfaces(criterion: &mut Criterion) {
    for waves in [4, 64, 256] {
        let mut sea = Sea {
            waves,
            ..Sea::default()
        };
        ask(
            criterion,
            &format!("{waves} waves"),
            &Waves::sea(&sea).unwrap(),
        );
        sea.dispersion.depth = 10.0;
        ask(
            criterion,
            &format!("{waves} waves, 10 m deep"),
            &Waves::sea(&sea).unwrap(),
        );
    }
    for frames in [1, 16] {
        let grid = HeightGrid {
            nodes: [128; 2],
            frames,
            ..HeightGrid::default()
        };
        let heights = (0..128 * 128 * frames).map(|i| (i as f32).sin()).collect();
        let field = HeightField::new(grid, heights).unwrap();
        ask(criterion, &format!("field, {frames} frames"), &field);
    }
}

criterion_group!(benches, surfaces);
criterion_main!(benches);
