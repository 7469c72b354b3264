//! How the bench is looked at: nothing of it moves a body.

use rapier3d_immersed::DebugRender;
use serde::{Deserialize, Serialize};

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

    /// # Errors
    /// Names what is no number, or an eye in its target.
    pub fn check(&self) -> Result<(), String> {
        let numbers = self.eye.iter().chain(&self.target);
        if !numbers.clone().all(|x| x.is_finite()) {
            return Err("eye or target is no number".into());
        }
        if self.eye == self.target {
            return Err("the eye is in its target".into());
        }
        Ok(())
    }
}
