//! What the bodies of an immersion are in, and how it moves.

use super::registry::SWEEP;
#[cfg(feature = "serde-serialize")]
use crate::error::Error;
use crate::flow::{Flow, FlowSample, Still};
use crate::medium::Medium;
use rapier3d::math::Vector;
use std::sync::Arc;

/// The medium and the time.
#[derive(Clone)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct Environment {
    pub medium: Medium,
    /// Seconds that the set has been stepped while it was enabled.
    pub time: f64,
    /// Number of steps so far: the noise of a step depends on it.
    pub steps: u64,
    /// Gravity in the last step, m/s²: the read-out uses it.
    pub gravity: Vector,
    /// Steps after which a layer's fluid that comes to rest needs no looking at any more.
    resting_in: [u32; Medium::MOST_LAYERS],
}

impl Environment {
    pub fn new(medium: Medium) -> Self {
        Self {
            medium,
            time: 0.0,
            steps: 0,
            gravity: Vector::ZERO,
            resting_in: [0; Medium::MOST_LAYERS],
        }
    }

    /// Changes the medium.
    pub fn set_medium(&mut self, medium: Medium) {
        self.medium = medium;
        self.resting_in = [0; Medium::MOST_LAYERS];
    }

    /// Sets the flow of a layer, if there is such a one.
    pub fn set_flow(&mut self, layer: usize, flow: Arc<dyn Flow>) {
        if let Some(own) = self.medium.layers_mut().get_mut(layer) {
            own.flow = Some(flow);
            self.resting_in[layer] = 0;
        }
    }

    /// Ends the flow of a layer. For as many steps as it takes to look at every body it is a flow of zero, because
    /// bodies feel that the fluid is slowed down, and sleeping ones may wake.
    pub fn come_to_rest(&mut self, layer: usize) {
        if let Some(own) = self.medium.layers_mut().get_mut(layer) {
            own.flow = Some(Arc::new(Still));
            self.resting_in[layer] = SWEEP + 1;
        }
    }

    /// After loading: a fluid that was coming to rest goes on doing so.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    #[cfg(feature = "serde-serialize")]
    pub fn restore(&mut self) -> Result<(), Error> {
        for (layer, left) in self.medium.layers_mut().iter_mut().zip(self.resting_in) {
            let most = f64::from(SWEEP + 1);
            Error::check_range("steps until a fluid rests", left.into(), 0.0, most)?;
            if left > 0 {
                layer.flow = Some(Arc::new(Still));
            }
        }
        Ok(())
    }

    /// Counts a step; whether some fluid was coming to rest and none moves from now on.
    pub fn rests_now(&mut self) -> bool {
        let mut ended = false;
        let layers = self.medium.layers_mut().iter_mut();
        for (layer, left) in layers.zip(&mut self.resting_in) {
            if *left > 0 {
                *left -= 1;
                if *left == 0 {
                    layer.flow = None;
                    ended = true;
                }
            }
        }
        ended && self.medium.is_still()
    }

    /// The layer that a point is in now.
    pub fn layer_at(&self, point: Vector) -> usize {
        self.medium.layer_at(point, self.time)
    }

    /// Density at a point, kg/m³; `None` where there is one fluid alone.
    pub fn density_at(&self, point: Vector) -> Option<f64> {
        if !self.medium.has_surface() {
            return None;
        }
        let layer = self.medium.layers().get(self.layer_at(point))?;
        Some(layer.fluid.density().into())
    }

    /// The mean flow of a layer's fluid at a point now.
    pub fn mean_flow(&self, layer: usize, point: Vector) -> FlowSample {
        self.medium.flow_at(layer, point, self.time)
    }
}
