//! The closed surface of a body as a free surface cuts it: volume, centroid and waterplane of what is under.

mod cut;
mod divide;

pub use cut::{Submerged, Waterplane};

use crate::error::Error;
use crate::geometry::{Ellipsoid, Surface, check_indices};
use cut::{Corner, under_ellipsoid, under_few, under_many};
use rapier3d::math::Pose;
use rapier3d::na::{Matrix3, Rotation3, Vector3};
use rapier3d::parry::shape::{Shape, TypedShape};

/// The closed surface of a body or part, which a free surface cuts.
///
/// # Errors of round shapes
/// Of polyhedra, balls and ellipsoids volume, centroid and waterplane are exact. Cylinders, cones, capsules and rounded
/// borders are polyhedra of few facets, 24 around the axis, and of exactly the shape's volume. Largest errors against
/// closed forms while between 5 and 95 % of the height are under: of the draft in diameters, of the waterplane as a share of
/// its largest. Where the lowest facet of a lying one touches the surface, the waterplane is off by up to 4 %.
///
/// | shape | attitude | triangles | draft | waterplane |
/// |---|---|---|---|---|
/// | cylinder | upright | 96 | 0 | 0, its second moment 3·10⁻⁵ |
/// | cylinder | lying | 96 | 7·10⁻⁵ | 0.9 % |
/// | capsule, as long as 4.3 diameters | upright | 576 | 0.5 % | 1.5 %, at its round ends |
/// | capsule, the same | lying | 576 | 3·10⁻⁴ | 0.9 % |
///
/// # Cost
/// A cut looks at every triangle, so its time grows with their number, and allocates nothing. On one core
/// (`cargo bench --bench hull`): ball 27 ns, box 170 ns, cylinder 0.9 µs, capsule 3.7 µs; meshes of more than 512 corners
/// 29 ns per triangle, smaller ones 6 to 14. A mesh costs what it has, so give a body that floats a few hundred.
///
/// ```
/// use rapier3d_immersed::Hull;
/// use rapier3d_immersed::rapier3d::na::{Matrix3, Rotation3, Vector3};
/// use rapier3d_immersed::rapier3d::prelude::*;
///
/// // A log of 30 cm diameter and 4 m length lies in water (a cylinder's axis is y). How deep is its middle if it weighs
/// // half as much as water? As deep as the water is high: half of the log is under.
/// let log = Hull::from_shape(&Cylinder::new(2.0, 0.15))?;
/// let lying = Rotation3::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_2);
/// let under = |depth| log.under_plane(lying.matrix(), depth, [0.0, 0.0]);
/// assert!((under(0.0).volume / log.volume() - 0.5).abs() < 1e-9);
/// // A log of a relative density of 0.8 floats with its axis deeper: by bisection,
/// let (mut low, mut high) = (-0.15, 0.15);
/// for _ in 0..40 {
///     let middle = 0.5 * (low + high);
///     if under(middle).volume < 0.8 * log.volume() { low = middle } else { high = middle }
/// }
/// // by 0.492 radii, where the circular segment above has a fifth of the area.
/// assert!((low / 0.15 - 0.492).abs() < 0.01);
/// // It cuts a rectangle out of the surface: as long as the log, as wide as the chord there.
/// let chord = 2.0 * 0.15 * (1.0_f64 - 0.492 * 0.492).sqrt();
/// assert!((under(low).waterplane.area / (4.0 * chord) - 1.0).abs() < 0.01);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Hull {
    /// An ellipsoid: cut in closed form.
    Ellipsoid {
        /// Its center, m.
        center: Vector3<f64>,
        /// From its own axes to the frame.
        axes: Rotation3<f64>,
        /// Its semi-axes.
        shape: Ellipsoid,
    },
    /// A polyhedron, its triangles counter-clockwise seen from the fluid. Where it overlaps itself, the overlap counts
    /// twice, as it does in rapier's mass properties.
    Polyhedron {
        /// Its corners, m.
        vertices: Vec<Vector3<f64>>,
        /// Indices of each triangle's corners.
        triangles: Vec<[u32; 3]>,
    },
    /// Several side by side: what they displace adds up, also where they overlap.
    Several(Vec<Hull>),
}

impl Hull {
    /// The hull of a closed surface: its own triangles.
    pub fn from_surface(surface: &Surface) -> Self {
        Self::Polyhedron {
            vertices: surface.vertices().to_vec(),
            triangles: surface.triangles().to_vec(),
        }
    }

    /// The closed surface that it is, if it is one.
    pub(in crate::hydro) fn surface(&self) -> Option<Surface> {
        match self {
            Self::Polyhedron {
                vertices,
                triangles,
            } => Some(Surface::unchecked(vertices.clone(), triangles.clone())),
            Self::Several(hulls) if hulls.len() == 1 => hulls[0].surface(),
            Self::Ellipsoid { .. } | Self::Several(_) => None,
        }
    }

