//! Contacts of a body whose mass depends on the direction.
//!
//! Rapier's solver knows one scalar mass per body. In fluid a plate is heavier broadside on than
//! edgewise. Before the step a body near a contact gets the mass that it shows along the contact's
//! normal, `m_s = 1/(n·𝕄⁻¹n)`, so that the solver finds the right impulse; after the step the
//! velocity change that this impulse λ really causes, `𝕄⁻¹λ`, replaces `λ/m_s`.

use crate::coupling::body_mass::BodyMass;
use crate::coupling::rapier_sets::RapierSets;
use crate::coupling::registry::Registry;
use crate::coupling::shared_constants::SharedConstants;
use crate::math::{to_f64, to_quaternion, to_real};
use rapier3d::dynamics::RigidBody;
use rapier3d::geometry::{ColliderHandle, ContactPair, NarrowPhase};
use rapier3d::math::{Real, Vector};
use rapier3d::na::{Vector3, Vector6};
use rapier3d::parry::query::contact;

/// Which bodies are close to something.
#[derive(Clone, Default)]
pub(in crate::coupling) struct CloseBodies {
    /// By index of the body's state, unless the world is `crowded`.
    pub marked: Vec<bool>,
    pub crowded: bool,
}

impl CloseBodies {
    /// Whether the body's pairs have to be asked for.
    pub fn contains(&self, state: usize) -> bool {
        self.crowded || self.marked.get(state).is_some_and(|marked| *marked)
    }
}

/// Marks the bodies that meet others where these are few, so that the rest need not be asked for
/// their pairs one by one.
pub(super) fn find_close(
    registry: &Registry,
    heavy_fluid: bool,
    sets: &RapierSets,
    close: &mut CloseBodies,
) {
    close.marked.clear();
    close.marked.resize(registry.states().len(), false);
    close.crowded = false;
    // Pairs without a contact yet matter only to bodies that drag much fluid along.
    let mut few = sets.islands.num_active_bodies() / 4;
    for pair in sets.narrow_phase.contact_pairs() {
        if !heavy_fluid && !pair.has_any_active_contact() {
            continue;
        }
        if few == 0 {
            close.crowded = true;
            return;
        }
        few -= 1;
        for collider in [pair.collider1, pair.collider2] {
            let parent = sets.colliders.get(collider).and_then(|c| c.parent());
            if let Some(index) = parent.and_then(|body| registry.index(body)) {
                close.marked[index] = true;
            }
        }
    }
}

/// Visits the contacts of a body as the narrow phase last saw them.
pub(super) fn for_each_pair<'a>(
    body: &RigidBody,
    narrow_phase: &'a NarrowPhase,
    mut visit: impl FnMut(ColliderHandle, &'a ContactPair),
) {
    for collider in body.colliders() {
        narrow_phase
            .contact_pairs_with(*collider)
            .for_each(|pair| visit(*collider, pair));
    }
}

/// Whether contacts acted on a body in the last step.
pub(super) fn is_touched(body: &RigidBody, narrow_phase: &NarrowPhase) -> bool {
    let mut touched = false;
    for_each_pair(body, narrow_phase, |_, pair| {
        touched |= pair.has_any_active_contact();
    });
    touched
}

/// The normal of the contacts that the body has or is about to have, weighted by their impulses;
/// `None` if it touches nothing.
///
/// The narrow phase makes contact points only in the step of the impact itself, too late to change
/// the mass. For bodies that drag much fluid along, pairs that could meet in this step are therefore
/// asked for their normal here.
pub(super) fn normal(
    shared: &SharedConstants,
    body: &RigidBody,
    sets: &RapierSets,
) -> Option<Vector> {
    let mut sum = Vector::ZERO;
    let mut touching = false;
    let mut add = |normal: Vector, weight: Real| {
        // Normals that point opposite ways are the same direction to a mass.
        let sign = if sum.dot(normal) < 0.0 { -1.0 } else { 1.0 };
        sum += normal * (sign * weight);
        touching = true;
    };
    for_each_pair(body, sets.narrow_phase, |_, pair| {
        let Some(contacts) = pair.rigid() else {
            return;
        };
        let mut met = false;
        for manifold in contacts.solver_manifolds() {
            if !manifold.data.solver_contacts.is_empty() {
                let impulse: Real = manifold.points.iter().map(|p| p.data.impulse).sum();
                add(manifold.data.normal, impulse + 1e-12);
                met = true;
            }
        }
        if !met
            && shared.heavy_fluid
            && let Some(normal) = approach(pair, sets)
        {
            add(normal, 1e-12);
        }
    });
    touching.then(|| sum.normalize_or(Vector::Y))
}

