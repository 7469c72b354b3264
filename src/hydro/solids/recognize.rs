//! Which solid a surface is.

use super::{Placed, Solid};
use crate::geometry::{Ellipsoid, Surface, VolumeIntegrals};
use crate::hydro::{AddedMass, AddedMassSource};
use rapier3d::na::{Rotation3, Vector3};
use std::f64::consts::PI;

/// Share by which volume, area and radii of gyration may differ from those of the solid: facets of
/// round ones. A square and a disc of equal area differ by 4.5 % in their second moment.
const ALIKE: f64 = 0.02;
/// Share by which two lengths may differ and still leave the axes between them to chance.
const DEGENERATE: f64 = 0.01;

/// What is measured of a surface to compare it with solids, along its principal axes.
pub(in crate::hydro) struct Measured {
    convex: bool,
    volume: f64,
    area: f64,
    /// `∫x²dV` from the centroid, m⁵.
    second_moment: Vector3<f64>,
    /// Farthest points from the centroid toward either end of each axis, m, both positive.
    reach: [Vector3<f64>; 2],
}

impl Measured {
    /// Of a surface with these principal `axes`. One that is not `convex` may be a box out of several that touch.
    pub fn new(
        surface: &Surface,
        integrals: &VolumeIntegrals,
        axes: &Rotation3<f64>,
        convex: bool,
    ) -> Self {
        let to_axes = axes.inverse();
        let mut reach = [Vector3::zeros(); 2];
        for vertex in surface.vertices() {
            let at = to_axes * (vertex - integrals.centroid);
            reach = [reach[0].sup(&-at), reach[1].sup(&at)];
        }
        let area = surface
            .corners()
            .map(|[a, b, c]| 0.5 * (b - a).cross(&(c - a)).norm())
            .sum();
        let turned = to_axes.matrix() * integrals.second_moment * axes.matrix();
        Self {
            convex,
            volume: integrals.volume,
            area,
            second_moment: turned.diagonal(),
            reach,
        }
    }

    /// Its added mass per unit density about the centroid, along the principal axes, and where that is from: if it is a
    /// tabulated solid, by a `share` from the table, and for the rest the proxy ellipsoid's.
    pub fn added_mass(&self, proxy: &Ellipsoid, share: f64) -> (AddedMass, AddedMassSource) {
        let ellipsoid = proxy.added_mass();
        if self.is_ellipsoid() {
            return (ellipsoid, AddedMassSource::Ellipsoid);
        }
        match self.solid() {
            Some(placed) if share > 0.0 => {
                let solid = placed.solid;
                let table = super::table::added_mass(&placed);
                let mixed = table.scaled(share) + ellipsoid.scaled(1.0 - share);
                (mixed, AddedMassSource::Table { solid })
            }
            _ => (ellipsoid, AddedMassSource::ProxyEllipsoid),
        }
    }

    /// The solid that it is, if it is one that is tabulated.
    fn solid(&self) -> Option<Placed> {
        let lengths = (self.second_moment * (12.0 / self.volume)).map(f64::sqrt);
        let cuboid = Placed {
            solid: Solid::Cuboid { lengths },
            axis: 0,
            sign: 1.0,
        };
        if self.is(&cuboid) && self.fills_box(&lengths) {
            return Some(cuboid);
        }
        if !self.convex {
            return None;
        }
        (0..3).find_map(|axis| {
            let across = [lengths[(axis + 1) % 3], lengths[(axis + 2) % 3]];
            if (across[0] / across[1] - 1.0).abs() > DEGENERATE {
                return None;
            }
            let found = self.of_revolution(axis, (across[0] * across[1]).sqrt());
            found.into_iter().find(|placed| self.is(placed))
        })
    }

    /// Whether it fills the ellipsoid through its farthest points.
    fn is_ellipsoid(&self) -> bool {
        if !self.convex {
            return false;
        }
        let semi_axes = (self.reach[0] + self.reach[1]) * 0.5;
        let alike = |measured: f64, other: f64| (measured / other - 1.0).abs() <= ALIKE;
        alike(self.volume, 4.0 / 3.0 * PI * semi_axes.product())
            && (0..3).all(|i| {
                let moment = self.volume * semi_axes[i] * semi_axes[i] / 5.0;
                alike(self.second_moment[i], moment)
            })
    }

    /// The solids of revolution about an axis that it may be: those with its length, and its radius of gyration `across / √12`.
    fn of_revolution(&self, axis: usize, across: f64) -> [Placed; 3] {
        let [below, above] = self.reach.map(|reach| reach[axis]);
        let length = below + above;
        let placed = |solid| Placed {
            solid,
            axis,
            sign: if above < below { -1.0 } else { 1.0 },
        };
        let radius = across / 3.0_f64.sqrt();
        let mut capsule = radius;
        // Newton's method on the volume, which grows with the radius up to a ball.
        for _ in 0..8 {
            let solid = Solid::Capsule {
                radius: capsule,
                length,
            };
            let slope = 2.0 * PI * capsule * (length - capsule);
            capsule = (capsule + (self.volume - solid.volume()) / slope).clamp(0.0, 0.5 * length);
        }
        [
            placed(Solid::Cylinder {
                radius,
                height: length,
            }),
            placed(Solid::Cone {
                radius: across / 1.8_f64.sqrt(),
                height: length,
            }),
            placed(Solid::Capsule {
                radius: capsule,
                length,
            }),
        ]
    }

    /// Whether volume, area, radii of gyration and ends are those of a solid.
    fn is(&self, placed: &Placed) -> bool {
        let Placed { solid, axis, sign } = placed;
        let alike = |measured: f64, other: f64, share: f64| (measured / other - 1.0).abs() <= share;
        let moments = solid.second_moment();
        let centered = match solid {
            // A cone's centroid is a quarter up from its base.
            Solid::Cone { height, .. } => {
                let apex = self.reach[usize::from(*sign > 0.0)][*axis];
                alike(apex, 0.75 * height, ALIKE)
            }
            _ => alike(self.reach[0][*axis], self.reach[1][*axis], ALIKE),
        };
        centered
            && alike(self.volume, solid.volume(), ALIKE)
            // Faces within a body count in its area.
            && (!self.convex || alike(self.area, solid.area(), ALIKE))
            && (0..3).all(|i| {
                // The square of a length may differ by twice as much.
                alike(self.second_moment[(axis + i) % 3], moments[i], 2.0 * ALIKE)
            })
    }

    /// Whether it reaches as far as a box: a rhombus has the second moments of a rectangle. Equal lengths have
    /// principal axes that chance chooses, and a rhombus of equal diagonals is a square.
    fn fills_box(&self, lengths: &Vector3<f64>) -> bool {
        (0..3).all(|i| {
            let other = |j: usize| (lengths[j] / lengths[i] - 1.0).abs() <= DEGENERATE;
            let degenerate = other((i + 1) % 3) || other((i + 2) % 3);
            let reach = self.reach.map(|reach| 2.0 * reach[i] / lengths[i]);
            self.convex && degenerate || reach.iter().all(|reach| (reach - 1.0).abs() <= ALIKE)
        })
    }
}
