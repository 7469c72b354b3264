//! What a free surface cuts off a hull: against closed forms, and against independent computations.

use rapier3d_immersed::geometry::{Ellipsoid, Surface};
use rapier3d_immersed::rapier3d::na::{Matrix3, Rotation3, Vector3};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Hull, Submerged};
use std::f64::consts::PI;

type Plane = (f64, [f64; 2]);

/// Attitudes and planes from nearly all under to nearly nothing of a body of this size.
fn cases(size: f64) -> impl Iterator<Item = (Matrix3<f64>, Plane)> {
    (0..60).map(move |i| {
        let i = f64::from(i);
        let turn = Rotation3::from_euler_angles(1.7 * i, 2.9 * i + 0.1, 0.7 * i + 0.2);
        let depth = size * (0.8 * (2.3 * i + 0.4).sin());
        let slope = [0.4 * (3.1 * i).sin(), 0.3 * (1.3 * i).cos()];
        (*turn.matrix(), (depth, slope))
    })
}

fn cuboid(half: [f32; 3]) -> Hull {
    Hull::from_shape(&Cuboid::new(Vector::from_array(half))).unwrap()
}

/// The hull elsewhere in its frame.
fn off_center(hull: &Hull) -> Hull {
    let turn = Rotation3::from_euler_angles(0.3, -0.4, 0.9);
    hull.posed(&turn, &Vector3::new(0.31, -0.17, 0.23))
}

fn near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{what}: {found} {expected}"
    );
}

/// Each of the six tetrahedra of a box that share its diagonal, by their corners.
fn tetrahedra(half: [f64; 3]) -> Vec<[Vector3<f64>; 4]> {
    let orders = [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 1, 0],
    ];
    let start = -Vector3::from(half);
    orders
        .map(|order| {
            let mut corners = [start; 4];
            for (n, k) in order.into_iter().enumerate() {
                corners[n + 1] = corners[n];
                corners[n + 1][k] += 2.0 * half[k];
            }
            corners
        })
        .to_vec()
}

/// Boxes, plates a thousandth thick and needles, in any attitude, against the B-spline of each tetrahedron: of one with
/// the volume V and the depths dᵢ of its corners, V Σ dᵢ³/Π(dᵢ − dⱼ) over the corners under is under (Curry & Schoenberg
/// 1966), its derivative by depth is the area of the section, its integral ∫ d dV.
#[test]
fn boxes_against_the_splines_of_their_tetrahedra() {
    for half in [
        [0.4_f32, 0.5, 0.75],
        [0.5, 0.0005, 0.25],
        [1.0, 0.002, 0.002],
    ] {
        let hull = cuboid(half);
        let wide = half.map(f64::from);
        let size = Vector3::from(wide).norm();
        let full = 8.0 * wide.iter().product::<f64>();
        for (turn, (depth, slope)) in cases(size) {
            let normal = Vector3::new(-slope[0], 1.0, -slope[1]);
            let (mut volume, mut area, mut sunk) = (0.0, 0.0, 0.0);
            for corners in tetrahedra(wide) {
                let d = corners.map(|v| depth - normal.dot(&(turn * v)));
                for i in 0..4 {
                    if d[i] <= 0.0 {
                        continue;
                    }
                    let product: f64 = (0..4).filter(|j| *j != i).map(|j| d[i] - d[j]).product();
                    volume += full / 6.0 * d[i].powi(3) / product;
                    area += full / 6.0 * 3.0 * d[i].powi(2) / product;
                    sunk += full / 6.0 * d[i].powi(4) / (4.0 * product);
                }
            }
            let found = hull.under_plane(&turn, depth, slope);
            // The splines lose digits where depths are nearly equal, as across a thin plate.
            let thin = wide[1].min(wide[2]);
            let digits = 1e-12 + 1e-14 * (size / thin).powi(2);
            near(found.volume, volume, digits * full, "volume");
            near(found.waterplane.area, area, digits * full / thin, "area");
            let own = depth * found.volume - normal.dot(&found.moment);
            near(own, sunk, digits * full * size, "depth");
        }
    }
}

