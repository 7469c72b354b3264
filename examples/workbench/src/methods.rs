//! The four methods of the thesis beside the law of the panel and plain rapier, and what each needs beforehand.

use crate::kinds::{Shape, kind};
use crate::settings::{Fluids, Settings};
use crate::support::scene::Kind;
use rapier3d_immersed::motion::path::{SynthesisParams, Synthesizer, TrajectoryDatabase};
use rapier3d_immersed::motion::{Classifier, Codebook, DimensionlessNumbers, MotionGraph};
use rapier3d_immersed::reduced::CrossParams;
use rapier3d_immersed::training::{
    Experiment, Grid, Planner, PlannerParams, Release, Subspaces, Sweep,
};
use rapier3d_immersed::turbulence::{LangevinMode, Turbulence, TurbulenceTable, TurbulentLayer};
use rapier3d_immersed::{ImmersedBody, Part, SeparatedLaw, StochasticLaw, ViscousLaw, preset};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::hash::Hash;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, PoisonError};

/// What moves the bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// The viscous law that is set.
    #[default]
    Law,
    /// The stochastic method: its law, in turbulence (thesis chapter 4).
    Stochastic,
    /// The pattern-driven method: the default law with factors from a codebook of plans (chapter 5).
    Patterns,
    /// The graph-based method: a fall that is put together from a motion graph (chapter 3).
    Graph,
    /// The reduced method: the default law as a separated function, from the proper generalized decomposition (chapter 6).
    Reduced,
    /// Rapier without any fluid.
    Plain,
}

impl Method {
    /// All of them, in the order of their keys 0 to 5.
    pub const ALL: [Self; 6] = [
        Self::Law,
        Self::Stochastic,
        Self::Patterns,
        Self::Graph,
        Self::Reduced,
        Self::Plain,
    ];

    /// What it is called.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Law => "law",
            Self::Stochastic => "stochastic",
            Self::Patterns => "patterns",
            Self::Graph => "graph synthesis",
            Self::Reduced => "reduced (PGD)",
            Self::Plain => "plain rapier",
        }
    }

    /// Whether bodies that are not flat move by the law under it.
    pub const fn is_for_flat(self) -> bool {
        matches!(self, Self::Patterns | Self::Graph | Self::Reduced)
    }
}

/// Falls that a sweep tries along each of the three factors.
const NODES: usize = 6;
/// Plans in a codebook.
const PLANS: u64 = 8;
/// Of the separated law.
const RANK: usize = 24;
/// VL/ν of 0.04 m/s to 8 m/s, for bodies of a few centimeters.
const REYNOLDS_NUMBERS: [f64; 2] = [100.0, 20_000.0];
/// Seed of the wake's turbulence.
const SEED: u64 = 1;

/// The thing as an experiment in the uppermost fluid, let go as [`Placement`](crate::Placement)'s default is.
pub fn experiment(kind: &Kind, settings: &Settings) -> Experiment {
    let body = ImmersedBody::new(kind.body.hydro.clone());
    Experiment {
        release: Release {
            tilt: 0.35,
            tilt_axis: TILT_AXIS,
            ..Release::default()
        },
        dt: preset::LEAF_DT.into(),
        ..Experiment::new(body, kind.dry, settings.fluid())
    }
}

/// The axis that stays horizontal at a release: nearly the long one, as no real body is let go along an axis of symmetry.
pub const TILT_AXIS: f64 = 80.0 * std::f64::consts::PI / 180.0;

/// Where a thing is on the phase diagram.
pub fn numbers(kind: &Kind, settings: &Settings, height: f64) -> Option<DimensionlessNumbers> {
    let fluid = settings.fluid_at(height);
    DimensionlessNumbers::of(&kind.body.hydro, &kind.dry, &fluid, crate::GRAVITY).ok()
}

/// What has been prepared, by what it was prepared for. Preparing is a pure function of that.
/// What could not be is not tried again.
struct Shelf<K, T>(Mutex<Option<HashMap<K, Result<T, String>>>>);

impl<K: Eq + Hash, T: Clone> Shelf<K, T> {
    const fn new() -> Self {
        Self(Mutex::new(None))
    }

    fn holds(&self, key: &K) -> bool {
        let shelf = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        shelf.as_ref().is_some_and(|shelf| shelf.contains_key(key))
    }

    fn get(&self, key: K, make: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
        let mut shelf = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let shelf = shelf.get_or_insert_default();
        shelf.entry(key).or_insert_with(make).clone()
    }
}

