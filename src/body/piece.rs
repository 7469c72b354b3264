//! The pieces that a body's colliders are before it is decided which of them are one.

use crate::error::Error;
use crate::geometry::Surface;
use crate::hydro::{Hull, HydroProperties};
use rapier3d::math::Pose;
use rapier3d::na::Vector3;
use rapier3d::parry::query::distance;
use rapier3d::parry::shape::Shape;

/// Gap, over the size of the smaller of two colliders, up to which they touch.
const GAP: f64 = 0.02;
/// Cosine of the angle up to which plates are parallel: 5°.
const PARALLEL: f64 = 0.996;

/// A piece of a body, or several that have become one.
pub(super) struct Piece<'a> {
    pub(super) shapes: Vec<(Pose, &'a dyn Shape)>,
    pub(super) surface: Surface,
    pub(super) hydro: HydroProperties,
    pub(super) volume: f64,
}

impl<'a> Piece<'a> {
    pub(super) fn new(
        shapes: Vec<(Pose, &'a dyn Shape)>,
        center: Vector3<f64>,
    ) -> Result<Self, Error> {
        let surface = Surface::of_parts(&shapes, Surface::from_shape)?;
        let hydro = HydroProperties::with_hull(&surface, Hull::of_parts(&shapes)?, center);
        Ok(Self {
            volume: hydro.volume,
            shapes,
            surface,
            hydro,
        })
    }

    pub(super) fn is_plate(&self) -> bool {
        self.hydro.bluff.is_none()
    }

    /// Of a plate, on one of its sides.
    pub(super) fn normal(&self) -> Vector3<f64> {
        self.hydro.planform.axes * Vector3::z()
    }

    fn size(&self) -> f64 {
        self.hydro.planform.half_extents.x
    }

    pub(super) fn touches(&self, other: &Self) -> bool {
        let gap = GAP * self.size().min(other.size());
        self.shapes.iter().any(|(pose, shape)| {
            let others = other.shapes.iter();
            // Shapes of which parry knows no distance may touch.
            let near = |(other_pose, other): &(Pose, &dyn Shape)| {
                distance(pose, *shape, other_pose, *other)
                    .is_ok_and(|d| f64::from(d.distance) <= gap)
            };
            others.into_iter().any(near)
        })
    }

    /// Whether both are plates in one plane.
    pub(super) fn is_in_plane_with(&self, other: &Self) -> bool {
        if !(self.is_plate() && other.is_plate()) {
            return false;
        }
        let (a, b) = (&self.hydro.planform, &other.hydro.planform);
        let (n, m) = (self.normal(), other.normal());
        let apart = (b.center - a.center).dot(&n).abs();
        let thick = a.half_extents.z + b.half_extents.z;
        n.dot(&m).abs() > PARALLEL && apart <= thick
    }
}