/// The two other coordinates of the centroid and the waterplane against sums over 160³ cells of a box.
#[test]
fn centroid_and_waterplane_against_cells() {
    let half = [0.4, 0.5, 0.75];
    let hull = cuboid(half.map(|x| x as f32));
    const CELLS: usize = 160;
    for (turn, (depth, slope)) in cases(0.6).take(6) {
        let normal = Vector3::new(-slope[0], 1.0, -slope[1]);
        let cell = 8.0 * half.iter().product::<f64>() / (CELLS as f64).powi(3);
        let mut moment = Vector3::zeros();
        let at = |i: usize, k: usize| half[k] * ((2 * i + 1) as f64 / CELLS as f64 - 1.0);
        for i in 0..CELLS.pow(3) {
            let v = Vector3::new(
                at(i % CELLS, 0),
                at(i / CELLS % CELLS, 1),
                at(i / CELLS / CELLS, 2),
            );
            let r = turn * v;
            if depth > normal.dot(&r) {
                moment += r * cell;
            }
        }
        let found = hull.under_plane(&turn, depth, slope);
        assert!((found.moment - moment).norm() < 5e-4, "{found:?} {moment}");
    }
}

/// Whatever the body: volume grows with depth by the waterplane's area, and with the surface's slope by its first
/// moments; the moment of the volume by the first moments with depth, and by the second with slope. This is what shifts
/// the center of buoyancy by I/V per radian of heel.
#[test]
fn waterplane_is_the_derivative() {
    let tip = [
        Vector3::zeros(),
        Vector3::x(),
        Vector3::y() * 0.7,
        Vector3::z() * 1.3,
    ];
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let pebble = Hull::Ellipsoid {
        center: Vector3::new(0.1, 0.2, -0.3),
        axes: Rotation3::from_euler_angles(0.5, 0.6, 0.7),
        shape: Ellipsoid {
            semi_axes: Vector3::new(0.6, 0.4, 0.3),
        },
    };
    let pair = SharedShape::compound(vec![
        (
            Pose::from_translation(Vector::X * 0.4),
            SharedShape::ball(0.3),
        ),
        (Pose::IDENTITY, SharedShape::cuboid(0.2, 0.4, 0.3)),
    ]);
    for hull in [
        off_center(&cuboid([0.4, 0.5, 0.75])),
        Hull::from_surface(&Surface::new(&tip, &faces).unwrap()),
        Hull::from_shape(&Cylinder::new(0.5, 0.4)).unwrap(),
        Hull::from_shape(pair.as_ref()).unwrap(),
        pebble,
    ] {
        for (turn, (depth, slope)) in cases(0.5) {
            let under = |d: f64, s: [f64; 2]| {
                hull.under_plane(&turn, depth + d, [slope[0] + s[0], slope[1] + s[1]])
            };
            let h = 1e-5;
            let by = |d: f64, s: [f64; 2]| {
                let (more, less) = (
                    under(d * h, s.map(|s| s * h)),
                    under(-d * h, s.map(|s| -s * h)),
                );
                let over = 0.5 / h;
                (
                    (more.volume - less.volume) * over,
                    (more.moment - less.moment) * over,
                )
            };
            let plane = under(0.0, [0.0; 2]).waterplane;
            // Where a corner lies in the plane the second derivative jumps: an error of h times the body.
            let tolerance = 3e-5;
            let (volume, moment) = by(1.0, [0.0; 2]);
            near(volume, plane.area, tolerance, "area");
            near(moment.x, plane.first[0], tolerance, "x");
            near(moment.z, plane.first[1], tolerance, "z");
            let (volume, moment) = by(0.0, [1.0, 0.0]);
            near(volume, plane.first[0], tolerance, "x");
            near(moment.x, plane.second[0], tolerance, "xx");
            near(moment.z, plane.second[1], tolerance, "xz");
            let (volume, moment) = by(0.0, [0.0, 1.0]);
            near(volume, plane.first[1], tolerance, "z");
            near(moment.x, plane.second[1], tolerance, "zx");
            near(moment.z, plane.second[2], tolerance, "zz");
        }
    }
}

