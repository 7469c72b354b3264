//! Parts whose place in a body is likely to be a mistake.

use super::ImmersedBody;
use crate::math::to_f64;
use rapier3d::dynamics::{RigidBodyHandle, RigidBodySet};
use rapier3d::geometry::ColliderSet;
use rapier3d::na::{Point3, Vector3};

/// Distance of a part from the colliders, over the diagonal of their box and the part's length together, from which
/// on it is far. A sail has no collider, and a kite's may hang some lengths from what carries it; a pose in mm or in
/// inches is 1000 or 39 times too far.
const FAR: f64 = 10.0;

/// A part far from the colliders of its body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FarPart {
    /// Index of the part.
    pub part: usize,
    /// From the colliders' box, in the body's frame, to the part's center, m.
    pub distance: f64,
    /// Diagonal of that box and the part's length together, m.
    pub size: f64,
}

impl FarPart {
    /// The first part that is far, if there is one. A body without colliders has no place to be far from.
    pub fn of_body(
        handle: RigidBodyHandle,
        bodies: &RigidBodySet,
        colliders: &ColliderSet,
        description: &ImmersedBody,
    ) -> Option<Self> {
        if description.parts.is_empty() {
            return None;
        }
        let attached = bodies.get(handle)?.colliders().iter();
        let boxes = attached
            .filter_map(|handle| colliders.get(*handle))
            .map(|collider| {
                let pose = collider.position_wrt_parent().copied().unwrap_or_default();
                let around = collider.shape().compute_aabb(&pose);
                (to_f64(around.mins), to_f64(around.maxs))
            });
        let (low, high) = boxes.reduce(|(low, high), (l, h)| (low.inf(&l), high.sup(&h)))?;
        description
            .parts
            .iter()
            .enumerate()
            .find_map(|(part, known)| {
                let plate = &known.hydro.planform;
                let center: Vector3<f64> = (known.pose * Point3::from(plate.center)).coords;
                let distance = (center - center.sup(&low).inf(&high)).norm();
                let size = (high - low).norm() + 2.0 * plate.half_extents.norm();
                (distance > FAR * size).then_some(Self {
                    part,
                    distance,
                    size,
                })
            })
    }
}
