//! Snapshots of an immersion: what is written, and what is refused when it is read.

use super::admission::renew_constants;
use super::body_look::BodyChanges;
use super::body_state::{BodyState, FlightState};
use super::control::SeriesTable;
use super::environment::Environment;
use super::immersion::Immersion;
use super::registry::Registry;
use super::shared_constants::ConstantsTable;
use super::step::workspace::Workspace;
use super::warning::Warnings;
use crate::dynamics::Integrator;
use crate::error::Error;
use crate::math::vector;
use rapier3d::math::Vector;
use serde::de::Error as _;
use serde::ser::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Version of what is written. Others are refused.
const VERSION: u32 = 9;

/// What is written, in this order.
#[derive(Serialize)]
struct Written<'a> {
    version: u32,
    integrator: &'a Integrator,
    body_changes: BodyChanges,
    enabled: bool,
    environment: &'a Environment,
    registry: &'a Registry,
    series: &'a SeriesTable,
    warnings: &'a Warnings,
}

/// The same, read and not checked.
#[derive(Deserialize)]
struct Read {
    version: u32,
    integrator: Integrator,
    body_changes: BodyChanges,
    enabled: bool,
    environment: Environment,
    registry: Registry,
    series: SeriesTable,
    warnings: Warnings,
}

impl Serialize for Immersion {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if !self.workspace.saved_forces.is_empty() {
            let problem = "a snapshot between before_step and after_step would lose users' forces";
            return Err(S::Error::custom(problem));
        }
        let written = Written {
            version: VERSION,
            integrator: &self.integrator,
            body_changes: self.body_changes,
            enabled: self.enabled,
            environment: &self.environment,
            registry: &self.registry,
            series: &self.series,
            warnings: &self.warnings,
        };
        written.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Immersion {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let read = Read::deserialize(deserializer)?;
        read.checked().map_err(D::Error::custom)
    }
}

impl Read {
    fn checked(self) -> Result<Immersion, Error> {
        if self.version != VERSION {
            return Err(Error::UnsupportedFileVersion {
                file: "immersion",
                found: self.version,
                supported: VERSION,
            });
        }
        Error::check_not_negative("time of the immersion", self.environment.time)?;
        check_vectors("gravity", [self.environment.gravity])?;
        self.environment.medium.check()?;
        let mut environment = self.environment;
        environment.restore()?;
        let mut registry = self.registry;
        registry.restore()?;
        for series in self.series.iter() {
            series.check()?;
        }
        for state in registry.iter_mut() {
            state.check(&self.series)?;
        }
        let mut constants = ConstantsTable::default();
        renew_constants(&mut registry, &mut constants, &environment)?;
        Ok(Immersion {
            integrator: self.integrator,
            body_changes: self.body_changes,
            enabled: self.enabled,
            environment,
            registry,
            series: self.series,
            warnings: self.warnings,
            constants,
            workspace: Workspace::default(),
        })
    }
}

/// Speeds, m/s and rad/s, beyond which no step goes.
const FASTEST: f64 = 1e7;

fn check_vectors(
    what: &'static str,
    vectors: impl IntoIterator<Item = Vector>,
) -> Result<(), Error> {
    for vector in vectors {
        Error::check_all_finite(what, &vector.to_array().map(f64::from))?;
    }
    Ok(())
}

impl BodyState {
    fn check(&self, series: &SeriesTable) -> Result<(), Error> {
        self.control.factors.check()?;
        if let Some(index) = self.control.series() {
            let there = series.get(index).is_some();
            Error::check(
                "series of a body",
                f64::from(index),
                there,
                "one of the series",
            )?;
        }
        if let Some(time) = self.control.time() {
            Error::check_not_negative("time of a replay", time)?;
        }
        if let Some(saved) = &self.saved {
            saved.check()?;
            Error::check_positive("solver mass", self.flight.solver_mass.into())?;
        }
        if let Some(left) = &self.left {
            left.check()?;
        }
        if let Some(equipment) = &self.equipment {
            let parts = equipment.parts.len() as f64;
            Error::check("parts of a body", parts, equipment.is_valid(), "of numbers")?;
        }
        if let Some(crossing) = &self.crossing {
            let share = crossing.submerged.into();
            Error::check(
                "body at a surface",
                share,
                crossing.is_valid(),
                "of numbers",
            )?;
        }
        self.flight.check()
    }
}

impl FlightState {
    fn check(&self) -> Result<(), Error> {
        let motion = &self.motion;
        check_vectors(
            "acceleration of a body",
            [
                vector(motion.linear_rate),
                vector(motion.angular_rate),
                vector(motion.linear_trend),
                vector(motion.angular_trend),
            ],
        )?;
        let velocities = [
            motion.linear,
            motion.angular,
            self.end_linear,
            self.end_angular,
        ];
        for velocity in velocities {
            let speed = velocity.length().into();
            Error::check_range("speed of a body", speed, 0.0, FASTEST)?;
        }
        let norm = motion.attitude.iter().map(|x| x * x).sum::<f32>().sqrt();
        let unit = (norm - 1.0).abs() < 1e-3 || (norm == 0.0 && !self.continues);
        Error::check("norm of an attitude", norm.into(), unit, "1")?;
        Error::check_not_negative("last substep", motion.last_substep.into())?;
        Error::check_not_negative("substeps", motion.substeps.into())?;
        let turbulence = &self.turbulence;
        check_vectors(
            "flow around a body",
            [
                self.fluid_velocity,
                turbulence.fluctuation,
                turbulence.slip,
                turbulence.seen.normalized,
            ],
        )?;
        Error::check_finite("turbulent energy", self.turbulent_energy.into())?;
        if let Some(since) = turbulence.since {
            Error::check_finite("time since the turbulence acts", since)?;
        }
        Ok(())
    }
}
