//! A recording as one page that plays in a browser: `viewer.html` with its scripts and all data in it.
//!
//! A page holds a JSON header and one block of little-endian bytes in base64, to which the header has offsets:
//! meshes (f32, u32), poses and forces. A pose is six u16: its place in the box of all places, and its quaternion's three
//! lesser components (15 bits each; the two bits that say which is the greatest lead the first two words). A force
//! is three i16 in units of [`MOST_WEIGHTS`]/32767 of the body's weight.

use super::recording::{COMPONENTS, Recording};
use super::scene::{Look, Scene, pose_parts};
use super::sheet::{Camera, bounds, light};
use super::{Quat, Vec3};
use base64::{Engine, prelude::BASE64_STANDARD};
use rapier3d_immersed::geometry::Surface;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::f64::consts::FRAC_1_SQRT_2;
use std::sync::Arc;

const TEMPLATE: &str = include_str!("viewer.html");
const SCRIPTS: [&str; 6] = [
    include_str!("viewer/vectors.js"),
    include_str!("viewer/recording.js"),
    include_str!("viewer/camera.js"),
    include_str!("viewer/solids.js"),
    include_str!("viewer/overlay.js"),
    include_str!("viewer/controls.js"),
];

/// Bytes of poses and forces beyond which only every second, third, … recorded frame is kept.
const MOST_BYTES: usize = 24 << 20;

/// A component of the force beyond so many weights of its body is cut: such are those of an impact.
pub const MOST_WEIGHTS: f64 = 16.0;

/// A component that nowhere reaches this share of its body's weight is left out.
const LEAST_WEIGHTS: f64 = 0.01;

/// The scene and its recordings of equal pieces, by name, as a page that begins with an overview.
pub fn page(title: &str, scene: &Scene, runs: &[(&str, &Recording)]) -> String {
    let recordings: Vec<&Recording> = runs.iter().map(|(_, recording)| *recording).collect();
    let camera = Camera::overview(&bounds(scene, &recordings));
    page_from(title, scene, runs, &camera, false)
}

/// The same, seen from a camera at first. If it is to `follow`, the first body is followed from near by where it is too small to be
/// seen from there.
pub fn page_from(
    title: &str,
    scene: &Scene,
    runs: &[(&str, &Recording)],
    camera: &Camera,
    follow: bool,
) -> String {
    let mut block = Block::default();
    let fixed: Vec<Value> = scene
        .obstacles
        .iter()
        .map(|obstacle| {
            let (position, turn) = pose_parts(&obstacle.pose);
            json!({
                "mesh": block.mesh(&obstacle.look),
                "color": obstacle.look.color,
                "position": position.as_slice(),
                "turn": turn.coords.as_slice(),
            })
        })
        .collect();
    let gravity = f64::from(scene.world.gravity.length());
    let weights: Vec<f64> = scene
        .pieces
        .iter()
        .map(|piece| scene.kinds[piece.kind].dry.mass * gravity)
        .collect();
    let bodies: Vec<Value> = (0..scene.pieces.len())
        .map(|piece| {
            let look = scene.look(piece);
            json!({"mesh": block.mesh(&look), "color": look.color, "weight": weights[piece]})
        })
        .collect();

    let recordings: Vec<&Recording> = runs.iter().map(|(_, recording)| *recording).collect();
    for frame in recordings.iter().flat_map(|recording| &recording.frames) {
        assert_eq!(frame.len(), bodies.len(), "a recording of another scene");
    }
    let felt: Vec<usize> = (0..COMPONENTS.len())
        .filter(|component| is_felt(&recordings, &weights, *component))
        .collect();
    let lengths = recordings.iter().map(|recording| recording.times.len());
    let recorded = lengths.min().unwrap_or(0);
    let per_body: usize = recordings
        .iter()
        .map(|recording| {
            12 + if recording.forces.is_empty() {
                0
            } else {
                6 * felt.len()
            }
        })
        .sum();
    let stride = (recorded * bodies.len() * per_body)
        .div_ceil(MOST_BYTES)
        .max(1);
    let keys = || (0..recorded).step_by(stride);
    let range = Range::of(&recordings);
    let takes: Vec<Value> = runs
        .iter()
        .map(|(name, run)| {
            let poses = keys().flat_map(|key| &run.frames[key]);
            let words = poses.flat_map(|(place, turn)| range.pose(place, turn));
            let poses = block.add(words.map(u16::to_le_bytes));
            let forces = (!run.forces.is_empty()).then(|| {
                let all = keys().flat_map(|key| run.forces[key].iter().zip(&weights));
                let words = all.flat_map(|(force, weight)| {
                    let felt = felt.iter().flat_map(move |component| force[*component]);
                    felt.map(|x| in_weights(x, *weight))
                });
                block.add(words.map(i16::to_le_bytes))
            });
            json!({"name": name, "poses": poses, "forces": forces})
        })
        .collect();

    let times = |key: usize| recordings.first().and_then(|run| run.times.get(key));
    let interval = times(stride).or(times(recorded.saturating_sub(1)));
    let bounds = bounds(scene, &recordings);
    let header = json!({
        "title": title,
        "frames": keys().count(),
        "interval": interval,
        "low": range.low.as_slice(),
        "size": range.size.as_slice(),
        "bounds": bounds.map(|corner| [corner.x, corner.y, corner.z]),
        "gravity": [scene.world.gravity.x, scene.world.gravity.y, scene.world.gravity.z],
        "components": felt.iter().map(|i| COMPONENTS[*i]).collect::<Vec<_>>(),
        "mostWeights": MOST_WEIGHTS,
        "light": light().as_slice(),
        "eye": camera.eye.as_slice(),
        "target": camera.target.as_slice(),
        "fieldOfView": camera.field_of_view,
        "follow": following(scene, &bounds).filter(|_| follow),
        "ground": ground(scene).unwrap_or(bounds[0].y),
        "water": scene.water.is_some(),
        "meshes": block.meshes,
        "fixed": fixed,
        "bodies": bodies,
        "runs": takes,
    });
    // A "</script>" in a name would end the element.
    let header = header.to_string().replace('<', "\\u003c");
    TEMPLATE
        .replace("{{script}}", &SCRIPTS.join("\n"))
        .replace("{{header}}", &header)
        .replace("{{data}}", &BASE64_STANDARD.encode(&block.bytes))
}

