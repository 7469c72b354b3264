//! Runs a scene and keeps what pictures, animations and summaries need.

use super::scene::{Scene, pose_parts};
use super::{Quat, Vec3, cli, from_rapier};
use rapier3d_immersed::rapier3d::prelude::{PhysicsWorld, RigidBodyHandle};
use rapier3d_immersed::{ForceBreakdown, Immersion};
use std::collections::HashMap;
use std::time::Instant;

/// What happened to one piece.
#[derive(Clone, Copy, Debug, Default)]
pub struct Fate {
    /// When it first touched something, s.
    pub landed: Option<f64>,
    /// Where its center of mass was then, m; at the end if it never did.
    pub landed_at: Vec3,
    /// Turns of its normal until then.
    pub turns: f64,
    /// Its center of mass at the end, m.
    pub end: Vec3,
    /// Whether it was asleep or slower than 1 cm/s at the end.
    pub at_rest: bool,
}

/// What moves a world on.
pub trait Stepper {
    /// One step.
    fn step(&mut self, world: &mut PhysicsWorld);

    /// What the fluid does to a body; `None` without one.
    fn forces(&self, _: &PhysicsWorld, _: RigidBodyHandle) -> Option<ForceBreakdown> {
        None
    }
}

impl Stepper for Immersion {
    fn step(&mut self, world: &mut PhysicsWorld) {
        Self::step(self, world);
    }

    fn forces(&self, world: &PhysicsWorld, body: RigidBodyHandle) -> Option<ForceBreakdown> {
        Self::forces(self, &world.bodies, body)
    }
}

/// Rapier without any fluid.
pub struct Plain;

impl Stepper for Plain {
    fn step(&mut self, world: &mut PhysicsWorld) {
        world.step();
    }
}

/// The components of a recorded force.
pub const COMPONENTS: [&str; 5] = ["drag", "lift", "added mass", "buoyancy", "thrust"];

/// A force by its [`COMPONENTS`], N, world axes.
pub type Forces = [[f32; 3]; COMPONENTS.len()];

/// A force by its [`COMPONENTS`].
pub fn components(of: &ForceBreakdown) -> Forces {
    [
        of.drag.force + of.turbulence.force,
        of.translational_lift.force + of.rotational_lift.force,
        of.added_mass.force,
        of.buoyancy.force,
        of.thrust.force,
    ]
    .map(|force| [force.x, force.y, force.z])
}

/// Poses of all pieces at equal intervals, and what else is worth knowing of a run.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    /// Times of the frames, s.
    pub times: Vec<f64>,
    /// Pose of each piece's frame, for each time.
    pub frames: Vec<Vec<(Vec3, Quat)>>,
    /// Force on each piece, for each time; empty if none were asked for.
    pub forces: Vec<Vec<Forces>>,
    /// One for each piece.
    pub fates: Vec<Fate>,
    /// Median time of a step while pieces fall, ms (steps before half of them have landed).
    pub falling_step: f64,
    /// Median time of a step thereafter, ms.
    pub landed_step: f64,
    /// Wall time of the whole run, s.
    pub wall_time: f64,
}

/// How to run a scene.
#[derive(Clone, Copy, Debug)]
pub struct RunOptions {
    /// Simulated time, s.
    pub seconds: f64,
    /// Frames recorded per second.
    pub frame_rate: f64,
    /// Whether forces are recorded, too.
    pub forces: bool,
    /// What the progress bar says.
    pub message: &'static str,
}

