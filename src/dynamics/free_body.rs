//! One free body in f64, without rapier: for training, calibration and tests.

use super::constants::BodyConstants;
use super::flow_response::FlowResponse;
use super::forces::{ForceBreakdown, Instant};
use super::integrate::{Motion, advance, substeps};
use super::integrator::Integrator;
use super::load::Load;
use super::locked::Locks;
use super::parts::{PartNow, Parts};
use super::reaction::Whole;
use crate::body::{DryMass, ImmersedBody};
use crate::error::Error;
use crate::flow::{FlowSample, StrainRate};
use crate::fluid::Fluid;
use crate::hydro::part_law::Exact;
use crate::hydro::viscous::ForceFactors;
use crate::hydro::viscous::force_factors::Factored;
use crate::math;
use crate::math::spatial::{Twist, rotate_back};
use rapier3d::na::{UnitQuaternion, Vector3};

/// One body without a rapier world, by the same equations, law and integrator, in f64.
///
/// Positions are those of the center of mass; angular and linear velocities are in world axes.
///
/// ```
/// use rapier3d_immersed::geometry::Surface;
/// use rapier3d_immersed::rapier3d::na::{UnitQuaternion, Vector3};
/// use rapier3d_immersed::rapier3d::prelude::*;
/// use rapier3d_immersed::{DryMass, Fluid, FreeBody, HydroProperties, ImmersedBody};
///
/// let leaf = Cuboid::new(Vector::new(0.0365, 0.00015, 0.021));
/// let mass = DryMass::uniform(&Surface::from_shape(&leaf)?, 2.8e-4)?;
/// let body = ImmersedBody::new(HydroProperties::from_shape(&leaf)?);
/// let mut leaf = FreeBody::new(&body, &mass, &Fluid::AIR)?;
/// leaf.set_orientation(UnitQuaternion::from_scaled_axis(Vector3::x() * 0.3));
/// for _ in 0..120 {
///     leaf.step(1.0 / 120.0, Vector3::y() * -9.81);
/// }
/// // It falls more slowly than 9.81 m/s after a second, and not straight down.
/// assert!(leaf.linear_velocity().norm() < 2.0 && leaf.position.z.abs() > 0.05);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct FreeBody {
    constants: BodyConstants,
    flow_response: FlowResponse<f64>,
    /// How finely steps are integrated.
    pub integrator: Integrator,
    /// Factors on the law's forces (default 1).
    pub control: ForceFactors<f64>,
    /// Center of mass, m.
    pub position: Vector3<f64>,
    /// Turns of the parts about their hinges, rad; those beyond are zero.
    deflections: Vec<f64>,
    attitude: UnitQuaternion<f64>,
    /// u and w relative to the fluid at rest, plate axes.
    velocity: Twist<f64>,
    /// The integrator's memory: see [`Motion`].
    rate: Twist<f64>,
    trend: Twist<f64>,
    last: f64,
    /// Velocity of the fluid in the last step, m/s, world axes; `None` before the first.
    stream: Option<Vector3<f64>>,
}

impl FreeBody {
    /// A body at rest at the origin, its frame aligned with the world's.
    ///
    /// # Errors
    /// Those of [`DryMass::check`], [`HydroProperties::check`](crate::HydroProperties::check) and
    /// [`ViscousLaw::check`](crate::ViscousLaw::check); [`Error::UnphysicalAddedMass`].
    pub fn new(body: &ImmersedBody, mass: &DryMass, fluid: &Fluid) -> Result<Self, Error> {
        let constants = BodyConstants::new(body, mass, fluid)?;
        let attitude = UnitQuaternion::from_rotation_matrix(&constants.axes);
        let inverse_mass = constants
            .mass_matrix()
            .try_inverse()
            .ok_or(Error::UnphysicalAddedMass)?;
        Ok(Self {
            flow_response: FlowResponse::new(&constants, &inverse_mass),
            constants,
            integrator: Integrator::default(),
            control: ForceFactors::default(),
            position: Vector3::zeros(),
            deflections: Vec::new(),
            attitude,
            velocity: Twist::zero(0.0),
            rate: Twist::zero(0.0),
            trend: Twist::zero(0.0),
            last: 0.0,
            stream: None,
        })
    }

    /// Mass of the body itself, kg.
    pub fn mass(&self) -> f64 {
        self.constants.dry.mass
    }