/// From how far the first body is followed, m, if it is smaller than a thirtieth of where bodies go.
fn following(scene: &Scene, [low, high]: &[Vec3; 2]) -> Option<f64> {
    let look = scene.pieces.first().map(|_| scene.look(0))?;
    let vertices = look.solid.vertices().iter();
    let reach = vertices.map(Vec3::norm).fold(0.0, f64::max);
    (15.0 * reach < (high - low).norm()).then_some(16.0 * reach)
}

/// Height of the floor's top, m: of the first obstacle, which all shadows fall on.
fn ground(scene: &Scene) -> Option<f64> {
    let floor = scene.obstacles.first()?;
    let (position, turn) = pose_parts(&floor.pose);
    let corners = floor.look.solid.vertices().iter();
    let heights = corners.map(|v| (position + turn * v).y);
    heights.max_by(f64::total_cmp)
}

fn is_felt(recordings: &[&Recording], weights: &[f64], component: usize) -> bool {
    let frames = recordings.iter().flat_map(|recording| &recording.forces);
    let mut all = frames.flat_map(|frame| frame.iter().zip(weights));
    all.any(|(force, weight)| {
        let squares = force[component].map(|x| f64::from(x).powi(2));
        squares.iter().sum::<f64>().sqrt() > LEAST_WEIGHTS * weight
    })
}

fn in_weights(force: f32, weight: f64) -> i16 {
    let share = f64::from(force) / (weight * MOST_WEIGHTS);
    (share.clamp(-1.0, 1.0) * 32767.0).round() as i16
}

/// The box of all places.
struct Range {
    low: Vec3,
    size: Vec3,
}

impl Range {
    fn of(recordings: &[&Recording]) -> Self {
        let frames = recordings.iter().flat_map(|recording| &recording.frames);
        let places = || frames.clone().flatten().map(|(place, _)| place);
        let Some(first) = places().next() else {
            return Self {
                low: Vec3::zeros(),
                size: Vec3::zeros(),
            };
        };
        let low = places().fold(*first, |low, place| low.inf(place));
        let high = places().fold(*first, |high, place| high.sup(place));
        Self {
            low,
            size: high - low,
        }
    }

    fn pose(&self, place: &Vec3, turn: &Quat) -> [u16; 6] {
        let share = |axis: usize| match self.size[axis] {
            0.0 => 0.0,
            size => (place[axis] - self.low[axis]) / size,
        };
        let [x, y, z] = [0, 1, 2].map(|axis| (share(axis) * 65535.0).round() as u16);
        let [a, b, c] = smallest_three(turn);
        [x, y, z, a, b, c]
    }
}

/// All components but the greatest, which the others' squares tell: q and −q are the same attitude.
fn smallest_three(turn: &Quat) -> [u16; 3] {
    let q = turn.coords;
    let greatest = q.iamax();
    let sign = q[greatest].signum();
    let others = [1, 2, 3].map(|step| sign * q[(greatest + step) % 4]);
    let mut words = others.map(|x| {
        // The lesser components lie within ±1/√2.
        let share = 0.5 + 0.5 * x / FRAC_1_SQRT_2;
        (share.clamp(0.0, 1.0) * 32767.0).round() as u16
    });
    words[0] |= (greatest as u16 & 1) << 15;
    words[1] |= (greatest as u16 >> 1) << 15;
    words
}

/// The page's bytes, and the meshes that they hold.
#[derive(Default)]
struct Block {
    bytes: Vec<u8>,
    meshes: Vec<Value>,
    known: HashMap<*const Surface, usize>,
}

impl Block {
    /// Appends words where every kind of them may begin; returns where.
    fn add<const N: usize>(&mut self, words: impl Iterator<Item = [u8; N]>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let at = self.bytes.len();
        self.bytes.extend(words.flatten());
        at
    }

    /// Index of a look's mesh, which equal ones share.
    fn mesh(&mut self, look: &Look) -> usize {
        let solid = Arc::as_ptr(&look.solid);
        if let Some(known) = self.known.get(&solid) {
            return *known;
        }
        let mut mesh = self.triangles(look.solid.vertices(), look.solid.triangles());
        let (vertices, triangles) = look.outline();
        if (1..look.solid.triangles().len()).contains(&triangles.len()) {
            mesh["outline"] = self.triangles(&vertices, &triangles);
        }
        self.meshes.push(mesh);
        self.known.insert(solid, self.meshes.len() - 1);
        self.meshes.len() - 1
    }

    fn triangles(&mut self, vertices: &[Vec3], triangles: &[[u32; 3]]) -> Value {
        let words = vertices.iter().flat_map(|v| [v.x, v.y, v.z]);
        let at = self.add(words.map(|x| (x as f32).to_le_bytes()));
        let indices = self.add(triangles.iter().flatten().map(|i| i.to_le_bytes()));
        json!({
            "vertices": at,
            "vertexCount": vertices.len(),
            "indices": indices,
            "indexCount": 3 * triangles.len(),
        })
    }
}
