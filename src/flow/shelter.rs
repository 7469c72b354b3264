//! The lee of obstacles.

use super::{Flow, FlowSample};
use crate::error::Error;
use rapier3d::geometry::{ColliderSet, Ray, SharedShape};
use rapier3d::math::{Pose, Real, Vector};

/// Samples that each node looks upwind with: the node's own, and four around it.
const RAYS: usize = 5;
/// Share of the wind that is missing right behind an obstacle.
const DEFICIT: Real = 0.9;

/// A wind that is weaker behind obstacles: how much, is found once on a grid, by rays against the wind.
///
/// A node that sees an obstacle upwind at a distance x misses `0.9/(1 + x/5h)` of the wind, h being the obstacle's
/// height across the rays (the square root of its shadow): half of it five heights behind, a quarter fifteen, about what is measured
/// behind solid fences and blocks (Perera, *J. Wind Eng. Ind. Aerodyn.* 8, 93 (1981), recalled: 40 to 50 % at 5 heights, 20 % at 15). Five
/// rays, spread over a node's spacing, make the edges of the lee smooth.
///
/// It is an average for one direction of the wind and for obstacles that stand still: no vortices are shed, no
/// air is pushed around the sides. Baking costs five rays per node against each obstacle, sampling about 20 ns per point.
///
/// ```
/// use rapier3d_immersed::flow::{Flow, Shelter, Uniform};
/// use rapier3d_immersed::rapier3d::prelude::*;
///
/// // A wall of 4 m across a wind along x.
/// let wall = (SharedShape::cuboid(0.1, 2.0, 10.0), Pose::IDENTITY);
/// let region = [Vector::new(-2.0, 0.0, -2.0), Vector::new(20.0, 6.0, 2.0)];
/// let wind = Uniform::new(8.0, 0.0, 0.0);
/// let flow = Shelter::bake(wind, Vector::X, &[wall], region, 0.5)?;
/// let at = |x, y| flow.velocity(Vector::new(x, y, 0.0), 0.0).x;
/// assert!(at(1.0, 1.0) < 2.0 && at(18.0, 1.0) > 4.0);
/// assert_eq!(at(1.0, 5.0), 8.0); // above it
/// assert_eq!(at(-1.5, 1.0), 8.0); // before it
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone)]
pub struct Shelter<F> {
    flow: F,
    origin: Vector,
    spacing: Real,
    nodes: [usize; 3],
    /// Share of the wind at each node, x fastest.
    shares: Vec<Real>,
}

impl<F: Flow> Shelter<F> {
    /// A wind that blows along `direction`, sheltered by obstacles in a box between two corners, m, on a grid of this
    /// spacing, m. Outside of the box it is as at its faces.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a direction or spacing of no length, [`Error::OutOfRange`] for a box without
    /// volume or more than 10⁸ nodes, [`Error::NotFinite`].
    pub fn bake(
        flow: F,
        direction: Vector,
        obstacles: &[(SharedShape, Pose)],
        [low, high]: [Vector; 2],
        spacing: Real,
    ) -> Result<Self, Error> {
        let numbers = [direction, low, high].map(|v| v.to_array().map(f64::from));
        Error::check_all_finite("wind and box of a shelter", numbers.as_flattened())?;
        Error::check_positive("length of the wind's direction", direction.length().into())?;
        Error::check_positive("spacing of a shelter", spacing.into())?;
        let mut nodes = [0; 3];
        let mut count = 1.0;
        for (i, n) in nodes.iter_mut().enumerate() {
            let side = f64::from(high[i] - low[i]);
            Error::check_positive("side of the box of a shelter", side)?;
            let along = (side / f64::from(spacing)).ceil() + 1.0;
            count *= along;
            *n = along as usize;
        }
        Error::check_range("number of nodes of a shelter", count, 1.0, 1e8)?;
        let upwind = -direction.normalize();
        let across = upwind.any_orthonormal_pair();
        let obstacles: Vec<_> = obstacles
            .iter()
            .map(|(shape, pose)| (shape, pose, height_across(shape, pose, upwind)))
            .collect();
        let share = |node: usize| {
            let cell = [
                node % nodes[0],
                node / nodes[0] % nodes[1],
                node / (nodes[0] * nodes[1]),
            ];
            let at = low + Vector::from_array(cell.map(|i| i as Real * spacing));
            let quarter = 0.25 * spacing;
            let offsets = [
                Vector::ZERO,
                across.0 * quarter,
                across.0 * -quarter,
                across.1 * quarter,
                across.1 * -quarter,
            ];
            let missing: Real = offsets
                .iter()
                .map(|offset| {
                    let ray = Ray::new(at + *offset, upwind);
                    let deficits = obstacles.iter().filter_map(|(shape, pose, height)| {
                        let distance = shape.cast_ray(pose, &ray, Real::MAX, true)?;
                        Some(DEFICIT / (1.0 + distance / (5.0 * height)))
                    });
                    deficits.fold(0.0, Real::max)
                })
                .sum();
            1.0 - missing / RAYS as Real
        };
        let all = 0..nodes.iter().product::<usize>();
        #[cfg(feature = "bake")]
        let shares = {
            use rayon::prelude::*;
            all.into_par_iter().map(share).collect()
        };
        #[cfg(not(feature = "bake"))]
        let shares = all.map(share).collect();
        Ok(Self {
            flow,
            origin: low,
            spacing,
            nodes,
            shares,
        })
    }

