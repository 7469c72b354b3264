//! Everything the fluid feels of a shape, computed once.

use super::solids::Measured;
use super::{AddedMass, AddedMassSource, BluffShape, Hull, OutOfScope, Planform, Silhouette};
use crate::error::Error;
use crate::geometry::{Ellipsoid, Surface, VolumeIntegrals};
use crate::math;
use rapier3d::na::{Matrix3, Rotation3, Vector3};
use rapier3d::parry::shape::Shape;

/// A shadow that is smaller by more than this than half of what the surface shows is that of a folded one: more than
/// the lines that it is measured along miss of a round outline.
const FOLDED: f64 = 3e-3;
/// What the first two axes of a planform are.
#[derive(Clone, Copy)]
enum Order {
    /// The longest and the next.
    Descending,
    /// The span and the chord of a plate, whichever is longer.
    SpanFirst,
}

/// Thickness over width up to which a body is purely a plate to every law.
pub(super) const THIN: f64 = 0.25;

/// What the fluid feels of a shape: displaced volume, added mass, planform and proxy ellipsoid.
///
/// Coordinates are those of the *frame* in which the shape was given: the rigid body's local frame
/// for [`HydroProperties::from_body`], the shape's own for [`HydroProperties::from_shape`].
/// They depend on the shape alone, neither on the fluid nor on the mass.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct HydroProperties {
    /// Displaced volume, m³.
    pub volume: f64,
    /// Center of buoyancy: centroid of the displaced volume, m, in the frame.
    pub centroid: Vector3<f64>,
    /// Point that `added_mass` refers to, m, in the frame.
    pub reference: Vector3<f64>,
    /// Added mass per unit fluid density about `reference`, along the axes of the frame.
    pub added_mass: AddedMass,
    /// Where `added_mass` is from, and so how accurate it is.
    pub added_mass_source: AddedMassSource,
    /// What the shape shows to a fluid that flows against its broad side.
    pub planform: Planform,
    /// Ellipsoid with the same three principal shadows as the shape, along the planform's axes.
    pub proxy: Ellipsoid,
    /// What the law of bodies that are not plates knows of the shape; `None` for a thin plate, and where
    /// nothing but the proxy is known.
    pub bluff: Option<BluffShape>,
    /// The closed surface that a free surface cuts, in the frame. It encloses `volume`; of round shapes it has few
    /// facets.
    pub hull: Hull,
    /// The surfaces that the shape consists of, if it is more than one to the fluid: in the same frame, and
    /// without parts of their own.
    pub parts: Vec<HydroProperties>,
    /// What the default law does not see of the shape; [`ImmersedBody::out_of_scope`](crate::ImmersedBody::out_of_scope)
    /// says what of it matters to a body.
    pub out_of_scope: Vec<OutOfScope>,
}

