//! What must hold for every body, whatever its added mass.

use crate::as_is;
use rapier3d_immersed::AddedMass;
use rapier3d_immersed::Error;
use rapier3d_immersed::boundary_element::BoundaryElementParams;
use rapier3d_immersed::geometry::{Sheet, Surface};
use rapier3d_immersed::rapier3d::math::{Pose, Vector};
use rapier3d_immersed::rapier3d::na::{Rotation3, Vector3};
use rapier3d_immersed::rapier3d::parry::shape::SharedShape;

/// A cone cut in half along its axis: no center of symmetry, so that its coupling cannot vanish.
fn half_cone() -> Surface {
    let mut points = vec![Vector::Y];
    points.extend((0..=8).map(|i| {
        let (sin, cos) = (std::f32::consts::PI * i as f32 / 8.0).sin_cos();
        Vector::new(0.5 * cos, 0.0, 0.5 * sin)
    }));
    let hull = SharedShape::convex_hull(&points).unwrap();
    let mut surface = Surface::from_shape(hull.as_ref()).unwrap();
    // Divided evenly, by rapier's own triangles: the middle of each edge.
    for _ in 0..2 {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for [a, b, c] in surface.corners() {
            let n = vertices.len() as u32;
            vertices.extend([a, b, c, (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0]);
            triangles.extend(
                [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]].map(|t| t.map(|i: u32| n + i)),
            );
        }
        surface = Surface::new(&vertices, &triangles).unwrap();
    }
    surface
}

fn solve(surface: &Surface) -> AddedMass {
    let (added, report) = AddedMass::solve(surface, &as_is()).unwrap();
    assert!(report.definite && report.asymmetry < 1e-2, "{report:?}");
    added
}

fn difference(a: &AddedMass, b: &AddedMass) -> f64 {
    (a.to_matrix6() - b.to_matrix6()).norm() / a.to_matrix6().norm()
}

/// The coupling of the half-cone, and all else: turning and moving the mesh turns and moves the
/// tensor. Rounding alone is left.
#[test]
fn moving_the_body_moves_the_tensor() {
    let body = half_cone();
    let added = solve(&body);
    assert!(added.is_physical());
    let coupling = added.coupling.norm() / (added.linear.norm() * added.angular.norm()).sqrt();
    println!("coupling {coupling}");
    assert!(coupling > 0.01, "{}", added.coupling);

    let turn = Rotation3::from_euler_angles(0.4, -1.2, 2.0);
    let shift = Vector3::new(3.0, -2.0, 5.0);
    let moved = solve(&body.map(|v| turn * v + shift));
    let error = difference(&added.rotated(&turn), &moved);
    println!("turned {error:.1e}");
    assert!(error < 1e-9, "{error}");

    // About a point other than the centroid: computed there, and shifted there.
    let shape = SharedShape::cone(0.5, 0.3);
    let at = Vector::new(0.25, -0.5, 0.125);
    let [here, there] =
        [Vector::ZERO, at].map(|point| AddedMass::of_shape(shape.as_ref(), point, 0.05).unwrap().0);
    let shifted = here.about(Vector3::new(0.25, -0.5, 0.125));
    assert!(difference(&shifted, &there) < 1e-9);
}

/// Both scale as they must: m³, m⁴, m⁵.
#[test]
fn scaling() {
    let body = half_cone();
    let (added, large) = (solve(&body), solve(&body.map(|v| v * 10.0)));
    assert!((large.linear - added.linear * 1e3).norm() < 1e-8 * large.linear.norm());
    assert!((large.coupling - added.coupling * 1e4).norm() < 1e-8 * large.linear.norm() * 10.0);
    assert!((large.angular - added.angular * 1e5).norm() < 1e-8 * large.angular.norm());
}

