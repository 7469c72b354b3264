//! Friction of a body whose mass depends on the direction.
//!
//! A body in contact has the solver mass of the contact's normal, which for a plate in water is many times
//! its mass along the ground. Handed over as `m_s Δv_free/dt`, a push along the ground reaches the contact
//! m_s/𝕄 times too large, and a plate of aluminium slides at 5 % of μN. Along axes whose mass is smaller
//! than the solver's, the friction is therefore counted on beforehand
//! (see [`constraint_impulse`](super::constraint_impulse)):
//!
//! * in a fluid that weighs (added mass above half of the body's), after Coulomb: what would stop the slip
//!   and hold the load, `−(𝕄 v_slip + F dt)`, at most μ times the normal impulse of the last step;
//! * in a light one, −F dt, low-passed: in a pile of leaves the normals flicker, and what is slow keeps it
//!   at rest. Only of what lies: bodies that have been in contact for a while, carry weight there and do
//!   not slip. Leaves that meet in the air are left alone.

use super::contact_mass::for_each_pair;
use crate::coupling::body_state::FlightState;
use crate::coupling::principal_mass::PrincipalMass;
use crate::coupling::rapier_sets::RapierSets;
use crate::coupling::shared_constants::SharedConstants;
use rapier3d::dynamics::RigidBody;
use rapier3d::math::{Real, Vector};

/// Share of a new guess that a step takes over in a light fluid.
const NEW_SHARE: Real = 0.125;
/// Steps from which on a contact in a light fluid is one of a body that lies.
const LASTING: u8 = 8;
/// Slip below which a body in a light fluid counts as lying, m/s.
const RESTING: Real = 0.05;

/// The impulse of the friction that the coming step counts on. `normal` is that of the contacts,
/// `solver_mass` the mass along it; `masses` are those of body and fluid.
pub(super) fn expected(
    shared: &SharedConstants,
    masses: &PrincipalMass,
    body: &RigidBody,
    flight: &FlightState,
    user_force: Vector,
    (normal, solver_mass): (Vector, Real),
    sets: &RapierSets,
) -> Vector {
    let dt = sets.integration_parameters.dt;
    let attitude = *body.rotation();
    let across = |v: Vector| v - normal * v.dot(normal);
    let weight = sets.gravity * body.gravity_scale() * shared.constants.dry.mass as Real;
    let push = (flight.fluid_force + user_force + weight) * dt;
    let Some(touch) = touch(body, sets) else {
        return Vector::ZERO;
    };
    let wanted = if shared.heavy_fluid {
        let momentum = masses.scale(attitude, touch.slip, |mass| mass);
        -across(momentum + push).clamp_length_max(touch.friction * touch.impulse)
    } else if flight.contact_steps >= LASTING
        && touch.slip.length() < RESTING
        && touch.impulse > 0.5 * weight.length() * dt
    {
        -across(push)
    } else {
        return Vector::ZERO;
    };
    let lighter = |mass: Real| f32::from(u8::from(mass < solver_mass));
    let friction = across(masses.scale(attitude, wanted, lighter));
    if shared.heavy_fluid {
        return friction;
    }
    let last = flight.constraint_impulse;
    last + (friction - last) * NEW_SHARE
}

/// How a body touches others, on average over the impulses of its contacts.
#[derive(Clone, Copy)]
struct Touch {
    /// Velocity relative to what it touches, m/s.
    slip: Vector,
    /// Coefficient of friction.
    friction: Real,
    /// Normal impulse of the last step, N·s.
    impulse: Real,
}

/// How a body touched others in the last step; `None` if it did not.
fn touch(body: &RigidBody, sets: &RapierSets) -> Option<Touch> {
    let (mut slip, mut friction, mut total) = (Vector::ZERO, 0.0, 0.0);
    for_each_pair(body, sets.narrow_phase, |collider, pair| {
        let Some(contacts) = pair.rigid() else {
            return;
        };
        let first = pair.collider1 == collider;
        let other = if first {
            pair.collider2
        } else {
            pair.collider1
        };
        let other = sets.colliders.get(other).and_then(|c| c.parent());
        let other = other.and_then(|handle| sets.bodies.get(handle));
        for manifold in contacts.solver_manifolds() {
            for point in &manifold.points {
                let data = &point.data;
                if data.impulse <= 0.0 {
                    continue;
                }
                let (own, theirs) = if first {
                    (data.solver_dp1, data.solver_dp2)
                } else {
                    (data.solver_dp2, data.solver_dp1)
                };
                let mut relative = body.linvel() + body.angvel().cross(own);
                if let Some(other) = other {
                    relative -= other.linvel() + other.angvel().cross(theirs);
                }
                slip += relative * data.impulse;
                friction += manifold.data.friction * data.impulse;
                total += data.impulse;
            }
        }
    });
    (total > 0.0).then(|| Touch {
        slip: slip / total,
        friction: friction / total,
        impulse: total,
    })
}