impl HydroProperties {
    /// Properties of a shape in its own frame, referred to the frame's origin.
    ///
    /// # Errors
    /// Those of [`Surface::from_shape`]: the shape encloses no volume or its mesh is not closed.
    ///
    /// ```
    /// use rapier3d_immersed::HydroProperties;
    /// use rapier3d_immersed::rapier3d::prelude::*;
    ///
    /// // A ball drags half of the fluid that it displaces along.
    /// let hydro = HydroProperties::from_shape(&Ball::new(0.1))?;
    /// assert!((hydro.volume - 4.0 / 3.0 * std::f64::consts::PI * 1e-3).abs() < 1e-8);
    /// assert!((hydro.added_mass.linear[(0, 0)] / hydro.volume - 0.5).abs() < 0.01);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn from_shape(shape: &dyn Shape) -> Result<Self, Error> {
        let surface = Surface::from_shape(shape)?;
        let hull = Hull::from_shape(shape)?;
        Ok(Self::with_hull(&surface, hull, Vector3::zeros()))
    }

    /// Properties of a closed surface, referred to `reference`, with the added mass of
    /// [`Accuracy::Calibrated`](super::Accuracy).
    ///
    /// [`HydroProperties::added_mass_source`] says how good that is. The [hull](HydroProperties::hull) is the surface itself.
    ///
    /// ```
    /// use rapier3d_immersed::HydroProperties;
    /// use rapier3d_immersed::geometry::{Ellipsoid, Surface};
    /// use rapier3d_immersed::rapier3d::na::Vector3;
    ///
    /// let pebble = Ellipsoid { semi_axes: Vector3::new(0.03, 0.02, 0.01) };
    /// let hydro = HydroProperties::from_surface(&Surface::ellipsoid(&pebble, 8)?, Vector3::zeros());
    /// // An ellipsoid is its own proxy.
    /// assert!((hydro.proxy.semi_axes - pebble.semi_axes).norm() < 3e-4);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn from_surface(surface: &Surface, reference: Vector3<f64>) -> Self {
        Self::with_hull(surface, Hull::from_surface(surface), reference)
    }

    /// Properties of a closed surface with a hull that stands for it.
    pub(crate) fn with_hull(surface: &Surface, hull: Hull, reference: Vector3<f64>) -> Self {
        let integrals = surface.volume_integrals();
        let axes = principal_axes(surface, &integrals.second_moment);
        Self::along(
            surface,
            hull,
            &integrals,
            axes,
            reference,
            Order::Descending,
        )
    }

    /// Those of a plate, with `span` (of any length, not along the normal) as the first axis of its planform, longest or not.
    pub(crate) fn with_span(surface: &Surface, span: Vector3<f64>) -> Self {
        let integrals = surface.volume_integrals();
        let normal = principal_axes(surface, &integrals.second_moment) * Vector3::z();
        let span = (span - normal * normal.dot(&span)).normalize();
        let chord = normal.cross(&span);
        let axes = Matrix3::from_columns(&[span, chord, normal]);
        let axes = Rotation3::from_matrix_unchecked(axes);
        Self::along(
            surface,
            Hull::from_surface(surface),
            &integrals,
            axes,
            Vector3::zeros(),
            Order::SpanFirst,
        )
    }

    fn along(
        surface: &Surface,
        hull: Hull,
        integrals: &VolumeIntegrals,
        axes: Rotation3<f64>,
        reference: Vector3<f64>,
        order: Order,
    ) -> Self {
        let mut planform = Planform::new(surface, integrals, axes);
        // No shadow is larger than that of the box.
        let [x, y, z]: [f64; 3] = planform.half_extents.into();
        let boxed = Vector3::new(y * z, z * x, x * y) * 4.0;
        let mut shadows =
            Vector3::from_fn(|i, _| surface.projected_area(axes.matrix().column(i).into()));
        shadows = shadows.inf(&boxed);
        // Where parts touch or overlap, or a surface is folded, lines cross it more than twice: what no fluid
        // reaches counts once.
        let convex = surface.is_convex();
        if !convex {
            let around = Silhouette::around(surface, integrals.centroid, &axes);
            for (shadow, silhouette) in shadows.iter_mut().zip(&around) {
                if *shadow > silhouette.area * (1.0 + FOLDED) {
                    *shadow = silhouette.area;
                }
            }
            if planform.area > around[2].area * (1.0 + FOLDED) {
                planform.unfold(&around[2], integrals);
            }
        }
        let proxy = rounded(ellipsoid_with_shadows(shadows, order));
        let bluff = (proxy.semi_axes.z > THIN * proxy.semi_axes.y)
            .then(|| BluffShape::new(surface, integrals.centroid, &axes, shadows, convex));
        let plate = bluff.is_none();
        let out_of_scope =
            OutOfScope::of(surface, integrals.centroid, &axes, &shadows, plate, convex);
        let (added_mass, added_mass_source) =
            Measured::new(surface, integrals, &axes, convex).added_mass(&proxy, thickness(&proxy));
        let added_mass = added_mass
            .rotated(&axes)
            .about(reference - integrals.centroid);
        Self {
            volume: integrals.volume,
            centroid: integrals.centroid,
            reference,
            added_mass,
            added_mass_source,
            planform,
            proxy,
            bluff,
            hull,
            parts: Vec::new(),
            out_of_scope,
        }
    }

    /// Replaces the added mass by one computed elsewhere, which refers to
    /// `self.reference` and the axes of the frame.
    ///
    /// # Errors
    /// [`Error::UnphysicalAddedMass`] if it is not finite, not symmetric or has negative energy.
    ///
    /// ```
    /// use rapier3d_immersed::rapier3d::{na::Vector3, prelude::*};
    /// use rapier3d_immersed::{AddedMass, HydroProperties};
    ///
    /// let cube = HydroProperties::from_shape(&Cuboid::new(Vector::splat(0.5)))?;
    /// // What a table of added masses has for a cube: 0.64 of its volume.
    /// let tabulated = AddedMass::diagonal(Vector3::repeat(0.64), cube.added_mass.angular.diagonal());
    /// assert_eq!(cube.with_added_mass(tabulated)?.added_mass.linear[(0, 0)], 0.64);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn with_added_mass(mut self, added_mass: AddedMass) -> Result<Self, Error> {
        if !added_mass.is_physical() {
            return Err(Error::UnphysicalAddedMass);
        }
        self.added_mass = added_mass;
        self.added_mass_source = AddedMassSource::Given;
        Ok(self)
    }

    /// Added mass about another point of the frame, m.
    pub fn added_mass_about(&self, point: Vector3<f64>) -> AddedMass {
        self.added_mass.about(point - self.reference)
    }

    /// 0 for a body that is purely a plate to every law, 1 from a little more on: what belongs to the edges
    /// of a slab, which thin plates do without.
    pub(crate) fn thickness(&self) -> f64 {
        thickness(&self.proxy)
    }

    /// The added mass of the table, for plates too, if the shape is a solid that is tabulated.
    pub(super) fn tabulated(mut self) -> Self {
        if !self.parts.is_empty() {
            let parts = std::mem::take(&mut self.parts).into_iter();
            self.parts = parts.map(Self::tabulated).collect();
            let sum = |sum: AddedMass, part: &Self| sum + part.added_mass;
            self.added_mass = self.parts.iter().fold(AddedMass::zero(), sum);
        } else if let (true, Some(surface)) = (self.planform.fraction >= 1.0, self.hull.surface()) {
            let (integrals, axes) = (surface.volume_integrals(), &self.planform.axes);
            let measured = Measured::new(&surface, &integrals, axes, surface.is_convex());
            let (added_mass, source) = measured.added_mass(&self.proxy, 1.0);
            if let AddedMassSource::Table { .. } = source {
                let own = added_mass.rotated(axes);
                self.added_mass = own.about(self.reference - self.centroid);
                self.added_mass_source = source;
            }
        }
        self
    }

    /// The added mass that a body has in every direction, per unit density, m³: the smallest principal one about
    /// the center of volume. A mass that is the same in all directions couples no motion to another, so that
    /// what a law takes off the coupling it may not take off this: a sphere would get a lift `ω × u` that no
    /// potential flow has. Of a thin plate it is next to nothing, and left out. The mean of the three would give
    /// a disc that moves edgewise a coupling that it has not.
    pub(crate) fn isotropic_added_mass(&self) -> f64 {
        let about_volume = self.added_mass_about(self.centroid).linear;
        about_volume.symmetric_eigenvalues().min().max(0.0)
    }

    /// Displaced volume over the volume of the box around it: π/6 for an ellipsoid, 1 for a box.
    pub fn box_fill(&self) -> f64 {
        self.volume / (8.0 * self.planform.half_extents.product())
    }
}

