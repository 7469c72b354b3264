//! Strips of a plate side by side along its span, for wings and blades whose sections meet different flows.

use super::{AddedMass, Hull, HydroProperties, OutOfScope, Planform};
use crate::error::Error;
use crate::geometry::Surface;
use rapier3d::na::{Rotation3, Vector2, Vector3};
use rapier3d::parry::shape::Shape;

impl HydroProperties {
    /// Strips of a thin shape, side by side along its longest axis (the span), from its lower to its upper end.
    ///
    /// Each is a [`Part`](crate::Part) that sees the velocity of its own middle, so that what a rotation does to the
    /// flow along the span comes by itself: the speed of a blade's tip, the roll damping of a wing. Each has the
    /// aspect ratio of the whole ([`Planform::fraction`]), so that together they lift and drag like it, and its own mean
    /// chord, so that a tapered or swept wing has its pressure where its sections have theirs. Volume, centroid and
    /// [hull](HydroProperties::hull) are those of its own slice.
    ///
    /// ```
    /// use rapier3d_immersed::rapier3d::prelude::*;
    /// use rapier3d_immersed::{HydroProperties, ImmersedBody};
    ///
    /// let blade = Cuboid::new(Vector::new(0.3, 0.001, 0.03));
    /// let strips = HydroProperties::strips_of_shape(&blade, 6)?;
    /// assert_eq!(strips.len(), 6);
    /// assert!((strips[0].planform.center.x + 0.25).abs() < 1e-6);
    /// let blade = ImmersedBody::new(HydroProperties::from_shape(&blade)?);
    /// let blade = blade.with_parts(strips.into_iter().map(rapier3d_immersed::Part::new));
    /// assert_eq!(blade.parts.len(), 6);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Surface::from_shape`] and [`HydroProperties::strips_of_surface`].
    pub fn strips_of_shape(shape: &dyn Shape, count: usize) -> Result<Vec<Self>, Error> {
        Self::strips_of_surface(&Surface::from_shape(shape)?, count)
    }

    /// Strips of a thin shape, side by side along a span of the user's, in the shape's frame, which need not be the longest
    /// axis: a wing that is longer than wide, a low-aspect blade that turns about its short side.
    ///
    /// ```
    /// use rapier3d_immersed::rapier3d::{na::Vector3, prelude::*};
    /// use rapier3d_immersed::HydroProperties;
    ///
    /// // A paddle wheel's board, 10 cm out from the axle and 30 cm along it.
    /// let board = Cuboid::new(Vector::new(0.05, 0.002, 0.15));
    /// let strips = HydroProperties::strips_of_shape_along(&board, Vector3::x(), 5)?;
    /// assert!((strips[0].planform.center.x + 0.04).abs() < 1e-6);
    /// assert!((strips[0].planform.half_extents.x - 0.05).abs() < 1e-6);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`HydroProperties::strips_of_shape`], [`Error::NotFinite`], and [`Error::InvalidParameter`] if the span
    /// has no length or does not lie in the plate.
    pub fn strips_of_shape_along(
        shape: &dyn Shape,
        span: Vector3<f64>,
        count: usize,
    ) -> Result<Vec<Self>, Error> {
        Self::strips_of_surface_along(&Surface::from_shape(shape)?, span, count)
    }

    /// Strips of the solid that a thin closed surface bounds, along its longest axis.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if there shall be none or more than a thousand; [`Error::InvalidParameter`] if the body is
    /// thicker than a quarter of its width: only plates are divided.
    pub fn strips_of_surface(surface: &Surface, count: usize) -> Result<Vec<Self>, Error> {
        let whole = Self::from_surface(surface, Vector3::zeros());
        strips_of(&whole, surface, count)
    }

    /// Strips of the solid that a thin closed surface bounds, along a span in the surface's frame.
    ///
    /// # Errors
    /// Those of [`HydroProperties::strips_of_surface`] and [`HydroProperties::strips_of_shape_along`].
    pub fn strips_of_surface_along(
        surface: &Surface,
        span: Vector3<f64>,
        count: usize,
    ) -> Result<Vec<Self>, Error> {
        Error::check_all_finite("span of strips", span.as_slice())?;
        let length = span.norm();
        Error::check_positive("length of the span of strips", length)?;
        let plate = Self::from_surface(surface, Vector3::zeros());
        let normal = plate.planform.axes * Vector3::z();
        let out = (normal.dot(&span) / length).abs();
        let lies = out <= OUT_OF_PLANE;
        Error::check(
            "sine of the angle between the span of strips and the plate",
            out,
            lies,
            "at most 0.1",
        )?;
        strips_of(&Self::with_span(surface, span), surface, count)
    }

