//! An animation as a glTF 2.0 binary file that ordinary 3-D tools open: one mesh per kind and colour,
//! one node per piece, translations and rotations as key frames over one shared time accessor.

use super::recording::Recording;
use super::scene::{Look, Scene, pose_parts};
use super::{Quat, Vec3};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::sync::Arc;

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// Collects binary data with the views and accessors that describe it.
#[derive(Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffer {
    /// Adds an accessor with a view of its own; every component takes four bytes.
    fn add(
        &mut self,
        words: impl Iterator<Item = [u8; 4]>,
        target: Option<u32>,
        mut accessor: Value,
    ) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(words.flatten());
        let mut view = json!({
            "buffer": 0,
            "byteOffset": start,
            "byteLength": self.bytes.len() - start,
        });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        accessor["bufferView"] = self.views.len().into();
        self.views.push(view);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn floats(&mut self, values: &[f32], kind: &str, count: usize) -> usize {
        let accessor = json!({"componentType": FLOAT, "type": kind, "count": count});
        self.add(values.iter().map(|x| x.to_le_bytes()), None, accessor)
    }
}

/// The scene and its recording as the bytes of a `.glb` file.
pub fn animation(scene: &Scene, recording: &Recording) -> Vec<u8> {
    let mut buffer = Buffer::default();
    let mut meshes = Meshes::default();
    let mut nodes = Vec::new();
    for (i, obstacle) in scene.obstacles.iter().enumerate() {
        let (position, turn) = pose_parts(&obstacle.pose);
        let mesh = meshes.index(&obstacle.look, &mut buffer);
        nodes.push(node(&format!("obstacle {i}"), mesh, position, turn));
    }

    let times: Vec<f32> = recording.times.iter().map(|t| *t as f32).collect();
    let time = buffer.floats(&times, "SCALAR", times.len());
    buffer.accessors[time]["min"] = json!([times.first()]);
    buffer.accessors[time]["max"] = json!([times.last()]);
    let (mut channels, mut samplers) = (Vec::new(), Vec::new());
    for piece in 0..scene.pieces.len() {
        let keys: Vec<(Vec3, Quat)> = recording.frames.iter().map(|frame| frame[piece]).collect();
        let mesh = meshes.index(&scene.look(piece), &mut buffer);
        let Some((position, turn)) = keys.first() else {
            continue;
        };
        let target = nodes.len();
        nodes.push(node(&format!("piece {piece}"), mesh, *position, *turn));
        let translations: Vec<f32> = keys
            .iter()
            .flat_map(|(p, _)| [p.x as f32, p.y as f32, p.z as f32])
            .collect();
        let turns: Vec<f32> = continuous(keys.iter().map(|(_, q)| *q)).concat();
        for (path, kind, values) in [
            ("translation", "VEC3", translations),
            ("rotation", "VEC4", turns),
        ] {
            let output = buffer.floats(&values, kind, keys.len());
            channels.push(json!({
                "sampler": samplers.len(),
                "target": {"node": target, "path": path},
            }));
            samplers.push(json!({"input": time, "output": output, "interpolation": "LINEAR"}));
        }
    }

    let mut root = json!({
        "asset": {"version": "2.0", "generator": "rapier3d-immersed"},
        "scene": 0,
        "scenes": [{"nodes": (0..nodes.len()).collect::<Vec<_>>()}],
        "nodes": nodes,
        "meshes": meshes.meshes,
        "materials": meshes.materials,
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": buffer.bytes.len()}],
    });
    if !channels.is_empty() {
        root["animations"] = json!([{"name": "fall", "channels": channels, "samplers": samplers}]);
    }
    container(&root, buffer.bytes)
}

fn node(name: &str, mesh: usize, position: Vec3, turn: Quat) -> Value {
    json!({
        "name": name,
        "mesh": mesh,
        "translation": [position.x as f32, position.y as f32, position.z as f32],
        "rotation": components(&turn),
    })
}

/// x, y, z, w, of unit length in f32.
fn components(turn: &Quat) -> [f32; 4] {
    let q = turn.coords;
    [q.x as f32, q.y as f32, q.z as f32, q.w as f32]
}

