//! Films any world: its bodies as their colliders make them, what is fixed, and the lines between joints.

use super::film::{Film, FilmArgs};
use super::options::Out;
use super::recording::{Recording, components};
use super::scene::{Kind, Look, Obstacle, Scene, corners, pose_parts, surface_of};
use super::sheet::Camera;
use super::{Quat, Vec3, from_rapier};
use rapier3d_immersed::Immersion;
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::geometry::{SharedShape, TypedShape};
use rapier3d_immersed::rapier3d::math::Pose;
use rapier3d_immersed::rapier3d::prelude::{
    ImpulseJointHandle, PhysicsWorld, RigidBody, RigidBodyHandle,
};
use std::path::PathBuf;
use std::sync::Arc;

/// Linear RGB of what moves, in turn, of what is fixed, and of lines.
const COLORS: [[f32; 3]; 4] = [
    [0.62, 0.24, 0.04],
    [0.06, 0.24, 0.52],
    [0.16, 0.36, 0.10],
    [0.55, 0.42, 0.06],
];
const FIXED: [f32; 3] = [0.42, 0.44, 0.47];
const LINE: [f32; 3] = [0.10, 0.10, 0.12];
/// Thickness of a line over its length, and the shortest that is drawn, m.
const SLENDER: f64 = 0.006;
const SHORTEST: f64 = 0.02;

/// So many bodies are few.
const FEW: usize = 6;

/// A joint that is drawn as a straight line between its anchors.
struct Line {
    joint: ImpulseJointHandle,
}

/// A film that is being taken.
pub struct Reel {
    scene: Scene,
    lines: Vec<Line>,
    frame_rate: f64,
    takes: Vec<Take>,
}

/// One run.
struct Take {
    name: String,
    steps: usize,
    handles: Vec<RigidBodyHandle>,
    recording: Recording,
}

impl Reel {
    /// Looks at a world's bodies, so many times per second from now on; those that have no colliders are not seen.
    pub fn new(world: &PhysicsWorld, frame_rate: f64) -> Self {
        let mut empty = PhysicsWorld::new();
        empty.gravity = world.gravity;
        let mut scene = Scene::new(empty);
        for (_, body) in world.bodies.iter() {
            let Some(solid) = looks(world, body) else {
                continue;
            };
            if body.is_fixed() {
                scene.obstacles.push(Obstacle {
                    pose: *body.position(),
                    look: look(Arc::new(solid), FIXED),
                });
            } else {
                let color = COLORS[scene.pieces.len() % COLORS.len()];
                add(&mut scene, solid, body.mass().into(), color);
            }
        }
        // The page takes the first obstacle for the floor: the one that is widest.
        let width = |obstacle: &Obstacle| {
            let [low, high] = corners(&obstacle.look.solid);
            let size = high - low;
            size.x * size.z
        };
        scene
            .obstacles
            .sort_by(|a, b| width(b).total_cmp(&width(a)));
        let lines = lines(world, &mut scene);
        Self {
            scene,
            lines,
            frame_rate,
            takes: Vec::new(),
        }
    }

    /// Shows of what is fixed only these.
    #[must_use]
    pub fn showing(mut self, shown: impl Fn(&Surface) -> bool) -> Self {
        self.scene
            .obstacles
            .retain(|obstacle| shown(&obstacle.look.solid));
        self
    }

    /// The surface of water at y = 0 that is to be seen, of `size` along x and z, m.
    #[must_use]
    pub fn with_water(mut self, size: [f64; 2]) -> Self {
        self.scene.add_water(size, [0.10, 0.22, 0.30]);
        self
    }

    /// A floor at a height, m, that is to be seen, of `size` along x and z, m.
    #[must_use]
    pub fn with_floor(mut self, height: f64, size: [f64; 2]) -> Self {
        let place = super::to_rapier(&Vec3::new(0.0, height - 0.01, 0.0));
        let size = [size[0], 0.02, size[1]];
        self.scene
            .add_box(Pose::from_translation(place), size, [0.55, 0.52, 0.46]);
        // The last one added is the first one seen.
        self.scene.obstacles.rotate_right(1);
        self
    }

    /// Begins a run in a world of the same bodies.
    pub fn take(&mut self, name: &str, world: &PhysicsWorld) {
        let all = world.bodies.iter();
        let handles = all.filter(|(_, body)| !body.is_fixed() && looks(world, body).is_some());
        self.takes.push(Take {
            name: name.to_owned(),
            steps: 0,
            handles: handles.map(|(handle, _)| handle).collect(),
            recording: Recording::default(),
        });
    }

    /// Looks at the world: once before its first step and once after each.
    pub fn keep(&mut self, world: &PhysicsWorld, immersion: Option<&Immersion>) {
        if self.takes.is_empty() {
            self.take("run", world);
        }
        let dt = f64::from(world.integration_parameters.dt);
        let every = (1.0 / (self.frame_rate * dt)).round().max(1.0) as usize;
        let take = self.takes.last_mut().expect("one has begun");
        let step = take.steps;
        take.steps += 1;
        if !step.is_multiple_of(every) {
            return;
        }
        let mut places: Vec<(Vec3, Quat)> = take
            .handles
            .iter()
            .map(|handle| pose_parts(world.bodies[*handle].position()))
            .collect();
        places.extend(self.lines.iter().map(|line| line.place(world)));
        let recording = &mut take.recording;
        recording.times.push(dt * step as f64);
        if let Some(immersion) = immersion {
            let force = |handle: &RigidBodyHandle| {
                immersion.forces(&world.bodies, *handle).unwrap_or_default()
            };
            let mut forces: Vec<_> = take.handles.iter().map(|h| components(&force(h))).collect();
            forces.resize(places.len(), Default::default());
            recording.forces.push(forces);
        }
        recording.frames.push(places);
    }

