//! Every shape that a collider can have is described as it is, at any aspect and scale: its volume, the
//! fluid that it drags along, and the mass that rapier gives it.

use crate::support::weightless;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rapier3d_immersed::geometry::{Ellipsoid, Surface};
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::rapier3d::parry::math::IVector;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{DryMass, Fluid, HydroProperties, Immersion, Warning};
use std::f64::consts::PI;

fn wide(x: f32) -> f64 {
    x.into()
}

/// Steiner's formula for a convex core grown by r: its volume, area and integral of mean curvature.
fn steiner([volume, area, curvature]: [f64; 3], r: f64) -> f64 {
    volume + area * r + curvature * r * r + 4.0 / 3.0 * PI * r.powi(3)
}

fn of_box([a, b, c]: [f64; 3]) -> [f64; 3] {
    [
        8.0 * a * b * c,
        8.0 * (a * b + b * c + c * a),
        2.0 * PI * (a + b + c),
    ]
}

fn of_cylinder(r: f64, h: f64) -> [f64; 3] {
    [
        2.0 * PI * r * r * h,
        2.0 * PI * r * (r + 2.0 * h),
        2.0 * PI * h + PI * PI * r,
    ]
}

/// The slope turns by 2h/l·2π per length; the rim by the angle between the slope's normal and the base's.
fn of_cone(r: f64, h: f64) -> [f64; 3] {
    let slant = (2.0 * h).hypot(r);
    [
        2.0 / 3.0 * PI * r * r * h,
        PI * r * (r + slant),
        2.0 * PI * h + PI * r * (PI - (2.0 * h).atan2(r)),
    ]
}

fn of_tetrahedron(p: [Vector3<f64>; 4]) -> [f64; 3] {
    let normal = |i: usize| {
        let [a, b, c] = [1, 2, 3].map(|k| p[(i + k) % 4]);
        let n = (b - a).cross(&(c - a));
        n * (a - p[i]).dot(&n).signum()
    };
    let area = (0..4).map(|i| normal(i).norm() / 2.0).sum();
    let mut curvature = 0.0;
    for i in 0..4 {
        for j in i + 1..4 {
            // The faces opposite i and j share the edge of the other two points.
            let others: Vec<usize> = (0..4).filter(|k| *k != i && *k != j).collect();
            let length = (p[others[0]] - p[others[1]]).norm();
            curvature += 0.5 * length * normal(i).angle(&normal(j));
        }
    }
    let volume = (p[1] - p[0]).cross(&(p[2] - p[0])).dot(&(p[3] - p[0])) / 6.0;
    [volume.abs(), area, curvature]
}

/// A shape, its exact volume, and to which share rapier's single precision lets it be known.
struct Case {
    shape: SharedShape,
    volume: f64,
    tolerance: f64,
    text: String,
}

