//! Bodies some of whose axes a user has locked.
//!
//! Rapier locks an axis of the world by zeros in the inverse of the mass and of the inertia. A torque τ
//! turns the body by `(I⁻¹)_FF τ_F` then, F being the free axes: the torque for a wanted angular
//! acceleration is `((I⁻¹)_FF)⁻¹ α_F`, not `I α`, which a long body would answer with up to I_max/I_min
//! times the acceleration.
//!
//! Velocities at the end of a step obey the lock at the attitude that rapier reaches, not at the
//! integrator's. What is off is taken away as a lock would, by an impulse λ along the locked axes: of
//! all changes that obey the lock, `Δν = −𝕄⁻¹Eᵀ(E𝕄⁻¹Eᵀ)⁻¹(Eν − q)` (E picks the locked axes, along which
//! the velocity is q) leaves the least energy, never more than before where q is zero.

use crate::coupling::body_mass::BodyMass;
use crate::math::Row;
use rapier3d::dynamics::LockedAxes;
use rapier3d::na::{Matrix3, Matrix6, Rotation3, Vector3, Vector6};

/// 1 for each locked axis: of translation …
pub(super) fn linear(locks: LockedAxes) -> Row {
    axes(locks.bits())
}

/// … and of rotation.
pub(super) fn angular(locks: LockedAxes) -> Row {
    axes(locks.bits() >> 3)
}

fn axes(bits: u8) -> Row {
    let axis = |i: u8| f32::from(bits >> i & 1);
    [axis(0), axis(1), axis(2), 0.0]
}

/// The torque for an angular acceleration under the locks, world axes. `inertia` is rapier's tensor, in
/// world axes.
pub(super) fn torque_for(
    inertia: &Matrix3<f64>,
    locks: LockedAxes,
    acceleration: Vector3<f64>,
) -> Vector3<f64> {
    let locked = angular(locks).map(f64::from);
    if locked == [0.0; 4] {
        return inertia * acceleration;
    }
    let Some(mut inverse) = inertia.try_inverse() else {
        return Vector3::zeros();
    };
    // A locked axis is cut off from the others; the number in its place only keeps the matrix regular.
    let place = inverse.trace() / 3.0;
    for i in (0..3).filter(|i| locked[*i] == 1.0) {
        inverse.row_mut(i).fill(0.0);
        inverse.column_mut(i).fill(0.0);
        inverse[(i, i)] = place;
    }
    let free = |v: Vector3<f64>| Vector3::from_fn(|i, _| v[i] * (1.0 - locked[i]));
    let torque = inverse
        .try_inverse()
        .map_or(acceleration * 0.0, |effective| {
            effective * free(acceleration)
        });
    free(torque)
}

/// `velocity` (linear and angular, world axes) after the impulse that makes it `kept` along the locked
/// axes. `body` maps the body's frame to the world.
pub(super) fn obey(
    mass: &BodyMass,
    body: &Rotation3<f64>,
    locks: LockedAxes,
    velocity: Vector6<f64>,
    kept: &Vector6<f64>,
) -> Vector6<f64> {
    let bits = locks.bits();
    let locked = Vector6::from_fn(|i, _| f64::from(bits >> i & 1));
    let missing = (kept - velocity).component_mul(&locked);
    let mut turn = Matrix6::zeros();
    turn.fixed_view_mut::<3, 3>(0, 0).copy_from(body.matrix());
    turn.fixed_view_mut::<3, 3>(3, 3).copy_from(body.matrix());
    let response = turn * mass.inverse * turn.transpose();
    // Entries of mass and inertia differ by orders of magnitude: the equations are scaled by the diagonal.
    let scale = Vector6::from_fn(|i, _| 1.0 / response[(i, i)].sqrt());
    let system = Matrix6::from_fn(|i, j| {
        let unit = f64::from(u8::from(i == j));
        let both = locked[i] * locked[j];
        both * response[(i, j)] * scale[i] * scale[j] + (1.0 - locked[i]) * unit
    });
    let impulse = system.lu().solve(&missing.component_mul(&scale));
    let Some(impulse) = impulse else {
        return velocity + missing;
    };
    let changed = velocity + response * impulse.component_mul(&scale);
    // To the bit along the locks.
    Vector6::from_fn(|i, _| {
        if locked[i] == 1.0 {
            kept[i]
        } else {
            changed[i]
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The torque against rapier's own mask: what comes back is the acceleration on the free axes, for
    /// every lock and a rod whose moments differ by a hundred, at an odd attitude.
    #[test]
    fn torques_cause_the_acceleration_on_free_axes() {
        let turn = Rotation3::from_euler_angles(0.5, 1.0, 0.8);
        let own = Matrix3::from_diagonal(&Vector3::new(0.01, 1.0, 0.9));
        let inertia = turn.matrix() * own * turn.matrix().transpose();
        let wanted = Vector3::new(3.0, -2.0, 5.0);
        for bits in 0..8_u8 {
            let locks = LockedAxes::from_bits_truncate(bits << 3);
            let torque = torque_for(&inertia, locks, wanted);
            let mut masked = inertia.try_inverse().unwrap();
            for i in (0..3).filter(|i| bits >> i & 1 == 1) {
                masked.row_mut(i).fill(0.0);
                masked.column_mut(i).fill(0.0);
            }
            let caused = masked * torque;
            for i in 0..3 {
                let free = f64::from(1 - (bits >> i & 1));
                assert!(
                    (caused[i] - wanted[i] * free).abs() < 1e-12,
                    "{bits} {caused}"
                );
            }
        }
    }
}
