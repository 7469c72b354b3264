//! Closed surfaces from rapier's shapes.

use super::Surface;
use crate::error::Error;
use rapier3d::math::{Pose, Vector};
use rapier3d::na::Vector3;
use rapier3d::parry::math::Vector3 as ParryVector3;
use rapier3d::parry::shape::{Shape, TypedShape};
use rapier3d::parry::transformation::try_convex_hull;
use std::f64::consts::{PI, TAU};

/// How many segments go around a round body, and along half a circle of its profile.
const AROUND: usize = 64;
const ALONG: usize = 48;

impl Surface {
    /// The surface of any shape that a rapier collider can have, in the shape's own frame.
    ///
    /// Flat-faced shapes are exact. Round ones are inscribed polyhedra, blown up a little across
    /// their axis so that their **volume is exact**; their other integrals are right to about
    /// 10⁻³.
    ///
    /// # Errors
    /// [`Error::ShapeWithoutVolume`] names the shapes that enclose nothing (half-space, height
    /// field, polyline, segment, triangle, custom shapes); an open triangle mesh gives
    /// [`Error::OpenMesh`] and a shape of zero or non-finite size the errors of [`Surface::new`].
    ///
    /// ```
    /// use rapier3d_immersed::geometry::Surface;
    /// use rapier3d_immersed::rapier3d::prelude::*;
    ///
    /// let coin = Surface::from_shape(&Cylinder::new(0.001, 0.01))?;
    /// let volume = std::f64::consts::PI * 0.01_f64.powi(2) * 0.002;
    /// assert!((coin.volume_integrals().volume / volume - 1.0).abs() < 1e-6);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn from_shape(shape: &dyn Shape) -> Result<Self, Error> {
        let none = |shape| Err(Error::ShapeWithoutVolume { shape });
        match shape.as_typed_shape() {
            TypedShape::Ball(s) => revolve(&arc(s.radius.into(), 0.0, PI), {
                let r = f64::from(s.radius);
                4.0 / 3.0 * PI * r.powi(3)
            }),
            TypedShape::Cuboid(s) => from_mesh(s.to_trimesh()),
            TypedShape::Capsule(s) => {
                let (r, h) = (f64::from(s.radius), f64::from(s.half_height()));
                let mut profile = arc(r, 0.0, PI / 2.0);
                profile.iter_mut().for_each(|p| p.1 += h);
                let lower = arc(r, PI / 2.0, PI);
                profile.extend(lower.iter().map(|p| (p.0, p.1 - h)));
                let volume = PI * r * r * (4.0 / 3.0 * r + 2.0 * h);
                let along_y = revolve(&profile, volume)?;
                let pose = Pose::from_parts(s.center(), s.rotation_wrt_y());
                Ok(along_y.posed(&pose))
            }
            TypedShape::Cylinder(s) => {
                let (r, h) = (f64::from(s.radius), f64::from(s.half_height));
                revolve(
                    &[(0.0, h), (r, h), (r, -h), (0.0, -h)],
                    2.0 * PI * r * r * h,
                )
            }
            TypedShape::Cone(s) => {
                let (r, h) = (f64::from(s.radius), f64::from(s.half_height));
                revolve(&[(0.0, h), (r, -h), (0.0, -h)], 2.0 / 3.0 * PI * r * r * h)
            }
            TypedShape::ConvexPolyhedron(s) => from_mesh(s.to_trimesh()),
            TypedShape::TriMesh(s) => from_mesh((s.vertices().to_vec(), s.indices().to_vec())),
            TypedShape::Voxels(s) => from_mesh(s.to_trimesh()),
            TypedShape::Compound(s) => {
                let parts: Vec<_> = s.shapes().iter().map(|(p, s)| (*p, s.as_ref())).collect();
                Self::of_parts(&parts, Self::from_shape)
            }
            TypedShape::RoundCuboid(s) => {
                let (vertices, _) = s.inner_shape.to_trimesh();
                rounded(&vertices, s.border_radius)
            }
            TypedShape::RoundCylinder(s) => {
                let (vertices, _) = s.inner_shape.to_trimesh(AROUND as u32 / 2);
                rounded(&vertices, s.border_radius)
            }
            TypedShape::RoundCone(s) => {
                let (vertices, _) = s.inner_shape.to_trimesh(AROUND as u32 / 2);
                rounded(&vertices, s.border_radius)
            }
            TypedShape::RoundConvexPolyhedron(s) => {
                rounded(s.inner_shape.points(), s.border_radius)
            }
            TypedShape::RoundTriangle(s) => rounded(&s.inner_shape.vertices()[..], s.border_radius),
            TypedShape::HalfSpace(_) => none("half-space"),
            TypedShape::HeightField(_) => none("height field"),
            TypedShape::Polyline(_) => none("polyline"),
            TypedShape::Segment(_) => none("segment"),
            TypedShape::Triangle(_) => none("triangle"),
            TypedShape::Custom(_) => none("custom shape"),
        }
    }

    /// The surfaces that `mesh` makes of several shapes, each moved by its pose, as one.
    pub(crate) fn of_parts(
        parts: &[(Pose, &dyn Shape)],
        mesh: impl Fn(&dyn Shape) -> Result<Self, Error>,
    ) -> Result<Self, Error> {
        let mut whole: Option<Self> = None;
        for (pose, part) in parts {
            let part = mesh(*part)?.posed(pose);
            match &mut whole {
                Some(whole) => whole.append(&part),
                None => whole = Some(part),
            }
        }
        whole.ok_or(Error::EmptyMesh)
    }

    /// The surface moved by a rapier pose.
    pub fn posed(&self, pose: &Pose) -> Self {
        let pose = crate::math::isometry(pose);
        self.map(|v| pose.transform_point(&v.into()).coords)
    }
}

