//! A contact sheet: moments of a run, drawn in perspective, farther things first.

use super::picture::Failure;
use super::recording::Recording;
use super::scene::{Look, Scene, convex_outline, corners, pose_parts};
use super::{Quat, Vec3};
use plotters::backend::SVGBackend;
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Polygon, Rectangle, Text};
use plotters::style::{Color, IntoFont, RGBAColor, RGBColor, TextStyle};

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Pixels of a moment of what falls from high.
pub const UPRIGHT: (u32, u32) = (600, 840);

/// Where the picture is taken from.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// Position, m.
    pub eye: Vec3,
    /// Point in the middle of the picture, m.
    pub target: Vec3,
    /// Vertical field of view, rad.
    pub field_of_view: f64,
}

impl Camera {
    /// A view of what moves between two corners of a box, from aside and a little above.
    pub fn overview([low, high]: &[Vec3; 2]) -> Self {
        let target = 0.5 * (low + high);
        let distance = 1.5 * (high - low).norm().max(0.1);
        Self {
            eye: target + Vec3::new(0.75, 0.4, 1.9).normalize() * distance,
            target,
            field_of_view: 0.66,
        }
    }

    /// Pixel coordinates of a point in front of the camera.
    fn project(&self, point: &Vec3, size: (u32, u32)) -> [f64; 2] {
        let forward = (self.target - self.eye).normalize();
        let right = forward.cross(&Vec3::y()).normalize();
        let up = right.cross(&forward);
        let d = point - self.eye;
        let depth = d.dot(&forward);
        let focal = 0.5 * f64::from(size.1) / (0.5 * self.field_of_view).tan();
        let x = 0.5 * f64::from(size.0) + focal * d.dot(&right) / depth;
        let y = 0.5 * f64::from(size.1) - focal * d.dot(&up) / depth;
        [x, y]
    }
}

/// Two corners of a box in which nearly everything is nearly always, and what is largest fits beside its middle: those few pieces
/// that roll or blow away are not worth a view ten times as wide.
pub fn bounds(scene: &Scene, recordings: &[&Recording]) -> [Vec3; 2] {
    // Of each kind its middle in its own frame, and how far it reaches from there.
    let boxes: Vec<(Vec3, f64)> = scene
        .kinds
        .iter()
        .map(|kind| {
            let [low, high] = corners(&kind.solid);
            (0.5 * (low + high), 0.5 * (high - low).norm())
        })
        .collect();
    let widest = boxes.iter().map(|(_, reach)| *reach).fold(0.0, f64::max);
    let frames = recordings.iter().flat_map(|recording| &recording.frames);
    let places: Vec<Vec3> = frames
        .step_by(8)
        .flat_map(|frame| frame.iter().zip(&scene.pieces))
        .map(|((place, turn), piece)| place + turn * boxes[piece.kind].0)
        .collect();
    let sorted = [0, 1, 2].map(|axis| {
        let mut values: Vec<f64> = places.iter().map(|place| place[axis]).collect();
        values.sort_by(f64::total_cmp);
        values
    });
    [(0.02, -widest), (0.98, widest)].map(|(share, beside)| {
        let at = (share * places.len() as f64) as usize;
        Vec3::from_fn(|axis, _| sorted[axis].get(at).copied().unwrap_or(0.0) + beside)
    })
}

/// Direction toward the light.
pub fn light() -> Vec3 {
    Vec3::new(-0.35, 1.0, 0.3).normalize()
}

/// Where the shadow of a point falls on the floor.
pub fn shadow(point: &Vec3) -> Vec3 {
    point - light() * (point.y.max(0.0) / light().y)
}

/// A polygon in world axes.
struct Face {
    corners: Vec<Vec3>,
    color: [f32; 3],
}

