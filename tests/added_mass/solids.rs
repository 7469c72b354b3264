//! The table of solids against the boundary elements that it was made with, at places between its rows.

use super::assert_within;
use rapier3d_immersed::rapier3d::parry::shape::{Capsule, Cone, Cuboid, Cylinder, Shape};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Accuracy, AddedMassSource, HydroProperties};

/// The largest difference of two added masses: translation over the largest translation, rotation over the larger of
/// added and displaced inertia, as the table in the docs of `Accuracy` counts.
fn difference(shape: &dyn Shape) -> (f64, f64) {
    let tabulated = HydroProperties::from_shape_with(shape, Accuracy::Tabulated).unwrap();
    assert!(
        matches!(tabulated.added_mass_source, AddedMassSource::Table { .. }),
        "{:?}",
        tabulated.added_mass_source
    );
    let solved =
        HydroProperties::from_shape_with(shape, Accuracy::Mesh { tolerance: 0.004 }).unwrap();
    let AddedMassSource::BoundaryElements { estimated_error } = solved.added_mass_source else {
        panic!("{:?}", solved.added_mass_source);
    };
    assert!(estimated_error < 0.004);
    let center = tabulated.centroid;
    let [table, solver] = [&tabulated, &solved].map(|hydro| hydro.added_mass_about(center));
    let linear = (table.linear - solver.linear).amax() / solver.linear.amax();
    let moments = shape.mass_properties(1.0).principal_inertia();
    let displaced = f64::from(moments.max_element());
    let scale = solver.angular.amax().max(displaced);
    let angular = (table.angular - solver.angular).amax() / scale;
    let coupling =
        (table.coupling - solver.coupling).amax() / (solver.linear.amax() * scale).sqrt();
    (linear, angular.max(coupling))
}

/// Half way between the rows of the table, where interpolation is worst. Both the table and the solver are good to half
/// a percent.
#[test]
fn between_the_rows() {
    let cuboid = |x: f32, y: f32, z: f32| -> Box<dyn Shape> {
        Box::new(Cuboid::new(Vector::new(x, y, z) * 0.5))
    };
    let shapes: [Box<dyn Shape>; 9] = [
        cuboid(0.5, 0.3, 0.4),
        cuboid(1.4, 1.0, 0.7),
        cuboid(0.09, 2.9, 1.0),
        cuboid(1.0, 0.15, 0.11),
        Box::new(Cylinder::new(0.36, 0.5)),
        Box::new(Cylinder::new(0.02, 0.7)),
        Box::new(Cone::new(0.7, 0.5)),
        Box::new(Cone::new(0.09, 0.5)),
        Box::new(Capsule::new_x(0.22, 0.5)),
    ];
    for (i, shape) in shapes.iter().enumerate() {
        let (linear, angular) = difference(shape.as_ref());
        println!("shape {i}: translation {linear:.4}, rotation and coupling {angular:.4}");
        assert!(
            linear < 0.01 && angular < 0.01,
            "shape {i}: {linear} {angular}"
        );
    }
}

/// Thin rectangles by aspect ratio: an independent collocation (see `sheets.rs`); those of the table are 1/1000 as thick as
/// wide, which adds up to half a percent.
#[test]
fn thin_rectangles() {
    let pi = std::f64::consts::PI;
    for (b, mass, about_long, about_short) in [
        (1.0, 0.57901, 0.8176, 0.3066),
        (1.5, 0.68980, 0.8774, 0.4127),
        (2.0, 0.75688, 0.9079, 0.4947),
        (4.0, 0.87191, 0.954, 0.6835),
        (5.0, 0.89668, 0.963, 0.7348),
        (10.0, 0.94758, 0.982, 0.8545),
    ] {
        let plate = Cuboid::new(Vector::new(0.5 * b as f32, 0.0005, 0.5));
        let tabulated = HydroProperties::from_shape_with(&plate, Accuracy::Tabulated);
        let added = tabulated.unwrap().added_mass;
        let what = |name| format!("{b}:1 {name}");
        let linear = added.linear[(1, 1)] / (pi / 4.0 * b);
        assert_within(linear, mass, 0.012, &what("mass"));
        let long = added.angular[(0, 0)] / (pi / 128.0 * b);
        assert_within(long, about_long, 0.012, &what("about the long axis"));
        let short = added.angular[(2, 2)] / (pi / 48.0 * b.powi(3));
        assert_within(short, about_short, 0.012, &what("about the short axis"));
    }
}