/// Shapes of 1 mm to 100 m with proportions of up to 1 : 3000, and borders from none to wider than the core.
fn cases(count: usize) -> Vec<Case> {
    let mut random = Pcg64Mcg::seed_from_u64(590);
    let mut cases = Vec::new();
    for i in 0.. {
        if cases.len() == count {
            break;
        }
        let mut power = |low: f64, high: f64| 10f64.powf(random.random_range(low..high));
        let size = power(-3.0, 2.0);
        let [a, b, c] = [0, 1, 2].map(|_| (size * power(-3.5, 0.0)) as f32);
        let border = (size * power(-4.0, 0.5)) as f32;
        let [x, y, z, r] = [a, b, c, border].map(wide);
        let mut point =
            |size: [f32; 3]| Vector::from(size.map(|s| s * random.random_range(-1.0..1.0)));
        let (shape, volume, tolerance) = match i % 14 {
            0 => (SharedShape::ball(a), 4.0 / 3.0 * PI * x.powi(3), 1e-9),
            1 => (SharedShape::cuboid(a, b, c), of_box([x, y, z])[0], 1e-9),
            2 => {
                let volume = PI * y * y * (4.0 / 3.0 * y + 2.0 * x);
                (SharedShape::capsule_y(a, b), volume, 1e-6)
            }
            3 => (SharedShape::cylinder(a, b), of_cylinder(y, x)[0], 1e-9),
            4 => (SharedShape::cone(a, b), of_cone(y, x)[0], 1e-9),
            5 | 6 => {
                let shape = SharedShape::round_cuboid(a, b, c, border);
                (shape, steiner(of_box([x, y, z]), r), 1e-9)
            }
            7 | 8 => {
                let shape = SharedShape::round_cylinder(a, b, border);
                (shape, steiner(of_cylinder(y, x), r), 1e-9)
            }
            9 | 10 => {
                let shape = SharedShape::round_cone(a, b, border);
                (shape, steiner(of_cone(y, x), r), 1e-9)
            }
            11 => {
                let p = [0; 4].map(|_| point([a, b, c]));
                let exact = of_tetrahedron(p.map(|p| Vector3::from(p.to_array()).cast()));
                let indices = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]];
                let shape = if i % 2 == 0 {
                    let Some(shape) = SharedShape::round_convex_hull(&p, border) else {
                        continue;
                    };
                    (shape, steiner(exact, r), 1e-6)
                } else {
                    let shape = SharedShape::trimesh(p.to_vec(), indices.to_vec()).unwrap();
                    (shape, exact[0], 1e-6)
                };
                // Too flat for rapier to find a hull of, or for the mesh to be closed in single precision.
                if exact[0] < 1e-4 * (x.max(y).max(z)).powi(3) {
                    continue;
                }
                shape
            }
            12 => {
                let [p, q, s] = [0; 3].map(|_| point([a, b, c]));
                let [u, v, w] = [p, q, s].map(|p| Vector3::<f64>::from(p.to_array().map(wide)));
                let area = (v - u).cross(&(w - u)).norm();
                let perimeter = (v - u).norm() + (w - v).norm() + (u - w).norm();
                let shape = SharedShape::round_triangle(p, q, s, border);
                (shape, steiner([0.0, area, 0.5 * PI * perimeter], r), 1e-9)
            }
            _ => {
                let cells: std::collections::BTreeSet<_> = (0..40)
                    .map(|_| [0; 3].map(|_| random.random_range(-4..4)))
                    .collect();
                let keys: Vec<_> = cells.iter().map(|cell| IVector::from(*cell)).collect();
                let shape = SharedShape::voxels(Vector::new(a, b, c), &keys);
                (shape, cells.len() as f64 * x * y * z, 1e-9)
            }
        };
        let text = format!("case {i}: {:?} {a} {b} {c} {border}", shape.shape_type());
        cases.push(Case {
            shape,
            volume,
            tolerance,
            text,
        });
    }
    cases
}

/// All have their exact volume, a centroid inside of their bounds, and a description that can be true. What
/// they drag along is above nothing and below what the ellipsoid around their box does: added mass plus
/// displaced mass grows with the body (the fluid at rest between the smaller body and the larger is a flow
/// around the smaller, and by Kelvin's theorem not the one of least energy). The proxy is allowed its error of
/// up to 50 % (table of `Accuracy`).
#[test]
fn every_shape_is_described() {
    for case in cases(700) {
        let text = &case.text;
        let surface =
            Surface::from_shape(case.shape.as_ref()).unwrap_or_else(|e| panic!("{text}: {e}"));
        let found = surface.volume_integrals();
        let error = (found.volume / case.volume - 1.0).abs();
        assert!(
            error < case.tolerance,
            "{text}: {} for {}",
            found.volume,
            case.volume
        );
        let bounds = case.shape.compute_local_aabb();
        let center: [f32; 3] = found.centroid.map(|x| x as f32).into();
        assert!(bounds.contains_local_point(center.into()), "{text}");

        let hydro = HydroProperties::from_shape(case.shape.as_ref()).unwrap();
        hydro.check().unwrap_or_else(|e| panic!("{text}: {e}"));
        let half = hydro.planform.half_extents;
        let around = Ellipsoid {
            semi_axes: half * 3f64.sqrt(),
        };
        let most = around.added_mass();
        let axes = hydro.planform.axes;
        let own = hydro
            .added_mass_about(hydro.centroid)
            .rotated(&axes.inverse());
        for k in 0..3 {
            let dragged = own.linear[(k, k)];
            let bound = most.linear[(k, k)] + around.volume() - hydro.volume;
            assert!(dragged >= 0.0 && dragged < 1.5 * bound, "{text}, axis {k}");
            // Zero up to the rounding of a way to the frame's origin and back.
            let rounding = 1e-12 * own.angular.amax().max(hydro.added_mass.angular.amax());
            assert!(
                own.angular[(k, k)] >= -rounding,
                "{text}, turning about {k}"
            );
        }
    }
}

