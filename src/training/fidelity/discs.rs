//! Discs of every inertia and Reynolds number: Field, Klaus, Moore & Nori, *Nature* 388 (1997).

use super::measured_discs::MEASURED;
use super::{Shake, uniform_disc};
use crate::body::{DryMass, ImmersedBody};
use crate::error::Error;
use crate::fluid::Fluid;
use crate::hydro::HydroProperties;
use crate::hydro::viscous::ViscousLaw;
use crate::math;
use crate::motion::{Classifier, DimensionlessNumbers, Outline, PhaseDiagram, Regime, Trajectory};
use crate::training::{Experiment, Release};
use rapier3d::parry::shape::Cylinder;
use std::f64::consts::PI;

/// Discs of 2 cm in a liquid as dense as water. They are of steel, unless they would then be thicker than
/// this share of their diameter, and correspondingly denser otherwise; the map has I* only.
const DIAMETER: f64 = 0.02;
const STEEL: f64 = 7.85;
const MOST_THICKNESS: f64 = 0.08;
const LIQUID: f32 = 1000.0;
const GRAVITY: f64 = 9.81;

/// Length of a fall in units of the diameter over the broadside speed, and what of it is transient.
const LENGTHS: f64 = 130.0;
const TRANSIENT: f64 = 0.4;

/// One point of the measured map.
#[derive(Clone, Debug)]
pub struct Disc {
    /// Reynolds number by mean descent.
    pub reynolds: f64,
    /// I*.
    pub i_star: f64,
    /// The motion that was observed.
    pub regime: Regime,
    hydro: HydroProperties,
    mass: DryMass,
    /// Estimate of the mean descent, m/s.
    speed: f64,
}

/// What one disc did.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct DiscFall {
    /// Reynolds number by the fall's own mean descent.
    pub reynolds: f64,
    /// I*.
    pub i_star: f64,
    /// The disc's motion; helix and spiral count as periodic flutter, as on the measured map.
    pub regime: Regime,
    /// The measured map's regime at the fall's own Reynolds number.
    pub expected: Regime,
    /// The least factor − 1 by which Re or I* would have to change for the map to agree (0 if it does;
    /// not more than 1).
    pub off_by: f64,
}

/// The map's four classes: flutter, helix and spiral are periodic.
pub(super) fn map_class(regime: Regime) -> Regime {
    match regime {
        Regime::TransitionalHelix | Regime::PeriodicSpiral => Regime::PeriodicFlutter,
        other => other,
    }
}

impl Disc {
    /// Every disc of Field et al. (1997) that the public data of Howison et al. (2020) hold.
    ///
    /// # Errors
    /// Those of [`Disc::new`], which the stored numbers do not give.
    pub fn measured() -> Result<Vec<Self>, Error> {
        let discs = MEASURED.iter();
        discs
            .map(|(re, i, regime)| Self::new(*re, *i, *regime))
            .collect()
    }

    /// A disc of this I* in a liquid of the viscosity that gives about this Reynolds number.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if a number is not positive and finite.
    pub fn new(reynolds: f64, i_star: f64, regime: Regime) -> Result<Self, Error> {
        Error::check_positive("reynolds", reynolds)?;
        Error::check_positive("i_star", i_star)?;
        // This is I* = π (ρ_s/ρ_f) t/(64 d).
        let product = 64.0 * i_star / PI;
        let thickness = (product / STEEL).min(MOST_THICKNESS);
        let ratio = product / thickness;
        let t = thickness * DIAMETER;
        let shape = Cylinder::new(0.5 * t as f32, 0.5 * DIAMETER as f32);
        let density = ratio * f64::from(LIQUID);
        // At high Reynolds numbers ½ρU²·1.17 = (ρ_s − ρ_f) g t; at lower ones U follows from the same
        // balance with the drag at the given Re, and the viscosity from U.
        let drag = (64.0 / (PI * reynolds) * (1.0 + 0.138 * math::powf(reynolds, 0.792))).max(1.17);
        let numbers = DimensionlessNumbers::new(
            Outline::Round,
            DIAMETER,
            t,
            density,
            &Fluid::new(LIQUID, 1e-6)?,
            GRAVITY,
        )?;
        Ok(Self {
            reynolds,
            i_star,
            regime,
            hydro: HydroProperties::from_shape(&shape)?,
            mass: uniform_disc(DIAMETER, t, density),
            speed: numbers.u0 * (2.0 / drag).sqrt(),
        })
    }

