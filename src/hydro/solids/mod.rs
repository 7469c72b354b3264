//! Boxes, cylinders, cones and capsules: how a surface is known to be one, and the table of their added mass.
//!
//! A solid is recognised by what it is, not by what it is called: a cuboid, its convex hull and its mesh are the same to
//! the fluid, and get the same.

mod recognize;
mod table;

pub(super) use recognize::Measured;

use crate::geometry::Ellipsoid;
use crate::math;
use rapier3d::na::Vector3;
use std::f64::consts::PI;

/// A solid whose added mass is tabulated, with its lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Solid {
    /// A box, with its edges along the planform's axes.
    Cuboid {
        /// Lengths of the edges.
        lengths: Vector3<f64>,
    },
    /// A circular cylinder.
    Cylinder {
        /// Radius.
        radius: f64,
        /// Height from face to face.
        height: f64,
    },
    /// A circular cone.
    Cone {
        /// Radius of the base.
        radius: f64,
        /// Height from base to apex.
        height: f64,
    },
    /// A cylinder with half a ball at each end.
    Capsule {
        /// Radius.
        radius: f64,
        /// Length from pole to pole.
        length: f64,
    },
}

/// A solid, and how it lies in the principal axes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Placed {
    solid: Solid,
    /// Which principal axis is its first: that of revolution.
    axis: usize,
    /// −1 if the apex of a cone is toward the negative end of that axis.
    sign: f64,
}

impl Placed {
    /// What a body of revolution has along its first axis and across, along the principal axes.
    fn along(&self, own: Vector3<f64>) -> Vector3<f64> {
        Vector3::from_fn(|i, _| own[(i + 3 - self.axis) % 3])
    }
}

impl Solid {
    /// Displaced volume, m³.
    pub fn volume(&self) -> f64 {
        match *self {
            Self::Cuboid { lengths } => lengths.product(),
            Self::Cylinder { radius, height } => PI * radius * radius * height,
            Self::Cone { radius, height } => PI * radius * radius * height / 3.0,
            Self::Capsule { radius, length } => PI * radius * radius * (length - radius / 1.5),
        }
    }

    /// Area of its surface, m².
    pub fn area(&self) -> f64 {
        match *self {
            Self::Cuboid { lengths: l } => 2.0 * (l.x * l.y + l.y * l.z + l.z * l.x),
            Self::Cylinder { radius, height } => 2.0 * PI * radius * (radius + height),
            Self::Cone { radius, height } => PI * radius * (radius + math::hypot(radius, height)),
            Self::Capsule { radius, length } => 2.0 * PI * radius * length,
        }
    }

    /// `∫ x² dV` from the centroid, m⁵, of the coordinates along the axis of revolution or the first edge, then the other
    /// two.
    pub fn second_moment(&self) -> Vector3<f64> {
        let volume = self.volume();
        let squares = match *self {
            Self::Cuboid { lengths } => lengths.component_mul(&lengths) / 12.0,
            Self::Cylinder { radius, height } => {
                round(height * height / 12.0, radius * radius / 4.0)
            }
            Self::Cone { radius, height } => {
                round(height * height * (3.0 / 80.0), radius * radius * 0.15)
            }
            Self::Capsule { radius, length } => {
                // The straight part, and both half balls together with their centers at its ends.
                let (r2, straight) = (radius * radius, length - 2.0 * radius);
                let (tube, ball) = (PI * r2 * straight, 4.0 / 3.0 * PI * r2 * radius);
                let half = 0.5 * straight;
                let axial = tube * half * half / 3.0
                    + ball * (r2 / 5.0 + half * half + 0.75 * half * radius);
                return round(axial, tube * r2 / 4.0 + ball * r2 / 5.0);
            }
        };
        squares * volume
    }

