//! Planning: a motion graph's patterns turned into a series of control parameters (thesis § 5.5.3).
//!
//! 1. The first pattern is drawn from the graph's start distribution.
//! 2. In a *dwell*, every interval's c̃ minimises the energy objective within the pattern's subspace near
//!    an anchor that is drawn from it ([`EnergyObjective`]).
//! 3. When the path has turned often enough, the next pattern is drawn at a turning point.
//!
//! The thesis trusts that a point of a pattern's subspace shows the pattern whatever came before. It was
//! trained from rest, though, and a tumbling body that is given the parameters of flutter may tumble on.
//! So each dwell is checked: it counts if the direct classifier sees the planned pattern in it, for the
//! planned release and for others near it; otherwise another anchor and another draw of the noise are
//! tried. Draws of *patterns* are never repeated, so that their statistics stay those of the graph.
//!
//! Measured (test `patterns`, 200 plans for a leaf under the default law, played back in rapier): the sequence that is seen
//! is the planned one in 185 of 200 runs. Anchors that stay away from the subspace's boundary do worse (162 with those of the
//! fewest foreign neighbours, 47 where that leaves a single one): what a dwell shows depends on what came before, and so
//! choice is worth more than distance from the boundary.
//!
//! Another release, another distribution of the mass or a wind ([`Experiment::release`], [`Experiment::mass`],
//! [`Experiment::wind`]) is planned for by giving it: a dwell counts if the pattern is seen under *those* conditions, so that
//! subspaces which were trained for others still serve as a place to look for anchors. A plan holds for what it was made
//! for, which a [`Codebook`] keeps with it.

use super::energy::{ControlBox, EnergyObjective};
use super::experiment::Experiment;
use super::plan::{DwellReport, Plan, PlannerParams};
use super::subspace::Subspaces;
use crate::dynamics::FreeBody;
use crate::error::Error;
use crate::hydro::viscous::ForceFactors;
use crate::math::to_real;
use crate::motion::{
    Codebook, ControlSeries, Dwell, Moment, MotionGraph, Pattern, Trajectory, TurnFinder,
};
use crate::turbulence::{Turbulence, TurbulenceState, kolmogorov_constant};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;
use rapier3d::na::{UnitQuaternion, Vector3};

/// Makes plans for one body.
///
/// ```
/// use rapier3d_immersed::ThesisLaw;
/// use rapier3d_immersed::motion::{MotionGraph, Pattern};
/// use rapier3d_immersed::training::{Experiment, Grid, Planner, PlannerParams, Subspaces};
///
/// // Subspaces usually come from a sweep; here every control is said to make the body flutter.
/// let experiment = Experiment::thesis_card(ThesisLaw::new(ThesisLaw::ZIGZAG))?;
/// let grid = Grid::of_coefficients(2, 3.0)?;
/// let subspaces = Subspaces::new(grid, vec![Pattern::Zigzag; 8])?;
/// let params = PlannerParams { seconds: 0.5, tries: 1, shaken: 0, ..PlannerParams::default() };
/// let planner = Planner::new(experiment, subspaces, &MotionGraph::thesis(), params)?;
/// // Patterns that the body never shows are never planned.
/// let plan = planner.plan(1)?;
/// assert_eq!(plan.series.sequence(), [Pattern::Zigzag]);
/// assert!(planner.plan_sequence(&[Pattern::SteadyDescent], 1).is_err());
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Planner {
    experiment: Experiment,
    subspaces: Subspaces,
    graph: MotionGraph,
    params: PlannerParams,
    /// The nodes from which anchors are drawn, by pattern.
    anchors: [Vec<usize>; 4],
    turbulence: Turbulence,
    length: f64,
    steps: usize,
}

/// The state of a plan that is being made.
#[derive(Clone)]
struct Flight {
    /// The body as planned, then its copies of other releases.
    bodies: Vec<FreeBody>,
    turns: TurnFinder,
    time: f64,
}

/// One try of a dwell.
struct Attempt {
    flight: Flight,
    controls: Vec<ForceFactors>,
    moments: Vec<Moment>,
    objectives: Vec<(EnergyObjective, Vec<ControlBox>)>,
    report: DwellReport,
}

