//! A machine's run, and what it leaves behind: outlines of its bodies at moments, curves, and lines of text.

use crate::Failure;
use crate::draw::{self, Item, Panel, Point};
use plotters::style::RGBColor;
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::prelude::*;
use std::path::Path;

pub const BLUE: RGBColor = RGBColor(30, 90, 200);
pub const RED: RGBColor = RGBColor(211, 47, 47);
pub const GREY: RGBColor = RGBColor(150, 150, 150);
pub const GREEN: RGBColor = RGBColor(46, 140, 60);

/// A machine's picture, and what is printed.
pub struct Shown {
    title: &'static str,
    pub panels: Vec<Panel>,
    pub lines: Vec<String>,
}

impl Shown {
    pub fn new(title: &'static str, panels: Vec<Panel>, lines: Vec<String>) -> Self {
        Self {
            title,
            panels,
            lines,
        }
    }
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

/// A panel of what bodies look like from a side.
pub fn seen(
    title: &str,
    labels: [&str; 2],
    world: &PhysicsWorld,
    bodies: &[RigidBodyHandle],
    view: View,
) -> Panel {
    let mut panel = Panel::new(title, labels[0], labels[1]).equal();
    panel.items = drawn(world, bodies, view, BLUE);
    panel
}

/// The greatest magnitude on a curve.
pub fn greatest(curve: &[Point]) -> f64 {
    curve.iter().map(|(_, y)| y.abs()).fold(0.0, f64::max)
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
    let item = |line: Vec<Point>| Item::Line(line.into_iter().map(large).collect(), color, 1);
    let outlines = outlines(world, body, view).into_iter();
    outlines.map(item).collect()
}

/// The convex hull of points, closed: Andrew's monotone chain.
fn hull(mut points: Vec<Point>) -> Vec<Point> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let turn = |a: Point, b: Point, c: Point| (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0);
    let half = |points: &mut dyn Iterator<Item = Point>| {
        let mut line: Vec<Point> = Vec::new();
        for p in points {
            while line.len() > 1 && turn(line[line.len() - 2], line[line.len() - 1], p) <= 0.0 {
                line.pop();
            }
            line.push(p);
        }
        line
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
    let columns = shown.panels.len().min(3);
    let picture = draw::svg(shown.title, &shown.panels, columns, (420, 380))?;
    Ok(std::fs::write(path, picture)?)
}
