//! Plates that fall through water: Andersen, Pesavento & Wang, *J. Fluid Mech.* 541 (2005).

use super::{Shake, uniform_box};
use crate::body::{DryMass, ImmersedBody};
use crate::error::Error;
use crate::fluid::Fluid;
use crate::hydro::HydroProperties;
use crate::hydro::viscous::ViscousLaw;
use crate::math;
use crate::motion::{Classifier, Regime, Trajectory};
use crate::training::{Experiment, Release};
use rapier3d::math::Vector;
use rapier3d::parry::shape::Cuboid;
use std::f64::consts::FRAC_PI_2;

/// Aluminium plates in water: thickness 0.81 mm, span 19 cm, 2.7 times as dense as the water, of
/// kinematic viscosity 0.89 mm²/s.
const THICKNESS: f64 = 0.81e-3;
const SPAN: f64 = 0.19;
const DENSITY: f64 = 2700.0;
const VISCOSITY: f32 = 0.89e-6;

/// Share of a fall, from its release on, that does not count.
const TRANSIENT: f64 = 1.0 / 3.0;

/// One plate, and what was measured of it.
#[derive(Clone, Debug)]
pub struct Plate {
    /// Thickness over chord.
    pub beta: f64,
    /// How it falls.
    pub regime: Regime,
    /// Whether the regime was observed; if not, it is what is expected between plates that were.
    pub observed: bool,
    /// Mean horizontal speed, m/s, where it was published.
    pub drift: Option<f64>,
    /// Mean descent, m/s, where it was published.
    pub descent: Option<f64>,
    /// Mean angular speed, rad/s, where it was published.
    pub spin: Option<f64>,
    hydro: HydroProperties,
    mass: DryMass,
}

/// Means over one fall after its transient.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct PlateFall {
    /// Share of flips among flips and reversals: 1 is tumbling, 0 flutter.
    pub tumbling: f64,
    /// Horizontal speed from end to end, m/s.
    pub drift: f64,
    /// Descent, m/s.
    pub descent: f64,
    /// Angle turned, counted in one sense, over time, rad/s.
    pub spin: f64,
}

impl Plate {
    /// The plates of the paper: β = 1/8 tumbles, 1/10 is apparently chaotic, 1/14 flutters; and two on either
    /// side of 1/10, whose regime is not from the paper: a law is expected to make them chaotic too.
    ///
    /// # Errors
    /// Those of [`Plate::new`], which the stored numbers do not give.
    pub fn targets() -> Result<Vec<Self>, Error> {
        use Regime::{PeriodicFlutter, PeriodicTumbling, TransitionalChaotic};
        Ok(vec![
            Self {
                drift: Some(0.159),
                descent: Some(0.115),
                spin: Some(14.5),
                ..Self::new(1.0 / 8.0, PeriodicTumbling)?
            },
            Self {
                observed: false,
                ..Self::new(1.0 / 9.5, TransitionalChaotic)?
            },
            Self::new(1.0 / 10.0, TransitionalChaotic)?,
            Self {
                observed: false,
                ..Self::new(1.0 / 11.0, TransitionalChaotic)?
            },
            Self {
                // The speed is not printed, but follows from Re = 1147 on the chord.
                descent: Some(0.090),
                ..Self::new(1.0 / 14.0, PeriodicFlutter)?
            },
        ])
    }

    /// A plate of which only the regime is known.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if `beta` is not positive and finite.
    pub fn new(beta: f64, regime: Regime) -> Result<Self, Error> {
        Error::check_positive("beta", beta)?;
        let chord = THICKNESS / beta;
        let half = Vector::new(SPAN as f32, chord as f32, THICKNESS as f32) * 0.5;
        Ok(Self {
            beta,
            regime,
            observed: true,
            drift: None,
            descent: None,
            spin: None,
            hydro: HydroProperties::from_shape(&Cuboid::new(half))?,
            mass: uniform_box([SPAN, chord, THICKNESS], DENSITY),
        })
    }

    /// A fall from rest, the span horizontal, the chord tilted by `tilt` (rad): 7 s at 240 steps/s.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] or [`Error::OutOfRange`] if a coefficient of the law cannot be.
    pub fn experiment(&self, law: &ViscousLaw, tilt: f64, seed: u64) -> Result<Experiment, Error> {
        let fluid = Fluid::new(1000.0, VISCOSITY)?;
        let body = ImmersedBody::new(self.hydro.clone()).with_law(*law)?;
        let mut shake = Shake::new(seed);
        let mut experiment = Experiment::new(body, self.mass, fluid);
        // The motion stays in the plane, as between the experiment's walls.
        experiment.release = Release {
            tilt: tilt + shake.normal(1f64.to_radians()),
            tilt_axis: FRAC_PI_2,
            ..Release::default()
        };
        experiment.release.spin.z = shake.normal(0.1);
        experiment.dt = 1.0 / 240.0;
        experiment.seconds = 7.0;
        Ok(experiment)
    }

    /// What a fall did.
    pub fn measure(&self, fall: &Trajectory) -> PlateFall {
        let skipped = (fall.moments.len() as f64 * TRANSIENT) as usize;
        let moments = &fall.moments[skipped..];
        let time = fall.interval * moments.len().saturating_sub(1).max(1) as f64;
        let (Some(first), Some(last)) = (moments.first(), moments.last()) else {
            return PlateFall {
                tumbling: 0.0,
                drift: 0.0,
                descent: 0.0,
                spin: 0.0,
            };
        };
        let moved = last.position - first.position;
        let turned: f64 = moments
            .windows(2)
            .map(|pair| {
                let (a, b) = (pair[0].normal, pair[1].normal);
                math::atan2(a.cross(&b).dot(&pair[0].long_axis), a.dot(&b))
            })
            .sum();
        PlateFall {
            tumbling: Classifier::default().observe(moments).tumbling(),
            drift: math::hypot(moved.x, moved.z) / time,
            descent: -moved.y / time,
            spin: turned.abs() / time,
        }
    }
}
