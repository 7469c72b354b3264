//! One body of a world that follows a sketch: the controls of each interval are sought when it comes to it.

use super::experiment::{Experiment, Release};
use super::followed::{FollowParams, Followed};
use super::in_world::BodyState;
use crate::coupling::Immersion;
use crate::dynamics::FreeBody;
use crate::error::Error;
use crate::flow::FlowSample;
use crate::hydro::viscous::ForceFactors;
use crate::math::to_real;
use crate::medium::Medium;
use crate::motion::{ControlSeries, Sketch};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;
use rapier3d::dynamics::{RigidBodyHandle, RigidBodySet};
use rapier3d::na::Vector3;

/// Headings of the release that are tried.
const HEADINGS: u32 = 8;

/// Makes one body of a world follow a sketch, whatever else is in the world.
///
/// The search steps a free body in the mean flow of the world's uppermost fluid; of turbulence, obstacles and other bodies it
/// knows what they have done so far. After a contact it steers back to the sketch as far as the body can. The series it has
/// played can be replayed without it: in the same world and from the same release the body goes the same way.
///
/// An interval takes some milliseconds to search ([`FollowParams`]): several bodies in real time need a coarser search.
///
/// ```
/// use rapier3d_immersed::flow::Uniform;
/// use rapier3d_immersed::motion::Sketch;
/// use rapier3d_immersed::rapier3d::{na::Vector3, prelude::ColliderBuilder};
/// use rapier3d_immersed::training::{
///     BodyInWorld, Experiment, FollowParams, SketchFollower, thin_ellipsoid,
/// };
/// use rapier3d_immersed::{Fluid, Immersion};
///
/// let (hydro, mass) = thin_ellipsoid([0.0365, 0.021, 0.00015], 400.0)?;
/// let leaf = Experiment::new(hydro, mass, Fluid::AIR);
/// let down = Sketch::new(vec![(0.0, Vector3::zeros()), (0.5, Vector3::new(0.25, -0.4, 0.0))])?;
/// let mut wind = Immersion::new(Fluid::AIR);
/// wind.set_flow(Uniform::new(0.5, 0.0, 0.0));
/// let params = FollowParams { samples: 32, rounds: 2, ..FollowParams::default() };
/// let mut follower = SketchFollower::new(&down, &leaf, &wind, &params)?;
///
/// // The world may be any; the body starts as the follower says.
/// let release = follower.release_state();
/// let mut own = BodyInWorld::new(leaf.body, &leaf.mass, leaf.fluid, &release, leaf.dt, leaf.gravity)?;
/// own.immersion.set_flow(Uniform::new(0.5, 0.0, 0.0));
/// for _ in 0..follower.steps() {
///     follower.before_step(own.handle, &own.world.bodies, &mut own.immersion);
///     own.step();
/// }
/// let followed = follower.followed(own.handle, &own.world.bodies)?;
/// assert!(followed.mean_distance < 0.073); // the leaf's length
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone)]
pub struct SketchFollower {
    sketch: Sketch,
    params: FollowParams,
    release: Release,
    state: BodyState,
    gravity: Vector3<f64>,
    dt: f64,
    /// Steps of an interval, and intervals in all.
    steps: usize,
    count: usize,
    since: f64,
    trial: FreeBody,
    mean: Vec<[f64; 3]>,
    random: Pcg64Mcg,
    controls: Vec<ForceFactors>,
    path: Vec<Vector3<f64>>,
}

impl SketchFollower {
    /// A follower for the body of `experiment`, at its time step, which the world's must be. Release angle and spin are the
    /// experiment's, the velocity is that of the path, and the heading the best of eight in the flow of `immersion`.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] or [`Error::OutOfRange`] names a parameter that cannot be; those of
    /// [`Experiment::released`].
    pub fn new(
        sketch: &Sketch,
        experiment: &Experiment,
        immersion: &Immersion,
        params: &FollowParams,
    ) -> Result<Self, Error> {
        params.check()?;
        let steps = (params.interval / experiment.dt).round();
        Error::check_range("interval / dt", steps, 1.0, 1e6)?;
        let steps = steps as usize;
        let mut random = Pcg64Mcg::seed_from_u64(params.seed);
        let since = immersion.time();
        let search = Search {
            sketch,
            gravity: experiment.gravity_vector(),
            medium: immersion.medium(),
            since,
            dt: experiment.dt,
            steps,
            params,
        };
        let mean = vec![[1.0; 3]; params.horizon];
        let mut choice: Option<(f64, Release, FreeBody)> = None;
        for turn in 0..HEADINGS {
            let release = Release {
                velocity: sketch.velocity(0),
                heading: f64::from(turn) * std::f64::consts::TAU / f64::from(HEADINGS),
                ..experiment.release
            };
            let experiment = Experiment {
                release,
                ..experiment.clone()
            };
            let mut trial = experiment.released()?;
            trial.position = sketch.points()[0].1;
            let (cost, _) = search.best(&trial, 0.0, &mut mean.clone(), &mut random);
            if choice.as_ref().is_none_or(|(least, ..)| cost < *least) {
                choice = Some((cost, release, trial));
            }
        }
        let (_, release, trial) = choice.expect("there is at least one heading");
        let count = (sketch.duration() / (steps as f64 * experiment.dt)).ceil() as usize;
        Ok(Self {
            gravity: search.gravity,
            state: BodyState::of(&trial),
            sketch: sketch.clone(),
            params: *params,
            release,
            dt: experiment.dt,
            steps,
            count,
            since,
            trial,
            mean,
            random,
            controls: Vec::with_capacity(count),
            path: Vec::with_capacity(steps * count + 1),
        })
    }