    /// The same behind all solid colliders of a world that no dynamic body holds, as they are now.
    ///
    /// # Errors
    /// As of [`Shelter::bake`].
    pub fn bake_colliders(
        flow: F,
        direction: Vector,
        bodies: &rapier3d::dynamics::RigidBodySet,
        colliders: &ColliderSet,
        corners: [Vector; 2],
        spacing: Real,
    ) -> Result<Self, Error> {
        let stands = |collider: &&rapier3d::geometry::Collider| {
            let body = collider.parent().and_then(|parent| bodies.get(parent));
            collider.is_enabled() && !collider.is_sensor() && body.is_none_or(|b| !b.is_dynamic())
        };
        let obstacles: Vec<_> = colliders
            .iter()
            .map(|(_, collider)| collider)
            .filter(stands)
            .map(|collider| (collider.shared_shape().clone(), *collider.position()))
            .collect();
        Self::bake(flow, direction, &obstacles, corners, spacing)
    }

    /// Share of the wind at a point.
    fn share(&self, point: Vector) -> Real {
        let place = (point - self.origin) / self.spacing;
        let mut index = [0; 3];
        let mut part = [0.0; 3];
        for i in 0..3 {
            let last = self.nodes[i] - 1;
            let x = place[i].clamp(0.0, last as Real);
            // NaN has no place, and is where the box begins.
            let x = if x.is_nan() { 0.0 } else { x };
            index[i] = (x as usize).min(last.saturating_sub(1));
            part[i] = x - index[i] as Real;
        }
        let [nx, ny, _] = self.nodes;
        let mut sum = 0.0;
        for corner in 0..8 {
            let (mut node, mut weight) = ([0; 3], 1.0);
            for i in 0..3 {
                let upper = corner >> i & 1;
                node[i] = (index[i] + upper).min(self.nodes[i] - 1);
                weight *= if upper == 1 { part[i] } else { 1.0 - part[i] };
            }
            sum += weight * self.shares[(node[2] * ny + node[1]) * nx + node[0]];
        }
        sum
    }
}

/// The height that the lee of a shape is measured by, m: the square root of the area that its box shows along a direction, or its
/// middle side if that is less.
fn height_across(shape: &SharedShape, pose: &Pose, direction: Vector) -> Real {
    let sides = shape.compute_aabb(pose).extents();
    let d = direction.abs();
    let area = d.x * sides.y * sides.z + d.y * sides.z * sides.x + d.z * sides.x * sides.y;
    // What is wide shelters by its lesser side.
    let mut lengths = sides.to_array();
    lengths.sort_by(Real::total_cmp);
    area.sqrt().min(lengths[1]).max(1e-3)
}

impl<F: Flow> Flow for Shelter<F> {
    fn velocity(&self, point: Vector, time: f64) -> Vector {
        self.flow.velocity(point, time) * self.share(point)
    }

    fn vorticity(&self, point: Vector, time: f64) -> Vector {
        self.flow.vorticity(point, time) * self.share(point)
    }

    fn sample(&self, points: &[Vector], time: f64, samples: &mut [FlowSample]) {
        self.flow.sample(points, time, samples);
        for (point, sample) in points.iter().zip(samples) {
            let share = self.share(*point);
            sample.velocity *= share;
            sample.vorticity *= share;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::Uniform;

    fn wall() -> Shelter<Uniform> {
        let wall = (SharedShape::cuboid(0.1, 1.0, 8.0), Pose::IDENTITY);
        let region = [Vector::new(-4.0, -3.0, -1.0), Vector::new(40.0, 3.0, 1.0)];
        Shelter::bake(
            Uniform::new(10.0, 0.0, 0.0),
            Vector::X,
            &[wall],
            region,
            0.25,
        )
        .unwrap()
    }

    /// The lee of a wall of 2 m (half of its wake's factor at five heights), its edges, and the batch, which is the
    /// same point by point.
    #[test]
    fn behind_a_wall() {
        let flow = wall();
        let at = |x, y| flow.velocity(Vector::new(x, y, 0.0), 0.0).x;
        let behind = |x: Real| 10.0 * (1.0 - DEFICIT / (1.0 + (x - 0.1) / 10.0));
        for x in [1.0, 5.0, 20.0, 30.0] {
            assert!(
                (at(x, 0.0) - behind(x)).abs() < 0.05,
                "{x}: {} {}",
                at(x, 0.0),
                behind(x)
            );
        }
        assert_eq!(at(3.0, 2.0), 10.0);
        assert_eq!(at(-2.0, 0.0), 10.0);
        let points = [
            Vector::new(1.0, 0.2, 0.1),
            Vector::new(2.0, 1.0, 0.0),
            Vector::X * 99.0,
        ];
        let mut samples = [FlowSample::default(); 3];
        flow.sample(&points, 0.0, &mut samples);
        for (point, sample) in points.iter().zip(&samples) {
            assert_eq!(sample.velocity, flow.velocity(*point, 0.0));
        }
        assert!(flow.velocity(Vector::splat(Real::NAN), 0.0).x.is_finite());
    }

    #[test]
    fn bad_boxes_are_refused() {
        let bake = |direction, high: Vector, spacing| {
            let region = [Vector::ZERO, high];
            Shelter::bake(Uniform::default(), direction, &[], region, spacing)
        };
        assert!(bake(Vector::X, Vector::ONE, 0.5).is_ok());
        assert!(bake(Vector::ZERO, Vector::ONE, 0.5).is_err());
        assert!(bake(Vector::X, Vector::X, 0.5).is_err());
        assert!(bake(Vector::X, Vector::ONE, 0.0).is_err());
        assert!(bake(Vector::X, Vector::ONE * 1e6, 1e-3).is_err());
        assert!(bake(Vector::X * Real::NAN, Vector::ONE, 0.5).is_err());
    }
}