    /// The ellipsoid with the same three shadows, its first axis that of revolution.
    fn proxy(&self) -> Ellipsoid {
        // Along the axis, and across it.
        let (along, across) = match *self {
            Self::Cuboid { lengths } => {
                return Ellipsoid {
                    semi_axes: lengths / PI.sqrt(),
                };
            }
            Self::Cylinder { radius, height } => (2.0 / PI * height, radius),
            Self::Cone { radius, height } => (height / PI, radius),
            Self::Capsule { radius, length } => {
                let shadow = 2.0 * radius * length - (4.0 - PI) * radius * radius;
                (shadow / (PI * radius), radius)
            }
        };
        Ellipsoid {
            semi_axes: round(along, across),
        }
    }
}

/// A property of a body of revolution along its axis, and twice across.
fn round(along: f64, across: f64) -> Vector3<f64> {
    Vector3::new(along, across, across)
}

#[cfg(test)]
mod tests {
    use crate::geometry::Surface;
    use crate::hydro::{Accuracy, AddedMassSource, HydroProperties, Solid};
    use rapier3d::na::{Rotation3, Vector3};
    use rapier3d::prelude::*;

    /// A surface's added mass, turned back by the rotation that it was turned by.
    fn of(
        surface: &Surface,
        turn: &Rotation3<f64>,
    ) -> (HydroProperties, Vector3<f64>, Vector3<f64>) {
        let turned = surface.map(|v| turn * v);
        let hydro = HydroProperties::from_surface(&turned, Vector3::zeros()).tabulated();
        let own = hydro
            .added_mass_about(hydro.centroid)
            .rotated(&turn.inverse());
        (hydro, own.linear.diagonal(), own.angular.diagonal())
    }

    fn tabulated(shape: &dyn Shape) -> HydroProperties {
        HydroProperties::from_shape_with(shape, Accuracy::Tabulated).unwrap()
    }

    fn surface(shape: &dyn Shape) -> Surface {
        Surface::from_shape(shape).unwrap()
    }

    /// Hulls and meshes of solids in any attitude are the solids that they are, and those of few facets too.
    #[test]
    fn solids_are_known_by_what_they_are() {
        let turns = [
            Rotation3::identity(),
            Rotation3::from_euler_angles(0.7, -0.4, 1.9),
            Rotation3::from_euler_angles(0.0, 0.785, 0.0),
        ];
        let shapes: [(&str, Box<dyn Shape>); 9] = [
            ("crate", Box::new(Cuboid::new(Vector::new(0.25, 0.15, 0.2)))),
            ("cube", Box::new(Cuboid::new(Vector::splat(0.2)))),
            ("tile", Box::new(Cuboid::new(Vector::new(0.2, 0.01, 0.2)))),
            ("beam", Box::new(Cuboid::new(Vector::new(0.1, 1.0, 0.1)))),
            ("coin", Box::new(Cylinder::new(0.002, 0.012))),
            ("log", Box::new(Cylinder::new(1.0, 0.1))),
            ("cone", Box::new(Cone::new(0.3, 0.2))),
            ("hat", Box::new(Cone::new(0.1, 0.3))),
            ("capsule", Box::new(Capsule::new_z(0.3, 0.1))),
        ];
        for (name, shape) in &shapes {
            let reference = tabulated(shape.as_ref());
            let AddedMassSource::Table { .. } = reference.added_mass_source else {
                panic!("{name}: {:?}", reference.added_mass_source);
            };
            let own = reference.added_mass_about(reference.centroid);
            for turn in &turns {
                let (hydro, linear, angular) = of(&surface(shape.as_ref()), turn);
                let known = matches!(hydro.added_mass_source, AddedMassSource::Table { .. });
                assert!(known, "{name}: {:?}", hydro.added_mass_source);
                let off = (linear - own.linear.diagonal()).amax() / own.linear.amax();
                let spin = (angular - own.angular.diagonal()).amax() / own.angular.amax();
                assert!(off < 5e-3 && spin < 1e-2, "{name}: {off} {spin}");
            }
        }
    }

