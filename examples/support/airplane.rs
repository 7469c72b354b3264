//! The paper airplane of the thesis's section 4.6: a folded sheet of 8.3 × 8.3 × 0.01 cm, and one that flies.

use super::mesh::RawMesh;
use super::options::key;
use super::picture::{self, Line, Panel, time_color};
use super::recording::Recording;
use super::scene::{Kind, Scene};
use super::sheet::{Camera, UPRIGHT, contact_sheet};
use super::{Quat, Vec3, cli};
use plotters::style::RGBColor;
use rapier3d_immersed::AddedMass;
use rapier3d_immersed::geometry::{Sheet, Surface};
use rapier3d_immersed::preset;
use rapier3d_immersed::rapier3d::geometry::{Cuboid, SharedShape};
use rapier3d_immersed::rapier3d::math::{Pose, Vector};
use rapier3d_immersed::rapier3d::na::{Isometry3, Matrix3};
use rapier3d_immersed::rapier3d::prelude::PhysicsWorld;
use rapier3d_immersed::{DryMass, Error, HydroProperties, ImmersedBody, Part};
use serde_json::{Value, json};
use std::sync::Arc;

/// Side of the sheet, m.
pub const SIDE: f64 = 0.083;
/// Thickness of the paper, m.
pub const THICKNESS: f64 = 1e-4;
/// Velocity at the release, m/s, along the nose: about that of its glide. The thesis's, whose law has the same lift at any
/// angle, starts with 0.2 m/s, from which this one falls for half a meter before it flies.
pub const SPEED: f64 = 2.0;
/// How far the right wing is down at the release, rad: perfectly level, the airplane would never turn
/// sideways. The thesis does not say.
const BANK: f64 = 0.1;
/// Thickness of the wings' collision boxes, m, as of the leaves'.
const COLLISION_THICKNESS: f64 = 1e-3;
/// The paper clip that makes it fly: its mass, kg, where it is ahead of the middle, m, and its radius of gyration, m.
const CLIP: f64 = 3e-4;
const CLIP_AT: f64 = 0.035;
const CLIP_RADIUS: f64 = 5e-3;
/// Width of the rear edges that are bent up, m, and by how much, rad.
const EDGE: f64 = 4e-3;
const BENT: f64 = 0.3;
/// The boundary-element solution; the file says which command wrote it.
const STORED: &str = include_str!("airplane_added_mass.json");

/// The stored added mass, per unit density about the centroid, and its relative error.
pub fn stored_added_mass() -> (AddedMass, f64) {
    let file: Value = serde_json::from_str(STORED).expect("the file is part of this example");
    let number = |value: &Value| value.as_f64().expect("a number");
    let block = |name: &str| Matrix3::from_fn(|i, j| number(&file[name][i][j]));
    let added_mass = AddedMass {
        linear: block("linear_m3"),
        coupling: block("coupling_m4"),
        angular: block("angular_m5"),
    };
    (added_mass, number(&file["error"]))
}

/// The same, solved anew.
#[cfg(feature = "bake")]
pub fn solved_added_mass() -> AddedMass {
    use rapier3d_immersed::boundary_element::{BoundaryElementParams, BoundaryElementSolution};
    BoundaryElementSolution::of_sheets(
        |level| {
            let cells = 12.0 * 2f64.powf(0.5 * level as f64);
            Sheet::paper_airplane(SIDE, THICKNESS, cells.round() as usize)
        },
        &BoundaryElementParams::default(),
        &|_| (),
    )
    .expect("the sheet is a good one")
    .added_mass
}

fn added_mass() -> AddedMass {
    #[cfg(feature = "bake")]
    return solved_added_mass();
    #[cfg(not(feature = "bake"))]
    stored_added_mass().0
}

/// The airplane made of paper of this density (kg/m³). Its frame is that of
/// [`Sheet::paper_airplane`]: nose toward +x, wings in ±y, keel downward along −z.
///
/// # Errors
/// What the density lacks.
pub fn kind(density: f64) -> Result<Kind, String> {
    let sheet = Sheet::paper_airplane(SIDE, THICKNESS, 6).map_err(|error| error.to_string())?;
    let raw = RawMesh {
        vertices: sheet.vertices().to_vec(),
        triangles: sheet.triangles().to_vec(),
    };
    let solid = raw.mitred(THICKNESS)?;
    let integrals = solid.volume_integrals();
    let dry = DryMass {
        mass: density * integrals.volume,
        center: integrals.centroid,
        inertia: integrals.unit_inertia() * density,
    };
    dry.check().map_err(|error| error.to_string())?;
    let hydro = HydroProperties::from_surface(&solid, sheet.centroid())
        .with_added_mass(added_mass())
        .map_err(|error| error.to_string())?;
    let wing = chords(&sheet);
    Ok(Kind {
        body: Arc::new(ImmersedBody::new(hydro)),
        dry,
        collision: boxes(&wing),
        solid: Arc::new(solid),
        outline: Arc::new(faces(&wing)),
    })
}

