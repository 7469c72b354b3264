//! Systems of bodies that joints connect, found anew in each step.
//!
//! Joints without motors only pass energy on, between the bodies of a system, so that what a system has is
//! known where the share of one body is not (see [`energy_budget`](super::energy_budget)).

use crate::coupling::body_state::NONE;
use crate::coupling::rapier_sets::RapierSets;
use crate::coupling::registry::Registry;
use rapier3d::dynamics::{
    GenericJoint, ImpulseJointHandle, JointAxesMask, JointAxis, MotorModel, RigidBody,
    RigidBodyHandle, RigidBodySet,
};
use rapier3d::math::Real;

/// The jointed bodies of a step, by the systems that they form.
#[derive(Clone, Default)]
pub(in crate::coupling) struct JointedSystems {
    /// Number of a body among the jointed ones, by index of its state; `NONE` of the others.
    numbers: Vec<u32>,
    /// Index of the state, by number.
    states: Vec<u32>,
    /// Another body of the system, by number; a body that names itself is the system's first.
    parents: Vec<u32>,
    /// What is known of a system, at its first body.
    kinds: Vec<SystemKind>,
    /// The springs, each with a body that it holds.
    springs: Vec<(u32, ImpulseJointHandle, Real)>,
}

/// A body that joints hold.
#[derive(Clone, Copy)]
pub(in crate::coupling) struct Jointed {
    pub number: u32,
    /// Whether a spring swings too fast for the step: its last pull says nothing about the next.
    pub unresolved: bool,
}

/// `k dt²/m` from which on a step does not resolve a spring: a tenth of its period, (2π/10)².
const STIFF: Real = 0.4;

/// What is known of a system.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::coupling) struct SystemKind {
    /// Whether something may give it energy: motors, bodies that a user moves, or that are not in the fluid,
    /// contacts.
    pub driven: bool,
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
}

impl JointedSystems {
    /// Begins a step with so many states.
    pub fn clear(&mut self, states: usize) {
        for state in self.states.drain(..) {
            if let Some(number) = self.numbers.get_mut(state as usize) {
                *number = NONE;
            }
        }
        if self.numbers.len() != states {
            self.numbers.resize(states, NONE);
        }
        self.parents.clear();
        self.kinds.clear();
        self.springs.clear();
    }

    /// Number of bodies.
    pub fn len(&self) -> usize {
        self.parents.len()
    }

    /// The first body of the system of a body.
    pub fn first(&mut self, mut number: u32) -> u32 {
        loop {
            let parent = self.parents[number as usize];
            if parent == number {
                return number;
            }
            // Halves the way for those who ask later.
            let next = self.parents[parent as usize];
            self.parents[number as usize] = next;
            number = next;
        }
    }

    /// The same where nothing is to be changed.
    pub fn first_of(&self, mut number: u32) -> u32 {
        while self.parents[number as usize] != number {
            number = self.parents[number as usize];
        }
        number
    }

    /// What is known of the system whose first body is `first`.
    pub fn kind(&self, first: u32) -> SystemKind {
        self.kinds[first as usize]
    }

    /// Potential energies of the springs before the step, and the systems that have them.
    pub fn springs(&self) -> &[(u32, ImpulseJointHandle, Real)] {
        &self.springs
    }

    /// Something else than the joints acts on a body's system.
    pub fn drive(&mut self, number: u32) {
        self.mark(number, |kind| kind.driven = true);
    }

    fn mark(&mut self, number: u32, mark: impl FnOnce(&mut SystemKind)) {
        let first = self.first(number);
        mark(&mut self.kinds[first as usize]);
    }

    fn number(&mut self, state: usize) -> u32 {
        if self.numbers[state] == NONE {
            self.numbers[state] = self.parents.len() as u32;
            self.states.push(state as u32);
            self.parents.push(self.numbers[state]);
            self.kinds.push(SystemKind::default());
        }
        self.numbers[state]
    }

