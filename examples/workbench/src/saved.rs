//! A scene in a file: what was changed when, from which everything else follows bit by bit.

use crate::bench::{Entry, LONGEST_FALL};
use crate::view::View;
use serde::{Deserialize, Serialize};

/// Version of the file. Others are refused.
const VERSION: u32 = 1;

/// A scene as it is written: JSON that can be read, and written by hand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Saved {
    /// Version of the file.
    pub version: u32,
    /// The step that the scene is at: 240 in a second.
    pub step: u64,
    /// How it is looked at.
    #[serde(default)]
    pub view: View,
    /// What was changed, in order.
    pub changes: Vec<Entry>,
}

impl Saved {
    /// A scene at a step.
    pub fn new(step: u64, view: View, changes: Vec<Entry>) -> Self {
        Self {
            version: VERSION,
            step,
            view,
            changes,
        }
    }

    /// The file.
    ///
    /// # Errors
    /// If something in it cannot be written.
    pub fn to_text(&self) -> Result<String, String> {
        let text = serde_json::to_string_pretty(self).map_err(|error| error.to_string())?;
        Ok(text + "\n")
    }

    /// The scene of a file.
    ///
    /// # Errors
    /// Names what cannot be.
    pub fn from_text(text: &str) -> Result<Self, String> {
        let saved: Self = serde_json::from_str(text).map_err(|error| error.to_string())?;
        if saved.version != VERSION {
            let found = saved.version;
            return Err(format!(
                "version {found} of the file; this bench reads {VERSION}"
            ));
        }
        if saved.step > LONGEST_FALL {
            return Err(format!("step {} is beyond {LONGEST_FALL}", saved.step));
        }
        saved.view.check()?;
        if !saved.changes.is_sorted_by_key(|entry| entry.step) {
            return Err("the changes are not in the order of their steps".into());
        }
        let changes = saved.changes.into_iter().map(|entry| {
            let (change, _) = entry.change.held()?;
            Ok(Entry { change, ..entry })
        });
        Ok(Self {
            changes: changes.collect::<Result<_, String>>()?,
            ..saved
        })
    }
}
