//! Making a reduced model of a law: sampling it over all motions.

use super::place::PartPlace;
use super::separated::{SeparatedLaw, proportions};
use super::{Exact, PartLaw};
use crate::error::Error;
use crate::fluid::Fluid;
use crate::hydro::HydroProperties;
use crate::hydro::viscous::ForceFactors;
use crate::math::spatial::Twist;
use crate::reduced::{Axis, CrossParams, CrossReport, Motions, SeparatedForces};
use rapier3d::na::Vector3;
use std::sync::Arc;

/// Random motions that the error is measured at.
const ERROR_POINTS: usize = 20_000;
impl SeparatedLaw {
    /// Separates a law for the shape of `hydro` between two Reynolds numbers VL/ν, on the coordinates that
    /// [`Motions::Mirrored`] proposes.
    ///
    /// # Errors
    /// Those of [`PartLaw::check`], [`HydroProperties::check`] and [`SeparatedForces::bake`]: a law that
    /// reflections of the plate change ([`ThesisLaw`](crate::ThesisLaw), a cambered section) has no such separation.
    pub fn bake(
        hydro: &HydroProperties,
        law: impl Into<PartLaw>,
        reynolds_numbers: [f64; 2],
        params: &CrossParams,
    ) -> Result<(Self, CrossReport), Error> {
        let [slow, fast] = reynolds_numbers;
        let axes = Motions::Mirrored.axes(slow, fast)?;
        Self::bake_on(hydro, law, axes, params)
    }

    /// The same on coordinates of the user's own: see [`SeparatedForces`], with Reynolds numbers for speeds.
    ///
    /// # Errors
    /// Those of [`SeparatedLaw::bake`].
    pub fn bake_on(
        hydro: &HydroProperties,
        law: impl Into<PartLaw>,
        axes: Vec<Axis>,
        params: &CrossParams,
    ) -> Result<(Self, CrossReport), Error> {
        let law = law.into();
        hydro.check()?;
        law.check()?;
        // Any fluid will do, and a mass and length of 1: the law is dimensionless.
        let fluid = Fluid::WATER;
        let (density, viscosity) = (
            f64::from(fluid.density()),
            f64::from(fluid.kinematic_viscosity()),
        );
        let length = hydro.planform.half_extents.x;
        let (prepared, point, axes_of_law) = law.prepare(hydro, &fluid, 1.0, 1.0);
        // About the planform's center, in its axes.
        let plate = hydro.planform.axes.inverse();
        let place = PartPlace {
            position: plate * (point - hydro.planform.center),
            turn: plate.matrix() * axes_of_law,
        };
        let factors = ForceFactors::default();
        let per_force = 1.0 / (density * viscosity * viscosity);
        let model = |u: &Vector3<f64>, w: &Vector3<f64>, _: &[f64]| {
            let twist = Twist {
                linear: u * (viscosity / length),
                angular: w * (viscosity / (length * length)),
            };
            let n = prepared.matrix(Exact, &place, &twist, factors);
            let force = n.apply(&twist);
            [force.force * per_force, force.torque * (per_force / length)]
        };
        let (forces, report) =
            SeparatedForces::bake(Motions::Mirrored, axes, Vec::new(), params, model)?;
        let law = Self {
            proportions: proportions(hydro),
            munk: law.munk_factor(hydro),
            error: forces.error(ERROR_POINTS, params.seed.wrapping_add(1), model),
            forces: Arc::new(forces),
        };
        law.check()?;
        Ok((law, report))
    }
}
