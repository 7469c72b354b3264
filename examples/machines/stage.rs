//! What machines are put together with: a world, colliders that touch nothing, places.

use crate::Failure;
use rapier3d_immersed::rapier3d::na::{
    Isometry3, Quaternion, Translation3, UnitQuaternion, UnitVector3, Vector3,
};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, ImmersedBody, Immersion, Part};

/// A world of so many steps per second, in a fluid.
pub fn world(fluid: Fluid, hz: f32) -> (PhysicsWorld, Immersion) {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = 1.0 / hz;
    (world, Immersion::new(fluid))
}

/// Lets the fluid feel a body: as its colliders make it, or as these parts.
///
/// # Errors
/// Those of [`HydroProperties::from_body`].
pub fn immerse(
    world: &PhysicsWorld,
    immersion: &mut Immersion,
    body: RigidBodyHandle,
    parts: Option<Vec<Part>>,
) -> Result<(), Failure> {
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, body)?;
    let mut described = ImmersedBody::new(hydro);
    if let Some(parts) = parts {
        described.parts = parts;
    }
    immersion.insert(body, described);
    Ok(())
}

/// Steps for so many seconds.
pub fn advance(world: &mut PhysicsWorld, immersion: &mut Immersion, seconds: f32) {
    (0..steps(world, seconds)).for_each(|_| immersion.step(world));
}

/// How many steps that is.
pub fn steps(world: &PhysicsWorld, seconds: f32) -> usize {
    (seconds / world.integration_parameters.dt).round() as usize
}

/// A collider that touches nothing, as of a part of a machine.
pub fn untouched(shape: SharedShape, place: Pose) -> ColliderBuilder {
    let collider = ColliderBuilder::new(shape).position(place);
    collider.collision_groups(InteractionGroups::none())
}

/// A joint with springs, N·m/rad, and dampers, N·m·s/rad, about its three axes.
pub fn sprung(joint: GenericJointBuilder, stiffness: f32, damping: f32) -> GenericJointBuilder {
    let axes = [JointAxis::AngX, JointAxis::AngY, JointAxis::AngZ];
    axes.into_iter().fold(joint, |joint, axis| {
        let joint = joint.motor_position(axis, 0.0, stiffness, damping);
        joint.motor_model(axis, MotorModel::ForceBased)
    })
}

/// Kinetic energy of all bodies, without the fluid's, J.
pub fn kinetic_energy(world: &PhysicsWorld) -> f64 {
    let energies = world.bodies.iter().map(|(_, body)| body.kinetic_energy());
    energies.map(f64::from).sum()
}

/// A place, turned by so many whole turns about an axis through the origin.
pub fn around(axis: &UnitVector3<f64>, turns: f64, place: Vector3<f64>) -> Isometry3<f64> {
    let turned = UnitQuaternion::from_axis_angle(axis, std::f64::consts::TAU * turns);
    Isometry3::from_parts(Translation3::from(turned * place), turned)
}

/// In rapier's single precision.
pub fn single(place: &Isometry3<f64>) -> Pose {
    let (t, q) = (&place.translation.vector, place.rotation.coords);
    let rotation = Rotation::from_xyzw(q.x as f32, q.y as f32, q.z as f32, q.w as f32);
    Pose::from_parts(Vector::new(t.x as f32, t.y as f32, t.z as f32), rotation)
}

/// A place of rapier's in double precision, as parts have it.
pub fn double(pose: &Pose) -> Isometry3<f64> {
    let (t, q) = (pose.translation, pose.rotation);
    let [x, y, z, w] = [q.x, q.y, q.z, q.w].map(f64::from);
    let turn = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z));
    let place = [t.x, t.y, t.z].map(f64::from);
    Isometry3::from_parts(Translation3::from(place), turn)
}
