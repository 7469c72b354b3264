//! The force on one body, component by component.

use super::constants::BodyConstants;
use super::parts::PartNow;
use crate::hydro::viscous::ForceFactors;
use crate::hydro::viscous::terms::{Evaluate, ViscousTerms};
use crate::math;
use crate::math::spatial::{Twist, Wrench, cross};
use crate::math::to_real;
use rapier3d::math::{Real, Vector};
use rapier3d::na::{UnitQuaternion, Vector3};

/// A force, N, and its moment about the center of mass, N·m, world axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct ForceAndTorque {
    /// Force, N.
    pub force: Vector,
    /// Torque about the center of mass, N·m.
    pub torque: Vector,
}

impl std::ops::Add for ForceAndTorque {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            force: self.force + other.force,
            torque: self.torque + other.torque,
        }
    }
}

impl std::ops::Mul<f64> for ForceAndTorque {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self {
            force: self.force * factor as Real,
            torque: self.torque * factor as Real,
        }
    }
}

impl std::ops::Sub for ForceAndTorque {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self {
            force: self.force - other.force,
            torque: self.torque - other.torque,
        }
    }
}

impl ForceBreakdown {
    /// Drag, lifts and damping together.
    pub fn viscous(&self) -> ForceAndTorque {
        self.drag + self.translational_lift + self.rotational_lift + self.damping
    }
}

/// What the fluid and gravity do to a body at one moment, by component.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ForceBreakdown {
    /// Inertia of the fluid that the body drags along: `−A dν/dt` with the acceleration of the last
    /// step, and the Munk moment and the other inertial couplings. Of a body in a free surface also what the waves that
    /// it makes take from it, and not what the change of its added mass does while it goes under.
    pub added_mass: ForceAndTorque,
    /// Along the velocity of the pressure point, against it: pressure and friction.
    pub drag: ForceAndTorque,
    /// Lift of the plate's angle of attack.
    pub translational_lift: ForceAndTorque,
    /// Lift of the rotation, and the Magnus force.
    pub rotational_lift: ForceAndTorque,
    /// Resistance to rotation: a pure torque.
    pub damping: ForceAndTorque,
    /// Buoyancy, at the center of the displaced volume.
    pub buoyancy: ForceAndTorque,
    /// What thrusters do.
    pub thrust: ForceAndTorque,
    /// Weight, at the center of mass.
    pub weight: ForceAndTorque,
    /// What the fluctuation of the fluid's velocity adds to the viscous force; the components above
    /// are those in the mean flow. Zero without turbulence, and in the mode that changes bodies'
    /// velocities instead.
    pub turbulence: ForceAndTorque,
    /// Angle of attack: of the relative velocity to the plate, rad, 0 edgewise to π/2 broadside.
    pub angle_of_attack: f32,
}

impl ForceBreakdown {
    /// With factors on the law's forces.
    pub(crate) fn scaled(self, factors: &ForceFactors<f64>) -> Self {
        Self {
            drag: self.drag * factors.drag,
            rotational_lift: self.rotational_lift * factors.rotational_lift,
            translational_lift: self.translational_lift * factors.translational_lift,
            ..self
        }
    }
}

/// The state that forces depend on.
pub(crate) struct Instant {
    /// Plate axes to world.
    pub attitude: UnitQuaternion<f64>,
    /// u and w = ωL relative to the fluid, plate axes.
    pub velocity: Twist<f64>,
    /// Acceleration over the last substep, u̇ + ω × u and ẇ, plate axes.
    pub rate: Twist<f64>,
    /// Gravity that the body feels, m/s², world axes.
    pub gravity: Vector3<f64>,
    /// What goes on at each part of a body of parts.
    pub parts: Vec<PartNow<f64>>,
}

/// Of a velocity in plate axes: 0 edgewise to π/2 broadside.
pub(super) fn angle_of_attack(velocity: &Vector3<f64>) -> f32 {
    let speed = velocity.norm();
    if speed > 0.0 {
        math::asin((velocity.z.abs() / speed).min(1.0)) as f32
    } else {
        0.0
    }
}