/// Quaternions whose signs are chosen so that neighbours are close: q and −q are the same attitude,
/// but viewers interpolate along the components.
pub fn continuous(turns: impl Iterator<Item = Quat>) -> Vec<[f32; 4]> {
    let mut keys: Vec<[f32; 4]> = Vec::new();
    for turn in turns {
        let mut key = components(&turn);
        if let Some(last) = keys.last()
            && last.iter().zip(&key).map(|(a, b)| a * b).sum::<f32>() < 0.0
        {
            key = key.map(|x| -x);
        }
        keys.push(key);
    }
    keys
}

/// Meshes by solid and colour; the vertices of a solid are stored once.
#[derive(Default)]
struct Meshes {
    meshes: Vec<Value>,
    materials: Vec<Value>,
    solids: HashMap<*const rapier3d_immersed::geometry::Surface, (usize, usize)>,
    known: HashMap<(*const rapier3d_immersed::geometry::Surface, [u32; 3]), usize>,
}

impl Meshes {
    fn index(&mut self, look: &Look, buffer: &mut Buffer) -> usize {
        let solid = Arc::as_ptr(&look.solid);
        let key = (solid, look.color.map(f32::to_bits));
        if let Some(index) = self.known.get(&key) {
            return *index;
        }
        let (positions, indices) = *self
            .solids
            .entry(solid)
            .or_insert_with(|| geometry(look, buffer));
        let [r, g, b] = look.color;
        self.materials.push(json!({
            "pbrMetallicRoughness": {
                "baseColorFactor": [r, g, b, 1.0],
                "metallicFactor": 0.0,
                "roughnessFactor": 0.8,
            },
        }));
        self.meshes.push(json!({
            "primitives": [{
                "attributes": {"POSITION": positions},
                "indices": indices,
                "material": self.materials.len() - 1,
            }],
        }));
        self.known.insert(key, self.meshes.len() - 1);
        self.meshes.len() - 1
    }
}

/// Positions and indices; normals are left out, so that viewers shade the flat triangles.
fn geometry(look: &Look, buffer: &mut Buffer) -> (usize, usize) {
    let vertices: Vec<[f32; 3]> = look
        .solid
        .vertices()
        .iter()
        .map(|v| [v.x as f32, v.y as f32, v.z as f32])
        .collect();
    let bound = |pick: fn(f32, f32) -> f32, from: f32| -> Vec<f32> {
        let axis = |k: usize| vertices.iter().fold(from, |m, v| pick(m, v[k]));
        (0..3).map(axis).collect()
    };
    let accessor = json!({
        "componentType": FLOAT, "type": "VEC3", "count": vertices.len(),
        "min": bound(f32::min, f32::INFINITY), "max": bound(f32::max, f32::NEG_INFINITY),
    });
    let words = vertices.iter().flatten().map(|x| x.to_le_bytes());
    let positions = buffer.add(words, Some(ARRAY_BUFFER), accessor);
    let triangles = look.solid.triangles();
    let accessor = json!({
        "componentType": UNSIGNED_INT, "type": "SCALAR", "count": 3 * triangles.len(),
    });
    let words = triangles.iter().flatten().map(|i| i.to_le_bytes());
    let indices = buffer.add(words, Some(ELEMENT_ARRAY_BUFFER), accessor);
    (positions, indices)
}

/// Header, JSON chunk and binary chunk, each padded to four bytes.
fn container(root: &Value, mut binary: Vec<u8>) -> Vec<u8> {
    let mut text = root.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let length = 12 + 8 + text.len() + 8 + binary.len();
    let mut file = Vec::with_capacity(length);
    file.extend(b"glTF");
    for word in [2, length as u32, text.len() as u32] {
        file.extend(word.to_le_bytes());
    }
    file.extend(b"JSON");
    file.extend(text);
    file.extend((binary.len() as u32).to_le_bytes());
    file.extend(b"BIN\0");
    file.extend(binary);
    file
}
