//! The forces on one body of the world.

use super::body_state::BodyState;
use super::environment::Environment;
use super::equipment::PartState;
use super::shared_constants::{ConstantsTable, in_layer};
use super::surface_readout::AmongLayers;
use crate::dynamics::ForceBreakdown;
use crate::dynamics::forces::Instant;
use crate::dynamics::part_constants::PartConstants;
use crate::dynamics::parts::PartNow;
use crate::math::spatial::Twist;
use crate::math::{to_f64, to_quaternion, to_real, vector};
use crate::medium::Layer;
use rapier3d::dynamics::RigidBody;
use rapier3d::math::{Real, Vector};
use rapier3d::na::UnitQuaternion;

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
