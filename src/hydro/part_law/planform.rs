//! A part under one of the laws of planforms.

use super::place::{PartPlace, through, velocity_at};
use crate::hydro::viscous::terms::{Evaluate, ViscousTerms};
use crate::math::Scalar;
use crate::math::spatial::{Blocks, Twist, product, skew};
use rapier3d::na::{Matrix3, Vector3};

/// The matrix that maps the body's velocity relative to the fluid to the part's force, about the center of mass.
#[inline(always)]
pub(super) fn matrix<T: Scalar, L: Evaluate<T>>(
    law: &L,
    place: &PartPlace<T>,
    v: &Twist<T>,
) -> Blocks<T> {
    let u = place.back(&velocity_at(v, &place.position));
    of_terms(&law.terms(&u, &place.back(&v.angular)), place)
}

/// A law's force as a matrix, in the body's axes about its center of mass.
#[inline(always)]
pub(super) fn of_terms<T: Scalar>(terms: &ViscousTerms<T>, place: &PartPlace<T>) -> Blocks<T> {
    let zero = terms.drag.constant(0.0);
    let lift = place.out(&(terms.translational_lift + terms.rotational_lift));
    let mut g = skew(&lift) - place.diagonal_out(&terms.creeping);
    for i in 0..3 {
        g[(i, i)] -= terms.drag;
    }
    let center = place.position + place.out(&terms.offset);
    let lever = -skew(&center);
    let mut n = if terms.arm_moves {
        // Of the pressure point's arm, which lies in the planform, only what moves it along the normal counts: the
        // normal times the arm turned by a right angle.
        let normal = Vector3::new(place.turn.m13, place.turn.m23, place.turn.m33);
        let turned = place.out(&Vector3::new(terms.arm.y, -terms.arm.x, zero));
        through(&g, &(lever + outer(&normal, &turned)))
    } else {
        // The force of the center's velocity acts at the pressure point. Such a law is not passive.
        let arm = skew(&place.out(&terms.arm));
        let mut n = through(&g, &lever);
        n.m22 += product(&arm, &n.m12);
        n.m21 += product(&arm, &g);
        n
    };
    n.m22 -= place.diagonal_out(&terms.damping);
    n
}

/// The same by component: drag, translational lift, rotational lift, damping.
pub(super) fn components<L: Evaluate<f64>>(
    law: &L,
    place: &PartPlace<f64>,
    v: &Twist<f64>,
) -> [Blocks<f64>; 4] {
    let u = place.back(&velocity_at(v, &place.position));
    let all = law.terms(&u, &place.back(&v.angular));
    let bare = ViscousTerms {
        arm: all.arm,
        offset: all.offset,
        arm_moves: all.arm_moves,
        ..ViscousTerms::none(all.drag)
    };
    [
        ViscousTerms {
            drag: all.drag,
            creeping: all.creeping,
            ..bare
        },
        ViscousTerms {
            translational_lift: all.translational_lift,
            ..bare
        },
        ViscousTerms {
            rotational_lift: all.rotational_lift,
            ..bare
        },
        ViscousTerms {
            damping: all.damping,
            ..bare
        },
    ]
    .map(|terms| of_terms(&terms, place))
}

#[inline(always)]
fn outer<T: Scalar>(a: &Vector3<T>, b: &Vector3<T>) -> Matrix3<T> {
    Matrix3::new(
        a.x * b.x,
        a.x * b.y,
        a.x * b.z,
        a.y * b.x,
        a.y * b.y,
        a.y * b.z,
        a.z * b.x,
        a.z * b.y,
        a.z * b.z,
    )
}