    /// Orientation of the body's frame.
    pub fn orientation(&self) -> UnitQuaternion<f64> {
        self.attitude * UnitQuaternion::from_rotation_matrix(&self.constants.axes).inverse()
    }

    /// Turns the body's frame; its velocities in world axes stay.
    pub fn set_orientation(&mut self, orientation: UnitQuaternion<f64>) {
        let (linear, angular) = (self.linear_velocity(), self.angular_velocity());
        self.attitude = orientation * UnitQuaternion::from_rotation_matrix(&self.constants.axes);
        self.set_velocity(linear, angular);
    }

    /// Turns a part about its [`Hinge`](crate::Hinge), rad. A part without one, and an angle that is no number, change
    /// nothing.
    pub fn set_deflection(&mut self, part: usize, angle: f64) {
        let hinged = self
            .constants
            .parts
            .get(part)
            .is_some_and(|part| part.hinge.is_some());
        if hinged && angle.is_finite() {
            let count = self.deflections.len().max(part + 1);
            self.deflections.resize(count, 0.0);
            self.deflections[part] = angle;
        }
    }

    /// How far a part is turned about its hinge, rad.
    pub fn deflection(&self, part: usize) -> f64 {
        self.deflections.get(part).copied().unwrap_or(0.0)
    }

    /// Velocity of the center of mass, m/s, world axes.
    pub fn linear_velocity(&self) -> Vector3<f64> {
        self.attitude * self.velocity.linear
    }

    /// Angular velocity, rad/s, world axes.
    pub fn angular_velocity(&self) -> Vector3<f64> {
        self.attitude * self.velocity.angular / self.constants.length
    }

    /// Sets both velocities, world axes, m/s and rad/s.
    pub fn set_velocity(&mut self, linear: Vector3<f64>, angular: Vector3<f64>) {
        self.velocity = Twist {
            linear: self.attitude.inverse() * linear,
            angular: self.attitude.inverse() * angular * self.constants.length,
        };
        self.rate = Twist::zero(0.0);
        self.trend = Twist::zero(0.0);
        self.last = 0.0;
    }

    /// Goes on from a state that was computed elsewhere and is close to this body's own, keeping
    /// the integrator's memory of the acceleration.
    pub fn follow(
        &mut self,
        position: Vector3<f64>,
        orientation: UnitQuaternion<f64>,
        linear: Vector3<f64>,
        angular: Vector3<f64>,
    ) {
        let (rate, trend, last) = (self.rate, self.trend, self.last);
        self.position = position;
        self.set_orientation(orientation);
        self.set_velocity(linear, angular);
        (self.rate, self.trend, self.last) = (rate, trend, last);
    }

    /// Plate normal (the shortest principal axis), world axes.
    pub fn normal(&self) -> Vector3<f64> {
        self.attitude * Vector3::z()
    }

    /// Longest principal axis, world axes.
    pub fn long_axis(&self) -> Vector3<f64> {
        self.attitude * Vector3::x()
    }

    /// Advances by `dt` seconds in a fluid at rest under `gravity` (m/s², world axes). Any `dt` is
    /// stable; a `dt` that is not positive does nothing.
    pub fn step(&mut self, dt: f64, gravity: Vector3<f64>) {
        self.step_in(dt, gravity, &FlowSample::default());
    }

