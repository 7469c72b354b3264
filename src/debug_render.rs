//! What the fluid does to bodies, as lines for rapier's own debug renderer.

use crate::body::ImmersedBody;
use crate::coupling::Immersion;
use crate::dynamics::ForceBreakdown;
use crate::hydro::HydroProperties;
use crate::math;
use crate::math::{isometry, to_real};
use rapier3d::dynamics::{RigidBody, RigidBodyHandle, RigidBodySet};
use rapier3d::math::{Real, Vector};
use rapier3d::na::{Isometry3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};
use rapier3d::pipeline::{DebugColor, DebugRenderBackend, DebugRenderObject};
use std::f64::consts::TAU;

/// Draws forces, planforms, proxy ellipsoids and the flow around immersed bodies, through the same backend as rapier's
/// [`DebugRenderPipeline`](rapier3d::pipeline::DebugRenderPipeline): whatever shows that shows this.
///
/// Lines belong to their rigid body ([`DebugRenderObject::RigidBody`]), so that a backend's filter hides them with it. What
/// belongs to a sleeping body is dark.
///
/// ```
/// use rapier3d_immersed::rapier3d::prelude::*;
/// use rapier3d_immersed::{DebugRender, Fluid, HydroProperties, Immersion};
///
/// /// A backend that counts.
/// struct Lines(usize);
/// impl DebugRenderBackend for Lines {
///     fn draw_line(&mut self, _: DebugRenderObject, _: Vector, _: Vector, _: DebugColor) {
///         self.0 += 1;
///     }
/// }
///
/// let mut world = PhysicsWorld::new();
/// let ball = ColliderBuilder::ball(0.1).density(500.0);
/// let (ball, _) = world.insert(RigidBodyBuilder::dynamic(), ball);
/// let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, ball)?;
/// let mut immersion = Immersion::new(Fluid::WATER);
/// immersion.insert(ball, hydro);
/// immersion.step(&mut world);
/// let mut lines = Lines(0);
/// DebugRender::default().render(&mut lines, &world.bodies, &immersion);
/// assert!(lines.0 > 10);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DebugRender {
    /// Arrows of the components of the force ([`DebugRender::FORCES`] has their colors), from the center of mass; of a body of
    /// parts, its drag and lifts part by part, from each part's planform (default true).
    pub forces: bool,
    /// Outlines of planforms: rectangles or ellipses with the planform's extents, and their normals (default true).
    pub planforms: bool,
    /// The three principal sections of the proxy ellipsoids (default false).
    pub proxies: bool,
    /// Arrows of the mean flow's velocity at the center of mass, and at each part (default true).
    pub flow: bool,
    /// Length of an arrow for a force as large as the body's weight at 9.81 m/s², in longest extents of the body
    /// (default 1).
    pub force_length: Real,
    /// Length of a flow's arrow per speed, s: how far the fluid goes in that time (default 0.1).
    pub flow_time: Real,
}

impl Default for DebugRender {
    fn default() -> Self {
        Self {
            forces: true,
            planforms: true,
            proxies: false,
            flow: true,
            force_length: 1.0,
            flow_time: 0.1,
        }
    }
}

const PLANFORM: DebugColor = [60.0, 0.9, 0.5, 1.0];
const PROXY: DebugColor = [60.0, 0.3, 0.4, 1.0];
const FLOW: DebugColor = [190.0, 0.9, 0.6, 1.0];
/// The components that each part has of its own: the first ones.
const OF_PARTS: usize = 3;
/// As rapier darkens what sleeps.
const ASLEEP: Real = 0.2;
/// Segments of a closed curve.
const SEGMENTS: usize = 24;

impl DebugRender {
    /// What the components of a force are called, and their colors (hue in degrees, saturation, lightness, alpha): a legend.
    pub const FORCES: [(&str, DebugColor); 8] = [
        ("drag", [0.0, 0.9, 0.5, 1.0]),
        ("translational lift", [120.0, 0.9, 0.4, 1.0]),
        ("rotational lift", [90.0, 0.9, 0.5, 1.0]),
        ("added mass", [280.0, 0.7, 0.6, 1.0]),
        ("buoyancy", [210.0, 0.9, 0.55, 1.0]),
        ("weight", [0.0, 0.0, 0.6, 1.0]),
        ("thrust", [30.0, 1.0, 0.5, 1.0]),
        ("turbulence", [320.0, 0.9, 0.6, 1.0]),
    ];