impl Planner {
    /// A planner for the body of `experiment` with the subspaces of its controls. Patterns that it never
    /// shows are taken out of the graph, whose states must be those of [`Pattern::ALL`].
    ///
    /// # Errors
    /// [`Error::WrongLength`] if the graph does not have four states or the subspaces three axes; those
    /// of [`Experiment::check`]; [`Error::InvalidParameter`] or [`Error::OutOfRange`] names a parameter
    /// that cannot be.
    pub fn new(
        experiment: Experiment,
        subspaces: Subspaces,
        graph: &MotionGraph,
        params: PlannerParams,
    ) -> Result<Self, Error> {
        experiment.check()?;
        params.check()?;
        Error::check_length("states of the motion graph", 4, graph.states())?;
        Error::check_length("axes of the subspaces", 3, subspaces.grid().axes().len())?;
        let steps = (params.interval / experiment.dt).round();
        Error::check_range("interval / dt", steps, 1.0, 1e6)?;
        let anchors = Pattern::ALL.map(|pattern| subspaces.nodes(pattern));
        let possible: Vec<bool> = anchors.iter().map(|nodes| !nodes.is_empty()).collect();
        let graph = graph.restricted(&possible)?;
        let plate = &experiment.body.hydro.planform;
        let length = plate.half_extents.x;
        let turbulence = match &params.turbulence {
            Some(turbulence) => turbulence.clone(),
            None => {
                let gravity = experiment.gravity.abs().max(1e-9);
                let numbers = crate::motion::DimensionlessNumbers::of(
                    &experiment.body.hydro,
                    &experiment.mass,
                    &experiment.fluid,
                    gravity,
                )?;
                let (speed, size) = (numbers.u0 as f32, numbers.length as f32);
                Turbulence::Homogeneous(TurbulenceState::from_intensity(speed, 0.1, size)?)
            }
        };
        Ok(Self {
            experiment,
            subspaces,
            graph,
            params,
            anchors,
            turbulence,
            length,
            steps: steps as usize,
        })
    }

    /// The graph without the patterns that the body never shows.
    pub fn graph(&self) -> &MotionGraph {
        &self.graph
    }

    /// Plans a fall with patterns drawn from the graph. The same seed gives the same plan.
    ///
    /// # Errors
    /// Those of [`Experiment::released`].
    pub fn plan(&self, seed: u64) -> Result<Plan, Error> {
        let mut patterns = Pcg64Mcg::seed_from_u64(seed ^ 0x70a7_7e25);
        let mut state = self.graph.draw_start(&mut patterns);
        let mut first = true;
        self.run(seed, |time| {
            if !first {
                if time >= self.params.seconds {
                    return None;
                }
                state = self.graph.draw_next(state, &mut patterns);
            }
            first = false;
            Some(Pattern::ALL[state])
        })
    }

    /// Plans a fall through the given patterns, whatever the graph says.
    ///
    /// # Errors
    /// [`Error::WrongLength`] if there is none; [`Error::PatternNotShown`] if the body never shows one;
    /// those of [`Experiment::released`].
    pub fn plan_sequence(&self, sequence: &[Pattern], seed: u64) -> Result<Plan, Error> {
        if sequence.is_empty() {
            return Err(Error::WrongLength {
                what: "patterns of the plan",
                expected: 1,
                actual: 0,
            });
        }
        for pattern in sequence {
            if self.anchors[pattern.index()].is_empty() {
                return Err(Error::PatternNotShown {
                    pattern: pattern.abbreviation(),
                });
            }
        }
        let mut rest = sequence.iter();
        self.run(seed, |_| rest.next().copied())
    }

    /// A codebook of plans, one per seed, for the experiment's body, fluid, release and time step.
    ///
    /// # Errors
    /// Those of [`Planner::plan`]; [`Error::WrongLength`] if there is no seed.
    pub fn codebook(
        &self,
        body: impl Into<String>,
        seeds: std::ops::Range<u64>,
    ) -> Result<Codebook, Error> {
        let series = |seed| Ok(self.plan(seed)?.series);
        #[cfg(feature = "bake")]
        let series: Result<Vec<ControlSeries>, Error> = {
            use rayon::prelude::*;
            seeds.into_par_iter().map(series).collect()
        };
        #[cfg(not(feature = "bake"))]
        let series: Result<Vec<ControlSeries>, Error> = seeds.map(series).collect();
        Codebook::new(body, self.experiment.planned_for(), series?)
    }

    fn run(&self, seed: u64, mut next: impl FnMut(f64) -> Option<Pattern>) -> Result<Plan, Error> {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let mut flight = self.release(&mut random)?;
        let mut plan = (Vec::new(), Vec::new());
        let (mut reports, mut objectives) = (Vec::new(), Vec::new());
        let mut moments = vec![Moment::of(&flight.bodies[0])];
        let mut anchor = None;
        let mut last = None;
        while let Some(pattern) = next(flight.time) {
            // A pattern that was drawn again goes on with its anchor as long as that works.
            if last != Some(pattern) {
                anchor = None;
            }
            last = Some(pattern);
            let attempt = self.dwell(&flight, pattern, &mut anchor, &mut random);
            plan.1.push(Dwell {
                pattern,
                from: plan.0.len(),
            });
            plan.0.extend(attempt.controls);
            moments.extend(attempt.moments);
            objectives.extend(attempt.objectives);
            reports.push(attempt.report);
            flight = attempt.flight;
        }
        Ok(Plan {
            series: ControlSeries::new(self.steps as f64 * self.experiment.dt, plan.0, plan.1)?,
            dwells: reports,
            fall: Trajectory {
                interval: self.experiment.dt,
                moments,
            },
            objectives,
        })
    }

    fn release(&self, random: &mut Pcg64Mcg) -> Result<Flight, Error> {
        let released = self.experiment.released()?;
        let mut bodies = vec![released.clone()];
        for _ in 0..self.params.shaken {
            let turn = gaussian(random) * self.params.shake;
            let mut body = released.clone();
            body.set_orientation(UnitQuaternion::from_scaled_axis(turn) * body.orientation());
            bodies.push(body);
        }
        Ok(Flight {
            bodies,
            turns: TurnFinder::new(self.length, self.params.turn_tolerance),
            time: 0.0,
        })
    }

