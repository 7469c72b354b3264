//! What the coupling keeps of one body.

use super::flight::Integrated;
use super::original::Original;
use super::playback::Player;
use super::stir::Stirred;
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::math::{Real, Vector};

/// No index.
pub(super) const NONE: u32 = u32::MAX;

/// One immersed body.
#[derive(Clone, Debug)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct Slot {
    pub handle: RigidBodyHandle,
    pub description: u32,
    pub enabled: bool,
    /// What the body replays, if it does.
    pub player: Option<Player>,
    /// Factors on the law's drag, rotational lift and translational lift.
    pub control: [f32; 3],
    /// What rapier's body was before; `None` while it is not immersed.
    pub original: Option<Box<Original>>,
    /// Index of the kind; found again after loading a snapshot.
    #[cfg_attr(feature = "serde-serialize", serde(skip, default = "no_kind"))]
    pub kind: u32,
    pub flight: FlightState,
}

#[cfg(feature = "serde-serialize")]
fn no_kind() -> u32 {
    NONE
}

/// What a body in flight carries from step to step besides what rapier keeps.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct FlightState {
    /// As integrated; rapier's attitude follows it to third order.
    pub motion: Integrated,
    /// The velocities that rapier shall have after its step if nothing interferes.
    pub end_linear: Vector,
    pub end_angular: Vector,
    /// Mass that rapier's solver uses, kg.
    pub solver_mass: Real,
    /// Steps in a row whose contacts have been corrected.
    pub contact: u8,
    /// Velocity of the fluid in the last step, m/s, with its fluctuation.
    pub stream: Vector,
    pub stirred: Stirred,
    /// Whether rapier could not be given the right inertia tensor: torques are converted then.
    pub odd_inertia: bool,
    /// Whether all this is from the step before.
    pub flying: bool,
}