    /// Steps the immersed world for so many seconds and films it.
    pub fn shoot(&mut self, world: &mut PhysicsWorld, immersion: &mut Immersion, seconds: f64) {
        let steps = (seconds / f64::from(world.integration_parameters.dt)).round() as usize;
        self.keep(world, Some(immersion));
        for _ in 0..steps {
            immersion.step(world);
            self.keep(world, Some(immersion));
        }
    }

    /// Writes the film; returns where its files are.
    pub fn write(
        &self,
        (name, title): (&str, &str),
        camera: Option<Camera>,
        out: &Out,
        options: &FilmArgs,
    ) -> Vec<PathBuf> {
        let runs: Vec<(&str, &Recording)> = self
            .takes
            .iter()
            .map(|take| (take.name.as_str(), &take.recording))
            .collect();
        Film {
            name,
            title,
            scene: &self.scene,
            runs: &runs,
            camera,
            // Among many, none is the one to look at.
            follow: camera.is_none() && self.scene.pieces.len() - self.lines.len() <= FEW,
        }
        .write(out, options)
    }

    /// What was recorded, run by run.
    pub fn recordings(&self) -> impl Iterator<Item = (&str, &Recording)> {
        self.takes
            .iter()
            .map(|take| (take.name.as_str(), &take.recording))
    }

    /// What is seen.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }
}

/// Adds a piece, of a kind that is there if one looks the same.
fn add(scene: &mut Scene, solid: Surface, mass: f64, color: [f32; 3]) {
    let same = |kind: &Kind| {
        kind.dry.mass == mass
            && kind.solid.vertices() == solid.vertices()
            && kind.solid.triangles() == solid.triangles()
    };
    let kind = scene.kinds.iter().position(same).unwrap_or_else(|| {
        scene.kinds.push(Kind::seen(solid, mass));
        scene.kinds.len() - 1
    });
    scene.add_seen(kind, color);
}

fn look(solid: Arc<Surface>, color: [f32; 3]) -> Look {
    Look {
        solid,
        color,
        faces: Arc::new(Vec::new()),
        ball: None,
    }
}

/// All colliders of a body in its frame.
fn looks(world: &PhysicsWorld, body: &RigidBody) -> Option<Surface> {
    let mut all: Option<Surface> = None;
    for handle in body.colliders() {
        let collider = &world.colliders[*handle];
        let place = collider
            .position_wrt_parent()
            .copied()
            .unwrap_or(Pose::IDENTITY);
        for (pose, shape) in simple(place, collider.shared_shape()) {
            let Some(surface) = drawn(&shape) else {
                continue;
            };
            let (at, turn) = pose_parts(&pose);
            let placed = surface.map(|v| at + turn * v);
            match &mut all {
                Some(all) => all.append(&placed),
                None => all = Some(placed),
            }
        }
    }
    all
}

/// A shape, or the shapes of a compound.
fn simple(pose: Pose, shape: &SharedShape) -> Vec<(Pose, SharedShape)> {
    match shape.as_compound() {
        Some(compound) => {
            let shapes = compound.shapes().iter();
            shapes
                .map(|(at, shape)| (pose * *at, shape.clone()))
                .collect()
        }
        None => vec![(pose, shape.clone())],
    }
}

/// A shape's surface, coarser than the fluid feels it where it is round; none of what has no inside.
fn drawn(shape: &SharedShape) -> Option<Surface> {
    const AROUND: u32 = 24;
    match shape.as_typed_shape() {
        TypedShape::Ball(ball) => Some(surface_of(ball.to_trimesh(AROUND, AROUND / 2))),
        _ => Surface::from_shape(shape.as_ref()).ok(),
    }
}

/// Joints between anchors that are apart, as thin solids along y.
fn lines(world: &PhysicsWorld, scene: &mut Scene) -> Vec<Line> {
    let mut lines = Vec::new();
    for (joint, _) in world.impulse_joints.iter() {
        let line = Line { joint };
        let Some([from, to]) = line.ends(world) else {
            continue;
        };
        let length = (to - from).norm();
        if length < SHORTEST {
            continue;
        }
        let half = (0.5 * length) as f32;
        let thin = (0.5 * SLENDER * length).min(0.004) as f32;
        let shape = SharedShape::cuboid(thin, half, thin);
        let solid = surface_of(shape.as_cuboid().expect("a box").to_trimesh());
        // Of some mass, because a force is told in weights; none acts on it.
        add(scene, solid, 1.0, LINE);
        lines.push(line);
    }
    lines
}

impl Line {
    /// Where it is tied, m; none if the joint is gone.
    fn ends(&self, world: &PhysicsWorld) -> Option<[Vec3; 2]> {
        let joint = world.impulse_joints.get(self.joint)?;
        let end = |body, at| Some(from_rapier(*world.bodies.get(body)?.position() * at));
        let first = end(joint.body1(), joint.data.local_anchor1())?;
        let second = end(joint.body2(), joint.data.local_anchor2())?;
        Some([first, second])
    }

    fn place(&self, world: &PhysicsWorld) -> (Vec3, Quat) {
        let Some([from, to]) = self.ends(world) else {
            return (Vec3::zeros(), Quat::identity());
        };
        let turn = Quat::rotation_between(&Vec3::y(), &(to - from)).unwrap_or_default();
        (0.5 * (from + to), turn)
    }
}
