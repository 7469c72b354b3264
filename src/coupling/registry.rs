//! Which bodies are immersed, by rapier's handles.

use super::body_state::{BodyState, FlightState, NONE, Warned};
use super::control::BodyControl;
use super::equipment::Equipment;
use crate::body::ImmersedBody;
#[cfg(feature = "serde-serialize")]
use crate::error::Error;
use crate::interning::{Content, Interned};
use rapier3d::dynamics::RigidBodyHandle;

/// Sleeping and stale bodies are looked at once in this many steps.
pub(super) const SWEEP: u32 = 16;

/// The bodies of an immersion and their descriptions.
#[derive(Clone, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct Registry {
    descriptions: Interned<ImmersedBody>,
    bodies: Vec<Option<BodyState>>,
    /// Index into `bodies` of each index of rapier's, or `NONE`.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    lookup: Vec<u32>,
    /// Indices of `bodies` that are free, in the order in which they became so: the place that a body gets
    /// decides in which step it is looked at while it sleeps.
    free: Vec<u32>,
    /// Which of the bodies that a step does not visit are looked at next.
    pub sweep_phase: u32,
    /// Whether bodies may have to enter or leave the fluid.
    #[cfg_attr(feature = "serde-serialize", serde(skip, default = "yes"))]
    pub changed: bool,
    /// Indices of bodies that should be moved and cannot be now: not dynamic, disabled, or refused. Each
    /// step looks at them.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub waiting: Vec<u32>,
    /// Number of bodies in rapier's set in the last step.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub rapier_bodies: usize,
    /// Bodies that rapier may not list as active yet.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub newcomers: Vec<RigidBodyHandle>,
}

#[cfg(feature = "serde-serialize")]
fn yes() -> bool {
    true
}

/// Indices of rapier's that a snapshot may have.
#[cfg(feature = "serde-serialize")]
const MOST_BODIES: u32 = 1 << 26;

#[cfg(feature = "serde-serialize")]
impl Registry {
    /// Checks what was read, and makes the look-up of handles from it.
    ///
    /// # Errors
    /// Those of the descriptions; [`Error::InvalidParameter`] or [`Error::OutOfRange`] names an index or a
    /// body that is there twice.
    pub fn restore(&mut self) -> Result<(), Error> {
        for description in self.descriptions.iter() {
            description.check()?;
        }
        let mut free = self.free.clone();
        free.sort_unstable();
        let gaps = self.bodies.iter().enumerate();
        let gaps = gaps.filter(|(_, state)| state.is_none());
        let same = gaps.map(|(index, _)| index as u32).eq(free);
        let gaps = self.free.len() as f64;
        Error::check("free places for bodies", gaps, same, "each gap once")?;
        for (index, state) in self.bodies.iter().enumerate() {
            let Some(state) = state else {
                continue;
            };
            let described = self.descriptions.get(state.description).is_some();
            let description = f64::from(state.description);
            Error::check(
                "description of a body",
                description,
                described,
                "a known one",
            )?;
            let rapier_index = state.handle.into_raw_parts().0;
            let most = f64::from(MOST_BODIES);
            Error::check_range("index of a body", rapier_index.into(), 0.0, most)?;
            let rapier_index = rapier_index as usize;
            if self.lookup.len() <= rapier_index {
                self.lookup.resize(rapier_index + 1, NONE);
            }
            let once = self.lookup[rapier_index] == NONE;
            Error::check("body", rapier_index as f64, once, "there only once")?;
            self.lookup[rapier_index] = index as u32;
        }
        Ok(())
    }
}

impl Registry {
    /// The index of a description, which is stored if it is new. It has to be given to a body before the
    /// next one is asked for, or it may be forgotten.
    pub fn describe(&mut self, body: ImmersedBody) -> u32 {
        let states = self.bodies.iter().flatten();
        self.descriptions
            .intern(body, || states.map(|state| state.description))
    }

    /// Whether an equal description is known.
    pub fn knows(&self, body: &ImmersedBody) -> bool {
        let hash = body.content_hash();
        self.descriptions
            .find(hash, |known| known == body)
            .is_some()
    }

    /// The description of a body.
    pub fn description(&self, state: &BodyState) -> Option<&ImmersedBody> {
        self.descriptions.get(state.description)
    }

    /// Whether the body of an index is in the fluid.
    pub fn moves(&self, index: usize) -> bool {
        let state = self.bodies.get(index).and_then(Option::as_ref);
        state.is_some_and(|state| state.saved.is_some())
    }

    /// Indices of the constants that are in use.
    pub fn used_constants(&self) -> impl Iterator<Item = u32> {
        self.bodies.iter().flatten().map(|state| state.constants)
    }