/// What is under a plane and what is above it, which is under it for the body upside down, are the whole.
#[test]
fn under_and_above_are_the_whole() {
    for shape in [
        SharedShape::cuboid(0.5, 0.0005, 0.25),
        SharedShape::cone(0.5, 0.4),
        SharedShape::ball(0.6),
        SharedShape::capsule_x(0.4, 0.3),
    ] {
        let hull = off_center(&Hull::from_shape(shape.as_ref()).unwrap());
        let (whole, centroid) = (hull.volume(), hull.centroid());
        // Half a turn about x.
        let over = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
        for (turn, (depth, [a, b])) in cases(0.6) {
            let under = hull.under_plane(&turn, depth, [a, b]);
            let above = hull.under_plane(&(over * turn), -depth, [-a, b]);
            near(under.volume + above.volume, whole, 1e-13, "volume");
            let moment = under.moment + over * above.moment;
            assert!((moment - turn * centroid * whole).norm() < 1e-13);
            near(under.waterplane.area, above.waterplane.area, 1e-12, "area");
            near(
                under.waterplane.second[1],
                -above.waterplane.second[1],
                1e-12,
                "xz",
            );
        }
        let deep = hull.under_plane(&Matrix3::identity(), 9.0, [0.0; 2]);
        near(deep.volume, whole, 1e-12, "deep");
        assert_eq!(deep.waterplane.area.abs(), 0.0);
        let high = hull.under_plane(&Matrix3::identity(), -9.0, [0.0; 2]);
        assert_eq!(high, Submerged::default());
    }
}

/// A spherical cap of height h: π h² (r − h/3), its centroid at ¾ (2r − h)²/(3r − h) from the center, its waterplane
/// π (2 r h − h²). And ellipsoids against polyhedra of 20 thousand facets.
#[test]
fn balls_and_ellipsoids() {
    let r = f64::from(0.3_f32);
    let ball = Hull::from_shape(&Ball::new(0.3)).unwrap();
    for h in [0.01, 0.1, 0.3, 0.5, 0.59] {
        let cap = ball.under_plane(&Matrix3::identity(), h - r, [0.0; 2]);
        let volume = PI * h * h * (r - h / 3.0);
        near(cap.volume, volume, 1e-12, "cap");
        let low = -0.75 * (2.0 * r - h).powi(2) / (3.0 * r - h);
        near(cap.moment.y / cap.volume, low, 1e-12, "centroid");
        let area = PI * (2.0 * r * h - h * h);
        near(cap.waterplane.area, area, 1e-12, "waterplane");
        near(
            cap.waterplane.second[0],
            area * area / (4.0 * PI),
            1e-12,
            "second",
        );
    }
    let shape = Ellipsoid {
        semi_axes: Vector3::new(0.6, 0.4, 0.25),
    };
    let exact = off_center(&Hull::Ellipsoid {
        center: Vector3::zeros(),
        axes: Rotation3::identity(),
        shape,
    });
    let fine = off_center(&Hull::from_surface(
        &Surface::ellipsoid(&shape, 60).unwrap(),
    ));
    for (turn, (depth, slope)) in cases(0.5) {
        let (a, b) = (
            exact.under_plane(&turn, depth, slope),
            fine.under_plane(&turn, depth, slope),
        );
        near(a.volume, b.volume, 1e-3 * exact.volume(), "volume");
        assert!((a.moment - b.moment).norm() < 1e-3 * exact.volume());
        near(a.waterplane.area, b.waterplane.area, 2e-3, "area");
        for i in 0..3 {
            near(
                a.waterplane.second[i],
                b.waterplane.second[i],
                1e-3,
                "second",
            );
        }
        // A surface of which only depths are known is found to be this plane.
        let normal = Vector3::new(-slope[0], 1.0, -slope[1]);
        let c = exact.under(&turn, |r| depth - normal.dot(r));
        near(a.volume, c.volume, 1e-10, "depths");
    }
}

/// A crate of 2 m under a wave of 1 m: its volume, moment and waterplane by the integral of the sine, converging with
/// the square of the edges.
#[test]
fn crates_in_waves() {
    let hull = cuboid([1.0, 0.5, 0.4]);
    let (k, a, phase) = (2.0 * PI, 0.05, 0.7);
    let wave = |x: f64| a * (k * x + phase).cos();
    let integral = |x: f64| a / k * (k * x + phase).sin();
    // From −½ up to the wave, over 2 m by 0.8 m.
    let volume = 0.8 * (1.0 + integral(1.0) - integral(-1.0));
    // ∫ x η dx by parts.
    let by_parts = |x: f64| x * integral(x) + a / (k * k) * (k * x + phase).cos();
    let along = 0.8 * (by_parts(1.0) - by_parts(-1.0));
    let error = |longest: f64| {
        let found = hull
            .divided(longest)
            .under(&Matrix3::identity(), |r| wave(r.x) - r.y);
        near(found.waterplane.area, 1.6, 1e-6, "waterplane");
        near(found.waterplane.second[0], 1.6 / 3.0, 1e-6, "second");
        (found.volume - volume).abs() + (found.moment.x - along).abs()
    };
    // The sides alone bear the waves' slope; a flat bottom has all depths right to the square of its edges.
    let (coarse, fine) = (error(0.1), error(0.05));
    assert!(coarse < 2e-3 && fine < 0.4 * coarse, "{coarse} {fine}");
    // Division changes nothing under a plane.
    for (turn, (depth, slope)) in cases(0.8).take(10) {
        let [whole, parts] = [0.0, 0.3].map(|d| hull.divided(d).under_plane(&turn, depth, slope));
        near(whole.volume, parts.volume, 1e-12, "divided");
        near(
            whole.waterplane.second[1],
            parts.waterplane.second[1],
            1e-12,
            "divided",
        );
    }
}

