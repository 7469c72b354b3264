//! What is known of one body of the world: forces, masses, how it floats.

use super::body_state::BodyState;
use super::environment::Environment;
use super::equipment::PartState;
use super::immersion::Immersion;
use super::shared_constants::{ConstantsTable, in_layer};
use super::surface_readout::AmongLayers;
use crate::body::DryMass;
use crate::dynamics::forces::Instant;
use crate::dynamics::part_constants::PartConstants;
use crate::dynamics::parts::PartNow;
use crate::dynamics::{ForceBreakdown, Hydrostatics};
use crate::math::spatial::Twist;
use crate::math::{to_f64, to_quaternion, to_real, vector};
use crate::medium::Layer;
use rapier3d::dynamics::{RigidBody, RigidBodyHandle, RigidBodySet};
use rapier3d::math::{Real, Vector};
use rapier3d::na::{Matrix6, UnitQuaternion};

/// The forces on a body, or on one of its parts, in the state that it has now; `None` if it is not in the fluid.
pub(super) fn forces(
    state: &BodyState,
    constants: &ConstantsTable,
    environment: &Environment,
    body: &RigidBody,
    part: Option<usize>,
) -> Option<ForceBreakdown> {
    state.saved.as_ref()?;
    let mut layer = usize::from(state.layer);
    if let Some(among) = AmongLayers::of(state, constants, environment, body) {
        if among.is_cut() {
            return Some(among.forces(part));
        }
        // One that its user has just moved is not where it was in the last step.
        layer = among.first();
    }
    let c = &constants.get(in_layer(state.constants, layer))?.constants;
    let axes = UnitQuaternion::from_rotation_matrix(&c.axes);
    let attitude = to_quaternion(*body.rotation()) * axes;
    let mean = environment.mean_flow(layer, body.center_of_mass());
    let plate_axes = |row| to_f64(vector(row));
    let motion = &state.flight.motion;
    let instant = |fluid_velocity: Vector, fluctuation: Real| {
        let linear = body.linvel() - fluid_velocity;
        // Bodies of parts see the vorticity at their parts.
        let spins = if c.parts.is_empty() { 0.5 } else { 0.0 };
        let angular = body.angvel() - mean.vorticity * spins;
        let part = |(i, constants): (usize, &PartConstants<f64>)| {
            let none = PartState::default();
            let equipment = state.equipment.as_ref();
            let part = equipment
                .and_then(|known| known.parts.get(i))
                .unwrap_or(&none);
            let arm = attitude * (constants.place.position * c.length);
            let seen = environment.mean_flow(layer, body.center_of_mass() + to_real(arm));
            let velocity = seen.velocity + part.turbulence.fluctuation * fluctuation;
            PartNow {
                velocity: to_f64(velocity - fluid_velocity),
                spin: to_f64(seen.vorticity) * (0.5 * c.length),
                factors: part.factors.into(),
                ..PartNow::at_rest(part.deflection.into())
            }
        };
        Instant {
            attitude,
            velocity: Twist {
                linear: attitude.inverse() * to_f64(linear),
                angular: attitude.inverse() * to_f64(angular) * c.length,
            },
            rate: Twist {
                linear: plate_axes(motion.linear_rate),
                angular: plate_axes(motion.angular_rate),
            },
            gravity: to_f64(environment.gravity * body.gravity_scale()),
            parts: c.parts.iter().enumerate().map(part).collect(),
        }
    };
    let factors = state.control.factors.into();
    if let Some(part) = part {
        let forces = c.part_forces(part, &instant(mean.velocity, 0.0))?;
        return Some(forces.scaled(&factors));
    }
    let forces_in = |fluid_velocity: Vector, fluctuation: Real| {
        c.forces(&instant(fluid_velocity, fluctuation))
            .scaled(&factors)
    };
    let mut forces = forces_in(mean.velocity, 0.0);
    if let Some(equipment) = &state.equipment {
        forces.thrust = equipment.thrust;
        forces.buoyancy = forces.buoyancy + equipment.buoyancy;
    }
    let fluctuation = state.flight.turbulence.fluctuation;
    let turbulent = |layer: &Layer| layer.turbulence.is_some();
    if environment
        .medium
        .layers()
        .get(layer)
        .is_some_and(turbulent)
        && fluctuation != Vector::ZERO
    {
        let fluctuating = forces_in(mean.velocity + fluctuation, 1.0);
        forces.turbulence = fluctuating.viscous() - forces.viscous();
    }
    Some(forces)
}

