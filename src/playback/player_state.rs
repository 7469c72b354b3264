//! One played body: how it is moved along its path, and what contacts do to it.

use super::player::{AtContact, Drive, MotionPlayer};
use crate::math;
use crate::motion::path::{MotionPath, WindResponse};
use rapier3d::dynamics::{RigidBody, RigidBodyHandle, RigidBodyType};
use rapier3d::geometry::{ActiveCollisionTypes, ColliderSet, NarrowPhase};
use rapier3d::math::{Pose, Real, Rotation, Vector};
use std::sync::Arc;

/// A played body.
#[derive(Clone)]
pub(super) struct PlayerState {
    pub handle: RigidBodyHandle,
    pub path: Arc<MotionPath>,
    pub origin: Vector,
    pub turn: Rotation,
    /// The rotation from the body's frame to the plate's axes.
    pub to_plate: Rotation,
    pub drive: Drive,
    pub at_contact: AtContact,
    pub clock: Real,
    /// Seconds since something touched it.
    pub free: Real,
    pub waiting: bool,
    /// Whether the force model is switched off for it.
    pub taken: bool,
    /// Velocity taken from the wind, m/s.
    pub blown: Vector,
    /// How a kinematic body still differs from its path after a contact.
    pub deflection: Option<Deflection>,
    /// Whether its colliders look for the contacts that rapier leaves out.
    pub watched: bool,
    /// The path at `clock`, turned: position from the origin, and attitude of the body's frame.
    pub now: (Vector, Rotation),
}

/// How a kinematic body differs from its path after a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Deflection {
    /// Rotation vector from the path's attitude, rad.
    pub rotation: Vector,
    /// Velocity relative to the path's, m/s.
    pub velocity: Vector,
}

/// Time in which a [`Deflection`] fades, s: as long as the default compliance.
const DEFLECTION_TIME: Real = 0.1;

/// What all bodies share in a step.
pub(super) struct PlayStep {
    pub dt: Real,
    /// Velocity by which gravity moves a body within the step.
    pub sag: Vector,
    pub angle: Option<WindResponse>,
}

impl PlayerState {
    /// A body at the beginning of its path.
    pub fn new(handle: RigidBodyHandle, player: &MotionPlayer) -> Self {
        let release = player.release(Vector::ZERO);
        Self {
            handle,
            path: player.path.clone(),
            origin: player.origin,
            turn: Rotation::from_axis_angle(Vector::Y, player.heading),
            now: (release.translation - player.origin, release.rotation),
            to_plate: player.axes.inverse(),
            drive: player.drive,
            at_contact: player.at_contact,
            clock: 0.0,
            free: Real::INFINITY,
            waiting: false,
            taken: false,
            blown: Vector::ZERO,
            deflection: None,
            watched: false,
        }
    }

    /// Lets rapier look for contacts of a kinematic body with all kinds of bodies: by default it leaves
    /// out those with fixed and kinematic ones, which move neither.
    #[cold]
    pub fn watch(&mut self, body: &RigidBody, colliders: &mut ColliderSet) {
        self.watched = true;
        if self.drive != Drive::Kinematic || self.at_contact == AtContact::Ignore {
            return;
        }
        for handle in body.colliders() {
            if let Some(collider) = colliders.get_mut(*handle) {
                let others = ActiveCollisionTypes::KINEMATIC_FIXED
                    | ActiveCollisionTypes::KINEMATIC_KINEMATIC;
                collider.set_active_collision_types(collider.active_collision_types() | others);
            }
        }
    }

    /// Moves the body, which may be `touching` another, for a step, and says whether it is played on.
    #[inline]
    pub fn advance(
        &mut self,
        body: &mut RigidBody,
        touching: bool,
        wind: Option<Vector>,
        step: &PlayStep,
    ) -> bool {
        match self.drive {
            Drive::Kinematic if body.body_type() == RigidBodyType::KinematicPositionBased => {
                if self.at_contact != AtContact::Ignore && touching {
                    self.let_go(body, step.dt);
                    return self.at_contact != AtContact::HandOver;
                }
                self.carry(body, wind, step);
                let done = self.clock >= self.path.duration();
                if done {
                    body.set_body_type(RigidBodyType::Dynamic, true);
                }
                !done
            }
            Drive::Kinematic if self.waiting && body.is_dynamic() => {
                self.free = match touching {
                    true => 0.0,
                    false => self.free + step.dt,
                };
                let after = match self.at_contact {
                    AtContact::Resume { after } => after,
                    _ => 0.0,
                };
                if self.free > after {
                    self.take_up(body);
                    self.carry(body, wind, step);
                }
                true
            }
            Drive::Velocity { compliance } if body.is_dynamic() => {
                self.drive(body, touching, compliance, wind, step)
            }
            _ => true,
        }
    }

    /// Moves a kinematic body to where the path is at the end of the step.
    #[inline]
    fn carry(&mut self, body: &mut RigidBody, wind: Option<Vector>, step: &PlayStep) {
        self.taken = true;
        let lean = self.blow(wind, step);
        self.proceed(step.dt);
        let mut rotation = leaning(lean, self.now.1);
        if let Some(deflection) = &mut self.deflection {
            let left = DEFLECTION_TIME / (DEFLECTION_TIME + step.dt);
            deflection.rotation *= left;
            deflection.velocity *= left;
            self.origin += deflection.velocity * step.dt;
            rotation = Rotation::from_scaled_axis(deflection.rotation) * rotation;
            if deflection.rotation.length() < 1e-4 && deflection.velocity.length() < 1e-4 {
                self.deflection = None;
            }
        }
        let com = self.origin + self.now.0;
        let origin = com - rotation * body.local_center_of_mass();
        let pose = Pose::from_parts(origin, rotation.normalize());
        // A path of numbers beyond single precision moves nobody.
        if pose.translation.is_finite() && pose.rotation.is_finite() {
            body.set_next_kinematic_position(pose);
        }
    }