    /// Adds a body, or gives one that is there another description. Rapier's invalid handle is that of no
    /// body and is passed over.
    pub fn insert(&mut self, handle: RigidBodyHandle, description: u32) {
        if handle == RigidBodyHandle::invalid() {
            return;
        }
        self.changed = true;
        if let Some(index) = self.index(handle) {
            self.redescribe(index, description);
            if let Some(state) = self.at_mut(index) {
                state.outdated = true;
                state.described_anew = true;
                state.left = None;
            }
            return;
        }
        let body = self.descriptions.get(description);
        let equipment = body.and_then(|body| Equipment::of(body, None));
        let rapier_index = handle.into_raw_parts().0 as usize;
        if self.lookup.len() <= rapier_index {
            self.lookup.resize(rapier_index + 1, NONE);
        }
        // The place that a removed body of the same index left behind is taken over.
        let index = match self.lookup[rapier_index] {
            NONE => self.free.pop().unwrap_or_else(|| {
                self.bodies.push(None);
                self.bodies.len() as u32 - 1
            }),
            stale => stale,
        };
        self.lookup[rapier_index] = index;
        self.bodies[index as usize] = Some(BodyState {
            handle,
            description,
            enabled: true,
            control: BodyControl::default(),
            saved: None,
            left: None,
            constants: NONE,
            layer: 0,
            outdated: false,
            described_anew: false,
            waits: false,
            disabled: false,
            enabling: false,
            refused: None,
            warned: Warned::default(),
            flight: FlightState::default(),
            equipment,
            crossing: None,
        });
    }

    /// Gives the body of an index another description, with the equipment that goes with it.
    pub fn redescribe(&mut self, index: usize, description: u32) {
        let state = self.bodies.get_mut(index).and_then(Option::as_mut);
        if let (Some(state), Some(body)) = (state, self.descriptions.get(description)) {
            state.equipment = Equipment::of(body, state.equipment.take());
            state.description = description;
            state.constants = NONE;
        }
    }

    /// Takes a body out; unknown handles give `None`.
    pub fn remove(&mut self, handle: RigidBodyHandle) -> Option<BodyState> {
        let index = self.index(handle)?;
        self.lookup[handle.into_raw_parts().0 as usize] = NONE;
        self.free.push(index as u32);
        self.bodies[index].take()
    }

    /// Forgets the body at an index, of which rapier has none any more.
    pub fn forget(&mut self, index: usize) -> Option<BodyState> {
        let state = self.bodies.get_mut(index)?.take()?;
        let lookup = &mut self.lookup[state.handle.into_raw_parts().0 as usize];
        if *lookup == index as u32 {
            *lookup = NONE;
            self.free.push(index as u32);
        }
        Some(state)
    }

    /// Puts a body on the list of those that cannot be moved now.
    pub fn wait(&mut self, index: usize) {
        if let Some(state) = self.at_mut(index)
            && !std::mem::replace(&mut state.waits, true)
        {
            self.waiting.push(index as u32);
        }
    }

    /// Takes all bodies off that list.
    pub fn take_waiting(&mut self) -> Vec<u32> {
        let waiting = std::mem::take(&mut self.waiting);
        for index in &waiting {
            if let Some(state) = self.at_mut(*index as usize) {
                state.waits = false;
            }
        }
        waiting
    }

    /// The index of a body.
    pub fn index(&self, handle: RigidBodyHandle) -> Option<usize> {
        let index = *self.lookup.get(handle.into_raw_parts().0 as usize)?;
        let state = self.bodies.get(index as usize)?.as_ref()?;
        (state.handle == handle).then_some(index as usize)
    }

    /// The state of a body.
    pub fn get(&self, handle: RigidBodyHandle) -> Option<&BodyState> {
        self.bodies[self.index(handle)?].as_ref()
    }

    /// The state of a body, to be changed.
    pub fn get_mut(&mut self, handle: RigidBodyHandle) -> Option<&mut BodyState> {
        let index = self.index(handle)?;
        self.bodies[index].as_mut()
    }

    /// All bodies, by index, with gaps.
    pub fn states(&self) -> &[Option<BodyState>] {
        &self.bodies
    }

    /// The state at an index.
    pub fn at_mut(&mut self, index: usize) -> Option<&mut BodyState> {
        self.bodies.get_mut(index)?.as_mut()
    }

    /// All bodies, to be changed.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut BodyState> {
        self.bodies.iter_mut().flatten()
    }

    /// Has the constants of all bodies looked up again, as when the fluid has changed.
    pub fn forget_constants(&mut self) {
        self.changed = true;
        for state in self.iter_mut() {
            state.constants = NONE;
            state.outdated = true;
        }
    }

    /// Number of bodies. Those that rapier has removed count until [`Registry::forget`].
    pub fn len(&self) -> usize {
        self.bodies.len() - self.free.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coupling::body_look::KeptCollider;
    use crate::coupling::saved_properties::SavedProperties;

    /// What the documentation of `Immersion` says of memory.
    #[test]
    fn bytes_per_body() {
        let collider = size_of::<KeptCollider>();
        // With what the allocator adds to two boxes.
        let kept = size_of::<BodyState>() + size_of::<SavedProperties>() + collider + 32;
        assert!(kept <= 820, "{kept}");
    }
}
