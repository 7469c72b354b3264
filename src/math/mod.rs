//! Scalars, lanes, and the border between the f64 of what is computed once and the `Real` of rapier's world.

pub(crate) mod fields;
mod functions;
mod lanes;
mod scalar;
pub(crate) mod spatial;

pub(crate) use fields::scalar_struct;
pub(crate) use functions::*;
pub(crate) use lanes::{Lanes, MOST_LANES, OnLanes, Row, dispatch, row, vector};
#[cfg(test)]
pub(crate) use lanes::{NARROW, dispatch_narrow};
pub(crate) use scalar::Scalar;

use rapier3d::math::{Pose, Rotation, Vector};
use rapier3d::na::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};

/// A rapier vector in f64.
pub(crate) fn to_f64(v: Vector) -> Vector3<f64> {
    Vector3::new(v.x.into(), v.y.into(), v.z.into())
}

/// The nearest rapier vector.
pub(crate) fn to_real(v: Vector3<f64>) -> Vector {
    Vector::new(v.x as f32, v.y as f32, v.z as f32)
}

/// A rapier rotation in f64.
pub(crate) fn to_quaternion(r: Rotation) -> UnitQuaternion<f64> {
    UnitQuaternion::from_quaternion(Quaternion::new(
        r.w.into(),
        r.x.into(),
        r.y.into(),
        r.z.into(),
    ))
}

/// The nearest rapier rotation.
pub(crate) fn to_rotation(q: UnitQuaternion<f64>) -> Rotation {
    Rotation::from_xyzw(q.i as f32, q.j as f32, q.k as f32, q.w as f32).normalize()
}

/// A rapier pose in f64.
pub(crate) fn isometry(pose: &Pose) -> Isometry3<f64> {
    Isometry3::from_parts(
        Translation3::from(to_f64(pose.translation)),
        to_quaternion(pose.rotation),
    )
}
