//! The bodies of `drop`: their volume and inertia against integrals over their surfaces, and the
//! dimensionless numbers against published ones.

use crate::support::Vec3;
use crate::support::cli::{Lengths, lengths, one_line, vector};
use crate::support::specimen::{ShapeName, Specimen, TiltAxis};
use rapier3d_immersed::Fluid;
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::geometry::SharedShape;

fn specimen(shape: ShapeName, size: &[f64]) -> Specimen {
    Specimen::new(shape, Some(&Lengths(size.to_vec())), None, None, 1e-3).unwrap()
}

#[test]
fn inertia_agrees_with_the_surface() {
    // Inscribed polyhedra blown up to the exact volume: moments right to about 10⁻³.
    let disc = Surface::from_shape(&*SharedShape::cylinder(0.005, 0.05)).unwrap();
    let expected = disc.volume_integrals();
    let disc = specimen(ShapeName::Disc, &[0.1, 0.01]);
    assert!((disc.volume / expected.volume - 1.0).abs() < 1e-6);
    let error = (disc.unit_inertia - expected.unit_inertia()).norm();
    assert!(error < 4e-3 * disc.unit_inertia.norm(), "{error}");

    let cuboid = Surface::from_shape(&*SharedShape::cuboid(0.05, 0.1, 0.15)).unwrap();
    let expected = cuboid.volume_integrals();
    let cuboid = specimen(ShapeName::Box, &[0.1, 0.2, 0.3]);
    let error = (cuboid.unit_inertia - expected.unit_inertia()).norm();
    assert!(error < 1e-6 * cuboid.unit_inertia.norm(), "{error}");

    // A circular ellipse is a disc, a spherical ellipsoid a sphere; both through their own formulas.
    let round = specimen(ShapeName::Ellipse, &[0.1, 0.1, 0.01]);
    assert!((round.unit_inertia - disc.unit_inertia).norm() < 1e-12 * disc.unit_inertia.norm());
    assert!((round.hydro.planform.area / disc.hydro.planform.area - 1.0).abs() < 4e-3);
    let ball = specimen(ShapeName::Sphere, &[0.04]);
    let ellipsoid = specimen(ShapeName::Ellipsoid, &[0.04; 3]);
    assert!((ball.unit_inertia - ellipsoid.unit_inertia).norm() < 1e-12 * ball.unit_inertia.norm());
    assert!((ball.hydro.volume / ellipsoid.hydro.volume - 1.0).abs() < 1e-5);
}

#[test]
fn the_yen_coin_has_the_published_numbers() {
    // Thesis § 3.6: d = 2.0 cm, t = 0.15 cm, aluminium in water, printed as I* = 10⁻² and Re = 3.55·10³.
    // With 2700 kg/m³, and 1000 kg/m³ and 0.89·10⁻⁶ m²/s for water (none printed), I* is 9.94·10⁻³.
    let coin = specimen(ShapeName::Disc, &[0.02, 0.0015]);
    let water = Fluid::new(1000.0, 0.89e-6).unwrap();
    assert!((coin.i_star(2700.0, &water) - 9.94e-3).abs() < 1e-4);
    let reynolds = coin.u0(2700.0, &water, 9.81) * coin.length / 0.89e-6;
    assert!((reynolds / 3.55e3 - 1.0).abs() < 2e-3, "{reynolds}");
}

#[test]
fn a_plate_is_the_same_in_any_order_and_lies_flat() {
    let orders = [[0.2, 0.001, 0.05], [0.001, 0.05, 0.2], [0.05, 0.2, 0.001]];
    for size in orders {
        let plate = specimen(ShapeName::Plate, &size);
        assert_eq!((plate.thickness, plate.length), (0.001, 0.05));
        assert!((plate.span - 0.2).abs() < 1e-8);
        // Rectangle formula at ρ_s/ρ_f = 2 by hand: 16/(3π)·(a² + b²)b/a³, a = .05, b = .001.
        let fluid = Fluid::new(500.0, 1e-6).unwrap();
        assert!((plate.i_star(1000.0, &fluid) - 0.033_967).abs() < 1e-5);
        let axes = plate.hydro.planform.axes;
        let level = plate.released_at(0.0, TiltAxis::Long);
        assert!(
            (level * (axes * Vec3::z()) - Vec3::y()).norm() < 1e-9,
            "{size:?}"
        );
        assert!(
            (level * (axes * Vec3::x()) - Vec3::x()).norm() < 1e-9,
            "{size:?}"
        );
        let dipped = plate.released_at(0.5, TiltAxis::Short) * (axes * Vec3::x());
        assert!((dipped - Vec3::new(0.5_f64.cos(), -0.5_f64.sin(), 0.0)).norm() < 1e-9);
        // A positive angle lowers the +z side: the normal leans toward +z.
        let tilted = plate.released_at(0.5, TiltAxis::Long) * (axes * Vec3::z());
        assert!((tilted - Vec3::new(0.0, 0.5_f64.cos(), 0.5_f64.sin())).norm() < 1e-9);
    }
}

#[test]
fn wrong_sizes_name_the_flag() {
    let new = |shape, size: Option<&[f64]>, file: Option<&str>| {
        let size = size.map(|s| Lengths(s.to_vec()));
        Specimen::new(shape, size.as_ref(), file.map(AsRef::as_ref), None, 1e-3).unwrap_err()
    };
    assert_eq!(new(ShapeName::Disc, Some(&[0.1]), None).0, "--size");
    assert_eq!(new(ShapeName::Disc, None, None).0, "--size");
    assert_eq!(new(ShapeName::Sphere, Some(&[0.1, 0.2]), None).0, "--size");
    assert_eq!(
        new(ShapeName::Ellipse, Some(&[0.02, 0.1, 0.001]), None).0,
        "--size"
    );
    assert_eq!(
        new(ShapeName::Plate, Some(&[1e-30, 1.0, 1.0]), None).0,
        "--size"
    );
    assert_eq!(new(ShapeName::Mesh, None, None).0, "--mesh");
    let scaled = Specimen::new(
        ShapeName::Sphere,
        Some(&Lengths(vec![0.1])),
        None,
        Some(2.0),
        1e-3,
    );
    assert_eq!(scaled.unwrap_err().0, "--scale");
    assert_eq!(new(ShapeName::Mesh, None, Some("no.obj")).0, "--mesh");
    assert_eq!(
        new(ShapeName::Disc, Some(&[0.1, 0.01]), Some("no.obj")).0,
        "--mesh"
    );
}

#[test]
fn values_from_the_command_line() {
    assert_eq!(lengths("0.1, 2e-3").unwrap(), Lengths(vec![0.1, 2e-3]));
    for bad in ["", "0", "-1", "nan", "inf", "1,2,3,4", "1,,2", "1;2"] {
        assert!(lengths(bad).is_err(), "{bad}");
    }
    assert_eq!(vector("1,-2,3e-1").unwrap(), Vec3::new(1.0, -2.0, 0.3));
    for bad in ["1", "1,2", "1,2,3,4", "a,b,c", "1,2,inf"] {
        assert!(vector(bad).is_err(), "{bad}");
    }
    let message = "error: invalid value 'x' for '--fluid <FLUID>'\n  [possible values: air, water]\n\nFor more";
    let line = "error: invalid value 'x' for '--fluid <FLUID>' [possible values: air, water]";
    assert_eq!(one_line(message), line);
}
