//! The bodies of `drop`: their volume and inertia against integrals over their surfaces, and the
//! dimensionless numbers against published ones.

use crate::support::Vec3;
use crate::support::cli::{one_line, vector};
use crate::support::shape::{Lengths, MeshArgs, ShapeArgs, ShapeName, lengths};
use crate::support::specimen::{Specimen, TiltAxis};
use clap::ValueEnum;
use rapier3d_immersed::Fluid;
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::geometry::SharedShape;

/// What `--shape` and `--size` ask for.
pub fn asked(shape: ShapeName, size: Option<&[f64]>) -> ShapeArgs {
    ShapeArgs {
        shape: Some(shape),
        size: size.map(|size| Lengths(size.to_vec())),
        mesh: MeshArgs::default(),
    }
}

pub fn specimen(shape: ShapeName, size: &[f64]) -> Specimen {
    let shaped = asked(shape, Some(size)).try_shaped();
    Specimen::new(&shaped.unwrap()).unwrap()
}

/// Every shape by its own name and size: closed forms and integrals over its surface agree, about its center of mass.
#[test]
fn every_shape_has_a_name_and_a_size() {
    for shape in ShapeName::value_variants() {
        let shape = *shape;
        let word = shape.word();
        assert_eq!(ShapeName::from_str(&word, false), Ok(shape));
        if shape == ShapeName::Mesh {
            continue;
        }
        let shaped = asked(shape, None).try_shaped().unwrap();
        let (names, usual) = shape.sizes();
        assert_eq!((&shaped.name, &shaped.size[..]), (&word, usual));
        assert_eq!(names.split(',').count(), usual.len());
        let body = Specimen::new(&shaped).unwrap();
        let integrals = body.solid.volume_integrals();
        let reach = body.solid.size();
        assert!(integrals.centroid.norm() < 1e-3 * reach, "{word}");
        assert!(
            (integrals.volume / body.volume - 1.0).abs() < 5e-3,
            "{word}"
        );
        let off = (integrals.unit_inertia() - body.unit_inertia).norm();
        assert!(off < 1e-2 * body.unit_inertia.norm(), "{word}: {off}");
        // One length too many.
        let more = [usual, &[0.1]].concat();
        let (flag, problem) = asked(shape, Some(&more)).try_shaped().unwrap_err();
        assert!(flag == "--size" && problem.contains(names), "{problem}");
        assert!(
            problem.contains(&word) && problem.ends_with("0.1"),
            "{problem}"
        );
    }
    assert_eq!(ShapeName::from_str("sphere", false), Ok(ShapeName::Ball));
}

/// A cone's center of mass is a quarter of its height over its base; exactly as heavy to turn as its formula says.
#[test]
fn a_cone_turns_about_its_center_of_mass() {
    let (diameter, height) = (0.1_f64, 0.2);
    let cone = specimen(ShapeName::Cone, &[diameter, height]);
    let volume = std::f64::consts::PI / 12.0 * diameter * diameter * height;
    assert!((cone.volume / volume - 1.0).abs() < 5e-3);
    let about_axis = 0.3 * volume * (0.5 * diameter).powi(2);
    let across = 0.15 * volume * (0.25 * diameter * diameter + 0.25 * height * height);
    assert!((cone.unit_inertia[(1, 1)] / about_axis - 1.0).abs() < 1e-2);
    assert!((cone.unit_inertia[(0, 0)] / across - 1.0).abs() < 1e-2);
    let top = cone
        .solid
        .vertices()
        .iter()
        .map(|v| v.y)
        .fold(0.0, f64::max);
    assert!((top / (0.75 * height) - 1.0).abs() < 5e-3, "the tip is up");
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

    // A circular ellipse is a disc, a spherical ellipsoid a ball; both through their own formulas.
    let round = specimen(ShapeName::Ellipse, &[0.1, 0.1, 0.01]);
    assert!((round.unit_inertia - disc.unit_inertia).norm() < 1e-12 * disc.unit_inertia.norm());
    assert!((round.hydro.planform.area / disc.hydro.planform.area - 1.0).abs() < 4e-3);
    let ball = specimen(ShapeName::Ball, &[0.04]);
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
    let numbers = coin.numbers(2700.0, &water, 9.81).unwrap();
    assert!((numbers.i_star - 9.94e-3).abs() < 1e-4);
    let reynolds = numbers.reynolds_u0;
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
        let numbers = plate.numbers(1000.0, &fluid, 9.81).unwrap();
        assert!((numbers.i_star - 0.033_967).abs() < 1e-5);
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
        let mesh = MeshArgs {
            mesh: file.map(Into::into),
            ..MeshArgs::default()
        };
        let asked = ShapeArgs {
            mesh,
            ..asked(shape, size)
        };
        match asked.try_shaped() {
            Ok(shaped) => ("", Specimen::new(&shaped).unwrap_err()),
            Err(problem) => problem,
        }
    };
    let (flag, problem) = new(ShapeName::Disc, Some(&[0.1]), None);
    assert_eq!(
        (flag, &problem[..]),
        ("--size", "disc takes diameter,thickness, not 0.1")
    );
    assert_eq!(new(ShapeName::Ball, Some(&[0.1, 0.2]), None).0, "--size");
    assert_eq!(
        new(ShapeName::Ellipse, Some(&[0.02, 0.1, 0.001]), None).0,
        "--size"
    );
    assert_eq!(new(ShapeName::Capsule, Some(&[0.2, 0.1]), None).0, "--size");
    // What single precision makes a thickness of zero of.
    assert!(
        !new(ShapeName::Plate, Some(&[1e-30, 1.0, 1.0]), None)
            .1
            .is_empty()
    );
    assert_eq!(new(ShapeName::Mesh, None, None).0, "--mesh");
    assert_eq!(new(ShapeName::Mesh, None, Some("no.obj")).0, "--mesh");
    assert_eq!(
        new(ShapeName::Disc, Some(&[0.1, 0.01]), Some("no.obj")).0,
        "--mesh"
    );
    assert_eq!(
        new(ShapeName::Mesh, Some(&[0.1]), Some("no.obj")).0,
        "--size"
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