    /// Draws everything about the bodies of `immersion` that are in the fluid, in the state that they have now.
    pub fn render(
        &self,
        backend: &mut impl DebugRenderBackend,
        bodies: &RigidBodySet,
        immersion: &Immersion,
    ) {
        for (handle, body) in bodies.iter() {
            let object = DebugRenderObject::RigidBody(handle, body);
            let (Some(immersed), Some(forces)) =
                (immersion.get(handle), immersion.forces(bodies, handle))
            else {
                continue;
            };
            if backend.filter_object(object) {
                let mut pen = Pen {
                    backend,
                    object,
                    lightness: if body.is_sleeping() { ASLEEP } else { 1.0 },
                };
                let scene = Scene {
                    bodies,
                    immersion,
                    handle,
                    body,
                };
                self.draw(&mut pen, &scene, immersed, &forces);
            }
        }
    }

    fn draw(
        &self,
        pen: &mut Pen<impl DebugRenderBackend>,
        scene: &Scene,
        immersed: &ImmersedBody,
        forces: &ForceBreakdown,
    ) {
        let pose = isometry(scene.body.position());
        let center = scene.body.center_of_mass();
        if self.proxies {
            pen.proxy(&pose, &immersed.hydro);
        }
        let parts = &immersed.parts;
        let whole = parts.len() < 2;
        let mass = scene.immersion.mass_of(scene.handle);
        let weight = mass.map_or(1.0, |dry| dry.mass as Real * 9.81);
        let length = 2.0 * immersed.hydro.planform.half_extents.max() as Real;
        let scale = self.force_length * length / weight;
        let arrows = |forces: &ForceBreakdown| {
            let vectors = components(forces).map(|force| force * scale);
            Self::FORCES
                .map(|(_, color)| color)
                .into_iter()
                .zip(vectors)
        };
        if self.forces {
            // What parts do is drawn where they are.
            for (color, arrow) in arrows(forces).skip(if whole { 0 } else { OF_PARTS }) {
                pen.arrow(center, arrow, color);
            }
        }
        if whole {
            self.surface(pen, scene, &pose, &immersed.hydro, center);
            return;
        }
        for (index, part) in parts.iter().enumerate() {
            let deflection = scene
                .immersion
                .deflection(scene.handle, index)
                .unwrap_or(0.0);
            let turned = part.hinge.map_or(Isometry3::identity(), |hinge| {
                let turn = UnitQuaternion::from_scaled_axis(hinge.axis * f64::from(deflection));
                Translation3::from(hinge.point - turn * hinge.point) * turn
            });
            let pose = pose * turned * part.pose;
            let at = to_real((pose * Point3::from(part.hydro.planform.center)).coords);
            self.surface(pen, scene, &pose, &part.hydro, at);
            let own = scene
                .immersion
                .part_forces(scene.bodies, scene.handle, index);
            if let (true, Some(own)) = (self.forces, own) {
                for (color, arrow) in arrows(&own).take(OF_PARTS) {
                    pen.arrow(at, arrow, color);
                }
            }
        }
    }

    /// A surface's planform, and the flow at a point of it.
    fn surface(
        &self,
        pen: &mut Pen<impl DebugRenderBackend>,
        scene: &Scene,
        pose: &Isometry3<f64>,
        hydro: &HydroProperties,
        at: Vector,
    ) {
        if self.planforms {
            pen.planform(pose, hydro);
        }
        if self.flow {
            let (medium, time) = (scene.immersion.medium(), scene.immersion.time());
            let flow = medium.flow_at(medium.layer_at(at, time), at, time);
            pen.arrow(at, flow.velocity * self.flow_time, FLOW);
        }
    }
}

/// A body, and where its readings are from.
struct Scene<'a> {
    bodies: &'a RigidBodySet,
    immersion: &'a Immersion,
    handle: RigidBodyHandle,
    body: &'a RigidBody,
}

/// In the order of [`DebugRender::FORCES`]: drag and lifts first.
fn components(forces: &ForceBreakdown) -> [Vector; 8] {
    [
        forces.drag,
        forces.translational_lift,
        forces.rotational_lift,
        forces.added_mass,
        forces.buoyancy,
        forces.weight,
        forces.thrust,
        forces.turbulence,
    ]
    .map(|component| component.force)
}

/// Draws for one body.
struct Pen<'a, B> {
    backend: &'a mut B,
    object: DebugRenderObject<'a>,
    lightness: Real,
}

