//! What a rapier body is to its user while the crate has put other mass properties in its place.
//!
//! While a body is immersed, rapier's mass properties for it are the crate's: one collider carries them all
//! ([`SavedProperties::immerse`]), the others and the body's additional mass properties carry none. What its
//! user meant is kept here, with what was written, so that anything else that is found there is known to be
//! the user's and is left alone or taken over.

#[cfg(feature = "serde-serialize")]
use super::body_look::MassSpec;
use super::body_look::{KeptCollider, same};
use super::shared_constants::SharedConstants;
use crate::body::DryMass;
use crate::body::from_rapier::inertia_error;
use crate::error::Error;
use rapier3d::dynamics::{
    MassProperties, RigidBody, RigidBodyAdditionalMassProps, RigidBodyHandle, RigidBodySet,
};
use rapier3d::geometry::{Collider, ColliderSet};
use rapier3d::math::{Pose, Real, Vector};

/// Mass properties and switches of a rapier body, to be given back.
#[derive(Clone, Debug)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct SavedProperties {
    /// The body's own mass, without fluid.
    pub dry: DryMass,
    pub colliders: Vec<KeptCollider>,
    additional: Option<RigidBodyAdditionalMassProps>,
    gyroscopic: bool,
    /// Whether the body's user let it turn by more than 45° per step …
    pub fast_rotation: bool,
    /// … and whether the crate does.
    pub fast_written: bool,
    /// Whether a collider carries the mass; if the body has no enabled one, its additional mass properties
    /// do.
    carried: bool,
    /// What the carrier was given.
    written: MassProperties,
}

/// What has changed of a body since it was last read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Difference {
    Nothing,
    /// Its mass or its switches.
    Mass,
    /// What displaces fluid (and so perhaps the mass).
    Shape,
}

/// An additional mass that says that there is none: a number that nobody sets, too small to change any mass.
const NO_MASS: Real = Real::from_bits(0x0000_a7f1);

/// Mass properties that say that a collider, or a body besides its colliders, has none. To rapier they equal
/// zero; the sign of the inverse mass tells them from a zero of the user's.
const fn none_at(center: Vector) -> MassProperties {
    MassProperties {
        local_com: center,
        inv_mass: -0.0,
        inv_principal_inertia: Vector::ZERO,
        principal_inertia_local_frame: rapier3d::math::Rotation::IDENTITY,
    }
}

/// Whether mass properties are the same to the bit. Each step asks this for each body.
#[inline(always)]
fn are_same(a: &MassProperties, b: &MassProperties) -> bool {
    a.inv_mass.to_bits() == b.inv_mass.to_bits()
        && same(&a.local_com, &b.local_com)
        && same(&a.inv_principal_inertia, &b.inv_principal_inertia)
        && a.principal_inertia_local_frame == b.principal_inertia_local_frame
}

/// Whether mass properties are those of [`none_at`].
fn says_none(properties: &MassProperties) -> bool {
    properties.inv_mass.to_bits() == (-0.0_f32).to_bits()
}

/// What a collider gets that carries no mass. Rapier passes over mass properties that equal those that a
/// collider has; where a pose makes them differ from zero anyway they differ from the start, so that a user
/// can set zero.
fn no_mass(kept: &KeptCollider) -> MassProperties {
    if kept.pose == Pose::IDENTITY {
        none_at(Vector::ZERO)
    } else {
        none_at(Vector::X * 1e-30)
    }
}

/// Whether an immersion has put its mass properties in the place of those of a body that has colliders.
pub(super) fn is_immersed(body: &RigidBody) -> bool {
    match body.mass_properties().additional_local_mprops.as_deref() {
        Some(RigidBodyAdditionalMassProps::MassProps(properties)) => says_none(properties),
        Some(RigidBodyAdditionalMassProps::Mass(mass)) => *mass == NO_MASS,
        None => false,
    }
}

#[cfg(feature = "serde-serialize")]
impl SavedProperties {
    /// # Errors
    /// Those of [`DryMass::check`]; [`Error::NotFinite`] names a mass property of a collider.
    pub fn check(&self) -> Result<(), Error> {
        self.dry.check()?;
        check_properties(&self.written)?;
        for kept in &self.colliders {
            match &kept.mass {
                MassSpec::Density(density) => {
                    Error::check_not_negative("density of a collider", (*density).into())?;
                }
                MassSpec::Mass(mass) => {
                    Error::check_not_negative("mass of a collider", (*mass).into())?;
                }
                MassSpec::Explicit(properties) => check_properties(properties)?,
            }
        }
        match &self.additional {
            Some(RigidBodyAdditionalMassProps::MassProps(properties)) => {
                check_properties(properties)
            }
            Some(RigidBodyAdditionalMassProps::Mass(mass)) => {
                Error::check_not_negative("additional mass", (*mass).into()).map(|_| ())
            }
            None => Ok(()),
        }
    }
}

