//! A law as a reduced model: the force of another law, separated over all motions.

use super::frozen_force::of_each;
use super::place::PartPlace;
use crate::error::Error;
use crate::fluid::Fluid;
use crate::hydro::HydroProperties;
use crate::math::Scalar;
use crate::math::spatial::{Blocks, Twist};
use crate::reduced::{Motions, SeparatedForces};
use rapier3d::na::{Matrix3, Vector3};
use std::sync::Arc;

/// By how much a part's proportions may differ from those that the law was baked for.
const SAME_SHAPE: f64 = 0.01;

/// Another law of one shape as a reduced model (thesis § 7.3): its force and torque
/// as a tensor train over all motions, which then drives bodies in its place.
///
/// It is dimensionless: force over ρV²L² and torque over ρV²L³ by direction of the motion and Reynolds number
/// VL/ν, where L is the larger half extent of the planform and V = √(u² + L²ω²). One law serves all sizes of
/// the shape in all fluids. A separated law takes the same time whatever it stands for: for a law as cheap as the default one that
/// is a loss (see the table of [`reduced`](crate::reduced)), for a [`CustomLaw`](crate::CustomLaw) that solves
/// for the flow it is what makes it fit for a step.
///
/// **It cannot blow up.** What of the approximation would give energy to the motion (positive power) is left out, as for a
/// [`CustomLaw`](crate::CustomLaw), so that it is passive at any step size and whatever its error. Every direction of
/// velocity and spin is within its table. Above its Reynolds numbers coefficients stay as at the largest, below they grow as
/// 1/Re, so that forces fall linearly as in creeping flow. A step allocates nothing, and the law is part of snapshots.
///
/// ```
/// use rapier3d_immersed::rapier3d::prelude::*;
/// use rapier3d_immersed::reduced::CrossParams;
/// use rapier3d_immersed::{HydroProperties, ImmersedBody, Part, SeparatedLaw, ViscousLaw};
///
/// let hydro = HydroProperties::from_shape(&Cuboid::new(Vector::new(0.0365, 0.00015, 0.021)))?;
/// let params = CrossParams { tolerance: 1e-3, max_rank: 8, rank_growth: 4, ..CrossParams::default() };
/// let (law, _) = SeparatedLaw::bake(&hydro, ViscousLaw::default(), [1e2, 2e4], &params)?;
/// assert!(law.error()[0] < 0.3); // relative, root mean square over all motions; rank 32 makes it .08
/// let body = ImmersedBody::new(hydro.clone()).with_parts([Part::new(hydro).with_law(law)]);
/// assert!(body.check().is_ok());
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct SeparatedLaw {
    pub(super) forces: Arc<SeparatedForces>,
    /// Half extents of the planform over the largest.
    pub(super) proportions: Vector3<f64>,
    /// Share of the coupling of the added mass that the law keeps.
    pub(super) munk: f64,
    pub(super) error: [f64; 2],
}

/// Clones are equal without a look at the table.
impl PartialEq for SeparatedLaw {
    fn eq(&self, other: &Self) -> bool {
        (Arc::ptr_eq(&self.forces, &other.forces) || self.forces == other.forces)
            && (self.proportions, self.munk, self.error)
                == (other.proportions, other.munk, other.error)
    }
}

/// Half extents of the planform over the largest.
pub(super) fn proportions(hydro: &HydroProperties) -> Vector3<f64> {
    hydro.planform.half_extents / hydro.planform.half_extents.x
}

impl SeparatedLaw {
    /// The error of force and torque at 20 000 random motions off the nodes: root mean square over that of the force, and
    /// the largest over the same.
    pub fn error(&self) -> [f64; 2] {
        self.error
    }

    /// The separated forces, of Reynolds numbers uL/ν and ωL²/ν, over ρν² and ρν²L.
    pub fn forces(&self) -> &SeparatedForces {
        &self.forces
    }

    pub(super) fn munk_factor(&self) -> f64 {
        self.munk
    }

    /// # Errors
    /// If the table is not one of a law, or its numbers are not finite.
    pub(super) fn check(&self) -> Result<(), Error> {
        self.forces.check()?;
        let mirrored = self.forces.motions() == Motions::Mirrored;
        let axes = self.forces.train().axes().len();
        Error::check(
            "axes of a separated law",
            axes as f64,
            mirrored && axes == 6,
            "the six of mirrored motions",
        )?;
        Error::check_range("share of the Munk moment", self.munk, 0.0, 1.0)?;
        Error::check_all_finite(
            "proportions of a separated law",
            self.proportions.as_slice(),
        )
    }

    /// # Errors
    /// [`Error::InvalidParameter`] if the law is not one of this shape.
    pub(crate) fn check_shape(&self, hydro: &HydroProperties) -> Result<(), Error> {
        let of_part = proportions(hydro);
        for i in 1..3 {
            let same = (of_part[i] - self.proportions[i]).abs() <= SAME_SHAPE * self.proportions[i];
            Error::check(
                "half extent of a part's planform over its largest",
                of_part[i],
                same,
                "that of the shape that its separated law was baked for",
            )?;
        }
        Ok(())
    }

    /// The law's constants, its point and its axes: see [`PartLaw`].
    pub(super) fn prepare(
        &self,
        hydro: &HydroProperties,
        fluid: &Fluid,
        mass: f64,
        length: f64,
    ) -> (PreparedSeparated, Vector3<f64>, Matrix3<f64>) {
        let (density, viscosity) = (
            f64::from(fluid.density()),
            f64::from(fluid.kinematic_viscosity()),
        );
        let own = hydro.planform.half_extents.x;
        let force = density * viscosity * viscosity / mass;
        let prepared = PreparedSeparated {
            law: self.clone(),
            linear: own / viscosity,
            angular: own * own / (viscosity * length),
            force,
            torque: force * own / length,
        };
        (
            prepared,
            hydro.planform.center,
            *hydro.planform.axes.matrix(),
        )
    }
}

/// What a step needs of a [`SeparatedLaw`].
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PreparedSeparated {
    law: SeparatedLaw,
    /// From u and w, m/s, to Reynolds numbers, s/m.
    linear: f64,
    angular: f64,
    /// From dimensionless force and torque to the integrator's units.
    force: f64,
    torque: f64,
}

impl PreparedSeparated {
    /// Whether every factor is a finite number of single precision, in which what they make is kept.
    pub fn is_finite(&self) -> bool {
        [self.linear, self.angular, self.force, self.torque]
            .iter()
            .all(|x| (*x as f32).is_finite())
    }

    #[inline(always)]
    pub fn matrix<T: Scalar>(&self, place: &PartPlace<T>, v: &Twist<T>, factor: T) -> Blocks<T> {
        of_each(place, v, factor, |u, w| {
            let (u, w) = (u * self.linear, w * self.angular);
            let [force, torque] = self.law.forces.evaluate(&u, &w, &[]);
            [force * self.force, torque * self.torque]
        })
    }
}
