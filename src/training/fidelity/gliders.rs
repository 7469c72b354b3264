//! Weighted plates that glide.

use super::uniform_box;
use crate::body::{DryMass, ImmersedBody};
use crate::error::Error;
use crate::fluid::Fluid;
use crate::hydro::HydroProperties;
use crate::hydro::viscous::ViscousLaw;
use crate::math;
use crate::motion::Trajectory;
use crate::training::{Experiment, Release};
use rapier3d::math::Vector;
use rapier3d::na::Vector3;
use rapier3d::parry::shape::Cuboid;

/// A card of 150 × 50 mm, 0.3 kg/m².
const SPAN: f64 = 0.15;
const CHORD: f64 = 0.05;
const THICKNESS: f64 = 3e-4;
const DENSITY: f64 = 1000.0;
/// Speed of the throw, along the chord, m/s: about that of its glide.
const THROW: f64 = 2.2;
/// Length of a flight, s, and the share of it that is not counted.
const SECONDS: f64 = 5.0;
const TRANSIENT: f64 = 0.4;

/// A card with its center of mass ahead of its middle.
#[derive(Clone, Debug)]
pub struct Glider {
    /// How far the center of mass is ahead of the middle, in chords.
    pub forward: f64,
    hydro: HydroProperties,
    mass: DryMass,
}

/// What one flight did.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct GliderFall {
    /// Way over height lost, after the transient.
    pub ratio: f64,
    /// Whether it never turned over or stood on edge.
    pub upright: bool,
}

impl GliderFall {
    /// The glide ratio, 0 for a card that turned over.
    pub fn glide(&self) -> f64 {
        if self.upright && self.ratio.is_finite() {
            self.ratio.max(0.0)
        } else {
            0.0
        }
    }
}

impl Glider {
    /// Where the center of mass is, in chords ahead of the middle: between those of a card that falls and
    /// of one that dives.
    ///
    /// # Errors
    /// Those of [`Glider::new`], which the stored numbers do not give.
    pub fn cards() -> Result<Vec<Self>, Error> {
        [0.10, 0.15, 0.20].map(Self::new).into_iter().collect()
    }

    /// A card whose center of mass is `forward` chords ahead of its middle.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if that is not on the card.
    pub fn new(forward: f64) -> Result<Self, Error> {
        Error::check_range("forward", forward, -0.5, 0.5)?;
        let half = Vector::new(SPAN as f32, CHORD as f32, THICKNESS as f32) * 0.5;
        Ok(Self {
            forward,
            hydro: HydroProperties::from_shape(&Cuboid::new(half))?,
            mass: DryMass {
                center: Vector3::new(0.0, forward * CHORD, 0.0),
                ..uniform_box([SPAN, CHORD, THICKNESS], DENSITY)
            },
        })
    }

    /// A flight in air: thrown along its chord, which points `pitch` (rad) above the horizon, and tilted by
    /// `roll` to a side.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] or [`Error::OutOfRange`] if a coefficient of the law cannot be.
    pub fn experiment(&self, law: &ViscousLaw, pitch: f64, roll: f64) -> Result<Experiment, Error> {
        let body = ImmersedBody::new(self.hydro.clone()).with_law(*law)?;
        let mut experiment = Experiment::new(body, self.mass, Fluid::new(1.2, 1.5e-5)?);
        let mut release = Release {
            tilt: math::hypot(pitch, roll),
            tilt_axis: math::atan2(pitch, roll),
            ..Release::default()
        };
        release.velocity = release.orientation(&self.hydro) * Vector3::new(0.0, THROW, 0.0);
        experiment.release = release;
        experiment.dt = 1.0 / 240.0;
        experiment.seconds = SECONDS;
        Ok(experiment)
    }

    /// What a flight did.
    pub fn measure(&self, fall: &Trajectory) -> GliderFall {
        let skipped = (fall.moments.len() as f64 * TRANSIENT) as usize;
        let moments = &fall.moments[skipped..];
        let (Some(release), Some(first), Some(last)) =
            (fall.moments.first(), moments.first(), moments.last())
        else {
            return GliderFall {
                ratio: 0.0,
                upright: false,
            };
        };
        let up = release.normal.y.signum();
        let moved = last.position - first.position;
        GliderFall {
            ratio: math::hypot(moved.x, moved.z) / -moved.y,
            upright: fall.moments.iter().all(|m| m.normal.y * up > 0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Moment;
    use rapier3d::na::UnitQuaternion;

    /// Four lengths ahead for one down is a glide of 4, whichever side is up; a card that turns over does not glide.
    #[test]
    fn ratios_and_turning_over() {
        let card = Glider::new(0.2).unwrap();
        let flight = |up: f64, turns: f64| Trajectory {
            interval: 0.1,
            moments: (0..50)
                .map(|step| {
                    let t = f64::from(step) * 0.1;
                    let turn = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), turns * t);
                    Moment {
                        position: Vector3::new(2.4 * t, -t, -3.2 * t),
                        normal: turn * Vector3::y() * up,
                        long_axis: Vector3::x(),
                    }
                })
                .collect(),
        };
        for up in [1.0, -1.0] {
            let glide = card.measure(&flight(up, 0.1));
            assert!((glide.ratio - 4.0).abs() < 1e-9 && glide.upright);
            assert_eq!(card.measure(&flight(up, 0.5)).glide(), 0.0);
        }
        assert!(Glider::new(0.6).is_err());
    }

    /// The card flies the way its center of mass is off the middle, nose up for a positive pitch; it leans
    /// sideways for a roll.
    #[test]
    fn thrown_along_the_chord() {
        let card = Glider::new(0.2).unwrap();
        let law = ViscousLaw::default();
        for (pitch, roll) in [(0.0, 0.0), (0.3f64, 0.0), (-0.3, 0.0), (0.0, 0.1)] {
            let release = card.experiment(&law, pitch, roll).unwrap().release;
            let turn = release.orientation(&card.hydro);
            let ahead = turn * card.mass.center;
            let along = release.velocity.dot(&ahead) / (THROW * ahead.norm());
            assert!((along - 1.0).abs() < 1e-6, "{along}");
            let climbs = release.velocity.y / THROW;
            assert!((climbs - pitch.sin()).abs() < 1e-6, "{climbs}");
            let leans = (turn * Vector3::x()).y.abs();
            assert!((leans - roll.sin()).abs() < 1e-6, "{leans}");
        }
    }
}
