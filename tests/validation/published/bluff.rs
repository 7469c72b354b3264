//! Drag of bodies that are not plates, at Re 2·10⁴; `docs/bluff-bodies.md` says where the numbers are from.

use super::draw::{self, Item, Panel};
use super::report::Row;
use super::{Computed, Effort, Failure, Progress};
use plotters::style::RGBColor;
use rapier3d_immersed::geometry::{Ellipsoid, Surface};
use rapier3d_immersed::rapier3d::na::{UnitQuaternion, Vector3};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{DryMass, Fluid, FreeBody, HydroProperties, ImmersedBody};
use std::f64::consts::PI;

pub fn compute(_effort: Effort, progress: Progress) -> Result<Computed, Failure> {
    let table = table();
    let mut rows = Vec::new();
    for entry in &table {
        let source = if entry.fitted {
            "docs/bluff-bodies.md; fitted"
        } else {
            "docs/bluff-bodies.md; not fitted"
        };
        let pair = [entry.published, entry.ours];
        rows.push(Row::number(entry.name, pair, "", Some(0.5), source));
    }
    let others = log_error(table.iter().filter(|entry| !entry.fitted));
    rows.push(Row::at_most(
        "rms of ln(ours/published), those not fitted",
        others,
        Some(0.2),
        "",
    ));
    progress(1.0);
    Ok((rows, vec![("bluff.svg".into(), picture(&table)?)]))
}

fn picture(table: &[Entry]) -> Result<String, Failure> {
    const GREY: RGBColor = RGBColor(150, 150, 150);
    const LIGHT: RGBColor = RGBColor(200, 200, 200);
    let mut panel = Panel::new(
        "fitted (blue) and not fitted (red); dashed: 20 % off",
        "published",
        "ours",
    );
    let ends = (0.0, 2.2);
    panel.window = Some([ends, ends]);
    let diagonal = |factor: f64| {
        let far = ends.1 / f64::max(factor, 1.0);
        vec![(ends.0, factor * ends.0), (far, factor * far)]
    };
    let dots = |fitted: bool| {
        let of = table.iter().filter(|entry| entry.fitted == fitted);
        of.map(|entry| (entry.published, entry.ours)).collect()
    };
    panel.items = vec![
        Item::Line(diagonal(1.0), GREY, 1),
        Item::Dashed(diagonal(1.2), LIGHT),
        Item::Dashed(diagonal(1.0 / 1.2), LIGHT),
        Item::Dots(dots(true), RGBColor(30, 90, 200), 4),
        Item::Dots(dots(false), RGBColor(211, 47, 47), 4),
    ];
    draw::svg(
        "Drag coefficients of bodies that are not plates",
        &[panel],
        1,
        (640, 600),
    )
}

/// Drag coefficient on `area` of a body that moves along `direction` at this Reynolds number on the sphere of
/// its volume.
pub fn drag_coefficient(surface: &Surface, direction: Vector3<f64>, area: f64, re: f64) -> f64 {
    let mass = DryMass::uniform(surface, 1.0).unwrap();
    let hydro = HydroProperties::from_surface(surface, mass.center);
    let radius = hydro.proxy.semi_axes.product().cbrt();
    let fluid = Fluid::new(1000.0, 1e-6).unwrap();
    let speed = re * 1e-6 / (2.0 * radius);
    let mut body = FreeBody::new(&ImmersedBody::new(hydro), &mass, &fluid).unwrap();
    body.set_orientation(UnitQuaternion::identity());
    body.set_velocity(direction.normalize() * speed, Vector3::zeros());
    let force = body.forces(Vector3::zeros()).drag.force;
    let force = Vector3::new(force.x, force.y, force.z).map(f64::from);
    -force.dot(&direction.normalize()) / (0.5 * 1000.0 * speed * speed * area)
}

/// A solid of revolution about y with this profile (radius, height) from the bottom up; closed where the
/// radius is 0.
pub fn revolved(profile: &[[f64; 2]], sides: usize) -> Surface {
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    let mut rings = Vec::new();
    for &[radius, height] in profile {
        let start = vertices.len() as u32;
        let count = if radius == 0.0 { 1 } else { sides };
        for i in 0..count {
            let angle = 2.0 * PI * i as f64 / sides as f64;
            vertices.push(Vector3::new(
                radius * angle.cos(),
                height,
                radius * angle.sin(),
            ));
        }
        rings.push((start, count as u32));
    }
    for pair in rings.windows(2) {
        let ((a, m), (b, n)) = (pair[0], pair[1]);
        for i in 0..sides as u32 {
            let j = (i + 1) % sides as u32;
            let at = |start: u32, count: u32, i: u32| start + if count == 1 { 0 } else { i };
            if m > 1 {
                triangles.push([at(a, m, i), at(b, n, i), at(a, m, j)]);
            }
            if n > 1 {
                triangles.push([at(a, m, j), at(b, n, i), at(b, n, j)]);
            }
        }
    }
    Surface::new(&vertices, &triangles).unwrap()
}

fn arc(radius: f64, from: f64, to: f64) -> Vec<[f64; 2]> {
    (0..=16)
        .map(|i| {
            let angle = (from + (to - from) * f64::from(i) / 16.0).to_radians();
            let r = radius * angle.cos();
            [if r < 1e-9 { 0.0 } else { r }, radius * angle.sin()]
        })
        .collect()
}

/// A hemisphere of radius ½, round side down.
pub fn hemisphere() -> Surface {
    let mut profile = arc(0.5, -90.0, 0.0);
    profile.push([0.0, 0.0]);
    revolved(&profile, 48)
}

