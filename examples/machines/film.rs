//! A machine's run, and what it leaves behind: outlines of its bodies at moments, curves, and lines of text.

use crate::Failure;
use crate::draw::{self, Item, Panel, Point};
use plotters::style::RGBColor;
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::na::{
    Isometry3, Translation3, UnitQuaternion, UnitVector3, Vector3,
};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, Immersion};
use std::path::Path;

pub const BLUE: RGBColor = RGBColor(30, 90, 200);
pub const RED: RGBColor = RGBColor(211, 47, 47);
pub const GREY: RGBColor = RGBColor(150, 150, 150);
pub const GREEN: RGBColor = RGBColor(46, 140, 60);

/// A machine's picture, and what is printed.
pub struct Shown {
    pub title: String,
    pub panels: Vec<Panel>,
    pub lines: Vec<String>,
}

/// Two directions of the world that a picture shows to the right and upward.
#[derive(Clone, Copy)]
pub struct View(pub Vector, pub Vector);

impl View {
    /// From the side: x and y.
    pub const SIDE: Self = Self(Vector::X, Vector::Y);
    /// From above: x and −z.
    pub const ABOVE: Self = Self(Vector::X, Vector::new(0.0, 0.0, -1.0));
    /// Along x, from its positive end: −z and y.
    pub const FRONT: Self = Self(Vector::new(0.0, 0.0, -1.0), Vector::Y);

    pub fn of(&self, p: Vector) -> Point {
        (p.dot(self.0).into(), p.dot(self.1).into())
    }
}

/// The outlines of all colliders of a body where they are now, seen from a side: closed lines.
pub fn outlines(world: &PhysicsWorld, body: RigidBodyHandle, view: View) -> Vec<Vec<Point>> {
    let colliders = world.bodies[body].colliders().iter();
    let colliders = colliders.flat_map(|handle| {
        let collider = &world.colliders[*handle];
        let at = *collider.position();
        match collider.shape().as_compound() {
            Some(compound) => {
                let shapes = compound.shapes().iter();
                shapes
                    .map(|(pose, shape)| (at * *pose, shape.clone()))
                    .collect()
            }
            None => vec![(at, collider.shared_shape().clone())],
        }
    });
    colliders
        .filter_map(|(pose, shape)| {
            let surface = Surface::from_shape(shape.as_ref()).ok()?;
            let seen = surface.vertices().iter().map(|v| {
                let v = Vector::new(v.x as Real, v.y as Real, v.z as Real);
                view.of(pose * v)
            });
            Some(hull(seen.collect()))
        })
        .collect()
}

/// A world of so many steps per second, in a fluid.
pub fn world(fluid: Fluid, hz: f32) -> (PhysicsWorld, Immersion) {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = 1.0 / hz;
    (world, Immersion::new(fluid))
}

/// Steps for so many seconds.
pub fn advance(world: &mut PhysicsWorld, immersion: &mut Immersion, seconds: f32) {
    let steps = (seconds / world.integration_parameters.dt).round() as usize;
    (0..steps).for_each(|_| immersion.step(world));
}

/// A collider that touches nothing, as of a part of a machine.
pub fn untouched(shape: SharedShape, place: Pose) -> ColliderBuilder {
    let collider = ColliderBuilder::new(shape).position(place);
    collider.collision_groups(InteractionGroups::none())
}

/// The outlines as items of a panel.
pub fn drawn(
    world: &PhysicsWorld,
    bodies: &[RigidBodyHandle],
    view: View,
    color: RGBColor,
) -> Vec<Item> {
    let outlines = bodies.iter().flat_map(|body| outlines(world, *body, view));
    outlines.map(|line| Item::Line(line, color, 1)).collect()
}

/// The outlines of one body so many times as large about its position, at another place of the panel or its own.
pub fn enlarged(
    world: &PhysicsWorld,
    body: RigidBodyHandle,
    view: View,
    color: RGBColor,
    (scale, place): (f64, Option<Point>),
) -> Vec<Item> {
    let own = view.of(world.bodies[body].translation());
    let to = place.unwrap_or(own);
    let large = |p: Point| (to.0 + scale * (p.0 - own.0), to.1 + scale * (p.1 - own.1));
    let outlines = outlines(world, body, view).into_iter();
    let large = outlines.map(|line| line.into_iter().map(large).collect());
    large.map(|line| Item::Line(line, color, 1)).collect()
}

/// A place, turned by so many whole turns about an axis through the origin.
pub fn around(axis: &UnitVector3<f64>, turns: f64, place: Vector3<f64>) -> Isometry3<f64> {
    let turned = UnitQuaternion::from_axis_angle(axis, std::f64::consts::TAU * turns);
    Isometry3::from_parts(Translation3::from(turned * place), turned)
}

/// In rapier's single precision.
pub fn single(place: &Isometry3<f64>) -> Pose {
    let (t, q) = (&place.translation.vector, place.rotation.coords);
    let rotation = Rotation::from_xyzw(q.x as f32, q.y as f32, q.z as f32, q.w as f32);
    Pose::from_parts(Vector::new(t.x as f32, t.y as f32, t.z as f32), rotation)
}

/// The outlines of bodies, so many times as large, about a point of the picture.
pub fn drawn_larger(
    world: &PhysicsWorld,
    bodies: &[RigidBodyHandle],
    view: View,
    color: RGBColor,
    (about, by): (Point, f64),
) -> Vec<Item> {
    let away = |x: f64, from: f64| from + by * (x - from);
    let outlines = bodies.iter().flat_map(|body| outlines(world, *body, view));
    let enlarged = outlines.map(|line| {
        let points = line.into_iter();
        let points = points.map(|(x, y)| (away(x, about.0), away(y, about.1)));
        Item::Line(points.collect(), color, 1)
    });
    enlarged.collect()
}

/// The convex hull of points, closed: Andrew's monotone chain.
fn hull(mut points: Vec<Point>) -> Vec<Point> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let turn = |a: Point, b: Point, c: Point| (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0);
    let half = |points: &mut dyn Iterator<Item = Point>| {
        let mut chain: Vec<Point> = Vec::new();
        for p in points {
            while chain.len() > 1 && turn(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 0.0
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain
    };
    let mut around = half(&mut points.iter().copied());
    around.pop();
    around.extend(half(&mut points.iter().rev().copied()));
    around
}

pub fn write(path: &Path, shown: &Shown) -> Result<(), Failure> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let columns = shown.panels.len().min(3) as u32;
    let picture = draw::svg(&shown.title, &shown.panels, columns as usize, (420, 380))?;
    std::fs::write(path, picture)?;
    Ok(())
}
