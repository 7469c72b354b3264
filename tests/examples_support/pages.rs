//! A page for the browser holds what was recorded, in little room, and loads nothing.

use crate::animation::scene;
use crate::support::recording::{Forces, Plain, Recording, RunOptions, run};
use crate::support::scene::Scene;
use crate::support::{Quat, Vec3, gif, html};
use base64::{Engine, prelude::BASE64_STANDARD};
use rand::{Rng, RngExt, SeedableRng};
use rapier3d_immersed::rapier3d::na::Quaternion;
use rapier3d_immersed::{Fluid, Immersion};
use serde_json::Value;

/// The page's header and bytes.
struct Page {
    header: Value,
    bytes: Vec<u8>,
}

impl Page {
    fn read(page: &str) -> Self {
        let inside = |id: &str| {
            let (_, rest) = page.split_once(&format!("id=\"{id}\">")).unwrap();
            rest.split_once("</script>").unwrap().0
        };
        Self {
            header: serde_json::from_str(inside("header")).unwrap(),
            bytes: BASE64_STANDARD.decode(inside("data")).unwrap(),
        }
    }

    fn frames(&self) -> usize {
        self.header["frames"].as_u64().unwrap() as usize
    }

    fn bodies(&self) -> usize {
        self.header["bodies"].as_array().unwrap().len()
    }

    fn vector(&self, name: &str) -> Vec3 {
        Vec3::from_fn(|k, _| self.header[name][k].as_f64().unwrap())
    }

    fn word(&self, at: usize) -> u16 {
        u16::from_le_bytes([self.bytes[at], self.bytes[at + 1]])
    }

    /// Place and attitude, as the documentation of `html.rs` describes them.
    fn pose(&self, run: usize, frame: usize, body: usize) -> (Vec3, Quat) {
        let start = self.header["runs"][run]["poses"].as_u64().unwrap() as usize;
        let at = start + 12 * (frame * self.bodies() + body);
        let words: [u16; 6] = std::array::from_fn(|k| self.word(at + 2 * k));
        let share = Vec3::from_fn(|k, _| f64::from(words[k]) / 65535.0);
        let place = self.vector("low") + share.component_mul(&self.vector("size"));
        let greatest = usize::from(words[3] >> 15) + 2 * usize::from(words[4] >> 15);
        let mut q = [0.0; 4];
        for k in 0..3 {
            let share = f64::from(words[3 + k] % 32768) / 32767.0;
            q[(greatest + 1 + k) % 4] = (2.0 * share - 1.0) / 2f64.sqrt();
        }
        q[greatest] = (1.0 - q.iter().map(|x| x * x).sum::<f64>()).sqrt();
        let turn = Quat::new_normalize(Quaternion::new(q[3], q[0], q[1], q[2]));
        (place, turn)
    }

    fn force(&self, run: usize, frame: usize, body: usize, component: usize) -> Vec3 {
        let start = self.header["runs"][run]["forces"].as_u64().unwrap() as usize;
        let count = self.header["components"].as_array().unwrap().len();
        let at = start + 6 * ((frame * self.bodies() + body) * count + component);
        let weight = self.header["bodies"][body]["weight"].as_f64().unwrap();
        let unit = weight * self.header["mostWeights"].as_f64().unwrap() / 32767.0;
        Vec3::from_fn(|k, _| f64::from(self.word(at + 2 * k).cast_signed()) * unit)
    }
}

/// Any attitude with equal probability: four normal numbers, scaled (Muller 1959), here from sums of uniform ones.
fn any_turn(random: &mut impl Rng) -> Quat {
    let mut normal = || (0..12).map(|_| random.random_range(-0.5..0.5)).sum::<f64>();
    Quat::new_normalize(Quaternion::new(normal(), normal(), normal(), normal()))
}

/// As many pieces that are anywhere in a box of 9 × 2 × 4 m, in any attitude, at every frame.
fn scattered(pieces: usize, frames: usize, forces: bool) -> (Scene, Recording) {
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(3);
    let mut scene = scene();
    for i in scene.pieces.len()..pieces {
        let at = (Vec3::new(0.0, i as f64, 0.0), Quat::identity());
        scene.add_piece(0, [0.5; 3], at, Vec3::zeros(), |b| b);
    }
    let size = Vec3::new(9.0, 2.0, 4.0);
    let mut pose = || {
        let share = Vec3::from_fn(|_, _| random.random_range(-0.5..0.5));
        (share.component_mul(&size), any_turn(&mut random))
    };
    let frames: Vec<Vec<(Vec3, Quat)>> = (0..frames)
        .map(|_| (0..pieces).map(|_| pose()).collect())
        .collect();
    // Three components that are felt, as of a leaf in air.
    let force: Forces = [[1e-3; 3], [2e-3; 3], [-1e-3; 3], [0.0; 3], [0.0; 3]];
    let recording = Recording {
        times: (0..frames.len()).map(|i| i as f64 / 30.0).collect(),
        forces: if forces {
            vec![vec![force; pieces]; frames.len()]
        } else {
            Vec::new()
        },
        frames,
        fates: Vec::new(),
        falling_step: 0.0,
        landed_step: 0.0,
        wall_time: 0.0,
    };
    (scene, recording)
}

