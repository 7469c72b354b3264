//! Closed surfaces from rapier's shapes.

use super::Surface;
use super::revolution::{Facets, RoundBody, arc, revolve};
use super::rounded::Core;
use super::voxels;
use crate::error::Error;
use crate::math;
use crate::math::to_f64;
use rapier3d::math::{Pose, Real, Vector};
use rapier3d::parry::shape::{
    ConvexPolyhedron, RoundCone, RoundConvexPolyhedron, RoundCuboid, RoundCylinder, RoundTriangle,
    Shape, TypedShape,
};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// Share of its size that the surface of [`Surface::of_hull`] may be off a round one by, before the volume is made exact.
const HULL_ERROR: f64 = 0.01;

impl Surface {
    /// The surface of a shape of a rapier collider, in the shape's own frame.
    ///
    /// Every shape that encloses a volume has one, at any aspect and scale: ball, cuboid, capsule, cylinder,
    /// cone, convex polyhedron, voxels; the rounded ones of cuboid, cylinder, cone, convex polyhedron and
    /// triangle **with their border**; closed triangle meshes; and compounds of them. Half extents may be zero
    /// where there is a border.
    ///
    /// Flat-faced shapes are exact. Round ones are inscribed polyhedra, blown up a little across
    /// their axis (rounded edges: from their core) so that their **volume is exact**; their other integrals
    /// are right to about 10⁻³.
    ///
    /// # Errors
    /// [`Error::ShapeWithoutVolume`] names the shapes that enclose nothing (half-space, height
    /// field, polyline, segment, triangle), [`Error::UnknownShape`] a custom shape: make a
    /// [`Surface::new`] of it. An open triangle mesh gives [`Error::OpenMesh`], a length that is negative, zero
    /// or not finite [`Error::InvalidParameter`], and a shape of less than 10⁻¹² of the cube of its size (a
    /// needle a million times as long as thick) [`Error::NoVolume`].
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
        Self::divided(shape, &Facets::FINE)
    }

    /// The surface of a shape with as few facets as its waterplane needs to be right to about 1 %, for what is done
    /// at each step. Its volume is exact.
    pub(crate) fn of_hull(shape: &dyn Shape) -> Result<Self, Error> {
        Self::divided(shape, &facets_of_hull(shape))
    }

    fn divided(shape: &dyn Shape, facets: &Facets) -> Result<Self, Error> {
        let none = |shape| Err(Error::ShapeWithoutVolume { shape });
        match shape.as_typed_shape() {
            TypedShape::Ball(s) => ball(length("radius", s.radius)?, facets),
            TypedShape::Cuboid(s) => {
                for (name, value) in HALF_EXTENTS.iter().zip(s.half_extents.to_array()) {
                    length(name, value)?;
                }
                from_polyhedron(s.to_trimesh())
            }
            TypedShape::Capsule(s) => {
                let r = length("radius", s.radius)?;
                let h = length_or_zero("half height", s.half_height())?;
                let mut profile = arc(r, 0.0, PI / 2.0, facets);
                profile.iter_mut().for_each(|p| p.1 += h);
                let lower = arc(r, PI / 2.0, PI, facets);
                profile.extend(lower.iter().map(|p| (p.0, p.1 - h)));
                let volume = PI * r * r * (4.0 / 3.0 * r + 2.0 * h);
                let along_y = revolve(&profile, volume, facets)?;
                if h == 0.0 {
                    // A segment of no length has no direction, and its rotation is not a number.
                    let center = to_f64(s.center());
                    return Ok(along_y.map(|v| v + center));
                }
                let pose = Pose::from_parts(s.center(), s.rotation_wrt_y());
                Ok(along_y.posed(&pose))
            }
            TypedShape::Cylinder(s) => {
                let r = length("radius", s.radius)?;
                let h = length("half_height", s.half_height)?;
                revolve(
                    &[(0.0, h), (r, h), (r, -h), (0.0, -h)],
                    2.0 * PI * r * r * h,
                    facets,
                )
            }
            TypedShape::Cone(s) => {
                let r = length("radius", s.radius)?;
                let h = length("half_height", s.half_height)?;
                revolve(
                    &[(0.0, h), (r, -h), (0.0, -h)],
                    2.0 / 3.0 * PI * r * r * h,
                    facets,
                )
            }
            TypedShape::ConvexPolyhedron(s) => from_polyhedron(s.to_trimesh()),
            TypedShape::TriMesh(s) => from_mesh((s.vertices().to_vec(), s.indices().to_vec())),
            TypedShape::Voxels(s) => voxels::surface(s),
            TypedShape::Compound(s) => {
                let parts: Vec<_> = s.shapes().iter().map(|(p, s)| (*p, s.as_ref())).collect();
                Self::of_parts(&parts, |part| Self::divided(part, facets))
            }
            TypedShape::RoundCuboid(_)
            | TypedShape::RoundCylinder(_)
            | TypedShape::RoundCone(_)
            | TypedShape::RoundConvexPolyhedron(_)
            | TypedShape::RoundTriangle(_) => rounded_surface(shape, facets),
            TypedShape::HalfSpace(_) => none("half-space"),
            TypedShape::HeightField(_) => none("height field"),
            TypedShape::Polyline(_) => none("polyline"),
            TypedShape::Segment(_) => none("segment"),
            TypedShape::Triangle(_) => none("triangle"),
            TypedShape::Custom(_) => Err(Error::UnknownShape),
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

/// The volume of a shape with its rounded border, m³; `None` if it has no border.
pub(crate) fn rounded_volume(shape: &dyn Shape) -> Result<Option<f64>, Error> {
    let rounded = Rounded::of(shape, &Facets::FINE)?;
    rounded.map(|rounded| rounded.volume()).transpose()
}

/// Facets for [`Surface::of_hull`]. A border that is narrow beside the body needs but few: what they are off its arc
/// by is some share of the second of the body's three dimensions, on which its waterplane depends in any attitude but
/// flat.
fn facets_of_hull(shape: &dyn Shape) -> Facets {
    let mut half = shape.compute_local_aabb().half_extents().to_array();
    half.sort_by(f32::total_cmp);
    let border = match shape.as_typed_shape() {
        TypedShape::Capsule(s) => s.radius,
        TypedShape::RoundCuboid(s) => s.border_radius,
        TypedShape::RoundCylinder(s) => s.border_radius,
        TypedShape::RoundCone(s) => s.border_radius,
        TypedShape::RoundConvexPolyhedron(s) => s.border_radius,
        TypedShape::RoundTriangle(s) => s.border_radius,
        _ => half[1],
    };
    let share = HULL_ERROR * f64::from(half[1] / border);
    // What is not a number is found when the surface is made.
    let step = if share < 1.0 - math::cos(FRAC_PI_4) {
        2.0 * math::acos(1.0 - share)
    } else {
        FRAC_PI_2
    };
    Facets {
        around: 24,
        along: (PI / step).ceil() as usize,
        step: step * (1.0 + 1e-9),
    }
}

/// The surface of a shape with a rounded border; that of any other shape with the facets of fine ones.
pub(super) fn rounded_surface(shape: &dyn Shape, facets: &Facets) -> Result<Surface, Error> {
    match Rounded::of(shape, facets)? {
        Some(rounded) => rounded.surface(facets),
        None => Surface::from_shape(shape),
    }
}

/// A shape grown by a border on all sides.
enum Rounded {
    /// A ball: the core is a point.
    Ball(f64),
    /// A body of revolution.
    Revolved(RoundBody),
    /// A convex polyhedron, and its border in m.
    Grown(Core, f64),
}

impl Rounded {
    fn of(shape: &dyn Shape, facets: &Facets) -> Result<Option<Self>, Error> {
        Ok(Some(match shape.as_typed_shape() {
            TypedShape::RoundCuboid(s) => Self::cuboid(s)?,
            TypedShape::RoundCylinder(s) => Self::cylinder(s, facets)?,
            TypedShape::RoundCone(s) => Self::cone(s, facets)?,
            TypedShape::RoundConvexPolyhedron(s) => Self::polyhedron(s)?,
            TypedShape::RoundTriangle(s) => Self::triangle(s)?,
            _ => return Ok(None),
        }))
    }

    fn cuboid(s: &RoundCuboid) -> Result<Self, Error> {
        let border = length_or_zero("border_radius", s.border_radius)?;
        let mut half = to_f64(s.inner_shape.half_extents);
        for (name, value) in HALF_EXTENTS.iter().zip(half.iter_mut()) {
            *value = core_length(name, *value as Real, border)?;
        }
        Ok(Self::Grown(Core::cuboid(half), border))
    }

    fn cylinder(s: &RoundCylinder, facets: &Facets) -> Result<Self, Error> {
        let border = length_or_zero("border_radius", s.border_radius)?;
        let r = core_length("radius", s.inner_shape.radius, border)?;
        let h = core_length("half_height", s.inner_shape.half_height, border)?;
        Ok(Self::Revolved(RoundBody::cylinder(r, h, border, facets)))
    }

    fn cone(s: &RoundCone, facets: &Facets) -> Result<Self, Error> {
        let border = length_or_zero("border_radius", s.border_radius)?;
        let r = core_length("radius", s.inner_shape.radius, border)?;
        let h = core_length("half_height", s.inner_shape.half_height, border)?;
        if r == 0.0 && h == 0.0 {
            return Ok(Self::Ball(border));
        }
        Ok(Self::Revolved(RoundBody::cone(r, h, border, facets)))
    }

    fn triangle(s: &RoundTriangle) -> Result<Self, Error> {
        // A triangle has a volume by its border alone.
        let border = length("border_radius", s.border_radius)?;
        let points = s.inner_shape.vertices().map(to_f64);
        super::quality::check_indices(&points, &[[0, 1, 2]])?;
        let [a, b, c] = points;
        if a == b && b == c {
            return Ok(Self::Ball(border));
        }
        Ok(Self::Grown(Core::triangle(points), border))
    }

    fn polyhedron(s: &RoundConvexPolyhedron) -> Result<Self, Error> {
        let border = length_or_zero("border_radius", s.border_radius)?;
        Ok(Self::Grown(polyhedron(&s.inner_shape)?, border))
    }

    fn volume(&self) -> Result<f64, Error> {
        match self {
            Self::Ball(r) => Ok(4.0 / 3.0 * PI * r.powi(3)),
            Self::Revolved(body) => Ok(body.volume),
            Self::Grown(core, border) => core.grown_volume(*border),
        }
    }

    fn surface(&self, facets: &Facets) -> Result<Surface, Error> {
        match self {
            Self::Ball(r) => ball(*r, facets),
            Self::Revolved(body) => body.surface(),
            Self::Grown(core, border) => core.grown(*border, facets.step),
        }
    }
}

const HALF_EXTENTS: [&str; 3] = ["half_extents.x", "half_extents.y", "half_extents.z"];

fn length(name: &'static str, value: Real) -> Result<f64, Error> {
    Error::check_positive(name, value.into())
}

fn length_or_zero(name: &'static str, value: Real) -> Result<f64, Error> {
    Error::check_not_negative(name, value.into())
}

/// A length of a core, which may be zero if it has a border.
fn core_length(name: &'static str, value: Real, border: f64) -> Result<f64, Error> {
    if border > 0.0 {
        length_or_zero(name, value)
    } else {
        length(name, value)
    }
}

fn polyhedron(s: &ConvexPolyhedron) -> Result<Core, Error> {
    let points: Vec<_> = s.points().iter().map(|p| to_f64(*p)).collect();
    let corners = s.vertices_adj_to_face();
    super::quality::check_indices(&points, &[[0; 3]])?;
    let faces = s.faces().iter().map(|face| {
        let first = face.first_vertex_or_edge as usize;
        corners[first..first + face.num_vertices_or_edges as usize].to_vec()
    });
    let normals: Vec<_> = s.faces().iter().map(|face| to_f64(face.normal)).collect();
    Ok(Core::polyhedron(points, faces.collect(), &normals))
}

fn ball(radius: f64, facets: &Facets) -> Result<Surface, Error> {
    revolve(
        &arc(radius, 0.0, PI, facets),
        4.0 / 3.0 * PI * radius.powi(3),
        facets,
    )
}

fn from_mesh((vertices, triangles): (Vec<Vector>, Vec<[u32; 3]>)) -> Result<Surface, Error> {
    let vertices: Vec<_> = vertices.iter().map(|v| to_f64(*v)).collect();
    Surface::new(&vertices, &triangles)
}

/// A mesh that rapier has put together, whose triangles share their vertices.
fn from_polyhedron((vertices, triangles): (Vec<Vector>, Vec<[u32; 3]>)) -> Result<Surface, Error> {
    let vertices: Vec<_> = vertices.iter().map(|v| to_f64(*v)).collect();
    Surface::assembled(&vertices, &triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use rapier3d::na::Vector3;
    use rapier3d::parry::math::IVector;
    use rapier3d::parry::shape::SharedShape;

    fn volume(shape: &SharedShape) -> f64 {
        let surface = Surface::from_shape(shape.as_ref()).unwrap();
        surface.volume_integrals().volume
    }

    /// Parry's hull of a hexagon of 69 µm paper is flat and weighs nothing. That is an error that says what to do, and
    /// what it says works: (3/2)√3 r² t.
    #[test]
    fn paper_is_made_of_its_faces() {
        let (radius, thickness) = (0.042f32, 69e-6f32);
        let corner = |k: usize, y: f32| {
            let angle = std::f32::consts::FRAC_PI_3 * k as f32;
            Vector::new(radius * angle.cos(), y, radius * angle.sin())
        };
        let points: Vec<Vector> = (0..6)
            .flat_map(|k| [corner(k, -0.5 * thickness), corner(k, 0.5 * thickness)])
            .collect();
        let hull = SharedShape::convex_hull(&points).unwrap();
        let error = Surface::from_shape(hull.as_ref()).unwrap_err();
        assert!(error.to_string().contains("convex_mesh"), "{error}");

        let mut faces = Vec::new();
        for k in 0..6u32 {
            let (here, next) = (2 * k, 2 * ((k + 1) % 6));
            faces.extend([[here, here + 1, next], [next, here + 1, next + 1]]);
        }
        for k in 1..5u32 {
            faces.extend([[0, 2 * k, 2 * k + 2], [1, 2 * k + 3, 2 * k + 1]]);
        }
        let paper = SharedShape::convex_mesh(points, &faces).unwrap();
        let exact = 1.5 * 3f64.sqrt() * f64::from(radius).powi(2) * f64::from(thickness);
        assert_relative_eq!(volume(&paper), exact, max_relative = 3e-6);
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

    /// A border of no width changes nothing, and one around a point is a ball, whatever the core.
    #[test]
    fn borders_of_nothing_and_around_nothing() {
        let volume_of = |shape: SharedShape| volume(&shape);
        let ball = 4.0 / 3.0 * PI * 0.027;
        let hull: Vec<_> = (0..8)
            .map(|i| Vector::new(i as f32 % 2.0, (i / 2) as f32 % 2.0, (i / 4) as f32))
            .collect();
        for (shape, exact) in [
            (SharedShape::round_cuboid(0.1, 0.2, 0.3, 0.0), 0.048),
            (SharedShape::round_cylinder(0.01, 0.4, 0.0), PI * 0.0032),
            (SharedShape::round_cone(0.5, 0.2, 0.0), PI * 0.04 / 3.0),
            (SharedShape::round_convex_hull(&hull, 0.0).unwrap(), 1.0),
            (SharedShape::round_cuboid(0.0, 0.0, 0.0, 0.3), ball),
            (SharedShape::round_cylinder(0.0, 0.0, 0.3), ball),
            (SharedShape::round_cone(0.0, 0.0, 0.3), ball),
            (
                SharedShape::round_triangle(Vector::X, Vector::X, Vector::X, 0.3),
                ball,
            ),
        ] {
            assert_relative_eq!(volume_of(shape), exact, max_relative = 3e-7);
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

    /// A block with a hole through it and two cells that touch along an edge, ten thousand cells from the
    /// origin, where the centers of cells are rounded in single precision: the count of cells is the volume.
    #[test]
    fn voxels_are_closed() {
        let cell = |x: i32, y: i32, z: i32| IVector::new(10_000 + x, y - 7_001, z);
        let mut cells = vec![cell(3, 3, 0), cell(9, 9, 9)];
        for (x, y, z) in (0..27).map(|i| (i % 3, i / 3 % 3, i / 9)) {
            if (x, y) != (1, 1) {
                cells.push(cell(x, y, z));
            }
        }
        let size = [0.1, 0.07, 0.3];
        let shape = SharedShape::voxels(size.into(), &cells);
        let surface = Surface::from_shape(shape.as_ref()).unwrap();
        let found = surface.volume_integrals();
        let size = size.map(f64::from);
        let one: f64 = size.iter().product();
        assert_relative_eq!(found.volume, 26.0 * one, max_relative = 1e-9);
        // The ring is 24 cells around (10001.5, −6999.5, 1.5).
        let x = (24.0 * 10_001.5 + 10_003.5 + 10_009.5) / 26.0 * size[0];
        assert_relative_eq!(found.centroid.x, x, max_relative = 1e-9);
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
    }

    /// A length that cannot be is named, with its value.
    #[test]
    fn lengths_that_cannot_be_are_named() {
        let (nan, infinite) = (f32::NAN, f32::INFINITY);
        for (shape, text) in [
            (
                SharedShape::ball(0.0),
                "radius must be positive and finite, but is 0",
            ),
            (SharedShape::ball(nan), "radius"),
            (SharedShape::cuboid(1.0, -2.0, 1.0), "half_extents.y"),
            (SharedShape::capsule_x(1.0, 0.0), "radius"),
            (SharedShape::capsule_x(nan, 1.0), "half height"),
            (SharedShape::cylinder(0.0, 1.0), "half_height"),
            (SharedShape::cone(1.0, infinite), "radius"),
            (
                SharedShape::round_cuboid(1.0, 1.0, nan, 0.1),
                "half_extents.z",
            ),
            (
                SharedShape::round_cuboid(1.0, 1.0, 0.0, 0.0),
                "half_extents.z",
            ),
            (SharedShape::round_cylinder(1.0, 1.0, -0.5), "border_radius"),
            (SharedShape::round_cone(-1.0, 1.0, 0.5), "half_height"),
            (
                SharedShape::round_triangle(Vector::X, Vector::Y, Vector::ZERO, 0.0),
                "border_radius",
            ),
            (
                SharedShape::round_triangle(Vector::X, Vector::Y, Vector::splat(nan), 0.1),
                "vertex 2 of the mesh is not finite",
            ),
            (
                SharedShape::voxels(Vector::new(0.1, 0.0, 0.1), &[IVector::ZERO]),
                "voxel_size.y",
            ),
        ] {
            let error = Surface::from_shape(shape.as_ref()).unwrap_err().to_string();
            assert!(error.starts_with(text), "{error}");
        }
    }
}