    /// The first try that all releases show, or the one that most do.
    fn dwell(
        &self,
        flight: &Flight,
        pattern: Pattern,
        anchor: &mut Option<usize>,
        random: &mut Pcg64Mcg,
    ) -> Attempt {
        let nodes = &self.anchors[pattern.index()];
        let mut best: Option<(usize, Attempt)> = None;
        for tries in 1..=self.params.tries {
            let node = match anchor.take() {
                Some(node) => node,
                None => nodes[random.random_range(0..nodes.len())],
            };
            let mut attempt = self.attempt(flight.clone(), pattern, node, random);
            attempt.report.tries = tries;
            let shown = attempt.report.shown;
            if best.as_ref().is_none_or(|(_, b)| shown > b.report.shown) {
                best = Some((node, attempt));
            }
            if shown == flight.bodies.len() {
                break;
            }
        }
        let (node, attempt) = best.expect("there is at least one try");
        *anchor = Some(node);
        attempt
    }

    /// The boxes of a pattern's subspace within reach of an anchor.
    fn boxes(&self, pattern: Pattern, anchor: usize) -> Vec<ControlBox> {
        let grid = self.subspaces.grid();
        let center = grid.indices(anchor);
        let near = |node: &&usize| {
            let indices = grid.indices(**node);
            let mut steps = indices.iter().zip(&center).map(|(a, b)| a.abs_diff(*b));
            steps.all(|step| step as f64 <= self.params.reach)
        };
        let nodes = self.anchors[pattern.index()].iter().filter(near);
        nodes
            .map(|node| {
                let cell = self.subspaces.cell(*node);
                [cell[0], cell[1], cell[2]]
            })
            .collect()
    }

    fn attempt(
        &self,
        mut flight: Flight,
        pattern: Pattern,
        anchor: usize,
        random: &mut Pcg64Mcg,
    ) -> Attempt {
        let params = &self.params;
        let boxes = self.boxes(pattern, anchor);
        let mut falls = vec![Vec::new(); flight.bodies.len()];
        let (mut controls, mut objectives) = (Vec::new(), Vec::new());
        let start = flight.time;
        let mut turned = 0;
        let point = self.subspaces.grid().point(anchor);
        for body in &mut flight.bodies {
            body.control = [point[0], point[1], point[2]].into();
        }
        loop {
            let objective = self.objective(&flight, random);
            if let Some(minimum) = objective.minimum(&boxes) {
                // The control is rounded to f32, as it is saved.
                let factors = ForceFactors::<f64>::from(<[f64; 3]>::from(minimum));
                let control = ForceFactors::<f32>::from(factors);
                for body in &mut flight.bodies {
                    body.control = control.into();
                }
                controls.push(control);
            }
            objectives.push((objective, boxes.clone()));
            let mut turn = false;
            for _ in 0..self.steps {
                for (body, fall) in flight.bodies.iter_mut().zip(&mut falls) {
                    self.experiment.advance(body);
                    fall.push(Moment::of(body));
                }
                turn |= flight.turns.push(flight.bodies[0].position);
            }
            turned += u32::from(turn);
            flight.time += self.steps as f64 * self.experiment.dt;
            let lasted = flight.time - start;
            let over = if turned == 0 {
                lasted >= params.steady_dwell
            } else {
                turn && turned >= params.least_turns && lasted >= params.least_dwell
            };
            if over || lasted >= params.longest_dwell {
                break;
            }
        }
        let seen = |moments: &Vec<Moment>| -> Pattern {
            let fall = Trajectory {
                interval: self.experiment.dt,
                moments: moments.clone(),
            };
            params.classifier.classify(&fall).regime.into()
        };
        let observed: Vec<Pattern> = falls.iter().map(seen).collect();
        Attempt {
            report: DwellReport {
                planned: pattern,
                observed: observed[0],
                shown: observed.iter().filter(|seen| **seen == pattern).count(),
                releases: observed.len(),
                tries: 1,
            },
            flight,
            controls,
            moments: falls.swap_remove(0),
            objectives,
        }
    }

    fn objective(&self, flight: &Flight, random: &mut Pcg64Mcg) -> EnergyObjective {
        let body = &flight.bodies[0];
        let state = self
            .turbulence
            .at(to_real(body.position), flight.time, flight.time);
        let viscosity = self.experiment.fluid.kinematic_viscosity();
        let c_k = kolmogorov_constant(state.taylor_reynolds_squared(viscosity));
        let turbulence = [c_k, state.dissipation, state.turnover_rate()].map(f64::from);
        EnergyObjective::at(
            body,
            self.experiment.gravity_vector(),
            &self.experiment.flow(),
            self.steps as f64 * self.experiment.dt,
            gaussian(random),
            turbulence,
        )
    }
}

fn gaussian(random: &mut Pcg64Mcg) -> Vector3<f64> {
    Vector3::from_fn(|_, _| StandardNormal.sample(random))
}