/// Steps the scene with `stepper` and records it.
pub fn run(scene: &mut Scene, options: &RunOptions, stepper: &mut impl Stepper) -> Recording {
    let dt = f64::from(scene.world.integration_parameters.dt);
    let steps = (options.seconds / dt).ceil() as u64;
    let per_frame = (1.0 / (options.frame_rate * dt)).round().max(1.0) as u64;
    let index: HashMap<RigidBodyHandle, usize> = scene
        .pieces
        .iter()
        .enumerate()
        .map(|(i, piece)| (piece.handle, i))
        .collect();
    let normals: Vec<Vec3> = scene
        .pieces
        .iter()
        .map(|piece| scene.kinds[piece.kind].body.hydro.planform.axes * Vec3::z())
        .collect();
    let mut recording = Recording {
        fates: vec![Fate::default(); scene.pieces.len()],
        ..Recording::default()
    };
    let (mut falling_steps, mut landed_steps) = (Vec::new(), Vec::new());
    let mut flying = scene.pieces.len();
    let bar = cli::progress(steps, options.message);
    let begin = Instant::now();
    recording.keep(0.0, scene, stepper, options.forces);
    for count in 1..=steps {
        let start = Instant::now();
        stepper.step(&mut scene.world);
        let cost = start.elapsed().as_secs_f64() * 1e3;
        if 2 * flying > scene.pieces.len() {
            falling_steps.push(cost);
        } else {
            landed_steps.push(cost);
        }
        let time = count as f64 * dt;
        for (i, fate) in recording.fates.iter_mut().enumerate() {
            if fate.landed.is_none() {
                let body = &scene.world.bodies[scene.pieces[i].handle];
                let normal = pose_parts(body.position()).1 * normals[i];
                fate.turns +=
                    from_rapier(body.angvel()).cross(&normal).norm() * dt / std::f64::consts::TAU;
            }
        }
        if flying > 0 {
            flying -= recording.find_landings(time, scene, &index);
        }
        if count % per_frame == 0 {
            recording.keep(time, scene, stepper, options.forces);
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    recording.wall_time = begin.elapsed().as_secs_f64();
    recording.falling_step = median(falling_steps);
    recording.landed_step = median(landed_steps);
    for (fate, piece) in recording.fates.iter_mut().zip(&scene.pieces) {
        let body = &scene.world.bodies[piece.handle];
        fate.end = from_rapier(body.center_of_mass());
        fate.at_rest = body.is_sleeping() || body.linvel().length() < 0.01;
        if fate.landed.is_none() {
            fate.landed_at = fate.end;
        }
    }
    recording
}

/// The middle value; 0 of none.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

impl Recording {
    fn keep(&mut self, time: f64, scene: &Scene, stepper: &impl Stepper, with_forces: bool) {
        self.times.push(time);
        let handles = || scene.pieces.iter().map(|piece| piece.handle);
        let poses = handles().map(|handle| pose_parts(scene.world.bodies[handle].position()));
        self.frames.push(poses.collect());
        if with_forces {
            // Before its first step, the fluid knows of no body.
            let force = |handle| stepper.forces(&scene.world, handle).unwrap_or_default();
            let forces = handles().map(|handle| components(&force(handle)));
            self.forces.push(forces.collect());
        }
    }

    /// Notes first contacts with anything that stands or has landed; returns how many.
    fn find_landings(
        &mut self,
        time: f64,
        scene: &Scene,
        index: &HashMap<RigidBodyHandle, usize>,
    ) -> usize {
        let piece_of = |collider| {
            let parent = scene.world.colliders.get(collider)?.parent()?;
            index.get(&parent).copied()
        };
        let mut landings = 0;
        for pair in scene.world.contact_pairs() {
            if !pair.has_any_active_contact() {
                continue;
            }
            let both = [piece_of(pair.collider1), piece_of(pair.collider2)];
            // Two pieces that meet in the air have not landed.
            let grounded = |i: Option<usize>| i.is_none_or(|i| self.fates[i].landed.is_some());
            if !(grounded(both[0]) || grounded(both[1])) {
                continue;
            }
            for i in both.into_iter().flatten() {
                let fate = &mut self.fates[i];
                if fate.landed.is_none() {
                    fate.landed = Some(time);
                    let body = &scene.world.bodies[scene.pieces[i].handle];
                    fate.landed_at = from_rapier(body.center_of_mass());
                    landings += 1;
                }
            }
        }
        landings
    }
}