/// A thing of a size, in water or not.
type Key = (Shape, u64, bool);

static BOOKS: Shelf<Key, Arc<Codebook>> = Shelf::new();
static SEPARATED: Shelf<(Shape, u64), Arc<SeparatedLaw>> = Shelf::new();

fn key(shape: Shape, size: f64, settings: &Settings) -> Key {
    (shape, size.to_bits(), settings.fluids == Fluids::Water)
}

/// Whether the method has to prepare something for this thing first, which takes a second or so.
pub fn must_prepare(method: Method, shape: Shape, size: f64, settings: &Settings) -> bool {
    let key = key(shape, size, settings);
    match method {
        Method::Patterns => shape.is_flat() && !BOOKS.holds(&key),
        Method::Reduced => shape.is_flat() && !SEPARATED.holds(&(key.0, key.1)),
        _ => false,
    }
}

/// Plans along the thesis's graph of patterns, for this thing.
///
/// # Errors
/// If it shows no pattern that the graph knows.
pub fn codebook(shape: Shape, size: f64, settings: &Settings) -> Result<Arc<Codebook>, String> {
    BOOKS.get(key(shape, size, settings), || {
        let experiment = experiment(&kind(shape, size)?, settings);
        let planned = || -> Result<Codebook, rapier3d_immersed::Error> {
            let mut sweep = Sweep::new(Grid::of_coefficients(NODES, 3.0)?);
            let classifier = Classifier::default();
            sweep.run_coefficients(&experiment, &classifier, |_, _| ControlFlow::Continue(()))?;
            let subspaces = Subspaces::new(sweep.grid().clone(), sweep.patterns()?)?;
            let graph = MotionGraph::thesis();
            let params = PlannerParams::default();
            let planner = Planner::new(experiment.clone(), subspaces, &graph, params)?;
            planner.codebook(shape.name(), 1..1 + PLANS)
        };
        planned().map(Arc::new).map_err(|error| error.to_string())
    })
}

/// The thing under the default law as a separated function.
///
/// # Errors
/// If the law cannot be separated for this thing.
pub fn reduced(shape: Shape, size: f64) -> Result<ImmersedBody, String> {
    let kind = kind(shape, size)?;
    let hydro = &kind.body.hydro;
    let separated = SEPARATED.get((shape, size.to_bits()), || {
        let params = CrossParams {
            tolerance: 1e-3,
            max_rank: RANK,
            max_evaluations: 1_000_000,
            rank_growth: 4,
            ..CrossParams::default()
        };
        SeparatedLaw::bake(hydro, ViscousLaw::default(), REYNOLDS_NUMBERS, &params)
            .map(|(law, _)| Arc::new(law))
            .map_err(|error| error.to_string())
    })?;
    let part = Part::new(hydro.clone()).with_law((*separated).clone());
    Ok((*kind.body).clone().with_parts([part]))
}

/// The thing under the stochastic method's law.
pub fn stochastic(kind: &Kind) -> ImmersedBody {
    let law = ViscousLaw::Stochastic(StochasticLaw::default());
    let body = (*kind.body).clone();
    body.clone().with_law(law).unwrap_or(body)
}

/// The turbulence in the wake of such a thing, of the crate's own table, for the stochastic method where no other is set.
pub fn wake(kind: &Kind, settings: &Settings) -> Option<TurbulentLayer> {
    let numbers = numbers(kind, settings, f64::INFINITY)?;
    Some(TurbulentLayer {
        source: Turbulence::History {
            table: Arc::new(TurbulenceTable::default_history()),
            velocity_scale: numbers.u0 as f32,
            length_scale: 2.0 * kind.body.hydro.planform.half_extents.x as f32,
        },
        mode: LangevinMode::FluidSeen,
        seed: SEED,
    })
}

/// Falls of such a thing from a height, m.
///
/// # Errors
/// If it does not sink.
pub fn synthesizer(kind: &Kind, settings: &Settings, height: f64) -> Result<Synthesizer, String> {
    let numbers = numbers(kind, settings, height).ok_or("it has no place on the phase diagram")?;
    let params = SynthesisParams {
        height,
        ..SynthesisParams::default()
    };
    let length = 2.0 * kind.body.hydro.planform.half_extents.x;
    Synthesizer::new(&numbers, length, TrajectoryDatabase::shipped(), params)
        .map_err(|error| error.to_string())
}
