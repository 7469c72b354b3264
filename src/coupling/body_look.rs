//! What a rapier body is made of, as it was last seen: rapier tells nobody which bodies a user has changed.

use crate::geometry::equal_shapes;
use rapier3d::dynamics::{MassProperties, RigidBody, RigidBodyAdditionalMassProps};
use rapier3d::geometry::{Collider, ColliderHandle, ColliderSet, SharedShape};
use rapier3d::math::{Pose, Real, Vector};
use std::hash::{DefaultHasher, Hasher};
use std::sync::Arc;

/// What becomes of a body in the fluid whose colliders or mass its user changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum BodyChanges {
    /// The next step moves the body as what it has become. Its mass is always taken over. So is its shape,
    /// if the body's description is what
    /// [`HydroProperties::from_body`](crate::HydroProperties::from_body) made of the shape that it had; another description is the user's own
    /// and stays, with a [`Warning::ShapeKept`](crate::Warning::ShapeKept). Velocities stay as they are, as in rapier.
    #[default]
    Follow,
    /// The body goes on as what it was when it entered the fluid, with a [`Warning::ChangeIgnored`](crate::Warning::ChangeIgnored); when it
    /// leaves the fluid it is what its user has made of it. Contacts are those of the new shape.
    Ignore,
}

/// How a user gave a collider its mass.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) enum MassSpec {
    /// kg/m³.
    Density(Real),
    /// kg, spread evenly.
    Mass(Real),
    Explicit(MassProperties),
}

impl MassSpec {
    /// Rapier shows the result only; what it comes from is what gives the same again.
    fn of(collider: &Collider) -> Self {
        let properties = collider.mass_properties();
        let density = collider.density();
        if collider.shape().mass_properties(density) == properties {
            return Self::Density(density);
        }
        let mut even = collider.shape().mass_properties(1.0);
        even.set_mass(collider.mass(), true);
        if even == properties {
            Self::Mass(collider.mass())
        } else {
            Self::Explicit(properties)
        }
    }

    /// Gives a collider its mass back.
    pub fn give_to(&self, collider: &mut Collider) {
        // Rapier keeps what equals the new, and the crate's zero equals a user's.
        collider.set_density(match self {
            Self::Density(density) => *density,
            Self::Mass(_) | Self::Explicit(_) => 1.0,
        });
        match self {
            Self::Density(_) => {}
            Self::Mass(mass) => collider.set_mass(*mass),
            Self::Explicit(properties) => collider.set_mass_properties(*properties),
        }
    }
}

/// One collider of a body, as it was when the body was last read.
#[derive(Clone, Debug)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct KeptCollider {
    pub handle: ColliderHandle,
    pub mass: MassSpec,
    /// In the body's frame.
    pub pose: Pose,
    pub enabled: bool,
    pub sensor: bool,
    /// Whether it carries the mass of the body while that is immersed.
    pub carries: bool,
    /// The shape itself: as long as it is held here, whoever changes it gets a copy at another address.
    /// `None` after loading.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub shape: Option<SharedShape>,
    /// What tells the shape from others where the address does not, after loading.
    #[cfg(feature = "serde-serialize")]
    shape_mark: u64,
}

impl KeptCollider {
    pub fn of(handle: ColliderHandle, collider: &Collider) -> Self {
        Self {
            handle,
            mass: MassSpec::of(collider),
            pose: pose_of(collider),
            enabled: collider.is_enabled(),
            sensor: collider.is_sensor(),
            carries: false,
            shape: Some(collider.shared_shape().clone()),
            #[cfg(feature = "serde-serialize")]
            shape_mark: shape_mark(collider),
        }
    }

    /// The colliders of a body.
    pub fn all_of(body: &RigidBody, colliders: &ColliderSet) -> Vec<Self> {
        let kept = body.colliders().iter().filter_map(|handle| {
            let collider = colliders.get(*handle)?;
            Some(Self::of(*handle, collider))
        });
        kept.collect()
    }

    /// Whether the collider displaces fluid.
    pub fn is_solid(&self) -> bool {
        self.enabled && !self.sensor
    }

