//! Factors on the forces of single bodies, and series of them, set by the user of an immersion.

use super::{Immersion, OnContact};
use crate::body::DryMass;
use crate::error::Error;
use crate::hydro::viscous::ForceFactors;
use crate::math::{to_f64, to_quaternion};
use crate::motion::{Codebook, ControlSeries, PlannedFor};
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::pipeline::PhysicsWorld;

impl Immersion {
    /// Multiplies the forces of a body's law, from the next step on (default 1): the control parameters c̃
    /// of the pattern-driven method, as [`FreeBody::control`](crate::FreeBody::control). A series that the
    /// body replays is stopped.
    ///
    /// Unknown handles, and factors that [`ForceFactors::check`] refuses, are ignored.
    ///
    /// ```
    /// use rapier3d_immersed::rapier3d::prelude::*;
    /// use rapier3d_immersed::{Fluid, ForceFactors, HydroProperties, Immersion};
    ///
    /// let mut world = PhysicsWorld::new();
    /// let leaf = ColliderBuilder::cuboid(0.0365, 0.00015, 0.021).density(300.0);
    /// let (leaf, _) = world.insert(RigidBodyBuilder::dynamic(), leaf);
    /// let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, leaf)?;
    /// let mut immersion = Immersion::new(Fluid::AIR);
    /// immersion.insert(leaf, hydro);
    /// immersion.set_control(leaf, ForceFactors { drag: 3.0, ..ForceFactors::ONE });
    /// assert_eq!(immersion.control(leaf).unwrap().drag, 3.0);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn set_control(&mut self, handle: RigidBodyHandle, factors: ForceFactors) {
        if let Some(state) = self.registry.get_mut(handle) {
            state.control.set(factors);
        }
    }

    /// The factors on the forces of a body's law: those that were set or, during a replay, those of the last
    /// step.
    pub fn control(&self, handle: RigidBodyHandle) -> Option<ForceFactors> {
        self.registry.get(handle).map(|state| state.control.factors)
    }

    /// Lets a body replay a series from its beginning, at the next step; after its last entry that one
    /// stays. The body must be what the series was planned for: [`Immersion::replay_planned`] checks that. A body that is held by a joint or has locked axes counts
    /// as touching: under [`OnContact::Restart`] its series begins when it is free, under [`OnContact::Stop`]
    /// it ends at once. Unknown handles are ignored.
    pub fn replay(
        &mut self,
        handle: RigidBodyHandle,
        series: &ControlSeries,
        on_contact: OnContact,
    ) {
        let Some(index) = self.registry.index(handle) else {
            return;
        };
        let states = self.registry.states().iter().flatten();
        let used = || states.filter_map(|state| state.control.series());
        let series = self.series.intern(series.clone(), used);
        if let Some(state) = self.registry.at_mut(index) {
            state.control.replay(series, on_contact);
        }
    }

    /// Stops the series that a body replays: it goes on under its own law. Nothing to stop is no error.
    pub fn stop_replay(&mut self, handle: RigidBodyHandle) {
        if let Some(state) = self.registry.get_mut(handle) {
            state.control.stop();
        }
    }

    /// How far a body has come in the series that it replays, s; `None` if it replays none.
    pub fn replay_time(&self, handle: RigidBodyHandle) -> Option<f64> {
        self.registry.get(handle)?.control.time()
    }

    /// [`Immersion::replay`] of a series of a codebook by a body that is, and is released now, as the book was
    /// planned for.
    ///
    /// ```
    /// use rapier3d_immersed::motion::{Codebook, ControlSeries, PlannedFor};
    /// use rapier3d_immersed::rapier3d::prelude::*;
    /// use rapier3d_immersed::{DryMass, Fluid, ForceFactors, HydroProperties, Immersion, OnContact};
    ///
    /// let mut world = PhysicsWorld::new();
    /// world.integration_parameters.dt = 1.0 / 120.0;
    /// let card = ColliderBuilder::cuboid(0.0365, 0.00015, 0.021).density(400.0);
    /// let (leaf, _) = world.insert(RigidBodyBuilder::dynamic(), card.clone());
    /// let (heavy, _) = world.insert(RigidBodyBuilder::dynamic(), card.density(800.0));
    /// let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, leaf)?;
    /// let mass = DryMass::of_body(&world.bodies, &world.colliders, leaf)?;
    /// let series = ControlSeries::new(0.5, vec![ForceFactors::ONE; 4], Vec::new())?;
    /// let planned_for = PlannedFor::new(hydro.clone(), mass, Fluid::AIR, 1.0 / 120.0);
    /// let book = Codebook::new("leaf", planned_for, vec![series])?;
    ///
    /// let mut immersion = Immersion::new(Fluid::AIR);
    /// immersion.insert_all([leaf, heavy], hydro);
    /// immersion.replay_planned(&world, leaf, &book, &book.series()[0], OnContact::Restart)?;
    /// let refused = immersion.replay_planned(&world, heavy, &book, &book.series()[0], OnContact::Restart);
    /// assert!(refused.unwrap_err().to_string().contains("mass"));
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NotAsPlanned`] names all that differs: shape, mass, law, fluid, wind at the body, gravity, time
    /// step, release ([`PlannedFor::check_same`]); [`Error::NoBody`] if the body is not immersed; those of
    /// [`DryMass::of_body`]. The body then goes on as before.
    pub fn replay_planned(
        &mut self,
        world: &PhysicsWorld,
        handle: RigidBodyHandle,
        book: &Codebook,
        series: &ControlSeries,
        on_contact: OnContact,
    ) -> Result<(), Error> {
        let rapier = world.bodies.get(handle).ok_or(Error::NoBody)?;
        let state = self.registry.get(handle).ok_or(Error::NoBody)?;
        let body = self.registry.description(state).ok_or(Error::NoBody)?;
        // Rapier has the mass of body and fluid while the body is in it.
        let mass = match self.mass_of(handle) {
            Some(mass) => mass,
            None => DryMass::of_body(&world.bodies, &world.colliders, handle)?,
        };
        let at = rapier.center_of_mass();
        let layer = self.environment.layer_at(at);
        let wind = self.environment.mean_flow(layer, at).velocity;
        let now = PlannedFor {
            body: body.clone(),
            mass,
            fluid: self.environment.medium.layers()[layer].fluid,
            wind: to_f64(wind),
            gravity: to_f64(world.gravity),
            orientation: to_quaternion(*rapier.rotation()),
            velocity: to_f64(rapier.linvel()),
            spin: to_f64(rapier.angvel()),
            dt: f64::from(world.integration_parameters.dt),
        };
        book.planned_for.check_same(&now)?;
        self.replay(handle, series, on_contact);
        Ok(())
    }
}
