//! The components of immersed bodies.

use crate::reflect::{ForceBreakdownWrapper, ForceFactorsWrapper, ViscousLawWrapper};
use bevy::prelude::*;
use rapier3d_immersed::{
    Accuracy, Division, Error, ForceBreakdown, ForceFactors, HydroProperties, ImmersedBody,
    ViscousLaw,
};
use std::sync::Arc;

use bevy_rapier3d::rapier::prelude::{ColliderSet, RigidBodyHandle, RigidBodySet};

/// Lets a body of bevy_rapier move in the fluid. Without it the body is rapier's own again.
///
/// Goes on the entity with the [`RigidBody`](bevy_rapier3d::prelude::RigidBody); colliders may be on it or on its
/// children, and may come, go and change at any time, as may the fields of this component. A body that cannot be immersed
/// (without collider or mass) is rapier's own until it can; [`ImmersionWarning`](crate::ImmersionWarning) says why.
///
/// While it is immersed rapier's masses are what the solver uses, and so are bevy_rapier's `ReadMassProperties` and
/// `ReadColliderMassProperties`; [`Immersion::mass_of`](rapier3d_immersed::Immersion::mass_of) is the body's own.
/// Bevy_rapier's `ExternalImpulse` acts on the body's own mass,
/// [`Immersion::apply_impulse`](rapier3d_immersed::Immersion::apply_impulse) on that of body and fluid.
///
/// ```
/// use bevy_rapier3d_immersed::prelude::*;
///
/// let leaf = Immersed::default();
/// let swings = Immersed::with_law(ViscousLaw::Thesis(ThesisLaw::new(ThesisLaw::ZIGZAG)));
/// let parachute = Immersed {
///     factors: ForceFactors { drag: 2.0, ..ForceFactors::ONE },
///     ..Immersed::default()
/// };
/// # let _ = (leaf, swings, parachute);
/// ```
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
pub struct Immersed {
    /// How the viscous force is computed. One whose coefficients cannot be is refused.
    #[reflect(remote = ViscousLawWrapper)]
    pub law: ViscousLaw,
    /// Factors on the law's forces.
    #[reflect(remote = ForceFactorsWrapper)]
    pub factors: ForceFactors,
    /// What the fluid feels of the body.
    pub description: Description,
}

/// What the fluid feels of a body, and how accurately.
#[derive(Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Default, Clone, Debug, PartialEq)]
pub enum Description {
    /// Its colliders, divided into parts where they are apart ([`Division::Automatic`]).
    #[default]
    Colliders,
    /// Its colliders, all as one ([`Division::Whole`]).
    Whole,
    /// Its colliders, each as a part ([`Division::EachCollider`]).
    EachCollider,
    /// Its colliders, with their added mass by boundary elements (feature `bake`). It takes up to seconds.
    #[cfg(feature = "bake")]
    Mesh {
        /// Relative error to refine to, positive; 0.01 is a good choice.
        tolerance: f64,
    },
    /// What the user gives, whatever the colliders are: parts, thrusters, properties from a file.
    Given(GivenBody),
}

/// A description that entities share. Its law is that of [`Immersed`].
#[derive(Reflect, Clone, Debug, PartialEq, Deref)]
#[reflect(opaque, Clone, Debug, PartialEq)]
pub struct GivenBody(pub Arc<ImmersedBody>);

impl Immersed {
    /// A body of this law, as its colliders are.
    pub fn with_law(law: ViscousLaw) -> Self {
        Self {
            law,
            ..Self::default()
        }
    }

    /// A body of this description: [`HydroProperties`](rapier3d_immersed::HydroProperties), or an [`ImmersedBody`] with
    /// its law, parts and thrusters, in the frame of the rigid body.
    pub fn with_body(body: impl Into<ImmersedBody>) -> Self {
        let body = body.into();
        Self {
            law: body.law,
            description: Description::Given(GivenBody(Arc::new(body))),
            ..Self::default()
        }
    }

    /// What a body of rapier is to the fluid.
    ///
    /// # Errors
    /// Those of [`HydroProperties::from_body`], which a given description does not have.
    pub(crate) fn describe(
        &self,
        bodies: &RigidBodySet,
        colliders: &ColliderSet,
        handle: RigidBodyHandle,
    ) -> Result<ImmersedBody, Error> {
        let divided =
            |division| HydroProperties::from_body_divided(bodies, colliders, handle, division);
        let with = |accuracy| HydroProperties::from_body_with(bodies, colliders, handle, accuracy);
        let hydro = match &self.description {
            Description::Colliders => with(Accuracy::default())?,
            Description::Whole => divided(Division::Whole)?,
            Description::EachCollider => divided(Division::EachCollider)?,
            #[cfg(feature = "bake")]
            Description::Mesh { tolerance } => with(Accuracy::Mesh {
                tolerance: *tolerance,
            })?,
            Description::Given(GivenBody(body)) => {
                let body = (**body).clone();
                return Ok(ImmersedBody {
                    law: self.law,
                    ..body
                });
            }
        };
        Ok(ImmersedBody {
            law: self.law,
            ..ImmersedBody::new(hydro)
        })
    }
}

/// The forces on an immersed body after the last step, N and N·m about its center of mass, world axes. Put it on an entity
/// to have them written there; zero as long as the body is not in the fluid.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Deref)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
pub struct FluidForces(
    /// By component.
    #[reflect(remote = ForceBreakdownWrapper)]
    pub ForceBreakdown,
);
