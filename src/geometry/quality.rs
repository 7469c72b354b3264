//! Checks of a mesh, before anything is computed from it.

use crate::error::Error;
use rapier3d::na::Vector3;

/// Height over longest edge below which a triangle is a needle: its normal has lost half its digits.
const NEEDLE: f64 = 1e-8;

/// Checks that every vertex is finite, every index in range, and that there is a triangle.
pub(crate) fn check_indices(
    vertices: &[Vector3<f64>],
    triangles: &[[u32; 3]],
) -> Result<(), Error> {
    if let Some(index) = vertices
        .iter()
        .position(|v| !v.iter().all(|x| x.is_finite()))
    {
        return Err(Error::NonFiniteVertex { index });
    }
    if let Some(index) = triangles
        .iter()
        .flatten()
        .find(|i| **i as usize >= vertices.len())
    {
        return Err(Error::IndexOutOfRange {
            index: *index,
            vertices: vertices.len(),
        });
    }
    if triangles.is_empty() {
        return Err(Error::EmptyMesh);
    }
    Ok(())
}

/// Checks that no triangle has collapsed to a point or a line.
pub(crate) fn check_triangles(
    vertices: &[Vector3<f64>],
    triangles: &[[u32; 3]],
) -> Result<(), Error> {
    for (triangle, t) in triangles.iter().enumerate() {
        let [a, b, c] = t.map(|i| vertices[i as usize]);
        let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
        let height = (b - a).cross(&(c - a)).norm() / longest;
        // For a point this is 0/0, and not a number is no proper height.
        let proper = height > NEEDLE * longest;
        if !proper {
            return Err(Error::DegenerateTriangle {
                triangle,
                at: ((a + b + c) / 3.0).into(),
            });
        }
    }
    Ok(())
}

