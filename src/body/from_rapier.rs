//! What rapier's bodies are made of, read in f64, and mass properties that rapier gets right.

use super::DryMass;
use super::division::{Division, added_mass_of, parts_of};
use crate::error::Error;
use crate::geometry::{Surface, rounded_volume};
use crate::hydro::{Accuracy, AddedMassSource, Hull, HydroProperties};
use crate::math::{to_f64, to_quaternion, to_real, to_rotation};
use rapier3d::dynamics::{
    MassProperties, RigidBody, RigidBodyAdditionalMassProps, RigidBodyHandle, RigidBodySet,
};
use rapier3d::geometry::{Collider, ColliderSet, SharedShape};
use rapier3d::math::{Pose, Vector};
use rapier3d::na::{Isometry3, Matrix3, Rotation3, UnitQuaternion, Vector3};
use rapier3d::parry::shape::{Shape, TypedShape};

impl HydroProperties {
    /// Properties of all of a body's enabled, solid (not sensor) colliders together, in the body's
    /// local frame, referred to its center of mass, with the [parts](HydroProperties::parts) that they are to the
    /// fluid ([`Division::Automatic`]).
    ///
    /// # Errors
    /// [`Error::NoBody`] if the handle is stale, [`Error::NoCollider`] if there is nothing to
    /// immerse, those of [`Surface::from_shape`] and of [`DryMass::of_body`].
    pub fn from_body(
        bodies: &RigidBodySet,
        colliders: &ColliderSet,
        handle: RigidBodyHandle,
    ) -> Result<Self, Error> {
        Self::from_body_with(bodies, colliders, handle, Accuracy::default())
    }

    /// [`HydroProperties::from_body`] with its colliders divided into parts as told.
    ///
    /// ```
    /// use rapier3d_immersed::rapier3d::prelude::*;
    /// use rapier3d_immersed::{Division, HydroProperties};
    ///
    /// // Two crossed fins: two surfaces.
    /// let mut world = PhysicsWorld::new();
    /// let (dart, _) = world.insert(
    ///     RigidBodyBuilder::dynamic(),
    ///     ColliderBuilder::cuboid(0.1, 0.03, 0.001).density(100.0),
    /// );
    /// let fin = ColliderBuilder::cuboid(0.1, 0.001, 0.03).density(100.0).build();
    /// world.colliders.insert_with_parent(fin, dart, &mut world.bodies);
    /// let divided = |division| {
    ///     let (bodies, colliders) = (&world.bodies, &world.colliders);
    ///     HydroProperties::from_body_divided(bodies, colliders, dart, division)
    /// };
    /// assert_eq!(divided(Division::Automatic)?.parts.len(), 2);
    /// assert!(divided(Division::Whole)?.parts.is_empty());
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`HydroProperties::from_body`].
    pub fn from_body_divided(
        bodies: &RigidBodySet,
        colliders: &ColliderSet,
        handle: RigidBodyHandle,
        division: Division,
    ) -> Result<Self, Error> {
        let (parts, center) = solid_parts(bodies, colliders, handle)?;
        Self::of_parts(&parts, center, division)
    }

    /// [`HydroProperties::from_body`] with the added mass as accurate as asked for.
    ///
    /// A solve that does not reach the tolerance is logged as a warning, not an error.
    ///
    /// # Errors
    /// Those of [`HydroProperties::from_body`] and [`HydroProperties::from_shape_with`]; colliders
    /// that touch or overlap, which make no single mesh, are an [`Error::SelfIntersection`].
    pub fn from_body_with(
        bodies: &RigidBodySet,
        colliders: &ColliderSet,
        handle: RigidBodyHandle,
        accuracy: Accuracy,
    ) -> Result<Self, Error> {
        let (parts, center) = solid_parts(bodies, colliders, handle)?;
        Self::of_parts(&parts, center, Division::Automatic)?.with_accuracy(&parts, accuracy)
    }

    /// Properties of shapes at their poses in a body's frame, referred to `center`.
    pub(crate) fn of_parts(
        parts: &[(Pose, &dyn Shape)],
        center: Vector3<f64>,
        division: Division,
    ) -> Result<Self, Error> {
        if parts.is_empty() {
            return Err(Error::NoCollider);
        }
        let surface = Surface::of_parts(parts, Surface::from_shape)?;
        let mut whole = Self::with_hull(&surface, Hull::of_parts(parts)?, center);
        whole.parts = parts_of(parts, center, division)?;
        if !whole.parts.is_empty() {
            whole.added_mass = added_mass_of(&whole.parts);
            whole.added_mass_source = AddedMassSource::Parts;
        }
        Ok(whole)
    }
}

