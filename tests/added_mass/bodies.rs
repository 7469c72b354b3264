//! Closed bodies.

use crate::{as_is, assert_within, ellipsoid, solve_ellipsoid};
use rapier3d_immersed::AddedMass;
use rapier3d_immersed::boundary_element::{BoundaryElementParams, BoundaryElementSolution};
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::math::Vector;
use rapier3d_immersed::rapier3d::parry::shape::SharedShape;

/// Lamb's sphere and ellipsoids to 0.1 % of the largest entry of each block with 1280 panels.
#[test]
fn ellipsoids_to_a_thousandth() {
    for [a, b, c] in [
        [1.0, 1.0, 1.0],
        [2.0, 1.0, 1.0],
        [3.0, 2.0, 1.0],
        [1.0, 1.0, 0.3],
    ] {
        let body = ellipsoid(a, b, c);
        let (found, exact) = (solve_ellipsoid(&body, 8), body.added_mass());
        let linear = (found.linear - exact.linear).norm() / exact.linear.norm();
        println!("{a}:{b}:{c} linear {linear:.2e}");
        assert!(linear < 1e-3, "{a}:{b}:{c}: {linear:.2e}");
        let solid = body.volume() * (a * a + b * b) / 5.0;
        let angular = (found.angular - exact.angular).norm() / exact.angular.norm().max(solid);
        println!("{a}:{b}:{c} angular {angular:.2e}");
        assert!(angular < 1e-3, "{a}:{b}:{c}: {angular:.2e}");
        assert!(found.coupling.norm() < 1e-6 * solid, "{}", found.coupling);
    }
}

/// Order of convergence in panel size, on a body without edges: the flat panels' geometry is of order
/// 2, so that four times the panels make a quarter of the error.
#[test]
fn ellipsoids_converge_at_second_order() {
    let body = ellipsoid(1.0, 0.8, 0.6);
    let exact = body.added_mass();
    let error = |cells| {
        let found = solve_ellipsoid(&body, cells);
        (found.angular - exact.angular).norm() / exact.angular.norm()
            + (found.linear - exact.linear).norm() / exact.linear.norm()
    };
    let errors = [3, 6].map(error);
    let order = (errors[0] / errors[1]).log2();
    println!("{errors:?} order {order}");
    assert!(order > 1.5, "{errors:?}: order {order}");
}

/// A leaf of 7.3 × 4.2 × 0.03 cm: within 1 % of Lamb for the motions that move fluid, where the
/// thesis's figure 5.2 shows 90 %. Its motions in the plane have a two-thousandth of the added mass
/// of the broadside one, and are held to 1 % of that.
#[test]
fn leaf_within_a_hundredth_of_lamb() {
    let leaf = ellipsoid(0.0365, 0.021, 0.00015);
    let (found, exact) = (solve_ellipsoid(&leaf, 8), leaf.added_mass());
    let broadside = exact.linear[(2, 2)];
    assert_within(found.linear[(2, 2)], broadside, 0.01, "broadside");
    assert_within(
        found.angular[(0, 0)],
        exact.angular[(0, 0)],
        0.01,
        "about the long axis",
    );
    assert_within(
        found.angular[(1, 1)],
        exact.angular[(1, 1)],
        0.01,
        "about the short axis",
    );
    for i in 0..2 {
        let error = found.linear[(i, i)] - exact.linear[(i, i)];
        assert!(error.abs() < 0.01 * broadside, "{i}: {error}");
    }
}

/// However thin: the closed surface needs no other formulation.
#[test]
fn extremely_thin_ellipsoids() {
    for thickness in [1e-3, 1e-5] {
        let body = ellipsoid(1.0, 0.575, thickness);
        let surface = Surface::ellipsoid(&body, 6).unwrap();
        let (found, report) = AddedMass::solve(&surface, &as_is()).unwrap();
        assert!(report.definite, "{report:?}");
        let exact = body.added_mass();
        assert_within(
            found.linear[(2, 2)],
            exact.linear[(2, 2)],
            0.01,
            "broadside",
        );
        for i in 0..2 {
            assert_within(
                found.angular[(i, i)],
                exact.angular[(i, i)],
                0.02,
                "turning",
            );
        }
    }
}

/// Cube: polarisability −1.6383 of a perfectly impermeable cube (Sihvola et al. 2004, *IEEE Trans. Antennas
/// Propag.* 52), added mass 0.6383 ρV. Its moment of inertia 0.0392 ρa⁵ was computed with another
/// boundary-element program, and square prisms 1 × 1 × 2, .334 and .834, too.
#[test]
fn cube_and_square_prism() {
    let params = BoundaryElementParams {
        tolerance: 0.003,
        max_panels: 3000,
        ..BoundaryElementParams::default()
    };
    let solve = |x: f32, y: f32, z: f32| {
        let shape = SharedShape::cuboid(x, y, z);
        let (added, report) =
            AddedMass::of_shape(shape.as_ref(), Vector::ZERO, params.tolerance).unwrap();
        println!("{report:?}");
        assert!(report.converged && report.definite, "{report:?}");
        added
    };
    let cube = solve(0.5, 0.5, 0.5);
    for i in 0..3 {
        assert_within(cube.linear[(i, i)], 0.6383, 0.01, "cube");
        assert_within(cube.angular[(i, i)], 0.0392, 0.01, "cube's rotation");
    }
    let prism = solve(0.5, 0.5, 1.0);
    assert_within(prism.linear[(2, 2)] / 2.0, 0.334, 0.01, "prism along");
    assert_within(prism.linear[(0, 0)] / 2.0, 0.834, 0.01, "prism across");
}

