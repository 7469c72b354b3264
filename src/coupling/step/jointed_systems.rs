//! Systems of bodies that joints connect, found anew in each step.
//!
//! Joints without motors, or with such as only brake, pass energy on between the bodies of a system and add
//! none, so that what a system has is known where the share of one body is not (see [`energy_budget`](super::energy_budget)).

use crate::coupling::body_state::NONE;
use crate::coupling::rapier_sets::RapierSets;
use crate::coupling::registry::Registry;
use rapier3d::dynamics::{
    GenericJoint, ImpulseJoint, ImpulseJointHandle, JointAxesMask, JointAxis, MotorModel,
    RigidBody, RigidBodyHandle, RigidBodySet,
};
use rapier3d::math::{Real, Vector};

/// The jointed bodies of a step, by the systems that they form.
#[derive(Clone, Default)]
pub(in crate::coupling) struct JointedSystems {
    /// Number of a body among the jointed ones, by index of its state; `NONE` of the others.
    numbers: Vec<u32>,
    /// The bodies, by number.
    members: Vec<Member>,
    springs: Vec<Spring>,
}

#[derive(Clone, Copy)]
struct Member {
    /// Index of its state.
    state: u32,
    /// Another body of its system, by number; the first of a system names itself.
    parent: u32,
    unresolved: bool,
    /// What is known of the system, at its first body.
    kind: SystemKind,
}

/// A spring, one of the bodies that it holds, and what it stores before the step, J.
#[derive(Clone, Copy)]
pub(in crate::coupling) struct Spring {
    pub body: u32,
    pub joint: ImpulseJointHandle,
    pub energy: Real,
}

/// A body that joints hold.
#[derive(Clone, Copy)]
pub(in crate::coupling) struct Jointed {
    /// Its number among those that joints hold.
    pub number: u32,
    /// Whether a spring swings too fast for the step: its last pull says nothing about the next.
    pub unresolved: bool,
    /// Whether its system has motors.
    pub motorised: bool,
}

/// `k dt²/m` from which on a step does not resolve a spring: a tenth of its period, (2π/10)².
const STIFF: Real = 0.4;

/// What is known of a system.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::coupling) struct SystemKind {
    /// Whether something may give it energy: motors, bodies that a user moves, or that are not in the fluid,
    /// contacts.
    pub driven: bool,
    /// Whether it has motors that do more than brake.
    pub motorised: bool,
    /// Whether it hangs on something that stands still.
    pub anchored: bool,
    /// Whether it has springs.
    pub sprung: bool,
    /// Whether there are links of multibodies in it.
    pub linked: bool,
}

impl SystemKind {
    /// Whose sums those of a body belong to: its own, or those of the system's first body.
    pub fn sum_of(self, number: u32, first: u32) -> u32 {
        if self.driven && !self.linked {
            number
        } else {
            first
        }
    }

    fn join(&mut self, other: Self) {
        self.driven |= other.driven;
        self.motorised |= other.motorised;
        self.anchored |= other.anchored;
        self.sprung |= other.sprung;
        self.linked |= other.linked;
    }
}

/// What a body at the end of a joint is.
#[derive(Clone, Copy)]
enum End {
    /// In the fluid and awake: its number.
    Member(u32),
    /// Does not move, or is asleep.
    Still,
    /// Moves otherwise.
    Foreign,
}

impl JointedSystems {
    /// Forgets the bodies of the last step.
    pub fn clear(&mut self) {
        for member in self.members.drain(..) {
            if let Some(number) = self.numbers.get_mut(member.state as usize) {
                *number = NONE;
            }
        }
        self.springs.clear();
    }

    /// Looks at all joints.
    pub fn find(&mut self, sets: &RapierSets, registry: &Registry) {
        self.clear();
        self.find_others(sets, registry);
    }

    /// The same when bodies have entered the fluid since; those that are known keep their numbers.
    pub fn find_others(&mut self, sets: &RapierSets, registry: &Registry) {
        self.springs.clear();
        self.numbers.resize(registry.states().len(), NONE);
        for (handle, joint) in sets.impulse_joints.iter() {
            if joint.data.is_enabled() {
                let bodies = [joint.body1(), joint.body2()];
                let ends = bodies.map(|body| self.end(body, sets, registry));
                self.connect(ends);
                self.drive_by(handle, joint, ends, sets);
            }
        }
        for multibody in sets.multibody_joints.multibodies() {
            for link in multibody.links() {
                let own = self.end(link.rigid_body_handle(), sets, registry);
                let above = link.parent_id().and_then(|id| multibody.link(id));
                let above = above.map(|above| self.end(above.rigid_body_handle(), sets, registry));
                self.connect([own, above.unwrap_or(own)]);
                if let End::Member(own) = own {
                    let joint = link.joint();
                    let springs = (0..6).any(|axis| joint.spring(axis).0 != 0.0);
                    self.mark(own, |kind| {
                        kind.linked = true;
                        kind.motorised |= springs || !only_brakes(&joint.data);
                        kind.driven |= kind.motorised;
                    });
                }
            }
        }
    }

    /// A body's place among the jointed ones; `None` if no joint holds it.
    #[inline(always)]
    pub fn get(&self, state: usize) -> Option<Jointed> {
        let number = *self.numbers.get(state)?;
        let member = self.members.get(number as usize)?;
        Some(Jointed {
            number,
            unresolved: member.unresolved,
            motorised: self.system(number).1.motorised,
        })
    }

    /// Number of bodies.
    pub fn len(&self) -> usize {
        self.members.len()
    }