impl Face {
    fn all(look: &Look, position: Vec3, turn: Quat) -> impl Iterator<Item = Self> + '_ {
        look.faces.iter().map(move |face| Self {
            corners: face.iter().map(|v| position + turn * v).collect(),
            color: look.color,
        })
    }

    fn normal(&self) -> Vec3 {
        let n = self.corners.len();
        let area = |i: usize| {
            (self.corners[i] - self.corners[0])
                .cross(&(self.corners[(i + 1) % n] - self.corners[0]))
        };
        let sum: Vec3 = (1..n).map(area).sum();
        sum.try_normalize(1e-300).unwrap_or_else(Vec3::y)
    }

    fn center(&self) -> Vec3 {
        self.corners.iter().sum::<Vec3>() / self.corners.len() as f64
    }

    /// Whether the segment from `eye` to `point` passes through this (convex) face.
    fn hides(&self, eye: &Vec3, point: &Vec3) -> bool {
        let normal = self.normal();
        let (from, to) = (
            (eye - self.corners[0]).dot(&normal),
            (point - self.corners[0]).dot(&normal),
        );
        // The end counts as in front: what lies on a face is seen.
        if from <= 0.0 || to > -2e-3 {
            return false;
        }
        let hit = eye + (point - eye) * (from / (from - to));
        let n = self.corners.len();
        (0..n).all(|i| {
            let (a, b) = (self.corners[i], self.corners[(i + 1) % n]);
            (b - a).cross(&(hit - a)).dot(&normal) >= 0.0
        })
    }

    /// sRGB colour under the light, either side lit.
    fn shade(&self, toward_eye: &Vec3) -> RGBColor {
        let normal = self.normal();
        let facing = if normal.dot(toward_eye) < 0.0 {
            -normal
        } else {
            normal
        };
        let brightness = 0.45 + 0.35 * facing.dot(&light()).max(0.0) + 0.2 * facing.y.abs();
        display(self.color, brightness)
    }
}

/// Divides faces by the water's level into those above, and those below as they are seen through water of a colour.
fn divided(faces: &[Face], water: [f32; 3]) -> [Vec<Face>; 2] {
    const CLEAR: f32 = 0.3;
    /// What floats flat, a part of a millimeter deep, is seen as above.
    const LEVEL: f64 = -0.01;
    let part = |face: &Face, side: f64, color| {
        let between = |a: &Vec3, b: &Vec3, s: f64| a + (b - a) * s;
        let corners = clipped(&face.corners, |p| side * (p.y - LEVEL), between);
        (corners.len() > 2).then_some(Face { corners, color })
    };
    let through = |face: &Face| {
        let mixed = |k: usize| water[k] + CLEAR * (face.color[k] - water[k]);
        part(face, -1.0, [0, 1, 2].map(mixed))
    };
    [
        faces.iter().filter_map(|f| part(f, 1.0, f.color)).collect(),
        faces.iter().filter_map(through).collect(),
    ]
}

/// sRGB of a linear colour under a light.
pub fn display(color: [f32; 3], brightness: f64) -> RGBColor {
    let [r, g, b] = color.map(|x| {
        let linear = (f64::from(x) * brightness).clamp(0.0, 1.0);
        (255.0 * linear.powf(1.0 / 2.2)) as u8
    });
    RGBColor(r, g, b)
}

/// Draws the recorded frames at the times (s) and from the cameras given, of `frame` pixels each, in rows of `columns`.
///
/// # Errors
/// What the drawing library says.
pub fn contact_sheet(
    scene: &Scene,
    recording: &Recording,
    moments: &[(f64, Camera)],
    columns: usize,
    frame: (u32, u32),
) -> Result<String, Failure> {
    let rows = moments.len().div_ceil(columns);
    let mut svg = String::new();
    {
        let size = (frame.0 * columns as u32, frame.1 * rows as u32);
        let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        let areas = root.split_evenly((rows, columns));
        for (area, (time, camera)) in areas.iter().zip(moments) {
            let nearest = recording.times.partition_point(|t| t < time);
            let frame = nearest.min(recording.times.len().saturating_sub(1));
            draw(area, scene, recording, camera, frame).map_err(|error| error.to_string())?;
        }
        root.present().map_err(|error| error.to_string())?;
    }
    Ok(svg)
}

/// Parts of the world that pieces can be behind.
enum Solid {
    Faces(Vec<Face>),
    Ball(Vec3, f64, [f32; 3]),
}

