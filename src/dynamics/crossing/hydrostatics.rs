//! How a body floats: read out from how it is cut.

use super::constants::CrossingConstants;
use super::cut::{Cut, Place};
use crate::math;
use crate::math::to_real;
use rapier3d::math::Vector;
use rapier3d::na::{Rotation3, Vector3};

/// How a body lies in the free surface of its medium. World axes, SI units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hydrostatics {
    /// Volume under the free surface, m³, and its share of the whole.
    pub submerged_volume: f64,
    /// Share of the body's volume under the free surface.
    pub submerged_share: f64,
    /// Center of buoyancy: the middle of the volume under the surface, m. Of a body above it its own middle.
    pub center_of_buoyancy: Vector,
    /// Area that the body cuts out of the surface, seen from above, m², and its middle, m.
    pub waterplane_area: f64,
    /// Middle of the waterplane, m.
    pub center_of_flotation: Vector,
    /// Metacentric radii BM = I/V about the two principal axes of the waterplane, the smaller one first, m: that much
    /// higher than the center of buoyancy is the metacenter.
    pub metacentric_radii: [f64; 2],
}

impl Hydrostatics {
    /// Of a body at a place; `level` maps level axes to world axes, `origin` is the world's place of theirs.
    pub(crate) fn of(
        constants: &CrossingConstants,
        cut: &Cut,
        place: &Place,
        level: &Rotation3<f64>,
        origin: Vector,
    ) -> Self {
        let world =
            |from_center: Vector3<f64>| origin + to_real(level * (place.center + from_center));
        let under = cut.under(1, &constants.whole, place);
        let mut found = Self {
            submerged_volume: under.volume,
            submerged_share: under.volume / constants.whole.volume,
            center_of_buoyancy: world(place.turn * constants.whole.middle),
            center_of_flotation: world(Vector3::zeros()),
            ..Self::default()
        };
        if under.volume <= 0.0 {
            return found;
        }
        let center = under.moment / under.volume;
        found.center_of_buoyancy = world(center);
        let plane = under.waterplane;
        if plane.area > 1e-9 * math::powf(constants.whole.volume, 2.0 / 3.0) {
            let [x, z] = plane.first.map(|moment| moment / plane.area);
            let [xx, xz, zz] = plane.second;
            let own = [
                xx - plane.area * x * x,
                xz - plane.area * x * z,
                zz - plane.area * z * z,
            ];
            let mean = 0.5 * (own[0] + own[2]);
            let spread = (0.25 * (own[0] - own[2]).powi(2) + own[1] * own[1]).sqrt();
            found.waterplane_area = plane.area;
            found.center_of_flotation = world(Vector3::new(x, -place.center.y, z));
            found.metacentric_radii = [mean - spread, mean + spread].map(|i| i / under.volume);
        }
        found
    }
}
