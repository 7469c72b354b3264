//! What a step cannot refuse to do but a user should know.

use super::registry::Registry;
use crate::body::ImmersedBody;
use crate::hydro::OutOfScope;
use rapier3d::dynamics::RigidBodyHandle;

/// Something that a user should know about a body. Collected by the step, which cannot fail.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
#[non_exhaustive]
pub enum Warning {
    /// The body cannot be immersed; it goes on as plain rapier moves it.
    Refused {
        /// The body.
        body: RigidBodyHandle,
        /// Why, in words.
        reason: String,
    },
    /// Rapier's own inertia tensor for the body was wrong (see [`DryMass::of_body`](crate::DryMass::of_body)); while it is
    /// immersed it has the right one.
    WrongInertia {
        /// The body.
        body: RigidBodyHandle,
        /// Largest error of an entry over the largest entry.
        relative_error: f64,
    },
    /// Rapier's inertia tensor is wrong while the body is immersed, too: it has several colliders,
    /// away from the body's origin, and is small. Free flight is right all the same; contacts turn
    /// it wrongly. One compound collider instead of several avoids it.
    OddInertia {
        /// The body.
        body: RigidBodyHandle,
        /// Largest error of an entry over the largest entry.
        relative_error: f64,
    },
    /// A rounded collider of the body has a density, and rapier's mass of it is that of the core, without the
    /// border. The body keeps that mass, and floats by its whole volume: the numbers say whether it does so
    /// wrongly. [`DryMass::of_shape`](crate::DryMass::of_shape) gives it the mass of the whole.
    CoreMass {
        /// The body.
        body: RigidBodyHandle,
        /// Rapier's mass of the body's colliders, kg.
        rapier_mass: f64,
        /// Their mass with the borders at the same density, kg.
        whole_mass: f64,
    },
    /// The user has changed the shape of the body, but its description is not what
    /// [`HydroProperties::from_body`](crate::HydroProperties::from_body) makes of the shape that it had: it
    /// is kept as the user gave it, and only the mass is taken over. Insert a description of the new shape.
    ShapeKept {
        /// The body.
        body: RigidBodyHandle,
    },
    /// The user has changed what the body is made of, and
    /// [`BodyChanges::Ignore`](crate::BodyChanges::Ignore) has it go on as before.
    ChangeIgnored {
        /// The body.
        body: RigidBodyHandle,
    },
    /// The default law does not see all of the shape that the body is described by. Said once of equal descriptions,
    /// when the first body enters under one; it is in the fluid all the same.
    OutOfScope {
        /// The first body of this description.
        body: RigidBodyHandle,
        /// What is not seen, and how much.
        reason: OutOfScope,
    },
    /// A part is so far from the body's colliders that its place is likely to be a mistake: of units, or one in the
    /// world's frame. It is moved with the body all the same.
    FarPart {
        /// The body.
        body: RigidBodyHandle,
        /// Index of the part.
        part: usize,
        /// From the colliders' box to the part's center, m.
        distance: f64,
        /// Diagonal of the colliders' box and the part's length together, m.
        size: f64,
    },
    /// The body is in the fluid of another [`Immersion`](crate::Immersion), or was in one that was dropped
    /// without giving it back ([`Immersion::remove`](crate::Immersion::remove)): its mass properties are not
    /// its own. This immersion leaves it alone until the other one has given it back.
    ImmersedTwice {
        /// The body.
        body: RigidBodyHandle,
    },
    /// The flow at the body was no number: the fluid around it stayed as it was.
    FlowNotFinite {
        /// The body.
        body: RigidBodyHandle,
    },
    /// A layer of the medium is lighter than the one above it: in nature they would change places, and here what floats
    /// between them is not held.
    LighterBelow {
        /// Index of the lighter layer.
        layer: usize,
        /// Its density, kg/m³.
        density: f32,
        /// Density of the layer above, kg/m³.
        above: f32,
    },
    /// The world's gravity is not opposite to the medium's up ([`Medium::with_up`](crate::Medium::with_up)): where a free
    /// surface cuts a body its buoyancy acts along up all the same, with what of the gravity is along it.
    TiltedGravity,
    /// A step was begun ([`Immersion::before_step`](crate::Immersion::before_step)) before the last one was
    /// finished ([`Immersion::after_step`](crate::Immersion::after_step)): contacts were not corrected.
    UnfinishedStep,
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Refused { body, reason } => write!(f, "{body:?} is not immersed: {reason}"),
            Self::CoreMass {
                body,
                rapier_mass,
                whole_mass,
            } => write!(
                f,
                "rapier gives {body:?} {rapier_mass:.4} kg, the mass of its rounded shape without the border; \
                 at its density the whole has {whole_mass:.4} kg (see DryMass::of_shape)"
            ),
            Self::FlowNotFinite { body } => {
                write!(
                    f,
                    "the flow at {body:?} is no number; the fluid stays as it was there"
                )
            }
            Self::ShapeKept { body } => write!(
                f,
                "the shape of {body:?} has changed, but its description is the user's own and is kept"
            ),
            Self::OutOfScope { body, reason } => {
                write!(
                    f,
                    "{body:?} is not one of the default law's bodies: {reason}"
                )
            }
            Self::FarPart {
                body,
                part,
                distance,
                size,
            } => write!(
                f,
                "part {part} of {body:?} is {distance:.3} m from its colliders, which with the part are \
                 {size:.3} m long: is its pose in the body's frame, in m?"
            ),
            Self::ChangeIgnored { body } => {
                write!(
                    f,
                    "a change of {body:?} was seen and is ignored while it is immersed"
                )
            }
            Self::ImmersedTwice { body } => write!(
                f,
                "{body:?} is not immersed: another immersion holds it, or did not give it back"
            ),
            Self::LighterBelow {
                layer,
                density,
                above,
            } => write!(
                f,
                "layer {layer} of the medium, of {density} kg/m³, is lighter than the one above it, of {above} kg/m³"
            ),
            Self::TiltedGravity => write!(
                f,
                "the world's gravity is not opposite to the medium's up: buoyancy at the surface acts along up"
            ),
            Self::UnfinishedStep => write!(
                f,
                "before_step was called twice without after_step in between"
            ),
            Self::WrongInertia {
                body,
                relative_error,
            } => write!(
                f,
                "rapier's own inertia tensor of {body:?} is wrong by {:.0} %; corrected while immersed",
                relative_error * 100.0
            ),
            Self::OddInertia {
                body,
                relative_error,
            } => write!(
                f,
                "rapier makes an inertia tensor that is wrong by {:.0} % of the colliders of {body:?}, \
                 which shows in contacts; use one compound collider",
                relative_error * 100.0
            ),
        }
    }
}

/// The warnings so far.
#[derive(Clone, Debug, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct Warnings {
    pub list: Vec<Warning>,
}

impl Warnings {
    /// Keeps a warning, and passes its text to the `log` crate at level `warn`.
    pub fn push(&mut self, warning: Warning) {
        log::warn!("{warning}");
        self.list.push(warning);
    }

    /// Keeps what the default law does not see of a description that is new: `body` is the first under it.
    pub fn push_scope(
        &mut self,
        body: RigidBodyHandle,
        description: &ImmersedBody,
        known: &Registry,
    ) {
        let reasons = description.out_of_scope();
        if !reasons.is_empty() && !known.knows(description) {
            for reason in reasons {
                self.push(Warning::OutOfScope { body, reason });
            }
        }
    }

    /// Keeps a warning that concerns the whole set, unless it is there already.
    pub fn push_once(&mut self, warning: Warning) {
        if !self.list.contains(&warning) {
            self.push(warning);
        }
    }
}
