//! Control by sketch: a series of control parameters and a release that make a body follow a path drawn
//! by a user, through rapier (thesis § 7.3).
//!
//! # How
//! What a control does to a falling body a second later is chaotic, so that one long optimisation over the
//! whole fall has no useful gradient. The path is therefore followed window by window, a short horizon
//! ahead (receding horizon): at every interval sequences of controls are drawn around the
//! best so far, tried with the free body, and the best ones kept (cross-entropy method); the first control
//! of the best sequence is then applied **in rapier**, and the next window begins from where rapier got.
//! The series that is returned is the one that rapier was given: replayed from the same release in a world
//! with the same time step, the body takes the same path.
//!
//! Besides the release's velocity and heading only the body's three force factors are steered: nothing
//! pushes the body, and contacts go on.
//!
//! Measured (test and example `patterns`) with two leaves of 7.3 cm and sketches of five points over two
//! seconds (swing, glide, helix): mean distances of 1.2 to 5.4 cm, in about half a second each.

use super::experiment::{Experiment, Release};
use super::in_world::{BodyInWorld, BodyState};
use crate::dynamics::FreeBody;
use crate::error::Error;
use crate::flow::{FlowSample, Uniform};
use crate::hydro::viscous::ForceFactors;
use crate::motion::{ControlSeries, DimensionlessNumbers, Sketch};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;
use rapier3d::geometry::ColliderBuilder;
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
    fn check(&self) -> Result<(), Error> {
        Error::check_positive("interval", self.interval)?;
        Error::check_range("horizon", self.horizon as f64, 1.0, 1e3)?;
        Error::check_range("samples", self.samples as f64, 2.0, 1e6)?;
        Error::check_range("elites", self.elites as f64, 1.0, self.samples as f64)?;
        Error::check_range("rounds", self.rounds as f64, 1.0, 1e3)?;
        Error::check_range("limit", self.limit, 0.0, 100.0)?;
        Ok(())
    }
}

/// Headings of the release that are tried.
const HEADINGS: u32 = 8;

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

