//! Sweeps: many experiments over a grid of parameters, in parallel, resumable.

use super::experiment::Experiment;
use super::grid::Grid;
use super::parameter::Parameter;
use crate::error::Error;
use crate::motion::{AttitudeSpread, Classifier, Pattern, Regime, Spread, Trajectory};
use std::ops::ControlFlow;

/// What one experiment showed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Sample {
    /// d of the whole fall, m (thesis § 5.4.2).
    pub distance: f64,
    /// e of the whole fall.
    pub eccentricity: f64,
    /// How the body turns, after the classifier's transient.
    pub attitude: AttitudeSpread,
    /// The direct classifier's share of flips among flips and reversals
    /// ([`Observation::tumbling`](crate::motion::Observation::tumbling)).
    pub flips: f64,
    /// The direct classifier's verdict.
    pub regime: Regime,
    /// Whether it was simulated, not taken over from agreeing neighbours.
    pub simulated: bool,
}

impl Sample {
    /// The sample of a fall.
    pub fn of(fall: &Trajectory, classifier: &Classifier) -> Self {
        let Spread {
            distance,
            eccentricity,
        } = fall.spread();
        let seen = classifier.classify(fall);
        Self {
            distance,
            eccentricity,
            attitude: AttitudeSpread::of(classifier.after_transient(fall)),
            flips: seen.tumbling(),
            regime: seen.regime,
            simulated: true,
        }
    }

    /// The direct classifier's verdict as one of the four patterns.
    pub fn pattern(&self) -> Pattern {
        self.regime.into()
    }
}

/// A grid and what is known at its nodes. A sweep that was interrupted, saved and loaded goes on where it
/// was.
///
/// ```
/// use rapier3d_immersed::ThesisLaw;
/// use rapier3d_immersed::motion::Classifier;
/// use rapier3d_immersed::training::{Experiment, Grid, Sweep};
/// use std::ops::ControlFlow;
///
/// // Eight falls, one for each corner of the thesis's range of coefficients.
/// let mut experiment = Experiment::thesis_card(ThesisLaw::new([1.0; 3]))?;
/// experiment.seconds = 1.0;
/// let mut sweep = Sweep::new(Grid::of_coefficients(2, 3.0)?);
/// sweep.run_coefficients(&experiment, &Classifier::default(), |done, of| {
///     println!("{done}/{of}");
///     ControlFlow::Continue(())
/// })?;
/// assert_eq!((sweep.remaining(), sweep.simulated()), (0, 8));
/// // Twice as fine, only nodes between neighbours that disagree are missing.
/// let finer = sweep.refined(|sample| sample.pattern())?;
/// assert_eq!(finer.grid().len(), 27);
/// assert!(finer.remaining() <= 27 - 8);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Sweep {
    grid: Grid,
    samples: Vec<Option<Sample>>,
}

/// Experiments between two reports of progress.
const BATCH: usize = 64;

