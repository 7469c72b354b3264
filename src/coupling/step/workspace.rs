//! What passes between the stages of a step, and the memory for it, which is reused from step to step.

use super::mean_motion::MeanMotion;
use super::substep_matching::SubstepScheme;
use crate::coupling::body_state::{BodyState, FlightState, IntegratorState, TurbulenceMemory};
use crate::coupling::shared_constants::{ConstantsTable, Route};
use crate::dynamics::Integrator;
use crate::flow::FlowSample;
use crate::hydro::viscous::ForceFactors;
use crate::math::{Row, row, vector};
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
    /// Is in contact or held, so that rapier may let it sleep.
    pub may_sleep: bool,
    /// Is in contact; is held by joints.
    pub in_contact: bool,
    pub jointed: bool,
    /// Is a link of a multibody, whose velocity cannot be set.
    pub linked: bool,
    /// Whether its joints can do no work.
    pub workless: bool,
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
    /// Whether a user's torque turns the body.
    pub has_torque: bool,
    /// What rapier has: attitude (plate axes to world, a quaternion) and velocities.
    pub rapier_attitude: Row,
    pub rapier_linear: Row,
    pub rapier_angular: Row,
}

/// What acts on a body besides fluid and gravity. Most bodies have none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::coupling) struct Disturbance {
    /// Velocities that come on top of what was integrated: what happened to the body since, or all of
    /// its velocity. m/s and rad/s.
    pub linear: Row,
    pub angular: Row,
    /// User's force, with that of the constraints as far as the step counts on it, N, and torque, N·m.
    pub force: Row,
    pub torque: Row,
    /// Impulse of the constraints that the step counts on, N·s.
    pub impulse: Row,
}

impl Disturbance {
    pub const NONE: Self = Self {
        linear: [0.0; 4],
        angular: [0.0; 4],
        force: [0.0; 4],
        torque: [0.0; 4],
        impulse: [0.0; 4],
    };
}

/// The flow that a body sees. World axes.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::coupling) struct SeenFlow {
    /// Velocity of the fluid, m/s; that of the last step until the flow has been sampled.
    pub velocity: Row,
    /// Its vorticity, 1/s.
    pub vorticity: Row,
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

    /// Goes on to this step's flow; says whether that is a number. Where it is not, the fluid stays as it
    /// was.
    #[inline(always)]
    pub fn advance(&mut self, sample: &FlowSample) -> bool {
        let finite = (sample.velocity + sample.vorticity).is_finite();
        if finite {
            if self.known_before {
                self.change = row(sample.velocity - vector(self.velocity));
            }
            self.velocity = row(sample.velocity);
            self.vorticity = row(sample.vorticity);
        }
        finite
    }
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
    /// Index in `held` of a body that is held but not in contact, `NONE` for others.
    pub held: u32,
}

/// A held body before rapier's step. World axes unless said otherwise.
#[derive(Clone, Copy)]
pub(in crate::coupling) struct HeldStart {
    pub attitude: Rotation,
    pub linear: Vector,
    pub angular: Vector,
    /// Changes of the velocities that rapier will cause if the constraints do as expected.
    pub expected_change: Vector,
    pub expected_turn: Vector,
    /// The impulse that is expected of them, N·s.
    pub impulse: Vector,
    /// Velocities that were integrated, plate axes, relative to the fluid.
    pub own_linear: Vector,
    pub own_angular: Vector,
    pub fluid_velocity: Vector,
    pub locks: LockedAxes,
    pub jointed: bool,
    /// Whether it flies freely all the same, its joints being slack.
    pub flies: bool,
    /// Weight, buoyancy and user's force, N, and their torque, N·m.
    pub load_force: Vector,
    pub load_torque: Vector,
    /// Whether the fluid's velocity is that of the last step.
    pub steady: bool,
    /// Whether its joints can do no work.
    pub workless: bool,
    /// Whether its velocity may be set: rapier overwrites those of multibodies' links.
    pub settable: bool,
}

