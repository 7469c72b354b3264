//! The same solid is the same body, however it is put together; and axes that are alike are treated alike.

use super::{ellipsoid, to_f64};
use crate::published::bluff::{drag_coefficient, revolved};
use crate::support::{solid_box, sphere};
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::na::{Rotation3, UnitQuaternion, Vector3};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{
    DryMass, Fluid, FreeBody, HydroProperties, ImmersedBody, PhysicalLaw, ViscousLaw,
};

/// A box of these full extents out of `n` × `n` × `n` that touch.
fn block(size: [f64; 3], n: usize) -> SharedShape {
    let half = size.map(|x| (0.5 * x / n as f64) as f32);
    let cell = SharedShape::cuboid(half[0], half[1], half[2]);
    let place = |i: usize, axis: usize| (2 * i + 1) as f32 * half[axis] - 0.5 * size[axis] as f32;
    let mut parts = Vec::new();
    for (i, (j, k)) in
        (0..n).flat_map(|i| (0..n).flat_map(move |j| (0..n).map(move |k| (i, (j, k)))))
    {
        let at = Vector::new(place(i, 0), place(j, 1), place(k, 2));
        parts.push((Pose::from_translation(at), cell.clone()));
    }
    SharedShape::compound(parts)
}

fn body(shape: &SharedShape, density: f64) -> (ImmersedBody, DryMass) {
    let mass = DryMass::of_shape(shape.as_ref(), density).unwrap();
    let surface = Surface::from_shape(shape.as_ref()).unwrap();
    let hydro = HydroProperties::from_surface(&surface, mass.center);
    (ImmersedBody::new(hydro), mass)
}

/// How far a body has fallen in water after two seconds, from rest and tilted.
fn fall((body, mass): &(ImmersedBody, DryMass)) -> Vector3<f64> {
    let mut free = FreeBody::new(body, mass, &Fluid::WATER).unwrap();
    free.set_orientation(UnitQuaternion::from_euler_angles(0.3, 0.2, 0.1));
    for _ in 0..240 {
        free.step(1.0 / 120.0, Vector3::new(0.0, -9.81, 0.0));
    }
    free.position
}

/// A block, a brick and a plate out of 1, 8 and 64 boxes: the planform to 10⁻⁴ (the midpoint rule), and the
/// fall to a thousandth. Every part's own faces would give two and four times the planform.
#[test]
fn blocks_of_boxes_are_blocks() {
    for size in [[0.1, 0.1, 0.1], [0.2, 0.12, 0.06], [0.2, 0.12, 0.01]] {
        let one = body(
            &SharedShape::cuboid(
                (0.5 * size[0]) as f32,
                (0.5 * size[1]) as f32,
                (0.5 * size[2]) as f32,
            ),
            1500.0,
        );
        let expected = fall(&one);
        for n in [1, 2, 4] {
            let many = body(&block(size, n), 1500.0);
            let (plate, right) = (&many.0.hydro.planform, &one.0.hydro.planform);
            assert!(
                (plate.area / right.area - 1.0).abs() < 1e-4,
                "{n}: {}",
                plate.area
            );
            for (ours, right) in plate.second_moment.iter().zip(&right.second_moment) {
                assert!((ours / right - 1.0).abs() < 1e-4, "{n}: {ours} {right}");
            }
            let fallen = fall(&many);
            let miss = (fallen - expected).norm();
            assert!(
                miss < 1e-3 * expected.norm(),
                "{size:?} {n}: {fallen} {expected}"
            );
        }
    }
}

