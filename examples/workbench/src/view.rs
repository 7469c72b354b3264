//! How the bench is looked at: nothing of it moves a body.

use crate::change::Change;
use rapier3d_immersed::DebugRender;
use rapier3d_immersed::rapier3d::math::Vector;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// Greatest coordinate of eye and target, m.
const FARTHEST: f32 = 100.0;
/// From the eye to its target, m.
pub(crate) const DISTANCE: RangeInclusive<f32> = 0.1..=40.0;

/// Where one looks from, and what is shown.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct View {
    /// Where the eye is, m.
    pub eye: [f32; 3],
    /// What it looks at, m.
    pub target: [f32; 3],
    /// Arrows of the forces by their components.
    pub forces: bool,
    /// Outlines of the planforms.
    pub planforms: bool,
    /// The ellipsoids that stand for shapes whose added mass is not solved for.
    pub proxies: bool,
    /// Arrows of the flow at the bodies.
    pub flow: bool,
    /// Where bodies have been in the last two seconds.
    pub trails: bool,
    /// The phase diagram.
    pub phase: bool,
    /// The panel.
    pub panel: bool,
    /// The body that is spoken of, if one is.
    pub selected: Option<usize>,
}

impl Default for View {
    fn default() -> Self {
        Self {
            eye: [1.6, 1.5, 3.2],
            target: [0.0, 0.75, 0.0],
            forces: true,
            planforms: false,
            proxies: false,
            flow: false,
            trails: false,
            phase: false,
            panel: true,
            selected: Some(0),
        }
    }
}

impl View {
    /// What of the fluid is drawn as lines.
    pub fn debug_render(&self) -> DebugRender {
        DebugRender {
            forces: self.forces,
            planforms: self.planforms,
            proxies: self.proxies,
            flow: self.flow,
            ..DebugRender::default()
        }
    }

    /// After a body was removed another one has its number.
    pub(crate) fn forget(&mut self, change: &Change) {
        self.selected = match (change, self.selected) {
            (Change::Clear, _) => None,
            (Change::Remove(gone), Some(selected)) if *gone == selected => None,
            (Change::Remove(gone), Some(selected)) if *gone < selected => Some(selected - 1),
            (_, selected) => selected,
        };
    }

    /// # Errors
    /// Names an eye or a target that is no number or too far away, and an eye that is too near its target or too far from it.
    pub fn check(&self) -> Result<(), String> {
        let mut numbers = self.eye.iter().chain(&self.target);
        if !numbers.all(|x| x.abs() <= FARTHEST) {
            return Err(format!("eye or target is no place within {FARTHEST} m"));
        }
        let [a, b] = [self.eye, self.target].map(Vector::from);
        let distance = (a - b).length();
        if !DISTANCE.contains(&distance) {
            let (least, most) = DISTANCE.into_inner();
            return Err(format!(
                "the eye is {distance} m from its target, not {least} to {most}"
            ));
        }
        Ok(())
    }
}
