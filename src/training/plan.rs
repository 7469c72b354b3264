//! The parameters of a plan, and the plan.

use super::energy::{ControlBox, EnergyObjective};
use crate::error::Error;
use crate::motion::{Classifier, ControlSeries, Pattern, Trajectory, TurnFinder};
use crate::turbulence::Turbulence;

/// How plans are made.
///
/// ```
/// use rapier3d_immersed::training::PlannerParams;
///
/// // Long plans with short dwells, which need not hold for releases that are a little off.
/// let params = PlannerParams { seconds: 20.0, least_turns: 2, shaken: 0, ..PlannerParams::default() };
/// assert_eq!(params.tries, 32);
/// ```
#[derive(Clone, Debug)]
pub struct PlannerParams {
    /// A plan ends with the first dwell that is over after this time, s (default 4).
    pub seconds: f64,
    /// Time that a control is held, s (default 1/30): a whole number of the experiment's steps.
    pub interval: f64,
    /// Least number of turns in a dwell (default 3).
    pub least_turns: u32,
    /// Least length of a dwell, s (default 1.2).
    pub least_dwell: f64,
    /// Length of a dwell that does not turn, as in steady descent, s (default 1).
    pub steady_dwell: f64,
    /// Largest length of a dwell, s (default 3).
    pub longest_dwell: f64,
    /// Tolerance of the [`TurnFinder`] (default [`TurnFinder::TOLERANCE`]).
    pub turn_tolerance: f64,
    /// How far from its anchor a dwell's controls may be, in spacings of the subspaces' grid along each
    /// axis (default 1). Infinite leaves the whole subspace to the optimisation, as in the thesis;
    /// strong turbulence then drives c̃ from one end of it to the other at every interval.
    pub reach: f64,
    /// Anchors that are tried for a dwell (default 32).
    pub tries: u32,
    /// Number of copies of the release, turned a little, that must show the pattern as well (default 5).
    pub shaken: usize,
    /// By how much these copies are turned, rad (default 0.03).
    pub shake: f64,
    /// The turbulence that the energy objective follows; `None` (the default) stands for one of 10 % of U0
    /// with eddies of the body's length. The thesis has 100 %.
    pub turbulence: Option<Turbulence>,
    /// What decides whether a dwell shows its pattern.
    pub classifier: Classifier,
}

impl Default for PlannerParams {
    fn default() -> Self {
        Self {
            seconds: 4.0,
            interval: 1.0 / 30.0,
            least_turns: 3,
            least_dwell: 1.2,
            steady_dwell: 1.0,
            longest_dwell: 3.0,
            turn_tolerance: TurnFinder::TOLERANCE,
            reach: 1.0,
            tries: 32,
            shaken: 5,
            shake: 0.03,
            turbulence: None,
            classifier: Classifier::default(),
        }
    }
}

impl PlannerParams {
    pub(super) fn check(&self) -> Result<(), Error> {
        Error::check_range("seconds", self.seconds, 0.0, 1e4)?;
        Error::check_positive("interval", self.interval)?;
        Error::check_not_negative("least_dwell", self.least_dwell)?;
        Error::check_range("steady_dwell", self.steady_dwell, self.interval, 1e3)?;
        Error::check_range("longest_dwell", self.longest_dwell, self.interval, 1e3)?;
        Error::check_positive("turn_tolerance", self.turn_tolerance)?;
        Error::check("reach", self.reach, self.reach >= 0.0, "zero or positive")?;
        Error::check_range("tries", f64::from(self.tries), 1.0, 1e6)?;
        Error::check_range("shaken", self.shaken as f64, 0.0, 1e3)?;
        Error::check_finite("shake", self.shake)?;
        Ok(())
    }
}

/// How one dwell of a plan came out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DwellReport {
    /// The pattern that was drawn.
    pub planned: Pattern,
    /// What the direct classifier sees, for the planned release.
    pub observed: Pattern,
    /// Number of releases, among the planned one and its copies, in which it sees the planned pattern.
    pub shown: usize,
    /// Number of releases in all.
    pub releases: usize,
    /// Anchors that were tried.
    pub tries: u32,
}

/// A plan and its report.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The controls.
    pub series: ControlSeries,
    /// Dwell by dwell; a pattern that was drawn again is a dwell of its own.
    pub dwells: Vec<DwellReport>,
    /// The planned fall.
    pub fall: Trajectory,
    /// The objective of every interval, with the boxes that its minimum was sought in.
    pub objectives: Vec<(EnergyObjective, Vec<ControlBox>)>,
}
