//! The memory that a step works in, reused from step to step.

use super::contact_mass::CloseBodies;
use super::energy_budget::JointedBodies;
use super::mean_motion::MeanMotion;
use super::stage_data::{
    CrossingBody, Disturbance, PartRow, SavedForces, SeenFlow, StepContext, StepInput, StepOutput,
};
use crate::coupling::body_state::{BodyState, IntegratorState};
use crate::coupling::shared_constants::{ConstantsTable, Route};
use crate::coupling::turbulence_memory::TurbulenceMemory;
use crate::flow::FlowSample;
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::math::Vector;
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
    /// The parts of the bodies, one after the other; where they are; and what they remember of the turbulence. Points
    /// and memories are there where flows and turbulence are.
    pub parts: Vec<PartRow>,
    pub part_points: Vec<Vector>,
    pub part_turbulence: Vec<TurbulenceMemory>,
    /// What bodies that are cut have besides, and the layer that each of the parts' points is in; empty on other routes.
    pub crossings: Vec<CrossingBody>,
    pub point_layers: Vec<u8>,
    /// Accelerations of the fluid at those points, m/s².
    pub part_accelerations: Vec<Vector>,
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
        self.parts.clear();
        self.part_points.clear();
        self.part_turbulence.clear();
        self.crossings.clear();
        self.point_layers.clear();
        self.part_accelerations.clear();
    }
}

/// What the bodies of a batch have in common.
#[derive(Clone, Copy)]
pub(in crate::coupling) struct Batched<'a> {
    pub states: &'a [Option<BodyState>],
    pub constants: &'a ConstantsTable,
    pub disturbances: &'a [Disturbance],
    pub parts: &'a [PartRow],
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

/// Points of one layer, and where they stand among others.
#[derive(Clone, Default)]
pub(in crate::coupling) struct LayerPoints {
    pub points: Vec<Vector>,
    pub places: Vec<usize>,
    /// What the fluid does there, now and at the end of the step.
    pub samples: [Vec<FlowSample>; 2],
}

/// What a step works in.
#[derive(Clone, Default)]
pub(in crate::coupling) struct Workspace {
    /// Bodies that are about to be moved, by layer and route: see [`Bin`].
    pub batches: Vec<Batch>,
    pub close: CloseBodies,
    /// What the bodies had before the step: filled by `before_step`, emptied by `after_step`.
    pub saved_forces: Vec<SavedForces>,
    pub jointed: JointedBodies,
    pub moved_by_mean: Vec<MeanMotion>,
    pub samples: Vec<FlowSample>,
    pub part_samples: Vec<FlowSample>,
    /// Which bodies this step moves, and which the last one moved, by the index of their state: ones, as bytes
    /// that compare fast.
    pub moved: Vec<u8>,
    pub moved_before: Vec<u8>,
    /// Indices of the states of bodies that their users have changed, which are not moved yet.
    pub changed: Vec<u32>,
    /// Those of bodies that have got into another layer, and that layer.
    pub sunk: Vec<(u32, usize)>,
    /// Points of one layer among those of parts, and their places.
    pub layer_points: LayerPoints,
    /// Bodies at which the flow was no number in this step.
    pub bad_flows: Vec<RigidBodyHandle>,
}

/// Bodies of one layer of the medium that take the same route: they are moved together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::coupling) struct Bin {
    pub layer: usize,
    pub route: Route,
}

impl Bin {
    /// All bins of a medium of so many layers.
    pub fn all(layers: usize) -> impl Iterator<Item = Self> {
        let of_layer = |layer| Route::all().map(move |route| Self { layer, route });
        (0..layers).flat_map(of_layer)
    }

    /// Index of its batch.
    pub fn index(self) -> usize {
        self.layer * Route::COUNT + self.route.index()
    }
}

impl Workspace {
    /// Makes a batch for each bin of a medium of so many layers.
    pub fn prepare_batches(&mut self, layers: usize) {
        self.batches
            .resize_with(layers * Route::COUNT, Batch::default);
    }

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
        self.jointed.forget();
        self.moved_by_mean.clear();
    }
}
