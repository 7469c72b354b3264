//! A leaf that follows a drawn line.

use crate::support::Vec3;
use rapier3d_immersed::Immersion;
use rapier3d_immersed::motion::Sketch;
use rapier3d_immersed::rapier3d::prelude::{RigidBodyHandle, RigidBodySet};
use rapier3d_immersed::training::{BodyState, Experiment, FollowParams, SketchFollower};

/// Time between the points that a drawn line is followed through, s.
const SPACING: f64 = 0.1;
/// Least descent of a line, m.
const LEAST_DESCENT: f64 = 0.1;
/// A search of 7 ms or so per interval of 50 ms.
const SAMPLES: usize = 64;
const ROUNDS: usize = 3;

/// How far a leaf has come along its line.
#[derive(Clone)]
pub struct Followed {
    follower: SketchFollower,
    sketch: Sketch,
    dt: f64,
    steps: usize,
    sum: f64,
    largest: f64,
}

impl Followed {
    /// A leaf for a line.
    ///
    /// # Errors
    /// If the leaf cannot be released on it.
    pub fn new(
        sketch: Sketch,
        leaf: &Experiment,
        immersion: &Immersion,
        seed: u64,
    ) -> Result<Self, String> {
        let params = FollowParams {
            samples: SAMPLES,
            rounds: ROUNDS,
            seed,
            ..FollowParams::default()
        };
        let follower = SketchFollower::new(&sketch, leaf, immersion, &params)
            .map_err(|error| error.to_string())?;
        Ok(Self {
            follower,
            sketch,
            dt: leaf.dt,
            steps: 0,
            sum: 0.0,
            largest: 0.0,
        })
    }

    /// The state in which the leaf has to begin.
    pub fn release(&self) -> BodyState {
        self.follower.release_state()
    }

    /// The line that is followed, in time.
    pub fn sketch(&self) -> &Sketch {
        &self.sketch
    }

    /// Whether the line is at its end.
    pub fn is_over(&self) -> bool {
        self.steps >= self.follower.steps()
    }

    /// Mean and largest distance from the line so far, at equal times, m; `None` before the first step.
    pub fn distances(&self) -> Option<[f64; 2]> {
        let counted = self.steps.min(self.follower.steps());
        (counted > 0).then(|| [self.sum / counted as f64, self.largest])
    }

    pub(crate) fn before_step(
        &mut self,
        handle: RigidBodyHandle,
        bodies: &RigidBodySet,
        immersion: &mut Immersion,
    ) {
        self.follower.before_step(handle, bodies, immersion);
    }

    pub(crate) fn after_step(&mut self, place: &Vec3) {
        self.steps += 1;
        if self.steps <= self.follower.steps() {
            let distance = (place - self.sketch.at(self.steps as f64 * self.dt)).norm();
            self.sum += distance;
            self.largest = self.largest.max(distance);
        }
    }
}

/// A line through these points, m, that is followed at a constant speed, in the time that the leaf takes for its descent.
///
/// # Errors
/// What of the line cannot be followed.
pub fn sketch(points: &[[f64; 3]], leaf: &Experiment) -> Result<Sketch, String> {
    let wrong = |error: rapier3d_immersed::Error| error.to_string();
    let line: Vec<Vec3> = points.iter().map(|p| Vec3::from(*p)).collect();
    let [first, .., last] = &line[..] else {
        return Err("a line has two points at least".into());
    };
    if first.y - last.y < LEAST_DESCENT {
        return Err(format!(
            "a leaf cannot climb: the line must end {LEAST_DESCENT} m lower than it begins"
        ));
    }
    let seconds = Sketch::landing(leaf, *first, &[], *last)
        .map_err(wrong)?
        .duration();
    let mut ways = vec![0.0];
    for pair in line.windows(2) {
        ways.push(ways[ways.len() - 1] + (pair[1] - pair[0]).norm());
    }
    let whole = ways[ways.len() - 1];
    let count = (seconds / SPACING).ceil().max(1.0);
    let at = |index: usize| {
        let share = index as f64 / count;
        let way = share * whole;
        let i = ways.partition_point(|w| *w < way).clamp(1, line.len() - 1);
        let piece = (ways[i] - ways[i - 1]).max(1e-12);
        let place = line[i - 1].lerp(&line[i], (way - ways[i - 1]) / piece);
        (share * seconds, place)
    };
    Sketch::new((0..=count as usize).map(at).collect()).map_err(wrong)
}
