//! Setting and reading the parts, thrusters and volume of bodies in the fluid.

use super::equipment::Equipment;
use super::immersion::Immersion;
use super::readout;
use crate::dynamics::ForceBreakdown;
use crate::hydro::viscous::ForceFactors;
use rapier3d::dynamics::{RigidBodyHandle, RigidBodySet};

/// Bodies of parts. Unknown handles, parts and thrusters, and values that are no numbers, change nothing. A change acts with
/// the next step, and wakes a body that sleeps within sixteen; nothing is made anew for it.
impl Immersion {
    /// Turns a part of a body about its [`Hinge`](crate::Hinge), rad, as a rudder, an aileron or a blade's pitch.
    ///
    /// ```
    /// use rapier3d_immersed::rapier3d::{na::Vector3, prelude::*};
    /// use rapier3d_immersed::{Fluid, Hinge, HydroProperties, ImmersedBody, Immersion, Part};
    ///
    /// let mut world = PhysicsWorld::new();
    /// let boat = ColliderBuilder::cuboid(0.5, 0.05, 0.1).density(500.0);
    /// let (boat, _) = world.insert(RigidBodyBuilder::dynamic(), boat);
    /// let hull = HydroProperties::from_body(&world.bodies, &world.colliders, boat)?;
    /// let rudder = HydroProperties::from_shape(&Cuboid::new(Vector::new(0.04, 0.08, 0.002)))?;
    /// let rudder = Part::new(rudder)
    ///     .at(rapier3d_immersed::rapier3d::na::Isometry3::translation(-0.55, -0.1, 0.0))
    ///     .with_hinge(Hinge::new(Vector3::new(-0.51, 0.0, 0.0), Vector3::y())?);
    /// let body = ImmersedBody::new(hull.clone()).with_parts([Part::new(hull), rudder]);
    /// let mut immersion = Immersion::new(Fluid::WATER);
    /// immersion.insert(boat, body);
    /// immersion.set_deflection(boat, 1, 0.4);
    /// assert_eq!(immersion.deflection(boat, 1), Some(0.4));
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn set_deflection(&mut self, handle: RigidBodyHandle, part: usize, angle: f32) {
        let hinged = self
            .get(handle)
            .and_then(|body| body.parts.get(part))
            .is_some_and(|part| part.hinge.is_some());
        if hinged
            && angle.is_finite()
            && let Some(part) = self
                .equipment_mut(handle)
                .and_then(|e| e.parts.get_mut(part))
        {
            part.deflection = angle;
        }
    }

    /// How far a part is turned about its hinge, rad.
    pub fn deflection(&self, handle: RigidBodyHandle, part: usize) -> Option<f32> {
        let equipment = self.registry.get(handle)?.equipment.as_ref()?;
        Some(equipment.parts.get(part)?.deflection)
    }

    /// Multiplies the forces on one part, on top of [`Immersion::set_control`]: a wing that is torn off has a drag of 0.
    pub fn set_part_control(
        &mut self,
        handle: RigidBodyHandle,
        part: usize,
        factors: ForceFactors,
    ) {
        if factors.check().is_ok()
            && let Some(part) = self
                .equipment_mut(handle)
                .and_then(|e| e.parts.get_mut(part))
        {
            part.factors = factors;
        }
    }

    /// Drives a [`Thruster`](crate::Thruster): by N, or by turns per second if it has a propeller. It goes on until it is driven
    /// otherwise.
    pub fn set_thrust(&mut self, handle: RigidBodyHandle, thruster: usize, drive: f64) {
        if drive.is_finite()
            && let Some(known) = self
                .equipment_mut(handle)
                .and_then(|e| e.drives.get_mut(thruster))
        {
            *known = drive;
        }
    }

    /// What drives a thruster.
    pub fn thrust(&self, handle: RigidBodyHandle, thruster: usize) -> Option<f64> {
        let equipment = self.registry.get(handle)?.equipment.as_ref()?;
        equipment.drives.get(thruster).copied()
    }

    /// Lets a body displace so many m³ more (or less) than its shape, at its center of buoyancy: a buoyancy engine, a
    /// swim bladder. Ballast is `set_additional_mass` of rapier's.
    pub fn set_extra_volume(&mut self, handle: RigidBodyHandle, volume: f64) {
        if !volume.is_finite() {
            return;
        }
        if let Some(state) = self.registry.get_mut(handle)
            && state.equipment.is_none()
            && volume != 0.0
        {
            state.equipment = Some(Box::default());
        }
        if let Some(equipment) = self.equipment_mut(handle) {
            equipment.extra_volume = volume;
        }
    }

    /// The viscous force on one part of a body, with its angle of attack, in the state that it has now; moments are about
    /// the body's center of mass. `None` if the body is not in the fluid (yet), or has no such part.
    pub fn part_forces(
        &self,
        bodies: &RigidBodySet,
        handle: RigidBodyHandle,
        part: usize,
    ) -> Option<ForceBreakdown> {
        let state = self.registry.get(handle)?;
        let body = bodies.get(handle)?;
        readout::forces(state, &self.constants, &self.environment, body, Some(part))
    }

    /// The equipment of a body, which is woken by what is set there.
    fn equipment_mut(&mut self, handle: RigidBodyHandle) -> Option<&mut Equipment> {
        let state = self.registry.get_mut(handle)?;
        let equipment = state.equipment.as_deref_mut()?;
        equipment.set = true;
        Some(equipment)
    }
}