    /// Whether a collider is this one, of the same shape at the same place.
    #[inline(always)]
    pub fn is(&self, handle: ColliderHandle, collider: &Collider) -> bool {
        let (Some(shape), Some(pose)) = (&self.shape, collider.position_wrt_parent()) else {
            return false;
        };
        self.handle == handle
            && Arc::ptr_eq(&shape.0, &collider.shared_shape().0)
            && self.enabled == collider.is_enabled()
            && self.sensor == collider.is_sensor()
            && same(&pose.translation, &self.pose.translation)
            && pose.rotation == self.pose.rotation
    }

    /// Whether another collider that is read in the same state gives its body the same mass.
    pub fn weighs_as(&self, other: &Self) -> bool {
        self.mass == other.mass
            && self.enabled == other.enabled
            && self.pose == other.pose
            && (self.shape.as_deref().zip(other.shape.as_deref()))
                .is_some_and(|(a, b)| equal_shapes(a, b))
    }

    /// The same where the shape may have another address, because it or this was loaded: it is held from now on if it is the
    /// one that was kept.
    pub fn is_loaded(&mut self, handle: ColliderHandle, collider: &Collider) -> bool {
        if self.has_shape_of(collider) {
            self.shape = Some(collider.shared_shape().clone());
        }
        self.is(handle, collider)
    }

    fn has_shape_of(&self, collider: &Collider) -> bool {
        #[cfg(feature = "serde-serialize")]
        if self.shape.is_none() {
            return shape_mark(collider) == self.shape_mark;
        }
        let shape = self.shape.as_deref();
        shape.is_some_and(|shape| equal_shapes(shape, collider.shape()))
    }
}

/// Whether two vectors are the same to the bit: bits compare faster than numbers.
#[inline(always)]
pub(super) fn same(a: &Vector, b: &Vector) -> bool {
    a.x.to_bits() == b.x.to_bits()
        && a.y.to_bits() == b.y.to_bits()
        && a.z.to_bits() == b.z.to_bits()
}

fn pose_of(collider: &Collider) -> Pose {
    let pose = collider.position_wrt_parent().copied();
    pose.unwrap_or(Pose::IDENTITY)
}

/// A number that stays while nobody changes what a body is made of, and hardly can otherwise.
pub(super) fn body_mark(body: &RigidBody, colliders: &ColliderSet) -> u64 {
    let mut hasher = DefaultHasher::new();
    hasher.write_u8(body.body_type() as u8);
    for handle in body.colliders() {
        let (index, generation) = handle.into_raw_parts();
        hasher.write_u32(index);
        hasher.write_u32(generation);
        if let Some(collider) = colliders.get(*handle) {
            hasher.write_u8(u8::from(collider.is_enabled()));
            hasher.write_u8(u8::from(collider.is_sensor()));
            let shape: *const _ = Arc::as_ptr(&collider.shared_shape().0);
            hasher.write_usize(shape.cast::<()>().addr());
            hasher.write_u64(shape_mark(collider));
            let pose = pose_of(collider);
            write(&mut hasher, &pose.translation.to_array());
            write(&mut hasher, &pose.rotation.to_array());
            write_properties(&mut hasher, &collider.mass_properties());
        }
    }
    match body.mass_properties().additional_local_mprops.as_deref() {
        None => {}
        Some(RigidBodyAdditionalMassProps::Mass(mass)) => write(&mut hasher, &[*mass]),
        Some(RigidBodyAdditionalMassProps::MassProps(properties)) => {
            write_properties(&mut hasher, properties);
        }
    }
    hasher.finish()
}

/// Tells shapes apart by their kind, their extent and their volume.
fn shape_mark(collider: &Collider) -> u64 {
    let shape = collider.shape();
    let mut hasher = DefaultHasher::new();
    hasher.write_u8(shape.shape_type() as u8);
    let extent = shape.compute_local_aabb();
    write(&mut hasher, &extent.mins.to_array());
    write(&mut hasher, &extent.maxs.to_array());
    write_properties(&mut hasher, &shape.mass_properties(1.0));
    hasher.finish()
}

fn write(hasher: &mut DefaultHasher, numbers: &[Real]) {
    for number in numbers {
        hasher.write_u32(number.to_bits());
    }
}

fn write_properties(hasher: &mut DefaultHasher, properties: &MassProperties) {
    write(hasher, &properties.local_com.to_array());
    write(hasher, &properties.inv_principal_inertia.to_array());
    write(hasher, &properties.principal_inertia_local_frame.to_array());
    write(hasher, &[properties.inv_mass]);
}
