//! Pushes that act on a body and on the fluid that it drags along.

use crate::math::{to_f64, to_quaternion, to_real};
use rapier3d::dynamics::{LockedAxes, RigidBody};
use rapier3d::math::Vector;
use rapier3d::na::{Matrix6, Vector6};

/// The changes of a body's linear and angular velocity, world axes, when an impulse in N·s acts at `lever`
/// from its center of mass: `Δν = 𝕄⁻¹ (J, r × J)`, 𝕄 being the 6×6 mass of body and fluid in the body's axes. Along locked axes
/// nothing changes, whatever it takes.
pub(super) fn velocity_change(
    mass: &Matrix6<f64>,
    body: &RigidBody,
    impulse: Vector,
    lever: Vector,
) -> Option<(Vector, Vector)> {
    let rotation = to_quaternion(*body.rotation()).to_rotation_matrix();
    let mut turn = Matrix6::zeros();
    turn.fixed_view_mut::<3, 3>(0, 0)
        .copy_from(rotation.matrix());
    turn.fixed_view_mut::<3, 3>(3, 3)
        .copy_from(rotation.matrix());
    let mut mass = turn * mass * turn.transpose();
    let (linear, angular) = (to_f64(impulse), to_f64(lever).cross(&to_f64(impulse)));
    let mut push = Vector6::new(
        linear.x, linear.y, linear.z, angular.x, angular.y, angular.z,
    );
    let locks = body.locked_axes().bits();
    for axis in (0..6).filter(|axis| locks >> axis & 1 == 1) {
        mass.row_mut(axis).fill(0.0);
        mass.column_mut(axis).fill(0.0);
        mass[(axis, axis)] = 1.0;
        push[axis] = 0.0;
    }
    let change = mass.try_inverse()? * push;
    let part = |from| to_real(change.fixed_rows::<3>(from).into_owned());
    let (linear, angular): (Vector, Vector) = (part(0), part(3));
    (linear + angular).is_finite().then_some((linear, angular))
}

// The bits of rapier's locks are those of the rows: three of translation, three of rotation.
const _: () = assert!(LockedAxes::TRANSLATION_LOCKED_X.bits() == 1);
const _: () = assert!(LockedAxes::ROTATION_LOCKED_X.bits() == 8);
