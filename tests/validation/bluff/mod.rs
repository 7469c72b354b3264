//! Bodies that are not plates.

mod attitudes;
mod coupling;
mod creeping;
mod jeffery;
mod magnus;
mod parts;
mod sparse;
mod table;

use rapier3d_immersed::geometry::{Ellipsoid, Surface};
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::rapier3d::prelude::Vector;
use rapier3d_immersed::{DryMass, FreeBody, HydroProperties, ImmersedBody};

/// A uniform ellipsoid of these semi-axes along x, y and z, referred to its center.
fn ellipsoid(semi_axes: [f64; 3], density: f64) -> (ImmersedBody, DryMass) {
    let semi_axes = Vector3::from(semi_axes);
    let surface = Surface::ellipsoid(&Ellipsoid { semi_axes }, 24).unwrap();
    let mass = density * surface.volume_integrals().volume;
    let dry = DryMass::uniform(&surface, mass).unwrap();
    let hydro = HydroProperties::from_surface(&surface, dry.center);
    (ImmersedBody::new(hydro), dry)
}

fn to_f64(v: Vector) -> Vector3<f64> {
    Vector3::new(v.x.into(), v.y.into(), v.z.into())
}

/// Acceleration of the center of mass and the spin over a moment, world axes, m/s² and rad/s².
fn accelerations(body: &FreeBody) -> (Vector3<f64>, Vector3<f64>) {
    let dt = 1e-6;
    let mut after = body.clone();
    after.step(dt, Vector3::zeros());
    (
        (after.linear_velocity() - body.linear_velocity()) / dt,
        (after.angular_velocity() - body.angular_velocity()) / dt,
    )
}