/// Checks that every part of a closed mesh encloses a positive volume, unless it is a cavity of another.
#[cfg_attr(not(feature = "bake"), allow(dead_code))]
pub(crate) fn check_parts(vertices: &[Vector3<f64>], triangles: &[[u32; 3]]) -> Result<(), Error> {
    struct Part {
        volume: f64,
        low: Vector3<f64>,
        high: Vector3<f64>,
        first: usize,
    }
    let mut parent: Vec<usize> = (0..vertices.len()).collect();
    fn root(parent: &mut [usize], mut i: usize) -> usize {
        while parent[i] != i {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        i
    }
    for [a, b, c] in triangles {
        for other in [*b, *c] {
            let (i, j) = (
                root(&mut parent, *a as usize),
                root(&mut parent, other as usize),
            );
            parent[i.max(j)] = i.min(j);
        }
    }
    let mut parts: std::collections::BTreeMap<usize, Part> = Default::default();
    for (first, t) in triangles.iter().enumerate() {
        let key = root(&mut parent, t[0] as usize);
        // The volume of each part is computed from one of its own vertices.
        let [a, b, c] = t.map(|i| vertices[i as usize]);
        let part = parts.entry(key).or_insert(Part {
            volume: 0.0,
            low: a,
            high: a,
            first,
        });
        let origin = vertices[key];
        part.volume += (a - origin).dot(&(b - origin).cross(&(c - origin))) / 6.0;
        part.low = part.low.inf(&a).inf(&b).inf(&c);
        part.high = part.high.sup(&a).sup(&b).sup(&c);
    }
    for part in parts.values().filter(|p| p.volume < 0.0) {
        let inside = |other: &Part| {
            other.volume > -part.volume
                && (0..3).all(|k| other.low[k] < part.low[k] && part.high[k] < other.high[k])
        };
        if !parts.values().any(inside) {
            return Err(Error::InsideOut {
                triangle: part.first,
                center: ((part.low + part.high) / 2.0).into(),
            });
        }
    }
    Ok(())
}

/// Checks that no two triangles pass through each other or lie on each other, unless they share a vertex.
#[cfg_attr(not(feature = "bake"), allow(dead_code))]
pub(crate) fn check_intersections(
    vertices: &[Vector3<f64>],
    triangles: &[[u32; 3]],
) -> Result<(), Error> {
    let corners: Vec<_> = triangles
        .iter()
        .map(|t| t.map(|i| vertices[i as usize]))
        .collect();
    let bounds: Vec<_> = corners
        .iter()
        .map(|[a, b, c]| (a.inf(b).inf(c), a.sup(b).sup(c)))
        .collect();
    // The triangles are swept along the longest axis.
    let all = bounds
        .iter()
        .skip(1)
        .fold(bounds[0], |all, b| (all.0.inf(&b.0), all.1.sup(&b.1)));
    let axis = (all.1 - all.0).imax();
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    order.sort_by(|i, j| bounds[*i].0[axis].total_cmp(&bounds[*j].0[axis]));
    for (place, first) in order.iter().enumerate() {
        let (low, high) = bounds[*first];
        for second in &order[place + 1..] {
            let (other_low, other_high) = bounds[*second];
            if other_low[axis] > high[axis] {
                break;
            }
            let apart = (0..3).any(|k| other_low[k] > high[k] || low[k] > other_high[k]);
            let shared = triangles[*first]
                .iter()
                .any(|v| triangles[*second].contains(v));
            if apart || shared {
                continue;
            }
            let (p, q) = (&corners[*first], &corners[*second]);
            if let Some(at) = crossing(p, q).or_else(|| crossing(q, p)) {
                return Err(Error::SelfIntersection {
                    first: *first.min(second),
                    second: *first.max(second),
                    at: at.into(),
                });
            }
        }
    }
    Ok(())
}

/// A point where an edge of `p` meets the triangle `q`, or a point of both if they are coplanar.
fn crossing(p: &[Vector3<f64>; 3], q: &[Vector3<f64>; 3]) -> Option<Vector3<f64>> {
    let cross = (q[1] - q[0]).cross(&(q[2] - q[0]));
    let normal = cross.normalize();
    let height = p.map(|v| normal.dot(&(v - q[0])));
    let size = cross.norm().sqrt();
    // Shapes in single precision touch no better than this.
    let flat = 1e-7 * size;
    // A point is inside if it is so by more than this margin: neighbors without a common vertex may touch.
    let inside = |x: &Vector3<f64>| {
        (0..3).all(|i| {
            let edge = q[(i + 1) % 3] - q[i];
            normal.dot(&edge.cross(&(x - q[i]))) > flat * edge.norm()
        })
    };
    if height.iter().all(|h| h.abs() <= flat) {
        let centroid = (p[0] + p[1] + p[2]) / 3.0;
        let middles = [0, 1, 2].map(|i| (p[i] + p[(i + 1) % 3]) * 0.5);
        let mut candidates = p.iter().chain(&middles).chain([&centroid]);
        return candidates.find(|x| inside(x)).copied();
    }
    (0..3).find_map(|i| {
        let (from, to) = (height[i], height[(i + 1) % 3]);
        if from.min(to) >= -flat || from.max(to) <= flat {
            return None;
        }
        let x = p[i] + (p[(i + 1) % 3] - p[i]) * (from / (from - to));
        inside(&x).then_some(x)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Surface;
    use rapier3d::math::{Pose, Vector};
    use rapier3d::parry::shape::SharedShape;

    fn boxes_apart(distance: f32) -> Result<(), Error> {
        let part = SharedShape::cuboid(0.5, 0.5, 0.5);
        let poses = [
            Pose::IDENTITY,
            Pose::from_translation(Vector::new(distance, 0.1, 0.2)),
        ];
        let both = SharedShape::compound(poses.map(|p| (p, part.clone())).to_vec());
        let surface = Surface::panelled(both.as_ref(), 3).unwrap();
        check_intersections(surface.vertices(), surface.triangles())
    }

    #[test]
    fn overlapping_and_touching_parts_are_found() {
        assert_eq!(boxes_apart(1.01), Ok(()));
        for distance in [0.5, 1.0] {
            let found = boxes_apart(distance);
            let Err(Error::SelfIntersection { first, second, at }) = found else {
                panic!("{distance}: {found:?}");
            };
            assert!(first < second);
            // Both boxes contain the point that is named.
            assert!(at[0] >= f64::from(distance) - 0.5 - 1e-6 && at[0] <= 0.5 + 1e-6);
        }
    }

    /// A part turned inside out is an error, a cavity is not.
    #[test]
    fn inside_out_parts_are_found() {
        let part = |half: f32| {
            Surface::from_shape(SharedShape::cuboid(half, half, half).as_ref()).unwrap()
        };
        let with_inverted = |small: Surface| {
            let mut whole = part(1.0);
            let mut vertices = whole.vertices().to_vec();
            let start = vertices.len() as u32;
            vertices.extend_from_slice(small.vertices());
            let mut triangles = whole.triangles().to_vec();
            let turned = |[a, b, c]: &[u32; 3]| [a + start, c + start, b + start];
            triangles.extend(small.triangles().iter().map(turned));
            whole = Surface::new(&vertices, &triangles).unwrap();
            check_parts(whole.vertices(), whole.triangles())
        };
        assert_eq!(with_inverted(part(0.5)), Ok(()));
        let beside = with_inverted(part(0.5).map(|v| v + Vector3::x() * 3.0));
        let Err(Error::InsideOut { center, .. }) = beside else {
            panic!("{beside:?}");
        };
        assert_eq!(center, [3.0, 0.0, 0.0]);
    }

    #[test]
    fn needles_are_named() {
        let v = [
            Vector3::zeros(),
            Vector3::x(),
            Vector3::y(),
            Vector3::new(0.5, 1e-12, 0.0),
        ];
        assert_eq!(check_triangles(&v, &[[0, 1, 2]]), Ok(()));
        let found = check_triangles(&v, &[[0, 1, 2], [0, 1, 3]]);
        assert!(matches!(
            found,
            Err(Error::DegenerateTriangle { triangle: 1, .. })
        ));
    }
}