/// The same airplane as one flies it: a paper clip on its nose, its rear edges bent up, and the wings as sections that each
/// see the air where they are. Without the clip its center of mass is behind the pressure of its wings, and it
/// turns over whatever the law.
///
/// # Errors
/// What the density lacks.
pub fn flying(density: f64) -> Result<Kind, String> {
    let sheet = Sheet::paper_airplane(SIDE, THICKNESS, 6).map_err(|error| error.to_string())?;
    let bare = kind(density)?;
    let clip = DryMass {
        mass: CLIP,
        center: Vec3::new(CLIP_AT, 0.0, 0.0),
        inertia: Matrix3::identity() * (CLIP * CLIP_RADIUS * CLIP_RADIUS),
    };
    let parts = parts(&chords(&sheet)).map_err(|error| error.to_string())?;
    Ok(Kind {
        body: Arc::new((*bare.body).clone().with_parts(parts)),
        dry: bare.dry.combined(&clip),
        ..bare
    })
}

/// Sections of the wings, of the aspect ratio of both together; the keel; and the bent rear edges.
fn parts(wing: &[Chord]) -> Result<Vec<Part>, Error> {
    let (low, high) = (wing[0], wing[wing.len() - 1]);
    let span = high[0].y - low[0].y;
    let lengths = |strip: &[Chord]| [0, 1].map(|i| strip[i][1].x - strip[i][0].x);
    let area = |strip: &[Chord]| {
        let [a, b] = lengths(strip);
        0.5 * (a + b) * (strip[1][0].y - strip[0][0].y)
    };
    let is_keel = |strip: &[Chord]| strip[0][0].y * strip[1][0].y < 0.0;
    let whole: f64 = wing.windows(2).filter(|s| !is_keel(s)).map(area).sum();
    let mut parts = Vec::new();
    for strip in wing.windows(2) {
        if is_keel(strip) {
            let [back, front] = [strip[0][0], strip[0][1]];
            let down = Vec3::z() * -front.z;
            let middle = [back, front].map(|v| Vec3::new(v.x, 0.0, v.z));
            let corners = [middle[0], middle[1], middle[1] + down, middle[0] + down];
            let plate = prism(&corners, Vec3::y() * THICKNESS)?;
            parts.push(Part::new(HydroProperties::from_surface(
                &plate,
                Vec3::zeros(),
            )));
            continue;
        }
        let corners = [strip[0][0], strip[0][1], strip[1][1], strip[1][0]];
        let plate = prism(&corners, Vec3::z() * (0.5 * THICKNESS))?;
        let mut section = HydroProperties::from_surface(&plate, Vec3::zeros());
        let along = section.planform.axes.inverse() * Vec3::y();
        section.planform.half_extents[along.xy().iamax()] = 0.5 * span;
        section.planform.fraction = area(strip) / whole;
        parts.push(Part::new(section));
    }
    for side in [low, high] {
        let at = Vec3::new(side[0].x, 0.6 * side[0].y, side[0].z);
        let bent = Isometry3::new(at, Vec3::y() * BENT);
        let half = Vec3::new(0.5 * EDGE, 0.2 * span, 0.5 * THICKNESS).map(|x| x as f32);
        let edge = HydroProperties::from_shape(&Cuboid::new(Vector::new(half.x, half.y, half.z)))?;
        let behind = Isometry3::translation(-0.5 * EDGE, 0.0, 0.0);
        parts.push(Part::new(edge).at(bent * behind));
    }
    Ok(parts)
}

/// The solid over a quadrangle, so far to either side.
fn prism(corners: &[Vec3; 4], to: Vec3) -> Result<Surface, Error> {
    let points: Vec<Vec3> = [to, -to]
        .iter()
        .flat_map(|d| corners.map(|v| v + d))
        .collect();
    let mut triangles = vec![[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]];
    for i in 0..4 {
        let next = (i + 1) % 4;
        triangles.extend([[i, i + 4, next + 4], [i, next + 4, next]]);
    }
    let surface = Surface::new(&points, &triangles)?;
    if surface.volume_integrals().volume > 0.0 {
        return Ok(surface);
    }
    let turned: Vec<[u32; 3]> = triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    Surface::new(&points, &turned)
}