/// Bodies of one route that are moved together.
#[derive(Clone, Default)]
pub(in crate::coupling) struct Batch {
    pub inputs: Vec<StepInput>,
    pub disturbances: Vec<Disturbance>,
    /// Where the bodies are (centers of mass) and the flow that they see; empty where nothing flows.
    pub points: Vec<Vector>,
    pub flows: Vec<SeenFlow>,
    /// What the bodies remember of the turbulence; empty where there is none.
    pub turbulence: Vec<TurbulenceMemory>,
    /// What the integration makes of the inputs.
    pub outputs: Vec<StepOutput>,
}

impl Batch {
    /// Number of bodies that are moved together: few enough to be still in the cache when they are
    /// written back, many enough for threads to share.
    const SIZE: usize = if cfg!(feature = "parallel") {
        16384
    } else {
        256
    };

    pub fn is_full(&self) -> bool {
        self.inputs.len() >= Self::SIZE
    }

    pub fn clear(&mut self) {
        self.inputs.clear();
        self.disturbances.clear();
        self.points.clear();
        self.flows.clear();
        self.turbulence.clear();
    }
}

/// What the bodies of a batch have in common.
#[derive(Clone, Copy)]
pub(in crate::coupling) struct Batched<'a> {
    pub states: &'a [Option<BodyState>],
    pub constants: &'a ConstantsTable,
    pub disturbances: &'a [Disturbance],
    pub context: &'a StepContext,
}

impl<'a> Batched<'a> {
    /// The motion that a body keeps from step to step.
    #[inline(always)]
    pub fn motion(&self, input: &StepInput) -> &'a IntegratorState {
        let state = self.states.get(input.state as usize);
        let state = state.and_then(Option::as_ref);
        state.map_or(&IntegratorState::REST, |state| &state.flight.motion)
    }

    /// What disturbs a body.
    #[inline(always)]
    pub fn disturbance(&self, input: &StepInput) -> &'a Disturbance {
        let disturbance = self.disturbances.get(input.disturbance as usize);
        disturbance.unwrap_or(&Disturbance::NONE)
    }
}

/// Which bodies are close to something.
#[derive(Clone, Default)]
pub(in crate::coupling) struct CloseBodies {
    /// By index of the body's state, unless the world is `crowded`.
    pub marked: Vec<bool>,
    pub crowded: bool,
}

impl CloseBodies {
    /// Whether the body's pairs have to be asked for.
    pub fn contains(&self, state: usize) -> bool {
        self.crowded || self.marked.get(state).is_some_and(|marked| *marked)
    }
}

/// What a step works in.
#[derive(Clone, Default)]
pub(in crate::coupling) struct Workspace {
    /// Bodies that are about to be moved, by route.
    pub batches: [Batch; Route::COUNT],
    pub close: CloseBodies,
    /// What the bodies had before the step: filled by `before_step`, emptied by `after_step`.
    pub saved_forces: Vec<SavedForces>,
    pub held: Vec<HeldStart>,
    pub moved_by_mean: Vec<MeanMotion>,
    pub samples: Vec<FlowSample>,
    /// Which bodies this step moves, and which the last one moved, by the index of their state: ones, as bytes
    /// that compare fast.
    pub moved: Vec<u8>,
    pub moved_before: Vec<u8>,
    /// Indices of the states of bodies that their users have changed, which are not moved yet.
    pub changed: Vec<u32>,
    /// Bodies at which the flow was no number in this step.
    pub bad_flows: Vec<RigidBodyHandle>,
}

impl Workspace {
    /// Makes room for marking which of so many bodies a step moves.
    pub fn begin_marks(&mut self, bodies: usize) {
        std::mem::swap(&mut self.moved, &mut self.moved_before);
        self.moved.clear();
        self.moved.resize(bodies, 0);
    }

    /// Indices of the bodies that the last step moved and this one does not.
    pub fn missed(&self) -> impl Iterator<Item = usize> {
        let both = self.moved_before.iter().zip(&self.moved);
        let missed = both.enumerate().filter(|(_, (before, now))| *before > *now);
        missed.map(|(index, _)| index)
    }

    /// Forgets what the bodies had before the step.
    pub fn forget_bodies(&mut self) {
        self.saved_forces.clear();
        self.held.clear();
        self.moved_by_mean.clear();
    }
}
