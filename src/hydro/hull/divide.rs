//! Hulls with shorter edges, and slices of hulls.

use super::Hull;
use rapier3d::na::Vector3;

impl Hull {
    /// The same hull with no edge longer than `longest`, m: for surfaces that bend over that length. Ellipsoids stay.
    ///
    /// Each halving of the length quadruples the triangles. A length that is not positive changes nothing.
    pub fn divided(&self, longest: f64) -> Self {
        match self {
            Self::Ellipsoid { .. } => self.clone(),
            Self::Several(hulls) => {
                Self::Several(hulls.iter().map(|hull| hull.divided(longest)).collect())
            }
            Self::Polyhedron {
                vertices,
                triangles,
            } => {
                let mut corners: Vec<_> = triangles
                    .iter()
                    .map(|t| t.map(|i| vertices[i as usize]))
                    .collect();
                if longest > 0.0 {
                    corners = halved(corners, longest);
                }
                polyhedron(&corners)
            }
        }
    }

    /// What lies between two planes across a unit vector of the frame, as a closed polyhedron; `None` if nothing does, or
    /// if the hull is no polyhedron.
    pub(crate) fn slice(&self, across: &Vector3<f64>, from: f64, to: f64) -> Option<Self> {
        let Self::Polyhedron {
            vertices,
            triangles,
        } = self
        else {
            return None;
        };
        let mut kept: Vec<_> = triangles
            .iter()
            .map(|t| t.map(|i| vertices[i as usize]))
            .collect();
        for (normal, limit) in [(*across, from), (-across, -to)] {
            kept = beyond(&kept, &normal, limit);
        }
        (!kept.is_empty()).then(|| polyhedron(&kept))
    }
}

/// Halves of triangles across their edges longer than `longest` until there are none. Whether an edge is halved depends
/// on its own length alone, so that both of its triangles do it.
fn halved(mut rest: Vec<[Vector3<f64>; 3]>, longest: f64) -> Vec<[Vector3<f64>; 3]> {
    let mut done = Vec::with_capacity(rest.len());
    while let Some([a, b, c]) = rest.pop() {
        let long = |p: Vector3<f64>, q: Vector3<f64>| (p - q).norm_squared() > longest * longest;
        let middle = |p: Vector3<f64>, q: Vector3<f64>| (p + q) * 0.5;
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        match [long(a, b), long(b, c), long(c, a)] {
            [false, false, false] => done.push([a, b, c]),
            [true, false, false] => rest.extend([[a, ab, c], [ab, b, c]]),
            [false, true, false] => rest.extend([[b, bc, a], [bc, c, a]]),
            [false, false, true] => rest.extend([[c, ca, b], [ca, a, b]]),
            [true, true, false] => rest.extend([[ab, b, bc], [a, ab, bc], [a, bc, c]]),
            [false, true, true] => rest.extend([[bc, c, ca], [b, bc, ca], [b, ca, a]]),
            [true, false, true] => rest.extend([[ca, a, ab], [c, ca, ab], [c, ab, b]]),
            [true, true, true] => {
                rest.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
            }
        }
    }
    done
}

/// What of a closed surface lies where `r·normal ≥ limit`, closed by a fan of triangles in the plane.
fn beyond(
    corners: &[[Vector3<f64>; 3]],
    normal: &Vector3<f64>,
    limit: f64,
) -> Vec<[Vector3<f64>; 3]> {
    let height = |p: &Vector3<f64>| p.dot(normal) - limit;
    // Both triangles of an edge find the same point: from the side that is kept.
    let cut = |kept: &Vector3<f64>, lost: &Vector3<f64>| {
        let (high, low) = (height(kept), height(lost));
        kept + (lost - kept) * (high / (high - low))
    };
    let (mut result, mut outline) = (Vec::with_capacity(corners.len()), Vec::new());
    for [a, b, c] in corners {
        match [a, b, c].map(|p| height(p) > 0.0) {
            [false, false, false] => {}
            [true, true, true] => result.push([*a, *b, *c]),
            kept => {
                // Turned so that the corner that is alone comes first.
                let alone = kept.iter().filter(|kept| **kept).count() == 1;
                let first = kept.iter().position(|kept| *kept == alone).unwrap_or(0);
                let turned = [[a, b, c], [b, c, a], [c, a, b]][first];
                let [a, b, c] = turned;
                let (p, q) = if alone {
                    let (p, q) = (cut(a, b), cut(a, c));
                    result.push([*a, p, q]);
                    (p, q)
                } else {
                    let (p, q) = (cut(c, a), cut(b, a));
                    result.extend([[*b, *c, p], [*b, p, q]]);
                    (p, q)
                };
                outline.push((p, q));
            }
        }
    }
    // The fan may fold over itself where the outline does not bulge: what it counts twice it takes off again.
    if let Some((apex, _)) = outline.first().copied() {
        let cap = outline.iter().map(|(p, q)| [*q, *p, apex]);
        result.extend(cap);
    }
    // Triangles with a side of no length enclose nothing, and their other sides cancel.
    result.retain(|[a, b, c]| a != b && b != c && c != a);
    result
}

/// The polyhedron of triangles given by their corners, of which those at exactly the same place are one.
fn polyhedron(corners: &[[Vector3<f64>; 3]]) -> Hull {
    let mut places = std::collections::HashMap::new();
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for triangle in corners {
        triangles.push(triangle.map(|v| {
            // Adding 0.0 turns −0.0 into 0.0.
            let place = <[u64; 3]>::from(v.map(|x| (x + 0.0).to_bits()));
            *places.entry(place).or_insert_with(|| {
                vertices.push(v);
                vertices.len() as u32 - 1
            })
        }));
    }
    Hull::Polyhedron {
        vertices,
        triangles,
    }
}