impl Solid {
    fn hides(&self, eye: &Vec3, point: &Vec3) -> bool {
        match self {
            Self::Faces(faces) => faces.iter().any(|face| face.hides(eye, point)),
            Self::Ball(center, radius, _) => {
                let (line, from) = (point - eye, eye - center);
                // Nearest approach of the segment; a point on the ball itself is seen.
                let s = (-from.dot(&line) / line.norm_squared()).clamp(0.0, 1.0);
                let seen_side = (point - center).dot(&(eye - center)) > radius * radius;
                (from + line * s).norm() < 0.995 * radius && !seen_side
            }
        }
    }

    fn distance(&self, eye: &Vec3) -> f64 {
        match self {
            Self::Faces(faces) => {
                let distances = faces.iter().map(|face| (face.center() - eye).norm());
                distances.fold(f64::INFINITY, f64::min)
            }
            Self::Ball(center, radius, _) => (center - eye).norm() - radius,
        }
    }
}

/// One picture of the sheet.
struct Canvas<'a, 'b> {
    area: &'b Area<'a>,
    size: (u32, u32),
    camera: &'b Camera,
}

type Outcome = Result<(), Box<dyn std::error::Error>>;

impl Canvas<'_, '_> {
    fn fill(&self, corners: &[Vec3], color: RGBAColor) -> Outcome {
        const NEAR: f64 = 0.01;
        let forward = (self.camera.target - self.camera.eye).normalize();
        let ahead = |p: &Vec3| (p - self.camera.eye).dot(&forward) - NEAR;
        let between = |a: &Vec3, b: &Vec3, s: f64| a + (b - a) * s;
        let mut points: Vec<[f64; 2]> = clipped(corners, ahead, between)
            .iter()
            .map(|p| self.camera.project(p, self.size))
            .collect();
        let between = |a: &[f64; 2], b: &[f64; 2], s: f64| [0, 1].map(|k| a[k] + (b[k] - a[k]) * s);
        for (k, size) in [self.size.0, self.size.1].into_iter().enumerate() {
            points = clipped(&points, |p| p[k], between);
            points = clipped(&points, |p| f64::from(size) - p[k], between);
        }
        if points.len() > 2 {
            let rounded = points
                .iter()
                .map(|p| (p[0].round() as i32, p[1].round() as i32));
            self.area
                .draw(&Polygon::new(rounded.collect::<Vec<_>>(), color.filled()))?;
        }
        Ok(())
    }

    fn face(&self, face: &Face) -> Outcome {
        self.fill(
            &face.corners,
            face.shade(&(self.camera.eye - face.center())).mix(1.0),
        )
    }

    /// A ball as discs that shrink toward its bright side.
    fn ball(&self, center: &Vec3, radius: f64, color: [f32; 3]) -> Outcome {
        const DISCS: usize = 10;
        let toward = (self.camera.eye - center).normalize();
        let right = Vec3::y().cross(&toward).normalize();
        let up = toward.cross(&right);
        let bright = light() - toward * light().dot(&toward);
        for i in 0..DISCS {
            let s = i as f64 / DISCS as f64;
            let (middle, size) = (
                center + bright * (0.45 * radius * s),
                radius * (1.0 - s * s).sqrt().min(1.0 - 0.9 * s * s),
            );
            let rim: Vec<Vec3> = (0..48)
                .map(|k| {
                    let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 48.0).sin_cos();
                    middle + (right * cos + up * sin) * size
                })
                .collect();
            self.fill(&rim, display(color, 0.5 + 0.55 * s).mix(1.0))?;
        }
        Ok(())
    }

    /// Shade on the floor.
    fn shade(&self, outline: impl Iterator<Item = Vec3>, strength: f64) -> Outcome {
        let outline: Vec<Vec3> = outline.collect();
        self.fill(&outline, RGBColor(40, 30, 20).mix(strength))
    }
}

/// The part of a polygon where `inside` is not negative (Sutherland & Hodgman 1974).
pub fn clipped<P: Clone>(
    polygon: &[P],
    inside: impl Fn(&P) -> f64,
    between: impl Fn(&P, &P, f64) -> P,
) -> Vec<P> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, a) in polygon.iter().enumerate() {
        let b = &polygon[(i + 1) % polygon.len()];
        let (from, to) = (inside(a), inside(b));
        if from >= 0.0 {
            kept.push(a.clone());
        }
        if (from >= 0.0) != (to >= 0.0) {
            kept.push(between(a, b, from / (from - to)));
        }
    }
    kept
}

