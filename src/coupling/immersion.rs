//! The set of immersed bodies.

use super::kind::Kind;
use super::slot::{FlightState, NONE, Slot};
use super::stir::Stirred;
use super::warning::Warning;
use crate::body::ImmersedBody;
use crate::dynamics::Integrator;
use crate::flow::Flow;
use crate::fluid::Fluid;
use crate::motion::ControlSeries;
use crate::turbulence::TurbulentLayer;
use crate::{DryMass, Error};
use rapier3d::dynamics::{RigidBodyHandle, RigidBodySet};
use rapier3d::geometry::ColliderSet;
use rapier3d::math::Vector;
use std::sync::Arc;

/// Bodies of a rapier world that are immersed in one fluid.
///
/// Keyed by rapier's handles and otherwise independent of the world: bodies may be removed from
/// rapier at any time, and their handles reused.
///
/// # What it does to a body
/// From the step after its insertion until it is removed or disabled, an immersed body
/// * has all its mass properties moved to its first collider, with the fluid's share of the
///   rotational inertia (and, near contacts, of the mass) added: other colliders then read
///   `mass() == 0`;
/// * may rotate by more than 45° per step, and has rapier's gyroscopic forces off (the crate
///   integrates them);
/// * does not fall asleep unless it touches something;
/// * keeps its user forces, gravity scale (which scales the buoyancy too), damping, locked axes and
///   joints.
///
/// Joints and locked axes act on the body as rapier holds it; such bodies, multibody links and bodies
/// with solver iterations of their own get their motion by a force alone, like bodies in contact.
/// Kinematic bodies are left alone until they become dynamic.
///
/// # Memory
/// About 550 bytes per body, besides what equal bodies share.
///
/// To change the mass or the colliders of an immersed body, remove it, change it, insert it again.
#[derive(Clone)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Immersion {
    pub(super) fluid: Fluid,
    /// How finely flight is integrated within a step of rapier.
    pub integrator: Integrator,
    pub(super) enabled: bool,
    pub(super) time: f64,
    /// Number of steps so far: what the noise of a step depends on.
    pub(super) steps: u64,
    /// Of the last step, for the read-out.
    pub(super) gravity: Vector,
    pub(super) descriptions: Vec<ImmersedBody>,
    pub(super) slots: Vec<Option<Slot>>,
    /// Slot of each rapier body index, or `NONE`.
    pub(super) lookup: Vec<u32>,
    pub(super) free: Vec<u32>,
    pub(super) warnings: Vec<Warning>,
    pub(super) sweep: u32,
    /// The series that bodies replay; `None` where there is room for one.
    pub(super) series: Vec<Option<ControlSeries>>,
    /// Whether bodies may have to enter or leave the fluid.
    #[cfg_attr(feature = "serde-serialize", serde(skip, default = "yes"))]
    pub(super) changed: bool,
    /// The velocity field; `None` is a fluid at rest. Not part of a snapshot: set it again.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub(super) flow: Option<Arc<dyn Flow>>,
    /// The turbulence on top of it. Not part of a snapshot either; what bodies remember of it is.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub(super) turbulence: Option<TurbulentLayer>,
    /// Rebuilt from the slots after loading.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub(super) kinds: Vec<Kind>,
    /// Whether one of the kinds drags much fluid along.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub(super) heavy_fluid: bool,
    /// Bodies that rapier may not list as active yet.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub(super) newcomers: Vec<RigidBodyHandle>,
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub(super) scratch: super::scratch::Scratch,
}

#[cfg(feature = "serde-serialize")]
fn yes() -> bool {
    true
}

impl Immersion {
    /// An empty set in a fluid at rest.
    pub fn new(fluid: Fluid) -> Self {
        Self {
            fluid,
            integrator: Integrator::default(),
            enabled: true,
            time: 0.0,
            steps: 0,
            gravity: Vector::ZERO,
            descriptions: Vec::new(),
            slots: Vec::new(),
            lookup: Vec::new(),
            free: Vec::new(),
            warnings: Vec::new(),
            sweep: 0,
            series: Vec::new(),
            changed: false,
            flow: None,
            turbulence: None,
            kinds: Vec::new(),
            heavy_fluid: false,
            newcomers: Vec::new(),
            scratch: super::scratch::Scratch::default(),
        }
    }