impl BodyConstants {
    /// The components of the force at one moment.
    pub fn forces(&self, now: &Instant) -> ForceBreakdown {
        let (inertia, velocity, attitude) = (&self.inertia, &now.velocity, now.attitude);
        let center = inertia.center_velocity(velocity);
        let w = &velocity.angular;
        let terms = self.law.terms(&center, w);
        let world = |wrench: Wrench<f64>| ForceAndTorque {
            force: to_real(attitude * wrench.force * self.mass),
            torque: to_real(attitude * wrench.torque * (self.mass * self.length)),
        };
        let at_pressure = |part: fn(&ViscousTerms<f64>, &Vector3<f64>) -> Vector3<f64>| {
            let mut v = center + cross(w, &terms.offset);
            if terms.arm_moves {
                v.z += w.x * terms.arm.y - w.y * terms.arm.x;
            }
            let force = part(&terms, &v);
            let mut torque = cross(&terms.arm, &force);
            if terms.arm_moves {
                torque.z = 0.0;
            }
            let torque = torque + cross(&(inertia.center + terms.offset), &force);
            world(Wrench { force, torque })
        };
        let buoyancy = now.gravity * -self.displaced_mass;
        let arm = attitude * (self.axes.inverse() * self.buoyancy_arm);
        let viscous = if self.parts.is_empty() {
            ForceBreakdown {
                drag: at_pressure(|t, v| -v.component_mul(&t.creeping) - v * t.drag),
                translational_lift: at_pressure(|t, v| cross(&t.translational_lift, v)),
                rotational_lift: at_pressure(|t, v| cross(&t.rotational_lift, v)),
                damping: world(Wrench {
                    force: Vector3::zeros(),
                    torque: -terms.damping.component_mul(w),
                }),
                angle_of_attack: angle_of_attack(&center),
                ..ForceBreakdown::default()
            }
        } else {
            let parts = (0..self.parts.len()).filter_map(|part| self.part_forces(part, now));
            ForceBreakdown {
                angle_of_attack: angle_of_attack(&center),
                ..parts.fold(ForceBreakdown::default(), |sum, part| ForceBreakdown {
                    drag: sum.drag + part.drag,
                    translational_lift: sum.translational_lift + part.translational_lift,
                    rotational_lift: sum.rotational_lift + part.rotational_lift,
                    damping: sum.damping + part.damping,
                    ..sum
                })
            }
        };
        ForceBreakdown {
            added_mass: world(self.fluid_inertia(velocity, &now.rate)),
            buoyancy: ForceAndTorque {
                force: to_real(buoyancy),
                torque: to_real(arm.cross(&buoyancy)),
            },
            weight: ForceAndTorque {
                force: to_real(now.gravity * self.dry.mass),
                torque: Vector::ZERO,
            },
            ..viscous
        }
    }

    /// The components of the viscous force on one part, moments about the body's center of mass, and its angle of
    /// attack; `None` if there is no such part.
    pub fn part_forces(&self, index: usize, now: &Instant) -> Option<ForceBreakdown> {
        let (part, at) = (self.parts.get(index)?, now.parts.get(index)?);
        let turn = now.attitude.inverse();
        let place = match &part.hinge {
            Some(hinge) => hinge.turned(&part.place, at.sine, at.cosine),
            None => part.place,
        };
        let spin = turn * at.spin;
        let relative = Twist {
            linear: now.velocity.linear - (turn * at.velocity - spin.cross(&place.position)),
            angular: now.velocity.angular - spin,
        };
        let world = |wrench: Wrench<f64>| ForceAndTorque {
            force: to_real(now.attitude * wrench.force * self.mass),
            torque: to_real(now.attitude * wrench.torque * (self.mass * self.length)),
        };
        let [drag, translational_lift, rotational_lift, damping] = part
            .law
            .components(&place, &relative, at.factors)
            .map(|n| world(n.apply(&relative)));
        let center = relative.linear + relative.angular.cross(&place.position);
        Some(ForceBreakdown {
            drag,
            translational_lift,
            rotational_lift,
            damping,
            angle_of_attack: angle_of_attack(&place.back(&center)),
            ..ForceBreakdown::default()
        })
    }

    /// Force and torque of the fluid's own inertia, in the integrator's units: that of 𝕄 less that
    /// of the body itself.
    fn fluid_inertia(&self, v: &Twist<f64>, rate: &Twist<f64>) -> Wrench<f64> {
        let mass = self.inertia.mass_matrix();
        let turn = self.axes.inverse();
        let dry = turn.matrix() * self.dry.inertia * self.axes.matrix()
            / (self.mass * self.length * self.length);
        let fluid = |v: &Twist<f64>| Wrench {
            force: mass.m11 * v.linear + mass.m12 * v.angular - v.linear * self.inertia.dry_mass,
            torque: mass.m21 * v.linear + mass.m22 * v.angular - dry * v.angular,
        };
        let turned = cross(&v.angular, &v.linear) * self.inertia.per_length;
        let resisted = fluid(&Twist {
            linear: rate.linear - turned,
            angular: rate.angular,
        });
        let carried = fluid(v);
        let spinning = mass.m22 * v.angular - dry * v.angular;
        let munk = self.inertia.munk;
        let isotropic = (1.0 - munk) * self.inertia.isotropic;
        let arm = &self.inertia.volume_center;
        let p = carried.force * munk + (v.linear + cross(&v.angular, arm)) * isotropic;
        let h = spinning + mass.m21 * v.linear * munk + cross(arm, &v.linear) * isotropic;
        let per_length = self.inertia.per_length;
        let force = cross(&p, &v.angular) * per_length - resisted.force;
        let torque = (cross(&h, &v.angular) + cross(&p, &v.linear)) * per_length - resisted.torque;
        Wrench { force, torque }
    }
}