/// Rapier's own answer to "is this point inside" agrees with the volume and the second moments, within four
/// standard deviations of 30,000 points.
#[test]
fn points_inside_agree() {
    let mut random = Pcg64Mcg::seed_from_u64(4);
    let shapes = [
        SharedShape::round_cuboid(0.5, 0.2, 0.3, 0.1),
        SharedShape::round_cuboid(0.9, 0.03, 0.6, 0.06),
        SharedShape::round_cylinder(0.2, 0.5, 0.1),
        SharedShape::round_cone(0.5, 0.3, 0.2),
        SharedShape::round_cone(0.05, 0.6, 0.02),
        SharedShape::round_triangle(Vector::ZERO, Vector::X, Vector::Y, 0.2),
        SharedShape::round_convex_hull(
            &[
                Vector::ZERO,
                Vector::X,
                Vector::Y * 0.8,
                Vector::Z * 0.6,
                Vector::new(0.7, 0.9, 0.8),
                Vector::new(0.9, -0.2, 0.6),
            ],
            0.15,
        )
        .unwrap(),
    ];
    for shape in shapes {
        let bounds = shape.compute_local_aabb();
        let size = bounds.extents();
        let count = 30_000;
        let (mut inside, mut sums) = (0.0, [0.0; 3]);
        let found = Surface::from_shape(shape.as_ref())
            .unwrap()
            .volume_integrals();
        for _ in 0..count {
            let share = [0; 3].map(|_| random.random_range(0.0..1.0f32));
            let point = bounds.mins + Vector::from(share) * size;
            if shape.contains_local_point(point) {
                inside += 1.0;
                for k in 0..3 {
                    sums[k] += (wide(point[k]) - found.centroid[k]).powi(2);
                }
            }
        }
        let all = f64::from(count);
        let volume = size.to_array().map(wide).iter().product::<f64>();
        let share = found.volume / volume;
        let deviation = (share * (1.0 - share) / all).sqrt();
        assert!(
            (inside / all - share).abs() < 4.0 * deviation,
            "{share} {}",
            inside / all
        );
        for (k, sum) in sums.iter().enumerate() {
            let mean = sum / inside;
            let exact = found.second_moment[(k, k)] / found.volume;
            // The fourth moment is below 3 times the square of the second for bodies without tails.
            let deviation = exact * (2.0 / inside).sqrt();
            assert!(
                (mean - exact).abs() < 4.0 * deviation + 1e-3 * exact,
                "{mean} {exact}"
            );
        }
    }
}

/// Flat round bodies drag 8/3 a³ along broadside (Lamb § 102) and 16/45 a⁵ about a diameter, whether cylinder
/// or cone, sharp or rounded; needles of revolution their displaced volume across (Lighthill's slender body).
#[test]
fn flat_and_slender_limits() {
    let (a, thin) = (0.7f32, 1e-4f32);
    let disc = [
        SharedShape::cylinder(thin, a),
        SharedShape::cone(thin, a),
        SharedShape::round_cylinder(thin, a - thin, thin),
        SharedShape::round_cone(thin, a - thin, thin),
        SharedShape::round_cylinder(0.0, a - thin, thin),
    ];
    for shape in disc {
        let hydro = HydroProperties::from_shape(shape.as_ref()).unwrap();
        let added = hydro.added_mass_about(hydro.centroid);
        let broadside = added.linear[(1, 1)] / (8.0 / 3.0 * wide(a).powi(3));
        let about = added.angular[(0, 0)] / (16.0 / 45.0 * wide(a).powi(5));
        // A polygon of 64 corners, thickness 10⁻⁴.
        assert!((broadside - 1.0).abs() < 4e-3, "{broadside}");
        assert!((about - 1.0).abs() < 8e-3, "{about}");
        assert!(added.linear[(0, 0)] < 1e-3 * added.linear[(1, 1)]);
    }
    let needle = [
        SharedShape::capsule_y(30.0, 0.1),
        SharedShape::cylinder(30.0, 0.1),
        SharedShape::cone(33.889744, 0.10938867),
        SharedShape::round_cylinder(30.0, 0.05, 0.05),
        SharedShape::round_cone(30.0, 0.1, 0.001),
    ];
    for shape in needle {
        let hydro = HydroProperties::from_shape(shape.as_ref()).unwrap();
        hydro.check().unwrap();
        let added = hydro.added_mass_about(hydro.centroid);
        // By their shadows 8/(3π) of a cylinder's and 4/π of a cone's; along it what blunt ends push.
        let across = added.linear[(0, 0)] / hydro.volume;
        assert!(across > 0.84 && across < 1.29, "{across}");
        assert!(added.linear[(1, 1)] < 3e-3 * hydro.volume);
    }
}

