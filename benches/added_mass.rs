//! Time of one boundary-element solve against the number of panels.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use rapier3d_immersed::AddedMass;
use rapier3d_immersed::boundary_element::BoundaryElementParams;
use rapier3d_immersed::geometry::{Ellipsoid, Sheet, Surface};
use rapier3d_immersed::rapier3d::na::Vector3;
use std::hint::black_box;

fn solve(criterion: &mut Criterion) {
    let params = BoundaryElementParams {
        tolerance: f64::INFINITY,
        max_panels: 10_000,
        ..BoundaryElementParams::default()
    };
    let mut group = criterion.benchmark_group("added_mass");
    group.sample_size(10);
    // 20 cells² panels: 320, 1280, 5120.
    for cells in [4, 8, 16] {
        for (name, z) in [("ball", 1.0), ("leaf", 0.015 / 3.65)] {
            let body = Ellipsoid {
                semi_axes: Vector3::new(1.0, if z < 1.0 { 0.575 } else { 1.0 }, z),
            };
            let surface = Surface::ellipsoid(&body, cells).expect("a proper ellipsoid");
            let panels = surface.triangles().len();
            group.bench_with_input(BenchmarkId::new(name, panels), &surface, |b, surface| {
                b.iter(|| AddedMass::solve(black_box(surface), &params));
            });
        }
        // 6 rings² panels: 294, 1350, 4704.
        let sheet = Sheet::elliptic_disc(1.0, 0.575, 0.001, 7 * cells / 4 + cells / 8)
            .expect("a proper disc");
        let panels = sheet.triangles().len();
        group.bench_with_input(BenchmarkId::new("sheet", panels), &sheet, |b, sheet| {
            b.iter(|| AddedMass::solve_sheet(black_box(sheet), &params));
        });
    }
    group.finish();
}

criterion_group!(benches, solve);
criterion_main!(benches);
