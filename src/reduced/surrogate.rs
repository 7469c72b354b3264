//! Surrogates of dynamics that are no polynomials: separated trajectories, and a separated flow
//! map over a short time that is iterated (thesis §6.5 hopes for the former; see [`FlowMap`]).

use super::axis::Axis;
use super::cross::{CrossParams, CrossReport, cross};
use super::tensor_train::TensorTrain;
use crate::error::Error;

/// Whole trajectories as a tensor train over parameters, initial values among them.
///
/// It is accurate as long as all trajectories of the domain stay alike; where motion patterns change
/// within it, the trajectories of the two sides part, and the ranks grow without bound.
///
/// ```
/// use rapier3d_immersed::reduced::{Axis, CrossParams, TrajectorySurrogate};
///
/// // Where x = cos ωt and its rate are, for every ω from 1 to 2.
/// let model = |omega: &[f64], times: &[f64], states: &mut [f64]| {
///     for (state, time) in states.chunks_exact_mut(2).zip(times) {
///         let (sin, cos) = (omega[0] * time).sin_cos();
///         state.copy_from_slice(&[cos, -omega[0] * sin]);
///     }
/// };
/// let (time, omega) = (Axis::spectral(0.0, 3.0, 16)?, Axis::spectral(1.0, 2.0, 12)?);
/// let (surrogate, report) =
///     TrajectorySurrogate::bake(time, 2, vec![omega], model, &CrossParams::default())?;
/// assert!(report.converged);
/// let state = surrogate.evaluate(&[1.23], &[2.5]);
/// assert!((state[0] - (1.23_f64 * 2.5).cos()).abs() < 1e-5);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct TrajectorySurrogate {
    pub(crate) time: Axis,
    pub(crate) components: usize,
    pub(crate) train: TensorTrain,
}

impl TrajectorySurrogate {
    /// Samples `model(parameters, times, states)`, which writes the states at all `times` (the
    /// nodes of `time`), one after the other with `components` entries each.
    ///
    /// # Errors
    /// Those of [`cross()`].
    pub fn bake(
        time: Axis,
        components: usize,
        parameters: Vec<Axis>,
        mut model: impl FnMut(&[f64], &[f64], &mut [f64]),
        params: &CrossParams,
    ) -> Result<(Self, CrossReport), Error> {
        let times = time.nodes().to_vec();
        let outputs = times.len() * components;
        let (train, report) = cross(parameters, outputs, |p, out| model(p, &times, out), params)?;
        let train = train.rounded(0.1 * params.tolerance);
        let surrogate = Self {
            time,
            components,
            train,
        };
        surrogate.check()?;
        Ok((surrogate, report))
    }

    /// The ranges of the parameters.
    pub fn parameters(&self) -> &[Axis] {
        self.train.axes()
    }

    /// The tensor train over the parameters; its outputs are the states at the nodes of time.
    pub fn train(&self) -> &TensorTrain {
        &self.train
    }

    /// The state at each of `times`, one after the other.
    ///
    /// # Panics
    /// If the number of parameters differs.
    pub fn evaluate(&self, parameters: &[f64], times: &[f64]) -> Vec<f64> {
        let nodes = self.train.evaluate(parameters);
        let mut states = Vec::with_capacity(times.len() * self.components);
        let mut column = vec![0.0; self.time.len()];
        let mut values = vec![vec![0.0; times.len()]; self.components];
        for (component, values) in values.iter_mut().enumerate() {
            for (i, entry) in column.iter_mut().enumerate() {
                *entry = nodes[i * self.components + component];
            }
            for (value, time) in values.iter_mut().zip(times) {
                *value = self.time.interpolate(&column, *time);
            }
        }
        for i in 0..times.len() {
            states.extend(values.iter().map(|component| component[i]));
        }
        states
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        self.train.check()?;
        Error::check_positive("components", self.components as f64)?;
        let expected = self.time.len().saturating_mul(self.components);
        Error::check_length(
            "outputs of a trajectory surrogate",
            expected,
            self.train.outputs(),
        )
    }
}

