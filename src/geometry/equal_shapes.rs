//! Whether two shapes of parry are the same.

use rapier3d::geometry::SharedShape;
use rapier3d::math::Pose;
use rapier3d::parry::shape::{Shape, TypedShape, Voxels};

/// Whether two shapes are equal, as far as that can be told: one that encloses no volume, or is not parry's, is equal to
/// itself alone.
pub(crate) fn equal_shapes(a: &dyn Shape, b: &dyn Shape) -> bool {
    if std::ptr::addr_eq(a, b) {
        return true;
    }
    match (a.as_typed_shape(), b.as_typed_shape()) {
        (TypedShape::Ball(a), TypedShape::Ball(b)) => a.radius == b.radius,
        (TypedShape::Cuboid(a), TypedShape::Cuboid(b)) => a.half_extents == b.half_extents,
        (TypedShape::Cylinder(a), TypedShape::Cylinder(b)) => {
            (a.half_height, a.radius) == (b.half_height, b.radius)
        }
        (TypedShape::Cone(a), TypedShape::Cone(b)) => {
            (a.half_height, a.radius) == (b.half_height, b.radius)
        }
        (TypedShape::Capsule(a), TypedShape::Capsule(b)) => {
            (a.segment.a, a.segment.b, a.radius) == (b.segment.a, b.segment.b, b.radius)
        }
        (TypedShape::ConvexPolyhedron(a), TypedShape::ConvexPolyhedron(b)) => a == b,
        (TypedShape::TriMesh(a), TypedShape::TriMesh(b)) => {
            (a.vertices(), a.indices()) == (b.vertices(), b.indices())
        }
        (TypedShape::Compound(a), TypedShape::Compound(b)) => {
            let (a, b) = (a.shapes(), b.shapes());
            let equal = |((at, a), (there, b)): (&(Pose, SharedShape), &(Pose, SharedShape))| {
                at == there && equal_shapes(&**a, &**b)
            };
            a.len() == b.len() && a.iter().zip(b).all(equal)
        }
        (TypedShape::RoundCuboid(a), TypedShape::RoundCuboid(b)) => {
            a.border_radius == b.border_radius && equal_shapes(&a.inner_shape, &b.inner_shape)
        }
        (TypedShape::RoundCylinder(a), TypedShape::RoundCylinder(b)) => {
            a.border_radius == b.border_radius && equal_shapes(&a.inner_shape, &b.inner_shape)
        }
        (TypedShape::RoundCone(a), TypedShape::RoundCone(b)) => {
            a.border_radius == b.border_radius && equal_shapes(&a.inner_shape, &b.inner_shape)
        }
        (TypedShape::RoundConvexPolyhedron(a), TypedShape::RoundConvexPolyhedron(b)) => {
            a.border_radius == b.border_radius && a.inner_shape == b.inner_shape
        }
        (TypedShape::RoundTriangle(a), TypedShape::RoundTriangle(b)) => {
            a.border_radius == b.border_radius && a.inner_shape == b.inner_shape
        }
        (TypedShape::Voxels(a), TypedShape::Voxels(b)) => {
            let cells = |voxels: &Voxels| {
                let filled = voxels.voxels().filter(|voxel| !voxel.state.is_empty());
                filled.map(|voxel| voxel.grid_coords).collect::<Vec<_>>()
            };
            a.voxel_size() == b.voxel_size() && cells(a) == cells(b)
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rapier3d::math::Vector;

    /// A shape is equal to another one like it at another address, and to none that differs in a single number.
    #[test]
    fn what_is_alike_is_equal() {
        let points = |x: f32| {
            let corners = [Vector::ZERO, Vector::X * x, Vector::Y, Vector::Z];
            (
                corners.to_vec(),
                vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
            )
        };
        let mesh = |x: f32| {
            let (corners, faces) = points(x);
            SharedShape::trimesh(corners, faces).unwrap()
        };
        let hull = |x: f32| SharedShape::convex_hull(&points(x).0).unwrap();
        let round_hull = |x: f32, r: f32| SharedShape::round_convex_hull(&points(x).0, r).unwrap();
        let pair = |x: f32, at: f32| {
            let at = Pose::from_translation(Vector::X * at);
            SharedShape::compound(vec![(Pose::IDENTITY, SharedShape::ball(x)), (at, hull(x))])
        };
        let make = |x: f32, y: f32| {
            [
                SharedShape::ball(x * y),
                SharedShape::cuboid(x, y, 1.0),
                SharedShape::cylinder(x, y),
                SharedShape::cone(x, y),
                SharedShape::capsule_y(x, y),
                hull(x * y),
                mesh(x * y),
                pair(x, y),
                SharedShape::round_cuboid(x, 1.0, 1.0, y),
                SharedShape::round_cylinder(x, 1.0, y),
                SharedShape::round_cone(x, 1.0, y),
                round_hull(x, y),
                SharedShape::round_triangle(Vector::ZERO, Vector::X * x, Vector::Y, y),
                SharedShape::voxels_from_points(
                    Vector::splat(x),
                    &[Vector::ZERO, Vector::X * 2.0 * y],
                ),
            ]
        };
        let (first, same) = (make(0.5, 0.25), make(0.5, 0.25));
        for (i, a) in first.iter().enumerate() {
            for (j, b) in same.iter().enumerate() {
                assert_eq!(equal_shapes(&**a, &**b), i == j, "{i} {j}");
            }
        }
        for other in [make(0.6, 0.25), make(0.5, 0.2)] {
            for (a, b) in first.iter().zip(&other) {
                assert!(!equal_shapes(&**a, &**b), "{a:?}", a = a.shape_type());
            }
        }
    }
}
