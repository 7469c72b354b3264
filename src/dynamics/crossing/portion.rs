//! A share of a body, and where it is.

use rapier3d::na::Vector3;

/// What of a body or part is in one fluid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(crate) struct Portion {
    /// Share of its volume.
    pub share: f64,
    /// Middle of what is in the fluid, less the middle of the whole: plate axes, m.
    pub shift: Vector3<f64>,
}