impl<B: DebugRenderBackend> Pen<'_, B> {
    fn line(&mut self, from: Vector, to: Vector, [hue, saturation, lightness, alpha]: DebugColor) {
        let color = [hue, saturation, lightness * self.lightness, alpha];
        self.backend.draw_line(self.object, from, to, color);
    }

    /// An arrow with a head of two strokes; nothing for a vector of no length, or none that is a number.
    fn arrow(&mut self, from: Vector, along: Vector, color: DebugColor) {
        let length = along.length();
        if !(length > 0.0 && length.is_finite()) {
            return;
        }
        let tip = from + along;
        let side = along.any_orthonormal_vector() * (0.07 * length);
        self.line(from, tip, color);
        for side in [side, -side] {
            self.line(tip, tip - along * 0.2 + side, color);
        }
    }

    fn closed(&mut self, points: impl ExactSizeIterator<Item = Vector> + Clone, color: DebugColor) {
        let next = points.clone().cycle().skip(1);
        for (from, to) in points.zip(next) {
            self.line(from, to, color);
        }
    }

    fn planform(&mut self, pose: &Isometry3<f64>, hydro: &HydroProperties) {
        let plate = &hydro.planform;
        let half = plate.half_extents;
        let at = |x: f64, y: f64| {
            let point = plate.center + plate.axes * Vector3::new(x * half.x, y * half.y, 0.0);
            to_real((pose * Point3::from(point)).coords)
        };
        // The boundary lies halfway between an ellipse's π/4 and a rectangle's 1, as that of `Outline`.
        let fill = plate.area / (4.0 * half.x * half.y);
        if fill < 0.5 * (1.0 + TAU / 8.0) {
            let point = |k| {
                let (sine, cosine) = math::sin_cos(angle(k));
                at(cosine, sine)
            };
            self.closed((0..SEGMENTS).map(point), PLANFORM);
        } else {
            let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
            self.closed(corners.into_iter().map(|(x, y)| at(x, y)), PLANFORM);
        }
        let normal = to_real(pose * (plate.axes * Vector3::z() * half.y));
        self.arrow(at(0.0, 0.0), normal, PLANFORM);
    }

    fn proxy(&mut self, pose: &Isometry3<f64>, hydro: &HydroProperties) {
        let axes: Rotation3<f64> = hydro.planform.axes;
        let semi = hydro.proxy.semi_axes;
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            let point = |k| {
                let (sine, cosine) = math::sin_cos(angle(k));
                let mut on = Vector3::zeros();
                (on[a], on[b]) = (semi[a] * cosine, semi[b] * sine);
                to_real((pose * Point3::from(hydro.centroid + axes * on)).coords)
            };
            self.closed((0..SEGMENTS).map(point), PROXY);
        }
    }
}

