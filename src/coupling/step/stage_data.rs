//! What passes between the stages of a step, body by body.

use super::substep_matching::SubstepScheme;
use crate::coupling::body_state::{FlightState, IntegratorState};
use crate::coupling::crossing_memory::CrossingMemory;
use crate::dynamics::ForceAndTorque;
use crate::dynamics::Integrator;
use crate::dynamics::gravity_step::GravityStep;
use crate::flow::FlowSample;
use crate::hydro::viscous::ForceFactors;
use crate::math::{Row, row, to_real, vector};
use rapier3d::dynamics::{LockedAxes, RigidBodyHandle};
use rapier3d::math::{Real, Rotation, Vector};

/// How a step is taken.
#[derive(Clone, Copy)]
pub(in crate::coupling) struct StepContext {
    pub dt: Real,
    /// Substeps of rapier's.
    pub substeps: usize,
    pub scheme: SubstepScheme,
    pub gravity: Vector,
    /// Whether there are joints.
    pub joints: bool,
    pub integrator: Integrator,
}

/// How rapier divides the step of a body.
#[derive(Clone, Copy)]
pub(in crate::coupling) struct Substeps {
    pub count: usize,
    /// Length of each, s.
    pub length: Real,
}

impl StepContext {
    /// The substeps that a body takes.
    pub fn substeps_of(&self, input: &StepInput) -> Substeps {
        let count = self.substeps + input.own_substeps as usize;
        Substeps {
            count,
            length: self.dt / count as Real,
        }
    }
}

/// One awake body during one step. World axes unless said otherwise. The rows are vectors, filled up with
/// a zero.
#[derive(Clone, Copy, Debug)]
pub(in crate::coupling) struct StepInput {
    pub handle: RigidBodyHandle,
    /// Indices of the body's state and constants.
    pub state: u32,
    pub constants: u32,
    /// Touches nothing and is held by nothing: velocity and pose are written back exactly.
    pub free: bool,
    /// Is in contact or held.
    pub touching: bool,
    /// Rapier may let it sleep: something holds it, or it rests on a fluid.
    pub may_sleep: bool,
    /// Is in contact; is held by locked axes and nothing else.
    pub in_contact: bool,
    pub locked: bool,
    /// Number among the jointed bodies, `NONE` if no joint holds it.
    pub system: u32,
    /// Is a link of a multibody, whose velocity cannot be set.
    pub linked: bool,
    pub locks: LockedAxes,
    /// Substeps that rapier takes for it beyond those of the others.
    pub own_substeps: u32,
    /// Goes on with the velocity relative to the fluid that was integrated.
    pub continues: bool,
    /// Mass that rapier's solver uses, kg; `new_mass` if rapier has to be told.
    pub solver_mass: Real,
    pub new_mass: bool,
    pub factors: ForceFactors,
    /// Share of the world's gravity that the body feels.
    pub gravity_scale: Real,
    /// Index of the body's [`Disturbance`], `NONE` if it has none.
    pub disturbance: u32,
    /// Index of the first of its parts among those of the batch.
    pub first_part: u32,
    /// Whether a user's torque turns the body.
    pub has_torque: bool,
    /// What rapier has: attitude (plate axes to world, a quaternion) and velocities.
    pub rapier_attitude: Row,
    pub rapier_linear: Row,
    pub rapier_angular: Row,
}

/// What the constraints of a body did in a step, or are expected to do: impulse, N·s, and change of the angular
/// velocity, rad/s; world axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::coupling) struct JointAction {
    pub impulse: Vector,
    pub turn: Vector,
}

/// What acts on a body besides fluid and gravity. Most bodies have none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::coupling) struct Disturbance {
    /// Velocities that come on top of what was integrated: what happened to the body since, or all of
    /// its velocity. m/s and rad/s.
    pub linear: Row,
    pub angular: Row,
    /// User's force, N, and torque, N·m, with those of the constraints as far as the step counts on them.
    pub force: Row,
    pub torque: Row,
    /// What the step counts on the constraints for.
    pub expected: JointAction,
}

impl Disturbance {
    pub const NONE: Self = Self {
        linear: [0.0; 4],
        angular: [0.0; 4],
        force: [0.0; 4],
        torque: [0.0; 4],
        expected: JointAction {
            impulse: Vector::ZERO,
            turn: Vector::ZERO,
        },
    };
}

impl Disturbance {
    /// Gives a body what gravity does to it in a step at once, and takes the loads that cause it out of the step.
    pub fn take(&mut self, step: &GravityStep) {
        let add = |to: &mut Row, change| *to = row(vector(*to) + to_real(change));
        add(&mut self.linear, step.change.linear);
        add(&mut self.angular, step.change.angular);
        add(&mut self.force, -step.load.force);
        add(&mut self.torque, -step.load.torque);
    }
}

/// The flow that a body sees. World axes.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::coupling) struct SeenFlow {
    /// Velocity of the fluid, m/s; that of the last step until the flow has been sampled.
    pub velocity: Row,
    /// Its vorticity, 1/s.
    pub vorticity: Row,
    /// Its rate of strain, 1/s: stretching along the axes, shearing across them.
    pub stretching: Row,
    pub shearing: Row,
    /// Change of its velocity since the last step, m/s; zero for a body that was not in flight then.
    pub change: Row,
    /// Whether the velocity of the last step is known.
    known_before: bool,
}