    /// Immerses a body from the next step on. Equal descriptions are stored once.
    ///
    /// `body` is [`HydroProperties`](crate::HydroProperties) (under the default law) or an
    /// [`ImmersedBody`]. A handle that is stale or becomes stale is no error; a body that is already
    /// immersed gets the new description. What cannot be immersed (without mass, say) is left to
    /// plain rapier and reported in [`Immersion::warnings`].
    pub fn insert(&mut self, handle: RigidBodyHandle, body: impl Into<ImmersedBody>) {
        let body = body.into();
        let description = match self.descriptions.iter().rposition(|known| *known == body) {
            Some(index) => index,
            None => {
                self.descriptions.push(body);
                self.descriptions.len() - 1
            }
        } as u32;
        self.insert_described(handle, description);
    }

    /// Immerses many equal bodies: `body` is compared with the known descriptions only once.
    pub fn insert_all(
        &mut self,
        handles: impl IntoIterator<Item = RigidBodyHandle>,
        body: impl Into<ImmersedBody>,
    ) {
        let mut handles = handles.into_iter();
        if let Some(first) = handles.next() {
            self.insert(first, body);
            let description = self.slot(first).map_or(0, |slot| slot.description);
            for handle in handles {
                self.insert_described(handle, description);
            }
        }
    }

    fn insert_described(&mut self, handle: RigidBodyHandle, description: u32) {
        self.changed = true;
        if let Some(slot) = self.slot_mut(handle) {
            slot.description = description;
            slot.kind = NONE;
            return;
        }
        let index = handle.into_raw_parts().0 as usize;
        if self.lookup.len() <= index {
            self.lookup.resize(index + 1, NONE);
        }
        // A slot that a removed body of the same index left behind is taken over.
        let slot = match self.lookup[index] {
            NONE => self.free.pop().unwrap_or_else(|| {
                self.slots.push(None);
                self.slots.len() as u32 - 1
            }),
            stale => stale,
        };
        self.lookup[index] = slot;
        self.slots[slot as usize] = Some(Slot {
            handle,
            description,
            enabled: true,
            player: None,
            control: [1.0; 3],
            original: None,
            kind: NONE,
            flight: FlightState::default(),
        });
    }

    /// Takes a body out of the fluid and gives it back the mass properties and switches that it had.
    /// Unknown handles are no error.
    pub fn remove(
        &mut self,
        handle: RigidBodyHandle,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
    ) {
        let Some(index) = self.index(handle) else {
            return;
        };
        if let Some(slot) = self.slots[index as usize].take()
            && let Some(original) = slot.original
        {
            original.restore(handle, bodies, colliders);
        }
        self.lookup[handle.into_raw_parts().0 as usize] = NONE;
        self.free.push(index);
    }

    /// Whether a body is in the set, enabled or not.
    pub fn contains(&self, handle: RigidBodyHandle) -> bool {
        self.index(handle).is_some()
    }

    /// Number of bodies in the set. Bodies that were removed from rapier count until the step has
    /// come across them.
    pub fn len(&self) -> usize {
        self.slots.len() - self.free.len()
    }

    /// Whether no body is immersed.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The description of a body.
    pub fn get(&self, handle: RigidBodyHandle) -> Option<&ImmersedBody> {
        let slot = self.slot(handle)?;
        Some(&self.descriptions[slot.description as usize])
    }

    /// Switches the fluid off or on for the whole set, from the next step on. While off, the world
    /// steps as plain rapier: mass properties and switches are those from before immersion.
    pub fn set_enabled(&mut self, enabled: bool) {
        self.enabled = enabled;
        self.changed = true;
    }

    /// Whether the fluid is on for the set.
    pub fn is_enabled(&self) -> bool {
        self.enabled
    }