    /// What the fluid feels of a piece of a plate, given by its own surface, which reaches across the whole of the plate's
    /// chord: a strip, in the plate's frame, referred to its own middle.
    pub(crate) fn strip(&self, piece: &Surface) -> Option<Self> {
        let to_plate = self.planform.axes.inverse();
        let triangles = in_axes(piece, &to_plate);
        let (low, high) = range(&triangles);
        let own = piece.volume_integrals();
        let height = (to_plate * own.centroid).z;
        let hull = Hull::from_surface(piece);
        let mut strip = strip(self, &triangles, height, high - low, hull)?;
        strip.planform.thickness = own.volume / strip.planform.area;
        Some(strip)
    }
}

/// Sine of the angle to the plate up to which a span lies in it.
const OUT_OF_PLANE: f64 = 0.1;

fn strips_of(
    whole: &HydroProperties,
    surface: &Surface,
    count: usize,
) -> Result<Vec<HydroProperties>, Error> {
    Error::check_range("number of strips", count as f64, 1.0, 1000.0)?;
    let semi_axes = &whole.proxy.semi_axes;
    let ratio = semi_axes.z / semi_axes.y.min(semi_axes.x);
    let plate = whole.bluff.is_none();
    Error::check(
        "thickness over width of a body that is divided into strips",
        ratio,
        plate,
        "at most 0.25",
    )?;
    let to_plate = whole.planform.axes.inverse();
    let flat = in_axes(surface, &to_plate);
    let (low, high) = range(&flat);
    let width = (high - low) / count as f64;
    let height = (to_plate * whole.centroid).z;
    let span = whole.planform.axes * Vector3::x();
    let strips = (0..count).map(|i| {
        let from = low + width * i as f64;
        let mut pieces = Vec::new();
        for triangle in &flat {
            let inside = cut(cut(triangle.to_vec(), from, 1.0), from + width, -1.0);
            for i in 2..inside.len() {
                pieces.push([inside[0], inside[i - 1], inside[i]]);
            }
        }
        let hull = whole.hull.slice(&span, from, from + width)?;
        strip(whole, &pieces, height, width, hull)
    });
    Ok(strips.flatten().collect())
}

/// The triangles of a surface in the axes of a plate.
fn in_axes(surface: &Surface, to_plate: &Rotation3<f64>) -> Vec<[Vector3<f64>; 3]> {
    let corners = surface.corners();
    corners.map(|c| c.map(|corner| to_plate * corner)).collect()
}

/// How far triangles reach along the span, from its lower to its upper end.
fn range(triangles: &[[Vector3<f64>; 3]]) -> (f64, f64) {
    let along = triangles.iter().flatten().map(|corner| corner.x);
    along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
        (low.min(x), high.max(x))
    })
}

/// The part of a polygon where `sign·(x − at) ≥ 0`.
fn cut(polygon: Vec<Vector3<f64>>, at: f64, sign: f64) -> Vec<Vector3<f64>> {
    let side = |p: &Vector3<f64>| sign * (p.x - at);
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, p) in polygon.iter().enumerate() {
        let q = &polygon[(i + 1) % polygon.len()];
        let (p_side, q_side) = (side(p), side(q));
        if p_side >= 0.0 {
            kept.push(*p);
        }
        if (p_side < 0.0) != (q_side < 0.0) {
            kept.push(p + (q - p) * (p_side / (p_side - q_side)));
        }
    }
    kept
}

