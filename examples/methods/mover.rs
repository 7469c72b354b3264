//! Bodies that fall by one of the methods.

use crate::Failure;
use crate::method::Method;
use crate::prepared::Prepared;
use crate::subject::Start;
use crate::support::recording::{Recording, RunOptions, Stepper, run};
use crate::support::scene::{Scene, pose_parts};
use crate::support::{Quat, Vec3, to_rapier};
use rapier3d_immersed::motion::path::MotionPath;
use rapier3d_immersed::motion::{Moment, Trajectory};
use rapier3d_immersed::playback::{MotionPlayer, MotionPlayers};
use rapier3d_immersed::rapier3d::math::{Rotation, Vector};
use rapier3d_immersed::rapier3d::na::UnitQuaternion;
use rapier3d_immersed::rapier3d::prelude::PhysicsWorld;
use rapier3d_immersed::training::BodyState;
use rapier3d_immersed::{Immersion, OnContact, RapierSets, preset};
use std::sync::Arc;

/// Moves a world on by one of the methods.
pub struct Mover {
    pub players: MotionPlayers,
    /// None for plain rapier.
    pub immersion: Option<Immersion>,
}

impl Stepper for Mover {
    fn step(&mut self, world: &mut PhysicsWorld) {
        let Some(immersion) = &mut self.immersion else {
            world.step();
            return;
        };
        if !self.players.is_empty() {
            let sets = &mut RapierSets::of(world);
            self.players.before_step(sets, Some(immersion));
        }
        immersion.step(world);
    }
}

/// An empty world with this step, s.
pub fn empty(prepared: &Prepared, dt: f64) -> Scene {
    let mut world = PhysicsWorld::new();
    preset::leaf_scale(&mut world.integration_parameters);
    world.integration_parameters.dt = dt as f32;
    let mut scene = Scene::new(world);
    scene.kinds = vec![prepared.subject.kind.clone()];
    scene
}

impl Mover {
    /// Releases bodies in the scene. By the graph-based method each plays a fall of its own from `height`, in the attitude
    /// that this begins with, turned to the heading of its release.
    pub fn release(
        prepared: &Prepared,
        method: Method,
        scene: &mut Scene,
        starts: &[Start],
        height: f64,
    ) -> Result<Self, Failure> {
        let subject = &prepared.subject;
        let hydro = &subject.kind.body.hydro;
        let mut mover = Self {
            players: MotionPlayers::new(),
            immersion: (method != Method::Plain).then(|| Immersion::new(subject.fluid)),
        };
        if let (Method::Stochastic, Some(immersion)) = (method, &mut mover.immersion) {
            immersion.set_turbulence(prepared.layer.clone());
        }
        let synthesizer = prepared.synthesizer(height)?;
        let body = prepared.body(method)?;
        for start in starts {
            let release = start.release;
            let turn = release.orientation(hydro);
            let player = (method == Method::Graph).then(|| {
                let path = Arc::new(synthesizer.path(start.seed));
                player(prepared, path, start)
            });
            let origin = start.place - turn * subject.kind.dry.center;
            let pose = match &player {
                Some(player) => pose_parts(&player.release(to_rapier(&subject.kind.dry.center))),
                None => (origin, turn),
            };
            scene.add_piece(0, method.color(), pose, release.spin, preset::leaf_body);
            let handle = scene.pieces[scene.pieces.len() - 1].handle;
            scene.world.bodies[handle].set_linvel(to_rapier(&release.velocity), true);
            let Some(immersion) = &mut mover.immersion else {
                continue;
            };
            immersion.insert(handle, body.clone());
            if let Some(player) = &player {
                mover.players.play(handle, player)?;
            }
            if method == Method::Pattern {
                let series = prepared.codebook.series();
                let series = &series[start.seed as usize % series.len()];
                immersion.replay(handle, series, OnContact::Restart);
            }
        }
        Ok(mover)
    }
}

/// A body's player of a path from where it is released.
pub fn player(prepared: &Prepared, path: Arc<MotionPath>, start: &Start) -> MotionPlayer {
    let axes = prepared.subject.kind.body.hydro.planform.axes;
    let q = UnitQuaternion::from_rotation_matrix(&axes)
        .coords
        .map(|x| x as f32);
    MotionPlayer {
        heading: start.release.heading as f32,
        axes: Rotation::from_xyzw(q.x, q.y, q.z, q.w),
        ..MotionPlayer::new(path, to_rapier(&start.place))
    }
}

/// Where the bodies of a crowd begin: far enough from each other, near enough for single precision.
pub fn apart(index: usize) -> Vector {
    const DISTANCE: f32 = 20.0;
    Vector::new((index % 32) as f32, 0.0, (index / 32) as f32) * DISTANCE
}

/// Lets a crowd fall in the open and records every step.
pub fn fly(
    prepared: &Prepared,
    method: Method,
    starts: &[Start],
    dt: f64,
    seconds: f64,
    height: f64,
) -> Result<Vec<Trajectory>, Failure> {
    let mut scene = empty(prepared, dt);
    let mut mover = Mover::release(prepared, method, &mut scene, starts, height)?;
    let options = RunOptions {
        seconds,
        frame_rate: 1.0 / dt,
        forces: false,
        message: method.name(),
    };
    let recording = run(&mut scene, &options, &mut mover);
    let count = starts.len();
    Ok((0..count)
        .map(|i| trajectory(prepared, &recording, i))
        .collect())
}

/// One body's fall, from its release at the origin.
pub fn trajectory(prepared: &Prepared, recording: &Recording, piece: usize) -> Trajectory {
    let kind = &prepared.subject.kind;
    let first = recording.frames[0][piece];
    let from = first.0 + first.1 * kind.dry.center;
    let moment = |(place, turn): (Vec3, Quat)| -> Moment {
        let state = BodyState {
            position: place + turn * kind.dry.center - from,
            orientation: turn,
            ..BodyState::default()
        };
        state.moment(&kind.body.hydro)
    };
    Trajectory {
        interval: recording.times[1] - recording.times[0],
        moments: recording.frames.iter().map(|f| moment(f[piece])).collect(),
    }
}