#[test]
fn poses_are_as_recorded_to_the_resolution() {
    let (scene, mut recording) = scattered(40, 60, false);
    // Attitudes at the edges of the encoding: one component is all, equal ones, both signs.
    let edges = [
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, -1.0],
        [0.5, 0.5, 0.5, 0.5],
        [-0.5, 0.5, -0.5, 0.5],
        [0.0, 1.0, -1.0, 0.0],
        [-1.0, 0.0, 0.0, 1.0],
    ];
    for (pose, [w, x, y, z]) in recording.frames[7].iter_mut().zip(edges) {
        pose.1 = Quat::new_normalize(Quaternion::new(w, x, y, z));
    }
    let page = Page::read(&html::page("", &scene, &[("one", &recording)]));
    assert_eq!((page.frames(), page.bodies()), (60, 40));
    let box_size = page.vector("size");
    let (mut farthest, mut most) = (0.0_f64, 0.0_f64);
    for (key, frame) in recording.frames.iter().enumerate() {
        for (body, (place, turn)) in frame.iter().enumerate() {
            let (read, attitude) = page.pose(0, key, body);
            farthest = farthest.max((read - place).component_div(&box_size).amax());
            most = most.max(turn.angle_to(&attitude));
        }
    }
    println!("errors: {farthest:.2e} of the box, {most:.2e} rad");
    assert!(farthest < 1.0 / 30_000.0);
    assert!(most < 1e-3);
    // Such errors are there: nothing else than the quantised words was read.
    assert!(farthest > 1e-6 && most > 1e-6);
}

#[test]
fn forces_are_as_recorded() {
    let mut scene = scene();
    let mut immersion = Immersion::new(Fluid::AIR);
    let handles: Vec<_> = scene.pieces.iter().map(|piece| piece.handle).collect();
    immersion.insert_all(handles, (*scene.kinds[0].body).clone());
    let options = RunOptions {
        seconds: 0.5,
        frame_rate: 30.0,
        forces: true,
        message: "test",
    };
    let recording = run(&mut scene, &options, &mut immersion);
    let page = Page::read(&html::page("", &scene, &[("in air", &recording)]));
    // Buoyancy is a three hundredth of a leaf's weight, and there are no thrusters.
    assert_eq!(
        page.header["components"],
        serde_json::json!(["drag", "lift", "added mass"])
    );
    let weight = 9.81 * scene.kinds[0].dry.mass;
    for (key, frame) in recording.forces.iter().enumerate() {
        for (body, force) in frame.iter().enumerate() {
            for (component, told) in force.iter().take(3).enumerate() {
                let told = Vec3::from_fn(|k, _| f64::from(told[k]));
                let read = page.force(0, key, body, component);
                assert!((read - told).amax() < 1e-3 * weight, "{read} {told}");
            }
        }
    }
    // Half a second into its fall, drag carries a good part of a leaf.
    let drag = page.force(0, page.frames() - 1, 0, 0);
    assert!(drag.y > 0.1 * weight, "{drag}");
}

#[test]
fn a_page_is_small_and_loads_nothing() {
    // 400 leaves for 10 s, with and without air.
    let (scene, immersed) = scattered(400, 301, true);
    let (_, plain) = scattered(400, 301, false);
    let runs = [("immersed", &immersed), ("plain rapier", &plain)];
    let page = html::page("</script> & \"quotes\"", &scene, &runs);
    println!("{:.2} MB", page.len() as f64 * 1e-6);
    assert!(page.len() < 8_000_000, "{}", page.len());
    assert!(!page.contains("http"), "an address");
    assert!(!page.contains("{{"), "a part of the template is left");
    // The title does not end the element that it is in.
    let read = Page::read(&page);
    assert_eq!(read.header["title"], "</script> & \"quotes\"");
    assert_eq!(read.frames(), 301);
}

#[test]
fn a_long_recording_is_thinned() {
    let (scene, recording) = scattered(1000, 4001, false);
    let page = html::page("", &scene, &[("long", &recording)]);
    // 48 MB of poses become 24 of every second one, which base64 makes 32.
    assert!(page.len() < 33_000_000, "{}", page.len());
    let page = Page::read(&page);
    assert_eq!(page.frames(), 2001);
    let interval = page.header["interval"].as_f64().unwrap();
    assert!((interval - 2.0 / 30.0).abs() < 1e-12);
    let (place, _) = page.pose(0, 1000, 5);
    assert!((place - recording.frames[2000][5].0).amax() < 9.0 / 30_000.0);
}

#[test]
fn the_gif_shows_the_run() {
    let mut scene = scene();
    let options = RunOptions {
        seconds: 0.5,
        frame_rate: 30.0,
        forces: false,
        message: "test",
    };
    let recording = run(&mut scene, &options, &mut Plain);
    let bytes = gif::animation(&scene, &[&recording, &recording]).unwrap();
    let mut decoder = ::gif::DecodeOptions::new().read_info(&bytes[..]).unwrap();
    let size = (decoder.width(), decoder.height());
    let mut delays = Vec::new();
    let mut changed = Vec::new();
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        assert_eq!((frame.width, frame.height), size);
        delays.push(frame.delay);
        let colors = frame.buffer.iter().filter(|index| **index != 255);
        changed.push(colors.count());
    }
    // Fifteen pictures per second, the last of 7/15 s.
    assert_eq!(delays.len(), 8);
    assert_eq!(delays[..7].iter().sum::<u16>(), 47);
    assert_eq!(changed[0], usize::from(size.0) * usize::from(size.1));
    assert!(
        changed[1..]
            .iter()
            .all(|count| *count > 0 && *count < changed[0] / 2)
    );
}