impl Sketch {
    /// "Land here, pass there": from `start` through the `passes` to `landing`, at the pace at which the
    /// body falls broadside; times are shared out by descent.
    ///
    /// # Errors
    /// Those of [`Sketch::new`] and [`DimensionlessNumbers::of`]; [`Error::InvalidParameter`] if a point is
    /// not below the one before.
    ///
    /// ```
    /// use rapier3d_immersed::ThesisLaw;
    /// use rapier3d_immersed::motion::Sketch;
    /// use rapier3d_immersed::rapier3d::na::Vector3;
    /// use rapier3d_immersed::training::Experiment;
    ///
    /// let leaf = Experiment::thesis_leaf(ThesisLaw::new(ThesisLaw::ZIGZAG))?;
    /// let (start, passes) = (Vector3::y() * 2.0, [Vector3::new(0.3, 1.0, 0.0)]);
    /// let sketch = Sketch::landing(&leaf, start, &passes, Vector3::zeros())?;
    /// // The first meter takes as long as the second.
    /// assert!((sketch.at(0.5 * sketch.duration()) - passes[0]).norm() < 1e-9);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn landing(
        experiment: &Experiment,
        start: Vector3<f64>,
        passes: &[Vector3<f64>],
        landing: Vector3<f64>,
    ) -> Result<Self, Error> {
        let hydro = &experiment.body.hydro;
        let numbers = DimensionlessNumbers::of(
            hydro,
            &experiment.mass,
            &experiment.fluid,
            experiment.gravity,
        )?;
        let speed = Error::check_positive("speed of descent", numbers.broadside_descent())?;
        let mut points = vec![(0.0, start)];
        let (mut time, mut last) = (0.0, start);
        for point in passes.iter().chain(std::iter::once(&landing)) {
            let descent = last.y - point.y;
            Error::check(
                "height of a point",
                point.y,
                descent > 0.0,
                "below the one before",
            )?;
            time += descent / speed;
            points.push((time, *point));
            last = *point;
        }
        Self::new(points)
    }

    /// Finds a release and a series with which the body of `experiment`, in rapier with this `collider`,
    /// follows this path at the experiment's time step. Release angle and spin are the experiment's, the
    /// velocity is that of the path, and the heading the best of eight.
    ///
    /// A path that cannot be followed is no error: the distances tell. Bodies cannot climb, and turn only as
    /// their lifts let them.
    ///
    /// ```
    /// use rapier3d_immersed::motion::Sketch;
    /// use rapier3d_immersed::rapier3d::{na::Vector3, prelude::*};
    /// use rapier3d_immersed::training::{Experiment, FollowParams};
    /// use rapier3d_immersed::{DryMass, Fluid, HydroProperties};
    ///
    /// let mut world = PhysicsWorld::new();
    /// let collider = ColliderBuilder::cuboid(0.0365, 0.00015, 0.021).density(400.0);
    /// let (leaf, _) = world.insert(RigidBodyBuilder::dynamic(), collider.clone());
    /// let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, leaf)?;
    /// let mass = DryMass::of_body(&world.bodies, &world.colliders, leaf)?;
    /// let experiment = Experiment::new(hydro, mass, Fluid::AIR);
    ///
    /// let end = Vector3::new(0.15, -0.4, 0.0);
    /// let sketch = Sketch::new(vec![(0.0, Vector3::zeros()), (0.5, end)])?;
    /// let params = FollowParams { samples: 32, rounds: 2, ..FollowParams::default() };
    /// let followed = sketch.follow(&experiment, collider, &params)?;
    /// assert!(followed.mean_distance < 0.073); // the leaf's length
    /// // At run time: release the leaf as `followed.release` says and replay `followed.series`.
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] or [`Error::OutOfRange`] names a parameter that cannot be; those of
    /// [`Experiment::released`].
    pub fn follow(
        &self,
        experiment: &Experiment,
        collider: ColliderBuilder,
        params: &FollowParams,
    ) -> Result<Followed, Error> {
        params.check()?;
        let steps = (params.interval / experiment.dt).round();
        Error::check_range("interval / dt", steps, 1.0, 1e6)?;
        let steps = steps as usize;
        let mut random = Pcg64Mcg::seed_from_u64(params.seed);
        let search = Search {
            sketch: self,
            gravity: experiment.gravity_vector(),
            flow: experiment.flow(),
            dt: experiment.dt,
            steps,
            params,
        };
        let first = vec![[1.0; 3]; params.horizon];
        let mut choice: Option<(f64, Release, FreeBody)> = None;
        for turn in 0..HEADINGS {
            let release = Release {
                velocity: self.velocity(0),
                heading: f64::from(turn) * std::f64::consts::TAU / f64::from(HEADINGS),
                ..experiment.release
            };
            let experiment = Experiment {
                release,
                ..experiment.clone()
            };
            let mut trial = experiment.released()?;
            trial.position = self.points()[0].1;
            let (cost, _) = search.best(&trial, 0.0, &mut first.clone(), &mut random);
            if choice.as_ref().is_none_or(|(least, ..)| cost < *least) {
                choice = Some((cost, release, trial));
            }
        }
        let (_, release, mut trial) = choice.expect("there is at least one heading");
        let state = BodyState {
            position: self.points()[0].1,
            orientation: release.orientation(&experiment.body.hydro),
            velocity: release.velocity,
            spin: release.spin,
        };
        let (body, fluid) = (experiment.body.clone(), experiment.fluid);
        let (dt, gravity) = (experiment.dt, experiment.gravity);
        let mut rapier = BodyInWorld::with_collider(body, collider, fluid, &state, dt, gravity)?;
        rapier.immersion.integrator = experiment.integrator;
        if experiment.wind != Vector3::zeros() {
            let velocity = search.flow.velocity;
            rapier.immersion.set_flow(Uniform { velocity });
        }
        let count = (self.duration() / (steps as f64 * experiment.dt)).ceil() as usize;
        let mut controls = Vec::with_capacity(count);
        let mut path = vec![self.points()[0].1];
        let mut mean = first;
        for interval in 0..count {
            let time = (interval * steps) as f64 * experiment.dt;
            let (_, best) = search.best(&trial, time, &mut mean, &mut random);
            let control = ForceFactors::<f32>::from(ForceFactors::from(best));
            controls.push(control);
            for _ in 0..steps {
                rapier.immersion.set_control(rapier.handle, control);
                rapier.step();
                path.push(rapier.state().position);
            }
            trial.control = control.into();
            for _ in 0..steps {
                experiment.advance(&mut trial);
            }
            correct(&mut trial, &rapier.state());
            mean.rotate_left(1);
            let end = mean.len() - 1;
            mean[end] = mean[end.saturating_sub(1)];
        }
        let distance = |index: usize| (path[index] - self.at(index as f64 * experiment.dt)).norm();
        let within = (self.duration() / experiment.dt).floor() as usize + 1;
        let distances: Vec<f64> = (0..within.min(path.len())).map(distance).collect();
        let at_points = self.points().iter().map(|(time, point)| {
            let index = (time / experiment.dt).round() as usize;
            (path[index.min(path.len() - 1)] - point).norm()
        });
        Ok(Followed {
            release,
            series: ControlSeries::new(steps as f64 * experiment.dt, controls, Vec::new())?,
            mean_distance: distances.iter().sum::<f64>() / distances.len() as f64,
            largest_distance: distances.iter().copied().fold(0.0, f64::max),
            at_points: at_points.collect(),
            path,
        })
    }
}