/// A solid as rapier's primitive, as a mesh, as the hull of its points, and as two or more that touch or overlap: a
/// cylinder, a cube, and an open box of thin walls, which no primitive is. Volumes count twice where parts
/// overlap, as in rapier's own mass properties, so that only the drag is compared there.
#[test]
fn the_same_solid_has_the_same_drag() {
    let surface = |shape: &SharedShape| Surface::from_shape(shape.as_ref()).unwrap();
    let hull = |mesh: &Surface| {
        let points = mesh.vertices().iter();
        let points = points.map(|v| Vector::new(v.x as f32, v.y as f32, v.z as f32));
        surface(&SharedShape::convex_hull(&points.collect::<Vec<_>>()).unwrap())
    };
    let two = |piece: SharedShape, apart: f32| {
        let at = [-0.5 * apart, 0.5 * apart].map(|y| Pose::from_translation(Vector::Y * y));
        surface(&SharedShape::compound(
            at.map(|at| (at, piece.clone())).to_vec(),
        ))
    };
    // A revolution in four steps is square, its sides at 45° to the axes.
    let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), std::f64::consts::FRAC_PI_4);
    let square = |profile: &[[f64; 2]]| {
        let profile: Vec<_> = profile.iter().map(|[r, y]| [r * 2f64.sqrt(), *y]).collect();
        revolved(&profile, 4).map(|v| turn * v)
    };
    let cylinder = revolved(&[[0.0, -0.6], [0.3, -0.6], [0.3, 0.6], [0.0, 0.6]], 40);
    let cube = square(&[[0.0, -0.5], [0.5, -0.5], [0.5, 0.5], [0.0, 0.5]]);
    let wall = 0.005;
    let open = square(&[
        [0.0, -0.3],
        [0.5, -0.3],
        [0.5, 0.3],
        [0.5 - wall, 0.3],
        [0.5 - wall, wall - 0.3],
        [0.0, wall - 0.3],
    ]);
    let half = 0.5 * wall as f32;
    let mut walls = vec![(
        Pose::from_translation(Vector::Y * (half - 0.3)),
        SharedShape::cuboid(0.5, half, 0.5),
    )];
    for side in [half - 0.5, 0.5 - half] {
        let at = |axis: Vector| Pose::from_translation(axis * side);
        walls.push((at(Vector::X), SharedShape::cuboid(half, 0.3, 0.5)));
        walls.push((at(Vector::Z), SharedShape::cuboid(0.5, 0.3, half)));
    }
    for (name, solid) in [
        (
            "cylinder",
            vec![
                surface(&SharedShape::cylinder(0.6, 0.3)),
                hull(&cylinder),
                cylinder,
                two(SharedShape::cylinder(0.4, 0.3), 0.4),
            ],
        ),
        (
            "cube",
            vec![
                surface(&SharedShape::cuboid(0.5, 0.5, 0.5)),
                hull(&cube),
                cube,
                two(SharedShape::cuboid(0.5, 0.3, 0.5), 0.4),
                surface(&block([1.0; 3], 2)),
            ],
        ),
        (
            "open box",
            vec![open, surface(&SharedShape::compound(walls))],
        ),
    ] {
        for direction in [
            Vector3::x(),
            Vector3::y(),
            -Vector3::y(),
            Vector3::new(1.0, 1.0, 0.3),
        ] {
            let expected = drag_coefficient(&solid[0], direction, 1.0, 2e4);
            for (i, other) in solid.iter().enumerate().skip(1) {
                let found = drag_coefficient(other, direction, 1.0, 2e4);
                assert!(
                    (found / expected - 1.0).abs() < 0.05,
                    "{name} {i} {direction}: {found} {expected}"
                );
            }
        }
    }
}

/// Deceleration of the spin about each of the frame's axes, over the spin, in a stream along them or in none.
fn braking((body, mass): &(ImmersedBody, DryMass), stream: f64) -> Vector3<f64> {
    Vector3::from_fn(|i, _| {
        let mut free = FreeBody::new(body, mass, &Fluid::WATER).unwrap();
        let axis = Vector3::ith(i, 1.0);
        free.set_velocity(axis * stream, axis * 5.0);
        -to_f64(free.forces(Vector3::zeros()).damping.torque)[i] / 5.0
    })
}

/// A ball and a cube are braked alike about all axes, a cylinder and a square bar about both of their axes
/// across; the bar's corners make it turn less freely about itself than the cylinder does.
#[test]
fn equal_axes_are_damped_alike() {
    let alike = |a: f64, b: f64, tolerance: f64| (a / b - 1.0).abs() < tolerance;
    for stream in [0.0, 1.0] {
        for (body, tolerance) in [
            // The facets of its surface.
            (sphere(0.05, 1500.0), 0.02),
            (ellipsoid([0.05, 0.05, 0.05], 1500.0), 0.02),
            (solid_box([0.1; 3], 1500.0, ViscousLaw::default()), 1e-3),
        ] {
            let braking = braking(&body, stream);
            assert!(
                alike(braking.x, braking.y, tolerance),
                "{stream}: {braking}"
            );
            assert!(
                alike(braking.x, braking.z, tolerance),
                "{stream}: {braking}"
            );
        }
        let law = ViscousLaw::Physical(PhysicalLaw::default());
        let bar = braking(&solid_box([0.1, 0.4, 0.1], 1500.0, law), stream);
        let cylinder = braking(&body(&SharedShape::cylinder(0.2, 0.05), 1500.0), stream);
        for across in [bar, cylinder] {
            assert!(alike(across.x, across.z, 0.01), "{stream}: {across}");
        }
        assert!(bar.y > 1.5 * cylinder.y, "{stream}: {bar} {cylinder}");
        assert!(bar.x > 3.0 * bar.y, "{stream}: {bar}");
    }
}

/// A smooth ball is braked by friction alone: at 40 m/s a baseball (145 g, of radius 3.66 cm) loses its spin
/// in about 30 s (time constant of Nathan's trajectory calculator, 30 s at 100 miles per hour, in
/// proportion to the speed).
#[test]
fn a_ball_keeps_its_spin() {
    let (body, mut mass) = sphere(0.0366, 1.0);
    let inertia = 0.4 * 0.145 * 0.0366 * 0.0366;
    mass.inertia *= inertia / mass.inertia[(0, 0)];
    mass.mass = 0.145;
    let mut free = FreeBody::new(&body, &mass, &Fluid::AIR).unwrap();
    free.set_velocity(Vector3::x() * 44.7, Vector3::z() * 200.0);
    let torque = to_f64(free.forces(Vector3::zeros()).damping.torque).z;
    let time = -inertia * 200.0 / torque;
    assert!((time / 30.0).ln().abs() < 1.5f64.ln(), "{time} s");
}
