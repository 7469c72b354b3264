//! What a rapier body was before it was immersed.

use super::shared_constants::SharedConstants;
use crate::body::DryMass;
use crate::body::from_rapier::{inertia_error, uniform_density};
use crate::error::Error;
use rapier3d::dynamics::{
    MassProperties, RigidBodyAdditionalMassProps, RigidBodyHandle, RigidBodySet,
};
use rapier3d::geometry::{ColliderHandle, ColliderSet};
use rapier3d::math::Pose;

/// Mass properties and switches of a rapier body, to be given back.
#[derive(Clone, Debug)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct SavedProperties {
    /// The body's own mass, without fluid.
    pub dry: DryMass,
    colliders: Vec<(ColliderHandle, ColliderMass)>,
    additional: Option<RigidBodyAdditionalMassProps>,
    gyroscopic: bool,
    /// Whether the body's user let it turn by more than 45° per step.
    pub fast_rotation: bool,
}

#[derive(Clone, Copy, Debug)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
enum ColliderMass {
    Density(f32),
    Explicit(MassProperties),
}

#[cfg(feature = "serde-serialize")]
impl SavedProperties {
    /// # Errors
    /// Those of [`DryMass::check`]; [`Error::NotFinite`] names a mass property of a collider.
    pub fn check(&self) -> Result<(), Error> {
        self.dry.check()?;
        let check = |properties: &MassProperties| {
            let frame = properties.principal_inertia_local_frame;
            let numbers = [
                properties.local_com.to_array().as_slice(),
                properties.inv_principal_inertia.to_array().as_slice(),
                frame.to_array().as_slice(),
                &[properties.inv_mass],
            ]
            .concat();
            let numbers: Vec<f64> = numbers.into_iter().map(f64::from).collect();
            Error::check_all_finite("mass properties of a collider", &numbers)
        };
        for (_, mass) in &self.colliders {
            match mass {
                ColliderMass::Density(density) => {
                    Error::check_not_negative("density of a collider", (*density).into())?;
                }
                ColliderMass::Explicit(properties) => check(properties)?,
            }
        }
        match &self.additional {
            Some(RigidBodyAdditionalMassProps::MassProps(properties)) => check(properties),
            Some(RigidBodyAdditionalMassProps::Mass(mass)) => {
                Error::check_not_negative("additional mass", (*mass).into()).map(|_| ())
            }
            None => Ok(()),
        }
    }
}

impl SavedProperties {
    /// Reads a body as it is. Also returns the relative error of rapier's own inertia for it.
    ///
    /// # Errors
    /// Those of [`DryMass::of_body`].
    pub fn of(
        handle: RigidBodyHandle,
        bodies: &RigidBodySet,
        colliders: &ColliderSet,
    ) -> Result<(Self, f64), Error> {
        let dry = DryMass::of_body(bodies, colliders, handle)?;
        let body = &bodies[handle];
        let mut own = body.clone();
        own.recompute_mass_properties_from_colliders(colliders);
        let error = inertia_error(&own.mass_properties().local_mprops, &dry);
        let masses = body.colliders().iter().filter_map(|handle| {
            let collider = colliders.get(*handle)?;
            let mass = uniform_density(collider).map_or_else(
                || ColliderMass::Explicit(collider.mass_properties()),
                ColliderMass::Density,
            );
            Some((*handle, mass))
        });
        let saved = Self {
            dry,
            colliders: masses.collect(),
            additional: body
                .mass_properties()
                .additional_local_mprops
                .as_deref()
                .copied(),
            gyroscopic: body.gyroscopic_forces_enabled(),
            fast_rotation: body.is_fast_rotation_allowed(),
        };
        Ok((saved, error))
    }

    /// Gives the body the mass properties and switches of an immersed one. Returns the relative error of
    /// the inertia that rapier makes of it.
    pub fn immerse(
        &self,
        constants: &SharedConstants,
        mass: f64,
        handle: RigidBodyHandle,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
    ) -> f64 {
        self.set_mass(constants, mass, handle, bodies, colliders);
        let body = &mut bodies[handle];
        body.enable_gyroscopic_forces(false);
        body.set_allow_fast_rotation(true);
        body.recompute_mass_properties_from_colliders(colliders);
        inertia_error(&body.mass_properties().local_mprops, &constants.wet(mass))
    }

    /// Gives the body the mass properties of an immersed one with another scalar mass, kg.
    ///
    /// A single collider carries them all; of several, the first. Carrying them as *additional* mass
    /// properties would send them through the sum with a collider of no mass but with a pose, and so
    /// through the eigenvalue solver that fails for small bodies (see [`DryMass::of_body`]).
    pub fn set_mass(
        &self,
        constants: &SharedConstants,
        mass: f64,
        handle: RigidBodyHandle,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
    ) {
        let properties = constants.rapier_properties(mass);
        let mut carried = false;
        for (handle, _) in &self.colliders {
            let Some(collider) = colliders.get_mut(*handle) else {
                continue;
            };
            if carried {
                collider.set_density(0.0);
            } else {
                let pose = collider.position_wrt_parent().copied();
                let pose = pose.unwrap_or(Pose::IDENTITY);
                collider.set_mass_properties(properties.transform_by(&pose.inverse()));
                carried = collider.is_enabled();
            }
        }
        let left = if carried {
            MassProperties::default()
        } else {
            properties
        };
        bodies[handle].set_additional_mass_properties(left, false);
    }

    /// Gives everything back.
    pub fn restore(
        &self,
        handle: RigidBodyHandle,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
    ) {
        for (handle, mass) in &self.colliders {
            if let Some(collider) = colliders.get_mut(*handle) {
                match mass {
                    ColliderMass::Density(density) => collider.set_density(*density),
                    ColliderMass::Explicit(properties) => {
                        collider.set_mass_properties(*properties);
                    }
                }
            }
        }
        if let Some(body) = bodies.get_mut(handle) {
            match self.additional {
                None => body.set_additional_mass_properties(MassProperties::default(), false),
                Some(RigidBodyAdditionalMassProps::Mass(mass)) => {
                    body.set_additional_mass(mass, false);
                }
                Some(RigidBodyAdditionalMassProps::MassProps(properties)) => {
                    body.set_additional_mass_properties(properties, false);
                }
            }
            body.enable_gyroscopic_forces(self.gyroscopic);
            body.set_allow_fast_rotation(self.fast_rotation);
            body.recompute_mass_properties_from_colliders(colliders);
        }
    }
}