impl DryMass {
    /// The mass properties that rapier *means* to give a body: the sum over its colliders and its
    /// additional mass properties, in f64.
    ///
    /// Rapier's own sum, and its inertia of convex hulls and meshes, go through an eigenvalue
    /// solver with an absolute threshold, which returns wrong principal axes for inertia tensors
    /// with entries below about 10⁻⁵ kg·m²: every leaf, coin and snowflake (glamx 0.3.1).
    ///
    /// A collider with a mass of its own, or a density, has that mass as rapier has it: of a rounded shape with
    /// a density, the core's ([`DryMass::of_shape`] is that of the whole). It is spread over the whole shape.
    ///
    /// # Errors
    /// [`Error::NoBody`] if the handle is stale; [`Error::InvalidParameter`] if the mass or a
    /// principal moment of inertia is not positive and finite; those of [`Surface::from_shape`] for
    /// colliders that get their mass from their density.
    pub fn of_body(
        bodies: &RigidBodySet,
        colliders: &ColliderSet,
        handle: RigidBodyHandle,
    ) -> Result<Self, Error> {
        let body = bodies.get(handle).ok_or(Error::NoBody)?;
        let mut parts = Vec::new();
        for (collider, pose) in attached(body, colliders) {
            if collider.mass() > 0.0 {
                parts.push(of_collider(collider, &pose)?);
            }
        }
        let mut total = parts.into_iter().reduce(|sum, part| sum.combined(&part));
        match body.mass_properties().additional_local_mprops.as_deref() {
            None => {}
            Some(RigidBodyAdditionalMassProps::MassProps(extra)) if extra.mass() > 0.0 => {
                let extra = of_mass_properties(extra, &Pose::IDENTITY);
                total = Some(total.map_or(extra, |total| total.combined(&extra)));
            }
            Some(RigidBodyAdditionalMassProps::MassProps(_)) => {}
            // As rapier does: the inertia scales with the mass, or comes from the shapes.
            Some(RigidBodyAdditionalMassProps::Mass(extra)) => {
                let extra = f64::from(*extra);
                total = match total {
                    Some(total) => Some(scaled(&total, total.mass + extra)),
                    None if extra > 0.0 => {
                        let mut parts = Vec::new();
                        for (collider, pose) in attached(body, colliders) {
                            parts.push(of_uniform_density(collider, &pose, 1.0)?);
                        }
                        let unit = parts.into_iter().reduce(|sum, part| sum.combined(&part));
                        unit.map(|unit| scaled(&unit, extra))
                    }
                    None => None,
                };
            }
        }
        let total = total.ok_or(Error::InvalidParameter {
            parameter: "mass",
            requirement: "positive and finite",
            value: 0.0,
        })?;
        total.check()?;
        Ok(total)
    }

    /// As rapier mass properties, with principal axes from nalgebra's solver in f64: right at any
    /// scale, from a snowflake to a boulder.
    pub fn to_mass_properties(&self) -> MassProperties {
        let eigen = self.inertia.symmetric_eigen();
        let mut axes = eigen.eigenvectors;
        if axes.determinant() < 0.0 {
            axes.swap_columns(0, 1);
        }
        // The eigenvalues in the order of the (possibly swapped) axes.
        let moments = Vector3::from_fn(|i, _| {
            let axis = axes.column(i);
            axis.dot(&(self.inertia * axis))
        });
        let frame = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
        MassProperties::with_principal_inertia_frame(
            to_real(self.center),
            self.mass as f32,
            to_real(moments),
            to_rotation(frame),
        )
    }
}

