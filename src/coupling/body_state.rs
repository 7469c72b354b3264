//! What the coupling keeps of one body: plain data.

use super::body_mass::BodyMass;
use super::control::BodyControl;
use super::crossing_memory::CrossingMemory;
use super::equipment::Equipment;
use super::saved_properties::SavedProperties;
use super::shared_constants::SharedConstants;
use super::turbulence_memory::TurbulenceMemory;
use crate::math::Row;
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::math::{Real, Rotation, Vector};
use rapier3d::na::Matrix6;
use std::borrow::Cow;

/// No index.
pub(super) const NONE: u32 = u32::MAX;

/// One immersed body.
#[derive(Clone, Debug)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct BodyState {
    pub handle: RigidBodyHandle,
    /// Index of the body's description in the registry.
    pub description: u32,
    pub enabled: bool,
    pub control: BodyControl,
    /// What rapier's body was before; `None` while it is not immersed.
    pub saved: Option<Box<SavedProperties>>,
    /// What rapier's body was when it last left the fluid or was refused there: what it is made of when it
    /// comes back is compared with this.
    pub left: Option<Box<SavedProperties>>,
    /// Index of the constants that the body shares with its equals, `NONE` until they are known. They are
    /// made again when a snapshot is loaded.
    #[cfg_attr(feature = "serde-serialize", serde(skip, default = "none"))]
    pub constants: u32,
    /// The layer of the medium whose constants they are.
    pub layer: u8,
    /// Whether rapier's body is as another description or fluid wanted it.
    pub outdated: bool,
    /// Whether the user has described the body anew since rapier's body was last read: a shape that has
    /// changed meanwhile is the one that was described.
    pub described_anew: bool,
    /// Whether the body is on the list of those that cannot be moved now.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub waits: bool,
    /// Whether the body waits because it is disabled in rapier.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub disabled: bool,
    /// Whether it has just been enabled again: its colliders are with rapier's next step, and cannot be
    /// looked at before.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub enabling: bool,
    /// What the body was made of when it was refused, as a number: it is tried again when that changes.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub refused: Option<u64>,
    pub warned: Warned,
    pub flight: FlightState,
    /// What a body of parts or engines has besides.
    pub equipment: Option<Box<Equipment>>,
    /// What a body keeps that a boundary of fluids may cut: in a medium of several.
    pub crossing: Option<Box<CrossingMemory>>,
}

impl BodyState {
    /// The 6×6 mass of body and fluid about the center of mass, body axes, `shared` being the body's constants.
    pub fn mass_matrix(&self, shared: &SharedConstants) -> Matrix6<f64> {
        match &self.crossing {
            Some(memory) if memory.active => memory.mass.to_matrix6(&shared.constants.axes),
            _ => shared.mass_matrix(),
        }
    }

    /// The same as contacts and joints feel it.
    pub fn mass<'a>(&self, shared: &'a SharedConstants) -> Cow<'a, BodyMass> {
        // Rapier has the inertia of a body that is whole in the lowest fluid.
        let cut = self.crossing.as_ref().filter(|memory| memory.active);
        let own = cut.and_then(|memory| {
            let whole = memory.mass.to_matrix6(&shared.constants.axes);
            let mut own = BodyMass::of(whole, true)?;
            own.cut = true;
            Some(own)
        });
        own.map_or(Cow::Borrowed(&shared.mass), Cow::Owned)
    }
}

#[cfg(feature = "serde-serialize")]
fn none() -> u32 {
    NONE
}

/// Of what the user has been warned for one body: each once.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct Warned {
    /// One bit for each kind of reason.
    pub refused: u64,
    pub immersed_twice: bool,
    pub shape_kept: bool,
    pub change_ignored: bool,
    pub inertia: bool,
    pub core_mass: bool,
    pub far_part: bool,
    pub flow: bool,
}

/// What a body in flight carries from step to step besides what rapier keeps. World axes.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct FlightState {
    /// The motion as it was integrated; rapier's attitude follows it to third order.
    pub motion: IntegratorState,
    /// The velocities that rapier shall have after its step if nothing interferes, m/s and rad/s.
    pub end_linear: Vector,
    pub end_angular: Vector,
    /// Mass that rapier's solver uses, kg.
    pub solver_mass: Real,
    /// Impulse of joints or friction that the last step found or counted on, N·s, world axes, and the time
    /// that it took, s.
    pub constraint_impulse: Vector,
    pub constraint_time: Real,
    /// Whether that impulse turns with the body.
    pub constraint_turns: bool,
    /// Change of the angular velocity that the joints caused in the last step, rad/s, world axes.
    pub constraint_turn: Vector,
    /// Energy that rounding and the finite step have lost to a jointed body, J: what they may give back.
    pub energy_reserve: Real,
    /// Steps in a row in which the body was in contact.
    pub contact_steps: u8,
    /// Force of the fluid in the last step while something held the body, N.
    pub fluid_force: Vector,
    /// Steps whose contacts have been corrected since the body last touched nothing.
    pub corrected_contacts: u8,
    /// Velocity of the fluid in the last step, m/s, with its fluctuation.
    pub fluid_velocity: Vector,
    pub turbulence: TurbulenceMemory,
    /// Kinetic energy of the turbulence when it last woke the body, m²/s².
    pub turbulent_energy: Real,
    /// Whether rapier could not be given the right inertia tensor: torques are converted then.
    pub converts_torque: bool,
    /// Whether joints held the body in the step before: its motion is another then than was integrated.
    pub was_held: bool,
    /// Whether all this is from the step before.
    pub continues: bool,
}

impl FlightState {
    /// Forgets what its joints did.
    pub fn forget_joints(&mut self) {
        self.constraint_impulse = Vector::ZERO;
        self.constraint_time = 0.0;
        self.constraint_turns = false;
        self.constraint_turn = Vector::ZERO;
    }

    /// Forgets what held the body.
    pub fn let_go(&mut self) {
        self.forget_joints();
        self.fluid_force = Vector::ZERO;
        self.energy_reserve = 0.0;
        self.contact_steps = 0;
    }
}

/// The motion of a body as the integrator carries it from step to step: plate axes, relative to the
/// fluid. The rows are vectors, filled up with a zero.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct IntegratorState {
    /// Plate axes to world: a quaternion (x, y, z, w).
    pub attitude: Row,
    /// u, m/s.
    pub linear: Vector,
    /// Length of the last substep, s.
    pub last_substep: Real,
    /// w = ωL, m/s.
    pub angular: Vector,
    /// Number of substeps in the last step.
    pub substeps: Real,
    /// Acceleration over the last substep, u̇ + ω × u and ẇ, m/s² …
    pub linear_rate: Row,
    pub angular_rate: Row,
    /// … and its change between the last two, m/s³.
    pub linear_trend: Row,
    pub angular_trend: Row,
}

impl IntegratorState {
    /// At rest in the fluid, its axes those of the world, without history.
    pub const REST: Self = Self {
        attitude: [0.0, 0.0, 0.0, 1.0],
        linear: Vector::ZERO,
        last_substep: 0.0,
        angular: Vector::ZERO,
        substeps: 0.0,
        linear_rate: [0.0; 4],
        angular_rate: [0.0; 4],
        linear_trend: [0.0; 4],
        angular_trend: [0.0; 4],
    };

    /// At rest in the fluid, without history.
    pub fn at(attitude: Rotation) -> Self {
        Self {
            attitude: attitude.to_array(),
            ..Self::REST
        }
    }
}
