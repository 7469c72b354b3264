//! One experiment, run by the crate's own integrator or in a rapier world.

use rapier3d_immersed::motion::Trajectory;
use rapier3d_immersed::training::Experiment;
use rapier3d_immersed::{Error, Integrator};

/// Who integrates, and how finely. The experiment's own step is 1/240 s for plates and papers, and scaled
/// to the size of a disc.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Runner {
    /// The crate's own free body in f64, at the experiment's step.
    Alone,
    /// The same at half the step.
    HalfStep,
    /// A rapier world (f32) whose step is so many times the experiment's; the fall is recorded at every
    /// step.
    Rapier(u32),
    /// The same under [`Integrator::FINE`].
    Fine(u32),
}

impl Runner {
    /// For tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Alone => "stand-alone",
            Self::HalfStep => "dt/2",
            Self::Rapier(1) => "rapier, dt",
            Self::Rapier(4) => "rapier, 4 dt",
            Self::Rapier(_) => "rapier",
            Self::Fine(4) => "rapier, 4 dt, fine substeps",
            Self::Fine(_) => "rapier, fine substeps",
        }
    }

    /// Drops the body.
    ///
    /// # Errors
    /// Those of [`Experiment::run`].
    pub fn run(self, experiment: &Experiment) -> Result<Trajectory, Error> {
        let every = |dt: f64| Experiment {
            dt,
            ..experiment.clone()
        };
        match self {
            Self::Alone => experiment.run(),
            Self::HalfStep => every(0.5 * experiment.dt).run(),
            Self::Rapier(times) => every(experiment.dt * f64::from(times)).run_in_rapier(),
            Self::Fine(times) => Experiment {
                integrator: Integrator::FINE,
                ..every(experiment.dt * f64::from(times))
            }
            .run_in_rapier(),
        }
    }
}