/// How far rapier's inertia tensor is from the right one, relative to its largest entry.
pub(crate) fn inertia_error(rapier: &MassProperties, right: &DryMass) -> f64 {
    let theirs = inertia(rapier);
    (theirs - right.inertia).amax() / right.inertia.amax()
}

/// The inertia tensor that rapier's mass properties stand for, body axes, kg·m².
pub(crate) fn inertia(rapier: &MassProperties) -> Matrix3<f64> {
    of_mass_properties(rapier, &Pose::IDENTITY).inertia
}

fn scaled(mass: &DryMass, to: f64) -> DryMass {
    DryMass {
        mass: to,
        center: mass.center,
        inertia: mass.inertia * (to / mass.mass),
    }
}

/// Shapes at their poses in a body's frame.
type PosedShapes<'a> = Vec<(Pose, &'a dyn Shape)>;

/// Shapes of the solid colliders of a body with their poses, and its center of mass, in its frame.
fn solid_parts<'a>(
    bodies: &RigidBodySet,
    colliders: &'a ColliderSet,
    handle: RigidBodyHandle,
) -> Result<(PosedShapes<'a>, Vector3<f64>), Error> {
    let body = bodies.get(handle).ok_or(Error::NoBody)?;
    let mut parts = Vec::new();
    for collider in body
        .colliders()
        .iter()
        .filter_map(|handle| colliders.get(*handle))
    {
        if collider.is_enabled() && !collider.is_sensor() {
            let pose = collider.position_wrt_parent().copied();
            parts.push((pose.unwrap_or(Pose::IDENTITY), collider.shape()));
        }
    }
    if parts.is_empty() {
        return Err(Error::NoCollider);
    }
    match DryMass::of_body(bodies, colliders, handle) {
        Ok(mass) => Ok((parts, mass.center)),
        // A shape that cannot be is the reason rather than its mass.
        Err(problem) => Surface::of_parts(&parts, Surface::from_shape).and(Err(problem)),
    }
}

/// Enabled colliders of a body with their poses in its frame.
fn attached<'a>(
    body: &'a RigidBody,
    colliders: &'a ColliderSet,
) -> impl Iterator<Item = (&'a Collider, Pose)> + 'a {
    body.colliders()
        .iter()
        .filter_map(|handle| colliders.get(*handle))
        .filter(|collider| collider.is_enabled())
        .map(|collider| {
            let pose = collider.position_wrt_parent().copied();
            (collider, pose.unwrap_or(Pose::IDENTITY))
        })
}

/// Whether a collider's mass comes from its shape, and at which density.
pub(crate) fn uniform_density(collider: &Collider) -> Option<f32> {
    let density = collider.density();
    (collider.shape().mass_properties(density) == collider.mass_properties()).then_some(density)
}

fn of_collider(collider: &Collider, pose: &Pose) -> Result<DryMass, Error> {
    // A shape without volume of its own can only have been given mass explicitly. A rounded triangle has
    // one by its border alone, of which rapier does not know: it makes no inertia of a mass that is set.
    let properties = collider.mass_properties();
    let bare_mass = properties.inv_principal_inertia == Vector::ZERO
        && matches!(
            collider.shape().as_typed_shape(),
            TypedShape::RoundTriangle(_)
        );
    if bare_mass || uniform_density(collider).is_some() {
        of_uniform_density(collider, pose, collider.mass().into())
    } else {
        Ok(of_mass_properties(&properties, pose))
    }
}

/// What rapier makes of the density of the rounded shapes of a body, whose border it leaves out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CoreMass {
    /// Rapier's mass of the body's colliders, kg.
    pub rapier: f64,
    /// What they would have with their borders, kg.
    pub whole: f64,
}