#[cfg(feature = "serde-serialize")]
fn check_properties(properties: &MassProperties) -> Result<(), Error> {
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
}

impl SavedProperties {
    /// Reads a body that is as its user wants it. Also returns the relative error of rapier's own inertia
    /// for it. `like` is what was read of another body, with its error: one that is made of the same gets
    /// the same mass, without integrating over its shapes again.
    ///
    /// # Errors
    /// Those of [`DryMass::of_body`].
    pub fn of(
        handle: RigidBodyHandle,
        bodies: &mut RigidBodySet,
        colliders: &ColliderSet,
        like: Option<(&Self, f64)>,
    ) -> Result<(Self, f64), Error> {
        let body = bodies.get(handle).ok_or(Error::NoBody)?;
        let mut saved = Self::with_mass(DryMass::NONE, body, colliders);
        if let Some((like, error)) = like
            && saved.weighs_as(like)
        {
            saved.dry = like.dry;
            return Ok((saved, error));
        }
        saved.dry = DryMass::of_body(bodies, colliders, handle)?;
        let body = bodies.get_mut(handle).ok_or(Error::NoBody)?;
        body.recompute_mass_properties_from_colliders(colliders);
        let error = inertia_error(&body.mass_properties().local_mprops, &saved.dry);
        Ok((saved, error))
    }

    fn weighs_as(&self, other: &Self) -> bool {
        self.colliders.len() == other.colliders.len()
            && self.additional == other.additional
            && (self.colliders.iter().zip(&other.colliders)).all(|(a, b)| a.weighs_as(b))
    }

    /// The same for a body whose mass is known.
    pub fn with_mass(dry: DryMass, body: &RigidBody, colliders: &ColliderSet) -> Self {
        let additional = body.mass_properties().additional_local_mprops.as_deref();
        Self {
            dry,
            colliders: KeptCollider::all_of(body, colliders),
            additional: additional.copied(),
            gyroscopic: body.gyroscopic_forces_enabled(),
            fast_rotation: body.is_fast_rotation_allowed(),
            fast_written: true,
            carried: false,
            written: MassProperties::default(),
        }
    }

    /// Gives the body the mass properties and switches of an immersed one. Returns the relative error of
    /// the inertia that rapier makes of it.
    pub fn immerse(
        &mut self,
        constants: &SharedConstants,
        mass: f64,
        handle: RigidBodyHandle,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
    ) -> f64 {
        self.set_mass(constants, mass, handle, bodies, colliders);
        let Some(body) = bodies.get_mut(handle) else {
            return 0.0;
        };
        body.enable_gyroscopic_forces(false);
        body.set_allow_fast_rotation(true);
        self.fast_written = true;
        body.recompute_mass_properties_from_colliders(colliders);
        inertia_error(&body.mass_properties().local_mprops, &constants.wet(mass))
    }

    /// Gives the body the mass properties of an immersed one with another scalar mass, kg.
    ///
    /// A single collider carries them all; of several, the first that is enabled. Carrying them as
    /// *additional* mass properties would send them through the sum with a collider of no mass but with a
    /// pose, and so through the eigenvalue solver that fails for small bodies (see [`DryMass::of_body`]).
    pub fn set_mass(
        &mut self,
        constants: &SharedConstants,
        mass: f64,
        handle: RigidBodyHandle,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
    ) {
        let properties = constants.rapier_properties(mass);
        (self.carried, self.written) = (false, properties);
        for kept in &mut self.colliders {
            kept.carries = false;
            let Some(collider) = colliders.get_mut(kept.handle) else {
                continue;
            };
            if !self.carried && collider.is_enabled() {
                (self.carried, kept.carries) = (true, true);
                self.written = properties.transform_by(&kept.pose.inverse());
                collider.set_mass_properties(self.written);
                // Rapier keeps what equals the new, whatever the signs of its zeros.
                self.written = collider.mass_properties();
            } else {
                collider.set_mass_properties(no_mass(kept));
            }
        }
        let Some(body) = bodies.get_mut(handle) else {
            return;
        };
        if !self.carried {
            body.set_additional_mass_properties(properties, false);
            let now = body.mass_properties().additional_local_mprops.as_deref();
            if let Some(RigidBodyAdditionalMassProps::MassProps(now)) = now {
                self.written = *now;
            }
        } else if self.has_additional() {
            // The user may set zero, which must differ.
            body.set_additional_mass(NO_MASS, false);
        } else {
            // What adds a zero changes no bit of the mass.
            let none = none_at(Vector::ZERO);
            if !is_immersed(body) && body.mass_properties().additional_local_mprops.is_some() {
                // Rapier would keep a zero that is there.
                body.set_additional_mass(NO_MASS, false);
            }
            body.set_additional_mass_properties(none, false);
        }
    }