/// Largest errors of the few facets of round shapes: of the draft in diameters, of the waterplane as a share of its
/// largest, with 5 to 95 % of the height under and beyond. A polygon of 24 sides and of the circle's area has sides 0.3 %
/// too near and corners 0.6 % too far; a side that lies in the surface is in or out as a whole.
#[test]
fn few_facets_are_enough_for_round_shapes() {
    let r = f64::from(0.3_f32);
    let h = 1.0;
    // Depths of the axis or the middle under water, in radii.
    let depths: Vec<f64> = (0..200).map(|i| -0.995 + 0.01 * f64::from(i)).collect();
    let upright = Matrix3::identity();
    let compare =
        |hull: &Hull, turn: &Matrix3<f64>, exact: &dyn Fn(f64) -> (f64, f64), reach: f64| {
            let largest = depths
                .iter()
                .map(|t| exact(t * reach).1)
                .fold(0.0, f64::max);
            let (mut draft, mut plane, mut touching) = (0.0_f64, 0.0_f64, 0.0_f64);
            for t in &depths {
                let (volume, area) = exact(t * reach);
                let found = hull.under_plane(turn, t * reach, [0.0; 2]);
                let off = (found.waterplane.area - area).abs() / largest;
                let worst = if t.abs() < 0.9 {
                    &mut plane
                } else {
                    &mut touching
                };
                *worst = worst.max(off);
                draft = draft.max((found.volume - volume).abs() / largest / (2.0 * r));
            }
            (draft, plane, touching)
        };
    let segment = |t: f64| r * r * ((-t / r).acos() + t / r * (1.0 - t * t / (r * r)).sqrt());
    let cap = |t: f64| PI * (r + t).powi(2) * (2.0 * r - t) / 3.0;
    let disc = |t: f64| PI * (r * r - t * t).max(0.0);
    let chord = |t: f64| 2.0 * (r * r - t * t).max(0.0).sqrt();

    let cylinder = Hull::from_shape(&Cylinder::new(h as f32, r as f32)).unwrap();
    let under = cylinder.under_plane(&upright, 0.2, [0.0; 2]);
    near(under.volume / (PI * r * r * 1.2), 1.0, 1e-6, "upright");
    let second = PI / 4.0 * r.powi(4);
    near(under.waterplane.second[0] / second, 1.0, 1e-4, "upright");
    near(under.waterplane.second[2] / second, 1.0, 1e-4, "upright");
    for roll in 0..7 {
        let roll = Rotation3::from_axis_angle(&Vector3::y_axis(), f64::from(roll) * PI / 72.0);
        let lying = Rotation3::from_axis_angle(&Vector3::z_axis(), PI / 2.0) * roll;
        let lying = lying.matrix();
        let exact = |t: f64| (2.0 * h * segment(t), 2.0 * h * chord(t));
        let (draft, plane, touching) = compare(&cylinder, lying, &exact, r);
        assert!(
            draft < 1e-4 && plane < 0.01 && touching < 0.05,
            "{draft} {plane} {touching}"
        );

        let capsule = Hull::from_shape(&Capsule::new_y(h as f32, r as f32)).unwrap();
        let exact = |t: f64| (2.0 * h * segment(t) + cap(t), 2.0 * h * chord(t) + disc(t));
        let (draft, plane, touching) = compare(&capsule, lying, &exact, r);
        assert!(
            draft < 5e-4 && plane < 0.01 && touching < 0.05,
            "{draft} {plane} {touching}"
        );
        let exact = |t: f64| {
            let (low, high) = ((t + h).min(0.0), (t - h).max(0.0));
            let volume = cap(low) + PI * r * r * (t.clamp(-h, h) + h) + cap(high)
                - 2.0 * PI * r.powi(3) / 3.0;
            (volume, disc(low.min(-0.0)).min(disc(high)))
        };
        let (draft, plane, touching) = compare(&capsule, &upright, &exact, r + h);
        assert!(
            draft < 0.01 && plane < 0.02 && touching < 0.02,
            "{draft} {plane} {touching}"
        );
    }
}

