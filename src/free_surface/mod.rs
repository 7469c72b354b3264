//! The surface between two fluids, such as water and air: where it is, and how the fluid below it moves with it.
//!
//! # Axes
//! A surface is given in *level axes*: y up, x and z level, the origin at the level of the fluid at rest. In a world
//! whose up is y they are the world's axes, moved to the level; where up is elsewhere, y is turned to it along the
//! shortest way.

//!
//! # What there is
//! [`Level`] is at rest, [`Waves`] are sums of linear waves, among them [seas](Waves::sea) of a spectrum, and a
//! [`HeightField`] is looked up. Anything else implements [`FreeSurface`]. [`mesh`] makes triangles of a patch to look at.
//! Currents are no part of a surface: they are the [flow](crate::flow) of the fluid.

mod dispersion;
mod fours;
mod height_field;
mod mesh;
mod sea;
mod spectrum;
mod waves;

pub use dispersion::Dispersion;
pub use height_field::{HeightField, HeightGrid};
pub use mesh::mesh;
pub use sea::Sea;
pub use spectrum::WaveSpectrum;
pub use waves::{Wave, Waves};

use rapier3d::na::Vector3;
use std::sync::Arc;

/// A free surface at one place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Elevation {
    /// Height above the level of the fluid at rest, m.
    pub height: f64,
    /// How fast the height grows along x and z.
    pub slope: [f64; 2],
}

/// A free surface: the trait that users implement for one of their own. Lengths in m, times in s, level axes.
pub trait FreeSurface: Send + Sync {
    /// The surface over or under a place of the level.
    fn elevation(&self, x: f64, z: f64, time: f64) -> Elevation;

    /// Velocity of the lower fluid that belongs to the surface's motion, at a point of it. Bodies ask for it at the middle of
    /// what is under water, which may be a little above the surface. Zero unless implemented: then the surface pushes bodies up and down by their buoyancy alone.
    fn velocity(&self, _point: &Vector3<f64>, _time: f64) -> Vector3<f64> {
        Vector3::zeros()
    }

    /// A bound on the height above and below the level. Bodies beyond it are not looked at.
    fn highest(&self) -> f64;

    /// Length over which the surface bends: the shortest wave that counts. A body longer than a quarter of it is cut
    /// corner by corner, a smaller one by the plane that touches the surface there.
    fn bend(&self) -> f64 {
        f64::INFINITY
    }

    /// Whether the surface never moves and its fluid rests, so that what floats on it may sleep.
    fn is_still(&self) -> bool {
        false
    }
}

/// A surface that several owners share.
impl<S: FreeSurface + ?Sized> FreeSurface for Arc<S> {
    fn elevation(&self, x: f64, z: f64, time: f64) -> Elevation {
        (**self).elevation(x, z, time)
    }

    fn velocity(&self, point: &Vector3<f64>, time: f64) -> Vector3<f64> {
        (**self).velocity(point, time)
    }

    fn highest(&self) -> f64 {
        (**self).highest()
    }

    fn bend(&self) -> f64 {
        (**self).bend()
    }

    fn is_still(&self) -> bool {
        (**self).is_still()
    }
}

/// Level and at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Level;

impl FreeSurface for Level {
    fn elevation(&self, _x: f64, _z: f64, _time: f64) -> Elevation {
        Elevation::default()
    }

    fn highest(&self) -> f64 {
        0.0
    }

    fn is_still(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sea that two media share is the same sea.
    #[test]
    fn shared_surfaces_are_themselves() {
        let sea = Waves::sea(&Sea::default()).unwrap();
        let shared: Arc<dyn FreeSurface> = Arc::new(sea.clone());
        let point = Vector3::new(1.3, 0.2, -0.7);
        assert_eq!(
            FreeSurface::elevation(&shared, 1.3, -0.7, 2.0),
            sea.elevation(1.3, -0.7, 2.0)
        );
        assert_eq!(
            FreeSurface::velocity(&shared, &point, 2.0),
            sea.velocity(&point, 2.0)
        );
        assert!(FreeSurface::highest(&shared) > 0.0 && FreeSurface::bend(&shared).is_finite());
        assert_eq!(FreeSurface::highest(&shared), sea.highest());
        assert_eq!(FreeSurface::bend(&shared), sea.bend());
        assert!(!FreeSurface::is_still(&shared));
        assert!(FreeSurface::is_still(&Arc::new(Level)));
    }
}