fn draw(
    area: &Area,
    scene: &Scene,
    recording: &Recording,
    camera: &Camera,
    frame: usize,
) -> Outcome {
    let size = area.dim_in_pixel();
    let canvas = Canvas { area, size, camera };
    let eye = &camera.eye;
    area.fill(&RGBColor(236, 240, 243))?;

    let mut pieces: Vec<Face> = Vec::new();
    for (i, (position, turn)) in recording.frames[frame].iter().enumerate() {
        pieces.extend(Face::all(&scene.look(i), *position, *turn));
    }
    let mut standing: Vec<Solid> = Vec::new();
    let mut shades: Vec<Vec<[f64; 2]>> = Vec::new();
    for (i, obstacle) in scene.obstacles.iter().enumerate() {
        let (position, turn) = pose_parts(&obstacle.pose);
        let look = &obstacle.look;
        let solid = match look.ball {
            Some(radius) => Solid::Ball(position, radius, look.color),
            None => {
                let mut faces: Vec<Face> = Face::all(look, position, turn)
                    .filter(|face| face.normal().dot(&(eye - face.center())) > 0.0)
                    .collect();
                if let Some(water) = scene.water
                    && i > 0
                {
                    [faces, _] = divided(&faces, water);
                }
                Solid::Faces(faces)
            }
        };
        // The floor comes first, with all shadows on it.
        match &solid {
            Solid::Faces(faces) if i == 0 => {
                for face in faces {
                    canvas.face(face)?;
                }
            }
            _ => {
                let corners: Vec<Vec3> = match &solid {
                    // What is under water casts none.
                    Solid::Faces(faces) if scene.water.is_some() => {
                        faces.iter().flat_map(|face| face.corners.clone()).collect()
                    }
                    _ => {
                        let vertices = look.solid.vertices().iter();
                        vertices.map(|v| position + turn * v).collect()
                    }
                };
                let shadows = corners.iter().map(shadow);
                shades.push(convex_outline(shadows.map(|p| [p.x, p.z]).collect()));
                standing.push(solid);
            }
        }
    }
    let distance = |face: &Face| (face.center() - eye).norm();
    if let Some(water) = scene.water {
        let [above, mut below] = divided(&pieces, water);
        below.sort_by(|a, b| distance(b).total_cmp(&distance(a)));
        below.iter().try_for_each(|face| canvas.face(face))?;
        pieces = above;
    }
    for outline in &shades {
        let outline = outline.iter().map(|p| Vec3::new(p[0], 0.0, p[1]));
        canvas.shade(outline, 0.22)?;
    }
    for piece in &pieces {
        // Higher pieces cast fainter shadows, as under a wide sky.
        let strength = 0.3 / (1.0 + 4.0 * piece.center().y.max(0.0));
        canvas.shade(piece.corners.iter().map(shadow), strength)?;
    }
    standing.sort_by(|a, b| b.distance(eye).total_cmp(&a.distance(eye)));
    for solid in &standing {
        match solid {
            Solid::Faces(faces) => faces.iter().try_for_each(|face| canvas.face(face))?,
            Solid::Ball(center, radius, color) => canvas.ball(center, *radius, *color)?,
        }
    }
    pieces.retain(|face| {
        let point = face.center();
        !standing.iter().any(|solid| solid.hides(eye, &point))
    });
    pieces.sort_by(|a, b| distance(b).total_cmp(&distance(a)));
    for piece in &pieces {
        canvas.face(piece)?;
    }

    let style = TextStyle::from(("sans-serif", 30).into_font()).color(&RGBColor(60, 60, 60));
    let label = format!("{:.1} s", recording.times[frame]);
    area.draw(&Text::new(label, (20, 18), style))?;
    let border = [(0, 0), (size.0 as i32 - 1, size.1 as i32 - 1)];
    area.draw(&Rectangle::new(
        border,
        RGBColor(150, 150, 150).stroke_width(2),
    ))?;
    Ok(())
}
