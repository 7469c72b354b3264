//! A force that is known as a force alone, as the matrix of a substep.

use super::place::{PartPlace, moved, velocity_at};
use crate::math::Scalar;
use crate::math::spatial::{Blocks, Twist, Wrench, dot, matrix};
use rapier3d::na::Vector3;

/// Square of the speed, m²/s², below which what of a force is across the motion fades.
const LEAST_SPEED2: f64 = 1e-12;
/// The same below which a resistance does; its square is still a number of single precision.
const TINY: f64 = 1e-18;
/// Rate, 1/s, at which what is across a motion turns it at most: a force on a body at rest (a cambered wing's, say) fades
/// below a speed of force over mass over this. Faster turning would be lost in rounding.
const FASTEST: f64 = 1e4;

/// The matrix of a law that knows force and torque of one motion at a time: `of_motion` gives them of u and w, of the
/// part's place and in its axes. Both are in the integrator's units, and what is no number is no force.
#[inline(always)]
pub(super) fn of_each<T: Scalar>(
    place: &PartPlace<T>,
    v: &Twist<T>,
    factor: T,
    of_motion: impl Fn(&Vector3<f64>, &Vector3<f64>) -> [Vector3<f64>; 2],
) -> Blocks<T> {
    let u = place.back(&velocity_at(v, &place.position));
    let w = place.back(&v.angular);
    let [fx, fy, fz, tx, ty, tz] = T::by_lane([u.x, u.y, u.z, w.x, w.y, w.z], |v| {
        let (u, w) = (
            Vector3::new(v[0], v[1], v[2]),
            Vector3::new(v[3], v[4], v[5]),
        );
        let [force, torque] = of_motion(&u, &w);
        let all = [force.x, force.y, force.z, torque.x, torque.y, torque.z];
        if all.iter().all(|x| x.is_finite()) {
            all
        } else {
            [0.0; 6]
        }
    });
    let own = Twist {
        linear: place.out(&u),
        angular: place.out(&w),
    };
    let force = Wrench {
        force: place.out(&Vector3::new(fx, fy, fz)) * factor,
        torque: place.out(&Vector3::new(tx, ty, tz)) * factor,
    };
    moved(&of_force(&force, &own), &place.position)
}

/// A force and torque on a part at a velocity ν, as a matrix that gives them at that velocity and takes no more
/// energy than they do: what is along u or w and against it is a resistance there; what is across is the skew
/// `(F νᵀ − ν Fᵀ)/|ν|²`. Where only force and torque together take energy, `(F·ν) ν νᵀ/|ν|⁴` is their resistance, and what gives
/// energy (F·ν > 0) is left out.
#[inline(always)]
fn of_force<T: Scalar>(force: &Wrench<T>, v: &Twist<T>) -> Blocks<T> {
    let (u, w) = (&v.linear, &v.angular);
    let (zero, one) = (u.x.constant(0.0), u.x.constant(1.0));
    let least = zero.constant(LEAST_SPEED2);
    let (u2, w2) = (dot(u, u), dot(w, w));
    let (by_u, by_w) = (dot(&force.force, u), dot(&force.torque, w));
    // Both take energy by themselves, or nothing is along either.
    let both = by_u.max(by_w);
    let apart = |power: T| zero.select_lt(zero, both, power);
    let tiny = zero.constant(TINY);
    let resist = |power: T, size2: T| apart(power) / size2.max(tiny) / size2.max(tiny);
    let (along_u, along_w) = (resist(by_u, u2), resist(by_w, w2));
    let across = Wrench {
        force: force.force - u * (along_u * u2),
        torque: force.torque - w * (along_w * w2),
    };
    let size2 = u2 + w2;
    let strength = (dot(&across.force, &across.force) + dot(&across.torque, &across.torque)).sqrt();
    let slow = strength * size2.sqrt() * zero.constant(1.0 / FASTEST);
    let per = one / size2.max(slow).max(least);
    let together = (by_u + by_w).min(zero).select_lt(zero, both, zero) * per * per;
    let block = |f: &Vector3<T>, a: &Vector3<T>, g: &Vector3<T>, b: &Vector3<T>, along: T| {
        let e = |i: usize, j: usize| (f[i] * b[j] - a[i] * g[j]) * per + a[i] * b[j] * along;
        matrix(e)
    };
    let (f, t) = (&across.force, &across.torque);
    Blocks {
        m11: block(f, u, f, u, along_u + together),
        m12: block(f, u, t, w, together),
        m21: block(t, w, f, u, together),
        m22: block(t, w, t, w, along_w + together),
    }
}
