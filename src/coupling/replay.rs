//! Series of a codebook, played by what they were planned for.

use super::control::OnContact;
use super::immersion::Immersion;
use crate::body::DryMass;
use crate::error::Error;
use crate::math::{to_f64, to_quaternion};
use crate::motion::{Codebook, ControlSeries, PlannedFor};
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::pipeline::PhysicsWorld;

impl Immersion {
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