    /// Volume, area and second moments in closed form are those of the surfaces, but for their facets.
    #[test]
    fn closed_forms_are_those_of_the_surfaces() {
        let (radius, height, length) = (0.3, 0.5, 0.9);
        let lengths = Vector3::new(0.5, 0.3, 0.4);
        let shapes: [(Solid, Box<dyn Shape>); 4] = [
            (
                Solid::Cuboid { lengths },
                Box::new(Cuboid::new(Vector::new(0.25, 0.15, 0.2))),
            ),
            (
                Solid::Cylinder { radius, height },
                Box::new(Cylinder::new(0.25, 0.3)),
            ),
            (
                Solid::Cone { radius, height },
                Box::new(Cone::new(0.25, 0.3)),
            ),
            (
                Solid::Capsule { radius, length },
                Box::new(Capsule::new_y(0.15, 0.3)),
            ),
        ];
        for (solid, shape) in shapes {
            let (surface, round) = (
                surface(shape.as_ref()),
                !matches!(solid, Solid::Cuboid { .. }),
            );
            let integrals = surface.volume_integrals();
            let area: f64 = surface
                .corners()
                .map(|[a, b, c]| 0.5 * (b - a).cross(&(c - a)).norm())
                .sum();
            let near = |ours: f64, right: f64| {
                assert!(
                    (ours / right - 1.0).abs() < 2e-3,
                    "{solid:?}: {ours} for {right}"
                );
            };
            near(solid.volume(), integrals.volume);
            near(solid.area(), area);
            let axes = if round { [1, 2, 0] } else { [0, 1, 2] };
            for (ours, axis) in solid.second_moment().iter().zip(axes) {
                near(*ours, integrals.second_moment[(axis, axis)]);
            }
        }
    }

    /// What comes near a solid in one respect is not taken for it.
    #[test]
    fn others_are_not() {
        let hull = |corners: &[[f32; 3]]| {
            let corners: Vec<_> = corners.iter().map(|c| Vector::from_array(*c)).collect();
            SharedShape::convex_hull(&corners).unwrap()
        };
        let slab = |outline: &[[f32; 2]], half: f32| {
            let sides = [half, -half].map(|y| outline.iter().map(move |[x, z]| [*x, y, *z]));
            hull(&sides.into_iter().flatten().collect::<Vec<_>>())
        };
        let ellipse: Vec<[f32; 2]> = (0..40)
            .map(|i| (std::f32::consts::TAU * i as f32 / 40.0).sin_cos())
            .map(|(s, c)| [1.5 * c, s])
            .collect();
        let others = [
            // A rhombus has the volume and the second moments of a rectangle.
            (
                "rhombus",
                slab(&[[2.0, 0.0], [0.0, 1.0], [-2.0, 0.0], [0.0, -1.0]], 0.2),
            ),
            (
                "triangle",
                slab(&[[1.0, 0.0], [-0.5, 0.866], [-0.5, -0.866]], 0.5),
            ),
            ("elliptic cylinder", slab(&ellipse, 0.5)),
            // Four corners of a cube.
            (
                "tetrahedron",
                hull(&[
                    [1.0, 1.0, 1.0],
                    [1.0, -1.0, -1.0],
                    [-1.0, 1.0, -1.0],
                    [-1.0, -1.0, 1.0],
                ]),
            ),
            (
                "pyramid",
                hull(&[
                    [1.0, 0.0, 1.0],
                    [1.0, 0.0, -1.0],
                    [-1.0, 0.0, 1.0],
                    [-1.0, 0.0, -1.0],
                    [0.0, 1.5, 0.0],
                ]),
            ),
        ];
        for (name, shape) in &others {
            let hydro = tabulated(shape.as_ref());
            let source = hydro.added_mass_source;
            assert_eq!(source, AddedMassSource::ProxyEllipsoid, "{name}");
        }
        let ball = HydroProperties::from_shape(&Ball::new(0.2)).unwrap();
        let source = ball.added_mass_source;
        assert_eq!(source, AddedMassSource::Ellipsoid);
        assert!((ball.added_mass.linear[(0, 0)] / ball.volume - 0.5).abs() < 5e-3);
        let pebble = crate::geometry::Ellipsoid {
            semi_axes: Vector3::new(0.3, 0.2, 0.1),
        };
        let pebble = Surface::ellipsoid(&pebble, 12).unwrap();
        let (hydro, ..) = of(&pebble, &Rotation3::from_euler_angles(0.3, 0.2, 0.1));
        assert_eq!(hydro.added_mass_source, AddedMassSource::Ellipsoid);
    }

