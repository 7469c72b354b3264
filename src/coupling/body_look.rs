//! What a rapier body is made of, as it was last seen: rapier tells nobody which bodies a user has changed.

use super::saved_properties::SavedProperties;
use rapier3d::dynamics::{MassProperties, RigidBody, RigidBodyAdditionalMassProps};
use rapier3d::geometry::{Collider, ColliderHandle, ColliderSet, SharedShape};
use rapier3d::math::{Pose, Real};
use std::hash::{DefaultHasher, Hasher};
use std::sync::Arc;

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
    fn is(&self, handle: ColliderHandle, collider: &Collider) -> bool {
        let shape = collider.shared_shape();
        self.handle == handle
            && self
                .shape
                .as_ref()
                .is_some_and(|kept| Arc::ptr_eq(&kept.0, &shape.0))
            && self.enabled == collider.is_enabled()
            && self.sensor == collider.is_sensor()
            && collider
                .position_wrt_parent()
                .is_some_and(|pose| *pose == self.pose)
    }

    /// The same after loading: the shape is held from now on if it is the one that was kept.
    fn is_loaded(&mut self, handle: ColliderHandle, collider: &Collider) -> bool {
        #[cfg(feature = "serde-serialize")]
        if self.shape.is_none() && shape_mark(collider) == self.shape_mark {
            self.shape = Some(collider.shared_shape().clone());
        }
        self.is(handle, collider)
    }
}

fn pose_of(collider: &Collider) -> Pose {
    let pose = collider.position_wrt_parent().copied();
    pose.unwrap_or(Pose::IDENTITY)
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

impl SavedProperties {
    /// Whether a body is as it was left: the question of every step.
    #[inline(always)]
    pub fn still_holds(&self, body: &RigidBody, colliders: &ColliderSet) -> bool {
        let handles = body.colliders();
        handles.len() == self.colliders.len()
            && self.wrote_body(body)
            && (self.colliders.iter().zip(handles).enumerate()).all(|(index, (kept, handle))| {
                colliders.get(*handle).is_some_and(|collider| {
                    kept.is(*handle, collider) && self.wrote(index, collider)
                })
            })
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
