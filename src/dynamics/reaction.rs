//! What the fluid does to a body in one substep: the equation that is solved for its new velocity.

use super::constants::InertiaConstants;
use super::load::Load;
use crate::hydro::viscous::terms::{Evaluate, safe_inverse};
use crate::math::Scalar;
use crate::math::spatial::{Twist, dot, rotate_back};
use rapier3d::na::{Quaternion, Vector3};

/// The state that a substep's forces are frozen at.
pub(crate) struct Frozen<T> {
    /// Velocity at the beginning, and its estimate for the middle; plate axes.
    pub start: Twist<T>,
    pub middle: Twist<T>,
    /// Plate axes to world, in the middle.
    pub attitude: Quaternion<T>,
}

/// Fluid around a body: one law for the whole of it, or one for each of its parts.
pub(crate) trait Reaction<T: Scalar> {
    /// Evaluations per substep that are needed at least.
    fn least_iterations(&self) -> u32;

    /// The increment Δν of one substep `h`: `(𝕄 − θhN) Δν = h (N ν₀ + Q)`. `SYMMETRIC` as for
    /// [`InertiaConstants::increment`].
    fn increment<const SYMMETRIC: bool>(
        &self,
        inertia: &InertiaConstants<T>,
        load: &Load<T>,
        frozen: &Frozen<T>,
        h: T,
    ) -> Twist<T>;
}

/// How implicit a substep is that lets a motion decay by `z` times itself: just so much that it does not
/// overshoot zero.
#[inline(always)]
pub(super) fn implicitness<T: Scalar>(z: T) -> T {
    z.constant(0.5).max(z.constant(1.0) - safe_inverse(z))
}

/// One law for the whole of a body.
pub(crate) struct Whole<'a, L>(pub &'a L);

impl<T: Scalar, L: Evaluate<T>> Reaction<T> for Whole<'_, L> {
    #[inline(always)]
    fn least_iterations(&self) -> u32 {
        self.0.least_iterations()
    }

    #[inline(always)]
    fn increment<const SYMMETRIC: bool>(
        &self,
        inertia: &InertiaConstants<T>,
        load: &Load<T>,
        frozen: &Frozen<T>,
        h: T,
    ) -> Twist<T> {
        let Frozen {
            start,
            middle,
            attitude,
        } = frozen;
        let zero = h.constant(0.0);
        let mut fluid_spin = if load.spinning {
            rotate_back(attitude, &load.fluid_spin)
        } else {
            Vector3::repeat(zero)
        };
        if load.straining {
            fluid_spin += load.strain_spin(attitude);
        }
        let terms = self.0.terms(
            &inertia.center_velocity(middle),
            &(middle.angular - fluid_spin),
        );
        let mut applied = load.applied(attitude);
        if load.spinning {
            applied.torque += terms.damping.component_mul(&fluid_spin);
        }

        // z: decay per substep of the motion as it is, and of the rotation about the axis where it
        // is fastest.
        let u = &middle.linear;
        let inertial =
            u.x * u.x * inertia.m11.m11 + u.y * u.y * inertia.m11.m22 + u.z * u.z * inertia.m11.m33;
        let (s, k) = (&terms.creeping, &terms.damping);
        let along_x = (s.x * inertia.per_m11.x).max(k.x * inertia.per_m22.x);
        let along_y = (s.y * inertia.per_m11.y).max(k.y * inertia.per_m22.y);
        let along_z = (s.z * inertia.per_m11.z).max(k.z * inertia.per_m22.z);
        let slow = along_x.max(along_y).max(along_z);
        let pressure = terms.drag * dot(u, u) * safe_inverse(inertial);
        let theta = implicitness(h * (pressure + slow));
        let free = inertia.increment::<SYMMETRIC>(&terms, start, middle, &applied, h, theta);
        if !load.locks.any {
            return free;
        }
        let mass = inertia.mass_matrix();
        let n = inertia.coupling_matrix(&mass, &terms, middle);
        let system = mass.less_scaled(&n, theta * h);
        let right = (n.apply(start) + applied).scaled(h);
        load.locks
            .increment(&free, &system, &right, start, attitude, h, theta)
    }
}