    /// Makes a kinematic body dynamic, with the velocities that it has on its path.
    fn let_go(&mut self, body: &mut RigidBody, dt: Real) {
        // Rapier keeps the velocities of the last step's displacement; in the first step there is none.
        if self.clock == 0.0 {
            let next = self.path.at(dt);
            let attitude = self.turn * next.attitude * self.to_plate;
            let linear = self.turn * self.path.at(0.0).velocity;
            set_velocities(body, linear, vector(attitude * self.now.1.inverse()) / dt);
        }
        body.set_body_type(RigidBodyType::Dynamic, true);
        (self.waiting, self.taken, self.free) = (true, false, 0.0);
        self.deflection = None;
    }

    /// Makes a body kinematic again that nothing touches any more: its path goes on from where it is, and
    /// with its attitude and velocity at first.
    fn take_up(&mut self, body: &mut RigidBody) {
        self.waiting = false;
        self.anchor(*body.position() * body.local_center_of_mass());
        let path = self.turn * self.path.at(self.clock).velocity + self.blown;
        let away = *body.rotation() * self.now.1.inverse();
        self.deflection = Some(Deflection {
            rotation: away.to_scaled_axis(),
            velocity: body.linvel() - path,
        });
        body.set_body_type(RigidBodyType::KinematicPositionBased, true);
    }

    fn drive(
        &mut self,
        body: &mut RigidBody,
        touching: bool,
        compliance: Real,
        wind: Option<Vector>,
        step: &PlayStep,
    ) -> bool {
        let dt = step.dt;
        let touching = touching && self.at_contact != AtContact::Ignore;
        self.free = if touching { 0.0 } else { self.free + dt };
        let com = *body.position() * body.local_center_of_mass();
        match self.at_contact {
            AtContact::HandOver if touching => return false,
            AtContact::Resume { after } => {
                if touching {
                    (self.waiting, self.taken) = (true, false);
                } else if self.waiting && self.free > after {
                    self.waiting = false;
                    self.anchor(com);
                    // The velocity of the path comes back as after a contact.
                    self.free = dt;
                }
                if self.waiting {
                    return true;
                }
            }
            AtContact::Deflect if touching => self.anchor(com),
            _ => {}
        }
        self.taken = true;
        if !body.is_fast_rotation_allowed() {
            body.set_allow_fast_rotation(true);
        }
        // This is where the path was before this step's wind, whose displacement is not an error.
        let from = self.origin + self.now.0;
        let lean = self.blow(wind, step);
        let turned = leaning(lean, self.now.1);
        let before = self.now.0;
        self.proceed(dt);
        let mut moved = self.now.0 - before;
        if lean.is_some() {
            moved += self.blown * dt;
        }
        let rotation = leaning(lean, self.now.1);
        // This is the share of an error that is corrected in this step (implicit Euler).
        let k = dt / (dt + compliance);
        let linear = (moved + (from - com) * k) / dt - step.sag;
        let away = turned * body.rotation().inverse();
        let angular = (vector(rotation * turned.inverse()) + vector(away) * k) / dt;
        let (linear, angular) = if self.free < 8.0 * compliance {
            let s = 1.0 - math::exp(-self.free / compliance);
            (
                body.linvel() + (linear - body.linvel()) * s,
                body.angvel() + (angular - body.angvel()) * s,
            )
        } else {
            (linear, angular)
        };
        set_velocities(body, linear, angular);
        self.clock < self.path.duration()
    }

    /// Takes on the wind, and returns how far that leans the body.
    #[inline]
    fn blow(&mut self, wind: Option<Vector>, step: &PlayStep) -> Option<Rotation> {
        let (wind, response) = (wind?, step.angle?);
        let wind = if wind.is_finite() { wind } else { Vector::ZERO };
        self.blown += (wind - self.blown) * (step.dt / (response.delay + step.dt));
        self.origin += self.blown * step.dt;
        Some(response.lean(self.blown))
    }

    /// Moves on along the path.
    #[inline]
    fn proceed(&mut self, dt: Real) {
        self.clock += dt;
        let key = self.path.at(self.clock);
        self.now = (
            self.turn * key.position,
            self.turn * key.attitude * self.to_plate,
        );
    }

    /// Lets the path go through a point at the present time.
    fn anchor(&mut self, com: Vector) {
        self.origin = com - self.now.0;
    }
}

/// Sets velocities, but for those that are no numbers: rapier never gets any.
#[inline]
fn set_velocities(body: &mut RigidBody, linear: Vector, angular: Vector) {
    if (linear + angular).is_finite() {
        body.set_linvel(linear, true);
        body.set_angvel(angular, true);
    }
}

/// A rotation that the wind leans.
#[inline]
fn leaning(lean: Option<Rotation>, rotation: Rotation) -> Rotation {
    lean.map_or(rotation, |lean| lean * rotation)
}

/// Whether a body touches another.
#[inline]
pub(super) fn touches(body: &RigidBody, narrow_phase: &NarrowPhase) -> bool {
    body.colliders().iter().any(|collider| {
        narrow_phase
            .contact_pairs_with(*collider)
            .any(|pair| pair.has_any_active_contact())
    })
}

/// Rotation vector of a rotation, to fifth order in its angle.
#[inline]
fn vector(rotation: Rotation) -> Vector {
    let part = Vector::new(rotation.x, rotation.y, rotation.z);
    let s2 = part.length_squared();
    let sign = if rotation.w < 0.0 { -2.0 } else { 2.0 };
    part * (sign * (1.0 + s2 / 6.0 + 0.075 * s2 * s2))
}
