//! Conforming refinement of triangle meshes.

use rapier3d::na::Vector3;
use std::collections::{HashMap, HashSet};

type Edge = (u32, u32);

fn key(a: u32, b: u32) -> Edge {
    (a.min(b), a.max(b))
}

/// Quarters the marked triangles: halves them across their longest edge, twice, and with them as many
/// others as it takes for no vertex to lie inside of an edge (Rivara 1984, Int. J. Numer. Meth.
/// Engng 20). The surface does not change, and no angle becomes smaller than half the smallest at the
/// start.
pub(crate) fn quarter(
    vertices: &mut Vec<Vector3<f64>>,
    triangles: &[[u32; 3]],
    marked: &[bool],
) -> Vec<[u32; 3]> {
    let (halves, parents) = halve(vertices, triangles, marked);
    let marked: Vec<_> = parents.iter().map(|p| marked[*p]).collect();
    halve(vertices, &halves, &marked).0
}

/// The refined triangles, and of each the one that it is a part of.
fn halve(
    vertices: &mut Vec<Vector3<f64>>,
    triangles: &[[u32; 3]],
    marked: &[bool],
) -> (Vec<[u32; 3]>, Vec<usize>) {
    // The edge itself decides between equal lengths, so that both neighbors agree.
    let longest: Vec<usize> = triangles
        .iter()
        .map(|t| {
            let rank = |i: &usize| {
                let (a, b) = (t[*i], t[(i + 1) % 3]);
                let length = (vertices[a as usize] - vertices[b as usize]).norm_squared();
                (length, key(a, b))
            };
            (0..3)
                .max_by(|i, j| {
                    let (a, b) = (rank(i), rank(j));
                    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
                })
                .unwrap_or(0)
        })
        .collect();
    let edge = |t: &[u32; 3], i: usize| key(t[i], t[(i + 1) % 3]);
    let mut split: HashSet<Edge> = HashSet::new();
    for ((t, i), _) in triangles
        .iter()
        .zip(&longest)
        .zip(marked)
        .filter(|(_, marked)| **marked)
    {
        split.insert(edge(t, *i));
    }
    loop {
        let before = split.len();
        for (t, i) in triangles.iter().zip(&longest) {
            if (0..3).any(|j| split.contains(&edge(t, j))) {
                split.insert(edge(t, *i));
            }
        }
        if split.len() == before {
            break;
        }
    }
    let mut middles: HashMap<Edge, u32> = HashMap::with_capacity(split.len());
    let mut refined = Vec::with_capacity(triangles.len() + 2 * split.len());
    let mut parents = Vec::with_capacity(triangles.len() + 2 * split.len());
    for (parent, (t, i)) in triangles.iter().zip(&longest).enumerate() {
        let mut middle = |a: u32, b: u32| {
            split.contains(&key(a, b)).then(|| {
                *middles.entry(key(a, b)).or_insert_with(|| {
                    vertices.push((vertices[a as usize] + vertices[b as usize]) * 0.5);
                    vertices.len() as u32 - 1
                })
            })
        };
        let [from, to, apex] = [0, 1, 2].map(|k| t[(i + k) % 3]);
        let Some(m) = middle(from, to) else {
            refined.push(*t);
            parents.push(parent);
            continue;
        };
        for (a, b) in [(to, apex), (apex, from)] {
            match middle(a, b) {
                Some(k) => refined.extend([[a, k, m], [k, b, m]]),
                None => refined.push([a, b, m]),
            }
        }
        parents.resize(refined.len(), parent);
    }
    (refined, parents)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Surface;
    use rand::{RngExt, SeedableRng};

    /// Whichever triangles are marked, a closed surface stays closed with the same volume and centroid.
    #[test]
    fn refinement_keeps_the_surface() {
        let shape = rapier3d::parry::shape::SharedShape::cuboid(0.5, 1.0, 0.1);
        let surface = Surface::from_shape(shape.as_ref()).unwrap();
        let exact = surface.volume_integrals();
        let (mut vertices, mut triangles) =
            (surface.vertices().to_vec(), surface.triangles().to_vec());
        let mut random = rand_pcg::Pcg32::seed_from_u64(1);
        for _ in 0..4 {
            let marked: Vec<bool> = triangles.iter().map(|_| random.random_bool(0.3)).collect();
            let count = triangles.len();
            triangles = quarter(&mut vertices, &triangles, &marked);
            assert!(triangles.len() > count);
            let refined = Surface::new(&vertices, &triangles).unwrap();
            assert_eq!(refined.triangles().len(), triangles.len());
            let found = refined.volume_integrals();
            assert!((found.volume / exact.volume - 1.0).abs() < 1e-12);
            assert!((found.centroid - exact.centroid).norm() < 1e-12);
        }
    }

    #[test]
    fn nothing_marked_changes_nothing() {
        let mut vertices = vec![Vector3::zeros(), Vector3::x(), Vector3::y()];
        let triangles = [[0, 1, 2]];
        assert_eq!(quarter(&mut vertices, &triangles, &[false]), triangles);
        assert_eq!(quarter(&mut vertices, &triangles, &[true]).len(), 4);
        assert_eq!(vertices.len(), 6);
    }
}