/// The search for one interval's control.
struct Search<'a> {
    sketch: &'a Sketch,
    gravity: Vector3<f64>,
    flow: FlowSample,
    dt: f64,
    steps: usize,
    params: &'a FollowParams,
}

impl Search<'_> {
    /// Mean squared distance from the sketch over the horizon, and how far the velocity at its end is
    /// from the sketch's.
    fn cost(&self, trial: &FreeBody, time: f64, controls: &[[f64; 3]]) -> f64 {
        let mut body = trial.clone();
        let (mut cost, mut now) = (0.0, time);
        for control in controls {
            body.control = (*control).into();
            for _ in 0..self.steps {
                body.step_in(self.dt, self.gravity, &self.flow);
                now += self.dt;
                cost += (body.position - self.sketch.at(now)).norm_squared();
            }
        }
        let slope = (self.sketch.at(now + 1e-3) - self.sketch.at(now - 1e-3)) / 2e-3;
        // An error of the velocity at the end becomes a distance an interval later.
        let later = (body.linear_velocity() - slope) * (self.steps as f64 * self.dt);
        let cost = cost / (controls.len() * self.steps) as f64 + later.norm_squared();
        if cost.is_finite() {
            cost
        } else {
            f64::INFINITY
        }
    }

    /// The cost of the best controls found, and the first of them. The search starts from `mean`, which is
    /// then set to these controls.
    fn best(
        &self,
        trial: &FreeBody,
        time: f64,
        mean: &mut [[f64; 3]],
        random: &mut Pcg64Mcg,
    ) -> (f64, [f64; 3]) {
        let params = self.params;
        let low = if params.reverse_lifts {
            -params.limit
        } else {
            0.0
        };
        let bound = |k: usize, x: f64| x.clamp(if k == 0 { 0.02 } else { low }, params.limit);
        let mut spread = vec![[0.5 * params.limit; 3]; mean.len()];
        let mut winner = (self.cost(trial, time, mean), mean.to_vec());
        for _ in 0..params.rounds {
            let mut flown: Vec<(f64, Vec<[f64; 3]>)> = (0..params.samples)
                .map(|_| {
                    let pairs = mean.iter().zip(&spread);
                    let controls: Vec<[f64; 3]> = pairs
                        .map(|(mean, spread)| {
                            [0, 1, 2].map(|k| {
                                let noise: f64 = StandardNormal.sample(random);
                                bound(k, mean[k] + spread[k] * noise)
                            })
                        })
                        .collect();
                    (self.cost(trial, time, &controls), controls)
                })
                .collect();
            flown.push(winner.clone());
            flown.sort_by(|a, b| a.0.total_cmp(&b.0));
            winner = flown[0].clone();
            let elites = &flown[..params.elites];
            for (i, (mean, spread)) in mean.iter_mut().zip(&mut spread).enumerate() {
                for k in 0..3 {
                    let values = elites.iter().map(|(_, controls)| controls[i][k]);
                    let count = elites.len() as f64;
                    mean[k] = values.clone().sum::<f64>() / count;
                    let variance = values.map(|x| (x - mean[k]).powi(2)).sum::<f64>() / count;
                    spread[k] = variance.sqrt().max(0.02 * params.limit);
                }
            }
        }
        mean.copy_from_slice(&winner.1);
        (winner.0, winner.1[0])
    }
}

/// Puts a free body where rapier's is.
fn correct(trial: &mut FreeBody, state: &BodyState) {
    trial.follow(
        state.position,
        state.orientation,
        state.velocity,
        state.spin,
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydro::viscous::{ThesisLaw, ViscousLaw};

    #[test]
    fn bad_goals_are_refused() {
        let point = Vector3::zeros();
        let mut leaf = Experiment::thesis_leaf(ThesisLaw::new([1.0; 3])).unwrap();
        leaf.body.law = ViscousLaw::default();
        assert!(Sketch::landing(&leaf, point, &[], Vector3::y()).is_err());
        let down = Vector3::y() * -0.05;
        let sketch = Sketch::new(vec![(0.0, point), (0.1, down)]).unwrap();
        let params = FollowParams {
            elites: 0,
            ..FollowParams::default()
        };
        let ball = ColliderBuilder::ball(0.01);
        assert!(sketch.follow(&leaf, ball, &params).is_err());
    }
}