/// Circular cylinders, computed with Capytaine to ±3 %: axial over 8/3 ρa³, rotation about a
/// diameter over 16/45 ρa⁵ for thin ones; lateral over ρV for long ones.
#[test]
fn cylinders() {
    let solve = |half_height: f32| {
        let shape = SharedShape::cylinder(half_height, 1.0);
        let (added, report) = AddedMass::of_shape(shape.as_ref(), Vector::ZERO, 0.01).unwrap();
        println!("{report:?}");
        assert!(report.converged, "{report:?}");
        added
    };
    for (ratio, axial, diametral) in [
        (0.05, 1.08, 1.11),
        (0.1, 1.13, 1.15),
        (0.2, 1.21, 1.18),
        (0.5, 1.30, 1.17),
    ] {
        let added = solve(ratio);
        assert_within(added.linear[(1, 1)] / (8.0 / 3.0), axial, 0.03, "axial");
        assert_within(
            added.angular[(0, 0)] / (16.0 / 45.0),
            diametral,
            0.03,
            "diametral",
        );
    }
    for (ratio, lateral) in [(1.0, 0.58), (5.0, 0.88)] {
        let volume = std::f64::consts::TAU * f64::from(ratio);
        let added = solve(ratio);
        assert_within(added.linear[(0, 0)] / volume, lateral, 0.03, "lateral");
    }
}

/// A user's coarse mesh, here a box of twelve triangles, is refined by itself to the same values.
#[test]
fn coarse_mesh_is_refined() {
    let box_ = Surface::from_shape(SharedShape::cuboid(0.5, 0.5, 0.5).as_ref()).unwrap();
    assert_eq!(box_.triangles().len(), 12);
    let params = BoundaryElementParams {
        tolerance: 0.02,
        max_panels: 3000,
        ..BoundaryElementParams::default()
    };
    let (added, report) = AddedMass::solve(&box_, &params).unwrap();
    println!("{report:?}");
    assert!(report.converged && report.panels > 100, "{report:?}");
    assert_within(added.linear[(0, 0)], 0.6383, 0.01, "cube");
    // The estimate is not smaller than the error.
    let error = (added.linear[(0, 0)] / 0.6383 - 1.0).abs();
    assert!(error <= report.estimated_error.unwrap() + 1e-3, "{error}");
    // Not converging is said, not raised.
    let strict = BoundaryElementParams {
        tolerance: 1e-6,
        max_panels: 600,
        ..params
    };
    let (_, report) = AddedMass::solve(&box_, &strict).unwrap();
    assert!(!report.converged && report.panels <= 600);
    let (_, once) = AddedMass::solve(&box_, &as_is()).unwrap();
    assert_eq!((once.panels, once.estimated_error), (12, None));
}

/// Every kind of shape that encloses a volume can be solved for. Rounded shapes come with some
/// thousand panels of their own and are solved for as they are.
#[test]
fn every_kind_of_shape() {
    let hull = [Vector::X, Vector::Y, Vector::Z, Vector::ZERO, Vector::ONE];
    for shape in [
        SharedShape::ball(0.5),
        SharedShape::capsule_y(0.5, 0.3),
        SharedShape::cone(0.5, 0.3),
        SharedShape::convex_hull(&hull).unwrap(),
        SharedShape::round_cuboid(0.5, 0.4, 0.3, 0.1),
        SharedShape::voxels_from_points(Vector::splat(0.5), &[Vector::ZERO, Vector::X]),
    ] {
        let kind = format!("{:?}", shape.shape_type());
        let params = BoundaryElementParams {
            tolerance: 0.2,
            max_panels: 2500,
            ..BoundaryElementParams::default()
        };
        let solved = BoundaryElementSolution::of_shape(shape.as_ref(), &params, &|_| ()).unwrap();
        let (added, report) = (solved.added_mass, solved.report);
        println!(
            "{kind}: {} panels, error {:?}",
            report.panels, report.estimated_error
        );
        assert!(report.definite && added.is_physical(), "{kind}: {report:?}");
        // A sphere has ½, a cube 0.64; flatter or more angular bodies up to about twice that.
        let volume = Surface::from_shape(shape.as_ref())
            .unwrap()
            .volume_integrals()
            .volume;
        let mean = added.linear.trace() / 3.0 / volume;
        assert!((0.3..1.5).contains(&mean), "{kind}: {mean}");
    }
}
