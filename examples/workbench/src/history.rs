//! Moments that were, to go back to.

use crate::state::State;
use rapier3d_immersed::Immersion;
use rapier3d_immersed::rapier3d::prelude::PhysicsWorld;
use std::collections::VecDeque;

/// Steps between two snapshots: a quarter of a second.
const INTERVAL: u64 = 60;
/// Bytes that snapshots of rapier's world may take. Beyond, every second one is dropped, and going back there takes longer.
const MOST_BYTES: usize = 64 << 20;

/// The world at a moment, before the changes that were made then.
struct Snapshot {
    /// All but the world and the fluid.
    state: State,
    /// The world and the fluid, as rapier and the crate write them.
    bytes: Vec<u8>,
    /// Changes that had been made.
    done: usize,
}

/// Snapshots in order, the first of the beginning.
#[derive(Default)]
pub struct History {
    snapshots: VecDeque<Snapshot>,
}

impl History {
    /// Whether a moment at this step is kept.
    pub fn is_due(step: u64) -> bool {
        step.is_multiple_of(INTERVAL)
    }

    /// Keeps a moment if it is due, and after those that are kept.
    ///
    /// # Errors
    /// If rapier's world cannot be written.
    pub fn keep(&mut self, state: &State, done: usize) -> Result<(), String> {
        let last = self.snapshots.back().map(|last| last.state.step);
        let new = last.is_none_or(|last| state.step > last);
        if !(new && Self::is_due(state.step)) {
            return Ok(());
        }
        let both = (state.world(), &state.immersion);
        let bytes = postcard::to_stdvec(&both).map_err(|error| error.to_string())?;
        let empty = Immersion::new(state.settings.fluid());
        let state = state.with(PhysicsWorld::new(), empty);
        self.snapshots.push_back(Snapshot { state, bytes, done });
        let bytes: usize = self.snapshots.iter().map(|kept| kept.bytes.len()).sum();
        if bytes > MOST_BYTES {
            let mut index = 0;
            self.snapshots.retain(|_| {
                index += 1;
                index % 2 == 1
            });
        }
        Ok(())
    }

    /// The last moment kept that is not after a step, and how many changes had been made by then.
    ///
    /// # Errors
    /// If there is none.
    pub fn before(&self, step: u64) -> Result<(State, usize), String> {
        let mut kept = self.snapshots.iter().rev();
        let kept = kept
            .find(|kept| kept.state.step <= step)
            .ok_or("nothing is kept of that time")?;
        let both = postcard::from_bytes(&kept.bytes);
        let (world, immersion) = both.map_err(|error| error.to_string())?;
        let mut state = kept.state.with(world, immersion);
        state.restore_flows()?;
        Ok((state, kept.done))
    }

    /// Forgets what is after a step, or has more than so many changes in it.
    pub fn forget(&mut self, step: u64, done: usize) {
        self.snapshots
            .retain(|kept| kept.state.step <= step && kept.done <= done);
    }
}