fn angle(k: usize) -> f64 {
    TAU * k as f64 / SEGMENTS as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Part;
    use crate::flow::Uniform;
    use crate::fluid::Fluid;
    use rapier3d::dynamics::RigidBodyBuilder;
    use rapier3d::geometry::ColliderBuilder;
    use rapier3d::pipeline::PhysicsWorld;

    #[derive(Default)]
    struct Lines {
        drawn: Vec<(Vector, Vector, DebugColor)>,
        hidden: bool,
    }

    impl Lines {
        /// The first line of a color: the shaft of an arrow.
        fn shaft(&self, color: DebugColor) -> Option<Vector> {
            let found = self.drawn.iter().find(|(.., c)| *c == color);
            found.map(|(from, to, _)| *to - *from)
        }
    }

    impl DebugRenderBackend for Lines {
        fn filter_object(&self, _: DebugRenderObject) -> bool {
            !self.hidden
        }

        fn draw_line(&mut self, _: DebugRenderObject, a: Vector, b: Vector, color: DebugColor) {
            assert!(a.is_finite() && b.is_finite());
            self.drawn.push((a, b, color));
        }
    }

    fn color(name: &str) -> DebugColor {
        let found = DebugRender::FORCES.iter().find(|(known, _)| *known == name);
        found.unwrap().1
    }

    /// A board held in a stream of 2 m/s.
    fn board(parts: usize) -> (PhysicsWorld, Immersion, RigidBodyHandle) {
        let mut world = PhysicsWorld::new();
        let board = ColliderBuilder::cuboid(0.2, 0.005, 0.1).density(400.0);
        let (handle, _) =
            world.insert(RigidBodyBuilder::dynamic().rotation(Vector::Z * 0.3), board);
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
        let mut immersion = Immersion::new(Fluid::WATER);
        immersion.set_flow(Uniform::new(2.0, 0.0, 0.0));
        let part = Part::new(hydro.clone());
        let body = ImmersedBody::new(hydro).with_parts(vec![part; parts]);
        immersion.insert(handle, body);
        immersion.step(&mut world);
        (world, immersion, handle)
    }

    /// Arrows are the components of the force, a weight as long as the body is: 0.4 m.
    #[test]
    fn arrows_are_the_forces() {
        let (world, immersion, handle) = board(0);
        let mut lines = Lines::default();
        DebugRender::default().render(&mut lines, &world.bodies, &immersion);
        let forces = immersion.forces(&world.bodies, handle).unwrap();
        let per_newton = 0.4 / (400.0 * 0.4 * 0.01 * 0.2 * 9.81);
        for (name, force) in [
            ("drag", forces.drag),
            ("buoyancy", forces.buoyancy),
            ("weight", forces.weight),
            ("added mass", forces.added_mass),
        ] {
            let drawn = lines.shaft(color(name)).unwrap();
            let exact = force.force * per_newton;
            assert!((drawn - exact).length() < 1e-4 * exact.length(), "{name}");
        }
        assert!((lines.shaft(color("weight")).unwrap().y + 0.4).abs() < 1e-4);
        // The fluid goes 0.2 m in 0.1 s.
        assert!((lines.shaft(FLOW).unwrap() - Vector::X * 0.2).length() < 1e-6);
        assert!(lines.shaft(color("thrust")).is_none(), "it has none");
    }

    /// The rectangle has the plate's corners, 0.4 m × 0.2 m, tilted by 0.3 rad.
    #[test]
    fn planforms_are_where_the_body_is() {
        let (mut world, immersion, handle) = board(0);
        world.bodies[handle].set_rotation(rapier3d::math::Rotation::from_rotation_z(0.5), true);
        let mut lines = Lines::default();
        DebugRender::default().render(&mut lines, &world.bodies, &immersion);
        let edges: Vec<_> = lines
            .drawn
            .iter()
            .filter(|(.., c)| *c == PLANFORM)
            .collect();
        // Four edges and an arrow.
        assert_eq!(edges.len(), 7);
        let (sine, cosine) = 0.5f32.sin_cos();
        let center = world.bodies[handle].position().translation;
        for (from, ..) in &edges[..4] {
            let local = *from - center;
            assert!((local.x * cosine + local.y * sine).abs() - 0.2 < 1e-4);
            assert!(
                (local.y * cosine - local.x * sine).abs() < 1e-4,
                "in its plane"
            );
            assert!((local.z.abs() - 0.1).abs() < 1e-4);
        }
    }

    /// Two parts in the same place have half of the drag each of what both have, drawn at each.
    #[test]
    fn parts_have_their_own_arrows() {
        let (world, immersion, handle) = board(2);
        let mut lines = Lines::default();
        DebugRender::default().render(&mut lines, &world.bodies, &immersion);
        let drag: Vec<_> = lines
            .drawn
            .iter()
            .filter(|(.., c)| *c == color("drag"))
            .collect();
        assert_eq!(drag.len(), 6, "two arrows of three lines");
        let all = immersion.forces(&world.bodies, handle).unwrap().drag.force;
        let per_newton = 0.4 / (400.0 * 0.4 * 0.01 * 0.2 * 9.81);
        let sum = (drag[0].1 - drag[0].0) + (drag[3].1 - drag[3].0);
        assert!((sum - all * per_newton).length() < 1e-3 * sum.length());
        let frames = lines.drawn.iter().filter(|(.., c)| *c == PLANFORM).count();
        assert_eq!(frames, 14);
    }

    #[test]
    fn what_sleeps_is_dark_and_what_is_filtered_is_not_there() {
        let (mut world, immersion, handle) = board(0);
        world.bodies[handle].sleep();
        let mut lines = Lines::default();
        let everything = DebugRender {
            proxies: true,
            ..DebugRender::default()
        };
        everything.render(&mut lines, &world.bodies, &immersion);
        assert!(
            lines
                .drawn
                .iter()
                .all(|(.., [_, _, lightness, _])| *lightness <= 0.2)
        );
        let proxy = [PROXY[0], PROXY[1], PROXY[2] * ASLEEP, PROXY[3]];
        let sections = lines.drawn.iter().filter(|(.., c)| *c == proxy).count();
        assert_eq!(sections, 3 * SEGMENTS);
        let mut lines = Lines {
            hidden: true,
            ..Lines::default()
        };
        everything.render(&mut lines, &world.bodies, &immersion);
        assert!(lines.drawn.is_empty());
    }
}
