//! Bodies that several laws are tested on.

use rapier3d_immersed::rapier3d::na::{Matrix3, Vector3};
use rapier3d_immersed::rapier3d::parry::shape::SharedShape;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{DryMass, HydroProperties, ImmersedBody, ViscousLaw};

/// A box of full extents `size` and the given density under `law`, for flight without rapier.
pub fn solid_box(size: [f64; 3], density: f64, law: ViscousLaw) -> (ImmersedBody, DryMass) {
    let half = size.map(|x| (x / 2.0) as f32);
    let shape = SharedShape::cuboid(half[0], half[1], half[2]);
    let hydro = HydroProperties::from_shape(shape.as_ref()).unwrap();
    let [x, y, z] = size.map(|x| x * x / 12.0);
    let mass = density * size.iter().product::<f64>();
    let dry = DryMass {
        mass,
        center: Vector3::zeros(),
        inertia: Matrix3::from_diagonal(&Vector3::new(y + z, z + x, x + y)) * mass,
    };
    (ImmersedBody::new(hydro).with_law(law).unwrap(), dry)
}

/// A uniform sphere.
pub fn sphere(radius: f64, density: f64) -> (ImmersedBody, DryMass) {
    let shape = SharedShape::ball(radius as f32);
    let hydro = HydroProperties::from_shape(shape.as_ref()).unwrap();
    let mass = density * hydro.volume;
    let dry = DryMass {
        mass,
        center: Vector3::zeros(),
        inertia: Matrix3::identity() * (0.4 * mass * radius * radius),
    };
    (hydro.into(), dry)
}

/// A world without gravity.
pub fn weightless() -> PhysicsWorld {
    PhysicsWorld {
        gravity: Vector::ZERO,
        ..PhysicsWorld::new()
    }
}
