//! The law of a body in an ideal fluid: no viscous force.

use super::terms::{Evaluate, ViscousTerms};
use crate::math::{Lanes, Scalar};
use fearless_simd::Simd;
use rapier3d::na::Vector3;
use std::marker::PhantomData;

/// Nothing to prepare; `T` is the scalar that the terms are asked for in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct InviscidConstants<T>(PhantomData<T>);

impl<T> InviscidConstants<T> {
    pub fn new() -> Self {
        Self(PhantomData)
    }
}

impl InviscidConstants<f64> {
    pub fn rounded(&self) -> InviscidConstants<f32> {
        InviscidConstants::new()
    }
}

impl InviscidConstants<f32> {
    pub fn is_finite(&self) -> bool {
        true
    }
}

impl<S: Simd> InviscidConstants<Lanes<S>> {
    #[inline(always)]
    pub fn splat(_simd: S, _constants: &InviscidConstants<f32>) -> Self {
        Self::new()
    }

    #[inline(always)]
    pub fn gather<'a>(_simd: S, _of: impl Fn(usize) -> &'a InviscidConstants<f32>) -> Self {
        Self::new()
    }
}

impl<T: Scalar> Evaluate<T> for InviscidConstants<T> {
    /// Momentum and energy are conserved together only where the equations are solved to the end.
    #[inline(always)]
    fn least_iterations(&self) -> u32 {
        8
    }

    #[inline(always)]
    fn terms(&self, u: &Vector3<T>, _w: &Vector3<T>) -> ViscousTerms<T> {
        ViscousTerms::none(u.x)
    }
}
