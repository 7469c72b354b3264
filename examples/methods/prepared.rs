//! What the methods need before a body can fall by them.

use crate::Failure;
use crate::memory::Making;
use crate::method::Method;
use crate::subject::Subject;
use rapier3d_immersed::motion::path::{
    DatabaseParams, SynthesisParams, Synthesizer, TrajectoryDatabase,
};
use rapier3d_immersed::motion::{Classifier, Codebook, MotionGraph};
use rapier3d_immersed::reduced::CrossParams;
use rapier3d_immersed::training::{Grid, Planner, PlannerParams, Subspaces, Sweep};
use rapier3d_immersed::turbulence::{LangevinMode, Turbulence, TurbulenceTable, TurbulentLayer};
use rapier3d_immersed::{ImmersedBody, Part, SeparatedLaw, StochasticLaw, ViscousLaw};
use std::ops::ControlFlow;
use std::sync::Arc;

/// Falls that a sweep tries along each of the three factors.
const NODES: usize = 6;
/// Plans in a codebook.
const PLANS: u64 = 12;
/// Of the separated law.
const RANK: usize = 32;
/// VL/ν of 0.04 m/s to 8 m/s, for bodies of a few centimeters.
const REYNOLDS_NUMBERS: [f64; 2] = [100.0, 20_000.0];

/// All that the methods need of a subject.
pub struct Prepared {
    pub subject: Subject,
    pub planner: Planner,
    pub codebook: Codebook,
    pub separated: SeparatedLaw,
    pub layer: TurbulentLayer,
    database: Arc<TrajectoryDatabase>,
    /// `None` is what the crate estimates for the main regime.
    regimes: Option<MotionGraph>,
    making: [Making; 6],
}

impl Prepared {
    /// Which regime, and which pattern, follows which; `None` is what the crate estimates for the main regime.
    pub fn new(
        subject: Subject,
        regimes: Option<MotionGraph>,
        patterns: MotionGraph,
    ) -> Result<Self, Failure> {
        let ((database, _), of_graph) = Making::of(
            || TrajectoryDatabase::bake(&DatabaseParams::default()),
            |(database, _)| database.entries().len(),
        )?;
        let numbers = subject.numbers()?;
        let (layer, of_stochastic) = Making::of(
            || {
                Ok::<_, Failure>(TurbulentLayer {
                    source: Turbulence::History {
                        table: Arc::new(TurbulenceTable::default_history()),
                        velocity_scale: numbers.u0 as f32,
                        length_scale: subject.length as f32,
                    },
                    mode: LangevinMode::FluidSeen,
                    seed: 1,
                })
            },
            |_| 1,
        )?;
        let falls = NODES.pow(3);
        let ((planner, codebook), of_pattern) =
            Making::of(|| train(&subject, &patterns), |_| falls)?;
        let params = CrossParams {
            tolerance: 1e-3,
            max_rank: RANK,
            max_evaluations: 1_000_000,
            rank_growth: 4,
            ..CrossParams::default()
        };
        let hydro = &subject.kind.body.hydro;
        let law = ViscousLaw::default();
        let ((separated, _), of_reduced) = Making::of(
            || SeparatedLaw::bake(hydro, law, REYNOLDS_NUMBERS, &params),
            |(_, report)| report.evaluations,
        )?;
        let none = Making::default();
        Ok(Self {
            subject,
            planner,
            codebook,
            separated,
            layer,
            database: Arc::new(database),
            regimes,
            making: [none, none, of_graph, of_stochastic, of_pattern, of_reduced],
        })
    }

    pub fn making(&self, method: Method) -> Making {
        self.making[method as usize]
    }

    /// Falls from a height, m; the phase diagram says of which kind.
    pub fn synthesizer(&self, height: f64) -> Result<Synthesizer, Failure> {
        let params = SynthesisParams {
            height,
            graph: self.regimes.clone(),
            ..SynthesisParams::default()
        };
        let (numbers, database) = (self.subject.numbers()?, self.database.clone());
        Ok(Synthesizer::new(
            &numbers,
            self.subject.length,
            database,
            params,
        )?)
    }

    /// The body as the method has it; plain rapier has the law's, which it does not use.
    pub fn body(&self, method: Method) -> Result<ImmersedBody, Failure> {
        let body = (*self.subject.kind.body).clone();
        Ok(match method {
            Method::Stochastic => {
                body.with_law(ViscousLaw::Stochastic(StochasticLaw::default()))?
            }
            Method::Reduced => {
                let part = Part::new(body.hydro.clone()).with_law(self.separated.clone());
                body.with_parts([part])
            }
            _ => body,
        })
    }
}

/// What the body does for which factors on its law's forces, and plans along a graph.
fn train(subject: &Subject, graph: &MotionGraph) -> Result<(Planner, Codebook), Failure> {
    let experiment = subject.experiment();
    let mut sweep = Sweep::new(Grid::of_coefficients(NODES, 3.0)?);
    let classifier = Classifier::default();
    sweep.run_coefficients(&experiment, &classifier, |_, _| ControlFlow::Continue(()))?;
    let subspaces = Subspaces::new(sweep.grid().clone(), sweep.patterns()?)?;
    let planner = Planner::new(experiment, subspaces, graph, PlannerParams::default())?;
    let codebook = planner.codebook("methods", 1..1 + PLANS)?;
    Ok((planner, codebook))
}
