//! Values that theory gives exactly, one for each sign and factor that no other test notices: bodies whose
//! center of mass is not that of their volume, fluid that turns, impacts with a direction, single terms of
//! the law. Coefficients that the default law may have calibrated anew are given here.

mod impacts;
mod law;
mod off_center;
mod readout;
mod rotating_fluid;
mod thesis_laws;

use crate::support;
use rapier3d_immersed::geometry::Ellipsoid;
use rapier3d_immersed::rapier3d::na::{Rotation3, Vector3};
use rapier3d_immersed::{AddedMass, DryMass, Hull, ImmersedBody};

/// A uniform sphere to the last digit, without what the facets of its surface leave: its proxy is round, its
/// added mass half of what it displaces.
fn sphere(radius: f64, density: f64) -> (ImmersedBody, DryMass) {
    let (mut body, mut dry) = support::sphere(radius, density);
    let proxy = Ellipsoid {
        semi_axes: Vector3::repeat(radius),
    };
    let half = Vector3::repeat(0.5 * proxy.volume());
    // Its law knows nothing but the proxy.
    body.hydro.bluff = None;
    body.hydro.volume = proxy.volume();
    body.hydro.hull = Hull::Ellipsoid {
        center: body.hydro.centroid,
        axes: Rotation3::identity(),
        shape: proxy,
    };
    body.hydro.proxy = proxy;
    body.hydro.added_mass = AddedMass::diagonal(half, Vector3::zeros());
    dry.inertia *= density * proxy.volume() / dry.mass;
    dry.mass = density * proxy.volume();
    (body, dry)
}