impl Immersion {
    /// The forces on a body in the state that it has now, or `None` if it is not immersed (yet: a
    /// body enters the fluid with the first step after its insertion). Gravity is that of the last
    /// step.
    ///
    /// ```
    /// use rapier3d_immersed::rapier3d::prelude::*;
    /// use rapier3d_immersed::{Fluid, HydroProperties, Immersion};
    ///
    /// let mut world = PhysicsWorld::new();
    /// let (ball, _) = world.insert(RigidBodyBuilder::dynamic(), ColliderBuilder::ball(0.1));
    /// let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, ball)?;
    /// let mut immersion = Immersion::new(Fluid::WATER);
    /// immersion.insert(ball, hydro);
    /// immersion.step(&mut world);
    /// let forces = immersion.forces(&world.bodies, ball).unwrap();
    /// assert!((forces.buoyancy.force.y - 997.0 * 0.004189 * 9.81).abs() < 0.2); // ρVg, N
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn forces(&self, bodies: &RigidBodySet, handle: RigidBodyHandle) -> Option<ForceBreakdown> {
        let state = self.registry.get(handle)?;
        let body = bodies.get(handle)?;
        forces(state, &self.constants, &self.environment, body, None)
    }

    /// How a body lies in the free surface of the medium, as it is now; `None` if it is not immersed (yet), or in a single
    /// fluid.
    ///
    /// ```
    /// use rapier3d_immersed::rapier3d::prelude::*;
    /// use rapier3d_immersed::{Fluid, HydroProperties, Immersion, Medium};
    ///
    /// let mut world = PhysicsWorld::new();
    /// let raft = ColliderBuilder::cuboid(1.0, 0.1, 0.5).density(500.0);
    /// let (raft, _) = world.insert(RigidBodyBuilder::dynamic(), raft);
    /// let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, raft)?;
    /// let mut immersion = Immersion::new(Medium::layered(Fluid::AIR, Fluid::WATER));
    /// immersion.insert(raft, hydro);
    /// immersion.step(&mut world);
    /// let floats = immersion.hydrostatics(&world.bodies, raft).unwrap();
    /// assert!((floats.submerged_share - 0.5).abs() < 0.01);
    /// assert!((floats.waterplane_area - 2.0).abs() < 1e-4); // m²
    /// // BM = I/V of the waterplane, a rectangle of 2 m × 1 m, about its long axis.
    /// assert!((floats.metacentric_radii[0] - 2.0 / 12.0 / floats.submerged_volume).abs() < 1e-4);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn hydrostatics(
        &self,
        bodies: &RigidBodySet,
        handle: RigidBodyHandle,
    ) -> Option<Hydrostatics> {
        let state = self.registry.get(handle)?;
        let body = bodies.get(handle)?;
        let among = AmongLayers::of(state, &self.constants, &self.environment, body)?;
        Some(among.hydrostatics())
    }

    /// The mass, center of mass and inertia of a body itself, without any fluid, as its user means them; `None`
    /// if it is not in the fluid (yet: a body enters with the first step after its insertion). A change is in
    /// them after the next step. Rapier's own `body.mass()` is what the solver uses meanwhile: see
    /// [`Immersion`].
    ///
    /// ```
    /// use rapier3d_immersed::rapier3d::prelude::*;
    /// use rapier3d_immersed::{Fluid, HydroProperties, Immersion};
    ///
    /// let mut world = PhysicsWorld::new();
    /// let (ball, _) = world.insert(RigidBodyBuilder::dynamic(), ColliderBuilder::ball(0.1).mass(2.0));
    /// let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, ball)?;
    /// let mut immersion = Immersion::new(Fluid::WATER);
    /// immersion.insert(ball, hydro);
    /// immersion.step(&mut world);
    /// world.bodies[ball].set_additional_mass(0.5, true); // ballast
    /// immersion.step(&mut world);
    /// assert!((immersion.mass_of(ball).unwrap().mass - 2.5).abs() < 1e-6);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn mass_of(&self, handle: RigidBodyHandle) -> Option<DryMass> {
        Some(self.registry.get(handle)?.saved.as_ref()?.dry)
    }

    /// The 6×6 mass 𝕄 of a body with the fluid that it drags along: `𝕄 (v, ω)` is the momentum, N·s, and
    /// angular momentum, N·m·s, about the center of mass that it takes to move body and fluid at v, m/s, and
    /// ω, rad/s. Axes of the body's frame. A body that the boundary of two fluids cuts drags along what it did in the
    /// last step. `None` if the body is not in the fluid (yet).
    pub fn mass_matrix_of(&self, handle: RigidBodyHandle) -> Option<Matrix6<f64>> {
        let state = self.registry.get(handle)?;
        state.saved.as_ref()?;
        let shared = self.constants.get(state.constants)?;
        Some(state.mass_matrix(shared))
    }
}