impl CoreMass {
    /// `None` if nothing is left out. Colliders that were given their mass count with it.
    ///
    /// # Errors
    /// [`Error::NoBody`], or what is wrong with a rounded shape.
    pub fn of_body(
        bodies: &RigidBodySet,
        colliders: &ColliderSet,
        handle: RigidBodyHandle,
    ) -> Result<Option<Self>, Error> {
        let body = bodies.get(handle).ok_or(Error::NoBody)?;
        let mut borders = 0.0;
        for (collider, _) in attached(body, colliders) {
            let volume = volume_of_borders(collider.shape())?;
            if volume != 0.0 && has_density(collider) {
                borders += f64::from(collider.density()) * volume;
            }
        }
        if borders == 0.0 {
            return Ok(None);
        }
        let masses = attached(body, colliders).map(|(collider, _)| f64::from(collider.mass()));
        let rapier = masses.sum();
        Ok(Some(Self {
            rapier,
            whole: rapier + borders,
        }))
    }

    /// Share of the whole that rapier leaves out.
    pub fn missing(&self) -> f64 {
        1.0 - self.rapier / self.whole
    }
}

/// The volume that rapier leaves out of a shape's mass, m³.
fn volume_of_borders(shape: &dyn Shape) -> Result<f64, Error> {
    if let TypedShape::Compound(compound) = shape.as_typed_shape() {
        let parts = compound.shapes().iter();
        return parts
            .map(|(_, part)| volume_of_borders(part.as_ref()))
            .sum();
    }
    let core = || f64::from(shape.mass_properties(1.0).mass());
    Ok(rounded_volume(shape)?.map_or(0.0, |whole| whole - core()))
}

/// Whether a collider's mass follows from a density, and not the density from a mass that was set: rapier does
/// not say, but the density stays when the shape changes.
fn has_density(collider: &Collider) -> bool {
    let mut other = collider.clone();
    let balls = [0.5, 1.0].map(SharedShape::ball);
    balls.into_iter().all(|ball| {
        other.set_shape(ball);
        other.density() == collider.density()
    })
}

/// A collider filled uniformly up to `mass`.
fn of_uniform_density(collider: &Collider, pose: &Pose, mass: f64) -> Result<DryMass, Error> {
    let surface = Surface::from_shape(collider.shape())?;
    DryMass::uniform(&surface.posed(pose), mass)
}