    /// The state in which the body has to begin.
    pub fn release_state(&self) -> BodyState {
        self.state
    }

    /// Steps that the sketch takes.
    pub fn steps(&self) -> usize {
        self.steps * self.count
    }

    /// To be called before each step of the immersion that `body` is in, from its release on. Once the sketch is over, the last
    /// control stays. A handle that is stale does nothing.
    pub fn before_step(
        &mut self,
        body: RigidBodyHandle,
        bodies: &RigidBodySet,
        immersion: &mut Immersion,
    ) {
        let Some(rapier) = bodies.get(body) else {
            return;
        };
        let step = self.path.len();
        if step > self.steps() {
            return;
        }
        let state = BodyState::of_rapier(rapier);
        self.path.push(state.position);
        if step < self.steps() && step.is_multiple_of(self.steps) {
            self.next_control(step, &state, immersion);
        }
        if let Some(control) = self.controls.last() {
            immersion.set_control(body, *control);
        }
    }

    /// Seeks the control of the interval that begins at a step.
    fn next_control(&mut self, step: usize, state: &BodyState, immersion: &Immersion) {
        let search = Search {
            sketch: &self.sketch,
            gravity: self.gravity,
            medium: immersion.medium(),
            since: self.since,
            dt: self.dt,
            steps: self.steps,
            params: &self.params,
        };
        if let Some(last) = self.controls.last() {
            // The free body keeps the integrator's memory of the acceleration, and is put where rapier's body is.
            self.trial.control = (*last).into();
            for before in step - self.steps..step {
                search.step(&mut self.trial, before as f64 * self.dt);
            }
            self.trial.follow(
                state.position,
                state.orientation,
                state.velocity,
                state.spin,
            );
            self.mean.rotate_left(1);
            let end = self.mean.len() - 1;
            self.mean[end] = self.mean[end.saturating_sub(1)];
        }
        let time = step as f64 * self.dt;
        let (_, best) = search.best(&self.trial, time, &mut self.mean, &mut self.random);
        self.controls
            .push(ForceFactors::<f32>::from(ForceFactors::from(best)));
    }

    /// What has come of it: to be asked after the last of [`steps`](Self::steps).
    ///
    /// # Errors
    /// Those of [`ControlSeries::new`]: no step has been made.
    pub fn followed(
        mut self,
        body: RigidBodyHandle,
        bodies: &RigidBodySet,
    ) -> Result<Followed, Error> {
        let last = bodies.get(body).map(BodyState::of_rapier);
        let unseen = last.filter(|_| (1..=self.steps()).contains(&self.path.len()));
        self.path.extend(unseen.map(|state| state.position));
        let series = ControlSeries::new(self.steps as f64 * self.dt, self.controls, Vec::new())?;
        Ok(Followed::of(
            &self.sketch,
            self.release,
            series,
            self.path,
            self.dt,
        ))
    }
}

/// The search for one interval's control.
struct Search<'a> {
    sketch: &'a Sketch,
    gravity: Vector3<f64>,
    /// The fluid, and its time at the sketch's beginning, s.
    medium: &'a Medium,
    since: f64,
    dt: f64,
    steps: usize,
    params: &'a FollowParams,
}

impl Search<'_> {
    /// Moves the body on by a step from a time of the sketch, s.
    fn step(&self, body: &mut FreeBody, time: f64) {
        if !self.medium.moves(0) {
            return body.step(self.dt, self.gravity);
        }
        let flow = self
            .medium
            .flow_at(0, to_real(body.position), self.since + time);
        let known = flow.velocity.is_finite() && flow.vorticity.is_finite();
        let flow = if known { flow } else { FlowSample::default() };
        body.step_in(self.dt, self.gravity, &flow);
    }

    /// Mean squared distance from the sketch over the horizon, and how far the velocity at its end is
    /// from the sketch's.
    fn cost(&self, trial: &FreeBody, time: f64, controls: &[[f64; 3]]) -> f64 {
        let mut body = trial.clone();
        let (mut cost, mut now) = (0.0, time);
        for control in controls {
            body.control = (*control).into();
            for _ in 0..self.steps {
                self.step(&mut body, now);
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