    /// Advances by `dt` in a fluid that moves uniformly with `flow` during the step.
    ///
    /// What the fluid's velocity has changed by since the last step, the body feels as the pressure gradient
    /// and added mass of an accelerating flow, as in an [`Immersion`](crate::Immersion): a neutrally buoyant
    /// one changes its own by as much. In its first step a body finds the fluid as it is.
    pub fn step_in(&mut self, dt: f64, gravity: Vector3<f64>, flow: &FlowSample) {
        if dt.is_nan() || dt <= 0.0 {
            return;
        }
        let c = &self.constants;
        let stream = math::to_f64(flow.velocity);
        let weight = gravity * (c.dry.mass / c.mass);
        let buoyancy = gravity * (-c.displaced_mass / c.mass);
        let load = Load {
            force: weight + buoyancy,
            torque: Vector3::zeros(),
            buoyancy,
            buoyancy_arm: c.axes.inverse() * c.buoyancy_arm / c.length,
            fluid_spin: math::to_f64(flow.vorticity) * (0.5 * c.length),
            stretching: math::to_f64(flow.strain.stretching),
            shearing: math::to_f64(flow.strain.shearing),
            strain_response: self.flow_response.straining,
            turning: true,
            spinning: true,
            straining: flow.strain != StrainRate::default(),
            locks: Locks::none(0.0),
        };
        let mut motion = Motion {
            attitude: *self.attitude.quaternion(),
            displacement: Vector3::zeros(),
            velocity: self.velocity,
            rate: self.rate,
            trend: self.trend,
            last: self.last,
        };
        let change = stream - self.stream.replace(stream).unwrap_or(stream);
        let response = self
            .flow_response
            .to(&rotate_back(&motion.attitude, &change));
        motion.velocity.linear += response.linear - rotate_back(&motion.attitude, &stream);
        motion.velocity.angular += response.angular;
        let inertia = &c.inertia;
        let count = substeps(inertia, &motion, &load, dt, &self.integrator);
        let (most, iterations) = (count as u32, self.integrator.iterations);
        let m = &mut motion;
        // One body does not need the path for symmetric ones.
        if c.parts.is_empty() {
            let law = &Factored {
                law: &c.law,
                factors: self.control,
            };
            advance::<false, _, _>(inertia, &Whole(law), &load, m, dt, count, most, iterations);
        } else {
            let spin = load.fluid_spin;
            let parts = Parts {
                constants: &c.parts,
                coupled: &c.coupled,
                raise: Exact,
                now: |part: usize| PartNow {
                    spin,
                    factors: self.control,
                    ..PartNow::at_rest(self.deflection(part))
                },
                flows: spin != Vector3::zeros(),
                deflected: !self.deflections.is_empty(),
            };
            advance::<false, _, _>(inertia, &parts, &load, m, dt, count, most, iterations);
        }
        self.attitude = UnitQuaternion::new_normalize(motion.attitude);
        self.velocity = motion.velocity;
        self.velocity.linear += rotate_back(self.attitude.quaternion(), &stream);
        (self.rate, self.trend, self.last) = (motion.rate, motion.trend, motion.last);
        self.position += motion.displacement + stream * dt;
    }

    /// The components of the force on the body in a fluid at rest under `gravity`, m/s².
    pub fn forces(&self, gravity: Vector3<f64>) -> ForceBreakdown {
        let instant = Instant {
            attitude: self.attitude,
            velocity: self.velocity,
            rate: self.rate,
            gravity,
            parts: self.part_states(),
        };
        self.constants.forces(&instant).scaled(&self.control)
    }

    /// The components of the viscous force on one part in a fluid at rest, moments about the body's center of mass;
    /// `None` if there is no such part.
    pub fn part_forces(&self, part: usize) -> Option<ForceBreakdown> {
        let instant = Instant {
            attitude: self.attitude,
            velocity: self.velocity,
            rate: self.rate,
            gravity: Vector3::zeros(),
            parts: self.part_states(),
        };
        Some(
            self.constants
                .part_forces(part, &instant)?
                .scaled(&self.control),
        )
    }

    fn part_states(&self) -> Vec<PartNow<f64>> {
        let parts = 0..self.constants.parts.len();
        parts
            .map(|part| PartNow::at_rest(self.deflection(part)))
            .collect()
    }

    /// Momentum of body and fluid in plate axes, kg·m/s and kg·m²/s.
    fn momentum(&self) -> (Vector3<f64>, Vector3<f64>) {
        let p = self.constants.inertia.mass_matrix().apply(&self.velocity);
        let scale = self.constants.mass;
        (p.force * scale, p.torque * (scale * self.constants.length))
    }

    /// Kinetic energy of the body and of the fluid at rest that it sets in motion, J.
    pub fn kinetic_energy(&self) -> f64 {
        let (p, h) = self.momentum();
        0.5 * (p.dot(&self.velocity.linear) + h.dot(&self.velocity.angular) / self.constants.length)
    }

    /// World impulse of body and fluid, kg·m/s.
    pub fn impulse(&self) -> Vector3<f64> {
        self.attitude * self.momentum().0
    }

    /// World moment of impulse of body and fluid about the origin, kg·m²/s.
    pub fn impulse_moment(&self) -> Vector3<f64> {
        let (p, h) = self.momentum();
        self.attitude * h + self.position.cross(&(self.attitude * p))
    }
}