    /// Cube: 0.6383 of its volume (Sihvola et al. 2004), inertia 0.0392 ρa⁵; a square prism 1 × 1 × 2: .334 along, .834
    /// across; a long cylinder has its displaced mass across (the plane flow's exact 1), a square one 1.186 (Wendel 1956).
    #[test]
    fn published_values() {
        let of = |shape: &dyn Shape| {
            let hydro = tabulated(shape);
            (
                hydro.added_mass.linear.diagonal() / hydro.volume,
                hydro.added_mass.angular.diagonal(),
            )
        };
        let near = |found: f64, expected: f64, share: f64| {
            assert!(
                (found / expected - 1.0).abs() < share,
                "{found} for {expected}"
            );
        };
        let (cube, inertia) = of(&Cuboid::new(Vector::splat(0.5)));
        near(cube.x, 0.6383, 5e-3);
        near(inertia.x, 0.0392, 1e-2);
        let (prism, _) = of(&Cuboid::new(Vector::new(0.5, 1.0, 0.5)));
        near(prism.y, 0.334, 1e-2);
        near(prism.z, 0.834, 1e-2);
        let (log, _) = of(&Cylinder::new(32.0, 0.5));
        near(log.x, 1.0, 1e-2);
        let (beam, _) = of(&Cuboid::new(Vector::new(0.5, 32.0, 0.5)));
        near(beam.x, 1.186, 1e-2);
        // A thin coin is a disc: 8/3 ρa³, and 16/45 ρa⁵ about a diameter.
        let coin = tabulated(&Cylinder::new(1e-3, 1.0));
        near(coin.added_mass.linear[(1, 1)], 8.0 / 3.0, 1e-2);
        near(coin.added_mass.angular[(0, 0)], 16.0 / 45.0, 1.5e-2);
    }

    /// Plates keep the ellipsoid that their law was calibrated with, and nothing jumps where plates end.
    #[test]
    fn plates_keep_their_ellipsoid() {
        let of = |thickness: f32| {
            let shape = Cuboid::new(Vector::new(0.5, 0.5 * thickness, 0.5));
            HydroProperties::from_shape(&shape).unwrap()
        };
        let broadside = |thickness| of(thickness).added_mass.linear[(1, 1)];
        let tile = of(0.2);
        assert_eq!(tile.added_mass_source, AddedMassSource::ProxyEllipsoid);
        let own = tile.proxy.added_mass().linear[(2, 2)];
        assert!((broadside(0.2) / own - 1.0).abs() < 1e-12);
        for i in 0..100 {
            let thickness = 0.2 + 0.0015 * i as f32;
            let step = broadside(thickness + 0.0015) / broadside(thickness);
            assert!((0.999..1.02).contains(&step), "{thickness}: {step}");
        }
    }

    /// A cone that is pushed across turns: the other way where its apex is on the other side.
    #[test]
    fn a_cone_is_coupled() {
        let cone = tabulated(&Cone::new(0.5, 0.5));
        let AddedMassSource::Table {
            solid: Solid::Cone { radius, height },
        } = cone.added_mass_source
        else {
            panic!("{:?}", cone.added_mass_source);
        };
        assert!((radius - 0.5).abs() < 1e-3 && (height - 1.0).abs() < 1e-3);
        let own = cone.added_mass_about(cone.centroid);
        let turned = surface(&Cone::new(0.5, 0.5)).map(|v| Vector3::new(v.x, -v.y, -v.z));
        let turned = HydroProperties::from_surface(&turned, Vector3::zeros()).tabulated();
        let flipped = turned.added_mass_about(turned.centroid);
        assert!(own.coupling.amax() > 0.01 * own.linear.amax());
        // Turned by half a turn about x, A₁₂ along (z, x) keeps its sign and that along (x, z) does not.
        let half_turn = Rotation3::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
        let expected = own.rotated(&half_turn).coupling;
        assert!((flipped.coupling - expected).amax() < 1e-3 * expected.amax());
        assert!(own.is_physical());
    }
}