    /// The hull of a rapier shape in the shape's own frame: balls in closed form, other round shapes as polyhedra of few
    /// facets (see [`Hull`]), meshes by their own triangles, compounds by the sum of their shapes.
    ///
    /// # Errors
    /// Those of [`Surface::from_shape`].
    pub fn from_shape(shape: &dyn Shape) -> Result<Self, Error> {
        let ball = |center, radius: f32| {
            Ok(Self::Ellipsoid {
                center: crate::math::to_f64(center),
                axes: Rotation3::identity(),
                shape: Ellipsoid {
                    semi_axes: Vector3::repeat(Error::check_positive("radius", radius.into())?),
                },
            })
        };
        match shape.as_typed_shape() {
            TypedShape::Ball(s) => ball(rapier3d::math::Vector::ZERO, s.radius),
            TypedShape::Capsule(s) if s.half_height() == 0.0 => ball(s.center(), s.radius),
            TypedShape::Compound(s) => {
                let parts: Vec<_> = s.shapes().iter().map(|(p, s)| (*p, s.as_ref())).collect();
                Self::of_parts(&parts)
            }
            _ => Ok(Self::from_surface(&Surface::of_hull(shape)?)),
        }
    }

    /// The hull of several shapes at their poses.
    pub(crate) fn of_parts(parts: &[(Pose, &dyn Shape)]) -> Result<Self, Error> {
        let hulls: Result<Vec<_>, Error> = parts
            .iter()
            .map(|(pose, shape)| {
                let pose = crate::math::isometry(pose);
                let turn = pose.rotation.to_rotation_matrix();
                Ok(Self::from_shape(*shape)?.posed(&turn, &pose.translation.vector))
            })
            .collect();
        Ok(Self::several(hulls?))
    }

    /// Hulls side by side, their polyhedra as one.
    fn several(hulls: Vec<Self>) -> Self {
        let (mut all, mut corners, mut faces) = (Vec::new(), Vec::new(), Vec::new());
        let mut rest = hulls;
        rest.reverse();
        while let Some(hull) = rest.pop() {
            match hull {
                Self::Ellipsoid { .. } => all.push(hull),
                Self::Polyhedron {
                    vertices,
                    triangles,
                } => {
                    let offset = corners.len() as u32;
                    corners.extend(vertices);
                    faces.extend(triangles.iter().map(|t| t.map(|i| i + offset)));
                }
                Self::Several(hulls) => rest.extend(hulls.into_iter().rev()),
            }
        }
        if !faces.is_empty() {
            all.push(Self::Polyhedron {
                vertices: corners,
                triangles: faces,
            });
        }
        match all.len() {
            1 => all.remove(0),
            _ => Self::Several(all),
        }
    }

    /// Number of triangles that a cut looks at; none for an ellipsoid.
    pub fn triangles(&self) -> usize {
        match self {
            Self::Ellipsoid { .. } => 0,
            Self::Polyhedron { triangles, .. } => triangles.len(),
            Self::Several(hulls) => hulls.iter().map(Self::triangles).sum(),
        }
    }

    /// The hull in another frame.
    pub fn posed(&self, rotation: &Rotation3<f64>, translation: &Vector3<f64>) -> Self {
        match self {
            Self::Ellipsoid {
                center,
                axes,
                shape,
            } => Self::Ellipsoid {
                center: rotation * center + translation,
                axes: rotation * axes,
                shape: *shape,
            },
            Self::Polyhedron {
                vertices,
                triangles,
            } => Self::Polyhedron {
                vertices: vertices
                    .iter()
                    .map(|v| rotation * v + translation)
                    .collect(),
                triangles: triangles.clone(),
            },
            Self::Several(hulls) => {
                let posed = hulls.iter().map(|hull| hull.posed(rotation, translation));
                Self::Several(posed.collect())
            }
        }
    }

    /// A distance from the origin that no point of the hull exceeds, m: of a polyhedron the largest there is.
    pub fn radius(&self) -> f64 {
        match self {
            Self::Ellipsoid { center, shape, .. } => center.norm() + shape.semi_axes.max(),
            Self::Polyhedron { vertices, .. } => {
                vertices.iter().map(|v| v.norm()).fold(0.0, f64::max)
            }
            Self::Several(hulls) => hulls.iter().map(Self::radius).fold(0.0, f64::max),
        }
    }

    /// The volume that it encloses, m³.
    pub fn volume(&self) -> f64 {
        self.whole().volume
    }

    /// Centroid of the volume that it encloses, m.
    pub fn centroid(&self) -> Vector3<f64> {
        let whole = self.whole();
        whole.moment / whole.volume
    }

    /// All of it, as if it were far under; without the digits that depth would cost.
    fn whole(&self) -> Submerged {
        match self {
            Self::Polyhedron { vertices, .. } if vertices.is_empty() => Submerged::default(),
            Self::Polyhedron {
                vertices,
                triangles,
            } => {
                let surface = Surface::unchecked(vertices.clone(), triangles.clone());
                let integrals = surface.volume_integrals();
                Submerged {
                    volume: integrals.volume,
                    moment: integrals.centroid * integrals.volume,
                    ..Submerged::default()
                }
            }
            Self::Ellipsoid { .. } => {
                self.under_plane(&Matrix3::identity(), f64::INFINITY, [0.0, 0.0])
            }
            Self::Several(hulls) => sum_of(hulls, Self::whole),
        }
    }

