//! What a body shows to the fluid that flows against its broad side.

use super::Silhouette;
use crate::geometry::{Surface, VolumeIntegrals};
use rapier3d::na::{Rotation3, Vector2, Vector3};

/// Projection of a shape along its shortest principal axis, the plate normal z; x is the longest.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Planform {
    /// Maps plate axes (x longest, z normal) to the axes of the shape's frame.
    pub axes: Rotation3<f64>,
    /// Center of the projected area, at the height of the center of buoyancy, m, in the frame.
    pub center: Vector3<f64>,
    /// Projected area A, m².
    pub area: f64,
    /// Half extents along the plate axes, m.
    pub half_extents: Vector3<f64>,
    /// Mean thickness, volume over area, m.
    pub thickness: f64,
    /// `∫y² dA` (about x) and `∫x² dA` (about y) from the center, m⁴.
    pub second_moment: Vector2<f64>,
    /// `∫|y|³ dA` (about x) and `∫|x|³ dA` (about y) from the center, m⁵.
    pub third_moment: Vector2<f64>,
    /// Share of the area of the planform that it is cut out of, 1 if it is whole. A strip has the half extent of the whole
    /// along its span, and so the whole's aspect ratio, and half its own mean chord across it.
    pub fraction: f64,
}

impl Planform {
    /// Projects `surface` along the third of `axes`.
    pub(super) fn new(
        surface: &Surface,
        integrals: &VolumeIntegrals,
        axes: Rotation3<f64>,
    ) -> Self {
        let to_plate = axes.inverse();
        let flat: Vec<([Vector3<f64>; 3], f64)> = surface
            .corners()
            .map(|corners| {
                let [a, b, c] = corners.map(|v| to_plate * (v - integrals.centroid));
                // Every line along the normal crosses the surface twice, hence the half.
                let area = (b - a).cross(&(c - a)).z.abs() / 4.0;
                ([a, b, c], area)
            })
            .collect();
        let area: f64 = flat.iter().map(|(_, area)| area).sum();
        let mut center = Vector3::zeros();
        let mut low = Vector3::repeat(f64::INFINITY);
        let mut high = -low;
        for (corners, weight) in &flat {
            center += corners.iter().sum::<Vector3<f64>>() * (weight / (3.0 * area));
            for corner in corners {
                low = low.inf(corner);
                high = high.sup(corner);
            }
        }
        center.z = 0.0;

        let (mut second, mut third) = (Vector2::zeros(), Vector2::zeros());
        for (corners, weight) in &flat {
            for (point, share) in quadrature(corners) {
                let distance = Vector2::new(point.y - center.y, point.x - center.x).abs();
                let square = distance.component_mul(&distance);
                second += square * (weight * share);
                third += square.component_mul(&distance) * (weight * share);
            }
        }
        Self {
            axes,
            center: integrals.centroid + axes * center,
            area,
            half_extents: (high - low) * 0.5,
            thickness: integrals.volume / area,
            second_moment: second,
            third_moment: third,
            fraction: 1.0,
        }
    }
}

impl Planform {
    /// Puts what a silhouette shows in place of what faces at all depths add up to.
    pub(super) fn unfold(&mut self, silhouette: &Silhouette, integrals: &VolumeIntegrals) {
        let center = Vector3::new(silhouette.center.x, silhouette.center.y, 0.0);
        self.area = silhouette.area;
        self.center = integrals.centroid + self.axes * center;
        self.thickness = integrals.volume / self.area;
        self.second_moment = silhouette.second_moment;
        self.third_moment = silhouette.third_moment;
    }
}

/// Points and weights on a triangle, split in 16 with the three-point rule on each part: exact for
/// quadratics, and good to 10⁻³ for |x|³ on a triangle that crosses the axis.
pub(super) fn quadrature(
    corners: &[Vector3<f64>; 3],
) -> impl Iterator<Item = (Vector3<f64>, f64)> + use<> {
    const SPLIT: usize = 4;
    let [a, b, c] = *corners;
    let step = 1.0 / SPLIT as f64;
    let at = move |i: f64, j: f64| a + (b - a) * (i * step) + (c - a) * (j * step);
    let weight = step * step / 3.0;
    (0..SPLIT).flat_map(move |i| {
        (0..SPLIT - i).flat_map(move |j| {
            let (i, j) = (i as f64, j as f64);
            let upright = [
                (1.0 / 6.0, 1.0 / 6.0),
                (2.0 / 3.0, 1.0 / 6.0),
                (1.0 / 6.0, 2.0 / 3.0),
            ]
            .map(|(p, q)| (at(i + p, j + q), weight));
            // The upside-down triangle of the same cell, where there is one.
            let whole = i + j + 2.0 <= SPLIT as f64;
            let inverted = [
                (5.0 / 6.0, 5.0 / 6.0),
                (1.0 / 3.0, 5.0 / 6.0),
                (5.0 / 6.0, 1.0 / 3.0),
            ]
            .map(|(p, q)| (at(i + p, j + q), weight));
            upright
                .into_iter()
                .chain(inverted.into_iter().filter(move |_| whole))
        })
    })
}