/// A section of the level wing: its trailing and its leading point.
type Chord = [Vec3; 2];

/// From the tip at −y to that at +y; the keel opens between the middle two.
fn chords(sheet: &Sheet) -> Vec<Chord> {
    let top = sheet.vertices().iter().map(|v| v.z).fold(0.0, f64::max);
    let mut chords: Vec<Chord> = Vec::new();
    for v in sheet.vertices().iter().filter(|v| v.z > top - 1e-9) {
        match chords.iter_mut().find(|c| (c[0].y - v.y).abs() < 1e-9) {
            Some([back, front]) => {
                back.x = back.x.min(v.x);
                front.x = front.x.max(v.x);
            }
            None => chords.push([*v, *v]),
        }
    }
    chords.sort_by(|a, b| a[0].y.total_cmp(&b[0].y));
    chords
}

/// A box for the keel and one for each strip of the wings, with the strip's area.
fn boxes(wing: &[Chord]) -> SharedShape {
    let strips = wing.windows(2).map(|strip| {
        let [back, front] = [0, 1].map(|i| 0.5 * (strip[0][i] + strip[1][i]));
        let is_keel = strip[0][0].y * strip[1][0].y < 0.0;
        let height = if is_keel {
            front.z
        } else {
            COLLISION_THICKNESS
        };
        let mut middle = 0.5 * (back + front);
        middle.z -= 0.5 * height;
        let size = [front.x - back.x, strip[1][0].y - strip[0][0].y, height];
        let [x, y, z] = size.map(|s| 0.5 * s as f32);
        let at = Vector::new(middle.x as f32, middle.y as f32, middle.z as f32);
        (Pose::from_translation(at), SharedShape::cuboid(x, y, z))
    });
    SharedShape::compound(strips.collect())
}

/// The wings and the sides of the keel, for pictures.
fn faces(wing: &[Chord]) -> Vec<Vec<Vec3>> {
    let half = wing.len() / 2;
    let quad = |[a, b]: Chord, [c, d]: Chord| vec![a, b, d, c];
    let bottom = wing[half].map(|v| Vec3::new(v.x, 0.0, 0.0));
    vec![
        quad(wing[0], wing[half - 1]),
        quad(wing[half - 1], bottom),
        quad(bottom, wing[half]),
        quad(wing[half], wing[wing.len() - 1]),
    ]
}

/// The airplane above a floor, at its speed of release.
pub fn scene(world: PhysicsWorld, kinds: &[Kind]) -> Scene {
    let mut scene = Scene::new(world);
    scene.kinds = kinds.to_vec();
    let floor = Pose::from_translation(Vector::new(0.0, -0.05, 0.0));
    scene.add_box(floor, [14.0, 0.1, 14.0], [0.62, 0.58, 0.50]);
    let level = Quat::from_axis_angle(&Vec3::x_axis(), -std::f64::consts::FRAC_PI_2);
    let banked = Quat::from_axis_angle(&Vec3::x_axis(), BANK) * level;
    let place = (Vec3::new(0.0, 1.5, 0.0), banked);
    scene.add_piece(
        0,
        [0.85, 0.85, 0.80],
        place,
        Vec3::zeros(),
        preset::leaf_body,
    );
    let body = &mut scene.world.bodies[scene.pieces[0].handle];
    body.set_linvel(Vector::new(SPEED as f32, 0.0, 0.0), true);
    scene
}

/// A flight in a few numbers.
#[derive(Clone, Copy, Debug)]
pub struct Flight {
    /// From the release to the first contact, s; the whole run if there was none.
    pub time: f64,
    /// How far ahead of the release, m.
    pub forward: f64,
    /// How far to the right of the nose at the release, m.
    pub sideways: f64,
    /// Mean speed of descent, m/s.
    pub descent: f64,
    /// Turns of the wings' normal.
    pub turns: f64,
}

impl Flight {
    /// Of the recorded run.
    pub fn of(scene: &Scene, recording: &Recording) -> Self {
        let fate = &recording.fates[0];
        let time = fate
            .landed
            .unwrap_or(recording.times[recording.times.len() - 1]);
        let way = fate.landed_at - scene.pieces[0].release;
        Self {
            time,
            forward: way.x,
            sideways: way.z,
            descent: -way.y / time,
            turns: fate.turns,
        }
    }