fn of_mass_properties(properties: &MassProperties, pose: &Pose) -> DryMass {
    let invert = |x: f32| if x == 0.0 { 0.0 } else { 1.0 / f64::from(x) };
    let pose: Isometry3<f64> = crate::math::isometry(pose);
    let inverse: Vector = properties.inv_principal_inertia;
    let principal = Vector3::new(invert(inverse.x), invert(inverse.y), invert(inverse.z));
    let frame = pose.rotation * to_quaternion(properties.principal_inertia_local_frame);
    let axes = frame.to_rotation_matrix();
    DryMass {
        mass: invert(properties.inv_mass),
        center: (pose * rapier3d::na::Point3::from(to_f64(properties.local_com))).coords,
        inertia: axes.matrix() * Matrix3::from_diagonal(&principal) * axes.matrix().transpose(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use rapier3d::dynamics::RigidBodyBuilder;
    use rapier3d::geometry::ColliderBuilder;
    use rapier3d::math::Rotation;

    /// From a dust grain of 1 µg to a slab of 1 t, a turned box must keep the inertia
    /// m/12 (b² + c²) about its own axes. Rapier's own sum fails below about 10⁻⁵ kg·m².
    #[test]
    fn inertia_is_right_from_a_microgram_to_a_ton() {
        let turn = Rotation::from_euler(rapier3d::glamx::EulerRot::XYZ, 0.3, -0.7, 1.1);
        for exponent in -9..=3 {
            let mass = 10f64.powi(exponent);
            // Leaf proportions at 300 kg/m³.
            let scale = (mass / 300.0 / (0.73 * 0.42 * 0.03)).cbrt();
            let half = [0.365, 0.015, 0.21].map(|x| (x * scale) as f32);
            let mut bodies = RigidBodySet::new();
            let mut colliders = ColliderSet::new();
            let handle = bodies.insert(RigidBodyBuilder::dynamic());
            let collider = ColliderBuilder::cuboid(half[0], half[1], half[2])
                .density(300.0)
                .position(Pose::from_parts(Vector::ZERO, turn));
            colliders.insert_with_parent(collider, handle, &mut bodies);

            let dry = DryMass::of_body(&bodies, &colliders, handle).unwrap();
            let square = half.map(|x| f64::from(x).powi(2) / 3.0);
            let exact = Vector3::new(
                square[1] + square[2],
                square[2] + square[0],
                square[0] + square[1],
            ) * dry.mass;
            let r = to_quaternion(turn).to_rotation_matrix();
            let exact = r.matrix() * Matrix3::from_diagonal(&exact) * r.matrix().transpose();
            assert_relative_eq!(dry.mass, mass, max_relative = 1e-5);
            assert_relative_eq!(dry.inertia, exact, max_relative = 1e-6);

            // And through rapier's own representation in f32.
            let rapier = dry.to_mass_properties();
            assert!(inertia_error(&rapier, &dry) < 1e-5, "{mass} kg");
        }
    }

    /// Two boxes on one body, one of explicit mass properties, plus additional mass properties:
    /// the parallel-axis sum by hand.
    #[test]
    fn parts_add_up() {
        let mut bodies = RigidBodySet::new();
        let mut colliders = ColliderSet::new();
        let extra = MassProperties::new(Vector::new(0.0, 2.0, 0.0), 3.0, Vector::splat(0.5));
        let body = RigidBodyBuilder::dynamic().additional_mass_properties(extra);
        let handle = bodies.insert(body);
        let cube = ColliderBuilder::cuboid(0.5, 0.5, 0.5)
            .density(2.0)
            .translation(Vector::X);
        colliders.insert_with_parent(cube, handle, &mut bodies);
        let explicit = MassProperties::new(Vector::ZERO, 1.0, Vector::splat(0.25));
        let ball = ColliderBuilder::ball(0.5).mass_properties(explicit);
        colliders.insert_with_parent(ball, handle, &mut bodies);

        let dry = DryMass::of_body(&bodies, &colliders, handle).unwrap();
        assert_relative_eq!(dry.mass, 6.0, max_relative = 1e-6);
        let center = Vector3::new(2.0 / 6.0, 1.0, 0.0);
        assert_relative_eq!(dry.center, center, epsilon = 1e-6);
        let about = |m: f64, d: Vector3<f64>| m * (d.y * d.y + d.z * d.z);
        let xx = 2.0 / 6.0
            + about(2.0, Vector3::x() - center)
            + 0.25
            + about(1.0, -center)
            + 0.5
            + about(3.0, Vector3::y() * 2.0 - center);
        assert_relative_eq!(dry.inertia[(0, 0)], xx, max_relative = 1e-5);
    }

    /// A rounded cube and a compound with one, by density, mass and mass properties: only what follows from a
    /// density lacks the border. Steiner: a cube of side a with a border r has a³ + 6a²r + 3πar² + 4π/3 r³.
    #[test]
    fn borders_are_left_out_of_what_a_density_gives() {
        let (a, r) = (0.4, 0.1_f64);
        let core = a * a * a;
        let pi = std::f64::consts::PI;
        let whole = core + 6.0 * a * a * r + 3.0 * pi * a * r * r + 4.0 / 3.0 * pi * r.powi(3);
        let cube = SharedShape::round_cuboid(0.2, 0.2, 0.2, 0.1);
        let plain = SharedShape::cuboid(0.5, 0.5, 0.5);
        let far = Pose::from_translation(Vector::X * 3.0);
        let pair = vec![(Pose::IDENTITY, cube.clone()), (far, plain)];
        let of = |collider: ColliderBuilder| {
            let (mut bodies, mut colliders) = (RigidBodySet::new(), ColliderSet::new());
            let handle = bodies.insert(RigidBodyBuilder::dynamic());
            colliders.insert_with_parent(collider, handle, &mut bodies);
            CoreMass::of_body(&bodies, &colliders, handle).unwrap()
        };
        let builder = || ColliderBuilder::new(cube.clone());
        let by_density = |collider: ColliderBuilder, rapier: f64, whole: f64| {
            let found = of(collider).unwrap();
            assert_relative_eq!(found.rapier, rapier, max_relative = 1e-6);
            assert_relative_eq!(found.whole, whole, max_relative = 1e-6);
            assert_relative_eq!(found.missing(), 1.0 - rapier / whole, max_relative = 1e-6);
        };
        by_density(builder().density(2000.0), 2000.0 * core, 2000.0 * whole);
        let pair = ColliderBuilder::compound(pair).density(2.0);
        by_density(pair, 2.0 * (core + 1.0), 2.0 * (whole + 1.0));
        let right = DryMass::of_shape(cube.as_ref(), 2000.0).unwrap();
        assert_relative_eq!(right.mass, 2000.0 * whole, max_relative = 1e-6);
        assert_eq!(of(builder().density(0.0)), None);
        assert_eq!(of(builder().mass(7.0)), None);
        // As much as one density or another would give.
        assert_eq!(of(builder().mass(core as f32)), None);
        assert_eq!(
            of(builder().mass_properties(right.to_mass_properties())),
            None
        );
        assert_eq!(
            of(ColliderBuilder::cuboid(1.0, 1.0, 1.0).density(3.0)),
            None
        );
    }

    /// A rounded triangle has no mass by density in rapier, but may be given one: it is spread over the plate.
    /// Far from its edges that has the inertia of the sheet, m/18 (a² + b²) about the normal of the legs a, b
    /// (m/36 (a² + b² + c²) with c² = a² + b²).
    #[test]
    fn rounded_triangles_may_be_given_a_mass() {
        let (mut bodies, mut colliders) = (RigidBodySet::new(), ColliderSet::new());
        let handle = bodies.insert(RigidBodyBuilder::dynamic());
        let triangle = SharedShape::round_triangle(Vector::ZERO, Vector::X, Vector::Y * 2.0, 1e-4);
        let collider = ColliderBuilder::new(triangle).mass(3.0);
        colliders.insert_with_parent(collider, handle, &mut bodies);
        let dry = DryMass::of_body(&bodies, &colliders, handle).unwrap();
        assert_relative_eq!(dry.mass, 3.0);
        assert_relative_eq!(dry.inertia[(2, 2)], 3.0 / 18.0 * 5.0, max_relative = 2e-3);
    }

    #[test]
    fn bodies_without_mass_or_colliders_are_refused() {
        let mut bodies = RigidBodySet::new();
        let mut colliders = ColliderSet::new();
        let handle = bodies.insert(RigidBodyBuilder::dynamic());
        let none = DryMass::of_body(&bodies, &colliders, handle);
        assert!(matches!(
            none,
            Err(Error::InvalidParameter {
                parameter: "mass",
                ..
            })
        ));
        let hydro = HydroProperties::from_body(&bodies, &colliders, handle);
        assert_eq!(hydro, Err(Error::NoCollider));
        let ground = ColliderBuilder::new(SharedShape::halfspace(Vector::Y));
        colliders.insert_with_parent(ground, handle, &mut bodies);
        let hydro = HydroProperties::from_body(&bodies, &colliders, handle);
        assert_eq!(
            hydro,
            Err(Error::ShapeWithoutVolume {
                shape: "half-space"
            })
        );
    }
}