    /// A fall from rest, tilted by `tilt` (rad): 130 diameters at the broadside speed, in steps of
    /// 0.08 of them.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] or [`Error::OutOfRange`] if a coefficient of the law cannot be.
    pub fn experiment(&self, law: &ViscousLaw, tilt: f64, seed: u64) -> Result<Experiment, Error> {
        let viscosity = self.speed * DIAMETER / self.reynolds;
        let body = ImmersedBody::new(self.hydro.clone()).with_law(*law)?;
        let fluid = Fluid::new(LIQUID, viscosity as f32)?;
        let mut experiment = Experiment::new(body, self.mass, fluid);
        let unit = DIAMETER / self.speed;
        let mut shake = Shake::new(seed);
        experiment.gravity = GRAVITY;
        experiment.release = shake.release(
            Release {
                tilt,
                ..Release::default()
            },
            1f64.to_radians(),
            0.02 / unit,
        );
        experiment.dt = 0.08 * unit;
        experiment.seconds = LENGTHS * unit;
        Ok(experiment)
    }

    /// What a fall did.
    pub fn measure(&self, experiment: &Experiment, fall: &Trajectory) -> DiscFall {
        let skipped = (fall.moments.len() as f64 * TRANSIENT) as usize;
        let moments = &fall.moments[skipped..];
        let regime = map_class(Classifier::default().observe(moments).regime);
        let time = fall.interval * moments.len().saturating_sub(1).max(1) as f64;
        let descent = match (moments.first(), moments.last()) {
            (Some(first), Some(last)) => (first.position.y - last.position.y) / time,
            _ => 0.0,
        };
        let viscosity = f64::from(experiment.fluid.kinematic_viscosity());
        let reynolds = (descent * DIAMETER / viscosity).max(1e-3);
        DiscFall {
            reynolds,
            i_star: self.i_star,
            regime,
            expected: expected(reynolds, self.i_star),
            off_by: off_by(reynolds, self.i_star, regime),
        }
    }
}

fn expected(reynolds: f64, i_star: f64) -> Regime {
    map_class(PhaseDiagram::default().regime(reynolds, i_star))
}

/// The least factor − 1 of Re or I* that leads to where the map says `regime`.
fn off_by(reynolds: f64, i_star: f64, regime: Regime) -> f64 {
    const STEPS: u32 = 40;
    let around = |step: &u32| {
        let factor = 1.0 + f64::from(*step) / f64::from(STEPS);
        [
            (reynolds * factor, i_star),
            (reynolds / factor, i_star),
            (reynolds, i_star * factor),
            (reynolds, i_star / factor),
        ]
        .iter()
        .any(|(re, i)| expected(*re, *i) == regime)
    };
    let step = (0..STEPS).find(around).unwrap_or(STEPS);
    f64::from(step) / f64::from(STEPS)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The labels are numbers beside the points of the data set, whose meaning was inferred from where the
    /// points lie; the curves are that data set's, too.
    #[test]
    fn the_curves_agree_with_the_points() {
        let right = MEASURED
            .iter()
            .filter(|(re, i, regime)| expected(*re, *i) == *regime);
        let share = right.count() as f64 / MEASURED.len() as f64;
        // Six of 200 lie on the wrong side of a curve.
        assert!(share >= 0.97, "{share}");
    }

    #[test]
    fn discs_have_the_inertia_that_was_asked_for() {
        for (re, i, regime) in MEASURED {
            let disc = Disc::new(re, i, regime).unwrap();
            let fluid = Fluid::new(LIQUID, 1e-6).unwrap();
            let numbers =
                DimensionlessNumbers::of(&disc.hydro, &disc.mass, &fluid, GRAVITY).unwrap();
            // The polygon of the cylinder's mesh has a little less area than the circle.
            assert!((numbers.i_star / i - 1.0).abs() < 0.02, "{numbers:?} {i}");
        }
        assert!(Disc::new(f64::NAN, 0.01, T).is_err());
        assert!(Disc::new(100.0, 0.0, T).is_err());
    }
    const T: Regime = Regime::PeriodicTumbling;

    #[test]
    fn distances_are_factors() {
        // I* = 0.0396 separates chaos from tumbling at Re = 1000.
        let off = |i| off_by(1000.0, i, T);
        assert_eq!(off(0.05), 0.0);
        assert!((off(0.033) - 0.2).abs() < 0.03, "{}", off(0.033));
        assert_eq!(off(0.001), 1.0);
    }
}
