//! Plates that meet at an edge at an angle: one bent plate, as the halves of a wing with dihedral.
//!
//! Each of them is a strip of the plate that they are when they are unfolded, and has its aspect ratio: the halves shed one
//! wake. A wing of a dihedral Γ then has cos²Γ of the lift slope of the flat one, as tests of V-tails
//! bear out (P. E. Purser & J. P. Campbell, NACA Rep. 823 (1945); the relation is recalled); each half by itself would have that of half the aspect ratio.

use super::piece::Piece;
use crate::hydro::HydroProperties;
use rapier3d::na::{Isometry3, Point3, Rotation3, UnitQuaternion, UnitVector3, Vector3};

/// Cosine of the angle between the planes of plates up to which they are one bent plate: 60°, a dihedral of 30° on each side. In
/// sideslip the halves of a V lift against each other and are two wings rather than one; from here on that counts as much.
const BENT: f64 = 0.5;
/// How far plates may reach over the fold that they meet at, over the width of the narrower.
const OVER: f64 = 0.05;
/// Share of the shorter of two edges along which they have to meet.
const SHARED: f64 = 0.5;

/// Where two plates meet: the line, and how to turn the second about it into the plane of the first.
struct Fold {
    line: Vector3<f64>,
    flatten: Isometry3<f64>,
}

/// What the fluid feels of pieces: those that touch (`pairs` do) and are one bent plate as strips of it, the others as they
/// are; all referred to `center`.
pub(super) fn unfolded(
    pieces: &[Piece],
    pairs: &[(usize, usize)],
    center: Vector3<f64>,
) -> Vec<HydroProperties> {
    let mut hydro: Vec<_> = pieces.iter().map(|piece| piece.hydro.clone()).collect();
    let mut flat: Vec<Option<Isometry3<f64>>> = vec![None; pieces.len()];
    for first in 0..pieces.len() {
        if flat[first].is_some() || !pieces[first].is_plate() {
            continue;
        }
        // The plates that are one with this one, each with the turn into its plane.
        flat[first] = Some(Isometry3::identity());
        let mut group = vec![first];
        let mut lines: Vec<Vector3<f64>> = Vec::new();
        let mut next = 0;
        while let Some(i) = group.get(next).copied() {
            next += 1;
            let touching = pairs.iter().filter_map(|(a, b)| match (*a == i, *b == i) {
                (true, _) => Some(*b),
                (_, true) => Some(*a),
                _ => None,
            });
            for j in touching {
                let near = |k: &usize| is_bent_little(&pieces[*k], &pieces[j]);
                if flat[j].is_some() || !pieces[j].is_plate() || !group.iter().all(near) {
                    continue;
                }
                let (Some(fold), Some(before)) = (fold_of(&pieces[i], &pieces[j]), flat[i]) else {
                    continue;
                };
                let line = before * fold.line;
                let along = lines.first().map_or(1.0, |first| first.dot(&line).signum());
                lines.push(line * along);
                flat[j] = Some(before * fold.flatten);
                group.push(j);
            }
        }
        if group.len() < 2 {
            continue;
        }
        let surface = |k: usize| {
            let turn = flat[k].unwrap_or_else(Isometry3::identity);
            pieces[k].surface.map(|v| (turn * Point3::from(v)).coords)
        };
        let mut whole = surface(first);
        group[1..].iter().for_each(|k| whole.append(&surface(*k)));
        let normal = pieces[first].normal();
        let span = lines.iter().sum::<Vector3<f64>>().cross(&normal);
        let whole = HydroProperties::with_span(&whole, span);
        for k in group {
            if let (Some(strip), Some(turn)) = (whole.strip(&surface(k)), flat[k]) {
                hydro[k] = folded(strip, &turn.inverse(), center);
            }
        }
    }
    hydro
}

/// Whether two plates differ in direction by no more than what is one bent plate.
fn is_bent_little(a: &Piece, b: &Piece) -> bool {
    a.normal().dot(&b.normal()).abs() >= BENT
}

/// Where two plates that are not in one plane meet with an edge of each.
fn fold_of(a: &Piece, b: &Piece) -> Option<Fold> {
    let n = a.normal();
    // Of the two normals of the second, that on the same side.
    let m = b.normal() * n.dot(&b.normal()).signum();
    let line = UnitVector3::try_new(n.cross(&m), 1e-9)?;
    let cosine = n.dot(&m);
    // The point of both middle planes that is nearest to the middle between the plates.
    let (from, to) = (a.hydro.planform.center, b.hydro.planform.center);
    let middle = (from + to) * 0.5;
    let (x, y) = (n.dot(&(from - middle)), m.dot(&(to - middle)));
    let sine2 = 1.0 - cosine * cosine;
    let point = middle + n * ((x - y * cosine) / sine2) + m * ((y - x * cosine) / sine2);
    let turn = UnitQuaternion::rotation_between(&m, &n)?;
    let flatten = Isometry3::rotation_wrt_point(turn, point.into());
    // In the plane of the first: along the line, and across it.
    let across = n.cross(&line);
    let range = |piece: &Piece, of: &dyn Fn(Vector3<f64>) -> f64| {
        let along = piece.surface.vertices().iter().map(|v| of(v - point));
        along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(x), high.max(x)]
        })
    };
    let own = range(a, &|v| v.dot(&across));
    let other = range(b, &|v| (turn * v).dot(&across));
    let width = |[low, high]: [f64; 2]| high - low;
    let over = OVER * width(own).min(width(other));
    let thick = a.hydro.planform.half_extents.z + b.hydro.planform.half_extents.z;
    let beside = |low: [f64; 2], high: [f64; 2]| low[1] <= over + thick && high[0] >= -over - thick;
    if !(beside(own, other) || beside(other, own)) {
        return None;
    }
    let [edge, others] = [a, b].map(|piece| range(piece, &|v| v.dot(&line)));
    let shared = edge[1].min(others[1]) - edge[0].max(others[0]);
    let shorter = width(edge).min(width(others));
    (shared >= SHARED * shorter).then(|| Fold {
        line: line.into_inner(),
        flatten,
    })
}

/// A strip put back to where it is in the body, referred to `center`.
fn folded(
    mut strip: HydroProperties,
    place: &Isometry3<f64>,
    center: Vector3<f64>,
) -> HydroProperties {
    let at = |point: Vector3<f64>| (place * Point3::from(point)).coords;
    let turn: Rotation3<f64> = place.rotation.to_rotation_matrix();
    strip.added_mass = strip.added_mass.rotated(&turn);
    strip.centroid = at(strip.centroid);
    strip.reference = at(strip.reference);
    strip.added_mass = strip.added_mass_about(center);
    strip.reference = center;
    let plate = &mut strip.planform;
    plate.center = at(plate.center);
    plate.axes = turn * plate.axes;
    strip
}