    /// Whether [`Hull::check`] finds nothing.
    pub fn is_valid(&self) -> bool {
        self.check().is_ok()
    }

    /// Checks every number and index.
    ///
    /// # Errors
    /// [`Error::NonFiniteVertex`], [`Error::IndexOutOfRange`], [`Error::EmptyMesh`] or [`Error::OpenMesh`] of a
    /// polyhedron; [`Error::NotFinite`] or [`Error::InvalidParameter`] of an ellipsoid, whose semi-axes are positive and
    /// whose axes are a rotation, and of several hulls without one.
    pub fn check(&self) -> Result<(), Error> {
        match self {
            Self::Ellipsoid {
                center,
                axes,
                shape,
            } => {
                Error::check_all_finite("center of a hull", center.as_slice())?;
                let axes = axes.matrix();
                Error::check_all_finite("axes of a hull", axes.as_slice())?;
                let skewness = (axes * axes.transpose() - Matrix3::identity()).amax();
                let rotation = skewness < 1e-6 && axes.determinant() > 0.0;
                Error::check("axes of a hull", skewness, rotation, "a rotation")?;
                for semi_axis in shape.semi_axes.iter() {
                    Error::check_positive("semi-axis of a hull", *semi_axis)?;
                }
                Ok(())
            }
            Self::Polyhedron {
                vertices,
                triangles,
            } => {
                check_indices(vertices, triangles)?;
                Surface::unchecked(vertices.clone(), triangles.clone()).check_closed()
            }
            Self::Several(hulls) => {
                let count = hulls.len() as f64;
                Error::check("hulls side by side", count, count > 0.0, "at least one")?;
                for hull in hulls {
                    if let Self::Several(inner) = hull {
                        let count = inner.len() as f64;
                        Error::check("hulls side by side within others", count, false, "none")?;
                    }
                    hull.check()?;
                }
                Ok(())
            }
        }
    }

    /// What is under a plane: `depth` is how far the point that positions are counted from is under it, along y, and
    /// `slope` how fast the surface rises along x and z. `turn` maps the hull's frame to level axes. Exact.
    #[inline]
    pub fn under_plane(&self, turn: &Matrix3<f64>, depth: f64, slope: [f64; 2]) -> Submerged {
        let [along_x, along_z] = slope;
        let normal = Vector3::new(-along_x, 1.0, -along_z);
        match self {
            Self::Ellipsoid {
                center,
                axes,
                shape,
            } => under_ellipsoid(
                turn * center,
                &(turn * axes.matrix()),
                shape,
                depth,
                &normal,
            ),
            Self::Polyhedron { .. } => self.cut(turn, &|r: &Vector3<f64>| depth - normal.dot(r)),
            Self::Several(hulls) => sum_of(hulls, |hull| hull.under_plane(turn, depth, slope)),
        }
    }

    /// What is under any surface. `depth` says how far a point, given in level axes, is under it along y; negative above.
    ///
    /// A polyhedron is cut as if the depth were linear along its edges: exactly by a plane; where the surface bends over
    /// the length of an edge, [divide](Hull::divided) it. An ellipsoid is cut by the plane that touches the surface over
    /// or under its center.
    pub fn under(&self, turn: &Matrix3<f64>, depth: impl Fn(&Vector3<f64>) -> f64) -> Submerged {
        self.cut(turn, &depth)
    }

    fn cut<D: Fn(&Vector3<f64>) -> f64>(&self, turn: &Matrix3<f64>, depth: &D) -> Submerged {
        match self {
            Self::Ellipsoid { center, shape, .. } => {
                let at = turn * center;
                let step = (1e-3 * shape.semi_axes.max()).max(1e-9);
                let along = |axis: Vector3<f64>| {
                    let [ahead, behind] = [at + axis * step, at - axis * step].map(|r| depth(&r));
                    (ahead - behind) / (2.0 * step)
                };
                let slope = [along(Vector3::x()), along(Vector3::z())];
                let here = depth(&at) + at.y - slope[0] * at.x - slope[1] * at.z;
                self.under_plane(turn, here, slope)
            }
            Self::Polyhedron {
                vertices,
                triangles,
            } => {
                let place = |v: &Vector3<f64>| -> Corner {
                    let r = turn * v;
                    (r, depth(&r))
                };
                // What is set aside for corners is filled with zeros first: as little as will do.
                match vertices.len() {
                    0..=8 => under_few::<8>(vertices, triangles, place),
                    9..=64 => under_few::<64>(vertices, triangles, place),
                    65..=512 => under_few::<512>(vertices, triangles, place),
                    _ => under_many(vertices, triangles, place),
                }
            }
            Self::Several(hulls) => sum_of(hulls, |hull| hull.cut(turn, depth)),
        }
    }
}

fn sum_of(hulls: &[Hull], of: impl Fn(&Hull) -> Submerged) -> Submerged {
    let mut sum = Submerged::default();
    for hull in hulls {
        sum += of(hull);
    }
    sum
}