    /// Whether the user gave the body mass besides that of its colliders.
    fn has_additional(&self) -> bool {
        match &self.additional {
            None => false,
            Some(RigidBodyAdditionalMassProps::Mass(mass)) => *mass != 0.0,
            Some(RigidBodyAdditionalMassProps::MassProps(properties)) => {
                *properties != MassProperties::default()
            }
        }
    }

    /// Whether a collider of the body still has the mass properties that the crate gave it.
    #[inline(always)]
    pub fn wrote(&self, kept: &KeptCollider, collider: &Collider) -> bool {
        let now = collider.mass_properties();
        if kept.carries {
            are_same(&now, &self.written)
        } else {
            says_none(&now)
        }
    }

    /// Whether the body's additional mass properties and its switches are still those that the crate gave
    /// it.
    #[inline(always)]
    pub fn wrote_body(&self, body: &RigidBody) -> bool {
        self.wrote_additional(body)
            && !body.gyroscopic_forces_enabled()
            && body.is_fast_rotation_allowed() == self.fast_written
    }

    #[inline(always)]
    fn wrote_additional(&self, body: &RigidBody) -> bool {
        let now = body.mass_properties().additional_local_mprops.as_deref();
        match now {
            Some(RigidBodyAdditionalMassProps::MassProps(now)) if !self.carried => {
                are_same(now, &self.written)
            }
            Some(RigidBodyAdditionalMassProps::MassProps(now)) => says_none(now),
            Some(RigidBodyAdditionalMassProps::Mass(now)) => *now == NO_MASS,
            None => false,
        }
    }

    /// Gives everything back that is as the crate has set it; what the user has set since stays.
    pub fn restore(
        &self,
        handle: RigidBodyHandle,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
    ) {
        for kept in &self.colliders {
            if let Some(collider) = colliders.get(kept.handle)
                && self.wrote(kept, collider)
                && let Some(collider) = colliders.get_mut(kept.handle)
            {
                kept.mass.give_to(collider);
            }
        }
        if let Some(body) = bodies.get_mut(handle) {
            if self.wrote_additional(body) {
                // Rapier keeps what equals the new, and the crate's zero equals a user's.
                body.set_additional_mass(NO_MASS, false);
                match self.additional {
                    None => body.set_additional_mass_properties(MassProperties::default(), false),
                    Some(RigidBodyAdditionalMassProps::Mass(mass)) => {
                        body.set_additional_mass(mass, false);
                    }
                    Some(RigidBodyAdditionalMassProps::MassProps(properties)) => {
                        body.set_additional_mass_properties(properties, false);
                    }
                }
            }
            if !body.gyroscopic_forces_enabled() {
                body.enable_gyroscopic_forces(self.gyroscopic);
            }
            if body.is_fast_rotation_allowed() == self.fast_written {
                body.set_allow_fast_rotation(self.fast_rotation);
            }
            body.recompute_mass_properties_from_colliders(colliders);
        }
    }
}

impl SavedProperties {
    /// Whether a body is as it was left: the question of every step.
    #[inline(always)]
    pub fn still_holds(&self, body: &RigidBody, colliders: &ColliderSet) -> bool {
        let handles = body.colliders();
        if handles.len() != self.colliders.len() || !self.wrote_body(body) {
            return false;
        }
        for (kept, handle) in self.colliders.iter().zip(handles) {
            let Some(collider) = colliders.get(*handle) else {
                return false;
            };
            if !(kept.is(*handle, collider) && self.wrote(kept, collider)) {
                return false;
            }
        }
        true
    }

    /// What has changed of a body that may not be as it was left.
    pub fn difference(&mut self, body: &RigidBody, colliders: &ColliderSet) -> Difference {
        let handles = body.colliders();
        let mut same_shape = handles.len() == self.colliders.len();
        for (kept, handle) in self.colliders.iter_mut().zip(handles) {
            let collider = colliders.get(*handle);
            same_shape &= collider.is_some_and(|collider| kept.is_loaded(*handle, collider));
        }
        if !same_shape {
            Difference::Shape
        } else if self.still_holds(body, colliders) {
            Difference::Nothing
        } else {
            Difference::Mass
        }
    }
}