/// A hemispherical cup of radius ½, round side down, open above.
pub fn cup() -> Surface {
    cup_of(0.02)
}

/// The same with a wall of this thickness.
pub fn cup_of(wall: f64) -> Surface {
    let mut profile = arc(0.5, -90.0, 0.0);
    let mut inner = arc(0.5 - wall, -90.0, 0.0);
    inner.reverse();
    profile.extend(inner);
    revolved(&profile, 48)
}

/// A cone of full angle `degrees` and radius ½, apex up.
pub fn cone(degrees: f64) -> Surface {
    let height = 0.5 / (0.5 * degrees).to_radians().tan();
    revolved(&[[0.0, 0.0], [0.5, 0.0], [0.0, height]], 48)
}

/// A cylinder of radius ½ along y.
fn cylinder(length: f64) -> Surface {
    let half = 0.5 * length;
    revolved(&[[0.0, -half], [0.5, -half], [0.5, half], [0.0, half]], 48)
}

pub fn block(x: f64, y: f64, z: f64) -> Surface {
    let half = Vector::new(0.5 * x as f32, 0.5 * y as f32, 0.5 * z as f32);
    Surface::from_shape(&Cuboid::new(half)).unwrap()
}

pub fn spheroid(length: f64) -> Surface {
    let semi_axes = Vector3::new(0.5, 0.5 * length, 0.5);
    Surface::ellipsoid(&Ellipsoid { semi_axes }, 24).unwrap()
}

/// One published number.
pub struct Entry {
    pub name: &'static str,
    pub published: f64,
    pub ours: f64,
    /// Whether the law's constants were fitted to it.
    pub fitted: bool,
}

pub fn table() -> Vec<Entry> {
    let (x, y, disc) = (Vector3::x(), Vector3::y(), PI / 4.0);
    let mut entries = Vec::new();
    let mut add = |name, published, fitted, surface: Surface, direction, area| {
        let ours = drag_coefficient(&surface, direction, area, 2e4);
        entries.push(Entry {
            name,
            published,
            ours,
            fitted,
        });
    };
    add("sphere", 0.45, true, spheroid(1.0), x, disc);
    add(
        "cube, face first",
        1.05,
        false,
        block(1.0, 1.0, 1.0),
        x,
        1.0,
    );
    add(
        "cube, edge first",
        0.80,
        false,
        block(1.0, 1.0, 1.0),
        x + y,
        2f64.sqrt(),
    );
    for (name, published, fitted, length) in [
        ("cylinder across, L/D = 1", 0.63, false, 1.0),
        ("cylinder across, L/D = 2", 0.68, false, 2.0),
        ("cylinder across, L/D = 5", 0.74, true, 5.0),
        ("cylinder across, L/D = 10", 0.82, true, 10.0),
        ("cylinder across, L/D = 40", 0.98, false, 40.0),
        (
            "cylinder across, L/D = 1000 for infinite",
            1.20,
            true,
            1000.0,
        ),
    ] {
        add(name, published, fitted, cylinder(length), x, length);
    }
    add(
        "square prism across, 1000 long",
        2.0,
        true,
        block(1.0, 1000.0, 1.0),
        x,
        1000.0,
    );
    for (name, published, fitted, length) in [
        ("square rod end-on, L/a = 1", 1.15, false, 1.0),
        ("square rod end-on, L/a = 1.5", 0.97, true, 1.5),
        ("square rod end-on, L/a = 2", 0.87, false, 2.0),
        ("square rod end-on, L/a = 2.5", 0.90, true, 2.5),
        ("square rod end-on, L/a = 3", 0.93, false, 3.0),
        ("square rod end-on, L/a = 4", 0.95, true, 4.0),
        ("square rod end-on, L/a = 5", 0.95, false, 5.0),
    ] {
        add(name, published, fitted, block(1.0, length, 1.0), y, 1.0);
    }
    for (name, published, length) in [
        ("cylinder end-on, L/D = 1", 0.91, 1.0),
        ("cylinder end-on, L/D = 2", 0.85, 2.0),
        ("cylinder end-on, L/D = 4", 0.87, 4.0),
        ("cylinder end-on, L/D = 7", 0.99, 7.0),
    ] {
        add(name, published, false, cylinder(length), y, disc);
    }
    add("spheroid 2:1 along", 0.27, true, spheroid(2.0), y, disc);
    add(
        "hemisphere, round side first",
        0.42,
        true,
        hemisphere(),
        -y,
        disc,
    );
    add(
        "hemisphere, flat side first",
        1.17,
        false,
        hemisphere(),
        y,
        disc,
    );
    add("cup, round side first", 0.38, false, cup(), -y, disc);
    add("cup, open side first", 1.42, true, cup(), y, disc);
    add("cone of 60°, apex first", 0.51, true, cone(60.0), y, disc);
    add("cone of 60°, base first", 1.17, false, cone(60.0), -y, disc);
    add("cone of 30°, apex first", 0.34, false, cone(30.0), y, disc);
    add(
        "slab 2 × 1 × 0.3, short edge first",
        0.93,
        false,
        block(2.0, 1.0, 0.3),
        x,
        0.3,
    );
    entries
}

/// Root mean square of ln(ours/published).
pub fn log_error<'a>(entries: impl Iterator<Item = &'a Entry>) -> f64 {
    let errors: Vec<f64> = entries.map(|e| (e.ours / e.published).ln()).collect();
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
}