/// A strip a thousand times as long as wide, and ten times as wide as thick, is a plate with its normal along
/// its thickness, however it lies in its frame.
#[test]
fn strips_know_their_flat_side() {
    let half = [1.0f32, 1e-3, 1e-4];
    for order in [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [2, 1, 0],
        [2, 0, 1],
        [1, 2, 0],
    ] {
        let extents = order.map(|i| half[i]);
        let normal = order.iter().position(|i| *i == 2).unwrap();
        for roll in [0.0, 0.5] {
            let strip = SharedShape::cuboid(extents[0], extents[1], extents[2]);
            let along = order.iter().position(|i| *i == 0).unwrap();
            let mut turn = Vector::ZERO;
            turn[along] = roll;
            let pose = Pose::new(Vector::ZERO, turn);
            let parts = vec![(pose, strip)];
            let hydro = HydroProperties::from_shape(SharedShape::compound(parts).as_ref()).unwrap();
            let mut expected = Vector::ZERO;
            expected[normal] = 1.0;
            let expected: Vector3<f64> =
                Vector3::from((pose.rotation * expected).to_array()).cast();
            let found = hydro.planform.axes * Vector3::z();
            assert!(
                found.dot(&expected).abs() > 1.0 - 1e-6,
                "{order:?} {roll}: {found}"
            );
            // Broadside a strip of width 2b drags π b² along per length.
            let across = hydro
                .added_mass
                .rotated(&hydro.planform.axes.inverse())
                .linear[(2, 2)];
            assert!((across / (PI * 1e-6 * 2.0) - 1.0).abs() < 0.2, "{across}");
        }
    }
}

/// What encloses nothing says so by its name.
#[test]
fn what_has_no_volume_is_named() {
    let points = vec![Vector::ZERO, Vector::X, Vector::Y];
    let heights = Array2::zeros(3, 3);
    for (shape, name) in [
        (
            SharedShape::halfspace(Vector::Y),
            "a half-space encloses no volume",
        ),
        (SharedShape::segment(Vector::X, Vector::Y), "a segment"),
        (
            SharedShape::triangle(points[0], points[1], points[2]),
            "a triangle",
        ),
        (SharedShape::polyline(points.clone(), None), "a polyline"),
        (
            SharedShape::heightfield(heights, Vector::splat(1.0)),
            "a height field",
        ),
        (
            SharedShape::trimesh(points, vec![[0, 1, 2]]).unwrap(),
            "the mesh is not closed: 3 edges",
        ),
    ] {
        let error = HydroProperties::from_shape(shape.as_ref())
            .unwrap_err()
            .to_string();
        assert!(error.starts_with(name), "{error}");
    }
}

/// A cone of 2000 kg/m³ with a thick border floats in water by rapier's mass, which is said once with both
/// numbers; with the mass of the whole it sinks, and nothing is said.
#[test]
fn the_mass_of_a_rounded_cone() {
    let shape = SharedShape::round_cone(0.1, 0.05, 0.05);
    let exact = 2000.0 * steiner(of_cone(wide(0.05), wide(0.1)), wide(0.05));
    let fall = |collider: ColliderBuilder| {
        let mut world = weightless();
        world.gravity = Vector::Y * -9.81;
        let (handle, _) = world.insert(RigidBodyBuilder::dynamic(), collider);
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
        let mut immersion = Immersion::new(Fluid::WATER);
        immersion.insert(handle, hydro);
        for _ in 0..30 {
            immersion.step(&mut world);
        }
        // Let out and in again, it is not said again.
        immersion.set_body_enabled(handle, false);
        immersion.step(&mut world);
        immersion.set_body_enabled(handle, true);
        immersion.step(&mut world);
        let warnings: Vec<_> = immersion
            .warnings()
            .iter()
            .filter(|warning| matches!(warning, Warning::CoreMass { .. }))
            .cloned()
            .collect();
        (world.bodies[handle].translation().y, warnings, handle)
    };
    let builder = || ColliderBuilder::new(shape.clone());
    let (height, warnings, handle) = fall(builder().density(2000.0));
    assert!(height > 0.1, "{height}");
    let [
        Warning::CoreMass {
            body,
            rapier_mass,
            whole_mass,
        },
    ] = warnings[..]
    else {
        panic!("{warnings:?}");
    };
    assert_eq!(body, handle);
    let core = 2000.0 * of_cone(wide(0.05), wide(0.1))[0];
    assert!((rapier_mass / core - 1.0).abs() < 1e-6);
    assert!((whole_mass / exact - 1.0).abs() < 1e-6);
    let text = warnings[0].to_string();
    assert!(text.contains(&format!("{core:.4} kg")) && text.contains(&format!("{exact:.4} kg")));

    let whole = DryMass::of_shape(shape.as_ref(), 2000.0).unwrap();
    let (height, warnings, _) = fall(builder().mass_properties(whole.to_mass_properties()));
    assert!(
        height < -0.1 && warnings.is_empty(),
        "{height} {warnings:?}"
    );
    let (height, warnings, _) = fall(builder().mass(whole.mass as Real));
    assert!(
        height < -0.1 && warnings.is_empty(),
        "{height} {warnings:?}"
    );
}