/// See [`HydroProperties::thickness`].
fn thickness(proxy: &Ellipsoid) -> f64 {
    let semi_axes = &proxy.semi_axes;
    let t = ((semi_axes.z / semi_axes.y - THIN) / 0.05).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Principal axes of a solid as the columns of a rotation: x the longest, z the shortest.
fn principal_axes(surface: &Surface, second_moment: &Matrix3<f64>) -> Rotation3<f64> {
    let eigen = second_moment.symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|i, j| eigen.eigenvalues[*j].total_cmp(&eigen.eigenvalues[*i]));
    let axis = |i: usize| eigen.eigenvectors.column(order[i]).into_owned();
    // A cube's or a square plate's axes are arbitrary to the solver; the frame's own are as good
    // and do not depend on rounding. Each pair is judged by itself: a strip's width and thickness may be
    // nothing beside its length.
    let spread = second_moment.diagonal();
    let within = |i: usize, j: usize, x: f64| x.abs() <= 1e-5 * spread[i].max(spread[j]);
    let aligned = [(0, 1), (1, 2), (2, 0)]
        .iter()
        .all(|(i, j)| within(*i, *j, second_moment[(*i, *j)]));
    let (x, z) = if aligned {
        let mut order = [0, 1, 2];
        // The order descends; ties (within rounding) stay in the order of the frame.
        order.sort_by(|i, j| {
            let difference = spread[*j] - spread[*i];
            if within(*i, *j, difference) {
                std::cmp::Ordering::Equal
            } else {
                difference.total_cmp(&0.0)
            }
        });
        let unit = |i: usize| Vector3::from_fn(|row, _| f64::from(u8::from(row == order[i])));
        (unit(0), unit(2))
    } else {
        (axis(0), axis(2))
    };
    debug_assert!(surface.triangles().len() >= 4);
    Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, z.cross(&x), z]))
}

/// Makes the axes of a body that is not a plate equal where they differ by no more than facets do: a ball's
/// proxy is round, or it would turn to the flow like an egg.
fn rounded(mut proxy: Ellipsoid) -> Ellipsoid {
    let alike = |x: f64, y: f64| (x - y).abs() <= 5e-3 * x.max(y);
    let axes = &mut proxy.semi_axes;
    if axes.z <= THIN * axes.y {
        return proxy;
    }
    if alike(axes.x, axes.z) {
        *axes = Vector3::repeat(math::cbrt(axes.product()));
    } else if alike(axes.x, axes.y) {
        let mean = (axes.x * axes.y).sqrt();
        (axes.x, axes.y) = (mean, mean);
    } else if alike(axes.y, axes.z) {
        let mean = (axes.y * axes.z).sqrt();
        (axes.y, axes.z) = (mean, mean);
    }
    proxy
}

/// The ellipsoid whose shadows along its axes have these areas: exact for an ellipsoid, and for a
/// plate of any outline it has the right planform.
fn ellipsoid_with_shadows(shadows: Vector3<f64>, order: Order) -> Ellipsoid {
    let [x, y, z]: [f64; 3] = shadows.into();
    let pi = std::f64::consts::PI;
    let mut semi_axes = Vector3::new(
        (y * z / (pi * x)).sqrt(),
        (z * x / (pi * y)).sqrt(),
        (x * y / (pi * z)).sqrt(),
    );
    // The laws rely on x ≥ y ≥ z, which the second moments gave but a strange shape's shadows
    // need not; of a plate they rely on z alone.
    match order {
        Order::Descending => semi_axes.y = semi_axes.y.min(semi_axes.x),
        Order::SpanFirst => semi_axes.z = semi_axes.z.min(semi_axes.x),
    }
    semi_axes.z = semi_axes.z.min(semi_axes.y);
    Ellipsoid { semi_axes }
}
