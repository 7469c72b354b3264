//! The force on a body that is cut, component by component.

use super::constants::CrossingConstants;
use super::cut::{Cut, Place};
use crate::dynamics::forces::{ForceAndTorque, ForceBreakdown, Instant, angle_of_attack};
use crate::math::spatial::{Twist, Wrench};
use crate::math::to_real;
use rapier3d::math::Vector;
use rapier3d::na::{Rotation3, Vector3};

impl CrossingConstants {
    /// The components at one moment, of the whole or of one of the parts. `now.velocity` is in the frame that the fluids'
    /// velocities in `now.parts` are relative to, layer by layer.
    pub fn forces(
        &self,
        cut: &Cut,
        place: &Place,
        level: &Rotation3<f64>,
        now: &Instant,
        only: Option<usize>,
    ) -> ForceBreakdown {
        let mut portions = Vec::new();
        let wetted = cut.cut(self, place, &mut portions);
        let (mass, length, attitude) = (self.mass, self.length, now.attitude);
        let world = |wrench: Wrench<f64>| ForceAndTorque {
            force: to_real(attitude * wrench.force * mass),
            torque: to_real(attitude * wrench.torque * (mass * length)),
        };
        let mut found = ForceBreakdown::default();
        let (parts, turn) = (self.part_count(), attitude.inverse());
        let fluids = self.fluids[cut.first..].iter().take(cut.count);
        let all = fluids.flat_map(|fluid| &fluid.parts);
        for (index, ((part, portion), at)) in all.zip(&portions).zip(&now.parts).enumerate() {
            if portion.share <= 0.0 || only.is_some_and(|only| only != index % parts) {
                continue;
            }
            let mut own = match &part.hinge {
                Some(hinge) => hinge.turned(&part.place, at.sine, at.cosine),
                None => part.place,
            };
            own.position += portion.shift / length;
            let spin = turn * at.spin;
            let relative = Twist {
                linear: now.velocity.linear - (turn * at.velocity - spin.cross(&own.position)),
                angular: now.velocity.angular - spin,
            };
            let components = part.law.components(&own, &relative, at.factors);
            let [drag, lift, rotational_lift, damping] =
                components.map(|n| world(n.apply(&relative)) * portion.share);
            found.drag = found.drag + drag;
            found.translational_lift = found.translational_lift + lift;
            found.rotational_lift = found.rotational_lift + rotational_lift;
            found.damping = found.damping + damping;
            let center = relative.linear + relative.angular.cross(&own.position);
            found.angle_of_attack = angle_of_attack(&own.back(&center));
        }
        if only.is_some() {
            return found;
        }
        let up = level * Vector3::y();
        let gravity = -now.gravity.dot(&up);
        let lifted = up * (gravity * wetted.displaced_mass);
        let moment = attitude * wetted.displaced_moment;
        found.buoyancy = ForceAndTorque {
            force: to_real(lifted),
            torque: to_real(moment.cross(&up) * gravity),
        };
        found.weight = ForceAndTorque {
            force: to_real(now.gravity * self.dry_mass),
            torque: Vector::ZERO,
        };
        let (v, rate) = (&now.velocity, &now.rate);
        let turned = v.angular.cross(&v.linear) / length;
        let accelerated = Twist {
            linear: rate.linear - turned,
            angular: rate.angular / length,
        };
        let resisted = wetted.mass.momentum(&accelerated);
        let own = Wrench {
            force: resisted.force - accelerated.linear * self.dry_mass,
            torque: resisted.torque - self.dry_inertia * accelerated.angular,
        };
        let inertia = ForceAndTorque {
            force: to_real(attitude * -own.force),
            torque: to_real(attitude * -own.torque),
        };
        // What the waves that it makes take.
        let stiffness = self.stiffness(&wetted, place, gravity.max(0.0));
        let radiation = self.radiation(&stiffness, &wetted.mass);
        found.added_mass = inertia - world(stiffness.apply(v).scaled(radiation));
        found
    }
}
