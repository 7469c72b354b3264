//! Which bodies are immersed, by rapier's handles.

use super::body_state::{BodyState, FlightState, NONE};
use super::control::BodyControl;
use super::interning::Interned;
use crate::body::ImmersedBody;
use rapier3d::dynamics::RigidBodyHandle;

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
    lookup: Vec<u32>,
    /// Indices of `bodies` that are free.
    free: Vec<u32>,
    /// Which of the bodies that a step does not visit are looked at next.
    pub sweep_phase: u32,
    /// Whether bodies may have to enter or leave the fluid.
    #[cfg_attr(feature = "serde-serialize", serde(skip, default = "yes"))]
    pub changed: bool,
    /// Bodies that rapier may not list as active yet.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub newcomers: Vec<RigidBodyHandle>,
}

#[cfg(feature = "serde-serialize")]
fn yes() -> bool {
    true
}

impl Registry {
    /// The index of a description, which is stored if it is new.
    pub fn describe(&mut self, body: ImmersedBody) -> u32 {
        self.descriptions.intern(body)
    }

    /// The description of a body.
    pub fn description(&self, state: &BodyState) -> &ImmersedBody {
        self.description_at(state.description)
    }

    /// The description of an index that [`Registry::describe`] has returned.
    pub fn description_at(&self, index: u32) -> &ImmersedBody {
        self.descriptions.get(index)
    }

    /// Adds a body, or gives one that is there another description.
    pub fn insert(&mut self, handle: RigidBodyHandle, description: u32) {
        self.changed = true;
        if let Some(state) = self.get_mut(handle) {
            state.description = description;
            state.constants = NONE;
            return;
        }
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
            constants: NONE,
            flight: FlightState::default(),
        });
    }

    /// Takes a body out; unknown handles give `None`.
    pub fn remove(&mut self, handle: RigidBodyHandle) -> Option<BodyState> {
        let index = self.index(handle)?;
        self.lookup[handle.into_raw_parts().0 as usize] = NONE;
        self.free.push(index as u32);
        self.bodies[index].take()
    }

    /// Forgets the body at an index, of which rapier has none any more.
    pub fn forget(&mut self, index: usize) {
        if let Some(state) = self.bodies[index].take() {
            let lookup = &mut self.lookup[state.handle.into_raw_parts().0 as usize];
            if *lookup == index as u32 {
                *lookup = NONE;
                self.free.push(index as u32);
            }
        }
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
    use crate::coupling::saved_properties::SavedProperties;

    /// What the documentation of `Immersion` says of memory.
    #[test]
    fn bytes_per_body() {
        let kept = size_of::<BodyState>() + size_of::<SavedProperties>() + 64;
        assert!(kept <= 570, "{kept}");
    }
}
