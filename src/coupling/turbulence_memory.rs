//! What is remembered of the turbulence from step to step.

use crate::turbulence::SeenFluctuation;
use rapier3d::math::Vector;

/// What a body, or a part of one, remembers of the turbulence that it moves through.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct TurbulenceMemory {
    pub seen: SeenFluctuation,
    /// Time of the immersion when the turbulence first acted on the body, s.
    pub since: Option<f64>,
    /// The fluctuation of the fluid's velocity in the last step, m/s.
    pub fluctuation: Vector,
    /// The body's velocity through the fluid that it sees, averaged over several memories of the
    /// turbulence, m/s. The momentary one would be correlated with the fluctuation, whose memory it sets,
    /// and would make strong fluctuations last less: a sixth of the variance would be lost.
    pub slip: Vector,
}