    fn connect(&mut self, a: u32, b: u32) {
        let (a, b) = (self.first(a), self.first(b));
        if a != b {
            let other = self.kinds[b as usize];
            let kind = &mut self.kinds[a as usize];
            kind.driven |= other.driven;
            kind.anchored |= other.anchored;
            kind.sprung |= other.sprung;
            kind.linked |= other.linked;
            self.parents[b as usize] = a;
        }
    }

    /// Looks at the joints of a body; `None` if none is enabled.
    pub fn enter(
        &mut self,
        state: usize,
        handle: RigidBodyHandle,
        sets: &RapierSets,
        registry: &Registry,
    ) -> Option<Jointed> {
        let mut number = None;
        let mut unresolved = false;
        for (first, second, joint_handle, joint) in
            sets.impulse_joints.attached_enabled_joints(handle)
        {
            let own = *number.get_or_insert_with(|| self.number(state));
            let other = if first == handle { second } else { first };
            let met = self.meet(own, other, sets, registry);
            if joint.data.motor_axes.is_empty() {
                continue;
            }
            let stiffness = joint.data.motors[JointAxis::LinX as usize].stiffness;
            let dt = sets.integration_parameters.dt;
            let mass = sets.bodies.get(handle).map_or(0.0, RigidBody::mass);
            unresolved |= stiffness * dt * dt > STIFF * mass;
            if !is_spring(&joint.data) {
                self.drive(own);
            } else if first == handle || met != Other::Member {
                let energy = spring_energy(&joint.data, sets.bodies, [first, second]);
                self.springs.push((own, joint_handle, energy));
                self.mark(own, |kind| kind.sprung = true);
            }
        }
        if let Some(id) = sets.multibody_joints.rigid_body_link(handle)
            && let Some(multibody) = sets.multibody_joints.get_multibody(id.multibody)
            && let Some(link) = multibody.link(id.id)
        {
            let own = *number.get_or_insert_with(|| self.number(state));
            self.mark(own, |kind| kind.linked = true);
            let above = link.parent_id().and_then(|id| multibody.link(id));
            if let Some(above) = above {
                self.meet(own, above.rigid_body_handle(), sets, registry);
                let springs = (0..6).any(|axis| link.joint().spring(axis).0 != 0.0);
                if !link.joint().data.motor_axes.is_empty() || springs {
                    self.drive(own);
                }
            }
        }
        number.map(|number| Jointed { number, unresolved })
    }

    /// Takes the body at the other end of a joint into account.
    fn meet(
        &mut self,
        own: u32,
        other: RigidBodyHandle,
        sets: &RapierSets,
        registry: &Registry,
    ) -> Other {
        let Some(body) = sets.bodies.get(other) else {
            return Other::Fixed;
        };
        if !body.is_dynamic() {
            let still = body.is_fixed() || stands_still(body);
            self.mark(own, |kind| {
                kind.anchored = true;
                kind.driven |= !still;
            });
            return Other::Fixed;
        }
        match registry.index(other).filter(|index| registry.moves(*index)) {
            Some(index) => {
                let other = self.number(index);
                self.connect(own, other);
                Other::Member
            }
            None => {
                self.drive(own);
                Other::Foreign
            }
        }
    }
}

/// What a body at the other end of a joint is.
#[derive(Clone, Copy, PartialEq)]
enum Other {
    Fixed,
    Member,
    Foreign,
}

fn stands_still(body: &RigidBody) -> bool {
    body.linvel().length_squared() + body.angvel().length_squared() == 0.0
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
pub(super) fn spring_energy(
    joint: &GenericJoint,
    bodies: &RigidBodySet,
    ends: [RigidBodyHandle; 2],
) -> Real {
    let motor = &joint.motors[JointAxis::LinX as usize];
    let anchors = [joint.local_anchor1(), joint.local_anchor2()];
    let at = |i: usize| bodies.get(ends[i]).map(|body| body.position() * anchors[i]);
    let (Some(a), Some(b)) = (at(0), at(1)) else {
        return 0.0;
    };
    let stretch = (b - a).length() - motor.target_pos;
    0.5 * motor.stiffness * stretch * stretch
}