/// The normal along which the colliders of a pair may meet within the step.
fn approach(pair: &ContactPair, sets: &RapierSets) -> Option<Vector> {
    let (a, b) = (
        sets.colliders.get(pair.collider1)?,
        sets.colliders.get(pair.collider2)?,
    );
    let [speed_a, speed_b] = [a, b].map(|collider| {
        let parent = collider.parent().and_then(|handle| sets.bodies.get(handle));
        parent.map_or(0.0, |body| {
            let reach = body.mass_properties().max_extent();
            body.linvel().length() + body.angvel().length() * reach
        })
    });
    let reach = (speed_a + speed_b) * sets.integration_parameters.dt;
    let contact = contact(a.position(), a.shape(), b.position(), b.shape(), reach);
    Some(contact.ok()??.normal1)
}

/// The scalar mass that the body shows along `normal` (world axes), kg.
pub(super) fn mass_along(mass: &BodyMass, body: &RigidBody, normal: Vector) -> f64 {
    let n = to_quaternion(*body.rotation()).inverse() * to_f64(normal);
    let response = mass.inverse.fixed_view::<3, 3>(0, 0);
    1.0 / n.dot(&(response * n))
}

/// What has to be added to linear and angular velocity (world axes) after the step, because the
/// contacts acted on the scalar `solver_mass`.
pub(super) fn correction(
    shared: &SharedConstants,
    mass: &BodyMass,
    body: &RigidBody,
    narrow_phase: &NarrowPhase,
    solver_mass: f64,
) -> Option<(Vector, Vector)> {
    let (mut impulse, mut moment) = (Vector::ZERO, Vector::ZERO);
    for_each_pair(body, narrow_phase, |collider, pair| {
        let Some(contacts) = pair.rigid() else {
            return;
        };
        let first = pair.collider1 == collider;
        for manifold in contacts.solver_manifolds() {
            // The normal points from the first to the second body.
            let away = if first { -1.0 } else { 1.0 };
            for point in &manifold.points {
                let data = &point.data;
                let push = manifold.data.normal * (away * data.impulse);
                impulse += push;
                let lever = if first {
                    data.solver_dp1
                } else {
                    data.solver_dp2
                };
                moment += lever.cross(push);
            }
        }
    });
    if impulse == Vector::ZERO {
        return None;
    }
    let rotation = to_quaternion(*body.rotation());
    let (f, t) = (
        rotation.inverse() * to_f64(impulse),
        rotation.inverse() * to_f64(moment),
    );
    // Without coupling the rotational inertia that rapier has is the right one.
    let t = if mass.coupled { t } else { t * 0.0 };
    let mut change = mass.inverse * Vector6::new(f.x, f.y, f.z, t.x, t.y, t.z);
    let inertia = shared.constants.dry.inertia + shared.constants.added_mass.angular;
    let already = inertia.try_inverse().map_or(t * 0.0, |inverse| inverse * t);
    if mass.cut {
        // The solver knew another inertia: as much of the impulse acts as changes the velocities that it acts on as it
        // wanted. All of it would throw the body off.
        let wanted = f.norm_squared() / solver_mass + t.dot(&already);
        let own = change.fixed_rows::<3>(0).dot(&f) + change.fixed_rows::<3>(3).dot(&t);
        if own > 0.0 {
            change *= wanted / own;
        }
    }
    let linear = change.fixed_rows::<3>(0) - f / solver_mass;
    let angular = if mass.coupled {
        change.fixed_rows::<3>(3) - already
    } else {
        Vector3::zeros()
    };
    Some((to_real(rotation * linear), to_real(rotation * angular)))
}
