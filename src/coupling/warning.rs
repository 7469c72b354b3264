//! What a step cannot refuse to do but a user should know.

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
    /// The flow at the body was no number: the fluid around it stayed as it was.
    FlowNotFinite {
        /// The body.
        body: RigidBodyHandle,
    },
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

    /// Keeps a warning that concerns the whole set, unless it is there already.
    pub fn push_once(&mut self, warning: Warning) {
        if !self.list.contains(&warning) {
            self.push(warning);
        }
    }
}