impl Sweep {
    /// A sweep of which nothing is known yet.
    pub fn new(grid: Grid) -> Self {
        let samples = vec![None; grid.len()];
        Self { grid, samples }
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// What is known, by node.
    pub fn samples(&self) -> &[Option<Sample>] {
        &self.samples
    }

    /// Number of nodes that have not been computed.
    pub fn remaining(&self) -> usize {
        self.samples.iter().filter(|s| s.is_none()).count()
    }

    /// Number of nodes that were simulated, not taken over.
    pub fn simulated(&self) -> usize {
        let known = self.samples.iter().flatten();
        known.filter(|sample| sample.simulated).count()
    }

    /// Computes what is missing; `experiment` gives the sample at a point of the grid. After every few
    /// experiments `progress` is told how many are done of how many, and may stop the sweep; what is
    /// done is kept. The result depends neither on the number of threads nor on interruptions.
    ///
    /// # Errors
    /// The first (in the order of nodes) of a batch that `experiment` returns.
    pub fn run(
        &mut self,
        experiment: impl Fn(&[f64]) -> Result<Sample, Error> + Sync,
        mut progress: impl FnMut(usize, usize) -> ControlFlow<()>,
    ) -> Result<(), Error> {
        let missing: Vec<usize> = (0..self.samples.len())
            .filter(|node| self.samples[*node].is_none())
            .collect();
        let mut done = 0;
        for batch in missing.chunks(BATCH) {
            let run = |node: &usize| experiment(&self.grid.point(*node));
            #[cfg(feature = "bake")]
            let results: Vec<Result<Sample, Error>> = {
                use rayon::prelude::*;
                batch.par_iter().map(run).collect()
            };
            #[cfg(not(feature = "bake"))]
            let results: Vec<Result<Sample, Error>> = batch.iter().map(run).collect();
            for (node, result) in batch.iter().zip(results) {
                self.samples[*node] = Some(result?);
            }
            done += batch.len();
            if progress(done, missing.len()).is_break() {
                break;
            }
        }
        Ok(())
    }

    /// Computes what is missing by dropping the body of `experiment` with the point as its control
    /// parameters c̃ ([`FreeBody::control`](crate::FreeBody::control)).
    ///
    /// # Errors
    /// [`Error::WrongLength`] if the grid does not have three axes, those of
    /// [`Experiment::released`].
    pub fn run_coefficients(
        &mut self,
        experiment: &Experiment,
        classifier: &Classifier,
        progress: impl FnMut(usize, usize) -> ControlFlow<()>,
    ) -> Result<(), Error> {
        Error::check_length("axes of a grid of coefficients", 3, self.grid.axes().len())?;
        let released = experiment.released()?;
        let drop = |point: &[f64]| {
            let mut body = released.clone();
            body.control = [point[0], point[1], point[2]].into();
            Ok(Sample::of(&experiment.fall(body), classifier))
        };
        self.run(drop, progress)
    }

    /// Computes what is missing by dropping the body of `experiment` with each axis of the grid as one parameter of
    /// it (thesis § 5.7: release, distribution of the mass, wind).
    ///
    /// ```
    /// use rapier3d_immersed::motion::Classifier;
    /// use rapier3d_immersed::training::{Axis, Experiment, Grid, Parameter, Sweep};
    /// use rapier3d_immersed::{ThesisLaw, ViscousLaw};
    /// use std::ops::ControlFlow;
    ///
    /// let mut leaf = Experiment::thesis_leaf(ThesisLaw::default())?;
    /// leaf.body.law = ViscousLaw::default();
    /// leaf.seconds = 1.0;
    /// let tilt = Axis { low: 0.1, high: 1.2, count: 3 };
    /// let ballast = Axis { low: 0.0, high: 0.01, count: 2 };
    /// let mut sweep = Sweep::new(Grid::new(vec![tilt, ballast])?);
    /// let parameters = [Parameter::Tilt, Parameter::CenterOfMass(0)];
    /// let go_on = |_, _| ControlFlow::Continue(());
    /// sweep.run_parameters(&leaf, &parameters, &Classifier::default(), go_on)?;
    /// assert_eq!(sweep.remaining(), 0);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::WrongLength`] if there is not one parameter per axis; those of [`Parameter::set`] and
    /// [`Experiment::released`].
    pub fn run_parameters(
        &mut self,
        experiment: &Experiment,
        parameters: &[Parameter],
        classifier: &Classifier,
        progress: impl FnMut(usize, usize) -> ControlFlow<()>,
    ) -> Result<(), Error> {
        let axes = self.grid.axes().len();
        Error::check_length("parameters of the grid", axes, parameters.len())?;
        let drop = |point: &[f64]| {
            let mut experiment = experiment.clone();
            let mut control = [1.0; 3];
            for (parameter, value) in parameters.iter().zip(point) {
                parameter.set(*value, &mut experiment, &mut control)?;
            }
            let mut body = experiment.released()?;
            body.control = control.into();
            Ok(Sample::of(&experiment.fall(body), classifier))
        };
        self.run(drop, progress)
    }

    /// The sweep over a grid twice as fine in which only nodes between **disagreeing** neighbours are
    /// missing (thesis § 5.4.3): `label` tells what a sample is. The number of experiments then grows
    /// like the area of the boundaries between patterns, not like the volume.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if this sweep is not complete; [`Error::OutOfRange`] if the finer
    /// grid is too large.
    pub fn refined<L: PartialEq>(&self, label: impl Fn(&Sample) -> L) -> Result<Self, Error> {
        let remaining = self.remaining();
        Error::check(
            "remaining",
            remaining as f64,
            remaining == 0,
            "0 before refining",
        )?;
        let grid = self.grid.refined()?;
        let known = |node: usize| self.samples[node].as_ref();
        let samples = (0..grid.len()).map(|fine| {
            let corners = self.grid.around(&grid.indices(fine));
            let first = known(corners[0])?;
            if corners.len() == 1 {
                return Some(*first);
            }
            let mut others = corners[1..].iter().filter_map(|corner| known(*corner));
            others
                .all(|other| label(other) == label(first))
                .then_some(Sample {
                    simulated: false,
                    ..*first
                })
        });
        Ok(Self {
            samples: samples.collect(),
            grid,
        })
    }

    /// The direct classifier's pattern at every node.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if the sweep is not complete.
    pub fn patterns(&self) -> Result<Vec<Pattern>, Error> {
        let remaining = self.remaining();
        Error::check("remaining", remaining as f64, remaining == 0, "0")?;
        Ok(self.samples.iter().flatten().map(Sample::pattern).collect())
    }

    #[cfg(feature = "serde-serialize")]
    pub(super) fn check(&self) -> Result<(), Error> {
        self.grid.check()?;
        Error::check_length("samples of the sweep", self.grid.len(), self.samples.len())?;
        for sample in self.samples.iter().flatten() {
            Error::check_not_negative("distance", sample.distance)?;
            Error::check_range("eccentricity", sample.eccentricity, 0.0, 1.0)?;
            Error::check_not_negative("tilt", sample.attitude.tilt)?;
            Error::check_range("coherence", sample.attitude.coherence, 0.0, 1.0)?;
            Error::check_range("flips", sample.flips, 0.0, 1.0)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydro::viscous::ThesisLaw;
    use crate::training::Axis;

    /// A disc of one pattern in a square of another.
    fn disc(point: &[f64]) -> Result<Sample, Error> {
        let inside = point[0].hypot(point[1]) < 0.7;
        Ok(Sample {
            distance: point[0].abs(),
            eccentricity: 0.5,
            attitude: AttitudeSpread::default(),
            flips: 0.0,
            regime: if inside {
                Regime::PeriodicFlutter
            } else {
                Regime::SteadyDescent
            },
            simulated: true,
        })
    }

    fn square(count: usize) -> Grid {
        let axis = Axis {
            low: -1.0,
            high: 1.0,
            count,
        };
        Grid::new(vec![axis; 2]).unwrap()
    }

    fn go_on(_: usize, _: usize) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    #[test]
    fn an_interrupted_sweep_goes_on() {
        let mut whole = Sweep::new(square(17));
        whole.run(disc, go_on).unwrap();
        let mut parts = Sweep::new(square(17));
        let mut rounds = 0;
        while parts.remaining() > 0 {
            parts.run(disc, |_, _| ControlFlow::Break(())).unwrap();
            rounds += 1;
        }
        assert_eq!(rounds, 289usize.div_ceil(BATCH));
        assert_eq!(parts, whole);
    }

    /// Refining finds the same labels as computing everything, from far fewer experiments; their
    /// number doubles with each halving of the spacing, not quadruples (in the plane).
    #[test]
    fn refinement_follows_the_boundary() {
        let mut sweep = Sweep::new(square(9));
        sweep.run(disc, go_on).unwrap();
        let mut counts = Vec::new();
        for _ in 0..4 {
            sweep = sweep.refined(|sample| sample.regime).unwrap();
            counts.push(sweep.remaining());
            sweep.run(disc, go_on).unwrap();
        }
        let mut whole = Sweep::new(square(129));
        whole.run(disc, go_on).unwrap();
        assert_eq!(sweep.patterns(), whole.patterns());
        for pair in counts.windows(2) {
            let growth = pair[1] as f64 / pair[0] as f64;
            // The coarsest grid resolves the boundary, a curve, with some 20 nodes.
            assert!((1.7..2.3).contains(&growth), "{counts:?}");
        }
        assert!(sweep.simulated() < 129 * 129 / 8);
    }

    #[test]
    fn coefficients_steer_the_fall() {
        let mut experiment = Experiment::thesis_card(ThesisLaw::new([1.0; 3])).unwrap();
        experiment.seconds = 0.5;
        let grid = Grid::of_coefficients(2, 3.0).unwrap();
        let mut sweep = Sweep::new(grid);
        let classifier = Classifier::default();
        sweep
            .run_coefficients(&experiment, &classifier, go_on)
            .unwrap();
        assert_eq!(sweep.remaining(), 0);
        // The law itself with the coefficients of a node gives the same fall.
        let point = sweep.grid().point(5);
        experiment.body.law =
            crate::ViscousLaw::Thesis(ThesisLaw::new([point[0], point[1], point[2]]));
        let fall = experiment.run().unwrap();
        let (swept, direct) = (sweep.samples()[5].unwrap(), Sample::of(&fall, &classifier));
        assert_eq!(swept.regime, direct.regime);
        // Factors are multiplied in another order, which changes the rounding.
        assert!((swept.distance / direct.distance - 1.0).abs() < 1e-9);
        let mut flat = Sweep::new(square(2));
        assert!(
            flat.run_coefficients(&experiment, &classifier, go_on)
                .is_err()
        );
        assert!(flat.refined(|s| s.regime).is_err());
    }
}