fn from_mesh((vertices, triangles): (Vec<Vector>, Vec<[u32; 3]>)) -> Result<Surface, Error> {
    let vertices: Vec<_> = vertices.iter().map(|v| crate::math::to_f64(*v)).collect();
    Surface::new(&vertices, &triangles)
}

/// Points (distance from the axis, height) of a circular arc between two polar angles.
fn arc(radius: f64, from: f64, to: f64) -> Vec<(f64, f64)> {
    let segments = (ALONG as f64 * (to - from) / PI).ceil() as usize;
    (0..=segments)
        .map(|i| {
            let angle = from + (to - from) * i as f64 / segments as f64;
            // The poles lie exactly on the axis, so that they weld to one vertex.
            let at_pole = i == 0 && from == 0.0 || i == segments && to == PI;
            let distance = if at_pole { 0.0 } else { radius * angle.sin() };
            (distance, radius * angle.cos())
        })
        .collect()
}

/// The body of revolution about y of a profile from its top to its bottom, with distances from the
/// axis scaled so that the volume is exactly `volume`.
fn revolve(profile: &[(f64, f64)], volume: f64) -> Result<Surface, Error> {
    let build = |scale: f64| {
        let mut vertices = Vec::with_capacity(profile.len() * AROUND);
        for (distance, height) in profile {
            vertices.extend((0..AROUND).map(|i| {
                let (sin, cos) = (TAU * i as f64 / AROUND as f64).sin_cos();
                Vector3::new(scale * distance * sin, *height, scale * distance * cos)
            }));
        }
        let mut triangles = Vec::with_capacity(profile.len() * AROUND * 2);
        for ring in 0..profile.len() - 1 {
            for i in 0..AROUND {
                let next = (i + 1) % AROUND;
                let [a, b] = [i, next].map(|i| (ring * AROUND + i) as u32);
                let [c, d] = [i, next].map(|i| ((ring + 1) * AROUND + i) as u32);
                triangles.push([a, c, d]);
                triangles.push([a, d, b]);
            }
        }
        Surface::new(&vertices, &triangles)
    };
    let inscribed = build(1.0)?.volume_integrals().volume;
    build((volume / inscribed).sqrt())
}