/// Two bodies far apart feel nothing of each other: their tensors add up about a common point. A
/// dipole at ten diameters is worth 10⁻³.
#[test]
fn distant_bodies_add_up() {
    let part = SharedShape::cuboid(0.5, 0.3, 0.2);
    let one = solve(&Surface::panelled(part.as_ref(), 5).unwrap());
    let poses = [-5.0, 5.0].map(|x| Pose::from_translation(Vector::X * x));
    let both = SharedShape::compound(poses.map(|p| (p, part.clone())).to_vec());
    let both = solve(&Surface::panelled(both.as_ref(), 5).unwrap());
    let sum = one.about(Vector3::x() * -5.0) + one.about(Vector3::x() * 5.0);
    let error = difference(&sum, &both);
    println!("two bodies {error:.1e}");
    assert!(error > 0.0 && error < 3e-3, "{error}");
}

/// A sheet turned and moved likewise.
#[test]
fn moving_a_sheet_moves_the_tensor() {
    let plane = Sheet::paper_airplane(0.083, 1e-4, 8).unwrap();
    let turn = Rotation3::from_euler_angles(0.4, -1.2, 2.0);
    let solve = |sheet: &Sheet| AddedMass::solve_sheet(sheet, &as_is()).unwrap().0;
    let (added, moved) = (
        solve(&plane),
        solve(&plane.map(|v| turn * v + Vector3::x())),
    );
    assert!(difference(&added.rotated(&turn), &moved) < 1e-9);
    assert!(added.is_physical());
    // Mirror symmetry across y: these motions do not mix.
    assert!(added.linear[(0, 1)].abs() < 1e-6 * added.linear.norm());
    // Sinking, it pitches: the tail is wider than the nose.
    assert!(added.coupling[(2, 1)].abs() > 1e-2 * added.coupling.norm());
}

/// The order of additions is fixed: the same digits whatever the number of threads.
#[test]
fn threads_do_not_matter() {
    let body = half_cone();
    let in_pool = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| solve(&body))
    };
    let difference = difference(&in_pool(1), &in_pool(3));
    // The assembly is the same to the last bit; the factorisation blocks by thread.
    assert!(difference < 1e-12, "{difference}");
}

/// Whatever is wrong with the input is named.
#[test]
fn bad_input_is_an_error() {
    let body = half_cone();
    for (params, culprit) in [
        (
            BoundaryElementParams {
                tolerance: f64::NAN,
                ..as_is()
            },
            "tolerance",
        ),
        (
            BoundaryElementParams {
                max_panels: 0,
                ..as_is()
            },
            "max_panels",
        ),
        (
            BoundaryElementParams {
                far: 0.5,
                ..as_is()
            },
            "far",
        ),
        (
            BoundaryElementParams {
                close_levels: 99,
                ..as_is()
            },
            "close_levels",
        ),
    ] {
        match AddedMass::solve(&body, &params) {
            Err(Error::InvalidParameter { parameter, .. }) => assert_eq!(parameter, culprit),
            other => panic!("{culprit}: {other:?}"),
        }
    }
    let small = BoundaryElementParams {
        max_panels: 10,
        ..as_is()
    };
    let too_many = AddedMass::solve(&body, &small).unwrap_err();
    assert!(
        matches!(too_many, Error::TooManyPanels { max_panels: 10, .. }),
        "{too_many}"
    );

    let part = SharedShape::cuboid(0.5, 0.5, 0.5);
    let poses = [0.0, 0.7].map(|x| Pose::from_translation(Vector::X * x));
    let overlapping = SharedShape::compound(poses.map(|p| (p, part.clone())).to_vec());
    let error = AddedMass::of_shape(overlapping.as_ref(), Vector::ZERO, 0.1).unwrap_err();
    assert!(matches!(error, Error::SelfIntersection { .. }), "{error}");
    let nowhere = AddedMass::of_shape(part.as_ref(), Vector::NAN, 0.1);
    assert!(nowhere.is_err() && AddedMass::of_shape(part.as_ref(), Vector::ZERO, 0.0).is_err());
    let plane = SharedShape::halfspace(Vector::Y);
    assert!(AddedMass::of_shape(plane.as_ref(), Vector::ZERO, 0.1).is_err());
}