impl SeenFlow {
    /// What a body remembers of the last step.
    #[inline(always)]
    pub fn before(flight: &FlightState) -> Self {
        Self {
            velocity: row(flight.fluid_velocity),
            known_before: flight.continues,
            ..Self::default()
        }
    }

    /// Whether the fluid strains.
    #[inline(always)]
    pub fn strains(&self) -> bool {
        self.stretching != Row::default() || self.shearing != Row::default()
    }

    /// Goes on to this step's flow; says whether that is a number. Where it is not, the fluid stays as it
    /// was.
    #[inline(always)]
    pub fn advance(&mut self, sample: &FlowSample) -> bool {
        let strain = sample.strain.stretching + sample.strain.shearing;
        let finite = (sample.velocity + sample.vorticity + strain).is_finite();
        if finite {
            if self.known_before {
                self.change = row(sample.velocity - vector(self.velocity));
            }
            self.velocity = row(sample.velocity);
            self.vorticity = row(sample.vorticity);
            self.stretching = row(sample.strain.stretching);
            self.shearing = row(sample.strain.shearing);
        }
        finite
    }
}

/// What goes on at one part of a body. World axes.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::coupling) struct PartRow {
    /// Velocity of the fluid relative to that at the body's center, m/s, and the sine of the deflection.
    pub velocity: Row,
    /// Half the vorticity times L, m/s, and the cosine of the deflection.
    pub spin: Row,
    /// Factors on drag, rotational and translational lift.
    pub factors: Row,
}

/// What a step makes of a [`StepInput`]. World axes unless said otherwise.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::coupling) struct StepOutput {
    /// Motion at the end of the step.
    pub motion: IntegratorState,
    /// Velocities at the end of the step, m/s and rad/s.
    pub end_linear: Row,
    pub end_angular: Row,
    /// Velocities to start from, and the force, N, and torque, N·m, to apply.
    pub start_linear: Row,
    pub start_angular: Row,
    pub force: Row,
    pub torque: Row,
}

/// What a user's body had before the step took its place, to be given back after it.
#[derive(Clone, Copy)]
pub(in crate::coupling) struct SavedForces {
    pub handle: RigidBodyHandle,
    /// Indices of the body's state and constants.
    pub state: u32,
    pub constants: u32,
    pub force: Vector,
    pub torque: Vector,
    /// Whether the body is in contact or held.
    pub touching: bool,
    /// Index in `moved_by_mean` of a body that gets its velocity after the step, `NONE` for others.
    pub mean_motion: u32,
    /// Index in `held` of a jointed body, `NONE` for others.
    pub held: u32,
}

/// A body held by joints or locks before rapier's step. World axes unless said otherwise.
#[derive(Clone, Copy)]
pub(in crate::coupling) struct HeldStart {
    pub handle: RigidBodyHandle,
    /// Index of its state.
    pub state: u32,
    pub attitude: Rotation,
    pub linear: Vector,
    pub angular: Vector,
    /// Changes of the velocities that rapier will cause if the constraints do as expected.
    pub expected_change: Vector,
    pub expected_turn: Vector,
    /// What is expected of them.
    pub expected: JointAction,
    /// Velocities that were integrated, plate axes, relative to the fluid.
    pub own_linear: Vector,
    pub own_angular: Vector,
    pub fluid_velocity: Vector,
    pub locks: LockedAxes,
    /// Number among the jointed bodies.
    pub system: u32,
    /// Whether it flies freely all the same, its joints being slack.
    pub flies: bool,
    /// Weight, buoyancy and user's force, N, and their torque, N·m.
    pub load_force: Vector,
    pub load_torque: Vector,
    /// Whether the fluid's velocity is that of the last step.
    pub steady: bool,
    /// Whether its joints are counted on to turn it: with locked axes, or where a link turns far, what they did
    /// cannot be told from the rest.
    pub learns_turn: bool,
    /// Whether it is a link of a multibody, which gets its velocity from that.
    pub linked: bool,
}

/// A jointed body after rapier's step.
#[derive(Clone, Copy)]
pub(in crate::coupling) struct HeldEnd {
    /// Index of its [`HeldStart`].
    pub start: u32,
    /// Kinetic energy of body and fluid, J, and what it would be without the joints.
    pub energy: Real,
    pub without_joints: Real,
    /// Work of the joints, J.
    pub work: Real,
}

/// One body of a batch that is cut.
#[derive(Clone, Debug)]
pub(in crate::coupling) struct CrossingBody {
    /// The first of the layers that it may be in, and their number.
    pub first: usize,
    pub count: usize,
    /// Parts times layers.
    pub rows: usize,
    /// Center of mass, world axes.
    pub center: Vector,
    /// Inertia before the step, if the body was in a fluid then.
    pub known_mass: bool,
    /// Whether nothing but fluids at rest acts on it.
    pub alone: bool,
    /// Taken from the body's state for the step, and given back with it.
    pub memory: Option<Box<CrossingMemory>>,
    /// Weight, buoyancy and the pressure of accelerating fluids.
    pub load: ForceAndTorque,
}