    /// The first body of the system of a body, and what is known of the system.
    pub fn system(&self, mut number: u32) -> (u32, SystemKind) {
        loop {
            let member = &self.members[number as usize];
            if member.parent == number {
                return (number, member.kind);
            }
            number = member.parent;
        }
    }

    /// The springs.
    pub fn springs(&self) -> &[Spring] {
        &self.springs
    }

    /// Something else than the joints acts on a body's system.
    pub fn drive(&mut self, number: u32) {
        self.mark(number, |kind| kind.driven = true);
    }

    fn first(&mut self, mut number: u32) -> u32 {
        loop {
            let parent = self.members[number as usize].parent;
            if parent == number {
                return number;
            }
            // Halves the way for those who ask later.
            let next = self.members[parent as usize].parent;
            self.members[number as usize].parent = next;
            number = next;
        }
    }

    fn mark(&mut self, number: u32, mark: impl FnOnce(&mut SystemKind)) {
        let first = self.first(number);
        mark(&mut self.members[first as usize].kind);
    }

    fn end(&mut self, handle: RigidBodyHandle, sets: &RapierSets, registry: &Registry) -> End {
        let Some(body) = sets.bodies.get(handle) else {
            return End::Still;
        };
        if !body.is_dynamic() {
            let still = body.is_fixed() || (is_at_rest(body) && stays(body));
            return if still { End::Still } else { End::Foreign };
        }
        if body.is_sleeping() {
            return End::Still;
        }
        let Some(state) = registry
            .index(handle)
            .filter(|state| registry.moves(*state))
        else {
            return End::Foreign;
        };
        if self.numbers[state] == NONE {
            let number = self.members.len() as u32;
            self.numbers[state] = number;
            self.members.push(Member {
                state: state as u32,
                parent: number,
                unresolved: false,
                kind: SystemKind::default(),
            });
        }
        End::Member(self.numbers[state])
    }

    fn connect(&mut self, ends: [End; 2]) {
        match ends {
            [End::Member(a), End::Member(b)] => {
                let (a, b) = (self.first(a), self.first(b));
                if a != b {
                    let other = self.members[b as usize].kind;
                    self.members[a as usize].kind.join(other);
                    self.members[b as usize].parent = a;
                }
            }
            [End::Member(own), End::Still] | [End::Still, End::Member(own)] => {
                self.mark(own, |kind| kind.anchored = true);
            }
            [End::Member(own), End::Foreign] | [End::Foreign, End::Member(own)] => {
                self.mark(own, |kind| {
                    kind.driven = true;
                    kind.anchored = true;
                });
            }
            _ => {}
        }
    }

    /// Takes a joint's motors into account.
    fn drive_by(
        &mut self,
        handle: ImpulseJointHandle,
        joint: &ImpulseJoint,
        ends: [End; 2],
        sets: &RapierSets,
    ) {
        if only_brakes(&joint.data) {
            return;
        }
        let dt = sets.integration_parameters.dt;
        let stiffness = joint.data.motors[JointAxis::LinX as usize].stiffness;
        let bodies = [joint.body1(), joint.body2()];
        let mut stored = false;
        for (end, body) in ends.into_iter().zip(bodies) {
            let End::Member(own) = end else {
                continue;
            };
            let mass = sets.bodies.get(body).map_or(0.0, RigidBody::mass);
            self.members[own as usize].unresolved |= stiffness * dt * dt > STIFF * mass;
            if !is_spring(&joint.data) {
                self.mark(own, |kind| {
                    kind.driven = true;
                    kind.motorised = true;
                });
            } else if !stored {
                stored = true;
                self.mark(own, |kind| kind.sprung = true);
                self.springs.push(Spring {
                    body: own,
                    joint: handle,
                    energy: spring_energy(joint, sets.bodies),
                });
            }
        }
    }
}

fn is_at_rest(body: &RigidBody) -> bool {
    body.linvel().length_squared() + body.angvel().length_squared() == 0.0
}

/// Whether the coming step leaves a kinematic body where it is.
fn stays(body: &RigidBody) -> bool {
    body.next_position() == body.position()
}

/// Whether all motors of a joint only brake.
fn only_brakes(joint: &GenericJoint) -> bool {
    let motors = joint.motors.iter().enumerate();
    let mut on = motors.filter(|(axis, _)| joint.motor_axes.bits() >> axis & 1 == 1);
    on.all(|(_, motor)| motor.stiffness == 0.0 && motor.target_vel == 0.0 && motor.damping >= 0.0)
}

/// Whether a joint's motor is a spring along the line between its anchors, as
/// [`SpringJoint`](rapier3d::dynamics::SpringJoint) makes it.
fn is_spring(joint: &GenericJoint) -> bool {
    let motor = &joint.motors[JointAxis::LinX as usize];
    joint.motor_axes == JointAxesMask::LIN_X
        && joint.coupled_axes == JointAxesMask::LIN_AXES
        && motor.model == MotorModel::ForceBased
        && motor.target_vel == 0.0
        && motor.damping >= 0.0
}

/// `½k(l − l₀)²`, J.
pub(super) fn spring_energy(joint: &ImpulseJoint, bodies: &RigidBodySet) -> Real {
    let motor = &joint.data.motors[JointAxis::LinX as usize];
    let end = |body: RigidBodyHandle, anchor: Vector| {
        let body = bodies.get(body);
        body.map(|body| body.position() * anchor)
    };
    let a = end(joint.body1(), joint.data.local_anchor1());
    let b = end(joint.body2(), joint.data.local_anchor2());
    let (Some(a), Some(b)) = (a, b) else {
        return 0.0;
    };
    let stretch = (b - a).length() - motor.target_pos;
    0.5 * motor.stiffness * stretch * stretch
}
