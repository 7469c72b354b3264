//! Why does it do that: every component of the force on one body.

use super::immersion::{Immersion, NONE};
use crate::body::LawConstants;
use crate::dynamics::integrate::Inviscid;
use crate::dynamics::kirchhoff::{Twist, cross};
use crate::hydro::viscous::{Evaluate, ViscousTerms};
use crate::math::{to_f64, to_quaternion, to_real};
use rapier3d::dynamics::{RigidBodyHandle, RigidBodySet};
use rapier3d::math::Vector;
use rapier3d::na::{UnitQuaternion, Vector3};

/// A force, N, and its moment about the center of mass, N·m, world axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
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

/// What the fluid and gravity do to a body at one moment, by component.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ForceBreakdown {
    /// Inertia of the fluid that the body drags along: `−A dν/dt` with the acceleration of the last
    /// step, and the Munk moment and its kin.
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
    /// Weight, at the center of mass.
    pub weight: ForceAndTorque,
    /// Share of the fluid's turbulence in the viscous force; zero without a turbulent flow.
    pub turbulence: ForceAndTorque,
    /// Angle of attack: of the relative velocity to the plate, rad, 0 edgewise to π/2 broadside.
    pub angle_of_attack: f32,
}

impl Immersion {
    /// The forces on a body in the state that it has now, or `None` if it is not immersed (yet: a
    /// body enters the fluid with the first step after its insertion). Gravity is that of the last
    /// step.
    pub fn forces(&self, bodies: &RigidBodySet, handle: RigidBodyHandle) -> Option<ForceBreakdown> {
        let slot = self.slot(handle)?;
        let body = bodies.get(handle)?;
        if slot.kind == NONE || slot.original.is_none() {
            return None;
        }
        let c = &self.kinds[slot.kind as usize].constants;
        let attitude =
            to_quaternion(*body.rotation()) * UnitQuaternion::from_rotation_matrix(&c.axes);
        let sample = self.flow.as_ref().map(|flow| {
            let point = body.center_of_mass();
            (
                flow.velocity(point, self.time),
                flow.vorticity(point, self.time),
            )
        });
        let (stream, vorticity) = sample.unwrap_or_default();
        let inverse = attitude.inverse();
        let velocity = Twist {
            linear: inverse * to_f64(body.linvel() - stream),
            angular: inverse * to_f64(body.angvel() - vorticity * 0.5) * c.length,
        };
        let center = c.inertia.center_velocity(&velocity);
        let w = &velocity.angular;
        let terms = match &c.law {
            LawConstants::Inviscid => Evaluate::<f64>::terms(&Inviscid, &center, w),
            LawConstants::Physical(law) => law.terms(&center, w),
            LawConstants::Thesis(law) => law.terms(&center, w),
            LawConstants::Stochastic(law) => law.terms(&center, w),
        };

        let world = |force: Vector3<f64>, torque: Vector3<f64>| ForceAndTorque {
            force: to_real(attitude * force * c.mass),
            torque: to_real(attitude * torque * (c.mass * c.length)),
        };
        let at_pressure = |part: fn(&ViscousTerms<f64>, &Vector3<f64>) -> Vector3<f64>| {
            let mut v = center;
            if terms.arm_moves {
                v.z += w.x * terms.arm.y - w.y * terms.arm.x;
            }
            let force = part(&terms, &v);
            let mut torque = cross(&terms.arm, &force);
            if terms.arm_moves {
                torque.z = 0.0;
            }
            world(force, torque + cross(&c.inertia.center(), &force))
        };

        // Inertia of the fluid alone: 𝕄 less the body's own.
        let mass = c.inertia.mass_matrix();
        let acceleration = Twist {
            linear: plate(&slot.flight.rate[..3]),
            angular: plate(&slot.flight.rate[3..]),
        };
        let turn = c.axes.inverse();
        let dry = turn.matrix() * c.dry.inertia * c.axes.matrix() / (c.mass * c.length * c.length);
        let fluid = |v: &Twist<f64>| Twist {
            linear: mass.m11 * v.linear + mass.m12 * v.angular - v.linear * c.inertia.dry_mass,
            angular: mass.m21 * v.linear + mass.m22 * v.angular - dry * v.angular,
        };
        let resisted = fluid(&acceleration);
        let carried = fluid(&velocity);
        let munk = c.inertia.munk * c.inertia.per_length;
        let turned = c.inertia.per_length;
        let spin_part = mass.m22 * velocity.angular - dry * velocity.angular;
        let added_mass = world(
            cross(&carried.linear, w) * munk - resisted.linear,
            cross(&spin_part, w) * turned
                + (cross(&carried.linear, &velocity.linear)
                    + cross(&(mass.m21 * velocity.linear), w))
                    * munk
                - resisted.angular,
        );

        let gravity = to_f64(self.gravity * body.gravity_scale());
        let buoyancy = gravity * -c.displaced_mass;
        let arm = to_quaternion(*body.rotation()) * c.buoyancy_arm;
        let speed = center.norm();
        Some(ForceBreakdown {
            added_mass,
            drag: at_pressure(|t, v| -v.component_mul(&t.creeping) - v * t.drag),
            translational_lift: at_pressure(|t, v| cross(&t.translational_lift, v)),
            rotational_lift: at_pressure(|t, v| cross(&t.rotational_lift, v)),
            damping: world(Vector3::zeros(), -terms.damping.component_mul(w)),
            buoyancy: ForceAndTorque {
                force: to_real(buoyancy),
                torque: to_real(arm.cross(&buoyancy)),
            },
            weight: ForceAndTorque {
                force: to_real(gravity * c.dry.mass),
                torque: Vector::ZERO,
            },
            turbulence: ForceAndTorque::default(),
            angle_of_attack: if speed > 0.0 {
                (center.z.abs() / speed).asin() as f32
            } else {
                0.0
            },
        })
    }
}

fn plate(v: &[f32]) -> Vector3<f64> {
    Vector3::new(v[0].into(), v[1].into(), v[2].into())
}
