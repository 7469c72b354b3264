//! A law whose three forces are weighted from outside, step by step.

use super::{Evaluate, ViscousTerms};
use crate::math::Scalar;
use rapier3d::na::Vector3;

/// A prepared law with factors on its drag, rotational lift and translational lift. Passive if the law
/// is and the first factor is not negative: lifts do no work whatever their size.
pub(crate) struct Scaled<'a, T, L> {
    pub law: &'a L,
    pub factors: [T; 3],
}

impl<T: Scalar, L: Evaluate<T>> Evaluate<T> for Scaled<'_, T, L> {
    #[inline(always)]
    fn least_iterations(&self) -> u32 {
        self.law.least_iterations()
    }

    #[inline(always)]
    fn terms(&self, u: &Vector3<T>, w: &Vector3<T>) -> ViscousTerms<T> {
        let [drag, rotational, translational] = self.factors;
        let terms = self.law.terms(u, w);
        ViscousTerms {
            drag: terms.drag * drag,
            creeping: terms.creeping * drag,
            rotational_lift: terms.rotational_lift * rotational,
            translational_lift: terms.translational_lift * translational,
            ..terms
        }
    }
}
