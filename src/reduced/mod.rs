//! Reduced models by separated representation (thesis chapter 6): solutions of parametric problems
//! as sums of products of functions of one coordinate, baked once and evaluated in a microsecond.
//!
//! ```text
//! Axis ──► Operator, Canonical ──► solve ──────────┐
//!     └──► QuadraticSystem ──────► evolve ─────────┼──► Separated ──► evaluate, grid
//!     └──► any function ─────────► cross ──► TensorTrain, FlowMap, TrajectorySurrogate
//! model and track ───────────────► fit ────────────► parameters with uncertainty
//! ```
//!
//! In the order of use: give every coordinate an [`Axis`], state the problem, solve or sample it once, and
//! evaluate the result ([`Separated`], [`TensorTrain`]) as often as you like.
//!
//! * [`solve`] is the thesis's algorithm for linear problems of any number of dimensions: greedy
//!   enrichment by alternating directions and projection, and, beyond the thesis, updates of all terms,
//!   which bring them close to the best separation of their number.
//! * [`evolve`] takes coupled systems, quadratic in the state, whose parameters and initial
//!   values are coordinates: by Newton's linearisation, all components together or one by one.
//! * [`cross()`] and [`TrajectorySurrogate`] are for dynamics that are no polynomials.
//! * [`fit`] finds the parameters of a model from a measured track.
//!
//! **Where it fails.** A solution that becomes infinite within the domain has no separated
//! representation: [`evolve`] looks for such points and reports them. Trajectories
//! over a range of parameters in which the motion pattern changes are not separable over times in
//! which the patterns part. Measured (`examples/reduced_models`, figure `horizon`) as the error of the
//! horizontal position relative to its spread over the domain, on a planar plate over five parameters
//! (three coefficients ± 5 %, density ratio, release angle):
//!
//! | | T = 2 | 10 | 20 | 40 |
//! |---|---|---|---|---|
//! | across flutter–tumble: separated trajectory | 6e-7 | 1e-2 | .50 | .69 |
//! | … separated flow map over 0.25, iterated | 3e-3 | 5e-3 | 1e-2 | 2e-2 |
//! | … separated rates, integrated | 3e-3 | 4e-3 | 1e-2 | 3e-2 |
//! | flutter only: separated trajectory | 4e-7 | 3e-2 | .07 | .24 |
//! | … separated flow map over 0.25, iterated | 1e-2 | .09 | .08 | .26 |
//! | … separated rates, integrated | 5e-4 | 8e-4 | 1e-3 | 3e-3 |
//!
//! and on this crate's own dynamics, [`FreeBody`](crate::FreeBody): a card in air in space under the
//! thesis's law, over C̃ ± 5 %, density ratio and release angle, with forces separated over the six
//! coordinates of the motion; and a plate in water in a plane, over density ratio and release angle, under
//! the default law with a smoother set of coefficients than it has now (under those the plate is chaotic
//! between flutter and tumbling, as measured, and nothing follows it across):
//!
//! | | T = 0.2 s | 0.5 | 1 | 2 | 3 |
//! |---|---|---|---|---|---|
//! | card, zigzag only: separated trajectory | 2e-5 | 4e-3 | 9e-3 | .06 | .20 |
//! | … separated forces, integrated | 2e-4 | 1e-3 | 2e-3 | 5e-3 | 6e-3 |
//! | card, across autorotation: separated trajectory | 4e-5 | .48 | 1.0 | 1.0 | 1.0 |
//! | … separated forces, integrated | 3e-4 | 5e-3 | .42 | .50 | .54 |
//!
//! | | T = 0.24 s | 0.48 | 1.2 | 2.4 | 4.8 |
//! |---|---|---|---|---|---|
//! | plate, flutter only: separated trajectory | 3e-5 | 8e-5 | 5e-4 | 5e-4 | 2e-3 |
//! | … separated forces, integrated | 2e-3 | 1e-2 | .12 | .03 | .05 |
//! | … separated flow map over 0.04 s, iterated | .41 | .41 | 3.7 | 2.5 | 2.8 |
//! | plate, across tumbling: separated trajectory | 4e-5 | 8e-5 | .35 | .47 | .55 |
//! | … separated forces, integrated | 9e-3 | .03 | .06 | .01 | 8e-3 |
//! | … separated flow map over 0.04 s, iterated | .30 | 1.7 | .81 | .94 | 1.0 |
//!
//! Separate trajectories within one pattern, therefore, and forces across patterns. Forces are sums of few
//! products in the right coordinates (incidence, and the spin along and across the velocity), where rates and
//! flow maps over velocities are not. Nothing follows autorotation for long: 1e-6 rad at the release become
//! a millimetre in 2 s, and any error grows as fast. The default law's flow map takes more than 10⁵ samples
//! because of its stall and its kinks at rest and at zero spin.
//!
//! The short-time forms take 10⁵ to 1.5·10⁶ samples and ten microseconds or more per step, more than the
//! plate's rates or a step of `FreeBody` cost: they pay only for dynamics that cost more.
//!
//! ```
//! use rapier3d_immersed::reduced::Axis;
//! use rapier3d_immersed::reduced::{EvolutionParams, evolve};
//! use rapier3d_immersed::reduced::example_systems::{falling_body, falling_body_solution};
//!
//! // Free fall against quadratic drag, for every drag coefficient from 0.5 to 2 at once.
//! let drag = Axis::spectral(0.5, 2.0, 16)?;
//! let time = Axis::time(0.0, 1.0, 16, 3)?;
//! let mut params = EvolutionParams::default();
//! params.pgd.tolerance = 1e-5;
//! let (velocity, report) = evolve(&falling_body(drag), &time, &params, |_, _| ())?;
//! assert!(report.converged && report.modes <= 6);
//! let error = velocity.evaluate(&[0.3, 1.2])[0] - falling_body_solution(0.3, 1.2);
//! assert!(error.abs() < 1e-4);
//! # Ok::<(), rapier3d_immersed::Error>(())
//! ```

mod alternating;
mod axis;
mod canonical;
mod cross;
mod deim;
mod deim_evolution;
mod dormand_prince;
mod evolution;
pub mod example_systems;
mod falling_plate;
#[cfg(feature = "serde-serialize")]
mod file;
mod identify;
mod kirchhoff;
mod legendre;
mod operator;
mod orthogonal;
mod params;
mod pgd;
mod piecewise_linear;
mod quadratic;
mod separated;
mod separated_forces;
mod surrogate;
mod tensor_train;

pub use axis::{Axis, Family, MAX_DEGREE, Quadrature};
pub use canonical::Canonical;
pub use cross::{CrossParams, CrossReport, cross};
pub use deim::Deim;
pub use deim_evolution::{DeimEvolution, DeimParams, Snapshot};
pub use dormand_prince::{Tolerances, integrate};
pub use evolution::{Coupling, EvolutionParams, EvolutionReport, evolve};
pub use falling_plate::FallingPlate;
pub use identify::{Fit, FitParams, fit};
pub use kirchhoff::KirchhoffBody;
pub use operator::{Factor, Operator};
pub use params::PgdParams;
pub use pgd::{PgdReport, compress, solve};
pub use piecewise_linear::PiecewiseLinear;
pub use quadratic::{Dependence, InitialTerm, QuadraticSystem, RateTerm, Singularity};
pub use separated::{Evaluator, Separated};
pub use separated_forces::{Motions, SeparatedForces};
pub use surrogate::{FlowMap, TrajectorySurrogate};
pub use tensor_train::TensorTrain;
