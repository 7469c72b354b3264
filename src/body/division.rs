//! Which colliders of a body are one surface to the fluid, and which are parts of their own.

use super::bent::unfolded;
use super::piece::Piece;
use crate::error::Error;
use crate::hydro::{AddedMass, HydroProperties};
use crate::math::to_real;
use rapier3d::math::Pose;
use rapier3d::na::Vector3;
use rapier3d::parry::shape::Shape;
use rapier3d::parry::transformation::try_convex_hull;

/// How the colliders of a body, and the shapes of its compound colliders, are divided into [`Part`](crate::Part)s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Division {
    /// Colliders that touch are one part if they are plates in one plane, if they fill their common hull, or if none of them is a
    /// plate (as the pieces of a convex decomposition); every other is a part by itself. Plates that meet edge to edge at an angle of
    /// up to 60° stay parts, but are strips of one bent plate, with its aspect ratio: the halves of a wing with dihedral.
    #[default]
    Automatic,
    /// All are one.
    Whole,
    /// Each collider is a part, and of compound ones each of their shapes.
    EachCollider,
}

/// Share of their common hull that colliders fill which make one solid together.
const FILLED: f64 = 0.9;

/// Whether pieces fill their common convex hull.
fn are_convex<'a>(pieces: impl Iterator<Item = &'a Piece<'a>>) -> bool {
    let (mut points, mut volume) = (Vec::new(), 0.0);
    for piece in pieces {
        points.extend(piece.surface.vertices().iter().map(|v| to_real(*v)));
        volume += piece.volume;
    }
    let Ok((points, triangles)) = try_convex_hull(&points) else {
        return false;
    };
    let point = |i: u32| crate::math::to_f64(points[i as usize]);
    let from = point(0);
    let sixth = |[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [*a, *b, *c].map(|i| point(i) - from);
        a.dot(&b.cross(&c)) / 6.0
    };
    let hull: f64 = triangles.iter().map(sixth).sum();
    volume >= FILLED * hull
}

/// The parts of shapes at their poses in a body's frame, referred to `center`: none if all are one.
pub(super) fn parts_of(
    shapes: &[(Pose, &dyn Shape)],
    center: Vector3<f64>,
    division: Division,
) -> Result<Vec<HydroProperties>, Error> {
    if division == Division::Whole {
        return Ok(Vec::new());
    }
    let mut pieces = Vec::new();
    for (pose, shape) in shapes {
        match shape.as_compound() {
            Some(compound) => {
                for (inner, shape) in compound.shapes() {
                    pieces.push((*pose * *inner, shape.as_ref()));
                }
            }
            None => pieces.push((*pose, *shape)),
        }
    }
    if pieces.len() < 2 {
        return Ok(Vec::new());
    }
    let pieces: Result<Vec<_>, Error> = pieces
        .into_iter()
        .map(|shape| Piece::new(vec![shape], center))
        .collect();
    let mut pieces = pieces?;
    if division == Division::Automatic {
        if are_convex(pieces.iter()) {
            return Ok(Vec::new());
        }
        pieces = joined(pieces, center)?;
    }
    if pieces.len() < 2 {
        return Ok(Vec::new());
    }
    if division == Division::Automatic {
        return Ok(unfolded(&pieces, &touching(&pieces), center));
    }
    Ok(pieces.into_iter().map(|piece| piece.hydro).collect())
}

/// Which of the pieces touch.
fn touching(pieces: &[Piece]) -> Vec<(usize, usize)> {
    let count = pieces.len();
    (0..count)
        .flat_map(|i| (i + 1..count).map(move |j| (i, j)))
        .filter(|(i, j)| pieces[*i].touches(&pieces[*j]))
        .collect()
}

/// Pieces of which those that are one have become one.
fn joined(pieces: Vec<Piece>, center: Vector3<f64>) -> Result<Vec<Piece>, Error> {
    // Who touches whom, and which of them are one; the first of a group stands for it.
    let count = pieces.len();
    let mut group: Vec<usize> = (0..count).collect();
    let pairs = touching(&pieces);
    let join = |group: &mut Vec<usize>, i: usize, j: usize| {
        let (low, high) = (group[i].min(group[j]), group[i].max(group[j]));
        for of in group.iter_mut().filter(|of| **of == high) {
            *of = low;
        }
    };
    for (i, j) in &pairs {
        let (a, b) = (&pieces[*i], &pieces[*j]);
        if a.is_in_plane_with(b) || !(a.is_plate() || b.is_plate()) {
            join(&mut group, *i, *j);
        }
    }
    // Plates on top of each other, and whatever else fills its hull, become one step by step.
    loop {
        let fill = |(i, j): &&(usize, usize)| {
            let (a, b) = (group[*i], group[*j]);
            a != b
                && are_convex(
                    (0..count)
                        .filter(|k| [a, b].contains(&group[*k]))
                        .map(|k| &pieces[k]),
                )
        };
        let Some((i, j)) = pairs.iter().find(fill).copied() else {
            break;
        };
        join(&mut group, i, j);
    }
    let mut ones: Vec<usize> = group.clone();
    ones.sort_unstable();
    ones.dedup();
    ones.into_iter()
        .map(|one| {
            let members = (0..count).filter(|k| group[*k] == one);
            let shapes = members.flat_map(|k| pieces[k].shapes.iter().copied());
            Piece::new(shapes.collect(), center)
        })
        .collect()
}

/// The added mass of parts together, which do not feel each other, about the point that all refer to.
pub(super) fn added_mass_of(parts: &[HydroProperties]) -> AddedMass {
    let sum = |sum: AddedMass, part: &HydroProperties| sum + part.added_mass;
    parts.iter().fold(AddedMass::zero(), sum)
}
