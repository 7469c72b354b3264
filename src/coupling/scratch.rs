//! Memory that is reused from step to step.

use super::flight::{Extra, Flyer, Landing};
use super::kind::Route;
use super::stir::Stirred;
use super::stream::Stream;
use crate::flow::FlowSample;
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::math::Vector;

/// What a step works in.
#[derive(Clone, Default)]
pub(super) struct Scratch {
    /// Bodies that are about to be moved, by route.
    pub batches: [Batch; Route::COUNT],
    pub landings: Vec<Landing>,
    /// Slots of bodies that are close to something, unless the world is `crowded`.
    pub close: Vec<bool>,
    pub crowded: bool,
    /// Bodies between `before_step` and `after_step`.
    pub borrowed: Vec<Borrowed>,
    pub samples: Vec<FlowSample>,
}

/// Bodies of one route that are moved together.
#[derive(Clone, Default)]
pub(super) struct Batch {
    pub flyers: Vec<Flyer>,
    pub extras: Vec<Extra>,
    /// Where the flyers are (centers of mass) and what flows past them; empty where nothing flows.
    pub points: Vec<Vector>,
    pub streams: Vec<Stream>,
    /// What the flyers remember of the turbulence; empty where there is none.
    pub stirred: Vec<Stirred>,
}

impl Batch {
    pub fn clear(&mut self) {
        self.flyers.clear();
        self.extras.clear();
        self.points.clear();
        self.streams.clear();
        self.stirred.clear();
    }
}

/// What a body was lent for the length of a step.
#[derive(Clone, Copy)]
pub(super) struct Borrowed {
    pub handle: RigidBodyHandle,
    pub slot: u32,
    pub force: Vector,
    pub torque: Vector,
    pub touching: bool,
}