    fn rows(&self) -> [(&'static str, f64, &'static str); 5] {
        [
            ("flight_time", self.time, "s"),
            ("forward", self.forward, "m"),
            ("sideways", self.sideways, "m"),
            ("descent", self.descent, "m/s"),
            ("turns", self.turns, ""),
        ]
    }

    /// As a JSON object.
    pub fn json(&self) -> Value {
        let fields = self
            .rows()
            .map(|(name, value, unit)| (key(name, unit), json!(value)));
        Value::Object(fields.into_iter().collect())
    }
}

/// The flight as a table, beside that in plain rapier.
pub fn table(immersed: &Flight, plain: Option<&Flight>) -> String {
    let mut text = format!("{:<16}{:>12}", "", "immersed");
    if plain.is_some() {
        text += &format!("{:>14}", "plain rapier");
    }
    for (i, (name, value, unit)) in immersed.rows().into_iter().enumerate() {
        text += &format!("\n{:<16}{value:>12.3}", name.replace('_', " "));
        if let Some(plain) = plain {
            text += &format!("{:>14.3}", plain.rows()[i].1);
        }
        text += &format!(" {unit}");
    }
    text.push('\n');
    text
}

/// Eight moments, the camera beside the airplane.
pub fn frames(scene: &Scene, recording: &Recording, flight: &Flight) -> String {
    let moments: Vec<(f64, Camera)> = (0..8)
        .map(|i| {
            let time = flight.time * f64::from(i) / 7.0;
            let frame = recording.times.partition_point(|t| *t < time);
            let target = recording.frames[frame.min(recording.frames.len() - 1)][0].0;
            let camera = Camera {
                eye: target + Vec3::new(0.12, 0.14, 0.30),
                target,
                field_of_view: 0.6,
            };
            (time, camera)
        })
        .collect();
    contact_sheet(scene, recording, &moments, 4, UPRIGHT)
        .unwrap_or_else(|problem| cli::cannot_write("frames.svg".as_ref(), problem))
}

/// The path from the side and from above with the airplane drawn to scale, blue to yellow in time;
/// in grey, plain rapier's.
pub fn path(
    scene: &Scene,
    recording: &Recording,
    flight: &Flight,
    plain: Option<&Recording>,
) -> String {
    let side = |p: &Vec3| (p.x, p.y);
    let above = |p: &Vec3| (p.x, -p.z);
    let panel = |title, axes, view: fn(&Vec3) -> (f64, f64)| {
        let mut lines: Vec<Line> = plain
            .into_iter()
            .map(|plain| Line {
                points: plain.frames.iter().map(|frame| view(&frame[0].0)).collect(),
                color: RGBColor(160, 160, 160),
                width: 2,
            })
            .collect();
        lines.extend(silhouettes(scene, recording, flight.time, view));
        Panel {
            title,
            axes,
            lines,
            dots: Vec::new(),
            window: None,
        }
    };
    let panels = [
        panel("from the side", ["ahead, m", "height, m"], side),
        panel("from above", ["ahead, m", "to the left, m"], above),
    ];
    let title = format!(
        "A paper airplane released at {SPEED} m/s: {:.2} s of flight; grey: plain rapier",
        flight.time
    );
    picture::panels(&title, &panels, 2, (560, 620))
        .unwrap_or_else(|problem| cli::cannot_write("trajectories.svg".as_ref(), problem))
}

/// The path until the landing, and the airplane on it.
fn silhouettes(
    scene: &Scene,
    recording: &Recording,
    until: f64,
    view: fn(&Vec3) -> (f64, f64),
) -> Vec<Line> {
    const SHOWN: usize = 18;
    let look = scene.look(0);
    let count = recording.times.partition_point(|t| *t <= until);
    let every = count.div_ceil(SHOWN).max(1);
    let mut lines = Vec::new();
    for (i, pair) in recording.frames[..count].windows(2).enumerate() {
        let color = time_color(i as f64 / count as f64);
        let line = |points, width| Line {
            points,
            color,
            width,
        };
        lines.push(line(
            pair.iter().map(|frame| view(&frame[0].0)).collect(),
            1,
        ));
        if i % every == 0 {
            let (position, turn) = pair[0][0];
            for face in look.faces.iter() {
                let corners = face.iter().chain(face.first());
                lines.push(line(
                    corners.map(|v| view(&(position + turn * v))).collect(),
                    1,
                ));
            }
        }
    }
    lines
}