/// The metacentric height I/V − BG of a log of square section, half as heavy as water, in sides: −1/12 with a side up,
/// 1/(3√2) with an edge up, so that it floats at 45°.
#[test]
fn square_logs_float_on_their_edges() {
    let log = cuboid([0.5, 0.5, 3.0]);
    let height = |angle: f64| {
        let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), angle);
        let under = log.under_plane(turn.matrix(), 0.0, [0.0; 2]);
        let plane = under.waterplane;
        let about = plane.second[0] - plane.first[0] * plane.first[0] / plane.area;
        about / under.volume + under.moment.y / under.volume
    };
    // BM = 1/12/(1/2) = 1/6, the center of buoyancy ¼ below.
    near(height(0.0), 1.0 / 6.0 - 0.25, 1e-12, "side up");
    // BM = (√2)³/12/(½) = √2/3; the half is a triangle of height √½ with its centroid a third of it below.
    let edge = 2.0_f64.sqrt() / 3.0 - 0.5_f64.sqrt() / 3.0;
    near(height(PI / 4.0), edge, 1e-12, "edge up");
}

/// The hull of a body is in its frame, encloses its volume about its centroid, and those of its parts add up to it.
#[test]
fn hulls_of_bodies() {
    use rapier3d_immersed::{Division, HydroProperties};
    let mut world = PhysicsWorld::new();
    let turned = Pose::new(Vector::new(0.3, 0.1, 0.0), Vector::new(0.4, 0.5, 0.6));
    let (body, _) = world.insert(
        RigidBodyBuilder::dynamic(),
        ColliderBuilder::ball(0.2).position(turned).density(300.0),
    );
    let colliders = [
        ColliderBuilder::cuboid(0.4, 0.01, 0.2).translation(Vector::Y * 0.05),
        ColliderBuilder::round_cylinder(0.3, 0.1, 0.02).rotation(Vector::Z),
        ColliderBuilder::capsule_x(0.2, 0.1).position(turned),
        ColliderBuilder::new(SharedShape::compound(vec![
            (turned, SharedShape::cone(0.2, 0.1)),
            (
                Pose::IDENTITY,
                SharedShape::round_cuboid(0.1, 0.2, 0.1, 0.03),
            ),
        ])),
    ];
    for collider in colliders {
        let collider = collider.density(300.0).build();
        world
            .colliders
            .insert_with_parent(collider, body, &mut world.bodies);
    }
    let properties = |division| {
        HydroProperties::from_body_divided(&world.bodies, &world.colliders, body, division).unwrap()
    };
    let whole = properties(Division::EachCollider);
    whole.check().unwrap();
    assert_eq!(whole.parts.len(), 6);
    near(whole.hull.volume() / whole.volume, 1.0, 1e-6, "volume");
    assert!((whole.hull.centroid() - whole.centroid).norm() < 1e-5);
    for (turn, (depth, slope)) in cases(0.3) {
        let under = whole.hull.under_plane(&turn, depth, slope);
        let parts: f64 = whole
            .parts
            .iter()
            .map(|part| part.hull.under_plane(&turn, depth, slope).volume)
            .sum();
        near(under.volume, parts, 1e-12, "parts");
    }
    assert!(matches!(whole.parts[0].hull, Hull::Ellipsoid { .. }));
    assert_eq!(properties(Division::Whole).hull, whole.hull);
}

/// Hulls that are written and read are the same.
#[cfg(feature = "serde-serialize")]
#[test]
fn hulls_are_written_and_read() {
    let ball = SharedShape::ball(0.25);
    let pair = SharedShape::compound(vec![
        (Pose::from_translation(Vector::X), ball),
        (Pose::IDENTITY, SharedShape::cuboid(0.25, 0.5, 0.75)),
    ]);
    let hull = Hull::from_shape(pair.as_ref()).unwrap();
    let text = serde_json::to_string(&hull).unwrap();
    assert_eq!(serde_json::from_str::<Hull>(&text).unwrap(), hull);
}
