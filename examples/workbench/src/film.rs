//! A film of what happens, as a page, a GIF or a glTF file.

use crate::settings::Fluids;
use crate::state::State;
use crate::support::recording::{Fate, Forces, Recording, components};
use crate::support::scene::{Scene, pose_parts};
use crate::support::{Quat, Vec3, gif, glb, html};
use rapier3d_immersed::preset;
use rapier3d_immersed::rapier3d::math::Vector;
use rapier3d_immersed::rapier3d::prelude::PhysicsWorld;
use std::collections::BTreeMap;
use std::path::Path;

/// Steps between two pictures: 30 in a second.
const INTERVAL: u64 = 8;
/// Side of the ground and of the water in a film, m.
const GROUND: f64 = 8.0;
/// Linear RGB of the water.
const WATER: [f32; 3] = [0.10, 0.20, 0.22];

struct Frame {
    step: u64,
    /// By the number of the body.
    bodies: BTreeMap<u64, ((Vec3, Quat), Forces)>,
}

/// What has happened since a film was begun.
pub struct Film {
    frames: Vec<Frame>,
}

impl Film {
    /// A film that begins now.
    pub fn begin(state: &State) -> Self {
        let mut film = Self { frames: Vec::new() };
        film.push(state);
        film
    }

    /// How long it is, s.
    pub fn length(&self) -> f64 {
        (self.frames.len() - 1) as f64 * INTERVAL as f64 * f64::from(preset::LEAF_DT)
    }

    /// Keeps a moment if it is due, and after those that are kept.
    pub fn keep(&mut self, state: &State) {
        let [first, last] = [0, self.frames.len() - 1].map(|i| self.frames[i].step);
        if state.step > last && (state.step - first).is_multiple_of(INTERVAL) {
            self.push(state);
        }
    }

    /// Forgets what is after a step; before its beginning the film begins there.
    pub fn cut(&mut self, step: u64) {
        self.frames.retain(|frame| frame.step <= step);
        if self.frames.is_empty() {
            self.frames.push(Frame {
                step,
                bodies: BTreeMap::new(),
            });
        }
    }

    fn push(&mut self, state: &State) {
        let bodies = state.bodies.iter().enumerate().filter_map(|(index, body)| {
            let rapier = &state.world().bodies[state.handle(index)?];
            let forces = components(&state.forces(index).unwrap_or_default());
            Some((body.id, (pose_parts(rapier.position()), forces)))
        });
        self.frames.push(Frame {
            step: state.step,
            bodies: bodies.collect(),
        });
    }

    /// The film in the format that the name of the file has. It shows the bodies that there are now; before one was placed it
    /// stands where it was.
    ///
    /// # Errors
    /// If the name has no format that is known, or there is nothing to show.
    pub fn file(&self, path: &Path, state: &State) -> Result<Vec<u8>, String> {
        if state.bodies.is_empty() || self.frames.len() < 2 {
            return Err("a film needs a body, and some time".into());
        }
        let scene = scene(state);
        let level = match state.settings.fluids {
            Fluids::Pond => Vec3::y() * state.settings.level,
            Fluids::Air | Fluids::Water => Vec3::zeros(),
        };
        let recording = self.recording(state, &level);
        match path.extension().and_then(|kind| kind.to_str()) {
            Some("html") => Ok(html::page("Workbench", &scene, &[("bench", &recording)]).into()),
            Some("glb") => Ok(glb::animation(&scene, &recording)),
            Some("gif") => gif::animation(&scene, &[&recording]).map_err(|error| error.to_string()),
            _ => Err("a film is a .html, .gif or .glb file".into()),
        }
    }

    fn recording(&self, state: &State, level: &Vec3) -> Recording {
        let interval = INTERVAL as f64 * f64::from(preset::LEAF_DT);
        let track = |index: usize, id: &u64| {
            let known = self.frames.iter().find_map(|frame| frame.bodies.get(id));
            // One that was placed after the last picture is where it is now.
            let now = || {
                Some(pose_parts(
                    state.world().bodies[state.handle(index)?].position(),
                ))
            };
            let at_rest = Forces::default();
            let mut last = known
                .copied()
                .or_else(|| Some((now()?, at_rest)))
                .unwrap_or_default();
            let track = self
                .frames
                .iter()
                .map(move |frame| match frame.bodies.get(id) {
                    Some(now) => {
                        last = *now;
                        *now
                    }
                    None => (last.0, at_rest),
                });
            track.collect::<Vec<_>>()
        };
        let bodies = state.bodies.iter().enumerate();
        let tracks: Vec<_> = bodies.map(|(index, body)| track(index, &body.id)).collect();
        let moments = 0..self.frames.len();
        Recording {
            times: moments.clone().map(|k| k as f64 * interval).collect(),
            frames: moments
                .clone()
                .map(|k| {
                    let poses = tracks.iter().map(|track| track[k].0);
                    poses.map(|(place, turn)| (place - level, turn)).collect()
                })
                .collect(),
            forces: moments
                .map(|k| tracks.iter().map(|track| track[k].1).collect())
                .collect(),
            fates: vec![Fate::default(); state.bodies.len()],
            falling_step: 0.0,
            landed_step: 0.0,
            wall_time: 0.0,
        }
    }
}

/// The scene to look at; over a pond, the water's surface is at y = 0, as the pictures want it.
fn scene(state: &State) -> Scene {
    let mut scene = Scene::new(PhysicsWorld::new());
    let from = &state.scene;
    scene.kinds = from.kinds.clone();
    scene.pieces = from.pieces.clone();
    scene.colors = from.colors.clone();
    let ground =
        |y: f32| rapier3d_immersed::rapier3d::math::Pose::from_translation(Vector::Y * (y - 0.05));
    let size = [GROUND, 0.1, GROUND];
    match state.settings.fluids {
        Fluids::Pond => {
            scene.add_box(
                ground(-state.settings.level as f32),
                size,
                crate::state::SAND,
            );
            scene.add_water([GROUND, GROUND], WATER);
        }
        Fluids::Air | Fluids::Water => scene.add_box(ground(0.0), size, crate::state::SAND),
    }
    scene
}