/// The map from a state to the state a fixed time later, as a tensor train over the state and
/// parameters: iterated, it follows any sequence of motions.
///
/// It makes an error in each step, like an integrator, so that patterns and their statistics survive
/// where [`TrajectorySurrogate`] fails; neighbouring chaotic trajectories still part. It costs
/// Σ rank² · nodes per step, and pays only where the dynamics it stands for cost more.
///
/// A state outside of the axes changes as at their nearer end: bake them as wide as the motion is.
///
/// ```
/// use rapier3d_immersed::reduced::{Axis, CrossParams, FlowMap};
///
/// // u̇ = −u² over steps of 0.1 s: u becomes u/(1 + 0.1 u).
/// let model = |u: &[f64], _: &[f64], change: &mut [f64]| change[0] = u[0] / (1.0 + 0.1 * u[0]) - u[0];
/// let u = Axis::spectral(0.0, 1.0, 12)?;
/// let (map, report) = FlowMap::bake(0.1, vec![u], Vec::new(), 0, model, &CrossParams::default())?;
/// assert!(report.converged);
/// let (mut u, mut change, mut scratch) = ([1.0], [0.0], Vec::new());
/// for _ in 0..20 {
///     map.change(&u, &[], &mut change, &mut scratch);
///     u[0] += change[0];
/// }
/// assert!((u[0] - 1.0 / 3.0).abs() < 1e-6); // 1/(1 + t) at t = 2
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct FlowMap {
    pub(crate) step: f64,
    pub(crate) components: usize,
    pub(crate) train: TensorTrain,
}

impl FlowMap {
    /// Samples `model(state, parameters, change)`, which writes what `step` seconds change: first
    /// that of every component of the state, then of any further quantities (such as the
    /// position, which the rates do not depend on).
    ///
    /// # Errors
    /// Those of [`cross()`]; `step` must be positive.
    pub fn bake(
        step: f64,
        state: Vec<Axis>,
        parameters: Vec<Axis>,
        further: usize,
        mut model: impl FnMut(&[f64], &[f64], &mut [f64]),
        params: &CrossParams,
    ) -> Result<(Self, CrossReport), Error> {
        Error::check_positive("step", step)?;
        let components = state.len();
        let axes = state.into_iter().chain(parameters).collect();
        let change = |point: &[f64], out: &mut [f64]| {
            let (state, parameters) = point.split_at(components);
            model(state, parameters, out);
        };
        let (train, report) = cross(axes, components + further, change, params)?;
        let train = train.rounded(0.1 * params.tolerance);
        let map = Self {
            step,
            components,
            train,
        };
        map.check()?;
        Ok((map, report))
    }

    /// How long one step is.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// The tensor train: state, then parameters, to the changes.
    pub fn train(&self) -> &TensorTrain {
        &self.train
    }

    /// Writes the changes of one step: of the state, then of the further quantities.
    ///
    /// # Panics
    /// If a length differs from what was baked.
    pub fn change(
        &self,
        state: &[f64],
        parameters: &[f64],
        change: &mut [f64],
        scratch: &mut Vec<f64>,
    ) {
        assert_eq!(
            state.len(),
            self.components,
            "one entry per component of the state"
        );
        let point: Vec<f64> = state.iter().chain(parameters).copied().collect();
        self.train.evaluate_into(&point, change, scratch);
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        self.train.check()?;
        Error::check_positive("step", self.step)?;
        Error::check_positive("components", self.components as f64)?;
        if self.components > self.train.outputs() || self.components > self.train.axes().len() {
            return Err(Error::WrongLength {
                what: "outputs of a flow map",
                expected: self.components,
                actual: self.train.outputs().min(self.train.axes().len()),
            });
        }
        Ok(())
    }
}