/// The strip of a width along the span whose surface, in plate axes, consists of these triangles; `None` if it shows
/// nothing.
fn strip(
    whole: &HydroProperties,
    pieces: &[[Vector3<f64>; 3]],
    height: f64,
    width: f64,
    hull: Hull,
) -> Option<HydroProperties> {
    let plate = &whole.planform;
    // Every line along the normal crosses the surface twice, hence the half.
    let area_of = |[a, b, c]: &[Vector3<f64>; 3]| (b - a).cross(&(c - a)).z.abs() / 4.0;
    let area: f64 = pieces.iter().map(area_of).sum();
    if area < 1e-9 * plate.area {
        return None;
    }
    let mut center = Vector3::zeros();
    for piece in pieces {
        center += piece.iter().sum::<Vector3<f64>>() * (area_of(piece) / (3.0 * area));
    }
    center.z = height;
    let (mut second, mut third) = (Vector2::zeros(), Vector2::zeros());
    for piece in pieces {
        for (point, share) in super::planform::quadrature(piece) {
            let distance = Vector2::new(point.y - center.y, point.x - center.x).abs();
            let square = distance.component_mul(&distance);
            second += square * (area_of(piece) * share);
            third += square.component_mul(&distance) * (area_of(piece) * share);
        }
    }
    let center = plate.axes * center;
    let fraction = (area / plate.area).min(1.0);
    let about_middle = whole.added_mass_about(plate.center);
    // The rest of the rotational inertia comes from where the strips are.
    let span = plate.axes * Vector3::x();
    let about_span = span.dot(&(about_middle.angular * span)).max(0.0);
    let mut half_extents = plate.half_extents;
    half_extents.y = 0.5 * area / width;
    Some(HydroProperties {
        volume: hull.volume(),
        centroid: hull.centroid(),
        reference: center,
        added_mass: AddedMass {
            linear: about_middle.linear * fraction,
            coupling: AddedMass::zero().coupling,
            angular: span * span.transpose() * (about_span * fraction),
        },
        added_mass_source: whole.added_mass_source,
        planform: Planform {
            center,
            area,
            second_moment: second,
            third_moment: third,
            fraction: fraction * plate.fraction,
            half_extents,
            ..plate.clone()
        },
        proxy: whole.proxy,
        bluff: None,
        hull,
        parts: Vec::new(),
        // Strips have chords of their own; what gaps remain is between them.
        out_of_scope: whole
            .out_of_scope
            .iter()
            .filter(|reason| !matches!(reason, OutOfScope::Gaps { .. }))
            .copied()
            .collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rapier3d::math::Vector;
    use rapier3d::parry::shape::{Ball, Cuboid, Cylinder};

    /// Strips add up to the whole: area, volume, added mass, and moments about its middle by Steiner's theorem.
    #[test]
    fn strips_add_up() {
        let half = Vector::new(0.3, 0.001, 0.05);
        for shape in [&Cuboid::new(half) as &dyn Shape, &Cylinder::new(0.001, 0.1)] {
            let whole = HydroProperties::from_shape(shape).unwrap();
            let strips = HydroProperties::strips_of_shape(shape, 7).unwrap();
            assert_eq!(strips.len(), 7);
            let sum = |of: &dyn Fn(&HydroProperties) -> f64| strips.iter().map(of).sum::<f64>();
            let plate = &whole.planform;
            let area = sum(&|s| s.planform.area);
            assert!((area / plate.area - 1.0).abs() < 1e-9, "{area}");
            assert!((sum(&|s| s.planform.fraction) - 1.0).abs() < 1e-9);
            assert!((sum(&|s| s.volume) / whole.volume - 1.0).abs() < 1e-9);
            // Their slices are closed: cut level, their waterplanes add up to that of the whole, and their own
            // volumes are theirs.
            let surface = Surface::from_shape(shape).unwrap();
            let turn = rapier3d::na::Rotation3::from_euler_angles(0.4, 0.3, 0.2);
            let under = |hull: &Hull| hull.under_plane(turn.matrix(), 0.01, [0.1, 0.2]);
            let cut = under(&Hull::from_surface(&surface));
            let area = sum(&|s| under(&s.hull).waterplane.area);
            assert!((area / cut.waterplane.area - 1.0).abs() < 1e-9, "{area}");
            let volume = sum(&|s| under(&s.hull).volume);
            assert!((volume / cut.volume - 1.0).abs() < 1e-9, "{volume}");
            let steiner = sum(&|s| {
                let away = plate.axes.inverse() * (s.planform.center - plate.center);
                s.planform.second_moment.y + s.planform.area * away.x * away.x
            });
            // The three-point rule is exact for squares.
            assert!(
                (steiner / plate.second_moment.y - 1.0).abs() < 1e-6,
                "{steiner}"
            );
            let along = sum(&|s| s.planform.second_moment.x);
            assert!(
                (along / plate.second_moment.x - 1.0).abs() < 1e-6,
                "{along}"
            );
            let pushed = sum(&|s| s.added_mass.linear.trace());
            assert!((pushed / whole.added_mass.linear.trace() - 1.0).abs() < 1e-9);
            strips.iter().for_each(|strip| strip.check().unwrap());
        }
    }

    /// Strips of a triangle have the chord that it has where they are, and the aspect ratio of the whole.
    #[test]
    fn strips_have_chords_of_their_own() {
        let points = [
            Vector::new(0.0, 0.0, 0.1),
            Vector::new(0.4, 0.0, -0.1),
            Vector::new(-0.4, 0.0, -0.1),
        ];
        let both = |y: f32| points.map(|p| p + Vector::Y * y);
        let points = [both(1e-3), both(-1e-3)].concat();
        let delta = rapier3d::prelude::SharedShape::convex_hull(&points).unwrap();
        let strips = HydroProperties::strips_of_shape(delta.as_ref(), 8).unwrap();
        for strip in &strips {
            let plate = &strip.planform;
            let chord = 0.2 * (1.0 - plate.center.x.abs() / 0.4);
            let own = 2.0 * plate.half_extents.y;
            // The chord at the middle of the area and the mean chord differ at the tip, by a sixth of it.
            assert!((own - chord).abs() < 0.01, "{own} {chord}");
            let aspect = 4.0 * plate.half_extents.x.powi(2) * plate.fraction / plate.area;
            assert!((aspect - 8.0).abs() < 1e-4, "{aspect}");
        }
    }

    /// A plate divided along its longer side is the same whether that is found or told; one divided along its shorter side has
    /// that as its span, and the same area and volume.
    #[test]
    fn along_a_span_that_is_told() {
        let plate = Cuboid::new(Vector::new(0.3, 0.001, 0.05));
        let found = HydroProperties::strips_of_shape(&plate, 5).unwrap();
        let told = HydroProperties::strips_of_shape_along(&plate, Vector3::x() * 7.0, 5).unwrap();
        for (a, b) in found.iter().zip(&told) {
            assert!((a.planform.center - b.planform.center).norm() < 1e-9);
            assert!((a.planform.second_moment - b.planform.second_moment).amax() < 1e-12);
            assert!((a.planform.half_extents - b.planform.half_extents).amax() < 1e-9);
            assert!((a.proxy.semi_axes - b.proxy.semi_axes).amax() < 1e-9);
        }
        let across = HydroProperties::strips_of_shape_along(&plate, Vector3::z(), 5).unwrap();
        let area: f64 = across.iter().map(|s| s.planform.area).sum();
        let volume: f64 = across.iter().map(|s| s.volume).sum();
        assert!((area - 0.06).abs() < 1e-7 && (volume - 1.2e-4).abs() < 1e-9);
        for (i, strip) in across.iter().enumerate() {
            let plate = &strip.planform;
            assert!((plate.center.z - 0.02 * (i as f64 - 2.0)).abs() < 1e-7);
            assert!((plate.half_extents - Vector3::new(0.05, 0.3, 0.001)).amax() < 1e-7);
            // Helmbold's law sees 4b²/A of the whole, whichever side the flow comes from.
            let aspect = |b: f64| 4.0 * b * b * plate.fraction / plate.area;
            assert!((aspect(plate.half_extents.x) - 1.0 / 6.0).abs() < 1e-4);
            assert!((aspect(plate.half_extents.y) - 6.0).abs() < 1e-3);
            strip.check().unwrap();
        }
        let error = |span| HydroProperties::strips_of_shape_along(&plate, span, 5).unwrap_err();
        for (span, says) in [
            (Vector3::zeros(), "length of the span"),
            (Vector3::y(), "sine of the angle"),
            (Vector3::new(f64::NAN, 0.0, 0.0), "span of strips"),
        ] {
            assert!(error(span).to_string().contains(says), "{}", error(span));
        }
    }

    /// What is no plate is not divided.
    #[test]
    fn only_plates() {
        let error = HydroProperties::strips_of_shape(&Ball::new(0.1), 4).unwrap_err();
        assert!(error.to_string().contains("0.25"), "{error}");
        let plate = Cuboid::new(Vector::new(0.3, 0.001, 0.05));
        for count in [0, 1001] {
            assert!(HydroProperties::strips_of_shape(&plate, count).is_err());
        }
    }
}
