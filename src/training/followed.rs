//! How finely a sketch is followed, and what comes of it.

use super::experiment::Release;
use crate::error::Error;
use crate::motion::{ControlSeries, Sketch};
use rapier3d::na::Vector3;

/// How a sketch is followed.
///
/// ```
/// use rapier3d_immersed::training::FollowParams;
///
/// // A search that takes a quarter of the time.
/// let coarse = FollowParams { samples: 48, rounds: 2, ..FollowParams::default() };
/// assert!(coarse.elites < coarse.samples);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FollowParams {
    /// Time that a control is held, s (default 1/20).
    pub interval: f64,
    /// Intervals looked ahead (default 10).
    pub horizon: usize,
    /// Sequences that are tried in a round (default 96).
    pub samples: usize,
    /// Sequences that are kept of a round (default 8).
    pub elites: usize,
    /// Rounds per interval (default 4).
    pub rounds: usize,
    /// Largest factor on the drag, and on the lifts of either sign (default π).
    pub limit: f64,
    /// Whether lifts may also be reversed (default false: the thesis's parameters are positive).
    pub reverse_lifts: bool,
    /// Seed of the search (default 1).
    pub seed: u64,
}

impl Default for FollowParams {
    fn default() -> Self {
        Self {
            interval: 1.0 / 20.0,
            horizon: 10,
            samples: 96,
            elites: 8,
            rounds: 4,
            limit: std::f64::consts::PI,
            reverse_lifts: false,
            seed: 1,
        }
    }
}

impl FollowParams {
    pub(super) fn check(&self) -> Result<(), Error> {
        Error::check_positive("interval", self.interval)?;
        Error::check_range("horizon", self.horizon as f64, 1.0, 1e3)?;
        Error::check_range("samples", self.samples as f64, 2.0, 1e6)?;
        Error::check_range("elites", self.elites as f64, 1.0, self.samples as f64)?;
        Error::check_range("rounds", self.rounds as f64, 1.0, 1e3)?;
        Error::check_range("limit", self.limit, 0.0, 100.0)?;
        Ok(())
    }
}

/// How a sketch was followed.
#[derive(Clone, Debug, PartialEq)]
pub struct Followed {
    /// The release: of the body's own frame at the sketch's first point.
    pub release: Release,
    /// The controls.
    pub series: ControlSeries,
    /// Where the body was in rapier, at every time step from the release on, m.
    pub path: Vec<Vector3<f64>>,
    /// Mean distance from the sketch at equal times, m.
    pub mean_distance: f64,
    /// Largest distance from the sketch, m.
    pub largest_distance: f64,
    /// Distance from the sketch at each of its points, m.
    pub at_points: Vec<f64>,
}

impl Followed {
    /// Distances of a path, in steps of `dt`, from its sketch.
    pub(super) fn of(
        sketch: &Sketch,
        release: Release,
        series: ControlSeries,
        path: Vec<Vector3<f64>>,
        dt: f64,
    ) -> Self {
        let distance = |index: usize| (path[index] - sketch.at(index as f64 * dt)).norm();
        let within = (sketch.duration() / dt).floor() as usize + 1;
        let distances: Vec<f64> = (0..within.min(path.len())).map(distance).collect();
        let at_points = sketch.points().iter().map(|(time, point)| {
            let index = (time / dt).round() as usize;
            (path[index.min(path.len() - 1)] - point).norm()
        });
        Self {
            release,
            series,
            mean_distance: distances.iter().sum::<f64>() / distances.len() as f64,
            largest_distance: distances.iter().copied().fold(0.0, f64::max),
            at_points: at_points.collect(),
            path,
        }
    }
}