    /// Switches the fluid off or on for one body, from the next step on.
    pub fn set_body_enabled(&mut self, handle: RigidBodyHandle, enabled: bool) {
        if let Some(slot) = self.slot_mut(handle) {
            slot.enabled = enabled;
            self.changed = true;
        }
    }

    /// The fluid.
    pub fn fluid(&self) -> &Fluid {
        &self.fluid
    }

    /// Changes the fluid, from the next step on.
    pub fn set_fluid(&mut self, fluid: Fluid) {
        self.fluid = fluid;
        self.kinds.clear();
        self.heavy_fluid = false;
        self.changed = true;
        for slot in self.slots.iter_mut().flatten() {
            slot.kind = NONE;
        }
    }

    /// Sets the velocity field of the fluid.
    pub fn set_flow(&mut self, flow: impl Flow + 'static) {
        self.flow = Some(Arc::new(flow));
    }

    /// Stirs the fluid: turbulence on top of the mean flow, another for each body.
    ///
    /// A [`Turbulence`](crate::turbulence::Turbulence) acts as the fluctuating velocity of the fluid
    /// that a body sees, with seed 0; [`TurbulentLayer`] chooses otherwise.
    pub fn set_turbulence(&mut self, turbulence: impl Into<TurbulentLayer>) {
        self.turbulence = Some(turbulence.into());
    }

    /// Ends the turbulence.
    pub fn clear_turbulence(&mut self) {
        self.turbulence = None;
        for slot in self.slots.iter_mut().flatten() {
            slot.flight.stirred = Stirred::default();
        }
        self.calm();
    }

    /// Where nothing moves the fluid any more, bodies start afresh in it.
    fn calm(&mut self) {
        if self.flow.is_some() || self.turbulence.is_some() {
            return;
        }
        for slot in self.slots.iter_mut().flatten() {
            slot.flight.stream = Vector::ZERO;
            slot.flight.flying = false;
        }
    }

    /// Lets the fluid rest, but for its turbulence.
    pub fn clear_flow(&mut self) {
        self.flow = None;
        self.calm();
    }

    /// Seconds that the set has been stepped.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// What the steps so far had to say; [`Immersion::clear_warnings`] forgets it. The same text
    /// goes to the `log` crate at level `warn`.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// Forgets the warnings so far.
    pub fn clear_warnings(&mut self) {
        self.warnings.clear();
    }

    pub(super) fn warn(&mut self, warning: Warning) {
        log::warn!("{warning}");
        self.warnings.push(warning);
    }

    fn index(&self, handle: RigidBodyHandle) -> Option<u32> {
        let index = *self.lookup.get(handle.into_raw_parts().0 as usize)?;
        let slot = self.slots.get(index as usize)?.as_ref()?;
        (slot.handle == handle).then_some(index)
    }

    pub(super) fn slot_index(&self, handle: RigidBodyHandle) -> Option<usize> {
        self.index(handle).map(|index| index as usize)
    }

    pub(super) fn slot(&self, handle: RigidBodyHandle) -> Option<&Slot> {
        self.slots[self.slot_index(handle)?].as_ref()
    }

    pub(super) fn slot_mut(&mut self, handle: RigidBodyHandle) -> Option<&mut Slot> {
        let index = self.slot_index(handle)?;
        self.slots[index].as_mut()
    }

    /// Index of the kind of a body with this description and mass.
    pub(super) fn kind_of(&mut self, description: u32, dry: &DryMass) -> Result<u32, Error> {
        if let Some(index) = self
            .kinds
            .iter()
            .rposition(|kind| kind.is(description, dry))
        {
            return Ok(index as u32);
        }
        let body = &self.descriptions[description as usize];
        let kind = Kind::new(description, body, dry, &self.fluid)?;
        self.heavy_fluid |= kind.heavy_fluid;
        self.kinds.push(kind);
        Ok(self.kinds.len() as u32 - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coupling::original::Original;

    /// What the documentation says of memory.
    #[test]
    fn bytes_per_body() {
        let kept = size_of::<Slot>() + size_of::<Original>() + 64;
        assert!(kept <= 570, "{kept}");
        assert!(size_of::<super::super::flight::Flyer>() <= 120);
    }
}
