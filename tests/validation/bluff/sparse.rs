//! Bodies of thin parts far from each other, which lines a sixty-fourth of the width apart would miss, and slivers.

use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion};

fn rod(half: Vector, at: Vector, turn: f32) -> (Pose, SharedShape) {
    let turn = Rotation::from_scaled_axis(Vector::Z * turn);
    let shape = SharedShape::cuboid(half.x, half.y, half.z);
    (Pose::from_parts(turn * at, turn), shape)
}

/// Two rods of 1 m in a V, open along x.
fn v(thickness: f32) -> SharedShape {
    let half = Vector::new(0.5, 0.5 * thickness, 0.5 * thickness);
    let arms = [0.785, -0.785].map(|turn| rod(half, Vector::X * 0.5, turn));
    SharedShape::compound(arms.to_vec())
}

/// Two balls 1 m apart.
fn pair(radius: f32) -> SharedShape {
    let ends = [-0.5, 0.5].map(|x| (Pose::translation(x, 0.0, 0.0), SharedShape::ball(radius)));
    SharedShape::compound(ends.to_vec())
}

/// The twelve edges of a cube of 1 m.
fn frame(thickness: f32) -> SharedShape {
    let mut bars = Vec::new();
    for axis in 0..3 {
        let mut half = Vector::splat(0.5 * thickness);
        half[axis] = 0.5;
        for corner in 0..4 {
            let mut at = Vector::ZERO;
            at[(axis + 1) % 3] = if corner & 1 == 0 { -0.5 } else { 0.5 };
            at[(axis + 2) % 3] = if corner & 2 == 0 { -0.5 } else { 0.5 };
            bars.push(rod(half, at, 0.0));
        }
    }
    SharedShape::compound(bars)
}

/// Such bodies are described by finite numbers that may be, drag coefficients from 0.3 to 2.5, with
/// pressure points within their box; and they sink in water like anything else.
#[test]
fn thin_parts_far_from_each_other_are_described() {
    for thickness in [0.1, 0.05, 0.02, 0.01, 5e-3, 2e-3] {
        for (name, shape) in [
            ("V", v(thickness)),
            ("pair", pair(thickness)),
            ("frame", frame(thickness)),
        ] {
            let hydro = HydroProperties::from_shape(shape.as_ref()).unwrap();
            hydro
                .check()
                .unwrap_or_else(|error| panic!("{name} {thickness}: {error}"));
            if let Some(bluff) = &hydro.bluff {
                let reach = hydro.planform.half_extents * 2.0 + Vector3::repeat(1e-9);
                for side in 0..2 {
                    for axis in 0..3 {
                        let drag = bluff.drag[side][axis];
                        let at = format!("{name} {thickness} {side} {axis}");
                        assert!((0.3..2.5).contains(&drag), "{at}: {drag}");
                        let point = bluff.pressure_point[side][axis].abs();
                        assert!((reach - point).min() >= 0.0, "{at}: {point}");
                    }
                }
            }
            let mut world = PhysicsWorld::new();
            let collider = ColliderBuilder::new(shape).density(2000.0);
            let (body, _) = world.insert(RigidBodyBuilder::dynamic(), collider);
            let mut immersion = Immersion::new(Fluid::WATER);
            immersion.insert(body, hydro);
            for _ in 0..240 {
                immersion.step(&mut world);
            }
            // 4 s in water: far below the 39 m/s of a free fall.
            let speed = world.bodies[body].linvel().length();
            assert!((0.1..10.0).contains(&speed), "{name} {thickness}: {speed}");
        }
    }
}

/// Two thin square plates that face each other from afar: their shadows, to rounding, whatever the gap. Edge on they have
/// the pressure of flat faces, 0.32 + 0.58, no wake behind so long a body, and the friction of what is seen from
/// outside, 0.003 (S/A − 4); broadside that pressure, and a wake of 0.96 at most.
#[test]
fn plates_far_apart_are_seen() {
    for (gap, thickness) in [(2.0, 0.01), (20.0, 0.005), (100.0, 0.001)] {
        let ends = [-0.5, 0.5].map(|side: f32| {
            let plate = SharedShape::cuboid(0.5 * thickness, 0.5, 0.5);
            (Pose::translation(side * gap, 0.0, 0.0), plate)
        });
        let pair = HydroProperties::from_shape(SharedShape::compound(ends.to_vec()).as_ref());
        let bluff = pair.unwrap().bluff.unwrap();
        let t = f64::from(thickness);
        for axis in 0..3 {
            // The longest axis is that from plate to plate.
            let exact = if axis == 0 { 1.0 } else { 2.0 * t };
            let shadow = bluff.shadow[axis];
            assert!(
                (shadow / exact - 1.0).abs() < 1e-3,
                "{gap} {axis}: {shadow}"
            );
            let friction = 0.003 * ((2.0 + 8.0 * t) / exact - 4.0).max(0.0);
            for drag in bluff.drag {
                let pressure = drag[axis] - friction;
                if axis == 0 {
                    assert!((0.9..1.86).contains(&pressure), "{gap}: {pressure}");
                } else {
                    let off = (pressure - 0.9).abs() / drag[axis];
                    assert!(off < 2e-3, "{gap} {axis}: {pressure} {friction}");
                }
            }
        }
    }
}

/// The pressure points of a needle's hull stay within its box, whatever its facets look like.
#[test]
fn slivers_have_their_pressure_points_inside() {
    let mut state = 1_u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32 - 0.5
    };
    for aspect in [4.0, 16.0, 64.0] {
        for _ in 0..10 {
            let points: Vec<Vector> = (0..12)
                .map(|_| Vector::new(random() * aspect, random(), random()))
                .collect();
            let Some(hull) = SharedShape::convex_hull(&points) else {
                continue;
            };
            let Ok(hydro) = HydroProperties::from_shape(hull.as_ref()) else {
                continue;
            };
            let Some(bluff) = &hydro.bluff else {
                continue;
            };
            let reach = hydro.planform.half_extents * 2.0 + Vector3::repeat(1e-9);
            for point in bluff.pressure_point.iter().flatten() {
                assert!((reach - point.abs()).min() >= 0.0, "{aspect}: {point}");
            }
        }
    }
}
