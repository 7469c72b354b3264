//! Reduced models by separated representation (thesis chapter 6): solutions of parametric problems
//! as sums of products of functions of one coordinate, baked once and evaluated in a microsecond.
//!
//! ```text
//! Axis ──► Operator, Canonical ──► solve ──────────┐
//!     └──► QuadraticSystem ──────► evolve ─────────┼──► Separated ──► evaluate, grid
//!     └──► any function ─────────► cross ──► TensorTrain, FlowMap, TrajectorySurrogate, SeparatedForces
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
//! * [`KirchhoffBody`] is a body that falls through an ideal fluid as such a system; gravity turns in its axes (thesis (6.24)).
//! * [`cross()`] and [`TrajectorySurrogate`] are for dynamics that are no polynomials.
//! * [`SeparatedForces`] are a fluid's forces over all motions of a body; a [`SeparatedLaw`](crate::SeparatedLaw) of them drives
//!   bodies in rapier.
//! * [`DeimEvolution`] and [`PiecewiseLinear`] are what the thesis (§6.5) weighs against these.
//! * [`fit`] finds the parameters of a model from a measured track.
//!
//! **Where it fails.** A solution that becomes infinite within the domain has no separated
//! representation: [`evolve`] looks for such points and reports them. Trajectories
//! over a range of parameters in which the motion pattern changes are not separable over times in
//! which the patterns part. Measured (`examples/reduced_models`) as the error of the
//! horizontal position relative to its spread over the domain, on a planar plate over five parameters
//! (three coefficients ± 5 %, density ratio, release angle; figure `planar`):
//!
//! | | T = 2 | 5 | 10 | 20 | 40 |
//! |---|---|---|---|---|---|
//! | across flutter–tumble: separated trajectory | 6e-7 | 2e-5 | 1e-2 | .50 | .69 |
//! | … separated flow map over 0.25, iterated | 3e-3 | 4e-3 | 5e-3 | 1e-2 | 2e-2 |
//! | … separated rates, integrated | 3e-3 | 2e-3 | 4e-3 | 1e-2 | 3e-2 |
//! | … empirical interpolation, 200 trajectories | 1e-3 | 1.5 | .75 | 1.1 | 1.2 |
//! | … piecewise linear rates about 4000 points | .08 | .06 | .19 | .34 | .34 |
//! | flutter only: separated trajectory | 4e-7 | 3e-3 | 3e-2 | .07 | .24 |
//! | … separated flow map over 0.25, iterated | 1e-2 | 1e-2 | .09 | .08 | .26 |
//! | … separated rates, integrated | 5e-4 | 2e-4 | 8e-4 | 1e-3 | 3e-3 |
//! | … empirical interpolation, 200 trajectories | 1e-4 | 2e-4 | .23 | .54 | .65 |
//! | … piecewise linear rates about 4000 points | .15 | .03 | .09 | .05 | .08 |
//!
//! Empirical interpolation is the best of all whole trajectories at T = 5 of flutter (79 modes), because it solves the equations between those
//! it was trained on; beyond, the modes that it needs grow to hundreds and Newton's method does not find its way among
//! them (27 % of the solutions at T = 10, all of them across tumbling from T = 5 on). Piecewise linear rates are never
//! good, and their error hardly grows with the horizon. In eight dimensions 4000 points do not cover the training input, and a
//! look at all of them costs seven steps of the flow map.
//!
//! On this crate's own dynamics, [`FreeBody`](crate::FreeBody), figures `card` and `plate`: a card in air in space under the
//! thesis's law, over C̃ ± 5 %, density ratio and release angle, with forces separated over the six
//! coordinates of the motion; and a plate in water in a plane, over density ratio and release angle, under
//! the default law, under which it flutters at these densities (from ρ_s/ρ_f 5 on some turn over):
//!
//! | | T = 0.2 s | 0.5 | 1 | 2 | 3 |
//! |---|---|---|---|---|---|
//! | card, zigzag only: separated trajectory | 2e-5 | 4e-3 | 9e-3 | .06 | .20 |
//! | … separated forces, integrated | 2e-4 | 1e-3 | 2e-3 | 5e-3 | 6e-3 |
//! | card, across autorotation: separated trajectory | 4e-5 | .48 | 1.0 | 1.0 | 1.0 |
//! | … separated forces, integrated | 3e-4 | 5e-3 | .42 | .50 | .54 |
//!
//! | | T = 0.12 s | 0.24 | 0.48 | 1.2 | 2.4 | 4.8 |
//! |---|---|---|---|---|---|---|
//! | plate, ρ_s/ρ_f 2 to 2.6: separated trajectory | 2e-2 | 8e-3 | 5e-3 | .09 | .08 | .13 |
//! | … separated forces, integrated | 6e-3 | 2e-2 | 3e-2 | .94 | 1.2 | 1.8 |
//! | … separated flow map over 0.04 s, iterated | 9 | 9 | 13 | 15 | 15 | 16 |
//! | plate, ρ_s/ρ_f 3.8 to 4.8: separated trajectory | 3e-2 | 5e-3 | .05 | .08 | .56 | .12 |
//! | … separated forces, integrated | 5e-3 | 8e-3 | .07 | .14 | .63 | .48 |
//! | … separated flow map over 0.04 s, iterated | 5 | 2 | 2 | 2 | 2 | 3 |
//!
//! Separate trajectories within one pattern, therefore, and forces across patterns. Forces are sums of few
//! products in the right coordinates (incidence, and the spin along and across the velocity), where rates and
//! flow maps over velocities are not. Nothing follows autorotation for long: 1e-6 rad at the release become
//! a millimetre in 2 s, and any error grows as fast. Nor does anything but a table of its trajectories follow the plate under the
//! default law, whose stall is a step within .1 of sin α that moves with the pitch rate: its forces are good to a percent for half a
//! second, and its flow map takes more than the 10⁵ samples that it was given.
//!
//! The short-time forms take 10⁵ to 1.5·10⁶ samples and ten microseconds or more per step, more than the
//! plate's rates or a step of `FreeBody` cost: they pay only for dynamics that cost more.
//!
//! **Driving bodies** (thesis §7.3; figure `driven`). 64 leaves of 7.3 × 4.2 cm in rapier for 3 s, each tilted its own way, under the
//! default law and under [`SeparatedLaw`](crate::SeparatedLaw)s of it, whose error is that of the force over all motions, half of which
//! spin faster than they move:
//!
//! | | error | mean descent | mean drift | µs per body and step, rapier's 0.8 included |
//! |---|---|---|---|---|
//! | default law | | 1.019 m/s | 1.02 m | 1.2 |
//! | … released 0.001 rad apart | | 1.018 | 0.99 | |
//! | separated, rank 8 | .27 | 0.92 | 0.63 | 6 |
//! | separated, rank 16 | .15 | 1.08 | 0.64 | 6 |
//! | separated, rank 32 | .083 | 1.022 | 1.04 | 14 |
//! | separated, rank 60 | .066 | 1.001 | 1.08 | 32 |
//!
//! From rank 32 on the leaves fall as the law's do, on average: single ones part after a second, as do those that are released
//! a thousandth apart. A law of closed formulas is cheaper itself; the table stands for those that are not.
//!
//! **The thesis's own examples** (§6.4): (6.18) one mode, error 1e-11 as printed. (6.20) error 1e-4 after five enrichments, the thesis's count.
//! (6.22) error 1e-3 after 8 enrichments, 4e-6 finally, baked in a second; all final states of 20³ initial values in 0.1 ms,
//! 300 times faster than solving for each (printed: 17 ms, 50 times; figure `coupled`), on [0, ½] where the solution exists. (6.24) with gravity that turns, and its
//! torque: 6e-4 after 45 enrichments over [0, 1]⁶ (figure `kirchhoff`).
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