/// The convex hull of some points, swept by a ball of radius `border`.
fn rounded(points: &[Vector], border: f32) -> Result<Surface, Error> {
    let border = f64::from(border);
    let ball = revolve(&arc(border, 0.0, PI), 4.0 / 3.0 * PI * border.powi(3))?;
    // Every fourth ring and segment of the ball is plenty around an edge.
    let offsets: Vec<_> = ball.vertices().iter().step_by(3).collect();
    let swept: Vec<ParryVector3> = points
        .iter()
        .flat_map(|p| {
            let p = crate::math::to_f64(*p);
            offsets.iter().map(move |o| crate::math::to_real(p + *o))
        })
        .collect();
    let hull = try_convex_hull(&swept).map_err(|_| Error::EmptyMesh)?;
    from_mesh(hull)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use rapier3d::parry::shape::SharedShape;

    fn volume(shape: &SharedShape) -> f64 {
        let surface = Surface::from_shape(shape.as_ref()).unwrap();
        surface.volume_integrals().volume
    }

    /// The displaced volume, which decides whether a body floats, is exact for every primitive.
    #[test]
    fn primitive_volumes_are_exact() {
        let shapes = [
            (SharedShape::ball(0.3), 4.0 / 3.0 * PI * 0.027),
            (SharedShape::cuboid(0.1, 0.2, 0.3), 0.048),
            (SharedShape::cylinder(0.01, 0.4), PI * 0.16 * 0.02),
            (SharedShape::cone(0.5, 0.2), PI * 0.04 / 3.0),
            (
                SharedShape::capsule(Vector::X, Vector::X * 3.0, 0.5),
                PI * 0.25 * 2.0 + 4.0 / 3.0 * PI * 0.125,
            ),
        ];
        for (shape, exact) in shapes {
            // The sizes are f32.
            assert_relative_eq!(volume(&shape), exact, max_relative = 3e-7);
        }
    }

    /// Second moments of the tessellated primitives; inscribed polygons of 64 sides with the right
    /// area have theirs wrong by (2π/64)²/6 ≈ 1.6·10⁻³ at most.
    #[test]
    fn second_moments_of_round_shapes() {
        let ball = Surface::from_shape(SharedShape::ball(1.0).as_ref()).unwrap();
        let moment = ball.volume_integrals().second_moment;
        for i in 0..3 {
            assert_relative_eq!(moment[(i, i)], 4.0 * PI / 15.0, max_relative = 3e-3);
        }
        assert_relative_eq!(ball.projected_area(Vector3::y()), PI, max_relative = 3e-3);
    }

    #[test]
    fn capsule_lies_along_its_segment() {
        let shape = SharedShape::capsule(Vector::X, Vector::X * 3.0, 0.5);
        let integrals = Surface::from_shape(shape.as_ref())
            .unwrap()
            .volume_integrals();
        assert_relative_eq!(integrals.centroid, Vector3::x() * 2.0, epsilon = 1e-6);
        assert!(integrals.second_moment[(0, 0)] > 3.0 * integrals.second_moment[(1, 1)]);
    }

    /// Steiner's formula for a convex body grown by r: V + S r + M r² + 4/3 π r³ with M = π/… the
    /// edges' share, for a box π(a+b+c). The faceted ball is what is missing: below 2 %.
    #[test]
    fn rounded_box_grows_by_its_border() {
        let (a, b, c, r) = (0.4, 0.6, 0.2, 0.05);
        let half = |x: f64| (x / 2.0) as f32;
        let shape = SharedShape::round_cuboid(half(a), half(b), half(c), r as f32);
        let steiner = a * b * c
            + 2.0 * (a * b + b * c + c * a) * r
            + PI * (a + b + c) * r * r
            + 4.0 / 3.0 * PI * r.powi(3);
        assert_relative_eq!(volume(&shape), steiner, max_relative = 0.02);
        for shape in [
            SharedShape::round_cylinder(0.1, 0.2, 0.02),
            SharedShape::round_cone(0.1, 0.2, 0.02),
            SharedShape::round_triangle(Vector::ZERO, Vector::X, Vector::Y, 0.02),
        ] {
            assert!(volume(&shape) > 0.0);
        }
    }

    #[test]
    fn compound_parts_are_placed_and_added() {
        let part = SharedShape::cuboid(0.5, 0.5, 0.5);
        let poses = [Pose::from_translation(Vector::X * 2.0), Pose::IDENTITY];
        let shape = SharedShape::compound(poses.map(|p| (p, part.clone())).to_vec());
        let i = Surface::from_shape(shape.as_ref())
            .unwrap()
            .volume_integrals();
        assert_relative_eq!(i.volume, 2.0, max_relative = 1e-6);
        assert_relative_eq!(i.centroid, Vector3::x(), epsilon = 1e-6);
    }

    #[test]
    fn voxels_are_closed() {
        let voxels =
            SharedShape::voxels_from_points(Vector::splat(0.1), &[Vector::ZERO, Vector::X]);
        assert_relative_eq!(volume(&voxels), 2e-3, max_relative = 1e-4);
    }

    #[test]
    fn shapes_without_volume_are_named() {
        let error = Surface::from_shape(SharedShape::halfspace(Vector::Y).as_ref());
        assert_eq!(
            error,
            Err(Error::ShapeWithoutVolume {
                shape: "half-space"
            })
        );
        let triangle = SharedShape::triangle(Vector::ZERO, Vector::X, Vector::Y);
        assert!(Surface::from_shape(triangle.as_ref()).is_err());
        assert!(Surface::from_shape(SharedShape::ball(0.0).as_ref()).is_err());
        assert!(Surface::from_shape(SharedShape::ball(f32::NAN).as_ref()).is_err());
    }
}
