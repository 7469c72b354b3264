//! Reduced models by separated representation (thesis chapter 6): solutions of parametric problems
//! as sums of products of functions of one coordinate, baked once and evaluated in a microsecond.
//!
//! ```text
//! Axis ──► Operator, Canonical ──► pgd::solve ─────┐
//!     └──► QuadraticSystem ──────► evolve ─────────┼──► Separated ──► evaluate, grid
//!     └──► any function ─────────► cross ──► TensorTrain, FlowMap, TrajectorySurrogate
//! model and track ───────────────► identify::fit ──► parameters with uncertainty
//! ```
//!
//! * [`pgd`] is the thesis's algorithm for linear problems of any number of dimensions: greedy
//!   enrichment by alternating directions and projection, with updates of all terms, which bring
//!   them close to the best separation of their number.
//! * [`evolution`] takes coupled systems, quadratic in the state, whose parameters and initial
//!   values are coordinates: by Newton's linearisation, all components together or one by one.
//! * [`cross`](mod@cross) and [`surrogate`] are for dynamics that are no polynomials.
//! * [`identify`] finds the parameters of a model from a measured track.
//!
//! **Where it fails.** A solution that becomes infinite within the domain has no separated
//! representation: [`evolution::evolve`] looks for such points and reports them. Trajectories
//! over a range of parameters in which the motion pattern changes are not separable over times in
//! which the patterns part. Measured on a falling plate over five parameters (three coefficients
//! ± 5 %, density ratio, release angle), as the error of the horizontal position relative to its
//! spread over the domain:
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
//! The kinks of quasi-steady forces at rest and at zero spin limit both short-time forms. They take
//! some 10⁵ samples and ten microseconds or more per step, more than the plate's own rates cost:
//! they pay only for dynamics that cost more (`examples/reduced_models` draws this).
//!
//! ```
//! use rapier3d_immersed::reduced::axis::Axis;
//! use rapier3d_immersed::reduced::evolution::{EvolutionParams, evolve};
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
pub mod axis;
pub mod canonical;
pub mod cross;
pub mod dormand_prince;
pub mod evolution;
pub mod example_systems;
pub mod falling_plate;
#[cfg(feature = "serde-serialize")]
mod file;
pub mod identify;
mod legendre;
pub mod operator;
mod orthogonal;
pub mod pgd;
pub mod quadratic;
pub mod separated;
pub mod surrogate;
pub mod tensor_train;
