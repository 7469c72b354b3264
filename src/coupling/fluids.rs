//! What the bodies of an immersion are in, set and asked by its user.

use super::admission::renew_constants;
use super::immersion::Immersion;
use crate::flow::Flow;
use crate::fluid::Fluid;
use crate::free_surface::FreeSurface;
use crate::medium::{Layer, Medium};
use crate::turbulence::TurbulentLayer;
use std::sync::Arc;

impl Immersion {
    /// The fluid; of several layers the uppermost.
    pub fn fluid(&self) -> &Fluid {
        &self.environment.medium.layers()[0].fluid
    }

    /// What the bodies are in.
    pub fn medium(&self) -> &Medium {
        &self.environment.medium
    }

    /// Puts all bodies into another fluid, from the next step on, with the flow and turbulence that there are; of
    /// several layers those of the uppermost. Bodies go on with the velocities that they have, and
    /// sleeping ones wake. [`Immersion::forces`] are those in the new fluid at once.
    pub fn set_fluid(&mut self, fluid: Fluid) {
        let uppermost = self.environment.medium.layers()[0].clone();
        self.set_medium(Layer { fluid, ..uppermost });
    }

    /// Puts all bodies into another medium, with its flows and its turbulence, from the next step on; the rest as
    /// [`Immersion::set_fluid`].
    pub fn set_medium(&mut self, medium: impl Into<Medium>) {
        self.environment.set_medium(medium.into());
        self.warn_of_medium();
        self.constants.clear();
        self.registry.forget_constants();
        // What cannot be immersed is refused, and reported, with the next step.
        let _ = renew_constants(&mut self.registry, &mut self.constants, &self.environment);
    }

    /// Sets the velocity field of the fluid; of several layers that of the uppermost: the wind.
    ///
    /// ```
    /// use rapier3d_immersed::flow::Uniform;
    /// use rapier3d_immersed::{Fluid, Immersion};
    ///
    /// let mut immersion = Immersion::new(Fluid::AIR);
    /// immersion.set_flow(Uniform::new(2.0, 0.0, 0.0)); // a breeze along +x
    /// ```
    pub fn set_flow(&mut self, flow: impl Flow + 'static) {
        self.set_flow_of(0, flow);
    }

    /// Sets the velocity field of one layer of the medium, counted from the uppermost: that of layer 1 is the current
    /// of the water under air. A layer that the medium has not is no error.
    pub fn set_flow_of(&mut self, layer: usize, flow: impl Flow + 'static) {
        self.environment.set_flow(layer, Arc::new(flow));
    }

    /// Lets all fluids rest, but for their turbulence and the waves: the same as a flow that is zero everywhere.
    pub fn clear_flow(&mut self) {
        for layer in 0..self.environment.medium.layers().len() {
            if self.environment.medium.layers()[layer].flow.is_some() {
                self.environment.come_to_rest(layer);
            }
        }
    }

    /// Sets the surface between the first two fluids, as the waves of one that was at rest: the bodies' own constants stay, so
    /// that after a snapshot, which leaves the surface out as it does the flow, bodies go on bit by bit.
    ///
    /// ```
    /// use rapier3d_immersed::free_surface::{Dispersion, Wave, Waves};
    /// use rapier3d_immersed::{Fluid, Immersion, Medium};
    ///
    /// let mut immersion = Immersion::new(Medium::layered(Fluid::AIR, Fluid::WATER));
    /// immersion.set_surface(Waves::new(Dispersion::default(), &[Wave::default()])?);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn set_surface(&mut self, surface: impl FreeSurface + 'static) {
        self.environment.medium.set_surface(Arc::new(surface));
    }

    /// Adds turbulence to the mean flow; of several layers to that of the uppermost. Its fluctuations differ from body to
    /// body.
    ///
    /// A [`Turbulence`](crate::turbulence::Turbulence) acts as the fluctuating velocity of the fluid
    /// that a body sees, with seed 0; [`TurbulentLayer`] chooses otherwise.
    ///
    /// ```
    /// use rapier3d_immersed::turbulence::{Turbulence, TurbulenceState};
    /// use rapier3d_immersed::{Fluid, Immersion};
    ///
    /// let mut immersion = Immersion::new(Fluid::AIR);
    /// immersion.set_turbulence(Turbulence::Homogeneous(TurbulenceState {
    ///     kinetic_energy: 0.1, // m²/s²
    ///     dissipation: 0.05,   // m²/s³
    /// }));
    /// ```
    pub fn set_turbulence(&mut self, turbulence: impl Into<TurbulentLayer>) {
        self.set_turbulence_of(0, turbulence);
    }

    /// Adds turbulence to the flow of one layer of the medium, counted from the uppermost. A layer that the medium has
    /// not is no error.
    pub fn set_turbulence_of(&mut self, layer: usize, turbulence: impl Into<TurbulentLayer>) {
        if let Some(own) = self.environment.medium.layers_mut().get_mut(layer) {
            own.turbulence = Some(turbulence.into());
        }
    }

    /// Ends the turbulence of all layers.
    pub fn clear_turbulence(&mut self) {
        for state in self.registry.iter_mut() {
            state.flight.turbulence = Default::default();
        }
        for layer in 0..self.environment.medium.layers().len() {
            let own = &mut self.environment.medium.layers_mut()[layer];
            let ended = own.turbulence.take().is_some();
            if own.flow.is_none() && ended {
                self.environment.come_to_rest(layer);
            }
        }
    }
}
