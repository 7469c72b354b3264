//! The fluid that the bodies of an immersion are in, and how it moves.

use super::registry::SWEEP;
use crate::flow::{Flow, FlowSample, Still};
use crate::fluid::Fluid;
use crate::turbulence::TurbulentLayer;
use rapier3d::math::Vector;
use std::sync::Arc;

/// The fluid, its flow, and the time.
#[derive(Clone)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct Environment {
    pub fluid: Fluid,
    /// Seconds that the set has been stepped while it was enabled.
    pub time: f64,
    /// Number of steps so far: the noise of a step depends on it.
    pub steps: u64,
    /// Gravity in the last step, m/s²: the read-out uses it.
    pub gravity: Vector,
    /// The velocity field; `None` is a fluid at rest. Not part of a snapshot: set it again.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub flow: Option<Arc<dyn Flow>>,
    /// The turbulence on top of it. Not part of a snapshot either; what bodies remember of it is.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub turbulence: Option<TurbulentLayer>,
    /// Steps after which a fluid that comes to rest needs no looking at any more.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    resting_in: u32,
}

impl Environment {
    /// A fluid at rest.
    pub fn new(fluid: Fluid) -> Self {
        Self {
            fluid,
            time: 0.0,
            steps: 0,
            gravity: Vector::ZERO,
            flow: None,
            turbulence: None,
            resting_in: 0,
        }
    }

    /// Sets the flow.
    pub fn set_flow(&mut self, flow: Arc<dyn Flow>) {
        self.flow = Some(flow);
        self.resting_in = 0;
    }

    /// Ends the flow. For as many steps as it takes to look at every body it is a flow of zero, because
    /// bodies feel that the fluid is slowed down, and sleeping ones may wake.
    pub fn come_to_rest(&mut self) {
        self.flow = Some(Arc::new(Still));
        self.resting_in = SWEEP + 1;
    }

    /// Counts a step; whether the fluid, which was coming to rest, rests from now on and has no turbulence.
    pub fn rests_now(&mut self) -> bool {
        if self.resting_in == 0 {
            return false;
        }
        self.resting_in -= 1;
        if self.resting_in == 0 {
            self.flow = None;
        }
        self.resting_in == 0 && self.turbulence.is_none()
    }

    /// Whether the fluid moves at all.
    pub fn moves(&self) -> bool {
        self.flow.is_some() || self.turbulence.is_some()
    }

    /// The mean flow at a point now.
    pub fn mean_flow(&self, point: Vector) -> FlowSample {
        match &self.flow {
            Some(flow) => FlowSample {
                velocity: flow.velocity(point, self.time),
                vorticity: flow.vorticity(point, self.time),
                ..FlowSample::default()
            },
            None => FlowSample::default(),
        }
    }
}
